//! Plans that hold, and forgeries of them that must not pass.

mod forge;
mod sampling;
mod scene;
mod threats;
