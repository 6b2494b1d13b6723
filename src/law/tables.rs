//! The numbers of a law, for either floating-point type.

use crate::exact::{Rational, dot};
use crate::geometry::Polytope;
use crate::ir::Model;

use super::Float;
use super::tracking::{Bounds, Moment};

/// How near to its bounds a state or an input is reported, as a share of their distance.
const NEAR: f64 = 0.05;

/// The feedback of a dynamics model with n states and m inputs, in the doubles of a plan:
/// e_t = Σ_i D_i ŵ_{t−1−i} with ŵ in center ± half_width.
#[derive(Clone, Copy, Debug)]
pub struct Feedback<'a> {
    /// The middle of Θ', n entries.
    pub center: &'a [f64],
    /// The half-widths of Θ', n entries.
    pub half_width: &'a [f64],
    /// K matrices, n × n each, row by row; the first is the identity.
    pub d: &'a [Vec<Vec<f64>>],
    /// K matrices, m × n each, row by row.
    pub m: &'a [Vec<Vec<f64>>],
}

/// The tables of a model's feedback, in doubles that the float type holds: the fields of
/// [`tracking::Tube`](super::tracking::Tube), each column of its own length.
#[derive(Clone, Debug, PartialEq)]
pub struct TubeTables {
    /// The columns of D_1 … D_{K−1}.
    pub errors: Vec<Vec<f64>>,
    /// The columns of M_0 … M_{K−1}.
    pub gains: Vec<Vec<f64>>,
    /// Θ', rounded inwards.
    pub disturbance: Bounds<Vec<f64>>,
    /// The middle of Θ'.
    pub assumed: Vec<f64>,
    /// The least box around Ω, rounded outwards.
    pub hull: Bounds<Vec<f64>>,
    /// The states' bounds, rounded inwards; for positions without any, the workspace's bounding box.
    pub state: Bounds<Vec<f64>>,
    /// How near to them is reported, 0 where there are none.
    pub state_near: Vec<f64>,
    /// The inputs' bounds, rounded inwards.
    pub input: Bounds<Vec<f64>>,
    /// How near to them is reported.
    pub input_near: Vec<f64>,
}

impl TubeTables {
    /// The tables of a feedback; `None` when some number of it is no finite number of the type.
    pub fn new(
        float: Float,
        model: &Model,
        workspace: &Polytope,
        feedback: &Feedback<'_>,
    ) -> Option<TubeTables> {
        let (center, half_width) = (exact(feedback.center)?, exact(feedback.half_width)?);
        let (lo, hi): (Vec<_>, Vec<_>) =
            center.iter().zip(&half_width).map(|(c, h)| (Some(c - h), Some(c + h))).unzip();
        let (input_lo, input_hi): (Vec<_>, Vec<_>) =
            model.input_bounds.iter().map(|b| (Some(b.lo.clone()), Some(b.hi.clone()))).unzip();
        let (state_lo, state_hi) = state_ends(model, workspace);
        let state = inward(float, &state_lo, &state_hi);
        let input = inward(float, &input_lo, &input_hi);
        let tables = TubeTables {
            errors: columns(float, feedback.d.get(1..)?),
            gains: columns(float, feedback.m),
            disturbance: inward(float, &lo, &hi),
            assumed: feedback.center.iter().map(|c| float.round(*c)).collect(),
            hull: hull(float, feedback.d, &center, &half_width)?,
            state_near: near(float, &state),
            state,
            input_near: near(float, &input),
            input,
        };
        tables.is_finite().then_some(tables)
    }

    /// Whether every number that the law computes with is finite.
    fn is_finite(&self) -> bool {
        let bounds = [&self.disturbance, &self.hull, &self.input];
        let ends = bounds.into_iter().flat_map(|b| [&b.lo, &b.hi]);
        let columns = self.errors.iter().chain(&self.gains).chain([&self.assumed]).chain(ends);
        columns.flatten().all(|x| x.is_finite())
    }
}

