//! The gains M of one block: a small linear program for each length K of the memory.
//!
//! Variables are the generators G_i = D_i·diag(θ') and N_i = M_i·diag(θ'), each as a difference of
//! non-negative parts, so that Σ|·| is linear; rows are G_{i+1} = A G_i + B N_i with G_0 = diag(θ')
//! and G_K = 0, and the bounds. States whose disturbance is a mere numerical margin get the gains
//! of least norm instead, which need no program.

use nalgebra::{DMatrix, DVector};

use super::block::Scaled;
use super::program::{Answer, Column, Optimum, Program, Terms};

/// A tube that improves by less than this share with one more step of memory is long enough.
const WORTHWHILE: f64 = 0.01;
/// The weight of all that is no position, to break ties.
const TIE_BREAK: f64 = 1e-4;
/// How much longer than the shortest memory that of an explanation is at most.
const EXPLAINED: usize = 8;
/// The share of a state's bound that the tube may take.
const STATE_ROOM: f64 = 0.99;
/// Disturbances below this share of the block's largest are left out of the program.
const NEGLIGIBLE: f64 = 1e-4;

/// The gains of a block in the program's units.
#[derive(Clone, Debug)]
pub(super) struct Gains {
    /// M_0 … M_{K−1}.
    pub(super) m: Vec<DMatrix<f64>>,
    /// The weighted sum of the position half-widths.
    pub(super) cost: f64,
    /// The largest share of an input's extent that the feedback takes.
    pub(super) share: f64,
}

/// Why a block has no gains.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum NoGains {
    /// Within the states' bounds, the inputs would have to give this share of their extent.
    Inputs {
        /// More than β.
        share: f64,
    },
    /// Within β𝒰, a state's error would have to take this share of its bound.
    State {
        /// The state's index in the block.
        state: usize,
        /// More than what it may take.
        share: f64,
    },
    /// No one bound is to blame.
    Bounds,
    /// The linear programs failed numerically.
    Numerics,
}

/// What a program is to minimise.
#[derive(Clone, Copy, PartialEq)]
enum Aim {
    /// The positions' half-widths, with the given share of the inputs.
    Position { beta: f64 },
    /// The share of the inputs.
    Inputs,
    /// The share of the states' bounds, with the given share of the inputs.
    States { beta: f64 },
}

/// The shortest memory that brings every error to 0, as far as doubles tell.
pub(super) fn shortest(scaled: &Scaled) -> usize {
    let n = scaled.a.nrows();
    (1..n).find(|&k| Chain::new(scaled, k).residual_of_least_norm() < 1e-9).unwrap_or(n)
}

/// Where to look for gains.
#[derive(Clone, Copy, Debug)]
pub(super) struct Search {
    /// The share of the inputs.
    pub(super) beta: f64,
    /// The shortest memory.
    pub(super) from: usize,
    /// The longest memory.
    pub(super) longest: usize,
    /// A cost that ends the search: 0 to look for the least.
    pub(super) enough: f64,
}

/// The gains with the least positions' half-widths within β of the inputs, or the first that are
/// good enough.
pub(super) fn gains(scaled: &Scaled, search: Search) -> Result<Gains, NoGains> {
    let Search { beta, from, longest, enough } = search;
    let mut best: Option<Gains> = None;
    let mut failed = false;
    let (mut k, mut jump) = (from, 1);
    while k <= longest {
        let mut stride = 1;
        match gains_of_length(scaled, k, Aim::Position { beta }) {
            Ok(found) if found.cost <= enough => return Ok(found),
            Ok(found) => {
                let previous = best.as_ref().map(|b| b.cost);
                if previous.is_some_and(|cost| found.cost > cost * (1.0 - WORTHWHILE)) {
                    return best.ok_or(NoGains::Numerics);
                }
                best = Some(found);
            }
            Err(NoGains::Numerics) => failed = true,
            // What fails with one memory fails with each shorter one, so no length is wrongly refused.
            Err(_) => {
                stride = jump;
                jump *= 2;
            }
        }
        if failed && best.is_some() {
            break;
        }
        k = if k < longest { longest.min(k + stride) } else { longest + 1 };
    }
    match best {
        Some(gains) => Ok(gains),
        None if failed => Err(NoGains::Numerics),
        None => Err(reason(scaled, beta, longest)),
    }
}

