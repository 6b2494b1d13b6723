//! The law and its monitor, on a model small enough to follow by hand.

use std::fmt::Debug;

use proptest::collection::vec;
use proptest::prelude::*;

use super::tracking::{
    Assumption, Bounds, Containment, Fallback, Moment, Path, Reading, Real, Status, Tracker, Tube,
};
use super::{Feedback, Flight, Float, Magnitudes, Misfit, Promise, Rounding, SOURCE, TubeTables, fit};
use crate::exact::{Rational, RationalMatrix, dot};
use crate::geometry::HalfSpace;
use crate::ir::Model;
use crate::ir::sample::{empty, exact, integrators, model, point};

/// x⁺ = x + u + w with |w| ≤ 1, u = v − ŵ: K = 1, nothing to predict.
const INTEGRATOR: Tube<'static, [f64; 1], [f64; 1]> = Tube {
    errors: &[],
    gains: &[[-1.0]],
    disturbance: Bounds { lo: [-1.0], hi: [1.0] },
    assumed: [0.0],
    hull: Bounds { lo: [-1.0], hi: [1.0] },
    state: Bounds { lo: [-10.0], hi: [10.0] },
    state_near: [0.5],
    input: Bounds { lo: [-3.0], hi: [3.0] },
    input_near: [0.25],
};

/// It goes to 2 in two steps and stays there.
const PATH: Path<'static, [f64; 1], [f64; 1]> = Path {
    first: Moment { z: [0.0], v: [1.0] },
    rest: &[Moment { z: [1.0], v: [1.0] }, Moment { z: [2.0], v: [0.0] }],
    loop_start: 2,
};

type Small = Tracker<'static, [f64; 1], [f64; 1], [[f64; 1]; 1]>;

fn tracker(fallback: Fallback<[f64; 1]>) -> Small {
    Tracker::new(&INTEGRATOR, &PATH, fallback, [[7.0]])
}

fn quiet(containment: Containment<f64>) -> Status<f64> {
    Status { assumption: Assumption::Within, containment, state_near: None, input_near: None }
}

#[test]
fn what_was_disturbed_is_answered_and_forgotten() {
    let mut tracker = tracker(Fallback::Predict);
    assert_eq!(tracker.step(&[0.0]), ([1.0], quiet(Containment::Inside)));
    assert_eq!(tracker.step(&[1.5]), ([0.5], quiet(Containment::Inside)));
    assert_eq!(tracker.history(), [[0.5]]);
    assert_eq!(tracker.step(&[1.0]), ([1.0], quiet(Containment::Inside)));
    assert_eq!(tracker.moment(), 2, "the last moment comes again");
    assert_eq!(tracker.step(&[2.0]), ([0.0], quiet(Containment::Inside)));
    tracker.reset();
    assert_eq!((tracker.moment(), tracker.history()), (0, [[0.0]].as_slice()));
}

#[test]
fn an_excess_is_told_with_its_size_and_then_its_end() {
    let mut tracker = tracker(Fallback::Predict);
    tracker.step(&[0.0]);
    let (input, status) = tracker.step(&[3.0]);
    let by = Reading { component: 0, amount: 1.0 };
    assert_eq!(input, [-1.0], "it goes on tracking");
    assert_eq!(status.assumption, Assumption::Exceeded(by));
    assert_eq!(status.containment, Containment::Outside(by));
    assert!(!status.holds());
    let (_, status) = tracker.step(&[2.0]);
    assert_eq!(status, quiet(Containment::Returned));
    assert!(status.holds());
    assert_eq!(tracker.step(&[2.0]).1, quiet(Containment::Inside));
}

#[test]
fn what_may_be_outside_is_not_said_to_be_inside_before_all_is_forgotten() {
    // Two disturbances are remembered: one that was too large counts for two measurements.
    let tube = Tube { errors: &[[0.0]], gains: &[[-1.0], [0.0]], ..INTEGRATOR };
    let mut tracker = Tracker::new(&tube, &PATH, Fallback::Predict, [[0.0]; 2]);
    tracker.step(&[0.0]);
    assert!(matches!(tracker.step(&[2.5]).1.containment, Containment::Outside(_)));
    assert_eq!(tracker.step(&[2.0]).1.containment, Containment::Unproved);
    assert_eq!(tracker.step(&[2.0]).1.containment, Containment::Returned);
}

