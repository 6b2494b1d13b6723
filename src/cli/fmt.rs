//! `dosmc fmt`: missions in the one style.

use std::path::{Path, PathBuf};

use serde::Serialize;

use super::Status;
use super::files;
use super::mission::{self, Unopened};
use super::output::Output;
use crate::diag::{Diagnostic, Diagnostics, printable};
use crate::source::SourceFile;
use crate::syntax::format::{self, Formatted};

/// What `fmt --json` prints.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct JsonFmt {
    /// `done`, or `unformatted` with `--check` where a mission is not in the style.
    #[cfg_attr(test, schemars(extend("enum" = ["done", "unformatted"])))]
    status: &'static str,
    /// The missions that were changed, or would be with `--check`.
    changed: Vec<String>,
    /// With standard input: the formatted mission.
    #[serde(skip_serializing_if = "Option::is_none")]
    text: Option<String>,
}

/// Rewrites missions in the one style, or with `check` only says which are not in it.
pub fn fmt(paths: &[PathBuf], check: bool, output: &Output) -> Status {
    let (mut changed, mut text) = (Vec::new(), None);
    for path in paths {
        match one(path, check, output) {
            Ok(Outcome { name, differs, printed }) => {
                changed.extend(differs.then_some(name));
                text = text.or(printed);
            }
            Err(status) => return status,
        }
    }
    tell(changed, text, check, output).unwrap_or_else(|status| status)
}

/// What came of one mission.
struct Outcome {
    name: String,
    differs: bool,
    /// From standard input: the formatted text.
    printed: Option<String>,
}

fn one(path: &Path, check: bool, output: &Output) -> Result<Outcome, Status> {
    let (source, Formatted { text, .. }) = read(path, output)?;
    let (name, differs) = (source.name, source.text != text);
    if path == Path::new("-") {
        return Ok(Outcome { name, differs, printed: Some(text) });
    }
    if differs && !check {
        files::replace(path, text.as_bytes()).map_err(|problem| output.fail(problem))?;
    }
    Ok(Outcome { name, differs, printed: None })
}

/// A mission and the same in the style.
fn read(path: &Path, output: &Output) -> Result<(SourceFile, Formatted), Status> {
    let source = mission::open(path).map_err(|unopened| {
        let Unopened { source, problem, status } = *unopened;
        output.fail_in(&source, &[problem], status)
    })?;
    let mut diagnostics = Diagnostics::new();
    let Ok(formatted) = format::format(&source, &mut diagnostics) else {
        let all: Vec<Diagnostic> = diagnostics.sorted().into_iter().cloned().collect();
        return Err(output.fail_in(&source, &all, Status::Mission));
    };
    if formatted.left > 0 {
        let (name, left) = (printable(&source.name).into_owned(), formatted.left);
        let what = if left == 1 { "1 declaration" } else { &format!("{left} declarations") };
        output.note(&format!("warning: {name}: {what} with errors left as written; `dosmc check` has them"));
    }
    Ok((source, formatted))
}

fn tell(changed: Vec<String>, text: Option<String>, check: bool, output: &Output) -> Result<Status, Status> {
    let differs = check && !changed.is_empty();
    if check {
        for name in &changed {
            output.say(&format!("not in the style: {}", printable(name)))?;
        }
    } else if let Some(text) = &text {
        output.text(text)?;
    }
    let status = if differs { "unformatted" } else { "done" };
    output.json(&JsonFmt { status, changed, text: text.filter(|_| !check) })?;
    Ok(if differs { Status::Usage } else { Status::Done })
}
