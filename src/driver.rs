//! The chain from text to plan, as the picture in the crate's documentation shows it.
//!
//! Nothing here reads a file, looks at the clock or prints.

use crate::diag::{Diagnostics, Reported};
use crate::source::SourceFile;
use crate::syntax;

/// What the command line says about a mission besides its text.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// Values for parameters, as written.
    pub set: Vec<(String, String)>,
    /// The lengths to try instead of the mission's.
    pub horizon: Option<(usize, usize)>,
}

/// Reads a mission and looks for everything that is wrong with it, short of a search.
///
/// # Errors
/// [`Reported`] when the mission has errors.
pub fn load(
    source: &SourceFile,
    _overrides: &Overrides,
    diagnostics: &mut Diagnostics,
) -> Result<(), Reported> {
    syntax::parse(source, diagnostics)?;
    diagnostics.or_reported()
}
