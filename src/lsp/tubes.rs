//! The tube of one motion model, also where other declarations of its mission are wrong.
//!
//! A tube takes its time, so those found are kept: under everything that they depend on, which is the
//! model, the workspace and the starts of its robots.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use super::session::lock;
use crate::abstraction::ErrorSet;
use crate::check::{Facts, typed};
use crate::diag::Diagnostics;
use crate::entity::{EntityId, Table};
use crate::exact::Rational;
use crate::ir::{Model, RobotId};
use crate::law::Float;
use crate::lower::lower;
use crate::source::Span;
use crate::tube::{Tube, synthesize};

/// The most tubes that are kept.
const MOST_KEPT: usize = 64;

/// The tubes that were found so far.
#[derive(Default)]
pub struct Tubes {
    kept: Mutex<BTreeMap<String, Arc<ModelTube>>>,
}

/// A model with its tube.
pub struct ModelTube {
    /// The model as the planner sees it.
    pub model: Model,
    /// The tube; where there is none, why.
    pub tube: Result<Tube, String>,
    /// The part of the tube that robots' positions feel.
    pub errors: Option<ErrorSet>,
}

impl Tubes {
    /// The tube of a model; `None` where the mission has no workspace to fit it into.
    pub fn of(&self, facts: &Facts, id: typed::DynamicsId, float: Float) -> Option<Arc<ModelTube>> {
        let mission = alone(facts, id)?;
        let (problem, spans) = lower(&mission);
        let key = format!("{float:?} {problem}");
        if let Some(found) = lock(&self.kept).get(&key) {
            return Some(Arc::clone(found));
        }
        let model_id = problem.models.ids().next()?;
        let mut diagnostics = Diagnostics::new();
        let tube = match synthesize(&problem, &spans, float, &mut diagnostics) {
            Ok(tubes) => Ok(tubes.values().next()?.clone()),
            Err(_) => Err(diagnostics.iter().next().map_or_else(String::new, |d| d.message.clone())),
        };
        let model = problem.models[model_id].clone();
        let errors = tube.as_ref().ok().and_then(|tube| ErrorSet::new(&model, tube));
        let found = Arc::new(ModelTube { model, tube, errors });
        let mut kept = lock(&self.kept);
        if kept.len() >= MOST_KEPT {
            kept.clear();
        }
        kept.insert(key, Arc::clone(&found));
        Some(found)
    }
}

impl ModelTube {
    /// The tube's half-width along an axis of the workspace, in metres.
    pub fn half_width(&self, axis: usize) -> Option<f64> {
        let state = *self.model.position.get(axis)?;
        self.tube.as_ref().ok().map(|tube| tube.state_half_width(state))
    }
}

/// A mission of one model and its robots, at rest in the mission's workspace where it has none.
fn alone(facts: &Facts, id: typed::DynamicsId) -> Option<typed::Mission> {
    let dynamics = facts.dynamics().get(id)?.clone();
    let only = typed::DynamicsId::new(0);
    let nameless = |start: Vec<Rational>| typed::Robot {
        name: String::new(),
        doc: String::new(),
        dynamics: only,
        start,
        span: Span::default(),
    };
    let of_model = facts.robots(None).filter(|(_, robot)| robot.dynamics == id);
    let mut robots: Table<RobotId, typed::Robot> =
        of_model.map(|(_, robot)| nameless(robot.start.clone())).collect();
    if robots.is_empty() {
        robots.push(nameless(vec![Rational::ZERO; dynamics.states.len()]));
    }
    Some(typed::Mission {
        name: String::new(),
        doc: String::new(),
        sha256: String::new(),
        set: BTreeMap::new(),
        step: dynamics.step.clone(),
        workspace: facts.workspace.clone()?,
        regions: Table::new(),
        blockers: Table::new(),
        bases: Table::new(),
        dynamics: std::iter::once(dynamics).collect(),
        robots,
        separation: None,
        connectivity: None,
        horizon: (1, 1),
        objective: None,
        formulas: Table::new(),
        goals: Vec::new(),
    })
}

/// The models whose robots may go somewhere: those that robots have, or all where there is no robot.
pub fn moving(facts: &Facts) -> Vec<typed::DynamicsId> {
    let mut used: Vec<typed::DynamicsId> = facts.robots(None).map(|(_, robot)| robot.dynamics).collect();
    used.sort();
    used.dedup();
    if used.is_empty() { facts.dynamics().ids().collect() } else { used }
}
