//! How robots move between samples.
//!
//! The motion over a step is the one that, repeated eight times, gives the step: the principal eighth
//! root of the matrix of (x, u, 1) ↦ (A x + B u + c, u, 1), input held. Where there is none (A with
//! eigenvalues that are 0 or negative), or it is not found, robots move straight. The disturbance comes
//! in evenly over the step.

use nalgebra::DMatrix;

use super::body::{Point, length};
use crate::ir::Model;

/// The parts that a step is looked at in.
pub(super) const PARTS: usize = 8;

/// How far a model's motion is off the straight line from one sample to the next.
#[derive(Clone, Debug, Default)]
pub(super) struct Motion {
    /// Which entries of (x, u, 1) bend the motion.
    entries: Vec<usize>,
    /// By entry and instant: how far, along each axis.
    bends: Vec<[Point; PARTS - 1]>,
    /// By entry: the greatest of these lengths.
    most: Vec<f64>,
}

/// How far a robot is off the straight line at the instants of a step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bend {
    at: [Point; PARTS - 1],
}

/// Entries this small beside the largest are rounding.
const ROUNDING: f64 = 1e-12;
/// How well the root, repeated, must give the step.
const TRUE_ROOT: f64 = 1e-9;
/// After so many rounds a square root is not found.
const ROUNDS: usize = 60;

impl Motion {
    /// The motion of a model.
    pub(super) fn new(model: &Model) -> Motion {
        let step = augmented(model);
        let Some(root) = eighth_root(&step) else { return Motion::default() };
        let mut powers = vec![DMatrix::identity(step.nrows(), step.ncols())];
        (0..PARTS).for_each(|i| powers.push(&powers[i] * &root));
        // At instant j: the row of root^j, less the straight line's.
        let bend = |j: usize, row: usize, column: usize| {
            let share = j as f64 / PARTS as f64;
            let line = (1.0 - share) * powers[0][(row, column)] + share * step[(row, column)];
            let bend = powers[j][(row, column)] - line;
            if bend.abs() > ROUNDING * (1.0 + step.amax()) { bend } else { 0.0 }
        };
        let mut motion = Motion::default();
        for column in 0..step.ncols() {
            let mut bends = [[0.0; 3]; PARTS - 1];
            for (j, at) in bends.iter_mut().enumerate() {
                for (axis, &row) in model.position.iter().enumerate().take(3) {
                    at[axis] = bend(j + 1, row, column);
                }
            }
            if bends.iter().flatten().any(|x| *x != 0.0) {
                motion.entries.push(column);
                motion.most.push(bends.iter().map(length).fold(0.0, f64::max));
                motion.bends.push(bends);
            }
        }
        motion
    }

    /// How a step bends.
    pub(super) fn bend(&self, state: &[f64], input: &[f64]) -> Bend {
        let mut bend = Bend::default();
        for (&entry, bends) in self.entries.iter().zip(&self.bends) {
            let value = entry_of(entry, state, input);
            for (at, by) in bend.at.iter_mut().zip(bends) {
                (0..3).for_each(|axis| at[axis] += value * by[axis]);
            }
        }
        bend
    }

    /// At least how far a step bends at most.
    pub(super) fn most(&self, state: &[f64], input: &[f64]) -> f64 {
        let entries = self.entries.iter().zip(&self.most);
        entries.map(|(&entry, most)| entry_of(entry, state, input).abs() * most).sum()
    }
}

/// An entry of (x, u, 1).
fn entry_of(entry: usize, state: &[f64], input: &[f64]) -> f64 {
    match entry.checked_sub(state.len()) {
        None => state[entry],
        Some(i) => input.get(i).copied().unwrap_or(1.0),
    }
}

impl Bend {
    /// Where a robot is at an instant on its way from `p` to `q`.
    pub(super) fn place(&self, p: &Point, q: &Point, instant: usize) -> Point {
        let share = instant as f64 / PARTS as f64;
        let by = instant.checked_sub(1).and_then(|i| self.at.get(i)).copied().unwrap_or_default();
        [0, 1, 2].map(|i| p[i] + share * (q[i] - p[i]) + by[i])
    }
}

/// The matrix of (x, u, 1) ↦ (A x + B u + c, u, 1).
fn augmented(model: &Model) -> DMatrix<f64> {
    let (n, m) = (model.n(), model.m());
    let mut step = DMatrix::identity(n + m + 1, n + m + 1);
    for i in 0..n {
        (0..n).for_each(|j| step[(i, j)] = model.a[(i, j)].to_f64());
        (0..m).for_each(|j| step[(i, n + j)] = model.b[(i, j)].to_f64());
        step[(i, n + m)] = model.c[i].to_f64();
    }
    step
}

