//! What the parts of a mission are called in the crate.

use super::words::Scope;
use crate::ir::{Model, Problem, Signal};

/// All names of a crate.
pub(super) struct Names {
    /// The package, as in `relay-controller`.
    pub(super) package: String,
    /// The same as Rust has it, as in `relay_controller`.
    pub(super) library: String,
    /// One entry a model.
    pub(super) models: Vec<ModelNames>,
    /// Types of robots, which are nodes' names too.
    pub(super) robots: Vec<String>,
    /// Nodes' names of base stations.
    pub(super) bases: Vec<String>,
}

/// The names of a motion model.
pub(super) struct ModelNames {
    /// Its module.
    pub(super) module: String,
    /// The fields of `State`, in order.
    pub(super) states: Vec<String>,
    /// The fields of `Input`, in order.
    pub(super) inputs: Vec<String>,
}

impl Names {
    pub(super) fn new(problem: &Problem) -> Names {
        let mut nodes = Scope::with(&["Assumption", "Containment", "Reading", "Real", "Link", "Tracker"]);
        let mut modules = Scope::default();
        let library = format!("{}_controller", Scope::default().snake(&problem.name));
        let robots = problem.robots.values().map(|robot| nodes.camel(&robot.name)).collect();
        let bases = problem.bases.iter().map(|(_, base)| nodes.camel(&base.name)).collect();
        let model = |model: &Model| ModelNames {
            module: modules.snake(&model.name),
            states: fields(&model.states),
            inputs: fields(&model.inputs),
        };
        let models = problem.models.values().map(model).collect();
        Names { package: library.replace('_', "-"), library, models, robots, bases }
    }
}

fn fields(signals: &[Signal]) -> Vec<String> {
    let mut scope = Scope::default();
    signals.iter().map(|signal| scope.snake(&signal.name)).collect()
}
