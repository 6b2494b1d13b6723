//! Tangents from bases: directions that just have a base below a solid.
//!
//! In the plane these are the two lines through the base that touch the solid. In space there is a
//! whole cone of planes: those through the edges of a polytope that the base sees against the
//! background, and several around a ball.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::nearest::{self, Vector, cross, minus, vector};
use super::solid::{Ball, Solid};
use super::{Directions, Stage, dot};

/// The tangent planes of a ball in space, evenly around the cone.
const AROUND: u32 = 8;

/// Adds the tangents from a base to a solid, turned by a hair so that the base itself lies clear of
/// the solid.
pub(super) fn add(solid: &mut Solid, base: &[f64], directions: &mut Directions, gap: f64) {
    let found = match (&solid.ball, base.len()) {
        (Some(ball), _) => to_ball(solid, ball, base, gap),
        (None, 2) => to_polygon(solid, base, gap),
        (None, _) => to_polytope(solid, base, gap),
    };
    for tangent in found {
        solid.add_face(Stage::Tangents, directions.intern_near(&tangent));
    }
}

fn to_polygon(solid: &Solid, base: &[f64], gap: f64) -> Vec<Vec<f64>> {
    let mut found = Vec::new();
    for vertex in &solid.vertices {
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
            if solid.level(&direction) >= dot(&direction, vertex) - 1e-3 * gap {
                found.push(direction.to_vec());
            }
        }
    }
    found
}

/// The planes through the base and an edge that have the whole polytope on one side.
fn to_polytope(solid: &Solid, base: &[f64], gap: f64) -> Vec<Vec<f64>> {
    let at = vector(base);
    let least = |d: &Vector| minus(&solid.lowest(d), &at);
    // The direction in which the polytope lies farthest beyond the base: a turn towards it lifts
    // all of the polytope.
    let ahead = nearest::normals(least, &minus(&solid.middle(), &at), 4.0 * gap);
    let width = |d: &Vector| nearest::dot(d, &least(d)) / nearest::dot(d, d).sqrt();
    let Some(ahead) = ahead.into_iter().max_by(|a, b| width(a).total_cmp(&width(b))) else {
        return Vec::new();
    };
    let turn = gap / width(&ahead) / nearest::dot(&ahead, &ahead).sqrt();
    let mut found = Vec::new();
    for edge in &solid.edges {
        let [u, v] = edge.ends.map(|end| minus(&end, &at));
        let normal = cross(&u, &v);
        let length = nearest::dot(&normal, &normal).sqrt();
        // A base in line with the edge: other edges' planes go through both.
        if length <= 4.0 * gap * nearest::dot(&u, &u).max(nearest::dot(&v, &v)).sqrt() {
            continue;
        }
        for sign in [1.0, -1.0] {
            let direction = normal.map(|x| sign * x / length);
            if nearest::dot(&direction, &least(&direction)) >= -1e-3 * gap {
                found.push((0..3).map(|k| direction[k] + turn * ahead[k]).collect());
            }
        }
    }
    found
}

/// Tangents to a Euclidean ball, the two in the plane and several in space.
///
/// The directions that have the base below the ball by a gap are those within some angle of the
/// way to its centre; the ends of that range are found by bisection.
fn to_ball(solid: &Solid, ball: &Ball, base: &[f64], gap: f64) -> Vec<Vec<f64>> {
    let dimension = base.len();
    let way = minus(&vector(&ball.center), &vector(base));
    let distance = nearest::dot(&way, &way).sqrt();
    let ahead = way.map(|x| x / distance);
    let direction = |turn: f64, aside: &Vector| -> Vec<f64> {
        (0..dimension).map(|k| turn.cos() * ahead[k] + turn.sin() * aside[k]).collect()
    };
    let clear = |d: &[f64]| solid.level(d) - dot(d, base) >= gap;
    // Not a number is not clear either.
    if !clear(&direction(0.0, &[0.0; 3])) {
        return Vec::new();
    }
    let farthest = |aside: Vector| {
        let (mut inside, mut outside) = (0.0, FRAC_PI_2);
        for _ in 0..60 {
            let turn = 0.5 * (inside + outside);
            if clear(&direction(turn, &aside)) { inside = turn } else { outside = turn }
        }
        direction(inside, &aside)
    };
    asides(&ahead, dimension).into_iter().map(farthest).collect()
}

/// Unit vectors across a unit vector: both in the plane, several in space, level ones among them.
fn asides(ahead: &Vector, dimension: usize) -> Vec<Vector> {
    let left = [-ahead[1], ahead[0], 0.0];
    if dimension == 2 {
        return vec![left, left.map(|x| -x)];
    }
    let length = nearest::dot(&left, &left).sqrt();
    let left = if length > 1e-9 { left.map(|x| x / length) } else { [1.0, 0.0, 0.0] };
    let up = cross(ahead, &left);
    let aside = |i: u32| {
        let angle = TAU * f64::from(i) / f64::from(AROUND);
        [0, 1, 2].map(|k| angle.cos() * left[k] + angle.sin() * up[k])
    };
    (0..AROUND).map(aside).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::abstraction::Owner;
    use crate::entity::EntityId;
    use crate::exact::Rational;
    use crate::geometry::Polytope;
    use crate::ir::{BlockerId, Piece};

    const GAP: f64 = 1e-5;

    fn cube() -> Piece {
        let at = |x: i64| vec![Rational::from(x); 3];
        Piece::Polytope(Polytope::from_box(&at(-1), &at(1)))
    }

    /// Every tangent has the base below the solid by a gap, and the solid near.
    fn tangents(piece: &Piece, base: [f64; 3]) -> Vec<Vec<f64>> {
        let mut directions = Directions::new(3);
        let owner = Owner::Blocker(BlockerId::new(0));
        let mut solid = crate::abstraction::solid::solid(owner, 0, piece, &mut directions);
        add(&mut solid, &base, &mut directions, GAP);
        let faces = solid.faces.iter().filter(|(stage, _)| *stage == Stage::Tangents);
        let found: Vec<Vec<f64>> = faces.map(|(_, d)| directions[*d].vector.clone()).collect();
        for d in &found {
            let room = solid.level(d) - dot(d, &base);
            assert!((0.8 * GAP..30.0 * GAP).contains(&room), "{d:?} {room}");
        }
        found
    }

    #[test]
    fn a_cube_is_seen_with_its_outline() {
        // Before a face four edges are seen against the background, before a corner six.
        assert_eq!(tangents(&cube(), [-3.0, 0.2, 0.1]).len(), 4);
        assert_eq!(tangents(&cube(), [3.0, 4.0, 5.0]).len(), 6);
        // On a face and inside there is nothing to see past.
        assert_eq!(tangents(&cube(), [1.0, 0.0, 0.0]).len(), 0);
        assert_eq!(tangents(&cube(), [0.0, 0.5, 0.0]).len(), 0);
    }

    #[test]
    fn planes_around_a_ball_touch_it_all_around() {
        let numbers = |v: [f64; 3]| v.iter().map(|x| Rational::from_f64(*x).expect("finite")).collect();
        for spread in [[0.0; 3], [0.25, 0.0, 0.5]] {
            let radius = Rational::ONE;
            let ball = Piece::Ball { center: numbers([0.0; 3]), spread: numbers(spread), radius };
            for base in [[3.0, 0.0, 0.0], [0.0, 0.0, -4.0], [2.0, 2.0, 2.0]] {
                assert_eq!(tangents(&ball, base).len(), 8, "{base:?}");
            }
            assert_eq!(tangents(&ball, [0.5, 0.0, 0.0]).len(), 0);
        }
    }
}
