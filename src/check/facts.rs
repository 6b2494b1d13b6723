//! What the check finds out, kept for those who ask about single places: editors.
//!
//! The check goes on after an error with what is known, and so do these facts: a declaration that is
//! wrong has none, the others have theirs. Numbers are exact and SI.

use std::collections::BTreeMap;

use crate::check::constants::Constant;
use crate::check::expression::Value;
use crate::check::{Checker, Entry, typed};
use crate::diag::{Diagnostics, Reported};
use crate::entity::{EntityId, Table};
use crate::exact::Rational;
use crate::ir::{Connectivity, RobotId};
use crate::quantity::Dimension;
use crate::source::{SourceFile, Span};
use crate::syntax::ast::{self, Expr, ExprKind, ItemKind};

/// The most different values of one expression, or windows of one operator, that are listed.
const MOST_LISTED: usize = 8;

/// A number with what it measures.
#[derive(Clone, PartialEq, Debug)]
pub struct Quantity {
    /// In coherent SI units.
    pub number: Rational,
    /// What it measures.
    pub dimension: Dimension,
}

/// The value of a `param` or a `let`.
#[derive(Clone, PartialEq, Debug)]
pub enum Known {
    /// A number.
    Scalar(Quantity),
    /// The rows of a table, all of the same length.
    Table(Vec<Vec<Quantity>>),
}

/// The values of an expression: one, or several where it stands in a family's or a quantifier's scope.
#[derive(Clone, PartialEq, Debug)]
pub struct Values {
    /// What they measure.
    pub dimension: Dimension,
    /// The first different ones in the order in which they were found, in coherent SI units.
    pub listed: Vec<Rational>,
    /// Whether there are more.
    pub more: bool,
    /// The least of all.
    pub least: Rational,
    /// The greatest of all.
    pub most: Rational,
}

/// The steps of a window or a time: one pair, or several where it stands in a quantifier's scope.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Steps {
    /// The first different ones, bounds included.
    pub listed: Vec<(u32, u32)>,
    /// Whether there are more.
    pub more: bool,
}

/// The members of a declaration that may declare a family.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Members {
    /// The places of the members in their table.
    pub places: std::ops::Range<usize>,
    /// Whether it was declared with indices.
    pub is_family: bool,
}

/// What is noted while expressions and windows are looked at.
#[derive(Default)]
pub(super) struct Notes {
    values: BTreeMap<Span, Values>,
    places: BTreeMap<Span, Values>,
    steps: BTreeMap<Span, Steps>,
}

/// What the check found out about a mission, in parts where the mission has errors.
///
/// Declarations are known by their place in [`ast::File::items`].
#[derive(Clone, Default, Debug)]
pub struct Facts {
    /// 2 or 3.
    pub dimension: usize,
    /// 𝒲.
    pub workspace: Option<typed::Workspace>,
    /// The sampling time that all models in use share, in seconds.
    pub step: Option<Rational>,
    /// ε in metres.
    pub separation: Option<Rational>,
    /// What links are asked; `None` with `connectivity none`.
    pub connectivity: Option<Connectivity>,
    /// The lengths that may be tried.
    pub horizon: (usize, usize),
    values: BTreeMap<Span, Values>,
    places: BTreeMap<Span, Values>,
    steps: BTreeMap<Span, Steps>,
    constants: BTreeMap<usize, Known>,
    members: BTreeMap<usize, Members>,
    models: BTreeMap<usize, typed::DynamicsId>,
    teams: BTreeMap<usize, Vec<RobotId>>,
    roots: BTreeMap<usize, typed::FormulaId>,
    regions: Vec<Option<typed::Region>>,
    blockers: Vec<Option<typed::Blocker>>,
    bases: Vec<Option<typed::Base>>,
    robots: Vec<Option<typed::Robot>>,
    dynamics: Table<typed::DynamicsId, typed::Dynamics>,
    formulas: Table<typed::FormulaId, typed::Formula>,
}

/// As [`check`](super::check), with all that was found out, also where the mission has errors.
pub fn check_with_facts(
    file: &ast::File,
    source: &SourceFile,
    set: &[(String, String)],
    diagnostics: &mut Diagnostics,
) -> (Result<typed::Mission, Reported>, Facts) {
    let earlier = diagnostics.or_reported();
    let mut checker = Checker::new(file, source, diagnostics);
    checker.notes = Some(Box::default());
    checker.run(set);
    let facts = checker.facts();
    (earlier.and_then(|()| checker.finish(set)), facts)
}

