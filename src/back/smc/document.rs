//! What an instance file says, key by key.
//!
//! These are the format's own types: the encoding may change without it, and it only with its
//! version. Their comments are the descriptions in the format's schema.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// A mission as clauses and linear rows: a plan of one of the lengths exists, with separating planes
/// of the directions used, just when under the length's literal some assignment of the Boolean
/// variables satisfies all clauses and, with it, some values of the real variables satisfy all blocks
/// that have no literal or a true one. Boolean variables are numbered from 1, a negative number is a
/// negated literal; real variables are called by their place in their list, from 0. All numbers are
/// doubles that read back exactly. Readers ignore keys that they don't know.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Document {
    /// Always `dosm-smc`.
    #[cfg_attr(test, schemars(extend("const" = super::FORMAT)))]
    pub format: String,
    /// The version of the format.
    #[cfg_attr(test, schemars(extend("const" = super::VERSION)))]
    pub version: u32,
    /// The program that wrote the file.
    pub tool: String,
    /// What the file was made from.
    pub mission: Mission,
    /// How the workspace is encoded: `half-spaces`, or `paper` for the cells of a partition.
    #[cfg_attr(test, schemars(extend("enum" = ["half-spaces", "paper"])))]
    pub encoding: String,
    /// The tubes, one a dynamics model.
    pub tubes: Vec<Tube>,
    /// The half-spaces of nominal positions that literals stand for.
    pub half_spaces: Vec<HalfSpace>,
    /// With the encoding `paper`: the cells of all models' partitions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cells: Option<Vec<Cell>>,
    /// The lengths that may be asked for, rising.
    pub lengths: Vec<Length>,
    /// The Boolean part.
    pub cnf: Cnf,
    /// The convex part.
    pub convex: Convex,
    /// What Boolean variables stand for; those that are not listed are parts of formulas.
    pub map: Map,
}

/// What the file was made from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Mission {
    /// The mission's name.
    pub name: String,
    /// SHA-256 of the source text, in lower-case hexadecimal.
    pub sha256: String,
    /// The source text.
    pub source: String,
    /// The `--set` assignments as written on the command line, by parameter name.
    pub set: BTreeMap<String, String>,
}

/// The tube around a nominal trajectory of a model with n states and m inputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Tube {
    /// The model's name.
    pub dynamics: String,
    /// The box that everything unexplained is assumed to stay in.
    pub disturbance: Disturbance,
    /// The part of the box that is kept for the controller's rounding, n numbers.
    pub reserve: Vec<f64>,
    /// The share of the inputs that the feedback was allowed.
    pub beta: f64,
    /// K matrices, n × n: how the error remembers disturbances.
    #[serde(rename = "D")]
    pub d: Vec<Vec<Vec<f64>>>,
    /// K matrices, m × n: how the feedback answers them.
    #[serde(rename = "M")]
    pub m: Vec<Vec<Vec<f64>>>,
}

/// A box, n numbers each.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Disturbance {
    /// Its middle.
    pub center: Vec<f64>,
    /// Its half-widths.
    pub half_width: Vec<f64>,
}

/// The half-space direction · position ≤ offset.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct HalfSpace {
    /// The model whose tube the offset takes into account.
    pub dynamics: String,
    /// A unit vector, one number a coordinate.
    pub direction: Vec<f64>,
    /// The offset in metres.
    pub offset: f64,
}

/// A convex cell of nominal positions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Cell {
    /// The model whose free space it is a part of.
    pub dynamics: String,
    /// The half-spaces whose intersection it is, as half-spaces of their own: the encoding leaves out
    /// those that the workspace's bounds imply.
    pub facets: Vec<Facet>,
}

/// The half-space direction · position ≤ offset.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Facet {
    /// A unit vector, one number a coordinate.
    pub direction: Vec<f64>,
    /// The offset in metres.
    pub offset: f64,
}

/// A length with its assumption.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Length {
    /// L: the nominal states are z_0 … z_L.
    pub length: usize,
    /// The literal to assume.
    pub literal: i32,
}

