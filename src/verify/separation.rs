//! Separation: one axis and side for each pair, at both ends of each step.

use super::report::{Kind, Ledger, Place};
use super::resolve::{Apart, Resolved};
use crate::exact::Rational;
use crate::ir::RobotId;

/// Checks every pair at every step; nothing without `separation`.
pub(super) fn check(plan: &Resolved, ledger: &mut Ledger) {
    let Some(least) = &plan.problem.separation else { return };
    ledger.reach(Kind::Separation);
    let none = Vec::new();
    for t in plan.steps() {
        let sides = plan.separation.get(t).unwrap_or(&none);
        for side in sides {
            apart(plan, side, t, least, ledger);
        }
        for (first, second) in pairs(plan) {
            let listed =
                |s: &Apart| (s.first, s.second) == (first, second) || (s.second, s.first) == (first, second);
            ledger.claim(Kind::Separation, sides.iter().any(listed), || {
                (Place::robot(&names(plan, first, second)).at(t), "the pair has no side".into())
            });
        }
    }
}

/// sign·(z_1 − z_2)[axis] ≥ ε + both tubes, now and at the next step.
fn apart(plan: &Resolved, side: &Apart, t: usize, least: &Rational, ledger: &mut Ledger) {
    let (first, second) = (&plan.robots[side.first], &plan.robots[side.second]);
    let tubes = plan.tube(side.first).positions.reach(side.axis, -side.sign)
        + plan.tube(side.second).positions.reach(side.axis, side.sign);
    let needed = least + tubes;
    for (end, when) in [(t, "at the step"), (plan.next(t), "at the step after")] {
        let distance = &first.p[end][side.axis] - &second.p[end][side.axis];
        let slack = if side.sign < 0 { -distance } else { distance } - &needed;
        ledger.not_negative(Kind::Separation, &slack, 1.0, || {
            let place = Place::robot(&names(plan, side.first, side.second)).at(t);
            (place, format!("too close along axis {} {when}", side.axis))
        });
    }
}

fn pairs(plan: &Resolved) -> impl Iterator<Item = (RobotId, RobotId)> {
    plan.robots.ids().flat_map(|j| plan.robots.ids().take_while(move |i| *i != j).map(move |i| (i, j)))
}

fn names(plan: &Resolved, first: RobotId, second: RobotId) -> String {
    format!("{} and {}", plan.robots[first].name, plan.robots[second].name)
}
