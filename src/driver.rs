//! The chain from text to plan, as the picture in the crate's documentation shows it.
//!
//! Nothing here reads a file, looks at the clock or prints.

mod files;

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::sync::Arc;
use std::time::Duration;

use serde::Serialize;

use crate::abstraction::{self, Abstraction, Fineness, Partition};
use crate::back::{Artifact, controller};
use crate::check;
use crate::diag::{Diagnostic, Diagnostics, Reported};
use crate::ir::{self, Problem, Spans, Violation};
use crate::law::{Float, Misfit};
use crate::lower;
use crate::plan::{self, Nominal, Plan};
use crate::solve::{self, Outcome, Phase, Reason, Statistics, Watch};
use crate::source::{SourceFile, Span};
use crate::syntax;
use crate::tube::{self, Tubes};
use crate::verify::{self, Report};

pub use crate::abstraction::TooFine;
pub use crate::encode::TooLarge;
pub use files::{NotWritten, Reopened, compile, is_instance_of, reopen};

/// What the command line says about a mission besides its text.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// Values for parameters, as written.
    pub set: Vec<(String, String)>,
    /// The lengths to try instead of the mission's.
    pub horizon: Option<(usize, usize)>,
    /// What the robots' controllers compute with: the tubes have room for its rounding.
    pub float: Float,
}

/// What the Boolean part of a search speaks of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub enum Encoding {
    /// Half-spaces, added where a candidate needs them.
    #[default]
    HalfSpaces,
    /// The cells of a partition, as the paper has it.
    Paper,
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
    meaning(&file, source, overrides, diagnostics)
}

/// Finds out what a mission that was parsed means: tree to problem.
///
/// # Errors
/// [`Reported`] when the mission has errors.
pub fn meaning(
    file: &syntax::ast::File,
    source: &SourceFile,
    overrides: &Overrides,
    diagnostics: &mut Diagnostics,
) -> Result<(Problem, Spans), Reported> {
    let typed = check::check(file, source, &overrides.set, diagnostics)?;
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
    prepare(problem, spans, overrides.float, diagnostics)
}

/// Makes the tubes of a problem, with room for the rounding of controllers in a float type, and looks
/// at its first step.
///
/// # Errors
/// [`Reported`] when a model has no tube, or the mission is lost at its first step.
pub fn prepare(
    problem: Problem,
    spans: Spans,
    float: Float,
    diagnostics: &mut Diagnostics,
) -> Result<Mission, Reported> {
    let tubes = tube::synthesize(&problem, &spans, float, diagnostics)?;
    abstraction::inspect(&problem, &spans, &tubes, diagnostics)?;
    Ok(Mission { problem, spans, tubes })
}

/// How a search for a plan that checks ended.
#[derive(Clone, Debug)]
pub enum Answer {
    /// With a plan that the exact check has accepted.
    Plan {
        /// The plan.
        plan: Box<Plan>,
        /// Whether all shorter lengths of the horizon are refuted.
        shortest: bool,
    },
    /// Without one, in this scope.
    NoPlan(Scope),
    /// Without an answer.
    Unknown(Reason),
    /// With a plan that the exact check refuses, however wide the margins.
    Refused(Box<Report>),
}

/// What 'no plan' holds for.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Scope {
    /// By model: the share of the inputs that the feedback was allowed.
    pub beta: BTreeMap<String, f64>,
    /// By model: the tube's half-widths along the coordinates, in metres.
    pub half_widths: BTreeMap<String, Vec<f64>>,
    /// How many directions separating planes could have.
    pub directions: usize,
    /// How many cells robots could be in; 0 where nothing was cut into cells.
    pub cells: usize,
}

/// An answer with the costs of finding it.
#[derive(Clone, Debug)]
pub struct Solved {
    /// The answer.
    pub answer: Answer,
    /// The search's own counts and times.
    pub statistics: Statistics,
    /// Time spent in the exact check.
    pub time_verify: Duration,
    /// What was searched.
    pub encoding: Encoding,
    /// How many cells the partition has; 0 without one.
    pub cells: usize,
    /// The outlines of the first robot's cells in the plane, to be drawn.
    pub outlines: Vec<Vec<[f64; 2]>>,
}

/// How much wider the margins are at each attempt, when the exact check refuses a plan.
const BACKOFFS: [f64; 3] = [1.0, 10.0, 100.0];

/// Looks for the shortest plan, and gives none out that the exact check has not accepted.
pub fn solve(mission: &Mission, watch: &Arc<dyn Watch>) -> Solved {
    let search = |backoff| Ok(Abstraction::new(&mission.problem, &mission.tubes, backoff));
    let Ok(solved): Result<Solved, Infallible> = search_with(mission, watch, Encoding::HalfSpaces, &search);
    solved
}

/// As [`solve`], with a choice of what the Boolean part speaks of.
///
/// Cells are coarse at first; where there is no plan over them, they are cut once more.
///
/// # Errors
/// [`TooFine`] when the paper's partition would have too many cells.
pub fn solve_with(mission: &Mission, encoding: Encoding, watch: &Arc<dyn Watch>) -> Result<Solved, TooFine> {
    if encoding == Encoding::HalfSpaces {
        return Ok(solve(mission, watch));
    }
    let Mission { problem, tubes, .. } = mission;
    let search = |fineness| {
        let cells = |backoff| Abstraction::new(problem, tubes, backoff).with_cells(problem, fineness);
        search_with(mission, watch, encoding, &cells)
    };
    let coarse = search(Fineness::Coarse)?;
    let may_be_finer = problem.dimension == 2 && !problem.blockers.is_empty();
    if !(may_be_finer && matches!(coarse.answer, Answer::NoPlan(_))) {
        return Ok(coarse);
    }
    // Cells that would be too many leave the answer as it is, for the cells that there were.
    let Ok(mut fine) = search(Fineness::Fine) else { return Ok(coarse) };
    fine.statistics.add_work(&coarse.statistics);
    Ok(fine)
}

