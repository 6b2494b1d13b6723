//! The command as its users meet it: exit statuses, JSON, files, hostile input.

#![allow(clippy::disallowed_methods, reason = "runs the command and looks at its files")]

#[path = "../common/mod.rs"]
mod common;
mod controller;
mod style;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

const REACH: &str = "tests/missions/solve/reach.dosm";
const UNSAT: &str = "tests/missions/unsat/too_far.dosm";
const WRONG: &str = "tests/missions/err/check_unknown_region.dosm";

/// A mission whose search goes on for ever, as far as a test is concerned.
const ENDLESS: &str = "tests/missions/unsat/cut_off.dosm";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn dosmc() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dosmc"));
    command.current_dir(root()).env_remove("NO_COLOR").stdin(Stdio::null());
    command
}

fn run(args: &[&str]) -> Output {
    dosmc().args(args).output().expect("the command starts")
}

fn run_with_input(args: &[&str], input: &[u8]) -> Output {
    let mut command = dosmc();
    command.args(args).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the command starts");
    // A command that has seen enough closes its input early.
    let _ = child.stdin.take().expect("a pipe").write_all(input);
    child.wait_with_output().expect("the command ends")
}

fn status(output: &Output) -> i32 {
    output.status.code().expect("it was not killed")
}

/// Standard output as exactly one JSON object.
fn json(output: &Output) -> Value {
    let text = String::from_utf8(output.stdout.clone()).expect("UTF-8");
    let value: Value = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e}: {text:?}"));
    assert!(value.is_object() && text.ends_with("}\n") && text.lines().count() == 1, "{text:?}");
    value
}

fn temporary() -> tempfile::TempDir {
    tempfile::tempdir().expect("a directory")
}

fn path(path: &Path) -> &str {
    path.to_str().expect("plain names")
}

/// Solves a mission into a fresh directory.
fn solved(mission: &str, more: &[&str]) -> (tempfile::TempDir, PathBuf, Output) {
    let dir = temporary();
    let out = dir.path().join("out");
    let output = run(&[&["solve", mission, "-o", path(&out)], more].concat());
    (dir, out, output)
}

