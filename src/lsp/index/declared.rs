//! The first pass: everything that is declared, so that uses may come before.

use crate::lsp::index::{Index, Occurrence, Role, Symbol, SymbolId, SymbolKind};
use crate::source::Span;
use crate::syntax::ast::{
    Broken, Doc, DynamicsItem, DynamicsKind, ExprKind, FamilyName, File, Item, ItemKind, Name, Signal,
};
use crate::syntax::words::COORDINATES;

/// The names of a position and its derivatives along an axis, as `integrator` calls its signals.
const CHAIN: [&str; 5] = ["p", "v", "a", "j", "s"];

impl Index {
    /// Takes down the declarations of a file, broken ones too, as if in the order in which they stand.
    pub(super) fn declare(&mut self, file: &File) {
        let mut broken = file.broken.iter().peekable();
        for (place, item) in file.items.iter().enumerate() {
            while let Some(lost) = broken.next_if(|b| b.span.start < item.span.start) {
                self.declare_broken(lost);
            }
            self.declare_item(place, item);
        }
        broken.for_each(|lost| self.declare_broken(lost));
    }

    fn declare_item(&mut self, place: usize, item: &Item) {
        let Some((name, kind)) = declared(&item.kind) else { return };
        let id = self.add(Symbol {
            item: Some(place),
            indices: family(&item.kind).map_or_else(Vec::new, variables),
            ..symbol(name, kind, item.span, &item.doc)
        });
        if kind.is_global() {
            self.globals.entry(name.text.clone()).or_insert(id);
        }
        if let ItemKind::Dynamics { items, .. } = &item.kind {
            self.declare_parts(id, place, items);
        }
    }

    fn declare_broken(&mut self, broken: &Broken) {
        let Some(name) = &broken.name else { return };
        let Some(kind) = kind_of_word(&broken.keyword) else { return };
        let id = self.add(symbol(name, kind, broken.span, &None));
        if kind.is_global() {
            self.globals.entry(name.text.clone()).or_insert(id);
        }
    }

    /// The states, inputs, modes and matrices of a model; the matrices of a mode.
    fn declare_parts(&mut self, parent: SymbolId, place: usize, items: &[DynamicsItem]) {
        for item in items {
            match &item.kind {
                DynamicsKind::State(list) => self.declare_signals(parent, place, SymbolKind::State, list),
                DynamicsKind::Input(list) => self.declare_signals(parent, place, SymbolKind::Input, list),
                DynamicsKind::Matrix { letter, .. } => {
                    let matrix = symbol(letter, SymbolKind::Matrix, item.span, &item.doc);
                    self.add(Symbol { item: Some(place), parent: Some(parent), ..matrix });
                }
                DynamicsKind::Mode { name, items, .. } => {
                    let mode = symbol(name, SymbolKind::Mode, item.span, &item.doc);
                    let mode = self.add(Symbol { item: Some(place), parent: Some(parent), ..mode });
                    self.declare_parts(mode, place, items);
                }
                DynamicsKind::Integrator(order) => {
                    let order = match &order.kind {
                        ExprKind::Number(order) => order.to_i64().and_then(|n| usize::try_from(n).ok()),
                        _ => None,
                    };
                    self.declare_chain(parent, place, item.span, order);
                }
                _ => {}
            }
        }
    }

    fn declare_signals(&mut self, model: SymbolId, place: usize, kind: SymbolKind, list: &[Signal]) {
        for signal in list {
            let span = signal.name.span.to(signal.unit.span);
            let symbol = symbol(&signal.name, kind, span, &signal.doc);
            let id = self.add(Symbol { item: Some(place), parent: Some(model), ..symbol });
            self.signals.entry((model, signal.name.text.clone())).or_insert(id);
        }
    }

