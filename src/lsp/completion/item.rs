//! Candidates as the protocol's items.

use lsp_types::{
    CompletionItem, CompletionItemKind, CompletionTextEdit, Documentation, InsertReplaceEdit,
    InsertTextFormat, MarkupContent, MarkupKind, TextEdit,
};

use crate::lsp::document::Document;
use crate::lsp::index::SymbolKind;
use crate::lsp::session::Client;
use crate::source::Span;
use crate::syntax::glossary;

use super::candidates::{Candidate, Kind};
use super::forms::filled;
use super::place::Place;

/// Makes items.
pub(super) struct Items<'a> {
    pub(super) document: &'a Document,
    pub(super) place: &'a Place<'a>,
    pub(super) client: Client,
}

impl Items<'_> {
    /// The items of candidates, and whether they are all: of more than `most`, those that begin like the word.
    pub(super) fn of(&self, candidates: Vec<Candidate>, most: usize) -> (Vec<CompletionItem>, bool) {
        let typed = self.document.source.slice(self.place.word).to_ascii_lowercase();
        let is_whole = candidates.len() <= most;
        let fits =
            |candidate: &Candidate| is_whole || candidate.label.to_ascii_lowercase().starts_with(&typed);
        let fitting = candidates.into_iter().filter(fits).take(most);
        (fitting.enumerate().map(|(at, candidate)| self.one(at, candidate)).collect(), is_whole)
    }

    fn one(&self, at: usize, candidate: Candidate) -> CompletionItem {
        // Behind the cursor something stands already: then a word is exchanged, not a declaration begun.
        let snippet = candidate.snippet.filter(|_| self.place.is_last_of_line);
        let is_whole_text = candidate.kind == Kind::Snippet;
        let (text, format) = match snippet {
            Some(snippet) if self.client.snippets && snippet.contains('$') => {
                (snippet, Some(InsertTextFormat::SNIPPET))
            }
            Some(snippet) if is_whole_text => (filled(&snippet), None),
            _ => (candidate.label.clone(), None),
        };
        CompletionItem {
            kind: Some(kind(candidate.kind, format.is_some())),
            detail: candidate.detail,
            documentation: candidate
                .doc
                .or_else(|| self.meaning(candidate.kind, &candidate.label))
                .map(|d| self.documentation(d)),
            sort_text: Some(format!("{at:05}")),
            text_edit: Some(self.edit(text, candidate.continues_unit)),
            insert_text_format: format,
            filter_text: None,
            label: candidate.label,
            ..CompletionItem::default()
        }
    }

    fn edit(&self, new_text: String, continues_unit: bool) -> CompletionTextEdit {
        let word = self.place.word;
        let start = self.place.unit.filter(|_| continues_unit).map_or(word.start, |(_, start)| start);
        let insert = self.document.range(Span { start, end: word.end });
        if self.client.insert_replace && self.place.end > word.end {
            let replace = self.document.range(Span { start, end: self.place.end });
            return CompletionTextEdit::InsertAndReplace(InsertReplaceEdit { new_text, insert, replace });
        }
        CompletionTextEdit::Edit(TextEdit { range: insert, new_text })
    }

    /// What a word of the language means.
    fn meaning(&self, kind: Kind, label: &str) -> Option<String> {
        if !matches!(kind, Kind::Word | Kind::Function | Kind::Coordinate | Kind::Unit) {
            return None;
        }
        let entry = glossary::entry(label.split(' ').next()?)?;
        let is_plain = !self.client.markdown_completion || entry.example.is_empty();
        Some(if is_plain {
            entry.meaning.to_string()
        } else {
            format!("{}\n\n```dosm\n{}\n```", entry.meaning, entry.example)
        })
    }

    fn documentation(&self, value: String) -> Documentation {
        if self.client.markdown_completion {
            return Documentation::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value });
        }
        Documentation::String(value)
    }
}

fn kind(kind: Kind, is_snippet: bool) -> CompletionItemKind {
    match kind {
        Kind::Snippet => CompletionItemKind::SNIPPET,
        Kind::Function => CompletionItemKind::FUNCTION,
        Kind::Word if is_snippet => CompletionItemKind::SNIPPET,
        Kind::Word => CompletionItemKind::KEYWORD,
        Kind::Coordinate => CompletionItemKind::VARIABLE,
        Kind::Unit => CompletionItemKind::UNIT,
        Kind::NewName => CompletionItemKind::TEXT,
        Kind::Name(symbol) => match symbol {
            SymbolKind::Parameter | SymbolKind::Constant => CompletionItemKind::CONSTANT,
            SymbolKind::Region | SymbolKind::Obstacle | SymbolKind::Jammer => CompletionItemKind::STRUCT,
            SymbolKind::Dynamics => CompletionItemKind::CLASS,
            SymbolKind::Team => CompletionItemKind::ENUM,
            SymbolKind::State | SymbolKind::Input | SymbolKind::Matrix => CompletionItemKind::FIELD,
            SymbolKind::Goal | SymbolKind::Define => CompletionItemKind::REFERENCE,
            SymbolKind::Mission | SymbolKind::Mode => CompletionItemKind::MODULE,
            SymbolKind::Robot | SymbolKind::RobotVariable | SymbolKind::IndexVariable | SymbolKind::Base => {
                CompletionItemKind::VARIABLE
            }
        },
    }
}
