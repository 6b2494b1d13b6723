//! A robot in closed loop: its plant in doubles, and the law that flies, compiled from its one source.

use super::greedy::Greedy;
use super::size::{Any, Fixed, Number, Size};
use super::way::{Report, Way};
use crate::exact::{Rational, RationalMatrix};
use crate::ir::Model;
use crate::law::tracking::{Bounds, Column, Fallback, Moment, Path, Tracker, Tube};
use crate::law::{Float, PathTables, TubeTables};

/// The mission's own x⁺ = A x + B u + c of a robot, where it starts, and the law's tables.
pub(super) struct Parts<'a> {
    pub(super) model: &'a Model,
    pub(super) start: &'a [Rational],
    pub(super) tube: &'a TubeTables,
    pub(super) path: &'a PathTables,
}

/// A robot that can be flown.
pub(super) trait Vehicle: Send + Sync {
    /// Flies a run: fills in states, inputs and reports, as many as the way has room for, with the
    /// disturbances that are there, those that `greedy` chooses excepted.
    fn fly(&self, way: &mut Way, greedy: Option<&Greedy>);
}

/// A robot with the law in a floating-point type, as fast as its size allows.
pub(super) fn vehicle(float: Float, parts: &Parts<'_>) -> Box<dyn Vehicle> {
    match float {
        Float::F64 => sized::<f64>(parts),
        Float::F32 => sized::<f32>(parts),
    }
}

/// The usual numbers of states and inputs have code of their own.
fn sized<R: Number>(parts: &Parts<'_>) -> Box<dyn Vehicle> {
    macro_rules! choose {
        ($($n:literal $m:literal),*) => {
            match (parts.model.n(), parts.model.m()) {
                $(($n, $m) => Box::new(Loop::<R, Fixed<$n>, Fixed<$m>>::new(parts)),)*
                _ => Box::new(Loop::<R, Any, Any>::new(parts)),
            }
        };
    }
    choose!(
        1 1, 2 1, 2 2, 3 1, 3 2, 3 3, 4 1, 4 2, 4 4, 5 2, 6 1, 6 2, 6 3, 8 2, 8 4, 9 3, 10 2, 12 2, 12 3, 12 4
    )
}

/// A robot with its law, in columns of known lengths.
struct Loop<R: Number, N: Size, M: Size> {
    /// The columns of A, then those of B.
    a: Vec<N::Of<f64>>,
    b: Vec<N::Of<f64>>,
    c: N::Of<f64>,
    start: N::Of<f64>,
    errors: Vec<N::Of<R>>,
    gains: Vec<M::Of<R>>,
    disturbance: Bounds<N::Of<R>>,
    assumed: N::Of<R>,
    hull: Bounds<N::Of<R>>,
    state: Bounds<N::Of<R>>,
    state_near: N::Of<R>,
    input: Bounds<M::Of<R>>,
    input_near: M::Of<R>,
    moments: Vec<Moment<N::Of<R>, M::Of<R>>>,
    loop_start: usize,
}

impl<R: Number, N: Size, M: Size> Loop<R, N, M> {
    fn new(parts: &Parts<'_>) -> Self {
        let Parts { model, start, tube, path } = parts;
        let moment = |m: &Moment<Vec<f64>, Vec<f64>>| Moment { z: law::<R, N>(&m.z), v: law::<R, M>(&m.v) };
        Loop {
            a: columns::<N>(&model.a),
            b: columns::<N>(&model.b),
            c: plant::<N>(&model.c),
            start: plant::<N>(start),
            errors: tube.errors.iter().map(|c| law::<R, N>(c)).collect(),
            gains: tube.gains.iter().map(|c| law::<R, M>(c)).collect(),
            disturbance: bounds::<R, N>(&tube.disturbance),
            assumed: law::<R, N>(&tube.assumed),
            hull: bounds::<R, N>(&tube.hull),
            state: bounds::<R, N>(&tube.state),
            state_near: law::<R, N>(&tube.state_near),
            input: bounds::<R, M>(&tube.input),
            input_near: law::<R, M>(&tube.input_near),
            moments: path.moments.iter().map(moment).collect(),
            loop_start: path.loop_start,
        }
    }

