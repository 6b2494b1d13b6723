//! What all parts of the tree's construction share: places, units read so far, errors.

use crate::diag::Diagnostic;
use crate::source::Span;
use crate::syntax::ast::Doc;
use crate::syntax::climb::TooDeep;
use crate::syntax::condensed::Condensed;
use crate::syntax::docs::Docs;
use crate::syntax::error;
use crate::syntax::grammar::{Built, Node, Stop};

/// Builds the tree of one declaration.
pub(super) struct Builder<'a> {
    source: &'a str,
    condensed: &'a Condensed,
    /// Where the text that pest saw begins in the condensed text.
    base: usize,
    docs: &'a mut Docs,
    /// The units read, in order.
    units: Vec<Span>,
    /// What is wrong.
    pub(super) errors: Vec<Diagnostic>,
}

impl<'a> Builder<'a> {
    /// A builder for the stretch of the condensed text that begins at `base`.
    pub(super) fn new(
        source: &'a str,
        condensed: &'a Condensed,
        base: usize,
        docs: &'a mut Docs,
    ) -> Builder<'a> {
        Builder { source, condensed, base, docs, units: Vec::new(), errors: Vec::new() }
    }

    /// A node's place in the source.
    pub(super) fn span(&self, node: &Node) -> Span {
        let span = node.as_span();
        self.place(span.start(), span.end())
    }

    /// The place in the source of a part of the text that pest saw.
    pub(super) fn place(&self, start: usize, end: usize) -> Span {
        self.condensed.span(self.base + start, self.base + end, self.source)
    }

    /// The end of what stands before a place of the text that pest saw.
    pub(super) fn end_before(&self, position: usize) -> u32 {
        let end = (self.base + position).min(self.condensed.text().len());
        let kept = self.condensed.text().get(..end).unwrap_or("").trim_end().len();
        self.condensed.span(kept.saturating_sub(1), kept, self.source).end
    }

    /// The documentation before a node.
    pub(super) fn doc(&mut self, node: &Node) -> Option<Doc> {
        self.docs.claim(self.base + node.as_span().start())
    }

    /// Notes an error and goes on.
    pub(super) fn report(&mut self, diagnostic: Diagnostic) {
        self.errors.push(diagnostic);
    }

    /// Notes an error and gives the declaration up.
    pub(super) fn stop<T>(&mut self, diagnostic: Diagnostic) -> Built<T> {
        self.errors.push(diagnostic);
        Err(Stop)
    }

    /// What a chain gives, unless it has too many levels; `what` and `span` say where.
    pub(super) fn shallow<T>(&mut self, read: Result<T, TooDeep>, what: &str, span: Span) -> Built<T> {
        read.or_else(|TooDeep| self.stop(error::too_deep(span, what)))
    }

    /// How many units have been read.
    pub(super) fn units_read(&self) -> usize {
        self.units.len()
    }

    /// The first unit read since [`Builder::units_read`] gave `mark`.
    pub(super) fn unit_since(&self, mark: usize) -> Option<Span> {
        self.units.get(mark).copied()
    }

    /// Notes that a unit has been read.
    pub(super) fn note_unit(&mut self, span: Span) {
        self.units.push(span);
    }
}