fn search_with<E>(
    mission: &Mission,
    watch: &Arc<dyn Watch>,
    encoding: Encoding,
    abstract_: &dyn Fn(f64) -> Result<Abstraction, E>,
) -> Result<Solved, E> {
    let mut refused = None;
    let mut solved = Solved {
        answer: Answer::Unknown(Reason::Numerics),
        statistics: Statistics::default(),
        time_verify: Duration::ZERO,
        encoding,
        cells: 0,
        outlines: Vec::new(),
    };
    for backoff in BACKOFFS {
        watch.enter(Phase::Geometry);
        let started = watch.now();
        let abstraction = abstract_(backoff)?;
        let time_abstraction = watch.now().saturating_sub(started);
        solved.cells = cells(&abstraction);
        solved.outlines = outlines(&mission.problem, &abstraction);
        let (attempt, statistics) = attempt(mission, watch, &abstraction, &mut solved.time_verify);
        solved.statistics = statistics;
        solved.statistics.time_geometry += time_abstraction;
        let answer = match attempt {
            Attempt::Refused(report) => {
                refused = report.or(refused);
                continue;
            }
            // With wider margins a length may be lost: this proves nothing about the mission.
            Attempt::Answer(Answer::NoPlan(_)) if backoff > BACKOFFS[0] => break,
            Attempt::Answer(answer) => answer,
        };
        return Ok(Solved { answer, ..solved });
    }
    if let Some(report) = refused {
        solved.answer = Answer::Refused(report);
    }
    Ok(solved)
}

/// One search and what the exact check says of it.
enum Attempt {
    Answer(Answer),
    /// The plan found does not check, or its witnesses could not be found again.
    Refused(Option<Box<Report>>),
}

fn attempt(
    mission: &Mission,
    watch: &Arc<dyn Watch>,
    abstraction: &Abstraction,
    time_verify: &mut Duration,
) -> (Attempt, Statistics) {
    let Mission { problem, tubes, .. } = mission;
    let options = solve::Options { horizon: problem.horizon, watch: Arc::clone(watch) };
    let (outcome, statistics) = solve::solve(problem, tubes, abstraction, &options);
    let attempt = match outcome {
        Outcome::NoPlan => Attempt::Answer(Answer::NoPlan(scope(mission, abstraction))),
        Outcome::Unknown(reason) => Attempt::Answer(Answer::Unknown(reason)),
        Outcome::Plan(nominal) => {
            watch.enter(Phase::ExactCheck);
            let started = watch.now();
            let attempt = proved(mission, abstraction, &nominal);
            *time_verify += watch.now().saturating_sub(started);
            attempt
        }
    };
    (attempt, statistics)
}

/// A nominal plan with its witnesses, if the exact check accepts it.
fn proved(mission: &Mission, abstraction: &Abstraction, nominal: &Nominal) -> Attempt {
    let Some(plan) = plan::extract(&mission.problem, &mission.tubes, abstraction, nominal) else {
        return Attempt::Refused(None);
    };
    let report = verify::verify(&mission.problem, &plan);
    if report.holds() {
        Attempt::Answer(Answer::Plan { plan: Box::new(plan), shortest: nominal.shortest })
    } else {
        Attempt::Refused(Some(Box::new(report)))
    }
}

fn scope(mission: &Mission, abstraction: &Abstraction) -> Scope {
    let models = || mission.problem.models.values().zip(mission.tubes.values());
    Scope {
        beta: models().map(|(m, t)| (m.name.clone(), t.beta)).collect(),
        half_widths: models()
            .map(|(m, t)| (m.name.clone(), m.position.iter().map(|&s| t.state_half_width(s)).collect()))
            .collect(),
        directions: abstraction.directions.len(),
        cells: cells(abstraction),
    }
}

fn cells(abstraction: &Abstraction) -> usize {
    abstraction.partition.as_ref().map_or(0, Partition::count)
}

/// The outlines of the cells that a search with the paper's encoding begins with, to be drawn.
///
/// # Errors
/// [`TooFine`] when there would be too many.
pub fn cells_of(problem: &Problem) -> Result<Vec<Vec<[f64; 2]>>, TooFine> {
    // Who has a plan that checks has tubes; without them there is nothing to draw.
    let Ok(tubes) = tube::synthesize(problem, &Spans::default(), Float::F64, &mut Diagnostics::new()) else {
        return Ok(Vec::new());
    };
    let abstraction = Abstraction::new(problem, &tubes, BACKOFFS[0]).with_cells(problem, Fineness::Coarse)?;
    Ok(outlines(problem, &abstraction))
}

fn outlines(problem: &Problem, abstraction: &Abstraction) -> Vec<Vec<[f64; 2]>> {
    let first = problem.robots.values().next().map(|robot| robot.model);
    let partition = abstraction.partition.as_ref();
    partition.zip(first).map_or_else(Vec::new, |(partition, model)| partition.outlines(model))
}

/// Checks a plan against a problem, in exact arithmetic.
pub fn verify(problem: &Problem, plan: &Plan) -> Report {
    verify::verify(problem, plan)
}

/// The controller of a plan that was checked against the problem.
///
/// # Errors
/// [`Misfit`] where the proof does not go through for controllers that compute with this type.
pub fn controller(problem: &Problem, plan: &Plan, float: Float) -> Result<Vec<Artifact>, Misfit> {
    controller::write(problem, plan, float)
}
