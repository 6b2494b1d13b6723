//! A robot of a plan with the law that flies it, its columns of any length.

use dosmc::ir::{Model, Robot};
use dosmc::law::tracking::{Bounds, Fallback, Moment, Path, Real, Status, Tracker, Tube};
use dosmc::law::{self, Feedback, Flight, PathTables, Promise, Rounding, TubeTables};
use dosmc::plan::RobotPlan;

use super::Planned;

/// A floating-point type of the law.
pub trait Number: Real + std::fmt::Debug {
    /// Rounds a double.
    fn of(value: f64) -> Self;
    /// The same number as a double.
    fn double(self) -> f64;
}

impl Number for f64 {
    fn of(value: f64) -> f64 {
        value
    }
    fn double(self) -> f64 {
        self
    }
}

impl Number for f32 {
    fn of(value: f64) -> f32 {
        value as f32
    }
    fn double(self) -> f64 {
        f64::from(self)
    }
}

/// A column of the law.
pub type Column<R> = Vec<R>;

/// The law of a robot.
pub type Law<'a, R> = Tracker<'a, Column<R>, Column<R>, Vec<Column<R>>>;

/// A robot of a plan.
pub struct Pilot<'a> {
    /// The mission's and the robot's name.
    pub name: String,
    /// Its mission's entry.
    pub robot: &'a Robot,
    /// Its motion model.
    pub model: &'a Model,
    /// What it flies.
    pub path: &'a RobotPlan,
    /// The step after the last one.
    pub loop_start: usize,
    /// D_0 … D_{K−1}.
    pub d: &'a [Vec<Vec<f64>>],
    /// M_0 … M_{K−1}.
    pub m: &'a [Vec<Vec<f64>>],
    /// The middle of Θ', its half-widths, and what of them is kept for rounding.
    pub center: &'a [f64],
    pub half_width: &'a [f64],
    pub reserve: &'a [f64],
    /// Its tables, and what is proved of its rounding.
    pub tables: TubeTables,
    pub rounding: Rounding,
    pub paths: PathTables,
}

/// The robots of a plan.
pub fn pilots(planned: &Planned) -> Vec<Pilot<'_>> {
    planned.problem.robots.values().map(|robot| pilot(planned, robot)).collect()
}

fn pilot<'a>(planned: &'a Planned, robot: &'a Robot) -> Pilot<'a> {
    let Planned { problem, plan, float, .. } = planned;
    let model = &problem.models[robot.model];
    let tube = plan.tubes.iter().find(|t| t.dynamics == model.name).expect("a tube");
    let path = plan.robots.iter().find(|r| r.name == robot.name).expect("a path");
    let feedback = Feedback { center: &tube.center, half_width: &tube.half_width, d: &tube.d, m: &tube.m };
    let promise = Promise { model, workspace: &problem.workspace, feedback, reserve: &tube.reserve };
    let flight = Flight { start: &robot.start, z: &path.z, v: &path.v };
    let (tables, rounding) = law::fit(*float, &promise, &[flight]).expect("it fits");
    Pilot {
        name: format!("{}/{}", planned.name, robot.name),
        robot,
        model,
        path,
        loop_start: plan.loop_start,
        d: &tube.d,
        m: &tube.m,
        center: &tube.center,
        half_width: &tube.half_width,
        reserve: &tube.reserve,
        tables,
        rounding,
        paths: PathTables::new(*float, &path.z, &path.v, plan.loop_start).expect("numbers"),
    }
}

/// The tables of a pilot in a float type.
pub struct Flown<R> {
    errors: Vec<Column<R>>,
    gains: Vec<Column<R>>,
    bounds: [Bounds<Column<R>>; 4],
    assumed: Column<R>,
    near: [Column<R>; 2],
    moments: Vec<Moment<Column<R>, Column<R>>>,
}

fn column<R: Number>(values: &[f64]) -> Column<R> {
    values.iter().map(|x| R::of(*x)).collect()
}

