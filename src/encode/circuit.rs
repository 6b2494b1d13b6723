//! A monotone circuit over SAT variables, written to clauses as it grows.
//!
//! Every gate is encoded in one direction only, *gate → what it means*, since the whole formula is
//! positive. That is what makes justification possible: from the asserted gates down, one true
//! input is enough for each disjunction, and only the leaves reached that way need to become
//! constraints. Every definition goes through this module, so none can be missed by that walk.

use std::collections::HashMap;

use rustsat::OutOfMemory;
use rustsat::encodings::CollectClauses;
use rustsat::instances::{BasicVarManager, Cnf, ManageVars};
use rustsat::types::{Clause, Lit};

use super::leaf::Leaf;

/// A truth value that may be known already.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bit {
    /// Never.
    False,
    /// Always.
    True,
    /// As the literal says.
    Lit(Lit),
}

impl From<bool> for Bit {
    fn from(value: bool) -> Bit {
        if value { Bit::True } else { Bit::False }
    }
}

/// What a variable stands for.
#[derive(Clone, Debug)]
pub enum Gate {
    /// A choice that nothing follows from, or a variable inside a library encoding.
    Choice,
    /// A constraint of the convex part.
    Leaf(Leaf),
    /// All of these; may grow.
    And(Vec<Lit>),
    /// Some of these.
    Or(Vec<Lit>),
    /// Both of some of these pairs.
    SomePair(Vec<(Lit, Lit)>),
    /// Weights of true literals that add up to at least the bound.
    AtLeast(Vec<(Lit, usize)>, usize),
    /// A formula's value at the position after a step.
    Successor(Successor),
}

/// Where the value at the position after a step comes from.
#[derive(Clone, Debug)]
pub struct Successor {
    /// The step.
    pub step: usize,
    /// The value at the next position, while the step is not the last; `None` until there is one.
    pub onward: Option<Bit>,
    /// The values at each position that the loop may go back to from here, while it is the last.
    pub wrap: Vec<Bit>,
}

/// The circuit with the clauses that no solver has taken yet.
#[derive(Debug, Default)]
pub struct Circuit {
    gates: Vec<Gate>,
    variables: BasicVarManager,
    pending: Cnf,
    clauses: usize,
    roots: Vec<Lit>,
    ands: HashMap<Vec<Lit>, Lit>,
    ors: HashMap<Vec<Lit>, Lit>,
    incomplete: bool,
}

impl Circuit {
    /// Notes that a definition had to be made stronger than it is, so that nothing is refuted.
    pub fn give_up(&mut self) {
        self.incomplete = true;
    }

    /// Whether some definition is stronger than it should be.
    pub fn is_incomplete(&self) -> bool {
        self.incomplete
    }

    /// A fresh variable that stands for a gate, as a positive literal.
    pub fn define(&mut self, gate: Gate) -> Lit {
        let lit = self.variables.new_var().pos_lit();
        self.gates.resize(lit.vidx(), Gate::Choice);
        self.gates.push(gate);
        lit
    }

    /// The gate of a literal's variable.
    pub fn gate(&self, lit: Lit) -> &Gate {
        self.gates.get(lit.vidx()).unwrap_or(&Gate::Choice)
    }

    /// The gate of a literal's variable, to be completed.
    pub fn gate_mut(&mut self, lit: Lit) -> &mut Gate {
        &mut self.gates[lit.vidx()]
    }

