//! The lenses over a mission: plan it, and look at the plan.

use lsp_types::{CodeLens, Command};

use super::commands::{OPEN_PAGE, OPEN_PICTURE, SOLVE};
use super::document::Document;
use super::session::Session;
use crate::source::Span;
use crate::syntax::ast::ItemKind;

/// The lenses, all at the mission's name, or at its first declaration without one.
pub fn lenses(document: &Document, session: &Session) -> Vec<CodeLens> {
    let range = document.range(place(document));
    let lens = |title: String, command: &str| CodeLens {
        range,
        command: Some(Command {
            title,
            command: command.into(),
            arguments: Some(vec![document.uri.as_str().into()]),
        }),
        data: None,
    };
    let mut lenses = Vec::new();
    if session.runs.is_running(document) {
        // Nothing to press: progress has its own button to stop.
        let planning = Command { title: "planning…".into(), command: String::new(), arguments: None };
        lenses.push(CodeLens { range, command: Some(planning), data: None });
    } else {
        lenses.push(lens("▶ plan this mission".into(), SOLVE));
    }
    if let Some(outcome) = session.runs.outcome(document) {
        if let Some(length) = outcome.length {
            lenses.push(lens(format!("plan of {length} steps: picture"), OPEN_PICTURE));
            lenses.push(lens("animation".into(), OPEN_PAGE));
        } else {
            let first = outcome.message.lines().next().unwrap_or_default();
            lenses.push(lens(first.into(), SOLVE));
        }
    }
    lenses
}

/// Where what concerns the mission as a whole is said: at its name, or at its beginning.
pub fn place(document: &Document) -> Span {
    let items = document.file().map_or(&[][..], |file| &file.items);
    let named = items.iter().find(|item| matches!(item.kind, ItemKind::Mission(_)));
    named.or(items.first()).map(|item| item.span).unwrap_or_default()
}
