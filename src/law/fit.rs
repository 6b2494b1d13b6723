//! Whether a plan's proof holds for a law in a float type: its rounding has to fit what the plan keeps
//! for it.

use std::fmt;

use crate::exact::{Rational, dot};
use crate::geometry::Polytope;
use crate::ir::Model;

use super::{Feedback, Float, Magnitudes, Rounding, TubeTables};

/// A dynamics model's part of a plan.
#[derive(Clone, Copy, Debug)]
pub struct Promise<'a> {
    /// The model.
    pub model: &'a Model,
    /// The workspace of its mission.
    pub workspace: &'a Polytope,
    /// Its feedback.
    pub feedback: Feedback<'a>,
    /// What its proof keeps for rounding, n entries.
    pub reserve: &'a [f64],
}

/// A robot's part of a plan.
#[derive(Clone, Copy, Debug)]
pub struct Flight<'a> {
    /// x̄₀, n entries.
    pub start: &'a [Rational],
    /// L + 1 nominal states of n entries.
    pub z: &'a [Vec<f64>],
    /// L + 1 nominal inputs of m entries.
    pub v: &'a [Vec<f64>],
}

/// Why a law has no proof in a float type.
#[derive(Clone, Debug, PartialEq)]
pub enum Misfit {
    /// A state's rounding can take more than is reserved for it, both in its unit.
    Reserve {
        /// The model.
        dynamics: String,
        /// The state.
        state: String,
        /// What is proved of the rounding.
        bound: f64,
        /// What the plan reserves.
        reserve: f64,
    },
    /// A robot starts so near the tube's edge that rounding could put it outside.
    Start {
        /// The model.
        dynamics: String,
        /// The state.
        state: String,
    },
    /// A general bound of the model has less room left, somewhere, than rounding can take.
    Bound {
        /// The model.
        dynamics: String,
        /// What rounding can take.
        bound: f64,
        /// What is left.
        room: f64,
    },
    /// The plan says nothing of a model or a robot.
    Missing {
        /// Which one.
        name: String,
    },
    /// Some number of the plan is too large for the type.
    TooLarge {
        /// The model or the robot.
        name: String,
    },
}

impl fmt::Display for Misfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Misfit::Reserve { dynamics, state, bound, reserve } => write!(
                f,
                "rounding can add up to {bound:.3e} to `{dynamics}.{state}`, and the plan reserves {reserve:.3e}"
            ),
            Misfit::Start { dynamics, state } => {
                write!(f, "a robot starts at the very edge of the tube of `{dynamics}.{state}`")
            }
            Misfit::Bound { dynamics, bound, room } => write!(
                f,
                "rounding can take {bound:.3e} of a general bound of `{dynamics}`, and the plan leaves {room:.3e}"
            ),
            Misfit::Missing { name } => write!(f, "the plan says nothing of `{name}`"),
            Misfit::TooLarge { name } => write!(f, "numbers of `{name}` are too large"),
        }
    }
}