#[test]
fn a_measurement_that_is_none_leads_to_the_fallback() {
    for (fallback, expected) in [
        (Fallback::Predict, [1.0]),
        (Fallback::Hold, [0.5]),
        (Fallback::Fixed([-2.0]), [-2.0]),
        (Fallback::Fixed([-9.0]), [-3.0]),
        (Fallback::Fixed([f64::NAN]), [1.0]),
    ] {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut tracker = tracker(fallback);
            tracker.step(&[0.5]);
            let (input, status) = tracker.step(&[bad]);
            assert_eq!(input, expected, "{fallback:?}");
            assert_eq!(status.assumption, Assumption::NotANumber { component: 0 });
            assert_eq!(status.containment, Containment::Unproved);
            assert_eq!(tracker.step(&[2.0]).1.containment, Containment::Returned);
        }
    }
    let mut tracker = tracker(Fallback::Predict);
    assert_eq!(tracker.missed().1.assumption, Assumption::Missing);
    assert_eq!(tracker.moment(), 1, "time goes on");
}

#[test]
fn numbers_too_large_to_compute_with_spoil_nothing() {
    let tube = Tube { errors: &[[-1e300]], gains: &[[-1e300], [1e300]], ..INTEGRATOR };
    let mut tracker = Tracker::new(&tube, &PATH, Fallback::Predict, [[0.0]; 2]);
    for x in [1e308, -1e308, f64::MAX, 1e300, f64::MIN] {
        let ([input], _) = tracker.step(&[x]);
        assert!((-3.0..=3.0).contains(&input), "{x}: {input}");
        assert!(tracker.history().iter().flatten().all(|w| w.is_finite()), "{:?}", tracker.history());
    }
    for _ in 0..3 {
        tracker.step(&[2.0]);
    }
    assert_eq!(tracker.step(&[2.0]).1.containment, Containment::Inside);
}

#[test]
fn bounds_that_are_near_are_told_with_the_room_left() {
    let mut tracker = tracker(Fallback::Predict);
    let (input, status) = tracker.step(&[-9.75]);
    assert_eq!(status.state_near, Some(Reading { component: 0, amount: 0.25 }));
    assert_eq!((input, status.input_near), ([3.0], Some(Reading { component: 0, amount: 0.0 })));
    assert_eq!(tracker.step(&[10.5]).1.state_near, Some(Reading { component: 0, amount: -0.5 }));
}

#[test]
fn of_several_the_worst_in_proportion_is_told() {
    let tube: Tube<'_, [f64; 2], [f64; 1]> = Tube {
        errors: &[],
        gains: &[[0.0], [0.0]],
        disturbance: Bounds { lo: [-1.0, -0.01], hi: [1.0, 0.01] },
        assumed: [0.0; 2],
        hull: Bounds { lo: [-1.0, -0.01], hi: [1.0, 0.01] },
        state: Bounds { lo: [f64::NEG_INFINITY, -1.0], hi: [f64::INFINITY, 1.0] },
        state_near: [0.0, 0.1],
        input: Bounds { lo: [-1.0], hi: [1.0] },
        input_near: [0.1],
    };
    let path = Path { first: Moment { z: [0.0; 2], v: [0.0] }, rest: &[], loop_start: 0 };
    let mut tracker = Tracker::new(&tube, &path, Fallback::Predict, [[0.0; 2]; 1]);
    let Assumption::Exceeded(reading) = tracker.step(&[2.0, 0.06]).1.assumption else { panic!("an excess") };
    assert_eq!((reading.component, (reading.amount * 1e9).round()), (1, 5e7));
    let Assumption::Exceeded(reading) = tracker.step(&[2.0, -0.012]).1.assumption else {
        panic!("an excess")
    };
    assert_eq!(reading, Reading { component: 0, amount: 1.0 });
}

