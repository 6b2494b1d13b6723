//! What there is at most one of: edition, name, step, separation, connectivity, horizon, objective.

use std::collections::BTreeSet;

use crate::check::connectivity::ANY_HOPS;
use crate::check::expression::{Scope, Value};
use crate::check::typed::DynamicsId;
use crate::check::{Checker, messages};
use crate::diag::Reported;
use crate::exact::Rational;
use crate::ir;
use crate::quantity::Dimension;
use crate::source::Span;
use crate::syntax::ast::{self, Expr, ItemKind, Name};

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
    /// `every` as written with its place, until the step is known.
    pub(super) every: Option<(Value, Span)>,
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
            every: None,
            horizon: DEFAULT_HORIZON,
            objective: None,
        }
    }
}

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
            ItemKind::Minimize(word) => {
                self.settings.objective = Some(self.objective(word)?);
                Err(self.report(messages::unsupported("`minimize`", span)))
            }
            _ => Ok(()),
        }
    }

    fn objective(&mut self, word: &Name) -> Result<ir::Objective, Reported> {
        match word.text.as_str() {
            "effort" => Ok(ir::Objective::Effort),
            "length" => Ok(ir::Objective::Length),
            _ => Err(self.report(messages::unknown_objective(word))),
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

    /// Looks at what several declarations say together: one step for all models in use, some base.
    pub(super) fn cross_settings(&mut self) {
        self.common_step();
        self.resolve_every();
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