#[test]
fn every_command_ends_with_its_status() {
    let (_keep, out, output) = solved(REACH, &[]);
    assert_eq!(status(&output), 0, "{output:?}");
    let plan = out.join("plan.json");
    let fresh = temporary();
    let other = fresh.path().join("other");
    let (plan, other) = (path(&plan), path(&other));
    let table: &[(&[&str], i32)] = &[
        (&["--help"], 0),
        (&["--version"], 0),
        (&["solve", "--help"], 0),
        (&[], 1),
        (&["frobnicate"], 1),
        (&["check"], 1),
        (&["check", REACH, "--frobnicate"], 1),
        (&["check", REACH, "--set", "robots"], 1),
        (&["check", REACH, "--set", "a=1", "--set", "a=2"], 1),
        (&["check", REACH, "--horizon", "9..3"], 1),
        (&["check", REACH, "--timeout", "soon"], 1),
        (&["check", REACH, "--threads", "0"], 1),
        (&["check", REACH, "--quiet", "--verbose"], 1),
        (&["check", "-", "-"], 1),
        (&["check", "no/such/file.dosm"], 1),
        (&["check", "tests"], 1),
        (&["check", REACH], 0),
        (&["check", REACH, "examples/first.dosm"], 0),
        (&["check", WRONG], 2),
        (&["check", REACH, WRONG], 2),
        (&["check", WRONG, "no/such/file.dosm"], 1),
        (&["check", REACH, "--set", "nobody=1"], 2),
        (&["check", "tests/missions/err/syntax_not_utf8.dosm"], 2),
        (&["check", "tests/missions/err/tube_weak_inputs.dosm"], 2),
        (&["check", "tests/missions/err/abstraction_starts_too_close.dosm"], 2),
        (&["solve", REACH], 1),
        (&["solve", WRONG, "-o", other], 2),
        (&["solve", UNSAT, "-o", other], 3),
        (&["solve", REACH, "-o", other, "--timeout", "0"], 4),
        (&["solve", REACH, "-o", "Cargo.toml"], 1),
        (&["solve", REACH, "-o", "Cargo.toml/below"], 1),
        (&["compile", REACH], 1),
        (&["compile", REACH, "-o", other, "--emit", "brainwave"], 1),
        (&["compile", REACH, "-o", other, "--emit", ""], 1),
        (&["compile", REACH, "-o", other, "--length", "0"], 1),
        (&["compile", REACH, "-o", "Cargo.toml"], 1),
        (&["compile", "no/such/file.dosm", "-o", other], 1),
        (&["compile", WRONG, "-o", other], 2),
        (&["compile", "tests/missions/err/tube_weak_inputs.dosm", "-o", other], 2),
        (&["compile", REACH, "-o", other, "--timeout", "0"], 4),
        (&["verify", plan, REACH], 0),
        (&["verify", plan, REACH, "--horizon", "1..1"], 0),
        (&["verify", plan, "tests/missions/solve/until.dosm"], 5),
        (&["verify", plan, WRONG], 2),
        (&["verify", REACH, REACH], 5),
        (&["verify", "no/such/plan.json", REACH], 1),
        (&["verify", plan, "no/such/file.dosm"], 1),
        (&["verify", "-", "-"], 1),
        (&["new", "not-a-name"], 1),
        (&["new", "../escape"], 1),
    ];
    for (args, expected) in table {
        let output = run(args);
        assert_eq!(status(&output), *expected, "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
        let said = !output.stderr.is_empty() || !output.stdout.is_empty();
        assert!(said, "{args:?} says nothing");
    }
    assert!(!Path::new(other).exists(), "a directory was made without a plan to put there");
}

#[test]
fn a_set_that_differs_is_refused() {
    let mission = "examples/paper/table1-4.dosm";
    let (_keep, out, output) = solved(mission, &["--set", "bases=2"]);
    assert_eq!(status(&output), 0);
    let plan = out.join("plan.json");
    assert_eq!(status(&run(&["verify", path(&plan), mission, "--set", "bases=2"])), 0);
    assert_eq!(status(&run(&["verify", path(&plan), mission])), 5);
}

#[test]
fn another_text_is_only_said() {
    let (keep, out, _) = solved(REACH, &[]);
    let copy = keep.path().join("reach.dosm");
    let text = fs::read_to_string(root().join(REACH)).expect("the mission");
    fs::write(&copy, format!("{text}\n// A remark.\n")).expect("it can be written");
    let plan = out.join("plan.json");
    let same = run(&["verify", path(&plan), REACH, "--json"]);
    let other = run(&["verify", path(&plan), path(&copy), "--json"]);
    assert_eq!((status(&same), status(&other)), (0, 0));
    assert_eq!(json(&same)["same_text"], true);
    assert_eq!(json(&other)["same_text"], false);
}

#[test]
fn a_plan_that_was_tampered_with_is_refused() {
    let (_keep, out, _) = solved(REACH, &[]);
    let plan = out.join("plan.json");
    let mut value: Value = serde_json::from_str(&fs::read_to_string(&plan).expect("a plan")).expect("JSON");
    let state = &mut value["robots"][0]["z"][2][0];
    *state = Value::from(state.as_f64().expect("a number") + 1e-3);
    fs::write(&plan, value.to_string()).expect("it can be written");
    let output = run(&["verify", path(&plan), REACH, "--json"]);
    assert_eq!(status(&output), 5);
    assert_eq!(json(&output)["status"], "refused");
}

#[test]
fn json_has_the_promised_shape() {
    let (_keep, out, output) = solved(REACH, &["--json"]);
    let value = json(&output);
    assert_eq!(value["status"], "plan");
    assert!(value["length"].as_u64() > Some(0) && value["loop_start"].is_u64());
    assert_eq!(value["shortest"], true);
    assert!(value["time_s"].as_f64() > Some(0.0));
    let counts =
        ["half_spaces", "cells", "bool_vars", "bool_vars_connectivity", "bool_vars_connectivity_paper"];
    let more = ["clauses", "sat_calls", "convex_calls", "lemmas"];
    let times =
        ["time_tube_s", "time_geometry_s", "time_encode_s", "time_sat_s", "time_convex_s", "time_verify_s"];
    let times = times.into_iter().chain(["time_read_s", "time_check_s", "time_write_s", "time_total_s"]);
    for key in counts.into_iter().chain(more) {
        assert!(value["stats"][key].is_u64(), "{key}");
    }
    for key in times.chain(["peak_rss_mib"]) {
        assert!(value["stats"][key].as_f64() > Some(0.0), "{key}");
    }
    assert!(value["stats"]["conflicts"].is_object());
    let rejection = &value["stats"]["rejection"]["Rover"];
    assert!(rejection["beta"].is_f64() && rejection["why"].is_string(), "{rejection}");
    assert!(out.join("plan.json").is_file());

    let value = json(&solved(UNSAT, &["--json"]).2);
    assert_eq!(value["status"], "no_plan");
    let scope = &value["scope"];
    assert!(
        scope["beta"]["Rover"].is_f64()
            && scope["half_widths"]["Rover"].is_array()
            && scope["directions"].is_u64()
    );

    let value = json(&solved(REACH, &["--json", "--timeout", "0s"]).2);
    assert_eq!((&value["status"], &value["reason"]), (&"unknown".into(), &"timeout".into()));

    for (mission, code) in [(WRONG, "dosm::check::unknown_region"), ("no/such.dosm", "dosm::cli::unreadable")]
    {
        let value = json(&solved(mission, &["--json"]).2);
        assert_eq!(value["status"], "error");
        assert_eq!(value["diagnostics"][0]["code"], code);
    }
    let value = json(&run(&["solve", "--json", "--frobnicate"]));
    assert_eq!(
        (&value["status"], &value["diagnostics"][0]["code"]),
        (&"error".into(), &"dosm::cli::usage".into())
    );
}

#[test]
fn compile_writes_what_is_asked_for() {
    let dir = temporary();
    let out = dir.path().join("deep/out");
    let output = run(&["compile", REACH, "-o", path(&out), "--emit", "ir,ir", "--json"]);
    assert_eq!(status(&output), 0, "{output:?}");
    let file = out.join("reach.ir.json");
    assert_eq!(json(&output), serde_json::json!({"status": "done", "files": [path(&file)]}));
    let document: Value =
        serde_json::from_str(&fs::read_to_string(&file).expect("it was written")).expect("JSON");
    assert_eq!((&document["format"], &document["version"]), (&"dosm-ir".into(), &1.into()));
    assert_eq!(fs::read_dir(&out).expect("it is there").count(), 1);

    let text = fs::read(root().join(REACH)).expect("the mission");
    let output = run_with_input(&["compile", "-", "-o", path(&out), "--horizon", "3..4"], &text);
    assert_eq!(status(&output), 0, "{output:?}");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("mission.ir.json"), "{said}");
    let document = fs::read_to_string(out.join("mission.ir.json")).expect("it was written");
    assert!(document.contains("\"horizon\": {\"from\": 3, \"to\": 4}"), "{document}");

    let output = run(&["compile", REACH, "-o", path(&out), "--timeout", "0", "--json"]);
    assert_eq!(json(&output)["status"], "unknown");
}

