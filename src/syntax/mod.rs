//! From text to syntax tree. The only module that names `pest`.
//!
//! A text is scanned (`scan`) first: comments, nesting and odd characters are dealt with, and the text falls
//! into stretches from one declaration's keyword to the next. pest parses each stretch on its own
//! (`grammar/dosm.pest`), so that an error in one leaves the others alone; the builder makes the tree from
//! what pest gives, with operator chains climbed (`climb`) on a stack of its own. Nothing here recurses deeper
//! than brackets nest, and those are counted before.

pub mod ast;
mod builder;
mod characters;
mod climb;
mod condensed;
mod declaration;
mod docs;
mod dump;
mod dynamics;
mod error;
mod expected;
mod expression;
pub mod format;
mod formula;
pub mod glossary;
mod grammar;
mod memory;
mod mend;
mod moved;
mod number;
mod reader;
mod scan;
mod shape;
pub mod token;
pub mod words;

pub use dump::dump;
pub use memory::Memory;
pub use reader::{decode, parse, parse_again, parse_expression};
