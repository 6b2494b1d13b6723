//! The goals on what really happened: an infinite run that is the finite one, its last round repeated.
//!
//! Truth of a subformula at all positions is a row of bits. A label may be neither in nor out only where
//! a region is uncertain; then it counts against the goal, as in the plan.

use crate::entity::EntityId;
use crate::ir::{Atom, Comparison, Formula, FormulaId, Formulas, Relation};

/// An infinite run: positions 0 … count − 1, and after the last of them `again`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trace {
    pub(super) count: usize,
    /// Less than `count`.
    pub(super) again: usize,
}

/// Where an atom certainly holds and where it certainly does not, by position.
pub(super) struct Labels<'a> {
    pub(super) inside: &'a [bool],
    pub(super) outside: &'a [bool],
}

/// The atoms of a formula itself, its operands' aside.
pub(super) fn atoms(formula: &Formula) -> Vec<Atom> {
    match formula {
        Formula::In(atom) | Formula::Out(atom) => vec![*atom],
        Formula::Compare(comparison) => comparison.terms.iter().map(|(atom, _)| *atom).collect(),
        _ => Vec::new(),
    }
}

/// Rows of truth values, kept from run to run for their room.
#[derive(Default)]
pub(super) struct Evaluation {
    rows: Vec<Vec<bool>>,
}

impl Evaluation {
    /// Evaluates all formulas at all positions.
    pub(super) fn run<'l>(&mut self, formulas: &Formulas, trace: Trace, labels: impl Fn(Atom) -> Labels<'l>) {
        self.rows.resize_with(formulas.nodes().len(), Vec::new);
        for (id, formula) in formulas.nodes().iter() {
            let (before, rest) = self.rows.split_at_mut(id.index());
            let Some(row) = rest.first_mut() else { return };
            row.clear();
            let operand = |f: &FormulaId| before[f.index()].as_slice();
            match formula {
                Formula::True => row.resize(trace.count, true),
                Formula::False => row.resize(trace.count, false),
                Formula::In(atom) => row.extend_from_slice(labels(*atom).inside),
                Formula::Out(atom) => row.extend_from_slice(labels(*atom).outside),
                Formula::Compare(comparison) => compare(comparison, trace, &labels, row),
                Formula::And(operands) => {
                    row.resize(trace.count, true);
                    operands.iter().for_each(|f| row.iter_mut().zip(operand(f)).for_each(|(r, x)| *r &= x));
                }
                Formula::Or(operands) => {
                    row.resize(trace.count, false);
                    operands.iter().for_each(|f| row.iter_mut().zip(operand(f)).for_each(|(r, x)| *r |= x));
                }
                Formula::Next(f) => {
                    row.extend_from_slice(operand(f).get(1..).unwrap_or_default());
                    row.push(operand(f)[trace.again]);
                }
                Formula::Until(None, a, b) => {
                    fixpoint(trace, row, false, operand(a), operand(b), |a, b, next| b | (a & next))
                }
                Formula::Release(None, a, b) => {
                    fixpoint(trace, row, true, operand(a), operand(b), |a, b, next| b & (a | next))
                }
                Formula::Until(Some(window), a, b) => {
                    within(trace, *window, operand(a), operand(b), true, row)
                }
                Formula::Release(Some(window), a, b) => {
                    within(trace, *window, operand(a), operand(b), false, row);
                    row.iter_mut().for_each(|x| *x = !*x);
                }
            }
        }
    }

    /// Whether a formula holds at the start.
    pub(super) fn holds(&self, formula: FormulaId) -> bool {
        self.rows.get(formula.index()).and_then(|row| row.first()).copied().unwrap_or(false)
    }
}

/// The fixpoint of a row that depends on itself one position on, from `start` for all positions.
fn fixpoint(
    trace: Trace,
    row: &mut Vec<bool>,
    start: bool,
    a: &[bool],
    b: &[bool],
    step: impl Fn(bool, bool, bool) -> bool,
) {
    row.resize(trace.count, start);
    // Once round the loop to learn what its first position has, once more to carry it on.
    for from in [trace.again, 0] {
        let mut next = row[trace.again];
        for t in (from..trace.count).rev() {
            next = step(a[t], b[t], next);
            row[t] = next;
        }
    }
}

