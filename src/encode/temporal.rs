//! Temporal logic on lassos, by a linear encoding that grows with the length.
//!
//! Every subformula has a value at every position, and 'until' a second one inside the loop that
//! makes it fulfil its promise before the loop ends (Biere, Heljanko, Junttila, Latvala and
//! Schuppan 2006). The formula is in negation normal form, so each value is encoded in one direction
//! only and 'release', a greatest fixpoint, needs no second value.

use crate::entity::EntityId;
use crate::ir::{Comparison, Formula, FormulaId, Problem, RegionId, RobotId};
use rustsat::types::Lit;

use super::circuit::{Bit, Circuit, Gate, Successor};

/// A subformula with its windows unrolled.
#[derive(Clone, Debug)]
enum Node {
    Constant(bool),
    In(RobotId, RegionId),
    Out(RobotId, RegionId),
    Compare(Comparison),
    And(Vec<usize>),
    Or(Vec<usize>),
    Next(usize),
    Until(usize, usize),
    Release(usize, usize),
}

/// A question about the present position.
#[derive(Clone, Debug)]
pub enum Ask {
    /// Is the robot certainly in the region?
    In(RobotId, RegionId),
    /// Is the robot certainly out of it?
    Out(RobotId, RegionId),
    /// Does the comparison hold whatever the unknown atoms are?
    Compare(Comparison),
}

/// The values of all subformulas at the positions encoded so far.
#[derive(Debug)]
pub struct Temporal {
    /// Operands before their users.
    nodes: Vec<Node>,
    goals: Vec<usize>,
    /// Whether a node's value is asked for after position 0.
    later: Vec<bool>,
    /// By position and node.
    values: Vec<Vec<Bit>>,
    /// By position and node: the second value of an 'until'.
    fulfilled: Vec<Vec<Bit>>,
    /// By position: the nodes whose value at the next position is used.
    successors: Vec<Vec<(usize, Lit)>>,
    /// By position: the 'untils' whose second value at the next position is used.
    second_successors: Vec<Vec<(usize, Lit)>>,
}

impl Temporal {
    /// The problem's goals, with no position encoded.
    pub fn new(problem: &Problem) -> Temporal {
        let mut unroll = Unroll { nodes: Vec::new(), longest: problem.horizon.1 as u32 + 1 };
        let mut of_formula = Vec::new();
        for (_, formula) in problem.formulas.nodes().iter() {
            let node = unroll.formula(formula, &of_formula);
            of_formula.push(node);
        }
        let goals: Vec<usize> = problem.goals.iter().map(|g| of_formula[g.formula.index()]).collect();
        let mut temporal = Temporal {
            later: Vec::new(),
            nodes: unroll.nodes,
            goals,
            values: Vec::new(),
            fulfilled: Vec::new(),
            successors: Vec::new(),
            second_successors: Vec::new(),
        };
        temporal.keep_needed();
        temporal
    }

    /// Drops what no goal uses and marks what is used after position 0.
    fn keep_needed(&mut self) {
        let mut now = vec![false; self.nodes.len()];
        let mut later = vec![false; self.nodes.len()];
        for &goal in &self.goals {
            now[goal] = true;
        }
        for id in (0..self.nodes.len()).rev() {
            let (here, after) = (now[id] || later[id], later[id]);
            if !here {
                continue;
            }
            let temporal = matches!(self.nodes[id], Node::Next(_) | Node::Until(..) | Node::Release(..));
            for operand in self.nodes[id].operands() {
                now[operand] = true;
                later[operand] |= after || temporal;
            }
            later[id] |= matches!(self.nodes[id], Node::Until(..) | Node::Release(..));
        }
        for (id, needed) in now.iter().enumerate() {
            if !needed {
                self.nodes[id] = Node::Constant(false);
            }
        }
        self.later = later;
    }

    /// What [`extend`](Temporal::extend) wants to know of the next position, in order.
    pub fn asks(&self) -> Vec<Ask> {
        let step = self.values.len();
        let asked = self.nodes.iter().enumerate().filter(|(id, _)| step == 0 || self.later[*id]);
        let ask = |node: &Node| match node {
            Node::In(robot, region) => Some(Ask::In(*robot, *region)),
            Node::Out(robot, region) => Some(Ask::Out(*robot, *region)),
            Node::Compare(comparison) => Some(Ask::Compare(comparison.clone())),
            _ => None,
        };
        asked.filter_map(|(_, node)| ask(node)).collect()
    }

    /// Encodes the next position, from the answers to its [asks](Temporal::asks). Returns the goals'
    /// values at position 0 when that is the one encoded.
    ///
    /// `was_last` says that the position before is the last one; it goes on here otherwise.
    pub fn extend(&mut self, circuit: &mut Circuit, was_last: Option<Lit>, answers: &[Bit]) -> Vec<Bit> {
        let step = self.values.len();
        let mut answers = answers.iter().copied();
        let mut values = vec![Bit::False; self.nodes.len()];
        let mut fulfilled = vec![Bit::False; self.nodes.len()];
        let mut next = Vec::new();
        let mut second = Vec::new();
        for (id, node) in self.nodes.iter().enumerate() {
            if step > 0 && !self.later[id] {
                continue;
            }
            values[id] = match node {
                Node::Constant(value) => Bit::from(*value),
                Node::In(..) | Node::Out(..) | Node::Compare(_) => answers.next().unwrap_or(Bit::False),
                Node::And(operands) => circuit.and(operands.iter().map(|&o| values[o])),
                Node::Or(operands) => circuit.or(operands.iter().map(|&o| values[o])),
                Node::Next(operand) => successor(circuit, step, *operand, &mut next),
                Node::Until(a, b) => {
                    let again = successor(circuit, step, id, &mut second);
                    let rest = circuit.and([values[*a], again]);
                    fulfilled[id] = circuit.or([values[*b], rest]);
                    let again = successor(circuit, step, id, &mut next);
                    let rest = circuit.and([values[*a], again]);
                    circuit.or([values[*b], rest])
                }
                Node::Release(a, b) => {
                    let again = successor(circuit, step, id, &mut next);
                    let rest = circuit.or([values[*a], again]);
                    circuit.and([values[*b], rest])
                }
            };
        }
        let goals = if step == 0 { self.goals.iter().map(|&g| values[g]).collect() } else { Vec::new() };
        self.values.push(values);
        self.fulfilled.push(fulfilled);
        self.successors.push(next);
        self.second_successors.push(second);
        if let (Some(last), true) = (was_last, step > 0) {
            self.go_on(circuit, step - 1, last);
        }
        goals
    }

