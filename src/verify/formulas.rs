//! Temporal formulas on a lasso, bottom up and without recursion.
//!
//! A lasso has the positions 0 … L, and after L comes k. An until asks whether its second operand
//! comes soon enough before its first one fails; both distances, which may go round the loop, are
//! least fixpoints that two backward passes reach. A release is the dual.

use super::labels::certainly;
use crate::entity::EntityId;
use crate::ir::{Atom, Formula, FormulaId, Formulas};
use crate::plan::Label;

/// Never.
const NEVER: u64 = u64::MAX;

/// The shape of an infinite run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lasso {
    /// L: the last position.
    pub(super) last: usize,
    /// k ≤ L: the position after the last.
    pub(super) loop_start: usize,
}

impl Lasso {
    fn next(self, t: usize) -> usize {
        if t < self.last { t + 1 } else { self.loop_start }
    }

    /// The position `steps` after t.
    fn after(self, t: usize, steps: u64) -> usize {
        let (loop_start, size) = (self.loop_start as u64, (self.last - self.loop_start + 1) as u64);
        let unrolled = t as u64 + steps;
        let folded =
            if unrolled > self.last as u64 { loop_start + (unrolled - loop_start) % size } else { unrolled };
        folded as usize
    }

    /// How many steps it takes from each position to the first where `holds` is `value`.
    fn distances(self, holds: &[bool], value: bool) -> Vec<u64> {
        let mut distances = vec![NEVER; self.last + 1];
        // The second pass carries what the loop's first positions found back to its last ones.
        for _ in 0..2 {
            for t in (0..=self.last).rev() {
                let later = distances[self.next(t)].saturating_add(1);
                distances[t] = if holds[t] == value { 0 } else { later };
            }
        }
        distances
    }

    /// At each position: for some d in the window, `b` is `value` d steps on and `a` is until then.
    fn until(self, window: Option<(u32, u32)>, a: &[bool], b: &[bool], value: bool) -> Vec<bool> {
        let (first, last) = window.map_or((0, NEVER), |(m, n)| (u64::from(m), u64::from(n)));
        let (a_fails, b_comes) = (self.distances(a, !value), self.distances(b, value));
        (0..=self.last)
            .map(|t| {
                let latest = last.min(a_fails[t]);
                let wait = b_comes[self.after(t, first)];
                first <= latest && wait != NEVER && wait <= latest - first
            })
            .collect()
    }
}

/// Whether each subformula holds at each position, in the order of the table.
pub(super) fn evaluate(
    formulas: &Formulas,
    lasso: Lasso,
    label: impl Fn(Atom, usize) -> Label,
) -> Vec<Vec<bool>> {
    let positions = 0..=lasso.last;
    let mut values: Vec<Vec<bool>> = Vec::with_capacity(formulas.nodes().len());
    for formula in formulas.nodes().values() {
        let operand = |id: FormulaId| values[id.index()].as_slice();
        let everywhere = |holds: &dyn Fn(usize) -> bool| positions.clone().map(holds).collect();
        let value: Vec<bool> = match formula {
            Formula::True => everywhere(&|_| true),
            Formula::False => everywhere(&|_| false),
            Formula::In(atom) => everywhere(&|t| label(*atom, t) == Label::In),
            Formula::Out(atom) => everywhere(&|t| label(*atom, t) == Label::Out),
            Formula::Compare(comparison) => everywhere(&|t| certainly(comparison, |atom| label(atom, t))),
            Formula::And(operands) => everywhere(&|t| operands.iter().all(|&f| operand(f)[t])),
            Formula::Or(operands) => everywhere(&|t| operands.iter().any(|&f| operand(f)[t])),
            Formula::Next(f) => everywhere(&|t| operand(*f)[lasso.next(t)]),
            Formula::Until(window, a, b) => lasso.until(*window, operand(*a), operand(*b), true),
            Formula::Release(window, a, b) => lasso
                .until(*window, operand(*a), operand(*b), false)
                .into_iter()
                .map(|violated| !violated)
                .collect(),
        };
        values.push(value);
    }
    values
}
