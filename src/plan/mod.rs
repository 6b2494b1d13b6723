//! Plans, and the `plan.json` that carries them with every witness (interfaces.md §2).

pub mod json;

mod extract;
mod nominal;
mod routes;

use std::collections::BTreeMap;

pub use extract::extract;
pub use nominal::Nominal;
pub use routes::Hop;

/// A plan with all its witnesses. All numbers are SI doubles, meant exactly as they stand.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The program that wrote it, `dosmc 0.1.0`.
    pub tool: String,
    /// What it is a plan of.
    pub mission: Mission,
    /// The sampling time in seconds.
    pub step_s: f64,
    /// L: the nominal states are z_0 … z_L.
    pub length: usize,
    /// k: after z_L comes z_k again.
    pub loop_start: usize,
    /// One tube a dynamics model.
    pub tubes: Vec<Tube>,
    /// One entry a robot.
    pub robots: Vec<RobotPlan>,
    /// One list a step of the links that the plan relies on; `None` with `connectivity none`.
    pub links: Option<Vec<Vec<Link>>>,
    /// One list a step of the separating axes; empty without `separation`.
    pub separation: Vec<Vec<Apart>>,
    /// What was minimised.
    pub objective: Option<Objective>,
}

impl Plan {
    /// The lasso in a few words for people.
    pub fn summary(&self) -> String {
        let (length, again, step) = (self.length, self.loop_start, self.step_s);
        let steps = if length == 1 { "step" } else { "steps" };
        // A loop of one step leads from z_L to z_L.
        let then = if again == length {
            "then stays there".to_string()
        } else {
            format!("then again from step {again},")
        };
        format!("{length} {steps} of {step} s, {then} for ever")
    }
}

/// What a plan is a plan of.
#[derive(Clone, Debug, PartialEq)]
pub struct Mission {
    /// The mission's name.
    pub name: String,
    /// SHA-256 of the source text.
    pub sha256: String,
    /// The `--set` assignments, as written.
    pub set: BTreeMap<String, String>,
}

/// The tube of a dynamics model with n states and m inputs: e_t = Σ_i D_i ŵ_{t−1−i}.
#[derive(Clone, Debug, PartialEq)]
pub struct Tube {
    /// The model's name.
    pub dynamics: String,
    /// The middle of Θ', n entries.
    pub center: Vec<f64>,
    /// The half-widths of Θ', n entries.
    pub half_width: Vec<f64>,
    /// The share of Θ' set aside for the controller's rounding, n entries.
    pub reserve: Vec<f64>,
    /// K matrices, n × n each, row by row; the first is the identity.
    pub d: Vec<Vec<Vec<f64>>>,
    /// K matrices, m × n each, row by row.
    pub m: Vec<Vec<Vec<f64>>>,
}

/// The plan of one robot.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotPlan {
    /// The robot's name.
    pub name: String,
    /// Its dynamics model's name.
    pub dynamics: String,
    /// L + 1 nominal states of n entries.
    pub z: Vec<Vec<f64>>,
    /// L + 1 nominal inputs of m entries.
    pub v: Vec<Vec<f64>>,
    /// For each region that ψ asks of this robot: in, out or neither at each step.
    pub regions: BTreeMap<String, Vec<Label>>,
    /// For each such region, the witness of each `Out`: one separator a piece.
    pub outside: BTreeMap<String, Vec<Option<Vec<Separator>>>>,
    /// For each blocker and step t, one separator a piece that clears z_t and the state after it.
    pub clear: BTreeMap<String, Vec<Vec<Separator>>>,
}

/// A robot's certain relation to a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Label {
    /// Certainly in.
    In,
    /// Certainly out.
    Out,
    /// Neither is certain.
    Unknown,
}

/// A plane between a convex piece and what must miss it: `normal · p < offset` for every possible
/// position p, `normal · q ≥ offset` for every point q of the piece.
#[derive(Clone, Debug, PartialEq)]
pub struct Separator {
    /// The piece's index among the operands of `or`.
    pub piece: usize,
    /// The normal, one entry a coordinate.
    pub normal: Vec<f64>,
    /// The offset.
    pub offset: f64,
}

/// A link that the plan relies on.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// A robot's name.
    pub from: String,
    /// A robot's or a base's name.
    pub to: String,
    /// The least number of links from `from` to a base over this step's list.
    pub hops: usize,
    /// For every piece of every blocker that links may not cross: blocker's name and separator.
    pub separators: Vec<(String, Separator)>,
}

/// `sign · (z_1 − z_2)[axis]` keeps two robots apart at a step and at the one after.
#[derive(Clone, Debug, PartialEq)]
pub struct Apart {
    /// The two robots' names.
    pub pair: (String, String),
    /// The coordinate, from 0.
    pub axis: usize,
    /// 1 or −1.
    pub sign: i8,
}

/// What was minimised and how far.
#[derive(Clone, Debug, PartialEq)]
pub struct Objective {
    /// `effort` or `length`.
    pub kind: String,
    /// The value reached; the checker computes it again.
    pub value: f64,
    /// A lower bound (information).
    pub bound: f64,
    /// Whether the value is proved optimal (information).
    pub proved: bool,
}
