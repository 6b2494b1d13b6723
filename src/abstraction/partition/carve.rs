//! Cutting a model's free space into cells, coarse where nothing is near.
//!
//! The planes of the blockers' facets go right through the room: a robot gets from cell to cell along
//! a straight line, and for that cells need the shape that such planes give them. Everything else is
//! cut into those cells only that it really meets: the copies of the regions that goals name, the
//! shadows that blockers throw from the bases, and the facets of blockers that have very many.

use super::{Cell, Fineness, Side, TooFine};
use crate::abstraction::{Abstraction, DirectionId, HalfSpace, Owner, SolidId, Stage};
use crate::entity::EntityId;
use crate::ir::{BaseId, ModelId, Problem, RegionId};

/// A blocker with more facets than this has the planes of its bounding box go through the room only.
const MOST_PLANES: usize = 8;

/// The knife for one model's free space.
pub(super) struct Knife<'a> {
    pub(super) problem: &'a Problem,
    pub(super) abstraction: &'a Abstraction,
    pub(super) model: ModelId,
    pub(super) fineness: Fineness,
    /// What is thinner does not count.
    pub(super) grain: f64,
    /// The most cells that there may be.
    pub(super) most: usize,
}

impl Knife<'_> {
    /// 𝒲 ⊖ Ω; `None` when the tube leaves nothing of it.
    pub(super) fn room(&self) -> Option<Cell> {
        let abstraction = self.abstraction;
        let far = |axis: usize, positive: bool| {
            let reach = abstraction.reaches[abstraction.directions.axis(axis, positive).index()];
            reach + abstraction.size
        };
        let lo: Vec<f64> = (0..abstraction.dimension).map(|axis| -far(axis, false)).collect();
        let hi: Vec<f64> = (0..abstraction.dimension).map(|axis| far(axis, true)).collect();
        let whole = Cell::from_box(&abstraction.directions, &lo, &hi);
        abstraction.workspace[self.model]
            .iter()
            .try_fold(whole, |rest, wall| rest.clip(&abstraction.directions, *wall))
    }

    /// The free cells.
    ///
    /// # Errors
    /// [`TooFine`] when there are too many.
    pub(super) fn carve(&self, regions: &[RegionId]) -> Result<Vec<Cell>, TooFine> {
        let mut cells: Vec<Cell> = self.room().into_iter().collect();
        let blockers = || self.blockers().flat_map(|b| self.abstraction.solids_of(Owner::Blocker(b)));
        for solid in blockers() {
            for plane in self.planes(solid) {
                cells = self.cut_all(cells, &[plane])?;
            }
        }
        for solid in blockers() {
            let inflated = self.inflated(solid);
            let mut free = Vec::new();
            for cell in cells {
                self.cut(cell, &inflated, &mut free);
            }
            cells = self.counted(free)?;
        }
        if self.fineness == Fineness::Fine {
            for solid in blockers() {
                cells = self.cut_corners(cells, solid)?;
            }
        }
        for &region in regions {
            for piece in self.abstraction.inside(self.model, region) {
                cells = self.cut_all(cells, &piece)?;
            }
            for solid in self.abstraction.solids_of(Owner::Region(region)) {
                cells = self.cut_all(cells, &self.inflated(solid))?;
            }
        }
        if self.problem.connectivity.is_some() {
            for base in self.problem.bases.ids() {
                for solid in blockers().filter(|s| self.abstraction.blocks_links(self.problem, *s)) {
                    cells = self.cut_all(cells, &self.shadow(base, solid))?;
                }
            }
        }
        Ok(cells)
    }

    /// Cuts the cells that touch a blocker along its oblique planes, so that robots can get, and see,
    /// round its corners.
    fn cut_corners(&self, cells: Vec<Cell>, solid: SolidId) -> Result<Vec<Cell>, TooFine> {
        let faces = self.abstraction.solids[solid].faces.iter();
        let oblique: Vec<HalfSpace> = faces
            .filter(|(stage, _)| *stage == Stage::Oblique)
            .map(|(_, direction)| self.beyond(solid, *direction))
            .collect();
        let mut around = self.inflated(solid);
        around.iter_mut().for_each(|h| h.offset += self.abstraction.gap);
        let (near, mut far): (Vec<Cell>, Vec<Cell>) =
            cells.into_iter().partition(|cell| self.common(cell, &around).is_some());
        let cut = |parts: Result<Vec<Cell>, TooFine>, plane| self.cut_all(parts?, &[plane]);
        far.extend(oblique.into_iter().fold(Ok(near), cut)?);
        self.counted(far)
    }

    fn blockers(&self) -> impl Iterator<Item = crate::ir::BlockerId> + use<> {
        self.problem.blockers.ids()
    }

    /// The directions in which a solid bounds positions: its own and the axes', which are those of a
    /// tube that is a box.
    fn directions(&self, solid: SolidId) -> Vec<DirectionId> {
        let mut directions = self.abstraction.facets_of(solid);
        for axis in self.axes() {
            if !directions.contains(&axis) {
                directions.push(axis);
            }
        }
        directions
    }

    fn axes(&self) -> Vec<DirectionId> {
        let both = |axis| [true, false].map(|positive| self.abstraction.directions.axis(axis, positive));
        (0..self.abstraction.dimension).flat_map(both).collect()
    }

    /// The planes of a blocker that go through the whole room.
    fn planes(&self, solid: SolidId) -> Vec<HalfSpace> {
        let facets = self.abstraction.facets_of(solid);
        let chosen = if facets.len() <= MOST_PLANES { facets } else { self.axes() };
        chosen.into_iter().map(|d| self.beyond(solid, d)).collect()
    }

    /// The positions that are not certainly below a solid along a direction.
    fn beyond(&self, solid: SolidId, direction: DirectionId) -> HalfSpace {
        let below = self.abstraction.below(self.model, solid, direction);
        HalfSpace { direction: self.abstraction.directions[direction].opposite, offset: -below.offset }
    }

    /// A solid ⊕ (−Ω) and the gap.
    fn inflated(&self, solid: SolidId) -> Vec<HalfSpace> {
        self.directions(solid).into_iter().map(|d| self.beyond(solid, d)).collect()
    }

    /// The positions from which a solid hides a base: along no direction are both clear of it.
    fn shadow(&self, base: BaseId, solid: SolidId) -> Vec<HalfSpace> {
        let mut directions = self.directions(solid);
        let faces = &self.abstraction.solids[solid].faces;
        directions.extend(faces.iter().filter(|(stage, _)| *stage == Stage::Tangents).map(|(_, d)| *d));
        let at = self.abstraction.base(base);
        directions
            .into_iter()
            .filter(|d| self.abstraction.point_below(at, solid, *d))
            .map(|d| self.beyond(solid, d))
            .collect()
    }

    /// Cuts every cell along the boundary of a convex set and keeps all parts.
    fn cut_all(&self, cells: Vec<Cell>, set: &[HalfSpace]) -> Result<Vec<Cell>, TooFine> {
        let mut parts = Vec::new();
        for cell in cells {
            let inside = self.cut(cell, set, &mut parts);
            parts.extend(inside);
        }
        self.counted(parts)
    }

    /// Cuts a cell along the boundary of a convex set, if the two overlap. The parts outside are
    /// pushed, the part inside is returned.
    fn cut(&self, cell: Cell, set: &[HalfSpace], outside: &mut Vec<Cell>) -> Option<Cell> {
        if self.common(&cell, set).is_none() {
            outside.push(cell);
            return None;
        }
        let mut rest = cell;
        for half_space in set {
            match rest.side(&self.abstraction.directions, *half_space, self.grain) {
                Side::Inside => {}
                Side::Outside => {
                    outside.push(rest);
                    return None;
                }
                Side::Cut(parts) => {
                    let (within, beyond) = *parts;
                    outside.push(beyond);
                    rest = within;
                }
            }
        }
        Some(rest)
    }

    /// What a cell and a convex set have in common.
    pub(super) fn common(&self, cell: &Cell, set: &[HalfSpace]) -> Option<Cell> {
        set.iter().try_fold(cell.clone(), |rest, half_space| {
            match rest.side(&self.abstraction.directions, *half_space, self.grain) {
                Side::Inside => Some(rest),
                Side::Outside => None,
                Side::Cut(parts) => Some(parts.0),
            }
        })
    }

    fn counted(&self, cells: Vec<Cell>) -> Result<Vec<Cell>, TooFine> {
        if cells.len() > self.most { Err(TooFine { most: self.most }) } else { Ok(cells) }
    }

    /// Whether a cell is certainly in a region, and whether it is certainly out of it.
    pub(super) fn label(&self, cell: &Cell, region: RegionId) -> (bool, bool) {
        let directions = &self.abstraction.directions;
        let within = |h: &HalfSpace| cell.reach(&directions[h.direction].vector) <= h.offset + self.grain;
        let inside = self.abstraction.inside(self.model, region).iter().any(|p| p.iter().all(within));
        let below = |solid: SolidId| {
            let mut ways = self.directions(solid).into_iter();
            ways.any(|d| within(&self.abstraction.below(self.model, solid, d)))
        };
        (inside, self.abstraction.solids_of(Owner::Region(region)).all(below))
    }
}
