//! What `--help` teaches is true: every example runs, and every command has examples and statuses.

#![cfg(unix)]
#![allow(clippy::disallowed_methods, reason = "runs the command")]

mod common;

use std::path::Path;
use std::process::{Command, Output, Stdio};

const DOSMC: &str = env!("CARGO_BIN_EXE_dosmc");

/// The widest line; terminals are 100 columns where nothing is known of them.
const WIDEST: usize = 96;

fn help(command: &[&str]) -> String {
    let output = Command::new(DOSMC).args(command).arg("--help").output().expect("the command starts");
    assert!(output.status.success());
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// The commands, in the order in which they are listed.
fn commands() -> Vec<String> {
    let whole = help(&[]);
    let list = whole.split("Commands:\n").nth(1).and_then(|rest| rest.split("\n\n").next()).expect("a list");
    let names = list.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    names.filter_map(|line| line.split_whitespace().next()).map(str::to_string).collect()
}

/// What stands below the flags.
fn lesson(help: &str) -> &str {
    let after = help.rfind("--version").or_else(|| help.rfind("--help")).expect("the last flag");
    &help[after..]
}

/// The lines below `Examples:` or the like that are commands.
fn examples(help: &str) -> Vec<&str> {
    lesson(help)
        .lines()
        .filter_map(|line| line.strip_prefix("  "))
        .filter(|l| l.starts_with("dosmc "))
        .collect()
}

fn shell(line: &str, directory: &Path) -> Output {
    let programs = Path::new(DOSMC).parent().expect("it lies in a directory");
    let path = format!("{}:{}", programs.display(), std::env::var("PATH").unwrap_or_default());
    let mut command = Command::new("sh");
    command.args(["-e", "-c", line]).current_dir(directory).env("PATH", path).env("MANPAGER", "cat");
    command.stdin(Stdio::null()).output().expect("a shell")
}

#[test]
fn every_example_runs_from_the_repository_root() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut run = 0;
    let has_man = shell("command -v man", root).status.success();
    for command in std::iter::once(String::new()).chain(commands()) {
        // A copy of the root, as far as examples go, where they may write.
        let dir = tempfile::tempdir().expect("a directory");
        std::os::unix::fs::symlink(root.join("examples"), dir.path().join("examples")).expect("a link");
        let text = help(&if command.is_empty() { vec![] } else { vec![command.as_str()] });
        let examples = examples(&text);
        assert!(!examples.is_empty(), "`{command}` has no examples:\n{text}");
        for line in examples {
            if line.contains("man -") && !has_man {
                common::skipped(&format!("`man` is not installed, so `{line}` did not run"));
                continue;
            }
            let output = shell(line, dir.path());
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{line}: {said}");
            assert!(!said.contains("error"), "{line}: {said}");
            run += 1;
        }
    }
    assert!(run > 20, "only {run} examples were found");
}

#[test]
fn every_command_teaches_in_lines_that_fit() {
    for command in std::iter::once(String::new()).chain(commands()) {
        let text = help(&if command.is_empty() { vec![] } else { vec![command.as_str()] });
        let lesson = lesson(&text);
        assert!(lesson.contains("\nExit status:\n  0  "), "`{command}` does not say how it ends:\n{lesson}");
        let wide = lesson.lines().find(|line| line.chars().count() > WIDEST);
        assert_eq!(wide, None, "`{command}`: a line that a terminal breaks");
    }
}

#[test]
fn every_format_of_compile_is_explained() {
    let text = help(&["compile"]);
    let formats = text.split("[possible values: ").nth(1).and_then(|rest| rest.split(']').next());
    let formats: Vec<&str> = formats.expect("the formats").split(',').map(str::trim).collect();
    assert!(formats.contains(&"ir"), "{formats:?}");
    let told = |format: &&str| lesson(&text).lines().any(|l| l.starts_with(&format!("  {format} ")));
    let untold: Vec<&&str> = formats.iter().filter(|format| !told(format)).collect();
    assert!(untold.is_empty(), "`compile --help` says nothing of {untold:?}");
}
