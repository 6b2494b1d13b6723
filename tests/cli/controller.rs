//! Controllers from the command line: who writes them, and where none is written.

use super::*;

/// All files of a controller with their texts.
fn controller(out: &Path) -> Vec<(&'static str, String)> {
    let files = [
        "Cargo.toml",
        "README.md",
        "src/law.rs",
        "src/dynamics.rs",
        "src/robots.rs",
        "src/links.rs",
        "src/lib.rs",
    ];
    let text = |file| fs::read_to_string(out.join("controller").join(file)).expect("it was written");
    files.map(|file| (file, text(file))).into()
}

#[test]
fn a_plan_has_one_controller_whoever_writes_it() {
    let (_keep, out, _) = solved(REACH, &[]);
    let again = out.join("again");
    let plan = out.join("plan.json");
    let args =
        ["compile", REACH, "--plan", path(&plan), "--emit", "controller", "-o", path(&again), "--json"];
    let output = run(&args);
    assert_eq!(status(&output), 0, "{output:?}");
    assert_eq!(json(&output)["files"].as_array().map(Vec::len), Some(7));
    assert_eq!(names(&again), ["controller"], "nothing else was asked for");
    assert_eq!(controller(&out), controller(&again));

    let everything = out.join("everything");
    assert_eq!(status(&run(&["compile", REACH, "--plan", path(&plan), "-o", path(&everything)])), 0);
    let expected = ["controller", "reach.cnf", "reach.ir.json", "reach.smc.json", "reach.smt2"];
    assert_eq!(names(&everything), expected);
}

#[test]
fn single_precision_wants_a_plan_with_room_for_it() {
    let (_keep, out, _) = solved(REACH, &[]);
    let (plan, other) = (out.join("plan.json"), out.join("other"));
    let single = ["--float", "f32", "--emit", "controller", "-o", path(&other)];
    let output = run(&[&["compile", REACH, "--plan", path(&plan)], &single[..]].concat());
    assert_eq!(status(&output), 5, "{output:?}");
    let said = String::from_utf8_lossy(&output.stderr);
    for part in ["dosm::controller::rounding", "e-6", "reserves", "--float f32"] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(!other.exists(), "nothing is written");

    let (_keep, out, output) = solved(REACH, &["--float", "f32"]);
    assert_eq!(status(&output), 0, "{output:?}");
    assert!(controller(&out).iter().any(|(_, text)| text.contains("pub type Real = f32;")));
    let plan = out.join("plan.json");
    let output = run(&[&["compile", REACH, "--plan", path(&plan)], &single[..]].concat());
    assert_eq!(status(&output), 0, "{output:?}");
    assert_eq!(controller(&out), controller(&other));
}

#[test]
fn no_controller_without_a_plan_that_checks() {
    let (_keep, out, _) = solved(REACH, &[]);
    let (plan, other) = (out.join("plan.json"), out.join("other"));
    let text = fs::read_to_string(&plan).expect("a plan");
    fs::write(&plan, text.replacen("\"loop_start\": ", "\"loop_start\": 1", 1)).expect("it can be changed");
    let compile = |more: &[&str]| run(&[&["compile", REACH, "-o", path(&other)], more].concat());
    assert_eq!(status(&compile(&["--plan", path(&plan), "--emit", "controller"])), 5);
    for usage in [
        &["--emit", "controller"][..],
        &["--emit", "ir", "--plan", path(&plan)],
        &["--emit", "ir", "--float", "f32"],
        &["--plan", "nowhere.json"],
    ] {
        assert_eq!(status(&compile(usage)), 1, "{usage:?}");
    }
    assert!(!other.exists(), "nothing is written");
}
