//! Convex polytopes in half-space and vertex form.

use crate::exact::{Rational, dot, primitive};
use crate::geometry::{ShapeError, half_spaces, hull};

/// The half-space {x : normal · x ≤ offset}.
#[derive(Clone, Debug, PartialEq)]
pub struct HalfSpace {
    /// The outward normal, not zero.
    pub normal: Vec<Rational>,
    /// The offset.
    pub offset: Rational,
}

impl HalfSpace {
    /// Whether the point lies in the closed half-space.
    pub fn contains(&self, point: &[Rational]) -> bool {
        dot(&self.normal, point) <= self.offset
    }

    /// Whether the point lies in the open half-space.
    pub fn contains_interior(&self, point: &[Rational]) -> bool {
        dot(&self.normal, point) < self.offset
    }

    /// The same half-space with the canonical normal of its direction: whole numbers without a
    /// common divisor, over the power of two that brings the largest of them into (½, 1].
    ///
    /// Parallel half-spaces then have equal normals, and these are doubles wherever the whole
    /// numbers are below 2⁵³.
    pub fn normalised(&self) -> HalfSpace {
        let mut normal = primitive(&self.normal);
        let largest = normal.iter().map(Rational::abs).max().unwrap_or(Rational::ONE);
        let (two, mut power) = (Rational::from(2), Rational::ONE);
        while power < largest {
            power *= &two;
        }
        normal.iter_mut().for_each(|x| *x = &*x / &power);
        let axis = normal.iter().position(|x| !x.is_zero());
        let scale = axis.map_or(Rational::ONE, |i| &normal[i] / &self.normal[i]);
        HalfSpace { offset: &self.offset * scale, normal }
    }
}

/// A bounded convex polytope with an interior, in both forms.
///
/// Both lists are irredundant. In the plane they run counter-clockwise, and facet `i` joins
/// vertex `i` and vertex `i + 1`. Normals are [`HalfSpace::normalised`].
#[derive(Clone, Debug, PartialEq)]
pub struct Polytope {
    /// The facets.
    pub facets: Vec<HalfSpace>,
    /// The vertices.
    pub vertices: Vec<Vec<Rational>>,
}

impl Polytope {
    /// The axis-aligned box with opposite corners `lo` and `hi`; the caller makes sure that
    /// `lo < hi` in each coordinate.
    ///
    /// In the plane the vertices start at `lo`; in 3-D they are sorted.
    pub fn from_box(lo: &[Rational], hi: &[Rational]) -> Polytope {
        debug_assert!(lo.len() == hi.len() && lo.iter().zip(hi).all(|(l, h)| l < h));
        let d = lo.len();
        if d == 2 {
            let (l, h) = (lo, hi);
            let corners = [[&l[0], &l[1]], [&h[0], &l[1]], [&h[0], &h[1]], [&l[0], &h[1]]];
            return hull::counter_clockwise(corners.map(|c| c.map(Clone::clone).to_vec()).to_vec());
        }
        let corner = |k: usize| (0..d).map(move |i| if k >> (d - 1 - i) & 1 == 0 { &lo[i] } else { &hi[i] });
        let facet = |i: usize, sign: i64, bound: &Rational| {
            let mut normal = vec![Rational::ZERO; d];
            normal[i] = Rational::from(sign);
            HalfSpace { normal, offset: bound * Rational::from(sign) }
        };
        Polytope {
            facets: (0..d).flat_map(|i| [facet(i, -1, &lo[i]), facet(i, 1, &hi[i])]).collect(),
            vertices: (0..1usize << d).map(|k| corner(k).cloned().collect()).collect(),
        }
    }

    /// The convex polygon with these corners, given in either orientation; corners on a straight
    /// edge are dropped.
    ///
    /// # Errors
    /// Too few or equal points, a corner where the outline is not convex (self-crossing outlines
    /// included), or a flat outline.
    pub fn polygon(points: &[Vec<Rational>]) -> Result<Polytope, ShapeError> {
        hull::polygon(points)
    }

    /// The convex hull of points in the plane or in space.
    ///
    /// # Errors
    /// [`ShapeError::TooFewPoints`], [`ShapeError::Flat`] or [`ShapeError::Dimension`].
    pub fn hull(points: &[Vec<Rational>]) -> Result<Polytope, ShapeError> {
        hull::hull(points)
    }

