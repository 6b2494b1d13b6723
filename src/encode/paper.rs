//! The paper's encoding of the workspace: every robot is in exactly one cell at every step.
//!
//! A cell implies its half-spaces, so that the convex part, its lemmas and justification carry on as
//! with half-spaces alone. Moves follow Adj_p, the closing step included; labels are those of cells;
//! links follow Adj_c. At step 0 a robot is at its start, which is a point.
//!
//! Each robot's 'in some cell' is a root of justification at every step, so all half-spaces of the
//! cells that a model chose are justified anyway. What follows from cells alone, moves and links,
//! therefore needs no gates of its own.

use rustsat::encodings::am1::{Bitwise, Encode};
use rustsat::types::Lit;

use super::Encoder;
use super::circuit::Bit;
use super::links::Link;
use crate::abstraction::{CellId, Partition, Place};
use crate::entity::EntityId;
use crate::ir::{ModelId, RegionId, RobotId};

/// The cell variables of the steps encoded so far.
#[derive(Debug)]
pub(super) struct CellVariables<'a> {
    partition: &'a Partition,
    /// By step from 1 on and robot: a cell's literal, or false where the robot can't be yet.
    steps: Vec<Vec<Vec<Bit>>>,
}

impl<'a> CellVariables<'a> {
    /// No variables yet.
    pub(super) fn new(partition: &'a Partition) -> CellVariables<'a> {
        CellVariables { partition, steps: Vec::new() }
    }

    /// The places of a robot at a step with their bits.
    fn places(&self, model: ModelId, robot: RobotId, step: usize) -> Vec<(Place, Bit)> {
        let Some(before) = step.checked_sub(1) else { return vec![(Place::Start(robot), Bit::True)] };
        let cells = self.partition.cells(model).ids();
        cells.map(|c| Place::Cell(model, c)).zip(self.steps[before][robot.index()].iter().copied()).collect()
    }
}

impl Encoder<'_> {
    /// Puts every robot into a cell at each step up to `step`, with the moves that lead there.
    pub(super) fn extend_cells(&mut self, step: usize) {
        while self.cells.as_ref().is_some_and(|cells| cells.steps.len() < step) {
            self.add_cells();
        }
    }

    fn add_cells(&mut self) {
        let Some(cells) = &self.cells else { return };
        let (partition, step) = (cells.partition, cells.steps.len() + 1);
        let mut all = Vec::new();
        for robot in self.problem.robots.ids() {
            let model = self.problem.robots[robot].model;
            let before = self.robot_places(robot, step - 1);
            let mut own = Vec::new();
            for cell in partition.cells(model).ids() {
                let here = Place::Cell(model, cell);
                let reached = before.iter().any(|(p, bit)| *bit != Bit::False && partition.moves(*p, here));
                own.push(if reached { Bit::Lit(self.cell(robot, step, cell)) } else { Bit::False });
            }
            self.exactly_one(&own);
            self.moves(partition, model, &before, &own);
            all.push(own);
        }
        if let Some(cells) = &mut self.cells {
            cells.steps.push(all);
        }
    }

    fn robot_places(&self, robot: RobotId, step: usize) -> Vec<(Place, Bit)> {
        let model = self.problem.robots[robot].model;
        self.cells.as_ref().map_or_else(Vec::new, |cells| cells.places(model, robot, step))
    }

    /// The variable of a robot's being in a cell.
    fn cell(&mut self, robot: RobotId, step: usize, cell: CellId) -> Lit {
        let model = self.problem.robots[robot].model;
        let partition = self.cells.as_ref().map(|c| c.partition);
        let facets = partition.map_or(&[][..], |p| &p.cells(model)[cell].facets[..]);
        let rows: Vec<Bit> = facets.iter().map(|f| self.half_space(robot, step, *f)).collect();
        let lit = self.circuit.growing_and();
        rows.into_iter().for_each(|row| self.circuit.grow(lit, row));
        lit
    }

    fn exactly_one(&mut self, cells: &[Bit]) {
        let some = self.circuit.or(cells.iter().copied());
        self.circuit.require(some);
        let mut others: Bitwise = literals(cells).collect();
        let encoded = self.circuit.encode_with(|clauses, variables| others.encode(clauses, variables));
        if encoded.is_err() {
            self.circuit.give_up();
        }
    }

