//! Closed loops: every example flies without a violation however it is disturbed, and does not where
//! disturbances are larger than assumed; what is printed is what was flown.

#![allow(clippy::disallowed_methods, reason = "runs the command and looks at its files")]

mod common;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

use dosmc::driver::{Answer, Overrides};
use dosmc::ir::{Model, Problem};
use dosmc::plan::Plan;
use dosmc::simulate::{self, Disturbance, Kind, Observer, Options, Summary};
use serde_json::Value;

/// Robot-steps for each example.
const ROBOT_STEPS: u64 = if cfg!(debug_assertions) { 5_000 } else { 1_000_000 };

/// Looks at nothing.
struct Blind;

impl Observer for Blind {}

/// A mission with its plan.
struct Planned {
    name: String,
    path: PathBuf,
    problem: Problem,
    plan: Plan,
}

/// All examples, or without optimisation a few, with their plans.
static EXAMPLES: LazyLock<Vec<Planned>> = LazyLock::new(|| {
    let mut paths = common::missions("examples");
    paths.extend(common::missions("examples/paper"));
    let few = ["first", "relay", "wind", "drones", "report"];
    let kept = |path: &PathBuf| {
        !cfg!(debug_assertions) || few.iter().any(|f| path.file_stem().is_some_and(|stem| stem == *f))
    };
    paths.into_iter().filter(kept).filter_map(|path| planned(&path)).collect()
});

/// A mission with its plan, if it has one.
fn planned(path: &Path) -> Option<Planned> {
    let mission = common::load(&common::source(path), &Overrides::default());
    let name = path.file_stem().expect("a file").to_string_lossy().into_owned();
    match common::solve(&mission) {
        Answer::Plan { plan, .. } => {
            Some(Planned { name, path: path.into(), problem: mission.problem, plan: *plan })
        }
        Answer::NoPlan(_) => None,
        other => panic!("{name}: {other:?}"),
    }
}

fn example(name: &str) -> &'static Planned {
    EXAMPLES.iter().find(|e| e.name == name).expect("an example")
}

fn options(planned: &Planned, robot_steps: u64) -> Options {
    let a_run = simulate::usual_steps(&planned.plan) * planned.problem.robots.len();
    Options { runs: robot_steps.div_ceil(a_run as u64), threads: 2, ..Options::default() }
}

fn run(planned: &Planned, options: &Options) -> Summary {
    simulate::run(&planned.problem, &planned.plan, options, &Blind).expect("it can be simulated")
}

#[test]
fn no_example_is_violated_by_what_its_plan_assumes() {
    for planned in EXAMPLES.iter() {
        let name = &planned.name;
        let options = Options { seed: 2026, ..options(planned, ROBOT_STEPS) };
        let summary = run(planned, &options);
        assert!(summary.robot_steps >= ROBOT_STEPS && summary.runs == options.runs, "{name}");
        let findings = &summary.findings;
        assert_eq!(findings.samples.all_shortfalls(), 0, "{name}: {findings:#?}");
        assert_eq!((findings.excesses, findings.unreported), (0, 0), "{name}");
        let looked_at = [Kind::Input, Kind::Workspace].map(|kind| findings.samples.least(kind));
        assert!(looked_at.iter().flatten().all(|l| l.margin.is_finite()), "{name}: {findings:#?}");
        assert!(looked_at.iter().all(Option::is_some), "{name}");
        let blockers = !planned.problem.blockers.is_empty();
        assert_eq!(findings.samples.least(Kind::Blocker).is_some(), blockers, "{name}");
    }
}

#[test]
fn beyond_the_bound_violations_are_found_and_none_comes_unreported() {
    let (mut violated, mut all) = (Vec::new(), 0);
    for planned in EXAMPLES.iter() {
        let options = Options { exceed: 1.3, ..options(planned, ROBOT_STEPS / 10) };
        let findings = run(planned, &options).findings;
        assert_eq!(findings.unreported, 0, "{}: {findings:#?}", planned.name);
        assert!(findings.runs_with_excess > 0, "{}", planned.name);
        all += 1;
        if findings.runs_with_violation > 0 {
            violated.push(planned.name.as_str());
        }
    }
    // Most plans use their tubes to the last: only what has room everywhere gets away with it.
    assert!(violated.contains(&"relay") && violated.len() * 2 > all, "{violated:?} of {all}");
}

