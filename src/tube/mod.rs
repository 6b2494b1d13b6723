//! Tubes: a law for each model that keeps every robot near its nominal trajectory (Algorithm 1,
//! step 1a).
//!
//! [`synthesize`] looks, for each dynamics model, for gains M_0 … M_{K−1} with which every
//! disturbance is forgotten after K steps (D_K = 0; theory.md §2). Positions' half-widths are as
//! small as a linear program makes them, within the states' bounds and a share β of the inputs.
//!
//! **β** is what `rejection` says. Where it says nothing, 0.3, 0.5, 0.7 and 0.9 are candidates, and
//! the least of them is taken whose tube is at most a tenth wider than that of 0.9: the rest of the
//! inputs is worth more to the plan than the last centimetres. It is only a cap: nominal inputs may
//! use all of 𝒰 ⊖ μ(Ω).
//!
//! **`reserve`** holds what the controller's own rounding can add: first an estimate, and where what is
//! proved of the law that comes out of it (`law::Rounding`) is more, that.
//!
//! **K** grows from the controllability index while each step more makes the tube at least 1 %
//! narrower, up to 4n.

mod block;
mod closing;
mod gains;
mod margin;
mod program;
mod report;
mod shape;

use nalgebra::DMatrix;

use crate::diag::{Diagnostics, Reported};
use crate::entity::{EntityId, Table};
use crate::ir::{Model, ModelId, Problem, Spans};
use crate::law::Float;

pub use closing::{admits, residual_room};
pub use shape::{Choice, Tube, rows};

use block::Block;
use gains::{Gains, NoGains};

/// One tube a dynamics model.
pub type Tubes = Table<ModelId, Tube>;

/// The shares of the inputs that are tried where the mission names none.
const SHARES: [f64; 4] = [0.9, 0.7, 0.5, 0.3];
/// How much wider than at the largest share a tube may be, to leave more to the nominal.
const TOLERABLE: f64 = 1.1;

/// How often a tube is made again because its reserve was too small.
const ATTEMPTS: usize = 4;

/// Finds a tube for each model of the problem, for controllers that compute with a float type.
///
/// # Errors
/// [`Reported`] when some model cannot be kept in a tube, or in one that fits the workspace and its
/// own bounds; each such model has its diagnostic.
pub fn synthesize(
    problem: &Problem,
    spans: &Spans,
    float: Float,
    diagnostics: &mut Diagnostics,
) -> Result<Tubes, Reported> {
    let mut tubes = Table::new();
    let mut refused = None;
    for id in problem.models.ids() {
        match tube_of(problem, id, float) {
            Ok(tube) => {
                tubes.push(tube);
            }
            Err(failure) => {
                let model_spans = spans.models.get(id.index()).cloned().unwrap_or_default();
                let diagnostic = report::diagnostic(&failure, problem, id, spans, &model_spans);
                refused = Some(diagnostics.report(diagnostic));
            }
        }
    }
    refused.map_or(Ok(tubes), Err)
}

/// Why a model has no tube.
#[derive(Clone, Debug, PartialEq)]
enum Failure {
    /// No input brings the error of these states back to 0.
    Uncontrollable { states: Vec<usize> },
    /// Numbers beyond the range of doubles.
    Unbounded,
    /// The inputs would have to give the feedback this share of their extent, at most `allowed`.
    WeakInputs { inputs: Vec<usize>, share: f64, allowed: f64 },
    /// The error would have to take this share of a state's bound.
    NarrowState { state: usize, share: f64 },
    /// The general bounds together leave no room.
    NarrowBounds,
    /// The error is as wide as the workspace.
    WiderThanWorkspace { axis: usize, half_width: f64 },
    /// The numbers of the tube are not good enough.
    Numerics { states: Vec<usize> },
}

