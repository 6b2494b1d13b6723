//! The simulator: a plan's closed loop under the worst that its assumption allows, and beyond.
//!
//! Each robot is its mission's own plant x⁺ = A x + B u + c + w in doubles, with w in Θ, and flies the
//! tracking law from the source that goes into every controller ([`law`](crate::law)). What happens is
//! held against the mission itself: true shapes, true distances, links between real positions, and the
//! goals on the labels that these give. Nothing here proves anything; it tries to break what was proved.
//!
//! A run is a function of the seed and its number alone, and runs are added up in their order, so that
//! the same seed gives the same result with any number of threads.

mod aim;
mod body;
mod contact;
mod csv;
mod goals;
mod greedy;
mod inspect;
mod json;
mod motion;
mod pushes;
mod random;
mod size;
mod tally;
mod vehicle;
mod way;
mod workers;
mod world;

#[cfg(test)]
mod tests;

pub use csv::Rows;
pub use inspect::Findings;
pub use json::{Between, BetweenMargins, JsonSpot, JsonSummary, Margins};
pub use tally::{Against, Kind, Least, Spot, Tally};
pub use way::{Place, Report, Way, Word};
pub use workers::Observer;

use crate::ir::Problem;
use crate::law::{Feedback, Float, PathTables, TubeTables};
use crate::plan::Plan;
use aim::{Aim, aims};
use greedy::Greedy;
use pushes::{Lasso, Pusher, Script};
use random::Stream;
use vehicle::{Parts, Vehicle, vehicle};
use world::World;

/// How robots are disturbed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Disturbance {
    /// Anywhere in Θ, independently at each step.
    Uniform,
    /// At a random vertex of Θ, another one at each step.
    Vertex,
    /// At one vertex of Θ all the time: that which, held, brings robots nearest to one of the plan's claims.
    Held,
    /// At each step at the vertex that leaves least at the next sample.
    Adversarial,
    /// By the very sequence that brings robots nearest to one of the plan's claims at one sample: to the
    /// tube's corner.
    Aimed,
}

impl Disturbance {
    /// All of them.
    pub const ALL: [Disturbance; 5] = [
        Disturbance::Uniform,
        Disturbance::Vertex,
        Disturbance::Held,
        Disturbance::Adversarial,
        Disturbance::Aimed,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Disturbance::Uniform => "uniform",
            Disturbance::Vertex => "vertex",
            Disturbance::Held => "held",
            Disturbance::Adversarial => "adversarial",
            Disturbance::Aimed => "aimed",
        }
    }
}

/// What to simulate.
#[derive(Clone, Debug)]
pub struct Options {
    /// How many runs.
    pub runs: u64,
    /// What all random numbers are made of.
    pub seed: u64,
    /// How many samples a run has; [`usual_steps`] when left out.
    pub steps: Option<usize>,
    /// The kinds of disturbance: runs take them in turn.
    pub disturbances: Vec<Disturbance>,
    /// Disturbances are scaled by this about the middle of Θ.
    pub exceed: f64,
    /// What the law computes with.
    pub float: Float,
    /// At most so many threads.
    pub threads: usize,
}

impl Default for Options {
    fn default() -> Options {
        Options {
            runs: 1000,
            seed: 0,
            steps: None,
            disturbances: Disturbance::ALL.to_vec(),
            exceed: 1.0,
            float: Float::F64,
            threads: 1,
        }
    }
}

/// What a simulation came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// How many runs were made: fewer than asked only when it was stopped.
    pub runs: u64,
    /// The samples of each run.
    pub steps: usize,
    /// Runs × robots × samples.
    pub robot_steps: u64,
    /// What was found.
    pub findings: Findings,
}

/// Why a plan can't be simulated, though it may be one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unfit {
    /// A run so short has no last round of the loop.
    #[error("a run of this plan has at least {least} steps")]
    TooShort {
        /// The least number of samples.
        least: usize,
    },
    /// The law's tables have numbers that its type doesn't hold.
    #[error("the plan has numbers that {0} does not hold")]
    TooLarge(Float),
    /// The plan lacks something that every plan of this mission has.
    #[error("the plan is none of this mission")]
    Foreign,
}

/// So often the loop is come back to in a usual run, at least.
const RETURNS: usize = 3;
/// So many steps a usual run has, at least.
const STEPS: usize = 60;

/// The samples of a usual run: the plan once, then round the loop, three times at least, until there are
/// no fewer than sixty.
pub fn usual_steps(plan: &Plan) -> usize {
    let (once, round) = (plan.length + 1, plan.length + 1 - plan.loop_start.min(plan.length));
    let returns = STEPS.saturating_sub(once).div_ceil(round.max(1)).max(RETURNS);
    once + returns * round
}

