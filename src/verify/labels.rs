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
