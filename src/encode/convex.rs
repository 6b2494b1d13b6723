//! The convex part of a whole instance: linear and cone rows over states and inputs, in blocks that literals
//! switch on.
//!
//! The search never builds this: it has small programs of its own (`solve::convex`). Files do, so
//! that other solvers can decide the same instance. The numbers are the very doubles of the search.

use rustsat::types::Lit;

use crate::abstraction::{Abstraction, Bounds};
use crate::entity::{EntityId, Table};
use crate::exact::{Rational, primitive};
use crate::ir::{ModelId, Norm, Problem, RobotId};
use crate::tube::Tubes;

use super::{Face, Leaf, Link, Near, link_models};

/// Whole numbers of fewer bits are doubles.
const MANTISSA: usize = 53;

/// One number of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variable {
    /// A state of a robot at a step 0 … L + 1.
    State {
        /// Who.
        robot: RobotId,
        /// When.
        step: usize,
        /// The index of the state.
        state: usize,
    },
    /// An input of a robot at a step 0 … L.
    Input {
        /// Who.
        robot: RobotId,
        /// When.
        step: usize,
        /// The index of the input.
        input: usize,
    },
}

/// How the two sides of a row compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// Σ = bound
    Equal,
    /// Σ ≤ bound
    AtMost,
}

/// Σ coefficient · variable ⋈ bound.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Indices into [`Convex::variables`], rising, with coefficients that are not 0.
    pub terms: Vec<(usize, f64)>,
    /// ⋈
    pub relation: Relation,
    /// The right-hand side.
    pub bound: f64,
}

/// ‖(Σ coefficient · variable + constant, …)‖₂ ≤ bound.
#[derive(Clone, Debug, PartialEq)]
pub struct Cone {
    /// One sum a coordinate of the workspace: terms as in a [`Row`], and a constant.
    pub sums: Vec<(Vec<(usize, f64)>, f64)>,
    /// The right-hand side.
    pub bound: f64,
}

/// Rows that hold together: always, or where a literal is true.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// What it is about, in words.
    pub name: String,
    /// What switches it on; `None` where nothing has to.
    pub literal: Option<Lit>,
    /// The linear rows.
    pub rows: Vec<Row>,
    /// The second-order cone rows.
    pub cones: Vec<Cone>,
}

/// The convex part of an instance.
#[derive(Clone, Debug, PartialEq)]
pub struct Convex {
    /// All variables, robot by robot.
    pub variables: Vec<Variable>,
    /// All blocks.
    pub blocks: Vec<Block>,
}

/// Builds the convex part for lengths up to `last`.
pub(super) struct Builder<'a> {
    problem: &'a Problem,
    abstraction: &'a Abstraction,
    bounds: Table<ModelId, Bounds>,
    last: usize,
    /// By robot: the index of its first variable.
    first: Vec<usize>,
    convex: Convex,
}

