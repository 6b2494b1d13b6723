//! Three robots with their controllers, and the world that they move in: motion, disturbances, jammers
//! and a radio, after `examples/paper/fig2-4.dosm`.
//!
//! The world's numbers are the mission's, written down once more: a controller is only as good as the
//! plan's assumptions, and here these are looked at from the outside. Only `+ − × ÷` and comparisons
//! of doubles are used, which every machine computes alike, so that the host's run and the
//! microcontroller's are the same to the last bit.

#![no_std]
#![forbid(unsafe_code)]

mod plant;
mod radio;
mod run;
mod team;

pub use plant::{Plant, Wind};
pub use radio::{in_the_clear, Radio};
pub use run::{run, Scene, Settings, Summary};
pub use team::{Decision, Robot, Team, ROBOTS};
