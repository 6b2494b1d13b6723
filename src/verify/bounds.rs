//! States, inputs and the workspace: every bound, less the tube.

use super::report::{Kind, Ledger, Place};
use super::resolve::{Resolved, Robot};
use super::shape::rounded_norm;
use crate::exact::{Rational, dot};
use crate::ir::{Interval, Model, ModelId};

/// Checks z ⊕ Ω ⊆ 𝒳, v ⊕ μ(Ω) ⊆ 𝒰 (together where a bound is on both), positions in 𝒲.
pub(super) fn check(plan: &Resolved, ledger: &mut Ledger) {
    for kind in [Kind::States, Kind::Inputs, Kind::Workspace] {
        ledger.reach(kind);
    }
    for (id, model) in plan.problem.models.iter() {
        let bounds = Bounds::new(plan, id, model);
        for robot in plan.robots.values().filter(|r| r.model == id) {
            bounds.check(plan, robot, ledger);
        }
    }
}

/// A model's bounds with the tube's supports along them.
struct Bounds<'a> {
    model: &'a Model,
    /// Reach of e, down and up, for each bounded state.
    states: Vec<Option<(Rational, Rational)>>,
    /// Reach of the feedback, down and up.
    inputs: Vec<(Rational, Rational)>,
    /// Support along each mixed bound.
    mixed: Vec<Rational>,
    /// Support along each facet of the workspace.
    workspace: Vec<Rational>,
}

impl<'a> Bounds<'a> {
    fn new(plan: &Resolved, id: ModelId, model: &'a Model) -> Bounds<'a> {
        let tube = &plan.tubes[id];
        let unit = |size: usize, i: usize, sign: i64| {
            let mut a = vec![Rational::ZERO; size];
            a[i] = Rational::from(sign);
            a
        };
        let state = |i| [-1, 1].map(|sign| tube.support(&unit(model.n(), i, sign), &[]));
        let input = |i| [-1, 1].map(|sign| tube.support(&[], &unit(model.m(), i, sign)));
        let bounded = |i: usize| model.state_bounds[i].as_ref().map(|_| state(i).into());
        Bounds {
            model,
            states: (0..model.n()).map(bounded).collect(),
            inputs: (0..model.m()).map(|i| input(i).into()).collect(),
            mixed: model
                .mixed_bounds
                .iter()
                .map(|bound| {
                    let (a, b) = bound.normal.split_at(model.n());
                    tube.support(a, b)
                })
                .collect(),
            workspace: plan
                .problem
                .workspace
                .facets
                .iter()
                .map(|f| tube.positions.support(&f.normal))
                .collect(),
        }
    }

    fn check(&self, plan: &Resolved, robot: &Robot, ledger: &mut Ledger) {
        for t in plan.steps() {
            let place = |name: &str| Place::robot(robot.name).about(name).at(t);
            for (i, reach) in self.states.iter().enumerate() {
                if let (Some(reach), Some(bound)) = (reach, &self.model.state_bounds[i]) {
                    let name = &self.model.states[i].name;
                    interval(Kind::States, &robot.z[t][i], reach, bound, || place(name), ledger);
                }
            }
            for (i, reach) in self.inputs.iter().enumerate() {
                let name = &self.model.inputs[i].name;
                let bound = &self.model.input_bounds[i];
                interval(Kind::Inputs, &robot.v[t][i], reach, bound, || place(name), ledger);
            }
            self.mixed(robot, t, ledger);
            for (facet, reach) in plan.problem.workspace.facets.iter().zip(&self.workspace) {
                let slack = &facet.offset - dot(&facet.normal, &robot.p[t]) - reach;
                let failure = || (Place::robot(robot.name).at(t), "the tube leaves the workspace".into());
                ledger.not_negative(Kind::Workspace, &slack, rounded_norm(&facet.normal), failure);
            }
        }
    }

    fn mixed(&self, robot: &Robot, t: usize, ledger: &mut Ledger) {
        for (index, (bound, reach)) in self.model.mixed_bounds.iter().zip(&self.mixed).enumerate() {
            let (a, b) = bound.normal.split_at(self.model.n());
            let slack = &bound.offset - dot(a, &robot.z[t]) - dot(b, &robot.v[t]) - reach;
            // A bound on states alone is one of 𝒳, any other limits the inputs.
            let kind = if b.iter().all(Rational::is_zero) { Kind::States } else { Kind::Inputs };
            ledger.not_negative(kind, &slack, rounded_norm(&bound.normal), || {
                (Place::robot(robot.name).at(t), format!("half-space {index} of `bound where` is violated"))
            });
        }
    }
}

fn interval(
    kind: Kind,
    value: &Rational,
    (down, up): &(Rational, Rational),
    bound: &Interval,
    place: impl Fn() -> Place,
    ledger: &mut Ledger,
) {
    for slack in [&bound.hi - value - up, value - down - &bound.lo] {
        ledger.not_negative(kind, &slack, 1.0, || {
            (place(), format!("beyond its bound by {:.3e}, the tube included", -slack.to_f64()))
        });
    }
}
