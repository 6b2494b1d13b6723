//! The tracking law that goes on the robot: its source, its tables, and a proved bound on its rounding.
//!
//! [`tracking`] is the law, one source file: compiled in here, where the simulator runs it, and copied
//! as it stands ([`SOURCE`]) into every controller. [`TubeTables`] and [`PathTables`] are the numbers
//! it works with, and [`Rounding`] is how far it can be from the law in real numbers.

mod fit;
mod float;
mod rounding;
mod tables;
#[cfg(test)]
mod tests;
pub mod tracking;

pub use fit::{Flight, Misfit, Promise, fit};
pub use float::Float;
pub use rounding::{Magnitudes, Rounding};
pub use tables::{Feedback, PathTables, TubeTables};

/// The text of [`tracking`], for controllers.
pub const SOURCE: &str = include_str!("tracking.rs");

impl<R: tracking::Real> tracking::Column for Vec<R> {
    type Entry = R;

    fn zeros(&self) -> Self {
        vec![R::ZERO; self.len()]
    }

    fn entries(&self) -> &[R] {
        self
    }

    fn entries_mut(&mut self) -> &mut [R] {
        self
    }
}
