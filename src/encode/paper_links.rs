//! The paper's encoding of communication: who reaches whom by so many links.
//!
//! With N nodes, robots and bases, there is one variable a step for each unordered pair of nodes and
//! each number of links h from 1 to N − 1: C(N, 2)·(N − 1) of them. The paper's transitivity holds
//! for h ≥ 2 only, and h falls by one a link, so nobody vouches for himself (theory.md §1, P9). A base
//! is nobody's relay (P8): the variables of pairs of bases are false.

use rustsat::types::Lit;

use super::circuit::{Bit, Circuit};
use super::links::StepLinks;

/// Variables 'these two nodes are joined by a path of h links', robots before bases.
struct Paths {
    robots: usize,
    nodes: usize,
    /// By h − 1, row-major over pairs i < j.
    levels: Vec<Vec<Lit>>,
}

impl Paths {
    fn pair(&self, a: usize, b: usize) -> usize {
        let (i, j) = (a.min(b), a.max(b));
        i * self.nodes - i * (i + 1) / 2 + j - i - 1
    }

    fn path(&self, a: usize, b: usize, links: usize) -> Lit {
        self.levels[links - 1][self.pair(a, b)]
    }

    /// Paths of a number of links: one link fewer to a relay, and one more from there.
    fn define(&self, circuit: &mut Circuit, links: usize) {
        for a in 0..self.nodes {
            for b in a + 1..self.nodes {
                let lit = self.path(a, b, links);
                let some = match (links, a < self.robots) {
                    (_, false) => Bit::False,
                    (1, true) => Bit::True,
                    _ => {
                        let relays = (0..self.robots).filter(|&relay| relay != a && relay != b);
                        let way = |relay| (self.path(a, relay, links - 1), self.path(relay, b, 1));
                        let ways: Vec<(Bit, Bit)> =
                            relays.map(way).map(|(far, near)| (Bit::Lit(far), Bit::Lit(near))).collect();
                        circuit.some_pair(&ways)
                    }
                };
                circuit.grow(lit, some);
            }
        }
    }
}

impl StepLinks {
    /// As [`new`](StepLinks::new), with the paper's variables. `variables` counts these alone.
    pub(super) fn paper(circuit: &mut Circuit, robots: usize, bases: usize, hops: usize) -> StepLinks {
        let nodes = robots + bases;
        let longest = nodes.saturating_sub(1);
        let mut paths = Paths { robots, nodes, levels: Vec::new() };
        let pairs = nodes * longest / 2;
        for _ in 1..=longest {
            paths.levels.push((0..pairs).map(|_| circuit.growing_and()).collect());
        }
        (1..=longest).for_each(|links| paths.define(circuit, links));
        for robot in 0..robots {
            let counts = 1..=hops.min(longest);
            let ways = counts.flat_map(|h| (robots..nodes).map(move |base| (base, h)));
            let reached = circuit.or(ways.map(|(base, h)| Bit::Lit(paths.path(robot, base, h))));
            circuit.require(reached);
        }
        let robot_pairs = (0..robots).flat_map(|i| (i + 1..robots).map(move |j| (i, j)));
        let base_pairs = (0..robots).flat_map(|i| (robots..nodes).map(move |b| (i, b)));
        StepLinks {
            robots,
            bases,
            pairs: robot_pairs.map(|(i, j)| paths.path(i, j, 1)).collect(),
            direct: base_pairs.map(|(i, b)| paths.path(i, b, 1)).collect(),
            variables: pairs * longest,
        }
    }
}
