//! Places in a text as editors count them: line, and units of an encoding within it.

use lsp_types::{Position, PositionEncodingKind, Range};

use crate::source::Span;

/// What a column counts; agreed upon when a session begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// Bytes.
    Utf8,
    /// 16-bit units, two for characters beyond the first plane: what every editor can do.
    #[default]
    Utf16,
    /// Characters.
    Utf32,
}

impl Encoding {
    /// The first of the editor's encodings that is known here; UTF-16 where it names none.
    pub fn agree(offered: Option<&[PositionEncodingKind]>) -> Encoding {
        let known = |kind: &PositionEncodingKind| {
            [Encoding::Utf8, Encoding::Utf16, Encoding::Utf32].into_iter().find(|e| e.kind() == *kind)
        };
        offered.into_iter().flatten().find_map(known).unwrap_or_default()
    }

    /// Its name in the protocol.
    pub fn kind(self) -> PositionEncodingKind {
        match self {
            Encoding::Utf8 => PositionEncodingKind::UTF8,
            Encoding::Utf16 => PositionEncodingKind::UTF16,
            Encoding::Utf32 => PositionEncodingKind::UTF32,
        }
    }

    /// How many units a character takes.
    fn units(self, character: char) -> usize {
        match self {
            Encoding::Utf8 => character.len_utf8(),
            Encoding::Utf16 => character.len_utf16(),
            Encoding::Utf32 => 1,
        }
    }
}

/// A character whose bytes and units differ.
#[derive(Clone, Copy, Debug)]
struct Wide {
    /// Its bytes, from and up to.
    start: u32,
    end: u32,
    /// By how much bytes outnumber units, from the beginning of the text up to its end.
    surplus: u32,
}

/// The lines of a text: converts between byte offsets and positions, each in logarithmic time.
#[derive(Clone, Debug)]
pub struct Lines {
    /// Where each line begins, and where it ends before its line break.
    lines: Vec<Span>,
    wide: Vec<Wide>,
}

impl Lines {
    /// The lines of a text; `\n`, `\r\n` and `\r` end one.
    pub fn new(text: &str, encoding: Encoding) -> Lines {
        let (mut lines, mut wide) = (Vec::new(), Vec::new());
        let (mut start, mut surplus) = (0, 0);
        let bytes = text.as_bytes();
        for (at, character) in text.char_indices() {
            match character {
                '\n' if at > 0 && bytes[at - 1] == b'\r' => start = at + 1,
                '\n' | '\r' => {
                    lines.push(Span::new(start, at));
                    start = at + 1;
                }
                _ if character.is_ascii() => {}
                _ => {
                    let length = character.len_utf8();
                    surplus += (length - encoding.units(character)) as u32;
                    wide.push(Wide { start: at as u32, end: (at + length) as u32, surplus });
                }
            }
        }
        lines.push(Span::new(start, text.len()));
        Lines { lines, wide }
    }

    /// How many lines there are; a text that ends with a line break has an empty last one.
    pub fn count(&self) -> usize {
        self.lines.len()
    }

    /// The bytes of a line without its line break; empty beyond the last one.
    pub fn span(&self, line: u32) -> Span {
        self.lines.get(line as usize).copied().unwrap_or_default()
    }

    /// The position of a byte offset.
    pub fn position(&self, offset: u32) -> Position {
        let line = self.lines.partition_point(|l| l.start <= offset).saturating_sub(1);
        // Between `\r` and `\n` is behind the line's end.
        let (start, offset) = (self.lines[line].start, offset.min(self.lines[line].end));
        Position { line: line as u32, character: self.column(start, offset) }
    }

    /// The range of a span.
    pub fn range(&self, span: Span) -> Range {
        Range { start: self.position(span.start), end: self.position(span.end) }
    }

