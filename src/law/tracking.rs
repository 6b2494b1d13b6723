//! The tracking law of a robot, and the monitor that watches its assumption.
//!
//! This file is the same in every controller and in the program that writes them, which simulates
//! with it; only tables are generated.
//!
//! A plan gives a robot nominal states `z` and inputs `v`, one of each a step, and after the last of
//! them those from the start of the loop again. The robot is pushed about by disturbances, and so is
//! somewhere else, at `x`. What the model does not explain of the last step is
//!
//! ```text
//! ŵ(t−1) = (x(t) − z(t)) − Σ D(i) ŵ(t−1−i)    over i = 1 … K−1
//! ```
//!
//! and the input answers the last `K` of these,
//!
//! ```text
//! u(t) = v(t) + Σ M(i) ŵ(t−1−i)               over i = 0 … K−1
//! ```
//!
//! so that each of them is forgotten after `K` steps. Before the start all of them are 0. While each
//! lies in its box, `x − z` lies in the tube that the plan was proved with, for ever. The monitor
//! says after every measurement whether that still holds.
//!
//! The tables alone bound how often each loop runs; only where something is beyond a bound, or no number,
//! is it looked for which. There is no path to a panic, no allocation and no recursion.

use core::mem;
use core::ops::{Add, Mul, Sub};

/// A floating-point type.
pub trait Real: Copy + PartialOrd + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// 0.
    const ZERO: Self;

    /// Whether it is a number, and no infinite one.
    fn is_finite(self) -> bool;
}

impl Real for f64 {
    const ZERO: f64 = 0.0;

    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
}

impl Real for f32 {
    const ZERO: f32 = 0.0;

    fn is_finite(self) -> bool {
        f32::is_finite(self)
    }
}

/// A column of numbers, one a state or one an input.
pub trait Column: Clone {
    /// What its entries are.
    type Entry: Real;

    /// A column of zeros, as long as this one.
    #[must_use]
    fn zeros(&self) -> Self;

    /// Its entries, in order.
    fn entries(&self) -> &[Self::Entry];

    /// Its entries, to be changed.
    fn entries_mut(&mut self) -> &mut [Self::Entry];
}

impl<R: Real, const N: usize> Column for [R; N] {
    type Entry = R;

    fn zeros(&self) -> Self {
        [R::ZERO; N]
    }

    fn entries(&self) -> &[R] {
        self
    }

    fn entries_mut(&mut self) -> &mut [R] {
        self
    }
}

/// A box: what lies between two columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds<C> {
    /// The lower ends.
    pub lo: C,
    /// The upper ends.
    pub hi: C,
}

/// The tables of a motion model with n states (`X`) and m inputs (`U`).
#[derive(Clone, Copy, Debug)]
pub struct Tube<'a, X, U> {
    /// The columns of `D(1)` … `D(K−1)`, one matrix after the other: (K − 1) n of them.
    pub errors: &'a [X],
    /// The columns of `M(0)` … `M(K−1)`, one matrix after the other: K n of them.
    pub gains: &'a [U],
    /// Where each `ŵ` lies while the assumption holds.
    pub disturbance: Bounds<X>,
    /// What is taken for a `ŵ` that could not be measured: the middle of its box.
    pub assumed: X,
    /// The least box around the tube: outside it, `x − z` is certainly outside the tube.
    pub hull: Bounds<X>,
    /// The bounds of the states; infinite where there are none.
    pub state: Bounds<X>,
    /// How near to its bounds a state is reported.
    pub state_near: X,
    /// The bounds of the inputs. No input is ever outside them.
    pub input: Bounds<U>,
    /// How near to its bounds an input is reported.
    pub input_near: U,
}

/// The nominal state and input of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment<X, U> {
    /// The nominal state.
    pub z: X,
    /// The nominal input.
    pub v: U,
}

/// A robot's nominal trajectory, without end.
#[derive(Clone, Copy, Debug)]
pub struct Path<'a, X, U> {
    /// The first step.
    pub first: Moment<X, U>,
    /// All others, up to the last one.
    pub rest: &'a [Moment<X, U>],
    /// The step that follows the last one.
    pub loop_start: usize,
}

