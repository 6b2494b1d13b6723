//! Which parts of the free space a robot can get to at all.
//!
//! Between two samples the chord of a robot's nominal positions misses every blocker inflated by the
//! robot's tube, so the whole nominal path is a curve in the free space. If start and region lie in
//! different components, no plan of any length exists, which no bounded search could find out.
//!
//! Doubtful places count as free: rounding and coarseness can hide that a region is cut off, but not
//! cut one off.

mod plane;
mod space;

use super::{Abstraction, HalfSpace};
use crate::ir::ModelId;
use plane::Plane;
use space::Space;

/// Lengths below this share of the workspace's size count as none.
const TOUCH: f64 = 1e-9;

/// The components of a model's free space.
#[derive(Clone, Debug)]
pub struct Passage(Kind);

#[derive(Clone, Debug)]
enum Kind {
    Plane(Plane),
    Space(Space),
}

impl Passage {
    /// The free space of a model's nominal positions; `None` in space where that would take too many
    /// cells.
    pub fn new(abstraction: &Abstraction, model: ModelId) -> Option<Passage> {
        if abstraction.dimension == 2 {
            return Some(Passage(Kind::Plane(Plane::new(abstraction, model))));
        }
        Some(Passage(Kind::Space(Space::new(abstraction, model)?)))
    }

    /// Whether some point of a convex set, given by half-spaces, may lie in the component of a point.
    pub fn connects(&self, abstraction: &Abstraction, from: &[f64], region: &[HalfSpace]) -> bool {
        match &self.0 {
            Kind::Plane(plane) => plane.connects(abstraction, from, region),
            Kind::Space(space) => space.connects(abstraction, from, region),
        }
    }
}