#[test]
fn the_papers_encoding_is_counted_and_drawn() {
    let (_dir, out, output) = solved("examples/first.dosm", &["--encoding", "paper", "--json"]);
    assert_eq!(status(&output), 0);
    let answer = json(&output);
    assert_eq!(answer["stats"]["encoding"], "paper");
    assert!(answer["stats"]["cells"].as_u64() > Some(1));
    assert_eq!(
        answer["stats"]["bool_vars_connectivity"], answer["stats"]["bool_vars_connectivity_paper"],
        "exactly the paper's variables"
    );
    let picture = fs::read_to_string(out.join("plan.svg")).unwrap();
    assert!(picture.contains("class=\"cell\""));
    let (plan, file) = (out.join("plan.json"), out.join("again.svg"));
    for (more, same) in [(&["--encoding", "paper"][..], true), (&[], false)] {
        let args = [&["render", path(&plan), "examples/first.dosm", "-o", path(&file)], more].concat();
        assert_eq!(status(&run(&args)), 0);
        assert_eq!(fs::read_to_string(&file).unwrap() == picture, same);
    }
}

#[test]
fn check_lists_diagnostics_with_their_places() {
    let output = run(&["check", "--json", REACH, WRONG]);
    let value = json(&output);
    assert_eq!((&value["status"], &value["errors"]), (&"error".into(), &1.into()));
    assert_eq!(value["files"][0]["status"], "ok");
    let diagnostic = &value["diagnostics"][0];
    assert_eq!(diagnostic["severity"], "error");
    assert_eq!(diagnostic["help"], "did you mean `depot`?");
    let label = &diagnostic["labels"][0];
    let place = ["line", "column", "end_line", "end_column", "start", "end"]
        .map(|k| label[k].as_u64().expect("a number"));
    let text = fs::read_to_string(root().join(WRONG)).expect("the mission");
    assert_eq!(&text[place[4] as usize..place[5] as usize], "dpot");
    assert_eq!(
        text.lines().nth(place[0] as usize - 1).and_then(|l| l.find("dpot")),
        Some(place[1] as usize - 1)
    );
    assert_eq!((place[0], place[1] + 4), (place[2], place[3]));
    assert!(output.stderr.is_empty(), "nothing but JSON is asked for");
}

