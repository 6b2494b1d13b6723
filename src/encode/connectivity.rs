//! When the links of a step have to reach a base, and whom they must reach without.
//!
//! With `every n` connectivity is asked at the times t ≡ 0 mod n of the infinite run. In the prefix
//! that is n itself; a position in a loop of ℓ steps comes again ℓ later, so there it is the greatest
//! common divisor of n and ℓ. With `redundancy k` it is asked whichever k robots are lost; these
//! demands come one by one, since most follow from the links in use anyway.

use rustsat::types::Lit;

use super::Encoder;
use super::circuit::Bit;
use super::links::StepLinks;
use crate::ir::{Connectivity, RobotId};

/// Whether connectivity is asked at a position of a lasso.
pub fn is_asked(asked: &Connectivity, step: usize, length: usize, loop_start: usize) -> bool {
    let every = asked.every.max(1) as usize;
    let period = if step < loop_start { every } else { common_divisor(every, length + 1 - loop_start) };
    step.is_multiple_of(period)
}

/// The sets of robots that connectivity has to survive the loss of: the largest ones alone, since a
/// path that survives the loss of more survives the loss of fewer.
pub fn losses(asked: &Connectivity, robots: usize) -> impl Iterator<Item = Vec<RobotId>> {
    let size = (asked.redundancy as usize).min(robots.saturating_sub(1));
    let first = (size > 0).then(|| (0..size).collect::<Vec<usize>>());
    let sets = std::iter::successors(first, move |set| next_set(set, robots));
    sets.map(|set| set.into_iter().map(crate::entity::EntityId::new).collect())
}

/// The next set of as many members below a bound, in lexicographic order.
fn next_set(set: &[usize], below: usize) -> Option<Vec<usize>> {
    let size = set.len();
    let at = (0..size).rev().find(|&at| set[at] + size - at < below)?;
    let risen = (at..size).map(|i| set[at] + 1 + i - at);
    Some(set[..at].iter().copied().chain(risen).collect())
}

fn common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

impl Encoder<'_> {
    /// The links of a new position.
    pub(super) fn add_links(&mut self, step: usize) {
        let Some(asked) = &self.problem.connectivity else { return };
        let (robots, bases) = (self.problem.robots.len(), self.problem.bases.len());
        let new = if self.cells.is_some() { StepLinks::paper } else { StepLinks::new };
        let (links, reached) = new(&mut self.circuit, robots, bases, hops(asked));
        self.links.push(links);
        let always = step.is_multiple_of(asked.every.max(1) as usize);
        let sometimes = (!always).then(|| self.circuit.growing_and());
        self.connected.push(sometimes);
        self.add_reached(step, reached);
    }

    /// Adds to what holds where connectivity is asked.
    fn add_reached(&mut self, step: usize, reached: Vec<Bit>) {
        for bit in reached {
            match self.connected[step] {
                Some(connected) => self.circuit.grow(connected, bit),
                None => self.circuit.require(bit),
            }
        }
    }

    /// Asks for connectivity at the positions of a loop where a later round needs it.
    pub(super) fn connect_loops(&mut self, length: usize, loops: &[Lit]) {
        let Some(asked) = &self.problem.connectivity else { return };
        for (back, &lit) in loops.iter().enumerate() {
            let steps = (back..=length).filter(|&step| is_asked(asked, step, length, back));
            let connected: Vec<Bit> = steps.filter_map(|step| self.connected[step].map(Bit::Lit)).collect();
            let all = self.circuit.and(connected);
            // Not going back there is a choice that rests on nothing.
            let asked_or_not = self.circuit.or([Bit::Lit(!lit), all]);
            self.circuit.require(asked_or_not);
        }
    }

    /// Demands that the robots left reach a base when some are lost, where connectivity is asked.
    pub fn demand_reach(&mut self, step: usize, lost: &[RobotId]) {
        let Some(asked) = &self.problem.connectivity else { return };
        let reached = self.links[step].reached(&mut self.circuit, hops(asked), lost);
        self.add_reached(step, reached);
    }
}

fn hops(asked: &Connectivity) -> usize {
    asked.hops.map_or(usize::MAX, |h| h as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::entity::EntityId;

    fn asked(every: u32, redundancy: u32) -> Connectivity {
        Connectivity { hops: None, range: None, redundancy, every }
    }

    /// The infinite run of a lasso, walked for many rounds.
    #[test]
    fn a_position_is_asked_when_some_round_needs_it() {
        for every in 1..=6 {
            for length in 0..=9usize {
                for back in 0..=length {
                    let mut needed = vec![false; length + 1];
                    let mut position = 0;
                    for time in 0..1000usize {
                        needed[position] |= time.is_multiple_of(every as usize);
                        position = if position == length { back } else { position + 1 };
                    }
                    let said: Vec<bool> =
                        (0..=length).map(|t| is_asked(&asked(every, 0), t, length, back)).collect();
                    assert_eq!(said, needed, "every {every}, length {length}, back to {back}");
                }
            }
        }
    }

    #[test]
    fn the_losses_are_all_sets_of_as_many_robots_as_may_drop_out() {
        let sets = |redundancy, robots| -> Vec<Vec<usize>> {
            let asked = asked(1, redundancy);
            losses(&asked, robots).map(|set| set.into_iter().map(EntityId::index).collect()).collect()
        };
        assert_eq!(sets(0, 3), Vec::<Vec<usize>>::new());
        assert_eq!(sets(1, 3), [[0], [1], [2]]);
        assert_eq!(sets(2, 4), [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]);
        assert_eq!(sets(3, 2), [[0], [1]]);
        assert_eq!(sets(1, 1), Vec::<Vec<usize>>::new());
        assert_eq!(sets(3, 6).len(), 20);
    }
}
