//! `plan.json`: the file form of a [`Plan`](super::Plan), to the letter of the format `dosm-plan` version 1.
//!
//! Writing is deterministic and keeps every double; reading is strict, because a plan is evidence:
//! what could be understood in two ways (duplicate keys, numbers beyond the doubles, rows of the
//! wrong length) is refused with the place where it stands. Unknown keys are ignored.

mod read;
mod write;

pub use read::read;
pub use write::write;

/// The value of the key `format`.
pub const FORMAT: &str = "dosm-plan";
/// The value of the key `version`.
pub const VERSION: u64 = 1;

#[cfg(test)]
pub(crate) mod schema;
#[cfg(test)]
mod tests;
