//! Convex outlines in the plane: what sets of positions look like in a projection, in metres.

use super::projection::Projection;
use super::section::Section;
use crate::exact::Rational;
use crate::geometry::{HalfSpace, Polytope};
use crate::ir::Piece;

/// A point of a projection, in metres.
pub type Point = [f64; 2];

/// How many corners stand for an outline made of arcs.
const ARC_CORNERS: usize = 120;

/// A convex polygon widened by a disc.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// The polygon's corners, counter-clockwise; one for a disc.
    pub corners: Vec<Point>,
    /// The disc's radius; 0 for a polygon.
    pub radius: f64,
}

impl Outline {
    /// The convex hull of points.
    pub fn hull(mut points: Vec<Point>) -> Outline {
        points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        points.dedup();
        if let [only] = points[..] {
            return Outline { corners: vec![only], radius: 0.0 };
        }
        let lower = half_hull(points.iter());
        let upper = half_hull(points.iter().rev());
        Outline { corners: lower.into_iter().chain(upper).collect(), radius: 0.0 }
    }

    /// A piece in a projection.
    pub fn of(piece: &Piece, projection: &Projection) -> Outline {
        match piece {
            Piece::Polytope(polytope) => Outline::of_polytope(polytope, projection),
            Piece::Ball { center, spread, radius } => {
                let corners = box_around(center, spread).iter().map(|p| projection.flat(p)).collect();
                Outline { radius: radius.to_f64(), ..Outline::hull(corners) }
            }
        }
    }

    /// A polytope in a projection.
    pub fn of_polytope(polytope: &Polytope, projection: &Projection) -> Outline {
        Outline::hull(polytope.vertices.iter().map(|v| projection.of(v)).collect())
    }

    /// The Minkowski sum of two outlines.
    pub fn plus(&self, other: &Outline) -> Outline {
        let sums = self.corners.iter().flat_map(|a| other.corners.iter().map(|b| [a[0] + b[0], a[1] + b[1]]));
        Outline { radius: self.radius + other.radius, ..Outline::hull(sums.collect()) }
    }

    /// The outline moved by an offset.
    pub fn at(&self, offset: Point) -> Outline {
        let corners = self.corners.iter().map(|c| [c[0] + offset[0], c[1] + offset[1]]).collect();
        Outline { corners, radius: self.radius }
    }

    /// The hull of two polygons; radii are left out.
    pub fn joined(&self, other: &Outline) -> Outline {
        Outline::hull(self.corners.iter().chain(&other.corners).copied().collect())
    }

    /// The lower left and the upper right corner of the box around it.
    pub fn bounds(&self) -> (Point, Point) {
        let along = |axis: usize, pick: fn(f64, f64) -> f64, start: f64| {
            self.corners.iter().map(|c| c[axis]).fold(start, pick)
        };
        let low = [0, 1].map(|a| along(a, f64::min, f64::INFINITY) - self.radius);
        let high = [0, 1].map(|a| along(a, f64::max, f64::NEG_INFINITY) + self.radius);
        (low, high)
    }
}

/// What is left of a piece for the nominal position when the whole section around it must stay in:
/// piece ⊖ Ω. `None` when that is nothing.
///
/// For a ball in space, the slice through its middle; none in the axonometric projection.
pub fn shrunk(piece: &Piece, section: &Section, projection: &Projection) -> Option<Outline> {
    match piece {
        Piece::Polytope(polytope) => {
            let moved = |facet: &HalfSpace| {
                let normal: Vec<f64> = facet.normal.iter().map(Rational::to_f64).collect();
                let offset = &facet.offset - Rational::from_f64(section.support(&normal))?;
                Some(HalfSpace { normal: facet.normal.clone(), offset })
            };
            let facets: Option<Vec<HalfSpace>> = polytope.facets.iter().map(moved).collect();
            Some(Outline::of_polytope(&Polytope::from_half_spaces(&facets?).ok()?, projection))
        }
        Piece::Ball { center, spread, radius } => {
            let numbers = |v: &[Rational]| v.iter().map(Rational::to_f64).collect::<Vec<_>>();
            shrunk_ball(&numbers(center), &numbers(spread), radius.to_f64(), section, projection.axes()?)
        }
    }
}

