//! Convex hulls and convex polygons, exactly.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

use crate::exact::{Rational, dot};
use crate::geometry::{HalfSpace, Polytope, ShapeError, rank};

type Point = Vec<Rational>;

/// The hull of points that all have 2 or all have 3 coordinates.
pub(super) fn hull(points: &[Point]) -> Result<Polytope, ShapeError> {
    let dimension = common_dimension(points)?;
    let points: Vec<Point> = points.iter().cloned().collect::<BTreeSet<_>>().into_iter().collect();
    if points.len() <= dimension {
        return Err(ShapeError::TooFewPoints);
    }
    if dimension == 2 { planar_hull(&points) } else { spatial_hull(&points) }
}

/// The polygon with these corners, see [`Polytope::polygon`].
pub(super) fn polygon(points: &[Point]) -> Result<Polytope, ShapeError> {
    if common_dimension(points)? != 2 {
        return Err(ShapeError::Dimension);
    }
    if points.len() < 3 {
        return Err(ShapeError::TooFewPoints);
    }
    refuse_duplicates(points)?;
    let hull = planar_hull(points)?;
    match wrong_corner(points) {
        Some(corner) => Err(ShapeError::NotConvex { corner }),
        None => Ok(hull),
    }
}

/// The polygon whose corners are known to be convex, irredundant and counter-clockwise.
pub(super) fn counter_clockwise(vertices: Vec<Point>) -> Polytope {
    let next = |i: usize| &vertices[(i + 1) % vertices.len()];
    let facet = |(i, a): (usize, &Point)| {
        let b = next(i);
        let normal = vec![&b[1] - &a[1], &a[0] - &b[0]];
        HalfSpace { offset: dot(&normal, a), normal }.normalised()
    };
    Polytope { facets: vertices.iter().enumerate().map(facet).collect(), vertices }
}

fn common_dimension(points: &[Point]) -> Result<usize, ShapeError> {
    let dimension = points.first().ok_or(ShapeError::TooFewPoints)?.len();
    let same = points.iter().all(|p| p.len() == dimension);
    if same && matches!(dimension, 2 | 3) { Ok(dimension) } else { Err(ShapeError::Dimension) }
}

fn refuse_duplicates(points: &[Point]) -> Result<(), ShapeError> {
    let mut seen: BTreeMap<&Point, usize> = BTreeMap::new();
    for (second, point) in points.iter().enumerate() {
        if let Some(first) = seen.insert(point, second) {
            return Err(ShapeError::Duplicate { first, second });
        }
    }
    Ok(())
}

/// Twice the signed area of the triangle a, b, c: positive when it turns left at b.
fn turn(a: &[Rational], b: &[Rational], c: &[Rational]) -> Rational {
    (&b[0] - &a[0]) * (&c[1] - &a[1]) - (&b[1] - &a[1]) * (&c[0] - &a[0])
}

/// The first corner at which a closed outline of distinct points, not all on a line, is not convex.
fn wrong_corner(points: &[Point]) -> Option<usize> {
    let n = points.len();
    let at = |i: usize| &points[i % n];
    let area: Rational = (1..n - 1).map(|i| turn(at(0), at(i), at(i + 1))).sum();
    let orientation = if area.is_negative() { Rational::from(-1) } else { Rational::ONE };
    let bends_back = |i: usize| {
        let (a, b, c) = (at(i + n - 1), at(i), at(i + 1));
        let left = turn(a, b, c) * &orientation;
        let onwards = (&b[0] - &a[0]) * (&c[0] - &b[0]) + (&b[1] - &a[1]) * (&c[1] - &b[1]);
        left.is_negative() || (left.is_zero() && onwards.is_negative())
    };
    let upwards = |i: usize| {
        let (a, b) = (at(i), at(i + 1));
        (&b[1], &b[0]) > (&a[1], &a[0])
    };
    // Outlines that turn the same way at each corner, but more than once round, turn upwards again.
    let turns_upwards = |i: &usize| !upwards(i + n - 1) && upwards(*i);
    (0..n).find(|&i| bends_back(i)).or_else(|| (0..n).filter(turns_upwards).nth(1))
}

/// Andrew's monotone chain.
fn planar_hull(points: &[Point]) -> Result<Polytope, ShapeError> {
    let mut sorted: Vec<&Point> = points.iter().collect();
    sorted.sort();
    let mut vertices = half_hull(sorted.iter().copied());
    vertices.pop();
    let mut upper = half_hull(sorted.iter().rev().copied());
    upper.pop();
    vertices.extend(upper);
    if vertices.len() < 3 {
        return Err(ShapeError::Flat);
    }
    Ok(counter_clockwise(vertices.into_iter().cloned().collect()))
}