/// A tube whose reserve holds the rounding of its own law.
fn tube_of(problem: &Problem, id: ModelId, float: Float) -> Result<Tube, Failure> {
    let mut needed = vec![0.0; problem.models[id].n()];
    for _ in 0..ATTEMPTS {
        let tube = tube_with(problem, id, &needed)?;
        let taken = margin::rounding(problem, id, &tube, float).ok_or(Failure::Unbounded)?;
        if taken.iter().zip(&tube.reserve).all(|(taken, reserve)| taken <= reserve) {
            return Ok(tube);
        }
        needed = taken;
    }
    Err(Failure::Numerics { states: (0..needed.len()).collect() })
}

/// A tube whose reserve holds so much, and what is usual, of each state.
fn tube_with(problem: &Problem, id: ModelId, needed: &[f64]) -> Result<Tube, Failure> {
    let model = &problem.models[id];
    let enlarged = margin::enlarge(problem, id, needed);
    let (lo, hi) = problem.workspace.bounding_box();
    let workspace: Vec<_> = lo.iter().zip(&hi).map(|(l, h)| (l.to_f64(), h.to_f64())).collect();
    if !enlarged.half_width.iter().all(|h| h.is_finite()) {
        return Err(Failure::Unbounded);
    }
    let blocks = block::blocks(model, &enlarged.half_width, &workspace).ok_or(Failure::Unbounded)?;
    if let Some(block) = blocks.iter().find(|b| !block::can_be_brought_to_zero(model, b)) {
        return Err(Failure::Uncontrollable { states: block.states.clone() });
    }
    if !enlarged.drowned.is_empty() {
        return Err(Failure::Numerics { states: enlarged.drowned });
    }
    let (share, gains) = choose_share(model, &blocks)?;
    let mut tube = assemble(model, &blocks, &gains, enlarged, share);
    close(model, &mut tube)?;
    fits_workspace(model, &tube, &workspace)?;
    Ok(tube)
}

/// β with its reason, and the gains of each block.
fn choose_share(model: &Model, blocks: &[Block]) -> Result<((f64, Choice), Vec<Gains>), Failure> {
    if let Some(beta) = &model.rejection {
        let beta = beta.to_f64();
        return Ok(((beta, Choice::Asked), all_gains(model, blocks, beta, None)?));
    }
    let [largest, smaller @ ..] = SHARES;
    let best = all_gains(model, blocks, largest, None)?;
    let mut chosen = ((largest, Choice::Least), best.clone());
    for beta in smaller {
        let used = chosen.1.iter().map(|g| g.share).fold(0.0, f64::max);
        let gains =
            if used <= beta { Ok(chosen.1.clone()) } else { all_gains(model, blocks, beta, Some(&best)) };
        let tolerable = |gains: &[Gains]| gains.iter().zip(&best).all(|(g, b)| g.cost <= TOLERABLE * b.cost);
        match gains {
            Ok(gains) if tolerable(&gains) => chosen = ((beta, Choice::Least), gains),
            Ok(gains) => chosen.0.1 = Choice::Wider { share: beta, factor: widening(&gains, &best) },
            Err(_) => chosen.0.1 = Choice::TooWeak { share: beta },
        }
        if chosen.0.0 != beta {
            break;
        }
    }
    Ok(chosen)
}

/// How many times as wide a tube is as another, at its worst block.
fn widening(gains: &[Gains], best: &[Gains]) -> f64 {
    gains.iter().zip(best).filter(|(_, b)| b.cost > 0.0).map(|(g, b)| g.cost / b.cost).fold(1.0, f64::max)
}

/// The gains of each block; blocks with the same numbers share one computation. Where the gains
/// with more of the inputs are known, the memory starts with theirs and tolerable ones will do.
fn all_gains(
    model: &Model,
    blocks: &[Block],
    beta: f64,
    best: Option<&[Gains]>,
) -> Result<Vec<Gains>, Failure> {
    let mut found: Vec<Gains> = Vec::new();
    for (i, block) in blocks.iter().enumerate() {
        let twin = blocks[..i].iter().position(|other| other.scaled == block.scaled);
        let best = best.map(|gains| &gains[i]);
        let search = || gains::Search {
            beta,
            from: best.map_or_else(|| gains::shortest(&block.scaled), |g| g.m.len()),
            longest: best.map_or(4 * model.n(), |g| g.m.len() + 2),
            enough: best.map_or(0.0, |g| TOLERABLE * g.cost),
        };
        let gains = match twin {
            Some(twin) => found[twin].clone(),
            None => gains::gains(&block.scaled, search()).map_err(|why| failure(block, beta, why))?,
        };
        found.push(gains);
    }
    Ok(found)
}

