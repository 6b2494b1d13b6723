//! The few lines of a source that a diagnostic shows: made printable, cut where they are long.
//!
//! The excerpt is a small text of its own with its own byte offsets; it knows which line of the
//! source each of its lines is, so that numbers on the screen are the file's.

use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

use super::lines::Lines;
use super::printable::{printable, shown_as};
use crate::diag::Label;
use crate::source::SourceFile;

/// A label that runs over more lines than this is shown on its first line only.
const TALLEST_LABEL: usize = 12;
/// Lines shown above and below a label's own.
pub(super) const CONTEXT: usize = 1;

/// What is shown of a source.
pub(super) struct Excerpt {
    name: String,
    text: String,
    lines: Vec<Shown>,
    places: Vec<Place>,
}

/// A line of the excerpt.
struct Shown {
    /// Its number in the source, from 0.
    number: usize,
    /// Its bytes in the excerpt, without the line break.
    start: usize,
    end: usize,
}

/// A label's place in the excerpt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    /// The first byte in the excerpt.
    pub start: usize,
    /// The number of bytes.
    pub len: usize,
    /// The column in the source, from 0, in characters.
    column: usize,
}

impl Excerpt {
    /// The lines around some labels, each cut to about `width` characters.
    pub fn new(source: &SourceFile, lines: &Lines, labels: &[Label], width: usize) -> Excerpt {
        let spans: Vec<(usize, usize)> = labels.iter().map(|l| shown_span(lines, l)).collect();
        let mut excerpt = Excerpt {
            name: printable(&source.name).replace(['\n', '\t'], " "),
            text: String::new(),
            lines: Vec::new(),
            places: spans
                .iter()
                .map(|&(s, _)| Place { start: 0, len: 0, column: lines.place(s).1 - 1 })
                .collect(),
        };
        for number in shown_lines(lines, &spans) {
            excerpt.push_line(source, lines, number, &spans, width);
        }
        excerpt
    }

    /// The labels' places, in the labels' order.
    pub fn places(&self) -> &[Place] {
        &self.places
    }

    /// Adds a line of the source, and to each label's place what of it lies there.
    fn push_line(
        &mut self,
        source: &SourceFile,
        lines: &Lines,
        number: usize,
        spans: &[(usize, usize)],
        width: usize,
    ) {
        let line = (lines.start(number), lines.end(number));
        let start = self.text.len();
        let on_line = spans.iter().filter(|s| s.0 <= line.1 && s.1 >= line.0);
        let marked: Vec<(usize, usize)> = on_line.map(|s| (s.0.max(line.0), s.1.min(line.1))).collect();
        let parts = kept(&source.text, line, &marked, width);
        for &(from, to) in &parts {
            if from > line.0 {
                self.text.push('…');
            }
            for (at, c) in source.text[from..to].char_indices() {
                self.mark(spans, from + at);
                self.text.push(shown_as(c));
            }
            self.mark(spans, to);
        }
        if parts.last().is_some_and(|part| part.1 < line.1) {
            self.text.push('…');
        }
        self.lines.push(Shown { number, start, end: self.text.len() });
        self.text.push('\n');
    }

    /// Notes that a byte of the source stands at the end of the excerpt so far.
    fn mark(&mut self, spans: &[(usize, usize)], byte: usize) {
        for (place, &(start, end)) in self.places.iter_mut().zip(spans) {
            if byte == start {
                place.start = self.text.len();
            }
            if byte > start && byte <= end {
                place.len = self.text.len() - place.start;
            }
        }
    }

    /// The index of the line that holds a byte of the excerpt.
    fn line_at(&self, offset: usize) -> usize {
        self.lines.partition_point(|l| l.start <= offset).saturating_sub(1)
    }
}

/// A label's bytes, shortened to its first line when it is tall.
fn shown_span(lines: &Lines, label: &Label) -> (usize, usize) {
    let (start, end) = lines.clamp(label.span);
    let first = lines.line_of(start);
    if lines.line_of(end) - first < TALLEST_LABEL {
        (start, end)
    } else {
        (start, lines.end(first).max(start))
    }
}

/// The numbers of the lines to show, in order.
fn shown_lines(lines: &Lines, spans: &[(usize, usize)]) -> Vec<usize> {
    let around = |&(start, end): &(usize, usize)| {
        let first = lines.line_of(start).saturating_sub(CONTEXT);
        first..=(lines.line_of(end) + CONTEXT).min(lines.count() - 1)
    };
    let mut numbers: Vec<usize> = spans.iter().flat_map(around).collect();
    numbers.sort_unstable();
    numbers.dedup();
    // What follows the last line break is a line only when something is said about it.
    let last = lines.count() - 1;
    let said = spans.iter().any(|&(_, end)| lines.line_of(end) == last);
    numbers.retain(|&n| n < last || said || lines.start(n) < lines.end(n));
    numbers
}