    /// The byte offset of a position: a column beyond its line's end is the end, one inside a character
    /// is the character's start, a line beyond the last is the end of the text.
    pub fn offset(&self, position: Position) -> u32 {
        let Some(&Span { start, end }) = self.lines.get(position.line as usize) else {
            return self.lines.last().map_or(0, |last| last.end);
        };
        let first = self.wide.partition_point(|w| w.start < start);
        let last = self.wide.partition_point(|w| w.start < end);
        let inside = &self.wide[first..last];
        let passed = inside.partition_point(|w| self.column(start, w.end) <= position.character);
        let base = passed.checked_sub(1).map_or(start, |i| inside[i].end);
        let ahead = position.character.saturating_sub(self.column(start, base));
        // Up to the next wide character units are bytes.
        let limit = inside.get(passed).map_or(end, |w| w.start);
        base.saturating_add(ahead).min(limit)
    }

    /// The span of a range; empty where the range is turned round.
    pub fn span_of(&self, range: Range) -> Span {
        let start = self.offset(range.start);
        Span { start, end: self.offset(range.end).max(start) }
    }

    /// How many units there are between a line's start and an offset in it.
    fn column(&self, start: u32, offset: u32) -> u32 {
        offset - start - (self.surplus(offset) - self.surplus(start))
    }

    /// By how much bytes outnumber units before an offset.
    fn surplus(&self, offset: u32) -> u32 {
        let before = self.wide.partition_point(|w| w.end <= offset);
        before.checked_sub(1).map_or(0, |i| self.wide[i].surplus)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The position of an offset, counted character by character.
    fn counted(text: &str, encoding: Encoding, offset: usize) -> Position {
        let (mut line, mut character) = (0, 0);
        let mut before = text[..offset].chars().peekable();
        while let Some(c) = before.next() {
            let ends = c == '\n' || c == '\r' && before.peek() != Some(&'\n');
            if ends && !(c == '\r' && text[offset..].starts_with('\n') && before.peek().is_none()) {
                (line, character) = (line + 1, 0);
            } else if c != '\r' {
                character += encoding.units(c) as u32;
            }
        }
        Position { line, character }
    }

    proptest! {
        #[test]
        fn positions_are_what_counting_says(text in "[a-c é→😀\r\n]{0,40}", which in 0usize..3) {
            let encoding = [Encoding::Utf8, Encoding::Utf16, Encoding::Utf32][which];
            let lines = Lines::new(&text, encoding);
            for offset in (0..=text.len()).filter(|&i| text.is_char_boundary(i)) {
                let position = lines.position(offset as u32);
                prop_assert_eq!(position, counted(&text, encoding, offset), "{:?} at {}", text, offset);
                let inside_a_break = text[..offset].ends_with('\r') && text[offset..].starts_with('\n');
                if !inside_a_break {
                    prop_assert_eq!(lines.offset(position), offset as u32, "{:?} at {}", text, offset);
                }
            }
        }

        #[test]
        fn any_position_has_an_offset_at_a_character(
            text in "[a😀é\r\n]{0,20}", line in 0u32..8, character in 0u32..30
        ) {
            let lines = Lines::new(&text, Encoding::Utf16);
            let offset = lines.offset(Position { line, character });
            prop_assert!(text.is_char_boundary(offset as usize));
            let back = lines.position(offset);
            prop_assert!(back.line <= line && (back.line < line || back.character <= character));
        }
    }

    #[test]
    fn a_column_inside_a_character_is_its_start() {
        let lines = Lines::new("a😀b", Encoding::Utf16);
        let offsets: Vec<u32> = (0..6).map(|c| lines.offset(Position { line: 0, character: c })).collect();
        assert_eq!(offsets, [0, 1, 1, 5, 6, 6]);
        assert_eq!(lines.offset(Position { line: 7, character: 0 }), 6);
    }

    #[test]
    fn the_first_known_encoding_of_the_editor_is_taken() {
        let odd = PositionEncodingKind::new("utf-7");
        assert_eq!(Encoding::agree(None), Encoding::Utf16);
        assert_eq!(Encoding::agree(Some(std::slice::from_ref(&odd))), Encoding::Utf16);
        let offered = [odd, PositionEncodingKind::UTF8, PositionEncodingKind::UTF16];
        assert_eq!(Encoding::agree(Some(&offered)), Encoding::Utf8);
    }
}
