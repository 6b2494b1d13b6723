//! The convex part: for each robot and candidate a small linear program, answered with a point or
//! with a contradiction that is proved.

mod certificate;
mod interval;
mod program;
mod simplex;
mod system;

pub use certificate::{Conflict, Term};
pub use interval::Interval;
pub use program::{Member, Node, Program, Verdict};
pub use system::System;