#[test]
fn each_kind_of_disturbance_finds_what_is_too_much() {
    let planned = example("relay");
    for kind in Disturbance::ALL {
        let of_kind = |exceed| Options {
            disturbances: vec![kind],
            exceed,
            seed: 3,
            ..options(planned, ROBOT_STEPS / 20)
        };
        let within = run(planned, &of_kind(1.0)).findings;
        assert_eq!((within.samples.all_shortfalls(), within.excesses), (0, 0), "{kind:?}");
        let beyond = run(planned, &of_kind(2.0)).findings;
        assert!(beyond.samples.all_shortfalls() > 0 && beyond.unreported == 0, "{kind:?}: {beyond:#?}");
    }
}

#[test]
fn aimed_disturbances_come_nearest() {
    // They reach the tube's corners at once, where chance would need the same K vertices in a row.
    for name in ["relay", "first"] {
        let planned = example(name);
        let nearest = |kind| {
            let options = Options { disturbances: vec![kind], runs: 120, seed: 5, ..Options::default() };
            let samples = run(planned, &options).findings.samples;
            [Kind::State, Kind::Input, Kind::Region]
                .map(|k| samples.least(k).map_or(f64::INFINITY, |l| l.margin))
        };
        let (aimed, uniform) = (nearest(Disturbance::Aimed), nearest(Disturbance::Uniform));
        assert!(aimed.iter().zip(&uniform).all(|(a, u)| a <= u), "{name}: {aimed:?} {uniform:?}");
        assert!(aimed.iter().any(|a| *a < 1e-3), "{name}: {aimed:?}");
    }
}

#[test]
fn a_seed_means_the_same_with_any_number_of_threads() {
    let planned = example("relay");
    for exceed in [1.0, 1.3] {
        let of = |threads, seed| {
            run(planned, &Options { threads, seed, exceed, ..options(planned, ROBOT_STEPS / 5) })
        };
        let one = of(1, 9);
        for threads in [1, 2, 3, 8] {
            assert_eq!(of(threads, 9), one, "{threads} threads");
        }
        assert_ne!(of(2, 10), one, "another seed is another simulation");
    }
}

#[test]
fn a_law_with_one_gain_turned_round_is_found_out() {
    let planned = example("relay");
    for (step, sign) in [(0, -1.0), (0, 0.0), (1, -1.0)] {
        let mut plan = planned.plan.clone();
        let gains = &mut plan.tubes[0].m[step];
        let largest = gains.iter_mut().flatten().max_by(|a, b| a.abs().total_cmp(&b.abs())).expect("gains");
        *largest *= sign;
        let options = Options { runs: 100, ..Options::default() };
        let findings = simulate::run(&planned.problem, &plan, &options, &Blind).expect("it flies").findings;
        assert!(findings.samples.all_shortfalls() > 0 && findings.excesses > 0, "gain {step}: {findings:#?}");
    }
}

#[test]
fn wild_disturbances_give_numbers_all_the_same() {
    let planned = example("relay");
    let options = Options { exceed: 1e6, runs: 20, ..Options::default() };
    let findings = run(planned, &options).findings;
    for kind in Kind::ALL {
        let least = [&findings.samples, &findings.between].map(|tally| tally.least(kind));
        assert!(least.iter().flatten().all(|l| l.margin.is_finite()), "{kind:?}");
    }
    assert!(findings.runs_with_violation == 20 && findings.unreported == 0, "{findings:#?}");
}

#[test]
fn runs_have_a_whole_round_at_least() {
    let planned = example("relay");
    let of = |steps| {
        let options = Options { steps: Some(steps), runs: 10, ..Options::default() };
        simulate::run(&planned.problem, &planned.plan, &options, &Blind)
    };
    let least = planned.plan.length + 1;
    assert_eq!(of(least).expect("long enough").findings.samples.all_shortfalls(), 0);
    assert_eq!(of(least - 1), Err(simulate::Unfit::TooShort { least }));
}

fn dosmc(args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dosmc"));
    command.current_dir(env!("CARGO_MANIFEST_DIR")).args(args).output().expect("the command starts")
}

