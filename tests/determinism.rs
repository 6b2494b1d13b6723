//! The same mission gives the same bytes: again, and with any number of threads.

#![allow(clippy::disallowed_methods, reason = "runs the command and looks at its files")]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

/// What a command wrote: each file's bytes by name.
type Files = BTreeMap<String, Vec<u8>>;

/// Missions small enough to be planned often: links and jammers, separation and counting, winds.
const PLANNED: [&str; 3] = ["examples/patrol.dosm", "examples/relay.dosm", "examples/wind.dosm"];
/// What only has to be written may be larger.
const COMPILED: [&str; 3] = ["examples/first.dosm", "examples/relay.dosm", "examples/hops.dosm"];

/// All that a command writes into a fresh directory.
fn written(args: &[&str]) -> Files {
    let dir = tempfile::tempdir().expect("a directory");
    let mut command = Command::new(env!("CARGO_BIN_EXE_dosmc"));
    command.current_dir(env!("CARGO_MANIFEST_DIR")).args(args).arg("-o").arg(dir.path());
    let output = command.output().expect("the command starts");
    assert_eq!(output.status.code(), Some(0), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    files(dir.path(), "")
}

fn files(directory: &Path, prefix: &str) -> Files {
    let mut found = Files::new();
    for entry in fs::read_dir(directory).expect("it was written") {
        let path = entry.expect("an entry").path();
        let name = format!("{prefix}{}", path.file_name().expect("a name").to_string_lossy());
        if path.is_dir() {
            found.extend(files(&path, &format!("{name}/")));
        } else {
            found.insert(name, fs::read(&path).expect("a file"));
        }
    }
    found
}

/// Runs a command four times and compares every file byte for byte.
fn assert_same(args: &[&str]) {
    let first = written(args);
    assert!(!first.is_empty(), "{args:?} writes nothing");
    for more in [&[][..], &["--threads", "1"], &["--threads", "2"]] {
        let again = written(&[args, more].concat());
        let names = |files: &Files| files.keys().cloned().collect::<Vec<_>>();
        assert_eq!(names(&first), names(&again), "{args:?} {more:?}");
        for (name, bytes) in &first {
            assert!(again[name] == *bytes, "{args:?} {more:?}: {name} differs");
        }
    }
}

#[test]
fn plans_are_the_same_bytes() {
    PLANNED.iter().for_each(|mission| assert_same(&["solve", mission]));
}

#[test]
fn every_format_is_the_same_bytes() {
    for mission in COMPILED {
        assert_same(&["compile", mission]);
        assert_same(&["compile", mission, "--length", "5"]);
    }
}
