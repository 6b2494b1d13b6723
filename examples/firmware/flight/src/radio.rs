//! A radio on which nobody hears anybody through a jammer.

use fig2_4_controller::Node;

use crate::team::ROBOTS;

/// Where the base station is.
const BASE: [f64; 2] = [1.0, 1.0];

/// The jammers: centre and radius, in metres.
const JAMMERS: [([f64; 2], f64); 3] = [([4.0, 7.0], 1.0), ([8.5, 9.0], 1.0), ([7.0, 3.0], 1.0)];

/// The ether for one step: where everybody is, and who holds whose report.
#[derive(Clone, Debug)]
pub struct Radio {
    positions: [[f64; 2]; ROBOTS],
    /// Who holds each robot's report; `None` when it is lost.
    holders: [Option<Node>; ROBOTS],
    /// How many transmissions were heard.
    pub hops: u32,
    /// How many were not.
    pub jammed: u32,
}

impl Radio {
    /// Everybody has a report to make.
    pub fn new(positions: [[f64; 2]; ROBOTS]) -> Radio {
        let holders = core::array::from_fn(|robot| Some(Node::ALL[robot]));
        Radio { positions, holders, hops: 0, jammed: 0 }
    }

    /// Whoever holds reports sends them to its next hop, as often as it takes from the furthest robot
    /// to a base; says whose arrived there.
    pub fn forward(&mut self, next: [Option<Node>; ROBOTS]) -> [bool; ROBOTS] {
        for _ in 0..ROBOTS {
            for report in 0..ROBOTS {
                let Some(from) = self.holders[report].filter(|node| !node.is_base()) else { continue };
                let Some(to) = next[from as usize] else { continue };
                let heard = in_the_clear(self.position(from), self.position(to));
                self.holders[report] = heard.then_some(to);
                *(if heard { &mut self.hops } else { &mut self.jammed }) += 1;
            }
        }
        self.holders.map(|holder| holder.is_some_and(Node::is_base))
    }

    /// Where a node is.
    fn position(&self, node: Node) -> [f64; 2] {
        self.positions.get(node as usize).copied().unwrap_or(BASE)
    }
}

/// Whether the straight line between two points misses all jammers.
pub fn in_the_clear(a: [f64; 2], b: [f64; 2]) -> bool {
    JAMMERS.iter().all(|(center, radius)| distance_squared(a, b, *center) > radius * radius)
}

/// The squared distance of a point from the line between two others.
fn distance_squared(a: [f64; 2], b: [f64; 2], point: [f64; 2]) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let to = [point[0] - a[0], point[1] - a[1]];
    let length = along[0] * along[0] + along[1] * along[1];
    let at = if length > 0.0 { (to[0] * along[0] + to[1] * along[1]) / length } else { 0.0 };
    let at = at.clamp(0.0, 1.0);
    let off = [to[0] - at * along[0], to[1] - at * along[1]];
    off[0] * off[0] + off[1] * off[1]
}
