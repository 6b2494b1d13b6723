//! From a plan to `plan.json`.

use std::collections::BTreeMap;

use super::{FORMAT, VERSION};
use crate::json::lay_out;
use crate::plan::{Apart, Label, Link, Objective, Plan, RobotPlan, Separator, Tube};

/// Writes a plan; the same plan gives the same text.
///
/// Every finite double is written with the fewest digits that give the same double back. (One that
/// is not finite is no number of JSON: it becomes `null`, which no reader takes.)
pub fn write(plan: &Plan) -> String {
    let tree = object([
        ("format", text(FORMAT)),
        ("version", natural(VERSION as usize)),
        ("tool", text(&plan.tool)),
        (
            "mission",
            object([
                ("name", text(&plan.mission.name)),
                ("sha256", text(&plan.mission.sha256)),
                ("set", map(&plan.mission.set, |s| text(s))),
            ]),
        ),
        ("step_s", number(&plan.step_s)),
        ("length", natural(plan.length)),
        ("loop_start", natural(plan.loop_start)),
        ("tubes", list(&plan.tubes, tube)),
        ("robots", list(&plan.robots, robot)),
        ("links", optional(&plan.links, |steps| list(steps, |links| list(links, link)))),
        ("separation", list(&plan.separation, |pairs| list(pairs, apart))),
        ("objective", optional(&plan.objective, objective)),
    ]);
    lay_out(&tree)
}

fn tube(tube: &Tube) -> Json {
    let disturbance = object([("center", row(&tube.center)), ("half_width", row(&tube.half_width))]);
    object([
        ("dynamics", text(&tube.dynamics)),
        ("disturbance", disturbance),
        ("reserve", row(&tube.reserve)),
        ("D", list(&tube.d, |matrix| list(matrix, |r| row(r)))),
        ("M", list(&tube.m, |matrix| list(matrix, |r| row(r)))),
    ])
}

fn robot(robot: &RobotPlan) -> Json {
    let pieces = |pieces: &Vec<Separator>| list(pieces, separator);
    object([
        ("name", text(&robot.name)),
        ("dynamics", text(&robot.dynamics)),
        ("z", list(&robot.z, |r| row(r))),
        ("v", list(&robot.v, |r| row(r))),
        ("regions", map(&robot.regions, |labels| list(labels, label))),
        ("outside", map(&robot.outside, |steps| list(steps, |step| optional(step, pieces)))),
        ("clear", map(&robot.clear, |steps| list(steps, pieces))),
    ])
}

fn label(label: &Label) -> Json {
    text(match label {
        Label::In => "in",
        Label::Out => "out",
        Label::Unknown => "unknown",
    })
}

fn separator(s: &Separator) -> Json {
    object([("piece", natural(s.piece)), ("normal", row(&s.normal)), ("offset", number(&s.offset))])
}

fn link(link: &Link) -> Json {
    let named = |(blocker, s): &(String, Separator)| {
        object([
            ("blocker", text(blocker)),
            ("piece", natural(s.piece)),
            ("normal", row(&s.normal)),
            ("offset", number(&s.offset)),
        ])
    };
    object([
        ("from", text(&link.from)),
        ("to", text(&link.to)),
        ("hops", natural(link.hops)),
        ("separators", list(&link.separators, named)),
    ])
}

fn apart(apart: &Apart) -> Json {
    object([
        ("pair", array([text(&apart.pair.0), text(&apart.pair.1)])),
        ("axis", natural(apart.axis)),
        ("sign", apart.sign.to_string()),
    ])
}

fn objective(objective: &Objective) -> Json {
    object([
        ("kind", text(&objective.kind)),
        ("value", number(&objective.value)),
        ("bound", number(&objective.bound)),
        ("proved", objective.proved.to_string()),
    ])
}

/// JSON without white space between its parts.
type Json = String;

fn text(value: &str) -> Json {
    serde_json::Value::from(value).to_string()
}

fn natural(value: usize) -> Json {
    value.to_string()
}

fn number(value: &f64) -> Json {
    // Rust's own shortest form round-trips and, for finite values, is a number of JSON.
    if value.is_finite() { format!("{value:?}") } else { "null".into() }
}

fn row(values: &[f64]) -> Json {
    list(values, number)
}

fn list<T>(items: &[T], write: impl Fn(&T) -> Json) -> Json {
    array(items.iter().map(write))
}

fn array(items: impl IntoIterator<Item = Json>) -> Json {
    format!("[{}]", items.into_iter().collect::<Vec<_>>().join(","))
}

fn optional<T>(item: &Option<T>, write: impl Fn(&T) -> Json) -> Json {
    item.as_ref().map_or("null".into(), write)
}

fn map<T>(items: &BTreeMap<String, T>, write: impl Fn(&T) -> Json) -> Json {
    fields(items.iter().map(|(key, value)| (key.as_str(), write(value))))
}

fn object<const N: usize>(members: [(&str, Json); N]) -> Json {
    fields(members)
}

fn fields<'a>(members: impl IntoIterator<Item = (&'a str, Json)>) -> Json {
    let members = members.into_iter().map(|(key, value)| format!("{}:{value}", text(key)));
    format!("{{{}}}", members.collect::<Vec<_>>().join(","))
}
