//! Convex bodies in doubles, and how far a point or a segment is from them.
//!
//! Everything lies in space; in the plane the third coordinate is 0. Distances are to the true set: a
//! ball is a ball, and one whose centre is uncertain is every ball that it may be.

use crate::exact::Rational;
use crate::geometry::Polytope;
use crate::ir::Piece;

/// A point.
pub(super) type Point = [f64; 3];

/// A plane before a convex set: `normal · p < offset` is on the other side of it. The normal has length 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub(super) normal: Point,
    pub(super) offset: f64,
}

impl Plane {
    /// How far a point is before the plane, and so at least from what is beyond it.
    pub(super) fn room(&self, p: &Point) -> f64 {
        self.offset - dot(&self.normal, p)
    }
}

/// A convex body.
#[derive(Clone, Debug)]
pub(super) enum Body {
    /// A polygon or a polyhedron.
    Polytope(Solid),
    /// All balls whose centre is in a box.
    Ball {
        /// The box's middle.
        center: Point,
        /// The box's half-widths.
        spread: Point,
        /// The radius.
        radius: f64,
    },
}

/// A polygon or a polyhedron.
#[derive(Clone, Debug)]
pub(super) struct Solid {
    /// Facets: outward normals of length 1, and offsets.
    facets: Vec<(Point, f64)>,
    vertices: Vec<Point>,
    /// Pairs of vertices.
    edges: Vec<[Point; 2]>,
    flat: bool,
}

impl Body {
    /// The body of a piece.
    pub(super) fn new(piece: &Piece) -> Body {
        match piece {
            Piece::Polytope(polytope) => Body::Polytope(Solid::new(polytope)),
            Piece::Ball { center, spread, radius } => {
                Body::Ball { center: point(center), spread: point(spread), radius: radius.to_f64() }
            }
        }
    }

    /// How far a point is outside: its distance, or less than 0 inside, where it is the least way out.
    pub(super) fn clearance(&self, p: &Point) -> f64 {
        self.clearance_below(p, f64::INFINITY).unwrap_or(f64::INFINITY)
    }

    /// How far a point is outside. Nothing when it is at least `enough`, which costs less to find out.
    pub(super) fn clearance_below(&self, p: &Point, enough: f64) -> Option<f64> {
        let found = match self {
            Body::Polytope(solid) => solid.clearance(p, enough)?,
            Body::Ball { center, spread, radius } => box_distance(&minus(p, center), spread) - radius,
        };
        (found < enough).then_some(found)
    }

    /// How far a segment is outside: its distance, or less than 0 where it meets the inside. Nothing when it
    /// is at least `enough`, which costs less to find out.
    pub(super) fn segment_clearance(&self, p: &Point, q: &Point, enough: f64) -> Option<f64> {
        let found = match self {
            Body::Polytope(solid) => solid.segment_clearance(p, q, enough)?,
            Body::Ball { center, spread, radius } => {
                segment_box_distance(&minus(p, center), &minus(q, center), spread) - radius
            }
        };
        (found < enough).then_some(found)
    }

    /// A plane beyond which the body is, and how far a segment is before it: as far as it can be before any
    /// that is easily found. Where that is not far enough, how far the segment is outside.
    pub(super) fn plane_before(&self, p: &Point, q: &Point, enough: f64) -> (Option<Plane>, Option<f64>) {
        let plane = match self {
            Body::Polytope(solid) => Some(solid.plane_before(p, q)),
            Body::Ball { center, spread, radius } if *spread == [0.0; 3] => {
                let (along, to) = (minus(q, p), minus(center, p));
                let share = ratio(dot(&to, &along), dot(&along, &along));
                let toward = [0, 1, 2].map(|i| to[i] - share * along[i]);
                let size = length(&toward);
                let normal = times(&toward, 1.0 / size);
                (size > 0.0).then(|| Plane { offset: dot(&normal, center) - radius, normal })
            }
            Body::Ball { .. } => None,
        };
        let room = plane.map_or(f64::NEG_INFINITY, |plane| plane.room(p).min(plane.room(q)));
        let left = match self {
            _ if room >= enough => None,
            // In the plane those are all the directions that two overlapping sets have.
            Body::Polytope(solid) if solid.flat && room <= 0.0 => Some(room),
            _ => self.segment_clearance(p, q, enough),
        };
        (plane, left)
    }

