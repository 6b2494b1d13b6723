//! Links of bounded length.
//!
//! A link literal switches on linear rows on the difference of both ends: those of the axes at once,
//! and for the Euclidean norm further tangents of the ball where a candidate needs them. Each row is
//! a consequence of the bound, so what they refute is refuted.

use super::Encoder;
use super::circuit::{Bit, Gate};
use super::leaf::{Leaf, Near};
use super::links::Link;
use crate::abstraction::{Ends, HalfSpace, LinkRange, dot};
use crate::ir::Problem;

impl Encoder<'_> {
    /// Demands that a link at a step, if it is used, is short enough along the axes. False when that
    /// has been demanded before, or links may be of any length.
    pub fn demand_range(&mut self, link: Link, step: usize) -> bool {
        let Some(range) = &self.abstraction.range else { return false };
        if !self.ranges.insert((link, step, None)) {
            return false;
        }
        range.axes().iter().for_each(|normal| self.bound_link(range, link, step, normal));
        true
    }

    /// Demands it along one more normal. False when that has been demanded before.
    pub fn demand_range_along(&mut self, link: Link, step: usize, normal: &[f64]) -> bool {
        let Some(range) = &self.abstraction.range else { return false };
        let key = normal.iter().map(|x| x.to_bits()).collect();
        let new = self.ranges.insert((link, step, Some(key)));
        if new {
            self.bound_link(range, link, step, normal);
        }
        new
    }

    fn bound_link(&mut self, range: &LinkRange, link: Link, step: usize, normal: &[f64]) {
        let offset = range.offset(link_models(self.problem, link), normal);
        let bit = match link {
            Link::Base(robot, base) => {
                let offset = offset + dot(normal, self.abstraction.base(base));
                match self.along_axis(normal) {
                    Some(direction) => self.half_space(robot, step, HalfSpace { direction, offset }),
                    None => self.near(Near::new(robot, None, step, normal, offset)),
                }
            }
            Link::Robots(first, second) => self.near(Near::new(first, Some(second), step, normal, offset)),
        };
        let lit = self.links[step].literal(link);
        self.circuit.grow(lit, bit);
    }

    fn along_axis(&self, normal: &[f64]) -> Option<crate::abstraction::DirectionId> {
        let mut axes = (0..normal.len()).filter(|&axis| normal[axis] != 0.0);
        match (axes.next(), axes.next()) {
            (Some(axis), None) => Some(self.abstraction.directions.axis(axis, normal[axis] > 0.0)),
            _ => None,
        }
    }

    fn near(&mut self, near: Near) -> Bit {
        if near.step > 0 {
            return Bit::Lit(self.circuit.define(Gate::Leaf(Leaf::Near(near))));
        }
        let problem = self.problem;
        let along = |robot: crate::ir::RobotId| -> f64 {
            let entry = &problem.robots[robot];
            let position = problem.models[entry.model].position.iter();
            position.zip(&near.normal).map(|(&s, x)| x * entry.start[s].to_f64()).sum()
        };
        Bit::from(along(near.first) - near.second.map_or(0.0, along) <= near.offset)
    }
}

/// The models at the ends of a link.
pub fn link_models(problem: &Problem, link: Link) -> Ends {
    match link {
        Link::Robots(a, b) => [a, b].map(|robot| Some(problem.robots[robot].model)),
        Link::Base(robot, _) => [Some(problem.robots[robot].model), None],
    }
}