fn bounds<R: Number>(bounds: &Bounds<Vec<f64>>) -> Bounds<Column<R>> {
    Bounds { lo: column(&bounds.lo), hi: column(&bounds.hi) }
}

impl<R: Number> Flown<R> {
    /// The tables of a pilot.
    pub fn new(pilot: &Pilot<'_>) -> Flown<R> {
        let tables = &pilot.tables;
        let moment = |m: &Moment<Vec<f64>, Vec<f64>>| Moment { z: column(&m.z), v: column(&m.v) };
        Flown {
            errors: tables.errors.iter().map(|c| column(c)).collect(),
            gains: tables.gains.iter().map(|c| column(c)).collect(),
            bounds: [&tables.disturbance, &tables.hull, &tables.state, &tables.input].map(bounds),
            assumed: column(&tables.assumed),
            near: [&tables.state_near, &tables.input_near].map(|c| column(c)),
            moments: pilot.paths.moments.iter().map(moment).collect(),
        }
    }

    /// Runs something with the law of these tables.
    pub fn fly<T>(
        &self,
        pilot: &Pilot<'_>,
        fallback: Fallback<Column<R>>,
        run: impl FnOnce(&mut Law<'_, R>) -> T,
    ) -> T {
        let [disturbance, hull, state, input] = self.bounds.clone();
        let tube = Tube {
            errors: &self.errors,
            gains: &self.gains,
            disturbance,
            assumed: self.assumed.clone(),
            hull,
            state,
            state_near: self.near[0].clone(),
            input,
            input_near: self.near[1].clone(),
        };
        let (first, rest) = self.moments.split_first().expect("a first moment");
        let path = Path { first: first.clone(), rest, loop_start: pilot.loop_start };
        let n = pilot.model.n();
        let history = vec![column(&vec![0.0; n]); pilot.d.len()];
        run(&mut Tracker::new(&tube, &path, fallback, history))
    }
}

impl Pilot<'_> {
    /// x⁺ = A x + B u + c + w in doubles.
    pub fn plant(&self, x: &[f64], u: &[f64], w: &[f64]) -> Vec<f64> {
        let row = |i: usize| {
            let a: f64 = x.iter().enumerate().map(|(j, x)| self.model.a[(i, j)].to_f64() * x).sum();
            let b: f64 = u.iter().enumerate().map(|(j, u)| self.model.b[(i, j)].to_f64() * u).sum();
            a + b + self.model.c[i].to_f64() + w[i]
        };
        (0..x.len()).map(row).collect()
    }

    /// A disturbance of the mission, by a share of −1 to 1 of each half-width.
    pub fn disturbance(&self, mut share: impl FnMut() -> f64) -> Vec<f64> {
        let of = |i: &dosmc::ir::Interval| {
            let (lo, hi) = (i.lo.to_f64(), i.hi.to_f64());
            // In doubles the plant is off by some units of the last place: not at the very edge.
            0.5 * (lo + hi) + 0.5 * (hi - lo) * share() * 0.9999
        };
        self.model.disturbance.iter().map(of).collect()
    }

    /// Where it starts.
    pub fn start(&self) -> Vec<f64> {
        self.robot.start.iter().map(|x| x.to_f64()).collect()
    }
}

/// An input as doubles.
pub fn doubles<R: Number>(column: &[R]) -> Vec<f64> {
    column.iter().map(|x| x.double()).collect()
}

/// Does something in the float type of a plan.
#[macro_export]
macro_rules! in_type {
    ($float:expr, $run:ident($($argument:expr),*)) => {
        match $float {
            Float::F64 => $run::<f64>($($argument),*),
            Float::F32 => $run::<f32>($($argument),*),
        }
    };
}

/// What the monitor says, in words.
pub fn said<R: Number>(status: &Status<R>) -> String {
    format!("{status:?}")
}
