//! The loop between the Boolean and the convex part.

use std::time::Duration;

use rustsat::types::{Lit, Var};

use crate::abstraction::Abstraction;
use crate::encode::{Encoder, Justification, Switch};
use crate::entity::{EntityId, Table};
use crate::ir::{ModelId, Problem, RobotId};
use crate::plan::Nominal;
use crate::tube::Tubes;

use super::clearance::{Scene, Violation};
use super::convex::{Conflict, System};
use super::demands::Demands;
use super::free::FreePrograms;
use super::lemma::Lemma;
use super::reach::Boxes;
use super::robots::{Refusal, Robots, Trajectory, systems};
use super::sat::{Answer, Model, Sat};
use super::{Options, Outcome, Phase, Reason, Statistics};

/// So many candidates that numbers can't decide, and a length is left undecided: each blocks itself
/// alone, and the next length may be easy.
const PATIENCE: usize = 30;

/// A search over the lengths of the horizon.
pub struct Search<'a> {
    problem: &'a Problem,
    abstraction: &'a Abstraction,
    options: &'a Options,
    systems: Table<ModelId, System>,
    statistics: Statistics,
}

/// How a length ended.
enum End {
    Found(Box<Nominal>),
    Refuted,
    /// Refuted for reasons that hold for every length.
    AllRefuted,
    Undecided,
    Stopped,
}

impl<'a> Search<'a> {
    /// A search that hasn't begun.
    pub fn new(
        problem: &'a Problem,
        tubes: &Tubes,
        abstraction: &'a Abstraction,
        options: &'a Options,
    ) -> Search<'a> {
        let start = options.watch.now();
        let systems = systems(problem, tubes, abstraction);
        let time_convex = options.watch.now().saturating_sub(start);
        let conflicts = vec![0; problem.robots.len()];
        let statistics = Statistics { conflicts, time_convex, ..Statistics::default() };
        Search { problem, abstraction, options, systems, statistics }
    }

    /// Tries the lengths in rising order.
    pub fn run(mut self) -> (Outcome, Statistics) {
        let start = self.now();
        let systems = std::mem::take(&mut self.systems);
        let reach = Boxes::new(self.problem, self.abstraction, systems.clone());
        let mut encoder = Encoder::new(self.problem, self.abstraction, Box::new(reach));
        self.statistics.time_encode += self.now() - start;
        let mut sat = Sat::new(self.options.watch.clone());
        let mut demands = Demands::default();
        let mut undecided = false;
        let (from, to) = self.options.horizon;
        let mut free = FreePrograms::new(self.problem, self.abstraction, &systems);
        let mut shiftable = Vec::new();
        let mut outcome = None;
        self.options.watch.enter(Phase::Search);
        for length in from..=to {
            self.statistics.length = length;
            let robots = Robots::new(self.problem, self.abstraction, &systems, length);
            let mut attempt = Attempt {
                search: &mut self,
                encoder: &mut encoder,
                sat: &mut sat,
                robots,
                length,
                closed: Switch::ALL.to_vec(),
                demands: &mut demands,
                free: &mut free,
                shiftable: &mut shiftable,
                undecided: 0,
            };
            match attempt.run() {
                End::Found(found) => {
                    let shortest = !undecided;
                    outcome = Some(Outcome::Plan(Box::new(Nominal { shortest, ..*found })));
                }
                End::Stopped => outcome = Some(Outcome::Unknown(Reason::Stopped)),
                End::AllRefuted if !undecided => outcome = Some(Outcome::NoPlan),
                End::AllRefuted | End::Refuted => {}
                End::Undecided => undecided = true,
            }
            if outcome.is_some() {
                break;
            }
            encoder.refute(length);
        }
        let end = if undecided { Outcome::Unknown(Reason::Numerics) } else { Outcome::NoPlan };
        self.count(&encoder, &sat);
        self.options.watch.progress(&self.statistics);
        (outcome.unwrap_or(end), self.statistics)
    }

    fn count(&mut self, encoder: &Encoder<'_>, sat: &Sat) {
        let counts = encoder.counts();
        self.statistics.half_spaces = counts.half_spaces;
        self.statistics.bool_vars = counts.variables;
        self.statistics.bool_vars_connectivity = counts.connectivity;
        self.statistics.clauses = counts.clauses;
        self.statistics.sat_calls = sat.calls;
    }

    fn now(&self) -> Duration {
        self.options.watch.now()
    }
}

