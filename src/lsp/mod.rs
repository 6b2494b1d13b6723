//! The language server: `dosmc lsp`.
//!
//! ```text
//! client ─► wire ─► server (keeps the texts) ─► queue ─► workers: requests, looks ─► wire ─► client
//!                      └─► commands ─► solve: a thread a run
//! ```
//!
//! A [`Document`] is a mission at one moment; a change makes a new one, so that an answer is always about
//! one text. Each feature is a file with functions from a document and a place to `lsp_types`; `requests`
//! is the table of them. Files, clock and planner are the [`Host`]'s.

mod actions;
mod capabilities;
mod commands;
mod completion;
mod diagnostics;
mod document;
mod folding;
mod formatting;
mod highlight;
pub mod hover;
pub mod index;
pub mod inlay;
mod lens;
mod lines;
mod location;
mod navigation;
mod number;
mod outline;
mod queue;
mod rename;
mod requests;
mod selection;
pub mod semantic;
mod server;
mod session;
pub mod signature;
mod solve;
mod symbols;
pub mod tubes;
pub mod wire;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

pub use document::Document;
pub use lines::{Encoding, Lines};
pub use server::{Ending, serve};
pub use solve::Outcome;

use crate::driver::Mission;
use crate::explain::Page;
use crate::solve::Watch;

/// What the server needs of the world outside.
pub trait Host: Send + Sync {
    /// Plans a mission, and writes what comes of it into a directory.
    fn plan(&self, mission: &Mission, directory: &Path, watch: &Arc<dyn Watch>) -> Outcome;

    /// A directory for the plans of missions that have no place of their own yet.
    fn temporary(&self) -> PathBuf;

    /// A file with a code's explanation, to link to.
    fn explanation(&self, page: &Page) -> Option<PathBuf>;

    /// The missions below some folders, with their texts; not more than can be looked through quickly.
    fn missions(&self, folders: &[PathBuf]) -> Vec<(PathBuf, String)>;

    /// The time since some fixed moment.
    fn now(&self) -> Duration;
}