/// Clauses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Cnf {
    /// The number of Boolean variables.
    pub vars: usize,
    /// The clauses.
    pub clauses: Vec<Vec<i32>>,
}

/// Rows over real variables.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Convex {
    /// The real variables: `R1.z[3].px` is a nominal state, `R1.v[3].ax` a nominal input.
    pub variables: Vec<String>,
    /// The rows, in blocks that hold together.
    pub blocks: Vec<Block>,
}

/// Rows that hold always, or where a literal is true.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Block {
    /// What it is about.
    pub name: String,
    /// The literal, `null` where the rows hold always.
    pub literal: Option<i32>,
    /// The rows.
    pub rows: Vec<Row>,
}

/// A linear row or a cone row.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum Row {
    /// A linear row.
    Linear(Linear),
    /// A row of a second-order cone.
    Cone(Cone),
}

/// Sums whose Euclidean norm is at most a bound.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Cone {
    /// The sums.
    pub norm: Vec<Sum>,
    /// The bound.
    pub bound: f64,
}

/// A sum of multiples of real variables and a constant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Sum {
    /// Pairs of a real variable and its coefficient.
    pub terms: Vec<(usize, f64)>,
    /// The constant.
    pub constant: f64,
}

/// A sum that equals a bound or is at most it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Linear {
    /// Pairs of a real variable and its coefficient.
    pub terms: Vec<(usize, f64)>,
    /// How the sum compares with the bound.
    pub relation: Relation,
    /// The bound.
    pub bound: f64,
}

/// How a sum compares with a bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub enum Relation {
    /// They are equal.
    #[serde(rename = "=")]
    Equal,
    /// The sum is at most the bound.
    #[serde(rename = "<=")]
    AtMost,
}

/// What Boolean variables stand for.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Map {
    /// A robot's nominal position lies in a half-space.
    pub half_spaces: Vec<InHalfSpace>,
    /// With the encoding `paper`: a robot is in a cell.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cells: Option<Vec<InCell>>,
    /// Two robots are apart along an axis, at a step and at the one after.
    pub faces: Vec<Face>,
    /// With a range in the ∞-norm: two robots are near each other along a normal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub near: Option<Vec<Near>>,
    /// Where the loop goes back to.
    pub loops: Vec<Loop>,
    /// Links.
    pub links: Vec<Link>,
}

/// A robot's nominal position lies in a half-space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct InHalfSpace {
    /// The literal.
    pub literal: i32,
    /// The robot's name.
    pub robot: String,
    /// The half-space's place in `half_spaces`.
    pub half_space: usize,
    /// The step.
    pub step: usize,
}

/// A robot is in a cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct InCell {
    /// The literal.
    pub literal: i32,
    /// The robot's name.
    pub robot: String,
    /// The cell's place in `cells`.
    pub cell: usize,
    /// The step.
    pub step: usize,
}

/// sign · (first − second)[axis] is at least the separation and both tubes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Face {
    /// The literal.
    pub literal: i32,
    /// The robots' names.
    pub pair: [String; 2],
    /// The axis, from 0.
    pub axis: usize,
    /// 1 or −1.
    #[cfg_attr(test, schemars(extend("enum" = [1, -1])))]
    pub sign: i32,
    /// The step.
    pub step: usize,
}

/// normal · (first − second) is at most the offset; with one robot, normal · first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Near {
    /// The literal.
    pub literal: i32,
    /// The robots' names, two or one.
    pub robots: Vec<String>,
    /// One number a coordinate of the workspace.
    pub normal: Vec<f64>,
    /// The offset in metres.
    pub offset: f64,
    /// The step.
    pub step: usize,
}

/// After the last state of this length comes an earlier one again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Loop {
    /// The literal.
    pub literal: i32,
    /// The length.
    pub length: usize,
    /// The step of the earlier state.
    pub loop_start: usize,
}

/// A link that is there, if its literal is true.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Link {
    /// The literal.
    pub literal: i32,
    /// A robot's name.
    pub from: String,
    /// A robot's or a base's name.
    pub to: String,
    /// The step.
    pub step: usize,
}
