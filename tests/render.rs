//! Pictures: `dosmc render` as its users meet it, hostile names, and the picture in the README.
//! (`tests/stages.rs` looks at the picture of every mission of the corpus.)

#![allow(clippy::disallowed_methods, reason = "runs the command and looks at its files")]

mod common;
mod picture;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

use dosmc::back::svg::{self, Options};
use dosmc::ir::Problem;
use dosmc::plan::Plan;
use proptest::prelude::*;
use serde_json::Value;

use common::planned;

const RELAY: &str = "examples/relay.dosm";

fn dosmc(args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dosmc"));
    command.current_dir(env!("CARGO_MANIFEST_DIR")).args(args).output().expect("the command starts")
}

fn status(output: &Output) -> i32 {
    output.status.code().expect("it was not killed")
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A directory with the relay's plan in it, made once.
static SOLVED: LazyLock<tempfile::TempDir> = LazyLock::new(|| {
    let dir = tempfile::tempdir().expect("a directory");
    let output = dosmc(&["solve", RELAY, "-o", dir.path().to_str().expect("plain names")]);
    assert_eq!(status(&output), 0, "{}", said(&output));
    dir
});

fn solved(name: &str) -> String {
    SOLVED.path().join(name).to_str().expect("plain names").to_string()
}

/// A fresh directory, and a file's path in it.
fn fresh(name: &str) -> (tempfile::TempDir, PathBuf, String) {
    let dir = tempfile::tempdir().expect("a directory");
    let path = dir.path().join(name);
    let text = path.to_str().expect("plain names").to_string();
    (dir, path, text)
}

#[test]
fn a_plan_is_drawn_as_solve_draws_it() {
    let (_dir, path, file) = fresh("new/directory/picture.SVG");
    let output = dosmc(&["render", &solved("plan.json"), RELAY, "-o", &file]);
    assert_eq!(status(&output), 0, "{}", said(&output));
    let picture = fs::read_to_string(&path).expect("it was drawn");
    assert_eq!(picture, fs::read_to_string(solved("plan.svg")).expect("solve drew it"));
    picture::assert_fine(&picture);
    assert_eq!(fs::read_dir(path.parent().expect("one")).expect("it is there").count(), 1, "nothing else");
}

#[test]
fn a_plan_that_does_not_check_is_not_drawn() {
    let (_dir, path, file) = fresh("picture.svg");
    fs::write(&path, "what was there").expect("it can be written");
    let forged = fs::read_to_string(solved("plan.json")).expect("a plan");
    let (_forged_dir, forged_path, forged_file) = fresh("plan.json");
    // Two robots at the same place.
    let mut value: Value = serde_json::from_str(&forged).expect("JSON");
    value["robots"][0]["z"] = value["robots"][1]["z"].clone();
    fs::write(&forged_path, value.to_string()).expect("it can be written");
    let other = "examples/hops.dosm";
    let cases: [(&[&str], i32); 5] = [
        (&["render", &forged_file, RELAY, "-o", &file], 5),
        (&["render", &solved("plan.json"), other, "-o", &file], 5),
        (&["render", RELAY, RELAY, "-o", &file], 5),
        (&["render", &solved("plan.json"), "tests/missions/err/check_unknown_region.dosm", "-o", &file], 2),
        (&["render", "no/such/plan.json", RELAY, "-o", &file], 1),
    ];
    for (args, expected) in cases {
        let output = dosmc(args);
        assert_eq!(status(&output), expected, "{args:?}: {}", said(&output));
        assert_eq!(fs::read_to_string(&path).expect("it is there"), "what was there", "{args:?}");
    }
}

#[test]
fn a_plan_of_other_parameters_is_not_drawn() {
    let (_dir, path, file) = fresh("picture.svg");
    let mission = "examples/paper/fig2-4.dosm";
    let (_out, _, out) = fresh("out");
    assert_eq!(status(&dosmc(&["solve", mission, "-o", &out])), 0);
    let plan = format!("{out}/plan.json");
    assert_eq!(status(&dosmc(&["render", &plan, mission, "-o", &file, "--set", "bases=2"])), 5);
    assert!(!path.exists());
    assert_eq!(status(&dosmc(&["render", &plan, mission, "-o", &file])), 0);
    assert!(path.exists());
}

#[test]
fn other_kinds_of_picture_are_refused_with_what_is_possible() {
    for name in ["page.htm", "picture.pdf", "picture", ".svg"] {
        let (_dir, path, file) = fresh(name);
        let output = dosmc(&["render", &solved("plan.json"), RELAY, "-o", &file]);
        assert_eq!(status(&output), 1, "{name}");
        assert!(said(&output).contains("FILE.svg"), "{}", said(&output));
        assert!(!path.exists());
    }
    let dir = tempfile::tempdir().expect("a directory");
    let taken = dir.path().join("picture.svg");
    fs::create_dir(&taken).expect("a directory in the way");
    let output = dosmc(&["render", &solved("plan.json"), RELAY, "-o", taken.to_str().expect("plain names")]);
    assert_eq!(status(&output), 1);
}

#[cfg(not(feature = "png"))]
#[test]
fn without_the_feature_png_is_refused_with_the_way_to_it() {
    let (_dir, path, file) = fresh("picture.png");
    let (_out, out_path, out) = fresh("out");
    for args in
        [&["render", &solved("plan.json"), RELAY, "-o", &file][..], &["solve", RELAY, "-o", &out, "--png"]]
    {
        let output = dosmc(args);
        assert_eq!(status(&output), 1);
        assert!(said(&output).contains("--features png"), "{}", said(&output));
    }
    assert!(!path.exists() && !out_path.exists());
}

#[cfg(feature = "png")]
#[test]
fn with_the_feature_png_is_drawn() {
    let (_dir, path, file) = fresh("picture.png");
    let (_out, out_path, out) = fresh("out");
    for args in
        [&["render", &solved("plan.json"), RELAY, "-o", &file][..], &["solve", RELAY, "-o", &out, "--png"]]
    {
        let output = dosmc(args);
        assert_eq!(status(&output), 0, "{}", said(&output));
    }
    let bytes = fs::read(&path).expect("it was drawn");
    assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n") && bytes.len() > 10_000);
    assert_eq!(bytes, fs::read(out_path.join("plan.png")).expect("it was drawn"));
}

/// The picture in the README is what is drawn today; `DOSMC_UPDATE=1 cargo test --test render` draws it
/// anew.
#[test]
fn the_picture_in_the_readme_is_up_to_date() {
    let (problem, plan) = planned("examples/paper/fig2-4.dosm");
    let drawn = svg::draw(&problem, &plan, &Options::default()).contents;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/fig2.svg");
    if std::env::var_os("DOSMC_UPDATE").is_some() {
        fs::write(&path, &drawn).expect("it can be written");
    }
    let kept = fs::read_to_string(&path).expect("it is there");
    assert!(kept == drawn, "docs/fig2.svg is not what is drawn today; DOSMC_UPDATE=1 draws it anew");
}

/// Each example has its picture in `docs/pictures`, as it is drawn today; the same variable draws them
/// anew.
#[test]
fn the_pictures_of_the_examples_are_up_to_date() {
    let directory = common::package("docs/pictures");
    let update = std::env::var_os("DOSMC_UPDATE").is_some();
    let mut stale = Vec::new();
    let mut names = Vec::new();
    for mission in common::missions("examples") {
        let stem = mission.file_stem().expect("a name").to_string_lossy().into_owned();
        let (problem, plan) = planned(&format!("examples/{stem}.dosm"));
        let drawn = svg::draw(&problem, &plan, &Options::default()).contents;
        let name = format!("{stem}.svg");
        if update {
            fs::write(directory.join(&name), &drawn).expect("it can be written");
        }
        if fs::read_to_string(directory.join(&name)).ok().as_deref() != Some(drawn.as_str()) {
            stale.push(name.clone());
        }
        names.push(name);
    }
    assert!(stale.is_empty(), "not what is drawn today: {stale:?}; DOSMC_UPDATE=1 draws them anew");
    for entry in fs::read_dir(directory).expect("a directory") {
        let name = entry.expect("an entry").file_name().to_string_lossy().into_owned();
        assert!(names.contains(&name), "{name} is the picture of no example");
    }
}

static RELAYED: LazyLock<(Problem, Plan)> = LazyLock::new(|| planned(RELAY));

/// The relay with other names.
fn renamed(mission: &str, names: &[String; 5]) -> (Problem, Plan) {
    common::renamed(&RELAYED, mission, names)
}

#[test]
fn hostile_names_are_only_text() {
    let hostile = [
        "</text><script>alert(1)</script>",
        "\" onload=\"alert(1)",
        "'--><![CDATA[ ]]> &amp; &#x202e;",
        "\u{202e}desrever\u{2066}\u{200f}",
        "\u{1b}[31m\0\u{fffe}\u{ffff}\n\t\u{7f}",
    ];
    let (problem, plan) = renamed("</title><svg onload='x'>]]>", &hostile.map(String::from));
    let text = svg::draw(&problem, &plan, &Options::default()).contents;
    picture::assert_fine(&text);
    let document = roxmltree::Document::parse(&text).expect("XML");
    let says = |name: &str| document.descendants().any(|n| n.is_text() && n.text() == Some(name));
    assert!(says(hostile[1]) && says("</title><svg onload='x'>]]>"), "the names are still there as text");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(48) })]

    #[test]
    fn whatever_the_names_the_picture_is_fine(
        mission in any::<String>(),
        names in prop::array::uniform5(prop_oneof![any::<String>(), "[a-zA-Z_0-9\\[\\],]{1,64}", "[<>&\"'\u{200e}\u{202e}\u{2066}\u{1b}]{1,9}"]),
    ) {
        let (problem, plan) = renamed(&mission, &names);
        let options = Options::default();
        let text = svg::draw(&problem, &plan, &options).contents;
        picture::assert_fine(&text);
        prop_assert_eq!(&text, &svg::draw(&problem, &plan, &options).contents);
    }
}
