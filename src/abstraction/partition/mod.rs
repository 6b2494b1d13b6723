//! The paper's PARTITION with its relations Adj_p and Adj_c, corrected (theory.md §1 and §3).
//!
//! For each model the free space is cut into convex cells, each wholly in, wholly out, or neither,
//! for every region that a goal names. Which cells a robot may move between and which ones see each
//! other is said of the hull of both cells with their tubes: a move or a link that the relations allow
//! is safe for whatever positions in these cells. A robot's start is a place of its own, a point.
//!
//! 'Misses' is exact up to the gap, but for Euclidean balls in the plane: they count as polygons
//! around them.

mod carve;
mod cell;
mod merge;
mod relation;
mod sight;

#[cfg(test)]
mod tests;

pub use cell::{Cell, Side};

use crate::entity::{EntityId, Table};
use crate::entity_id;
use crate::ir::{BaseId, Formula, ModelId, Problem, RegionId, RobotId};

use super::Abstraction;
use carve::Knife;
use merge::{Draft, Merging};
use relation::Relation;
use sight::{Place as SightPlace, Sight};

entity_id!(
    /// A cell of a model's partition.
    CellId, "cell"
);

/// The most cells of one model before merging: their relations grow with the square.
pub const MOST_CELLS: usize = 2000;

/// Cells thinner than this share of the gap do not count.
const GRAIN: f64 = 0.05;

/// How small the cells are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fineness {
    /// As the facets of blockers, regions and shadows cut them.
    Coarse,
    /// Cut round the corners of blockers, too: plans get shorter, and searches several times longer.
    Fine,
}

/// Why there is no partition.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the paper's partition has more than {most} cells here; the default encoding, half-spaces, has none")]
pub struct TooFine {
    /// The most cells that there may be.
    pub most: usize,
}

/// Where a robot or a base may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// A robot of a model in a cell.
    Cell(ModelId, CellId),
    /// A robot at its start.
    Start(RobotId),
    /// A base.
    Base(BaseId),
}

/// The cells of one model.
#[derive(Clone, Debug)]
struct Cells {
    cells: Table<CellId, Cell>,
    regions: Vec<RegionId>,
    /// By cell and region: certainly in, certainly out.
    labels: Vec<Vec<(bool, bool)>>,
    /// The number of the first cell among all places.
    first: usize,
}

/// The cells of all models with their relations.
#[derive(Clone, Debug)]
pub struct Partition {
    models: Table<ModelId, Cells>,
    /// The numbers of the first start and of the first base among all places.
    starts: usize,
    bases: usize,
    moves: Relation,
    sees: Relation,
}

impl Partition {
    /// The partition of a problem's free space, as coarse as it may be.
    ///
    /// # Errors
    /// [`TooFine`] when a model has more than [`MOST_CELLS`] cells.
    pub fn new(
        problem: &Problem,
        abstraction: &Abstraction,
        fineness: Fineness,
    ) -> Result<Partition, TooFine> {
        let mut merging = drafts(problem, abstraction, fineness)?;
        merging.relate();
        merging.run();
        Ok(collect(problem, merging))
    }

    /// The number of cells of all models.
    pub fn count(&self) -> usize {
        self.models.values().map(|m| m.cells.len()).sum()
    }

    /// The cells of a model.
    pub fn cells(&self, model: ModelId) -> &Table<CellId, Cell> {
        &self.models[model].cells
    }

    /// The outlines of a model's cells in the plane, counter-clockwise; none in space.
    pub fn outlines(&self, model: ModelId) -> Vec<Vec<[f64; 2]>> {
        let outline = |cell: &Cell| {
            let corners: Option<Vec<[f64; 2]>> = cell.corners().map(|p| p.try_into().ok()).collect();
            corners.map(super::clearance::convex_hull)
        };
        self.models[model].cells.values().filter_map(outline).collect()
    }

    /// Whether a cell is certainly in a region, and whether it is certainly out of it; neither for a
    /// region that no goal asks of the model.
    pub fn label(&self, model: ModelId, cell: CellId, region: RegionId) -> (bool, bool) {
        let cells = &self.models[model];
        let at = cells.regions.iter().position(|r| *r == region);
        at.map_or((false, false), |at| cells.labels[cell.index()][at])
    }