    /// How far inside a point is, less than 0 outside; of a ball whose centre is uncertain, what all its
    /// balls have in common.
    pub(super) fn depth(&self, p: &Point) -> f64 {
        match self {
            Body::Polytope(solid) => -solid.most(p),
            Body::Ball { center, spread, radius } => {
                let out = minus(p, center);
                radius - length(&[0, 1, 2].map(|i| out[i].abs() + spread[i]))
            }
        }
    }

    /// A length from which rounding can be judged: that of the farthest of it from the origin.
    pub(super) fn size(&self) -> f64 {
        match self {
            Body::Polytope(solid) => solid.vertices.iter().map(length).fold(0.0, f64::max),
            Body::Ball { center, spread, radius } => length(center) + length(spread) + radius,
        }
    }
}

impl Solid {
    /// The same set as a polytope, up to rounding.
    pub(super) fn new(polytope: &Polytope) -> Solid {
        let facet = |f: &crate::geometry::HalfSpace| {
            let normal = point(&f.normal);
            let scale = 1.0 / length(&normal);
            (times(&normal, scale), f.offset.to_f64() * scale)
        };
        let vertices: Vec<Point> = polytope.vertices.iter().map(|v| point(v)).collect();
        let count = vertices.len();
        let pairs = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
        let edges = pairs.filter(|&(i, j)| is_edge(polytope, i, j)).map(|(i, j)| [vertices[i], vertices[j]]);
        Solid {
            facets: polytope.facets.iter().map(facet).collect(),
            edges: edges.collect(),
            flat: polytope.dimension() < 3,
            vertices,
        }
    }

    /// The most that a point is beyond a facet; at most its distance.
    pub(super) fn most(&self, p: &Point) -> f64 {
        self.facets.iter().map(|(a, b)| dot(a, p) - b).fold(f64::NEG_INFINITY, f64::max)
    }

    fn clearance(&self, p: &Point, enough: f64) -> Option<f64> {
        let most = self.most(p);
        if most <= 0.0 {
            return Some(most);
        }
        (most < enough).then(|| self.above_facets(p).min(self.edge_distance(p)))
    }

    fn segment_clearance(&self, p: &Point, q: &Point, enough: f64) -> Option<f64> {
        let beyond = |(a, b): &(Point, f64)| dot(a, p).min(dot(a, q)) - b;
        let mut most = f64::NEG_INFINITY;
        for facet in &self.facets {
            most = most.max(beyond(facet));
            if most >= enough && most > 0.0 {
                return None;
            }
        }
        if most <= 0.0 || self.flat {
            most = self.between_edges(p, q).fold(most, f64::max);
        }
        if most <= 0.0 {
            return Some(most);
        }
        (most < enough).then(|| self.apart(p, q))
    }

    /// The plane along a facet, or in the plane along the segment, that a segment is farthest before.
    fn plane_before(&self, p: &Point, q: &Point) -> Plane {
        let mut best = (f64::NEG_INFINITY, Plane { normal: [0.0; 3], offset: f64::NEG_INFINITY });
        for (a, b) in &self.facets {
            let room = dot(a, p).min(dot(a, q)) - b;
            if room > best.0 {
                best = (room, Plane { normal: times(a, -1.0), offset: -b });
            }
        }
        let along = minus(q, p);
        let size = length(&along);
        if self.flat && size > 0.0 {
            let across = [along[1] / size, -along[0] / size, 0.0];
            let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
            for vertex in &self.vertices {
                let height = dot(&across, vertex);
                (least, most) = (least.min(height), most.max(height));
            }
            let at = dot(&across, p);
            if least - at > best.0 {
                best = (least - at, Plane { normal: across, offset: least });
            }
            if at - most > best.0 {
                best = (at - most, Plane { normal: times(&across, -1.0), offset: -most });
            }
        }
        best.1
    }

    /// The distance of a segment that does not meet it.
    fn apart(&self, p: &Point, q: &Point) -> f64 {
        let ends = self.edge_distance(p).min(self.edge_distance(q));
        if self.flat {
            // Two segments that don't cross are nearest at an end of one of them.
            let corners = self.vertices.iter().map(|v| from_segment(v, p, q)).fold(f64::INFINITY, f64::min);
            return ends.min(corners.sqrt());
        }
        let edges = self.edges.iter().map(|[a, b]| segments(p, q, a, b)).fold(f64::INFINITY, f64::min);
        edges.min(ends).min(self.above_facets(p)).min(self.above_facets(q))
    }

