//! Solids: convex pieces to keep clear of, each with the directions that do it.

use super::{DirectionId, Directions, HalfSpace, Stage, dot};
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

    fn add_face(&mut self, stage: Stage, direction: DirectionId) {
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
                add_tangents(&mut solid, &bases, directions, gap);
                add_ball_tangents(&mut solid, &bases, directions, gap);
            }
            add_oblique(&mut solid, problem.dimension, directions);
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

fn solid(owner: Owner, piece: usize, shape: &Piece, directions: &mut Directions) -> Solid {
    let floats = |v: &[Rational]| -> Vec<f64> { v.iter().map(Rational::to_f64).collect() };
    let mut solid = Solid { owner, piece, vertices: Vec::new(), ball: None, faces: Vec::new() };
    let normals: Vec<Vec<f64>> = match shape {
        Piece::Polytope(p) => {
            solid.vertices = p.vertices.iter().map(|v| floats(v)).collect();
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

/// Adds the tangents from each base to a solid in the plane, turned by a hair so that the base
/// itself lies clear of the solid.
fn add_tangents(solid: &mut Solid, bases: &[Vec<f64>], directions: &mut Directions, gap: f64) {
    for base in bases.iter().filter(|b| b.len() == 2) {
        for vertex in solid.vertices.clone() {
            let along = [vertex[0] - base[0], vertex[1] - base[1]];
            let distance = dot(&along, &along).sqrt();
            if distance <= 4.0 * gap {
                continue;
            }
            // The normal of the line from base to vertex, in both senses, turned so that the base
            // lies a gap below the line through the vertex.
            let turn = gap / distance;
            for sense in [1.0, -1.0] {
                let normal = [turn * along[0] - sense * along[1], turn * along[1] + sense * along[0]];
                let direction = normal.map(|x| x / distance);
                if solid.level(&direction) >= dot(&direction, &vertex) - 1e-3 * gap {
                    solid.add_face(Stage::Tangents, directions.intern_near(&direction));
                }
            }
        }
    }
}

/// Adds the two tangents from each base to a Euclidean ball in the plane.
///
/// The directions that have the base below the ball by a gap are those within some angle of the
/// way to its centre; both ends of that range are found by bisection.
fn add_ball_tangents(solid: &mut Solid, bases: &[Vec<f64>], directions: &mut Directions, gap: f64) {
    let Some(ball) = solid.ball.clone() else { return };
    for base in bases.iter().filter(|b| b.len() == 2) {
        let middle = (ball.center[1] - base[1]).atan2(ball.center[0] - base[0]);
        let direction = |turn: f64| [(middle + turn).cos(), (middle + turn).sin()];
        let clear = |turn: f64| solid.level(&direction(turn)) - dot(&direction(turn), base) >= gap;
        if !clear(0.0) {
            continue;
        }
        let tangents = [1.0, -1.0].map(|sense| {
            let (mut inside, mut outside) = (0.0, sense * std::f64::consts::FRAC_PI_2);
            for _ in 0..60 {
                let turn = 0.5 * (inside + outside);
                if clear(turn) { inside = turn } else { outside = turn }
            }
            direction(inside)
        });
        for tangent in tangents {
            solid.add_face(Stage::Tangents, directions.intern_near(&tangent));
        }
    }
}

/// Adds the diagonals of each pair of axes.
fn add_oblique(solid: &mut Solid, dimension: usize, directions: &mut Directions) {
    for i in 0..dimension {
        for j in i + 1..dimension {
            for (a, b) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                let mut vector = vec![0.0; dimension];
                vector[i] = a;
                vector[j] = b;
                solid.add_face(Stage::Oblique, directions.intern_near(&vector));
            }
        }
    }
}