/// What would have to give way for there to be gains.
///
/// A memory of moderate length is enough to say something that would do.
fn reason(scaled: &Scaled, beta: f64, longest: usize) -> NoGains {
    let longest = longest.min(shortest(scaled) + EXPLAINED);
    if let Ok(gains) = gains_of_length(scaled, longest, Aim::Inputs) {
        return NoGains::Inputs { share: gains.share };
    }
    if let Ok(gains) = gains_of_length(scaled, longest, Aim::States { beta }) {
        let chain = Chain::new(scaled, longest);
        return widest_state(scaled, &chain.half_widths(&gains.m).0);
    }
    if scaled.mixed.is_empty() { reason_of_least_norm(scaled, beta, longest) } else { NoGains::Bounds }
}

/// The state whose error takes the largest share of its bound.
fn widest_state(scaled: &Scaled, used: &[f64]) -> NoGains {
    let share = |i: usize| scaled.state_bounds[i].map_or(0.0, |(lo, hi)| 2.0 * used[i] / (hi - lo));
    let state = (0..used.len()).max_by(|&i, &j| share(i).total_cmp(&share(j))).unwrap_or(0);
    NoGains::State { state, share: share(state) }
}

/// The bound that the gains of least norm break: what is left to say where states and inputs are
/// both too narrow, or where a program found no point for numerical reasons.
fn reason_of_least_norm(scaled: &Scaled, beta: f64, longest: usize) -> NoGains {
    let chain = Chain::new(scaled, longest);
    let (states, inputs) = chain.half_widths(&chain.least_norm());
    let shares = inputs.iter().zip(&scaled.input_bounds).map(|(h, (lo, hi))| 2.0 * h / (hi - lo));
    let share = shares.fold(0.0, f64::max);
    if share > beta && share.is_finite() {
        return NoGains::Inputs { share };
    }
    match widest_state(scaled, &states) {
        state @ NoGains::State { share, .. } if share > STATE_ROOM && share.is_finite() => state,
        _ => NoGains::Numerics,
    }
}

fn gains_of_length(scaled: &Scaled, k: usize, aim: Aim) -> Result<Gains, NoGains> {
    let chain = Chain::new(scaled, k);
    let largest = scaled.half_width.iter().zip(&scaled.disturbed).filter(|(_, d)| **d);
    let largest = largest.map(|(h, _)| *h).fold(0.0, f64::max);
    let active: Vec<usize> = (0..scaled.half_width.len())
        .filter(|&j| scaled.disturbed[j] && scaled.half_width[j] >= NEGLIGIBLE * largest)
        .collect();
    let mut m = chain.least_norm();
    // As many gains as conditions: there is nothing to choose, hence no program to solve.
    let unique = scaled.b.ncols() * k <= scaled.a.nrows() && scaled.mixed.is_empty();
    if !active.is_empty() && !unique {
        for gain in &mut m {
            active.iter().for_each(|&j| gain.column_mut(j).fill(0.0));
        }
        let spent = chain.half_widths_of(&m, |j| !active.contains(&j));
        let layout = Layout::new(&chain, &active, spent, aim);
        match layout.program.solve() {
            Answer::Optimal(optimum) => layout.read(&optimum, &mut m),
            Answer::Infeasible => return Err(NoGains::Bounds),
            Answer::Failed => return Err(NoGains::Numerics),
        }
        chain.refine(&mut m);
    }
    if m.iter().flat_map(|m| m.iter()).any(|x| !x.is_finite()) {
        return Err(NoGains::Numerics);
    }
    let (states, inputs) = chain.half_widths(&m);
    if !keeps_bounds(scaled, aim, &states, &inputs) {
        return Err(if unique { NoGains::Bounds } else { NoGains::Numerics });
    }
    let cost = states.iter().zip(&scaled.position_weight).map(|(h, w)| h * w).sum();
    let share = inputs.iter().zip(&scaled.input_bounds).map(|(h, (lo, hi))| 2.0 * h / (hi - lo));
    let share = share.filter(|s| !s.is_nan()).fold(0.0, f64::max);
    Ok(Gains { m, cost, share })
}

