//! The intervals of a motion model: bounds on states and inputs, and the disturbance.

use crate::check::expression::Scope;
use crate::check::shapes::MAX_PARTS;
use crate::check::{Checker, messages, typed};
use crate::diag::Reported;
use crate::geometry::HalfSpace;
use crate::source::Span;
use crate::syntax::ast::{DynamicsItem, DynamicsKind, Inequality, Interval, Name};

/// The intervals that a model's items say, one entry a signal.
pub(super) struct Bounds {
    /// The box part of 𝒳.
    pub(super) states: Vec<Option<typed::Interval>>,
    /// The box part of 𝒰.
    pub(super) inputs: Vec<Option<typed::Interval>>,
    /// The general part of 𝒳 × 𝒰, over states and inputs.
    pub(super) mixed: Vec<HalfSpace>,
    /// Θ.
    pub(super) disturbance: Vec<Option<typed::Interval>>,
}

impl Checker<'_> {
    /// Collects the bounds and disturbances of a model's items.
    pub(super) fn bounds(
        &mut self,
        items: &[DynamicsItem],
        states: &[typed::Signal],
        inputs: &[typed::Signal],
    ) -> Result<Bounds, Reported> {
        let mut bounded = vec![None; states.len() + inputs.len()];
        let mut disturbance = vec![None; states.len()];
        let signals: Vec<&typed::Signal> = states.iter().chain(inputs).collect();
        let mut mixed = Vec::new();
        let mut failed = None;
        for item in items {
            let result = match &item.kind {
                DynamicsKind::BoundWhere(inequalities) => {
                    self.general(inequalities, &signals, item.span).map(|rows| mixed.extend(rows))
                }
                DynamicsKind::Bound { names, interval } => {
                    self.fill(&mut bounded, &signals, "state or input", names, interval, item.span)
                }
                DynamicsKind::Disturbance { names, interval } => {
                    let input = |name: &&Name| inputs.iter().any(|signal| signal.name == name.text);
                    if let Some(name) = names.iter().find(input) {
                        failed = Some(self.report(messages::disturbed_input(name)));
                        continue;
                    }
                    self.fill(&mut disturbance, &signals[..states.len()], "state", names, interval, item.span)
                }
                _ => continue,
            };
            failed = failed.or(result.err());
        }
        if let Some(reported) = failed {
            return Err(reported);
        }
        let inputs = bounded.split_off(states.len());
        for interval in bounded.iter().chain(&inputs).flatten() {
            if interval.lo == interval.hi {
                failed = Some(self.report(messages::point_bound(interval.span)));
            }
        }
        failed.map_or(Ok(Bounds { states: bounded, inputs, mixed, disturbance }), Err)
    }

    /// Half-spaces over all states and inputs.
    fn general(
        &mut self,
        inequalities: &[Inequality],
        signals: &[&typed::Signal],
        span: Span,
    ) -> Result<Vec<HalfSpace>, Reported> {
        if inequalities.len() > MAX_PARTS {
            return Err(self.report(messages::too_many_parts(span, inequalities.len(), MAX_PARTS)));
        }
        let coordinates = signals.iter().map(|s| (s.name.clone(), s.dimension)).collect();
        let scope = Scope { coordinates, ..Scope::default() };
        let rows: Vec<_> = inequalities.iter().map(|i| self.half_space(i, &scope)).collect();
        rows.into_iter().collect()
    }

    fn fill(
        &mut self,
        slots: &mut [Option<typed::Interval>],
        signals: &[&typed::Signal],
        wanted: &'static str,
        names: &[Name],
        interval: &Interval,
        span: Span,
    ) -> Result<(), Reported> {
        let mut failed = None;
        for name in names {
            let Some(index) = signals.iter().position(|s| s.name == name.text) else {
                let message = messages::unknown_signal(name, wanted, signals.iter().copied());
                failed = Some(self.report(message));
                continue;
            };
            if let Some(first) = &slots[index] {
                failed = Some(self.report(messages::repeated_interval(name, first.span)));
                continue;
            }
            match self.interval(interval, signals[index], span) {
                Ok(interval) => slots[index] = Some(interval),
                Err(reported) => failed = Some(reported),
            }
        }
        failed.map_or(Ok(()), Err)
    }

    fn interval(
        &mut self,
        interval: &Interval,
        signal: &typed::Signal,
        span: Span,
    ) -> Result<typed::Interval, Reported> {
        let scope = Scope::default();
        let unit = interval.unit.as_ref();
        let lo = self.quantity_in(&interval.from, unit, &scope, signal.dimension);
        let hi = self.quantity_in(&interval.to, unit, &scope, signal.dimension);
        let (lo, hi) = (lo?, hi?);
        if lo > hi {
            let ends = [&interval.from, &interval.to].map(|end| (self.source.slice(end.span), end.span));
            let [from, to] = ends;
            return Err(self.report(messages::empty_interval(interval.span, from, to)));
        }
        Ok(typed::Interval { lo, hi, span })
    }
}