    /// Adj_p: whether a robot may move straight from one place to the other.
    pub fn moves(&self, a: Place, b: Place) -> bool {
        self.moves.holds(self.number(a), self.number(b))
    }

    /// Adj_c: whether whoever is at these places has a link.
    pub fn sees(&self, a: Place, b: Place) -> bool {
        self.sees.holds(self.number(a), self.number(b))
    }

    fn number(&self, place: Place) -> usize {
        match place {
            Place::Cell(model, cell) => self.models[model].first + cell.index(),
            Place::Start(robot) => self.starts + robot.index(),
            Place::Base(base) => self.bases + base.index(),
        }
    }
}

/// The unmerged cells, with all places.
fn drafts<'a>(
    problem: &Problem,
    abstraction: &'a Abstraction,
    fineness: Fineness,
) -> Result<Merging<'a>, TooFine> {
    let grain = GRAIN * abstraction.gap;
    let sight = Sight::new(problem, abstraction);
    let (mut drafts, mut rooms) = (Vec::new(), Vec::new());
    for model in problem.models.ids() {
        let knife = Knife { problem, abstraction, model, fineness, grain, most: MOST_CELLS };
        let regions = asked(problem, model);
        for cell in knife.carve(&regions)? {
            let labels = regions.iter().map(|r| knife.label(&cell, *r)).collect();
            drafts.push(Some(Draft { model, cell, labels }));
        }
        rooms.push(knife.room());
    }
    let mut models: Vec<Option<ModelId>> = drafts.iter().flatten().map(|d| Some(d.model)).collect();
    let mut places: Vec<SightPlace> =
        drafts.iter().flatten().map(|d| sight.of_cell(d.model, &d.cell)).collect();
    for robot in problem.robots.values() {
        let position = &problem.models[robot.model].position;
        let start: Vec<f64> = position.iter().map(|&s| robot.start[s].to_f64()).collect();
        models.push(Some(robot.model));
        places.push(sight.of_point(Some(robot.model), &start));
    }
    for base in problem.bases.ids() {
        models.push(None);
        places.push(sight.of_point(None, abstraction.base(base)));
    }
    let (moves, sees) = (Relation::new(places.len()), Relation::new(places.len()));
    Ok(Merging { abstraction, sight, grain, rooms, drafts, places, models, moves, sees })
}

/// The regions that goals ask of a model's robots.
fn asked(problem: &Problem, model: ModelId) -> Vec<RegionId> {
    let mut regions = Vec::new();
    for node in problem.formulas.nodes().values() {
        let atoms = match node {
            Formula::In(atom) | Formula::Out(atom) => vec![*atom],
            Formula::Compare(comparison) => comparison.terms.iter().map(|(atom, _)| *atom).collect(),
            _ => Vec::new(),
        };
        let own = atoms.into_iter().filter(|atom| problem.robots[atom.robot].model == model);
        regions.extend(own.map(|atom| atom.region));
    }
    regions.sort_unstable();
    regions.dedup();
    regions
}

/// What is left after merging, numbered anew.
fn collect(problem: &Problem, merging: Merging<'_>) -> Partition {
    let points = merging.drafts.len()..merging.places.len();
    let alive = merging.drafts.iter().enumerate().filter(|(_, d)| d.is_some()).map(|(i, _)| i);
    let members: Vec<usize> = alive.chain(points).collect();
    let (moves, sees) = (merging.moves.restricted(&members), merging.sees.restricted(&members));
    let mut models: Table<ModelId, Cells> = Table::new();
    let mut first = 0;
    for model in problem.models.ids() {
        let own: Vec<Draft> = merging.drafts.iter().flatten().filter(|d| d.model == model).cloned().collect();
        let regions = asked(problem, model);
        let labels = own.iter().map(|d| d.labels.clone()).collect();
        let cells: Table<CellId, Cell> = own.into_iter().map(|d| d.cell).collect();
        let count = cells.len();
        models.push(Cells { cells, regions, labels, first });
        first += count;
    }
    Partition { models, starts: first, bases: first + problem.robots.len(), moves, sees }
}
