//! Everything that is written or printed as JSON is as its schema says, and nothing else is.
//! (`tests/stages.rs` holds the files of the whole corpus against theirs.)

#![allow(clippy::disallowed_methods, reason = "runs the command and looks at its files")]

mod schema;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use schema::Closed;
use serde_json::{Value, json};

const REACH: &str = "tests/missions/solve/reach.dosm";
const UNSAT: &str = "tests/missions/unsat/too_far.dosm";
const WRONG: &str = "tests/missions/err/check_unknown_region.dosm";
/// It asks for something of everything that a plan can hold.
const RICH: &str = "examples/relay.dosm";

/// What a command prints on standard output, and its status.
fn printed(args: &[&str]) -> (Value, i32) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dosmc"));
    let output = command.current_dir(env!("CARGO_MANIFEST_DIR")).args(args).arg("--json").output();
    let output = output.expect("the command starts");
    let value = serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{args:?}: {e}"));
    (value, output.status.code().expect("it was not killed"))
}

fn read(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).expect("it was written")).expect("JSON")
}

#[test]
fn every_answer_of_every_command_is_as_its_schema_says() {
    let dir = tempfile::tempdir().expect("a directory");
    let out = dir.path().to_str().expect("plain names");
    assert_eq!(printed(&["solve", REACH, "-o", out]).1, 0);
    let plan = dir.path().join("plan.json");
    let plan = plan.to_str().expect("plain names");
    let (picture, page) = (format!("{out}/drawn.svg"), format!("{out}/drawn.html"));
    let table: &[(&[&str], i32, &str)] = &[
        (&["check", REACH], 0, "ok"),
        (&["check", REACH, WRONG, "no/such/file.dosm"], 1, "error"),
        (&["check", "--frobnicate"], 1, "error"),
        (&["compile", REACH, "-o", out], 0, "done"),
        (&["compile", REACH, "-o", out, "--timeout", "0"], 4, "unknown"),
        (&["compile", WRONG, "-o", out], 2, "error"),
        (&["solve", REACH, "-o", out], 0, "plan"),
        (&["solve", UNSAT, "-o", out], 3, "no_plan"),
        (&["solve", REACH, "-o", out, "--timeout", "0"], 4, "unknown"),
        (&["solve", WRONG, "-o", out], 2, "error"),
        (&["solve", "no/such/file.dosm", "-o", out], 1, "error"),
        (&["explain", "duplicate"], 0, "done"),
        (&["explain"], 0, "done"),
        (&["explain", "no such code"], 1, "error"),
        (&["completions", "bash"], 0, "done"),
        (&["completions", "no such shell"], 1, "error"),
        (&["new", "no-name"], 1, "error"),
        (&["man"], 0, "done"),
        (&["man", "-o", out], 0, "done"),
        (&["man", "-o", "Cargo.toml"], 1, "error"),
        (&["verify", plan, REACH], 0, "checked"),
        (&["verify", plan, "tests/missions/solve/until.dosm"], 5, "refused"),
        (&["verify", REACH, REACH], 5, "error"),
        (&["verify", plan, WRONG], 2, "error"),
        (&["simulate", plan, REACH, "--runs", "20"], 0, "held"),
        (&["simulate", plan, REACH, "--runs", "20", "--exceed", "9"], 0, "violated"),
        (&["simulate", plan, REACH, "--runs", "1000000000", "--timeout", "0"], 4, "unknown"),
        (&["simulate", plan, REACH, "--steps", "1"], 1, "error"),
        (&["simulate", plan, "tests/missions/solve/until.dosm"], 5, "refused"),
        (&["render", plan, REACH, "-o", &picture, "--runs", "2"], 0, "drawn"),
        (&["render", plan, REACH, "-o", &page], 0, "drawn"),
        (&["render", plan, "tests/missions/solve/until.dosm", "-o", &picture], 5, "refused"),
        (&["render", plan, REACH, "-o", out], 1, "error"),
    ];
    for (args, status, word) in table {
        let (value, code) = printed(args);
        assert_eq!((code, &value["status"]), (*status, &Value::from(*word)), "{args:?}");
        Closed::of(args[0]).assert_accepts(&value);
    }
}