    /// Ties the successors of a position to the next one, unless the position is the last.
    fn go_on(&self, circuit: &mut Circuit, step: usize, last: Lit) {
        let first = self.successors[step].iter().map(|&(id, lit)| (lit, self.values[step + 1][id]));
        let second =
            self.second_successors[step].iter().map(|&(id, lit)| (lit, self.fulfilled[step + 1][id]));
        for (lit, target) in first.chain(second) {
            circuit.imply(&[lit, !last], target);
            if let Gate::Successor(next) = circuit.gate_mut(lit) {
                next.onward = Some(target);
            }
        }
    }

    /// Ties the successors of the last position to where its loop goes back to: `loops[k]` implies
    /// that this is the last position and the next state is that of position k.
    pub fn close(&self, circuit: &mut Circuit, last: Lit, loops: &[Lit]) {
        let step = loops.len() - 1;
        for &(id, lit) in &self.successors[step] {
            let until = matches!(self.nodes[id], Node::Until(..));
            let values = if until { &self.fulfilled } else { &self.values };
            let wrap: Vec<Bit> = (0..loops.len()).map(|k| values[k][id]).collect();
            for (&back, &target) in loops.iter().zip(&wrap) {
                circuit.imply(&[lit, back], target);
            }
            if let Gate::Successor(next) = circuit.gate_mut(lit) {
                next.wrap = wrap;
            }
        }
        // An 'until' inside the loop that is still waiting at its end was not fulfilled in it.
        for &(_, lit) in &self.second_successors[step] {
            circuit.clause(&[!lit, !last]);
        }
    }
}

fn successor(circuit: &mut Circuit, step: usize, node: usize, used: &mut Vec<(usize, Lit)>) -> Bit {
    if let Some(&(_, lit)) = used.iter().rev().find(|(id, _)| *id == node) {
        return Bit::Lit(lit);
    }
    let lit = circuit.define(Gate::Successor(Successor { step, onward: None, wrap: Vec::new() }));
    used.push((node, lit));
    Bit::Lit(lit)
}

impl Node {
    fn operands(&self) -> Vec<usize> {
        match self {
            Node::Constant(_) | Node::In(..) | Node::Out(..) | Node::Compare(_) => Vec::new(),
            Node::And(operands) | Node::Or(operands) => operands.clone(),
            Node::Next(operand) => vec![*operand],
            Node::Until(a, b) | Node::Release(a, b) => vec![*a, *b],
        }
    }
}

/// Unrolls windows into chains of 'next'.
struct Unroll {
    nodes: Vec<Node>,
    /// The most positions that any lasso of the horizon has.
    longest: u32,
}

impl Unroll {
    fn push(&mut self, node: Node) -> usize {
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    fn formula(&mut self, formula: &Formula, ids: &[usize]) -> usize {
        let id = |f: &FormulaId| ids[f.index()];
        match formula {
            Formula::True => self.push(Node::Constant(true)),
            Formula::False => self.push(Node::Constant(false)),
            Formula::In(atom) => self.push(Node::In(atom.robot, atom.region)),
            Formula::Out(atom) => self.push(Node::Out(atom.robot, atom.region)),
            Formula::Compare(comparison) => self.push(Node::Compare(comparison.clone())),
            Formula::And(operands) => self.push(Node::And(operands.iter().map(id).collect())),
            Formula::Or(operands) => self.push(Node::Or(operands.iter().map(id).collect())),
            Formula::Next(operand) => self.push(Node::Next(id(operand))),
            Formula::Until(None, a, b) => self.push(Node::Until(id(a), id(b))),
            Formula::Release(None, a, b) => self.push(Node::Release(id(a), id(b))),
            Formula::Until(Some(window), a, b) => self.window(*window, id(a), id(b), true),
            Formula::Release(Some(window), a, b) => self.window(*window, id(a), id(b), false),
        }
    }

    /// `a U[m, n] b`, or its dual: b now or (a now and the rest at the next step), n − m times, and
    /// before that m times a now and the rest at the next step.
    ///
    /// A lasso has at most `longest` positions, so a window of as many steps sees all there is.
    fn window(&mut self, (m, n): (u32, u32), a: usize, b: usize, until: bool) -> usize {
        let mut node = if n - m >= self.longest {
            self.push(if until { Node::Until(a, b) } else { Node::Release(a, b) })
        } else {
            let mut node = b;
            for _ in m..n {
                let rest = self.step(a, node, until);
                node = self.push(if until { Node::Or(vec![b, rest]) } else { Node::And(vec![b, rest]) });
            }
            node
        };
        for _ in 0..m {
            node = self.step(a, node, until);
        }
        node
    }

    fn step(&mut self, a: usize, rest: usize, until: bool) -> usize {
        let next = self.push(Node::Next(rest));
        self.push(if until { Node::And(vec![a, next]) } else { Node::Or(vec![a, next]) })
    }
}
