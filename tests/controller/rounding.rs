//! The law in floating-point numbers against the law in real ones: each step from the same remembered
//! disturbances within the proved bound, and whole runs that never leave what was proved.

use dosmc::exact::Rational;
use dosmc::law::tracking::Fallback;
use dosmc::law::{Feedback, Float, Magnitudes, PathTables, Rounding, TubeTables};

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

/// Numbers of very different sizes, zeros among them.
fn wild(luck: &mut Luck) -> f64 {
    let scale = *luck.pick(&[0.0, 1e-320, 1e-9, 1e-3, 1.0, 1.0, 30.0]);
    luck.push() * scale
}

/// A matrix of such numbers.
fn matrix(rows: usize, columns: usize, luck: &mut Luck) -> Vec<Vec<f64>> {
    (0..rows).map(|_| (0..columns).map(|_| wild(luck)).collect()).collect()
}

/// The steps of a law with tables that no plan has, for a model as large as a pilot's.
fn random_tables(pilot: &Pilot<'_>, float: Float, luck: &mut Luck) {
    let (n, m) = (pilot.model.n(), pilot.model.m());
    // A power of two: every type has it.
    let far = |sign: i64| Rational::from(sign << 40);
    let mut model = pilot.model.clone();
    model.input_bounds.iter_mut().for_each(|b| (b.lo, b.hi) = (far(-1), far(1)));
    model.mixed_bounds.clear();
    let k = 1 + luck.below(6);
    let one = |i: usize, j: usize| f64::from(u8::from(i == j));
    let mut d = vec![(0..n).map(|i| (0..n).map(|j| one(i, j)).collect()).collect()];
    d.extend((1..k).map(|_| matrix(n, n, luck)));
    let gains: Vec<_> = (0..k).map(|_| matrix(m, n, luck)).collect();
    let mut path = pilot.path.clone();
    path.z.iter_mut().flatten().for_each(|z| *z = wild(luck));
    path.v.iter_mut().flatten().for_each(|v| *v = wild(luck));
    let center: Vec<f64> = (0..n).map(|_| wild(luck)).collect();
    let half_width: Vec<f64> = (0..n).map(|_| 10.0 + luck.share()).collect();
    let feedback = Feedback { center: &center, half_width: &half_width, d: &d, m: &gains };
    let problem = &PLANNED[0].problem;
    let tables = TubeTables::new(float, &model, &problem.workspace, &feedback).expect("numbers");
    let most = |columns: &[Vec<f64>], size: usize| -> Vec<Rational> {
        let largest = |i: usize| columns.iter().map(|c| c[i].abs()).fold(0.0, f64::max);
        (0..size).map(|i| Rational::from_f64(largest(i)).expect("finite")).collect()
    };
    let magnitudes = Magnitudes { state: most(&path.z, n), input: most(&path.v, m) };
    let rounding = Rounding::new(float, &model, &feedback, &tables, &magnitudes).expect("a bound");
    let reserve: Vec<f64> = rounding.needed.iter().map(Rational::to_f64_up).collect();
    let odd = Pilot {
        name: format!("random tables ({float})"),
        robot: pilot.robot,
        model: &model,
        path: &path,
        loop_start: pilot.loop_start,
        d: &d,
        m: &gains,
        center: &center,
        half_width: &half_width,
        reserve: &reserve,
        paths: PathTables::new(float, &path.z, &path.v, pilot.loop_start).expect("numbers"),
        tables,
        rounding,
    };
    in_type!(float, steps(&odd, 12, luck));
}

#[test]
fn random_tables_keep_their_bounds_too() {
    let all: Vec<Pilot<'_>> = PLANNED.iter().flat_map(pilots).collect();
    let count = if cfg!(debug_assertions) { 100 } else { 2_000 };
    for seed in 0..count {
        let mut luck = Luck::new(7_000 + seed);
        let float = *luck.pick(&Float::ALL);
        random_tables(&all[luck.below(all.len())], float, &mut luck);
    }
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
