//! What README.md shows is what the program does.

#![allow(clippy::disallowed_methods, reason = "runs the command on what the README says")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn readme() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")).expect("a README")
}

/// The fenced blocks of a language, in order.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let opening = format!("\n```{language}\n");
    text.split(&opening).skip(1).map(|rest| rest.split("```").next().unwrap_or_default()).collect()
}

fn run(directory: &Path, args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dosmc"));
    command.current_dir(directory).args(args).output().expect("it runs")
}

#[test]
fn the_first_command_says_what_it_is_said_to_say() {
    let text = readme();
    let command = blocks(&text, "sh")[0].trim();
    let args: Vec<&str> = command.split_whitespace().skip_while(|word| *word != "--").skip(1).collect();
    assert_eq!(args[0], "solve", "{command}");
    let directory = tempfile::tempdir().expect("a directory");
    let mission = Path::new(env!("CARGO_MANIFEST_DIR")).join(args[1]);
    let output = run(directory.path(), &["solve", mission.to_str().expect("a plain path"), "-o", "out"]);
    assert_eq!(String::from_utf8_lossy(&output.stdout), blocks(&text, "text")[0]);
}

#[test]
fn the_mission_and_its_mistake_are_what_they_are_said_to_be() {
    let text = readme();
    let mission = blocks(&text, "dosm")[0];
    let directory = tempfile::tempdir().expect("a directory");
    let checked = |mission: &str| {
        fs::write(directory.path().join("relay.dosm"), mission).expect("it can be written");
        run(directory.path(), &["check", "relay.dosm"])
    };
    let right = checked(mission);
    assert_eq!(right.status.code(), Some(0), "{}", String::from_utf8_lossy(&right.stderr));
    let wrong = checked(&mission.replace("scout: Rover at (2, 2)", "scout: Rover at (4.4, 2)"));
    let shown = String::from_utf8_lossy(&wrong.stderr);
    let expected = blocks(&text, "text")[1];
    let drawn = expected.split("1 mission").next().expect("a text");
    assert!(shown.contains(drawn.trim_end()), "{shown}");
    assert!(shown.trim_end().ends_with(expected.lines().last().expect("a line")), "{shown}");
}
