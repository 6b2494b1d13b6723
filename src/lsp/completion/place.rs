//! Where the cursor is: the tokens before it, and the word that is being typed.

use crate::source::Span;
use crate::syntax::token::{Kind, Token, tokens};
use crate::syntax::words::DECLARATIONS;

use super::reader::declaration_start;

/// A cursor in a text.
pub(super) struct Place<'s> {
    /// The tokens of the whole text without comments and without what the cursor touches.
    pub(super) others: Vec<Token<'s>>,
    /// The tokens before the word that is typed, without comments.
    pub(super) before: Vec<Token<'s>>,
    /// The part of the word before the cursor.
    pub(super) word: Span,
    /// The end of the word, behind the cursor.
    pub(super) end: u32,
    /// Where a unit that is typed begins, and how many tokens stand before it.
    pub(super) unit: Option<(usize, u32)>,
    /// Whether a number ends at the cursor.
    pub(super) touches_number: bool,
    /// Whether a dot is typed, not a word.
    pub(super) is_dot: bool,
    /// Whether the word is the first of its line but for comments.
    pub(super) is_first_of_line: bool,
    /// Whether nothing stands behind it on its line.
    pub(super) is_last_of_line: bool,
}

impl<'s> Place<'s> {
    /// The place of a byte offset; `None` inside of comments.
    pub(super) fn new(text: &'s str, offset: usize) -> Option<Place<'s>> {
        let head = text.get(..offset)?;
        let mut before = tokens(head);
        if before.last().is_some_and(|last| is_open_comment(head, last)) {
            return None;
        }
        before.retain(|token| !token.is_comment());
        let start = word_start(&mut before, offset);
        let touches_number = before.last().is_some_and(|t| t.kind == Kind::Number && t.end == offset);
        let unit = unit_start(&before, start, offset);
        let tail = text.get(offset..).unwrap_or("");
        let length = tail.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(tail.len());
        let line = tail.get(length..).and_then(|rest| rest.lines().next()).unwrap_or("");
        let gap = text.get(before.last().map_or(0, |last| last.end)..start)?;
        let is_first_of_line = before.is_empty() || gap.contains('\n');
        let touches = |token: &Token<'_>| token.start <= offset && token.end >= offset && token.end > start;
        let others =
            tokens(text).into_iter().filter(|token| !token.is_comment() && !touches(token)).collect();
        Some(Place {
            others,
            before,
            word: Span::new(start, offset),
            end: (offset + length) as u32,
            unit,
            touches_number,
            is_dot: text.get(start..offset) == Some("."),
            is_first_of_line,
            is_last_of_line: line.trim().is_empty(),
        })
    }

    /// The tokens of the declaration that the cursor is in or behind, up to the cursor.
    pub(super) fn declaration(&self) -> Option<&[Token<'s>]> {
        self.before.get(declaration_start(&self.before)?..)
    }

    /// The tokens behind the cursor up to the next declaration.
    pub(super) fn behind(&self) -> &[Token<'s>] {
        let start = self.others.partition_point(|token| token.start < self.word.end as usize);
        let behind = self.others.get(start..).unwrap_or(&[]);
        behind.get(..stretch(behind)).unwrap_or(behind)
    }

    /// The whole declarations that begin with a word, without what the cursor touches.
    pub(super) fn declarations(&self, word: &'static str) -> impl Iterator<Item = &[Token<'s>]> {
        let starts = (0..self.others.len()).filter(move |&at| self.others[at].is(word));
        starts.map(|start| {
            let rest = &self.others[start..];
            &rest[..1 + stretch(&rest[1..])]
        })
    }

    /// How many dimensions the workspace has, as far as its first point tells.
    pub(super) fn dimensions(&self) -> usize {
        let Some(tokens) = self.declarations("workspace").next() else { return 2 };
        if tokens.iter().any(|token| token.is("z")) {
            return 3;
        }
        let point = tokens.iter().skip_while(|token| !token.is("(")).take_while(|token| !token.is(")"));
        if point.filter(|token| token.is(",")).count() == 2 { 3 } else { 2 }
    }

    /// Whether a word begins a declaration somewhere else.
    pub(super) fn declares(&self, word: &str) -> bool {
        self.others.iter().any(|token| token.is(word))
    }
}

/// How many tokens there are before the next declaration.
fn stretch(tokens: &[Token<'_>]) -> usize {
    let begins = |token: &Token<'_>| token.kind == Kind::Word && DECLARATIONS.contains(&token.text);
    tokens.iter().position(begins).unwrap_or(tokens.len())
}

/// Whether the last token of a text is a comment that what comes next would be in.
fn is_open_comment(text: &str, last: &Token<'_>) -> bool {
    let Some(written) = text.get(last.start..) else { return false };
    match last.kind {
        Kind::LineComment | Kind::Doc => last.end == text.len(),
        Kind::BlockComment => last.end == text.len() && tokens(&format!("{written}x")).len() == 1,
        _ => false,
    }
}

/// Takes away the word, or the first dot of `..`, that ends at the cursor; where it begins.
fn word_start(before: &mut Vec<Token<'_>>, offset: usize) -> usize {
    let typed = |token: &&Token<'_>| {
        token.end == offset && (matches!(token.kind, Kind::Word | Kind::Unit) || token.text == ".")
    };
    match before.last().filter(typed).map(|token| token.start) {
        Some(start) => {
            before.pop();
            start
        }
        None => offset,
    }
}

/// Where the run of a unit's characters begins that ends at the cursor, as in `2 m/|` and `2 m/k|`.
fn unit_start(before: &[Token<'_>], start: usize, offset: usize) -> Option<(usize, u32)> {
    let mut begin = start;
    for (at, token) in before.iter().enumerate().rev() {
        if token.end != begin || offset - token.start > 64 {
            return None;
        }
        match token.kind {
            Kind::Unit => return Some((at, token.start as u32)),
            Kind::Number | Kind::Word => {}
            Kind::Sign if matches!(token.text, "/" | "*" | "^" | "-") => {}
            _ => return None,
        }
        begin = token.start;
    }
    None
}
