//! The bounds of nominal trajectories: 𝒳 ⊖ Ω with 𝒲 ⊖ Ω, and 𝒰 ⊖ μ(Ω).

use super::{Abstraction, GAP, HalfSpace};
use crate::ir::{Interval, Model, ModelId, Problem};
use crate::tube::Tube;

/// How far the bounds of states and inputs are moved inwards, as a share of their extent: the linear
/// programs' answers are rounded, and the exact check has no tolerance.
const BACKOFF: f64 = 1e-7;

/// A general half-space over (z, v).
#[derive(Clone, Debug, PartialEq)]
pub struct MixedRow {
    /// n + m coefficients.
    pub normal: Vec<f64>,
    /// The offset, tightened by the tube.
    pub offset: f64,
}

/// What the nominal states and inputs of a model have to stay in.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// Lower and upper bound of each state, those of the workspace's axis-aligned facets included;
    /// infinite where there is none.
    pub states: Vec<(f64, f64)>,
    /// Lower and upper bound of each input.
    pub inputs: Vec<(f64, f64)>,
    /// General bounds.
    pub mixed: Vec<MixedRow>,
    /// The workspace's slanted facets.
    pub walls: Vec<HalfSpace>,
}

impl Abstraction {
    /// The bounds of a model's nominal trajectories within its tube, moved inwards by the back-off.
    pub fn bounds(&self, problem: &Problem, id: ModelId, tube: &Tube) -> Bounds {
        let model = &problem.models[id];
        let share = BACKOFF * self.gap / (GAP * self.size);
        let (axes, walls): (Vec<HalfSpace>, Vec<HalfSpace>) =
            self.workspace[id].iter().copied().partition(|w| self.along_axis(w));
        let mut states = states(model, tube, share);
        for wall in axes {
            let vector = &self.directions[wall.direction].vector;
            let axis = vector.iter().position(|x| *x != 0.0).unwrap_or(0);
            let (lo, hi) = &mut states[model.position[axis]];
            if vector[axis] > 0.0 {
                *hi = hi.min(wall.offset);
            } else {
                *lo = lo.max(-wall.offset);
            }
        }
        Bounds { states, inputs: inputs(model, tube, share), mixed: mixed(model, tube, share), walls }
    }

    fn along_axis(&self, half_space: &HalfSpace) -> bool {
        let vector = &self.directions[half_space.direction].vector;
        vector.iter().filter(|x| **x != 0.0).count() == 1
    }
}

fn states(model: &Model, tube: &Tube, share: f64) -> Vec<(f64, f64)> {
    let n = model.n();
    let bound = |(s, bound): (usize, &Option<Interval>)| match bound {
        None => (f64::NEG_INFINITY, f64::INFINITY),
        Some(bound) => {
            let down = tube.support_up(&unit(s, n, -1.0));
            inwards(bound, down, tube.support_up(&unit(s, n, 1.0)), share)
        }
    };
    model.state_bounds.iter().enumerate().map(bound).collect()
}

fn inputs(model: &Model, tube: &Tube, share: f64) -> Vec<(f64, f64)> {
    let m = model.m();
    let bound = |(u, bound): (usize, &Interval)| {
        let down = tube.input_support_up(&unit(u, m, -1.0));
        inwards(bound, down, tube.input_support_up(&unit(u, m, 1.0)), share)
    };
    model.input_bounds.iter().enumerate().map(bound).collect()
}

fn mixed(model: &Model, tube: &Tube, share: f64) -> Vec<MixedRow> {
    let row = |row: &crate::geometry::HalfSpace| {
        let normal: Vec<f64> = row.normal.iter().map(|x| x.to_f64()).collect();
        let size = normal.iter().fold(0.0f64, |a, x| a.max(x.abs()));
        let inset = share * (row.offset.to_f64().abs() + size);
        MixedRow { offset: row.offset.to_f64() - tube.joint_support_up(&normal) - inset, normal }
    };
    model.mixed_bounds.iter().map(row).collect()
}

/// An interval shrunk at both ends by the tube's reach there and a share of its extent.
fn inwards(bound: &Interval, down: f64, up: f64, share: f64) -> (f64, f64) {
    let (lo, hi) = (bound.lo.to_f64(), bound.hi.to_f64());
    let inset = share * (hi - lo);
    (lo + down + inset, hi - up - inset)
}

/// ± the i-th of k unit vectors.
fn unit(i: usize, k: usize, sign: f64) -> Vec<f64> {
    (0..k).map(|j| if i == j { sign } else { 0.0 }).collect()
}
