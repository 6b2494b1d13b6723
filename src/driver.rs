//! The chain from text to plan, as the picture in the crate's documentation shows it.
//!
//! Nothing here reads a file, looks at the clock or prints.

use crate::check;
use crate::diag::{Diagnostics, Reported};
use crate::ir::{Problem, Spans};
use crate::lower;
use crate::plan::Plan;
use crate::source::SourceFile;
use crate::syntax;
use crate::tube::{self, Tubes};
use crate::verify::{self, Report};

/// What the command line says about a mission besides its text.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// Values for parameters, as written.
    pub set: Vec<(String, String)>,
    /// The lengths to try instead of the mission's.
    pub horizon: Option<(usize, usize)>,
}

/// A mission without errors, ready to be planned.
#[derive(Clone, Debug)]
pub struct Mission {
    /// What it means.
    pub problem: Problem,
    /// Where its parts stand in the source.
    pub spans: Spans,
    /// A tube for each model.
    pub tubes: Tubes,
}

/// Reads a mission: text to problem.
///
/// # Errors
/// [`Reported`] when the mission has errors.
pub fn problem(
    source: &SourceFile,
    overrides: &Overrides,
    diagnostics: &mut Diagnostics,
) -> Result<(Problem, Spans), Reported> {
    let file = syntax::parse(source, diagnostics)?;
    let typed = check::check(&file, source, &overrides.set, diagnostics)?;
    let (mut problem, spans) = lower::lower(&typed);
    problem.horizon = overrides.horizon.unwrap_or(problem.horizon);
    diagnostics.or_reported()?;
    Ok((problem, spans))
}

/// Reads a mission and looks for everything that is wrong with it, short of a search.
///
/// # Errors
/// [`Reported`] when the mission has errors.
pub fn load(
    source: &SourceFile,
    overrides: &Overrides,
    diagnostics: &mut Diagnostics,
) -> Result<Mission, Reported> {
    let (problem, spans) = problem(source, overrides, diagnostics)?;
    let tubes = tube::synthesize(&problem, &spans, diagnostics)?;
    diagnostics.or_reported()?;
    Ok(Mission { problem, spans, tubes })
}

/// Checks a plan against a problem, in exact arithmetic.
pub fn verify(problem: &Problem, plan: &Plan) -> Report {
    verify::verify(problem, plan)
}
