//! Steps 1b and 1c: the tube taken off the workspace, and the half-spaces that the search works with.
//!
//! A *solid* is one convex piece of a blocker or of a region. Each solid has *directions*: unit
//! vectors d that point at it, so that a robot is certainly clear of the solid when its whole tube
//! lies below the solid along some d (theory.md §3). Direction and tube give a half-space for the
//! nominal position, `d · z ≤ offset`, moved by a small gap so that touching is harmless.
//!
//! Everything here is in doubles: a plan is proved elsewhere, so what matters is that the offsets
//! lie on the safe side by far more than rounding.

mod bounds;
mod clearance;
mod directions;
mod error_set;
mod narrow_region;
mod nearest;
mod oblique;
mod partition;
mod passage;
mod range;
mod separation;
mod solid;
mod start;
mod tangents;

pub use bounds::{Bounds, MixedRow};
pub use clearance::{Body, Plane};
pub use directions::{Direction, DirectionId, Directions};
pub use error_set::ErrorSet;
pub use partition::{Cell, CellId, Fineness, MOST_CELLS, Partition, Place, TooFine};
pub use passage::Passage;
pub use range::{Ends, LinkRange};
pub use solid::{Owner, Solid, SolidId};
pub use start::inspect;

use crate::entity::{EntityId, Table};
use crate::exact::Rational;
use crate::geometry::Polytope;
use crate::ir::{BaseId, ModelId, Piece, Problem, RegionId, Shape};
use crate::tube::Tubes;

use clearance::PositionTube;

/// The gap between an inflated set and the strict inequality of the exact check, as a share of the
/// workspace's size: far above rounding, far below anything that a mission means.
const GAP: f64 = 1e-6;

/// When a direction may be used: the search opens one stage after the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// Normals of the solid's own facets.
    Facets,
    /// Tangents from the bases, which repair links to them.
    Tangents,
    /// Oblique directions, which repair links between robots.
    Oblique,
}

impl Stage {
    /// All stages, in the order in which they are opened.
    pub const ALL: [Stage; 3] = [Stage::Facets, Stage::Tangents, Stage::Oblique];

    /// The name under which a report lists the stage.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Facets => "facets",
            Stage::Tangents => "tangents",
            Stage::Oblique => "oblique",
        }
    }
}

/// The half-space {z : d · z ≤ offset} of nominal positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// d, of unit length.
    pub direction: DirectionId,
    /// The offset, in metres.
    pub offset: f64,
}

/// The half-spaces of a problem.
#[derive(Clone, Debug)]
pub struct Abstraction {
    /// 2 or 3.
    pub dimension: usize,
    /// The largest extent of the workspace.
    pub size: f64,
    /// The gap, in metres.
    pub gap: f64,
    /// All directions in use.
    pub directions: Directions,
    /// Every convex piece of every blocker, then of every region.
    pub solids: Table<SolidId, Solid>,
    /// The facets of 𝒲 as half-spaces for each model's nominal position.
    pub workspace: Table<ModelId, Vec<HalfSpace>>,
    /// The partition into cells; `None` unless [asked for](Abstraction::with_cells).
    pub partition: Option<Partition>,
    /// The longest link; `None` when links may be of any length.
    pub range: Option<LinkRange>,
    tubes: Table<ModelId, PositionTube>,
    supports: Table<ModelId, Vec<f64>>,
    ceilings: Table<ModelId, Vec<f64>>,
    /// max d · p over the workspace, by direction.
    reaches: Vec<f64>,
    inside: Table<RegionId, Vec<Vec<HalfSpace>>>,
    bases: Table<BaseId, Vec<f64>>,
}

impl Abstraction {
    /// The half-spaces of a problem whose models have these tubes; `backoff` ≥ 1 widens the gap.
    pub fn new(problem: &Problem, tubes: &Tubes, backoff: f64) -> Abstraction {
        let corners = floats(&problem.workspace);
        let size = extent(&corners, problem.dimension);
        let gap = size * GAP * backoff;
        let mut directions = Directions::new(problem.dimension);
        let solids = solid::of_problem(problem, &mut directions, gap);
        let inside = problem.regions.values().map(|r| inside(r.sure(), &mut directions)).collect();
        let base = |b: &crate::ir::Base| b.position.iter().map(Rational::to_f64).collect();
        let walls = problem.workspace.facets.iter().map(|f| facet(f, &mut directions)).collect();
        let mut abstraction = Abstraction {
            dimension: problem.dimension,
            size,
            gap,
            directions,
            solids,
            workspace: Table::new(),
            partition: None,
            range: None,
            tubes: Table::new(),
            supports: Table::new(),
            ceilings: Table::new(),
            reaches: Vec::new(),
            inside,
            bases: problem.bases.values().map(base).collect(),
        };
        abstraction.add_models(problem, tubes, &corners, walls);
        abstraction.range = LinkRange::new(problem, &abstraction);
        abstraction
    }

    /// With the partition that the paper's encoding works on.
    ///
    /// # Errors
    /// [`TooFine`] when there would be too many cells.
    pub fn with_cells(mut self, problem: &Problem, fineness: Fineness) -> Result<Abstraction, TooFine> {
        self.partition = Some(Partition::new(problem, &self, fineness)?);
        Ok(self)
    }

