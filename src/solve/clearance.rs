//! What trajectories violate of all that the Boolean part has left out so far.

use crate::abstraction::{Abstraction, Body, Owner, SolidId};
use crate::encode::{Link, is_asked, link_models, losses};
use crate::entity::{EntityId, Table};
use crate::ir::{Problem, RobotId};

use super::robots::Trajectory;

/// Something left out that matters.
#[derive(Clone, Debug, PartialEq)]
pub enum Violation {
    /// A robot's move from a step to the next is not clear of a solid.
    Move(RobotId, usize, SolidId),
    /// A link in use is not clear of a solid.
    Link(Link, usize, SolidId),
    /// Two robots are not apart during a step; the coordinates halfway between them at both ends.
    Apart(RobotId, RobotId, usize, [Vec<f64>; 2]),
    /// A link in use may be longer than the range, along this normal.
    TooLong(Link, usize, Vec<f64>),
    /// Some robot reaches no base at a step when others are lost.
    CutOff(usize, Vec<RobotId>),
}

/// The geometry of a candidate's trajectories.
pub struct Scene<'a> {
    problem: &'a Problem,
    abstraction: &'a Abstraction,
    /// By robot and step: the nominal position.
    positions: Vec<Vec<Vec<f64>>>,
    length: usize,
}

impl<'a> Scene<'a> {
    /// The scene of trajectories of a length.
    pub fn new(
        problem: &'a Problem,
        abstraction: &'a Abstraction,
        trajectories: &Table<RobotId, Trajectory>,
        length: usize,
    ) -> Scene<'a> {
        let path = |(robot, trajectory): (RobotId, &Trajectory)| {
            let position = &problem.models[problem.robots[robot].model].position;
            let at = |z: &nalgebra::DVector<f64>| position.iter().map(|&s| z[s]).collect();
            trajectory.states.iter().map(at).collect()
        };
        Scene { problem, abstraction, positions: trajectories.iter().map(path).collect(), length }
    }

    /// Everything that is violated with these links in use and the loop back to `loop_start`, in a
    /// fixed order.
    pub fn violations(&self, links: &[Vec<Link>], loop_start: usize) -> Vec<Violation> {
        let mut found = Vec::new();
        self.moves(&mut found);
        self.links(links, &mut found);
        self.ranges(links, &mut found);
        self.pairs(&mut found);
        self.losses(links, loop_start, &mut found);
        found
    }

    fn losses(&self, links: &[Vec<Link>], loop_start: usize, found: &mut Vec<Violation>) {
        let Some(asked) = &self.problem.connectivity else { return };
        let robots = self.problem.robots.len();
        for (step, links) in links.iter().enumerate() {
            if is_asked(asked, step, self.length, loop_start) {
                let cut_off = |lost: &Vec<RobotId>| !all_reach(robots, links, lost, asked.hops);
                let sets = losses(asked, robots).filter(cut_off);
                found.extend(sets.map(|lost| Violation::CutOff(step, lost)));
            }
        }
    }

    fn body(&self, robot: RobotId, step: usize) -> Body<'_> {
        let center = &self.positions[robot.index()][step];
        Body { center, model: Some(self.problem.robots[robot].model) }
    }

    fn moves(&self, found: &mut Vec<Violation>) {
        for robot in self.problem.robots.ids() {
            for step in 0..=self.length {
                let ends = [self.body(robot, step), self.body(robot, step + 1)];
                for (solid, entry) in self.abstraction.solids.iter() {
                    let blocks = matches!(entry.owner, Owner::Blocker(_));
                    if blocks && self.abstraction.separate(&ends, solid).is_none() {
                        found.push(Violation::Move(robot, step, solid));
                    }
                }
            }
        }
    }

    fn links(&self, links: &[Vec<Link>], found: &mut Vec<Violation>) {
        for (step, links) in links.iter().enumerate() {
            for &link in links {
                for (solid, entry) in self.abstraction.solids.iter() {
                    let blocks = match entry.owner {
                        Owner::Blocker(id) => self.problem.blockers[id].kind.blocks_links(),
                        Owner::Region(_) => false,
                    };
                    if blocks && self.abstraction.separate(&self.ends(link, step), solid).is_none() {
                        found.push(Violation::Link(link, step, solid));
                    }
                }
            }
        }
    }

    fn ranges(&self, links: &[Vec<Link>], found: &mut Vec<Violation>) {
        let Some(range) = &self.abstraction.range else { return };
        for (step, links) in links.iter().enumerate() {
            for &link in links {
                let [a, b] = self.ends(link, step).map(|body| body.center);
                let between: Vec<f64> = a.iter().zip(b).map(|(x, y)| x - y).collect();
                let excess = range.excess(link_models(self.problem, link), &between);
                found.extend(excess.map(|normal| Violation::TooLong(link, step, normal)));
            }
        }
    }

    fn ends(&self, link: Link, step: usize) -> [Body<'_>; 2] {
        match link {
            Link::Robots(a, b) => [self.body(a, step), self.body(b, step)],
            Link::Base(robot, base) => {
                [self.body(robot, step), Body { center: self.abstraction.base(base), model: None }]
            }
        }
    }

    fn pairs(&self, found: &mut Vec<Violation>) {
        if self.problem.separation.is_none() {
            return;
        }
        for first in self.problem.robots.ids() {
            for second in self.problem.robots.ids().filter(|other| *other > first) {
                for step in 0..=self.length {
                    if self.face(first, second, step).is_none() {
                        let cuts = [step, step + 1].map(|t| self.middle(first, second, t));
                        found.push(Violation::Apart(first, second, step, cuts));
                    }
                }
            }
        }
    }

    fn face(&self, first: RobotId, second: RobotId, step: usize) -> Option<(usize, bool)> {
        let at = |robot: RobotId| [step, step + 1].map(|t| &self.positions[robot.index()][t][..]);
        self.abstraction.separating_face(self.problem, [first, second], [at(first), at(second)])
    }

    fn coordinate(&self, robot: RobotId, step: usize, axis: usize) -> f64 {
        self.positions[robot.index()][step][axis]
    }

    fn middle(&self, first: RobotId, second: RobotId, step: usize) -> Vec<f64> {
        let middle = |axis| 0.5 * (self.coordinate(first, step, axis) + self.coordinate(second, step, axis));
        (0..self.problem.dimension).map(middle).collect()
    }
}

/// Whether every robot that is not lost reaches a base by at most `hops` links over such robots.
fn all_reach(robots: usize, links: &[Link], lost: &[RobotId], hops: Option<u32>) -> bool {
    let left = |robot: RobotId| !lost.contains(&robot);
    let mut reached = vec![false; robots];
    let steps = hops.map_or(robots, |h| robots.min(h as usize));
    for step in 0..steps {
        let before = reached.clone();
        for &link in links {
            match link {
                Link::Base(robot, _) => reached[robot.index()] |= step == 0,
                Link::Robots(a, b) if left(a) && left(b) => {
                    reached[a.index()] |= before[b.index()];
                    reached[b.index()] |= before[a.index()];
                }
                Link::Robots(..) => {}
            }
        }
    }
    (0..robots).all(|robot| reached[robot] || !left(RobotId::new(robot)))
}
