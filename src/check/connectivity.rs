//! What `connectivity` asks of links.

use crate::check::expression::{Scope, Value};
use crate::check::settings::MAX_STEPS;
use crate::check::{Checker, messages};
use crate::diag::Reported;
use crate::ir;
use crate::quantity::Dimension;
use crate::source::Span;
use crate::syntax::ast::{ConnectivityItem, ConnectivityKind, Expr, Norm};

/// Every robot reaches a base over any number of links, always.
pub(super) const ANY_HOPS: ir::Connectivity =
    ir::Connectivity { hops: None, range: None, redundancy: 0, every: 1 };
/// The most robots that may be lost.
const MAX_REDUNDANCY: i64 = 3;

impl Checker<'_> {
    /// Reads the items of a `connectivity` block; `every` waits until the sampling time is known.
    pub(super) fn connectivity(&mut self, items: &[ConnectivityItem]) -> Result<(), Reported> {
        let mut connectivity = ANY_HOPS;
        let mut firsts: Vec<(&'static str, Span)> = Vec::new();
        let mut failed = None;
        for item in items {
            let word = word(&item.kind);
            if let Some((_, first)) = firsts.iter().find(|(w, _)| *w == word) {
                failed = Some(self.report(messages::repeated(word, *first, item.span)));
                continue;
            }
            firsts.push((word, item.span));
            failed = failed.or(self.item(item, &mut connectivity).err());
        }
        self.settings.connectivity = Some(connectivity);
        failed.map_or(Ok(()), Err)
    }

    fn item(&mut self, item: &ConnectivityItem, connectivity: &mut ir::Connectivity) -> Result<(), Reported> {
        match &item.kind {
            ConnectivityKind::Hops(expr) => connectivity.hops = Some(self.hops(expr)?),
            ConnectivityKind::Range { length, norm } => {
                connectivity.range = Some(self.link_range(length, norm.as_ref())?);
            }
            ConnectivityKind::Redundancy(expr) => {
                connectivity.redundancy = self.redundancy(expr)?;
            }
            ConnectivityKind::Every(expr) => {
                self.settings.every = Some((self.evaluate(expr, &Scope::default())?, expr.span));
            }
        }
        Ok(())
    }

    fn hops(&mut self, expr: &Expr) -> Result<u32, Reported> {
        let hops = self.whole(expr, &Scope::default())?;
        u32::try_from(hops)
            .ok()
            .filter(|h| (1..=MAX_STEPS as u32).contains(h))
            .ok_or_else(|| self.report(messages::bad_hops(expr.span, hops)))
    }

    fn link_range(&mut self, length: &Expr, norm: Option<&Norm>) -> Result<ir::Range, Reported> {
        let distance = self.quantity(length, &Scope::default(), Dimension::LENGTH)?;
        if !distance.is_positive() {
            return Err(self.report(messages::not_positive(length.span, "the range", &distance)));
        }
        let norm = match norm {
            None => ir::Norm::Infinity,
            Some(norm) if norm.value.value == 2 => ir::Norm::Euclidean,
            Some(norm) => {
                return Err(self.report(messages::unknown_range_norm(norm.value.span, &norm.value.value)));
            }
        };
        Ok(ir::Range { length: distance, norm })
    }

    fn redundancy(&mut self, expr: &Expr) -> Result<u32, Reported> {
        let lost = self.whole(expr, &Scope::default())?;
        u32::try_from(lost)
            .ok()
            .filter(|_| lost <= MAX_REDUNDANCY)
            .ok_or_else(|| self.report(messages::bad_redundancy(expr.span, lost, MAX_REDUNDANCY)))
    }

    /// Turns `every` into steps, once the sampling time is known.
    pub(super) fn resolve_every(&mut self) {
        let Some((every, span)) = self.settings.every.take() else { return };
        let Ok(steps) = self.every_in_steps(&every, span) else { return };
        self.note_steps(span, (steps, steps));
        if let Some(connectivity) = &mut self.settings.connectivity {
            connectivity.every = steps;
        }
    }

    fn every_in_steps(&mut self, every: &Value, span: Span) -> Result<u32, Reported> {
        let in_steps = every.dimension.is_bare();
        let number = if in_steps {
            every.number.clone()
        } else {
            let time = self.expect_dimension(every.clone(), span, Dimension::TIME)?;
            match &self.settings.step {
                Some(step) => time / step,
                None => return Err(self.reported(|| messages::missing_robot(span))),
            }
        };
        let steps = number.to_i64().filter(|n| (1..=MAX_STEPS).contains(n));
        steps.map(|n| n as u32).ok_or_else(|| {
            let step = self.settings.step.clone().filter(|_| !in_steps);
            self.report(messages::bad_every(span, &number, step.as_ref(), MAX_STEPS))
        })
    }
}

fn word(kind: &ConnectivityKind) -> &'static str {
    match kind {
        ConnectivityKind::Hops(_) => "hops",
        ConnectivityKind::Range { .. } => "range",
        ConnectivityKind::Redundancy(_) => "redundancy",
        ConnectivityKind::Every(_) => "every",
    }
}
