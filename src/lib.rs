//! dosmc: from a `.dosm` mission to a plan that is proved in exact arithmetic.

pub mod back;
pub mod cli;
pub mod diag;
pub mod entity;
pub mod exact;
pub mod geometry;
pub mod ir;
pub mod plan;
pub mod source;
pub mod syntax;
pub mod tube;
pub mod verify;