/// Proves that a law in a float type keeps the promise of a plan for these robots of one model, and
/// gives the law's tables and the bounds on its rounding.
///
/// # Errors
/// [`Misfit`] where the proof does not go through.
pub fn fit(
    float: Float,
    promise: &Promise<'_>,
    flights: &[Flight<'_>],
) -> Result<(TubeTables, Rounding), Misfit> {
    let Promise { model, feedback, .. } = promise;
    let too_large = || Misfit::TooLarge { name: model.name.clone() };
    let tables = TubeTables::new(float, model, promise.workspace, feedback).ok_or_else(too_large)?;
    let magnitudes = magnitudes(model, flights).ok_or_else(too_large)?;
    let rounding = Rounding::new(float, model, feedback, &tables, &magnitudes).ok_or_else(too_large)?;
    reserve(promise, &rounding)?;
    for flight in flights {
        start(promise, &rounding, flight)?;
        general_bounds(promise, &rounding, flight)?;
    }
    Ok((tables, rounding))
}

fn magnitudes(model: &Model, flights: &[Flight<'_>]) -> Option<Magnitudes> {
    let largest = |size: usize, columns: &mut dyn Iterator<Item = &Vec<f64>>| {
        let mut most = vec![Rational::ZERO; size];
        for column in columns {
            for (most, x) in most.iter_mut().zip(column) {
                *most = Rational::max_of(most, &Rational::from_f64(*x)?.abs()).clone();
            }
        }
        Some(most)
    };
    Some(Magnitudes {
        state: largest(model.n(), &mut flights.iter().flat_map(|f| f.z))?,
        input: largest(model.m(), &mut flights.iter().flat_map(|f| f.v))?,
    })
}

fn reserve(promise: &Promise<'_>, rounding: &Rounding) -> Result<(), Misfit> {
    for (i, needed) in rounding.needed.iter().enumerate() {
        let reserve = promise.reserve[i];
        if Rational::from_f64(reserve).is_none_or(|reserve| *needed > reserve) {
            return Err(Misfit::Reserve {
                dynamics: promise.model.name.clone(),
                state: promise.model.states[i].name.clone(),
                bound: needed.to_f64_up(),
                reserve,
            });
        }
    }
    Ok(())
}

/// The first error is one ŵ, to which no reserve belongs: |x̄_0 − z_0 − center| + its rounding has to
/// be in the half-width.
fn start(promise: &Promise<'_>, rounding: &Rounding, flight: &Flight<'_>) -> Result<(), Misfit> {
    let exact =
        |values: &[f64], i: usize| values.get(i).and_then(|x| Rational::from_f64(*x)).unwrap_or_default();
    for (i, start) in flight.start.iter().enumerate() {
        let z = flight.z.first().map_or(Rational::ZERO, |z| exact(z, i));
        let off = (start - z - exact(promise.feedback.center, i)).abs();
        // What the reserve holds is more than the rounding of one ŵ and of its bounds.
        if off + &rounding.needed[i] > exact(promise.feedback.half_width, i) {
            return Err(Misfit::Start {
                dynamics: promise.model.name.clone(),
                state: promise.model.states[i].name.clone(),
            });
        }
    }
    Ok(())
}

/// Where a general bound speaks of inputs, it has to leave room for theirs: u is off by σ, and M_0 ŵ by
/// what ŵ is off from the disturbance that x − z is made of.
fn general_bounds(promise: &Promise<'_>, rounding: &Rounding, flight: &Flight<'_>) -> Result<(), Misfit> {
    let (model, feedback) = (promise.model, &promise.feedback);
    for bound in &model.mixed_bounds {
        let (states, inputs) = bound.normal.split_at(model.n());
        let mut taken = Rational::ZERO;
        for (k, a) in inputs.iter().enumerate() {
            let row = feedback.m.first().and_then(|m| m.get(k)).map(Vec::as_slice).unwrap_or_default();
            let carried: Rational = row
                .iter()
                .zip(&rounding.disturbance)
                .filter_map(|(m, rho)| Some(Rational::from_f64(*m)?.abs() * rho))
                .sum();
            taken += a.abs() * (carried + &rounding.input[k]);
        }
        if taken.is_zero() {
            continue;
        }
        let reach = support(feedback, states, inputs);
        for (z, v) in flight.z.iter().zip(flight.v) {
            let nominal = dot(states, &exact(z)) + dot(inputs, &exact(v));
            let room = &bound.offset - nominal - &reach;
            if room < taken {
                return Err(Misfit::Bound {
                    dynamics: model.name.clone(),
                    bound: taken.to_f64_up(),
                    room: room.to_f64_down(),
                });
            }
        }
    }
    Ok(())
}

/// max a·Σ D_i w_i + b·Σ M_i w_i over the box.
fn support(feedback: &Feedback<'_>, a: &[Rational], b: &[Rational]) -> Rational {
    let (center, half_width) = (exact(feedback.center), exact(feedback.half_width));
    let mut reach = Rational::ZERO;
    for (d, m) in feedback.d.iter().zip(feedback.m) {
        for j in 0..center.len() {
            let column = |matrix: &[Vec<f64>]| matrix.iter().map(|row| row[j]).collect::<Vec<_>>();
            let entry = dot(a, &exact(&column(d))) + dot(b, &exact(&column(m)));
            reach += &entry * &center[j] + entry.abs() * &half_width[j];
        }
    }
    reach
}

/// The doubles as they stand; a plan that was read holds finite ones only.
fn exact(values: &[f64]) -> Vec<Rational> {
    values.iter().map(|x| Rational::from_f64(*x).unwrap_or_default()).collect()
}
