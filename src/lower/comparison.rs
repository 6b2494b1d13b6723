//! Comparisons of sums in normal form: each atom once, constants right, `≥ ≤ = ≠` only.

use std::collections::BTreeMap;

use crate::check::typed::Comparison as Op;
use crate::ir::{Atom, Comparison, Formula, Relation};

/// The IR's form of Σ coefficient · atom ⋈ bound, or of its negation.
///
/// What the coefficients alone decide becomes `True` or `False`, and a single atom its own literal:
/// that is the same for every value that unknown atoms could take.
pub(super) fn comparison(terms: &[(Atom, i64)], op: Op, bound: i64, negated: bool) -> Formula {
    let mut merged: BTreeMap<Atom, i64> = BTreeMap::new();
    for (atom, coefficient) in terms {
        *merged.entry(*atom).or_default() += coefficient;
    }
    let terms: Vec<(Atom, i64)> = merged.into_iter().filter(|(_, c)| *c != 0).collect();
    let (relation, bound) = relation(if negated { opposite(op) } else { op }, bound);
    if let Some(decided) = decide(&terms, relation, bound) {
        return if decided { Formula::True } else { Formula::False };
    }
    if let [(atom, coefficient)] = terms[..] {
        // Undecided, so it holds for exactly one of the atom's two values.
        let inside = holds(coefficient, relation, bound);
        return if inside { Formula::In(atom) } else { Formula::Out(atom) };
    }
    Formula::Compare(Comparison { terms, relation, bound })
}

fn opposite(op: Op) -> Op {
    match op {
        Op::Equal => Op::NotEqual,
        Op::NotEqual => Op::Equal,
        Op::Less => Op::GreaterEqual,
        Op::LessEqual => Op::Greater,
        Op::Greater => Op::LessEqual,
        Op::GreaterEqual => Op::Less,
    }
}

/// Sums are whole, so `< k` is `≤ k − 1`.
fn relation(op: Op, bound: i64) -> (Relation, i64) {
    match op {
        Op::Equal => (Relation::Equal, bound),
        Op::NotEqual => (Relation::NotEqual, bound),
        Op::Less => (Relation::AtMost, bound - 1),
        Op::LessEqual => (Relation::AtMost, bound),
        Op::Greater => (Relation::AtLeast, bound + 1),
        Op::GreaterEqual => (Relation::AtLeast, bound),
    }
}

fn holds(sum: i64, relation: Relation, bound: i64) -> bool {
    match relation {
        Relation::Equal => sum == bound,
        Relation::NotEqual => sum != bound,
        Relation::AtLeast => sum >= bound,
        Relation::AtMost => sum <= bound,
    }
}

/// Whether the comparison holds, or fails, whatever the atoms are; `None` when they matter.
fn decide(terms: &[(Atom, i64)], relation: Relation, bound: i64) -> Option<bool> {
    let least: i64 = terms.iter().map(|(_, c)| (*c).min(0)).sum();
    let most: i64 = terms.iter().map(|(_, c)| (*c).max(0)).sum();
    let divisor = terms.iter().fold(0, |g, (_, c)| gcd(g, c.abs()));
    let reachable = (least..=most).contains(&bound) && (divisor == 0 || bound % divisor == 0);
    match relation {
        Relation::Equal if !reachable => Some(false),
        Relation::NotEqual if !reachable => Some(true),
        Relation::Equal | Relation::NotEqual => (least == most).then(|| holds(least, relation, bound)),
        Relation::AtLeast | Relation::AtMost => {
            let (a, b) = (holds(least, relation, bound), holds(most, relation, bound));
            (a == b).then_some(a)
        }
    }
}