/// Whether the gains keep the bounds of their program after the last digits were mended: where the
/// inputs hardly tell two states apart, mending takes more than they have.
fn keeps_bounds(scaled: &Scaled, aim: Aim, states: &[f64], inputs: &[f64]) -> bool {
    let beta = match aim {
        Aim::Position { beta } | Aim::States { beta } => beta,
        Aim::Inputs => f64::INFINITY,
    };
    let within =
        |used: &f64, (lo, hi): (f64, f64), share: f64| *used <= share * (hi - lo) / 2.0 * (1.0 + 1e-6);
    let bounded = |(used, bounds): (&f64, &Option<(f64, f64)>)| {
        matches!(aim, Aim::States { .. }) || bounds.is_none_or(|b| within(used, b, 1.0))
    };
    states.iter().zip(&scaled.state_bounds).all(bounded)
        && (beta.is_infinite() || inputs.iter().zip(&scaled.input_bounds).all(|(u, b)| within(u, *b, beta)))
}

/// A block with a length of memory, and what linear algebra says of it.
struct Chain<'a> {
    scaled: &'a Scaled,
    k: usize,
    /// The pseudo-inverse of [A^{K−1}B … AB B], which is what the gains add to D_K.
    inverse: Option<DMatrix<f64>>,
}

impl<'a> Chain<'a> {
    fn new(scaled: &'a Scaled, k: usize) -> Chain<'a> {
        let (n, m) = scaled.b.shape();
        let mut reach = DMatrix::zeros(n, m * k);
        let mut power = scaled.b.clone();
        for i in (0..k).rev() {
            reach.view_mut((0, i * m), (n, m)).copy_from(&power);
            power = &scaled.a * power;
        }
        let size = reach.norm();
        let inverse = (m > 0).then(|| reach.pseudo_inverse(1e-13 * size).ok()).flatten();
        Chain { scaled, k, inverse }
    }

    /// D_0 … D_K under the gains.
    fn chain(&self, m: &[DMatrix<f64>]) -> Vec<DMatrix<f64>> {
        let n = self.scaled.a.nrows();
        let mut d = vec![DMatrix::identity(n, n)];
        for gain in m {
            let next = &self.scaled.a * &d[d.len() - 1] + &self.scaled.b * gain;
            d.push(next);
        }
        d
    }

    /// The gains of least norm that end the chain.
    fn least_norm(&self) -> Vec<DMatrix<f64>> {
        let (n, m) = self.scaled.b.shape();
        let mut gains = vec![DMatrix::zeros(m, n); self.k];
        self.refine(&mut gains);
        gains
    }

    /// Takes what is left of D_K away with the change of least norm, twice for the last digits.
    fn refine(&self, m: &mut [DMatrix<f64>]) {
        let Some(inverse) = &self.inverse else { return };
        let inputs = self.scaled.b.ncols();
        for _ in 0..2 {
            let left = self.chain(m).pop().unwrap_or_default();
            let change = inverse * left;
            for (i, gain) in m.iter_mut().enumerate() {
                *gain -= change.rows(i * inputs, inputs);
            }
        }
    }

    /// What the gains of least norm leave of D_K, relative to the size of A^K.
    fn residual_of_least_norm(&self) -> f64 {
        let free = self.chain(&vec![DMatrix::zeros(self.scaled.b.ncols(), self.scaled.a.nrows()); self.k]);
        let size = free.last().map_or(0.0, DMatrix::norm);
        let left = self.chain(&self.least_norm()).pop().map_or(0.0, |d| d.norm());
        if size == 0.0 { 0.0 } else { left / size.max(f64::MIN_POSITIVE) }
    }

    /// The half-widths of Ω and μ(Ω).
    fn half_widths(&self, m: &[DMatrix<f64>]) -> (Vec<f64>, Vec<f64>) {
        self.half_widths_of(m, |_| true)
    }

    /// The half-widths that the disturbances of some states alone make.
    fn half_widths_of(&self, m: &[DMatrix<f64>], counts: impl Fn(usize) -> bool) -> (Vec<f64>, Vec<f64>) {
        let width: Vec<f64> = self
            .scaled
            .half_width
            .iter()
            .enumerate()
            .map(|(j, h)| if counts(j) { *h } else { 0.0 })
            .collect();
        let width = DVector::from_vec(width);
        let of = |list: &[DMatrix<f64>], rows: usize| {
            let sum = list.iter().fold(DVector::zeros(rows), |sum, x| sum + x.abs() * &width);
            sum.iter().copied().collect()
        };
        let d = self.chain(m);
        (of(&d[..self.k], self.scaled.a.nrows()), of(m, self.scaled.b.ncols()))
    }
}

/// A number as the difference of two non-negative variables, or a constant.
#[derive(Clone, Copy)]
enum Entry {
    Split(Column, Column),
    Constant(f64),
}

impl Entry {
    fn add_to(self, terms: &mut Terms, constant: &mut f64, factor: f64) {
        match self {
            _ if factor == 0.0 => {}
            Entry::Split(plus, minus) => terms.extend([(plus, factor), (minus, -factor)]),
            Entry::Constant(value) => *constant += factor * value,
        }
    }

