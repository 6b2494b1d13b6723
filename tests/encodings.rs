//! Both encodings of the workspace on the same missions: half-spaces, and the paper's cells.
//!
//! Every plan that comes out was accepted by the exact check (`driver` gives out no other), so what
//! is compared is what each of them finds and refutes.

#![allow(clippy::disallowed_methods, reason = "reads the corpus")]

mod common;

use std::path::Path;
use std::sync::Arc;

use dosmc::diag::Diagnostics;
use dosmc::driver::{self, Answer, Encoding, Mission, Overrides, Solved};
use dosmc::solve::Watch;
use dosmc::source::SourceFile;

use common::Patient;

fn load(text: &str, set: &[(&str, &str)]) -> Mission {
    let source = SourceFile::new("mission.dosm", text);
    let set = set.iter().map(|(name, value)| (name.to_string(), value.to_string())).collect();
    let overrides = Overrides { set, ..Overrides::default() };
    driver::load(&source, &overrides, &mut Diagnostics::new()).expect("a mission without errors")
}

fn solve(mission: &Mission, encoding: Encoding) -> Solved {
    let watch: Arc<dyn Watch> = Arc::new(Patient);
    driver::solve_with(mission, encoding, &watch).expect("few cells")
}

/// The length of the plan found, if there is one.
fn length(solved: &Solved) -> Option<usize> {
    match &solved.answer {
        Answer::Plan { plan, shortest } => {
            assert!(shortest);
            Some(plan.length)
        }
        Answer::NoPlan(_) => None,
        other => panic!("{other:?}"),
    }
}

const TABLE: &str = include_str!("../examples/paper/table1-4.dosm");

/// The paper's Table I counts C(N, 2)·(N − 1) variables a step for N robots and bases.
#[test]
fn connectivity_takes_as_many_variables_as_in_the_papers_table() {
    let rows =
        [("2", "1", 6), ("3", "1", 18), ("4", "1", 40), ("2", "2", 18), ("3", "2", 40), ("4", "2", 75)];
    for (robots, bases, variables) in rows {
        // One step is enough to count: its positions are 0 and 1.
        let mut mission = load(TABLE, &[("robots", robots), ("bases", bases)]);
        mission.problem.horizon = (1, 1);
        let solved = solve(&mission, Encoding::Paper);
        assert_eq!(solved.statistics.bool_vars_connectivity, 2 * variables, "{robots} robots, {bases} bases");
        assert!(solved.cells > 0);
    }
}

/// With two robots and one base the paper's plan is a step longer: no cells of its partition see
/// past the corner that the diagonal half-spaces see past.
#[test]
fn both_encodings_plan_rows_of_table_one() {
    for (robots, bases, lengths) in [("2", "1", (6, 7)), ("2", "2", (6, 6)), ("4", "1", (6, 6))] {
        let mission = load(TABLE, &[("robots", robots), ("bases", bases)]);
        let found =
            (length(&solve(&mission, Encoding::HalfSpaces)), length(&solve(&mission, Encoding::Paper)));
        assert_eq!(found, (Some(lengths.0), Some(lengths.1)), "{robots} robots, {bases} bases");
    }
}

#[test]
fn the_same_mission_gives_the_same_plan_twice() {
    let mission = load(TABLE, &[]);
    let plan = || match solve(&mission, Encoding::Paper).answer {
        Answer::Plan { plan, .. } => dosmc::plan::json::write(&plan),
        other => panic!("{other:?}"),
    };
    assert_eq!(plan(), plan());
}

#[test]
fn without_a_plan_the_partition_is_part_of_the_scope() {
    let mission = load(include_str!("missions/unsat/one_hop_short.dosm"), &[]);
    match solve(&mission, Encoding::Paper).answer {
        Answer::NoPlan(scope) => assert!(scope.cells > 1),
        other => panic!("{other:?}"),
    }
    match solve(&mission, Encoding::HalfSpaces).answer {
        Answer::NoPlan(scope) => assert_eq!(scope.cells, 0),
        other => panic!("{other:?}"),
    }
}

/// Missions that take the paper's encoding minutes, or whose fellows stand for them; all rows of
/// Table I and Fig. 2 are run by `benches/encodings.py`.
const LEFT_OUT: [(&str, &str); 9] = [
    ("discs.dosm", "each disc has sixteen sides, which makes 475 cells: minutes"),
    ("drones.dosm", "373 cells in space: a minute; the plan is a step longer, for want of oblique cuts"),
    ("gantry.dosm", "a thousand cells in space: minutes"),
    ("quadrotors.dosm", "a ball in space has 26 sides, which makes 1600 cells: minutes"),
    ("patrol.dosm", "seconds"),
    ("fig1.dosm", "seconds"),
    ("fig2-4.dosm", "seconds"),
    ("fig2-6.dosm", "seconds"),
    ("fig2-8.dosm", "seconds"),
];

