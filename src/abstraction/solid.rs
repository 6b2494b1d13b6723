//! Solids: convex pieces to keep clear of, each with the directions that do it.

use super::nearest::{Vector, vector};
use super::oblique::Edge;
use super::{DirectionId, Directions, HalfSpace, Stage, dot, oblique, tangents};
use crate::entity::Table;
use crate::entity_id;
use crate::exact::Rational;
use crate::ir::{BlockerId, Piece, Problem, RegionId};

entity_id!(
    /// One convex piece of a blocker or of a region.
    SolidId, "solid"
);

/// Whose piece a solid is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Owner {
    /// An obstacle's or a jammer's.
    Blocker(BlockerId),
    /// A region's, as something to be out of.
    Region(RegionId),
}

/// The Euclidean balls of one radius whose centres fill a box.
#[derive(Clone, Debug)]
pub struct Ball {
    /// The middle of the box of centres.
    pub center: Vec<f64>,
    /// The half-widths of the box of centres.
    pub spread: Vec<f64>,
    /// The radius.
    pub radius: f64,
}

/// A convex piece in doubles, with the directions in which it can be kept clear of.
#[derive(Clone, Debug)]
pub struct Solid {
    /// Whose piece it is.
    pub owner: Owner,
    /// The piece's index among the operands of `or`.
    pub piece: usize,
    /// Its vertices (none for a Euclidean ball), in the plane counter-clockwise.
    pub vertices: Vec<Vec<f64>>,
    /// The ball, if it is one.
    pub ball: Option<Ball>,
    /// The directions that keep clear of it, by stage.
    pub faces: Vec<(Stage, DirectionId)>,
    /// In space, its edges and the outward normals of its facets (none for a Euclidean ball).
    pub(super) edges: Vec<Edge>,
    pub(super) normals: Vec<Vector>,
}

impl Solid {
    /// min d · q over the solid, for a direction of unit length.
    pub fn level(&self, d: &[f64]) -> f64 {
        match &self.ball {
            Some(ball) => {
                let reach: f64 = d.iter().zip(&ball.spread).map(|(a, s)| a.abs() * s).sum();
                dot(d, &ball.center) - reach - ball.radius * dot(d, d).sqrt()
            }
            None => self.vertices.iter().map(|q| dot(d, q)).fold(f64::INFINITY, f64::min),
        }
    }

    /// The lowest point of the solid along a direction; of a Euclidean ball's centres.
    pub(super) fn lowest(&self, d: &Vector) -> Vector {
        match &self.ball {
            Some(ball) => {
                let mut point = vector(&ball.center);
                for ((x, s), a) in point.iter_mut().zip(&ball.spread).zip(d) {
                    *x -= if *a < 0.0 { -s } else { *s };
                }
                point
            }
            None => {
                let heights = self.vertices.iter().map(|q| (dot(&d[..q.len()], q), q));
                let lowest = heights.min_by(|a, b| a.0.total_cmp(&b.0));
                lowest.map_or([0.0; 3], |(_, q)| vector(q))
            }
        }
    }

    /// A point inside.
    pub(super) fn middle(&self) -> Vector {
        match &self.ball {
            Some(ball) => vector(&ball.center),
            None => {
                let count = self.vertices.len().max(1) as f64;
                let sum = |axis: usize| self.vertices.iter().filter_map(|q| q.get(axis)).sum::<f64>();
                [0, 1, 2].map(|axis| sum(axis) / count)
            }
        }
    }

    pub(super) fn add_face(&mut self, stage: Stage, direction: DirectionId) {
        if self.faces.iter().all(|(_, d)| *d != direction) {
            self.faces.push((stage, direction));
        }
    }
}

