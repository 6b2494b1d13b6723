//! What has been demanded of the Boolean part so far.
//!
//! A demand is first made only where a candidate violates it. What is violated again and again is
//! then demanded at every step, present and future: in a mission that cannot be fulfilled, every
//! step would be tried in turn. What is violated though it was demanded gets its next disjuncts: a
//! demand's rarer directions, and constraints on two robots at once, count as fulfilled until then.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

use crate::abstraction::SolidId;
use crate::encode::{Encoder, Link};
use crate::ir::RobotId;

use super::clearance::Violation;

/// So many steps with one violation, and it is demanded at all of them.
const RECURRING: usize = 3;

/// What is to be kept clear of a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum What {
    Move(RobotId),
    Link(Link),
}

/// The demands made so far.
#[derive(Debug, Default)]
pub struct Demands {
    /// By what and where: the steps of the demand itself, then those at which its first, second, …
    /// deferred disjuncts were given their meaning.
    clear: BTreeMap<(What, SolidId), Vec<BTreeSet<usize>>>,
    apart: BTreeSet<(RobotId, RobotId, usize)>,
    /// By link: the steps at which it is to be short enough along the axes.
    ranges: BTreeMap<Link, BTreeSet<usize>>,
    /// By who is lost: the steps at which the others are to reach a base.
    reach: BTreeMap<Vec<RobotId>, BTreeSet<usize>>,
}

impl Demands {
    /// Makes the demands of some violations for a length. False when all of
    /// them had been made and say all that there is to say.
    pub fn make(&mut self, violations: Vec<Violation>, length: usize, encoder: &mut Encoder<'_>) -> bool {
        let mut new = false;
        for violation in violations {
            new |= match violation {
                Violation::Move(robot, step, solid) => {
                    self.demand(What::Move(robot), step, solid, length, encoder)
                }
                Violation::Link(link, step, solid) => {
                    self.demand(What::Link(link), step, solid, length, encoder)
                }
                Violation::TooLong(link, step, normal) => {
                    // The tangent through the very excess, once the axes' rows are there.
                    self.demand_range(link, step, length, encoder)
                        || encoder.demand_range_along(link, step, &normal)
                }
                Violation::CutOff(step, lost) => self.demand_reach(step, lost, length, encoder),
                Violation::Apart(first, second, step, cuts) => {
                    if self.apart.insert((first, second, step)) {
                        encoder.demand_apart(first, second, step, cuts);
                        true
                    } else {
                        encoder.sharpen_apart(first, second, step, cuts)
                    }
                }
            };
        }
        new
    }

    fn demand(
        &mut self,
        what: What,
        step: usize,
        solid: SolidId,
        length: usize,
        encoder: &mut Encoder<'_>,
    ) -> bool {
        let levels = self.clear.entry((what, solid)).or_default();
        let level = levels.iter().position(|steps| !steps.contains(&step)).unwrap_or(levels.len());
        if !raise(what, step, solid, level, encoder) {
            return false;
        }
        levels.resize(levels.len().max(level + 1), BTreeSet::new());
        levels[level].insert(step);
        if levels[level].len() == RECURRING {
            raise_all(what, solid, levels, 0..=length, encoder);
        }
        true
    }

    fn demand_range(&mut self, link: Link, step: usize, length: usize, encoder: &mut Encoder<'_>) -> bool {
        let steps = self.ranges.entry(link).or_default();
        if !steps.insert(step) {
            return false;
        }
        encoder.demand_range(link, step);
        if steps.len() == RECURRING {
            let others = (0..=length).filter(|step| steps.insert(*step));
            others.for_each(|step| {
                encoder.demand_range(link, step);
            });
        }
        true
    }

    fn demand_reach(
        &mut self,
        step: usize,
        lost: Vec<RobotId>,
        length: usize,
        encoder: &mut Encoder<'_>,
    ) -> bool {
        let steps = self.reach.entry(lost.clone()).or_default();
        if !steps.insert(step) {
            return false;
        }
        encoder.demand_reach(step, &lost);
        if steps.len() == RECURRING {
            let others = (0..=length).filter(|step| steps.insert(*step));
            others.for_each(|step| encoder.demand_reach(step, &lost));
        }
        true
    }

    /// Makes the recurring demands for the last step of a new length.
    pub fn extend(&mut self, length: usize, encoder: &mut Encoder<'_>) {
        for (link, steps) in self.ranges.iter_mut().filter(|(_, steps)| steps.len() >= RECURRING) {
            if steps.insert(length) {
                encoder.demand_range(*link, length);
            }
        }
        for (lost, steps) in self.reach.iter_mut().filter(|(_, steps)| steps.len() >= RECURRING) {
            if steps.insert(length) {
                encoder.demand_reach(length, lost);
            }
        }
        for ((what, solid), levels) in &mut self.clear {
            raise_all(*what, *solid, levels, length..=length, encoder);
        }
    }
}

/// Brings some steps up to every level that recurs.
fn raise_all(
    what: What,
    solid: SolidId,
    levels: &mut [BTreeSet<usize>],
    range: RangeInclusive<usize>,
    encoder: &mut Encoder<'_>,
) {
    for step in range {
        for (level, steps) in levels.iter_mut().enumerate().take_while(|(_, s)| s.len() >= RECURRING) {
            if steps.insert(step) {
                raise(what, step, solid, level, encoder);
            }
        }
    }
}

/// Makes a demand, or gives its next disjuncts their meaning. False when all is said.
fn raise(what: What, step: usize, solid: SolidId, level: usize, encoder: &mut Encoder<'_>) -> bool {
    match (what, level) {
        (What::Move(robot), 0) => encoder.demand_clear_move(robot, step, solid),
        (What::Link(link), 0) => encoder.demand_clear_link(link, step, solid),
        (What::Move(robot), _) => return encoder.sharpen_move(robot, step, solid),
        (What::Link(link), _) => return encoder.sharpen_link(link, step, solid),
    }
    true
}
