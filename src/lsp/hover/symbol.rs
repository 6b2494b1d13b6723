//! Names of the mission, kind by kind.

use super::{Page, View};
use crate::check::{Facts, Known, typed};
use crate::entity::EntityId;
use crate::exact::Rational;
use crate::lsp::index::{Occurrence, Symbol, SymbolId, SymbolKind};
use crate::lsp::number;
use crate::quantity::Unit;
use crate::source::Span;
use crate::syntax::ast::{DynamicsKind, Expr, ExprKind, Item, ItemKind};
use crate::syntax::glossary;

/// The most names that are listed.
const MOST_NAMES: usize = 8;
/// The most rows of a table that are shown.
const MOST_ROWS: usize = 8;
/// The most entries of a row that are shown.
const MOST_ENTRIES: usize = 8;

impl View<'_> {
    /// What is said about a name.
    pub(super) fn symbol(&self, occurrence: &Occurrence) -> String {
        let index = self.document.index();
        let symbol = index.symbol(occurrence.symbol);
        let mut page = Page::default();
        page.code(&self.declaration(symbol));
        let facts = self.document.facts();
        match (facts, symbol.item) {
            (Some(facts), Some(item)) => {
                let member = self.member(occurrence, facts);
                self.facts_of(&mut page, occurrence.symbol, facts, item, member.as_deref());
            }
            _ => page.say(format!("**{}**", symbol.kind.noun())),
        }
        page.doc(symbol.doc.as_deref());
        page.markdown()
    }

    /// The declaration's text; of a block, its first line.
    fn declaration(&self, symbol: &Symbol) -> String {
        let text = self.text(symbol.declaration);
        let head = match symbol.kind {
            SymbolKind::Dynamics => text.split('{').next().map(|head| format!("{}{{ … }}", with_blank(head))),
            SymbolKind::RobotVariable | SymbolKind::IndexVariable => Some(self.bound(symbol)),
            _ => None,
        };
        head.unwrap_or_else(|| text.to_string())
    }

    /// `r in fleet`, `i in 1..n`: from the variable to the end of its set or range.
    fn bound(&self, symbol: &Symbol) -> String {
        let rest = Span { start: symbol.place.start, end: symbol.declaration.end };
        let (mut depth, text) = (0usize, self.text(rest));
        let ends = |c: char, depth: &mut usize| match c {
            '[' | '(' => {
                *depth += 1;
                false
            }
            ']' | ')' if *depth > 0 => {
                *depth -= 1;
                false
            }
            ']' | ')' | ':' => true,
            ',' => *depth == 0 && symbol.kind == SymbolKind::IndexVariable,
            _ => false,
        };
        let end = text.char_indices().find(|(_, c)| ends(*c, &mut depth)).map_or(text.len(), |(i, _)| i);
        text[..end].trim_end().to_string()
    }

    /// The member of a family that stands at a name, `cell[1,2]`, where it is always the same.
    fn member(&self, occurrence: &Occurrence, facts: &Facts) -> Option<String> {
        if occurrence.is_declaration() {
            return None;
        }
        let text = &self.document.source.text;
        let behind = text.get(occurrence.span.end as usize..)?;
        let inside = behind.trim_start().strip_prefix('[')?;
        let start = occurrence.span.end as usize + behind.len() - inside.len();
        let mut depth = 0usize;
        let closes = |c: char| {
            match c {
                '(' | '[' => depth += 1,
                ')' | ']' if depth > 0 => depth -= 1,
                ']' => return true,
                _ => {}
            }
            false
        };
        let list = inside.get(..inside.find(closes)?)?;
        let mut at = start;
        let index = |written: &str| {
            let from = at + written.len() - written.trim_start().len();
            at += written.len() + 1;
            let values = facts.place(Span::new(from, from + written.trim().len()))?;
            let [only] = &values.listed[..] else { return None };
            (!values.more).then(|| only.to_string())
        };
        let indices: Option<Vec<String>> = list.split(',').map(index).collect();
        Some(format!("{}[{}]", self.text(occurrence.span), indices?.join(",")))
    }

    fn facts_of(&self, page: &mut Page, id: SymbolId, facts: &Facts, item: usize, member: Option<&str>) {
        let symbol = self.document.index().symbol(id);
        match symbol.kind {
            SymbolKind::Parameter | SymbolKind::Constant => self.constant(page, symbol, facts, item),
            SymbolKind::Region | SymbolKind::Obstacle | SymbolKind::Jammer => {
                self.set(page, symbol, facts, item, member);
            }
            SymbolKind::Base => self.base(page, facts, item, member),
            SymbolKind::Dynamics => self.model(page, facts, item),
            SymbolKind::Robot => self.robot(page, facts, item, member),
            SymbolKind::Team => team(page, facts, item),
            SymbolKind::Goal | SymbolKind::Define => self.formula(page, symbol, facts, item),
            SymbolKind::State | SymbolKind::Input => self.signal(page, symbol, facts, item),
            SymbolKind::Matrix | SymbolKind::Mode => self.part(page, symbol, facts, item),
            SymbolKind::Mission => page.say("**mission**: the name that plans and files bear."),
            SymbolKind::IndexVariable => self.variable(page, symbol, facts),
            SymbolKind::RobotVariable => {
                let uses = self.document.index().occurrences_of(id).count().saturating_sub(1);
                page.say(format!("**robot variable**, used {}", times(uses)));
            }
        }
    }

    fn constant(&self, page: &mut Page, symbol: &Symbol, facts: &Facts, item: usize) {
        let hint = if symbol.kind == SymbolKind::Parameter {
            format!("; `--set {}=…` gives it another value", symbol.name)
        } else {
            String::new()
        };
        let Some(known) = facts.constant(item) else {
            page.say(format!("**{}** without a value{hint}", symbol.kind.noun()));
            return;
        };
        let what = match known {
            Known::Scalar(quantity) if quantity.dimension.is_bare() => "a number".to_string(),
            Known::Scalar(quantity) => quantity.dimension.describe(),
            Known::Table(_) => String::new(),
        };
        let separator = if what.is_empty() { "" } else { " · " };
        let other = self.in_written_unit(item, known).map_or_else(String::new, |text| format!(" = `{text}`"));
        let value = match known {
            Known::Scalar(_) => format!("`{}`{other}", number::equals(&number::known(known))),
            Known::Table(_) => number::known(known),
        };
        page.say(format!("**{}** · {what}{separator}{value}{hint}", symbol.kind.noun()));
        if let Known::Table(rows) = known {
            let shown = rows.iter().take(MOST_ROWS).map(|row| {
                let mut cells: Vec<String> =
                    row.iter().take(MOST_ENTRIES).map(|q| number::number(&q.number)).collect();
                cells.extend((row.len() > MOST_ENTRIES).then(|| "…".to_string()));
                cells
            });
            let mut shown: Vec<Vec<String>> = shown.collect();
            shown.extend((rows.len() > MOST_ROWS).then(|| vec!["…".to_string()]));
            page.columns(&shown);
        }
    }

    /// A constant's value in the unit that its expression is written in, where that isn't SI.
    fn in_written_unit(&self, item: usize, known: &Known) -> Option<String> {
        let Known::Scalar(quantity) = known else { return None };
        let item: &Item = self.document.file()?.items.get(item)?;
        let (ItemKind::Param { value, .. } | ItemKind::Let { value, .. }) = &item.kind else { return None };
        let written = last_unit(value)?;
        let unit = Unit::from_factors(&written.factors).ok()?;
        let differs = !unit.is_coherent() && unit.dimension == quantity.dimension;
        let text = self.text(written.span);
        differs.then(|| format!("{} {text}", number::number(&(&quantity.number / &unit.scale))))
    }

    fn base(&self, page: &mut Page, facts: &Facts, item: usize, member: Option<&str>) {
        let places: Vec<String> = facts
            .bases(Some(item))
            .filter(|(_, b)| member.is_none_or(|member| member == b.name))
            .map(|(_, b)| format!("`{}` at {}", b.name, number::point(&b.position)))
            .collect();
        page.say(format!("**base station**{}", family(facts, item, "base")));
        page.say(list(&places));
    }

    fn robot(&self, page: &mut Page, facts: &Facts, item: usize, member: Option<&str>) {
        page.say(format!("**robot**{}", family(facts, item, "robot")));
        let mut model = None;
        let mut starts = Vec::new();
        let wanted = |name: &str| member.is_none_or(|member| member == name);
        for (_, robot) in facts.robots(Some(item)).filter(|(_, r)| wanted(&r.name)) {
            let Some(dynamics) = facts.dynamics().get(robot.dynamics) else { continue };
            model = Some(robot.dynamics);
            let at: Vec<_> = dynamics.position.iter().filter_map(|&s| robot.start.get(s).cloned()).collect();
            let moving = dynamics.states.iter().zip(&robot.start).enumerate();
            let moving = moving.filter(|(i, (_, value))| !dynamics.position.contains(i) && !value.is_zero());
            let rest: Vec<String> = moving
                .map(|(_, (state, value))| {
                    format!(", {} = {} {}", state.name, number::number(value), state.unit)
                })
                .collect();
            starts.push(format!("`{}` starts at {}{}", robot.name, number::point(&at), rest.join("")));
        }
        page.say(list(&starts));
        if let Some(tube) = model.and_then(|id| self.tubes.of(facts, id, self.document.float())) {
            page.say(format!("Model `{}`{}", facts_name(facts, model), super::model::summary(&tube)));
        }
    }

    fn formula(&self, page: &mut Page, symbol: &Symbol, facts: &Facts, item: usize) {
        let Some(root) = facts.root(item) else {
            page.say(format!("**{}** that has errors", symbol.kind.noun()));
            return;
        };
        let (robots, regions) = facts.concerned(root);
        let names = |places: &[usize], all: &dyn Fn(usize) -> Option<String>| -> Vec<String> {
            places.iter().filter_map(|&place| all(place)).collect()
        };
        let robot = |place: usize| Some(format!("`{}`", facts.robot(place)?.name));
        let region = |place: usize| Some(format!("`{}`", facts.region(place)?.name));
        let (robots, regions) = (names(&robots, &robot), names(&regions, &region));
        let about = if robots.is_empty() {
            "speaks of no robot".to_string()
        } else {
            format!("speaks of {} in {}", list(&robots), list(&regions))
        };
        page.say(format!("**{}**: {about}", symbol.kind.noun()));
        let step =
            facts.step.as_ref().map_or_else(String::new, |s| format!(" (a step is {} s)", number::number(s)));
        let windows: Vec<String> = facts
            .steps_in(symbol.declaration)
            .map(|(span, steps)| format!("`{}`: steps {}", self.text(span), number::steps(steps)))
            .collect();
        if !windows.is_empty() {
            page.say(format!("Windows{step}: {}", list(&windows)));
        }
    }

    fn part(&self, page: &mut Page, symbol: &Symbol, facts: &Facts, item: usize) {
        let index = self.document.index();
        let owner = symbol.parent.map(|id| index.symbol(id));
        let of = owner.map_or_else(String::new, |owner| format!(" of `{}`", owner.name));
        page.say(format!("**{}**{of}", symbol.kind.noun()));
        let word = if symbol.kind == SymbolKind::Mode { "mode" } else { symbol.name.as_str() };
        page.say(glossary::entry(word).map_or("", |entry| entry.meaning));
        if owner.is_some_and(|owner| owner.kind == SymbolKind::Dynamics) {
            self.held(page, symbol, facts, item);
        }
    }

    /// What a matrix of a `continuous` model becomes over a step.
    fn held(&self, page: &mut Page, symbol: &Symbol, facts: &Facts, item: usize) {
        let items = match self.document.file().and_then(|file| file.items.get(item)).map(|item| &item.kind) {
            Some(ItemKind::Dynamics { items, .. }) => items,
            _ => return,
        };
        let continuous = items.iter().any(|item| matches!(item.kind, DynamicsKind::Continuous));
        let Some((_, model)) = facts.model(item).filter(|_| continuous) else { return };
        let typed::Motion::Matrices { a, b, c, .. } = &model.motion else { return };
        let column: Vec<Vec<Rational>> = c.iter().map(|x| vec![x.clone()]).collect();
        let rows = match symbol.name.as_str() {
            "A" => a,
            "B" => b,
            _ => &column,
        };
        page.say(format!("Held over a step of {} s:", number::number(&model.step)));
        let row = |row: &Vec<Rational>| {
            row.iter().take(MOST_ENTRIES).map(|x| number::measure(x.to_f64())).collect()
        };
        page.columns(&rows.iter().take(MOST_ROWS).map(row).collect::<Vec<_>>());
    }

    fn variable(&self, page: &mut Page, symbol: &Symbol, facts: &Facts) {
        let text = self.bound(symbol);
        let range = text.split_once(" in ").map_or("", |(_, range)| range);
        let start = symbol.place.start as usize + text.len() - range.len();
        let ends: Vec<String> = range
            .split("..")
            .scan(start, |at, end| {
                let lead = end.len() - end.trim_start().len();
                let from = *at + lead;
                *at += end.len() + 2;
                Some(facts.place(Span::new(from, from + end.trim().len())).map(number::values))
            })
            .flatten()
            .collect();
        let shown = if ends.len() == 2 { format!(" from {} to {}", ends[0], ends[1]) } else { String::new() };
        page.say(format!("**index**{shown}"));
    }
}