/// Simulates a plan that has been checked against its problem.
///
/// # Errors
/// [`Unfit`] when it can't be simulated as asked.
pub fn run(
    problem: &Problem,
    plan: &Plan,
    options: &Options,
    observer: &dyn Observer,
) -> Result<Summary, Unfit> {
    let arena = Arena::new(problem, plan, options)?;
    let (runs, findings) = workers::work(&arena, observer);
    let robot_steps = runs.saturating_mul(arena.robots.len() as u64).saturating_mul(arena.steps as u64);
    Ok(Summary { runs, steps: arena.steps, robot_steps, findings })
}

/// The kind of disturbance in a run.
pub fn disturbance(options: &Options, run: u64) -> Disturbance {
    let kinds = &options.disturbances;
    let turn = usize::try_from(run % kinds.len().max(1) as u64).unwrap_or(0);
    kinds.get(turn).copied().unwrap_or(Disturbance::Uniform)
}

/// Everything that a run needs.
struct Arena<'a> {
    options: &'a Options,
    steps: usize,
    world: World<'a>,
    robots: Vec<Robot<'a>>,
    aims: Vec<Aim>,
}

/// A robot with what disturbs it.
struct Robot<'a> {
    vehicle: Box<dyn Vehicle>,
    pusher: Pusher<'a>,
    greedy: Greedy,
    n: usize,
    m: usize,
}

impl<'a> Arena<'a> {
    fn new(problem: &'a Problem, plan: &'a Plan, options: &'a Options) -> Result<Arena<'a>, Unfit> {
        let memory = plan.tubes.iter().map(|tube| tube.d.len()).max().unwrap_or(1);
        if plan.loop_start > plan.length {
            return Err(Unfit::Foreign);
        }
        let lasso = Lasso { last: plan.length, loop_start: plan.loop_start, memory };
        let steps = options.steps.unwrap_or_else(|| usual_steps(plan));
        if steps <= plan.length {
            return Err(Unfit::TooShort { least: plan.length + 1 });
        }
        let aims = aims(problem, plan);
        let robots = (0..problem.robots.len()).map(|index| robot(problem, plan, options, index, &aims));
        let robots = robots.collect::<Result<Vec<_>, Unfit>>()?;
        let world = World::new(problem, plan, lasso).ok_or(Unfit::Foreign)?;
        Ok(Arena { options, steps, world, robots, aims })
    }

    /// Room for a run.
    fn ways(&self) -> Vec<Way> {
        self.robots.iter().map(|robot| Way::new(robot.n, robot.m, self.steps)).collect()
    }

    /// Flies a run.
    fn fly(&self, run: u64, ways: &mut [Way]) {
        let kind = disturbance(self.options, run);
        let mut stream = Stream::new(self.options.seed, run);
        let turn = run / self.options.disturbances.len().max(1) as u64;
        let script = Script::new(kind, turn, &self.aims, self.world.lasso, self.steps, &mut stream);
        for (index, (robot, way)) in self.robots.iter().zip(ways).enumerate() {
            script.write(index, &robot.pusher, &mut stream, &mut way.pushes);
            let greedy = (script.kind == Disturbance::Adversarial).then_some(&robot.greedy);
            robot.vehicle.fly(way, greedy);
        }
    }
}

fn robot<'a>(
    problem: &'a Problem,
    plan: &'a Plan,
    options: &Options,
    index: usize,
    aims: &[Aim],
) -> Result<Robot<'a>, Unfit> {
    let robot = problem.robots.values().nth(index).ok_or(Unfit::Foreign)?;
    let model = &problem.models[robot.model];
    let tube = plan.tubes.iter().find(|t| t.dynamics == model.name).ok_or(Unfit::Foreign)?;
    let planned = plan.robots.iter().find(|r| r.name == robot.name).ok_or(Unfit::Foreign)?;
    let feedback = Feedback { center: &tube.center, half_width: &tube.half_width, d: &tube.d, m: &tube.m };
    let too_large = Unfit::TooLarge(options.float);
    let tables = TubeTables::new(options.float, model, &problem.workspace, &feedback).ok_or(too_large)?;
    let path = PathTables::new(options.float, &planned.z, &planned.v, plan.loop_start).ok_or(too_large)?;
    let parts = Parts { model, start: &robot.start, tube: &tables, path: &path };
    let mean: Vec<f64> = model.mean().iter().map(|x| x.to_f64()).collect();
    let half = |i: &crate::ir::Interval| (&i.hi - &i.lo).to_f64() / 2.0 * options.exceed;
    let reach: Vec<f64> = model.disturbance.iter().map(half).collect();
    Ok(Robot {
        vehicle: vehicle(options.float, &parts),
        greedy: Greedy::new(index, aims, &planned.z, plan.loop_start, &mean, &reach),
        pusher: Pusher { mean, reach, tube },
        n: model.n(),
        m: model.m(),
    })
}
