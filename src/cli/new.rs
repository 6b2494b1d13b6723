//! `dosmc new`: a starter mission.

use std::path::PathBuf;

use serde::Serialize;

use super::output::{Output, plain_error};
use super::{Status, files};
use crate::diag::{Diagnostics, printable};
use crate::driver::{self, Overrides};
use crate::source::SourceFile;

/// The starter mission; `NAME` stands for the mission's name.
const STARTER: &str = include_str!("starter.dosm");
/// The longest identifier (language.md §2).
const LONGEST_NAME: usize = 64;

/// What `new --json` prints.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct JsonNew {
    /// Always `written`.
    #[cfg_attr(test, schemars(extend("enum" = ["written"])))]
    status: &'static str,
    /// The mission's path.
    file: PathBuf,
}

/// Writes the starter mission under a new name.
pub fn new(name: &str, output: &Output) -> Status {
    let text = STARTER.replace("NAME", name);
    // Words of the language look like names; the parser knows them.
    let readable = || {
        driver::problem(&SourceFile::new("", text.as_str()), &Overrides::default(), &mut Diagnostics::new())
    };
    if !is_name(name) || readable().is_err() {
        let message = format!("`{}` is no name for a mission", printable(name));
        let help =
            "a name is made of letters, digits and `_`, starts with no digit, and has at most 64 of them";
        return output.fail(plain_error("dosm::cli::bad_name", message).with_help(help));
    }
    let path = PathBuf::from(format!("{name}.dosm"));
    if let Err(problem) = files::create(&path, &text) {
        return output.fail(problem);
    }
    let file = path.display();
    let said = output.say(&format!("{file} is written; plan it with:\n  dosmc solve {file} -o out"));
    let said = said.and_then(|()| output.json(&JsonNew { status: "written", file: path.clone() }));
    said.err().unwrap_or(Status::Done)
}

/// Whether a text is an identifier.
fn is_name(text: &str) -> bool {
    let start = |c: char| c.is_ascii_alphabetic() || c == '_';
    text.len() <= LONGEST_NAME
        && text.starts_with(start)
        && text.chars().all(|c| start(c) || c.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::is_name;

    #[test]
    fn names_are_identifiers() {
        assert!(["a", "_", "Relay_2", &"x".repeat(64)].iter().all(|n| is_name(n)));
        assert!(
            ["", "2a", "a-b", "../a", "a/b", "Ω", "a b", "a.dosm", &"x".repeat(65)]
                .iter()
                .all(|n| !is_name(n))
        );
    }
}
