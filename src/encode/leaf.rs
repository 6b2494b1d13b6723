//! The leaves of the circuit: what the convex part understands.

use crate::abstraction::{Abstraction, DirectionId, HalfSpace};
use crate::entity::{EntityId, Table};
use crate::ir::{Problem, RobotId};

use super::circuit::{Bit, Circuit, Gate};
use rustsat::types::Lit;

/// A constraint of the convex part. True switches it on, false says nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Leaf {
    /// The robot's nominal position at a step lies in the half-space.
    HalfSpace {
        /// Who.
        robot: RobotId,
        /// When; L + 1 is the closing position.
        step: usize,
        /// Where.
        half_space: HalfSpace,
    },
    /// `sign · (z_first − z_second)[axis]` is at least the separation and both tubes, at a step and
    /// at the one after.
    Apart(Face),
    /// `normal · (z_first − z_second) ≤ offset`.
    Near(Near),
}

/// A bound on the difference of two robots' nominal positions at a step, or on one robot's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Near {
    /// The first robot.
    pub first: RobotId,
    /// The second robot; `None` where the bound is on the first alone.
    pub second: Option<RobotId>,
    /// When.
    pub step: usize,
    /// One entry a coordinate of the workspace, then zeros.
    pub normal: [f64; 3],
    /// The offset.
    pub offset: f64,
}

impl Near {
    /// A bound along a normal of two or three entries.
    pub fn new(first: RobotId, second: Option<RobotId>, step: usize, along: &[f64], offset: f64) -> Near {
        let mut normal = [0.0; 3];
        normal.iter_mut().zip(along).for_each(|(to, from)| *to = *from);
        Near { first, second, step, normal, offset }
    }

    /// Whose positions it bounds, each with its sign.
    pub fn robots(&self) -> impl Iterator<Item = (RobotId, f64)> {
        [(self.first, 1.0)].into_iter().chain(self.second.map(|second| (second, -1.0)))
    }

    /// The axes along which the normal has a part.
    pub fn axes(self) -> impl Iterator<Item = usize> {
        (0..3).filter(move |&axis| self.normal[axis] != 0.0)
    }
}

/// One face of the separation of two robots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Face {
    /// The first robot.
    pub first: RobotId,
    /// The second robot.
    pub second: RobotId,
    /// When.
    pub step: usize,
    /// Along which axis.
    pub axis: usize,
    /// Whether the first robot has the larger coordinate.
    pub positive: bool,
}

/// Bounds on where a robot can get: what spares literals that are never true, or always.
pub trait Reach {
    /// A lower bound on d · z of a robot at a step.
    fn least(&mut self, robot: RobotId, direction: DirectionId, step: usize) -> f64;
}

/// A reach that knows nothing.
#[derive(Debug)]
pub struct Anywhere;

impl Reach for Anywhere {
    fn least(&mut self, _: RobotId, _: DirectionId, _: usize) -> f64 {
        f64::NEG_INFINITY
    }
}

/// Offsets in rising order with their literals.
type Levels = Vec<(f64, Lit)>;

/// The half-space literals of every robot and step, with order axioms between parallel ones and
/// exclusions between opposite ones.
#[derive(Debug)]
pub struct HalfSpaces {
    starts: Table<RobotId, Vec<f64>>,
    /// By robot, step and direction: offsets in rising order with their literals.
    literals: Vec<Vec<Vec<Levels>>>,
    count: usize,
}

impl HalfSpaces {
    /// No literals yet.
    pub fn new(problem: &Problem) -> HalfSpaces {
        let start = |r: &crate::ir::Robot| {
            problem.models[r.model].position.iter().map(|&s| r.start[s].to_f64()).collect()
        };
        let starts: Table<RobotId, Vec<f64>> = problem.robots.values().map(start).collect();
        HalfSpaces { literals: vec![Vec::new(); starts.len()], starts, count: 0 }
    }

    /// How many literals there are.
    pub fn len(&self) -> usize {
        self.count
    }

    /// The literal of `d · z ≤ offset` for a robot and a step; known at step 0, and where the
    /// workspace or the robot's reach decides it.
    pub fn literal(
        &mut self,
        circuit: &mut Circuit,
        abstraction: &Abstraction,
        problem: &Problem,
        reach: &mut dyn Reach,
        (robot, step, half_space): (RobotId, usize, HalfSpace),
    ) -> Bit {
        let HalfSpace { direction, offset } = half_space;
        let vector = &abstraction.directions[direction];
        if step == 0 {
            return Bit::from(crate::abstraction::dot(&vector.vector, &self.starts[robot]) <= offset);
        }
        let model = problem.robots[robot].model;
        if offset >= abstraction.ceiling(model, direction) {
            return Bit::True;
        }
        if offset < -abstraction.ceiling(model, vector.opposite) {
            return Bit::False;
        }
        if let Some(lit) = self.find(robot, step, direction, offset) {
            return Bit::Lit(lit);
        }
        if offset < reach.least(robot, direction, step) {
            return Bit::False;
        }
        if offset >= -reach.least(robot, vector.opposite, step) {
            return Bit::True;
        }
        Bit::Lit(self.insert(circuit, abstraction, robot, step, half_space))
    }

    fn row(&mut self, robot: RobotId, step: usize, direction: DirectionId) -> &mut Vec<(f64, Lit)> {
        let steps = &mut self.literals[robot.index()];
        if steps.len() <= step {
            steps.resize(step + 1, Vec::new());
        }
        let row = &mut steps[step];
        if row.len() <= direction.index() {
            row.resize(direction.index() + 1, Vec::new());
        }
        &mut row[direction.index()]
    }

    /// The literals along a direction, offsets rising.
    pub fn along(&self, robot: RobotId, step: usize, direction: DirectionId) -> &[(f64, Lit)] {
        let row = self.literals[robot.index()].get(step).and_then(|s| s.get(direction.index()));
        row.map_or(&[], |r| r.as_slice())
    }

    fn find(&self, robot: RobotId, step: usize, direction: DirectionId, offset: f64) -> Option<Lit> {
        let row = self.along(robot, step, direction);
        let at = row.partition_point(|(o, _)| *o < offset);
        row.get(at).filter(|(o, _)| *o == offset).map(|(_, lit)| *lit)
    }

    fn insert(
        &mut self,
        circuit: &mut Circuit,
        abstraction: &Abstraction,
        robot: RobotId,
        step: usize,
        half_space: HalfSpace,
    ) -> Lit {
        let HalfSpace { direction, offset } = half_space;
        let lit = circuit.define(Gate::Leaf(Leaf::HalfSpace { robot, step, half_space }));
        self.count += 1;
        let row = self.row(robot, step, direction);
        let at = row.partition_point(|(o, _)| *o < offset);
        row.insert(at, (offset, lit));
        if at > 0 {
            circuit.clause(&[!row[at - 1].1, lit]);
        }
        if at + 1 < row.len() {
            circuit.clause(&[!lit, row[at + 1].1]);
        }
        // The weakest opposite half-space that leaves nothing between the two; rounding of offsets
        // is far below a thousandth of the gap.
        let grain = 1e-3 * abstraction.gap;
        let opposite = self.row(robot, step, abstraction.directions[direction].opposite);
        let at = opposite.partition_point(|(o, _)| *o < -offset - grain);
        if at > 0 {
            circuit.clause(&[!lit, !opposite[at - 1].1]);
        }
        lit
    }
}
