//! Back ends: one file a format, problem and plan in, [`Artifact`]s out.

pub mod svg;

/// A file to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Artifact {
    /// Its name, relative to the output directory.
    pub name: String,
    /// Its text.
    pub contents: String,
}
