//! Completion: what may stand at the cursor.
//!
//! The tokens before the cursor say what the place wants ([`reader`]); so it works on text that can't be read
//! as a mission yet. Names come from the [`Index`](Index), which knows broken declarations too.

mod candidates;
mod declaration;
mod expression;
mod forms;
mod formula;
mod item;
mod model;
mod names;
mod place;
mod reader;
#[cfg(test)]
mod tests;

use lsp_types::{CompletionList, CompletionResponse, Position};

use super::document::Document;
use super::index::Index;
use super::session::Client;
use crate::syntax::token::{Kind, Token};
use candidates::Candidates;
use item::Items;
use model::Model;
use place::Place;
use reader::{Halt, Reader, Want};

/// The characters after which an editor asks without being told to.
pub const TRIGGERS: [&str; 7] = [" ", ":", ",", "[", "{", "/", "."];

/// So many candidates are sent at most; of more, those are taken that begin like the word that is typed.
const MOST: usize = 1000;

/// What may stand at a position. `typed` is the character after which the editor asks by itself: then only
/// what has to come is offered, as nobody asked for anything.
pub fn complete(
    document: &Document,
    position: Position,
    typed: Option<&str>,
    client: Client,
) -> Option<CompletionResponse> {
    let offset = document.offset(position) as usize;
    let text = &document.source.text;
    let place = Place::new(text, offset)?;
    let (mut wants, has_to_come) = wants(document, &place);
    if typed.is_some() && !has_to_come {
        return None;
    }
    if typed.is_some_and(|typed| typed != ".") {
        // Numbers are likelier than names: nothing is to stand in their way.
        wants.wants.retain(|want| !matches!(want, Want::Operand(_)));
    }
    let mut candidates = Candidates::new(document, &place, wants);
    candidates.collect();
    let (items, is_whole) = Items { document, place: &place, client }.of(candidates.list, MOST);
    (!items.is_empty())
        .then_some(CompletionResponse::List(CompletionList { is_incomplete: !is_whole, items }))
}

/// What a place wants, and what is known of the declaration around it.
struct Wanted<'t> {
    wants: Vec<Want<'t>>,
    /// What a unit that is typed over several tokens may measure.
    unit: Option<Want<'t>>,
    variables: Vec<reader::Variable<'t>>,
    /// The words of the items of the block around it.
    items: Vec<&'t str>,
    model: Model<'t>,
}

/// Reads up to the cursor; whether what is wanted has to come.
fn wants<'t>(document: &'t Document, place: &'t Place<'t>) -> (Wanted<'t>, bool) {
    let index = document.index();
    let Some(tokens) = place.declaration() else {
        let wanted = Wanted {
            wants: vec![Want::Declaration],
            unit: None,
            variables: Vec::new(),
            items: Vec::new(),
            model: Model::default(),
        };
        return (wanted, false);
    };
    let behind = place.behind();
    // What is typed at the cursor makes sense on neither side.
    let gap = Token { kind: Kind::Sign, text: "", start: 0, end: 0, lines_before: 0, blank_before: true };
    let whole: Vec<Token<'_>> = tokens.iter().chain([&gap]).chain(behind).copied().collect();
    let known = model_of(&whole, index);
    let mut reader = Reader::new(tokens, index);
    reader.known = known.clone();
    let end = reader.declaration();
    if end == Err(Halt::Lost) || !reader.is_at_cursor() {
        reader.wants = if place.is_first_of_line { vec![Want::Declaration] } else { Vec::new() };
    }
    let in_block = reader
        .wants
        .iter()
        .find(|want| matches!(want, Want::DynamicsItem | Want::ConnectivityItem | Want::ModeItem));
    let mut items = reader.items.clone();
    if let Some(block) = in_block {
        let mut rest = Reader::new(behind, index);
        let _ = match block {
            Want::DynamicsItem => rest.dynamics_items(),
            Want::ModeItem => rest.mode_items(),
            _ => rest.connectivity_items(),
        };
        items.extend(rest.closed.iter().chain(&rest.items));
    }
    let unit = place.unit.and_then(|(before, _)| {
        let count = before.checked_sub(place.before.len() - tokens.len())?;
        let mut reader = Reader::new(tokens.get(..count)?, index);
        reader.known = known.clone();
        let _ = reader.declaration();
        reader.wants.into_iter().find(|want| matches!(want, Want::Unit(_)))
    });
    let wanted = Wanted { wants: reader.wants, unit, variables: reader.variables, items, model: known };
    (wanted, end == Err(Halt::Cursor))
}

/// The motion model that some tokens declare.
fn model_of<'t>(tokens: &[Token<'t>], index: &Index) -> Model<'t> {
    let mut reader = Reader::new(tokens, index);
    let _ = reader.declaration();
    reader.model
}
