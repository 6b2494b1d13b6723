//! Lines and columns of many places in one text, found quickly.

use crate::source::Span;

/// Where each line of a text starts.
pub(super) struct Lines<'a> {
    text: &'a str,
    starts: Vec<usize>,
}

impl<'a> Lines<'a> {
    /// The lines of a text; a text has one more line than newlines.
    pub fn new(text: &'a str) -> Lines<'a> {
        let after = text.bytes().enumerate().filter(|&(_, b)| b == b'\n').map(|(i, _)| i + 1);
        Lines { text, starts: std::iter::once(0).chain(after).collect() }
    }

    /// The number of lines.
    pub fn count(&self) -> usize {
        self.starts.len()
    }

    /// The line that holds a byte, from 0.
    pub fn line_of(&self, offset: usize) -> usize {
        self.starts.partition_point(|&start| start <= offset).saturating_sub(1)
    }

    /// The first byte of a line.
    pub fn start(&self, line: usize) -> usize {
        self.starts.get(line).copied().unwrap_or(self.text.len())
    }

    /// One past the last byte of a line, its line break left out.
    pub fn end(&self, line: usize) -> usize {
        let Some(&next) = self.starts.get(line + 1) else { return self.text.len() };
        let end = next - 1;
        if self.text[self.start(line)..end].ends_with('\r') { end - 1 } else { end }
    }

    /// Line and column of a byte, both from 1; the column counts characters.
    pub fn place(&self, offset: usize) -> (usize, usize) {
        let offset = self.boundary(offset);
        let line = self.line_of(offset);
        (line + 1, self.text[self.start(line)..offset].chars().count() + 1)
    }

    /// The span moved onto character boundaries inside the text.
    pub fn clamp(&self, span: Span) -> (usize, usize) {
        let start = self.boundary(span.start as usize);
        (start, self.boundary(span.end as usize).max(start))
    }

    /// The last character boundary at or before a byte.
    fn boundary(&self, offset: usize) -> usize {
        let mut offset = offset.min(self.text.len());
        while !self.text.is_char_boundary(offset) {
            offset -= 1;
        }
        offset
    }
}

#[cfg(test)]
mod tests {
    use super::Lines;

    #[test]
    fn places_count_lines_and_characters_from_one() {
        let lines = Lines::new("aΩb\r\n\nc");
        assert_eq!(lines.count(), 3);
        assert_eq!(
            [0, 1, 3, 4, 6, 7, 99].map(|o| lines.place(o)),
            [(1, 1), (1, 2), (1, 3), (1, 4), (2, 1), (3, 1), (3, 2)]
        );
        assert_eq!((lines.start(0), lines.end(0)), (0, 4));
        assert_eq!(lines.place(2), (1, 2), "inside a character");
    }
}
