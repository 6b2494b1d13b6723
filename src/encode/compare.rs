//! Comparisons of sums whose atoms may be unknown.

use rustsat::encodings::pb::{BoundUpper, GeneralizedTotalizer};
use rustsat::types::Lit;

use crate::ir::{Comparison, Relation};

use super::circuit::{Bit, Circuit, Gate};

/// The bit of a comparison, from each atom's 'certainly in' and 'certainly out'.
///
/// An unknown atom counts as whatever is worst: a term with a positive coefficient counts towards
/// 'at least' only when it is certainly in, one with a negative coefficient spares its weight only
/// when it is certainly out.
pub fn compare(circuit: &mut Circuit, comparison: &Comparison, atoms: &[(Bit, Bit)]) -> Bit {
    let terms: Vec<(i64, Bit, Bit)> =
        comparison.terms.iter().zip(atoms).map(|((_, c), (i, o))| (*c, *i, *o)).collect();
    match comparison.relation {
        Relation::AtLeast => at_least(circuit, &terms, comparison.bound),
        Relation::AtMost => at_most(circuit, &terms, comparison.bound),
        Relation::Equal => {
            let low = at_least(circuit, &terms, comparison.bound);
            let high = at_most(circuit, &terms, comparison.bound);
            circuit.and([low, high])
        }
        Relation::NotEqual => Avoid { circuit, terms: &terms, bound: comparison.bound }.build(),
    }
}

fn at_most(circuit: &mut Circuit, terms: &[(i64, Bit, Bit)], bound: i64) -> Bit {
    let negated: Vec<(i64, Bit, Bit)> = terms.iter().map(|&(c, i, o)| (-c, i, o)).collect();
    at_least(circuit, &negated, -bound)
}

fn at_least(circuit: &mut Circuit, terms: &[(i64, Bit, Bit)], bound: i64) -> Bit {
    let mut bound = i128::from(bound);
    let mut literals: Vec<(Lit, usize)> = Vec::new();
    for &(coefficient, inside, outside) in terms {
        // c · x = c + |c| · (1 − x) where c is negative.
        bound -= i128::from(coefficient.min(0));
        let weight = coefficient.unsigned_abs() as usize;
        match if coefficient > 0 { inside } else { outside } {
            Bit::False => {}
            Bit::True => bound -= weight as i128,
            Bit::Lit(lit) => literals.push((lit, weight)),
        }
    }
    let total: i128 = literals.iter().map(|(_, w)| *w as i128).sum();
    if bound <= 0 {
        Bit::True
    } else if bound > total {
        Bit::False
    } else {
        sum(circuit, literals, bound as usize, total as usize)
    }
}

/// Σ weight · literal ≥ bound, for 0 < bound ≤ total.
fn sum(circuit: &mut Circuit, literals: Vec<(Lit, usize)>, bound: usize, total: usize) -> Bit {
    let bits = || literals.iter().map(|(l, _)| Bit::Lit(*l));
    if literals.iter().all(|(_, w)| *w >= bound) {
        return circuit.or(bits());
    }
    if literals.iter().all(|(_, w)| *w > total - bound) {
        return circuit.and(bits());
    }
    let gate = circuit.define(Gate::AtLeast(literals.clone(), bound));
    // At least `bound` of the true ones is at most `total − bound` of the others.
    let mut others: GeneralizedTotalizer = literals.iter().map(|&(l, w)| (!l, w)).collect();
    let slack = total - bound;
    let encoded =
        circuit.encode_with(|clauses, variables| others.encode_ub(slack..=slack, clauses, variables));
    match (encoded, others.enforce_ub(slack)) {
        (Ok(()), Ok(units)) => units.into_iter().for_each(|unit| circuit.clause(&[!gate, unit])),
        // Out of memory: a sum that is never true is sound for plans, but refutes nothing.
        _ => {
            circuit.clause(&[!gate]);
            circuit.give_up();
        }
    }
    Bit::Lit(gate)
}

/// Σ ≠ bound for every value of the unknown atoms, as a decision diagram over the partial sums: the
/// sum may have gaps, so it is not just 'above or below'.
struct Avoid<'a> {
    circuit: &'a mut Circuit,
    terms: &'a [(i64, Bit, Bit)],
    bound: i64,
}

impl Avoid<'_> {
    fn build(self) -> Bit {
        let mut layers = vec![std::collections::BTreeSet::from([0i64])];
        for (coefficient, ..) in self.terms {
            let next = layers[layers.len() - 1].iter().flat_map(|s| [*s, s.saturating_add(*coefficient)]);
            layers.push(next.collect());
        }
        let mut values: std::collections::BTreeMap<i64, Bit> =
            layers[self.terms.len()].iter().map(|&s| (s, Bit::from(s != self.bound))).collect();
        for (layer, &(coefficient, inside, outside)) in self.terms.iter().enumerate().rev() {
            let mut above = std::collections::BTreeMap::new();
            for &partial in &layers[layer] {
                // The atom may be false unless it is certainly in, true unless it is certainly out.
                let if_false = self.circuit.or([inside, values[&partial]]);
                let if_true = self.circuit.or([outside, values[&partial.saturating_add(coefficient)]]);
                above.insert(partial, self.circuit.and([if_false, if_true]));
            }
            values = above;
        }
        values[&0]
    }
}
