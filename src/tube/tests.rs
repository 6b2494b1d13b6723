//! Tubes against closed forms, simulation, and models that have none.

use super::*;
use crate::diag::Diagnostics;
use crate::exact::{Rational, RationalMatrix};
use crate::geometry::HalfSpace;
use crate::ir::Enclosure;
use crate::ir::sample::{empty, exact, integrators, interval, model, point};
use crate::law::Float;
use proptest::prelude::*;

/// A matrix of so many columns, row by row.
fn matrix(columns: usize, entries: &[f64]) -> RationalMatrix {
    let entries: Vec<_> = entries.iter().map(|&x| exact(x)).collect();
    RationalMatrix::from_row_slice(entries.len() / columns, columns, &entries)
}

fn tube_for(model: Model) -> Result<Tube, Diagnostics> {
    let mut diagnostics = Diagnostics::new();
    let tubes = synthesize(&empty(vec![model], 1000.0), &Spans::default(), Float::F64, &mut diagnostics);
    let first = |tubes: Tubes| tubes.values().next().cloned();
    tubes.ok().and_then(first).ok_or(diagnostics)
}

fn code_for(model: Model) -> &'static str {
    tube_for(model).unwrap_err().iter().next().unwrap().code
}

#[test]
fn chains_of_integrators_have_the_known_half_widths() {
    for (order, input, bounds, expected) in
        [(2, 4.0, &[4.0][..], 0.300), (3, 16.0, &[4.0, 8.0], 0.383), (4, 64.0, &[4.0, 8.0, 40.0], 0.483)]
    {
        let model = integrators(order, input, bounds);
        let tube = tube_for(model.clone()).unwrap();
        let width = tube.state_half_width(0);
        assert!((width - expected).abs() < 0.001, "order {order}: {width}, K = {}", tube.k());
        assert_eq!(width, tube.state_half_width(order), "both axes are alike");
        assert!(tube.input_half_width(0) <= 0.5 * input * 1.0001);
        assert!(admits(&model, &tube));
    }
}

#[test]
fn models_that_inputs_cannot_steer_are_refused() {
    let a = matrix(2, &[1.0, 0.0, 0.0, 1.0]);
    let b = matrix(1, &[1.0, 0.0]);
    assert_eq!(code_for(model(a.clone(), b.clone(), &[(-0.1, 0.1); 2], 1.0)), "dosm::tube::uncontrollable");
    // What forgets by itself need not be steered.
    let nilpotent = matrix(2, &[1.0, 1.0, 0.0, 0.0]);
    assert!(tube_for(model(nilpotent, b, &[(-0.1, 0.1); 2], 1.0)).is_ok());
}

/// A double integrator along one axis with a disturbance of its position.
fn cart(disturbance: (f64, f64)) -> Model {
    let a = matrix(2, &[1.0, 0.5, 0.0, 1.0]);
    let b = matrix(1, &[0.125, 0.5]);
    let mut model = model(a, b, &[disturbance, (0.0, 0.0)], 4.0);
    model.state_bounds[1] = Some(interval(-4.0, 4.0));
    model
}

/// The law as the robot runs it: ŵ from the error, the feedback from ŵ.
struct Law<'a> {
    tube: &'a Tube,
    /// ŵ_{t−1}, ŵ_{t−2} …
    past: Vec<Vec<f64>>,
}

impl Law<'_> {
    fn feedback(&mut self, error: &[f64]) -> Vec<f64> {
        let mut w = error.to_vec();
        for (d, past) in self.tube.d[1..].iter().zip(&self.past) {
            apply(d, past, &mut w, -1.0);
        }
        self.past.insert(0, w);
        self.past.truncate(self.tube.k());
        let mut input = vec![0.0; self.tube.m[0].nrows()];
        for (m, past) in self.tube.m.iter().zip(&self.past) {
            apply(m, past, &mut input, 1.0);
        }
        input
    }
}

fn apply(matrix: &DMatrix<f64>, vector: &[f64], sum: &mut [f64], factor: f64) {
    for (row, total) in matrix.row_iter().zip(sum) {
        *total += factor * row.iter().zip(vector).map(|(a, x)| a * x).sum::<f64>();
    }
}

