//! Goals: every formula of the specification at step 0.

use super::formulas::{Lasso, evaluate};
use super::labels::label;
use super::report::{Kind, Ledger, Place};
use super::resolve::Resolved;
use crate::entity::EntityId;

/// Checks every goal with the labels that the plan claims (and that are checked elsewhere).
pub(super) fn check(plan: &Resolved, ledger: &mut Ledger) {
    ledger.reach(Kind::Goals);
    let lasso = Lasso { last: plan.length, loop_start: plan.loop_start };
    let values = evaluate(&plan.problem.formulas, lasso, |atom, t| label(plan, atom, t));
    for goal in &plan.problem.goals {
        let holds = values.get(goal.formula.index()).is_some_and(|value| value[0]);
        ledger.claim(Kind::Goals, holds, || (Place::subject(&goal.name), "the goal does not hold".into()));
    }
}