    /// The leaves with their literals, by rising variable.
    pub fn leaves(&self) -> impl Iterator<Item = (Lit, Leaf)> + '_ {
        let leaf = |(index, gate): (usize, &Gate)| match gate {
            Gate::Leaf(leaf) => Some((Lit::positive(index as u32), *leaf)),
            _ => None,
        };
        self.gates.iter().enumerate().filter_map(leaf)
    }

    /// The number of variables.
    pub fn variables(&self) -> usize {
        self.variables.n_used() as usize
    }

    /// The number of clauses written so far.
    pub fn clauses(&self) -> usize {
        self.clauses
    }

    /// The gates that must be true.
    pub fn roots(&self) -> &[Lit] {
        &self.roots
    }

    /// Adds a clause.
    pub fn clause(&mut self, literals: &[Lit]) {
        self.clauses += 1;
        self.pending.add_clause(literals.iter().copied().collect::<Clause>());
    }

    /// Adds the clause `conditions → bit`; the conditions are literals that must all be true.
    pub fn imply(&mut self, conditions: &[Lit], bit: Bit) {
        let mut literals: Vec<Lit> = conditions.iter().map(|l| !*l).collect();
        match bit {
            Bit::True => return,
            Bit::False => {}
            Bit::Lit(lit) => literals.push(lit),
        }
        self.clause(&literals);
    }

    /// Adds the clause `conditions → some bit`; the conditions are literals that must all be true.
    pub fn imply_some(&mut self, conditions: &[Lit], bits: &[Bit]) {
        let mut literals: Vec<Lit> = conditions.iter().map(|l| !*l).collect();
        for bit in bits {
            match bit {
                Bit::True => return,
                Bit::False => {}
                Bit::Lit(lit) => literals.push(*lit),
            }
        }
        self.clause(&literals);
    }

    /// Requires a bit, and makes it a root of justification.
    pub fn require(&mut self, bit: Bit) {
        self.imply(&[], bit);
        if let Bit::Lit(lit) = bit {
            self.roots.push(lit);
        }
    }

    /// Hands the clauses written since the last call to a solver or a file.
    ///
    /// # Errors
    /// When the collector's memory runs out.
    pub fn write_clauses(&mut self, collector: &mut impl CollectClauses) -> Result<(), OutOfMemory> {
        collector.extend_clauses(std::mem::take(&mut self.pending))
    }

    /// The conjunction.
    pub fn and(&mut self, bits: impl IntoIterator<Item = Bit>) -> Bit {
        let mut inputs = Vec::new();
        for bit in bits {
            match bit {
                Bit::False => return Bit::False,
                Bit::True => {}
                Bit::Lit(lit) => inputs.push(lit),
            }
        }
        inputs.sort_unstable();
        inputs.dedup();
        match inputs[..] {
            [] => Bit::True,
            [only] => Bit::Lit(only),
            _ => Bit::Lit(self.and_gate(inputs)),
        }
    }

    fn and_gate(&mut self, inputs: Vec<Lit>) -> Lit {
        if let Some(&lit) = self.ands.get(&inputs) {
            return lit;
        }
        let lit = self.define(Gate::And(inputs.clone()));
        for &input in &inputs {
            self.clause(&[!lit, input]);
        }
        self.ands.insert(inputs, lit);
        lit
    }

    /// The disjunction.
    pub fn or(&mut self, bits: impl IntoIterator<Item = Bit>) -> Bit {
        let mut inputs = Vec::new();
        for bit in bits {
            match bit {
                Bit::True => return Bit::True,
                Bit::False => {}
                Bit::Lit(lit) => inputs.push(lit),
            }
        }
        inputs.sort_unstable();
        inputs.dedup();
        match inputs[..] {
            [] => Bit::False,
            [only] => Bit::Lit(only),
            _ => Bit::Lit(self.or_gate(inputs)),
        }
    }

    fn or_gate(&mut self, inputs: Vec<Lit>) -> Lit {
        if let Some(&lit) = self.ors.get(&inputs) {
            return lit;
        }
        let lit = self.define(Gate::Or(inputs.clone()));
        self.define_or(lit, &inputs);
        self.ors.insert(inputs, lit);
        lit
    }

    fn define_or(&mut self, lit: Lit, inputs: &[Lit]) {
        let mut clause = vec![!lit];
        clause.extend_from_slice(inputs);
        self.clause(&clause);
    }

    /// A conjunction that is still empty and can [grow](Circuit::grow).
    pub fn growing_and(&mut self) -> Lit {
        self.define(Gate::And(Vec::new()))
    }

    /// Adds a conjunct to a conjunction.
    pub fn grow(&mut self, and: Lit, bit: Bit) {
        self.imply(&[and], bit);
        if let (Gate::And(inputs), Bit::Lit(lit)) = (self.gate_mut(and), bit) {
            inputs.push(lit);
        }
    }

    /// A disjunction that is false while a condition is, and gets its meaning
    /// [later](Circuit::resolve).
    pub fn deferred_or(&mut self, condition: Lit) -> Lit {
        let lit = self.define(Gate::Or(Vec::new()));
        self.clause(&[!lit, condition]);
        lit
    }

    /// Gives a deferred disjunction its meaning.
    pub fn resolve(&mut self, deferred: Lit, bit: Bit) {
        match bit {
            Bit::True => *self.gate_mut(deferred) = Gate::Choice,
            Bit::False => self.clause(&[!deferred]),
            Bit::Lit(lit) => {
                self.define_or(deferred, &[lit]);
                *self.gate_mut(deferred) = Gate::Or(vec![lit]);
            }
        }
    }

    /// Some pair with both bits true.
    ///
    /// Small disjunctions are distributed into clauses, which takes no variables.
    pub fn some_pair(&mut self, pairs: &[(Bit, Bit)]) -> Bit {
        let plain: Option<Vec<(Lit, Lit)>> = pairs
            .iter()
            .map(|pair| match *pair {
                (Bit::Lit(a), Bit::Lit(b)) => Some((a, b)),
                _ => None,
            })
            .collect();
        match plain {
            Some(plain) if (2..=4).contains(&plain.len()) => Bit::Lit(self.distributed(plain)),
            _ => {
                let ands: Vec<Bit> = pairs.iter().map(|&(a, b)| self.and([a, b])).collect();
                self.or(ands)
            }
        }
    }

    fn distributed(&mut self, pairs: Vec<(Lit, Lit)>) -> Lit {
        let lit = self.define(Gate::SomePair(pairs.clone()));
        for choice in 0..1u32 << pairs.len() {
            let pick = |(i, &(a, b)): (usize, &(Lit, Lit))| if choice >> i & 1 == 0 { a } else { b };
            let inputs: Vec<Lit> = pairs.iter().enumerate().map(pick).collect();
            self.define_or(lit, &inputs);
        }
        lit
    }

    /// Hands the clause collector and the variables to a library encoding.
    pub fn encode_with<T>(&mut self, encode: impl FnOnce(&mut Cnf, &mut BasicVarManager) -> T) -> T {
        let before = self.pending.len();
        let result = encode(&mut self.pending, &mut self.variables);
        self.clauses += self.pending.len() - before;
        result
    }
}
