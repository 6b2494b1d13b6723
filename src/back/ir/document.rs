//! What an IR file says, key by key.
//!
//! These are the format's own types: the IR may change without it, and it only with its version.
//! Their comments are the descriptions in the format's schema.

use std::collections::BTreeMap;

use serde::{Deserialize, Deserializer, Serialize};

use super::number::Number;

/// A mission with nothing left but what it means: SI units, exact numbers, names resolved, families
/// written out. Entities are called by their place in their list, from 0. Every key is always there,
/// `null` where there is nothing; readers ignore keys that they don't know.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(title = "NAME.ir.json"))]
pub struct Document {
    /// Always `dosm-ir`.
    #[cfg_attr(test, schemars(extend("const" = super::FORMAT)))]
    pub format: String,
    /// The version of the format.
    #[cfg_attr(test, schemars(extend("const" = super::VERSION)))]
    pub version: u32,
    /// The program that wrote the file.
    pub tool: String,
    /// What the file was made from.
    pub mission: Mission,
    /// The number of coordinates of the workspace: 2 or 3.
    #[cfg_attr(test, schemars(extend("enum" = [2, 3])))]
    pub dimension: usize,
    /// The sampling time in seconds.
    pub step_s: Number,
    /// Where robots may be.
    pub workspace: Polytope,
    /// The regions of interest; members of families are called `name[1]`, `name[2,1]`.
    pub regions: Vec<Region>,
    /// Obstacles and jammers.
    pub blockers: Vec<Blocker>,
    /// The stationary base stations.
    pub bases: Vec<Base>,
    /// The dynamics models that some robot uses.
    pub models: Vec<Model>,
    /// The robots.
    pub robots: Vec<Robot>,
    /// How far apart robots must stay in some coordinate, in metres.
    #[serde(deserialize_with = "present")]
    pub separation: Option<Number>,
    /// What is required of radio links.
    #[serde(deserialize_with = "present")]
    pub connectivity: Option<Connectivity>,
    /// The lengths of plans that may be tried.
    pub horizon: Horizon,
    /// What to minimise among plans of the shortest length.
    #[serde(deserialize_with = "present")]
    pub objective: Option<Objective>,
    /// All subformulas of the goals in negation normal form, operands before their users, each once.
    pub formulas: Vec<Formula>,
    /// The goals, all of which must hold.
    pub goals: Vec<Goal>,
}

/// What the file was made from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Mission {
    /// The mission's name.
    pub name: String,
    /// Its documentation, empty when there is none.
    pub doc: String,
    /// SHA-256 of the source text, in lower-case hexadecimal.
    #[cfg_attr(test, schemars(regex(pattern = "^[0-9a-f]{64}$")))]
    pub sha256: String,
    /// The `--set` assignments as written on the command line, by parameter name.
    pub set: BTreeMap<String, String>,
}

/// A bounded convex polytope with an interior, in both forms, neither with anything redundant. In the
/// plane both lists run counter-clockwise, and facet i joins vertices i and i + 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Polytope {
    /// The vertices, one number a coordinate, in metres.
    pub vertices: Vec<Vec<Number>>,
    /// The facets.
    pub facets: Vec<HalfSpace>,
}

/// The half-space normal · x ≤ offset.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct HalfSpace {
    /// The outward normal, not zero; of a polytope's facet: whole numbers without a common divisor over
    /// the power of two that brings the largest into (1/2, 1].
    pub normal: Vec<Number>,
    /// The offset.
    pub offset: Number,
}

/// A closed convex set with an interior.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Piece {
    /// A bounded polytope, as the workspace is one.
    Polytope {
        /// The vertices, one number a coordinate, in metres.
        vertices: Vec<Vec<Number>>,
        /// The facets.
        facets: Vec<HalfSpace>,
    },
    /// The Euclidean ball of every centre in a box: box(center ± spread) ⊕ ball(radius).
    Ball {
        /// The middle of the box of centres.
        center: Vec<Number>,
        /// The half-widths of the box of centres, 0 when the centre is certain.
        spread: Vec<Number>,
        /// The radius, its uncertainty included.
        radius: Number,
    },
}

