//! The search: satisfiability modulo convex programming.
//!
//! A SAT solver proposes which half-spaces to use; small linear programs say whether trajectories
//! through them exist, or prove a contradiction that becomes a lemma; trajectories that do exist are
//! tested against what the Boolean part has left out so far, and what they violate is demanded. The
//! search ends with trajectories that violate nothing, with a refutation of every length, or with
//! *unknown*; the three are never mixed up.

mod clearance;
mod convex;
mod demands;
mod free;
mod lemma;
mod reach;
mod robots;
mod sat;
mod search;

use std::sync::Arc;
use std::time::Duration;

use crate::abstraction::Abstraction;

use crate::ir::Problem;
use crate::plan::Nominal;
use crate::tube::Tubes;

/// What may stop a search, and who hears how far it is.
pub trait Watch: Send + Sync {
    /// Whether to stop now.
    fn stop(&self) -> bool;
    /// Hears what is being done.
    fn enter(&self, _: Phase) {}
    /// Hears of progress.
    fn progress(&self, progress: &Progress);
    /// The time since some fixed moment, for statistics only.
    fn now(&self) -> Duration;
}

/// What is being done on the way to a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// The half-spaces of regions and blockers are made.
    Geometry,
    /// Lengths are tried.
    Search,
    /// A plan that was found is given its witnesses and checked.
    ExactCheck,
}

/// How far a search is: its counts and times so far.
pub type Progress = Statistics;

/// What a search may do.
#[derive(Clone)]
pub struct Options {
    /// The lengths to try, both ends included.
    pub horizon: (usize, usize),
    /// Stops and hears.
    pub watch: Arc<dyn Watch>,
}

/// Why a search ended without an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The watch stopped it.
    Stopped,
    /// Some length could not be decided numerically.
    Numerics,
}

/// How a search ended.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// With a plan, not yet proved.
    Plan(Box<Nominal>),
    /// Without one: every length is refuted, for the tubes, rejection shares and directions used.
    NoPlan,
    /// Without an answer.
    Unknown(Reason),
}

/// Counts and times of a search.
#[derive(Clone, Debug, Default)]
pub struct Statistics {
    /// The length tried last; 0 before the first.
    pub length: usize,
    /// Half-space literals.
    pub half_spaces: usize,
    /// SAT variables.
    pub bool_vars: usize,
    /// SAT variables that communication took.
    pub bool_vars_connectivity: usize,
    /// SAT clauses, lemmas included.
    pub clauses: usize,
    /// SAT queries.
    pub sat_calls: u64,
    /// Linear programs.
    pub convex_calls: u64,
    /// Candidates.
    pub candidates: u64,
    /// Lemmas.
    pub lemmas: u64,
    /// By robot: how often its programs refused what a candidate asks of them, alone or together with
    /// others'; several may refuse the same candidate.
    pub conflicts: Vec<u64>,
    /// Moves and links of candidates that what was encoded so far let pass, though they are not clear.
    pub not_clear: u64,
    /// Time spent encoding.
    pub time_encode: Duration,
    /// Time spent in the SAT solver.
    pub time_sat: Duration,
    /// Time spent in linear programs and their certificates.
    pub time_convex: Duration,
    /// Time spent testing candidates against geometry.
    pub time_geometry: Duration,
}

impl Statistics {
    /// Adds the work of an earlier search for the same mission.
    pub fn add_work(&mut self, earlier: &Statistics) {
        self.sat_calls += earlier.sat_calls;
        self.convex_calls += earlier.convex_calls;
        self.candidates += earlier.candidates;
        self.lemmas += earlier.lemmas;
        self.not_clear += earlier.not_clear;
        let refused = self.conflicts.iter_mut().zip(&earlier.conflicts);
        refused.for_each(|(sum, more)| *sum += more);
        self.time_encode += earlier.time_encode;
        self.time_sat += earlier.time_sat;
        self.time_convex += earlier.time_convex;
        self.time_geometry += earlier.time_geometry;
    }
}

/// Searches the horizon for a plan, shortest first.
pub fn solve(
    problem: &Problem,
    tubes: &Tubes,
    abstraction: &Abstraction,
    options: &Options,
) -> (Outcome, Statistics) {
    search::Search::new(problem, tubes, abstraction, options).run()
}
