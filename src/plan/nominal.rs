//! Nominal plans: what a search finds, before the witnesses.

use crate::encode::Link;
use crate::ir::Problem;

/// A nominal plan with what it relies on.
#[derive(Clone, Debug)]
pub struct Nominal {
    /// L.
    pub length: usize,
    /// k.
    pub loop_start: usize,
    /// z: by robot, L + 1 states.
    pub states: Vec<Vec<Vec<f64>>>,
    /// v: by robot, L + 1 inputs.
    pub inputs: Vec<Vec<Vec<f64>>>,
    /// By step: the links that the plan relies on; empty with `connectivity none`.
    pub links: Vec<Vec<Link>>,
    /// Whether all shorter lengths of the horizon are refuted.
    pub shortest: bool,
}

impl Nominal {
    /// By robot and step, the nominal positions.
    pub fn positions(&self, problem: &Problem) -> Vec<Vec<Vec<f64>>> {
        let path = |(robot, states): (&crate::ir::Robot, &Vec<Vec<f64>>)| {
            let position = &problem.models[robot.model].position;
            let at = |z: &Vec<f64>| position.iter().map(|&s| z[s]).collect();
            states.iter().map(at).collect()
        };
        problem.robots.values().zip(&self.states).map(path).collect()
    }
}
