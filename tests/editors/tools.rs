//! Other people's programs: whether they are there, and what they say.

use std::ffi::OsStr;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use crate::common::{package, skipped};

/// The first of some programs that is in `PATH`; says loudly what is skipped when none is.
pub fn tool(names: &[&str], what: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let directories: Vec<PathBuf> = std::env::split_paths(&path).collect();
    let places = names.iter().flat_map(|name| directories.iter().map(move |dir| dir.join(name)));
    let found = places.into_iter().find(|place| place.is_file());
    if found.is_none() {
        skipped(&format!("{what} was not run: no `{}`", names.join("` or `")));
    }
    found
}

/// A program in the root of the package, without input.
pub fn command(program: impl AsRef<OsStr>) -> Command {
    let mut command = Command::new(program);
    command.current_dir(package("")).stdin(Stdio::null());
    command
}

/// What a command prints; it has to succeed.
#[track_caller]
pub fn output(command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|e| panic!("{command:?}: {e}"));
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    let complaints = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {}\n{printed}\n{complaints}", output.status);
    printed
}
