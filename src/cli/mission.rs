//! Opening the missions that a command line names.

use std::path::Path;
use std::time::Instant;

use super::output::Output;
use super::overseer::Overseer;
use super::stats::Ledger;
use super::{Status, files};
use crate::diag::{Diagnostic, Diagnostics, Reported};
use crate::driver::{self, Mission, Overrides};
use crate::ir::Problem;
use crate::source::SourceFile;
use crate::syntax;

/// A mission that could not be opened.
pub struct Unopened {
    /// Its name, and as much of its text as could be read.
    pub source: SourceFile,
    /// Why.
    pub problem: Diagnostic,
    /// The command's status.
    pub status: Status,
}

/// Reads a mission's text.
///
/// # Errors
/// [`Unopened`] when the file can't be read (status 1) or is no text (status 2).
pub fn open(path: &Path) -> Result<SourceFile, Box<Unopened>> {
    let name = files::shown_name(path);
    let bytes = files::read(path).map_err(|problem| {
        let source = SourceFile::new(name.clone(), "");
        Box::new(Unopened { source, problem, status: Status::Usage })
    })?;
    match syntax::decode(&bytes) {
        Ok(text) => Ok(SourceFile::new(name, text)),
        Err(problem) => {
            // Up to the first wrong byte, which is where the problem is, both texts are the same.
            let text = String::from_utf8_lossy(&bytes).trim_start_matches('\u{feff}').to_string();
            Err(Box::new(Unopened { source: SourceFile::new(name, text), problem, status: Status::Mission }))
        }
    }
}

/// Loads a mission; its diagnostics are sorted by place.
pub fn load(source: &SourceFile, overrides: &Overrides) -> (Option<Mission>, Vec<Diagnostic>) {
    let mut diagnostics = Diagnostics::new();
    let loaded = driver::load(source, overrides, &mut diagnostics).ok();
    (loaded, sorted(&diagnostics))
}

/// Reads a mission's problem, and says what is wrong with it.
///
/// # Errors
/// The command's status when there is something wrong, which was said.
pub fn problem_or_fail(path: &Path, overrides: &Overrides, output: &Output) -> Result<Problem, Status> {
    let source = open_or_fail(path, output)?;
    let mut diagnostics = Diagnostics::new();
    let problem = driver::problem(&source, overrides, &mut diagnostics);
    told(problem, &source, &sorted(&diagnostics), output).map(|(problem, _)| problem)
}

/// Loads a mission step by step, notes what each took, and says what is wrong with it.
///
/// # Errors
/// The command's status when there is something wrong, which was said.
pub fn load_or_fail(
    path: &Path,
    overrides: &Overrides,
    overseer: &Overseer,
    ledger: &Ledger,
    output: &Output,
) -> Result<Mission, Status> {
    let started = Instant::now();
    let source = open_or_fail(path, output)?;
    let mut diagnostics = Diagnostics::new();
    let file = syntax::parse(&source, &mut diagnostics);
    ledger.note(|run| run.read(&source, started.elapsed()));
    let problem = file.and_then(|file| {
        let started = Instant::now();
        overseer.enter("checking");
        let problem = driver::meaning(&file, &source, overrides, &mut diagnostics);
        ledger.note(|run| run.time_check = started.elapsed());
        problem
    });
    let mission = problem.and_then(|(problem, spans)| {
        let started = Instant::now();
        overseer.name_robots(problem.robots.values().map(|r| r.name.clone()).collect());
        overseer.enter("making tubes");
        let mission = driver::prepare(problem, spans, &mut diagnostics);
        ledger.note(|run| run.time_tube = started.elapsed());
        mission
    });
    let mission = overseer.aside(|| told(mission, &source, &sorted(&diagnostics), output))?;
    ledger.note(|run| run.loaded(&mission));
    Ok(mission)
}

/// Reads a mission's text, and says why when that fails.
///
/// # Errors
/// The command's status when it can't be read, which was said.
pub fn open_or_fail(path: &Path, output: &Output) -> Result<SourceFile, Status> {
    open(path).map_err(|unopened| output.fail_in(&unopened.source, &[unopened.problem], unopened.status))
}

/// Says what was found; errors end the command.
fn told<T>(
    loaded: Result<T, Reported>,
    source: &SourceFile,
    diagnostics: &[Diagnostic],
    output: &Output,
) -> Result<T, Status> {
    loaded
        .inspect(|_| output.diagnostics(source, diagnostics))
        .map_err(|_| output.fail_in(source, diagnostics, Status::Mission))
}

fn sorted(diagnostics: &Diagnostics) -> Vec<Diagnostic> {
    diagnostics.sorted().into_iter().cloned().collect()
}
