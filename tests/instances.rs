//! `compile` and `solve` on instance files: the same plan as from the mission, and nothing from a file
//! that was changed.

#![allow(clippy::disallowed_methods, reason = "runs the command and looks at its files")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;

fn run(args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dosmc"));
    command.current_dir(env!("CARGO_MANIFEST_DIR")).stdin(Stdio::null());
    command.args(args).output().expect("it runs")
}

#[track_caller]
fn done(args: &[&str]) {
    let output = run(args);
    assert_eq!(output.status.code(), Some(0), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
}

fn shown(path: &Path) -> &str {
    path.to_str().expect("a plain path")
}

/// The only file in a directory with an extension.
fn file(directory: &Path, extension: &str) -> PathBuf {
    let entries = fs::read_dir(directory).expect("a directory").map(|e| e.expect("an entry").path());
    let mut found: Vec<PathBuf> = entries.filter(|p| shown(p).ends_with(extension)).collect();
    assert_eq!(found.len(), 1, "{found:?}");
    found.remove(0)
}

/// Compiles a mission to an instance in a new directory.
fn compiled(mission: &str, flags: &[&str]) -> (tempfile::TempDir, PathBuf) {
    let directory = tempfile::tempdir().expect("a directory");
    done(&[&["compile", mission, "-o", shown(directory.path()), "--emit", "smc"], flags].concat());
    let instance = file(directory.path(), ".smc.json");
    (directory, instance)
}

#[test]
fn an_instance_gives_the_plan_of_its_mission() {
    for (mission, flags) in [
        ("tests/missions/solve/relay.dosm", &[][..]),
        ("examples/hops.dosm", &["--horizon", "2..12"]),
        ("examples/paper/table1-4.dosm", &["--set", "robots=3", "--set", "bases=2", "--horizon", "1..9"]),
        ("examples/wall.dosm", &["--encoding", "paper", "--horizon", "1..15"]),
    ] {
        let (directory, instance) = compiled(mission, flags);
        let (one, other) = (directory.path().join("one"), directory.path().join("other"));
        done(&[&["solve", mission, "-o", shown(&one)], flags].concat());
        done(&["solve", shown(&instance), "-o", shown(&other)]);
        for name in ["plan.json", "plan.svg"] {
            let read = |directory: &Path| fs::read_to_string(directory.join(name)).expect("a file");
            assert_eq!(read(&one), read(&other), "{mission}: another {name}");
        }
    }
}

#[test]
fn an_instance_without_a_plan_is_refuted() {
    let (directory, instance) = compiled("tests/missions/unsat/too_far.dosm", &[]);
    let out = directory.path().join("out");
    assert_eq!(run(&["solve", shown(&instance), "-o", shown(&out)]).status.code(), Some(3));
    assert!(!out.exists());
}

/// What `solve --json` says of a text given as an instance: the status and the first code.
fn said(text: &str, flags: &[&str]) -> (Option<i32>, String) {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("changed.smc.json");
    fs::write(&path, text).expect("it can be written");
    let out = directory.path().join("out");
    let output = run(&[&["solve", shown(&path), "-o", shown(&out), "--json"], flags].concat());
    assert!(!out.exists() || output.status.success(), "something was written");
    let answer: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let code = answer["diagnostics"][0]["code"].as_str().unwrap_or_default().to_owned();
    (output.status.code(), code)
}

#[test]
fn an_instance_that_was_changed_is_not_planned() {
    let (_directory, instance) = compiled("tests/missions/solve/reach.dosm", &["--horizon", "1..7"]);
    let text = fs::read_to_string(instance).expect("a file");
    assert_eq!(said(&text, &[]), (Some(0), String::new()));
    let document: Value = serde_json::from_str(&text).expect("JSON");
    let change = |path: &str, value: Value| {
        let mut changed = document.clone();
        *changed.pointer_mut(path).unwrap_or_else(|| panic!("nothing at {path}")) = value;
        said(&changed.to_string(), &[])
    };
    let altered = (Some(1), "dosm::smc::altered".to_owned());
    assert_eq!(change("/cnf/clauses/3", serde_json::json!([1])), altered);
    assert_eq!(change("/cnf/vars", 100_000.into()), altered);
    assert_eq!(change("/convex/blocks/0/rows/0/bound", 0.125.into()), altered);
    assert_eq!(change("/tubes/0/disturbance/half_width/0", 0.0.into()), altered);
    assert_eq!(change("/half_spaces/0/offset", 0.0.into()), altered);
    assert_eq!(change("/map/loops/0/loop_start", 5.into()), altered);
    assert_eq!(change("/encoding", "paper".into()), altered);
    assert_eq!(change("/mission/sha256", "0".into()), altered);
    let source = document["mission"]["source"].as_str().expect("a text").to_owned() + "// more\n";
    assert_eq!(change("/mission/source", source.into()), altered);
    // Who wrote it does not matter.
    assert_eq!(change("/tool", "somebody else".into()).0, Some(0));
    let malformed = (Some(1), "dosm::smc::malformed".to_owned());
    assert_eq!(change("/version", 2.into()), malformed);
    assert_eq!(change("/cnf/clauses", "none".into()), malformed);
    assert_eq!(said(&text[..text.len() / 2], &[]), malformed);
    assert_eq!(said(&text.replacen("\"cnf\"", "\"tool\"", 1), &[]), malformed);
    assert_eq!(said("{}", &[]), malformed);
}

#[test]
fn the_command_line_does_not_contradict_an_instance() {
    let (_directory, instance) = compiled("tests/missions/solve/reach.dosm", &["--horizon", "2..7"]);
    let text = fs::read_to_string(instance).expect("a file");
    let usage = (Some(1), "dosm::cli::usage".to_owned());
    assert_eq!(said(&text, &["--set", "a=1"]), usage);
    assert_eq!(said(&text, &["--encoding", "paper"]), usage);
    assert_eq!(said(&text, &["--horizon", "1..7"]), usage);
    assert_eq!(said(&text, &["--horizon", "2..8"]), usage);
    assert_eq!(said(&text, &["--encoding", "half-spaces", "--horizon", "3..7"]).0, Some(0));
    assert_eq!(said(&text, &["--horizon", "2..3"]).0, Some(3));
}

#[test]
fn an_instance_that_nobody_could_read_is_not_written() {
    let directory = tempfile::tempdir().expect("a directory");
    let out = directory.path().join("out");
    let mission = "examples/paper/table1-4.dosm";
    let args = ["compile", mission, "-o", shown(&out), "--emit", "smc", "--horizon", "1..20000", "--json"];
    let output = run(&args);
    assert_eq!(output.status.code(), Some(1));
    let answer: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(answer["diagnostics"][0]["code"], "dosm::cli::too_large");
    assert!(!out.exists());
}
