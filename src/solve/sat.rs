//! The SAT solver: incremental, with assumptions and cores.

use std::sync::Arc;

use rustsat::solvers::{Solve, SolveIncremental, SolverResult};
use rustsat::types::{Assignment, Lit, TernaryVal, Var};
use rustsat_batsat::BasicSolver;

use super::Watch;
use crate::encode::Encoder;

/// The answer of a query.
#[derive(Clone, Debug)]
pub enum Answer {
    /// A model.
    Model(Model),
    /// None, and the assumptions over these variables suffice for that.
    Core(Vec<Var>),
    /// Time or memory ran out.
    Interrupted,
}

/// A model of the clauses.
#[derive(Clone, Debug)]
pub struct Model(Assignment);

impl Model {
    /// Whether a literal is true; one that the model leaves open counts as false.
    pub fn holds(&self, lit: Lit) -> bool {
        if lit.vidx() >= self.0.len() {
            return false;
        }
        self.0.lit_value(lit) == TernaryVal::True
    }
}

/// The solver of one search.
pub struct Sat {
    solver: BasicSolver,
    /// How many queries were made.
    pub calls: u64,
}

impl Sat {
    /// A solver without clauses that gives up when the watch says so.
    pub fn new(watch: Arc<dyn Watch>) -> Sat {
        let mut solver = BasicSolver::default();
        solver.batsat_mut().cb_mut().set_stop(move || watch.stop());
        Sat { solver, calls: 0 }
    }

    /// Adds the encoder's new clauses. False when memory runs out.
    pub fn read(&mut self, encoder: &mut Encoder<'_>) -> bool {
        encoder.write_clauses(&mut self.solver).is_ok()
    }

    /// Looks for a model in which all assumptions are true.
    pub fn query(&mut self, assumptions: &[Lit]) -> Answer {
        self.calls += 1;
        match self.solver.solve_assumps(assumptions) {
            Ok(SolverResult::Sat) => match self.solver.full_solution() {
                Ok(model) => Answer::Model(Model(model)),
                Err(_) => Answer::Interrupted,
            },
            Ok(SolverResult::Unsat) => match self.solver.core() {
                Ok(core) => Answer::Core(core.into_iter().map(|lit| lit.var()).collect()),
                Err(_) => Answer::Interrupted,
            },
            _ => Answer::Interrupted,
        }
    }
}