/// A region of interest: the union of its pieces.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Region {
    /// Its name in the mission.
    pub name: String,
    /// Its documentation, empty when there is none.
    pub doc: String,
    /// At least one convex piece, in the order of the operands of `or`; of an uncertain ball, all
    /// that it may be.
    pub pieces: Vec<Piece>,
    /// Where balls are uncertain: what is in the region for certain. Of an uncertain Euclidean ball
    /// that is the intersection of all balls with their centre in the box.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sure: Option<Vec<Piece>>,
}

/// What keeps robots out, and links too unless it is an obstacle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Blocker {
    /// Its name in the mission.
    pub name: String,
    /// Its documentation, empty when there is none.
    pub doc: String,
    /// What it is.
    pub kind: BlockerKind,
    /// At least one convex piece, in the order of the operands of `or`.
    pub pieces: Vec<Piece>,
}

/// The kinds of blocker.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum BlockerKind {
    /// Links may cross it.
    Obstacle,
    /// No link may cross it.
    OpaqueObstacle,
    /// No link may cross it.
    Jammer,
}

/// A stationary base station.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Base {
    /// Its name in the mission.
    pub name: String,
    /// Its documentation, empty when there is none.
    pub doc: String,
    /// Its coordinates, in metres.
    pub position: Vec<Number>,
}

/// A dynamics model with n states and m inputs: x⁺ = A x + B u + c + w.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Model {
    /// Its name in the mission.
    pub name: String,
    /// Its documentation, empty when there is none.
    pub doc: String,
    /// The n states, in order.
    pub states: Vec<State>,
    /// The m inputs, in order.
    pub inputs: Vec<Input>,
    /// Which states are the workspace's coordinates, one an axis.
    pub position: Vec<usize>,
    /// A, n rows of n numbers.
    #[serde(rename = "A")]
    pub a: Vec<Vec<Number>>,
    /// B, n rows of m numbers.
    #[serde(rename = "B")]
    pub b: Vec<Vec<Number>>,
    /// c, n numbers.
    pub c: Vec<Number>,
    /// How far the true A, B and c may be from those above, entry by entry; `null` when they are exact.
    #[serde(deserialize_with = "present")]
    pub enclosure: Option<Enclosure>,
    /// Bounds on states and inputs together: half-spaces over (x, u), n + m numbers each.
    pub mixed_bounds: Vec<HalfSpace>,
    /// The share of the inputs that the feedback may use, between 0 and 1; `null` leaves it to the
    /// planner.
    #[serde(deserialize_with = "present")]
    pub rejection: Option<Number>,
}

/// A state of a model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct State {
    /// Its name in the mission.
    pub name: String,
    /// Its documentation, empty when there is none.
    pub doc: String,
    /// Its coherent SI unit, `1` when it has none.
    pub unit: String,
    /// Its bounds; `null` where there are none.
    #[serde(deserialize_with = "present")]
    pub bounds: Option<Interval>,
    /// What the disturbance may add at each step.
    pub disturbance: Interval,
}

/// An input of a model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Input {
    /// Its name in the mission.
    pub name: String,
    /// Its documentation, empty when there is none.
    pub doc: String,
    /// Its coherent SI unit, `1` when it has none.
    pub unit: String,
    /// Its bounds.
    pub bounds: Interval,
}

/// A closed interval.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Interval {
    /// The lower end.
    pub lo: Number,
    /// The upper end.
    pub hi: Number,
}

/// Entrywise bounds on the error of A, B and c, of the same sizes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Enclosure {
    /// |ΔA|
    #[serde(rename = "A")]
    pub a: Vec<Vec<Number>>,
    /// |ΔB|
    #[serde(rename = "B")]
    pub b: Vec<Vec<Number>>,
    /// |Δc|
    pub c: Vec<Number>,
}

/// A robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Robot {
    /// Its name in the mission; members of families are called `fleet[1]`.
    pub name: String,
    /// Its documentation, empty when there is none.
    pub doc: String,
    /// Its model's place in `models`.
    pub model: usize,
    /// Where it starts, one number a state.
    pub start: Vec<Number>,
}