    /// The signals that an `integrator` brings along; all that there may be where its order is no number.
    fn declare_chain(&mut self, model: SymbolId, place: usize, span: Span, order: Option<usize>) {
        for (derivative, letter) in CHAIN.iter().enumerate() {
            if order.is_some_and(|order| derivative > order) {
                break;
            }
            let kind = if order == Some(derivative) { SymbolKind::Input } else { SymbolKind::State };
            for axis in COORDINATES {
                let name = Name { text: format!("{letter}{axis}"), span };
                if self.signals.contains_key(&(model, name.text.clone())) {
                    continue;
                }
                let signal = symbol(&name, kind, span, &None);
                let id = self.symbols.push(Symbol {
                    item: Some(place),
                    parent: Some(model),
                    is_written: false,
                    ..signal
                });
                self.signals.insert((model, name.text), id);
            }
        }
    }

    /// Adds a symbol with the occurrence that declares it.
    pub(super) fn add(&mut self, symbol: Symbol) -> SymbolId {
        let span = symbol.place;
        let symbol = self.symbols.push(symbol);
        self.occurrences.push(Occurrence { span, symbol, role: Role::Declaration });
        symbol
    }
}

/// A symbol that belongs to nothing else.
pub(super) fn symbol(name: &Name, kind: SymbolKind, declaration: Span, doc: &Option<Doc>) -> Symbol {
    Symbol {
        name: name.text.clone(),
        kind,
        place: name.span,
        declaration,
        doc: doc.as_ref().map(|d| d.text.clone()),
        item: None,
        parent: None,
        scope: None,
        indices: Vec::new(),
        is_written: true,
    }
}

fn variables(name: &FamilyName) -> Vec<String> {
    name.indices.iter().map(|index| index.variable.text.clone()).collect()
}

/// The name that a declaration declares, and what it is.
fn declared(kind: &ItemKind) -> Option<(&Name, SymbolKind)> {
    Some(match kind {
        ItemKind::Mission(name) => (name, SymbolKind::Mission),
        ItemKind::Param { name, .. } => (name, SymbolKind::Parameter),
        ItemKind::Let { name, .. } => (name, SymbolKind::Constant),
        ItemKind::Region { name, .. } => (&name.name, SymbolKind::Region),
        ItemKind::Obstacle { name, .. } => (&name.name, SymbolKind::Obstacle),
        ItemKind::Jammer { name, .. } => (&name.name, SymbolKind::Jammer),
        ItemKind::Base { name, .. } => (&name.name, SymbolKind::Base),
        ItemKind::Dynamics { name, .. } => (name, SymbolKind::Dynamics),
        ItemKind::Robot { name, .. } => (&name.name, SymbolKind::Robot),
        ItemKind::Team { name, .. } => (name, SymbolKind::Team),
        ItemKind::Goal { name, .. } => (name, SymbolKind::Goal),
        ItemKind::Define { name, .. } => (name, SymbolKind::Define),
        ItemKind::Edition(_)
        | ItemKind::Workspace(_)
        | ItemKind::Separation(_)
        | ItemKind::Connectivity(_)
        | ItemKind::Horizon { .. }
        | ItemKind::Minimize(_) => return None,
    })
}

/// The name of a declaration that may declare a family.
pub(super) fn family(kind: &ItemKind) -> Option<&FamilyName> {
    match kind {
        ItemKind::Region { name, .. }
        | ItemKind::Obstacle { name, .. }
        | ItemKind::Jammer { name, .. }
        | ItemKind::Base { name, .. }
        | ItemKind::Robot { name, .. } => Some(name),
        _ => None,
    }
}

/// What the declarations that begin with a word declare.
fn kind_of_word(word: &str) -> Option<SymbolKind> {
    Some(match word {
        "mission" => SymbolKind::Mission,
        "param" => SymbolKind::Parameter,
        "let" => SymbolKind::Constant,
        "region" => SymbolKind::Region,
        "obstacle" => SymbolKind::Obstacle,
        "jammer" => SymbolKind::Jammer,
        "base" => SymbolKind::Base,
        "dynamics" => SymbolKind::Dynamics,
        "robot" => SymbolKind::Robot,
        "team" => SymbolKind::Team,
        "goal" => SymbolKind::Goal,
        "define" => SymbolKind::Define,
        _ => return None,
    })
}