/// Runs the law against corners of Θ less its mean: e stays in Ω and μ(e) in μ(Ω) along all axes
/// and diagonals, and ŵ in Θ'.
fn simulate(model: &Model, tube: &Tube, corners: impl Iterator<Item = bool>) {
    let doubles = |m: &RationalMatrix| m.map(|x| x.to_f64());
    let (a, b) = (doubles(&model.a), doubles(&model.b));
    let half: Vec<f64> = model.disturbance.iter().map(|d| (&d.hi - &d.lo).to_f64() / 2.0).collect();
    let mut law = Law { tube, past: Vec::new() };
    let mut error = vec![0.0; model.n()];
    let mut corners = corners;
    for _ in 0..60 {
        let input = law.feedback(&error);
        for (i, w) in law.past[0].iter().enumerate() {
            assert!(w.abs() <= tube.half_width[i], "ŵ leaves the box");
        }
        for signs in 0..1u32 << model.n() {
            let direction: Vec<f64> =
                (0..model.n()).map(|i| if signs >> i & 1 == 0 { 1.0 } else { -1.0 }).collect();
            let reach: f64 = error.iter().zip(&direction).map(|(e, d)| e * d).sum();
            assert!(reach <= tube.support_up(&direction) * (1.0 + 1e-12), "e leaves Ω");
        }
        for (k, u) in input.iter().enumerate() {
            assert!(u.abs() <= tube.input_half_width(k) * (1.0 + 1e-12), "μ(e) leaves μ(Ω)");
        }
        let mut next: Vec<f64> =
            half.iter().map(|h| if corners.next().unwrap_or(true) { *h } else { -h }).collect();
        apply(&a, &error, &mut next, 1.0);
        apply(&b, &input, &mut next, 1.0);
        error = next;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn errors_of_random_models_stay_in_their_tubes(
        entries in prop::collection::vec(-12i64..13, 9),
        inputs in prop::collection::vec(-8i64..9, 3),
        n in 2usize..4,
        lo in -0.3f64..0.1,
        corners in prop::collection::vec(any::<bool>(), 180),
    ) {
        let tenth = |x: &i64| Rational::ratio(*x, 10);
        let a = RationalMatrix::from_fn(n, n, |i, j| tenth(&entries[i * n + j]));
        let b = RationalMatrix::from_fn(n, 1, |i, _| tenth(&inputs[i]));
        let disturbance: Vec<_> = (0..n).map(|i| if i == 1 { (0.0, 0.0) } else { (lo, lo + 0.25) }).collect();
        let model = model(a, b, &disturbance, 1e4);
        match tube_for(model.clone()) {
            Ok(tube) => {
                prop_assert!(admits(&model, &tube));
                simulate(&model, &tube, corners.into_iter());
            }
            // Random models may be uncontrollable or so close to it that the inputs are too weak.
            Err(diagnostics) => prop_assert!(diagnostics.has_errors()),
        }
    }
}

#[test]
fn the_law_keeps_integrators_in_their_tube() {
    for (order, input, bounds) in [(2, 4.0, &[4.0][..]), (4, 64.0, &[4.0, 8.0, 40.0])] {
        let model = integrators(order, input, bounds);
        let tube = tube_for(model.clone()).unwrap();
        simulate(&model, &tube, (0..).map(|i: u64| i.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 63 == 0));
        simulate(&model, &tube, std::iter::repeat(true));
    }
}

#[test]
fn erratum_p11_the_enlarged_box_holds_zero_wherever_the_disturbance_lies() {
    let centred = tube_for(cart((-0.1, 0.1))).unwrap();
    for (lo, hi) in [(0.1, 0.3), (-0.5, -0.3), (0.0, 0.2)] {
        let model = cart((lo, hi));
        let tube = tube_for(model.clone()).unwrap();
        assert!(tube.center.iter().zip(&tube.half_width).all(|(c, h)| c.abs() <= *h));
        assert!((tube.state_half_width(0) - centred.state_half_width(0)).abs() < 1e-6);
        assert!(admits(&model, &tube));
        simulate(&model, &tube, std::iter::repeat(false));
    }
}

#[test]
fn erratum_p15_bounds_need_not_hold_zero() {
    let plain = tube_for(cart((-0.2, 0.2))).unwrap();
    let mut moved = cart((-0.2, 0.2));
    moved.state_bounds[1] = Some(interval(10.0, 18.0));
    moved.input_bounds[0] = interval(-20.0, -12.0);
    let tube = tube_for(moved.clone()).unwrap();
    assert_eq!((tube.k(), &tube.d, &tube.m), (plain.k(), &plain.d, &plain.m));
    // The same as inequalities over (x, u), where only the middle is free.
    let row = |normal: &[f64], offset: f64| HalfSpace { normal: point(normal), offset: exact(offset) };
    moved.mixed_bounds = vec![row(&[0.0, 1.0, 0.0], 13.0), row(&[0.0, 0.0, 1.0], -14.0)];
    let inside = tube_for(moved.clone()).unwrap();
    assert!((inside.state_half_width(0) - plain.state_half_width(0)).abs() < 1e-3);
    // 0.2 m within steps of 0.5 s take ±0.4 m/s, which do not fit between 10 and 10.5.
    moved.mixed_bounds[0].offset = exact(10.5);
    assert_eq!(code_for(moved), "dosm::tube::narrow_bounds");
}

#[test]
fn erratum_p15_the_share_also_holds_for_inequalities_over_inputs() {
    let mut model = cart((-0.05, 0.05));
    model.input_bounds[0] = interval(-20.0, 0.0);
    model.mixed_bounds = vec![HalfSpace { normal: point(&[0.0, 0.0, 1.0]), offset: exact(-18.0) }];
    model.rejection = Some(Rational::ratio(3, 10));
    // Of the two units between −20 and −18, the feedback may use 0.3 each way of the middle.
    let tube = tube_for(model).unwrap();
    assert!(tube.input_half_width(0) <= 0.3 * (1.0 + 1e-6), "{}", tube.input_half_width(0));
}

#[test]
fn far_from_the_origin_rounding_takes_a_larger_margin() {
    let model = integrators(2, 4.0, &[4.0]);
    let mut problem = empty(vec![model.clone()], 10.0);
    problem.workspace = problem.workspace.translate(&point(&[1e6, 1e6]));
    let tubes = synthesize(&problem, &Spans::default(), Float::F64, &mut Diagnostics::new()).unwrap();
    let tube = &tubes[ModelId::new(0)];
    assert!(tube.reserve[0] > 1e6 * 100.0 * f64::EPSILON);
    assert!(tube.residual_allowance[0] > tube.reserve[0]);
    assert!(tube.state_half_width(0) < 0.301);
}

#[test]
fn tubes_scale_with_the_unit_of_length() {
    let plain = tube_for(integrators(2, 4.0, &[4.0])).unwrap();
    for scale in [1e-6, 1e-3, 1e3, 1e6] {
        let factor = exact(scale);
        let mut model = integrators(2, 4.0, &[4.0]);
        let intervals = model.state_bounds.iter_mut().flatten();
        for interval in intervals.chain(&mut model.input_bounds).chain(&mut model.disturbance) {
            interval.lo *= &factor;
            interval.hi *= &factor;
        }
        let problem = empty(vec![model.clone()], 1000.0 * scale);
        let tubes = synthesize(&problem, &Spans::default(), Float::F64, &mut Diagnostics::new()).unwrap();
        let tube = &tubes[ModelId::new(0)];
        let (width, expected) = (tube.state_half_width(0) / scale, plain.state_half_width(0));
        assert!((width - expected).abs() < 1e-6, "{scale}: {width} for {expected}");
        assert!(tube.residual_allowance.iter().all(|r| *r > 1e-10 * scale));
        assert!(tube.reserve.iter().all(|r| *r > 0.0 && *r < 1e-7 * scale));
    }
}

#[test]
fn without_a_disturbance_the_tube_is_a_mere_margin() {
    let model = cart((0.0, 0.0));
    let tube = tube_for(model.clone()).unwrap();
    assert!(tube.half_width.iter().chain(&tube.reserve).all(|h| *h > 0.0));
    assert!(tube.state_half_width(0) < 1e-4);
    assert!(admits(&model, &tube));
}

#[test]
fn a_tube_with_wrong_numbers_is_not_admitted() {
    let model = cart((-0.2, 0.2));
    let tube = tube_for(model.clone()).unwrap();
    let refused = |change: fn(&mut Tube)| {
        let mut wrong = tube.clone();
        change(&mut wrong);
        !admits(&model, &wrong)
    };
    assert!(refused(|t| t.m[0][(0, 0)] += 1e-5));
    assert!(refused(|t| t.d[1][(0, 0)] += 1e-5));
    // The last gain closes the chain: nothing but D_K = 0 tells that it is wrong.
    assert!(refused(|t| t.m.iter_mut().last().unwrap()[(0, 0)] += 1e-5));
    assert!(refused(|t| {
        t.d.pop();
        t.m.pop();
    }));
    assert!(refused(|t| t.half_width[0] = 0.2));
    assert!(refused(|t| t.center[0] = 0.3));
    assert!(refused(|t| t.reserve[0] = 1e-3));
    assert!(refused(|t| t.m[0][(0, 0)] = f64::NAN));
    assert!(!refused(|_| {}));
}

#[test]
fn an_enclosure_of_the_model_widens_the_margin() {
    let mut model = cart((-0.2, 0.2));
    let small = |rows: usize, columns: usize| RationalMatrix::from_element(rows, columns, exact(1e-9));
    model.enclosure = Some(Enclosure { a: small(2, 2), b: small(2, 1), c: vec![exact(1e-9); 2] });
    let tube = tube_for(model.clone()).unwrap();
    let plain = tube_for(cart((-0.2, 0.2))).unwrap();
    // Positions up to 1000 m make 1e-9 a micrometre.
    assert!(tube.half_width[0] > plain.half_width[0] + 1e-6);
    assert!(tube.residual_allowance[0] > 1.5e-6);
    assert!(admits(&model, &tube));
    let exact_model = Model { enclosure: None, ..model.clone() };
    let (with, without) =
        (residual_room(&model, &tube).unwrap(), residual_room(&exact_model, &tube).unwrap());
    // |ΔA| Σ|D_i| half_width + |ΔB| Σ|M_i| half_width, all entries of the errors being alike.
    let sum = |list: &[DMatrix<f64>]| -> Rational {
        let columns = |m: &DMatrix<f64>| {
            (0..2).map(|j| exact(m.column(j).abs().sum()) * exact(tube.half_width[j])).sum::<Rational>()
        };
        list.iter().map(columns).sum::<Rational>() * exact(1e-9)
    };
    let both = (sum(&tube.d) + sum(&tube.m)).to_f64();
    for (with, without) in with.iter().zip(&without) {
        assert!(((without - with).to_f64() / both - 1.0).abs() < 1e-9);
    }
}

#[test]
fn weak_inputs_are_told_what_would_do() {
    let mut model = cart((-50.0, 50.0));
    model.state_bounds[1] = None;
    assert_eq!(code_for(model.clone()), "dosm::tube::weak_inputs");
    // Eight steps of memory are not enough for 50 m.
    let help = help_for(model.clone());
    assert!(help.contains("a bound of `u0`") && !help.contains("rejection"), "{help}");
    model.input_bounds[0] = interval(-400.0, 400.0);
    model.rejection = Some(Rational::ratio(1, 10));
    let help = help_for(model.clone());
    let share = help.split("`rejection ").nth(1).and_then(|t| t.split('`').next()).unwrap();
    model.rejection = Some(exact(share.parse().unwrap()));
    assert!(tube_for(model.clone()).is_ok());
    model.rejection = Some(exact(share.parse::<f64>().unwrap() - 0.02));
    assert!(tube_for(model).is_err());
}

fn help_for(model: Model) -> String {
    tube_for(model).unwrap_err().iter().next().unwrap().help.clone().unwrap()
}

#[test]
fn tubes_too_wide_for_their_surroundings_are_refused() {
    let mut narrow = cart((-0.2, 0.2));
    narrow.state_bounds[1] = Some(interval(-0.1, 0.1));
    assert_eq!(code_for(narrow), "dosm::tube::wider_than_bound");
    let problem = empty(vec![integrators(2, 4.0, &[4.0])], 0.25);
    let mut diagnostics = Diagnostics::new();
    assert!(synthesize(&problem, &Spans::default(), Float::F64, &mut diagnostics).is_err());
    assert_eq!(diagnostics.iter().next().unwrap().code, "dosm::tube::wider_than_workspace");
}

#[test]
fn hardly_controllable_models_are_errors() {
    let mut weak = cart((-0.2, 0.2));
    weak.b = weak.b.map(|x| x * exact(1e-12));
    assert_eq!(code_for(weak), "dosm::tube::weak_inputs");
    let mut one_sided =
        model(matrix(2, &[1.0, 1e-12, 0.0, 1.0]), matrix(1, &[0.0, 1.0]), &[(-0.1, 0.1), (0.0, 0.0)], 1.0);
    assert!(tube_for(one_sided.clone()).is_err());
    one_sided.a[(0, 0)] = exact(1e200);
    one_sided.a[(0, 1)] = exact(1e200);
    assert!(tube_for(one_sided).is_err());
}

#[test]
fn the_share_is_the_least_that_costs_little() {
    let mut model = cart((-0.2, 0.2));
    let tube = tube_for(model.clone()).unwrap();
    let share = tube.beta;
    let next_smaller = exact(share) - Rational::ratio(1, 5);
    match tube.choice {
        Choice::Wider { share: smaller, factor } => assert!(factor > 1.1 && smaller < share, "{smaller}"),
        Choice::TooWeak { share: smaller } => {
            let weaker = Model { rejection: Some(exact(smaller)), ..model.clone() };
            assert!(smaller < share && tube_for(weaker).is_err());
        }
        Choice::Least => assert_eq!(share, 0.3),
        Choice::Asked => panic!("the mission does not say"),
    }
    let width = |model: &Model| tube_for(model.clone()).unwrap().state_half_width(0);
    let chosen = width(&model);
    model.rejection = Some(Rational::ratio(9, 10));
    assert_eq!(tube_for(model.clone()).unwrap().choice, Choice::Asked);
    assert!(chosen <= 1.1 * width(&model) + 1e-9);
    model.rejection = Some(next_smaller);
    assert!(tube_for(model.clone()).is_err() || width(&model) >= chosen);
}