/// The intersection of all balls around center ± spread − e for e in the section, by its distance
/// from its middle in all directions. In space: the slice along two axes through the middle, with the
/// box around the section.
fn shrunk_ball(
    center: &[f64],
    spread: &[f64],
    radius: f64,
    section: &Section,
    [a, b]: [usize; 2],
) -> Option<Outline> {
    let middle: Vec<f64> = center.iter().zip(&section.center).map(|(c, e)| c - e).collect();
    let off_middle = |error: &[f64], axis: usize| {
        error.get(axis).copied().unwrap_or(0.0) - section.center.get(axis).copied().unwrap_or(0.0)
    };
    let spread_at = |axis: usize| spread.get(axis).copied().unwrap_or(0.0);
    let mut discs: Vec<(Point, f64)> = Vec::new();
    for error in section.corners() {
        // The third axis is what a and b leave of 0 + 1 + 2.
        let across = 3 - a - b;
        let height = off_middle(&error, across).abs() + spread_at(across);
        let around = [-off_middle(&error, a), -off_middle(&error, b)];
        for q in corners_of_box(&around, &[spread_at(a), spread_at(b)]) {
            discs.push((q, radius * radius - height * height));
        }
    }
    let reach = |angle: f64| {
        let u = [angle.cos(), angle.sin()];
        let along = discs.iter().map(|(q, square)| {
            let ahead = q[0] * u[0] + q[1] * u[1];
            let root = ahead * ahead - q[0] * q[0] - q[1] * q[1] + square;
            if root < 0.0 { -1.0 } else { ahead + root.sqrt() }
        });
        along.fold(f64::INFINITY, f64::min)
    };
    let corner = |i: usize| {
        let angle = std::f64::consts::TAU * i as f64 / ARC_CORNERS as f64;
        let r = reach(angle);
        (r > 0.0).then(|| [middle[a] + r * angle.cos(), middle[b] + r * angle.sin()])
    };
    let corners: Option<Vec<Point>> = (0..ARC_CORNERS).map(corner).collect();
    Some(Outline { corners: corners?, radius: 0.0 })
}

/// The four corners of a box, doubled ones included.
fn corners_of_box(center: &Point, half: &Point) -> Vec<Point> {
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| [center[0] + x * half[0], center[1] + y * half[1]])
        .to_vec()
}

/// The corners of a box of two or three dimensions, doubled ones included.
fn box_around(center: &[Rational], half: &[Rational]) -> Vec<Vec<f64>> {
    let corner = |bits: usize| {
        let along = |(axis, (c, h)): (usize, (&Rational, &Rational))| {
            let (c, h) = (c.to_f64(), h.to_f64());
            if bits >> axis & 1 == 1 { c + h } else { c - h }
        };
        center.iter().zip(half).enumerate().map(along).collect()
    };
    (0..1 << center.len()).map(corner).collect()
}

/// One side of the hull of sorted points, its last point left out (Andrew's monotone chain).
fn half_hull<'a>(points: impl Iterator<Item = &'a Point>) -> Vec<Point> {
    let mut chain: Vec<Point> = Vec::new();
    for &p in points {
        while let [.., a, b] = chain[..]
            && (b[0] - a[0]) * (p[1] - a[1]) <= (b[1] - a[1]) * (p[0] - a[0])
        {
            chain.pop();
        }
        chain.push(p);
    }
    chain.pop();
    chain
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::Rational;

    fn numbers(values: &[f64]) -> Vec<Rational> {
        values.iter().map(|v| Rational::from_f64(*v).expect("finite")).collect()
    }

    fn disc(spread: [f64; 2]) -> Piece {
        Piece::Ball {
            center: numbers(&[2.0, 1.0]),
            spread: numbers(&spread),
            radius: numbers(&[1.0])[0].clone(),
        }
    }

    fn section() -> Section {
        Section { center: vec![0.5, 0.0], generators: vec![vec![0.3, 0.0], vec![0.0, 0.4]] }
    }

    /// However the piece is shrunk, the section around each corner touches the piece's edge from inside.
    fn farthest(corner: Point, spread: [f64; 2]) -> f64 {
        let errors = [(0.8, 0.4), (0.8, -0.4), (0.2, 0.4), (0.2, -0.4)];
        let reach = |(ex, ey): (f64, f64)| {
            let (x, y) = (corner[0] + ex - 2.0, corner[1] + ey - 1.0);
            (x.abs() + spread[0]).hypot(y.abs() + spread[1])
        };
        errors.map(reach).into_iter().fold(0.0, f64::max)
    }

    #[test]
    fn a_shrunk_disc_is_as_large_as_it_can_be() {
        for spread in [[0.0, 0.0], [0.0, 0.2], [0.1, 0.0]] {
            let left = shrunk(&disc(spread), &section(), &Projection::TOP).expect("something is left");
            assert_eq!(left.corners.len(), ARC_CORNERS);
            for corner in &left.corners {
                assert!((farthest(*corner, spread) - 1.0).abs() < 1e-9, "{corner:?} {spread:?}");
            }
        }
    }

    #[test]
    fn nothing_is_left_of_what_is_smaller_than_the_tube() {
        let wide = Section { center: vec![0.0, 0.0], generators: vec![vec![0.8, 0.0], vec![0.0, 0.8]] };
        assert_eq!(shrunk(&disc([0.0, 0.0]), &wide, &Projection::TOP), None);
        let square = Piece::Polytope(Polytope::from_box(&numbers(&[0.0, 0.0]), &numbers(&[1.5, 1.5])));
        assert_eq!(shrunk(&square, &wide, &Projection::TOP), None);
    }

    #[test]
    fn a_section_of_skew_generators_has_six_corners() {
        let section = Section {
            center: vec![0.0, 0.0],
            generators: vec![vec![1.0, 0.0], vec![0.0, 1.0], vec![1.0, 1.0]],
        };
        let outline = section.outline(&Projection::TOP);
        assert_eq!(
            outline.corners,
            [[-2.0, -2.0], [0.0, -2.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [-2.0, 0.0]]
        );
        assert_eq!(section.support(&[1.0, -1.0]), 2.0);
    }
}
