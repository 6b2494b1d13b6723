//! A model's nominal dynamics, made ready for small linear programs.
//!
//! The unknowns are not the inputs v but w = v − G z, for a gain G that brings the state to rest in
//! few steps: each state then depends on the last few unknowns alone, with coefficients that do not
//! grow with the length. (With the inputs themselves they grow like t^(n−1), and chains of four
//! integrators fail numerically from some 35 steps on.)

use nalgebra::{DMatrix, DVector};

use crate::abstraction::{Abstraction, Bounds, HalfSpace, MixedRow};
use crate::exact::RationalMatrix;
use crate::ir::{Model, ModelId, Problem};
use crate::tube::Tubes;

use super::interval::Interval;

/// Responses below this share of the largest one are over.
const FADED: f64 = 1e-14;

/// States and inputs that depend on no others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// The states, rising.
    pub states: Vec<usize>,
    /// The inputs, rising.
    pub inputs: Vec<usize>,
}

/// The nominal system z⁺ = A z + B v + drift with its tightened bounds.
#[derive(Clone, Debug)]
pub struct System {
    /// The number of states.
    pub n: usize,
    /// The number of inputs.
    pub m: usize,
    /// A, n × n.
    pub a: DMatrix<f64>,
    /// B, n × m.
    pub b: DMatrix<f64>,
    /// c plus the middle of Θ.
    pub drift: DVector<f64>,
    /// A, row by row, as intervals.
    pub exact_a: Vec<Vec<Interval>>,
    /// B, row by row, as intervals.
    pub exact_b: Vec<Vec<Interval>>,
    /// The drift as intervals.
    pub exact_drift: Vec<Interval>,
    /// G, m × n.
    pub gain: DMatrix<f64>,
    /// A + B G.
    pub closed: DMatrix<f64>,
    /// (A + B G)^i B for rising i, until it has faded.
    pub responses: Vec<DMatrix<f64>>,
    /// The size of each unknown: one unit moves a state by about its extent.
    pub units: Vec<f64>,
    /// The blocks.
    pub blocks: Vec<Block>,
    /// Bounds on each state, those of the workspace's axis-aligned facets included.
    pub state_bounds: Vec<(f64, f64)>,
    /// Bounds on each input.
    pub input_bounds: Vec<(f64, f64)>,
    /// General bounds.
    pub mixed: Vec<MixedRow>,
    /// The workspace's slanted facets.
    pub walls: Vec<HalfSpace>,
    /// Which states are the coordinates.
    pub position: Vec<usize>,
}

impl System {
    /// A model's nominal system within its tube.
    pub fn new(problem: &Problem, id: ModelId, tubes: &Tubes, abstraction: &Abstraction) -> System {
        let model = &problem.models[id];
        let (n, m) = (model.n(), model.m());
        let mean = model.mean();
        let drift: Vec<_> = model.c.iter().zip(&mean).map(|(c, w)| c + w).collect();
        let (a, b) = (floats(&model.a), floats(&model.b));
        let Bounds { states: state_bounds, inputs: input_bounds, mixed, walls } =
            abstraction.bounds(problem, id, &tubes[id]);
        let blocks = blocks(problem, model);
        let gain = gain(&a, &b, &blocks);
        let closed = &a + &b * &gain;
        let responses = responses(&closed, &b);
        let units = units(&responses, &state_bounds, &blocks, abstraction.size);
        System {
            n,
            m,
            exact_a: intervals(&model.a),
            exact_b: intervals(&model.b),
            exact_drift: drift.iter().map(Interval::around).collect(),
            drift: DVector::from_iterator(n, drift.iter().map(|x| x.to_f64())),
            a,
            b,
            gain,
            closed,
            responses,
            units,
            blocks,
            state_bounds,
            input_bounds,
            mixed,
            walls,
            position: model.position.clone(),
        }
    }

    /// States z_0 … z_{L+1} and inputs v_0 … v_L from a start and the unknowns w_0 … w_L.
    pub fn run(&self, start: &DVector<f64>, w: &[DVector<f64>]) -> (Vec<DVector<f64>>, Vec<DVector<f64>>) {
        let mut z = vec![start.clone()];
        let mut v = Vec::new();
        for w in w {
            let here = &z[z.len() - 1];
            let input = &self.gain * here + w;
            z.push(&self.a * here + &self.b * &input + &self.drift);
            v.push(input);
        }
        (z, v)
    }
}

fn floats(matrix: &RationalMatrix) -> DMatrix<f64> {
    matrix.map(|x| x.to_f64())
}

fn intervals(matrix: &RationalMatrix) -> Vec<Vec<Interval>> {
    matrix.row_iter().map(|row| row.iter().map(Interval::around).collect()).collect()
}