    /// How far a segment is away across it and an edge; in the plane across it.
    fn between_edges<'a>(&'a self, p: &Point, q: &Point) -> impl Iterator<Item = f64> + 'a {
        let (p, along) = (*p, minus(q, p));
        let directions = self.edges.iter().take(if self.flat { 1 } else { usize::MAX }).map(move |[a, b]| {
            if self.flat { [along[1], -along[0], 0.0] } else { cross(&along, &minus(b, a)) }
        });
        directions.filter_map(move |direction| {
            let size = length(&direction);
            let at = dot(&direction, &p);
            let over = |v: &Point| (dot(&direction, v) - at) / size;
            let (least, most) = self
                .vertices
                .iter()
                .map(over)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), x| (least.min(x), most.max(x)));
            (size > 0.0).then(|| least.max(-most))
        })
    }

    /// The distance from a facet's plane, where the nearest point of that plane is in the facet.
    fn above_facets(&self, p: &Point) -> f64 {
        if self.flat {
            return f64::INFINITY;
        }
        let above = |(a, b): &(Point, f64)| {
            let height = dot(a, p) - b;
            let foot = [0, 1, 2].map(|i| p[i] - height * a[i]);
            let inside = height > 0.0 && self.most(&foot) <= ON_FACET * (1.0 + length(&foot));
            if inside { height } else { f64::INFINITY }
        };
        self.facets.iter().map(above).fold(f64::INFINITY, f64::min)
    }

    fn edge_distance(&self, p: &Point) -> f64 {
        self.edges.iter().map(|[a, b]| from_segment(p, a, b)).fold(f64::INFINITY, f64::min).sqrt()
    }
}

/// How far beyond a facet, in proportion, the rounded foot of a perpendicular on it may seem to be.
const ON_FACET: f64 = 1e-13;

/// Whether two vertices share as many facets as an edge has.
fn is_edge(polytope: &Polytope, i: usize, j: usize) -> bool {
    let on = |f: &crate::geometry::HalfSpace, v: usize| {
        crate::exact::dot(&f.normal, &polytope.vertices[v]) == f.offset
    };
    let shared = polytope.facets.iter().filter(|f| on(f, i) && on(f, j)).count();
    shared + 1 >= polytope.dimension()
}

/// The squared distance of a point from a segment.
fn from_segment(p: &Point, a: &Point, b: &Point) -> f64 {
    let (along, to) = (minus(b, a), minus(p, a));
    let share = ratio(dot(&to, &along), dot(&along, &along));
    let apart = [0, 1, 2].map(|i| to[i] - share * along[i]);
    dot(&apart, &apart)
}

/// The distance of two segments.
fn segments(p: &Point, q: &Point, a: &Point, b: &Point) -> f64 {
    let (u, v, w) = (minus(q, p), minus(b, a), minus(p, a));
    let (uu, uv, vv, uw, vw) = (dot(&u, &u), dot(&u, &v), dot(&v, &v), dot(&u, &w), dot(&v, &w));
    let along_b = |s: f64| ratio(s * uv + vw, vv);
    // The lines' nearest points, or any where they are parallel; then each end that this misses.
    let s = ratio(uv * vw - vv * uw, uu * vv - uv * uv);
    let t = along_b(s);
    let s = ratio(t * uv - uw, uu);
    let apart = |s: f64, t: f64| length(&[0, 1, 2].map(|i| w[i] + s * u[i] - t * v[i]));
    let ends = [(0.0, along_b(0.0)), (1.0, along_b(1.0)), (ratio(-uw, uu), 0.0), (ratio(uv - uw, uu), 1.0)];
    ends.into_iter().map(|(s, t)| apart(s, t)).fold(apart(s, along_b(s)), f64::min)
}

/// A ratio, held between 0 and 1; 0 where it is none.
fn ratio(a: f64, b: f64) -> f64 {
    if b > 0.0 { (a / b).clamp(0.0, 1.0) } else { 0.0 }
}

/// The distance of a point from the box around the origin with these half-widths.
fn box_distance(p: &Point, half: &Point) -> f64 {
    length(&[0, 1, 2].map(|i| (p[i].abs() - half[i]).max(0.0)))
}