    /// The law's tables, as the law takes them.
    fn tube(&self) -> Tube<'_, N::Of<R>, M::Of<R>> {
        Tube {
            errors: &self.errors,
            gains: &self.gains,
            disturbance: self.disturbance.clone(),
            assumed: self.assumed.clone(),
            hull: self.hull.clone(),
            state: self.state.clone(),
            state_near: self.state_near.clone(),
            input: self.input.clone(),
            input_near: self.input_near.clone(),
        }
    }

    /// A x + B u + c.
    fn next(&self, x: &N::Of<f64>, u: &M::Of<f64>) -> N::Of<f64> {
        let mut next = self.c.clone();
        add(&mut next, &self.a, x.entries());
        add(&mut next, &self.b, u.entries());
        next
    }
}

impl<R: Number, N: Size, M: Size> Vehicle for Loop<R, N, M> {
    fn fly(&self, way: &mut Way, greedy: Option<&Greedy>) {
        let Some((first, rest)) = self.moments.split_first() else { return };
        let tube = self.tube();
        let path = Path { first: first.clone(), rest, loop_start: self.loop_start };
        let (n, m) = (self.start.entries().len(), self.gains.first().map_or(0, |g| g.entries().len()));
        let history = vec![self.assumed.zeros(); self.gains.len() / n.max(1)];
        let mut tracker = Tracker::new(&tube, &path, Fallback::Predict, history);
        let mut x = self.start.clone();
        let inputs = way.inputs.chunks_exact_mut(m.max(1));
        let rows = way.states.chunks_exact_mut(n.max(1)).zip(inputs);
        let more = way.pushes.chunks_exact_mut(n.max(1)).zip(&mut way.reports);
        for ((state, input), (push, report)) in rows.zip(more) {
            state.copy_from_slice(x.entries());
            let mut measured = self.assumed.zeros();
            measured.entries_mut().iter_mut().zip(x.entries()).for_each(|(to, from)| *to = R::nearest(*from));
            let step = tracker.moment();
            let (u, status) = tracker.step(&measured);
            input.iter_mut().zip(u.entries()).for_each(|(to, from)| *to = from.double());
            *report = Report::new(&status);
            let mut next = self.next(&x, &M::column(input));
            if let Some(greedy) = greedy {
                greedy.choose(step, next.entries(), push);
            }
            next.entries_mut().iter_mut().zip(push.iter()).for_each(|(x, w)| *x += w);
            x = next;
        }
    }
}

/// Adds to `sum` each column times its entry.
fn add<C: Column<Entry = f64>>(sum: &mut C, columns: &[C], factors: &[f64]) {
    for (column, factor) in columns.iter().zip(factors) {
        for (sum, entry) in sum.entries_mut().iter_mut().zip(column.entries()) {
            *sum += entry * factor;
        }
    }
}

/// A column of the plant.
fn plant<N: Size>(entries: &[Rational]) -> N::Of<f64> {
    N::column(&entries.iter().map(Rational::to_f64).collect::<Vec<_>>())
}

/// The columns of a matrix of the plant.
fn columns<N: Size>(matrix: &RationalMatrix) -> Vec<N::Of<f64>> {
    let (rows, columns) = matrix.shape();
    let column = |j: usize| (0..rows).map(|i| matrix[(i, j)].to_f64()).collect::<Vec<_>>();
    (0..columns).map(|j| N::column(&column(j))).collect()
}

/// A column of the law, whose numbers its floating-point type holds.
fn law<R: Number, S: Size>(entries: &[f64]) -> S::Of<R> {
    S::column(&entries.iter().map(|x| R::nearest(*x)).collect::<Vec<_>>())
}

fn bounds<R: Number, S: Size>(bounds: &Bounds<Vec<f64>>) -> Bounds<S::Of<R>> {
    Bounds { lo: law::<R, S>(&bounds.lo), hi: law::<R, S>(&bounds.hi) }
}
