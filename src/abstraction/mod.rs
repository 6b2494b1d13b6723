//! What a tube makes of a mission's shapes (Algorithm 1, steps 1b and 1c).

mod error_set;
mod narrow_region;
mod start;

pub use error_set::ErrorSet;
pub use start::inspect;
