//! Tubes against closed forms, simulation, and models that have none.

use super::*;
use crate::diag::Diagnostics;
use crate::exact::Rational;
use crate::geometry::Polytope;
use crate::ir::{Formulas, Interval, Robot, Signal};
use std::collections::BTreeMap;

fn interval(lo: f64, hi: f64) -> Interval {
    let exact = |x| Rational::from_f64(x).unwrap();
    Interval { lo: exact(lo), hi: exact(hi) }
}

fn signals(prefix: &str, count: usize) -> Vec<Signal> {
    let signal = |i| Signal { name: format!("{prefix}{i}"), doc: String::new(), unit: "1".into() };
    (0..count).map(signal).collect()
}

/// A model from rows of A and B.
fn model(a: DMatrix<f64>, b: DMatrix<f64>, disturbance: &[(f64, f64)], input: f64) -> Model {
    let exact = |m: &DMatrix<f64>| m.map(|x| Rational::from_f64(x).unwrap());
    let (n, m) = b.shape();
    Model {
        name: "Rover".into(),
        doc: String::new(),
        states: signals("x", n),
        inputs: signals("u", m),
        position: vec![0],
        a: exact(&a),
        b: exact(&b),
        c: vec![Rational::ZERO; n],
        enclosure: None,
        state_bounds: vec![None; n],
        input_bounds: vec![interval(-input, input); m],
        mixed_bounds: Vec::new(),
        disturbance: disturbance.iter().map(|&(lo, hi)| interval(lo, hi)).collect(),
        rejection: None,
    }
}

/// Chains of `order` integrators along two axes, step 0.5 s, position ±0.2 m, rejection 0.5.
fn integrators(order: usize, input: f64, bounds: &[f64]) -> Model {
    let t: f64 = 0.5;
    let power = |i: usize| (1..=i).fold(1.0, |p, k| p * t / k as f64);
    let n = 2 * order;
    let a = DMatrix::from_fn(n, n, |i, j| if i / order == j / order && j >= i { power(j - i) } else { 0.0 });
    let b = DMatrix::from_fn(n, 2, |i, k| if i / order == k { power(order - i % order) } else { 0.0 });
    let disturbance: Vec<_> = (0..n).map(|i| if i % order == 0 { (-0.2, 0.2) } else { (0.0, 0.0) }).collect();
    let mut model = model(a, b, &disturbance, input);
    model.a = model.a.map(|x| rational_near(&x));
    model.b = model.b.map(|x| rational_near(&x));
    model.position = vec![0, order];
    for (i, bound) in model.state_bounds.iter_mut().enumerate() {
        *bound = (i % order).checked_sub(1).map(|k| interval(-bounds[k], bounds[k]));
    }
    model.rejection = Some(Rational::ratio(1, 2));
    model
}

/// The fraction with denominator 384·k nearby: 1/48 and the like are no doubles.
fn rational_near(x: &Rational) -> Rational {
    let scale = Rational::from(384);
    (x * &scale + Rational::ratio(1, 2)).floor() / scale
}

fn problem(models: Vec<Model>, size: f64) -> Problem {
    let corner = |x: f64| vec![Rational::from_f64(x).unwrap(); 2];
    let start = |id: usize, m: &Model| Robot {
        name: format!("R{id}"),
        doc: String::new(),
        model: ModelId::new(id),
        start: vec![Rational::ZERO; m.n()],
    };
    Problem {
        name: "test".into(),
        doc: String::new(),
        sha256: String::new(),
        set: BTreeMap::new(),
        dimension: 2,
        step: Rational::ratio(1, 2),
        workspace: Polytope::from_box(&corner(-size), &corner(size)),
        regions: Table::new(),
        blockers: Table::new(),
        bases: Table::new(),
        robots: models.iter().enumerate().map(|(i, m)| start(i, m)).collect(),
        models: models.into_iter().collect(),
        separation: None,
        connectivity: None,
        horizon: (1, 8),
        objective: None,
        formulas: Formulas::new(),
        goals: Vec::new(),
    }
}

fn tube_for(model: Model) -> Result<Tube, Diagnostics> {
    let mut diagnostics = Diagnostics::new();
    let tubes = synthesize(&problem(vec![model], 1000.0), &Spans::default(), &mut diagnostics);
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
    let a = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 1.0]);
    let b = DMatrix::from_row_slice(2, 1, &[1.0, 0.0]);
    assert_eq!(code_for(model(a.clone(), b.clone(), &[(-0.1, 0.1); 2], 1.0)), "dosm::tube::uncontrollable");
    // What forgets by itself need not be steered.
    let nilpotent = DMatrix::from_row_slice(2, 2, &[1.0, 1.0, 0.0, 0.0]);
    assert!(tube_for(model(nilpotent, b, &[(-0.1, 0.1); 2], 1.0)).is_ok());
}
