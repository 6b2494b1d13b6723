//! `dosmc check`: diagnostics, and nothing else.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

use serde::Serialize;

use super::output::{Output, counted, giving_up};
use super::overseer::Overseer;
use super::stats::{JsonRejection, rejection_of};
use super::{Status, mission, phases};
use crate::diag::json::{JsonDiagnostic, to_json};
use crate::diag::{Diagnostic, Severity, printable};
use crate::driver::Overrides;
use crate::source::SourceFile;

/// What `check --json` prints.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct JsonCheck {
    /// `error` when a file is wrong or can't be read.
    #[cfg_attr(test, schemars(extend("enum" = ["ok", "error"])))]
    status: &'static str,
    /// How many errors there are in all files.
    errors: usize,
    /// How many warnings there are in all files.
    warnings: usize,
    /// The files, in the order of the command line.
    files: Vec<JsonFile>,
    /// Everything found in all files.
    diagnostics: Vec<JsonDiagnostic>,
}

/// What came of one file.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct JsonFile {
    /// Its name as given; `<stdin>` for standard input.
    file: String,
    /// `error` when it is wrong or can't be read.
    #[cfg_attr(test, schemars(extend("enum" = ["ok", "error"])))]
    status: &'static str,
}

/// A mission that was looked at.
struct Looked {
    source: SourceFile,
    diagnostics: Vec<Diagnostic>,
    status: Status,
    /// By model: its share of the inputs for rejection; of missions without errors.
    rejection: BTreeMap<String, JsonRejection>,
}

/// Checks all missions; the worst status is the command's.
pub fn check(
    missions: &[PathBuf],
    overrides: &Overrides,
    timeout: Option<Duration>,
    output: &Output,
) -> Status {
    if missions.iter().filter(|m| m.as_path() == Path::new("-")).count() > 1 {
        return output.fail(super::usage("standard input can be read only once, but `-` stands there twice"));
    }
    let overseer = Overseer::start(timeout, !output.quiet, giving_up(output.clone()));
    overseer.enter("checking");
    let all: Vec<Looked> = missions.iter().map(|path| look(path, overrides)).collect();
    overseer.close();
    for one in &all {
        output.diagnostics(&one.source, &one.diagnostics);
        if output.verbose > 0 && one.status == Status::Done {
            output.note(&tubes(one, all.len() > 1));
        }
    }
    let said = output.say(&summary(&all)).and_then(|()| output.json(&json(&all)));
    // An unreadable file weighs more than a wrong one: the command could not do its work.
    let worst = [Status::Usage, Status::Mission].into_iter().find(|s| all.iter().any(|one| one.status == *s));
    said.err().or(worst).unwrap_or(Status::Done)
}

fn look(path: &Path, overrides: &Overrides) -> Looked {
    match mission::open(path) {
        Err(unopened) => {
            let mission::Unopened { source, problem, status } = *unopened;
            Looked { source, diagnostics: vec![problem], status, rejection: BTreeMap::new() }
        }
        Ok(source) => {
            let (loaded, diagnostics) = mission::load(&source, overrides);
            let status = if loaded.is_some() { Status::Done } else { Status::Mission };
            let rejection = loaded.as_ref().map(rejection_of).unwrap_or_default();
            Looked { source, diagnostics, status, rejection }
        }
    }
}

/// How much of the inputs each model's feedback has, and why.
fn tubes(one: &Looked, named: bool) -> String {
    let name = named.then(|| format!("{}:", printable(&one.source.name)));
    name.into_iter().chain(phases::rejection(&one.rejection)).collect::<Vec<_>>().join("\n")
}

fn count(all: &[Looked], severity: Severity) -> usize {
    all.iter().flat_map(|one| &one.diagnostics).filter(|d| d.severity == severity).count()
}

fn summary(all: &[Looked]) -> String {
    let (errors, warnings) = (count(all, Severity::Error), count(all, Severity::Warning));
    let missions = counted(all.len(), "mission");
    let warned = if warnings > 0 { format!(", {}", counted(warnings, "warning")) } else { String::new() };
    if errors > 0 {
        format!("{missions}: {}{warned}", counted(errors, "error"))
    } else {
        format!("{missions}: no errors{warned}")
    }
}

fn json(all: &[Looked]) -> JsonCheck {
    let status = |ok: bool| if ok { "ok" } else { "error" };
    JsonCheck {
        status: status(all.iter().all(|one| one.status == Status::Done)),
        errors: count(all, Severity::Error),
        warnings: count(all, Severity::Warning),
        files: all
            .iter()
            .map(|one| JsonFile { file: one.source.name.clone(), status: status(one.status == Status::Done) })
            .collect(),
        diagnostics: all.iter().flat_map(|one| to_json(&one.source, &one.diagnostics)).collect(),
    }
}