/// The parts of a line to keep, as ascending byte ranges: all of a short line, else what is near
/// its marks, else its beginning.
fn kept(text: &str, line: (usize, usize), marked: &[(usize, usize)], width: usize) -> Vec<(usize, usize)> {
    if line.1 - line.0 <= width {
        return vec![line];
    }
    if marked.is_empty() {
        return vec![(line.0, forward(text, line.0, line.1, width))];
    }
    let near = width / 4;
    let mut parts: Vec<(usize, usize)> = Vec::new();
    let mut marked = marked.to_vec();
    marked.sort_unstable();
    for (start, end) in marked {
        let from = backward(text, start, line.0, near);
        let to = forward(text, forward(text, start, end, width / 2), line.1, near);
        match parts.last_mut() {
            Some(last) if from <= last.1 => last.1 = last.1.max(to),
            _ => parts.push((from, to)),
        }
    }
    parts
}

/// The byte `count` characters after `from`, at most `limit`.
fn forward(text: &str, from: usize, limit: usize, count: usize) -> usize {
    text[from..limit].char_indices().nth(count).map_or(limit, |(i, _)| from + i)
}

/// The byte `count` characters before `from`, at least `limit`.
fn backward(text: &str, from: usize, limit: usize, count: usize) -> usize {
    text[limit..from].char_indices().rev().take(count).last().map_or(from, |(i, _)| limit + i)
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let (mut first, mut last) = (self.line_at(span.offset()), self.line_at(span.offset() + span.len()));
        if first >= self.lines.len() || self.lines[last].number - self.lines[first].number != last - first {
            return Err(MietteError::OutOfBounds);
        }
        for _ in 0..before {
            first -= usize::from(first > 0 && self.lines[first - 1].number + 1 == self.lines[first].number);
        }
        for _ in 0..after {
            let next = self.lines.get(last + 1);
            last += usize::from(next.is_some_and(|l| l.number == self.lines[last].number + 1));
        }
        // Asked without context, miette wants to know where the span itself stands.
        let alone = before == 0 && after == 0;
        let start = if alone { span.offset() } else { self.lines[first].start };
        // With its line break, so that an empty last line is a line too.
        let end = if alone { span.offset() + span.len() } else { self.lines[last].end + 1 };
        let column = self.places.iter().find(|p| alone && p.start == span.offset()).map_or(0, |p| p.column);
        let number = self.lines[first].number;
        let data = self.text.as_bytes().get(start..end).ok_or(MietteError::OutOfBounds)?;
        let place = SourceSpan::from(start..end);
        Ok(Box::new(MietteSpanContents::new_named(
            self.name.clone(),
            data,
            place,
            number,
            column,
            last - first + 1,
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Span;

    fn excerpt(text: &str, spans: &[(usize, usize)], width: usize) -> (String, Vec<String>) {
        let source = SourceFile::new("m.dosm", text);
        let labels: Vec<Label> =
            spans.iter().map(|&(s, e)| Label { span: Span::new(s, e), text: String::new() }).collect();
        let excerpt = Excerpt::new(&source, &Lines::new(text), &labels, width);
        let marked =
            excerpt.places.iter().map(|p| excerpt.text[p.start..p.start + p.len].to_string()).collect();
        (excerpt.text, marked)
    }

    #[test]
    fn only_lines_near_a_label_are_shown() {
        let (text, marked) = excerpt("a\nb\nc\nd\ne\nf\n", &[(4, 5)], 80);
        assert_eq!((text.as_str(), marked), ("b\nc\nd\n", vec!["c".to_string()]));
        assert_eq!(excerpt("a\nb\n", &[(2, 3)], 80).0, "a\nb\n");
        assert_eq!(excerpt("a\nb\n", &[(4, 4)], 80).0, "b\n\n");
    }

    #[test]
    fn a_label_keeps_its_text_when_controls_become_pictures() {
        let (text, marked) = excerpt("a \u{1b}bad\u{202e} z", &[(2, 6), (6, 9)], 80);
        assert_eq!(text, "a ␛bad\u{fffd} z\n");
        assert_eq!(marked, ["␛bad", "\u{fffd}"]);
    }

    #[test]
    fn a_long_line_is_cut_around_its_labels() {
        let long = format!("{}HERE{}", "x".repeat(100_000), "y".repeat(100_000));
        let (text, marked) = excerpt(&long, &[(100_000, 100_004)], 40);
        assert_eq!(text, format!("…{}HERE{}…\n", "x".repeat(10), "y".repeat(10)));
        assert_eq!(marked, ["HERE"]);
    }

    #[test]
    fn a_label_longer_than_the_line_is_cut_too() {
        let (text, marked) = excerpt(&"Ω".repeat(1000), &[(0, 2000)], 40);
        assert_eq!(text.chars().count(), 30 + 2);
        assert!(text.starts_with(&marked[0]));
    }

    #[test]
    fn a_tall_label_is_shown_on_its_first_line() {
        let text = "line\n".repeat(100);
        let (shown, marked) = excerpt(&text, &[(5, 499)], 80);
        assert_eq!((shown.matches('\n').count(), marked), (3, vec!["line".to_string()]));
    }

    #[test]
    fn places_past_the_end_are_moved_to_it() {
        let (_, marked) = excerpt("ab", &[(2, 2), (1, 9), (7, 9)], 80);
        assert_eq!(marked, ["", "b", ""]);
    }
}
