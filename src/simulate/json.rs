//! What a simulation came to, as JSON and in words.

use std::collections::BTreeMap;

use serde::Serialize;

use super::{Against, Disturbance, Kind, Least, Options, Spot, Summary, Tally, disturbance};
use crate::entity::EntityId;
use crate::ir::{BaseId, BlockerId, Model, Problem, RegionId, RobotId};

/// A summary with the mission's names in it.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct JsonSummary {
    /// How many runs were made.
    pub runs: u64,
    /// How many robots each had.
    pub robots: usize,
    /// How many steps each had.
    pub steps: usize,
    /// Runs × robots × steps.
    pub robot_steps: u64,
    /// What all random numbers were made of.
    pub seed: u64,
    /// The kinds of disturbance, which runs took in turn.
    pub disturbance: Vec<&'static str>,
    /// What disturbances were scaled by.
    pub exceed: f64,
    /// What the law computed with.
    #[cfg_attr(test, schemars(extend("enum" = ["f64", "f32"])))]
    pub float: &'static str,
    /// How often something was violated at a sample.
    pub violations: u64,
    /// How often what was: kinds that there were none of are left out.
    pub violations_by_kind: BTreeMap<&'static str, u64>,
    /// In how many runs something was.
    pub runs_with_violation: u64,
    /// The least margin of each kind at samples.
    pub margins: Margins,
    /// By kind: where and when the margin was least.
    pub least: BTreeMap<&'static str, JsonSpot>,
    /// By kind: the first violation.
    pub first_violations: BTreeMap<&'static str, JsonSpot>,
    /// The same between samples, where the plan promises nothing but that straight ways are clear.
    pub between_samples: Between,
    /// How often a monitor reported that more happened than was assumed: robots × samples.
    pub excess_reported: u64,
    /// In how many runs one did.
    pub runs_with_excess: u64,
    /// How many violations no robot concerned had reported an excess of by the sample that showed them.
    pub unreported_violations: u64,
}

/// Least margins; `null` where there is nothing to have a margin from.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Margins {
    /// Of states from their own bounds, as a share of half of what lies between these: 1 is the middle.
    pub state: Option<f64>,
    /// Of inputs from their own bounds, as a share of half of what lies between these.
    pub input: Option<f64>,
    /// From bounds over states and inputs together: along the bound's normal, in coherent SI units.
    pub mixed: Option<f64>,
    /// From the edge of the workspace, in metres.
    pub workspace: Option<f64>,
    /// From obstacles and jammers, in metres.
    pub blocker: Option<f64>,
    /// What robots are farther apart than they have to, in metres, along the axis where that is most.
    pub separation: Option<f64>,
    /// Of the plan's links from what they must not cross, in metres.
    pub link: Option<f64>,
    /// What the plan's links could be longer, in metres.
    pub range: Option<f64>,
    /// From the edge of regions that the plan says a robot is in or out of, in metres.
    pub region: Option<f64>,
}

/// What was found between samples, at eighths of a step.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Between {
    /// The least margins. A link's is that of the better of two lists, of the sample before and after, what
    /// it could be longer included.
    pub margins: BetweenMargins,
    /// By kind: where and when the margin was least.
    pub least: BTreeMap<&'static str, JsonSpot>,
    /// By kind: at how many instants there was none left; `connectivity`: at which somebody had no way to a
    /// base over the links of the sample before and after. Kinds that there were none of are left out.
    pub shortfalls: BTreeMap<&'static str, u64>,
}

/// Least margins between samples, in metres; `null` where there is nothing to have a margin from.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct BetweenMargins {
    /// From the edge of the workspace.
    pub workspace: Option<f64>,
    /// From obstacles and jammers.
    pub blocker: Option<f64>,
    /// What robots are farther apart than they have to.
    pub separation: Option<f64>,
    /// Of links from what they must not cross.
    pub link: Option<f64>,
}

/// Where and when something was.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct JsonSpot {
    /// The margin, less than 0 where there was none; `null` where something holds or does not.
    pub margin: Option<f64>,
    /// The same in `unit`.
    pub amount: Option<f64>,
    /// `m`, or the unit of the state or input.
    pub unit: Option<String>,
    /// The run, from 0.
    pub run: u64,
    /// How robots were disturbed in it.
    #[cfg_attr(test, schemars(extend("enum" = ["uniform", "vertex", "held", "adversarial", "aimed"])))]
    pub disturbance: &'static str,
    /// The step, from 0; between samples that of the one before, and eighths.
    pub step: f64,
    /// The robots that it is about; none where it is about all.
    pub robots: Vec<String>,
    /// What it is about.
    pub against: String,
}