/// At each position: for some d in the window, `b` is `value` d steps on, and `a` is on the way there.
fn within(trace: Trace, (first, last): (u32, u32), a: &[bool], b: &[bool], value: bool, row: &mut Vec<bool>) {
    let (first, last) = (u64::from(first), u64::from(last));
    let (stops, comes) = (waits(trace, a, !value), waits(trace, b, value));
    let round = (trace.count - trace.again) as u64;
    row.extend((0..trace.count).map(|t| {
        let from = t as u64 + first;
        let again = trace.again as u64;
        let folded = if from < trace.count as u64 { from } else { again + (from - again) % round };
        // `a` has to last until the moment before `b` comes, which is not before the window.
        let wait = comes[folded as usize].map(|w| first.saturating_add(w));
        wait.is_some_and(|wait| wait <= last && stops[t].is_none_or(|stop| wait <= stop))
    }));
}

/// How many steps it takes from each position to the first where a row has a value.
fn waits(trace: Trace, row: &[bool], value: bool) -> Vec<Option<u64>> {
    let mut waits: Vec<Option<u64>> = vec![None; trace.count];
    for _ in 0..2 {
        let mut next = waits[trace.again];
        for t in (0..trace.count).rev() {
            next = if row[t] == value { Some(0) } else { next.map(|n| n + 1) };
            waits[t] = next;
        }
    }
    waits
}

/// Whether a comparison holds for every value of what is uncertain, at each position.
fn compare<'l>(
    comparison: &Comparison,
    trace: Trace,
    labels: &impl Fn(Atom) -> Labels<'l>,
    row: &mut Vec<bool>,
) {
    let terms: Vec<(Labels, i128)> =
        comparison.terms.iter().map(|(a, c)| (labels(*a), i128::from(*c))).collect();
    let bound = i128::from(comparison.bound);
    row.extend((0..trace.count).map(|t| {
        let (mut least, mut most) = (0, 0);
        let mut unknown = Vec::new();
        for (label, coefficient) in &terms {
            if label.inside[t] {
                least += coefficient;
                most += coefficient;
            } else if !label.outside[t] {
                unknown.push(*coefficient);
                least += coefficient.min(&0);
                most += coefficient.max(&0);
            }
        }
        match comparison.relation {
            Relation::AtLeast => least >= bound,
            Relation::AtMost => most <= bound,
            Relation::Equal => least == bound && most == bound,
            Relation::NotEqual => bound < least || most < bound || !sums_to(&unknown, bound, least),
        }
    }));
}

/// So many different sums are told apart; beyond, any may be.
const SUMS: usize = 100_000;