impl<X, U> Path<'_, X, U> {
    /// The nominal state and input of a step up to the last one.
    fn moment(&self, step: usize) -> &Moment<X, U> {
        step.checked_sub(1).and_then(|i| self.rest.get(i)).unwrap_or(&self.first)
    }

    /// The step after another one.
    fn after(&self, step: usize) -> usize {
        if step < self.rest.len() { step.saturating_add(1) } else { self.loop_start }
    }
}

/// What is given out when a measurement is missing or is no number. It is kept within the bounds of
/// the inputs, like every other input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fallback<U> {
    /// What the law says if the last disturbance was the middle of its box: the best guess, and what
    /// is right if nothing disturbed the robot.
    Predict,
    /// The last input once more.
    Hold,
    /// This input.
    Fixed(U),
}

impl<U> Fallback<U> {
    /// The same with another kind of input.
    pub fn map<V>(self, input: impl FnOnce(U) -> V) -> Fallback<V> {
        match self {
            Fallback::Predict => Fallback::Predict,
            Fallback::Hold => Fallback::Hold,
            Fallback::Fixed(fixed) => Fallback::Fixed(input(fixed)),
        }
    }
}

/// An amount, and which state or input it is about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading<R> {
    /// The index of the state or input, from 0.
    pub component: usize,
    /// The amount, in that one's unit.
    pub amount: R,
}

/// Whether the last step agrees with what was assumed of disturbances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Assumption<R> {
    /// It does.
    Within,
    /// It was disturbed more than assumed: by how much more, where that is the most of what was assumed.
    Exceeded(Reading<R>),
    /// This state's measurement is no number, or so large that nothing can be computed with it.
    NotANumber {
        /// The index of the state, from 0.
        component: usize,
    },
    /// There was no measurement.
    Missing,
}

/// Whether the robot is in the tube that the plan was proved with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Containment<R> {
    /// It is.
    Inside,
    /// It is in it again, for the first time after it may have been outside.
    Returned,
    /// It may be outside: a disturbance that was larger than assumed is not forgotten yet, or nothing
    /// was measured.
    Unproved,
    /// It is outside: by how much, where that is most.
    Outside(Reading<R>),
}

/// What the monitor says of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status<R> {
    /// Whether the last step was disturbed no more than assumed.
    pub assumption: Assumption<R>,
    /// Whether the robot is in the tube.
    pub containment: Containment<R>,
    /// The state nearest to a bound of its own, if it is near: what room is left, negative beyond.
    pub state_near: Option<Reading<R>>,
    /// The input nearest to a bound of its own, if it is near: what room is left.
    pub input_near: Option<Reading<R>>,
}

impl<R> Status<R> {
    /// Whether the plan's promise holds: nothing was beyond what was assumed, and what ever was is
    /// forgotten.
    pub fn holds(&self) -> bool {
        matches!(
            (&self.assumption, &self.containment),
            (Assumption::Within, Containment::Inside | Containment::Returned)
        )
    }
}

/// The law of one robot, with what it remembers.
///
/// `H` holds K columns: what the last K steps were disturbed by, the latest first.
#[derive(Clone, Debug)]
pub struct Tracker<'a, X, U, H> {
    tube: &'a Tube<'a, X, U>,
    path: &'a Path<'a, X, U>,
    fallback: Fallback<U>,
    history: H,
    step: usize,
    last: U,
    /// How many measurements within the assumption it takes until all that is remembered is.
    doubtful: usize,
    /// Whether the robot was last known to be in the tube.
    inside: bool,
}

