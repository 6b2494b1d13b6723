//! Measurements that are none: not a number, infinite, missing or stuck, at every step of a plan. Inputs
//! stay numbers within their bounds, the monitor says what happened, and says when all is well again.

use dosmc::law::Float;
use dosmc::law::tracking::{Assumption, Containment, Fallback, Status};

use super::luck::Luck;
use super::robot::{Column, Flown, Law, Number, Pilot, doubles, pilots};
use super::{PLANNED, in_type};

/// What goes wrong with a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    /// One state is this instead.
    Reads(f64),
    /// There is none.
    Missing,
    /// It is the one before.
    Stuck,
}

const FAULTS: [Fault; 6] = [
    Fault::Reads(f64::NAN),
    Fault::Reads(f64::INFINITY),
    Fault::Reads(f64::NEG_INFINITY),
    Fault::Reads(f64::MAX),
    Fault::Missing,
    Fault::Stuck,
];

/// A robot in closed loop.
struct Closed<'a, 'b, R: Number> {
    pilot: &'a Pilot<'a>,
    law: &'a mut Law<'b, R>,
    x: Vec<f64>,
    measured: Column<R>,
    /// The moment of the last step.
    before: usize,
}

impl<R: Number> Closed<'_, '_, R> {
    /// Fails where the robot is not in the least box around its tube, though the monitor says so.
    fn assert_inside(&self) {
        let (hull, z) = (&self.pilot.tables.hull, &self.pilot.path.z[self.before]);
        for (i, (x, z)) in self.x.iter().zip(z).enumerate() {
            let slack = 1e-6 * (hull.hi[i] - hull.lo[i]);
            let inside = hull.lo[i] - slack <= x - z && x - z <= hull.hi[i] + slack;
            assert!(inside, "{}: said to be inside with an error of {}", self.pilot.name, x - z);
        }
    }

    /// One step with a fault, or none; the input is always a number within its bounds.
    fn step(&mut self, fault: Option<Fault>, component: usize, luck: &mut Luck) -> Status<R> {
        let now: Column<R> = self.x.iter().map(|x| R::of(*x)).collect();
        self.before = self.law.moment();
        let (u, status) = match fault {
            None => self.law.step(&now),
            Some(Fault::Missing) => self.law.missed(),
            Some(Fault::Stuck) => self.law.step(&self.measured),
            Some(Fault::Reads(value)) => {
                let mut wrong = now.clone();
                wrong[component] = R::of(value);
                self.law.step(&wrong)
            }
        };
        let bounds = &self.pilot.tables.input;
        let u = doubles(&u);
        for (k, u) in u.iter().enumerate() {
            let fine = u.is_finite() && bounds.lo[k] <= *u && *u <= bounds.hi[k];
            assert!(fine, "{}: {fault:?} gives the input {u}", self.pilot.name);
        }
        if fault.is_none() && status.holds() {
            self.assert_inside();
        }
        let w = self.pilot.disturbance(|| luck.push());
        self.x = self.pilot.plant(&self.x, &u, &w);
        self.measured = now;
        status
    }
}

/// One flight with a fault of `length` steps that begins at a step; says how it was noticed.
fn flight<R: Number>(pilot: &Pilot<'_>, fault: Fault, at: usize, length: usize, luck: &mut Luck) -> bool {
    let v: Column<R> = pilot.path.v[0].iter().map(|v| R::of(*v)).collect();
    let fallback = luck.pick(&[Fallback::Predict, Fallback::Hold, Fallback::Fixed(v)]).clone();
    let flown = Flown::<R>::new(pilot);
    flown.fly(pilot, fallback.clone(), |law| {
        let start = pilot.start();
        let measured = start.iter().map(|x| R::of(*x)).collect();
        let mut closed = Closed { pilot, law, x: start, measured, before: 0 };
        let component = luck.below(pilot.model.n());
        let what = format!("{}: {fault:?} of state {component} at {at}, {fallback:?}", pilot.name);
        for _ in 0..at {
            let status = closed.step(None, component, luck);
            assert!(status.holds(), "before {what}: {status:?}");
        }
        let mut noticed = false;
        for _ in 0..length {
            let status = closed.step(Some(fault), component, luck);
            noticed |= !status.holds();
            match fault {
                Fault::Reads(value) if !R::of(value).is_finite() => {
                    assert_eq!(status.assumption, Assumption::NotANumber { component }, "{what}");
                }
                Fault::Reads(_) => {
                    assert!(!matches!(status.assumption, Assumption::Within), "{what}: {status:?}")
                }
                Fault::Missing => assert_eq!(status.assumption, Assumption::Missing, "{what}"),
                Fault::Stuck => {}
            }
            let sure = !matches!(fault, Fault::Stuck);
            assert!(!sure || !status.holds(), "{what}: {status:?}");
        }
        // What was wrong is forgotten after K steps within the assumption; a robot that the fault drove
        // away comes back first. Where the input was the law's own, bounds of inputs never keep it away.
        let mut returned = !noticed;
        let mut inside = 0;
        for _ in 0..4 * pilot.d.len() + 8 {
            let status = closed.step(None, component, luck);
            returned |= status.containment == Containment::Returned;
            inside = if status.holds() { inside + 1 } else { 0 };
            noticed |= !status.holds();
        }
        let gentle = fallback == Fallback::Predict && matches!(fault, Fault::Reads(_) | Fault::Missing);
        if gentle && fault != Fault::Reads(f64::MAX) {
            assert!(returned && inside >= 2, "{what}: not reported to be back");
        }
        noticed
    })
}

/// All faults at all steps of the plan, of one and of three steps.
fn all_faults<R: Number>(pilot: &Pilot<'_>, luck: &mut Luck) -> [usize; 2] {
    let mut stuck = [0, 0];
    for at in 0..=pilot.path.z.len() {
        for fault in FAULTS {
            for length in [1, 3] {
                let noticed = flight::<R>(pilot, fault, at, length, luck);
                if fault == Fault::Stuck && length == 3 {
                    stuck[usize::from(noticed)] += 1;
                }
            }
        }
    }
    stuck
}

#[test]
fn threat_15_wrong_measurements_are_survived_told_and_forgotten() {
    let mut stuck = [0, 0];
    for (seed, planned) in PLANNED.iter().enumerate() {
        // Debug builds take one robot a mission.
        let most = if cfg!(debug_assertions) { 1 } else { usize::MAX };
        for pilot in pilots(planned).iter().take(most) {
            let mut luck = Luck::new(seed as u64);
            let found = in_type!(planned.float, all_faults(pilot, &mut luck));
            stuck = [0, 1].map(|i| stuck[i] + found[i]);
        }
    }
    // A robot that moves can't hide a stuck sensor; one that stands still can.
    assert!(stuck[1] > stuck[0], "{stuck:?}");
}
