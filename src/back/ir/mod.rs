//! `NAME.ir.json`: the IR as a file, format `dosm-ir` version 1.
//!
//! For tools that want a mission without its language: every number is exact, every name resolved,
//! families and sugar are gone. Entities are called by their place in their table, from 0; operands
//! stand before their users. Every key is always there (`null` where there is nothing), unknown keys
//! are ignored, and a problem has exactly one text. [`read`] gives the same problem back.

mod document;
mod number;
mod read;
mod write;

use crate::back::{Artifact, file_name};
use crate::ir::Problem;
use crate::json::lay_out;

pub use document::Document;
pub use read::read;

/// The value of the key `format`.
pub const FORMAT: &str = "dosm-ir";
/// The value of the key `version`.
pub const VERSION: u32 = 1;

/// Writes a problem; the same problem gives the same bytes.
pub fn write(problem: &Problem) -> Artifact {
    // Strings, whole numbers, lists and string keys alone: nothing that JSON can't say.
    let compact = serde_json::to_string(&write::document(problem)).unwrap_or_default();
    Artifact { name: file_name(&problem.name, "ir.json"), contents: lay_out(&compact) }
}

#[cfg(test)]
mod tests;
