//! The colours of a mission: each token with what it means where it stands.
//!
//! Names have theirs from the index, everything else from the tokens alone, so that a declaration that
//! can't be read is coloured as well.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use lsp_types::{
    Range, SemanticToken, SemanticTokenModifier, SemanticTokenType, SemanticTokens, SemanticTokensDelta,
    SemanticTokensEdit, SemanticTokensFullDeltaResult, SemanticTokensLegend, Uri,
};

use super::Document;
use super::index::{Builtin, Index, Occurrence, SymbolKind};
use super::session::lock;
use crate::source::Span;
use crate::syntax::token::{Kind, Token, tokens};
use crate::syntax::words;

/// The kinds of token, each with its number in an answer.
const TYPES: [SemanticTokenType; 12] = [
    SemanticTokenType::KEYWORD,
    SemanticTokenType::OPERATOR,
    SemanticTokenType::NUMBER,
    SemanticTokenType::TYPE,
    SemanticTokenType::COMMENT,
    SemanticTokenType::VARIABLE,
    SemanticTokenType::PARAMETER,
    SemanticTokenType::STRUCT,
    SemanticTokenType::CLASS,
    SemanticTokenType::FUNCTION,
    SemanticTokenType::PROPERTY,
    SemanticTokenType::NAMESPACE,
];

/// What is said about tokens besides, each with its bit in an answer.
const MODIFIERS: [SemanticTokenModifier; 4] = [
    SemanticTokenModifier::DECLARATION,
    SemanticTokenModifier::READONLY,
    SemanticTokenModifier::DOCUMENTATION,
    SemanticTokenModifier::DEFAULT_LIBRARY,
];

const DECLARATION: u32 = 1;
const READONLY: u32 = 1 << 1;
const DOCUMENTATION: u32 = 1 << 2;
const DEFAULT_LIBRARY: u32 = 1 << 3;

/// The names of the numbers in an answer.
pub fn legend() -> SemanticTokensLegend {
    SemanticTokensLegend { token_types: TYPES.to_vec(), token_modifiers: MODIFIERS.to_vec() }
}

/// The colours of a whole mission.
pub fn full(document: &Document) -> SemanticTokens {
    coloured(document, Span::new(0, document.source.text.len()))
}

/// The colours of a range.
pub fn range(document: &Document, range: Range) -> SemanticTokens {
    coloured(document, document.lines.span_of(range))
}

/// The colours that were sent last, of each mission, with their names.
#[derive(Default)]
pub struct Colours {
    /// Whether the client colours words, numbers and comments by itself, and finer than the kinds of tokens do.
    names_only: bool,
    sent: Mutex<BTreeMap<String, (String, Vec<SemanticToken>)>>,
    count: AtomicU64,
}

impl Colours {
    /// Colours for a client, which may want those of names only.
    pub fn new(names_only: bool) -> Colours {
        Colours { names_only, ..Colours::default() }
    }

    /// The colours of a range.
    pub fn range(&self, document: &Document, asked: Range) -> SemanticTokens {
        self.wanted(range(document, asked))
    }

    fn wanted(&self, tokens: SemanticTokens) -> SemanticTokens {
        if self.names_only { SemanticTokens { data: of_names(tokens.data), ..tokens } } else { tokens }
    }

    /// The colours of a whole mission, kept so that later ones can be told by their difference.
    pub fn full(&self, document: &Document) -> SemanticTokens {
        let name = self.count.fetch_add(1, Ordering::Relaxed).to_string();
        let tokens = SemanticTokens { result_id: Some(name.clone()), ..self.wanted(full(document)) };
        lock(&self.sent).insert(document.uri.as_str().to_string(), (name, tokens.data.clone()));
        tokens
    }

    /// What has changed since colours of a name; all of them where these are not known any more.
    pub fn delta(&self, document: &Document, name: &str) -> SemanticTokensFullDeltaResult {
        let earlier = lock(&self.sent).remove(document.uri.as_str()).filter(|(sent, _)| sent == name);
        let now = self.full(document);
        match earlier {
            Some((_, before)) => delta(&before, &now).into(),
            None => now.into(),
        }
    }

    /// Forgets a mission that was closed.
    pub fn forget(&self, uri: &Uri) {
        lock(&self.sent).remove(uri.as_str());
    }
}

