//! Convex geometry in two and three dimensions, exact unless a name says otherwise.

mod polytope;

pub use polytope::{HalfSpace, Polytope};
