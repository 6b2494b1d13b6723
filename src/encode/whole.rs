//! A whole instance, for files: everything that the search would add on demand is there at once.
//!
//! It is satisfiable at a length, under the length's literal, just when there is a plan of that
//! length whose separating planes have the directions at hand. Steps beyond the length do no harm:
//! a plan can go on round its loop for ever.

use rustsat::instances::Cnf;
use rustsat::types::Lit;

use crate::abstraction::{Abstraction, CellId, Owner, SolidId};
use crate::ir::{Norm, Problem, RobotId};
use crate::tube::Tubes;

use super::convex::{Builder, Convex};
use super::{Anywhere, Encoder, End, Leaf, Link, connectivity, link_ends};

/// The most clauses that a whole instance may be expected to have: its file stays below what is read.
const LARGEST: u64 = 5_000_000;

/// What a literal of the Boolean part stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Meaning {
    /// A constraint of the convex part.
    Leaf(Leaf),
    /// The length, as an assumption: this position is the last one.
    Length(usize),
    /// The loop of a length goes back to this position.
    Loop {
        /// L.
        length: usize,
        /// k.
        start: usize,
    },
    /// The link is there at the step.
    Link(Link, usize),
    /// With the paper's encoding: the robot is in the cell.
    Cell {
        /// Who.
        robot: RobotId,
        /// Where: a cell of the partition of the robot's model.
        cell: CellId,
        /// When.
        step: usize,
    },
}

/// The number of a literal in files: variables count from 1, negated ones are negative.
pub fn number(lit: Lit) -> i32 {
    lit.to_ipasir()
}

/// An instance that would be too large to write down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge {
    /// About how many clauses it would have.
    pub clauses: u64,
}

/// The Boolean and the convex part of a range of lengths, with what ties them.
#[derive(Clone, Debug)]
pub struct Instance {
    /// The lengths, rising, with the literal to assume for each.
    pub lengths: Vec<(usize, Lit)>,
    /// The number of Boolean variables.
    pub variables: usize,
    /// The Boolean part.
    pub clauses: Cnf,
    /// The convex part.
    pub convex: Convex,
    /// What literals stand for, by rising variable; the others are parts of formulas.
    pub map: Vec<(Lit, Meaning)>,
}

impl Instance {
    /// The instance of all lengths in a range, both ends included.
    ///
    /// # Errors
    /// [`TooLarge`] when nobody could read it.
    pub fn new(
        problem: &Problem,
        tubes: &Tubes,
        abstraction: &Abstraction,
        (from, to): (usize, usize),
    ) -> Result<Instance, TooLarge> {
        let clauses = expected_clauses(problem, abstraction, (from, to));
        if clauses > LARGEST {
            return Err(TooLarge { clauses });
        }
        let mut encoder = Encoder::new(problem, abstraction, Box::new(Anywhere));
        encoder.eager = true;
        (from..=to).for_each(|length| encoder.extend(length));
        encoder.demand_all(to);
        encoder.exclude_two_lengths();
        let mut clauses = Cnf::new();
        // A plain list has no memory of its own that could run out before the process's.
        let written = encoder.write_clauses(&mut clauses);
        debug_assert!(written.is_ok());
        let map = encoder.meanings();
        let mut builder = Builder::new(problem, tubes, abstraction, to);
        for (lit, meaning) in &map {
            match meaning {
                Meaning::Leaf(leaf) => builder.add_leaf(*lit, leaf),
                Meaning::Loop { length, start } => builder.add_loop(*lit, *length, *start),
                Meaning::Link(link, step) => builder.add_link(*lit, *link, *step),
                Meaning::Length(_) | Meaning::Cell { .. } => {}
            }
        }
        let lengths = (from..=to).map(|length| (length, encoder.last(length))).collect();
        let variables = encoder.circuit.variables();
        Ok(Instance { lengths, variables, clauses, convex: builder.finish(), map })
    }

    /// The instance with its first length assumed: what a file about one length holds.
    pub fn assuming_first_length(mut self) -> Instance {
        if let Some(&(_, lit)) = self.lengths.first() {
            self.clauses.add_unit(lit);
        }
        self
    }
}

