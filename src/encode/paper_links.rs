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
    fn new(circuit: &mut Circuit, robots: usize, bases: usize) -> Paths {
        let nodes = robots + bases;
        let longest = nodes.saturating_sub(1);
        let mut paths = Paths { robots, nodes, levels: Vec::new() };
        for _ in 1..=longest {
            paths.levels.push((0..nodes * longest / 2).map(|_| circuit.growing_and()).collect());
        }
        (1..=longest).for_each(|links| paths.define(circuit, links));
        paths
    }

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
    pub(super) fn paper(
        circuit: &mut Circuit,
        robots: usize,
        bases: usize,
        hops: usize,
    ) -> (StepLinks, Vec<Bit>) {
        let nodes = robots + bases;
        let paths = Paths::new(circuit, robots, bases);
        let longest = paths.levels.len();
        let mut reached = Vec::new();
        for robot in 0..robots {
            let counts = 1..=hops.min(longest);
            let ways = counts.flat_map(|h| (robots..nodes).map(move |base| (base, h)));
            reached.push(circuit.or(ways.map(|(base, h)| Bit::Lit(paths.path(robot, base, h)))));
        }
        let robot_pairs = (0..robots).flat_map(|i| (i + 1..robots).map(move |j| (i, j)));
        let base_pairs = (0..robots).flat_map(|i| (robots..nodes).map(move |b| (i, b)));
        let links = StepLinks {
            robots,
            bases,
            pairs: robot_pairs.map(|(i, j)| paths.path(i, j, 1)).collect(),
            direct: base_pairs.map(|(i, b)| paths.path(i, b, 1)).collect(),
            variables: paths.levels.iter().map(Vec::len).sum(),
        };
        (links, reached)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Link;
    use super::*;
    use rustsat::solvers::{SolveIncremental, SolverResult};
    use rustsat_batsat::BasicSolver;

    /// The links of one step, as a set of pairs of nodes, robots before bases.
    struct Graph {
        robots: usize,
        nodes: usize,
        links: Vec<(usize, usize)>,
    }

    impl Graph {
        /// All graphs without links between bases.
        fn all(robots: usize, bases: usize) -> impl Iterator<Item = Graph> {
            let nodes = robots + bases;
            let pairs: Vec<(usize, usize)> =
                (0..robots).flat_map(|i| (i + 1..nodes).map(move |j| (i, j))).collect();
            (0..1u32 << pairs.len()).map(move |choice| {
                let chosen = pairs.iter().enumerate().filter(|(at, _)| choice >> at & 1 == 1);
                Graph { robots, nodes, links: chosen.map(|(_, pair)| *pair).collect() }
            })
        }

        fn linked(&self, a: usize, b: usize) -> bool {
            self.links.contains(&(a.min(b), a.max(b)))
        }

        /// Whether a walk of so many links leads from a to b, with robots alone in between that are
        /// neither of the two.
        fn walk(&self, a: usize, b: usize, links: usize) -> bool {
            if links == 1 {
                return self.linked(a, b);
            }
            let mut relays = (0..self.robots).filter(|&r| r != a && r != b);
            relays.any(|r| self.linked(r, b) && self.walk(a, r, links - 1))
        }

        /// Whether each robot that is not lost reaches a base by so many links without those that
        /// are, breadth first.
        fn connected(&self, hops: usize, lost: &[usize]) -> bool {
            let mut reached: Vec<bool> = (0..self.nodes).map(|node| node >= self.robots).collect();
            for _ in 0..hops.min(self.nodes) {
                let before = reached.clone();
                let left = |&&(a, b): &&(usize, usize)| !lost.contains(&a) && !lost.contains(&b);
                for &(a, b) in self.links.iter().filter(left) {
                    reached[a] |= before[b];
                    reached[b] |= before[a];
                }
            }
            reached.into_iter().enumerate().all(|(node, r)| r || lost.contains(&node))
        }

        /// The literals of the links that are there, and the negated ones of those that are not.
        fn forced(&self, links: &StepLinks) -> Vec<Lit> {
            let ends = |link| match link {
                Link::Robots(a, b) => (index(a), index(b)),
                Link::Base(a, b) => (index(a), self.robots + index(b)),
            };
            let forced = |(link, lit): (Link, Lit)| {
                let (a, b) = ends(link);
                if self.linked(a, b) { lit } else { !lit }
            };
            links.iter().map(forced).collect()
        }
    }

    fn solver(circuit: &mut Circuit) -> BasicSolver {
        let mut solver = BasicSolver::default();
        circuit.write_clauses(&mut solver).unwrap();
        solver
    }

    fn satisfiable(solver: &mut BasicSolver, assumptions: &[Lit]) -> bool {
        solver.solve_assumps(assumptions).unwrap() == SolverResult::Sat
    }

    fn for_all_graphs(visit: impl Fn(&Graph)) {
        for (robots, bases) in [(2, 1), (3, 1), (2, 2)] {
            Graph::all(robots, bases).for_each(|graph| visit(&graph));
        }
    }

    /// Erratum P2 and P9: an isolated robot reaches nobody, and two robots can't vouch for each other.
    #[test]
    fn erratum_p9_robots_are_connected_exactly_if_a_search_says_so() {
        for_all_graphs(|graph| {
            for (hops, new) in [1, 2, usize::MAX]
                .into_iter()
                .flat_map(|hops| [StepLinks::new, StepLinks::paper].into_iter().map(move |new| (hops, new)))
            {
                let mut circuit = Circuit::default();
                let (links, reached) = new(&mut circuit, graph.robots, graph.nodes - graph.robots, hops);
                reached.into_iter().for_each(|bit| circuit.require(bit));
                let found = satisfiable(&mut solver(&mut circuit), &graph.forced(&links));
                assert_eq!(found, graph.connected(hops, &[]), "{:?} {hops}", graph.links);
            }
        });
    }

    #[test]
    fn robots_outlive_others_exactly_if_a_search_says_so() {
        for_all_graphs(|graph| {
            for (hops, lost) in [1, 2, usize::MAX].into_iter().flat_map(|h| [(h, 0), (h, 1)]) {
                let mut circuit = Circuit::default();
                let (mut links, _) =
                    StepLinks::new(&mut circuit, graph.robots, graph.nodes - graph.robots, hops);
                let id = crate::entity::EntityId::new(lost);
                let reached = links.reached(&mut circuit, hops, &[id]);
                reached.into_iter().for_each(|bit| circuit.require(bit));
                let found = satisfiable(&mut solver(&mut circuit), &graph.forced(&links));
                assert_eq!(found, graph.connected(hops, &[lost]), "{:?} {hops} {lost}", graph.links);
            }
        });
    }

    fn index(id: impl crate::entity::EntityId) -> usize {
        id.index()
    }

    /// Erratum P8: a base is nobody's relay.
    #[test]
    fn erratum_p8_paths_lead_over_robots_alone() {
        for_all_graphs(|graph| {
            let mut circuit = Circuit::default();
            let paths = Paths::new(&mut circuit, graph.robots, graph.nodes - graph.robots);
            let mut solver = solver(&mut circuit);
            for links in 1..graph.nodes {
                for a in 0..graph.robots {
                    for b in a + 1..graph.nodes {
                        let mut assumptions = vec![paths.path(a, b, links)];
                        for i in 0..graph.robots {
                            for j in i + 1..graph.nodes {
                                let lit = paths.path(i, j, 1);
                                assumptions.push(if graph.linked(i, j) { lit } else { !lit });
                            }
                        }
                        let joined = satisfiable(&mut solver, &assumptions);
                        assert_eq!(joined, graph.walk(a, b, links), "{a} {b} {links}: {:?}", graph.links);
                    }
                }
            }
        });
    }
}
