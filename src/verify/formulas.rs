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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::entity::EntityId;
    use crate::ir::{RegionId, RobotId};

    /// A small generator of test cases: the same on every machine.
    struct Cases(u64);

    impl Cases {
        fn below(&mut self, bound: usize) -> usize {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ((self.0 >> 33) as usize) % bound
        }
        fn formula(&mut self, formulas: &mut Formulas, depth: usize) -> FormulaId {
            let atom = Atom { robot: RobotId::new(self.below(2)), region: RegionId::new(0) };
            let kind = if depth == 0 { self.below(4) } else { self.below(12) };
            let mut operand = || self.formula(formulas, depth.saturating_sub(1));
            let formula = match kind {
                0 | 1 => Formula::In(atom),
                2 => Formula::Out(atom),
                3 => {
                    return formulas.intern(if atom.robot.index() == 0 {
                        Formula::True
                    } else {
                        Formula::False
                    });
                }
                4 => Formula::And(vec![operand(), operand()]),
                5 => Formula::Or(vec![operand(), operand()]),
                6 => Formula::Next(operand()),
                7 => Formula::Until(None, operand(), operand()),
                8 => Formula::Release(None, operand(), operand()),
                _ => {
                    let (a, b) = (operand(), operand());
                    let first = self.below(6) as u32;
                    let window = Some((first, first + self.below(6) as u32));
                    if kind < 11 { Formula::Until(window, a, b) } else { Formula::Release(window, a, b) }
                }
            };
            formulas.intern(formula)
        }
    }

    /// The definition, on the run itself: positions only ever grow, the lasso is known to atoms alone.
    fn by_definition(
        formulas: &Formulas,
        f: FormulaId,
        lasso: Lasso,
        labels: &[[Label; 2]],
        t: usize,
    ) -> bool {
        let holds = |f: FormulaId, t: usize| by_definition(formulas, f, lasso, labels, t);
        let label = |atom: &Atom| {
            let mut folded = t;
            while folded > lasso.last {
                folded -= lasso.last + 1 - lasso.loop_start;
            }
            labels[folded][atom.robot.index()]
        };
        // Beyond twice the lasso's positions everything has been seen at the same place of the loop.
        let ends = |window: &Option<(u32, u32)>| {
            window.map_or((0, 2 * lasso.last + 2), |(m, n)| (m as usize, n as usize))
        };
        match &formulas[f] {
            Formula::True => true,
            Formula::False => false,
            Formula::In(atom) => label(atom) == Label::In,
            Formula::Out(atom) => label(atom) == Label::Out,
            Formula::Compare(_) => unreachable!("not generated"),
            Formula::And(fs) => fs.iter().all(|&f| holds(f, t)),
            Formula::Or(fs) => fs.iter().any(|&f| holds(f, t)),
            Formula::Next(f) => holds(*f, t + 1),
            Formula::Until(window, a, b) => {
                let (m, n) = ends(window);
                (m..=n).any(|d| holds(*b, t + d) && (0..d).all(|e| holds(*a, t + e)))
            }
            Formula::Release(window, a, b) => {
                let (m, n) = ends(window);
                (m..=n).all(|d| holds(*b, t + d) || (0..d).any(|e| holds(*a, t + e)))
            }
        }
    }

    #[test]
    fn threat_9_fixpoints_agree_with_the_definition_on_short_lassos() {
        let mut cases = Cases(2026);
        let (mut count, mut hold) = (0, 0);
        for _ in 0..150 {
            let mut formulas = Formulas::new();
            let root = cases.formula(&mut formulas, 3);
            for (last, loop_start) in (0..=4).flat_map(|last| (0..=last).map(move |k| (last, k))) {
                let lasso = Lasso { last, loop_start };
                for _ in 0..4 {
                    let mut any = || [Label::In, Label::Out, Label::Unknown][cases.below(3)];
                    let labels: Vec<[Label; 2]> = (0..=last).map(|_| [any(), any()]).collect();
                    let values = evaluate(&formulas, lasso, |atom, t| labels[t][atom.robot.index()]);
                    for (t, &found) in values[root.index()].iter().enumerate() {
                        let expected = by_definition(&formulas, root, lasso, &labels, t);
                        let what = || format!("{formulas:?} {lasso:?} {labels:?} at {t}");
                        assert_eq!(found, expected, "{}", what());
                        count += 1;
                        hold += usize::from(expected);
                    }
                }
            }
        }
        assert!(hold > count / 10 && hold < count * 9 / 10, "{hold} of {count}");
    }

    fn p() -> Formula {
        Formula::In(Atom { robot: RobotId::new(0), region: RegionId::new(0) })
    }

    #[test]
    fn threat_9_what_recurs_must_recur_in_the_loop() {
        let mut formulas = Formulas::new();
        let (p, yes, no) =
            (formulas.intern(p()), formulas.intern(Formula::True), formulas.intern(Formula::False));
        let eventually = formulas.intern(Formula::Until(None, yes, p));
        let always_eventually = formulas.intern(Formula::Release(None, no, eventually));
        let at = |visited: usize, lasso: Lasso| {
            let label = |_, t| if t == visited { Label::In } else { Label::Out };
            let values = evaluate(&formulas, lasso, label);
            (values[eventually.index()][0], values[always_eventually.index()][0])
        };
        assert_eq!(at(1, Lasso { last: 4, loop_start: 2 }), (true, false));
        assert_eq!(at(2, Lasso { last: 4, loop_start: 2 }), (true, true));
        assert_eq!(at(4, Lasso { last: 4, loop_start: 4 }), (true, true));
        assert_eq!(at(3, Lasso { last: 4, loop_start: 4 }), (true, false));
    }

    #[test]
    fn long_windows_and_deep_formulas_are_quick() {
        let mut formulas = Formulas::new();
        let mut f = formulas.intern(p());
        let yes = formulas.intern(Formula::True);
        for i in 0..2_000 {
            f = formulas.intern(Formula::Until(Some((i, 100_000)), yes, f));
        }
        let lasso = Lasso { last: 63, loop_start: 10 };
        let values = evaluate(&formulas, lasso, |_, t| if t == 50 { Label::In } else { Label::Unknown });
        assert!(values[f.index()][0]);
        let never = evaluate(&formulas, lasso, |_, t| if t == 5 { Label::In } else { Label::Unknown });
        assert!(!never[f.index()][0]);
    }
}