#[test]
fn standard_input_is_a_file_too() {
    let text = fs::read(root().join(REACH)).expect("the mission");
    assert_eq!(status(&run_with_input(&["check", "-"], &text)), 0);
    assert_eq!(status(&run_with_input(&["check", "-"], b"dosm 1\nnonsense")), 2);
    let dir = temporary();
    let out = dir.path().join("out");
    assert_eq!(status(&run_with_input(&["solve", "-", "-o", path(&out)], &text)), 0);
    let plan = fs::read(out.join("plan.json")).expect("a plan");
    assert_eq!(
        status(&run_with_input(&["verify", "-", REACH], &plan)),
        5,
        "the mission's name is its file's"
    );
}

#[test]
fn a_new_mission_can_be_planned_and_is_never_overwritten() {
    let dir = temporary();
    let new = |args: &[&str]| dosmc().current_dir(dir.path()).args(args).output().expect("it starts");
    assert_eq!(status(&new(&["new", "relay_2"])), 0);
    let file = dir.path().join("relay_2.dosm");
    fs::write(&file, fs::read_to_string(&file).expect("it is there") + "// mine\n")
        .expect("it can be written");
    assert_eq!(status(&new(&["new", "relay_2"])), 1);
    assert!(fs::read_to_string(&file).expect("it is there").ends_with("// mine\n"));
    let output = new(&["check", "relay_2.dosm", "--json"]);
    assert_eq!((status(&output), &json(&output)["warnings"]), (0, &0.into()));
    assert_eq!(status(&new(&["solve", "relay_2.dosm", "-o", "out"])), 0);
    for bad in ["", "2a", "a b", "a/b", "..", "goal", "always", &"x".repeat(65), "a\u{1b}[31m"] {
        let output = new(&["new", bad]);
        assert_eq!(status(&output), 1, "{bad}");
        assert!(!output.stderr.contains(&0x1b));
    }
    let names = fs::read_dir(dir.path()).expect("it is there").count();
    assert_eq!(names, 2, "relay_2.dosm and out");
}

/// Standard output and error hold no character that moves a cursor, hides or turns text round.
fn assert_printable(output: &Output) {
    for stream in [&output.stdout, &output.stderr] {
        let text = std::str::from_utf8(stream).expect("UTF-8");
        let hostile =
            text.chars().find(|c| (c.is_control() && *c != '\n') || matches!(c, '\u{202a}'..='\u{202e}'));
        assert_eq!(hostile, None, "{text:?}");
    }
}