impl<'a> Builder<'a> {
    /// The trajectories of all robots: starts, dynamics and bounds.
    pub fn new(
        problem: &'a Problem,
        tubes: &Tubes,
        abstraction: &'a Abstraction,
        last: usize,
    ) -> Builder<'a> {
        let bounds = tubes.iter().map(|(id, tube)| abstraction.bounds(problem, id, tube)).collect();
        let convex = Convex { variables: Vec::new(), blocks: Vec::new() };
        let mut builder = Builder { problem, abstraction, bounds, last, first: Vec::new(), convex };
        problem.robots.ids().for_each(|robot| builder.add_variables(robot));
        for robot in problem.robots.ids() {
            builder.add_start(robot);
            (0..=last).for_each(|step| builder.add_step(robot, step));
        }
        builder
    }

    /// All that was added.
    pub fn finish(self) -> Convex {
        self.convex
    }

    fn add_variables(&mut self, robot: RobotId) {
        let model = &self.problem.models[self.problem.robots[robot].model];
        self.first.push(self.convex.variables.len());
        for step in 0..=self.last + 1 {
            let states = (0..model.n()).map(|state| Variable::State { robot, step, state });
            self.convex.variables.extend(states);
            if step <= self.last {
                let inputs = (0..model.m()).map(|input| Variable::Input { robot, step, input });
                self.convex.variables.extend(inputs);
            }
        }
    }

    fn state(&self, robot: RobotId, step: usize, state: usize) -> usize {
        let model = &self.problem.models[self.problem.robots[robot].model];
        self.first[robot.index()] + step * (model.n() + model.m()) + state
    }

    fn input(&self, robot: RobotId, step: usize, input: usize) -> usize {
        let model = &self.problem.models[self.problem.robots[robot].model];
        self.state(robot, step, model.n() + input)
    }

    fn coordinate(&self, robot: RobotId, step: usize, axis: usize) -> usize {
        let model = &self.problem.models[self.problem.robots[robot].model];
        self.state(robot, step, model.position[axis])
    }

    fn push(&mut self, name: String, literal: Option<Lit>, rows: Vec<Row>) {
        if !rows.is_empty() {
            self.convex.blocks.push(Block { name, literal, rows, cones: Vec::new() });
        }
    }

    fn add_start(&mut self, robot: RobotId) {
        let entry = &self.problem.robots[robot];
        let row = |(s, x): (usize, &Rational)| Row {
            terms: vec![(self.state(robot, 0, s), 1.0)],
            relation: Relation::Equal,
            bound: x.to_f64(),
        };
        let rows = entry.start.iter().enumerate().map(row).collect();
        self.push(format!("start of {}", entry.name), None, rows);
    }

    /// The dynamics from a step to the next, the bounds of the input here and of the state there.
    fn add_step(&mut self, robot: RobotId, step: usize) {
        let entry = &self.problem.robots[robot];
        let (model, name) = (&self.problem.models[entry.model], &entry.name);
        let dynamics = (0..model.n()).map(|s| self.dynamics_row(robot, step, s));
        let dynamics = dynamics.collect();
        self.push(format!("dynamics of {name} from {step} to {}", step + 1), None, dynamics);
        let rows = self.input_rows(robot, step);
        self.push(format!("input bounds of {name} at {step}"), None, rows);
        let rows = self.state_rows(robot, step + 1);
        self.push(format!("state bounds of {name} at {}", step + 1), None, rows);
    }

    /// z⁺ − A z − B v = drift in one state.
    ///
    /// The row is multiplied by the common denominator of the model's exact numbers, so that doubles
    /// say them exactly: 48, 24, 6, 1 instead of 1, 0.5, 0.125 and something next to 1/48. That is
    /// also what keeps an exact solver's numbers short.
    fn dynamics_row(&self, robot: RobotId, step: usize, s: usize) -> Row {
        let model = &self.problem.models[self.problem.robots[robot].model];
        let (n, m) = (model.n(), model.m());
        let mut variables = vec![self.state(robot, step + 1, s)];
        variables.extend((0..n).map(|j| self.state(robot, step, j)));
        variables.extend((0..m).map(|j| self.input(robot, step, j)));
        let mut numbers = vec![Rational::from(1)];
        numbers.extend((0..n).map(|j| -&model.a[(s, j)]));
        numbers.extend((0..m).map(|j| -&model.b[(s, j)]));
        numbers.push(&model.c[s] + &model.mean()[s]);
        let whole = primitive(&numbers);
        if whole.iter().all(|x| x.bits() <= MANTISSA) {
            numbers = whole;
        }
        let terms = variables.into_iter().zip(numbers.iter().map(Rational::to_f64));
        row(terms.collect(), Relation::Equal, numbers.last().map_or(0.0, Rational::to_f64))
    }

    fn input_rows(&self, robot: RobotId, step: usize) -> Vec<Row> {
        let entry = &self.problem.robots[robot];
        let bounds = &self.bounds[entry.model];
        let n = self.problem.models[entry.model].n();
        let boxes = bounds.inputs.iter().enumerate();
        let mut rows: Vec<Row> = boxes.flat_map(|(u, b)| between(self.input(robot, step, u), *b)).collect();
        let variable =
            |j: usize| if j < n { self.state(robot, step, j) } else { self.input(robot, step, j - n) };
        rows.extend(bounds.mixed.iter().map(|mixed| {
            let terms = mixed.normal.iter().enumerate().map(|(j, x)| (variable(j), *x));
            row(terms.collect(), Relation::AtMost, mixed.offset)
        }));
        rows
    }

    fn state_rows(&self, robot: RobotId, step: usize) -> Vec<Row> {
        let bounds = &self.bounds[self.problem.robots[robot].model];
        let boxes = bounds.states.iter().enumerate();
        let mut rows: Vec<Row> = boxes.flat_map(|(s, b)| between(self.state(robot, step, s), *b)).collect();
        rows.extend(bounds.walls.iter().map(|wall| self.half_space(robot, step, wall)));
        rows
    }

    fn half_space(&self, robot: RobotId, step: usize, half_space: &crate::abstraction::HalfSpace) -> Row {
        let vector = &self.abstraction.directions[half_space.direction].vector;
        let terms = vector.iter().enumerate().map(|(axis, x)| (self.coordinate(robot, step, axis), *x));
        row(terms.collect(), Relation::AtMost, half_space.offset)
    }

    /// The rows that a leaf of the Boolean part switches on.
    pub fn add_leaf(&mut self, lit: Lit, leaf: &Leaf) {
        match leaf {
            Leaf::HalfSpace { robot, step, half_space } => {
                let name = &self.problem.robots[*robot].name;
                let title = format!("{name} in a half-space at {step}");
                let rows = vec![self.half_space(*robot, *step, half_space)];
                self.push(title, Some(lit), rows);
            }
            Leaf::Apart(face) => self.add_face(lit, *face),
            Leaf::Near(near) => self.add_near(lit, near),
        }
    }

    fn add_face(&mut self, lit: Lit, face: Face) {
        let pair = [face.first, face.second];
        let least = self.abstraction.least_apart(self.problem, pair, face.axis, face.positive);
        let sign = if face.positive { 1.0 } else { -1.0 };
        let at = |step: usize| {
            let terms = vec![
                (self.coordinate(face.first, step, face.axis), -sign),
                (self.coordinate(face.second, step, face.axis), sign),
            ];
            row(terms, Relation::AtMost, -least)
        };
        let rows = vec![at(face.step), at(face.step + 1)];
        let [first, second] = pair.map(|robot| &self.problem.robots[robot].name);
        let title = format!("{first} and {second} apart from {} to {}", face.step, face.step + 1);
        self.push(title, Some(lit), rows);
    }

    fn add_near(&mut self, lit: Lit, near: &Near) {
        let mut terms = Vec::new();
        for (robot, sign) in near.robots() {
            let along =
                near.axes().map(|axis| (self.coordinate(robot, near.step, axis), sign * near.normal[axis]));
            terms.extend(along);
        }
        let rows = vec![row(terms, Relation::AtMost, near.offset)];
        let names: Vec<&str> = near.robots().map(|(robot, _)| &*self.problem.robots[robot].name).collect();
        let title = format!("{} near at {}", names.join(" and "), near.step);
        self.push(title, Some(lit), rows);
    }

    /// With a Euclidean range: a cone for each corner that the ends' errors can differ by.
    pub fn add_link(&mut self, lit: Lit, link: Link, step: usize) {
        let abstraction = self.abstraction;
        let Some(range) = abstraction.range.as_ref().filter(|r| r.norm == Norm::Euclidean) else { return };
        let sum = |axis: usize, corner: &[f64]| match link {
            Link::Robots(a, b) => {
                let terms =
                    vec![(self.coordinate(a, step, axis), 1.0), (self.coordinate(b, step, axis), -1.0)];
                (row(terms, Relation::AtMost, 0.0).terms, corner[axis])
            }
            Link::Base(robot, base) => {
                (vec![(self.coordinate(robot, step, axis), 1.0)], corner[axis] - abstraction.base(base)[axis])
            }
        };
        let cone = |corner: &Vec<f64>| Cone {
            sums: (0..corner.len()).map(|axis| sum(axis, corner)).collect(),
            bound: range.length,
        };
        let cones = range.corners(link_models(self.problem, link)).iter().map(cone).collect();
        let (from, to) = match link {
            Link::Robots(a, b) => (&self.problem.robots[a].name, &self.problem.robots[b].name),
            Link::Base(robot, base) => (&self.problem.robots[robot].name, &self.problem.bases[base].name),
        };
        let name = format!("{from} and {to} in range at {step}");
        self.convex.blocks.push(Block { name, literal: Some(lit), rows: Vec::new(), cones });
    }

    /// z_{L+1} = z_k for all robots.
    pub fn add_loop(&mut self, lit: Lit, length: usize, back: usize) {
        let mut rows = Vec::new();
        for (robot, entry) in self.problem.robots.iter() {
            for s in 0..self.problem.models[entry.model].n() {
                let terms = vec![(self.state(robot, back, s), -1.0), (self.state(robot, length + 1, s), 1.0)];
                rows.push(row(terms, Relation::Equal, 0.0));
            }
        }
        self.push(format!("loop from {length} to {back}"), Some(lit), rows);
    }
}

/// A row with its terms in order and none that is 0.
fn row(mut terms: Vec<(usize, f64)>, relation: Relation, bound: f64) -> Row {
    terms.retain(|(_, x)| *x != 0.0);
    terms.sort_by_key(|(variable, _)| *variable);
    Row { terms, relation, bound }
}

/// lo ≤ variable ≤ hi, where finite.
fn between(variable: usize, (lo, hi): (f64, f64)) -> Vec<Row> {
    let below = hi.is_finite().then(|| row(vec![(variable, 1.0)], Relation::AtMost, hi));
    let above = lo.is_finite().then(|| row(vec![(variable, -1.0)], Relation::AtMost, -lo));
    below.into_iter().chain(above).collect()
}
