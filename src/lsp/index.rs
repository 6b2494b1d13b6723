//! Where each name of a mission is declared and used, from the syntax tree alone.
//!
//! The tree of a mission with errors lacks the declarations that could not be read; everything else is
//! indexed all the same, and the names that broken declarations were to declare are known. Scoping is
//! the language's: one global name space, signals that belong to their model, bound variables that hide
//! outer names, and coordinates that come first in `where`.

mod declared;
#[cfg(test)]
mod tests;
mod uses;
mod words;

use std::collections::BTreeMap;

use crate::entity::{EntityId, Table};
use crate::entity_id;
use crate::source::Span;
use crate::syntax::ast::File;

entity_id!(
    /// A symbol of an [`Index`].
    SymbolId, "symbol"
);

/// What a name names.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum SymbolKind {
    /// `mission NAME`
    Mission,
    /// `param`
    Parameter,
    /// `let`
    Constant,
    /// `region`
    Region,
    /// `obstacle`, opaque or not
    Obstacle,
    /// `jammer`
    Jammer,
    /// `base`
    Base,
    /// `dynamics`
    Dynamics,
    /// `robot`
    Robot,
    /// `team`
    Team,
    /// `goal`
    Goal,
    /// `define`
    Define,
    /// A state of a model.
    State,
    /// An input of a model.
    Input,
    /// A mode of a model.
    Mode,
    /// `A`, `B` or `c` of a model or a mode.
    Matrix,
    /// An index of a family or of a quantifier: a whole number.
    IndexVariable,
    /// The robot that a quantifier or a count speaks of.
    RobotVariable,
}

impl SymbolKind {
    /// What people call it.
    pub fn noun(self) -> &'static str {
        match self {
            SymbolKind::Mission => "mission",
            SymbolKind::Parameter => "parameter",
            SymbolKind::Constant => "constant",
            SymbolKind::Region => "region",
            SymbolKind::Obstacle => "obstacle",
            SymbolKind::Jammer => "jammer",
            SymbolKind::Base => "base station",
            SymbolKind::Dynamics => "dynamics model",
            SymbolKind::Robot => "robot",
            SymbolKind::Team => "team",
            SymbolKind::Goal => "goal",
            SymbolKind::Define => "defined formula",
            SymbolKind::State => "state",
            SymbolKind::Input => "input",
            SymbolKind::Mode => "mode",
            SymbolKind::Matrix => "matrix",
            SymbolKind::IndexVariable => "index",
            SymbolKind::RobotVariable => "robot variable",
        }
    }

    /// Whether names of this kind are declared in the mission's one name space.
    pub fn is_global(self) -> bool {
        (SymbolKind::Parameter..=SymbolKind::Define).contains(&self)
    }
}

/// A named thing.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Symbol {
    /// Its name, without indices.
    pub name: String,
    /// What it is.
    pub kind: SymbolKind,
    /// The declared name. For the signals that `integrator` brings along, which nothing in the text
    /// names, the item `integrator`.
    pub place: Span,
    /// The whole declaration, without its comment.
    pub declaration: Span,
    /// The documentation comment's text.
    pub doc: Option<String>,
    /// The index of the item in [`File::items`] that it is declared in; `None` when that could not be read.
    pub item: Option<usize>,
    /// What it belongs to: the model of a signal, mode or matrix, the mode of its matrix.
    pub parent: Option<SymbolId>,
    /// Where it can be used, when not in the whole mission: bound variables.
    pub scope: Option<Span>,
    /// The names of the indices, where it is a family.
    pub indices: Vec<String>,
    /// Whether the text declares it: not so the signals of an `integrator`.
    pub is_written: bool,
}

impl Symbol {
    /// Whether it may get another name: not so what the language itself calls by its name.
    pub fn is_renamable(&self) -> bool {
        self.is_written && self.kind != SymbolKind::Matrix
    }
}

/// What an occurrence does with its symbol.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Role {
    /// Declares it.
    Declaration,
    /// Gives it a value: a robot's start, a state or input in `bound` or `disturbance`.
    Write,
    /// Mentions it.
    Read,
    /// Mentions it, as far as can be told from a declaration that can't be read.
    Guess,
}

/// A place where a name stands.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Occurrence {
    /// The name, without indices.
    pub span: Span,
    /// What it means there.
    pub symbol: SymbolId,
    /// What it does there.
    pub role: Role,
}

impl Occurrence {
    /// Whether it declares its symbol.
    pub fn is_declaration(&self) -> bool {
        self.role == Role::Declaration
    }
}

/// A name that the language gives a meaning to where it stands.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Builtin {
    /// `x`, `y` or `z` in `where`.
    Coordinate,
    /// `pi`
    Constant,
    /// `sqrt` and the like.
    Function,
    /// `all`
    All,
}