impl Checker<'_> {
    /// Notes the value of an expression that is not just a number.
    pub(super) fn note_value(&mut self, expr: &Expr, value: &Value) {
        let Some(notes) = &mut self.notes else { return };
        let is_plain = |expr: &Expr| matches!(expr.kind, ExprKind::Number(_) | ExprKind::Parenthesised(_));
        let plain = is_plain(expr) || matches!(&expr.kind, ExprKind::WithUnit(inner, _) if is_plain(inner));
        if !plain && value.slopes.is_empty() {
            note(&mut notes.values, expr.span, &value.number, value.dimension);
        }
    }

    /// Notes the value that a whole expression gives its place, in the unit that is expected there.
    pub(super) fn note_place(&mut self, span: Span, number: &Rational, dimension: Dimension) {
        if let Some(notes) = &mut self.notes {
            note(&mut notes.places, span, number, dimension);
        }
    }

    /// Notes the steps of a window or a time.
    pub(super) fn note_steps(&mut self, span: Span, window: (u32, u32)) {
        let Some(notes) = &mut self.notes else { return };
        let steps = notes.steps.entry(span).or_insert(Steps { listed: Vec::new(), more: false });
        if !steps.listed.contains(&window) {
            if steps.listed.len() < MOST_LISTED { steps.listed.push(window) } else { steps.more = true }
        }
    }

    /// Everything that is known at the end of a check.
    fn facts(&mut self) -> Facts {
        let notes = self.notes.take().unwrap_or_default();
        let settings = &self.settings;
        let mut facts = Facts {
            dimension: self.dimension,
            workspace: self.workspace.as_ref().and_then(|w| w.as_ref().ok()).cloned(),
            step: settings.step.clone(),
            separation: settings.separation.as_ref().map(|s| s.0.clone()),
            connectivity: settings.connectivity.clone(),
            horizon: settings.horizon,
            values: notes.values,
            places: notes.places,
            steps: notes.steps,
            regions: self.regions.clone(),
            blockers: self.blockers.clone(),
            bases: self.bases.clone(),
            robots: self.robots.clone(),
            dynamics: self.dynamics.clone(),
            formulas: self.formulas.clone(),
            ..Facts::default()
        };
        for (item, entry) in self.entries.iter().enumerate() {
            facts.keep(item, entry);
        }
        let goals: BTreeMap<Span, typed::FormulaId> =
            self.goals.iter().map(|g| (g.span, g.formula)).collect();
        for (item, declaration) in self.file.items.iter().enumerate() {
            if let (ItemKind::Goal { .. }, Some(&root)) = (&declaration.kind, goals.get(&declaration.span)) {
                facts.roots.insert(item, root);
            }
        }
        facts
    }
}

impl Facts {
    fn keep(&mut self, item: usize, entry: &Entry) {
        match entry {
            Entry::Constant(Ok(constant)) => {
                self.constants.insert(item, known(constant));
            }
            Entry::Family(Ok(family)) => {
                let members = Members { places: family.ids(), is_family: !family.is_single() };
                self.members.insert(item, members);
            }
            Entry::Dynamics(Ok(model)) => {
                self.models.insert(item, *model);
            }
            Entry::Team(Ok(robots)) => {
                self.teams.insert(item, robots.clone());
            }
            Entry::Formula(Ok(root)) => {
                self.roots.insert(item, *root);
            }
            _ => {}
        }
    }

    /// The value of a `param` or a `let`.
    pub fn constant(&self, item: usize) -> Option<&Known> {
        self.constants.get(&item)
    }

    /// The values of an expression or a part of one, by its place; not of plain numbers.
    pub fn value(&self, span: Span) -> Option<&Values> {
        self.values.get(&span)
    }

    /// The values that a whole expression gives its place, in the unit that is expected there.
    pub fn place(&self, span: Span) -> Option<&Values> {
        self.places.get(&span)
    }

    /// All values of parts of expressions in a range, in the order of their places.
    pub fn values_in(&self, range: Span) -> impl Iterator<Item = (Span, &Values)> {
        inside(&self.values, range)
    }

    /// The steps of a window, or of `every`, by its place.
    pub fn steps(&self, span: Span) -> Option<&Steps> {
        self.steps.get(&span)
    }

    /// All windows in a range with their steps, in the order of their places.
    pub fn steps_in(&self, range: Span) -> impl Iterator<Item = (Span, &Steps)> {
        inside(&self.steps, range)
    }

    /// The members of a region, obstacle, jammer, base or robot.
    pub fn members(&self, item: usize) -> Option<&Members> {
        self.members.get(&item)
    }

    /// The robots of a team, each once.
    pub fn team(&self, item: usize) -> Option<&[RobotId]> {
        self.teams.get(&item).map(Vec::as_slice)
    }

    /// The motion model that an item declares.
    pub fn model(&self, item: usize) -> Option<(typed::DynamicsId, &typed::Dynamics)> {
        let id = *self.models.get(&item)?;
        Some((id, self.dynamics.get(id)?))
    }

    /// All motion models that are right, in the order of their declarations.
    pub fn dynamics(&self) -> &Table<typed::DynamicsId, typed::Dynamics> {
        &self.dynamics
    }

    /// The formula of a goal or a `define`.
    pub fn root(&self, item: usize) -> Option<typed::FormulaId> {
        self.roots.get(&item).copied()
    }

    /// All formulas, operands before their users.
    pub fn formulas(&self) -> &Table<typed::FormulaId, typed::Formula> {
        &self.formulas
    }

