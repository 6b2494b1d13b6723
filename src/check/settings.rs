//! What there is at most one of: edition, name, step, separation, connectivity, horizon, objective.

use std::collections::BTreeSet;

use crate::check::expression::Scope;
use crate::check::typed::DynamicsId;
use crate::check::{Checker, messages};
use crate::diag::Reported;
use crate::exact::Rational;
use crate::ir;
use crate::quantity::Dimension;
use crate::source::Span;
use crate::syntax::ast::{self, ConnectivityKind, Expr, ItemKind};

/// The longest horizon, window or distance between required links, in steps.
pub(super) const MAX_STEPS: i64 = 100_000;
/// The lengths that are tried when the mission does not say.
const DEFAULT_HORIZON: (usize, usize) = (1, 64);

/// The mission-wide settings.
pub(super) struct Settings {
    /// The declared name.
    pub(super) name: Option<String>,
    /// The sampling time that all models in use share.
    pub(super) step: Option<Rational>,
    /// Each model's name, `step` item and sampling time.
    pub(super) steps: Vec<(Span, Span, Rational)>,
    /// ε with its declaration.
    pub(super) separation: Option<(Rational, Span)>,
    /// `None` with `connectivity none`.
    pub(super) connectivity: Option<ir::Connectivity>,
    /// The lengths that may be tried.
    pub(super) horizon: (usize, usize),
    /// What to minimise.
    pub(super) objective: Option<ir::Objective>,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            name: None,
            step: None,
            steps: Vec::new(),
            separation: None,
            connectivity: Some(ANY_HOPS),
            horizon: DEFAULT_HORIZON,
            objective: None,
        }
    }
}

/// Every robot reaches a base over any number of links, always.
const ANY_HOPS: ir::Connectivity = ir::Connectivity { hops: None, range: None, redundancy: 0, every: 1 };

