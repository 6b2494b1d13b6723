//! Convex geometry in two and three dimensions, exact unless a name says otherwise.
//!
//! [`Polytope`] is the workhorse: built from boxes, corners, points or half-spaces, always with an
//! interior and in both forms. [`Zonotope`] has the supports of tubes, rounded outwards.

mod distance;
mod elimination;
mod half_spaces;
mod hull;
mod polytope;
mod shape_error;
mod zonotope;

pub use elimination::{null_space, rank, solve};
pub use polytope::{HalfSpace, Polytope};
pub use shape_error::ShapeError;
pub use zonotope::Zonotope;