/// About how many clauses an instance has: a few for each direction along which something may be
/// clear of a solid at a step, and one for each loop and subformula.
fn expected_clauses(problem: &Problem, abstraction: &Abstraction, (from, to): (usize, usize)) -> u64 {
    let (robots, bases) = (problem.robots.len() as u64, problem.bases.len() as u64);
    let links = problem.connectivity.as_ref().map_or(0, |_| robots * (robots - 1) / 2 + robots * bases);
    let clear = |(_, solid): (SolidId, &crate::abstraction::Solid)| {
        let ways = match solid.owner {
            Owner::Blocker(id) if problem.blockers[id].kind.blocks_links() => robots + links,
            Owner::Blocker(_) | Owner::Region(_) => robots,
        };
        3 * ways * solid.faces.len() as u64
    };
    let cells = abstraction.partition.as_ref().map(|p| p.count() as u64);
    let step: u64 = match cells {
        // A cell has its facets, moves to and from it, and what is seen from it.
        Some(cells) => cells * (10 * robots + links),
        None => abstraction.solids.iter().map(clear).sum(),
    };
    let lost = problem.connectivity.as_ref().map_or(0, |asked| sets(robots, asked.redundancy.into()));
    let step = step.saturating_add(lost.saturating_mul(robots.pow(3)));
    let lengths = (from..=to).fold(0u64, |sum, length| sum.saturating_add(length as u64 + 1));
    let formulas = problem.formulas.nodes().len() as u64 + 1;
    (to as u64 + 1).saturating_mul(step).saturating_add(lengths.saturating_mul(formulas))
}

/// How many sets of so many members there are; 0 for none.
fn sets(members: u64, size: u64) -> u64 {
    (0..size).fold(u64::from(size > 0), |sets, i| sets.saturating_mul(members.saturating_sub(i)) / (i + 1))
}

impl Encoder<'_> {
    /// Makes every demand that a search could make, up to a length.
    fn demand_all(&mut self, length: usize) {
        for step in 0..=length {
            // Where there are cells, their relations keep moves and links clear.
            if self.cells.is_none() {
                self.abstraction.solids.ids().for_each(|solid| self.demand_clear(step, solid));
            }
            self.demand_all_apart(step);
            self.demand_all_ranges(step);
            if let Some(asked) = &self.problem.connectivity {
                let losses = connectivity::losses(asked, self.problem.robots.len());
                losses.for_each(|lost| self.demand_reach(step, &lost));
            }
        }
    }

    fn demand_clear(&mut self, step: usize, solid: SolidId) {
        // Cells that robots may move between, and cells that see each other, are clear of everything.
        if self.cells.is_some() {
            return;
        }
        let Owner::Blocker(blocker) = self.abstraction.solids[solid].owner else { return };
        for robot in self.problem.robots.ids() {
            let ends = vec![End::Robot(robot, step), End::Robot(robot, step + 1)];
            let bit = self.clear(solid, ends);
            self.circuit.require(bit);
        }
        if !self.problem.blockers[blocker].kind.blocks_links() || self.links.is_empty() {
            return;
        }
        let links: Vec<(Link, Lit)> = self.links[step].iter().collect();
        for (link, lit) in links {
            let bit = self.clear(solid, link_ends(link, step).to_vec());
            self.circuit.grow(lit, bit);
        }
    }

    /// Along the axes; a Euclidean range is a cone of the link's own.
    fn demand_all_ranges(&mut self, step: usize) {
        if self.abstraction.range.as_ref().is_some_and(|range| range.norm == Norm::Infinity) {
            let links: Vec<Link> = self.links[step].iter().map(|(link, _)| link).collect();
            for link in links {
                self.demand_range(link, step);
            }
        }
    }

    fn demand_all_apart(&mut self, step: usize) {
        if self.problem.separation.is_none() {
            return;
        }
        for first in self.problem.robots.ids() {
            for second in self.problem.robots.ids().filter(|other| *other > first) {
                let bit = self.faces(first, second, step);
                self.circuit.require(bit);
            }
        }
    }

    /// A plan has one last position.
    fn exclude_two_lengths(&mut self) {
        for (i, &a) in self.lasts.iter().enumerate() {
            for &b in &self.lasts[i + 1..] {
                self.circuit.clause(&[!a, !b]);
            }
        }
    }

    /// What the literals stand for, by rising variable.
    fn meanings(&self) -> Vec<(Lit, Meaning)> {
        let lasts = self.lasts.iter().enumerate().map(|(length, &lit)| (lit, Meaning::Length(length)));
        let mut map: Vec<(Lit, Meaning)> = lasts.collect();
        for (length, loops) in self.loops.iter().enumerate() {
            map.extend(loops.iter().enumerate().map(|(start, &lit)| (lit, Meaning::Loop { length, start })));
        }
        for (step, links) in self.links.iter().enumerate() {
            map.extend(links.iter().map(|(link, lit)| (lit, Meaning::Link(link, step))));
        }
        map.extend(
            self.cell_literals().map(|(lit, robot, cell, step)| (lit, Meaning::Cell { robot, cell, step })),
        );
        map.extend(self.circuit.leaves().map(|(lit, leaf)| (lit, Meaning::Leaf(leaf))));
        map.sort_by_key(|(lit, _)| *lit);
        map
    }
}
