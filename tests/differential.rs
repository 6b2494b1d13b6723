//! Other people's solvers on the files that are written: Z3 decides the SMT-LIB file of a length as
//! the planner decides that length, and another SAT solver the DIMACS file as ours does.
//!
//! Z3 is the program that `DOSMC_Z3` names, or `z3`; the SAT solver `DOSMC_SAT`, or `minisat` or
//! `cadical`. Without them the tests say loudly that nothing was compared, and fail where
//! `DOSMC_REQUIRE_TOOLS` is set. With `DOSMC_SLOW` Z3 is also asked what takes it long: `just soak`.

#![allow(clippy::disallowed_methods, reason = "writes files and runs other programs on them")]

mod common;

use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::{Mutex, PoisonError};

use dosmc::abstraction::{Abstraction, Body, Owner, SolidId};
use dosmc::back::{cnf, smt2};
use dosmc::driver::{Answer, Mission, Overrides};
use dosmc::encode::Instance;
use dosmc::ir::Problem;
use dosmc::plan::Plan;
use rustsat::solvers::{Solve, SolverResult};
use rustsat_batsat::BasicSolver;

use common::{load, missions, overrides, solve, source};

/// How long Z3 may think about one file, in seconds: many times what it takes, since this is wall time on
/// a machine that may be busy.
const PATIENCE: u32 = 300;

/// The examples and missions of the corpus that Z3 needs more than 8 s for (up to 40), with the
/// lengths: it is asked about them where `DOSMC_SLOW` is set.
const SLOW_EXAMPLES: [(&str, usize); 7] = [
    ("rescue", 9),
    ("response", 11),
    ("response", 12),
    ("uncertain", 7),
    ("uncertain", 8),
    ("uncertain_regions", 10),
    ("uncertain_regions", 11),
];

/// The same of Table I with 8 states: 50 s with one base, 15 with two.
const SLOW_TABLE_ONE: [(&str, usize); 1] = [("table1_8", 7)];

/// Whether Z3 is asked what takes it long, too.
fn patient() -> bool {
    std::env::var_os("DOSMC_SLOW").is_some()
}

/// The first of some programs that can be run; a missing one is said, or fatal where tools must be
/// there.
fn tool(variable: &str, names: &[&str]) -> Option<String> {
    let named = std::env::var(variable).ok().filter(|n| !n.is_empty());
    let candidates = named.iter().map(String::as_str).chain(names.iter().copied());
    let runs = |name: &&str| Command::new(name).arg("--help").output().is_ok();
    let found = candidates.into_iter().find(runs).map(str::to_owned);
    if found.is_none() {
        common::skipped(&format!("none of {names:?} is there, and {variable} names none: nothing compared"));
    }
    found
}

/// What one length of a mission looks like to other solvers.
struct Asked {
    name: String,
    mission: Mission,
    length: usize,
    abstraction: Abstraction,
    instance: Instance,
}

impl Asked {
    fn new(path: &Path, set: &[(&str, &str)], length: usize) -> Asked {
        let mission = load(&source(path), &overrides(set, Some((length, length))));
        let abstraction = Abstraction::new(&mission.problem, &mission.tubes, 1.0);
        let instance = Instance::new(&mission.problem, &mission.tubes, &abstraction, (length, length));
        let instance = instance.expect("a small instance").assuming_first_length();
        let name = format!("{} {set:?} at length {length}", mission.problem.name);
        Asked { name, mission, length, abstraction, instance }
    }

    /// Whether there is a plan: `None` where the planner claims nothing.
    fn verdict(&self) -> Option<bool> {
        match solve(&self.mission) {
            Answer::Plan { plan, .. } => {
                assert_eq!(plan.length, self.length);
                self.within_directions(&plan).then_some(true)
            }
            Answer::NoPlan(_) => Some(false),
            Answer::Unknown(_) => None,
            Answer::Refused(report) => panic!("{}: {report}", self.name),
        }
    }

    /// Whether all moves and links of a plan are separated from blockers along directions at hand;
    /// the search accepts others too.
    fn within_directions(&self, plan: &Plan) -> bool {
        let problem = &self.mission.problem;
        self.abstraction.solids.iter().all(|(solid, entry)| {
            let Owner::Blocker(blocker) = entry.owner else { return true };
            let moves = (0..plan.robots.len()).flat_map(|r| (0..=plan.length).map(move |t| (r, t)));
            let moves_clear = moves.into_iter().all(|(r, t)| {
                let next = if t == plan.length { plan.loop_start } else { t + 1 };
                self.below(solid, &[self.body(plan, r, t), self.body(plan, r, next)])
            });
            let links = plan.links.iter().flatten().enumerate();
            let links_clear = links.into_iter().all(|(t, links)| {
                let ends = |link: &dosmc::plan::Link| {
                    let end = |name: &str| self.end(plan, problem, name, t);
                    [end(&link.from), end(&link.to)]
                };
                links.iter().all(|link| self.below(solid, &ends(link)))
            });
            moves_clear && (!problem.blockers[blocker].kind.blocks_links() || links_clear)
        })
    }

