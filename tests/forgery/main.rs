//! Plans that hold, and forgeries of them that must not pass.

mod bounds;
mod cases;
#[path = "../common/mod.rs"]
mod common;
mod flights;
mod forge;
mod links;
mod sampling;
mod scene;
mod threats;
