//! The text that pest sees: each run of blanks and comments is one blank, and what no mission may hold is gone.
//!
//! Alternatives are tried again and again at the same place; without this, each of them would skip the same
//! comments again.

use crate::source::Span;

/// A condensed text with the way back to the source.
#[derive(Default)]
pub(super) struct Condensed {
    text: String,
    /// In ascending order.
    sections: Vec<Section>,
    blank_due: bool,
}

/// A part of the condensed text.
#[derive(Clone, Copy)]
struct Section {
    /// Where it begins in the condensed text.
    start: u32,
    /// Where it begins in the source.
    source: u32,
    /// The length of what it takes the place of; `None` where it is the source's own text.
    replaced: Option<u32>,
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

    /// Adds the source's text at `offset`.
    pub(super) fn push(&mut self, piece: &str, offset: usize) {
        self.blank();
        let (start, source) = (self.text.len() as u32, offset as u32);
        let continues = self
            .sections
            .last()
            .is_some_and(|s| s.replaced.is_none() && s.source + (start - s.start) == source);
        if !continues {
            self.sections.push(Section { start, source, replaced: None });
        }
        self.text.push_str(piece);
    }

    /// Adds a text in place of the `length` bytes of the source at `offset`.
    pub(super) fn replace(&mut self, piece: &str, offset: usize, length: usize) {
        self.blank();
        let start = self.text.len() as u32;
        self.sections.push(Section { start, source: offset as u32, replaced: Some(length as u32) });
        self.text.push_str(piece);
    }

    fn blank(&mut self) {
        if self.blank_due {
            self.text.push(' ');
            self.blank_due = false;
        }
    }

    /// The section of a byte of the condensed text, with the byte's place in it.
    fn section(&self, position: usize) -> Option<(Section, usize)> {
        let after = self.sections.partition_point(|s| s.start as usize <= position);
        let section = *self.sections.get(after.checked_sub(1)?)?;
        Some((section, position - section.start as usize))
    }

    /// Where the source's text for a byte of the condensed text begins.
    fn begin(&self, position: usize) -> usize {
        match self.section(position) {
            Some((section, _)) if section.replaced.is_some() => section.source as usize,
            Some((section, inside)) => section.source as usize + inside,
            None => 0,
        }
    }

    /// Where the source's text for a byte of the condensed text ends.
    fn end(&self, position: usize, source: &str) -> usize {
        let Some((section, inside)) = self.section(position) else { return 0 };
        if let Some(length) = section.replaced {
            return section.source as usize + length as usize;
        }
        let mut end = section.source as usize + inside + 1;
        while end < source.len() && !source.is_char_boundary(end) {
            end += 1;
        }
        end
    }

    /// The source span of a part of the condensed text, blanks at its ends left out.
    ///
    /// An empty part is the place behind what stands before it.
    pub(super) fn span(&self, start: usize, end: usize, source: &str) -> Span {
        let inside = self.text.get(start..end).unwrap_or("");
        let start = start + (inside.len() - inside.trim_start().len());
        let length = inside.trim().len();
        if length == 0 {
            let kept = self.text.get(..start).unwrap_or("").trim_end().len();
            let place = kept.checked_sub(1).map_or(0, |last| self.end(last, source));
            return Span::new(place, place);
        }
        Span::new(self.begin(start), self.end(start + length - 1, source))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_lead_back_to_the_source() {
        // `a`, a blank, `≤` (3 bytes) replaced by `<=`, `b` at once behind it.
        let source = "/**/a  ≤b";
        let mut condensed = Condensed::default();
        condensed.separate();
        condensed.push("a", 4);
        condensed.separate();
        condensed.replace("<=", 7, 3);
        condensed.push("b", 10);
        assert_eq!(condensed.text(), "a <=b");
        assert_eq!(condensed.span(0, 1, source), Span::new(4, 5));
        assert_eq!(condensed.span(0, 2, source), Span::new(4, 5));
        assert_eq!(condensed.span(2, 4, source), Span::new(7, 10));
        assert_eq!(condensed.span(3, 4, source), Span::new(7, 10));
        assert_eq!(condensed.span(3, 5, source), Span::new(7, 11));
        assert_eq!(condensed.span(2, 2, source), Span::new(5, 5));
        assert_eq!(condensed.span(5, 5, source), Span::new(11, 11));
    }
}