#[test]
fn the_source_stands_alone() {
    for word in ["crate::", "super::", "std::", "unsafe", "unwrap()", "expect(", "panic", "[i]", "alloc"] {
        let code: String = SOURCE.lines().filter(|l| !l.trim_start().starts_with("//")).collect();
        assert!(!code.contains(word), "the law names `{word}`");
    }
}

/// A half-width a state, D and M: dead-beat gains for two integrators in a row on two axes at 0.5 s.
type Feeding = ([f64; 4], Vec<Vec<Vec<f64>>>, Vec<Vec<Vec<f64>>>);

fn dead_beat() -> Feeding {
    let block = |[a, b]: [[f64; 2]; 2]| {
        let rows =
            [[a[0], a[1], 0.0, 0.0], [b[0], b[1], 0.0, 0.0], [0.0, 0.0, a[0], a[1]], [0.0, 0.0, b[0], b[1]]];
        rows.map(Vec::from).to_vec()
    };
    let gains = |row: [f64; 2]| vec![vec![row[0], row[1], 0.0, 0.0], vec![0.0, 0.0, row[0], row[1]]];
    let d = vec![block([[1.0, 0.0], [0.0, 1.0]]), block([[0.5, 0.125], [-2.0, -0.5]])];
    ([0.25, 0.5, 0.25, 0.5], d, vec![gains([-4.0, -3.0]), gains([4.0, 1.0])])
}

/// What rounding takes of that law for nominal states up to a size.
fn rounding(float: Float, size: i64) -> Rounding {
    let model = integrators(2, 4.0, &[4.0]);
    let (half_width, d, m) = dead_beat();
    let feedback = Feedback { center: &[0.0; 4], half_width: &half_width, d: &d, m: &m };
    let problem = empty(vec![model.clone()], 100.0);
    let tables = TubeTables::new(float, &model, &problem.workspace, &feedback).expect("finite");
    let magnitudes = Magnitudes { state: vec![Rational::from(size); 4], input: vec![Rational::ONE; 2] };
    Rounding::new(float, &model, &feedback, &tables, &magnitudes).expect("finite")
}

/// What comes of a plan that stands at one place, with that law.
fn fitted(float: Float, model: &Model, reserve: f64, start: f64, z: f64) -> Result<(), Misfit> {
    let (half_width, d, m) = dead_beat();
    let feedback = Feedback { center: &[0.0; 4], half_width: &half_width, d: &d, m: &m };
    let workspace = empty(vec![model.clone()], 100.0).workspace;
    let promise = Promise { model, workspace: &workspace, feedback, reserve: &[reserve; 4] };
    let (z, v) = (vec![vec![z, 0.0, 0.0, 0.0]], vec![vec![0.0; 2]]);
    let start = point(&[start, 0.0, 0.0, 0.0]);
    fit(float, &promise, &[Flight { start: &start, z: &z, v: &v }]).map(drop)
}

#[test]
fn a_plan_fits_where_rounding_has_room_everywhere() {
    let mut model = integrators(2, 4.0, &[4.0]);
    assert_eq!(fitted(Float::F64, &model, 1e-12, 1.0, 1.0), Ok(()));
    let refused = fitted(Float::F32, &model, 1e-12, 1.0, 1.0);
    assert!(matches!(&refused, Err(Misfit::Reserve { state, .. }) if state == "x0"), "{refused:?}");
    // One disturbance off, at the very edge of its box, and a little less.
    let edge = fitted(Float::F64, &model, 1e-12, 1.25, 1.0);
    assert!(matches!(&edge, Err(Misfit::Start { state, .. }) if state == "x0"), "{edge:?}");
    assert_eq!(fitted(Float::F64, &model, 1e-12, 1.25 - 1e-12, 1.0), Ok(()));
    let large = fitted(Float::F32, &model, 1e-12, 1e300, 1e300);
    assert!(matches!(large, Err(Misfit::Reserve { .. })), "{large:?}");
    // The feedback of the first axis takes up to 2 (4 · 0.25) + (3 + 1) 0.5 = 4.
    let bound =
        |offset: f64| HalfSpace { normal: point(&[0.0, 0.0, 0.0, 0.0, 1.0, 0.0]), offset: exact(offset) };
    model.mixed_bounds = vec![bound(4.0)];
    let tight = fitted(Float::F64, &model, 1e-12, 1.0, 1.0);
    assert!(matches!(tight, Err(Misfit::Bound { .. })), "{tight:?}");
    model.mixed_bounds = vec![bound(4.0 + 1e-12)];
    assert_eq!(fitted(Float::F64, &model, 1e-12, 1.0, 1.0), Ok(()));
}

