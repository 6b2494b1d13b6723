//! `src/robots.rs`: a type for each robot, and its nominal trajectory.

use std::fmt::Write;

use super::dynamics::column;
use super::words::{code, doc, literal};
use super::{Contents, RobotPart};
use crate::law::Float;
use crate::law::tracking::Moment;

/// What the file begins with.
const HEAD: &str = "\
//! The robots' controllers, and their nominal trajectories.

// The tables are numbers as they come, not constants of nature.
#![allow(clippy::approx_constant, clippy::excessive_precision, clippy::unreadable_literal)]
// The mission's own words are plain text.
#![allow(clippy::doc_markdown)]

use super::law::{Fallback, Moment, Path, Tracker};
use super::{dynamics, Node, Output};
";

/// The whole file.
pub(super) fn file(contents: &Contents<'_>) -> String {
    let mut text = format!("{HEAD}\n{}", contents.stamp());
    for (at, part) in contents.robots.iter().enumerate() {
        text.push('\n');
        text.push_str(&robot(contents, at, part));
        text.push('\n');
        text.push_str(&path(contents, at, part));
    }
    text
}

/// A robot's type.
fn robot(contents: &Contents<'_>, at: usize, part: &RobotPart) -> String {
    let robot = contents.problem.robots.values().nth(at);
    let (name, about) = robot.map_or(("", ""), |robot| (&robot.name, &robot.doc));
    let model = &contents.problem.models[contents.models[part.model].id];
    let (n, m, real) = (model.n(), model.m(), contents.float);
    let type_ = &contents.names.robots[at];
    let module = format!("dynamics::{}", contents.names.models[part.model].module);
    let mut text = format!("/// The controller of {}, a {}.\n", code(name), code(&model.name));
    if !about.is_empty() {
        text.push_str("///\n");
        text.push_str(&doc("/// ", about));
    }
    let _ = write!(
        text,
        "\
#[derive(Clone, Debug)]
pub struct {type_} {{
    tracker: Tracker<'static, [{real}; {n}], [{real}; {m}], {module}::Memory>,
}}

impl {type_} {{
    /// Which node of the radio network it is.
    pub const NODE: Node = Node::{type_};
    /// Its name in the mission.
    pub const NAME: &'static str = {literal};

    /// A controller at the first step; where nothing usable is measured, it goes by what it predicts.
    #[must_use]
    pub fn new() -> Self {{
        Self::with_fallback(Fallback::Predict)
    }}

    /// A controller at the first step, and what it does where nothing usable is measured.
    #[must_use]
    pub fn with_fallback(fallback: Fallback<{module}::Input>) -> Self {{
        let fallback = fallback.map(<[{real}; {m}]>::from);
        Self {{ tracker: Tracker::new(&{module}::TUBE, &PATH_{at}, fallback, {module}::FORGOTTEN) }}
    }}

    /// The state that the mission starts it in.
    #[must_use]
    pub fn start() -> {module}::State {{
        {module}::State::from({start})
    }}

    /// The input for a state that was just measured, and what the monitor says of it. To be called
    /// once each sampling time.
    pub fn step(&mut self, x: &{module}::State) -> Output<{module}::Input> {{
        let moment = self.tracker.moment();
        let (input, status) = self.tracker.step(&<[{real}; {n}]>::from(*x));
        Output {{ input: input.into(), status, moment }}
    }}

    /// The input for a sampling time at which nothing could be measured.
    pub fn missed(&mut self) -> Output<{module}::Input> {{
        let moment = self.tracker.moment();
        let (input, status) = self.tracker.missed();
        Output {{ input: input.into(), status, moment }}
    }}

    /// Goes back to the first step, with nothing remembered.
    pub fn reset(&mut self) {{
        self.tracker.reset();
    }}

    /// The moment of the plan that the next measurement belongs to.
    #[must_use]
    pub fn moment(&self) -> usize {{
        self.tracker.moment()
    }}
}}

impl Default for {type_} {{
    fn default() -> Self {{
        Self::new()
    }}
}}
",
        literal = literal(name),
        start = column(real, &part.start),
    );
    text
}

/// Its nominal trajectory.
fn path(contents: &Contents<'_>, at: usize, part: &RobotPart) -> String {
    let (real, path) = (contents.float, &part.path);
    let model = &contents.problem.models[contents.models[part.model].id];
    let (n, m) = (model.n(), model.m());
    let mut text = String::from("#[rustfmt::skip]\n");
    let _ = writeln!(text, "static PATH_{at}: Path<'static, [{real}; {n}], [{real}; {m}]> = Path {{");
    let (first, rest) =
        path.moments.split_first().map_or((None, path.moments.as_slice()), |(f, r)| (Some(f), r));
    if let Some(first) = first {
        let _ = writeln!(text, "    first: {},", moment(real, first));
    }
    text.push_str("    rest: &[\n");
    for entry in rest {
        let _ = writeln!(text, "        {},", moment(real, entry));
    }
    let _ = writeln!(text, "    ],\n    loop_start: {},\n}};", path.loop_start);
    text
}

fn moment(real: Float, moment: &Moment<Vec<f64>, Vec<f64>>) -> String {
    format!("Moment {{ z: {}, v: {} }}", column(real, &moment.z), column(real, &moment.v))
}
