//! Opening the missions that a command line names.

use std::path::Path;

use super::{Status, files};
use crate::diag::{Diagnostic, Diagnostics};
use crate::driver::{self, Overrides};
use crate::source::SourceFile;
use crate::syntax;

/// A mission that could not be opened.
pub struct Unopened {
    /// Its name, and as much of its text as could be read.
    pub source: SourceFile,
    /// Why.
    pub problem: Diagnostic,
    /// The command's status.
    pub status: Status,
}

/// Reads a mission's text.
///
/// # Errors
/// [`Unopened`] when the file can't be read (status 1) or is no text (status 2).
pub fn open(path: &Path) -> Result<SourceFile, Box<Unopened>> {
    let name = files::shown_name(path);
    let bytes = files::read(path).map_err(|problem| {
        let source = SourceFile::new(name.clone(), "");
        Box::new(Unopened { source, problem, status: Status::Usage })
    })?;
    match syntax::decode(&bytes) {
        Ok(text) => Ok(SourceFile::new(name, text)),
        Err(problem) => {
            // Up to the first wrong byte, which is where the problem is, both texts are the same.
            let text = String::from_utf8_lossy(&bytes).trim_start_matches('\u{feff}').to_string();
            Err(Box::new(Unopened { source: SourceFile::new(name, text), problem, status: Status::Mission }))
        }
    }
}

/// Loads a mission; its diagnostics are sorted by place.
pub fn load(source: &SourceFile, overrides: &Overrides) -> (Option<()>, Vec<Diagnostic>) {
    let mut diagnostics = Diagnostics::new();
    let loaded = driver::load(source, overrides, &mut diagnostics).ok();
    (loaded, diagnostics.sorted().into_iter().cloned().collect())
}