/// The finest partition in which no state depends on another block's states or inputs.
fn blocks(problem: &Problem, model: &Model) -> Vec<Block> {
    let (n, m) = (model.n(), model.m());
    let mut group: Vec<usize> = (0..n + m).collect();
    let mut join = |members: Vec<usize>| {
        let Some(&first) = members.first() else { return };
        for &member in &members {
            let (from, to) = (group[member], group[first]);
            group.iter_mut().filter(|g| **g == from).for_each(|g| *g = to);
        }
    };
    for s in 0..n {
        let states = (0..n).filter(|&j| !model.a[(s, j)].is_zero());
        let inputs = (0..m).filter(|&j| !model.b[(s, j)].is_zero()).map(|j| n + j);
        join(std::iter::once(s).chain(states).chain(inputs).collect());
    }
    for row in &model.mixed_bounds {
        join((0..n + m).filter(|&j| !row.normal[j].is_zero()).collect());
    }
    for facet in &problem.workspace.facets {
        let axes = (0..problem.dimension).filter(|&axis| !facet.normal[axis].is_zero());
        join(axes.map(|axis| model.position[axis]).collect());
    }
    let mut names: Vec<usize> = group.clone();
    names.sort_unstable();
    names.dedup();
    let block = |name: &usize| Block {
        states: (0..n).filter(|&s| group[s] == *name).collect(),
        inputs: (0..m).filter(|&u| group[n + u] == *name).collect(),
    };
    names.iter().map(block).collect()
}

/// The gain that brings each block to rest: the first input of the least-energy sequence that does
/// so in as many steps as controllability takes (dead-beat for one input).
fn gain(a: &DMatrix<f64>, b: &DMatrix<f64>, blocks: &[Block]) -> DMatrix<f64> {
    let mut gain = DMatrix::zeros(b.ncols(), a.ncols());
    for block in blocks {
        let pick = |matrix: &DMatrix<f64>, columns: &[usize]| {
            DMatrix::from_fn(block.states.len(), columns.len(), |i, j| matrix[(block.states[i], columns[j])])
        };
        let (a, b) = (pick(a, &block.states), pick(b, &block.inputs));
        let Some(part) = block_gain(&a, &b) else { continue };
        for (i, &u) in block.inputs.iter().enumerate() {
            for (j, &s) in block.states.iter().enumerate() {
                gain[(u, s)] = part[(i, j)];
            }
        }
    }
    gain
}

fn block_gain(a: &DMatrix<f64>, b: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let (n, m) = (a.nrows(), b.ncols());
    if m == 0 {
        return None;
    }
    let mut blocks = vec![b.clone()];
    for steps in 1..=n {
        // x_N = A^N x + Σ A^{N−1−i} B u_i; the first input's block is the last power.
        let control = DMatrix::from_fn(n, steps * m, |i, j| blocks[steps - 1 - j / m][(i, j % m)]);
        let scale = control.amax().max(f64::MIN_POSITIVE);
        let power = (0..steps).fold(DMatrix::identity(n, n), |p, _| a * p);
        if steps == n || control.rank(1e-9 * scale) == n {
            let inverse = control.pseudo_inverse(1e-13 * scale).ok()?;
            return Some(-(inverse * power).rows(0, m).into_owned());
        }
        blocks.push(a * &blocks[steps - 1]);
    }
    None
}

fn responses(closed: &DMatrix<f64>, b: &DMatrix<f64>) -> Vec<DMatrix<f64>> {
    let mut responses = vec![b.clone()];
    let mut largest = b.amax();
    while responses.len() < 1000 {
        let next = closed * &responses[responses.len() - 1];
        largest = largest.max(next.amax());
        if next.amax() <= FADED * largest || !next.amax().is_finite() {
            break;
        }
        responses.push(next);
    }
    responses
}

/// The unknowns' units: the inverse of the largest response relative to the state's extent.
fn units(responses: &[DMatrix<f64>], bounds: &[(f64, f64)], blocks: &[Block], size: f64) -> Vec<f64> {
    let inputs = responses[0].ncols();
    let mut units = vec![1.0; inputs];
    for block in blocks {
        for &u in &block.inputs {
            let share = |s: usize| {
                let extent = bounds[s].1 - bounds[s].0;
                let largest = responses.iter().fold(0.0f64, |a, r| a.max(r[(s, u)].abs()));
                largest / if extent.is_finite() && extent > 0.0 { extent } else { size }
            };
            let most = block.states.iter().map(|&s| share(s)).fold(0.0, f64::max);
            if most > 0.0 {
                units[u] = 1.0 / most;
            }
        }
    }
    units
}
