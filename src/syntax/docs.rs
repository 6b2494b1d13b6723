//! Documentation comments: found by the scan, claimed by what stands behind them.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::source::Span;
use crate::syntax::ast::Doc;

/// The documentation comments of a file.
#[derive(Default)]
pub(super) struct Docs {
    /// The `//!` lines at the top.
    pub(super) file: Option<Doc>,
    /// `///` comments by the place (in the condensed text) of the token behind them.
    before: BTreeMap<usize, Doc>,
    stray: Vec<Span>,
}

impl Docs {
    /// Adds a `//!` line at the top of the file.
    pub(super) fn add_inner(&mut self, line: Doc) {
        match &mut self.file {
            Some(doc) => extend(doc, line),
            None => self.file = Some(line),
        }
    }

    /// Adds a `///` line that stands before the token at `place`.
    pub(super) fn add(&mut self, place: usize, line: Doc) {
        match self.before.get_mut(&place) {
            Some(doc) => extend(doc, line),
            None => {
                self.before.insert(place, line);
            }
        }
    }

    /// Adds a comment that can't document anything where it stands.
    pub(super) fn add_stray(&mut self, span: Span) {
        self.stray.push(span);
    }

    /// The places of the comments that nothing has claimed yet, in a part of the condensed text.
    pub(super) fn unclaimed(&self, part: Range<usize>) -> Vec<usize> {
        self.before.range(part).map(|(place, _)| *place).collect()
    }

    /// The comment before the token at `place`, which now has its owner.
    pub(super) fn claim(&mut self, place: usize) -> Option<Doc> {
        self.before.remove(&place)
    }

    /// Drops the comments before and inside a broken declaration: they need no warning.
    pub(super) fn forget(&mut self, start: usize, end: usize) {
        let mut rest = self.before.split_off(&start);
        self.before.append(&mut rest.split_off(&end));
    }

    /// The comments that nothing claimed, in order.
    pub(super) fn into_stray(self) -> Vec<Span> {
        let mut stray = self.stray;
        stray.extend(self.before.into_values().map(|doc| doc.span));
        stray.sort();
        stray
    }
}

fn extend(doc: &mut Doc, line: Doc) {
    doc.text.push('\n');
    doc.text.push_str(&line.text);
    doc.span = doc.span.to(line.span);
}

/// A documentation comment's text: without the slashes, one blank after them and blanks at the end.
pub(super) fn line_text(comment: &str) -> &str {
    let text = comment.get(3..).unwrap_or("").trim_end();
    text.strip_prefix(' ').unwrap_or(text)
}
