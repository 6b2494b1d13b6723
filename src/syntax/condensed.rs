//! The text that pest sees: each run of blanks and comments is one blank, and what no mission may hold is gone.
//!
//! Alternatives are tried again and again at the same place; without this, each of them would skip the same
//! comments again.

use crate::source::Span;

/// A condensed text with the way back to the source.
#[derive(Default)]
pub(super) struct Condensed {
    text: String,
    /// Where a stretch begins in the condensed text and in the source; both ascend.
    stretches: Vec<(u32, u32)>,
    blank_due: bool,
}

impl Condensed {
    /// The condensed text.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// Notes that blanks or a comment separate what comes from what was.
    pub(super) fn separate(&mut self) {
        self.blank_due = !self.text.is_empty();
    }

    /// Where the next token will begin.
    pub(super) fn next_start(&self) -> usize {
        self.text.len() + usize::from(self.blank_due)
    }

    /// Adds a piece of text that stands at `offset` in the source, or takes the place of what stands there.
    pub(super) fn push(&mut self, piece: &str, offset: usize) {
        if self.blank_due {
            self.text.push(' ');
            self.blank_due = false;
        }
        let here = self.text.len() as u32;
        let continues = self.stretches.last().is_some_and(|&(c, s)| s + (here - c) == offset as u32);
        if !continues {
            self.stretches.push((here, offset as u32));
        }
        self.text.push_str(piece);
    }

    /// The source offset of a byte of the condensed text.
    fn offset(&self, position: usize) -> usize {
        let after = self.stretches.partition_point(|&(c, _)| c as usize <= position);
        match after.checked_sub(1).and_then(|i| self.stretches.get(i)) {
            Some(&(c, s)) => s as usize + (position - c as usize),
            None => 0,
        }
    }

    /// The source span of a stretch of the condensed text, blanks at its ends left out.
    pub(super) fn span(&self, start: usize, end: usize, source: &str) -> Span {
        let inside = self.text.get(start..end).unwrap_or("");
        let start = start + (inside.len() - inside.trim_start().len());
        let end = start + inside.trim().len();
        let from = self.offset(start);
        if end == start {
            return Span::new(from, from);
        }
        let mut to = self.offset(end - 1) + 1;
        while to < source.len() && !source.is_char_boundary(to) {
            to += 1;
        }
        Span::new(from, to)
    }
}
