//! The independent parts of a model, scaled for the linear program.
//!
//! Chains of integrators along different axes share nothing, so their gains are found separately.
//! Scaling is by powers of two, hence without rounding: inputs by their extent, states by how far
//! full inputs carry them in n steps.

use nalgebra::DMatrix;

use crate::exact::Rational;
use crate::ir::Model;

/// States and inputs that no other part of the model touches.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// The block's states in the model.
    pub(super) states: Vec<usize>,
    /// The block's inputs in the model.
    pub(super) inputs: Vec<usize>,
    /// What the program sees.
    pub(super) scaled: Scaled,
    /// One state's unit in the program, in SI.
    pub(super) state_scale: Vec<f64>,
    /// One input's unit in the program, in SI.
    pub(super) input_scale: Vec<f64>,
}

/// A block in the program's units; equal ones have equal gains.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Scaled {
    /// A.
    pub(super) a: DMatrix<f64>,
    /// B.
    pub(super) b: DMatrix<f64>,
    /// Half-widths of Θ'.
    pub(super) half_width: Vec<f64>,
    /// Whether a state has a disturbance of its own, more than a numerical margin.
    pub(super) disturbed: Vec<bool>,
    /// Whether a state is a position, with its weight.
    pub(super) position_weight: Vec<f64>,
    /// Bounds of the states, or of the workspace for positions.
    pub(super) state_bounds: Vec<Option<(f64, f64)>>,
    /// Bounds of the inputs.
    pub(super) input_bounds: Vec<(f64, f64)>,
    /// General bounds: coefficients of states and inputs, and the right-hand side.
    pub(super) mixed: Vec<(Vec<f64>, Vec<f64>, f64)>,
}

/// Splits a model into blocks; `half_width` is Θ', `workspace` the extent of each position.
/// `None` when the numbers leave the range of doubles.
pub(super) fn blocks(model: &Model, half_width: &[f64], workspace: &[(f64, f64)]) -> Option<Vec<Block>> {
    let groups = components(model);
    groups.into_iter().map(|(s, i)| block(model, half_width, workspace, s, i)).collect()
}

/// The connected components of states and inputs under A, B and the general bounds.
fn components(model: &Model) -> Vec<(Vec<usize>, Vec<usize>)> {
    let (n, m) = (model.n(), model.m());
    let mut label: Vec<usize> = (0..n + m).collect();
    let mut join = |i: usize, j: usize| {
        let (from, to) = (label[i].max(label[j]), label[i].min(label[j]));
        label.iter_mut().filter(|l| **l == from).for_each(|l| *l = to);
    };
    for i in 0..n {
        (0..n).filter(|&j| !model.a[(i, j)].is_zero()).for_each(|j| join(i, j));
        (0..m).filter(|&k| !model.b[(i, k)].is_zero()).for_each(|k| join(i, n + k));
    }
    for row in &model.mixed_bounds {
        let touched: Vec<usize> = (0..n + m).filter(|&i| !row.normal[i].is_zero()).collect();
        touched.windows(2).for_each(|pair| join(pair[0], pair[1]));
    }
    let members =
        |l: usize, range: std::ops::Range<usize>| range.filter(|&i| label[i] == l).collect::<Vec<_>>();
    let roots = (0..n).filter(|&i| label[i] == i);
    roots.map(|l| (members(l, 0..n), members(l, n..n + m).iter().map(|i| i - n).collect())).collect()
}

fn block(
    model: &Model,
    half_width: &[f64],
    workspace: &[(f64, f64)],
    states: Vec<usize>,
    inputs: Vec<usize>,
) -> Option<Block> {
    let a = DMatrix::from_fn(states.len(), states.len(), |i, j| model.a[(states[i], states[j])].to_f64());
    let b = DMatrix::from_fn(states.len(), inputs.len(), |i, k| model.b[(states[i], inputs[k])].to_f64());
    let input_bounds: Vec<_> = inputs.iter().map(|&k| ends(&model.input_bounds[k])).collect();
    let input_scale: Vec<f64> = input_bounds.iter().map(|&(lo, hi)| power_of_two((hi - lo) / 2.0)).collect();
    let reach = reach(&a, &b, &input_scale);
    let state_scale: Vec<f64> = states
        .iter()
        .zip(&reach)
        .map(|(&i, &r)| power_of_two(if r > 0.0 { r } else { half_width[i] }))
        .collect();
    if !reach.iter().chain(&state_scale).chain(&input_scale).all(|x| x.is_finite()) {
        return None;
    }
    // One more unit for all, so that the largest disturbance is about 1.
    let share = |(&i, s): (&usize, &f64)| half_width[i] / s;
    let unit = power_of_two(states.iter().zip(&state_scale).map(share).fold(0.0, f64::max));
    let state_scale: Vec<f64> = state_scale.iter().map(|s| s * unit).collect();
    let input_scale: Vec<f64> = input_scale.iter().map(|s| s * unit).collect();
    let scaled = Scaled {
        a: DMatrix::from_fn(states.len(), states.len(), |i, j| a[(i, j)] * state_scale[j] / state_scale[i]),
        b: DMatrix::from_fn(states.len(), inputs.len(), |i, k| b[(i, k)] * input_scale[k] / state_scale[i]),
        half_width: states.iter().zip(&state_scale).map(|(&i, s)| half_width[i] / s).collect(),
        disturbed: states.iter().map(|&i| is_disturbed(model, i)).collect(),
        position_weight: position_weights(model, &states, &state_scale),
        state_bounds: state_bounds(model, workspace, &states, &state_scale),
        input_bounds: input_bounds.iter().zip(&input_scale).map(|(&(lo, hi), s)| (lo / s, hi / s)).collect(),
        mixed: mixed_rows(model, &states, &inputs, &state_scale, &input_scale),
    };
    Some(Block { states, inputs, scaled, state_scale, input_scale })
}