    fn add_size_to(self, terms: &mut Terms, constant: &mut f64, factor: f64) {
        match self {
            Entry::Split(plus, minus) => terms.extend([(plus, factor), (minus, factor)]),
            Entry::Constant(value) => *constant += factor * value.abs(),
        }
    }
}

/// The program of a chain, and where its unknowns are.
struct Layout<'a> {
    program: Program,
    scaled: &'a Scaled,
    active: &'a [usize],
    /// G_i by step, state and active disturbance.
    g: Vec<Vec<Vec<Entry>>>,
    /// N_i by step, input and active disturbance.
    n: Vec<Vec<Vec<Entry>>>,
    /// What the disturbances outside the program spend of each state's and input's bound.
    spent: (Vec<f64>, Vec<f64>),
    /// The variable share of the bounds, where that is the aim.
    share: Option<Column>,
    aim: Aim,
}

impl<'a> Layout<'a> {
    fn new(chain: &Chain<'a>, active: &'a [usize], spent: (Vec<f64>, Vec<f64>), aim: Aim) -> Layout<'a> {
        let mut layout = Layout {
            program: Program::new(),
            scaled: chain.scaled,
            active,
            g: Vec::new(),
            n: Vec::new(),
            spent,
            share: None,
            aim,
        };
        if !matches!(aim, Aim::Position { .. }) {
            layout.share = Some(layout.program.non_negative(1.0));
        }
        layout.add_variables(chain.k);
        layout.add_dynamics();
        layout.add_bounds();
        layout
    }

    fn beta(&self) -> f64 {
        match self.aim {
            Aim::Position { beta } | Aim::States { beta } => beta,
            Aim::Inputs => 1.0,
        }
    }

    fn add_variables(&mut self, k: usize) {
        let (states, inputs) = self.scaled.b.shape();
        let tie = if self.share.is_some() { 0.0 } else { TIE_BREAK };
        let cost = |state: usize| if self.share.is_some() { 0.0 } else { self.scaled.position_weight[state] };
        let costs: Vec<f64> = (0..states).map(|r| cost(r) + tie).collect();
        for i in 0..k {
            let first = i == 0;
            let grid =
                costs.iter().enumerate().map(|(r, &cost)| self.row(r, cost, first)).collect::<Vec<_>>();
            self.g.push(grid);
            let grid = (0..inputs).map(|_| self.row(usize::MAX, tie, false)).collect::<Vec<_>>();
            self.n.push(grid);
        }
    }

    /// One row of G_i or N_i; that of G_0 is diag(θ').
    fn row(&mut self, state: usize, cost: f64, first: bool) -> Vec<Entry> {
        let entry = |j: usize, program: &mut Program| {
            if first {
                Entry::Constant(if state == j { self.scaled.half_width[j] } else { 0.0 })
            } else {
                Entry::Split(program.non_negative(cost), program.non_negative(cost))
            }
        };
        self.active.iter().map(|&j| entry(j, &mut self.program)).collect()
    }

    /// G_{i+1} = A G_i + B N_i, and G_K = 0.
    fn add_dynamics(&mut self) {
        let (states, inputs) = self.scaled.b.shape();
        for i in 0..self.g.len() {
            for (r, j) in (0..states).flat_map(|r| (0..self.active.len()).map(move |j| (r, j))) {
                let (mut terms, mut constant) = (Terms::new(), 0.0);
                (0..states).for_each(|q| {
                    self.g[i][q][j].add_to(&mut terms, &mut constant, self.scaled.a[(r, q)]);
                });
                (0..inputs).for_each(|k| {
                    self.n[i][k][j].add_to(&mut terms, &mut constant, self.scaled.b[(r, k)]);
                });
                if let Some(next) = self.g.get(i + 1) {
                    next[r][j].add_to(&mut terms, &mut constant, -1.0);
                }
                if !terms.is_empty() || constant.abs() > 1e-12 {
                    self.program.equal(terms, -constant);
                }
            }
        }
    }

    fn add_bounds(&mut self) {
        for r in 0..self.scaled.a.nrows() {
            let Some((lo, hi)) = self.scaled.state_bounds[r] else { continue };
            let room = STATE_ROOM * (hi - lo) / 2.0;
            let shared = matches!(self.aim, Aim::States { .. });
            self.bound(|s| &s.g, r, room, self.spent.0[r], shared);
        }
        for k in 0..self.scaled.b.ncols() {
            let (lo, hi) = self.scaled.input_bounds[k];
            let room = self.beta() * (hi - lo) / 2.0;
            self.bound(|s| &s.n, k, room, self.spent.1[k], self.aim == Aim::Inputs);
        }
        if !self.scaled.mixed.is_empty() {
            self.add_mixed_bounds();
        }
    }

    /// Requires Σ|entries of a row| + spent ≤ room, or ≤ share · room.
    fn bound(
        &mut self,
        grid: fn(&Self) -> &Vec<Vec<Vec<Entry>>>,
        row: usize,
        room: f64,
        spent: f64,
        shared: bool,
    ) {
        let (mut terms, mut constant) = self.size_of(grid, row, 1.0);
        constant += spent;
        match self.share.filter(|_| shared) {
            Some(share) => {
                terms.push((share, -room));
                self.program.at_most(terms, -constant);
            }
            None => self.program.at_most(terms, room - constant),
        }
    }

    fn size_of(&self, grid: fn(&Self) -> &Vec<Vec<Vec<Entry>>>, row: usize, factor: f64) -> (Terms, f64) {
        let (mut terms, mut constant) = (Terms::new(), 0.0);
        for entry in grid(self).iter().flat_map(|matrix| &matrix[row]) {
            entry.add_size_to(&mut terms, &mut constant, factor);
        }
        (terms, constant)
    }

    /// P15: some x̄, ū with x̄ ⊕ Ω and ū ⊕ μ(Ω)/β within the boxes, and the general rows with the
    /// joint support (that of rows over inputs alone over β too).
    fn add_mixed_bounds(&mut self) {
        let beta = self.beta();
        let (states, inputs) = self.scaled.b.shape();
        let x: Vec<Column> = (0..states).map(|_| self.program.free()).collect();
        let u: Vec<Column> = (0..inputs).map(|_| self.program.free()).collect();
        for (r, &centre) in x.iter().enumerate() {
            if let Some(bounds) = self.scaled.state_bounds[r] {
                self.centre(|s| &s.g, r, centre, bounds, 1.0, self.spent.0[r]);
            }
        }
        for (k, &centre) in u.iter().enumerate() {
            let bounds = self.scaled.input_bounds[k];
            self.centre(|s| &s.n, k, centre, bounds, 1.0 / beta, self.spent.1[k]);
        }
        for (a, b, offset) in &self.scaled.mixed {
            let factor = if a.iter().all(|c| *c == 0.0) { 1.0 / beta } else { 1.0 };
            let mut spent = 0.0;
            a.iter().zip(&self.spent.0).for_each(|(c, s)| spent += c.abs() * s);
            b.iter().zip(&self.spent.1).for_each(|(c, s)| spent += c.abs() * s);
            let (mut terms, constant) = self.joint_support(a, b, factor);
            terms.extend(x.iter().zip(a).chain(u.iter().zip(b)).map(|(v, c)| (*v, *c)));
            self.program.at_most(terms, offset - constant - factor * spent);
        }
    }

    /// Requires bounds.0 + factor·h ≤ centre ≤ bounds.1 − factor·h, h the half-width of a row.
    fn centre(
        &mut self,
        grid: fn(&Self) -> &Vec<Vec<Vec<Entry>>>,
        row: usize,
        centre: Column,
        (lo, hi): (f64, f64),
        factor: f64,
        spent: f64,
    ) {
        let (terms, constant) = self.size_of(grid, row, factor);
        let constant = constant + factor * spent;
        let with = |sign: f64| terms.iter().copied().chain([(centre, sign)]).collect::<Terms>();
        self.program.at_most(with(1.0), hi - constant);
        self.program.at_most(with(-1.0), -lo - constant);
    }

    /// factor · Σ |a·G_i + b·N_i| as terms and a constant.
    fn joint_support(&mut self, a: &[f64], b: &[f64], factor: f64) -> (Terms, f64) {
        let (mut total, constant) = (Terms::new(), 0.0);
        for i in 0..self.g.len() {
            for j in 0..self.active.len() {
                let (mut terms, mut value) = (Terms::new(), 0.0);
                a.iter().zip(&self.g[i]).for_each(|(c, row)| row[j].add_to(&mut terms, &mut value, *c));
                b.iter().zip(&self.n[i]).for_each(|(c, row)| row[j].add_to(&mut terms, &mut value, *c));
                let (plus, minus) = (self.program.non_negative(0.0), self.program.non_negative(0.0));
                terms.extend([(plus, -1.0), (minus, 1.0)]);
                self.program.equal(terms, -value);
                total.extend([(plus, factor), (minus, factor)]);
            }
        }
        (total, constant)
    }

    /// Writes the gains of the active disturbances.
    fn read(&self, optimum: &Optimum, m: &mut [DMatrix<f64>]) {
        let value = |entry: Entry| match entry {
            Entry::Split(plus, minus) => optimum.value(plus) - optimum.value(minus),
            Entry::Constant(value) => value,
        };
        for (gain, grid) in m.iter_mut().zip(&self.n) {
            for (k, row) in grid.iter().enumerate() {
                for (entry, &j) in row.iter().zip(self.active) {
                    gain[(k, j)] = value(*entry) / self.scaled.half_width[j];
                }
            }
        }
    }
}
