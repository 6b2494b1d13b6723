//! What `plan.json` says, key by key: nothing but the source of its schema.
//!
//! The file itself is read and written by hand, to the digit; tests hold both against the schema.
#![allow(dead_code, reason = "only the schema is made of these")]

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Serialize;

/// A plan that carries its own proof: every "there is" in its claim comes with its witness. Numbers are
/// IEEE doubles, meant exactly as they stand; units are SI. States and inputs are in the order of their
/// declaration, steps run from 0 to L, a piece is the index of an operand of `or`, from 0, and members of
/// families are called `fleet[1]`, `J[2,1]`. Readers ignore keys that they don't know.
#[derive(Serialize, JsonSchema)]
#[schemars(title = "plan.json")]
pub struct Document {
    /// Always `dosm-plan`.
    #[schemars(extend("const" = super::FORMAT))]
    format: String,
    /// The version of the format.
    #[schemars(extend("const" = super::VERSION))]
    version: u64,
    /// The program that wrote the file.
    tool: String,
    /// What it is a plan of.
    mission: Mission,
    /// The sampling time in seconds.
    step_s: f64,
    /// L: the nominal states are z_0 … z_L.
    #[schemars(range(min = 1))]
    length: usize,
    /// After z_L comes the state of this step again.
    loop_start: usize,
    /// One tube a dynamics model.
    tubes: Vec<Tube>,
    /// One entry a robot.
    robots: Vec<Robot>,
    /// One list a step of the links that the plan relies on, enough that every robot reaches a base as
    /// `connectivity` asks, `[]` where none is required; `null` with `connectivity none`.
    links: Option<Vec<Vec<Link>>>,
    /// One list a step of what keeps each pair apart, then and at the step after; `[]` without
    /// `separation`.
    separation: Vec<Vec<Apart>>,
    /// What was minimised, `null` when nothing was.
    objective: Option<Objective>,
}

/// What a plan is a plan of.
#[derive(Serialize, JsonSchema)]
struct Mission {
    /// The mission's name.
    name: String,
    /// SHA-256 of the source text, in lower-case hexadecimal.
    #[schemars(regex(pattern = "^[0-9a-f]{64}$"))]
    sha256: String,
    /// The `--set` assignments as written on the command line, by parameter name.
    set: BTreeMap<String, String>,
}

/// The tube of a dynamics model with n states and m inputs: the error is Σ_i D_i ŵ_{t−1−i}, the feedback
/// Σ_i M_i ŵ_{t−1−i}, for disturbances ŵ in the box.
#[derive(Serialize, JsonSchema)]
struct Tube {
    /// The model's name.
    dynamics: String,
    /// The box of disturbances that the tube is made for.
    disturbance: Disturbance,
    /// The share of the box that is set aside for the controller's rounding, n numbers above 0.
    reserve: Vec<f64>,
    /// K matrices of n rows of n numbers; the first is the identity.
    #[serde(rename = "D")]
    d: Vec<Vec<Vec<f64>>>,
    /// K matrices of m rows of n numbers.
    #[serde(rename = "M")]
    m: Vec<Vec<Vec<f64>>>,
}

/// A box of disturbances.
#[derive(Serialize, JsonSchema)]
struct Disturbance {
    /// Its middle, n numbers.
    center: Vec<f64>,
    /// Its half-widths, n numbers.
    half_width: Vec<f64>,
}

/// The plan of one robot.
#[derive(Serialize, JsonSchema)]
struct Robot {
    /// The robot's name.
    name: String,
    /// Its dynamics model's name.
    dynamics: String,
    /// L + 1 nominal states of n numbers.
    z: Vec<Vec<f64>>,
    /// L + 1 nominal inputs of m numbers; the last leads back to `loop_start`.
    v: Vec<Vec<f64>>,
    /// For each region that the goals ask of this robot: what is certain at each step.
    regions: BTreeMap<String, Vec<Label>>,
    /// The witness of each `out`, one separator a piece; `null` at the other steps.
    outside: BTreeMap<String, Vec<Option<Vec<Separator>>>>,
    /// For each obstacle and jammer and each step, one separator a piece, which clears the state of the
    /// step and the one after it.
    clear: BTreeMap<String, Vec<Vec<Separator>>>,
}

/// A robot's certain relation to a region.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Label {
    /// Certainly in.
    In,
    /// Certainly out.
    Out,
    /// Neither is certain.
    Unknown,
}

/// A plane between a convex piece and what must miss it: normal · p < offset for every possible position p,
/// normal · q ≥ offset for every point q of the piece.
#[derive(Serialize, JsonSchema)]
struct Separator {
    /// The piece.
    piece: usize,
    /// The normal, one number a coordinate.
    normal: Vec<f64>,
    /// The offset.
    offset: f64,
}

/// A separator with the name of its blocker.
#[derive(Serialize, JsonSchema)]
struct LinkSeparator {
    /// The blocker's name.
    blocker: String,
    /// The piece.
    piece: usize,
    /// The normal, one number a coordinate.
    normal: Vec<f64>,
    /// The offset.
    offset: f64,
}

/// A link that the plan relies on.
#[derive(Serialize, JsonSchema)]
struct Link {
    /// A robot's name.
    from: String,
    /// A robot's or a base's name.
    to: String,
    /// The least number of links from `from` to a base over this step's list.
    hops: usize,
    /// For every piece of every blocker that links may not cross, what keeps the link on one side.
    separators: Vec<LinkSeparator>,
}

/// What keeps two robots apart: sign · (z_1 − z_2)[axis] is large enough for both tubes.
#[derive(Serialize, JsonSchema)]
struct Apart {
    /// The two robots' names.
    pair: [String; 2],
    /// The coordinate, from 0.
    axis: usize,
    /// 1 or −1.
    #[schemars(extend("enum" = [1, -1]))]
    sign: i8,
}

/// What was minimised and how far.
#[derive(Serialize, JsonSchema)]
struct Objective {
    /// `effort` or `length`.
    #[schemars(extend("enum" = ["effort", "length"]))]
    kind: String,
    /// The value reached; the checker computes it again.
    value: f64,
    /// A lower bound, for information.
    bound: f64,
    /// Whether the value is proved optimal for this tube, rejection share and directions, for information.
    proved: bool,
}