/// The distance of a segment from the box around the origin with these half-widths.
///
/// Its square is convex along the segment, and a parabola between the points where the segment crosses
/// the planes of the box's faces.
fn segment_box_distance(p: &Point, q: &Point, half: &Point) -> f64 {
    let u = minus(q, p);
    let mut cuts = [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    for i in 0..3 {
        if u[i] != 0.0 {
            cuts[2 + 2 * i] = ((half[i] - p[i]) / u[i]).clamp(0.0, 1.0);
            cuts[3 + 2 * i] = ((-half[i] - p[i]) / u[i]).clamp(0.0, 1.0);
        }
    }
    cuts.sort_by(f64::total_cmp);
    let at = |s: f64| [0, 1, 2].map(|i| p[i] + s * u[i]);
    let mut least = f64::INFINITY;
    for pair in cuts.windows(2) {
        let middle = at(0.5 * (pair[0] + pair[1]));
        // Beyond which faces it is on this stretch: there the distance along the axis is p + s u ∓ half.
        let (mut uu, mut up) = (0.0, 0.0);
        for i in 0..3 {
            if middle[i].abs() > half[i] {
                uu += u[i] * u[i];
                up += u[i] * (p[i] - half[i].copysign(middle[i]));
            }
        }
        let s = if uu > 0.0 { (-up / uu).clamp(pair[0], pair[1]) } else { pair[0] };
        least = least.min(box_distance(&at(s), half));
    }
    least
}

/// A point of the plane or of space.
pub(super) fn point(coordinates: &[Rational]) -> Point {
    let mut point = [0.0; 3];
    point.iter_mut().zip(coordinates).for_each(|(to, from)| *to = from.to_f64());
    point
}

pub(super) fn minus(a: &Point, b: &Point) -> Point {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn times(a: &Point, factor: f64) -> Point {
    a.map(|x| x * factor)
}

pub(super) fn dot(a: &Point, b: &Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: &Point, b: &Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn length(a: &Point) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::random::Stream;

    fn exact(p: &[f64]) -> Vec<Rational> {
        p.iter().map(|x| Rational::from_f64(*x).expect("finite")).collect()
    }

    /// A random piece in the plane or in space, about the size of its workspace.
    fn piece(stream: &mut Stream, dimension: usize) -> Piece {
        let mut some =
            |size: f64| -> Vec<f64> { (0..dimension).map(|_| size * stream.symmetric()).collect() };
        let center = some(1.5);
        match stream.below(4) {
            0 => {
                let spread = [0.0, 0.5, 1.0].map(|s| s * stream.below(2) as f64);
                let radius = Rational::from_f64(1.0 + 0.5 * stream.symmetric()).expect("finite");
                Piece::Ball { center: exact(&center), spread: exact(&spread[..dimension]), radius }
            }
            1 => {
                let lo: Vec<f64> = center.iter().map(|c| c - 1.0).collect();
                Piece::Polytope(Polytope::from_box(&exact(&lo), &exact(&center)))
            }
            _ => {
                let around = |stream: &mut Stream| -> Vec<Rational> {
                    exact(&center.iter().map(|c| c + 2.0 * stream.symmetric()).collect::<Vec<_>>())
                };
                let points: Vec<_> = (0..7).map(|_| around(stream)).collect();
                Piece::Polytope(Polytope::hull(&points).expect("random points are not flat"))
            }
        }
    }

    /// How far everything of a body is beyond a segment along a direction of length 1.
    fn beyond(body: &Body, p: &Point, q: &Point, a: &Point) -> f64 {
        let near = match body {
            Body::Polytope(solid) => solid.vertices.iter().map(|v| dot(a, v)).fold(f64::INFINITY, f64::min),
            Body::Ball { center, spread, radius } => {
                dot(a, center) - (0..3).map(|i| a[i].abs() * spread[i]).sum::<f64>() - radius
            }
        };
        near - dot(a, p).max(dot(a, q))
    }

    /// The greatest such distance: what separates two convex sets, or how far they overlap at least. Found
    /// by looking in many directions, and then ever more closely around the best.
    fn by_directions(body: &Body, p: &Point, q: &Point, dimension: usize, stream: &mut Stream) -> f64 {
        let mut unit = |around: &Point, scale: f64| loop {
            let mut a = [0.0; 3];
            (0..dimension).for_each(|i| a[i] = around[i] + scale * stream.symmetric());
            if length(&a) > 1e-3 {
                return times(&a, 1.0 / length(&a));
            }
        };
        let value = |a: &Point| beyond(body, p, q, a);
        let mut starts: Vec<Point> = (0..1500).map(|_| unit(&[0.0; 3], 1.0)).collect();
        starts.sort_by(|a, b| value(b).total_cmp(&value(a)));
        let refined = starts.into_iter().take(3).map(|mut best| {
            let mut scale = 0.3;
            while scale > 1e-7 {
                for _ in 0..60 {
                    let other = unit(&best, scale);
                    if value(&other) > value(&best) {
                        best = other;
                    }
                }
                scale *= 0.6;
            }
            value(&best)
        });
        refined.fold(f64::NEG_INFINITY, f64::max)
    }

    #[test]
    fn clearances_agree_with_a_search_for_the_separating_direction() {
        let mut stream = Stream::new(1, 2026);
        let (mut apart, mut cases) = (0, 0);
        for case in 0..240 {
            let dimension = 2 + case % 2;
            let body = Body::new(&piece(&mut stream, dimension));
            let mut any = || {
                let mut p = [0.0; 3];
                (0..dimension).for_each(|i| p[i] = 3.0 * stream.symmetric());
                p
            };
            let (p, q) = (any(), any());
            for (p, q) in [(p, q), (p, p)] {
                let found = body.segment_clearance(&p, &q, f64::INFINITY).expect("nothing is enough");
                let expected = by_directions(&body, &p, &q, dimension, &mut stream);
                // Inside the box of its centres a ball has no direction of its own.
                let deep = matches!(body, Body::Ball { radius, .. } if found <= -radius);
                // No direction has more than the distance; the search may miss a little of it.
                let agree = found >= expected - 1e-9 && found <= expected + 2e-3;
                assert!(deep || agree, "{found} {expected} {body:?} {p:?} {q:?}");
                if p == q {
                    assert!((body.clearance(&p) - found).abs() < 1e-9, "{body:?} {p:?}");
                }
                let (plane, left) = body.plane_before(&p, &q, 0.25);
                if let Some(plane) = plane {
                    let room = plane.room(&p).min(plane.room(&q));
                    assert!(found >= room - 1e-9, "{plane:?} {body:?} {p:?} {q:?}");
                    let beyond = beyond(&body, &p, &q, &plane.normal);
                    assert!((beyond - room).abs() < 1e-9, "the body is right behind {plane:?}");
                }
                assert!(
                    left.map_or(found >= 0.25 - 1e-9, |left| (left - found).abs() < 1e-9),
                    "{left:?} {found}"
                );
                for enough in [found - 0.1, found + 0.1] {
                    let partly = body.segment_clearance(&p, &q, enough.max(0.0));
                    assert!(
                        partly == (found < enough.max(0.0)).then_some(found),
                        "{partly:?} {found} {enough}"
                    );
                }
                cases += 1;
                apart += usize::from(found > 0.0);
            }
        }
        assert!(apart > cases / 4 && apart < cases * 9 / 10, "{apart} of {cases}");
    }

    #[test]
    fn distances_agree_with_exact_ones() {
        let mut stream = Stream::new(3, 4);
        for case in 0..60 {
            let dimension = 2 + case % 2;
            let Piece::Polytope(polytope) = piece(&mut stream, dimension) else { continue };
            let body = Body::Polytope(Solid::new(&polytope));
            let mut p = [0.0; 3];
            (0..dimension).for_each(|i| p[i] = 5.0 * stream.symmetric());
            let exact = polytope.squared_distance(&exact(&p[..dimension])).to_f64().sqrt();
            assert!((body.clearance(&p).max(0.0) - exact).abs() < 1e-9, "{body:?} {p:?}");
            assert!((body.depth(&p) > 0.0) == (body.clearance(&p) < 0.0));
        }
    }

    #[test]
    fn what_all_balls_share_is_less_than_what_some_ball_has() {
        let ball = Body::Ball { center: [0.0; 3], spread: [0.5, 0.25, 0.0], radius: 2.0 };
        assert_eq!((ball.depth(&[0.0; 3]), ball.clearance(&[2.5, 0.0, 0.0])), (2.0 - 0.3125_f64.sqrt(), 0.0));
        assert!(ball.depth(&[1.6, 0.0, 0.0]) < 0.0 && ball.clearance(&[1.6, 0.0, 0.0]) < 0.0);
    }

    #[test]
    fn an_edge_joins_two_corners() {
        let count = |piece: &Polytope| Solid::new(piece).edges.len();
        let cube = Polytope::from_box(&exact(&[0.0; 3]), &exact(&[1.0; 3]));
        let square = Polytope::from_box(&exact(&[0.0; 2]), &exact(&[1.0; 2]));
        assert_eq!((count(&cube), count(&square)), (12, 4));
    }
}
