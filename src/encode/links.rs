//! Multi-hop communication: links between robots and bases, and levels that fall towards a base.

use crate::entity::EntityId;
use crate::ir::{BaseId, RobotId};
use rustsat::types::Lit;

use super::circuit::{Bit, Circuit};

/// A possible link at one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Link {
    /// Between two robots, the first with the smaller id.
    Robots(RobotId, RobotId),
    /// Between a robot and a base.
    Base(RobotId, BaseId),
}

/// The communication variables of one step.
///
/// Links start out unconditional; what blocks them is added as conjuncts when it matters.
#[derive(Debug)]
pub struct StepLinks {
    pub(super) robots: usize,
    pub(super) bases: usize,
    /// Row-major over pairs i < j.
    pub(super) pairs: Vec<Lit>,
    /// By robot and base.
    pub(super) direct: Vec<Lit>,
    /// The variables that this step's communication took.
    pub variables: usize,
}

impl StepLinks {
    /// The links of one step, and for each robot 'it has a path of at most `hops` links to some base'.
    pub fn new(circuit: &mut Circuit, robots: usize, bases: usize, hops: usize) -> (StepLinks, Vec<Bit>) {
        let before = circuit.variables();
        let pairs = (0..robots * robots.saturating_sub(1) / 2).map(|_| circuit.growing_and()).collect();
        let direct = (0..robots * bases).map(|_| circuit.growing_and()).collect();
        let mut links = StepLinks { robots, bases, pairs, direct, variables: 0 };
        let reached = links.reached(circuit, hops, &[]);
        links.variables = circuit.variables() - before;
        (links, reached)
    }

    /// For each robot that is not lost: 'it has a path of at most `hops` links to some base, over robots that
    /// are not lost either'.
    ///
    /// Level h of a robot says that some path has h links; it rests on a link to a robot of level
    /// h − 1, so two robots can't vouch for each other.
    pub fn reached(&mut self, circuit: &mut Circuit, hops: usize, lost: &[RobotId]) -> Vec<Bit> {
        let before = circuit.variables();
        let left: Vec<usize> = (0..self.robots).filter(|r| !lost.contains(&RobotId::new(*r))).collect();
        let mut levels: Vec<Vec<Bit>> = vec![self.first_level(circuit, &left)];
        for _ in 2..=hops.min(left.len()) {
            let next = self.next_level(circuit, &left, &levels[levels.len() - 1]);
            levels.push(next);
        }
        let reached = |at: usize| levels.iter().map(move |level| level[at]);
        let all = (0..left.len()).map(|at| circuit.or(reached(at))).collect();
        self.variables += circuit.variables() - before;
        all
    }

    fn first_level(&self, circuit: &mut Circuit, left: &[usize]) -> Vec<Bit> {
        let row = |robot: usize| &self.direct[robot * self.bases..(robot + 1) * self.bases];
        left.iter().map(|&robot| circuit.or(row(robot).iter().map(|&l| Bit::Lit(l)))).collect()
    }

    fn next_level(&self, circuit: &mut Circuit, left: &[usize], below: &[Bit]) -> Vec<Bit> {
        let level = |robot: usize| -> Vec<(Bit, Bit)> {
            let others = left.iter().zip(below).filter(|(other, _)| **other != robot);
            others.map(|(&other, &below)| (Bit::Lit(self.pair(robot, other)), below)).collect()
        };
        left.iter().map(|&robot| circuit.some_pair(&level(robot))).collect()
    }

    fn pair(&self, a: usize, b: usize) -> Lit {
        let (i, j) = (a.min(b), a.max(b));
        self.pairs[i * self.robots - i * (i + 1) / 2 + j - i - 1]
    }

    /// The variable of a link.
    pub fn literal(&self, link: Link) -> Lit {
        match link {
            Link::Robots(a, b) => self.pair(a.index(), b.index()),
            Link::Base(robot, base) => self.direct[robot.index() * self.bases + base.index()],
        }
    }

    /// All links with their variables.
    pub fn iter(&self) -> impl Iterator<Item = (Link, Lit)> + '_ {
        let robots = (0..self.robots).flat_map(move |i| (i + 1..self.robots).map(move |j| (i, j)));
        let pairs = robots.map(|(i, j)| Link::Robots(RobotId::new(i), RobotId::new(j)));
        let direct = (0..self.robots).flat_map(move |i| (0..self.bases).map(move |b| (i, b)));
        let direct = direct.map(|(i, b)| Link::Base(RobotId::new(i), BaseId::new(b)));
        pairs.chain(direct).map(|link| (link, self.literal(link)))
    }
}
