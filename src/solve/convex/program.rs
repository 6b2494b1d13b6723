//! The linear program of one cluster of robots' blocks, for one length.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector};
use rustsat::types::Lit;

use crate::abstraction::{Abstraction, DirectionId};
use crate::encode::{Face, Leaf, Near};
use crate::ir::RobotId;

use super::certificate::{Conflict, Functional, Lasso, Part, Proof, Term};
use super::simplex::{Answer, Form, Simplex};
use super::system::System;

/// One robot's block of states and inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Node {
    /// The robot.
    pub robot: RobotId,
    /// The index of the block in its system.
    pub block: usize,
}

/// What a program says of a candidate.
#[derive(Clone, Debug)]
pub enum Verdict {
    /// There is a nominal trajectory; the program holds it.
    Feasible,
    /// There is none, for a proved reason.
    Infeasible(Box<Conflict>),
    /// Numbers ran out.
    Undecided,
}

/// A linear function of a cluster's trajectories, up to sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Key {
    State(RobotId, usize, usize),
    Input(RobotId, usize, usize),
    Direction(RobotId, usize, DirectionId),
    Mixed(RobotId, usize, usize),
    Apart(RobotId, RobotId, usize, usize),
    Near(RobotId, Option<RobotId>, usize, [u64; 3]),
    Loop(RobotId, usize, usize),
}

/// A form of the simplex with what it means.
#[derive(Clone, Debug)]
struct Row {
    form: Form,
    functional: Functional,
    /// The part of the value that no unknown changes.
    constant: f64,
    /// Bounds that always hold.
    always: (f64, f64),
    /// Bounds in force, with the candidate's constraint that set each.
    now: [(f64, Option<usize>); 2],
}

/// A member of the cluster: a robot with its system and the free evolution from its start.
#[derive(Clone, Debug)]
pub struct Member<'a> {
    /// The robot.
    pub robot: RobotId,
    /// Its system.
    pub system: &'a System,
    /// x̄₀.
    pub start: DVector<f64>,
    /// The states z_0 … z_{L+1} when all unknowns are 0.
    pub free: Vec<DVector<f64>>,
}

impl<'a> Member<'a> {
    /// A robot's system over a length.
    pub fn new(robot: RobotId, system: &'a System, start: DVector<f64>, length: usize) -> Member<'a> {
        let mut free = vec![start.clone()];
        for t in 0..=length {
            free.push(&system.closed * &free[t] + &system.drift);
        }
        Member { robot, system, start, free }
    }
}

/// The linear program of a cluster.
pub struct Program<'a> {
    abstraction: &'a Abstraction,
    length: usize,
    members: Vec<Member<'a>>,
    nodes: Vec<Node>,
    /// For each member and input: the column of w_0, if the input's block is in the cluster.
    columns: Vec<Vec<Option<usize>>>,
    /// For each state, the column of its value at step 0, when the start is free.
    starts: Vec<Option<usize>>,
    /// (A + B G)^t for each step, when the start is free.
    powers: Vec<DMatrix<f64>>,
    /// How many columns a step takes.
    stride: usize,
    simplex: Simplex,
    rows: Vec<Row>,
    index: HashMap<Key, usize>,
    touched: Vec<usize>,
}

