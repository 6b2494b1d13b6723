//! The exact zero-order hold of a continuous model, enclosed in rationals.
//!
//! With M = [A B c; 0], the sampled model is the upper part of e^{MT}. Where M is nilpotent (chains
//! of integrators) the series ends and the answer is exact. Otherwise the exponential of MT/2^s is
//! summed on a grid of 2^−P and squared s times, with a bound on the error that goes along.

use crate::exact::{Rational, RationalMatrix};
use crate::quantity::in_range;

/// P, the bits behind the point. Errors grow by the squarings only, at most 2^20-fold or so a step.
const GRID_BITS: i32 = 320;
/// The most squarings: beyond, a model changes by more than e^(2^19) within a step.
const MAX_SQUARINGS: u32 = 20;
/// The order of the series: with a norm below 1/2 the rest is below 2^−300.
const ORDER: i64 = 64;

/// A sampled model and how far the true one may be from it, entry by entry.
#[derive(Debug)]
pub(super) struct Hold {
    /// [A B c] of the sampled model, n rows.
    pub(super) value: RationalMatrix,
    /// The errors; `None` where the value is exact.
    pub(super) error: Option<RationalMatrix>,
}

/// The hold over `step` of dx/dt = M (x, u, 1), where `m` has n rows; `None` where it is out of range.
pub(super) fn zero_order_hold(m: &RationalMatrix, step: &Rational) -> Option<Hold> {
    let (n, width) = m.shape();
    let mut full = RationalMatrix::from_element(width, width, Rational::ZERO);
    full.view_mut((0, 0), (n, width)).copy_from(&m.map(|x| x * step));
    let hold = match nilpotent_exponential(&full) {
        Some(value) => Hold { value: value.rows(0, n).into_owned(), error: None },
        None => enclosed(&full, n)?,
    };
    hold.value.iter().all(in_range).then_some(hold)
}

/// e^M where some power of M is 0 by its pattern alone.
fn nilpotent_exponential(m: &RationalMatrix) -> Option<RationalMatrix> {
    let width = m.nrows();
    let mut sum = RationalMatrix::identity(width, width);
    let mut term = sum.clone();
    let mut pattern = RationalMatrix::identity(width, width).map(|x: Rational| !x.is_zero());
    let edges = m.map(|x| !x.is_zero());
    for k in 1..=width as i64 {
        pattern = product_of_patterns(&pattern, &edges);
        if pattern.iter().all(|reaches| !reaches) {
            return Some(sum);
        }
        term = (&term * m).map(|x| x / Rational::from(k));
        // Long entries are no use: the enclosure is for them.
        if !term.iter().all(in_range) {
            return None;
        }
        sum += &term;
    }
    None
}

fn product_of_patterns(a: &nalgebra::DMatrix<bool>, b: &nalgebra::DMatrix<bool>) -> nalgebra::DMatrix<bool> {
    let width = a.nrows();
    nalgebra::DMatrix::from_fn(width, width, |i, j| (0..width).any(|k| a[(i, k)] && b[(k, j)]))
}

/// The first n rows of e^M as doubles, with the errors.
fn enclosed(m: &RationalMatrix, n: usize) -> Option<Hold> {
    let mut squarings = 0;
    let mut scale = Rational::ONE;
    let norm_of_all = norm(m);
    while &norm_of_all * &scale > Rational::ratio(1, 2) {
        squarings += 1;
        scale *= Rational::ratio(1, 2);
        if squarings > MAX_SQUARINGS {
            return None;
        }
    }
    let (mut value, mut error) = series(&m.map(|x| x * &scale));
    for _ in 0..squarings {
        error = up(&(&error * (norm(&value) * Rational::from(2) + &error) + rounding(m.nrows())));
        value = (&value * &value).map(|x| cut(&x));
        if !value.iter().all(|x| x.is_zero() || x.abs() < i64::MAX) {
            return None;
        }
    }
    let reaches = reachability(m);
    let entry = |i: usize, j: usize| -> (Rational, Rational) {
        if !reaches[(i, j)] {
            return (Rational::ZERO, Rational::ZERO);
        }
        let double = Rational::from_f64(value[(i, j)].to_f64()).unwrap_or_default();
        let error = (&value[(i, j)] - &double).abs() + &error;
        (double, Rational::from_f64(error.to_f64_up()).unwrap_or(error))
    };
    let doubles = RationalMatrix::from_fn(n, m.ncols(), |i, j| entry(i, j).0);
    let errors = RationalMatrix::from_fn(n, m.ncols(), |i, j| entry(i, j).1);
    Some(Hold { value: doubles, error: Some(errors) })
}

/// Σ Mᵏ/k! on the grid for ‖M‖ ≤ 1/2, and a bound on the norm of its error.
fn series(m: &RationalMatrix) -> (RationalMatrix, Rational) {
    let width = m.nrows();
    let size = norm(m);
    let mut term = RationalMatrix::identity(width, width);
    let mut sum = term.clone();
    let (mut term_error, mut error) = (Rational::ZERO, Rational::ZERO);
    let mut rest = Rational::ONE;
    for k in 1..=ORDER {
        let k = Rational::from(k);
        term = (&term * m).map(|x| cut(&(x / &k)));
        sum += &term;
        term_error = up(&(term_error * &size / &k + rounding(width)));
        error += &term_error;
        rest = rest * &size / &k;
    }
    // What the series leaves out is at most the last term's bound again, since the norm is ≤ 1/2.
    (sum, up(&(error + rest)))
}