#[test]
fn rounding_grows_with_the_numbers_and_the_type() {
    let unit = f64::EPSILON / 2.0;
    let of = |float, size| rounding(float, size).needed[0].to_f64();
    // A hundred metres are measured to half a last place, and the error is carried on once more.
    let expected = 100.0 * unit;
    let double = of(Float::F64, 100);
    assert!((2.0 * expected..6.0 * expected).contains(&double), "{double:e}");
    assert!(of(Float::F64, 1000) > 5.0 * double);
    let single = of(Float::F32, 100);
    let types = f64::from(f32::EPSILON) / f64::EPSILON;
    // The table of z is rounded too.
    assert!((1.5 * types..2.5 * types).contains(&(single / double)), "{single:e}");
}

#[test]
fn what_is_needed_is_what_both_errors_make_of_the_next_disturbance() {
    let rounding = rounding(Float::F64, 10);
    let (rho, sigma) = (&rounding.disturbance, &rounding.input);
    let half = Rational::ratio(1, 2);
    // x⁺ = x + v/2 + u/8; the bounds of doubles are exact here.
    let expected = &rho[0] + &rho[0] + &rho[1] * &half + &sigma[0] * &Rational::ratio(1, 8);
    assert_eq!(rounding.needed[0], expected);
    assert_eq!(rounding.needed[1], &rho[1] + &rho[1] + &sigma[0] * &half);
}

/// A law of random tables, and what it is fed.
#[derive(Clone, Debug)]
struct Case {
    d: Vec<Vec<Vec<f64>>>,
    m: Vec<Vec<Vec<f64>>>,
    half_width: Vec<f64>,
    z: Vec<f64>,
    v: Vec<f64>,
    /// One a step: where in its box each disturbance is, from −1 to 1.
    disturbances: Vec<Vec<f64>>,
}

fn cases() -> impl Strategy<Value = Case> {
    let number = || (-4.0..4.0f64, 0..3i32).prop_map(|(x, e)| x * 10f64.powi(-3 * e));
    (1usize..4, 1usize..3, 1usize..5).prop_flat_map(move |(n, m, k)| {
        let column = move |size| vec(number(), size);
        let matrices = move |rows: usize| vec(vec(column(n), rows), k);
        let signs = vec(vec(prop_oneof![Just(-1.0), Just(1.0), -1.0..1.0], n), 1..12);
        let widths = vec((0.001..1.0f64).prop_map(|x| x), n);
        (matrices(n), matrices(m), widths, vec(-100.0..100.0f64, n), vec(-10.0..10.0f64, m), signs)
            .prop_map(|(d, m, half_width, z, v, disturbances)| Case { d, m, half_width, z, v, disturbances })
    })
}

/// Σ of matrices times columns, exactly.
fn product(matrices: &[Vec<Vec<f64>>], columns: &[Vec<Rational>], i: usize) -> Rational {
    let row = |(matrix, column): (&Vec<Vec<f64>>, &Vec<Rational>)| dot(&point(&matrix[i]), column);
    matrices.iter().zip(columns).map(row).sum()
}