/// The names of a mission.
#[derive(Clone, Debug, Default)]
pub struct Index {
    symbols: Table<SymbolId, Symbol>,
    /// In the order of their places; no two overlap.
    occurrences: Vec<Occurrence>,
    /// Places in `occurrences`, by symbol, then in order.
    by_symbol: Vec<u32>,
    /// Where each symbol's part of `by_symbol` begins, and the end of the last.
    starts: Vec<u32>,
    builtins: Vec<(Span, Builtin)>,
    unresolved: Vec<Span>,
    globals: BTreeMap<String, SymbolId>,
    signals: BTreeMap<(SymbolId, String), SymbolId>,
}

impl Index {
    /// The names of a mission. Declarations that can't be read count with the name that they declare.
    pub fn new(file: &File) -> Index {
        let mut index = Index::default();
        index.declare(file);
        index.resolve(file);
        index.finish();
        index
    }

    /// The names of a mission, with guesses at those that stand in declarations that can't be read.
    pub fn with_text(file: &File, text: &str) -> Index {
        let mut index = Index::default();
        index.declare(file);
        index.resolve(file);
        index.guess(file, text);
        index.finish();
        index
    }

    /// Sorts what was found, so that it can be looked up.
    fn finish(&mut self) {
        self.occurrences.sort_by_key(|o| o.span);
        self.occurrences.dedup_by_key(|o| o.span);
        self.builtins.sort_by_key(|b| b.0);
        self.unresolved.sort();
        self.starts = vec![0; self.symbols.len() + 1];
        for occurrence in &self.occurrences {
            self.starts[occurrence.symbol.index() + 1] += 1;
        }
        for i in 1..self.starts.len() {
            self.starts[i] += self.starts[i - 1];
        }
        let mut next = self.starts.clone();
        self.by_symbol = vec![0; self.occurrences.len()];
        for (place, occurrence) in self.occurrences.iter().enumerate() {
            let slot = &mut next[occurrence.symbol.index()];
            self.by_symbol[*slot as usize] = place as u32;
            *slot += 1;
        }
    }

    /// A symbol of this index.
    pub fn symbol(&self, id: SymbolId) -> &Symbol {
        &self.symbols[id]
    }

    /// All symbols: those of the global name space in the order of their declarations, each followed by
    /// those that belong to it; then bound variables and implicit signals.
    pub fn symbols(&self) -> impl Iterator<Item = (SymbolId, &Symbol)> {
        self.symbols.iter()
    }

    /// All occurrences in the order of their places.
    pub fn occurrences(&self) -> &[Occurrence] {
        &self.occurrences
    }

    /// The occurrences of one symbol, in the order of their places.
    pub fn occurrences_of(&self, id: SymbolId) -> impl Iterator<Item = &Occurrence> {
        let range = match (self.starts.get(id.index()), self.starts.get(id.index() + 1)) {
            (Some(&from), Some(&to)) => from as usize..to as usize,
            _ => 0..0,
        };
        self.by_symbol[range].iter().map(|&place| &self.occurrences[place as usize])
    }

    /// The occurrence that a cursor at a byte offset touches; one that begins there is preferred.
    pub fn at(&self, offset: u32) -> Option<&Occurrence> {
        touching(&self.occurrences, |o| o.span, offset)
    }

    /// The name of the language that a cursor at a byte offset touches, with its place.
    pub fn builtin_at(&self, offset: u32) -> Option<(Span, Builtin)> {
        touching(&self.builtins, |b| b.0, offset).copied()
    }

    /// All names that the language gives a meaning to, in the order of their places.
    pub fn builtins(&self) -> &[(Span, Builtin)] {
        &self.builtins
    }

    /// The names that nothing declares, in the order of their places.
    pub fn unresolved(&self) -> &[Span] {
        &self.unresolved
    }

    /// The symbol of the global name space with this name; the first one where it is declared twice.
    pub fn global(&self, name: &str) -> Option<SymbolId> {
        self.globals.get(name).copied()
    }

    /// The state or input of a model with this name.
    pub fn signal(&self, model: SymbolId, name: &str) -> Option<SymbolId> {
        self.signals.get(&(model, name.to_string())).copied()
    }

    /// The states and inputs of a model, in alphabetical order.
    pub fn signals(&self, model: SymbolId) -> impl Iterator<Item = SymbolId> {
        let of_model = self.signals.range((model, String::new())..);
        of_model.take_while(move |((owner, _), _)| *owner == model).map(|(_, &signal)| signal)
    }
}

/// The element whose span touches an offset, among elements in order that don't overlap.
fn touching<T>(list: &[T], span: impl Fn(&T) -> Span, offset: u32) -> Option<&T> {
    let after = list.partition_point(|e| span(e).start <= offset);
    let last = list.get(after.checked_sub(1)?)?;
    (offset <= span(last).end).then_some(last)
}