/// What has changed from the colours of an earlier moment, in one edit.
fn delta(before: &[SemanticToken], after: &SemanticTokens) -> SemanticTokensDelta {
    let now = &after.data;
    let same = |(a, b): &(&SemanticToken, &SemanticToken)| a == b;
    let head = before.iter().zip(now).take_while(same).count();
    let rest = (before.len() - head).min(now.len() - head);
    let tail = before.iter().rev().zip(now.iter().rev()).take(rest).take_while(same).count();
    let edit = SemanticTokensEdit {
        start: 5 * head as u32,
        delete_count: 5 * (before.len() - head - tail) as u32,
        data: Some(now[head..now.len() - tail].to_vec()),
    };
    let edits = if edit.delete_count == 0 && head + tail == now.len() { Vec::new() } else { vec![edit] };
    SemanticTokensDelta { result_id: after.result_id.clone(), edits }
}

/// The tokens that are names; what a client's own grammar colours is left out.
fn of_names(all: Vec<SemanticToken>) -> Vec<SemanticToken> {
    const OTHERS: [SemanticTokenType; 5] = [
        SemanticTokenType::KEYWORD,
        SemanticTokenType::OPERATOR,
        SemanticTokenType::NUMBER,
        SemanticTokenType::TYPE,
        SemanticTokenType::COMMENT,
    ];
    let (mut kept, mut lines, mut columns) = (Vec::new(), 0, 0);
    for token in all {
        columns = if token.delta_line > 0 { token.delta_start } else { columns + token.delta_start };
        lines += token.delta_line;
        if TYPES.get(token.token_type as usize).is_none_or(|kind| OTHERS.contains(kind)) {
            continue;
        }
        kept.push(SemanticToken { delta_line: lines, delta_start: columns, ..token });
        // The next one is relative to this one.
        (lines, columns) = (0, 0);
    }
    kept
}

/// A colour: type and modifiers.
type Colour = (SemanticTokenType, u32);

fn coloured(document: &Document, asked: Span) -> SemanticTokens {
    let text = &document.source.text;
    // From the beginning of a declaration, so that the text is read as it is meant.
    let items = document.file().map_or(&[][..], |file| &file.items);
    let before = items.partition_point(|item| item.span.start <= asked.start);
    let start = before.checked_sub(1).map_or(0, |i| items[i].span.start as usize);
    let piece = text.get(start..asked.end as usize).or_else(|| text.get(start..)).unwrap_or("");
    let index = document.index();
    let mut line = Line { document, last: None, data: Vec::new() };
    for token in tokens(piece) {
        let span = Span::new(start + token.start, start + token.start + token.text.len());
        if span.end <= asked.start {
            continue;
        }
        if let Some(colour) = colour(index, span, &token) {
            line.push(span, &colour);
        }
    }
    SemanticTokens { result_id: None, data: line.data }
}

/// The answer as it grows, each token relative to the one before.
struct Line<'d> {
    document: &'d Document,
    last: Option<(u32, u32)>,
    data: Vec<SemanticToken>,
}

impl Line<'_> {
    /// Adds a token, line by line.
    fn push(&mut self, span: Span, colour: &Colour) {
        let text = self.document.source.slice(span);
        if !text.contains(['\n', '\r']) {
            self.push_one(span, colour);
            return;
        }
        let mut start = span.start as usize;
        for line in text.split(['\n', '\r']) {
            let lead = line.len() - line.trim_start().len();
            self.push_one(Span::new(start + lead, start + line.trim_end().len().max(lead)), colour);
            start += line.len() + 1;
        }
    }

    fn push_one(&mut self, span: Span, (kind, modifiers): &Colour) {
        let Range { start, end } = self.document.range(span);
        if end.character <= start.character || end.line != start.line {
            return;
        }
        let (line, column) = self.last.unwrap_or((0, 0));
        let delta_line = start.line - line;
        let delta_start = if delta_line == 0 { start.character - column } else { start.character };
        self.last = Some((start.line, start.character));
        self.data.push(SemanticToken {
            delta_line,
            delta_start,
            length: end.character - start.character,
            token_type: TYPES.iter().position(|t| t == kind).unwrap_or(0) as u32,
            token_modifiers_bitset: *modifiers,
        });
    }
}

