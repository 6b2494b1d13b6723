//! From a name to where it is declared and where it is used.

use lsp_types::{GotoDefinitionResponse, Location, Position};

use super::document::Document;
use super::index::{Role, Symbol, SymbolId, SymbolKind};
use crate::source::Span;

/// The symbol whose name stands at a position, and the name's place.
pub fn symbol_at(document: &Document, position: Position) -> Option<(SymbolId, Span)> {
    let occurrence = document.index().at(document.offset(position))?;
    Some((occurrence.symbol, occurrence.span))
}

/// Where the name at a position is declared.
pub fn definition(document: &Document, position: Position) -> Option<GotoDefinitionResponse> {
    let (symbol, _) = symbol_at(document, position)?;
    Some(GotoDefinitionResponse::Scalar(location(document, document.index().symbol(symbol).place)))
}

/// Where what the name at a position stands for is declared: a robot's model, the model of a signal; or else
/// the name itself.
pub fn type_definition(document: &Document, position: Position) -> Option<GotoDefinitionResponse> {
    let (id, _) = symbol_at(document, position)?;
    let index = document.index();
    let symbol = index.symbol(id);
    let of_robot = || {
        let within =
            |span: Span| symbol.declaration.start <= span.start && span.end <= symbol.declaration.end;
        let uses = index.occurrences().iter().filter(|o| within(o.span)).map(|o| index.symbol(o.symbol));
        uses.into_iter().find(|s| s.kind == SymbolKind::Dynamics)
    };
    let kind: &Symbol = match (symbol.kind, symbol.parent) {
        (SymbolKind::Robot, _) => of_robot()?,
        (_, Some(parent)) => index.symbol(parent),
        _ => symbol,
    };
    Some(GotoDefinitionResponse::Scalar(location(document, kind.place)))
}

/// Where the name at a position is used, and, if wanted, where it is declared.
pub fn references(document: &Document, position: Position, with_declaration: bool) -> Option<Vec<Location>> {
    let (symbol, _) = symbol_at(document, position)?;
    let all = document.index().occurrences_of(symbol);
    let wanted = all.filter(|o| with_declaration || o.role != Role::Declaration);
    Some(wanted.map(|o| location(document, o.span)).collect())
}

fn location(document: &Document, span: Span) -> Location {
    Location { uri: document.uri.clone(), range: document.range(span) }
}
