//! Plans that the solver found: they survive the file, fly through sampled disturbances, and
//! forgeries of them fare no better than those of plans made by hand.

#![allow(clippy::disallowed_methods, reason = "reads the corpus")]

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use dosmc::diag::Diagnostics;
use dosmc::driver::{Answer, Overrides, load, solve};
use dosmc::ir::Problem;
use dosmc::plan::{Plan, json};
use dosmc::solve::{Progress, Watch};
use dosmc::source::SourceFile;
use dosmc::verify::verify;

use crate::forge::forge;
use crate::sampling::{Dice, counterexample};

/// Lets a search run to its end.
struct Patient;

impl Watch for Patient {
    fn stop(&self) -> bool {
        false
    }
    fn progress(&self, _: &Progress) {}
    fn now(&self) -> Duration {
        Duration::ZERO
    }
}

fn solved(path: &Path) -> (Problem, Plan) {
    let text = std::fs::read_to_string(path).unwrap();
    let source = SourceFile::new(path.to_string_lossy(), text);
    let mission = load(&source, &Overrides::default(), &mut Diagnostics::default()).expect("no errors");
    let watch: Arc<dyn Watch> = Arc::new(Patient);
    match solve(&mission, &watch).answer {
        Answer::Plan { plan, .. } => (mission.problem, *plan),
        other => panic!("{}: {other:?}", path.display()),
    }
}

fn missions() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/missions/solve");
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut missions: Vec<PathBuf> = entries.filter(|p| p.extension().is_some_and(|e| e == "dosm")).collect();
    missions.sort();
    assert!(missions.len() >= 10, "the corpus is gone");
    missions
}

#[test]
fn solved_plans_survive_the_file_and_fly() {
    for path in missions() {
        let (problem, plan) = solved(&path);
        let text = json::write(&plan);
        let again = json::read(&text).unwrap();
        assert_eq!(again, plan, "{}", path.display());
        assert_eq!(json::write(&again), text);
        let report = verify(&problem, &again);
        assert!(report.holds() && report.same_text, "{}: {report}", path.display());
        assert_eq!(counterexample(&problem, &again, 60, &mut Dice(11)), None, "{}", path.display());
    }
}

/// Whether a change there can't be excused by the margins that a solved plan has.
fn binding(path: &[String]) -> bool {
    const BINDING: [&str; 12] = [
        "name",
        "set",
        "step_s",
        "length",
        "loop_start",
        "dynamics",
        "piece",
        "pair",
        "axis",
        "sign",
        "from",
        "to",
    ];
    let last = path.iter().rev().find(|key| key.parse::<usize>().is_err());
    last.is_some_and(|key| BINDING.contains(&key.as_str()))
}

#[test]
fn forgeries_of_solved_plans_are_refused_or_do_no_harm() {
    for (path, every) in missions().iter().zip([43, 41, 37, 31, 29, 47, 53, 23].into_iter().cycle()) {
        let (problem, plan) = solved(path);
        let tally = forge(&problem, &plan, |_| true, binding, every, 2);
        assert!(tally.refused > 10, "{}: {} refused", path.display(), tally.refused);
    }
}