fn gcd(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::entity::EntityId;
    use crate::ir::{RegionId, RobotId};

    const OPS: [Op; 6] = [Op::Equal, Op::NotEqual, Op::Less, Op::LessEqual, Op::Greater, Op::GreaterEqual];

    fn atom(i: usize) -> Atom {
        Atom { robot: RobotId::new(i), region: RegionId::new(0) }
    }

    fn plain(sum: i64, op: Op, bound: i64) -> bool {
        match op {
            Op::Equal => sum == bound,
            Op::NotEqual => sum != bound,
            Op::Less => sum < bound,
            Op::LessEqual => sum <= bound,
            Op::Greater => sum > bound,
            Op::GreaterEqual => sum >= bound,
        }
    }

    /// What the normal form says when atom i is certainly `values[i]`, or unknown.
    fn evaluate(formula: &Formula, values: &[Option<bool>]) -> bool {
        let of = |a: &Atom| values[a.robot.index()];
        match formula {
            Formula::True => true,
            Formula::False => false,
            Formula::In(a) => of(a) == Some(true),
            Formula::Out(a) => of(a) == Some(false),
            Formula::Compare(c) => completions(values).all(|v| {
                let sum = c.terms.iter().map(|(a, k)| k * i64::from(v[a.robot.index()])).sum();
                holds(sum, c.relation, c.bound)
            }),
            other => panic!("{other:?} is no comparison"),
        }
    }

    /// All two-valued assignments that a three-valued one allows.
    fn completions(values: &[Option<bool>]) -> impl Iterator<Item = Vec<bool>> {
        let values = values.to_vec();
        (0..1u32 << values.len())
            .map(|bits| (0..32).map(|i| bits >> i & 1 == 1).collect::<Vec<bool>>())
            .filter(move |full| values.iter().zip(full).all(|(v, f)| v.is_none_or(|v| v == *f)))
    }

    fn three_valued(count: usize) -> impl Iterator<Item = Vec<Option<bool>>> {
        (0..3usize.pow(count as u32)).map(move |n| {
            (0..count).map(|i| [None, Some(false), Some(true)][n / 3usize.pow(i as u32) % 3]).collect()
        })
    }

    #[test]
    fn the_normal_form_means_the_same_for_every_three_valued_assignment() {
        let sums: [&[(usize, i64)]; 9] = [
            &[],
            &[(0, 1)],
            &[(0, -2)],
            &[(0, 1), (1, 1), (2, 1)],
            &[(0, 1), (0, 1), (1, -1)],
            &[(0, 1), (1, 1), (0, -1)],
            &[(0, 2), (1, 2)],
            &[(0, 3), (1, -2), (2, 4)],
            &[(2, 1), (2, -1)],
        ];
        for sum in sums {
            let terms: Vec<(Atom, i64)> = sum.iter().map(|(i, k)| (atom(*i), *k)).collect();
            for (op, bound) in OPS.iter().flat_map(|op| (-4..=8).map(move |b| (*op, b))) {
                for negated in [false, true] {
                    let formula = comparison(&terms, op, bound, negated);
                    for values in three_valued(3) {
                        let all = completions(&values).all(|v| {
                            let total = sum.iter().map(|(i, k)| k * i64::from(v[*i])).sum();
                            plain(total, op, bound) != negated
                        });
                        let ours = evaluate(&formula, &values);
                        assert_eq!(
                            ours, all,
                            "{sum:?} {op:?} {bound} negated: {negated}, {values:?}: {formula:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn what_coefficients_decide_is_folded_and_the_rest_is_not() {
        let both = [(atom(0), 1), (atom(1), 1)];
        assert_eq!(comparison(&both, Op::GreaterEqual, 0, false), Formula::True);
        assert_eq!(comparison(&both, Op::Greater, 2, false), Formula::False);
        assert!(matches!(comparison(&both, Op::Equal, 1, false), Formula::Compare(_)));
        assert_eq!(comparison(&[(atom(0), 2), (atom(1), 2)], Op::Equal, 3, false), Formula::False);
        assert_eq!(comparison(&both[..1], Op::Equal, 1, false), Formula::In(atom(0)));
        assert_eq!(comparison(&both[..1], Op::Equal, 1, true), Formula::Out(atom(0)));
    }
}
