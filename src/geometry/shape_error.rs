//! Why points or half-spaces do not make a polytope.

use crate::exact::Rational;

/// The reason why a shape is refused. Indices are those of the points as they were given.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShapeError {
    /// The points or normals do not all have the same number of coordinates, 2 or 3.
    #[error("the points do not all have the same 2 or 3 coordinates")]
    Dimension,
    /// Fewer points than a polytope has at least.
    #[error("too few points")]
    TooFewPoints,
    /// Two equal points.
    #[error("points {first} and {second} are the same")]
    Duplicate {
        /// The index of the first one.
        first: usize,
        /// The index of its repetition.
        second: usize,
    },
    /// A corner where the boundary turns the wrong way, runs back or crosses itself.
    #[error("not convex at point {corner}")]
    NotConvex {
        /// The index of the corner.
        corner: usize,
    },
    /// All points lie on one line (in 3-D: on one plane).
    #[error("the shape is flat")]
    Flat,
    /// No point satisfies all the inequalities.
    #[error("the shape is empty")]
    Empty,
    /// The shape goes on for ever.
    #[error("the shape is unbounded")]
    Unbounded {
        /// A direction in which it does.
        direction: Vec<Rational>,
    },
    /// An inequality with a zero normal.
    #[error("inequality {index} has no coordinate in it")]
    ZeroNormal {
        /// Its index.
        index: usize,
    },
    /// More inequalities than the exact enumeration can work through.
    #[error("too many inequalities: more than {most}")]
    TooMany {
        /// The most there may be.
        most: usize,
    },
}