    fn body(&self, plan: &Plan, robot: usize, step: usize) -> (Vec<f64>, Option<dosmc::ir::ModelId>) {
        let model = self.mission.problem.robots.values().nth(robot).expect("a robot").model;
        let position = &self.mission.problem.models[model].position;
        (position.iter().map(|&s| plan.robots[robot].z[step][s]).collect(), Some(model))
    }

    fn end(
        &self,
        plan: &Plan,
        problem: &Problem,
        name: &str,
        step: usize,
    ) -> (Vec<f64>, Option<dosmc::ir::ModelId>) {
        match plan.robots.iter().position(|r| r.name == name) {
            Some(robot) => self.body(plan, robot, step),
            None => {
                let base = problem.bases.iter().find(|(_, b)| b.name == name).expect("a base");
                (self.abstraction.base(base.0).to_vec(), None)
            }
        }
    }

    /// Whether some direction of a solid has both ends below it with the whole gap to spare.
    fn below(&self, solid: SolidId, ends: &[(Vec<f64>, Option<dosmc::ir::ModelId>)]) -> bool {
        let entry = &self.abstraction.solids[solid];
        entry.faces.iter().any(|(_, direction)| {
            let d = &self.abstraction.directions[*direction].vector;
            ends.iter().all(|(center, model)| {
                let room =
                    if model.is_some() { 0.999 * self.abstraction.gap } else { 0.25 * self.abstraction.gap };
                self.abstraction.reach(&Body { center, model: *model }, d) <= entry.level(d) - room
            })
        })
    }
}

/// Who has it may run Z3: its time limit is one of wall time.
static ALONE: Mutex<()> = Mutex::new(());

/// What Z3 says of an SMT-LIB file.
fn ask_z3(z3: &str, asked: &Asked) -> bool {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let artifact = smt2::write(&asked.mission.problem, &asked.instance);
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join(&artifact.name);
    fs::write(&path, &artifact.contents).expect("it can be written");
    let output = Command::new(z3).arg(format!("-T:{PATIENCE}")).arg(&path).output().expect("it runs");
    match String::from_utf8_lossy(&output.stdout).trim() {
        "sat" => true,
        "unsat" => false,
        other => panic!("{}: Z3 says {other:?}", asked.name),
    }
}

/// What came of a comparison: how many lengths were compared, and which were left out for their time.
#[derive(Default)]
struct Tally {
    compared: usize,
    left_out: Vec<(String, usize)>,
}

impl Tally {
    /// Fails where the list of what is slow names something that was not met, or met twice.
    fn left_out_just(&self, slow: &[(&str, usize)]) {
        let met: Vec<(&str, usize)> = self.left_out.iter().map(|(n, l)| (n.as_str(), *l)).collect();
        assert_eq!(met, if patient() { &[] } else { slow }, "the list of what is slow is out of date");
    }
}

/// Compares the planner and Z3 on some lengths of a mission.
fn compare(
    tally: &mut Tally,
    z3: &str,
    path: &Path,
    set: &[(&str, &str)],
    lengths: &[usize],
    slow: &[(&str, usize)],
) {
    for &length in lengths {
        let asked = Asked::new(path, set, length);
        let name = &asked.mission.problem.name;
        if !patient() && slow.contains(&(name.as_str(), length)) {
            tally.left_out.push((name.clone(), length));
            continue;
        }
        let ours = asked.verdict();
        let theirs = ask_z3(z3, &asked);
        if let Some(ours) = ours {
            assert_eq!(ours, theirs, "{}: the planner says {ours}, Z3 {theirs}", asked.name);
            tally.compared += 1;
        }
    }
}

/// The shortest length of a mission's plans, and the one before.
fn around_the_shortest(path: &Path, set: &[(&str, &str)]) -> Vec<usize> {
    let mission = load(&source(path), &overrides(set, None));
    match solve(&mission) {
        Answer::Plan { plan, .. } => [plan.length.wrapping_sub(1), plan.length]
            .into_iter()
            .filter(|&l| (1..=plan.length).contains(&l))
            .collect(),
        other => panic!("{}: {other:?}", path.display()),
    }
}

