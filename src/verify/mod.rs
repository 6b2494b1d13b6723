//! The exact checker: whether a plan is one for a problem, from the problem and the plan alone.
//!
//! Everything is computed in rational arithmetic on the doubles of the plan as they stand; nothing
//! here knows how the plan was found. Each "there is" of the claim comes with its witness in the
//! plan, so that no solver is needed. Robots' sides of separating planes are strict, the pieces'
//! sides are not. What is checked, in this order (theory.md §2 has the tube's inequality):
//!
//! 1. `mission`: name, `set`, sampling time; `form`: names, sizes, indices, finite numbers;
//! 2. `tube`, `start`: the disturbance box holds whatever the model doesn't explain, for ever;
//! 3. `states`, `inputs`, `workspace`: bounds, less the tube;
//! 4. `regions`, `blockers`, `links`, `connectivity`, `separation`: labels and witnesses;
//! 5. `goals`: each formula on the lasso, unknown labels taken against it;
//! 6. `objective`: the value that the plan claims.
//!
//! When the form is wrong the rest is not looked at. The mission's horizon is no part of the check,
//! and a different source text is only reported ([`Report::same_text`]).

mod blockers;
mod bounds;
mod formulas;
mod goals;
mod json;
mod labels;
mod links;
mod objective;
mod regions;
mod report;
mod resolve;
mod separation;
mod shape;
mod tube;
mod zonotope;

pub use json::JsonReport;
pub use report::{Check, Failure, Kind, Report};

use crate::ir::Problem;
use crate::plan::Plan;
use report::{Ledger, Place};

/// Checks a plan against a problem that satisfies `ir`'s invariants.
pub fn verify(problem: &Problem, plan: &Plan) -> Report {
    nothing_is_forgotten(problem);
    let mut ledger = Ledger::default();
    mission(problem, plan, &mut ledger);
    if let Some(resolved) = resolve::resolve(problem, plan, &mut ledger) {
        tube::check(&resolved, &mut ledger);
        bounds::check(&resolved, &mut ledger);
        regions::check(&resolved, &mut ledger);
        blockers::check(&resolved, &mut ledger);
        links::check(&resolved, &mut ledger);
        separation::check(&resolved, &mut ledger);
        goals::check(&resolved, &mut ledger);
        objective::check(&resolved, plan.objective.as_ref(), &mut ledger);
    }
    ledger.into_report(problem.sha256.eq_ignore_ascii_case(&plan.mission.sha256))
}

/// Names every part of a problem with where it is looked at, so that a new one does not compile until
/// somebody has said where it is checked: a requirement that is forgotten here would be accepted.
fn nothing_is_forgotten(problem: &Problem) {
    let Problem {
        // `mission`
        name: _,
        set: _,
        step: _,
        // said, no part of the verdict
        sha256: _,
        // `resolve`, and everywhere
        dimension: _,
        robots: _,
        // `tube`, `bounds`
        models: _,
        workspace: _,
        // `regions`, `goals`
        regions: _,
        formulas: _,
        goals: _,
        // `blockers`, `links`
        blockers: _,
        bases: _,
        connectivity: _,
        // `separation`
        separation: _,
        // `objective`
        objective: _,
        // says nothing
        doc: _,
        // what was searched, no part of a plan
        horizon: _,
    } = problem;
}

/// Whether the plan says that it is one of this mission.
fn mission(problem: &Problem, plan: &Plan, ledger: &mut Ledger) {
    let same = |ledger: &mut Ledger, what: &str, holds: bool| {
        ledger.claim(Kind::Mission, holds, || (Place::default(), format!("the plan has another {what}")));
    };
    same(ledger, "mission's name", plan.mission.name == problem.name);
    same(ledger, "set of parameter assignments", plan.mission.set == problem.set);
    same(ledger, "sampling time", plan.step_s == problem.step.to_f64());
}