fn failure(block: &Block, beta: f64, why: NoGains) -> Failure {
    match why {
        NoGains::Inputs { share } => {
            Failure::WeakInputs { inputs: block.inputs.clone(), share, allowed: beta }
        }
        NoGains::State { state, share } => Failure::NarrowState { state: block.states[state], share },
        NoGains::Bounds => Failure::NarrowBounds,
        NoGains::Numerics => Failure::Numerics { states: block.states.clone() },
    }
}

/// Puts the blocks' gains together and runs the chain D_{i+1} = A D_i + B M_i in doubles.
fn assemble(
    model: &Model,
    blocks: &[Block],
    gains: &[Gains],
    box_: margin::Enlarged,
    share: (f64, Choice),
) -> Tube {
    let (n, m) = (model.n(), model.m());
    let k = gains.iter().map(|g| g.m.len()).max().unwrap_or(1);
    let mut tube = Tube {
        d: vec![DMatrix::zeros(n, n); k],
        m: vec![DMatrix::zeros(m, n); k],
        center: vec![0.0; n],
        half_width: box_.half_width,
        reserve: box_.reserve,
        residual_allowance: vec![0.0; n],
        beta: share.0,
        choice: share.1,
    };
    for (block, gains) in blocks.iter().zip(gains) {
        write_block(model, block, gains, &mut tube);
    }
    tube
}

fn write_block(model: &Model, block: &Block, gains: &Gains, tube: &mut Tube) {
    let (states, inputs) = (&block.states, &block.inputs);
    let a = DMatrix::from_fn(states.len(), states.len(), |i, j| model.a[(states[i], states[j])].to_f64());
    let b = DMatrix::from_fn(states.len(), inputs.len(), |i, k| model.b[(states[i], inputs[k])].to_f64());
    let mut d = DMatrix::identity(states.len(), states.len());
    for (i, scaled) in gains.m.iter().enumerate() {
        let m = DMatrix::from_fn(inputs.len(), states.len(), |k, j| {
            scaled[(k, j)] * (block.input_scale[k] / block.state_scale[j])
        });
        write_entries(&mut tube.d[i], states, states, &d);
        write_entries(&mut tube.m[i], inputs, states, &m);
        d = &a * d + &b * m;
    }
}

fn write_entries(target: &mut DMatrix<f64>, rows: &[usize], columns: &[usize], source: &DMatrix<f64>) {
    for (i, &row) in rows.iter().enumerate() {
        for (j, &column) in columns.iter().enumerate() {
            target[(row, column)] = source[(i, j)];
        }
    }
}

/// Checks the numbers exactly and notes what they leave for the plan's residuals.
fn close(model: &Model, tube: &mut Tube) -> Result<(), Failure> {
    let room = residual_room(model, tube).ok_or(Failure::Unbounded)?;
    let bad: Vec<usize> = (0..model.n()).filter(|&i| !room[i].is_positive()).collect();
    if !bad.is_empty() {
        return Err(Failure::Numerics { states: bad });
    }
    tube.residual_allowance = room.iter().map(|r| r.to_f64_down()).collect();
    Ok(())
}

fn fits_workspace(model: &Model, tube: &Tube, workspace: &[(f64, f64)]) -> Result<(), Failure> {
    for (axis, (&state, (lo, hi))) in model.position.iter().zip(workspace).enumerate() {
        let half_width = tube.state_half_width(state);
        if 2.0 * half_width >= hi - lo {
            return Err(Failure::WiderThanWorkspace { axis, half_width });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
