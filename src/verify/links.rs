//! Links: that each one listed is safe and short enough, and that they suffice.

use std::collections::VecDeque;

use super::regions::covered;
use super::report::{Kind, Ledger, Place};
use super::resolve::{Link, Node, Resolved};
use super::shape::rounded_norm;
use super::zonotope::Zonotope;
use crate::entity::EntityId;
use crate::exact::{Rational, dot};
use crate::ir::{Connectivity, Norm, Range};

/// Checks the links of every step; nothing with `connectivity none`.
pub(super) fn check(plan: &Resolved, ledger: &mut Ledger) {
    let (Some(steps), Some(asked)) = (&plan.links, &plan.problem.connectivity) else { return };
    ledger.reach(Kind::Links);
    ledger.reach(Kind::Connectivity);
    let origin = Zonotope::origin(plan.problem.dimension);
    for (t, links) in steps.iter().enumerate() {
        for link in links {
            let segment = Segment::new(plan, link, t, &origin);
            segment.clear(plan, ledger);
            if let Some(range) = &asked.range {
                segment.within(range, ledger);
            }
        }
        if required(plan, asked, t) {
            connected(plan, asked, t, links, ledger);
        }
    }
}

/// Whether connectivity is asked at t, whichever round of the loop it is: t ≡ 0 mod n in the
/// prefix, mod gcd(n, ℓ) in the loop of ℓ steps.
fn required(plan: &Resolved, asked: &Connectivity, t: usize) -> bool {
    let every = (asked.every as usize).max(1);
    let period = if t < plan.loop_start { every } else { gcd(every, plan.length + 1 - plan.loop_start) };
    t.is_multiple_of(period)
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// A link at a step: both ends with their tubes (a base has none).
struct Segment<'a> {
    link: &'a Link,
    t: usize,
    ends: [(&'a [Rational], &'a Zonotope); 2],
}