impl<'a, R, X, U, H> Tracker<'a, X, U, H>
where
    R: Real,
    X: Column<Entry = R>,
    U: Column<Entry = R>,
    H: AsRef<[X]> + AsMut<[X]>,
{
    /// A tracker at its first step; all of `history` is overwritten.
    pub fn new(
        tube: &'a Tube<'a, X, U>,
        path: &'a Path<'a, X, U>,
        fallback: Fallback<U>,
        history: H,
    ) -> Self {
        let last = path.first.v.clone();
        let mut tracker = Tracker { tube, path, fallback, history, step: 0, last, doubtful: 0, inside: true };
        tracker.reset();
        tracker
    }

    /// Starts again at the first step, with nothing remembered.
    pub fn reset(&mut self) {
        let zeros = self.tube.assumed.zeros();
        for column in self.history.as_mut() {
            *column = zeros.clone();
        }
        self.last = self.path.first.v.clone();
        self.step = 0;
        self.doubtful = 0;
        self.inside = true;
    }

    /// The step that the next measurement belongs to: an index into the plan's tables.
    pub fn moment(&self) -> usize {
        self.step
    }

    /// What the last K steps were disturbed by, the latest first.
    pub fn history(&self) -> &[X] {
        self.history.as_ref()
    }

    /// The input for a measured state, and what the monitor says of it.
    pub fn step(&mut self, x: &X) -> (U, Status<R>) {
        let error = difference(x, &self.path.moment(self.step).z);
        let mut predicted = error.zeros();
        accumulate(&mut predicted, self.tube.errors, self.history.as_ref());
        let disturbance = difference(&error, &predicted);
        // What is wrong with the measurement shows here; what is right may be too large to compute with.
        if let Some(component) = unusable(&disturbance) {
            let component = unusable(x).unwrap_or(component);
            return self.unmeasured(Assumption::NotANumber { component });
        }
        let assumption = match most_beyond(&disturbance, &self.tube.disturbance) {
            Some(excess) => Assumption::Exceeded(excess),
            None => Assumption::Within,
        };
        self.remember(disturbance);
        let containment = self.contained(&assumption, &error);
        let state_near = nearest(x, &self.tube.state, &self.tube.state_near);
        let input = self.law();
        self.conclude(input, assumption, containment, state_near)
    }

    /// The input for a step without a measurement.
    pub fn missed(&mut self) -> (U, Status<R>) {
        self.unmeasured(Assumption::Missing)
    }

    /// A step of which nothing usable was measured.
    fn unmeasured(&mut self, assumption: Assumption<R>) -> (U, Status<R>) {
        self.remember(self.tube.assumed.clone());
        self.doubtful = self.doubtful.saturating_sub(1);
        self.inside = false;
        let input = match &self.fallback {
            Fallback::Predict => self.law(),
            Fallback::Hold => self.last.clone(),
            Fallback::Fixed(input) => input.clone(),
        };
        self.conclude(input, assumption, Containment::Unproved, None)
    }

    /// Puts a disturbance in front of those that are remembered; the oldest is forgotten.
    fn remember(&mut self, disturbance: X) {
        let mut newer = disturbance;
        for column in self.history.as_mut() {
            newer = mem::replace(column, newer);
        }
    }

    /// Whether the robot is in the tube, after a measurement: it is when all that is remembered is as
    /// assumed.
    fn contained(&mut self, assumption: &Assumption<R>, error: &X) -> Containment<R> {
        self.doubtful = match assumption {
            Assumption::Within => self.doubtful.saturating_sub(1),
            _ => self.history.as_ref().len(),
        };
        if self.doubtful == 0 {
            return if mem::replace(&mut self.inside, true) {
                Containment::Inside
            } else {
                Containment::Returned
            };
        }
        self.inside = false;
        match most_beyond(error, &self.tube.hull) {
            Some(excess) => Containment::Outside(excess),
            None => Containment::Unproved,
        }
    }

    /// The nominal input and the feedback of what is remembered. (Models that switch between modes have
    /// gains for each; the moment's mode will choose them here.)
    fn law(&self) -> U {
        let v = &self.path.moment(self.step).v;
        let mut input = v.zeros();
        accumulate(&mut input, self.tube.gains, self.history.as_ref());
        for (sum, &nominal) in input.entries_mut().iter_mut().zip(v.entries()) {
            *sum = nominal + *sum;
        }
        input
    }

    /// Keeps the input within its bounds and goes on to the next step.
    fn conclude(
        &mut self,
        mut input: U,
        assumption: Assumption<R>,
        containment: Containment<R>,
        state_near: Option<Reading<R>>,
    ) -> (U, Status<R>) {
        confine(&mut input, &self.tube.input, &self.path.moment(self.step).v);
        let input_near = nearest(&input, &self.tube.input, &self.tube.input_near);
        self.last = input.clone();
        self.step = self.path.after(self.step);
        (input, Status { assumption, containment, state_near, input_near })
    }
}

/// The first entry that is no number, or no finite one.
fn unusable<C: Column>(column: &C) -> Option<usize> {
    let mut usable = true;
    for entry in column.entries() {
        usable &= entry.is_finite();
    }
    if usable { None } else { column.entries().iter().position(|entry| !entry.is_finite()) }
}

