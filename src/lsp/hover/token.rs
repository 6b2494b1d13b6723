//! Words, numbers, units and operators.

use super::{Page, View};
use crate::lsp::index::Builtin;
use crate::lsp::number;
use crate::quantity::Unit;
use crate::source::Span;
use crate::syntax::ast::{ExprKind, Item, ItemKind};
use crate::syntax::glossary;
use crate::syntax::parse_expression;
use crate::syntax::token::{Kind, Token, tokens};

impl View<'_> {
    /// What is said about the token at an offset that is no name of the mission.
    pub(super) fn token(&self, offset: u32) -> Option<(Span, String)> {
        let (base, piece) = self.piece(offset);
        let tokens = tokens(piece);
        let at = offset as usize - base;
        let touches = |t: &Token<'_>| t.start <= at && at <= t.end && !t.is_comment();
        // Where two tokens meet, the one that begins there, unless only the other one is known.
        let mut candidates: Vec<usize> = (0..tokens.len()).filter(|&i| touches(&tokens[i])).collect();
        candidates.reverse();
        candidates.into_iter().find_map(|i| {
            let token = &tokens[i];
            let span = Span::new(base + token.start, base + token.end);
            let text = match token.kind {
                Kind::Number => self.number(span, tokens.get(i + 1).filter(|t| t.kind == Kind::Unit), base),
                Kind::Unit => unit(token.text),
                Kind::Word => self.word(span, token.text),
                Kind::Sign => self.sign(span, token.text),
                _ => None,
            };
            Some((span, text?))
        })
    }

    /// The declaration, or the text between two, that an offset stands in, with its beginning.
    fn piece(&self, offset: u32) -> (usize, &str) {
        let text = &self.document.source.text;
        let items = self.document.file().map_or(&[][..], |file| &file.items);
        let after = items.partition_point(|item| item.span.start <= offset);
        let start = after.checked_sub(1).map_or(0, |i| items[i].span.start as usize);
        let end = items.get(after).map_or(text.len(), |item| item.span.start as usize);
        (start, text.get(start..end).unwrap_or(""))
    }

    fn item(&self, offset: u32) -> Option<&Item> {
        let items = &self.document.file()?.items;
        let after = items.partition_point(|item| item.span.start <= offset);
        items.get(after.checked_sub(1)?).filter(|item| offset <= item.span.end)
    }

    fn word(&self, span: Span, word: &str) -> Option<String> {
        let index = self.document.index();
        if index.unresolved().binary_search(&span).is_ok() {
            return None;
        }
        let mut page = Page::default();
        if word == "workspace" {
            self.workspace().into_iter().for_each(|text| page.say(text));
        }
        if let Some((_, Builtin::Coordinate)) = index.builtin_at(span.start) {
            page.say(format!("**coordinate** `{word}`{}", self.extent(word)));
        }
        let entry = glossary::entry(word)?;
        page.say(entry.meaning);
        page.code(entry.example);
        Some(page.markdown())
    }

    /// How large the workspace is.
    fn workspace(&self) -> Option<String> {
        let (lo, hi) = self.document.facts()?.workspace.as_ref()?.polytope.bounding_box();
        let (from, to) = (number::point(&lo), number::point(&hi));
        Some(format!("**workspace** {from} .. {to}: {}", number::size(&lo, &hi)))
    }

    /// Between what a coordinate lies in the workspace.
    fn extent(&self, word: &str) -> String {
        let axis = ["x", "y", "z"].iter().position(|a| *a == word);
        let workspace = self.document.facts().and_then(|facts| facts.workspace.as_ref());
        let ends = workspace.zip(axis).and_then(|(workspace, axis)| {
            let (lo, hi) = workspace.polytope.bounding_box();
            Some(format!(
                ", from {} to {} m in the workspace",
                number::number(lo.get(axis)?),
                number::number(hi.get(axis)?)
            ))
        });
        ends.unwrap_or_default()
    }

    /// An operator, with the value of what it makes.
    fn sign(&self, span: Span, sign: &str) -> Option<String> {
        // Behind a declared name it says nothing.
        let compares = |item: &Item| matches!(item.kind, ItemKind::Goal { .. } | ItemKind::Define { .. });
        let entry =
            glossary::entry(sign).filter(|_| sign != "=" || self.item(span.start).is_some_and(compares))?;
        let mut page = Page::default();
        if let Some((whole, values)) = self.computed(span) {
            page.code(self.text(whole));
            page.say(format!("`{}`", number::equals(&number::values(values))));
        }
        page.say(entry.meaning);
        Some(page.markdown())
    }

    /// The least expression around an operator whose value was computed.
    fn computed(&self, span: Span) -> Option<(Span, &crate::check::Values)> {
        let item = self.item(span.start)?;
        let around = self.document.facts()?.values_in(item.span);
        let holds = around.filter(|(whole, _)| whole.start < span.start && span.end < whole.end);
        holds.min_by_key(|(whole, _)| whole.end - whole.start)
    }

    /// A number: what it is in SI, and what its place makes of it.
    fn number(&self, span: Span, unit: Option<&Token<'_>>, base: usize) -> Option<String> {
        let whole = unit.map_or(span, |unit| Span::new(span.start as usize, base + unit.end));
        let mut page = Page::default();
        let facts = self.document.facts();
        let place = facts.and_then(|facts| facts.place(whole).or_else(|| facts.place(span)));
        let written = self.text(whole);
        let si = match place {
            Some(values) => number::values(values),
            None => in_si(written)?,
        };
        if si != written {
            page.say(format!("`{written}` = `{si}`"));
        }
        if let Some(steps) = self.window(span) {
            page.say(steps);
        }
        (!page.paragraphs.is_empty()).then(|| page.markdown())
    }

    /// The steps of the window that a place stands in.
    fn window(&self, span: Span) -> Option<String> {
        let (item, facts) = (self.item(span.start)?, self.document.facts()?);
        let mut windows = facts.steps_in(item.span);
        let (whole, steps) = windows.find(|(w, _)| w.start <= span.start && span.end <= w.end)?;
        Some(format!("`{}`: steps {}", self.text(whole), number::steps(steps)))
    }
}