/// Whether some of the numbers can make a sum, of which `least` is the least.
fn sums_to(numbers: &[i128], sum: i128, least: i128) -> bool {
    let mut sums = std::collections::BTreeSet::from([least]);
    for number in numbers {
        let more: Vec<i128> = sums.iter().map(|s| s + number.abs()).collect();
        sums.extend(more);
        if sums.len() > SUMS {
            return true;
        }
    }
    sums.contains(&sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ir::{RegionId, RobotId};

    /// Random numbers for cases.
    struct Cases(u64);

    impl Cases {
        fn below(&mut self, bound: usize) -> usize {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ((self.0 >> 33) as usize) % bound
        }

        fn formula(&mut self, formulas: &mut Formulas, depth: usize) -> FormulaId {
            let atom = |robot: usize| Atom { robot: RobotId::new(robot), region: RegionId::new(0) };
            let kind = if depth == 0 { self.below(4) } else { self.below(12) };
            let some = atom(self.below(2));
            let mut operand = || self.formula(formulas, depth.saturating_sub(1));
            let formula = match kind {
                0 => Formula::In(some),
                1 => Formula::Out(some),
                2 | 3 => {
                    let all = [Relation::Equal, Relation::NotEqual, Relation::AtLeast, Relation::AtMost];
                    let coefficient = [-1, 1, 2][self.below(3)];
                    let terms = vec![(atom(0), coefficient), (atom(1), 1)];
                    let bound = self.below(4) as i64 - 1;
                    Formula::Compare(Comparison { terms, relation: all[self.below(4)], bound })
                }
                4 => Formula::And(vec![operand(), operand()]),
                5 => Formula::Or(vec![operand(), operand()]),
                6 => Formula::Next(operand()),
                7 => Formula::Until(None, operand(), operand()),
                8 => Formula::Release(None, operand(), operand()),
                _ => {
                    let (a, b) = (operand(), operand());
                    let first = self.below(5) as u32;
                    let window = Some((first, first + self.below(5) as u32));
                    if kind < 11 { Formula::Until(window, a, b) } else { Formula::Release(window, a, b) }
                }
            };
            formulas.intern(formula)
        }
    }

    /// The definition, on positions that only grow: 1 certainly in, −1 certainly out, 0 neither.
    fn by_definition(formulas: &Formulas, f: FormulaId, trace: Trace, run: &[[i8; 2]], t: usize) -> bool {
        let holds = |f: &FormulaId, t: usize| by_definition(formulas, *f, trace, run, t);
        let label = |atom: &Atom| {
            let mut at = t;
            while at >= trace.count {
                at -= trace.count - trace.again;
            }
            run[at][atom.robot.index()]
        };
        let ends = |window: &Option<(u32, u32)>| {
            window.map_or((0, 2 * trace.count), |(m, n)| (m as usize, n as usize))
        };
        match &formulas[f] {
            Formula::True => true,
            Formula::False => false,
            Formula::In(atom) => label(atom) == 1,
            Formula::Out(atom) => label(atom) == -1,
            Formula::Compare(Comparison { terms, relation, bound }) => (0..4usize).all(|bits| {
                let value = |i: usize| bits >> i & 1 == 1;
                let allowed = terms.iter().enumerate().all(|(i, (a, _))| match label(a) {
                    1 => value(i),
                    -1 => !value(i),
                    _ => true,
                });
                let sum: i64 = terms.iter().enumerate().filter(|(i, _)| value(*i)).map(|(_, (_, c))| c).sum();
                !allowed
                    || match relation {
                        Relation::Equal => sum == *bound,
                        Relation::NotEqual => sum != *bound,
                        Relation::AtLeast => sum >= *bound,
                        Relation::AtMost => sum <= *bound,
                    }
            }),
            Formula::And(fs) => fs.iter().all(|f| holds(f, t)),
            Formula::Or(fs) => fs.iter().any(|f| holds(f, t)),
            Formula::Next(f) => holds(f, t + 1),
            Formula::Until(window, a, b) => {
                let (m, n) = ends(window);
                (m..=n).any(|d| holds(b, t + d) && (0..d).all(|e| holds(a, t + e)))
            }
            Formula::Release(window, a, b) => {
                let (m, n) = ends(window);
                (m..=n).all(|d| holds(b, t + d) || (0..d).any(|e| holds(a, t + e)))
            }
        }
    }

    #[test]
    fn evaluation_agrees_with_the_definition_on_short_runs() {
        let mut cases = Cases(2026);
        let (mut count, mut hold) = (0, 0);
        for _ in 0..300 {
            let mut formulas = Formulas::new();
            let root = cases.formula(&mut formulas, 3);
            for (n, again) in (1..=4).flat_map(|n| (0..n).map(move |k| (n, k))) {
                let trace = Trace { count: n, again };
                let run: Vec<[i8; 2]> =
                    (0..n).map(|_| [0, 1].map(|_| [1, -1, 1, -1, 0][cases.below(5)])).collect();
                let rows =
                    |sign: i8| [0, 1].map(|r: usize| run.iter().map(|x| x[r] == sign).collect::<Vec<_>>());
                let (inside, outside) = (rows(1), rows(-1));
                let mut evaluation = Evaluation::default();
                evaluation.run(&formulas, trace, |atom| Labels {
                    inside: &inside[atom.robot.index()],
                    outside: &outside[atom.robot.index()],
                });
                let expected = by_definition(&formulas, root, trace, &run, 0);
                assert_eq!(evaluation.holds(root), expected, "{formulas:?} {trace:?} {run:?}");
                count += 1;
                hold += usize::from(expected);
            }
        }
        assert!(hold > count / 10 && hold < count * 9 / 10, "{hold} of {count}");
    }
}
