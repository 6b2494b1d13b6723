//! The language server's view of a mission.

pub mod index;