/// Adds to `sum` some matrices times the disturbances: matrix by matrix, of each the columns in order.
/// (Products of different matrices do not wait for each other so.)
fn accumulate<R, C, X>(sum: &mut C, columns: &[C], disturbances: &[X])
where
    R: Real,
    C: Column<Entry = R>,
    X: Column<Entry = R>,
{
    let mut rest = columns;
    for disturbance in disturbances {
        let width = disturbance.entries().len();
        let (matrix, next) = match (rest.get(..width), rest.get(width..)) {
            (Some(matrix), Some(next)) => (matrix, next),
            // Of the oldest disturbance nothing is left to be predicted.
            _ => return,
        };
        rest = next;
        let mut product = sum.zeros();
        for (&factor, column) in disturbance.entries().iter().zip(matrix) {
            for (product, &entry) in product.entries_mut().iter_mut().zip(column.entries()) {
                *product = *product + entry * factor;
            }
        }
        for (sum, &product) in sum.entries_mut().iter_mut().zip(product.entries()) {
            *sum = *sum + product;
        }
    }
}

/// One column less another.
fn difference<C: Column>(minuend: &C, subtrahend: &C) -> C {
    let mut difference = minuend.clone();
    for (entry, &less) in difference.entries_mut().iter_mut().zip(subtrahend.entries()) {
        *entry = *entry - less;
    }
    difference
}

/// Moves each entry into its bounds; what is no number becomes the nominal entry.
fn confine<C: Column>(column: &mut C, bounds: &Bounds<C>, nominal: &C) {
    let ends = bounds.lo.entries().iter().zip(bounds.hi.entries());
    for ((entry, &nominal), (&lo, &hi)) in column.entries_mut().iter_mut().zip(nominal.entries()).zip(ends) {
        if *entry < lo {
            *entry = lo;
        } else if *entry > hi {
            *entry = hi;
        } else if !entry.is_finite() {
            *entry = nominal;
        }
    }
}

/// Where a column is beyond its bounds, and by how much: of several entries the one that is most
/// beyond in proportion to its width.
fn most_beyond<C: Column>(column: &C, bounds: &Bounds<C>) -> Option<Reading<C::Entry>> {
    let ends = bounds.lo.entries().iter().zip(bounds.hi.entries());
    let mut any = false;
    for (&entry, (&lo, &hi)) in column.entries().iter().zip(ends.clone()) {
        any |= entry < lo;
        any |= entry > hi;
    }
    // Mostly it is within, and nothing has to be compared.
    if !any {
        return None;
    }
    let mut most: Option<(Reading<C::Entry>, C::Entry)> = None;
    for (component, (&entry, (&lo, &hi))) in column.entries().iter().zip(ends).enumerate() {
        let (amount, width) = (if entry < lo { lo - entry } else { entry - hi }, hi - lo);
        let larger = match &most {
            Some((reading, other)) => amount * *other > reading.amount * width,
            None => true,
        };
        if amount > C::Entry::ZERO && larger {
            most = Some((Reading { component, amount }, width));
        }
    }
    most.map(|(reading, _)| reading)
}

/// The entry with the least room to its bounds in proportion to what counts as near, if that is less
/// than near.
fn nearest<C: Column>(column: &C, bounds: &Bounds<C>, near: &C) -> Option<Reading<C::Entry>> {
    let ends = bounds.lo.entries().iter().zip(bounds.hi.entries());
    let mut any = false;
    for ((&entry, &near), (&lo, &hi)) in column.entries().iter().zip(near.entries()).zip(ends.clone()) {
        any |= entry - lo < near;
        any |= hi - entry < near;
    }
    if !any {
        return None;
    }
    let mut least: Option<(Reading<C::Entry>, C::Entry)> = None;
    for (component, ((&entry, &near), (&lo, &hi))) in
        column.entries().iter().zip(near.entries()).zip(ends).enumerate()
    {
        let (above, below) = (entry - lo, hi - entry);
        let amount = if above < below { above } else { below };
        let smaller = match &least {
            Some((reading, other)) => amount * *other < reading.amount * near,
            None => true,
        };
        if amount < near && smaller {
            least = Some((Reading { component, amount }, near));
        }
    }
    least.map(|(reading, _)| reading)
}