    /// Who is in a cell goes on to a cell that Adj_p allows, and came from one.
    fn moves(&mut self, partition: &Partition, model: ModelId, before: &[(Place, Bit)], after: &[Bit]) {
        let after: Vec<(Place, Bit)> =
            partition.cells(model).ids().map(|c| Place::Cell(model, c)).zip(after.iter().copied()).collect();
        for (from, to) in [(before, &after[..]), (&after[..], before)] {
            for (here, bit) in from {
                let Bit::Lit(lit) = bit else { continue };
                let next = to.iter().filter(|(there, _)| partition.moves(*here, *there));
                let next: Vec<Bit> = next.map(|(_, bit)| *bit).collect();
                self.circuit.imply_some(&[*lit], &next);
            }
        }
    }

    /// The variables of robots' being in cells, with who, where and when.
    pub(super) fn cell_literals(&self) -> impl Iterator<Item = (Lit, RobotId, CellId, usize)> + '_ {
        let steps = self.cells.iter().flat_map(|cells| cells.steps.iter().enumerate());
        let robots = steps.flat_map(|(before, robots)| {
            self.problem.robots.ids().zip(robots).map(move |(robot, cells)| (robot, cells, before + 1))
        });
        robots.flat_map(|(robot, cells, step)| {
            let lit = move |(cell, bit): (usize, &Bit)| match bit {
                Bit::Lit(lit) => Some((*lit, robot, CellId::new(cell), step)),
                Bit::True | Bit::False => None,
            };
            cells.iter().enumerate().filter_map(lit)
        })
    }

    /// 'Certainly in' and 'certainly out', of the cells of a step after the first.
    pub(super) fn cell_labels(
        &mut self,
        robot: RobotId,
        region: RegionId,
        step: usize,
    ) -> Option<(Bit, Bit)> {
        let partition = self.cells.as_ref().filter(|_| step > 0)?.partition;
        let model = self.problem.robots[robot].model;
        let (mut inside, mut outside) = (Vec::new(), Vec::new());
        for (place, bit) in self.robot_places(robot, step) {
            let Place::Cell(_, cell) = place else { continue };
            let label = partition.label(model, cell, region);
            inside.extend(label.0.then_some(bit));
            outside.extend(label.1.then_some(bit));
        }
        Some((self.circuit.or(inside), self.circuit.or(outside)))
    }

    /// Lets the links of a step be used only between places that see each other.
    pub(super) fn extend_sight(&mut self, step: usize) {
        let Some(partition) = self.cells.as_ref().map(|c| c.partition) else { return };
        let links: Vec<(Link, Lit)> = self.links[step].iter().collect();
        for (link, lit) in links {
            let (from, to) = match link {
                Link::Robots(a, b) => (self.robot_places(a, step), self.robot_places(b, step)),
                Link::Base(robot, base) => {
                    (vec![(Place::Base(base), Bit::True)], self.robot_places(robot, step))
                }
            };
            for (here, bit) in from {
                let seen = to.iter().filter(|(there, _)| partition.sees(here, *there));
                // Robots that see the same cells share the variable 'in one of these cells'.
                let seen = self.circuit.or(seen.map(|(_, bit)| *bit));
                match bit {
                    Bit::False => {}
                    Bit::True => self.circuit.imply(&[lit], seen),
                    Bit::Lit(cell) => self.circuit.imply(&[lit, cell], seen),
                }
            }
        }
    }

    /// A loop goes back to the cell that it came from.
    pub(super) fn close_cells(&mut self, length: usize, loops: &[Lit]) {
        let Some(partition) = self.cells.as_ref().map(|c| c.partition) else { return };
        for robot in self.problem.robots.ids() {
            let last = self.robot_places(robot, length + 1);
            for (back, &lit) in loops.iter().enumerate() {
                let first = self.robot_places(robot, back);
                for (i, (place, bit)) in last.iter().enumerate() {
                    let Bit::Lit(cell) = bit else { continue };
                    let same = match first.get(i) {
                        Some((_, bit)) if back > 0 => *bit,
                        _ => Bit::from(self.starts_in(partition, robot, *place)),
                    };
                    self.circuit.imply(&[lit, *cell], same);
                }
            }
        }
    }

    /// Whether a robot's start lies in a cell.
    fn starts_in(&self, partition: &Partition, robot: RobotId, place: Place) -> bool {
        let Place::Cell(model, cell) = place else { return false };
        let entry = &self.problem.robots[robot];
        let position = &self.problem.models[model].position;
        let start: Vec<f64> = position.iter().map(|&s| entry.start[s].to_f64()).collect();
        let grain = 0.25 * self.abstraction.gap;
        partition.cells(model)[cell].holds(&self.abstraction.directions, &start, grain)
    }
}

fn literals(bits: &[Bit]) -> impl Iterator<Item = Lit> + '_ {
    bits.iter().filter_map(|bit| match bit {
        Bit::Lit(lit) => Some(*lit),
        _ => None,
    })
}
