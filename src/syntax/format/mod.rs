//! The one style of missions: what `dosmc fmt` writes.
//!
//! Tokens stay what they are, comments included, and only what stands between them is chosen anew; where
//! declarations and their items begin, the syntax tree says. One declaration and one item stands on a line;
//! tables that have several lines have their columns under each other, and so have neighbours' intervals,
//! units and comments. An author's empty lines stay, one at a time, and so do line breaks inside formulas.
//! A declaration that can't be read is left as it is.

mod edits;
mod layout;
mod sheet;
mod spacing;
#[cfg(test)]
mod tests;

use super::ast::{File, Item};
use super::{dump, parse};
use crate::diag::{Diagnostics, Reported, Severity};
use crate::source::{SourceFile, Span};

use super::token::{Token, tokens};
use layout::Layout;

/// A formatted mission.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Formatted {
    /// Its text.
    pub text: String,
    /// How many declarations could not be read and were left as they are.
    pub left: usize,
}

/// Lays a mission out in the one style; it means the same as before.
///
/// # Errors
/// [`Reported`] when nothing useful can be read; the reason is in `diagnostics`, as all errors are.
pub fn format(source: &SourceFile, diagnostics: &mut Diagnostics) -> Result<Formatted, Reported> {
    let file = parse(source, diagnostics)?;
    let parts = parts(&file, diagnostics);
    let text = layout(source, &parts);
    let left = parts.iter().filter(|part| part.item.is_none()).count();
    // Whatever this does wrong, it must not change what a mission says.
    if is_same(source, &file, &text) {
        Ok(Formatted { text, left })
    } else {
        Ok(Formatted { text: source.text.clone(), left })
    }
}

/// The edits that [`format`] would make, gap by gap between tokens and in order, so that an editor keeps its
/// marks and cursors.
///
/// # Errors
/// As for [`format`].
pub fn edits(source: &SourceFile, diagnostics: &mut Diagnostics) -> Result<Vec<(Span, String)>, Reported> {
    Ok(edits::between(&source.text, &format(source, diagnostics)?.text))
}

/// A declaration, or one that could not be read.
struct Part<'a> {
    span: Span,
    item: Option<&'a Item>,
}

fn layout(source: &SourceFile, parts: &[Part<'_>]) -> String {
    let tokens = tokens(&source.text);
    let mut layout = Layout::new(&tokens);
    let mut at = 0;
    while let Some(token) = tokens.get(at) {
        let part = part_at(parts, token.start);
        match part {
            Some(Part { span, item: Some(item) }) => {
                layout.declaration(item);
                at = tokens.partition_point(|t| t.start < span.range().end);
            }
            None if token.is_comment() => {
                layout.comment(token, 0);
                at += 1;
            }
            // What could not be read, up to where something can be again.
            _ => {
                let end = end_of_unread(&tokens, at, parts);
                layout.raw(&source.text[token.start..tokens[end - 1].end], token.lines_before > 1);
                at = end;
            }
        }
    }
    layout.sheet.text()
}

/// All declarations, in order; what an error is about counts as not read.
fn parts<'a>(file: &'a File, diagnostics: &Diagnostics) -> Vec<Part<'a>> {
    let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error);
    let mut errors: Vec<Span> = errors.filter_map(|d| Some(d.labels.first()?.span)).collect();
    errors.sort();
    let wrong = |span: Span| {
        let behind = errors.partition_point(|error| error.start < span.start);
        errors.get(behind).is_some_and(|error| error.start < span.end)
    };
    let items = file.items.iter().map(|item| {
        let item_read = (!wrong(item.span)).then_some(item);
        Part { span: item.span, item: item_read }
    });
    let broken = file.broken.iter().map(|broken| Part { span: broken.span, item: None });
    let mut parts: Vec<Part<'_>> = items.chain(broken).collect();
    parts.sort_by_key(|part| part.span);
    parts
}

/// The part that an offset lies in.
fn part_at<'p, 'a>(parts: &'p [Part<'a>], offset: usize) -> Option<&'p Part<'a>> {
    let behind = parts.partition_point(|part| part.span.range().start <= offset);
    parts[..behind].last().filter(|part| part.span.range().contains(&offset))
}

/// The token after the last one that belongs to what begins at a token and can't be read; comments on lines
/// of their own before the next declaration are that one's.
fn end_of_unread(tokens: &[Token<'_>], begin: usize, parts: &[Part<'_>]) -> usize {
    let readable = |token: &Token<'_>| part_at(parts, token.start).is_some_and(|part| part.item.is_some());
    let next = tokens[begin..].iter().position(readable).map_or(tokens.len(), |at| begin + at);
    let own = tokens[begin..next].iter().rposition(|t| !t.is_comment()).unwrap_or(0);
    begin + own + 1
}

/// Whether a text says what a file says: the same tree, the same comments in the same order.
fn is_same(source: &SourceFile, file: &File, text: &str) -> bool {
    let again = SourceFile::new(source.name.clone(), text);
    let comments = |text: &str| -> Vec<String> {
        tokens(text).iter().filter(|t| t.is_comment()).map(|t| words(t.text)).collect()
    };
    parse(&again, &mut Diagnostics::new()).is_ok_and(|parsed| dump(&parsed) == dump(file))
        && comments(&source.text) == comments(text)
}

/// A comment without blanks at the ends of its lines.
fn words(comment: &str) -> String {
    comment.lines().map(str::trim_end).collect::<Vec<_>>().join("\n")
}