/// The principal eighth root, if there is one that, repeated, gives the matrix again.
fn eighth_root(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let root = square_root(&square_root(&square_root(matrix)?)?)?;
    let fourth = {
        let square = &root * &root;
        &square * &square
    };
    let again = &fourth * &fourth;
    let error = (again - matrix).amax();
    (error <= TRUE_ROOT * (1.0 + matrix.amax())).then_some(root)
}

/// The principal square root, by the iteration of Denman and Beavers (1976).
fn square_root(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let size = matrix.nrows();
    let (mut root, mut inverse) = (matrix.clone(), DMatrix::<f64>::identity(size, size));
    for _ in 0..ROUNDS {
        let (of_root, of_inverse) = (root.clone().try_inverse()?, inverse.clone().try_inverse()?);
        let next = (&root + of_inverse) * 0.5;
        inverse = (&inverse + of_root) * 0.5;
        let change = (&next - &root).amax();
        root = next;
        if !change.is_finite() {
            return None;
        }
        if change <= 1e-15 * (1.0 + root.amax()) {
            break;
        }
    }
    root.iter().all(|x| x.is_finite()).then_some(root)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{Rational, RationalMatrix};
    use crate::ir::sample;

    #[test]
    fn a_double_integrator_moves_along_parabolas() {
        let model = sample::integrators(2, 4.0, &[4.0]);
        let motion = Motion::new(&model);
        assert_eq!(motion.entries, [4, 5], "only inputs bend");
        let bend = motion.bend(&[1.0, 2.0, 3.0, 4.0], &[3.0, -2.0]);
        for (j, at) in bend.at.iter().enumerate() {
            let share = (j + 1) as f64 / 8.0;
            // p(s) = p + v sT + a (sT)²/2, the chord p + s (vT + aT²/2).
            let by = 0.5 * 0.25 * (share * share - share);
            assert!((at[0] - 3.0 * by).abs() < 1e-12 && (at[1] + 2.0 * by).abs() < 1e-12, "{at:?}");
        }
        let most = motion.most(&[1.0, 2.0, 3.0, 4.0], &[3.0, -2.0]);
        assert!((most - (3.0 + 2.0) * 0.25 * 0.125).abs() < 1e-12, "{most}");
        let middle = bend.place(&[0.0; 3], &[8.0, 0.0, 0.0], 4);
        assert!((middle[0] - 4.0 - bend.at[3][0]).abs() < 1e-12);
    }

    #[test]
    fn what_has_no_root_moves_straight() {
        let mirror = RationalMatrix::from_fn(2, 2, |i, j| Rational::from(if i == j { -1 } else { 0 }));
        let zero = RationalMatrix::from_fn(2, 2, |_, _| Rational::ZERO);
        let b = RationalMatrix::from_fn(2, 1, |_, _| Rational::ONE);
        for a in [mirror, zero] {
            let mut model = sample::model(a, b.clone(), &[(0.0, 0.0), (0.0, 0.0)], 1.0);
            model.position = vec![0, 1];
            let motion = Motion::new(&model);
            assert!(motion.entries.is_empty());
            assert_eq!(motion.most(&[1.0, 2.0], &[3.0]), 0.0);
        }
    }

    #[test]
    fn a_turn_moves_along_its_circle() {
        // A quarter turn a step: after j eighths the point is on the circle, j · 90°/8 on.
        let a = RationalMatrix::from_fn(2, 2, |i, j| Rational::from([[0, -1], [1, 0]][i][j]));
        let b = RationalMatrix::from_fn(2, 1, |_, _| Rational::ZERO);
        let mut model = sample::model(a, b, &[(0.0, 0.0), (0.0, 0.0)], 1.0);
        model.position = vec![0, 1];
        let bend = Motion::new(&model).bend(&[1.0, 0.0], &[0.0]);
        for j in 1..8 {
            let at = bend.place(&[1.0, 0.0, 0.0], &[0.0, 1.0, 0.0], j);
            let angle = j as f64 * std::f64::consts::FRAC_PI_2 / 8.0;
            assert!((at[0] - angle.cos()).abs() < 1e-9 && (at[1] - angle.sin()).abs() < 1e-9, "{j} {at:?}");
        }
    }
}