/// A directory with an example's plan, and the path of the plan.
fn on_disk(planned: &Planned) -> (tempfile::TempDir, String, String) {
    let dir = tempfile::tempdir().expect("a directory");
    let plan = dir.path().join("plan.json");
    std::fs::write(&plan, dosmc::plan::json::write(&planned.plan)).expect("it can be written");
    let text = |path: &Path| path.to_str().expect("plain names").to_string();
    (dir, text(&plan), text(&planned.path))
}

/// The rows of a table by run, robot and step, each with its columns by name.
fn table(text: &str) -> BTreeMap<(u64, String, usize), BTreeMap<String, String>> {
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().expect("a head").split(',').collect();
    let row = |line: &str| {
        let row: BTreeMap<String, String> =
            head.iter().zip(line.split(',')).map(|(k, v)| (k.to_string(), v.to_string())).collect();
        let number = |key: &str| row[key].parse::<u64>().expect("a number");
        ((number("run"), row["robot"].clone(), number("step") as usize), row)
    };
    lines.map(row).collect()
}

/// A x + B u + c + w, in doubles.
fn next(model: &Model, row: &BTreeMap<String, String>) -> Vec<f64> {
    let value = |prefix: &str, name: &str| row[&format!("{prefix}.{name}")].parse::<f64>().expect("a number");
    let (n, m) = (model.n(), model.m());
    let state = |i: usize| {
        let from_states: f64 =
            (0..n).map(|j| model.a[(i, j)].to_f64() * value("x", &model.states[j].name)).sum();
        let from_inputs: f64 =
            (0..m).map(|j| model.b[(i, j)].to_f64() * value("u", &model.inputs[j].name)).sum();
        from_states + from_inputs + model.c[i].to_f64() + value("w", &model.states[i].name)
    };
    (0..n).map(state).collect()
}

