//! Justification: the few true leaves that a model's truth rests on.

use rustsat::types::Lit;

use super::circuit::{Bit, Circuit, Gate};

/// How deep the cost of a disjunct is looked at.
const DEPTH: usize = 3;

/// The true leaves that suffice for all roots, for a lasso of this length and loop start, and which
/// variables the walk passed through.
///
/// `truth` is a model of the circuit's clauses. The leaves come in the order of their variables.
pub fn justify(
    circuit: &Circuit,
    truth: &dyn Fn(Lit) -> bool,
    length: usize,
    loop_start: usize,
) -> (Vec<Lit>, Vec<bool>) {
    let mut walk = Walk { circuit, truth, length, loop_start, seen: Vec::new(), todo: Vec::new() };
    walk.seen.resize(circuit.variables(), false);
    let mut leaves = Vec::new();
    for &root in circuit.roots() {
        walk.visit(root);
        while let Some(lit) = walk.todo.pop() {
            if matches!(circuit.gate(lit), Gate::Leaf(_)) {
                leaves.push(lit);
            } else {
                walk.expand(lit);
            }
        }
    }
    leaves.sort_unstable();
    (leaves, walk.seen)
}

struct Walk<'a> {
    circuit: &'a Circuit,
    truth: &'a dyn Fn(Lit) -> bool,
    length: usize,
    loop_start: usize,
    seen: Vec<bool>,
    todo: Vec<Lit>,
}

impl Walk<'_> {
    fn visit(&mut self, lit: Lit) {
        if !std::mem::replace(&mut self.seen[lit.vidx()], true) {
            self.todo.push(lit);
        }
    }

    fn visit_bit(&mut self, bit: Bit) {
        if let Bit::Lit(lit) = bit {
            self.visit(lit);
        }
    }

    fn expand(&mut self, lit: Lit) {
        let circuit = self.circuit;
        match circuit.gate(lit) {
            Gate::Choice | Gate::Leaf(_) => {}
            Gate::And(inputs) => inputs.iter().for_each(|&l| self.visit(l)),
            Gate::Or(inputs) => {
                let cheapest = inputs.iter().copied().filter(|&l| (self.truth)(l));
                if let Some(best) = cheapest.min_by_key(|&l| self.cost(l, DEPTH)) {
                    self.visit(best);
                }
            }
            Gate::SomePair(pairs) => {
                let true_pairs = pairs.iter().filter(|(a, b)| (self.truth)(*a) && (self.truth)(*b));
                let cost = |&&(a, b): &&(Lit, Lit)| self.cost(a, DEPTH) + self.cost(b, DEPTH);
                if let Some(&(a, b)) = true_pairs.min_by_key(cost) {
                    self.visit(a);
                    self.visit(b);
                }
            }
            Gate::AtLeast(terms, bound) => self.expand_sum(terms, *bound),
            Gate::Successor(next) if next.step < self.length => {
                self.visit_bit(next.onward.unwrap_or(Bit::True));
            }
            Gate::Successor(next) => {
                self.visit_bit(next.wrap.get(self.loop_start).copied().unwrap_or(Bit::True));
            }
        }
    }

    /// Takes true terms, those seen before and the heaviest first, until the bound is reached.
    fn expand_sum(&mut self, terms: &[(Lit, usize)], bound: usize) {
        let mut chosen: Vec<_> = terms.iter().copied().filter(|(l, _)| (self.truth)(*l)).collect();
        chosen.sort_by_key(|&(l, w)| (!self.seen[l.vidx()], std::cmp::Reverse(w), self.cost(l, DEPTH), l));
        let mut sum = 0;
        for (lit, weight) in chosen {
            if sum >= bound {
                break;
            }
            sum += weight;
            self.visit(lit);
        }
    }

    /// How many new leaves a gate would bring, looked at to a small depth.
    fn cost(&self, lit: Lit, depth: usize) -> usize {
        if self.seen[lit.vidx()] {
            return 0;
        }
        match self.circuit.gate(lit) {
            Gate::Choice => 0,
            Gate::And(inputs) if depth > 0 => inputs.iter().map(|&l| self.cost(l, depth - 1)).sum(),
            Gate::Or(inputs) if depth > 0 => {
                let live = inputs.iter().filter(|&&l| (self.truth)(l));
                live.map(|&l| self.cost(l, depth - 1)).min().unwrap_or(0)
            }
            Gate::Leaf(_) => 1,
            _ => 2,
        }
    }
}
