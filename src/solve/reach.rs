//! How far robots get: boxes that hold all that a robot's nominal state can be after so many steps.
//!
//! The boxes come from interval arithmetic over the dynamics and the bounds, rounded outwards. They
//! are wide for coupled states, but what lies outside of them is out of reach for certain, and that
//! decides most half-spaces of the first steps before anything is searched.

use crate::abstraction::{Abstraction, DirectionId};
use crate::encode::Reach;
use crate::entity::{EntityId, Table};
use crate::ir::{ModelId, Problem, RobotId};

use super::convex::{Interval, System};

/// The states that robots can be in, step by step.
pub struct Boxes<'a> {
    problem: &'a Problem,
    abstraction: &'a Abstraction,
    systems: Table<ModelId, System>,
    /// By robot and step: an interval for each state.
    boxes: Vec<Vec<Vec<Interval>>>,
}

impl<'a> Boxes<'a> {
    /// The boxes of all robots, made as far as they are asked for.
    pub fn new(
        problem: &'a Problem,
        abstraction: &'a Abstraction,
        systems: Table<ModelId, System>,
    ) -> Boxes<'a> {
        let start = |robot: &crate::ir::Robot| vec![robot.start.iter().map(Interval::around).collect()];
        Boxes { problem, abstraction, systems, boxes: problem.robots.values().map(start).collect() }
    }

    fn at(&mut self, robot: RobotId, step: usize) -> &[Interval] {
        let system = &self.systems[self.problem.robots[robot].model];
        let boxes = &mut self.boxes[robot.index()];
        while boxes.len() <= step {
            let next = after(system, &boxes[boxes.len() - 1]);
            boxes.push(next);
        }
        &boxes[step]
    }
}

impl Reach for Boxes<'_> {
    fn least(&mut self, robot: RobotId, direction: DirectionId, step: usize) -> f64 {
        let position = &self.problem.models[self.problem.robots[robot].model].position;
        let vector = &self.abstraction.directions[direction].vector;
        let states = self.at(robot, step);
        let parts = position.iter().zip(vector).filter(|(_, x)| **x != 0.0);
        let parts = parts.map(|(&s, &x)| Interval::point(x) * states[s]);
        parts.fold(Interval::ZERO, |a, b| a + b).lo
    }
}

/// The box after one more step, within the bounds.
fn after(system: &System, states: &[Interval]) -> Vec<Interval> {
    let next = |row: usize| {
        let from_states = system.exact_a[row].iter().zip(states).map(|(a, z)| (*a, *z));
        let inputs = system.input_bounds.iter().map(|&(lo, hi)| Interval { lo, hi });
        let from_inputs = system.exact_b[row].iter().copied().zip(inputs);
        // 0 times an unbounded state is 0.
        let products = from_states.chain(from_inputs).filter(|(a, _)| !a.is_zero()).map(|(a, x)| a * x);
        let reached = products.fold(system.exact_drift[row], |a, b| a + b);
        let (lo, hi) = system.state_bounds[row];
        Interval { lo: reached.lo.max(lo), hi: reached.hi.min(hi) }
    };
    (0..system.n).map(next).collect()
}