/// The search at one length.
struct Attempt<'s, 'p, 'e> {
    search: &'e mut Search<'p>,
    encoder: &'e mut Encoder<'p>,
    sat: &'e mut Sat,
    robots: Robots<'s>,
    length: usize,
    /// The switches that are still off.
    closed: Vec<Switch>,
    demands: &'e mut Demands,
    free: &'e mut FreePrograms<'s>,
    /// Lemmas that hold at any time, each with the robot that it came from.
    shiftable: &'e mut Vec<(Lemma, RobotId)>,
    /// How many candidates numbers could not decide.
    undecided: usize,
}

impl<'s, 'p: 's> Attempt<'s, 'p, '_> {
    fn run(&mut self) -> End {
        let start = self.search.now();
        self.encoder.extend(self.length);
        self.demands.extend(self.length, self.encoder);
        self.shift_to_end();
        self.search.statistics.time_encode += self.search.now() - start;
        loop {
            let watch = &self.search.options.watch;
            if watch.stop() {
                return End::Stopped;
            }
            if self.undecided > PATIENCE {
                return End::Undecided;
            }
            self.search.count(self.encoder, self.sat);
            self.search.options.watch.progress(&self.search.statistics);
            match self.query() {
                Answer::Interrupted => return End::Stopped,
                Answer::Core(core) => {
                    if let Some(end) = self.refuted(&core) {
                        return end;
                    }
                }
                Answer::Model(model) => {
                    if let Some(found) = self.candidate(&model) {
                        return End::Found(Box::new(found));
                    }
                }
            }
        }
    }

    fn query(&mut self) -> Answer {
        let start = self.search.now();
        let mut assumptions = vec![self.encoder.last(self.length)];
        assumptions.extend(self.closed.iter().map(|s| !self.encoder.switch(*s)));
        let answer =
            if self.sat.read(self.encoder) { self.sat.query(&assumptions) } else { Answer::Interrupted };
        self.search.statistics.time_sat += self.search.now() - start;
        answer
    }

    /// Turns on the next switch that the refutation rests on being off, or ends the length.
    fn refuted(&mut self, core: &[Var]) -> Option<End> {
        let blamed = self.closed.iter().position(|s| core.contains(&self.encoder.switch(*s).var()));
        if let Some(at) = blamed {
            self.closed.remove(at);
            return None;
        }
        if self.undecided > 0 || self.encoder.is_incomplete() {
            return Some(End::Undecided);
        }
        let rests_on_length = core.contains(&self.encoder.last(self.length).var());
        Some(if rests_on_length { End::Refuted } else { End::AllRefuted })
    }

    /// Tries a model: learns from it, demands more, or ends with a plan.
    fn candidate(&mut self, model: &Model) -> Option<Nominal> {
        self.search.statistics.candidates += 1;
        let start = self.search.now();
        let truth = |lit: Lit| model.holds(lit);
        let back = self.encoder.loop_start(&truth, self.length)?;
        let justification = self.encoder.justify(&truth, self.length, back);
        self.search.statistics.time_encode += self.search.now() - start;
        let start = self.search.now();
        let decided = self.robots.decide(&justification.leaves, back);
        self.search.statistics.convex_calls += std::mem::take(&mut self.robots.calls);
        let result = match decided {
            Err(refusals) => {
                refusals.iter().for_each(|refusal| self.learn(refusal, back));
                None
            }
            Ok(trajectories) => Some(trajectories),
        };
        self.search.statistics.time_convex += self.search.now() - start;
        let trajectories = result?;
        let start = self.search.now();
        let violations = self.violations(&trajectories, &justification, back);
        self.search.statistics.time_geometry += self.search.now() - start;
        if violations.is_empty() {
            return Some(self.found(&trajectories, back, justification));
        }
        let not_clear =
            violations.iter().filter(|v| matches!(v, Violation::Move(..) | Violation::Link(..))).count();
        self.search.statistics.not_clear += not_clear as u64;
        let start = self.search.now();
        self.demand(violations, &justification, back);
        self.search.statistics.time_encode += self.search.now() - start;
        None
    }

    fn violations(
        &self,
        z: &Table<RobotId, Trajectory>,
        justification: &Justification,
        back: usize,
    ) -> Vec<Violation> {
        let scene = Scene::new(self.search.problem, self.search.abstraction, z, self.length);
        scene.violations(&justification.links, back)
    }