impl<'a> Segment<'a> {
    fn new(plan: &'a Resolved, link: &'a Link, t: usize, origin: &'a Zonotope) -> Segment<'a> {
        let end = |node: Node| -> (&'a [Rational], &'a Zonotope) {
            match node {
                Node::Robot(id) => (&plan.robots[id].p[t], &plan.tube(id).positions),
                Node::Base(id) => (&plan.problem.bases[id].position, origin),
            }
        };
        Segment { link, t, ends: [end(Node::Robot(link.from)), end(link.to)] }
    }

    fn place(&self) -> Place {
        Place::robot(&self.link.name).at(self.t)
    }

    /// One plane for every piece of every blocker of links, with both ends before it.
    fn clear(&self, plan: &Resolved, ledger: &mut Ledger) {
        for (id, blocker) in plan.problem.blockers.iter() {
            let planes: Vec<_> =
                self.link.separators.iter().filter(|(b, _)| *b == id).map(|(_, p)| p).collect();
            if blocker.kind.blocks_links() || !planes.is_empty() {
                let place = || self.place().about(&blocker.name);
                covered(Kind::Links, planes.iter().copied(), &blocker.shape, place, ledger);
            }
            for plane in planes {
                for (point, tube) in self.ends {
                    let slack = &plane.offset - dot(&plane.normal, point) - tube.support(&plane.normal);
                    ledger.positive(Kind::Links, &slack, rounded_norm(&plane.normal), || {
                        let message = format!("the plane of piece {} cuts an end of the link", plane.piece);
                        (self.place().about(&blocker.name), message)
                    });
                }
            }
        }
    }

    /// The ends are never farther apart than the range.
    fn within(&self, range: &Range, ledger: &mut Ledger) {
        let [(p, tube_p), (q, tube_q)] = self.ends;
        let slack = match range.norm {
            Norm::Infinity => &range.length - farthest(p, q, tube_p, tube_q),
            Norm::Euclidean => {
                let corners = tube_p.minus(tube_q).corners();
                let square = |e: &Vec<Rational>| {
                    let distances = (0..p.len()).map(|axis| &p[axis] - &q[axis] + &e[axis]);
                    distances.map(|d| &d * &d).sum::<Rational>()
                };
                &range.length * &range.length - corners.iter().map(square).max().unwrap_or_default()
            }
        };
        // A margin in square metres would mean nothing beside the planes' metres.
        ledger.claim(Kind::Links, !slack.is_negative(), || {
            (self.place(), "the link may be longer than the range".into())
        });
    }
}

/// The greatest ∞-norm distance of two tubes' points.
fn farthest(p: &[Rational], q: &[Rational], tube_p: &Zonotope, tube_q: &Zonotope) -> Rational {
    let along = |axis: usize| {
        [1i8, -1].map(|sign| {
            let apart = &p[axis] - &q[axis];
            let apart = if sign < 0 { -apart } else { apart };
            apart + tube_p.reach(axis, sign) + tube_q.reach(axis, -sign)
        })
    };
    (0..p.len()).flat_map(along).max().unwrap_or_default()
}

/// Every robot reaches a base within the hops, whichever robots are lost.
fn connected(plan: &Resolved, asked: &Connectivity, t: usize, links: &[Link], ledger: &mut Ledger) {
    let graph = Graph::new(plan, links);
    let robots = graph.neighbours.len();
    let limit = asked.hops.map_or(robots, |hops| (hops as usize).min(robots));
    // A path that survives the loss of more survives the loss of fewer, so only largest sets count.
    let losses = (asked.redundancy as usize).min(robots.saturating_sub(1));
    let mut lost = vec![false; robots];
    for_each_subset(robots, losses, &mut lost, &mut |lost| {
        let reached = graph.reached(lost, limit);
        let cut_off = (0..robots).find(|&robot| !reached[robot] && !lost[robot]);
        ledger.claim(Kind::Connectivity, cut_off.is_none(), || {
            let named = |wanted: &dyn Fn(usize) -> bool| -> String {
                let names = plan.robots.iter().filter(|(id, _)| wanted(id.index())).map(|(_, r)| r.name);
                names.collect::<Vec<_>>().join(", ")
            };
            let without = named(&|robot| lost[robot]);
            let without = if without.is_empty() { without } else { format!(" without {without}") };
            let place = Place::robot(&named(&|robot| Some(robot) == cut_off)).at(t);
            (place, format!("reaches no base within {limit} links{without}"))
        });
    });
}

/// Who is linked to whom at a step.
struct Graph {
    neighbours: Vec<Vec<usize>>,
    at_base: Vec<bool>,
}

impl Graph {
    fn new(plan: &Resolved, links: &[Link]) -> Graph {
        let robots = plan.robots.len();
        let mut graph = Graph { neighbours: vec![Vec::new(); robots], at_base: vec![false; robots] };
        for link in links {
            match link.to {
                Node::Base(_) => graph.at_base[link.from.index()] = true,
                Node::Robot(to) => {
                    graph.neighbours[link.from.index()].push(to.index());
                    graph.neighbours[to.index()].push(link.from.index());
                }
            }
        }
        graph
    }

    /// Walks from the bases outwards, at most `limit` links.
    fn reached(&self, lost: &[bool], limit: usize) -> Vec<bool> {
        let mut reached = vec![false; lost.len()];
        let mut queue = VecDeque::new();
        for robot in (0..lost.len()).filter(|&r| limit >= 1 && self.at_base[r] && !lost[r]) {
            reached[robot] = true;
            queue.push_back((robot, 1));
        }
        while let Some((robot, hops)) = queue.pop_front() {
            if hops == limit {
                continue;
            }
            for &other in &self.neighbours[robot] {
                if !reached[other] && !lost[other] {
                    reached[other] = true;
                    queue.push_back((other, hops + 1));
                }
            }
        }
        reached
    }
}

/// Calls `visit` with each set of `count` of the first `below` members marked.
fn for_each_subset(below: usize, count: usize, marked: &mut Vec<bool>, visit: &mut dyn FnMut(&[bool])) {
    if count == 0 {
        return visit(marked);
    }
    for member in (count - 1)..below {
        marked[member] = true;
        for_each_subset(member, count - 1, marked, visit);
        marked[member] = false;
    }
}