#[test]
fn hostile_texts_are_answered_at_once_and_cleanly() {
    let noise = |seed: u64, count: usize, alphabet: &[u8]| -> Vec<u8> {
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            alphabet[(state >> 33) as usize % alphabet.len()]
        };
        (0..count).map(|_| next()).collect()
    };
    let every_byte: Vec<u8> = (0..=255).collect();
    let mission =
        |goal: String| format!("dosm 1\nworkspace box (0, 0) .. (9, 9)\ngoal g: {goal}\n").into_bytes();
    let cases: Vec<(&str, Vec<u8>)> = vec![
        ("nothing", Vec::new()),
        ("20,000 brackets", mission("(".repeat(20_000))),
        ("20,000 pairs of brackets", mission(format!("{}true{}", "(".repeat(20_000), ")".repeat(20_000)))),
        ("100,000 negations", mission(format!("{} true", "!".repeat(100_000)))),
        ("100,000 arrows", mission("true -> ".repeat(100_000))),
        ("comments in comments", mission("/*".repeat(20_000))),
        ("a billion members", b"dosm 1\njammer J[i in 1..1000000000] = ball (i, 0) radius 1\n".to_vec()),
        ("a long exponent", mission("10^10^10^10^10".into())),
        ("10 MB of any bytes", noise(1, 10 << 20, &every_byte)),
        ("10 MB of one line", noise(2, 10 << 20, b"abcgoal region (){}[]=<>+-*/.,:; 0123456789")),
        ("10 MB of lines", noise(3, 10 << 20, b"goal region\n\n()x = 1\n")),
        ("invalid UTF-8", b"dosm 1\nmission \xff\xfe\n".to_vec()),
        (
            "escape sequences",
            b"dosm 1\nmission \x1b[31m\x1b]0;title\x07 \xc2\x9b2J \xe2\x80\xae evil\n".to_vec(),
        ),
        ("a null byte", b"dosm 1\0\nmission x\n".to_vec()),
    ];
    for (name, text) in cases {
        for more in [&[][..], &["--json"]] {
            let started = Instant::now();
            let output = run_with_input(&[&["check", "-"], more].concat(), &text);
            assert_eq!(status(&output), 2, "{name}: {}", String::from_utf8_lossy(&output.stderr));
            assert!(started.elapsed() < Duration::from_secs(20), "{name} took {:?}", started.elapsed());
            assert!(output.stderr.len() < 1 << 20, "{name} said {} bytes", output.stderr.len());
            if more.is_empty() {
                assert_printable(&output);
            } else {
                json(&output);
            }
        }
    }
}

#[test]
fn hostile_names_reach_no_terminal() {
    let dir = temporary();
    let evil = dir.path().join("evil\u{1b}[31m\u{202e}.dosm");
    fs::write(&evil, "nonsense").expect("it can be written");
    assert_printable(&run(&["check", path(&evil)]));
    assert_printable(&run(&["check", "no\u{1b}[2Jfile"]));
    assert_printable(&run(&["verify", path(&evil), REACH]));
}

