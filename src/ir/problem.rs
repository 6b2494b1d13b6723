//! A whole problem: who moves where, what is in the way, what must happen.

use std::collections::BTreeMap;

use crate::entity::Table;
use crate::entity_id;
use crate::exact::Rational;
use crate::geometry::Polytope;
use crate::ir::{FormulaId, Formulas, Model, ModelId};

entity_id!(
    /// A region of interest.
    RegionId, "region"
);
entity_id!(
    /// An obstacle or a jammer.
    BlockerId, "blocker"
);
entity_id!(
    /// A base station.
    BaseId, "base"
);
entity_id!(
    /// A robot.
    RobotId, "robot"
);

/// A mission, lowered: everything that the planner and the checker need to know.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// The mission's name.
    pub name: String,
    /// The mission's `//!` documentation, empty when there is none.
    pub doc: String,
    /// SHA-256 of the source text, in lower-case hexadecimal.
    pub sha256: String,
    /// The `--set` assignments as written on the command line, by parameter name.
    pub set: BTreeMap<String, String>,
    /// 2 or 3.
    pub dimension: usize,
    /// The sampling time in seconds.
    pub step: Rational,
    /// 𝒲.
    pub workspace: Polytope,
    /// The regions of interest, members of families as `name[i]` or `name[i,j]`.
    pub regions: Table<RegionId, Region>,
    /// Obstacles and jammers, in order of declaration.
    pub blockers: Table<BlockerId, Blocker>,
    /// The base stations.
    pub bases: Table<BaseId, Base>,
    /// The dynamics models in use by at least one robot.
    pub models: Table<ModelId, Model>,
    /// The robots.
    pub robots: Table<RobotId, Robot>,
    /// ε, in metres; `None` when no separation is required.
    pub separation: Option<Rational>,
    /// What is required of links; `None` with `connectivity none`.
    pub connectivity: Option<Connectivity>,
    /// The lengths L that may be tried, both ends included.
    pub horizon: (usize, usize),
    /// What to minimise among plans of the first feasible length.
    pub objective: Option<Objective>,
    /// All subformulas of the goals, in negation normal form.
    pub formulas: Formulas,
    /// The goals; ψ is their conjunction.
    pub goals: Vec<Goal>,
}

/// A union of convex pieces, in the order of the operands of `or`.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// At least one piece.
    pub pieces: Vec<Piece>,
}

/// A closed convex set with an interior.
#[derive(Clone, Debug, PartialEq)]
pub enum Piece {
    /// A bounded polytope.
    Polytope(Polytope),
    /// The Euclidean ball of every centre in a box: box(center ± spread) ⊕ ball₂(radius).
    Ball {
        /// The middle of the box of centres.
        center: Vec<Rational>,
        /// The half-widths of the box of centres, zero when the centre is certain.
        spread: Vec<Rational>,
        /// The radius, its uncertainty included.
        radius: Rational,
    },
}

impl Piece {
    /// Whether a point may lie in the piece, given that a ball's centre may be uncertain.
    pub fn contains(&self, point: &[Rational]) -> bool {
        match self {
            Piece::Polytope(polytope) => polytope.contains(point),
            Piece::Ball { center, spread, radius } => {
                let beyond = |((p, c), s): ((&Rational, &Rational), &Rational)| {
                    let distance = (p - c).abs() - s;
                    if distance.is_negative() { Rational::ZERO } else { &distance * &distance }
                };
                let square: Rational = point.iter().zip(center).zip(spread).map(beyond).sum();
                square <= radius * radius
            }
        }
    }
}

/// A region of interest.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Its name in the mission.
    pub name: String,
    /// Its documentation, empty when there is none.
    pub doc: String,
    /// The set; every set that it may be, together, where it is uncertain.
    pub shape: Shape,
    /// What all sets that it may be have in common, where it is uncertain: a [`Piece::Ball`] is then
    /// the intersection of its balls, and there may be no piece at all.
    pub sure: Option<Shape>,
}

impl Region {
    /// Where a robot is certain to be in it.
    pub fn sure(&self) -> &Shape {
        self.sure.as_ref().unwrap_or(&self.shape)
    }
}

/// What stands in the way of robots, links or both.
#[derive(Clone, Debug, PartialEq)]
pub struct Blocker {
    /// Its name in the mission.
    pub name: String,
    /// Its documentation, empty when there is none.
    pub doc: String,
    /// Whether it is an obstacle or a jammer.
    pub kind: BlockerKind,
    /// The set.
    pub shape: Shape,
}

/// The kinds of blocker. All of them keep robots out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlockerKind {
    /// Links may cross it.
    Obstacle,
    /// No link may cross it.
    OpaqueObstacle,
    /// No link may cross it.
    Jammer,
}

impl BlockerKind {
    /// Whether no link may cross it.
    pub fn blocks_links(self) -> bool {
        !matches!(self, BlockerKind::Obstacle)
    }
}

/// A stationary base station.
#[derive(Clone, Debug, PartialEq)]
pub struct Base {
    /// Its name in the mission.
    pub name: String,
    /// Its documentation, empty when there is none.
    pub doc: String,
    /// Its coordinates, in metres.
    pub position: Vec<Rational>,
}

/// A robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    /// Its name in the mission, members of families as `fleet[1]`.
    pub name: String,
    /// Its documentation, empty when there is none.
    pub doc: String,
    /// Its dynamics.
    pub model: ModelId,
    /// x̄₀, one entry a state.
    pub start: Vec<Rational>,
}

/// What `connectivity` asks.
#[derive(Clone, Debug, PartialEq)]
pub struct Connectivity {
    /// The most links on a path to a base; `None` for any number.
    pub hops: Option<u32>,
    /// The longest link.
    pub range: Option<Range>,
    /// How many robots may drop out, 0 to 3.
    pub redundancy: u32,
    /// Required at the times t ≡ 0 modulo this many steps; at least 1.
    pub every: u32,
}

/// The longest link.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// In metres.
    pub length: Rational,
    /// How it is measured.
    pub norm: Norm,
}

/// A norm on the workspace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Norm {
    /// The ∞-norm.
    Infinity,
    /// The Euclidean norm.
    Euclidean,
}

/// What `minimize` asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Objective {
    /// Σ_robots Σ_{t=0..L} ‖v_t‖₂²
    Effort,
    /// Σ_robots Σ ‖p_{t+1} − p_t‖_∞, the closing step included
    Length,
}

/// A named part of the specification.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// Its name in the mission.
    pub name: String,
    /// Its formula.
    pub formula: FormulaId,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disc_holds_its_edge_and_not_the_corners_of_its_box() {
        let point = |x: i64, y: i64| vec![Rational::from(x), Rational::from(y)];
        let disc = |spread: i64| Piece::Ball {
            center: point(0, 0),
            spread: point(spread, spread),
            radius: Rational::from(5),
        };
        assert!(disc(0).contains(&point(3, 4)));
        assert!(!disc(0).contains(&point(4, 4)));
        assert!(disc(1).contains(&point(4, 4)));
        assert!(!disc(1).contains(&point(5, 5)));
    }
}
