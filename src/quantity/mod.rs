//! Physical dimensions, SI units and the constants that missions compute with.
//!
//! A value is an exact rational in coherent SI together with its [`Dimension`]. Sums, products and
//! whole powers stay exact; roots, sines and other powers give the nearest double, found by exact
//! rational enclosures so that it is the same on every platform.

mod dimension;
mod elementary;
mod limits;
mod unit;

pub use dimension::Dimension;
pub use elementary::{cos, pi, power, sin, sqrt};
pub use limits::{MAX_BITS, in_range};
pub use unit::{SYMBOLS, Unit, UnitError};