/// Missions whose plan has more steps with cells: with half-spaces a robot cuts a corner of a blocker
/// along a diagonal, and the coarse cells beside it are not clear as a whole.
const LONGER: [(&str, usize); 4] =
    [("relay_round_pillar.dosm", 1), ("thin_wall.dosm", 1), ("table1-4.dosm", 1), ("table1-6.dosm", 1)];

/// The missions of a directory, by name.
fn missions(directory: &str) -> Vec<(String, String)> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join(directory);
    let mut found = Vec::new();
    for entry in std::fs::read_dir(directory).expect("a directory of the package") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if name.ends_with(".dosm") {
            found.push((name, std::fs::read_to_string(path).expect("a text")));
        }
    }
    found.sort();
    assert!(found.len() > 3);
    found
}

#[test]
fn verdicts_agree_on_the_corpus() {
    let mut longer = Vec::new();
    for directory in ["tests/missions/solve", "tests/missions/unsat", "examples", "examples/paper"] {
        for (name, text) in missions(directory) {
            if LEFT_OUT.iter().any(|(n, _)| *n == name) || name == "table1-8.dosm" {
                continue;
            }
            let mission = load(&text, &[]);
            let (half_spaces, paper) =
                (solve(&mission, Encoding::HalfSpaces), solve(&mission, Encoding::Paper));
            let lengths = (length(&half_spaces), length(&paper));
            assert_eq!(lengths.0.is_some(), lengths.1.is_some(), "{name}: {lengths:?}");
            // What Adj_p and Adj_c allow is clear, so nothing is left for the search to find out.
            assert_eq!(paper.statistics.not_clear, 0, "{name}");
            assert!(half_spaces.cells == 0 && paper.cells > 0);
            match lengths {
                (Some(a), Some(b)) if b > a => longer.push((name, b - a)),
                (a, b) => assert_eq!(a, b, "{name}"),
            }
        }
    }
    let expected: Vec<(String, usize)> = LONGER.iter().map(|(name, by)| (name.to_string(), *by)).collect();
    assert_eq!(longer, expected);
}

/// With a horizon that the coarse cells' plans are too long for, the cells are cut once more.
#[test]
fn cells_that_are_too_coarse_are_refined() {
    for text in [TABLE, include_str!("missions/solve/thin_wall.dosm")] {
        let mut mission = load(text, &[]);
        let shortest = length(&solve(&mission, Encoding::HalfSpaces)).expect("a plan");
        let coarse = solve(&mission, Encoding::Paper);
        assert_eq!(length(&coarse), Some(shortest + 1));
        mission.problem.horizon = (1, shortest);
        let fine = solve(&mission, Encoding::Paper);
        assert_eq!(length(&fine), Some(shortest));
        assert!(fine.cells > coarse.cells && fine.statistics.not_clear == 0);
    }
}

/// Cells grow with the square of the jammers: where there would be too many, that is said at once.
#[test]
fn a_field_of_jammers_has_too_many_cells() {
    let mut text = String::from("dosm 1\nworkspace box (0, 0) .. (52, 52)\n");
    for i in 0..5 {
        for j in 0..5 {
            // Out of line, so that no two share a plane.
            let (x, y) = (10.0 * f64::from(i) + 6.0 + 0.13 * f64::from(j), 10 * j + 6);
            text += &format!("jammer J{i}{j} = ball ({x:.2}, {y}.{i}) radius 1.5\n");
        }
    }
    text += "region far = box (48, 48) .. (51, 51)\nconnectivity none\nhorizon 1..40\n\
             dynamics Rover {\n step 0.5 s\n integrator 2\n bound vx, vy in [-4, 4] m/s\n \
             bound ax, ay in [-4, 4] m/s^2\n disturbance px, py in [-0.2, 0.2] m\n}\n\
             robot r: Rover at (1, 2)\ngoal g: eventually r in far\n";
    let watch: Arc<dyn Watch> = Arc::new(Patient);
    let refused = driver::solve_with(&load(&text, &[]), Encoding::Paper, &watch);
    assert!(refused.is_err_and(|e| e.to_string().contains("more than 2000 cells")));
}