    fn add_models(&mut self, problem: &Problem, tubes: &Tubes, corners: &[Vec<f64>], walls: Vec<HalfSpace>) {
        let most = |d: &Direction| corners.iter().map(|p| dot(&d.vector, p)).fold(f64::MIN, f64::max);
        self.reaches = self.directions.iter().map(most).collect();
        for (id, model) in problem.models.iter() {
            let mut supports = Vec::new();
            let mut ceilings = Vec::new();
            let tube = PositionTube::new(&tubes[id], &model.position);
            for (direction, reach) in self.directions.iter().zip(&self.reaches) {
                let support = tube.support(&direction.vector);
                supports.push(support);
                ceilings.push(reach - support);
            }
            self.tubes.push(tube);
            self.supports.push(supports);
            self.ceilings.push(ceilings);
            let rows = walls.iter().map(|f| self.shrunk(id, *f)).collect();
            self.workspace.push(rows);
        }
    }

    /// h_Ω(d) of a model, in metres.
    pub fn support(&self, model: ModelId, direction: DirectionId) -> f64 {
        self.supports[model][direction.index()]
    }

    /// An upper bound on d · z over the nominal positions that 𝒲 ⊖ Ω allows.
    pub fn ceiling(&self, model: ModelId, direction: DirectionId) -> f64 {
        self.ceilings[model][direction.index()]
    }

    /// The half-space that keeps a robot's whole tube below a solid along a direction.
    pub fn below(&self, model: ModelId, solid: SolidId, direction: DirectionId) -> HalfSpace {
        let level = self.solids[solid].level(&self.directions[direction].vector);
        HalfSpace { direction, offset: level - self.support(model, direction) - self.gap }
    }

    /// Whether a point without a tube lies below a solid along a direction, by part of the gap.
    pub fn point_below(&self, point: &[f64], solid: SolidId, direction: DirectionId) -> bool {
        let d = &self.directions[direction].vector;
        dot(d, point) <= self.solids[solid].level(d) - 0.25 * self.gap
    }

    /// For each piece of a region, the half-spaces that keep a robot's whole tube inside.
    pub fn inside(&self, model: ModelId, region: RegionId) -> Vec<Vec<HalfSpace>> {
        let shrink = |facets: &Vec<HalfSpace>| facets.iter().map(|f| self.shrunk(model, *f)).collect();
        self.inside[region].iter().map(shrink).collect()
    }

    /// A set's own half-space moved inwards by a model's tube and the gap.
    fn shrunk(&self, model: ModelId, facet: HalfSpace) -> HalfSpace {
        let inset = self.support(model, facet.direction) + self.gap;
        HalfSpace { offset: facet.offset - inset, ..facet }
    }

    /// A base's coordinates.
    pub fn base(&self, id: BaseId) -> &[f64] {
        &self.bases[id]
    }

    /// The workspace's bounding box as a polygon, counter-clockwise.
    fn outer_box(&self) -> Vec<[f64; 2]> {
        let axis = |axis: usize, positive: bool| {
            let direction = self.directions.axis(axis, positive);
            let reach = self.reaches[direction.index()];
            if positive { reach } else { -reach }
        };
        let (a, b, c, d) = (axis(0, false), axis(1, false), axis(0, true), axis(1, true));
        vec![[a, b], [c, b], [c, d], [a, d]]
    }

    /// A polygon's Minkowski sum with a model's tube (which is symmetric), counter-clockwise.
    fn inflated(&self, model: ModelId, vertices: &[Vec<f64>]) -> Vec<[f64; 2]> {
        let outline = self.tubes[model].outline();
        let sums = vertices.iter().flat_map(|v| outline.iter().map(|c| [v[0] + c[0], v[1] + c[1]]));
        clearance::convex_hull(sums.collect())
    }

    /// The directions of a solid's own facets.
    fn facets_of(&self, solid: SolidId) -> Vec<DirectionId> {
        let faces = self.solids[solid].faces.iter();
        faces.filter(|(stage, _)| *stage == Stage::Facets).map(|(_, direction)| *direction).collect()
    }

    /// Whether no link may cross a solid.
    fn blocks_links(&self, problem: &Problem, solid: SolidId) -> bool {
        match self.solids[solid].owner {
            Owner::Blocker(id) => problem.blockers[id].kind.blocks_links(),
            Owner::Region(_) => false,
        }
    }

    /// The solids of one owner, piece by piece.
    pub fn solids_of(&self, owner: Owner) -> impl Iterator<Item = SolidId> {
        self.solids.iter().filter(move |(_, s)| s.owner == owner).map(|(id, _)| id)
    }
}

/// The scalar product in doubles.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn floats(polytope: &Polytope) -> Vec<Vec<f64>> {
    polytope.vertices.iter().map(|v| v.iter().map(Rational::to_f64).collect()).collect()
}

fn extent(corners: &[Vec<f64>], dimension: usize) -> f64 {
    let width = |axis: usize| {
        let values = corners.iter().map(|p| p[axis]);
        values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min)
    };
    (0..dimension).map(width).fold(0.0, f64::max)
}

/// A facet as a unit direction and its offset, both rounded to nearest.
fn facet(half_space: &crate::geometry::HalfSpace, directions: &mut Directions) -> HalfSpace {
    let normal: Vec<f64> = half_space.normal.iter().map(Rational::to_f64).collect();
    let length = dot(&normal, &normal).sqrt();
    HalfSpace { direction: directions.intern(&normal), offset: half_space.offset.to_f64() / length }
}

fn inside(shape: &Shape, directions: &mut Directions) -> Vec<Vec<HalfSpace>> {
    let piece = |piece: &Piece| match piece {
        Piece::Polytope(p) => p.facets.iter().map(|f| facet(f, directions)).collect(),
        Piece::Ball { center, spread, radius } => {
            let floats = |v: &[Rational]| -> Vec<f64> { v.iter().map(Rational::to_f64).collect() };
            solid::inscribed(&floats(center), &floats(spread), radius.to_f64(), directions)
        }
    };
    shape.pieces.iter().map(piece).collect()
}