/// The colour of a token; `None` for brackets, separators, and words that mean nothing.
fn colour(index: &Index, span: Span, token: &Token<'_>) -> Option<Colour> {
    if let Some(occurrence) = index.at(span.start).filter(|o| o.span == span) {
        return Some(of_name(index, occurrence));
    }
    if let Some((_, builtin)) = index.builtin_at(span.start).filter(|b| b.0 == span) {
        return Some(of_builtin(builtin));
    }
    match token.kind {
        Kind::Number => Some((SemanticTokenType::NUMBER, 0)),
        Kind::Unit => Some((SemanticTokenType::TYPE, DEFAULT_LIBRARY)),
        Kind::LineComment | Kind::BlockComment => Some((SemanticTokenType::COMMENT, 0)),
        Kind::Doc => Some((SemanticTokenType::COMMENT, DOCUMENTATION)),
        Kind::Sign => is_operator(token.text).then_some((SemanticTokenType::OPERATOR, 0)),
        Kind::Word if index.unresolved().binary_search(&span).is_ok() => None,
        Kind::Word => of_word(token.text),
    }
}

fn of_name(index: &Index, occurrence: &Occurrence) -> Colour {
    let (kind, modifiers) = match index.symbol(occurrence.symbol).kind {
        SymbolKind::Mission => (SemanticTokenType::NAMESPACE, 0),
        SymbolKind::Parameter | SymbolKind::Constant => (SemanticTokenType::VARIABLE, READONLY),
        SymbolKind::Region | SymbolKind::Obstacle | SymbolKind::Jammer => (SemanticTokenType::STRUCT, 0),
        SymbolKind::Base | SymbolKind::Robot | SymbolKind::Team => (SemanticTokenType::VARIABLE, 0),
        SymbolKind::Dynamics => (SemanticTokenType::CLASS, 0),
        SymbolKind::Goal | SymbolKind::Define => (SemanticTokenType::FUNCTION, 0),
        SymbolKind::State | SymbolKind::Input | SymbolKind::Mode | SymbolKind::Matrix => {
            (SemanticTokenType::PROPERTY, 0)
        }
        SymbolKind::IndexVariable | SymbolKind::RobotVariable => (SemanticTokenType::PARAMETER, 0),
    };
    (kind, modifiers | if occurrence.is_declaration() { DECLARATION } else { 0 })
}

fn of_builtin(builtin: Builtin) -> Colour {
    match builtin {
        Builtin::Coordinate => (SemanticTokenType::PARAMETER, DEFAULT_LIBRARY),
        Builtin::Constant => (SemanticTokenType::VARIABLE, READONLY | DEFAULT_LIBRARY),
        Builtin::Function => (SemanticTokenType::FUNCTION, DEFAULT_LIBRARY),
        Builtin::All => (SemanticTokenType::KEYWORD, 0),
    }
}

/// A word that is no name, as far as the index knows: a keyword, or one of the language's own names.
fn of_word(word: &str) -> Option<Colour> {
    const KEYWORDS: [&[&str]; 10] = [
        &words::SHAPES,
        &words::SHAPE_PARTS,
        &words::DYNAMICS_ITEMS,
        &words::DYNAMICS_PARTS,
        &words::MATRICES,
        &words::CONNECTIVITY_ITEMS,
        &words::CONNECTIVITY_OFF,
        &words::OBJECTIVES,
        &words::TRUTHS,
        &words::SETS,
    ];
    if words::is_reserved(word) || KEYWORDS.iter().any(|list| list.contains(&word)) {
        return Some((SemanticTokenType::KEYWORD, 0));
    }
    words::FUNCTIONS.contains(&word).then_some((SemanticTokenType::FUNCTION, DEFAULT_LIBRARY))
}

fn is_operator(sign: &str) -> bool {
    const OPERATORS: [&[&str]; 6] = [
        &words::LOGIC_SIGNS,
        &words::TEMPORAL_SIGNS,
        &words::COMPARISONS,
        &words::ARITHMETIC,
        &words::UNCERTAINTY,
        &words::DOTS,
    ];
    OPERATORS.iter().any(|list| list.contains(&sign))
}

#[cfg(test)]
mod tests;