/// How far inputs of at most `size` carry each state in as many steps as there are states.
fn reach(a: &DMatrix<f64>, b: &DMatrix<f64>, size: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; a.nrows()];
    let mut power = b.clone();
    for _ in 0..a.nrows() {
        for (row, total) in power.row_iter().zip(&mut sum) {
            *total += row.iter().zip(size).map(|(x, s)| x.abs() * s).sum::<f64>();
        }
        power = a * power;
    }
    sum
}

fn is_disturbed(model: &Model, state: usize) -> bool {
    model.disturbance[state].lo < model.disturbance[state].hi
}

/// Positions weigh alike in metres; the largest weight is 1.
fn position_weights(model: &Model, states: &[usize], scale: &[f64]) -> Vec<f64> {
    let weights = states.iter().zip(scale).map(|(i, s)| if model.position.contains(i) { *s } else { 0.0 });
    let weights: Vec<f64> = weights.collect();
    let largest = weights.iter().copied().fold(0.0, f64::max);
    if largest == 0.0 { weights } else { weights.iter().map(|w| w / largest).collect() }
}

fn state_bounds(
    model: &Model,
    workspace: &[(f64, f64)],
    states: &[usize],
    scale: &[f64],
) -> Vec<Option<(f64, f64)>> {
    let bound = |(&i, s): (&usize, &f64)| {
        let own = model.state_bounds[i].as_ref().map(ends);
        let axis = model.position.iter().position(|&p| p == i);
        let (lo, hi) = own.or_else(|| axis.and_then(|a| workspace.get(a).copied()))?;
        Some((lo / s, hi / s))
    };
    states.iter().zip(scale).map(bound).collect()
}

type MixedRow = (Vec<f64>, Vec<f64>, f64);

/// The general bounds that touch the block, each row divided by its largest coefficient.
fn mixed_rows(
    model: &Model,
    states: &[usize],
    inputs: &[usize],
    state_scale: &[f64],
    input_scale: &[f64],
) -> Vec<MixedRow> {
    let row = |h: &crate::geometry::HalfSpace| {
        let of = |i: usize, s: &f64| h.normal[i].to_f64() * s;
        let x: Vec<f64> = states.iter().zip(state_scale).map(|(&i, s)| of(i, s)).collect();
        let u: Vec<f64> = inputs.iter().zip(input_scale).map(|(&k, s)| of(model.n() + k, s)).collect();
        let size = x.iter().chain(&u).fold(0.0, |m: f64, c| m.max(c.abs()));
        let divide = |v: Vec<f64>| v.into_iter().map(|c| c / size).collect();
        (size > 0.0).then(|| (divide(x), divide(u), h.offset.to_f64() / size))
    };
    model.mixed_bounds.iter().filter_map(row).collect()
}

fn ends(interval: &crate::ir::Interval) -> (f64, f64) {
    (interval.lo.to_f64(), interval.hi.to_f64())
}

/// The power of two at or below a positive number; 1 for 0, infinite where that is.
fn power_of_two(x: f64) -> f64 {
    if x == 0.0 || !x.is_finite() {
        return if x == 0.0 { 1.0 } else { f64::INFINITY };
    }
    // Only the exponent's bits: no logarithm, hence the same on every platform.
    f64::from_bits(x.to_bits() & 0x7ff0_0000_0000_0000).max(f64::MIN_POSITIVE)
}

/// B, AB, A²B … as the columns of one exact matrix, and A^n: whether full rank of the first holds
/// the second, i.e. every error can be brought to 0.
pub(super) fn can_be_brought_to_zero(model: &Model, block: &Block) -> bool {
    let (states, inputs) = (&block.states, &block.inputs);
    let n = states.len();
    let a = |i: usize, j: usize| &model.a[(states[i], states[j])];
    let next = |v: &Vec<Rational>| -> Vec<Rational> {
        (0..n).map(|i| (0..n).map(|j| a(i, j) * &v[j]).sum()).collect()
    };
    let mut reachable: Vec<Vec<Rational>> = Vec::new();
    let mut power: Vec<Vec<Rational>> =
        inputs.iter().map(|&k| states.iter().map(|&i| model.b[(i, k)].clone()).collect()).collect();
    for _ in 0..n {
        reachable.extend(power.iter().cloned());
        power = power.iter().map(next).collect();
    }
    let rank = crate::geometry::rank(&reachable);
    if rank == n {
        return true;
    }
    let mut free: Vec<Vec<Rational>> = (0..n)
        .map(|j| (0..n).map(|i| if i == j { Rational::ONE } else { Rational::ZERO }).collect())
        .collect();
    for _ in 0..n {
        free = free.iter().map(next).collect();
    }
    reachable.extend(free);
    crate::geometry::rank(&reachable) == rank
}
