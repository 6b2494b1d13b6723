//! The tube: that the disturbance box holds all that the model doesn't explain (theory.md §2).

use super::report::{Kind, Ledger, Place};
use super::resolve::Resolved;
use super::zonotope::Zonotope;
use crate::exact::{Rational, RationalMatrix, dot};
use crate::ir::{Enclosure, Model, ModelId};

/// A tube e = Σ_i D_i ŵ_{t−1−i} with feedback Σ_i M_i ŵ_{t−1−i}, ŵ in a box.
pub(super) struct Tube {
    center: Vec<Rational>,
    half_width: Vec<Rational>,
    reserve: Vec<Rational>,
    d: Vec<Vec<Vec<Rational>>>,
    m: Vec<Vec<Vec<Rational>>>,
    /// Ω's position part.
    pub(super) positions: Zonotope,
}

impl Tube {
    /// The tube of K ≥ 1 matrices D (n × n) and M (m × n).
    pub(super) fn new(
        position: &[usize],
        center: Vec<Rational>,
        half_width: Vec<Rational>,
        reserve: Vec<Rational>,
        d: Vec<Vec<Vec<Rational>>>,
        m: Vec<Vec<Vec<Rational>>>,
    ) -> Tube {
        let middle = position.iter().map(|&i| d.iter().map(|d| dot(&d[i], &center)).sum()).collect();
        let generators = d.iter().flat_map(|d| {
            half_width.iter().enumerate().map(|(j, w)| position.iter().map(|&i| &d[i][j] * w).collect())
        });
        let positions = Zonotope::new(middle, generators.collect::<Vec<_>>());
        Tube { center, half_width, reserve, d, m, positions }
    }

    /// max a·e + b·μ over the tube, e and μ of the same ŵ; an empty slice stands for zeros.
    pub(super) fn support(&self, a: &[Rational], b: &[Rational]) -> Rational {
        let mut reach = Rational::ZERO;
        for (d, m) in self.d.iter().zip(&self.m) {
            for j in 0..self.center.len() {
                let entry = column_dot(a, d, j) + column_dot(b, m, j);
                if !entry.is_zero() {
                    reach += &entry * &self.center[j] + entry.abs() * &self.half_width[j];
                }
            }
        }
        reach
    }
}

fn column_dot(a: &[Rational], matrix: &[Vec<Rational>], j: usize) -> Rational {
    a.iter()
        .zip(matrix)
        .filter(|(x, row)| !x.is_zero() && !row[j].is_zero())
        .map(|(x, row)| x * &row[j])
        .sum()
}

/// Checks every model's tube, and that every robot starts in it.
pub(super) fn check(plan: &Resolved, ledger: &mut Ledger) {
    for (id, model) in plan.problem.models.iter() {
        let tube = &plan.tubes[id];
        box_itself(tube, model, ledger);
        invariance(plan, id, model, tube, ledger);
    }
    starts(plan, ledger);
}

/// D_0 = I, reserve > 0, 0 in the box.
fn box_itself(tube: &Tube, model: &Model, ledger: &mut Ledger) {
    let place = || Place::subject(&model.name);
    let identity = tube.d[0].iter().enumerate().all(|(i, row)| {
        row.iter().enumerate().all(|(j, x)| *x == if i == j { Rational::ONE } else { Rational::ZERO })
    });
    ledger.claim(Kind::Tube, identity, || (place(), "the first matrix D is not the identity".into()));
    for (i, signal) in model.states.iter().enumerate() {
        let place = || Place::subject(&format!("{}.{}", model.name, signal.name));
        ledger.claim(Kind::Tube, tube.reserve[i].is_positive(), || {
            (place(), "the reserve is not positive".into())
        });
        let zero_inside = tube.center[i].abs() <= tube.half_width[i];
        ledger.claim(Kind::Tube, zero_inside, || (place(), "0 is not in the disturbance box".into()));
    }
}

/// center ± half_width holds θ, the plan's residuals, the tube's own mismatch and the reserve.
fn invariance(plan: &Resolved, id: ModelId, model: &Model, tube: &Tube, ledger: &mut Ledger) {
    let Some((least, most)) = residuals(plan, id, model) else { return };
    let mismatch = mismatch(model, tube);
    for (i, signal) in model.states.iter().enumerate() {
        let theta = &model.disturbance[i];
        let share = &mismatch[i] + &tube.reserve[i];
        let (center, half) = (&tube.center[i], &tube.half_width[i]);
        let above = center + half - (&theta.hi + &most[i] + &share);
        let below = &theta.lo + &least[i] - &share - (center - half);
        for slack in [above, below] {
            ledger.not_negative(Kind::Tube, &slack, 1.0, || {
                let place = Place::subject(&format!("{}.{}", model.name, signal.name));
                let lacking = -slack.to_f64();
                (place, format!("the disturbance box is too small by {lacking:.3e} for what it must hold"))
            });
        }
    }
}

