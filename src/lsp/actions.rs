//! What an editor offers to do about a diagnostic: to mend it, and to explain it.

#[cfg(test)]
mod tests;

use std::collections::HashMap;

use lsp_types::{
    CodeAction, CodeActionContext, CodeActionKind, CodeActionOrCommand, CodeActionResponse, Command,
    Diagnostic as Shown, NumberOrString, Range, TextEdit, WorkspaceEdit,
};

use super::commands;
use super::document::Document;
use super::session::Client;
use crate::diag::{Diagnostic, Edit, Fix};
use crate::explain;
use crate::source::Span;
use crate::syntax::ast::{Item, ItemKind, Name, PieceKind, Shape};

/// The kind of the action that makes all sure mends at once.
pub const FIX_ALL: &str = "source.fixAll.dosmc";

/// What can be done about the diagnostics that a range touches.
pub fn actions(
    document: &Document,
    range: Range,
    context: &CodeActionContext,
    client: Client,
) -> CodeActionResponse {
    let within = document.lines.span_of(range);
    let said = document.said();
    let touched: Vec<&Diagnostic> = said.into_iter().filter(|d| touches(d, within)).collect();
    let wants = |kind: &CodeActionKind| {
        let is_below = |wanted: &CodeActionKind| {
            let rest = kind.as_str().strip_prefix(wanted.as_str());
            rest.is_some_and(|rest| wanted.as_str().is_empty() || rest.is_empty() || rest.starts_with('.'))
        };
        context.only.as_ref().is_none_or(|only| only.iter().any(is_below))
    };
    let mut list = Vec::new();
    if wants(&CodeActionKind::QUICKFIX) {
        if client.action_literals {
            list.extend(touched.iter().flat_map(|d| mends(document, d, context)));
        }
        list.extend(explanations(&touched));
    }
    let all = CodeActionKind::new(FIX_ALL);
    // Not between the mends of one place, but where somebody asks for it.
    if client.action_literals && context.only.is_some() && wants(&all) {
        list.extend(all_at_once(document).map(|edit| {
            CodeActionOrCommand::CodeAction(CodeAction {
                title: "mend all that can be mended surely".into(),
                kind: Some(all),
                edit: Some(edit),
                ..CodeAction::default()
            })
        }));
    }
    list
}

fn touches(diagnostic: &Diagnostic, within: Span) -> bool {
    diagnostic.labels.first().is_some_and(|l| l.span.start <= within.end && within.start <= l.span.end)
}

/// The mends of a diagnostic, those that it brings along and those that its declaration tells.
pub fn fixes(document: &Document, diagnostic: &Diagnostic) -> Vec<Fix> {
    let mut fixes = diagnostic.fixes.clone();
    fixes.extend(from_tree(document, diagnostic));
    fixes
}

/// A mend for which one has to see the declarations.
fn from_tree(document: &Document, diagnostic: &Diagnostic) -> Option<Fix> {
    let place = diagnostic.labels.first()?.span;
    let items = &document.file()?.items;
    match diagnostic.code {
        "dosm::check::unused" => {
            let item = items.iter().find(|item| declared(item).is_some_and(|name| name.span == place))?;
            let span = item.doc.as_ref().map_or(item.span, |doc| doc.span.to(item.span));
            let title = format!("remove `{}`", document.source.slice(place));
            Some(Fix { title, edits: vec![Edit::Remove(span)], is_sure: false })
        }
        "dosm::check::predeclared" => {
            let item = items.iter().find(|item| declared(item).is_some_and(|name| name.span == place))?;
            let name = format!("{}_1", declared(item)?.text);
            let title = format!("call it `{name}`");
            Some(Fix { title, edits: vec![Edit::Replace(place, name)], is_sure: false })
        }
        "dosm::check::wrong_point" => {
            let piece = items.iter().filter_map(shape).flat_map(|shape| &shape.pieces).find(|piece| {
                matches!(&piece.kind, PieceKind::Ball { center, disc: true, .. } if center.span == place)
            })?;
            let word = Span { end: piece.span.start + 4, ..piece.span };
            let edits = vec![Edit::Replace(word, "ball".into()), Edit::Append(piece.span, " norm 2".into())];
            Some(Fix { title: "write `ball … norm 2`".into(), edits, is_sure: true })
        }
        "dosm::check::missing_robot" if document.source.text.len() as u32 == place.end => {
            let is_model = |item: &&Item| matches!(item.kind, ItemKind::Dynamics { .. });
            let model = items.iter().find(is_model).and_then(declared)?;
            let robot = format!("robot R1: {} at (1, 1)", model.text);
            Some(Fix { title: format!("add `{robot}`"), edits: vec![Edit::AtEnd(robot)], is_sure: false })
        }
        _ => None,
    }
}