/// Feeds a case to the law in a float type, and compares each step with the same in exact arithmetic.
fn compare<R: Real + Debug>(case: &Case, float: Float, of: impl Fn(f64) -> R, to: impl Fn(R) -> f64) {
    let (n, m) = (case.z.len(), case.v.len());
    let model = Model {
        position: (0..n).collect(),
        ..model(
            RationalMatrix::from_fn(n, n, |_, _| Rational::ONE),
            RationalMatrix::from_fn(n, m, |_, _| Rational::ONE),
            &vec![(-1.0, 1.0); n],
            1e6,
        )
    };
    let feedback = Feedback { center: &vec![0.0; n], half_width: &case.half_width, d: &case.d, m: &case.m };
    let workspace = empty(vec![model.clone()], 1000.0).workspace;
    let tables = TubeTables::new(float, &model, &workspace, &feedback).expect("finite");
    let nominal = |values: &[f64]| values.iter().map(|x| exact(*x).abs()).collect::<Vec<_>>();
    let magnitudes = Magnitudes { state: nominal(&case.z), input: nominal(&case.v) };
    let rounding = Rounding::new(float, &model, &feedback, &tables, &magnitudes).expect("finite");

    let column = |values: &Vec<f64>| values.iter().map(|x| of(*x)).collect::<Vec<R>>();
    let bounds = |b: &Bounds<Vec<f64>>| Bounds { lo: column(&b.lo), hi: column(&b.hi) };
    let errors: Vec<_> = tables.errors.iter().map(column).collect();
    let gains: Vec<_> = tables.gains.iter().map(column).collect();
    let tube = Tube {
        errors: &errors,
        gains: &gains,
        disturbance: bounds(&tables.disturbance),
        assumed: column(&tables.assumed),
        hull: bounds(&tables.hull),
        state: bounds(&tables.state),
        state_near: column(&tables.state_near),
        input: bounds(&tables.input),
        input_near: column(&tables.input_near),
    };
    let path = Path { first: Moment { z: column(&case.z), v: column(&case.v) }, rest: &[], loop_start: 0 };
    let mut tracker = Tracker::new(&tube, &path, Fallback::Predict, vec![column(&case.z); case.d.len()]);
    for signs in &case.disturbances {
        let before: Vec<Vec<Rational>> =
            tracker.history().iter().map(|w| w.iter().map(|x| exact(to(*x))).collect()).collect();
        // The true state: z, what is remembered, and a disturbance that leaves room for rounding.
        let disturbance: Vec<Rational> =
            (0..n).map(|i| exact(signs[i]) * (exact(case.half_width[i]) - &rounding.needed[i])).collect();
        let predicted: Vec<Rational> = (0..n).map(|i| product(&case.d[1..], &before, i)).collect();
        let state: Vec<Rational> =
            (0..n).map(|i| exact(case.z[i]) + &predicted[i] + &disturbance[i]).collect();
        let measured: Vec<R> = state.iter().map(|x| of(x.to_f64())).collect();
        let (input, status) = tracker.step(&measured);
        assert_eq!(status.assumption, Assumption::Within);
        let after: Vec<Vec<Rational>> =
            tracker.history().iter().map(|w| w.iter().map(|x| exact(to(*x))).collect()).collect();
        for i in 0..n {
            let off = (&after[0][i] - &disturbance[i]).abs();
            assert!(off <= rounding.disturbance[i], "{float}: {off:?} > {:?}", rounding.disturbance[i]);
        }
        for (k, given) in input.iter().enumerate() {
            let off = (exact(to(*given)) - exact(case.v[k]) - product(&case.m, &after, k)).abs();
            assert!(off <= rounding.input[k], "{float}: {off:?} > {:?}", rounding.input[k]);
        }
    }
}

proptest! {
    #[test]
    fn no_step_is_off_by_more_than_is_proved(case in cases()) {
        compare(&case, Float::F64, |x| x, |x| x);
        #[allow(clippy::cast_possible_truncation)]
        compare(&case, Float::F32, |x| x as f32, f64::from);
    }
}
