//! Linear programs: the only module that names `microlp`.

use microlp::{ComparisonOp, Error, OptimizationDirection, Problem, Variable};

/// A minimisation over non-negative and free variables.
pub(super) struct Program {
    problem: Problem,
}

/// A variable of a [`Program`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Column(Variable);

/// Σ coefficient · variable.
pub(super) type Terms = Vec<(Column, f64)>;

/// What came of a program.
#[derive(Debug)]
pub(super) enum Answer {
    /// An optimal point.
    Optimal(Optimum),
    /// No point satisfies the constraints.
    Infeasible,
    /// The solver gave up: nothing is known.
    Failed,
}

/// An optimal point.
#[derive(Debug)]
pub(super) struct Optimum {
    solution: microlp::Solution,
}

impl Optimum {
    /// The value of a variable.
    pub(super) fn value(&self, column: Column) -> f64 {
        self.solution.var_value(column.0)
    }
}

impl Program {
    pub(super) fn new() -> Program {
        Program { problem: Problem::new(OptimizationDirection::Minimize) }
    }

    /// A variable that is at least 0, with its cost.
    pub(super) fn non_negative(&mut self, cost: f64) -> Column {
        Column(self.problem.add_var(cost, (0.0, f64::INFINITY)))
    }

    /// A variable without bounds and without cost.
    pub(super) fn free(&mut self) -> Column {
        Column(self.problem.add_var(0.0, (f64::NEG_INFINITY, f64::INFINITY)))
    }

    /// Requires `terms = value`.
    pub(super) fn equal(&mut self, terms: Terms, value: f64) {
        self.row(terms, ComparisonOp::Eq, value);
    }

    /// Requires `terms ≤ value`.
    pub(super) fn at_most(&mut self, terms: Terms, value: f64) {
        self.row(terms, ComparisonOp::Le, value);
    }

    fn row(&mut self, terms: Terms, op: ComparisonOp, value: f64) {
        self.problem.add_constraint(terms.into_iter().map(|(c, x)| (c.0, x)), op, value);
    }

    /// Solves the program; deterministic, no time limit.
    pub(super) fn solve(&self) -> Answer {
        match self.problem.solve().map(|outcome| outcome.into_solution()) {
            Ok(Ok(solution)) => Answer::Optimal(Optimum { solution }),
            Err(Error::Infeasible) => Answer::Infeasible,
            _ => Answer::Failed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_is_solved_or_said_to_be_infeasible() {
        let build = |least: f64| {
            let mut program = Program::new();
            let (x, y) = (program.non_negative(1.0), program.free());
            program.equal(vec![(x, 1.0), (y, 1.0)], 3.0);
            program.at_most(vec![(y, 1.0)], 2.0);
            program.at_most(vec![(x, 1.0)], least);
            (program.solve(), x, y)
        };
        let (answer, x, y) = build(5.0);
        let Answer::Optimal(optimum) = answer else { panic!("{answer:?}") };
        assert_eq!((optimum.value(x), optimum.value(y)), (1.0, 2.0));
        assert!(matches!(build(0.5).0, Answer::Infeasible));
    }
}
