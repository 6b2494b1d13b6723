//! The convex part of a candidate: its constraints shared out among small programs.

use std::collections::BTreeMap;

use nalgebra::DVector;
use rustsat::types::Lit;

use crate::abstraction::Abstraction;
use crate::encode::Leaf;
use crate::entity::{EntityId, Table};
use crate::ir::{ModelId, Problem, RobotId};
use crate::tube::Tubes;

use super::convex::{Conflict, Member, Node, Program, System, Verdict};

/// A constraint of a candidate with its literal.
pub type Constraint = (Lit, Leaf);

/// Blocks of robots that constraints join, with these constraints.
type Cluster = (Vec<Node>, Vec<Constraint>);

/// States z_0 … z_{L+1} and inputs v_0 … v_L of one robot.
#[derive(Clone, Debug)]
pub struct Trajectory {
    /// The states.
    pub states: Vec<DVector<f64>>,
    /// The inputs.
    pub inputs: Vec<DVector<f64>>,
}

/// A cluster's constraints that no trajectory satisfies.
pub struct Refusal {
    /// The constraints of the cluster.
    pub constraints: Vec<Constraint>,
    /// The robots of the cluster.
    pub robots: Vec<RobotId>,
    /// The proved contradiction; `None` when numbers ran out.
    pub conflict: Option<Box<Conflict>>,
}

/// A cluster's program with the candidate that it last found feasible.
struct Solved<'a> {
    program: Program<'a>,
    feasible: Option<(Vec<Lit>, usize)>,
}

/// The programs of one length, by cluster.
pub struct Robots<'a> {
    problem: &'a Problem,
    abstraction: &'a Abstraction,
    systems: &'a Table<ModelId, System>,
    length: usize,
    programs: BTreeMap<Vec<Node>, Solved<'a>>,
    /// How many programs were solved.
    pub calls: u64,
}

/// The nominal systems of a problem's models.
pub fn systems(problem: &Problem, tubes: &Tubes, abstraction: &Abstraction) -> Table<ModelId, System> {
    problem.models.ids().map(|id| System::new(problem, id, tubes, abstraction)).collect()
}

