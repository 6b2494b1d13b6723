//! Contradictions that don't rest on where the robots start, nor on the loop.
//!
//! A linear program's contradiction may mention the start or the loop though the half-spaces alone
//! exclude each other. The same half-spaces are asked again of a robot that starts anywhere: what is
//! then still impossible is so at every time and for every robot of the model.

use std::collections::BTreeMap;

use nalgebra::DVector;
use rustsat::types::Lit;

use crate::abstraction::Abstraction;
use crate::encode::Leaf;
use crate::entity::Table;
use crate::ir::{ModelId, Problem, RobotId};

use super::convex::{Conflict, Member, Node, Program, System};

/// The programs of robots that start anywhere, by model and block.
pub struct FreePrograms<'a> {
    problem: &'a Problem,
    abstraction: &'a Abstraction,
    systems: &'a Table<ModelId, System>,
    programs: BTreeMap<(ModelId, usize), (usize, Program<'a>)>,
}

impl<'a> FreePrograms<'a> {
    /// No programs yet.
    pub fn new(
        problem: &'a Problem,
        abstraction: &'a Abstraction,
        systems: &'a Table<ModelId, System>,
    ) -> FreePrograms<'a> {
        FreePrograms { problem, abstraction, systems, programs: BTreeMap::new() }
    }

    /// A robot whose start counts for nothing.
    pub fn member(&self, robot: RobotId) -> Member<'a> {
        let system = &self.systems[self.problem.robots[robot].model];
        Member::new(robot, system, DVector::zeros(system.n), 0)
    }

    /// A conflict of the same half-spaces that holds wherever the robot starts, if there is one.
    pub fn generalise(&mut self, conflict: &Conflict, length: usize) -> Option<(Conflict, RobotId)> {
        if conflict.free_from.is_some() {
            return None;
        }
        let rows: Vec<(Lit, Leaf)> = conflict.proof.terms.iter().filter_map(|t| t.constraint).collect();
        let (robot, block, first) = self.window(&rows)?;
        let key = (self.problem.robots[robot].model, block);
        let longest = length + 1;
        if self.programs.get(&key).is_none_or(|(reach, _)| *reach < longest) {
            let reach = longest.next_power_of_two();
            let system = &self.systems[key.0];
            let member = Member::new(robot, system, DVector::zeros(system.n), reach);
            let program = Program::free(self.abstraction, reach, member, Node { robot, block });
            self.programs.insert(key, (reach, program));
        }
        let (_, program) = self.programs.get_mut(&key)?;
        Some((program.refute_window(&rows, first)?, robot))
    }

    /// The robot, block and first step that several half-spaces have in common.
    fn window(&self, rows: &[(Lit, Leaf)]) -> Option<(RobotId, usize, usize)> {
        let mut found: Option<(RobotId, usize, usize)> = None;
        for (_, leaf) in rows {
            let Leaf::HalfSpace { robot, step, half_space } = *leaf else { return None };
            let system = &self.systems[self.problem.robots[robot].model];
            let vector = &self.abstraction.directions[half_space.direction].vector;
            let mut axes = (0..vector.len()).filter(|&axis| vector[axis] != 0.0);
            let state = system.position[axes.next()?];
            let block = system.blocks.iter().position(|b| b.states.contains(&state))?;
            if axes.any(|axis| !system.blocks[block].states.contains(&system.position[axis])) {
                return None;
            }
            found = match found {
                None => Some((robot, block, step)),
                Some((r, b, first)) if (r, b) == (robot, block) => Some((r, b, first.min(step))),
                Some(_) => return None,
            };
        }
        // One half-space alone excludes nothing that the bounds don't.
        found.filter(|_| rows.len() > 1)
    }
}