/// Compares on the rows of Table I with two robots and one or two bases, on lengths that are not slow.
fn table_one(file: &str, slow: &[(&str, usize)]) {
    let Some(z3) = tool("DOSMC_Z3", &["z3"]) else { return };
    let path = common::package(format!("examples/paper/{file}.dosm"));
    for bases in ["1", "2"] {
        let set = [("robots", "2"), ("bases", bases)];
        let lengths = around_the_shortest(&path, &set);
        let mut tally = Tally::default();
        compare(&mut tally, &z3, &path, &set, &lengths, slow);
        tally.left_out_just(slow);
        assert!(tally.compared > 0, "{file}, {bases}: nothing compared");
    }
}

#[test]
fn z3_agrees_on_table_one_with_4_states() {
    table_one("table1-4", &[]);
}

#[test]
fn z3_agrees_on_table_one_with_6_states() {
    table_one("table1-6", &[]);
}

#[test]
fn z3_agrees_on_table_one_with_8_states() {
    table_one("table1-8", &SLOW_TABLE_ONE);
}

/// Some lengths of a mission's horizon that are quickly decided by anybody.
fn first_lengths(mission: &Mission) -> Vec<usize> {
    let (from, to) = mission.problem.horizon;
    [1, 2, 3, 5, 7].into_iter().filter(|l| (from..=to).contains(l)).collect()
}

#[test]
fn z3_agrees_on_missions_without_a_plan() {
    let Some(z3) = tool("DOSMC_Z3", &["z3"]) else { return };
    for path in missions("tests/missions/unsat") {
        let lengths = first_lengths(&load(&source(&path), &Overrides::default()));
        let mut tally = Tally::default();
        compare(&mut tally, &z3, &path, &[], &lengths, &[]);
        assert_eq!(tally.compared, lengths.len(), "{}: not all decided", path.display());
    }
}

/// Whether a mission has at most so many robots, and five blockers.
fn small(path: &Path, robots: usize) -> bool {
    let problem = load(&source(path), &Overrides::default()).problem;
    problem.robots.len() <= robots && problem.blockers.len() <= 5
}

#[test]
fn z3_agrees_on_small_examples() {
    let Some(z3) = tool("DOSMC_Z3", &["z3"]) else { return };
    // With two robots in space Z3 takes up to a minute; one of those with one robot is in space.
    let flat = |p: &Path| load(&source(p), &Overrides::default()).problem.dimension == 2;
    let examples = missions("examples").into_iter().filter(|p| small(p, 2) && flat(p));
    // Of the corpus those with one robot and short numbers: what an exponential gives has 53 bits, with
    // which Z3 can take minutes.
    let short = |p: &Path| {
        let problem = load(&source(p), &Overrides::default()).problem;
        problem.models.values().all(|m| m.enclosure.is_none())
    };
    let others = missions("tests/missions/solve").into_iter().filter(|p| small(p, 1) && short(p));
    let mut tally = Tally::default();
    for path in examples.chain(others) {
        compare(&mut tally, &z3, &path, &[], &around_the_shortest(&path, &[]), &SLOW_EXAMPLES);
    }
    tally.left_out_just(&SLOW_EXAMPLES);
    assert!(tally.compared >= 20, "only {} lengths compared", tally.compared);
}

/// What our SAT solver says of the Boolean part.
fn ask_batsat(asked: &Asked) -> bool {
    let mut solver = BasicSolver::default();
    solver.add_cnf(asked.instance.clauses.clone()).expect("enough memory");
    match solver.solve().expect("an answer") {
        SolverResult::Sat => true,
        SolverResult::Unsat => false,
        SolverResult::Interrupted => panic!("{}: interrupted", asked.name),
    }
}

/// What another one says of the file: both speak by exit status, 10 and 20.
fn ask_other(program: &str, asked: &Asked) -> bool {
    let artifact = cnf::write(&asked.mission.problem, &asked.abstraction, &asked.instance);
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join(&artifact.name);
    fs::write(&path, &artifact.contents).expect("it can be written");
    let status = Command::new(program).arg(&path).output().expect("it runs").status;
    match status.code() {
        Some(10) => true,
        Some(20) => false,
        other => panic!("{}: {program} ends with {other:?}", asked.name),
    }
}

#[test]
fn another_sat_solver_agrees() {
    let Some(program) = tool("DOSMC_SAT", &["minisat", "cadical"]) else { return };
    let mut verdicts = [0, 0];
    let all = ["examples", "examples/paper", "tests/missions/solve", "tests/missions/unsat"];
    for path in all.into_iter().flat_map(missions) {
        for length in first_lengths(&load(&source(&path), &Overrides::default())) {
            let asked = Asked::new(&path, &[], length);
            let (ours, theirs) = (ask_batsat(&asked), ask_other(&program, &asked));
            assert_eq!(ours, theirs, "{}: batsat says {ours}, {program} {theirs}", asked.name);
            verdicts[usize::from(ours)] += 1;
        }
    }
    assert!(verdicts.iter().all(|v| *v > 0), "a comparison that knows one answer only: {verdicts:?}");
}