impl<'a> Robots<'a> {
    /// No programs yet, for a length.
    pub fn new(
        problem: &'a Problem,
        abstraction: &'a Abstraction,
        systems: &'a Table<ModelId, System>,
        length: usize,
    ) -> Robots<'a> {
        Robots { problem, abstraction, systems, length, programs: BTreeMap::new(), calls: 0 }
    }

    /// A robot with its system and free evolution.
    pub fn member(&self, robot: RobotId) -> Member<'a> {
        let entry = &self.problem.robots[robot];
        let start = DVector::from_iterator(entry.start.len(), entry.start.iter().map(|x| x.to_f64()));
        Member::new(robot, &self.systems[entry.model], start, self.length)
    }

    /// Trajectories for a candidate's constraints and loop, or every cluster that has none.
    ///
    /// # Errors
    /// The clusters' refusals.
    pub fn decide(
        &mut self,
        constraints: &[Constraint],
        loop_start: usize,
    ) -> Result<Table<RobotId, Trajectory>, Vec<Refusal>> {
        // What a robot can't do by itself says more than what several can't do together, and its
        // program is far smaller. So robots come alone first.
        let alone: Vec<Constraint> =
            constraints.iter().filter(|(_, leaf)| !is_coupling(leaf)).copied().collect();
        let single = self.clusters(&alone);
        let refusals = self.refusals(&single, loop_start);
        if !refusals.is_empty() {
            return Err(refusals);
        }
        if alone.len() == constraints.len() {
            return Ok(self.trajectories(&single));
        }
        let clusters = self.clusters(constraints);
        let refusals = self.refusals(&clusters, loop_start);
        if refusals.is_empty() { Ok(self.trajectories(&clusters)) } else { Err(refusals) }
    }

    fn refusals(&mut self, clusters: &[Cluster], loop_start: usize) -> Vec<Refusal> {
        let mut refusals = Vec::new();
        for (nodes, own) in clusters {
            let conflict = match self.check(nodes, own, loop_start) {
                Verdict::Feasible => continue,
                Verdict::Infeasible(conflict) => Some(conflict),
                Verdict::Undecided => None,
            };
            refusals.push(Refusal { constraints: own.clone(), robots: robots_of(nodes), conflict });
        }
        refusals
    }

    fn check(&mut self, nodes: &[Node], constraints: &[Constraint], loop_start: usize) -> Verdict {
        let (problem, abstraction) = (self.problem, self.abstraction);
        let candidate: (Vec<Lit>, usize) = (constraints.iter().map(|(lit, _)| *lit).collect(), loop_start);
        if !self.programs.contains_key(nodes) {
            let members = robots_of(nodes).into_iter().map(|r| self.member(r)).collect();
            let program = Program::new(abstraction, self.length, members, nodes.to_vec());
            self.programs.insert(nodes.to_vec(), Solved { program, feasible: None });
        }
        let Some(solved) = self.programs.get_mut(nodes) else { return Verdict::Undecided };
        if solved.feasible.as_ref() == Some(&candidate) {
            return Verdict::Feasible;
        }
        self.calls += 1;
        let verdict = solved.program.check(constraints, loop_start, &|face| {
            abstraction.least_apart(problem, [face.first, face.second], face.axis, face.positive)
        });
        solved.feasible = matches!(verdict, Verdict::Feasible).then_some(candidate);
        verdict
    }

    /// The finest partition of all robots' blocks that keeps each constraint in one part, with each
    /// part's constraints.
    fn clusters(&self, constraints: &[Constraint]) -> Vec<Cluster> {
        let mut nodes: Vec<Node> = Vec::new();
        for (robot, entry) in self.problem.robots.iter() {
            let blocks = self.systems[entry.model].blocks.len();
            nodes.extend((0..blocks).map(|block| Node { robot, block }));
        }
        let at = |node: Node| nodes.iter().position(|n| *n == node).unwrap_or(0);
        let mut group: Vec<usize> = (0..nodes.len()).collect();
        let touched: Vec<Vec<usize>> =
            constraints.iter().map(|(_, leaf)| self.touched(leaf).into_iter().map(at).collect()).collect();
        for members in &touched {
            for &member in members {
                let (from, to) = (group[member], group[members[0]]);
                group.iter_mut().filter(|g| **g == from).for_each(|g| *g = to);
            }
        }
        let mut clusters: BTreeMap<usize, Cluster> = BTreeMap::new();
        for (node, &name) in nodes.iter().zip(&group) {
            clusters.entry(name).or_default().0.push(*node);
        }
        for (constraint, members) in constraints.iter().zip(&touched) {
            clusters.entry(group[members[0]]).or_default().1.push(*constraint);
        }
        clusters.into_values().collect()
    }

    /// The blocks that a constraint speaks of.
    fn touched(&self, leaf: &Leaf) -> Vec<Node> {
        match *leaf {
            Leaf::HalfSpace { robot, half_space, .. } => {
                let vector = &self.abstraction.directions[half_space.direction].vector;
                let axes = vector.iter().enumerate().filter(|(_, x)| **x != 0.0).map(|(axis, _)| axis);
                axes.map(|axis| self.node(robot, axis)).collect()
            }
            Leaf::Apart(face) => {
                vec![self.node(face.first, face.axis), self.node(face.second, face.axis)]
            }
            Leaf::Near(near) => {
                let of = |(robot, _)| near.axes().map(move |axis| self.node(robot, axis));
                near.robots().flat_map(of).collect()
            }
        }
    }

    fn node(&self, robot: RobotId, axis: usize) -> Node {
        let system = &self.systems[self.problem.robots[robot].model];
        let state = system.position[axis];
        let block = system.blocks.iter().position(|b| b.states.contains(&state)).unwrap_or(0);
        Node { robot, block }
    }

    /// The trajectories that the clusters' programs hold.
    fn trajectories(&self, clusters: &[Cluster]) -> Table<RobotId, Trajectory> {
        let zero =
            |r: &crate::ir::Robot| vec![DVector::zeros(self.problem.models[r.model].m()); self.length + 1];
        let mut unknowns: Vec<Vec<DVector<f64>>> = self.problem.robots.values().map(zero).collect();
        let programs = clusters.iter().filter_map(|(nodes, _)| self.programs.get(nodes));
        for (robot, steps) in programs.flat_map(|solved| solved.program.unknowns()) {
            unknowns[robot.index()].iter_mut().zip(steps).for_each(|(sum, part)| *sum += part);
        }
        let run = |(robot, w): (RobotId, &Vec<DVector<f64>>)| {
            let member = self.member(robot);
            let (states, inputs) = member.system.run(&member.start, w);
            Trajectory { states, inputs }
        };
        self.problem.robots.ids().zip(&unknowns).map(run).collect()
    }
}

/// Whether a constraint speaks of two robots.
fn is_coupling(leaf: &Leaf) -> bool {
    match leaf {
        Leaf::HalfSpace { .. } => false,
        Leaf::Apart(_) => true,
        Leaf::Near(near) => near.second.is_some(),
    }
}

fn robots_of(nodes: &[Node]) -> Vec<RobotId> {
    let mut robots: Vec<RobotId> = nodes.iter().map(|n| n.robot).collect();
    robots.sort_unstable();
    robots.dedup();
    robots
}
