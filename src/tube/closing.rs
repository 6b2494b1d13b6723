//! What the rounded numbers of a tube leave of its box: the signed inequality of theory.md §2.
//!
//! The checker has its own version of this; here it decides how exactly a planner must close its
//! equations, and refuses tubes whose numbers went wrong.

use nalgebra::DMatrix;

use crate::exact::Rational;
use crate::ir::Model;

use super::Tube;

/// The largest |A z + B v + c + mean − z⁺| that each component of Θ' still holds, exactly; negative
/// where even an exact plan would not do. Without the part of a `continuous` model that depends on
/// the plan (|ΔA||z| + |ΔB||v| + |Δc|), for which the margin has room of its own.
///
/// `None` when a number of the tube is not finite.
pub fn residual_room(model: &Model, tube: &Tube) -> Option<Vec<Rational>> {
    let exact = |values: &[f64]| values.iter().map(|x| Rational::from_f64(*x)).collect::<Option<Vec<_>>>();
    let (center, half_width) = (exact(&tube.center)?, exact(&tube.half_width)?);
    let reserve = exact(&tube.reserve)?;
    let mean = model.mean();
    let mut slack = mismatch(model, tube, &center, &half_width)?;
    slack.iter_mut().zip(&reserve).for_each(|(s, r)| *s += r);
    let room = |i: usize| {
        let above = &center[i] + &half_width[i] - (&model.disturbance[i].hi - &mean[i]) - &slack[i];
        let below = &model.disturbance[i].lo - &mean[i] - (&center[i] - &half_width[i]) - &slack[i];
        let holds_zero = center[i].abs() <= half_width[i];
        let room = Rational::min_of(&above, &below).clone();
        if holds_zero { room } else { Rational::from(-1) }
    };
    Some((0..model.n()).map(room).collect())
}

/// Whether a plan that follows the model exactly, disturbance mean included, keeps ŵ in Θ' for ever.
pub fn admits(model: &Model, tube: &Tube) -> bool {
    residual_room(model, tube).is_some_and(|room| room.iter().all(|r| !r.is_negative()))
}

/// Σ_i |R_i center| + |R_i| half_width with R_i = D_{i+1} − A D_i − B M_i, and what an enclosure of
/// A and B adds to |R_i|.
fn mismatch(
    model: &Model,
    tube: &Tube,
    center: &[Rational],
    half_width: &[Rational],
) -> Option<Vec<Rational>> {
    let n = model.n();
    let mut sum = vec![Rational::ZERO; n];
    let d = tube.d.iter().map(exact_matrix).collect::<Option<Vec<_>>>()?;
    let m = tube.m.iter().map(exact_matrix).collect::<Option<Vec<_>>>()?;
    for i in 0..tube.k() {
        for row in 0..n {
            let mut moved = Rational::ZERO;
            for column in 0..n {
                let next = d.get(i + 1).map_or(Rational::ZERO, |d| d[row][column].clone());
                let model_part = entry(&model.a, row, &d[i], column) + entry(&model.b, row, &m[i], column);
                let r = next - model_part;
                moved += &r * &center[column];
                let mut size = r.abs();
                if let Some(enclosure) = &model.enclosure {
                    size += entry_of_sizes(&enclosure.a, row, &d[i], column);
                    size += entry_of_sizes(&enclosure.b, row, &m[i], column);
                }
                if !size.is_zero() {
                    sum[row] += size * &half_width[column];
                }
            }
            sum[row] += moved.abs();
        }
    }
    Some(sum)
}

type Rows = Vec<Vec<Rational>>;

fn exact_matrix(matrix: &DMatrix<f64>) -> Option<Rows> {
    let row = |r: usize| matrix.row(r).iter().map(|x| Rational::from_f64(*x)).collect::<Option<Vec<_>>>();
    (0..matrix.nrows()).map(row).collect()
}

/// (left · right)[row, column].
fn entry(left: &DMatrix<Rational>, row: usize, right: &Rows, column: usize) -> Rational {
    let mut sum = Rational::ZERO;
    for (k, other) in right.iter().enumerate() {
        if !left[(row, k)].is_zero() && !other[column].is_zero() {
            sum += &left[(row, k)] * &other[column];
        }
    }
    sum
}

/// (left · |right|)[row, column].
fn entry_of_sizes(left: &DMatrix<Rational>, row: usize, right: &Rows, column: usize) -> Rational {
    right.iter().enumerate().map(|(k, other)| &left[(row, k)] * other[column].abs()).sum()
}
