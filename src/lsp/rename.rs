//! Another name for something, wherever it stands.

use std::collections::HashMap;

use lsp_types::{Position, PrepareRenameResponse, TextEdit, WorkspaceEdit};

use super::document::Document;
use super::index::{Index, Symbol, SymbolId};
use super::navigation::symbol_at;
use crate::diag::Diagnostics;
use crate::source::{SourceFile, Span};
use crate::syntax::{self, words};

/// What would be renamed at a position.
///
/// # Errors
/// Why nothing there can be, for people.
pub fn prepare(document: &Document, position: Position) -> Result<PrepareRenameResponse, String> {
    let (symbol, span) = renamable(document, position)?;
    let placeholder = symbol.1.name.clone();
    Ok(PrepareRenameResponse::RangeWithPlaceholder { range: document.range(span), placeholder })
}

/// The edits that give what stands at a position another name.
///
/// # Errors
/// Why it can't have that name, for people: it is no name, it is taken, or something would mean another
/// thing than before.
pub fn rename(document: &Document, position: Position, name: &str) -> Result<WorkspaceEdit, String> {
    let ((id, symbol), _) = renamable(document, position)?;
    check_name(name)?;
    let index = document.index();
    let spans: Vec<Span> = index.occurrences_of(id).map(|o| o.span).collect();
    if name != symbol.name {
        check_free(index, symbol, name)?;
        check_meaning(document, &spans, name)?;
    }
    let edit = |span: &Span| TextEdit { range: document.range(*span), new_text: name.into() };
    let edits = spans.iter().map(edit).collect();
    #[allow(clippy::mutable_key_type, reason = "the protocol's own type; nothing in a URI changes")]
    let changes = HashMap::from([(document.uri.clone(), edits)]);
    Ok(WorkspaceEdit { changes: Some(changes), ..WorkspaceEdit::default() })
}

type Named<'a> = (SymbolId, &'a Symbol);

fn renamable(document: &Document, position: Position) -> Result<(Named<'_>, Span), String> {
    let (id, span) = symbol_at(document, position).ok_or("there is no name of the mission here")?;
    let symbol = document.index().symbol(id);
    if symbol.is_renamable() {
        Ok(((id, symbol), span))
    } else {
        Err(format!("`{}` has its name from the language", symbol.name))
    }
}

fn check_name(name: &str) -> Result<(), String> {
    let starts = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    if !starts || !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return Err(format!("`{name}` is no name: letters, digits and `_`, no digit first"));
    }
    if words::is_reserved(name) || words::PREDECLARED.contains(&name) {
        return Err(format!("`{name}` is a word of the language"));
    }
    Ok(())
}

/// Sees whether nothing of the same name space has the name.
fn check_free(index: &Index, symbol: &Symbol, name: &str) -> Result<(), String> {
    let is_beside = |other: &Symbol| {
        let in_model = symbol.parent.is_some() && symbol.parent == other.parent;
        in_model || symbol.kind.is_global() && other.kind.is_global()
    };
    match index.symbols().map(|(_, other)| other).find(|other| other.name == name && is_beside(other)) {
        Some(other) => Err(format!("there is a {} `{name}`", other.kind.noun())),
        None => Ok(()),
    }
}

/// Sees whether every name of the mission still means what it meant.
fn check_meaning(document: &Document, spans: &[Span], name: &str) -> Result<(), String> {
    let old = document.index();
    let text = renamed(&document.source.text, spans, name);
    let source = SourceFile::new(document.source.name.clone(), text);
    let new = match syntax::parse(&source, &mut Diagnostics::new()) {
        Ok(file) => Index::with_text(&file, &source.text),
        Err(_) => return Err("nothing here can be read".into()),
    };
    let same = meanings(old).eq(meanings(&new))
        && old.builtins().len() == new.builtins().len()
        && old.unresolved().len() == new.unresolved().len();
    if same {
        return Ok(());
    }
    Err(format!("with the name `{name}` something would mean another thing than now"))
}

/// What each name in the text stands for, in the order of the text: symbols go by where they are declared
/// among all names, since their places move.
fn meanings(index: &Index) -> impl Iterator<Item = (SymbolId, super::index::Role)> + '_ {
    index.occurrences().iter().map(|o| (o.symbol, o.role))
}

fn renamed(text: &str, spans: &[Span], name: &str) -> String {
    let (mut result, mut from) = (String::with_capacity(text.len()), 0);
    for span in spans {
        result.push_str(&text[from..span.range().start]);
        result.push_str(name);
        from = span.range().end;
    }
    result + &text[from..]
}