/// Which entries of a power of M, the 0th included, are not 0 by its pattern alone.
fn reachability(m: &RationalMatrix) -> nalgebra::DMatrix<bool> {
    let width = m.nrows();
    let mut reaches = nalgebra::DMatrix::from_fn(width, width, |i, j| i == j || !m[(i, j)].is_zero());
    for _ in 0..usize::BITS - width.leading_zeros() {
        reaches = product_of_patterns(&reaches, &reaches);
    }
    reaches
}

/// The largest row sum of absolute values.
fn norm(m: &RationalMatrix) -> Rational {
    m.row_iter().map(|row| row.iter().map(Rational::abs).sum::<Rational>()).max().unwrap_or_default()
}

/// What rounding every entry of a row down to the grid may add to a norm.
fn rounding(width: usize) -> Rational {
    Rational::from(width as i64) / grid()
}

fn grid() -> Rational {
    Rational::from(2).pow(GRID_BITS).unwrap_or(Rational::ONE)
}

/// The next number of the grid below.
fn cut(x: &Rational) -> Rational {
    if x.is_zero() { Rational::ZERO } else { (x * grid()).floor() / grid() }
}

/// The next number of the grid above.
fn up(x: &Rational) -> Rational {
    (x * grid()).ceil() / grid()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(rows: usize, entries: &[f64]) -> RationalMatrix {
        let entries: Vec<Rational> = entries.iter().map(|x| Rational::from_f64(*x).unwrap()).collect();
        RationalMatrix::from_row_slice(rows, entries.len() / rows, &entries)
    }

    /// Whether the enclosure holds the values, which are doubles near the true ones.
    fn check(m: &RationalMatrix, step: f64, expect: &[f64]) {
        let hold = zero_order_hold(m, &Rational::from_f64(step).unwrap()).unwrap();
        let error = hold.error.unwrap();
        let entries = hold.value.row_iter().flat_map(|r| r.iter().cloned().collect::<Vec<_>>());
        let errors = error.row_iter().flat_map(|r| r.iter().cloned().collect::<Vec<_>>());
        for ((ours, theirs), error) in entries.zip(expect).zip(errors) {
            let (ours, error) = (ours.to_f64(), error.to_f64());
            assert!((ours - theirs).abs() <= 4e-16 * theirs.abs().max(1e-300), "{ours} is not {theirs}");
            assert!(error <= 1.2e-16 * ours.abs(), "{error} at {ours}");
            assert_eq!(error == 0.0, ours == 0.0 || ours == 1.0);
        }
    }

    #[test]
    fn a_lag_decays() {
        // dx/dt = −2x + 3u + 1
        let decayed = (-1f64).exp();
        let rest = -(-1f64).exp_m1() / 2.0;
        check(&matrix(1, &[-2.0, 3.0, 1.0]), 0.5, &[decayed, 3.0 * rest, rest]);
    }

    #[test]
    fn a_stiff_lag_is_squared_down_to_nearly_nothing() {
        let hold = zero_order_hold(&matrix(1, &[-1024.0, 1024.0, 0.0]), &Rational::ratio(1, 2)).unwrap();
        let (value, error) = (hold.value, hold.error.unwrap());
        assert!(value[(0, 0)].abs().to_f64() < 1e-80 && error[(0, 0)].to_f64() < 1e-80);
        assert_eq!(value[(0, 1)], Rational::ONE);
        assert!(error[(0, 1)].is_positive() && error[(0, 1)].to_f64() < 1e-80);
    }

    #[test]
    fn an_oscillator_turns_and_what_it_does_not_reach_stays_zero() {
        let m = matrix(3, &[0.0, 1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 2.0, 0.0]);
        let (sin, cos) = (1f64.sin(), 1f64.cos());
        let (decayed, gained) = ((-1f64).exp(), -2.0 * (-1f64).exp_m1());
        check(&m, 1.0, &[cos, sin, 0.0, 0.0, 0.0, -sin, cos, 0.0, 0.0, 0.0, 0.0, 0.0, decayed, gained, 0.0]);
    }

    #[test]
    fn integrators_are_exact() {
        let m = matrix(2, &[0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        let hold = zero_order_hold(&m, &Rational::ratio(1, 3)).unwrap();
        assert!(hold.error.is_none());
        let expect = [1, 0, 0, 1].map(Rational::from);
        assert_eq!(hold.value[(0, 0)], expect[0]);
        assert_eq!(hold.value[(0, 1)], Rational::ratio(1, 3));
        assert_eq!(hold.value[(0, 2)], Rational::ratio(1, 18));
        assert_eq!(hold.value[(1, 2)], Rational::ratio(1, 3));
    }

    #[test]
    fn models_that_explode_within_a_step_are_refused() {
        assert!(zero_order_hold(&matrix(1, &[1e6, 1.0, 0.0]), &Rational::ONE).is_none());
        assert!(zero_order_hold(&matrix(1, &[500.0, 1.0, 0.0]), &Rational::ONE).is_none());
    }
}