/// The solids of all blockers, then of all regions.
pub(super) fn of_problem(problem: &Problem, directions: &mut Directions, gap: f64) -> Table<SolidId, Solid> {
    let point = |p: &Vec<Rational>| -> Vec<f64> { p.iter().map(Rational::to_f64).collect() };
    let bases: Vec<Vec<f64>> = problem.bases.values().map(|b| point(&b.position)).collect();
    let mut solids = Table::new();
    for (id, blocker) in problem.blockers.iter() {
        for (piece, shape) in blocker.shape.pieces.iter().enumerate() {
            let mut solid = solid(Owner::Blocker(id), piece, shape, directions);
            if blocker.kind.blocks_links() {
                bases.iter().for_each(|base| tangents::add(&mut solid, base, directions, gap));
            }
            oblique::add(&mut solid, problem.dimension, directions);
            solids.push(solid);
        }
    }
    for (id, region) in problem.regions.iter() {
        for (piece, shape) in region.shape.pieces.iter().enumerate() {
            solids.push(solid(Owner::Region(id), piece, shape, directions));
        }
    }
    solids
}

pub(super) fn solid(owner: Owner, piece: usize, shape: &Piece, directions: &mut Directions) -> Solid {
    let floats = |v: &[Rational]| -> Vec<f64> { v.iter().map(Rational::to_f64).collect() };
    let mut solid = Solid {
        owner,
        piece,
        vertices: Vec::new(),
        ball: None,
        faces: Vec::new(),
        edges: oblique::edges(shape),
        normals: Vec::new(),
    };
    let normals: Vec<Vec<f64>> = match shape {
        Piece::Polytope(p) => {
            solid.vertices = p.vertices.iter().map(|v| floats(v)).collect();
            solid.normals = p.facets.iter().map(|f| vector(&floats(&f.normal))).collect();
            p.facets.iter().map(|f| f.normal.iter().map(|x| -x.to_f64()).collect()).collect()
        }
        Piece::Ball { center, spread, radius } => {
            let ball = Ball { center: floats(center), spread: floats(spread), radius: radius.to_f64() };
            solid.ball = Some(ball);
            sphere(center.len()).0
        }
    };
    for normal in normals {
        solid.add_face(Stage::Facets, directions.intern(&normal));
    }
    solid
}

/// Facets of a polytope inside a Euclidean ball, which is the safe side for 'in'.
pub(super) fn inscribed(
    center: &[f64],
    spread: &[f64],
    radius: f64,
    directions: &mut Directions,
) -> Vec<HalfSpace> {
    let (normals, inradius) = sphere(center.len());
    let facet = |normal: &Vec<f64>| {
        let lost: f64 = normal.iter().zip(spread).map(|(a, s)| a.abs() * s).sum();
        let offset = dot(normal, center) + inradius * radius - lost;
        HalfSpace { direction: directions.intern(normal), offset }
    };
    normals.iter().map(facet).collect()
}

/// Unit normals around a sphere, and the inradius of the polytope with these facets whose vertices
/// lie inside the unit sphere.
fn sphere(dimension: usize) -> (Vec<Vec<f64>>, f64) {
    if dimension == 2 {
        const SIDES: u32 = 16;
        let angle = std::f64::consts::TAU / f64::from(SIDES);
        let normal = |i: u32| vec![(f64::from(i) * angle).cos(), (f64::from(i) * angle).sin()];
        return ((0..SIDES).map(normal).collect(), (0.5 * angle).cos());
    }
    let mut normals = Vec::new();
    let steps = [-1.0, 0.0, 1.0];
    for v in steps.iter().flat_map(|x| steps.iter().flat_map(move |y| steps.map(|z| [*x, *y, z]))) {
        let length = dot(&v, &v).sqrt();
        if length > 0.0 {
            normals.push(v.iter().map(|a| a / length).collect());
        }
    }
    // {x : n · x ≤ 1 for these 26 normals} has its farthest vertices at (1, √2 − 1, √3 − √2) and its
    // mirror images, 1.1280… away from the middle.
    (normals, 0.886)
}
