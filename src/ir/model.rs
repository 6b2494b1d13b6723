//! Dynamics models: x⁺ = A x + B u + c + w.

use crate::entity_id;
use crate::exact::{Rational, RationalMatrix};
use crate::geometry::HalfSpace;

entity_id!(
    /// A dynamics model.
    ModelId, "model"
);

/// A closed interval.
#[derive(Clone, Debug, PartialEq)]
pub struct Interval {
    /// The lower end.
    pub lo: Rational,
    /// The upper end.
    pub hi: Rational,
}

/// A state or an input.
#[derive(Clone, Debug, PartialEq)]
pub struct Signal {
    /// Its name in the mission.
    pub name: String,
    /// Its documentation, empty when there is none.
    pub doc: String,
    /// Its coherent SI unit as text (`m/s`), `1` when dimensionless.
    pub unit: String,
}

/// A linear motion model with n states and m inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Its name in the mission.
    pub name: String,
    /// Its documentation, empty when there is none.
    pub doc: String,
    /// The n states, in order.
    pub states: Vec<Signal>,
    /// The m inputs, in order.
    pub inputs: Vec<Signal>,
    /// Which states are the workspace's coordinates, one an axis.
    pub position: Vec<usize>,
    /// A, n × n, of the discrete-time model.
    pub a: RationalMatrix,
    /// B, n × m.
    pub b: RationalMatrix,
    /// c, n entries.
    pub c: Vec<Rational>,
    /// How far the true A, B, c may be from those above, entry by entry (`continuous` models);
    /// `None` when they are exact.
    pub enclosure: Option<Enclosure>,
    /// The box part of 𝒳, one entry a state; `None` where there is no bound.
    pub state_bounds: Vec<Option<Interval>>,
    /// The box part of 𝒰, one entry an input.
    pub input_bounds: Vec<Interval>,
    /// The general part of 𝒳 × 𝒰: half-spaces over (x, u), n + m entries each.
    pub mixed_bounds: Vec<HalfSpace>,
    /// Θ, one interval a state ([0, 0] where there is no disturbance).
    pub disturbance: Vec<Interval>,
    /// β; `None` leaves it to the compiler.
    pub rejection: Option<Rational>,
}

/// Entrywise bounds on the error of A, B and c.
#[derive(Clone, Debug, PartialEq)]
pub struct Enclosure {
    /// |ΔA|, n × n.
    pub a: RationalMatrix,
    /// |ΔB|, n × m.
    pub b: RationalMatrix,
    /// |Δc|, n entries.
    pub c: Vec<Rational>,
}

impl Model {
    /// n, the number of states.
    pub fn n(&self) -> usize {
        self.states.len()
    }

    /// m, the number of inputs.
    pub fn m(&self) -> usize {
        self.inputs.len()
    }

    /// The middle of Θ: what the nominal follows.
    pub fn mean(&self) -> Vec<Rational> {
        let half = Rational::ratio(1, 2);
        self.disturbance.iter().map(|i| (&i.lo + &i.hi) * &half).collect()
    }
}
