//! The controllers that are written agree with what was proved: the law against exact numbers, the crates
//! as compilers see them, names that look like code, and measurements that are none.

#![allow(clippy::disallowed_methods, reason = "runs compilers")]

#[path = "../common/mod.rs"]
mod common;

mod crates;
mod exact_sum;
mod faults;
mod luck;
mod names;
mod robot;
mod rounding;

use std::sync::LazyLock;

use dosmc::back::Artifact;
use dosmc::back::controller;
use dosmc::driver::{Answer, Overrides};
use dosmc::ir::Problem;
use dosmc::law::Float;
use dosmc::plan::Plan;

/// A mission with a plan whose tubes keep room for the rounding of a float type.
pub struct Planned {
    /// The file's name without its ending, and the type's.
    pub name: String,
    /// What was planned.
    pub problem: Problem,
    /// Its plan.
    pub plan: Plan,
    /// What its controllers compute with.
    pub float: Float,
}

/// All examples with their plans in doubles, and some in single precision.
pub static PLANNED: LazyLock<Vec<Planned>> = LazyLock::new(|| {
    let doubles = common::missions("examples").into_iter().map(|path| (path, Float::F64));
    let single = ["relay", "wind", "drones"].map(|name| (format!("examples/{name}.dosm").into(), Float::F32));
    doubles.chain(single).map(|(path, float)| plan(&path, float)).collect()
});

impl Planned {
    /// The moment of the plan that a sample belongs to.
    pub fn moment(&self, sample: usize) -> usize {
        let (last, first) = (self.plan.length, self.plan.loop_start);
        if sample <= last { sample } else { first + (sample - first) % (last + 1 - first) }
    }
}

fn plan(path: &std::path::Path, float: Float) -> Planned {
    let name = path.file_stem().expect("a name").to_string_lossy();
    let overrides = Overrides { float, ..Overrides::default() };
    let mission = common::load(&common::source(path), &overrides);
    match common::solve(&mission) {
        Answer::Plan { plan, .. } => {
            Planned { name: format!("{name}_{float}"), problem: mission.problem, plan: *plan, float }
        }
        other => panic!("{name}: {other:?}"),
    }
}

/// The crate of a plan.
pub fn crate_of(planned: &Planned) -> Vec<Artifact> {
    controller::write(&planned.problem, &planned.plan, planned.float)
        .unwrap_or_else(|e| panic!("{}: {e}", planned.name))
}

#[test]
fn the_same_plan_gives_the_same_bytes() {
    for planned in PLANNED.iter() {
        assert_eq!(crate_of(planned), crate_of(planned), "{}", planned.name);
    }
}
