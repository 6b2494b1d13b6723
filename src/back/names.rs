//! What literals and numbers of an instance are called in files.

use crate::abstraction::Abstraction;
use crate::encode::{Leaf, Link, Meaning, Near, Variable};
use crate::entity::EntityId;
use crate::exact::Rational;
use crate::ir::{Problem, RobotId};

/// The names of a problem's parts.
pub struct Names<'a> {
    problem: &'a Problem,
}

impl<'a> Names<'a> {
    /// The names of a problem.
    pub fn new(problem: &'a Problem) -> Names<'a> {
        Names { problem }
    }

    /// `R1.z[3].px` or `R1.v[3].ax`; names in a mission hold letters, digits, `_`, brackets and
    /// commas alone.
    pub fn variable(&self, variable: &Variable) -> String {
        match *variable {
            Variable::State { robot, step, state } => {
                let signals = &self.problem.models[self.problem.robots[robot].model].states;
                format!("{}.z[{step}].{}", self.robot(robot), signals[state].name)
            }
            Variable::Input { robot, step, input } => {
                let signals = &self.problem.models[self.problem.robots[robot].model].inputs;
                format!("{}.v[{step}].{}", self.robot(robot), signals[input].name)
            }
        }
    }

    /// What a literal stands for, in a few words.
    pub fn meaning(&self, meaning: &Meaning, abstraction: &Abstraction) -> String {
        match meaning {
            Meaning::Length(length) => format!("length {length}"),
            Meaning::Loop { length, start } => format!("loop {length} to {start}"),
            Meaning::Link(link, step) => {
                let (from, to) = self.ends(*link);
                format!("link {from} {to} at {step}")
            }
            Meaning::Cell { robot, cell, step } => {
                format!("cell {} {} at {step}", self.robot(*robot), cell.index())
            }
            Meaning::Leaf(Leaf::HalfSpace { robot, step, half_space }) => {
                let direction: Vec<String> = abstraction.directions[half_space.direction]
                    .vector
                    .iter()
                    .map(|x| format!("{x:?}"))
                    .collect();
                let direction = direction.join(" ");
                format!(
                    "half-space {} ({direction}) <= {:?} at {step}",
                    self.robot(*robot),
                    half_space.offset
                )
            }
            Meaning::Leaf(Leaf::Apart(face)) => {
                let sign = if face.positive { '+' } else { '-' };
                let (first, second) = (self.robot(face.first), self.robot(face.second));
                format!("apart {first} {second} {sign}{} at {}", face.axis, face.step)
            }
            Meaning::Leaf(Leaf::Near(near)) => self.near(near),
        }
    }

    fn near(&self, near: &Near) -> String {
        let robots: Vec<&str> = near.robots().map(|(robot, _)| self.robot(robot)).collect();
        let normal: Vec<String> =
            near.normal.iter().take(self.problem.dimension).map(|x| format!("{x:?}")).collect();
        format!("near {} ({}) <= {:?} at {}", robots.join(" "), normal.join(" "), near.offset, near.step)
    }

    /// The names of a link's ends, a robot's first.
    pub fn ends(&self, link: Link) -> (&'a str, &'a str) {
        match link {
            Link::Robots(a, b) => (self.robot(a), self.robot(b)),
            Link::Base(robot, base) => (self.robot(robot), &self.problem.bases[base].name),
        }
    }

    /// A robot's name.
    pub fn robot(&self, robot: RobotId) -> &'a str {
        &self.problem.robots[robot].name
    }
}

/// The numerator and the denominator of a finite double, in lowest terms.
pub fn dyadic(value: f64) -> (String, String) {
    Rational::from_f64(value).unwrap_or_default().parts()
}