/// A number with its unit in SI, where that says more.
fn in_si(written: &str) -> Option<String> {
    let expr = parse_expression(written).ok()?;
    let ExprKind::WithUnit(inner, unit) = &expr.kind else { return None };
    let ExprKind::Number(value) = &inner.kind else { return None };
    let unit = Unit::from_factors(&unit.factors).ok()?;
    Some(number::quantity(&(value * &unit.scale), unit.dimension))
}

/// A unit: what it measures and what it is in SI, symbol by symbol.
fn unit(written: &str) -> Option<String> {
    let expr = parse_expression(&format!("1 {written}")).ok();
    let mut page = Page::default();
    if let Some(ExprKind::WithUnit(_, parsed)) = expr.map(|e| e.kind)
        && let Ok(unit) = Unit::from_factors(&parsed.factors)
        && !written.bytes().all(|b| b.is_ascii_alphabetic())
    {
        page.say(if unit.is_coherent() {
            format!("`{written}`: {}, SI", unit.dimension.describe())
        } else {
            format!("`{written}` = `{}`", number::quantity(&unit.scale, unit.dimension))
        });
    }
    let mut symbols: Vec<&str> =
        written.split(|c: char| !c.is_ascii_alphabetic()).filter(|s| !s.is_empty()).collect();
    symbols.dedup();
    for entry in symbols.into_iter().filter_map(glossary::entry) {
        // What `min` says as a function is of no use behind a number.
        let meaning = if entry.word == "min" { "Minute: 60 s." } else { entry.meaning };
        page.say(format!("`{}`: {meaning}", entry.word));
    }
    (!page.paragraphs.is_empty()).then(|| page.markdown())
}