/// Least and greatest r_t = A z_t + B v_t + c − z_{t+1} of all robots of the model, component by
/// component, less or plus what the model's enclosure leaves open; `None` without robots.
fn residuals(plan: &Resolved, id: ModelId, model: &Model) -> Option<(Vec<Rational>, Vec<Rational>)> {
    let mut range: Option<(Vec<Rational>, Vec<Rational>)> = None;
    for robot in plan.robots.values().filter(|r| r.model == id) {
        for t in plan.steps() {
            let (z, v, next) = (&robot.z[t], &robot.v[t], &robot.z[plan.next(t)]);
            for i in 0..model.n() {
                let residual = row_dot(&model.a, i, z) + row_dot(&model.b, i, v) + &model.c[i] - &next[i];
                let open = model.enclosure.as_ref().map_or(Rational::ZERO, |e| open(e, i, z, v));
                let (low, high) = (&residual - &open, &residual + &open);
                let (least, most) = range.get_or_insert_with(|| (Vec::new(), Vec::new()));
                if least.len() == i {
                    least.push(low);
                    most.push(high);
                    continue;
                }
                if low < least[i] {
                    least[i] = low;
                }
                if high > most[i] {
                    most[i] = high;
                }
            }
        }
    }
    range
}

/// |ΔA||z| + |ΔB||v| + |Δc|, one component.
fn open(enclosure: &Enclosure, i: usize, z: &[Rational], v: &[Rational]) -> Rational {
    let sum = |matrix: &RationalMatrix, x: &[Rational]| -> Rational {
        x.iter().enumerate().map(|(j, x)| matrix[(i, j)].abs() * x.abs()).sum()
    };
    sum(&enclosure.a, z) + sum(&enclosure.b, v) + enclosure.c[i].abs()
}

/// Σ_i |R_i center| + E_i |center| + (|R_i| + E_i) half_width with R_i = D_{i+1} − A D_i − B M_i,
/// D_K = 0 and E_i = |ΔA||D_i| + |ΔB||M_i|.
fn mismatch(model: &Model, tube: &Tube) -> Vec<Rational> {
    let n = model.n();
    let mut sum = vec![Rational::ZERO; n];
    for step in 0..tube.d.len() {
        let (d, m, next) = (&tube.d[step], &tube.m[step], tube.d.get(step + 1));
        for (i, sum) in sum.iter_mut().enumerate() {
            let mut off_center = Rational::ZERO;
            for j in 0..n {
                let entry = next.map_or(Rational::ZERO, |next| next[i][j].clone())
                    - row_times_column(&model.a, i, d, j)
                    - row_times_column(&model.b, i, m, j);
                off_center += &entry * &tube.center[j];
                *sum += entry.abs() * &tube.half_width[j];
                if let Some(e) = &model.enclosure {
                    let open = open_product(&e.a, i, d, j) + open_product(&e.b, i, m, j);
                    *sum += open * (tube.center[j].abs() + &tube.half_width[j]);
                }
            }
            *sum += off_center.abs();
        }
    }
    sum
}

fn row_dot(matrix: &RationalMatrix, i: usize, x: &[Rational]) -> Rational {
    x.iter().enumerate().filter(|(j, _)| !matrix[(i, *j)].is_zero()).map(|(j, x)| &matrix[(i, j)] * x).sum()
}

fn row_times_column(matrix: &RationalMatrix, i: usize, rows: &[Vec<Rational>], j: usize) -> Rational {
    let terms = rows.iter().enumerate().filter(|(l, row)| !matrix[(i, *l)].is_zero() && !row[j].is_zero());
    terms.map(|(l, row)| &matrix[(i, l)] * &row[j]).sum()
}

fn open_product(matrix: &RationalMatrix, i: usize, rows: &[Vec<Rational>], j: usize) -> Rational {
    rows.iter().enumerate().map(|(l, row)| matrix[(i, l)].abs() * row[j].abs()).sum()
}

/// |x̄_0 − z_0 − center| ≤ half_width: the first error is one admissible disturbance.
fn starts(plan: &Resolved, ledger: &mut Ledger) {
    ledger.reach(Kind::Start);
    for (id, robot) in plan.robots.iter() {
        let (tube, model) = (plan.tube(id), &plan.problem.models[robot.model]);
        let start = &plan.problem.robots[id].start;
        for (i, signal) in model.states.iter().enumerate() {
            let off = (&start[i] - &robot.z[0][i] - &tube.center[i]).abs();
            let slack = &tube.half_width[i] - off;
            ledger.not_negative(Kind::Start, &slack, 1.0, || {
                let place = Place::robot(robot.name).about(&signal.name).at(0);
                (place, "the initial state lies outside the tube".into())
            });
        }
    }
}
