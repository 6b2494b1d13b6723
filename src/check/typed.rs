//! The typed mission: every name an id, every number an exact SI value, families written out.
//!
//! What is left for `lower` is sugar: integrators, the derived temporal operators, implications and
//! comparisons as they were written.

use std::collections::BTreeMap;

use crate::entity::Table;
use crate::entity_id;
use crate::exact::Rational;
use crate::geometry::{HalfSpace, Polytope};
pub use crate::ir::Piece;
use crate::ir::{
    Atom, BaseId, BlockerId, BlockerKind, Connectivity, Enclosure, Objective, RegionId, RobotId,
};
use crate::source::Span;
pub use crate::syntax::ast::Comparison;

entity_id!(
    /// A dynamics model of the mission, in use or not.
    DynamicsId, "dynamics"
);
entity_id!(
    /// A formula.
    FormulaId, "formula"
);

/// A whole mission.
#[derive(Clone, Debug)]
pub struct Mission {
    /// Its name.
    pub name: String,
    /// Its `//!` documentation, empty when there is none.
    pub doc: String,
    /// SHA-256 of the source text, in lower-case hexadecimal.
    pub sha256: String,
    /// The `--set` assignments as written, by parameter.
    pub set: BTreeMap<String, String>,
    /// The sampling time in seconds.
    pub step: Rational,
    /// 𝒲.
    pub workspace: Workspace,
    /// The regions, members of families one by one.
    pub regions: Table<RegionId, Region>,
    /// Obstacles and jammers in order of declaration.
    pub blockers: Table<BlockerId, Blocker>,
    /// The base stations.
    pub bases: Table<BaseId, Base>,
    /// All dynamics models.
    pub dynamics: Table<DynamicsId, Dynamics>,
    /// The robots.
    pub robots: Table<RobotId, Robot>,
    /// ε in metres with its declaration.
    pub separation: Option<(Rational, Span)>,
    /// What links are asked; `None` with `connectivity none`.
    pub connectivity: Option<Connectivity>,
    /// The lengths that may be tried.
    pub horizon: (usize, usize),
    /// What to minimise.
    pub objective: Option<Objective>,
    /// All formulas, operands before their users.
    pub formulas: Table<FormulaId, Formula>,
    /// The goals.
    pub goals: Vec<Goal>,
}

/// 𝒲 with its declaration.
#[derive(Clone, Debug)]
pub struct Workspace {
    /// The set.
    pub polytope: Polytope,
    /// The declaration.
    pub span: Span,
}

/// A closed set: the union of at least one piece.
#[derive(Clone, Debug)]
pub struct Shape {
    /// The operands of `or`, in order.
    pub pieces: Vec<Piece>,
}

/// A region of interest.
#[derive(Clone, Debug)]
pub struct Region {
    /// Its name, `name[1]` for a member of a family.
    pub name: String,
    /// Its documentation.
    pub doc: String,
    /// The set; every set that it may be, together, where it is uncertain.
    pub shape: Shape,
    /// What all sets that it may be have in common, where it is uncertain; perhaps no piece at all.
    pub sure: Option<Shape>,
    /// Its declaration.
    pub span: Span,
}

/// An obstacle or a jammer.
#[derive(Clone, Debug)]
pub struct Blocker {
    /// Its name.
    pub name: String,
    /// Its documentation.
    pub doc: String,
    /// What it is.
    pub kind: BlockerKind,
    /// The set.
    pub shape: Shape,
    /// Its declaration.
    pub span: Span,
}

/// A base station.
#[derive(Clone, Debug)]
pub struct Base {
    /// Its name.
    pub name: String,
    /// Its documentation.
    pub doc: String,
    /// Its coordinates in metres.
    pub position: Vec<Rational>,
    /// Its declaration.
    pub span: Span,
}

/// A robot.
#[derive(Clone, Debug)]
pub struct Robot {
    /// Its name.
    pub name: String,
    /// Its documentation.
    pub doc: String,
    /// Its motion model.
    pub dynamics: DynamicsId,
    /// x̄₀, one entry a state.
    pub start: Vec<Rational>,
    /// Its declaration.
    pub span: Span,
}

