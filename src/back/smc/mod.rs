//! `NAME.smc.json`: a whole instance as a file, format `dosm-smc` version 1.
//!
//! It carries the mission's source, so that whoever has the file has everything: [`read`] gives the
//! document back, and the planner makes the instance again and compares before it trusts it.

pub mod document;
mod read;
mod write;

use crate::back::{Artifact, file_name};
use crate::json::lay_out;

pub use document::Document;
pub use read::read;
pub use write::document;

/// The value of the key `format`.
pub const FORMAT: &str = "dosm-smc";
/// The value of the key `version`.
pub const VERSION: u32 = 1;

/// The value of the key `encoding` for half-spaces.
pub const HALF_SPACES: &str = "half-spaces";
/// The value of the key `encoding` for the paper's cells.
pub const PAPER: &str = "paper";

/// Writes a document; the same document gives the same bytes.
pub fn write(document: &Document) -> Artifact {
    // Strings, finite numbers, lists and string keys alone: nothing that JSON can't say.
    let compact = serde_json::to_string(document).unwrap_or_default();
    Artifact { name: file_name(&document.mission.name, "smc.json"), contents: lay_out(&compact) }
}
