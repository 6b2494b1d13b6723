//! The intermediate representation: a mission with nothing left but what it means.
//!
//! Every number is an exact SI value, every name is an id, families and sugar are gone. The IR is
//! what the planner plans and what the checker checks against; it holds no places in the source
//! (those are a side table, [`Spans`], that is no part of its value).

mod formula;
mod model;
mod problem;
#[cfg(test)]
pub(crate) mod sample;
mod spans;
mod text;
mod validate;

pub use formula::{Atom, Comparison, Formula, FormulaId, Formulas, Relation};
pub use model::{Enclosure, Interval, Model, ModelId, Signal};
pub use problem::{
    Base, BaseId, Blocker, BlockerId, BlockerKind, Connectivity, Goal, Norm, Objective, Piece, Problem,
    Range, Region, RegionId, Robot, RobotId, Shape,
};
pub use spans::{ModelSpans, Spans};
pub use validate::{Violation, validate};
