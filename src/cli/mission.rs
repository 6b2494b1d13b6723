//! Opening the missions that a command line names.

use std::path::Path;
use std::time::Instant;

use super::output::Output;
use super::overseer::Overseer;
use super::stats::Ledger;
use super::{Status, files};
use crate::diag::{Diagnostic, Diagnostics, Reported};
use crate::driver::{self, Mission, Overrides};
use crate::ir::{Problem, Spans};
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

/// A command that opens a mission: what it goes by, where it notes what it took and says what is wrong.
#[derive(Clone, Copy)]
pub struct Opening<'a> {
    /// What the command line says about the mission.
    pub overrides: &'a Overrides,
    /// Hears what is being done.
    pub overseer: &'a Overseer,
    /// Hears how long it took.
    pub ledger: &'a Ledger,
    /// Where to say what is wrong.
    pub output: &'a Output,
}

impl Opening<'_> {
    /// Reads a mission's problem, and says what is wrong with it.
    ///
    /// # Errors
    /// The command's status when there is something wrong, which was said.
    pub fn problem(&self, path: &Path) -> Result<Problem, Status> {
        let source = self.open(path)?;
        let mut diagnostics = Diagnostics::new();
        let problem = self.meaning(&source, &mut diagnostics);
        self.told(problem, &source, &diagnostics).map(|(problem, _)| problem)
    }

    /// Loads a mission, tubes included, and says what is wrong with it.
    ///
    /// # Errors
    /// The command's status when there is something wrong, which was said.
    pub fn load(&self, source: &SourceFile) -> Result<Mission, Status> {
        let mut diagnostics = Diagnostics::new();
        let mission = self.meaning(source, &mut diagnostics).and_then(|(problem, spans)| {
            let started = Instant::now();
            self.overseer.name_robots(problem.robots.values().map(|r| r.name.clone()).collect());
            self.overseer.enter("making tubes");
            let mission = driver::prepare(problem, spans, self.overrides.float, &mut diagnostics);
            self.ledger.note(|run| run.time_tube = started.elapsed());
            mission
        });
        let mission = self.told(mission, source, &diagnostics)?;
        self.ledger.note(|run| run.has_tubes(&mission));
        Ok(mission)
    }

    /// Reads a mission's text, and says why when that fails.
    ///
    /// # Errors
    /// The command's status when it can't be read, which was said.
    pub fn open(&self, path: &Path) -> Result<SourceFile, Status> {
        let started = Instant::now();
        let opened = open(path).map_err(|unopened| {
            let Unopened { source, problem, status } = *unopened;
            self.overseer.aside(|| self.output.fail_in(&source, &[problem], status))
        })?;
        self.ledger.note(|run| run.read(&opened, started.elapsed()));
        Ok(opened)
    }

    /// Ends the command with an error that has no place in a mission.
    pub fn fail(&self, why: Diagnostic) -> Status {
        self.overseer.aside(|| self.output.fail(why))
    }

    fn meaning(
        &self,
        source: &SourceFile,
        diagnostics: &mut Diagnostics,
    ) -> Result<(Problem, Spans), Reported> {
        let started = Instant::now();
        let file = syntax::parse(source, diagnostics)?;
        self.ledger.note(|run| run.time_read += started.elapsed());
        let started = Instant::now();
        self.overseer.enter("checking");
        let meaning = driver::meaning(&file, source, self.overrides, diagnostics)?;
        self.ledger.note(|run| {
            run.time_check = started.elapsed();
            run.means(&meaning.0);
        });
        Ok(meaning)
    }

    /// Says what was found; errors end the command.
    fn told<T>(
        &self,
        loaded: Result<T, Reported>,
        source: &SourceFile,
        diagnostics: &Diagnostics,
    ) -> Result<T, Status> {
        let (all, output) = (sorted(diagnostics), self.output);
        self.overseer.aside(|| match loaded {
            Ok(loaded) => {
                output.diagnostics(source, &all);
                Ok(loaded)
            }
            Err(_) => Err(output.fail_in(source, &all, Status::Mission)),
        })
    }
}

fn sorted(diagnostics: &Diagnostics) -> Vec<Diagnostic> {
    diagnostics.sorted().into_iter().cloned().collect()
}