    /// Adds the lemma of a refused cluster, and the same at other times and for other robots.
    fn learn(&mut self, refusal: &Refusal, back: usize) {
        for robot in &refusal.robots {
            self.search.statistics.conflicts[robot.index()] += 1;
        }
        let lits: Vec<Lit> = refusal.constraints.iter().map(|(lit, _)| *lit).collect();
        let Some(conflict) = &refusal.conflict else {
            // Its literals forbid every superset, so a refutation says nothing any more.
            self.undecided += 1;
            self.encoder.learn(&lits, Some((self.length, back)));
            return;
        };
        if let Some((free, first)) = self.free.generalise(conflict, self.length) {
            self.learn_free(&free, first);
            return;
        }
        let members: Vec<_> = refusal.robots.iter().map(|r| self.robots.member(*r)).collect();
        let (problem, abstraction) = (self.search.problem, self.search.abstraction);
        let lemma = Lemma::new(conflict, problem, abstraction, self.encoder, &members);
        self.search.statistics.lemmas += 1;
        let own: Vec<Lit> = lemma.rows.iter().map(|row| row.lit).collect();
        self.encoder.learn(&own, lemma.lasso);
        if lemma.shiftable {
            self.learn_shifted(&lemma, refusal.robots[0]);
        }
    }

    /// Adds the lemma of a conflict that holds wherever the robot is at first.
    fn learn_free(&mut self, conflict: &Conflict, robot: RobotId) {
        let members = [self.free.member(robot)];
        let (problem, abstraction) = (self.search.problem, self.search.abstraction);
        let lemma = Lemma::new(conflict, problem, abstraction, self.encoder, &members);
        self.search.statistics.lemmas += 1;
        let own: Vec<Lit> = lemma.rows.iter().map(|row| row.lit).collect();
        self.encoder.learn(&own, None);
        self.learn_shifted(&lemma, robot);
    }

    /// Adds a shiftable lemma at all other times and for all robots with the same model.
    fn learn_shifted(&mut self, lemma: &Lemma, robot: RobotId) {
        let Some((first, last)) = lemma.span() else { return };
        let latest = (self.length + 1).saturating_sub(last - first);
        for other in self.alike(robot) {
            for to in (1..=latest).filter(|to| (other, *to) != (robot, first)) {
                self.learn_at(lemma, other, first, to);
            }
        }
        self.shiftable.push((lemma.clone(), robot));
    }

    /// Adds the shiftable lemmas so far at the positions that a new length brings.
    fn shift_to_end(&mut self) {
        for (lemma, robot) in self.shiftable.clone() {
            let Some((first, last)) = lemma.span() else { continue };
            let to = (self.length + 1).saturating_sub(last - first);
            for other in self.alike(robot) {
                for to in to.saturating_sub(1).max(1)..=to {
                    self.learn_at(&lemma, other, first, to);
                }
            }
        }
    }

    fn alike(&self, robot: RobotId) -> Vec<RobotId> {
        let robots = &self.search.problem.robots;
        robots.ids().filter(|r| robots[*r].model == robots[robot].model).collect()
    }

    fn learn_at(&mut self, lemma: &Lemma, robot: RobotId, from: usize, to: usize) {
        if let Some(lits) = lemma.shifted(self.encoder, robot, from, to) {
            self.encoder.learn(&lits, None);
            self.search.statistics.lemmas += 1;
        }
    }

    fn demand(&mut self, violations: Vec<Violation>, justification: &Justification, back: usize) {
        if !self.demands.make(violations, self.length, self.encoder) {
            // What was demanded holds and yet is violated: the numbers don't carry this candidate.
            self.undecided += 1;
            let lits: Vec<Lit> = justification.leaves.iter().map(|(lit, _)| *lit).collect();
            self.encoder.learn(&lits, Some((self.length, back)));
        }
    }

    fn found(&self, z: &Table<RobotId, Trajectory>, back: usize, justification: Justification) -> Nominal {
        let rows = |steps: &[nalgebra::DVector<f64>]| -> Vec<Vec<f64>> {
            steps.iter().take(self.length + 1).map(|v| v.iter().copied().collect()).collect()
        };
        let connected = self.search.problem.connectivity.is_some();
        Nominal {
            length: self.length,
            loop_start: back,
            states: z.values().map(|t| rows(&t.states)).collect(),
            inputs: z.values().map(|t| rows(&t.inputs)).collect(),
            links: if connected { justification.links } else { Vec::new() },
            shortest: true,
        }
    }
}