fn team(page: &mut Page, facts: &Facts, item: usize) {
    let Some(team) = facts.team(item) else {
        page.say("**team** that has errors");
        return;
    };
    let names: Vec<String> =
        team.iter().filter_map(|id| Some(format!("`{}`", facts.robot(id.index())?.name))).collect();
    page.say(format!("**team** of {}: {}", number::counted(team.len(), "robot"), list(&names)));
}

/// ` family of 4 robots`, nothing for a single one.
pub(super) fn family(facts: &Facts, item: usize, noun: &str) -> String {
    match facts.members(item) {
        Some(members) if members.is_family => {
            format!(" family of {}", number::counted(members.places.len(), noun))
        }
        _ => String::new(),
    }
}

fn facts_name(facts: &Facts, id: Option<crate::check::typed::DynamicsId>) -> &str {
    id.and_then(|id| facts.dynamics().get(id)).map_or("", |model| &model.name)
}

/// The first of some things, and how many more there are.
pub(super) fn list(names: &[String]) -> String {
    let shown = names.iter().take(MOST_NAMES).cloned().collect::<Vec<_>>().join(", ");
    match names.len().saturating_sub(MOST_NAMES) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

fn times(count: usize) -> String {
    if count == 1 { "once".into() } else { format!("{count} times") }
}

fn with_blank(head: &str) -> String {
    format!("{} ", head.trim_end())
}

/// The last unit that is written in an expression.
fn last_unit(expr: &Expr) -> Option<&crate::syntax::ast::Unit> {
    let mut stack = vec![expr];
    while let Some(expr) = stack.pop() {
        match &expr.kind {
            ExprKind::WithUnit(_, unit) => return Some(unit),
            ExprKind::Negate(inner) | ExprKind::Parenthesised(inner) => stack.push(inner),
            ExprKind::Binary { left, right, .. } => stack.extend([&**left, &**right]),
            ExprKind::Call { arguments, .. } => stack.extend(arguments),
            ExprKind::Number(_) | ExprKind::Name(_) | ExprKind::Table(_) => {}
        }
    }
    None
}
