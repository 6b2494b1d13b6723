//! What an editor shows about the place that the mouse rests on.

mod model;
mod set;
mod symbol;
#[cfg(test)]
mod tests;
mod token;

use lsp_types::{Hover, HoverContents, MarkupContent, MarkupKind, Position};

use super::Document;
use super::tubes::Tubes;
use crate::source::Span;

/// The most lines of a declaration that are shown.
const MOST_LINES: usize = 6;
/// The most characters of a declaration that are shown.
const MOST_CHARACTERS: usize = 400;

/// What is known about the name, word, number, unit or operator at a position.
pub fn hover(document: &Document, position: Position, tubes: &Tubes) -> Option<Hover> {
    let (span, text) = View { document, tubes }.at(document.offset(position))?;
    Some(Hover {
        contents: HoverContents::Markup(MarkupContent { kind: MarkupKind::Markdown, value: text }),
        range: Some(document.range(span)),
    })
}

/// A mission with the tubes of its models.
#[derive(Clone, Copy)]
struct View<'d> {
    document: &'d Document,
    tubes: &'d Tubes,
}

impl View<'_> {
    /// What is said about the place at an offset, as Markdown, with the place.
    fn at(&self, offset: u32) -> Option<(Span, String)> {
        let index = self.document.index();
        if let Some(occurrence) = index.at(offset) {
            return Some((occurrence.span, self.symbol(occurrence)));
        }
        self.token(offset)
    }

    fn text(&self, span: Span) -> &str {
        self.document.source.slice(span)
    }
}

/// Markdown, paragraph by paragraph.
#[derive(Default)]
struct Page {
    paragraphs: Vec<String>,
}

impl Page {
    /// Adds a piece of a mission, cut where it is long.
    fn code(&mut self, text: &str) {
        let lines: Vec<&str> = text.lines().collect();
        let mut shown = lines.iter().take(MOST_LINES).copied().collect::<Vec<_>>().join("\n");
        let mut cut = lines.len() > MOST_LINES;
        if shown.chars().count() > MOST_CHARACTERS {
            shown = shown.chars().take(MOST_CHARACTERS).collect();
            cut = true;
        }
        let dots = if cut { " …" } else { "" };
        self.paragraphs.push(format!("```dosm\n{shown}{dots}\n```"));
    }

    /// Adds columns of text as they stand.
    fn columns(&mut self, rows: &[Vec<String>]) {
        let count = rows.iter().map(Vec::len).max().unwrap_or(0);
        let width = |column: usize| rows.iter().filter_map(|r| Some(r.get(column)?.chars().count())).max();
        let widths: Vec<usize> = (0..count).map(|c| width(c).unwrap_or(0)).collect();
        let line = |row: &Vec<String>| {
            let cells = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}"));
            cells.collect::<Vec<_>>().join("  ").trim_end().to_string()
        };
        let lines: Vec<String> = rows.iter().map(line).collect();
        self.paragraphs.push(format!("```text\n{}\n```", lines.join("\n")));
    }

    /// Adds a paragraph.
    fn say(&mut self, text: impl Into<String>) {
        self.paragraphs.push(text.into());
    }

    /// Adds a mission's own words, below a line.
    fn doc(&mut self, doc: Option<&str>) {
        if let Some(doc) = doc.filter(|d| !d.trim().is_empty()) {
            self.paragraphs.push(format!("---\n\n{doc}"));
        }
    }

    fn markdown(self) -> String {
        self.paragraphs.join("\n\n")
    }
}