    /// The intersection of half-spaces over 2 or 3 coordinates.
    ///
    /// # Errors
    /// When it is empty, flat or unbounded, a normal is zero, or there are too many.
    pub fn from_half_spaces(half_spaces: &[HalfSpace]) -> Result<Polytope, ShapeError> {
        half_spaces::intersection(half_spaces)
    }

    /// The number of coordinates.
    pub fn dimension(&self) -> usize {
        self.vertices.first().map_or(0, Vec::len)
    }

    /// Whether the point lies in the closed polytope.
    pub fn contains(&self, point: &[Rational]) -> bool {
        self.facets.iter().all(|f| f.contains(point))
    }

    /// Whether the point lies in the polytope's interior.
    pub fn contains_interior(&self, point: &[Rational]) -> bool {
        self.facets.iter().all(|f| f.contains_interior(point))
    }

    /// The support max {direction · x}, exactly.
    pub fn support(&self, direction: &[Rational]) -> Rational {
        self.vertices.iter().map(|v| dot(direction, v)).max().unwrap_or(Rational::ZERO)
    }

    /// The least box around the polytope, as its two corners.
    pub fn bounding_box(&self) -> (Vec<Rational>, Vec<Rational>) {
        let along = |i: usize| self.vertices.iter().map(move |v| v[i].clone());
        let axes = 0..self.dimension();
        let lo = axes.clone().filter_map(|i| along(i).min()).collect();
        (lo, axes.filter_map(|i| along(i).max()).collect())
    }

    /// The mean of the vertices, a point of the interior.
    pub fn middle(&self) -> Vec<Rational> {
        let count = Rational::from(self.vertices.len() as i64);
        let sum = |i: usize| self.vertices.iter().map(|v| &v[i]).sum::<Rational>();
        (0..self.dimension()).map(|i| sum(i) / &count).collect()
    }

    /// Whether the two closed polytopes have a point in common, touching included.
    pub fn intersects(&self, other: &Polytope) -> bool {
        if self.dimension() == 2 {
            return !self.has_separating_facet(other, |a, b| a < b)
                && !other.has_separating_facet(self, |a, b| a < b);
        }
        self.difference(other).is_ok_and(|d| d.contains(&vec![Rational::ZERO; self.dimension()]))
    }

    /// Whether the two polytopes' interiors have a point in common.
    pub fn overlaps(&self, other: &Polytope) -> bool {
        if self.dimension() == 2 {
            return !self.has_separating_facet(other, |a, b| a <= b)
                && !other.has_separating_facet(self, |a, b| a <= b);
        }
        self.difference(other).is_ok_and(|d| d.contains_interior(&vec![Rational::ZERO; self.dimension()]))
    }

    /// Whether some facet of this one has the whole other polytope beyond it.
    fn has_separating_facet(&self, other: &Polytope, apart: fn(&Rational, &Rational) -> bool) -> bool {
        self.facets.iter().any(|f| other.vertices.iter().all(|v| apart(&f.offset, &dot(&f.normal, v))))
    }

    /// {a − b : a in this polytope, b in the other}.
    fn difference(&self, other: &Polytope) -> Result<Polytope, ShapeError> {
        let minus = |a: &[Rational], b: &[Rational]| a.iter().zip(b).map(|(x, y)| x - y).collect();
        let pairs = self.vertices.iter().flat_map(|a| other.vertices.iter().map(move |b| minus(a, b)));
        Polytope::hull(&pairs.collect::<Vec<_>>())
    }

    /// The polytope moved by `offset`.
    pub fn translate(&self, offset: &[Rational]) -> Polytope {
        let facet = |f: &HalfSpace| HalfSpace {
            normal: f.normal.clone(),
            offset: &f.offset + dot(&f.normal, offset),
        };
        let vertex = |v: &Vec<Rational>| v.iter().zip(offset).map(|(x, o)| x + o).collect();
        Polytope {
            facets: self.facets.iter().map(facet).collect(),
            vertices: self.vertices.iter().map(vertex).collect(),
        }
    }

    /// The Minkowski sum with the box of these half-widths, none negative; zero ones add nothing.
    pub fn widened(&self, half_widths: &[Rational]) -> Polytope {
        let mut widened = self.clone();
        for (axis, half_width) in half_widths.iter().enumerate().filter(|(_, h)| !h.is_zero()) {
            let mut step = vec![Rational::ZERO; self.dimension()];
            step[axis] = half_width.clone();
            let back: Vec<Rational> = step.iter().map(|x| -x).collect();
            let mut points = widened.translate(&step).vertices;
            points.extend(widened.translate(&back).vertices);
            // The hull of more than a polytope with an interior has one, too.
            widened = Polytope::hull(&points).unwrap_or(widened);
        }
        widened
    }

