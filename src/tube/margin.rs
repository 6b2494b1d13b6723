//! Θ': the disturbance box of a tube, with room for all numerical error (theory.md §2).

use crate::exact::Rational;
use crate::ir::{Model, ModelId, Problem};
use crate::law::{Feedback, Float, Magnitudes as Nominal, Rounding, TubeTables};

use super::{Tube, rows};

/// The margin relative to the disturbance.
const RELATIVE: f64 = 1e-6;
/// The least margin relative to the state's extent.
const FLOOR: f64 = 1e-9;
/// Rounding errors of one step of the law, in units of the last place of the largest term, for each
/// term that is summed. Generous: four operations a term would do.
const OPERATIONS: f64 = 64.0;

/// How much more is reserved than a law turned out to need: the next one is a little different.
const SPARE: f64 = 1.5;

/// The share of a state's extent that rounding must not reach.
const DROWNED: f64 = 1e-4;

/// The box Θ' around 0 and what of it is reserved.
#[derive(Clone, Debug)]
pub(super) struct Enlarged {
    /// Its half-widths, all positive.
    pub(super) half_width: Vec<f64>,
    /// The controller's share, all positive.
    pub(super) reserve: Vec<f64>,
    /// The states of which rounding alone takes a visible share of the extent.
    pub(super) drowned: Vec<usize>,
}

/// How large the numbers of a model get: the basis of its rounding errors.
#[derive(Clone, Debug)]
pub(super) struct Magnitudes {
    /// The largest |x_i| that is reckoned with.
    state: Vec<f64>,
    /// Half the width of what x_i moves in.
    extent: Vec<f64>,
    /// The largest |u_k|.
    input: Vec<f64>,
}

/// The enlarged disturbance box, whose reserve holds at least `needed`; the longest memory is 4n.
pub(super) fn enlarge(problem: &Problem, id: ModelId, needed: &[f64]) -> Enlarged {
    let model = &problem.models[id];
    let magnitudes = magnitudes(problem, id);
    let estimates = reserves(model, &magnitudes);
    let reserve: Vec<f64> =
        estimates.iter().zip(needed).map(|(estimate, needed)| estimate.max(SPARE * needed)).collect();
    let uncertain = uncertainty(model, &magnitudes);
    let width = |i: usize| {
        let theta = (&model.disturbance[i].hi - &model.disturbance[i].lo).to_f64_up() / 2.0;
        let margin = (RELATIVE * theta).max(FLOOR * magnitudes.extent[i]).max(8.0 * reserve[i]);
        theta + margin + 2.0 * uncertain[i]
    };
    let half_width = (0..model.n()).map(width).collect();
    let drowned = (0..model.n()).filter(|&i| reserve[i] > DROWNED * magnitudes.extent[i]).collect();
    Enlarged { half_width, reserve, drowned }
}

/// What is proved of the rounding of a tube's law, rounded up; `None` when a number is not finite in
/// the float type.
pub(super) fn rounding(problem: &Problem, id: ModelId, tube: &Tube, float: Float) -> Option<Vec<f64>> {
    let model = &problem.models[id];
    let magnitudes = magnitudes(problem, id);
    let exact = |values: &[f64]| values.iter().map(|x| Rational::from_f64(*x)).collect::<Option<Vec<_>>>();
    let (d, m) = (rows(&tube.d), rows(&tube.m));
    let feedback = Feedback { center: &tube.center, half_width: &tube.half_width, d: &d, m: &m };
    let tables = TubeTables::new(float, model, &problem.workspace, &feedback)?;
    let nominal = Nominal { state: exact(&magnitudes.state)?, input: exact(&magnitudes.input)? };
    let rounding = Rounding::new(float, model, &feedback, &tables, &nominal)?;
    Some(rounding.needed.iter().map(Rational::to_f64_up).collect())
}

/// An estimate of what rounding adds to each component of ŵ in doubles: the errors of e and u, through
/// A and B.
fn reserves(model: &Model, magnitudes: &Magnitudes) -> Vec<f64> {
    let (n, m) = (model.n(), model.m());
    let terms = (4 * n * (n + m)) as f64;
    let carried = |i: usize| {
        let states = (0..n).map(|j| model.a[(i, j)].to_f64().abs() * magnitudes.state[j]);
        let inputs = (0..m).map(|k| model.b[(i, k)].to_f64().abs() * magnitudes.input[k]);
        magnitudes.state[i] + states.chain(inputs).sum::<f64>()
    };
    (0..n).map(|i| OPERATIONS * terms * f64::EPSILON * carried(i)).collect()
}

/// |ΔA||x| + |ΔB||u| + |Δc|.
fn uncertainty(model: &Model, magnitudes: &Magnitudes) -> Vec<f64> {
    let Some(enclosure) = &model.enclosure else { return vec![0.0; model.n()] };
    let row = |i: usize| {
        let states = (0..model.n()).map(|j| enclosure.a[(i, j)].to_f64_up() * magnitudes.state[j]);
        let inputs = (0..model.m()).map(|k| enclosure.b[(i, k)].to_f64_up() * magnitudes.input[k]);
        enclosure.c[i].to_f64_up() + states.chain(inputs).sum::<f64>()
    };
    (0..model.n()).map(row).collect()
}

fn magnitudes(problem: &Problem, id: ModelId) -> Magnitudes {
    let model = &problem.models[id];
    let input: Vec<f64> = model.input_bounds.iter().map(|b| largest(&b.lo, &b.hi)).collect();
    let (lo, hi) = problem.workspace.bounding_box();
    let (mut state, mut extent) = (Vec::new(), Vec::new());
    for i in 0..model.n() {
        let axis = model.position.iter().position(|&p| p == i);
        let own = model.state_bounds[i].as_ref().map(|b| (&b.lo, &b.hi));
        let ends = own.or_else(|| axis.and_then(|a| Some((lo.get(a)?, hi.get(a)?))));
        let (size, half) = ends.map_or_else(
            || (reach(model, i, &input), reach(model, i, &input)),
            |(lo, hi)| (largest(lo, hi), (hi - lo).to_f64() / 2.0),
        );
        let starts = problem.robots.values().filter(|r| r.model == id).map(|r| r.start[i].to_f64().abs());
        state.push(starts.fold(size, f64::max));
        extent.push(half);
    }
    Magnitudes { state, extent, input }
}

fn largest(lo: &Rational, hi: &Rational) -> f64 {
    lo.to_f64().abs().max(hi.to_f64().abs())
}

/// For a state without bounds: how far full inputs carry it in n steps, or 1 where they don't.
fn reach(model: &Model, state: usize, input: &[f64]) -> f64 {
    let n = model.n();
    let mut size: Vec<f64> = vec![0.0; n];
    for _ in 0..n {
        let next = |i: usize| {
            let states = (0..n).map(|j| model.a[(i, j)].to_f64().abs() * size[j]);
            let inputs = input.iter().enumerate().map(|(k, u)| model.b[(i, k)].to_f64().abs() * u);
            states.chain(inputs).sum::<f64>()
        };
        size = (0..n).map(next).collect();
    }
    if size[state] > 0.0 { size[state] } else { 1.0 }
}