    /// The regions that are right, of an item or of all; with their places.
    pub fn regions(&self, item: Option<usize>) -> impl Iterator<Item = (usize, &typed::Region)> {
        self.some(&self.regions, item)
    }

    /// A region by its place in the table.
    pub fn region(&self, place: usize) -> Option<&typed::Region> {
        self.regions.get(place)?.as_ref()
    }

    /// A robot by its place in the table.
    pub fn robot(&self, place: usize) -> Option<&typed::Robot> {
        self.robots.get(place)?.as_ref()
    }

    /// The obstacles and jammers that are right, of an item or of all.
    pub fn blockers(&self, item: Option<usize>) -> impl Iterator<Item = (usize, &typed::Blocker)> {
        self.some(&self.blockers, item)
    }

    /// The bases that are right, of an item or of all.
    pub fn bases(&self, item: Option<usize>) -> impl Iterator<Item = (usize, &typed::Base)> {
        self.some(&self.bases, item)
    }

    /// The robots that are right, of an item or of all.
    pub fn robots(&self, item: Option<usize>) -> impl Iterator<Item = (usize, &typed::Robot)> {
        self.some(&self.robots, item)
    }

    fn some<'f, T>(
        &self,
        table: &'f [Option<T>],
        item: Option<usize>,
    ) -> impl Iterator<Item = (usize, &'f T)> + use<'f, T> {
        let range = match item {
            None => 0..table.len(),
            Some(item) => self.members.get(&item).map_or(0..0, |members| members.places.clone()),
        };
        range.filter_map(|place| Some((place, table.get(place)?.as_ref()?)))
    }

    /// The robots and regions that a formula speaks of, each once, in the order of their tables.
    pub fn concerned(&self, root: typed::FormulaId) -> (Vec<usize>, Vec<usize>) {
        let mut seen = vec![false; self.formulas.len()];
        let mut robots = vec![false; self.robots.len()];
        let mut regions = vec![false; self.regions.len()];
        let mut open = vec![root];
        while let Some(id) = open.pop() {
            let Some(formula) = self.formulas.get(id) else { continue };
            if std::mem::replace(&mut seen[id.index()], true) {
                continue;
            }
            for atom in atoms(formula) {
                robots[atom.robot.index()] = true;
                regions[atom.region.index()] = true;
            }
            open.extend(operands(formula));
        }
        let places =
            |marks: Vec<bool>| marks.iter().enumerate().filter(|(_, m)| **m).map(|(i, _)| i).collect();
        (places(robots), places(regions))
    }
}

fn note(values: &mut BTreeMap<Span, Values>, span: Span, number: &Rational, dimension: Dimension) {
    let fresh =
        || Values { dimension, listed: Vec::new(), more: false, least: number.clone(), most: number.clone() };
    let values = values.entry(span).or_insert_with(fresh);
    if values.listed.contains(number) {
        return;
    }
    if values.listed.len() < MOST_LISTED {
        values.listed.push(number.clone())
    } else {
        values.more = true
    }
    if *number < values.least {
        values.least = number.clone();
    }
    if *number > values.most {
        values.most = number.clone();
    }
}

/// The entries of a map whose places lie in a range.
fn inside<T>(map: &BTreeMap<Span, T>, range: Span) -> impl Iterator<Item = (Span, &T)> {
    let from = Span { start: range.start, end: 0 };
    let entries = map.range(from..).take_while(move |(span, _)| span.start < range.end);
    entries.filter(move |(span, _)| span.end <= range.end).map(|(span, value)| (*span, value))
}

fn known(constant: &Constant) -> Known {
    let quantity = |v: &Value| Quantity { number: v.number.clone(), dimension: v.dimension };
    match constant {
        Constant::Scalar(value) => Known::Scalar(quantity(value)),
        Constant::Table(rows) => {
            Known::Table(rows.iter().map(|row| row.iter().map(quantity).collect()).collect())
        }
    }
}

fn atoms(formula: &typed::Formula) -> Vec<crate::ir::Atom> {
    match formula {
        typed::Formula::In(atom) => vec![*atom],
        typed::Formula::Compare { terms, .. } => terms.iter().map(|(atom, _)| *atom).collect(),
        _ => Vec::new(),
    }
}

fn operands(formula: &typed::Formula) -> Vec<typed::FormulaId> {
    use typed::Formula::{
        Always, And, Compare, Constant, Eventually, Iff, Implies, In, Next, Not, Or, Release, StrongRelease,
        Until, WeakUntil,
    };
    match formula {
        Constant(_) | In(_) | Compare { .. } => Vec::new(),
        Not(a) | Next(a) | Always(_, a) | Eventually(_, a) => vec![*a],
        And(list) | Or(list) => list.clone(),
        Implies(a, b) | Iff(a, b) => vec![*a, *b],
        Until(_, a, b) | Release(_, a, b) | WeakUntil(_, a, b) | StrongRelease(_, a, b) => vec![*a, *b],
    }
}

#[cfg(test)]
mod tests;
