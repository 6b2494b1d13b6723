//! What several test programs need: a watch that never stops, and missions from texts and files.

#![allow(dead_code, reason = "each test program uses a part of it")]
#![allow(clippy::disallowed_methods, reason = "reads the corpus")]

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use dosmc::diag::Diagnostics;
use dosmc::diag::render::{Style, render};
use dosmc::driver::{self, Answer, Mission, Overrides};
use dosmc::ir::{Base, Blocker, Problem, Region, Robot};
use dosmc::plan::Plan;
use dosmc::solve::{Progress, Watch};
use dosmc::source::SourceFile;

/// A clock that stands still: searches end by themselves.
pub struct Patient;

impl Watch for Patient {
    fn stop(&self) -> bool {
        false
    }
    fn progress(&self, _: &Progress) {}
    fn now(&self) -> Duration {
        Duration::ZERO
    }
}

/// A file of the package.
pub fn package(path: impl AsRef<Path>) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The missions in a directory of the package, sorted by name.
pub fn missions(directory: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(package(directory)).expect("a directory of the package");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let mut found: Vec<PathBuf> = paths.filter(|p| p.extension().is_some_and(|e| e == "dosm")).collect();
    found.sort();
    assert!(!found.is_empty(), "no mission in {directory}");
    found
}

/// The text of a mission.
pub fn source(path: impl AsRef<Path>) -> SourceFile {
    let path = package(path);
    let text = fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    SourceFile::new(path.file_name().expect("a file").to_string_lossy(), text)
}

/// A mission without errors.
pub fn load(source: &SourceFile, overrides: &Overrides) -> Mission {
    let mut diagnostics = Diagnostics::new();
    match driver::load(source, overrides, &mut diagnostics) {
        Ok(mission) => mission,
        Err(_) => panic!("{}", render(source, diagnostics.sorted(), Style::PLAIN)),
    }
}

/// Parameters and lengths for a mission.
pub fn overrides(set: &[(&str, &str)], horizon: Option<(usize, usize)>) -> Overrides {
    let set = set.iter().map(|(name, value)| (name.to_string(), value.to_string())).collect();
    Overrides { set, horizon, ..Overrides::default() }
}

/// What a search that takes its time says.
pub fn solve(mission: &Mission) -> Answer {
    let watch: Arc<dyn Watch> = Arc::new(Patient);
    driver::solve(mission, &watch).answer
}

/// A mission of the package with its plan.
pub fn planned(path: &str) -> (Problem, Plan) {
    let mission = load(&source(path), &Overrides::default());
    match solve(&mission) {
        Answer::Plan { plan, .. } => (mission.problem, *plan),
        other => panic!("{path}: {other:?}"),
    }
}

/// The plan of `examples/relay.dosm` with other names: scout, helper, tower, the region, the jammer.
pub fn renamed((problem, plan): &(Problem, Plan), mission: &str, names: &[String; 5]) -> (Problem, Plan) {
    let (mut problem, mut plan) = (problem.clone(), plan.clone());
    let new = |old: &str| match old {
        "scout" => names[0].clone(),
        "helper" => names[1].clone(),
        "tower" => names[2].clone(),
        _ => old.to_string(),
    };
    problem.name = mission.into();
    problem.regions =
        problem.regions.values().map(|r| Region { name: names[3].clone(), ..r.clone() }).collect();
    problem.blockers =
        problem.blockers.values().map(|b| Blocker { name: names[4].clone(), ..b.clone() }).collect();
    problem.bases = problem.bases.values().map(|b| Base { name: new(&b.name), ..b.clone() }).collect();
    problem.robots = problem.robots.values().map(|r| Robot { name: new(&r.name), ..r.clone() }).collect();
    plan.robots.iter_mut().for_each(|r| r.name = new(&r.name));
    for link in plan.links.iter_mut().flatten().flatten() {
        (link.from, link.to) = (new(&link.from), new(&link.to));
    }
    (problem, plan)
}

/// Says that a part of a test did not run for want of a tool, past the harness, which keeps back what
/// passing tests print; fails where `DOSMC_REQUIRE_TOOLS` says that all tools must be there.
pub fn skipped(what: &str) {
    assert!(std::env::var_os("DOSMC_REQUIRE_TOOLS").is_none(), "{what}");
    // Nobody is left to tell where standard error is closed.
    let _ = writeln!(std::io::stderr(), "SKIPPED: {what}");
}
