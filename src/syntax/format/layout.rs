//! From declarations to lines.

use super::sheet::{Cells, Line, Sheet, width};
use super::spacing::{is_spaced, join};
use crate::source::Span;
use crate::syntax::ast::{Connectivity, DynamicsItem, DynamicsKind, Item, ItemKind};
use crate::syntax::token::{Kind, Token};

/// The longest line that declarations are put on when their author broke them.
const WIDTH: usize = 100;
/// How far what is inside something is moved to the right.
const INDENT: usize = 2;

/// Lays tokens out on a sheet.
pub(super) struct Layout<'s> {
    pub(super) sheet: Sheet,
    tokens: &'s [Token<'s>],
}

/// What is inside braces: places of items, and how each is laid out.
type Body<'a> = Vec<(Span, Option<&'a DynamicsKind>)>;

impl<'s> Layout<'s> {
    pub(super) fn new(tokens: &'s [Token<'s>]) -> Layout<'s> {
        Layout { sheet: Sheet::default(), tokens }
    }

    /// The tokens of a span.
    pub(super) fn of(&self, span: Span) -> &'s [Token<'s>] {
        let range = span.range();
        let begin = self.tokens.partition_point(|t| t.start < range.start);
        let end = self.tokens.partition_point(|t| t.start < range.end);
        &self.tokens[begin..end.max(begin)]
    }

    /// A comment outside everything else, at the end of the line before if it stands there: then true.
    pub(super) fn comment(&mut self, token: &Token<'_>, indent: usize) -> bool {
        let trails = token.lines_before == 0 && !token.text.contains('\n');
        if trails && self.sheet.trail(token.text) {
            return true;
        }
        let mut lines = token.text.split('\n');
        let first = lines.next().unwrap_or_default().trim_end().to_owned();
        self.sheet.push(Line {
            indent,
            text: first,
            blank_before: token.lines_before > 1,
            ..Line::default()
        });
        // What is inside a long comment stays where its author put it.
        for line in lines {
            self.sheet.push(Line { text: line.trim_end().to_owned(), ..Line::default() });
        }
        false
    }

    /// Text that is left as it is.
    pub(super) fn raw(&mut self, text: &str, blank_before: bool) {
        for (at, line) in text.split('\n').enumerate() {
            let text = line.trim_end().to_owned();
            self.sheet.push(Line { text, blank_before: at == 0 && blank_before, ..Line::default() });
        }
    }

    /// A declaration.
    pub(super) fn declaration(&mut self, item: &Item) {
        let tokens = self.of(item.span);
        match &item.kind {
            ItemKind::Dynamics { items, .. } => self.block(tokens, &dynamics_body(items), 0),
            ItemKind::Connectivity(Connectivity::Items(items)) => {
                let body: Body<'_> = items.iter().map(|item| (item.span, None)).collect();
                self.small_block(tokens, &body);
            }
            ItemKind::Goal { .. } | ItemKind::Define { .. } => self.flow(tokens, 0, true),
            ItemKind::Let { .. } => self.matrix(tokens, 0),
            _ => self.flow(tokens, 0, false),
        }
    }

    /// A header, a brace, an item a line, a brace.
    fn block(&mut self, tokens: &[Token<'_>], body: &Body<'_>, indent: usize) {
        let Some(open) = last_open_brace(tokens) else { return self.flow(tokens, indent, true) };
        self.flow(&tokens[..=open], indent, false);
        let inner = &tokens[open + 1..tokens.len() - 1];
        let mut at = 0;
        let mut first = true;
        while let Some(token) = inner.get(at) {
            let item = body.iter().find(|(span, _)| span.range().contains(&token.start));
            let Some((span, kind)) = item else {
                if token.is_comment() {
                    let lines_before = if first { token.lines_before.min(1) } else { token.lines_before };
                    first &= self.comment(&Token { lines_before, ..*token }, indent + INDENT);
                }
                at += 1;
                continue;
            };
            let end = at + inner[at..].iter().take_while(|t| t.start < span.range().end).count();
            let mut own = inner[at..end].to_vec();
            if first {
                own[0].lines_before = own[0].lines_before.min(1);
            }
            self.item(&own, *kind, indent + INDENT);
            first = false;
            at = end;
        }
        self.sheet.push(Line { indent, text: "}".into(), ..Line::default() });
    }

    fn item(&mut self, tokens: &[Token<'_>], kind: Option<&DynamicsKind>, indent: usize) {
        match kind {
            Some(DynamicsKind::Matrix { .. }) => self.matrix(tokens, indent),
            Some(DynamicsKind::Mode { items, .. }) => self.block(tokens, &dynamics_body(items), indent),
            Some(DynamicsKind::Bound { .. } | DynamicsKind::Disturbance { .. }) => {
                self.flow(tokens, indent, false);
                self.sheet.note_cells(tokens);
            }
            _ => self.flow(tokens, indent, false),
        }
    }

    /// On one line if its author had it there and it fits, else an item a line.
    fn small_block(&mut self, tokens: &[Token<'_>], body: &Body<'_>) {
        let broken = tokens.iter().skip(1).any(|t| t.lines_before > 0 || t.is_comment());
        let items: Vec<String> = body.iter().map(|(span, _)| join(self.of(*span))).collect();
        let head = last_open_brace(tokens).map_or_else(String::new, |open| join(&tokens[..=open]));
        let text = format!("{head} {} }}", items.join("; "));
        if broken || width(&text) > WIDTH || items.is_empty() {
            return self.block(tokens, body, 0);
        }
        self.sheet.push(Line { text, blank_before: blank_before(tokens), ..Line::default() });
    }

    /// A table whose rows its author put on lines has a row a line, with columns under each other.
    fn matrix(&mut self, tokens: &[Token<'_>], indent: usize) {
        let open =
            tokens.iter().position(|t| t.is("=")).filter(|at| tokens.get(at + 1).is_some_and(|t| t.is("[")));
        let broken = tokens.iter().skip(1).any(|t| t.lines_before > 0);
        let commented = tokens.iter().any(Token::is_comment);
        let long = indent + width(&join(tokens)) > WIDTH;
        match open {
            Some(equals) if (broken || long) && !commented => self.table(tokens, equals + 1, indent),
            _ => self.flow(tokens, indent, false),
        }
    }

    fn table(&mut self, tokens: &[Token<'_>], open: usize, indent: usize) {
        let close = tokens.iter().rposition(|t| t.is("]")).unwrap_or(tokens.len() - 1);
        let rows: Vec<Vec<String>> = split(&tokens[open + 1..close], ";")
            .into_iter()
            .map(|row| split(row, ",").into_iter().map(join).collect())
            .collect();
        let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
        let widths: Vec<usize> = (0..columns)
            .map(|j| rows.iter().filter_map(|r| r.get(j)).map(|c| width(c)).max().unwrap_or(0))
            .collect();
        let head = format!("{} [", join(&tokens[..open]));
        let left = width(&head);
        for (at, row) in rows.iter().enumerate() {
            let mut text = if at == 0 { head.clone() } else { " ".repeat(left) };
            for (j, cell) in row.iter().enumerate() {
                let last = j + 1 == row.len();
                text.push_str(cell);
                if !last {
                    text.push_str(&format!(", {}", " ".repeat(widths[j] - width(cell))));
                }
            }
            if at + 1 == rows.len() {
                text.push_str(&join(&tokens[close..]));
            } else {
                text.push(';');
            }
            let blank_before = at == 0 && blank_before(tokens);
            self.sheet.push(Line { indent, text, blank_before, ..Line::default() });
        }
    }

    /// Tokens one after the other. Their author's line breaks stay where `keeps` says so, or where one
    /// line would be too long; comments end lines.
    fn flow(&mut self, tokens: &[Token<'_>], indent: usize, keeps: bool) {
        let keeps = keeps || indent + width(&join(tokens)) > WIDTH;
        let mut line = Line { indent, blank_before: blank_before(tokens), ..Line::default() };
        for (at, token) in tokens.iter().enumerate() {
            let before = at.checked_sub(1).map(|i| &tokens[i]);
            let ends = |t: &Token<'_>| matches!(t.kind, Kind::LineComment | Kind::Doc);
            let own_line = token.lines_before > 0 && (keeps || ends(token));
            let breaks = at > 0 && (before.is_some_and(ends) || own_line);
            if breaks {
                self.sheet.push(std::mem::take(&mut line));
                line.indent = indent + INDENT;
            }
            if ends(token) && !line.text.is_empty() {
                line.comment = Some(token.text.to_owned());
                continue;
            }
            if !line.text.is_empty() && is_spaced(tokens, at) {
                line.text.push(' ');
            }
            line.text.push_str(token.text);
        }
        if !line.text.is_empty() {
            self.sheet.push(line);
        }
    }
}

impl Sheet {
    /// Notes the parts of the interval that was just written on one line.
    fn note_cells(&mut self, tokens: &[Token<'_>]) {
        let parts = || {
            let (keyword, rest) = tokens.split_first()?;
            let within = rest.iter().position(|t| t.is("in"))?;
            let close = rest.iter().rposition(|t| t.is("]"))?;
            Some(Cells {
                keyword: keyword.text.to_owned(),
                names: join(&rest[..within]),
                interval: join(rest.get(within + 1..=close)?),
                unit: join(&rest[close + 1..]),
            })
        };
        if tokens.iter().any(Token::is_comment) {
            return;
        }
        self.describe_last(parts().filter(|_| indent_and_width(tokens) <= WIDTH));
    }
}

fn indent_and_width(tokens: &[Token<'_>]) -> usize {
    INDENT + width(&join(tokens))
}

fn dynamics_body(items: &[DynamicsItem]) -> Body<'_> {
    items.iter().map(|item| (item.span, Some(&item.kind))).collect()
}

fn blank_before(tokens: &[Token<'_>]) -> bool {
    tokens.first().is_some_and(|t| t.lines_before > 1)
}

/// The brace that the last token closes.
fn last_open_brace(tokens: &[Token<'_>]) -> Option<usize> {
    if !tokens.last()?.is("}") {
        return None;
    }
    let mut depth = 0i32;
    tokens.iter().rposition(|t| {
        depth += i32::from(t.is("}")) - i32::from(t.is("{"));
        depth == 0
    })
}

/// Tokens between separators outside inner brackets.
fn split<'a, 's>(tokens: &'a [Token<'s>], separator: &str) -> Vec<&'a [Token<'s>]> {
    let mut depth = 0i32;
    tokens
        .split(|t| {
            depth += i32::from(t.is("(") || t.is("[")) - i32::from(t.is(")") || t.is("]"));
            depth == 0 && t.is(separator)
        })
        .collect()
}
