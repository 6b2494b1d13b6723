//! Plans that the solver found: they survive the file, fly through sampled disturbances, and
//! forgeries of them fare no better than those of plans made by hand.

#![allow(clippy::disallowed_methods, reason = "reads the corpus")]

use std::path::{Path, PathBuf};
use std::sync::Arc;

use dosmc::diag::Diagnostics;
use dosmc::driver::{Answer, Overrides, load, solve};
use dosmc::ir::Problem;
use dosmc::plan::{Plan, json};
use dosmc::solve::Watch;
use dosmc::source::SourceFile;
use dosmc::verify::verify;

use crate::common::Patient;
use crate::forge::forge;
use crate::sampling::{Dice, counterexample};

fn solved(path: &Path) -> (Problem, Plan) {
    solved_text(&path.to_string_lossy(), &std::fs::read_to_string(path).unwrap())
}

pub fn solved_text(name: &str, text: &str) -> (Problem, Plan) {
    let source = SourceFile::new(name, text);
    let mission = load(&source, &Overrides::default(), &mut Diagnostics::default()).expect("no errors");
    let watch: Arc<dyn Watch> = Arc::new(Patient);
    match solve(&mission, &watch).answer {
        Answer::Plan { plan, .. } => (mission.problem, *plan),
        other => panic!("{name}: {other:?}"),
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
    // Not the axis and side of a pair nor a link's ends: robots may be apart along both axes, and a
    // plane may serve another pair as well. Those forgeries have to fly instead.
    const BINDING: [&str; 8] = ["name", "set", "step_s", "length", "loop_start", "dynamics", "piece", "pair"];
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

/// Coupled dynamics in continuous time beside a plain point, slanted shapes, joint bounds,
/// disturbances off their middle.
const MIXED: &str = r"
dosm 1
mission mixed
workspace polygon (0, 0), (12, -1), (13, 9), (6, 12), (-1, 9)
region a = ball (9, 7) radius 1.2 norm 1
region b = polygon (1, 6), (3, 7.5), (1.5, 8.5), (0.2, 7)
obstacle rock = hull (5, 4), (6.5, 4.5), (6, 6), (4.8, 5.5)
jammer J = ball (8, 3) radius 0.8 norm 1 or ball (3, 4.5) radius 0.5
base B1 at (1, 1)
base B2 at (11, 8)
dynamics Car {
  step 0.5 s
  state px: m, py: m, vx: m/s, vy: m/s
  input ax: m/s^2, ay: m/s^2
  position px, py
  continuous
  A = [0, 0, 1, 0.3; 0, 0, -0.3, 1; 0, 0, -0.2, 0.1; 0, 0, -0.1, -0.3]
  B = [0, 0; 0, 0; 1, 0.2; -0.1, 1]
  bound vx, vy in [-4, 4] m/s
  bound ax, ay in [-4, 4] m/s^2
  bound where { vx + vy <= 5; vx - 1 s * ax <= 7 }
  disturbance px, py in [-0.03, 0.05] m
}
dynamics Point { step 0.5 s integrator 1 bound vx, vy in [-3, 3] m/s disturbance px, py in [-0.1, 0.05] m }
robot R1: Car at (2, 2)
robot R2: Point at (4, 2)
robot R3: Point at (6, 1.5)
separation 0.2 m
connectivity { hops <= 2 }
horizon 1..30
goal g1: always eventually R1 in a
goal g2: eventually R2 in b and always eventually not (R2 in b)
goal g3: always count(r in R2, R3: r in a) != 2
";

#[test]
fn coupled_and_slanted_plans_fly_and_resist_forgery() {
    let (problem, plan) = solved_text("mixed", MIXED);
    assert_eq!(counterexample(&problem, &plan, 100, &mut Dice(5)), None);
    let tally = forge(&problem, &plan, |_| true, binding, 23, 1);
    assert!(tally.refused > 100, "{} refused", tally.refused);
}
