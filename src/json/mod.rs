//! JSON as this crate's files want it: read strictly, written so that people can read it too.
//!
//! Files are evidence: what could be understood in two ways (a key that occurs twice, a number that
//! is no double) is refused with the place where it stands. What is written is laid out within a
//! width, so that a vector stays on one line.

mod layout;
mod value;

use std::fmt;

pub use layout::lay_out;
pub use value::Value;

/// Why a text is not what it should be, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadError {
    /// The place as a JSON path, `$.robots[1].z[3][0]`; empty for the whole text.
    pub path: String,
    /// What is wrong there.
    pub message: String,
}

impl ReadError {
    /// Something is wrong with a value.
    pub fn new(message: impl Into<String>) -> ReadError {
        ReadError { path: String::new(), message: message.into() }
    }

    /// The same in a field of an object.
    pub fn in_key(mut self, key: &str) -> ReadError {
        let plain = !key.is_empty() && key.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
        let step = if plain { format!(".{key}") } else { format!("[{key:?}]") };
        self.path.insert_str(0, &step);
        self
    }

    /// The same in an item of an array.
    pub fn in_item(mut self, index: usize) -> ReadError {
        self.path.insert_str(0, &format!("[{index}]"));
        self
    }

    /// The same, with the path from the root of the text.
    pub fn from_root(mut self) -> ReadError {
        self.path.insert(0, '$');
        self
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path, self.message)
    }
}

impl std::error::Error for ReadError {}