/// What is required of radio links.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Connectivity {
    /// The most links on a robot's path to a base; `null` for any number.
    #[serde(deserialize_with = "present")]
    pub hops: Option<u32>,
    /// The longest link; `null` for any length.
    #[serde(deserialize_with = "present")]
    pub range: Option<Range>,
    /// How many robots may drop out, 0 to 3.
    pub redundancy: u32,
    /// Required at every so many steps, from step 0 on; at least 1.
    pub every: u32,
}

/// The longest link.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Range {
    /// In metres.
    pub length: Number,
    /// How it is measured.
    pub norm: Norm,
}

/// A norm on the workspace.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Norm {
    /// The ∞-norm.
    Infinity,
    /// The Euclidean norm.
    Euclidean,
}

/// The lengths of plans that may be tried, both ends included.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Horizon {
    /// The shortest, at least 1.
    pub from: usize,
    /// The longest.
    pub to: usize,
}

/// What to minimise among plans of the shortest length L.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Objective {
    /// The sum of the squared Euclidean norms of all nominal inputs.
    Effort,
    /// The sum of the ∞-norms of all nominal steps, the closing one included.
    Length,
}

/// A temporal formula over the runs of all robots; operands are called by their place in `formulas`,
/// before the formula itself. A window [m, n] counts steps, `null` stands for [0, ∞).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(tag = "op", rename_all = "snake_case")]
pub enum Formula {
    /// Holds always.
    True,
    /// Never holds.
    False,
    /// The robot is certainly in the region.
    In {
        /// The robot's place in `robots`.
        robot: usize,
        /// The region's place in `regions`.
        region: usize,
    },
    /// The robot is certainly out of the region.
    Out {
        /// The robot's place in `robots`.
        robot: usize,
        /// The region's place in `regions`.
        region: usize,
    },
    /// The sum of the coefficients of the robots that are in their regions compares with the bound,
    /// whatever the uncertain ones are.
    Compare {
        /// The terms, sorted by robot and region, each pair once.
        terms: Vec<Term>,
        /// How to compare.
        relation: Relation,
        /// The right-hand side.
        bound: i64,
    },
    /// All operands hold.
    And {
        /// The operands.
        operands: Vec<usize>,
    },
    /// Some operand holds.
    Or {
        /// The operands.
        operands: Vec<usize>,
    },
    /// The operand holds at the next step.
    Next {
        /// The operand.
        operand: usize,
    },
    /// Some d in the window: `then` holds at t + d, and `hold` at t … t + d − 1.
    Until {
        /// The window.
        #[serde(deserialize_with = "present")]
        window: Option<[u32; 2]>,
        /// What holds until then.
        hold: usize,
        /// What comes then.
        then: usize,
    },
    /// Each d in the window: `hold` holds at t + d, or `release` at some of t … t + d − 1.
    Release {
        /// The window.
        #[serde(deserialize_with = "present")]
        window: Option<[u32; 2]>,
        /// What ends the duty.
        release: usize,
        /// The duty.
        hold: usize,
    },
}

/// A term of a comparison.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Term {
    /// The coefficient, not 0.
    pub coefficient: i64,
    /// The robot's place in `robots`.
    pub robot: usize,
    /// The region's place in `regions`.
    pub region: usize,
}

/// How a sum compares with its bound.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub enum Relation {
    /// Equal.
    #[serde(rename = "=")]
    Equal,
    /// Not equal.
    #[serde(rename = "!=")]
    NotEqual,
    /// At least.
    #[serde(rename = ">=")]
    AtLeast,
    /// At most.
    #[serde(rename = "<=")]
    AtMost,
}

/// A named part of the specification.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Goal {
    /// Its name in the mission.
    pub name: String,
    /// Its formula's place in `formulas`.
    pub formula: usize,
}

/// A value that may be `null` but not left out.
fn present<'de, D: Deserializer<'de>, T: Deserialize<'de>>(deserializer: D) -> Result<Option<T>, D::Error> {
    Option::deserialize(deserializer)
}
