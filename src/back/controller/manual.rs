//! What people read first: `Cargo.toml`, `README.md` and `src/lib.rs`.

use std::fmt::Write;

use super::words::{code, doc, literal};
use super::{Contents, RUST};

/// `Cargo.toml`.
pub(super) fn manifest(contents: &Contents<'_>) -> String {
    format!(
        "\
# Written by {tool}.
[package]
name = \"{package}\"
version = \"0.1.0\"
edition = \"2021\"
rust-version = \"{RUST}\"
description = \"Controllers for a team of robots, with the plan that they follow\"
publish = false

# It has no dependencies, and may lie inside another workspace.
[workspace]
",
        tool = contents.plan.tool.replace(|c: char| !c.is_ascii_graphic() && c != ' ', "?"),
        package = contents.names.package,
    )
}

/// `README.md`.
pub(super) fn readme(contents: &Contents<'_>) -> String {
    let names = &contents.names;
    let mut text = format!(
        "\
# {package}

{what}

`no_std`, no `unsafe`, no dependencies, no heap, no path to a panic. Rust {RUST} or later.

## Use

Call `step` once each sampling time ({step} s) with the state that was just measured, apply the input
that it gives, and look at the status.

```rust
{example}```

`status.holds()` says that the promise of the plan holds: the last step was disturbed no more than the
mission allows, and nothing larger is still remembered. Where it does not,

- `status.assumption` says whether the disturbance was larger (of which state, by how much), or the
  measurement no number or missing;
- `status.containment` says whether the robot is outside its tube, may be, or has just come back;
- `status.state_near` and `status.input_near` say which state or input is near its bound.

The controller goes on tracking in any case. Where nothing usable is measured it gives out a
`Fallback`: `Predict` (what the law says without a new disturbance), `Hold` (the last input) or
`Fixed` (an input of yours); choose with `with_fallback`. Inputs are always numbers within their bounds.

`output.moment` is an index into the plan: `links::next_hop(output.moment, Node::{first})` is whom the
robot sends to now.

## What is proved

The plan was checked in exact arithmetic. While each disturbance is in the mission's box, every state
stays in its tube, with this very law in `{real}`: its rounding is bounded from the tables, and fits what
the plan keeps for it.

{rounding}
What is not covered: models that are wrong by more than the disturbance allows, sensors whose error is
not part of the disturbance, and what happens between sampling times.
",
        package = names.package,
        what = about(contents),
        step = seconds(contents),
        example = example(contents),
        first = names.robots.first().map_or("", String::as_str),
        real = contents.float,
        rounding = rounding(contents),
    );
    let _ = writeln!(text, "Mission {}, SHA-256 of its text", code(&contents.problem.name));
    let _ = writeln!(text, "`{}`,\nof plan.json `{}`.", contents.problem.sha256, contents.hash);
    text
}

/// `src/lib.rs`.
pub(super) fn library(contents: &Contents<'_>) -> String {
    let problem = contents.problem;
    let mut text = format!("//! {}\n", about(contents));
    if !problem.doc.is_empty() {
        text.push_str("//!\n");
        text.push_str(&doc("//! ", &problem.doc));
    }
    text.push_str("//!\n//! # Use\n//!\n//! ```\n");
    text.push_str(
        &example(contents)
            .lines()
            .map(|line| format!("//! {line}").trim_end().to_owned() + "\n")
            .collect::<String>(),
    );
    text.push_str("//! ```\n//!\n//! # What is proved\n//!\n");
    text.push_str(
        &rounding(contents)
            .lines()
            .map(|line| format!("//! {line}").trim_end().to_owned() + "\n")
            .collect::<String>(),
    );
    let robots = contents.names.robots.join(", ");
    let _ = write!(
        text,
        "
#![no_std]
#![forbid(unsafe_code)]
#![warn(missing_docs)]
// The mission's own words are plain text; hashes are long.
#![allow(clippy::doc_markdown, clippy::unreadable_literal)]

pub mod dynamics;
pub mod law;
pub mod links;
mod robots;

pub use law::{{Assumption, Containment, Fallback, Reading}};
pub use links::Node;
#[rustfmt::skip]
pub use robots::{{{robots}}};

/// The type of all states, inputs and tables.
pub type Real = {real};

/// What a monitor says of a step.
pub type Status = law::Status<Real>;

/// The mission's name.
pub const MISSION: &str = {mission};
/// SHA-256 of the mission's text.
pub const MISSION_SHA256: &str = {mission_hash};
/// SHA-256 of the plan that this was written from.
pub const PLAN_SHA256: &str = {plan_hash};
/// The sampling time, in seconds.
pub const STEP_SECONDS: f64 = {step};
/// The moment that comes after the last one of the plan.
pub const LOOP_START: usize = {loop_start};

// Tables of two plans do not go together.
const _: () = assert!(dynamics::PLAN == PLAN && robots::PLAN == PLAN && links::PLAN == PLAN);

{stamp}
/// What a controller says at a step; `I` is the dynamics' `Input`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Output<I> {{
    /// What to apply until the next step.
    pub input: I,
    /// What the monitor says.
    pub status: Status,
    /// The moment of the plan that this is: an index into [`links::NEXT_HOP`] and [`links::LINKS`].
    pub moment: usize,
}}
",
        real = contents.float,
        mission = literal(&problem.name),
        mission_hash = literal(&problem.sha256),
        plan_hash = literal(&contents.hash),
        step = seconds(contents),
        loop_start = contents.plan.loop_start,
        stamp = contents.stamp(),
    );
    text
}

/// What the crate is, in a sentence.
fn about(contents: &Contents<'_>) -> String {
    let robots: Vec<String> = contents.problem.robots.values().map(|robot| code(&robot.name)).collect();
    let robots = if robots.len() > MANY { format!("{} robots", robots.len()) } else { robots.join(", ") };
    format!("Controllers of {robots} in the mission {}.", code(&contents.problem.name))
}

/// More robots than this are only counted.
const MANY: usize = 8;

/// How a controller is used; nothing in it but names that were made for the crate.
fn example(contents: &Contents<'_>) -> String {
    let names = &contents.names;
    let robot = names.robots.first().map_or("", String::as_str);
    format!(
        "\
use {library}::{{Node, {robot}, links}};

let mut controller = {robot}::new();
// Your sensors' business; here it is where the mission starts.
let measured = {robot}::start();
let output = controller.step(&measured);
assert!(output.status.holds());
let _apply = output.input;
let _send_to = links::next_hop(output.moment, Node::{robot});
",
        library = names.library,
    )
}

/// A table of what is proved of the rounding.
fn rounding(contents: &Contents<'_>) -> String {
    let mut text =
        String::from("| state | rounding takes at most | the plan keeps for it |\n| --- | --- | --- |\n");
    for part in &contents.models {
        let model = &contents.problem.models[part.id];
        for (i, signal) in model.states.iter().enumerate() {
            let name = code(&format!("{}.{}", model.name, signal.name));
            let (needed, reserve) = (part.rounding.needed[i].to_f64_up(), part.tube.reserve[i]);
            let _ = writeln!(text, "| {name} | {needed:.2e} | {reserve:.2e} |");
        }
    }
    text.push('\n');
    text
}

fn seconds(contents: &Contents<'_>) -> String {
    format!("{:?}", contents.plan.step_s)
}