/// A robot's nominal trajectory, in doubles that the float type holds.
#[derive(Clone, Debug, PartialEq)]
pub struct PathTables {
    /// The L + 1 nominal states and inputs.
    pub moments: Vec<Moment<Vec<f64>, Vec<f64>>>,
    /// k: after the last one comes this one again.
    pub loop_start: usize,
}

impl PathTables {
    /// The tables of L + 1 nominal states `z` and inputs `v`; `None` when some number of them is no
    /// finite number of the type.
    pub fn new(float: Float, z: &[Vec<f64>], v: &[Vec<f64>], loop_start: usize) -> Option<PathTables> {
        let round = |column: &Vec<f64>| column.iter().map(|x| float.round(*x)).collect::<Vec<_>>();
        let moments: Vec<_> = z.iter().zip(v).map(|(z, v)| Moment { z: round(z), v: round(v) }).collect();
        let finite =
            |moment: &Moment<Vec<f64>, Vec<f64>>| moment.z.iter().chain(&moment.v).all(|x| x.is_finite());
        moments.iter().all(finite).then_some(PathTables { moments, loop_start })
    }
}

fn exact(values: &[f64]) -> Option<Vec<Rational>> {
    values.iter().map(|x| Rational::from_f64(*x)).collect()
}

/// The columns of some matrices, one matrix after the other.
fn columns(float: Float, matrices: &[Vec<Vec<f64>>]) -> Vec<Vec<f64>> {
    let of = |matrix: &Vec<Vec<f64>>| {
        let width = matrix.first().map_or(0, Vec::len);
        (0..width).map(|j| matrix.iter().map(|row| float.round(row[j])).collect()).collect::<Vec<_>>()
    };
    matrices.iter().flat_map(of).collect()
}

/// The least box around Σ D_i (center ± half_width), rounded outwards.
fn hull(
    float: Float,
    d: &[Vec<Vec<f64>>],
    center: &[Rational],
    half_width: &[Rational],
) -> Option<Bounds<Vec<f64>>> {
    let mut bounds = Bounds { lo: Vec::new(), hi: Vec::new() };
    for i in 0..center.len() {
        let (mut middle, mut reach) = (Rational::ZERO, Rational::ZERO);
        for matrix in d {
            let row = exact(&matrix[i])?;
            middle += dot(&row, center);
            reach += dot(&row.iter().map(Rational::abs).collect::<Vec<_>>(), half_width);
        }
        bounds.lo.push(float.down(&(&middle - &reach)));
        bounds.hi.push(float.up(&(&middle + &reach)));
    }
    Some(bounds)
}

/// The bounds of the states, or the workspace's along an axis.
fn state_ends(model: &Model, workspace: &Polytope) -> (Vec<Option<Rational>>, Vec<Option<Rational>>) {
    let (lo, hi) = workspace.bounding_box();
    let of = |i: usize| match &model.state_bounds[i] {
        Some(bound) => (Some(bound.lo.clone()), Some(bound.hi.clone())),
        None => {
            let axis = model.position.iter().position(|&p| p == i);
            (axis.and_then(|a| lo.get(a).cloned()), axis.and_then(|a| hi.get(a).cloned()))
        }
    };
    (0..model.n()).map(of).unzip()
}

/// Bounds whose ends are rounded inwards; infinite where there are none.
fn inward(float: Float, lo: &[Option<Rational>], hi: &[Option<Rational>]) -> Bounds<Vec<f64>> {
    let lo = lo.iter().map(|end| end.as_ref().map_or(f64::NEG_INFINITY, |x| float.up(x)));
    let hi = hi.iter().map(|end| end.as_ref().map_or(f64::INFINITY, |x| float.down(x)));
    Bounds { lo: lo.collect(), hi: hi.collect() }
}

/// How near to its bounds each entry is reported.
fn near(float: Float, bounds: &Bounds<Vec<f64>>) -> Vec<f64> {
    let share = |(lo, hi): (&f64, &f64)| {
        let near = NEAR * (hi - lo);
        if near.is_finite() { float.round(near) } else { 0.0 }
    };
    bounds.lo.iter().zip(&bounds.hi).map(share).collect()
}