/// The chain of sorted points that only turns left.
fn half_hull<'a>(points: impl Iterator<Item = &'a Point>) -> Vec<&'a Point> {
    let mut chain: Vec<&Point> = Vec::new();
    for point in points {
        while let [.., a, b] = chain[..] {
            if turn(a, b, point).is_positive() {
                break;
            }
            chain.pop();
        }
        chain.push(point);
    }
    chain
}

/// A triangle of a hull under construction: its corners seen counter-clockwise from outside.
struct Triangle {
    corners: [usize; 3],
    plane: HalfSpace,
}

impl Triangle {
    fn new(points: &[Point], corners: [usize; 3]) -> Triangle {
        let [a, b, c] = corners.map(|i| &points[i]);
        let normal = cross(&minus(b, a), &minus(c, a));
        Triangle { corners, plane: HalfSpace { offset: dot(&normal, a), normal } }
    }

    fn edges(&self) -> [(usize, usize); 3] {
        let [a, b, c] = self.corners;
        [(a, b), (b, c), (c, a)]
    }
}

fn minus(a: &[Rational], b: &[Rational]) -> Point {
    a.iter().zip(b).map(|(x, y)| x - y).collect()
}

fn cross(a: &[Rational], b: &[Rational]) -> Point {
    let entry = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
    vec![entry(1, 2), entry(2, 0), entry(0, 1)]
}

/// Adds one point after the other; a point that sees triangles strictly from outside replaces them
/// by the cone over their outline. Exactness makes co-planar points harmless: none of a facet's
/// triangles is seen from its own plane, and no new triangle is flat.
fn spatial_hull(points: &[Point]) -> Result<Polytope, ShapeError> {
    let simplex = first_simplex(points)?;
    let mut triangles = simplex_triangles(points, simplex);
    for (i, point) in points.iter().enumerate() {
        let (seen, mut kept): (Vec<_>, Vec<_>) =
            triangles.into_iter().partition(|t| !t.plane.contains(point));
        let edges: BTreeSet<(usize, usize)> = seen.iter().flat_map(Triangle::edges).collect();
        let outline = edges.iter().filter(|&&(a, b)| !edges.contains(&(b, a)));
        kept.extend(outline.map(|&(a, b)| Triangle::new(points, [a, b, i])));
        triangles = kept;
    }
    Ok(merge_triangles(points, &triangles))
}

/// Four points that are not on one plane.
fn first_simplex(points: &[Point]) -> Result<[usize; 4], ShapeError> {
    let mut chosen = vec![0];
    let mut directions: Vec<Point> = Vec::new();
    for (i, point) in points.iter().enumerate().skip(1) {
        directions.push(minus(point, &points[0]));
        if rank(&directions) == directions.len() {
            chosen.push(i);
        } else {
            directions.pop();
        }
        if let [a, b, c, d] = chosen[..] {
            return Ok([a, b, c, d]);
        }
    }
    Err(ShapeError::Flat)
}

fn simplex_triangles(points: &[Point], [a, b, c, d]: [usize; 4]) -> Vec<Triangle> {
    let faces = [([a, b, c], d), ([a, b, d], c), ([a, c, d], b), ([b, c, d], a)];
    let outward = |([i, j, k], opposite): ([usize; 3], usize)| {
        let triangle = Triangle::new(points, [i, j, k]);
        let inside = triangle.plane.contains(&points[opposite]);
        if inside { triangle } else { Triangle::new(points, [i, k, j]) }
    };
    faces.map(outward).into_iter().collect()
}

/// One facet a plane, and the points that are no mere inner points of facets or edges.
fn merge_triangles(points: &[Point], triangles: &[Triangle]) -> Polytope {
    let mut facets: Vec<HalfSpace> = triangles.iter().map(|t| t.plane.normalised()).collect();
    facets.sort_by(compare_half_spaces);
    facets.dedup();
    let corners: BTreeSet<usize> = triangles.iter().flat_map(|t| t.corners).collect();
    let is_vertex = |point: &Point| {
        let tight = facets.iter().filter(|f| !f.contains_interior(point));
        rank(&tight.map(|f| f.normal.clone()).collect::<Vec<_>>()) == 3
    };
    let vertices = corners.into_iter().map(|i| points[i].clone()).filter(is_vertex).collect();
    Polytope { facets, vertices }
}

