//! Plans that hold, and forgeries of them that must not pass.

mod bounds;
mod cases;
#[path = "../common/mod.rs"]
mod common;
mod flights;
mod forge;
mod links;
mod nets;
mod sampling;
mod scene;
mod sharp;
mod threats;
mod uncertain;
mod words;
