//! The mission's names that fit a place.

use crate::lsp::document::Document;
use crate::lsp::index::{Symbol, SymbolKind};
use crate::lsp::outline;

use super::candidates::{Candidate, Candidates, Kind};
use super::place::Place;

/// Adds names to candidates.
pub(super) struct Names<'c, 't> {
    candidates: &'c mut Candidates<'t>,
}

impl<'c, 't> Names<'c, 't> {
    pub(super) fn new(candidates: &'c mut Candidates<'t>) -> Names<'c, 't> {
        Names { candidates }
    }

    /// The names of some kinds.
    pub(super) fn of_kinds(&mut self, kinds: &[SymbolKind]) {
        self.each(kinds, |document, symbol| vec![candidate(document, symbol)]);
    }

    /// Regions; of families the members.
    pub(super) fn regions(&mut self) {
        self.each(&[SymbolKind::Region], members);
    }

    /// Robots and members of families; where a set is wanted, families and teams too.
    pub(super) fn robots(&mut self, sets: bool) {
        if sets {
            self.of_kinds(&[SymbolKind::Robot, SymbolKind::Team]);
        }
        self.each(&[SymbolKind::Robot], members);
    }

    fn each(&mut self, kinds: &[SymbolKind], one: impl Fn(&Document, &Symbol) -> Vec<Candidate>) {
        let document = self.candidates.document;
        let place = self.candidates.place;
        let index = document.index();
        let fitting = index.symbols().filter(|(_, symbol)| kinds.contains(&symbol.kind));
        for (_, symbol) in fitting.filter(|(_, symbol)| !is_here(place, symbol)) {
            self.candidates.list.extend(one(document, symbol));
        }
    }
}

/// Whether it is the word that is typed that declares a symbol: then it is no name yet.
fn is_here(place: &Place<'_>, symbol: &Symbol) -> bool {
    place.word.start < place.word.end && symbol.place.start == place.word.start
}

fn candidate(document: &Document, symbol: &Symbol) -> Candidate {
    Candidate {
        doc: symbol.doc.clone(),
        ..Candidate::new(symbol.name.clone(), Kind::Name(symbol.kind)).with_detail(detail(document, symbol))
    }
}

/// A symbol, or what names a member of a family: `fleet[i]` to fill in.
fn members(document: &Document, symbol: &Symbol) -> Vec<Candidate> {
    let plain = candidate(document, symbol);
    if symbol.indices.is_empty() {
        return vec![plain];
    }
    let label = format!("{}[{}]", symbol.name, symbol.indices.join(", "));
    let places: Vec<String> =
        symbol.indices.iter().enumerate().map(|(at, index)| format!("${{{}:{index}}}", at + 1)).collect();
    let snippet = format!("{}[{}]", symbol.name, places.join(", "));
    vec![Candidate { label, snippet: Some(snippet), ..plain }]
}

/// What it is, and what its declaration says of it.
fn detail(document: &Document, symbol: &Symbol) -> String {
    let noun = symbol.kind.noun();
    let behind = outline::behind(&document.source, symbol.declaration, symbol.place);
    if symbol.kind == SymbolKind::Dynamics || behind.is_empty() {
        return noun.to_string();
    }
    format!("{noun}: {behind}")
}
