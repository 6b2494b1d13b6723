//! Atoms and comparisons under three-valued labels.

use std::collections::{BTreeMap, BTreeSet};

use super::resolve::Resolved;
use crate::ir::{Atom, Comparison, Relation};
use crate::plan::Label;

/// How many sums are told apart when `≠` needs it; beyond, nothing is certain. Coefficients 1 and −1,
/// and sums that can't meet the bound at all, never come near it.
const SUMS: usize = 100_000;

/// The label of an atom at a step; a region that the plan doesn't name is unknown.
pub(super) fn label(plan: &Resolved, atom: Atom, t: usize) -> Label {
    plan.robots[atom.robot].regions.get(&atom.region).map_or(Label::Unknown, |labels| labels[t])
}

/// Whether the comparison holds for every value that the unknown atoms could take.
pub(super) fn certainly(comparison: &Comparison, label: impl Fn(Atom) -> Label) -> bool {
    let mut coefficients: BTreeMap<Atom, i128> = BTreeMap::new();
    for &(atom, coefficient) in &comparison.terms {
        *coefficients.entry(atom).or_default() += i128::from(coefficient);
    }
    let mut known = 0;
    let mut unknown = Vec::new();
    for (atom, coefficient) in coefficients {
        match label(atom) {
            Label::In => known += coefficient,
            Label::Out => {}
            Label::Unknown => unknown.push(coefficient),
        }
    }
    unknown.retain(|&c| c != 0);
    let least = known + unknown.iter().filter(|&&c| c < 0).sum::<i128>();
    let most = known + unknown.iter().filter(|&&c| c > 0).sum::<i128>();
    let bound = i128::from(comparison.bound);
    match comparison.relation {
        Relation::AtLeast => least >= bound,
        Relation::AtMost => most <= bound,
        Relation::Equal => least == bound && most == bound,
        Relation::NotEqual => bound < least || bound > most || never_sums_to(&unknown, bound - known),
    }
}

/// Whether no subset of the numbers has this sum.
fn never_sums_to(numbers: &[i128], sum: i128) -> bool {
    if numbers.iter().all(|c| c.abs() == 1) {
        // Every whole number between the extremes is a sum, and the caller has looked beyond them.
        return false;
    }
    let mut sums = BTreeSet::from([0i128]);
    for number in numbers {
        let more: Vec<i128> = sums.iter().map(|s| s + number).collect();
        sums.extend(more);
        if sums.len() > SUMS {
            return false;
        }
    }
    !sums.contains(&sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::entity::EntityId;
    use crate::ir::{RegionId, RobotId};

    const LABELS: [Label; 3] = [Label::In, Label::Out, Label::Unknown];
    const RELATIONS: [Relation; 4] =
        [Relation::Equal, Relation::NotEqual, Relation::AtLeast, Relation::AtMost];

    fn atom(index: usize) -> Atom {
        Atom { robot: RobotId::new(index), region: RegionId::new(0) }
    }

    fn holds(relation: Relation, sum: i64, bound: i64) -> bool {
        match relation {
            Relation::Equal => sum == bound,
            Relation::NotEqual => sum != bound,
            Relation::AtLeast => sum >= bound,
            Relation::AtMost => sum <= bound,
        }
    }

    /// Tries every assignment that the labels allow.
    fn brute_force(comparison: &Comparison, labels: &[Label]) -> bool {
        (0..1usize << labels.len()).all(|bits| {
            let inside = |i: usize| bits >> i & 1 == 1;
            let allowed = labels.iter().enumerate().all(|(i, label)| match label {
                Label::In => inside(i),
                Label::Out => !inside(i),
                Label::Unknown => true,
            });
            let sum = comparison.terms.iter().filter(|(a, _)| inside(a.robot.index())).map(|(_, c)| c).sum();
            !allowed || holds(comparison.relation, sum, comparison.bound)
        })
    }

    #[test]
    fn threat_8_comparisons_agree_with_every_assignment() {
        let coefficients = [[1, 1, 1, 1], [1, -1, 1, -1], [2, -3, 5, 1], [2, 4, -2, 6], [3, 3, -1, -1]];
        let mut certain = 0;
        for (terms, relation) in coefficients.iter().flat_map(|c| RELATIONS.map(|r| (c, r))) {
            for bound in -7..=10 {
                let terms = terms.iter().enumerate().map(|(i, &c)| (atom(i), c)).collect();
                let comparison = Comparison { terms, relation, bound };
                for code in 0..81usize {
                    let labels: Vec<Label> = (0..4).map(|i| LABELS[code / 3usize.pow(i) % 3]).collect();
                    let found = certainly(&comparison, |atom| labels[atom.robot.index()]);
                    assert_eq!(found, brute_force(&comparison, &labels), "{comparison:?} {labels:?}");
                    certain += usize::from(found);
                }
            }
        }
        assert!(certain > 10_000);
    }

    #[test]
    fn one_atom_twice_has_one_value() {
        let twice =
            |relation, bound| Comparison { terms: vec![(atom(0), 1), (atom(0), -1)], relation, bound };
        assert!(certainly(&twice(Relation::Equal, 0), |_| Label::Unknown));
        assert!(certainly(&twice(Relation::NotEqual, 1), |_| Label::Unknown));
    }

    #[test]
    fn huge_sums_neither_overflow_nor_take_for_ever() {
        let terms: Vec<(Atom, i64)> = (0..60).map(|i| (atom(i), i64::MAX >> (i % 20))).collect();
        let compare = |relation, bound| Comparison { terms: terms.clone(), relation, bound };
        assert!(certainly(&compare(Relation::AtLeast, 0), |_| Label::Unknown));
        assert!(certainly(&compare(Relation::AtLeast, i64::MAX), |_| Label::In));
        assert!(!certainly(&compare(Relation::NotEqual, 12_345), |_| Label::Unknown));
        assert!(certainly(&compare(Relation::NotEqual, -1), |_| Label::Unknown));
    }
}
