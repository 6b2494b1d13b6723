//! From a plan to `plan.json`.

use std::collections::BTreeMap;

use super::{FORMAT, VERSION};
use crate::plan::{Apart, Label, Link, Objective, Plan, RobotPlan, Separator, Tube};

/// How wide a line may be before its array or object is broken.
const WIDTH: usize = 120;

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
    let mut out = String::new();
    tree.broken(0, &mut out);
    out.push('\n');
    out
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
        ("pair", Json::List(vec![text(&apart.pair.0), text(&apart.pair.1)])),
        ("axis", natural(apart.axis)),
        ("sign", Json::Leaf(apart.sign.to_string())),
    ])
}

fn objective(objective: &Objective) -> Json {
    object([
        ("kind", text(&objective.kind)),
        ("value", number(&objective.value)),
        ("bound", number(&objective.bound)),
        ("proved", Json::Leaf(objective.proved.to_string())),
    ])
}

/// What is to be laid out.
enum Json {
    /// A number, a string or a constant, as it is written.
    Leaf(String),
    /// An array.
    List(Vec<Json>),
    /// An object, keys as they are written.
    Object(Vec<(String, Json)>),
}

impl Json {
    /// The text on one line, if that takes `room` characters at most.
    fn inline(&self, room: usize) -> Option<String> {
        let mut out = String::new();
        self.append_inline(room, &mut out)?;
        Some(out)
    }

    fn append_inline(&self, room: usize, out: &mut String) -> Option<()> {
        match self {
            Json::Leaf(leaf) => out.push_str(leaf),
            Json::List(items) => {
                out.push('[');
                for (i, item) in items.iter().enumerate() {
                    out.push_str(if i > 0 { ", " } else { "" });
                    item.append_inline(room, out)?;
                }
                out.push(']');
            }
            Json::Object(fields) => {
                out.push('{');
                for (i, (key, value)) in fields.iter().enumerate() {
                    out.push_str(if i > 0 { ", " } else { "" });
                    out.push_str(key);
                    out.push_str(": ");
                    value.append_inline(room, out)?;
                }
                out.push('}');
            }
        }
        (out.len() <= room).then_some(())
    }

    /// Appends the text, on one line where it fits.
    fn laid_out(&self, indent: usize, out: &mut String) {
        match self.inline(WIDTH.saturating_sub(indent)) {
            Some(line) => out.push_str(&line),
            None => self.broken(indent, out),
        }
    }

    /// Appends the text with one line or more for each member.
    fn broken(&self, indent: usize, out: &mut String) {
        let inner = indent + 2;
        match self {
            Json::Leaf(leaf) => out.push_str(leaf),
            Json::List(items) => {
                out.push('[');
                for (i, item) in items.iter().enumerate() {
                    start_line(i, inner, out);
                    item.laid_out(inner, out);
                }
                end_lines(indent, out, ']');
            }
            Json::Object(fields) => {
                out.push('{');
                for (i, (key, value)) in fields.iter().enumerate() {
                    start_line(i, inner, out);
                    out.push_str(key);
                    out.push_str(": ");
                    value.laid_out(inner, out);
                }
                end_lines(indent, out, '}');
            }
        }
    }
}

fn start_line(index: usize, indent: usize, out: &mut String) {
    out.push_str(if index > 0 { ",\n" } else { "\n" });
    out.extend(std::iter::repeat_n(' ', indent));
}

fn end_lines(indent: usize, out: &mut String, bracket: char) {
    out.push('\n');
    out.extend(std::iter::repeat_n(' ', indent));
    out.push(bracket);
}

fn text(value: &str) -> Json {
    Json::Leaf(quoted(value))
}

fn quoted(value: &str) -> String {
    serde_json::Value::from(value).to_string()
}

fn natural(value: usize) -> Json {
    Json::Leaf(value.to_string())
}

fn number(value: &f64) -> Json {
    // Rust's own shortest form round-trips and, for finite values, is a number of JSON.
    Json::Leaf(if value.is_finite() { format!("{value:?}") } else { "null".into() })
}

fn row(values: &[f64]) -> Json {
    list(values, number)
}

fn list<T>(items: &[T], write: impl Fn(&T) -> Json) -> Json {
    Json::List(items.iter().map(write).collect())
}

fn optional<T>(item: &Option<T>, write: impl Fn(&T) -> Json) -> Json {
    item.as_ref().map_or(Json::Leaf("null".into()), write)
}

fn map<T>(items: &BTreeMap<String, T>, write: impl Fn(&T) -> Json) -> Json {
    Json::Object(items.iter().map(|(k, v)| (quoted(k), write(v))).collect())
}

fn object<const N: usize>(fields: [(&str, Json); N]) -> Json {
    Json::Object(fields.into_iter().map(|(k, v)| (quoted(k), v)).collect())
}