#[test]
fn the_table_of_a_run_can_be_flown_again() {
    let planned = example("relay");
    let (dir, plan, mission) = on_disk(planned);
    let csv = dir.path().join("runs.csv");
    let csv_path = csv.to_str().expect("plain names");
    let args = ["simulate", &plan, &mission, "--runs", "10", "--exceed", "1.5"];
    let output = dosmc(&[&args[..], &["--csv", csv_path]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let text = std::fs::read_to_string(&csv).expect("it was written");
    let printed = dosmc(&[&args[..], &["--csv", "-"]].concat());
    assert!(String::from_utf8_lossy(&printed.stderr).contains("robot-steps"), "the summary is beside it");
    assert_eq!(String::from_utf8_lossy(&printed.stdout), text, "the same on standard output");
    let rows = table(&text);
    let steps = simulate::usual_steps(&planned.plan);
    assert_eq!(rows.len(), 10 * planned.problem.robots.len() * steps);
    let (mut compared, mut exceeded) = (0, 0);
    for ((run, robot, step), row) in &rows {
        exceeded += usize::from(row["monitor"] == "exceeded");
        let Some(then) = rows.get(&(*run, robot.clone(), step + 1)) else {
            assert_eq!(*step, steps - 1);
            continue;
        };
        let mover = planned.problem.robots.values().find(|r| r.name == *robot).expect("a robot");
        let model = &planned.problem.models[mover.model];
        for (signal, expected) in model.states.iter().zip(next(model, row)) {
            let found: f64 = then[&format!("x.{}", signal.name)].parse().expect("a number");
            assert!((found - expected).abs() < 1e-12, "{run} {robot} {step}: {found} {expected}");
            compared += 1;
        }
    }
    assert!(compared > 1000 && exceeded > 0, "{compared} {exceeded}");
}

#[test]
fn the_command_says_what_came_out_and_ends_accordingly() {
    let planned = example("relay");
    let (_dir, plan, mission) = on_disk(planned);
    let run = |more: &[&str]| dosmc(&[&["simulate", &plan, &mission, "--runs", "50"][..], more].concat());
    let json = |output: &Output| serde_json::from_slice::<Value>(&output.stdout).expect("JSON");
    let held = run(&["--json"]);
    let value = json(&held);
    assert_eq!((held.status.code(), &value["status"]), (Some(0), &Value::from("held")));
    assert_eq!((&value["violations"], &value["excess_reported"]), (&Value::from(0), &Value::from(0)));
    assert!(value["margins"]["separation"].as_f64().expect("a margin") > 0.0);
    assert!(value["margins"]["range"].is_null(), "the mission has no range");
    let beyond = run(&["--json", "--exceed", "2"]);
    let value = json(&beyond);
    assert_eq!((beyond.status.code(), &value["status"]), (Some(0), &Value::from("violated")));
    assert!(value["violations"].as_u64() > Some(0) && value["excess_reported"].as_u64() > Some(0));
    assert_eq!(value["unreported_violations"], 0);
    let text = String::from_utf8(run(&["--exceed", "2"]).stdout).expect("text");
    assert!(text.contains("scaled by 2") && text.contains("each violation was reported"), "{text}");
    for wrong in [
        &["--json", "--csv", "-"][..],
        &["--exceed", "-1"],
        &["--exceed", "NaN"],
        &["--steps", "3"],
        &["--runs", "0"],
        &["--disturbance", "gusty"],
    ] {
        let output = dosmc(&[&["simulate", &plan, &mission][..], wrong].concat());
        assert_eq!(output.status.code(), Some(1), "{wrong:?}");
    }
    let endless = ["simulate", &plan, &mission, "--runs", "1000000000", "--timeout", "0.5s", "--json"];
    let stopped = dosmc(&endless);
    let value = json(&stopped);
    assert_eq!((stopped.status.code(), &value["reason"]), (Some(4), &Value::from("timeout")));
}

#[test]
fn a_plan_that_does_not_check_is_not_flown() {
    let planned = example("relay");
    let (dir, plan, mission) = on_disk(planned);
    let mut wrong = planned.plan.clone();
    wrong.tubes[0].m[0][0][0] += 1e-3;
    std::fs::write(&plan, dosmc::plan::json::write(&wrong)).expect("it can be written");
    let csv = dir.path().join("runs.csv");
    let args = ["simulate", &plan, &mission, "--json", "--csv", csv.to_str().expect("plain names")];
    let output = dosmc(&args);
    let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((output.status.code(), &value["status"]), (Some(5), &Value::from("refused")));
    assert!(!csv.exists(), "and nothing is written");
}

#[test]
fn pictures_show_the_runs_that_are_asked_for() {
    let planned = example("relay");
    let (dir, plan, mission) = on_disk(planned);
    let draw = |name: &str, more: &[&str]| {
        let file = dir.path().join(name);
        let path = file.to_str().expect("plain names");
        let output = dosmc(&[&["render", &plan, &mission, "-o", path][..], more].concat());
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        std::fs::read_to_string(&file).expect("it was drawn")
    };
    let (bare, three) = (draw("a.svg", &[]), draw("b.svg", &["--runs", "3", "--seed", "4"]));
    assert!(three.contains("3 simulated runs") && !bare.contains("simulated"));
    assert_eq!(three, draw("c.svg", &["--runs", "3", "--seed", "4", "--threads", "1"]));
    assert_ne!(three, draw("d.svg", &["--runs", "3", "--seed", "5"]));
    let held = draw("e.svg", &["--runs", "3", "--disturbance", "held", "--exceed", "2", "--steps", "40"]);
    assert_ne!(three, held);
}

#[cfg(unix)]
#[test]
fn an_interrupt_says_what_was_reached_and_leaves_no_table() {
    use std::process::Stdio;
    use std::time::Duration;
    let planned = example("relay");
    let (dir, plan, mission) = on_disk(planned);
    let csv = dir.path().join("runs.csv");
    let mut command = Command::new(env!("CARGO_BIN_EXE_dosmc"));
    let args = ["simulate", &plan, &mission, "--runs", "1000000000"];
    let child = command.args(args).arg("--csv").arg(&csv).stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = child.current_dir(env!("CARGO_MANIFEST_DIR")).spawn().expect("it starts");
    std::thread::sleep(Duration::from_millis(1000));
    Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill is there");
    let output = child.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(4), "{said}");
    assert!(said.starts_with("interrupted after ") && said.contains("of 1000000000"), "{said}");
    assert_eq!(std::fs::read_dir(dir.path()).expect("it is there").count(), 1, "the plan alone");
}