impl JsonSummary {
    /// The summary of a simulation of a problem.
    pub fn new(problem: &Problem, options: &Options, summary: &Summary) -> JsonSummary {
        let found = &summary.findings;
        let names = Names { problem, options };
        let margin = |kind: Kind| found.samples.least(kind).map(|l| l.margin);
        let between = |kind: Kind| found.between.least(kind).map(|l| l.margin);
        JsonSummary {
            runs: summary.runs,
            robots: problem.robots.len(),
            steps: summary.steps,
            robot_steps: summary.robot_steps,
            seed: options.seed,
            disturbance: options.disturbances.iter().map(|d| d.name()).collect(),
            exceed: options.exceed,
            float: options.float.name(),
            violations: found.samples.all_shortfalls(),
            violations_by_kind: counts(&found.samples),
            runs_with_violation: found.runs_with_violation,
            margins: Margins {
                state: margin(Kind::State),
                input: margin(Kind::Input),
                mixed: margin(Kind::Mixed),
                workspace: margin(Kind::Workspace),
                blocker: margin(Kind::Blocker),
                separation: margin(Kind::Separation),
                link: margin(Kind::Link),
                range: margin(Kind::Range),
                region: margin(Kind::Region),
            },
            least: names.spots(|kind| found.samples.least(kind).filter(|_| kind.has_margin())),
            first_violations: names.spots(|kind| found.samples.first(kind)),
            between_samples: Between {
                margins: BetweenMargins {
                    workspace: between(Kind::Workspace),
                    blocker: between(Kind::Blocker),
                    separation: between(Kind::Separation),
                    link: between(Kind::Link),
                },
                least: names.spots(|kind| found.between.least(kind).filter(|_| kind.has_margin())),
                shortfalls: counts(&found.between),
            },
            excess_reported: found.excesses,
            runs_with_excess: found.runs_with_excess,
            unreported_violations: found.unreported,
        }
    }
}

fn counts(tally: &Tally) -> BTreeMap<&'static str, u64> {
    let all = Kind::ALL.into_iter().map(|kind| (kind.name(), tally.shortfalls(kind)));
    all.filter(|(_, count)| *count > 0).collect()
}

/// What ids are called.
struct Names<'a> {
    problem: &'a Problem,
    options: &'a Options,
}

impl Names<'_> {
    fn spots<'l>(&self, of: impl Fn(Kind) -> Option<&'l Least>) -> BTreeMap<&'static str, JsonSpot> {
        let spot = |kind: Kind| Some((kind.name(), self.spot(kind, of(kind)?)));
        Kind::ALL.into_iter().filter_map(spot).collect()
    }

    fn spot(&self, kind: Kind, least: &Least) -> JsonSpot {
        let Spot { run, sample, eighths, robots, against } = least.spot;
        let kind_of_run: Disturbance = disturbance(self.options, run);
        let margin = kind.has_margin().then_some(least.margin);
        let amount = margin.map(|margin| margin * self.scale(robots[0], against));
        JsonSpot {
            margin,
            amount,
            unit: margin.map(|_| self.unit(robots[0], against)),
            run,
            disturbance: kind_of_run.name(),
            step: sample as f64 + f64::from(eighths) / 8.0,
            robots: robots.into_iter().flatten().map(|robot| self.robot(robot)).collect(),
            against: self.against(robots[0], against),
        }
    }

    fn robot(&self, robot: usize) -> String {
        self.problem.robots.get(RobotId::new(robot)).map_or_else(String::new, |r| r.name.clone())
    }

    fn model(&self, robot: Option<usize>) -> Option<&Model> {
        let robot = self.problem.robots.get(RobotId::new(robot?))?;
        self.problem.models.get(robot.model)
    }

    /// What a margin of 1 is, in its unit.
    fn scale(&self, robot: Option<usize>, against: Against) -> f64 {
        let model = self.model(robot);
        let bound = match against {
            Against::State(i) => model.and_then(|m| m.state_bounds.get(i)?.as_ref()),
            Against::Input(i) => model.and_then(|m| m.input_bounds.get(i)),
            _ => None,
        };
        bound.map_or(1.0, |b| (&b.hi - &b.lo).to_f64() / 2.0)
    }

    fn unit(&self, robot: Option<usize>, against: Against) -> String {
        let model = self.model(robot);
        let signal = match against {
            Against::State(i) => model.and_then(|m| m.states.get(i)),
            Against::Input(i) => model.and_then(|m| m.inputs.get(i)),
            Against::Bound(_) => return "SI".into(),
            _ => None,
        };
        signal.map_or_else(|| "m".into(), |signal| signal.unit.clone())
    }

    fn against(&self, robot: Option<usize>, against: Against) -> String {
        let problem = self.problem;
        let model = self.model(robot);
        let named = |name: Option<&String>| name.cloned().unwrap_or_default();
        let blocker = |blocker: usize| problem.blockers.get(BlockerId::new(blocker));
        match against {
            Against::State(i) => named(model.and_then(|m| m.states.get(i)).map(|s| &s.name)),
            Against::Input(i) => named(model.and_then(|m| m.inputs.get(i)).map(|s| &s.name)),
            Against::Bound(i) => format!("bound {}", i + 1),
            Against::Workspace => "workspace".into(),
            Against::Piece { blocker: id, piece } => match blocker(id) {
                Some(b) if b.shape.pieces.len() > 1 => format!("{}, piece {piece}", b.name),
                b => named(b.map(|b| &b.name)),
            },
            Against::Each => "each other".into(),
            Against::Base { base, blocker: id } => {
                let to = named(problem.bases.get(BaseId::new(base)).map(|b| &b.name));
                match id.and_then(blocker) {
                    Some(blocker) => format!("{}, linked to {to}", blocker.name),
                    None => format!("linked to {to}"),
                }
            }
            Against::Region(i) => named(problem.regions.get(RegionId::new(i)).map(|r| &r.name)),
            Against::Goal(i) => named(problem.goals.get(i).map(|g| &g.name)),
            Against::Nothing => "all robots".into(),
        }
    }
}
