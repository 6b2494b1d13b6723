//! Forgeries at random places of `plan.json`: each is refused, or does no harm.
//!
//! Every leaf and every list of the file is changed in turn. A forgery that the checker lets pass
//! must still fly (see `sampling`), unless what was changed is information that claims nothing.

use dosmc::ir::Problem;
use dosmc::plan::{Plan, json};
use dosmc::verify::verify;
use serde_json::Value;

use crate::cases::relay;
use crate::sampling::{Dice, counterexample};
use crate::scene::Scene;

/// A place in the file: keys and indices from the root.
pub type Path = Vec<String>;

fn paths(value: &Value, at: &mut Path, found: &mut Vec<Path>) {
    found.push(at.clone());
    let members: Vec<(String, &Value)> = match value {
        Value::Array(items) => items.iter().enumerate().map(|(i, v)| (i.to_string(), v)).collect(),
        Value::Object(fields) => fields.iter().map(|(k, v)| (k.clone(), v)).collect(),
        _ => vec![],
    };
    for (key, member) in members {
        at.push(key);
        paths(member, at, found);
        at.pop();
    }
}

/// The `which`-th change of a value; `None` when there are no more.
fn change(value: &Value, which: usize, other_names: &[&str]) -> Option<Value> {
    match value {
        Value::Number(number) if number.is_f64() => {
            let x = number.as_f64().unwrap();
            let nudge = *[1e-6, -1e-6, 1e-3, -1e-3, 0.3, -0.3, 1.0, -2.0].get(which)?;
            Some(Value::from(if x == 0.0 { nudge } else { x * (1.0 + nudge) }))
        }
        Value::Number(number) => {
            let n = number.as_i64().unwrap();
            [n + 1, n - 1, n + 7, -n, 0].get(which).filter(|&&other| other != n).map(|&n| Value::from(n))
        }
        Value::String(text) => {
            other_names.iter().filter(|other| *other != text).nth(which).map(|&n| n.into())
        }
        Value::Bool(truth) => (which == 0).then(|| Value::from(!truth)),
        Value::Null => (which == 0).then(|| Value::Array(vec![])),
        Value::Array(items) if !items.is_empty() => {
            let mut items = items.clone();
            match which {
                0 => drop(items.pop()),
                1 => drop(items.remove(0)),
                2 => items.push(items[0].clone()),
                3 => items.reverse(),
                4 => items.rotate_left(1),
                5 => return Some(Value::Null),
                6 => items.clear(),
                _ => return None,
            }
            Some(Value::Array(items))
        }
        Value::Array(_) => None,
        Value::Object(fields) => {
            let mut fields = fields.clone();
            let key = fields.keys().nth(which)?.clone();
            fields.remove(&key);
            Some(Value::Object(fields))
        }
    }
}

/// Whether what stands there claims nothing (interfaces.md calls it information).
fn information(path: &[String]) -> bool {
    let last = path.last().map_or("", String::as_str);
    ["tool", "sha256", "hops"].contains(&last)
}

/// Whether any change there must be refused, because no slack and no other order excuses it.
fn binding(path: &[String]) -> bool {
    let last = path.iter().rev().find(|key| key.parse::<usize>().is_err()).map_or("", String::as_str);
    const BINDING: [&str; 24] = [
        "format",
        "version",
        "name",
        "set",
        "radius",
        "step_s",
        "length",
        "loop_start",
        "dynamics",
        "center",
        "D",
        "M",
        "z",
        "v",
        "piece",
        "from",
        "to",
        "blocker",
        "pair",
        "axis",
        "sign",
        "objective",
        "disturbance",
        "mission",
    ];
    BINDING.contains(&last)
}

/// What became of the forgeries.
#[derive(Default)]
pub struct Tally {
    pub refused: usize,
    pub passed: Vec<(Path, usize)>,
}

/// Makes one in `every` of all forgeries at the chosen places; those at binding places must be
/// refused.
pub fn forge(
    problem: &Problem,
    plan: &Plan,
    chosen: impl Fn(&Path) -> bool,
    binding: impl Fn(&[String]) -> bool,
    every: usize,
    runs: usize,
) -> Tally {
    let original: Value = serde_json::from_str(&json::write(plan)).unwrap();
    let names =
        ["R1", "R2", "B1", "J1", "wall", "pi1", "pi2", "in", "out", "unknown", "Rover0", "Rover1", "x"];
    let mut all = vec![];
    paths(&original, &mut vec![], &mut all);
    let (mut tally, mut dice, mut count) = (Tally::default(), Dice(1), 0);
    for path in all.into_iter().filter(chosen) {
        let pointer: String = path.iter().map(|key| format!("/{key}")).collect();
        let here = original.pointer(&pointer).unwrap();
        for which in 0.. {
            let Some(other) = change(here, which, &names) else { break };
            count += 1;
            if other == *here || count % every != 0 {
                continue;
            }
            let mut forged = original.clone();
            *forged.pointer_mut(&pointer).unwrap() = other;
            match json::read(&forged.to_string()) {
                Ok(forged) if verify(problem, &forged).holds() => {
                    let place = || format!("{}, change {which}", path.join("."));
                    assert!(!binding(&path), "accepted: {}", place());
                    if !information(&path) {
                        let found = counterexample(problem, &forged, runs, &mut dice);
                        assert_eq!(found, None, "{}", place());
                    }
                    tally.passed.push((path.clone(), which));
                }
                _ => tally.refused += 1,
            }
        }
    }
    tally
}

#[test]
fn forgeries_are_refused_or_do_no_harm() {
    let (problem, plan) = relay(Scene::default());
    assert_eq!(counterexample(&problem, &plan, 60, &mut Dice(7)), None);
    let tally = forge(&problem, &plan, |_| true, binding, 9, 1);
    assert!(tally.refused > 700, "{} refused", tally.refused);
}

#[test]
fn planes_that_touch_the_tube_have_no_room() {
    let (problem, plan) = relay(Scene { tight: true, ..Scene::default() });
    assert_eq!(counterexample(&problem, &plan, 60, &mut Dice(7)), None);
    let own_offset = |path: &Path| {
        let is = |key: Option<&String>, name: &str| key.is_some_and(|key| key == name);
        is(path.first(), "robots") && is(path.last(), "offset")
    };
    let tally = forge(&problem, &plan, own_offset, binding, 1, 1);
    // Of the two smallest changes of an offset one moves the plane into the tube.
    let slight: Vec<&Path> =
        tally.passed.iter().filter(|(_, which)| *which < 2).map(|(path, _)| path).collect();
    let loose = slight.windows(2).find(|pair| pair[0] == pair[1]);
    assert!(loose.is_none(), "{loose:?}");
    assert!(slight.len() > 50);
}