/// A total order of half-spaces, for output that does not depend on how they were found.
pub(super) fn compare_half_spaces(a: &HalfSpace, b: &HalfSpace) -> Ordering {
    (&a.normal, &a.offset).cmp(&(&b.normal, &b.offset))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points(list: &[[i64; 2]]) -> Vec<Point> {
        list.iter().map(|p| p.iter().map(|&x| Rational::from(x)).collect()).collect()
    }

    #[test]
    fn polygons_come_in_either_orientation_and_lose_straight_corners() {
        let left = polygon(&points(&[[0, 0], [2, 0], [4, 0], [4, 4], [0, 4]])).unwrap();
        let right = polygon(&points(&[[0, 4], [4, 4], [4, 0], [0, 0]])).unwrap();
        assert_eq!(left, right);
        assert_eq!(left.vertices, points(&[[0, 0], [4, 0], [4, 4], [0, 4]]));
    }

    #[test]
    fn polygons_that_are_not_convex_name_the_corner() {
        let refused = |list: &[[i64; 2]]| polygon(&points(list)).unwrap_err();
        assert_eq!(refused(&[[0, 0], [4, 0], [1, 1], [0, 4]]), ShapeError::NotConvex { corner: 2 });
        assert_eq!(refused(&[[0, 4], [1, 1], [4, 0], [0, 0]]), ShapeError::NotConvex { corner: 1 });
        // A straight corner from which the outline runs back over itself.
        assert_eq!(refused(&[[0, 0], [4, 0], [2, 0], [2, 3]]), ShapeError::NotConvex { corner: 1 });
        // A pentagram turns left at each corner.
        let star = [[0, 10], [-6, -8], [10, 3], [-10, 3], [6, -8]];
        assert!(matches!(refused(&star), ShapeError::NotConvex { .. }));
        // A bow tie.
        assert!(matches!(refused(&[[0, 0], [2, 2], [2, 0], [0, 2]]), ShapeError::NotConvex { .. }));
    }

    #[test]
    fn degenerate_outlines_are_refused_for_their_own_reason() {
        let refused = |list: &[[i64; 2]]| polygon(&points(list)).unwrap_err();
        assert_eq!(refused(&[[0, 0], [1, 1]]), ShapeError::TooFewPoints);
        assert_eq!(refused(&[[0, 0], [1, 1], [2, 2]]), ShapeError::Flat);
        assert_eq!(refused(&[[0, 0], [1, 0], [0, 1], [0, 0]]), ShapeError::Duplicate { first: 0, second: 3 });
        assert_eq!(hull(&[]).unwrap_err(), ShapeError::TooFewPoints);
        assert_eq!(hull(&points(&[[0, 0], [1, 1], [3, 3], [2, 2]])).unwrap_err(), ShapeError::Flat);
    }

    fn cloud(dimension: usize) -> impl Strategy<Value = Vec<Point>> {
        let point = prop::collection::vec((-6i64..7).prop_map(Rational::from), dimension);
        prop::collection::vec(point, dimension + 1..14)
    }

    /// Every facet holds all points, is touched by enough vertices, and the hull of the facets is
    /// the hull again.
    fn check_hull(points: &[Point], dimension: usize) {
        let Ok(hull) = hull(points) else { return };
        for facet in &hull.facets {
            assert!(points.iter().all(|p| facet.contains(p)));
            let tight: Vec<_> = hull.vertices.iter().filter(|v| !facet.contains_interior(v)).collect();
            let spread: Vec<_> = tight.iter().skip(1).map(|v| minus(v, tight[0])).collect();
            assert_eq!(rank(&spread), dimension - 1);
        }
        assert!(hull.vertices.iter().all(|v| points.contains(v)));
        assert!(hull.contains_interior(&hull.middle()));
        let again = Polytope::from_half_spaces(&hull.facets).unwrap();
        assert_eq!(again.vertices, hull.vertices);
        assert_eq!(again.facets, hull.facets);
    }

    proptest! {
        #[test]
        fn planar_hulls_survive_the_round_trip(points in cloud(2)) {
            check_hull(&points, 2);
        }

        #[test]
        fn spatial_hulls_survive_the_round_trip(points in cloud(3)) {
            check_hull(&points, 3);
        }

        #[test]
        fn polygon_agrees_with_hull_on_convex_outlines(points in cloud(2), turn in 0usize..8) {
            if let Ok(hull) = hull(&points) {
                let mut corners = hull.vertices.clone();
                let count = corners.len();
                corners.rotate_left(turn % count);
                if turn % 2 == 1 { corners.reverse(); }
                prop_assert_eq!(polygon(&corners).unwrap(), hull);
            }
        }
    }
}