impl<'a> Program<'a> {
    /// The program of a cluster, with the bounds that always hold.
    ///
    /// `members` are the robots of `nodes`, each once, in the order of the nodes.
    pub fn new(
        abstraction: &'a Abstraction,
        length: usize,
        members: Vec<Member<'a>>,
        nodes: Vec<Node>,
    ) -> Program<'a> {
        Program::build(abstraction, length, members, nodes, false)
    }

    /// The program of one robot's block that starts anywhere within its bounds.
    pub fn free(abstraction: &'a Abstraction, length: usize, member: Member<'a>, node: Node) -> Program<'a> {
        Program::build(abstraction, length, vec![member], vec![node], true)
    }

    fn build(
        abstraction: &'a Abstraction,
        length: usize,
        members: Vec<Member<'a>>,
        nodes: Vec<Node>,
        free: bool,
    ) -> Program<'a> {
        let mut stride = 0;
        let mut columns: Vec<Vec<Option<usize>>> = members.iter().map(|m| vec![None; m.system.m]).collect();
        for node in &nodes {
            let at = members.iter().position(|m| m.robot == node.robot).unwrap_or(0);
            for &u in &members[at].system.blocks[node.block].inputs {
                columns[at][u] = Some(stride);
                stride += 1;
            }
        }
        let (starts, powers) = if free { start_columns(&members, &nodes, length) } else { (vec![], vec![]) };
        let width = starts.iter().flatten().count();
        let mut program = Program {
            abstraction,
            starts,
            powers,
            length,
            members,
            nodes,
            columns,
            stride,
            simplex: Simplex::new(width + stride * (length + 1)),
            rows: Vec::new(),
            index: HashMap::new(),
            touched: Vec::new(),
        };
        program.add_bounds();
        program
    }

    /// The bounds on states, inputs and slanted walls at every step.
    fn add_bounds(&mut self) {
        for node in self.nodes.clone() {
            let at = self.member(node.robot);
            let system = self.members[at].system;
            let block = &system.blocks[node.block];
            for t in usize::from(self.starts.is_empty())..=self.length + 1 {
                for &s in block.states.iter().filter(|&&s| bounded(system.state_bounds[s])) {
                    self.bound(Key::State(node.robot, t, s), system.state_bounds[s]);
                }
                for wall in self.walls(at, node.block) {
                    let up = (f64::NEG_INFINITY, wall.offset);
                    self.bound_direction(node.robot, t, wall.direction, up);
                }
            }
            for t in 0..=self.length {
                for &u in &block.inputs {
                    self.bound(Key::Input(node.robot, t, u), system.input_bounds[u]);
                }
                for row in 0..system.mixed.len() {
                    let first = system.mixed[row].normal.iter().position(|x| *x != 0.0);
                    if first.is_some_and(|j| {
                        block.states.contains(&j) || block.inputs.contains(&j.wrapping_sub(system.n))
                    }) {
                        let up = (f64::NEG_INFINITY, system.mixed[row].offset);
                        self.bound(Key::Mixed(node.robot, t, row), up);
                    }
                }
            }
        }
    }

    fn walls(&self, member: usize, block: usize) -> Vec<crate::abstraction::HalfSpace> {
        let system = self.members[member].system;
        let first = |direction: DirectionId| {
            self.abstraction.directions[direction].vector.iter().position(|x| *x != 0.0).unwrap_or(0)
        };
        let own = |direction| system.blocks[block].states.contains(&system.position[first(direction)]);
        system.walls.iter().copied().filter(|w| own(w.direction)).collect()
    }

    fn bound(&mut self, key: Key, always: (f64, f64)) {
        let row = self.row(key);
        let row = &mut self.rows[row];
        row.always = (row.always.0.max(always.0), row.always.1.min(always.1));
        row.now = [(row.always.0, None), (row.always.1, None)];
        self.simplex.set_bounds(row.form, row.always.0 - row.constant, row.always.1 - row.constant);
    }

    fn bound_direction(&mut self, robot: RobotId, step: usize, direction: DirectionId, always: (f64, f64)) {
        let (key, flipped) = self.direction_key(robot, step, direction);
        self.bound(key, if flipped { (-always.1, -always.0) } else { always });
    }

    /// The key of d · z, and whether the key's form is its negative.
    fn direction_key(&self, robot: RobotId, step: usize, direction: DirectionId) -> (Key, bool) {
        let entry = &self.abstraction.directions[direction];
        let mut axes = entry.vector.iter().enumerate().filter(|(_, x)| **x != 0.0);
        if let (Some((axis, x)), None) = (axes.next(), axes.next()) {
            let system = self.members[self.member(robot)].system;
            return (Key::State(robot, step, system.position[axis]), *x < 0.0);
        }
        let flipped = entry.opposite < direction;
        (Key::Direction(robot, step, if flipped { entry.opposite } else { direction }), flipped)
    }

    fn member(&self, robot: RobotId) -> usize {
        self.members.iter().position(|m| m.robot == robot).unwrap_or(0)
    }

    /// The row of a key, added when it is new.
    fn row(&mut self, key: Key) -> usize {
        if let Some(&row) = self.index.get(&key) {
            return row;
        }
        let functional = self.functional(key);
        let mut coefficients = vec![0.0; self.width() + self.stride * (self.length + 1)];
        let mut constant = 0.0;
        for part in &functional.parts {
            constant += self.add_part(part, &mut coefficients);
        }
        let form = self.simplex.add_form(coefficients);
        let open = (f64::NEG_INFINITY, f64::INFINITY);
        let now = [(open.0, None), (open.1, None)];
        self.rows.push(Row { form, functional, constant, always: open, now });
        self.index.insert(key, self.rows.len() - 1);
        self.rows.len() - 1
    }

    /// What a key means, over states and inputs.
    fn functional(&self, key: Key) -> Functional {
        let unit = |robot: RobotId, step: usize, s: usize, sign: f64| Part {
            robot,
            step,
            state: vec![(s, sign)],
            input: Vec::new(),
        };
        let parts = match key {
            Key::State(robot, step, s) => vec![unit(robot, step, s, 1.0)],
            Key::Input(robot, step, u) => {
                vec![Part { robot, step, state: Vec::new(), input: vec![(u, 1.0)] }]
            }
            Key::Direction(robot, step, direction) => {
                let system = self.members[self.member(robot)].system;
                let vector = &self.abstraction.directions[direction].vector;
                let state = vector.iter().enumerate().map(|(axis, x)| (system.position[axis], *x));
                vec![Part { robot, step, state: state.collect(), input: Vec::new() }]
            }
            Key::Mixed(robot, step, row) => {
                let system = self.members[self.member(robot)].system;
                let (state, input) = system.mixed[row].normal.split_at(system.n);
                let sparse = |v: &[f64]| v.iter().copied().enumerate().filter(|(_, x)| *x != 0.0).collect();
                vec![Part { robot, step, state: sparse(state), input: sparse(input) }]
            }
            Key::Apart(first, second, step, axis) => {
                let at = |robot: RobotId| self.members[self.member(robot)].system.position[axis];
                vec![unit(first, step, at(first), 1.0), unit(second, step, at(second), -1.0)]
            }
            Key::Near(first, second, step, normal) => {
                let near = Near { first, second, step, normal: normal.map(f64::from_bits), offset: 0.0 };
                let of = |(robot, sign): (RobotId, f64)| {
                    let position = &self.members[self.member(robot)].system.position;
                    let state = near.axes().map(|axis| (position[axis], sign * near.normal[axis]));
                    Part { robot, step, state: state.collect(), input: Vec::new() }
                };
                near.robots().map(of).collect()
            }
            Key::Loop(robot, back, s) => {
                vec![unit(robot, self.length + 1, s, 1.0), unit(robot, back, s, -1.0)]
            }
        };
        Functional { parts }
    }

    /// Adds a part's coefficients over the unknowns and returns its constant.
    fn add_part(&self, part: &Part, coefficients: &mut [f64]) -> f64 {
        let at = self.member(part.robot);
        let member = &self.members[at];
        let system = member.system;
        // A function of the input is one of the state and of the newest unknown: v = G z + w.
        let mut weights = vec![0.0; system.n];
        for &(s, x) in &part.state {
            weights[s] += x;
        }
        for &(u, x) in &part.input {
            for (s, weight) in weights.iter_mut().enumerate() {
                *weight += x * system.gain[(u, s)];
            }
            if let Some(column) = self.columns[at][u] {
                coefficients[self.width() + part.step * self.stride + column] += x * system.units[u];
            }
        }
        for (age, response) in system.responses.iter().enumerate().take(part.step) {
            let step = part.step - 1 - age;
            for (u, column) in self.columns[at].iter().enumerate() {
                let Some(column) = column else { continue };
                let gain: f64 = weights.iter().enumerate().map(|(s, x)| x * response[(s, u)]).sum();
                coefficients[self.width() + step * self.stride + column] += gain * system.units[u];
            }
        }
        for (s, column) in self.starts.iter().enumerate() {
            let (Some(column), Some(power)) = (column, self.powers.get(part.step)) else { continue };
            let gain: f64 = weights.iter().enumerate().map(|(r, x)| x * power[(r, s)]).sum();
            coefficients[*column] += gain * extent(system.state_bounds[s]);
        }
        weights.iter().zip(member.free[part.step].iter()).map(|(a, b)| a * b).sum()
    }

    /// How many columns the start takes.
    fn width(&self) -> usize {
        self.starts.iter().flatten().count()
    }

    /// The contradiction of some half-spaces of one robot, whose steps count from `first`; only for
    /// a program with a free start.
    pub fn refute_window(&mut self, constraints: &[(Lit, Leaf)], first: usize) -> Option<Conflict> {
        self.reset();
        for (at, (_, leaf)) in constraints.iter().enumerate() {
            if let Leaf::HalfSpace { step, half_space, .. } = *leaf {
                let robot = self.members[0].robot;
                let (key, flipped) = self.direction_key(robot, step - first, half_space.direction);
                let offset = if flipped { -half_space.offset } else { half_space.offset };
                self.tighten(key, !flipped, offset, at);
            }
        }
        self.apply();
        match self.decide(constraints, self.length + 1) {
            Verdict::Infeasible(conflict) => Some(*conflict),
            Verdict::Feasible | Verdict::Undecided => None,
        }
    }

    /// Decides a candidate's constraints on this cluster, with the loop back to `loop_start`.
    pub fn check(
        &mut self,
        constraints: &[(Lit, Leaf)],
        loop_start: usize,
        offsets: &dyn Fn(Face) -> f64,
    ) -> Verdict {
        self.reset();
        for (at, (_, leaf)) in constraints.iter().enumerate() {
            match *leaf {
                Leaf::HalfSpace { robot, step, half_space } => {
                    let (key, flipped) = self.direction_key(robot, step, half_space.direction);
                    let offset = if flipped { -half_space.offset } else { half_space.offset };
                    self.tighten(key, !flipped, offset, at);
                }
                Leaf::Apart(face) => {
                    let offset = if face.positive { offsets(face) } else { -offsets(face) };
                    for step in [face.step, face.step + 1] {
                        let key = Key::Apart(face.first, face.second, step, face.axis);
                        self.tighten(key, !face.positive, offset, at);
                    }
                }
                Leaf::Near(near) => {
                    // Opposite normals share a form.
                    let flipped = near.axes().next().is_some_and(|axis| near.normal[axis] < 0.0);
                    let sign = if flipped { -1.0 } else { 1.0 };
                    let normal = near.normal.map(|x| (sign * x + 0.0).to_bits());
                    let key = Key::Near(near.first, near.second, near.step, normal);
                    self.tighten(key, !flipped, sign * near.offset, at);
                }
            }
        }
        // First without the loop: a contradiction that doesn't need it holds for every lasso.
        self.apply();
        let open = self.decide(constraints, loop_start);
        if !matches!(open, Verdict::Feasible) {
            return open;
        }
        self.close_loop(loop_start);
        self.apply();
        self.decide(constraints, loop_start)
    }

    fn decide(&mut self, constraints: &[(Lit, Leaf)], loop_start: usize) -> Verdict {
        for attempt in 0..3 {
            match self.simplex.check() {
                Answer::Feasible => return Verdict::Feasible,
                Answer::Infeasible(terms) => {
                    if let Some(conflict) = self.conflict(&terms, constraints, loop_start) {
                        return Verdict::Infeasible(Box::new(conflict));
                    }
                }
                Answer::Undecided => {}
            }
            // A contradiction that does not survive, or a lost basis: once more from fresh numbers,
            // then from the beginning.
            if attempt > 0 || !self.simplex.refactor() {
                self.simplex.restart();
            }
        }
        Verdict::Undecided
    }

    fn reset(&mut self) {
        for row in self.touched.drain(..) {
            let row = &mut self.rows[row];
            row.now = [(row.always.0, None), (row.always.1, None)];
            self.simplex.set_bounds(row.form, row.always.0 - row.constant, row.always.1 - row.constant);
        }
    }

    /// z_{L+1} = z_k.
    fn close_loop(&mut self, back: usize) {
        for node in self.nodes.clone() {
            let at = self.member(node.robot);
            for &s in &self.members[at].system.blocks[node.block].states {
                let row = self.row(Key::Loop(node.robot, back, s));
                self.rows[row].now = [(0.0, None), (0.0, None)];
                self.touched.push(row);
            }
        }
    }

    fn tighten(&mut self, key: Key, upper: bool, value: f64, constraint: usize) {
        let at = self.row(key);
        let now = &mut self.rows[at].now[usize::from(upper)];
        if if upper { value < now.0 } else { value > now.0 } {
            *now = (value, Some(constraint));
        }
        self.touched.push(at);
    }

    fn apply(&mut self) {
        for &row in &self.touched {
            let row = &self.rows[row];
            self.simplex.set_bounds(row.form, row.now[0].0 - row.constant, row.now[1].0 - row.constant);
        }
    }

    /// The contradiction in terms of bounds on trajectories, if it is one in exact arithmetic.
    fn conflict(
        &self,
        terms: &[(Form, bool, f64)],
        constraints: &[(Lit, Leaf)],
        loop_start: usize,
    ) -> Option<Conflict> {
        let mut proof = Vec::new();
        for &(form, upper, multiple) in terms {
            let row = self.rows.get(form.index())?;
            let (bound, constraint) = row.now[usize::from(upper)];
            let sign = if upper { 1.0 } else { -1.0 };
            proof.push(Term {
                functional: row.functional.clone(),
                sign,
                multiple,
                bound: sign * bound,
                constraint: constraint.map(|at| constraints[at]),
            });
        }
        let lasso = Lasso { length: self.length, back: loop_start };
        let proof = Proof { terms: proof, lasso };
        if self.starts.is_empty() {
            Conflict::new(proof, &self.members)
        } else {
            Conflict::free(proof, &self.members)
        }
    }

    /// The unknowns of each member, with 0 for inputs outside the cluster, after a feasible check.
    pub fn unknowns(&self) -> Vec<(RobotId, Vec<DVector<f64>>)> {
        let values = self.simplex.columns();
        let step = |at: usize, t: usize| {
            let system = self.members[at].system;
            let first = self.width() + t * self.stride;
            let entry = |u: usize| self.columns[at][u].map_or(0.0, |c| values[first + c] * system.units[u]);
            DVector::from_iterator(system.m, (0..system.m).map(entry))
        };
        let steps = |at: usize| (0..=self.length).map(|t| step(at, t)).collect();
        (0..self.members.len()).map(|at| (self.members[at].robot, steps(at))).collect()
    }
}

/// The columns of a free start, and how the start fades.
fn start_columns(
    members: &[Member<'_>],
    nodes: &[Node],
    length: usize,
) -> (Vec<Option<usize>>, Vec<DMatrix<f64>>) {
    let (Some(member), Some(node)) = (members.first(), nodes.first()) else { return (vec![], vec![]) };
    let system = member.system;
    let states = &system.blocks[node.block].states;
    let starts = (0..system.n).map(|s| states.iter().position(|x| *x == s)).collect();
    let mut powers = vec![DMatrix::identity(system.n, system.n)];
    for t in 0..=length {
        powers.push(&system.closed * &powers[t]);
    }
    (starts, powers)
}

/// The extent of an interval, 1 when it has none.
fn extent((lo, hi): (f64, f64)) -> f64 {
    if (hi - lo).is_finite() && hi > lo { hi - lo } else { 1.0 }
}

fn bounded((lo, hi): (f64, f64)) -> bool {
    lo.is_finite() || hi.is_finite()
}
