//! The pieces' side of the geometric claims.

use super::resolve::Plane;
use super::zonotope::Zonotope;
use crate::exact::{Rational, dot};
use crate::ir::Piece;

/// Whether a·q ≥ b for every point q of the piece.
///
/// For a ball no root is taken: (a·c − b)² ≥ r² a·a on the right side of the plane.
pub(super) fn beyond(plane: &Plane, piece: &Piece) -> bool {
    match piece {
        Piece::Polytope(polytope) => polytope.vertices.iter().all(|q| dot(&plane.normal, q) >= plane.offset),
        Piece::Ball { center, spread, radius } => {
            let depth = dot(&plane.normal, center) - box_reach(&plane.normal, spread) - &plane.offset;
            let square = dot(&plane.normal, &plane.normal);
            !depth.is_negative() && &depth * &depth >= radius * radius * square
        }
    }
}

/// How deep point ⊕ tube lies in the piece: at least 0 when it lies in it. In metres for polytopes
/// with unit normals, in square metres for balls.
///
/// The supports of the tube along a polytope's facets are given, in their order. Of a ball with an
/// uncertain centre it must lie in every one.
pub(super) fn depth(point: &[Rational], tube: &Zonotope, supports: &[Rational], piece: &Piece) -> Rational {
    match piece {
        Piece::Polytope(polytope) => {
            let slacks =
                polytope.facets.iter().zip(supports).map(|(f, h)| &f.offset - dot(&f.normal, point) - h);
            slacks.min().unwrap_or(Rational::from(-1))
        }
        Piece::Ball { center, spread, radius } => {
            let farthest = tube.corners().iter().map(|e| farthest_square(point, e, center, spread)).max();
            radius * radius - farthest.unwrap_or_default()
        }
    }
}

/// The square of the greatest distance from point + e to a point of box(center ± spread).
fn farthest_square(point: &[Rational], e: &[Rational], center: &[Rational], spread: &[Rational]) -> Rational {
    (0..point.len())
        .map(|axis| {
            let distance = (&point[axis] + &e[axis] - &center[axis]).abs() + &spread[axis];
            &distance * &distance
        })
        .sum()
}

fn box_reach(normal: &[Rational], spread: &[Rational]) -> Rational {
    normal.iter().zip(spread).filter(|(_, s)| !s.is_zero()).map(|(a, s)| a.abs() * s).sum()
}

/// The Euclidean length of a vector, rounded; 1 for the zero vector.
pub(super) fn rounded_norm(vector: &[Rational]) -> f64 {
    let norm = vector.iter().map(|x| x.to_f64()).map(|x| x * x).sum::<f64>().sqrt();
    if norm > 0.0 { norm } else { 1.0 }
}
