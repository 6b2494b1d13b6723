//! Convex polytopes in half-space and vertex form.

use crate::exact::{Rational, dot};

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
}

/// A bounded convex polytope with an interior, in both forms.
///
/// Both lists are irredundant. In the plane they run counter-clockwise, and facet `i` joins
/// vertex `i` and vertex `i + 1`.
#[derive(Clone, Debug, PartialEq)]
pub struct Polytope {
    /// The facets.
    pub facets: Vec<HalfSpace>,
    /// The vertices.
    pub vertices: Vec<Vec<Rational>>,
}
