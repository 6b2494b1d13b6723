//! Runs as rows of comma-separated values: one a run, robot and step.
//!
//! Numbers are written so that reading them gives the same doubles; with A, B and c of the mission each
//! state follows from the row before it, x⁺ = A x + B u + c + w. States and inputs of other models than
//! the robot's are empty, and so is the disturbance after the last step.

use std::fmt::Write;

use super::{Options, Place, Way, Word, disturbance};
use crate::entity::EntityId;
use crate::ir::{Model, Problem, RobotId, Signal};

/// Writes rows.
pub struct Rows<'a> {
    problem: &'a Problem,
    options: &'a Options,
    states: Vec<&'a str>,
    inputs: Vec<&'a str>,
}

impl<'a> Rows<'a> {
    /// Rows of runs of a problem.
    pub fn new(problem: &'a Problem, options: &'a Options) -> Rows<'a> {
        let states = distinct(problem.models.values().flat_map(|m| &m.states));
        let inputs = distinct(problem.models.values().flat_map(|m| &m.inputs));
        Rows { problem, options, states, inputs }
    }

    /// The names of the columns, with a line end.
    pub fn head(&self) -> String {
        let mut head = String::from("run,disturbance,robot,step");
        for (prefix, names) in [("x", &self.states), ("u", &self.inputs), ("w", &self.states)] {
            names.iter().for_each(|name| {
                head.push(',');
                head.push_str(&field(&format!("{prefix}.{name}")));
            });
        }
        head + ",monitor,tube,excess_of,excess\n"
    }

    /// A run's rows, each with a line end.
    pub fn run(&self, run: u64, ways: &[Way]) -> String {
        let mut text = String::new();
        let kind = disturbance(self.options, run).name();
        for (index, way) in ways.iter().enumerate() {
            let Some(robot) = self.problem.robots.get(RobotId::new(index)) else { continue };
            let model = &self.problem.models[robot.model];
            let name = field(&robot.name);
            for step in 0..way.samples() {
                let _ = write!(text, "{run},{kind},{name},{step}");
                self.numbers(&mut text, &self.states, &model.states, Some(way.state(step)));
                self.numbers(&mut text, &self.inputs, &model.inputs, Some(way.input(step)));
                let push = (step + 1 < way.samples()).then(|| way.push(step));
                self.numbers(&mut text, &self.states, &model.states, push);
                self.report(&mut text, way, step, model);
            }
        }
        text
    }

    fn numbers(&self, text: &mut String, columns: &[&str], signals: &[Signal], values: Option<&[f64]>) {
        for column in columns {
            let place = signals.iter().position(|signal| signal.name == *column);
            let value = place.and_then(|i| values?.get(i));
            text.push(',');
            if let Some(value) = value {
                let _ = write!(text, "{value:?}");
            }
        }
    }

    fn report(&self, text: &mut String, way: &Way, step: usize, model: &Model) {
        let report = &way.reports[step];
        let place = match report.place {
            Place::Inside => "inside",
            Place::Returned => "returned",
            Place::Unproved => "unproved",
            Place::Outside => "outside",
        };
        let of = || model.states.get(usize::from(report.component)).map_or("", |s| s.name.as_str());
        let _ = match report.word {
            Word::Within => writeln!(text, ",within,{place},,"),
            Word::Exceeded => writeln!(text, ",exceeded,{place},{},{:?}", field(of()), report.amount),
            Word::NotANumber => writeln!(text, ",not_a_number,{place},{},", field(of())),
        };
    }
}

fn distinct<'a>(signals: impl Iterator<Item = &'a Signal>) -> Vec<&'a str> {
    let mut names: Vec<&str> = Vec::new();
    for signal in signals {
        if !names.contains(&signal.name.as_str()) {
            names.push(&signal.name);
        }
    }
    names
}

/// A field, in quotes where it has to be (RFC 4180): names of families' members have commas.
fn field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.into()
    }
}
