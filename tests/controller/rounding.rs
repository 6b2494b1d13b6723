//! The law in floating-point numbers against the law in real ones: each step from the same remembered
//! disturbances within the proved bound, and whole runs that never leave what was proved.

use dosmc::exact::Rational;
use dosmc::law::Float;
use dosmc::law::tracking::Fallback;

use super::exact_sum::ExactSum;
use super::luck::Luck;
use super::robot::{Flown, Number, Pilot, doubles, pilots};
use super::{PLANNED, in_type};

/// How many steps are compared altogether; in a debug build fewer.
const STEPS: usize = if cfg!(debug_assertions) { 40_000 } else { 1_000_000 };
/// The length of a whole run.
const RUN: usize = 500;

/// How much of the bounds on ŵ and on u the errors of a run of steps take, at most.
fn steps<R: Number>(pilot: &Pilot<'_>, count: usize, luck: &mut Luck) -> [f64; 2] {
    let rho: Vec<f64> = pilot.rounding.disturbance.iter().map(Rational::to_f64_down).collect();
    let sigma: Vec<f64> = pilot.rounding.input.iter().map(Rational::to_f64_down).collect();
    let flown = Flown::<R>::new(pilot);
    flown.fly(pilot, Fallback::Predict, |law| {
        let mut used = [0.0f64; 2];
        for _ in 0..count {
            let moment = law.moment();
            let (z, v) = (&pilot.path.z[moment], &pilot.path.v[moment]);
            let before: Vec<Vec<f64>> = law.history().iter().map(|w| doubles(w)).collect();
            // Somewhere in what is left of Θ' beside the reserve, often at a corner of it.
            let x: Vec<f64> = (0..z.len())
                .map(|i| {
                    let w = pilot.center[i] + (pilot.half_width[i] - pilot.reserve[i]) * luck.push();
                    let carried: f64 = terms(&pilot.d[1..], &before, i).map(|(a, b)| a * b).sum();
                    z[i] + carried + w
                })
                .collect();
            let measured: Vec<R> = x.iter().map(|x| R::of(*x)).collect();
            let (u, status) = law.step(&measured);
            assert!(status.holds(), "{}: {status:?}", pilot.name);
            for i in 0..x.len() {
                let mut off = ExactSum::zero();
                off.add(x[i]);
                off.add(-z[i]);
                terms(&pilot.d[1..], &before, i).for_each(|(a, b)| off.add_product(-a, b));
                let remembered = law.history()[0][i].double();
                used[0] = used[0].max(share(off, remembered, rho[i], &|| format!("{}: ŵ_{i}", pilot.name)));
            }
            let after: Vec<Vec<f64>> = law.history().iter().map(|w| doubles(w)).collect();
            for (k, u) in u.iter().enumerate() {
                let mut off = ExactSum::zero();
                off.add(v[k]);
                terms(pilot.m, &after, k).for_each(|(a, b)| off.add_product(a, b));
                used[1] = used[1].max(share(off, u.double(), sigma[k], &|| format!("{}: u_{k}", pilot.name)));
            }
        }
        used
    })
}

/// The terms of a row of Σ matrix ŵ.
fn terms<'a>(
    matrices: &'a [Vec<Vec<f64>>],
    history: &'a [Vec<f64>],
    row: usize,
) -> impl Iterator<Item = (f64, f64)> + 'a {
    matrices
        .iter()
        .zip(history)
        .flat_map(move |(matrix, w)| matrix[row].iter().copied().zip(w.iter().copied()))
}

/// Fails where a number is farther from the exact one than a bound; says roughly which share of the
/// bound it takes.
fn share(mut exact: ExactSum, computed: f64, bound: f64, what: &dyn Fn() -> String) -> f64 {
    exact.add(-computed);
    assert!(exact.is_within(bound), "{} is off by more than {bound:e}", what());
    let shares = [0.5, 0.1, 0.01, 0.001];
    shares.into_iter().find(|share| !exact.is_within(share * bound)).unwrap_or(0.0)
}

#[test]
fn each_step_is_within_the_proved_bound_of_the_exact_one() {
    let all: Vec<(Float, Pilot<'_>)> =
        PLANNED.iter().flat_map(|p| pilots(p).into_iter().map(|pilot| (p.float, pilot))).collect();
    let count = STEPS.div_ceil(all.len());
    let mut used = [0.0f64; 2];
    for (seed, (float, pilot)) in all.iter().enumerate() {
        let mut luck = Luck::new(seed as u64);
        let most = in_type!(*float, steps(pilot, count, &mut luck));
        used = [0, 1].map(|i| used[i].max(most[i]));
    }
    // A bound that nothing comes near to would be no test of the law.
    assert!(used.iter().all(|share| *share >= 0.01), "{used:?}");
}

/// A closed loop in exact numbers, but for the law.
fn whole_run<R: Number>(pilot: &Pilot<'_>, luck: &mut Luck) {
    let exact = |x: f64| Rational::from_f64(x).expect("finite");
    let model = pilot.model;
    let flown = Flown::<R>::new(pilot);
    flown.fly(pilot, Fallback::Predict, |law| {
        let mut x = pilot.robot.start.clone();
        // A vertex is held for a while: that drives errors to the tube's corners.
        let mut vertex: Vec<bool> = Vec::new();
        for t in 0..RUN {
            let z = &pilot.path.z[law.moment()];
            let before: Vec<Vec<f64>> = law.history().iter().map(|w| doubles(w)).collect();
            for i in 0..model.n() {
                let carried: Rational =
                    terms(&pilot.d[1..], &before, i).map(|(a, b)| exact(a) * exact(b)).sum();
                let w = &x[i] - exact(z[i]) - carried;
                let off = (w - exact(pilot.center[i])).abs();
                assert!(off <= exact(pilot.half_width[i]), "{} at {t}: outside the tube", pilot.name);
                let within = model.state_bounds[i].as_ref().is_none_or(|b| b.lo <= x[i] && x[i] <= b.hi);
                assert!(within, "{} at {t}: state {i} out of bounds", pilot.name);
            }
            let measured: Vec<R> = x.iter().map(|x| R::of(x.to_f64())).collect();
            let (u, status) = law.step(&measured);
            assert!(status.holds(), "{} at {t}: {status:?}", pilot.name);
            let u: Vec<Rational> = u.iter().map(|u| exact(u.double())).collect();
            let inputs = u.iter().zip(&model.input_bounds);
            inputs.for_each(|(u, b)| assert!(b.lo <= *u && *u <= b.hi, "{} at {t}", pilot.name));
            if vertex.is_empty() || luck.below(6) == 0 {
                vertex = (0..model.n()).map(|_| luck.below(2) == 0).collect();
            }
            x = (0..model.n())
                .map(|i| {
                    let a: Rational = x.iter().enumerate().map(|(j, x)| &model.a[(i, j)] * x).sum();
                    let b: Rational = u.iter().enumerate().map(|(j, u)| &model.b[(i, j)] * u).sum();
                    let d = &model.disturbance[i];
                    a + b + &model.c[i] + if vertex[i] { &d.lo } else { &d.hi }
                })
                .collect();
        }
    });
}

#[test]
fn whole_exact_runs_stay_in_their_tubes() {
    for (seed, planned) in PLANNED.iter().enumerate() {
        let pilots = pilots(planned);
        // One robot of each model.
        let mut models = Vec::new();
        for pilot in &pilots {
            if !models.contains(&&pilot.model.name) {
                models.push(&pilot.model.name);
                let mut luck = Luck::new(100 + seed as u64);
                in_type!(planned.float, whole_run(pilot, &mut luck));
            }
        }
    }
}