    /// The squared Euclidean distance of a point from the polytope, exactly; 0 inside.
    pub fn squared_distance(&self, point: &[Rational]) -> Rational {
        super::distance::squared_distance(self, point)
    }

    /// Whether this polytope lies in the closed `outer` one.
    pub fn is_inside(&self, outer: &Polytope) -> bool {
        self.vertices.iter().all(|v| outer.contains(v))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn p(x: i64, y: i64) -> Vec<Rational> {
        vec![Rational::from(x), Rational::from(y)]
    }

    fn square(x: i64, y: i64, side: i64) -> Polytope {
        Polytope::from_box(&p(x, y), &p(x + side, y + side))
    }

    #[test]
    fn a_box_runs_counter_clockwise_with_facets_between_neighbours() {
        let b = Polytope::from_box(&p(0, 1), &p(2, 4));
        assert_eq!(b.vertices, [p(0, 1), p(2, 1), p(2, 4), p(0, 4)]);
        let normals: Vec<_> = b.facets.iter().map(|f| f.normal.clone()).collect();
        assert_eq!(normals, [p(0, -1), p(1, 0), p(0, 1), p(-1, 0)]);
        for (i, f) in b.facets.iter().enumerate() {
            assert_eq!(dot(&f.normal, &b.vertices[i]), f.offset);
            assert_eq!(dot(&f.normal, &b.vertices[(i + 1) % 4]), f.offset);
        }
    }

    #[test]
    fn a_box_in_space_has_six_facets_and_eight_vertices() {
        let at = |x: i64| vec![Rational::from(x); 3];
        let b = Polytope::from_box(&at(0), &at(2));
        assert_eq!((b.facets.len(), b.vertices.len()), (6, 8));
        assert!(b.contains_interior(&at(1)) && b.contains(&at(2)) && !b.contains_interior(&at(2)));
        assert_eq!(b.support(&at(1)), Rational::from(6));
        assert_eq!(Polytope::hull(&b.vertices).unwrap().facets.len(), 6);
        assert!(b.intersects(&b.translate(&at(2))) && !b.overlaps(&b.translate(&at(2))));
        assert!(!b.intersects(&b.translate(&at(3))));
    }

    #[test]
    fn touching_squares_meet_but_do_not_overlap() {
        let a = square(0, 0, 2);
        assert!(a.intersects(&square(2, 2, 1)) && !a.overlaps(&square(2, 2, 1)));
        assert!(a.intersects(&square(1, 1, 3)) && a.overlaps(&square(1, 1, 3)));
        assert!(!a.intersects(&square(3, 0, 1)));
        assert!(square(1, 1, 1).is_inside(&a) && !square(1, 1, 2).is_inside(&a));
    }

    #[test]
    fn a_diamond_is_separated_by_its_own_facet_only() {
        let diamond = Polytope::polygon(&[p(0, -2), p(2, 0), p(0, 2), p(-2, 0)]).unwrap();
        let box_ = Polytope::from_box(&[Rational::ratio(3, 2), Rational::ratio(3, 2)], &p(2, 2));
        assert!(!diamond.intersects(&box_) && !box_.intersects(&diamond));
        assert_eq!(diamond.support(&p(3, 1)), Rational::from(6));
        assert_eq!(diamond.bounding_box(), (p(-2, -2), p(2, 2)));
    }

    #[test]
    fn parallel_half_spaces_have_equal_normals() {
        let h = |a: i64, b: i64, d: i64| HalfSpace {
            normal: vec![Rational::ratio(a, d), Rational::ratio(b, d)],
            offset: Rational::from(5),
        };
        assert_eq!(h(3, -7, 10).normalised().normal, h(6, -14, 1).normalised().normal);
        assert_eq!(h(3, -7, 10).normalised().normal, [Rational::ratio(3, 8), Rational::ratio(-7, 8)]);
        assert_eq!(h(3, -7, 8).normalised().offset, Rational::from(5));
        assert_eq!(h(2, 0, 1).normalised(), HalfSpace { normal: p(1, 0), offset: Rational::ratio(5, 2) });
    }
}