/// One change for each kind of place in a document: of all items of a list, and of all values of a
/// map, the first alone is changed.
fn wrong_documents(document: &Value) -> BTreeMap<String, Value> {
    let mut changed = BTreeMap::new();
    spoil(document, "", &mut |place, wrong| {
        let shape: String =
            place.split('/').map(|p| if p.parse::<u32>().is_ok() { "/0" } else { p }).collect();
        changed.entry(shape).or_insert_with(|| {
            let mut whole = document.clone();
            *whole.pointer_mut(place).expect("a place of the document") = wrong;
            whole
        });
    });
    changed
}

/// Calls `note` with each place below a value and a value of another type for it.
fn spoil(value: &Value, place: &str, note: &mut impl FnMut(&str, Value)) {
    let other = if value.is_object() { json!([]) } else { json!({"wrong": 1}) };
    note(place, other);
    let escaped = |key: &str| key.replace('~', "~0").replace('/', "~1");
    match value {
        Value::Object(fields) => {
            for (key, inner) in fields {
                spoil(inner, &format!("{place}/{}", escaped(key)), note);
            }
        }
        Value::Array(items) => {
            for (i, inner) in items.iter().enumerate() {
                spoil(inner, &format!("{place}/{i}"), note);
            }
        }
        _ => {}
    }
}

/// The document without one key, for each key that is no name in a map.
fn lacking(document: &Value, optional: &[&str], maps: &[&str]) -> Vec<(String, Value)> {
    let mut all = Vec::new();
    let mut seen = std::collections::BTreeSet::new();
    spoil(document, "", &mut |place, _| {
        let Some((parent, key)) = place.rsplit_once('/') else { return };
        let owner = parent.rsplit('/').next().unwrap_or_default();
        let shape: String = place.chars().filter(|c| !c.is_ascii_digit()).collect();
        if key.parse::<u32>().is_ok()
            || optional.contains(&key)
            || maps.contains(&owner)
            || !seen.insert(shape)
        {
            return;
        }
        let mut whole = document.clone();
        let parent = whole.pointer_mut(parent).and_then(Value::as_object_mut).expect("an object");
        parent.remove(key);
        all.push((place.to_owned(), whole));
    });
    all
}

/// Every value of another type and every key left out must be refused.
#[track_caller]
fn assert_strict(name: &str, document: &Value, optional: &[&str], maps: &[&str]) {
    let schema = Closed::of(name);
    schema.assert_accepts(document);
    let wrong = wrong_documents(document);
    assert!(wrong.len() > 3, "{name} has nothing that could be wrong");
    for (place, wrong) in wrong {
        assert!(!schema.accepts(&wrong), "{name}: another type at {place} is taken");
    }
    for (place, lacks) in lacking(document, optional, maps) {
        assert!(!schema.accepts(&lacks), "{name}: nothing at {place} is taken");
    }
    let mut more = document.clone();
    more.as_object_mut().expect("an object").insert("surplus".into(), Value::Null);
    assert!(!schema.accepts(&more), "{name}: an unknown key is taken");
}

#[test]
fn wrong_documents_are_refused() {
    let dir = tempfile::tempdir().expect("a directory");
    let out = dir.path().to_str().expect("plain names");
    let solved = printed(&["solve", RICH, "-o", out]).0;
    let compiled = printed(&["compile", RICH, "-o", out]).0;
    let plan = dir.path().join("plan.json");
    let verified = printed(&["verify", plan.to_str().expect("plain names"), REACH]).0;
    assert_strict("plan", &read(&plan), &[], &["set", "regions", "outside", "clear"]);
    assert_strict("ir", &read(&dir.path().join("relay.ir.json")), &[], &["set"]);
    assert_strict("solve", &solved, &["files"], &["conflicts", "rejection"]);
    let unsolved = printed(&["solve", UNSAT, "-o", out]).0;
    assert_strict("solve", &unsolved, &["scope"], &["beta", "half_widths", "conflicts", "rejection"]);
    assert_strict("compile", &compiled, &[], &[]);
    assert_strict("verify", &verified, &[], &[]);
    let plan = plan.to_str().expect("plain names");
    let maps = ["violations_by_kind", "least", "first_violations", "shortfalls"];
    let flown = printed(&["simulate", plan, RICH, "--runs", "20", "--exceed", "1.5"]).0;
    assert_strict("simulate", &flown, &[], &maps);
    assert_strict("check", &printed(&["check", WRONG]).0, &[], &[]);
}