impl Checker<'_> {
    /// Reads every setting that does not depend on robots or models; the parser has seen to the edition.
    pub(super) fn settings(&mut self) {
        let file = self.file;
        let mut firsts: Vec<(&'static str, Span)> = Vec::new();
        for item in &file.items {
            let Some(word) = setting_word(&item.kind) else { continue };
            if let Some((_, first)) = firsts.iter().find(|(w, _)| *w == word) {
                self.report(messages::repeated(word, *first, item.span));
                continue;
            }
            firsts.push((word, item.span));
            // A setting that is wrong keeps its default, so that nothing else complains about it.
            let _ = self.setting(&item.kind, item.span);
        }
    }

    fn setting(&mut self, kind: &ItemKind, span: Span) -> Result<(), Reported> {
        match kind {
            ItemKind::Mission(name) => {
                self.settings.name = Some(name.text.clone());
                Ok(())
            }
            ItemKind::Separation(expr) => self.separation(expr, span),
            ItemKind::Connectivity(ast::Connectivity::None) => {
                self.settings.connectivity = None;
                Ok(())
            }
            ItemKind::Connectivity(ast::Connectivity::Items(items)) => self.connectivity(items),
            ItemKind::Horizon { from, to } => self.horizon(from, to),
            ItemKind::Minimize(word) => match word.text.as_str() {
                "effort" | "length" => Err(self.report(messages::unsupported("`minimize`", span))),
                _ => Err(self.report(messages::unknown_objective(word))),
            },
            _ => Ok(()),
        }
    }

    fn separation(&mut self, expr: &Expr, span: Span) -> Result<(), Reported> {
        let distance = self.quantity(expr, &Scope::default(), Dimension::LENGTH)?;
        if !distance.is_positive() {
            return Err(self.report(messages::not_positive(expr.span, "the separation", &distance)));
        }
        self.settings.separation = Some((distance, span));
        Ok(())
    }

    fn horizon(&mut self, from: &Expr, to: &Expr) -> Result<(), Reported> {
        let (a, b) = (self.whole(from, &Scope::default()), self.whole(to, &Scope::default()));
        let (a, b) = (a?, b?);
        if a < 1 || b < a || b > MAX_STEPS {
            return Err(self.report(messages::bad_horizon(from.span, to.span, a, b, MAX_STEPS)));
        }
        self.settings.horizon = (a as usize, b as usize);
        Ok(())
    }

    fn connectivity(&mut self, items: &[ast::ConnectivityItem]) -> Result<(), Reported> {
        let mut connectivity = ANY_HOPS;
        let mut firsts: Vec<(&'static str, Span)> = Vec::new();
        let mut failed = None;
        for item in items {
            let word = connectivity_word(&item.kind);
            if let Some((_, first)) = firsts.iter().find(|(w, _)| *w == word) {
                failed = Some(self.report(messages::repeated(word, *first, item.span)));
                continue;
            }
            firsts.push((word, item.span));
            match &item.kind {
                ConnectivityKind::Hops(expr) => match self.hops(expr) {
                    Ok(hops) => connectivity.hops = Some(hops),
                    Err(reported) => failed = Some(reported),
                },
                _ => failed = Some(self.report(messages::unsupported(&format!("`{word}`"), item.span))),
            }
        }
        self.settings.connectivity = Some(connectivity);
        failed.map_or(Ok(()), Err)
    }

    fn hops(&mut self, expr: &Expr) -> Result<u32, Reported> {
        let hops = self.whole(expr, &Scope::default())?;
        u32::try_from(hops)
            .ok()
            .filter(|h| (1..=MAX_STEPS as u32).contains(h))
            .ok_or_else(|| self.report(messages::bad_hops(expr.span, hops)))
    }

    /// Looks at what several declarations say together: one step for all models in use, some base.
    pub(super) fn cross_settings(&mut self) {
        self.common_step();
        let file = self.file;
        let bases = file.items.iter().any(|i| matches!(i.kind, ItemKind::Base { .. }));
        let unread = bases && self.bases.is_empty() && self.diagnostics.has_errors();
        if self.bases.is_empty()
            && !unread
            && self.settings.connectivity.is_some()
            && !file.has_broken_keyword("base")
        {
            let robot = file.items.iter().find(|i| matches!(i.kind, ItemKind::Robot { .. }));
            if let Some(robot) = robot {
                self.report(messages::missing_base(robot.span));
            }
        }
    }

    fn common_step(&mut self) {
        let mut used: BTreeSet<DynamicsId> = self.robots.iter().flatten().map(|r| r.dynamics).collect();
        let Some(first) = used.pop_first() else { return };
        let step = self.dynamics[first].step.clone();
        for other in used {
            let (a, b) = (&self.dynamics[first], &self.dynamics[other]);
            if a.step != b.step {
                let message = messages::different_steps(
                    (&a.name, step_span(&self.settings, a.name_span), &a.step),
                    (&b.name, step_span(&self.settings, b.name_span), &b.step),
                );
                self.report(message);
            }
        }
        self.settings.step = Some(step);
    }
}

fn step_span(settings: &Settings, model: Span) -> Span {
    settings.steps.iter().find(|(name, _, _)| *name == model).map_or(model, |(_, item, _)| *item)
}

fn setting_word(kind: &ItemKind) -> Option<&'static str> {
    match kind {
        ItemKind::Edition(_) => Some("dosm"),
        ItemKind::Mission(_) => Some("mission"),
        ItemKind::Separation(_) => Some("separation"),
        ItemKind::Connectivity(_) => Some("connectivity"),
        ItemKind::Horizon { .. } => Some("horizon"),
        ItemKind::Minimize(_) => Some("minimize"),
        _ => None,
    }
}

fn connectivity_word(kind: &ConnectivityKind) -> &'static str {
    match kind {
        ConnectivityKind::Hops(_) => "hops",
        ConnectivityKind::Range { .. } => "range",
        ConnectivityKind::Redundancy(_) => "redundancy",
        ConnectivityKind::Every(_) => "every",
    }
}