#[test]
fn a_reader_that_goes_away_is_no_accident() {
    for args in [&["--help"][..], &["check", REACH, "--json"], &["check", WRONG]] {
        let mut command = dosmc();
        let mut child =
            command.args(args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("it ends");
        assert!(!String::from_utf8_lossy(&output.stderr).contains("panicked"), "{args:?}");
        assert!(status(&output) <= 5, "{args:?}");
    }
}

/// What a directory of results may look like at any moment: no plan, or a whole one with its picture.
fn assert_whole(out: &Path) {
    let plan = out.join("plan.json");
    if plan.exists() {
        let text = fs::read_to_string(&plan).expect("it is there");
        serde_json::from_str::<Value>(&text).expect("a whole plan");
        assert!(fs::read_to_string(out.join("plan.svg")).expect("the picture").ends_with("</svg>\n"));
        let library = fs::read_to_string(out.join("controller/src/lib.rs")).expect("the controller");
        assert!(library.contains(&dosmc::source::sha256(&text)), "the controller is of another plan");
        for file in
            ["Cargo.toml", "README.md", "src/law.rs", "src/dynamics.rs", "src/robots.rs", "src/links.rs"]
        {
            let text = fs::read_to_string(out.join("controller").join(file)).expect("the controller");
            assert!(text.ends_with('\n'), "{file} is cut off");
        }
    }
}

/// What is in a directory, sorted.
fn names(directory: &Path) -> Vec<String> {
    let entries = fs::read_dir(directory).expect("it is there");
    let name =
        |e: std::io::Result<fs::DirEntry>| e.expect("an entry").file_name().to_string_lossy().into_owned();
    let mut names: Vec<String> = entries.map(name).collect();
    names.sort();
    names
}

#[test]
fn killed_at_any_moment_no_half_file_stays() {
    const POINTS: u32 = 200;
    let started = Instant::now();
    let (_keep, out, _) = solved(REACH, &[]);
    let whole = started.elapsed();
    assert_whole(&out);
    for point in 0..POINTS {
        let dir = temporary();
        let out = dir.path().join("out");
        let mut command = dosmc();
        command.args(["solve", REACH, "-o", path(&out)]).stdout(Stdio::null()).stderr(Stdio::null());
        let mut child = command.spawn().expect("it starts");
        std::thread::sleep(whole * point / POINTS);
        // It may have ended by itself.
        let _ = child.kill();
        child.wait().expect("it ends");
        assert_whole(&out);
    }
}

#[cfg(unix)]
#[test]
fn a_full_disk_leaves_the_old_plan() {
    let (_keep, out, _) = solved(REACH, &[]);
    let before = fs::read(out.join("plan.json")).expect("a plan");
    // No file may grow beyond a block or two, as on a disk that is full.
    let limited = "trap '' XFSZ; ulimit -f 1; exec \"$@\"";
    let program = env!("CARGO_BIN_EXE_dosmc");
    let mut command = Command::new("sh");
    command.args(["-c", limited, "sh", program, "solve", REACH, "-o", path(&out)]).current_dir(root());
    let output = command.output().expect("a shell");
    assert_eq!(status(&output), 1, "{output:?}");
    assert!(String::from_utf8_lossy(&output.stderr).contains("dosm::cli::unwritable"));
    assert_eq!(fs::read(out.join("plan.json")).expect("a plan"), before);
    assert_eq!(names(&out), ["controller", "plan.json", "plan.svg"], "no temporary file stays");
}

#[test]
fn a_place_that_is_taken_leaves_the_old_plan() {
    let (_keep, out, _) = solved(REACH, &[]);
    let before = fs::read(out.join("plan.json")).expect("a plan");
    // A directory in the place of the picture can't be replaced by a file.
    fs::remove_file(out.join("plan.svg")).expect("it is there");
    fs::create_dir(out.join("plan.svg")).expect("it can be made");
    let output = run(&["solve", REACH, "-o", path(&out)]);
    assert_eq!(status(&output), 1);
    assert_eq!(fs::read(out.join("plan.json")).expect("a plan"), before);
    assert_eq!(names(&out), ["controller", "plan.json", "plan.svg"], "no temporary file stays");
}

#[test]
fn the_time_limit_is_kept() {
    let started = Instant::now();
    let (_keep, out, output) = solved(ENDLESS, &["--horizon", "1..5000", "--timeout", "1500ms", "--json"]);
    assert_eq!(status(&output), 4);
    assert!(started.elapsed() < Duration::from_secs(4), "{:?}", started.elapsed());
    let value = json(&output);
    assert_eq!(value["reason"], "timeout");
    assert!(value["reached"].as_u64() > Some(0));
    let stats = &value["stats"];
    for key in ["half_spaces", "bool_vars", "clauses", "sat_calls", "convex_calls", "candidates", "lemmas"] {
        assert!(stats[key].as_u64() > Some(0), "{key} is lost: {stats}");
    }
    assert!(stats["conflicts"]["r"].as_u64() > Some(0), "{stats}");
    assert!(!out.exists());
    // Standard error is no terminal: no progress line, not even of a long search.
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}

#[test]
fn verbose_lists_the_phases() {
    let phases = |output: &Output| -> Vec<String> {
        let text = String::from_utf8(output.stderr.clone()).expect("UTF-8");
        let table = text.lines().take_while(|l| !l.is_empty());
        table.map(|l| l.chars().take(12).collect::<String>().trim_end().to_owned()).collect()
    };
    let (before, after) = (["phase", "read", "check", "tubes"], ["files", "other", "total"]);
    let search = ["geometry", "encoding", "SAT", "convex", "exact check"];
    for mission in [REACH, UNSAT] {
        let (_keep, _, output) = solved(mission, &["-v"]);
        assert_eq!(phases(&output), [&before[..], &search, &after].concat(), "{output:?}");
        assert!(!String::from_utf8_lossy(&output.stdout).contains("phase"));
    }
    let (_keep, out, _) = solved(REACH, &[]);
    let output = run(&["verify", path(&out.join("plan.json")), REACH, "-v"]);
    assert_eq!(phases(&output), ["phase", "read", "check", "exact check", "other", "total"]);
    let dir = temporary();
    let output = run(&["compile", REACH, "-o", path(dir.path()), "-v"]);
    assert_eq!(phases(&output), [before.as_slice(), &after].concat());
    assert_eq!(String::from_utf8_lossy(&solved(REACH, &[]).2.stderr), "");
}

#[test]
fn verbose_says_which_rejection_was_chosen_and_why() {
    let mission = |bounds: &str| {
        format!(
            "dosm 1\nworkspace box (0, 0) .. (20, 20)\nbase b at (1, 1)\ndynamics Rover {{ step 0.5 s \
             integrator 2 {bounds} disturbance px, py in [-0.1, 0.1] }}\nrobot r: Rover at (5, 5)\n"
        )
    };
    let dir = temporary();
    let said = |bounds: &str| {
        let file = dir.path().join("mission.dosm");
        std::fs::write(&file, mission(bounds)).expect("it can be written");
        let output = run(&["check", path(&file), "-v"]);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        String::from_utf8(output.stderr).expect("UTF-8")
    };
    let strong = said("bound ax, ay in [-4, 4]");
    assert!(strong.starts_with("rejection  Rover  0.3  chosen: the smallest that is tried"), "{strong}");
    let asked = said("bound ax, ay in [-4, 4] rejection 0.45");
    assert_eq!(asked, "rejection  Rover  0.45  as the mission says\n");
    let weak = said("bound ax, ay in [-0.36, 0.36] disturbance vx, vy in [-0.1, 0.1]");
    assert!(weak.starts_with("rejection  Rover  0.9  chosen: 0.7 is not enough"), "{weak}");
    let between = said("bound ax, ay in [-1, 1]");
    assert!(between.contains("chosen: with 0.5 the tube would be 1."), "{between}");
    assert_eq!(String::from_utf8_lossy(&run(&["check", REACH]).stderr), "");
}

/// `script` gives the command a terminal.
#[cfg(target_os = "linux")]
#[test]
fn a_terminal_gets_a_progress_line_that_goes_away() {
    if Command::new("script").arg("--version").output().is_err() {
        return common::skipped("`script` is not installed, so nothing was shown on a terminal");
    }
    let on_terminal = |more: &str| {
        let dir = temporary();
        let program = env!("CARGO_BIN_EXE_dosmc");
        let command = format!(
            "{program} solve {ENDLESS} -o {} --horizon 1..5000 --timeout 1500ms {more}",
            path(dir.path())
        );
        let mut script = Command::new("script");
        script.args(["-qec", &command, "/dev/null"]).current_dir(root()).env("TERM", "xterm");
        let output = script.stdin(Stdio::null()).output().expect("script is there");
        assert_eq!(status(&output), 4);
        String::from_utf8(output.stdout).expect("UTF-8")
    };
    // Taking a line away ends with an order to the terminal.
    let text = on_terminal("").replace("\u{1b}[2K", "");
    let (line, answer) =
        text.rsplit_once('\r').map_or(("", ""), |(rest, _)| rest.rsplit_once('\r').expect("lines"));
    assert!(
        line.contains("s · length ") && line.contains(" candidates · ") && line.contains(" refused "),
        "{text:?}"
    );
    assert!(answer.starts_with("unknown: time ran out at length "), "{text:?}");
    let drawn = text.split('\r').filter(|l| l.contains("· length")).map(|l| l.chars().count());
    assert!(drawn.max().is_some_and(|widest| widest <= 80), "{text:?}");
    assert!(!on_terminal("--quiet").contains('·'));
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_the_search_within_a_second() {
    for signal in ["-INT", "-TERM"] {
        let dir = temporary();
        let out = dir.path().join("out");
        let mut command = dosmc();
        let child = command
            .args(["solve", ENDLESS, "-o", path(&out), "--horizon", "1..5000"])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("it starts");
        std::thread::sleep(Duration::from_millis(1000));
        let started = Instant::now();
        Command::new("kill").args([signal, &child.id().to_string()]).status().expect("kill is there");
        let output = child.wait_with_output().expect("it ends");
        assert!(started.elapsed() < Duration::from_secs(2), "{:?}", started.elapsed());
        assert_eq!(status(&output), 4);
        assert!(String::from_utf8_lossy(&output.stdout).starts_with("unknown: interrupted at length"));
        assert!(!out.exists());
    }
}
