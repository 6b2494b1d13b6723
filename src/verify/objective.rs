//! The objective's value, computed again.

use super::report::{Kind, Ledger, Place};
use super::resolve::Resolved;
use crate::exact::Rational;
use crate::ir::Objective;
use crate::plan;

/// How far the claimed value may be from the exact one, relative to the latter: room for a sum of a
/// few thousand doubles, far below anything that matters to a reader.
const ROUNDING: f64 = 1e-9;

/// Checks the claimed value, if there is one; `bound` and `proved` are information.
pub(super) fn check(plan: &Resolved, claimed: Option<&plan::Objective>, ledger: &mut Ledger) {
    let Some(claimed) = claimed else { return };
    let fail = |ledger: &mut Ledger, message: &str| {
        ledger.fail(Kind::Objective, Place::default(), message.into());
    };
    let (name, value) = match plan.problem.objective {
        None => return fail(ledger, "the mission minimises nothing"),
        Some(Objective::Effort) => ("effort", effort(plan)),
        Some(Objective::Length) => ("length", length(plan)),
    };
    if claimed.kind != name {
        return fail(ledger, &format!("the mission minimises {name}"));
    }
    let (Some(said), Some(rounding)) = (Rational::from_f64(claimed.value), Rational::from_f64(ROUNDING))
    else {
        return fail(ledger, "the value is not finite");
    };
    let near = (&said - &value).abs() <= rounding * &value;
    ledger.claim(Kind::Objective, near, || {
        (Place::default(), format!("the value is {}, not {}", value.to_f64(), claimed.value))
    });
}

/// Σ_robots Σ_{t=0..L} ‖v_t‖₂².
fn effort(plan: &Resolved) -> Rational {
    plan.robots.values().flat_map(|r| r.v.iter().flatten()).map(|v| v * v).sum()
}

/// Σ_robots Σ ‖p_{t+1} − p_t‖_∞, the closing step included.
fn length(plan: &Resolved) -> Rational {
    let moved = |from: &[Rational], to: &[Rational]| {
        from.iter().zip(to).map(|(a, b)| (b - a).abs()).max().unwrap_or_default()
    };
    plan.robots.values().flat_map(|r| plan.steps().map(|t| moved(&r.p[t], &r.p[plan.next(t)]))).sum()
}