/// The shape of what has one.
fn shape(item: &Item) -> Option<&Shape> {
    match &item.kind {
        ItemKind::Workspace(shape)
        | ItemKind::Region { shape, .. }
        | ItemKind::Obstacle { shape, .. }
        | ItemKind::Jammer { shape, .. } => Some(shape),
        _ => None,
    }
}

/// The name that is declared.
fn declared(item: &Item) -> Option<&Name> {
    match &item.kind {
        ItemKind::Param { name, .. }
        | ItemKind::Let { name, .. }
        | ItemKind::Dynamics { name, .. }
        | ItemKind::Team { name, .. }
        | ItemKind::Goal { name, .. }
        | ItemKind::Define { name, .. } => Some(name),
        ItemKind::Region { name, .. }
        | ItemKind::Obstacle { name, .. }
        | ItemKind::Jammer { name, .. }
        | ItemKind::Base { name, .. }
        | ItemKind::Robot { name, .. } => Some(&name.name),
        _ => None,
    }
}

fn mends(
    document: &Document,
    diagnostic: &Diagnostic,
    context: &CodeActionContext,
) -> Vec<CodeActionOrCommand> {
    let fixes = fixes(document, diagnostic);
    let is_only = fixes.len() == 1;
    let shown = shown(document, diagnostic, context);
    let action = |fix: &Fix| {
        Some(CodeActionOrCommand::CodeAction(CodeAction {
            title: fix.title.clone(),
            kind: Some(CodeActionKind::QUICKFIX),
            diagnostics: shown.clone().map(|shown| vec![shown]),
            edit: Some(edit(document, fix.replacements(&document.source.text)?)),
            is_preferred: Some(fix.is_sure && is_only),
            ..CodeAction::default()
        }))
    };
    fixes.iter().filter_map(action).collect()
}

/// The diagnostic as the editor has it.
fn shown(document: &Document, diagnostic: &Diagnostic, context: &CodeActionContext) -> Option<Shown> {
    let range = document.range(diagnostic.labels.first()?.span);
    let code = NumberOrString::String(diagnostic.code.into());
    context.diagnostics.iter().find(|d| d.range == range && d.code.as_ref() == Some(&code)).cloned()
}

fn edit(document: &Document, replacements: Vec<(Span, String)>) -> WorkspaceEdit {
    let edits = replacements
        .into_iter()
        .map(|(span, new_text)| TextEdit { range: document.range(span), new_text })
        .collect();
    #[allow(clippy::mutable_key_type, reason = "the protocol's own type; nothing in a URI changes")]
    let changes = HashMap::from([(document.uri.clone(), edits)]);
    WorkspaceEdit { changes: Some(changes), ..WorkspaceEdit::default() }
}

/// All sure mends of a mission that don't get into each other's way.
fn all_at_once(document: &Document) -> Option<WorkspaceEdit> {
    let mut all: Vec<(Span, String)> = Vec::new();
    for diagnostic in document.said() {
        let sure = fixes(document, diagnostic).into_iter().find(|fix| fix.is_sure);
        let Some(replacements) = sure.and_then(|fix| fix.replacements(&document.source.text)) else {
            continue;
        };
        let is_free = |(span, _): &(Span, String)| {
            all.iter().all(|(other, _)| span.end < other.start || other.end < span.start)
        };
        if replacements.iter().all(is_free) {
            all.extend(replacements);
        }
    }
    all.sort_by_key(|(span, _)| *span);
    (!all.is_empty()).then(|| edit(document, all))
}

/// For each code, once: to read about it.
fn explanations(diagnostics: &[&Diagnostic]) -> Vec<CodeActionOrCommand> {
    let mut codes: Vec<&str> = diagnostics.iter().map(|d| d.code).collect();
    codes.sort_unstable();
    codes.dedup();
    let explained = codes.into_iter().filter(|code| explain::PAGES.iter().any(|page| page.code == *code));
    let command = |code: &str| {
        CodeActionOrCommand::Command(Command {
            title: format!("explain {code}"),
            command: commands::EXPLAIN.into(),
            arguments: Some(vec![code.into()]),
        })
    };
    explained.map(command).collect()
}
