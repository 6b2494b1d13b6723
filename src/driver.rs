//! The chain from text to plan, as the picture in the crate's documentation shows it.
//!
//! Nothing here reads a file, looks at the clock or prints.

use crate::abstraction;
use crate::check;
use crate::diag::{Diagnostic, Diagnostics, Reported};
use crate::ir::{self, Problem, Spans, Violation};
use crate::lower;
use crate::plan::Plan;
use crate::source::{SourceFile, Span};
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
    ir::validate(&problem).map_err(|violations| diagnostics.report(invalid(&violations)))?;
    Ok((problem, spans))
}

/// What is said when an earlier phase has let something through that later ones rely on: a bug, but
/// no reason to go on with it.
fn invalid(violations: &[Violation]) -> Diagnostic {
    let all: Vec<String> = violations.iter().map(Violation::to_string).collect();
    Diagnostic::error("dosm::ir::invalid", format!("internal error: {}", all.join("; ")), Span::default(), "")
        .with_help("this is a bug in dosmc, not in your mission: please report it with the mission")
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
    abstraction::inspect(&problem, &spans, &tubes, diagnostics)?;
    Ok(Mission { problem, spans, tubes })
}

/// Checks a plan against a problem, in exact arithmetic.
pub fn verify(problem: &Problem, plan: &Plan) -> Report {
    verify::verify(problem, plan)
}