/// A motion model.
#[derive(Clone, Debug)]
pub struct Dynamics {
    /// Its name.
    pub name: String,
    /// Its documentation.
    pub doc: String,
    /// Where the name stands.
    pub name_span: Span,
    /// The states in order.
    pub states: Vec<Signal>,
    /// The inputs in order.
    pub inputs: Vec<Signal>,
    /// Which states are the coordinates.
    pub position: Vec<usize>,
    /// The sampling time in seconds.
    pub step: Rational,
    /// How x and u make x⁺.
    pub motion: Motion,
    /// What says B.
    pub input_matrix_span: Span,
    /// The box part of 𝒳.
    pub state_bounds: Vec<Option<Interval>>,
    /// The box part of 𝒰.
    pub input_bounds: Vec<Interval>,
    /// The general part of 𝒳 × 𝒰, over (x, u).
    pub mixed_bounds: Vec<HalfSpace>,
    /// Θ, where a state has a disturbance.
    pub disturbance: Vec<Option<Interval>>,
    /// β with its item.
    pub rejection: Option<(Rational, Span)>,
}

/// A state or an input.
#[derive(Clone, Debug, PartialEq)]
pub struct Signal {
    /// Its name.
    pub name: String,
    /// Its documentation.
    pub doc: String,
    /// Its coherent SI unit as text.
    pub unit: String,
    /// What it measures.
    pub dimension: crate::quantity::Dimension,
}

/// How x and u make x⁺.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// x⁺ = A x + B u + c, rows of A and B.
    Matrices {
        /// A, n rows of n.
        a: Vec<Vec<Rational>>,
        /// B, n rows of m.
        b: Vec<Vec<Rational>>,
        /// c, n entries.
        c: Vec<Rational>,
        /// How far the true ones may be off (`continuous` models); `None` when they are exact.
        enclosure: Option<Enclosure>,
    },
    /// One chain of so many integrators an axis.
    Integrator {
        /// At least 1.
        order: usize,
    },
}

/// A closed interval with the item that says it.
#[derive(Clone, Debug, PartialEq)]
pub struct Interval {
    /// The lower end, SI.
    pub lo: Rational,
    /// The upper end, SI.
    pub hi: Rational,
    /// The item.
    pub span: Span,
}

/// A window in steps.
pub type Window = (u32, u32);

/// A formula as written, but with quantifiers and counts over the members that they mean.
#[derive(Clone, Debug, PartialEq)]
pub enum Formula {
    /// `true`, `false`
    Constant(bool),
    /// `R in A`
    In(Atom),
    /// Σ coefficient · atom ⋈ bound; an atom may occur more than once.
    Compare {
        /// The terms, right-hand ones with the opposite sign.
        terms: Vec<(Atom, i64)>,
        /// ⋈
        op: Comparison,
        /// All constants, on the right-hand side.
        bound: i64,
    },
    /// `not a`
    Not(FormulaId),
    /// `next a`
    Next(FormulaId),
    /// `always[m, n] a`
    Always(Option<Window>, FormulaId),
    /// `eventually[m, n] a`
    Eventually(Option<Window>, FormulaId),
    /// `a and b and …`, `forall`
    And(Vec<FormulaId>),
    /// `a or b or …`, `exists`
    Or(Vec<FormulaId>),
    /// `a -> b`
    Implies(FormulaId, FormulaId),
    /// `a <-> b`
    Iff(FormulaId, FormulaId),
    /// `a until[m, n] b`
    Until(Option<Window>, FormulaId, FormulaId),
    /// `a release[m, n] b`
    Release(Option<Window>, FormulaId, FormulaId),
    /// `a weak until[m, n] b`
    WeakUntil(Option<Window>, FormulaId, FormulaId),
    /// `a strong release[m, n] b`
    StrongRelease(Option<Window>, FormulaId, FormulaId),
}

/// A named part of the specification.
#[derive(Clone, Debug)]
pub struct Goal {
    /// Its name.
    pub name: String,
    /// Its formula.
    pub formula: FormulaId,
    /// Its declaration.
    pub span: Span,
}
