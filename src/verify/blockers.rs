//! Chords: between two steps a robot misses every obstacle and jammer.

use super::regions::covered;
use super::report::{Kind, Ledger, Place};
use super::resolve::Resolved;
use super::shape::rounded_norm;
use crate::exact::dot;

/// Checks that one plane a piece clears both z_t ⊕ Ω and the state after it, hence their hull.
pub(super) fn check(plan: &Resolved, ledger: &mut Ledger) {
    ledger.reach(Kind::Blockers);
    for (id, robot) in plan.robots.iter() {
        let tube = &plan.tube(id).positions;
        for (blocker, steps) in robot.clear.iter() {
            let blocker = &plan.problem.blockers[blocker];
            for (t, planes) in steps.iter().enumerate() {
                let place = || Place::robot(robot.name).about(&blocker.name).at(t);
                covered(Kind::Blockers, planes, &blocker.shape, place, ledger);
                for plane in planes {
                    let room = &plane.offset - tube.support(&plane.normal);
                    let norm = rounded_norm(&plane.normal);
                    for (end, when) in [(t, "at the step"), (plan.next(t), "at the step after")] {
                        let slack = &room - dot(&plane.normal, &robot.p[end]);
                        ledger.positive(Kind::Blockers, &slack, norm, || {
                            (place(), format!("the plane of piece {} cuts the tube {when}", plane.piece))
                        });
                    }
                }
            }
        }
    }
}
