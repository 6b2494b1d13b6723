//! The editors' plug-ins: their lists of words are the compiler's, and they work in the real editors.

#![allow(clippy::disallowed_methods, reason = "reads the plug-ins and runs editors")]

#[path = "../common/mod.rs"]
mod common;

mod bat;
mod emacs;
mod generated;
mod neovim;
mod queries;
mod sublime;
mod tools;
mod tree_sitter;
mod vim;
mod vscode;
