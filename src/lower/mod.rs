//! From typed mission to IR: what is left of the sugar ends here.
//!
//! Integrators become matrices, the derived temporal operators become until and release in negation
//! normal form, and models that no robot uses disappear. Nothing can fail: `check` has seen to it.

mod comparison;
mod formula;
mod model;

pub use formula::normalise;

use std::collections::BTreeSet;

use crate::check::typed;
use crate::entity::{EntityId, Table};
use crate::ir;

/// Lowers a mission, with the places of its parts beside it.
pub fn lower(mission: &typed::Mission) -> (ir::Problem, ir::Spans) {
    let used = used_dynamics(mission);
    let roots: Vec<typed::FormulaId> = mission.goals.iter().map(|goal| goal.formula).collect();
    let (formulas, roots) = normalise(&mission.formulas, &roots);
    let goals = mission.goals.iter().zip(roots);
    let problem = ir::Problem {
        name: mission.name.clone(),
        doc: mission.doc.clone(),
        sha256: mission.sha256.clone(),
        set: mission.set.clone(),
        dimension: mission.workspace.polytope.dimension(),
        step: mission.step.clone(),
        workspace: mission.workspace.polytope.clone(),
        regions: mission.regions.values().map(region).collect(),
        blockers: mission.blockers.values().map(blocker).collect(),
        bases: mission.bases.values().map(base).collect(),
        models: used.iter().map(|&id| model::model(&mission.dynamics[id])).collect(),
        robots: mission.robots.values().map(|r| robot(r, &used)).collect(),
        separation: mission.separation.as_ref().map(|(distance, _)| distance.clone()),
        connectivity: mission.connectivity.clone(),
        horizon: mission.horizon,
        objective: mission.objective,
        formulas,
        goals: goals.map(|(g, formula)| ir::Goal { name: g.name.clone(), formula }).collect(),
    };
    (problem, spans(mission, &used))
}

/// The models that some robot uses, in order of declaration.
fn used_dynamics(mission: &typed::Mission) -> Vec<typed::DynamicsId> {
    let used: BTreeSet<typed::DynamicsId> = mission.robots.values().map(|r| r.dynamics).collect();
    used.into_iter().collect()
}

fn shape(shape: &typed::Shape) -> ir::Shape {
    ir::Shape { pieces: shape.pieces.clone() }
}

fn region(region: &typed::Region) -> ir::Region {
    ir::Region {
        name: region.name.clone(),
        doc: region.doc.clone(),
        shape: shape(&region.shape),
        sure: region.sure.as_ref().map(shape),
    }
}

fn blocker(blocker: &typed::Blocker) -> ir::Blocker {
    ir::Blocker {
        name: blocker.name.clone(),
        doc: blocker.doc.clone(),
        kind: blocker.kind,
        shape: shape(&blocker.shape),
    }
}

fn base(base: &typed::Base) -> ir::Base {
    ir::Base { name: base.name.clone(), doc: base.doc.clone(), position: base.position.clone() }
}

fn robot(robot: &typed::Robot, used: &[typed::DynamicsId]) -> ir::Robot {
    let place = used.binary_search(&robot.dynamics).unwrap_or_default();
    ir::Robot {
        name: robot.name.clone(),
        doc: robot.doc.clone(),
        model: ir::ModelId::new(place),
        start: robot.start.clone(),
    }
}

fn spans(mission: &typed::Mission, used: &[typed::DynamicsId]) -> ir::Spans {
    ir::Spans {
        workspace: mission.workspace.span,
        regions: places(&mission.regions, |r| r.span),
        blockers: places(&mission.blockers, |b| b.span),
        bases: places(&mission.bases, |b| b.span),
        models: used.iter().map(|&id| model::spans(&mission.dynamics[id])).collect(),
        robots: places(&mission.robots, |r| r.span),
        goals: mission.goals.iter().map(|g| g.span).collect(),
        separation: mission.separation.as_ref().map(|(_, span)| *span),
    }
}

fn places<I: EntityId, T, S>(table: &Table<I, T>, place: impl Fn(&T) -> S) -> Vec<S> {
    table.values().map(place).collect()
}
