//! The mission's one name space: who declares what, and which name was meant.

use std::collections::BTreeMap;

use crate::source::Span;
use crate::syntax::ast::{File, Item, ItemKind, Name};
use crate::syntax::words::PREDECLARED;

/// Whether a name is one of the predeclared ones.
pub(super) fn is_predeclared(name: &str) -> bool {
    PREDECLARED.contains(&name)
}

/// What a name was declared as.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    Param,
    Let,
    Region,
    Obstacle,
    Jammer,
    Base,
    Dynamics,
    Robot,
    Team,
    Goal,
    Define,
}

impl Kind {
    /// The noun that messages use.
    pub(super) fn noun(self) -> &'static str {
        match self {
            Kind::Param => "parameter",
            Kind::Let => "constant",
            Kind::Region => "region",
            Kind::Obstacle => "obstacle",
            Kind::Jammer => "jammer",
            Kind::Base => "base",
            Kind::Dynamics => "dynamics model",
            Kind::Robot => "robot",
            Kind::Team => "team",
            Kind::Goal => "goal",
            Kind::Define => "defined formula",
        }
    }

    /// The noun with its article.
    pub(super) fn a_noun(self) -> String {
        let article = if self == Kind::Obstacle { "an" } else { "a" };
        format!("{article} {}", self.noun())
    }
}

/// A declared name.
#[derive(Clone, Copy, Debug)]
pub(super) struct Symbol {
    /// What it names.
    pub(super) kind: Kind,
    /// The index of its declaration in the file.
    pub(super) item: usize,
    /// Where the name stands in its declaration.
    pub(super) span: Span,
    /// Whether something refers to it.
    pub(super) used: bool,
}

/// All declared names.
#[derive(Default)]
pub(super) struct Names {
    table: BTreeMap<String, Symbol>,
}

impl Names {
    /// The names that a file declares; the second declaration of each pair goes to `duplicate`.
    pub(super) fn collect(file: &File, mut duplicate: impl FnMut(&Name, Kind, Symbol)) -> Names {
        let mut names = Names::default();
        for (item, declaration) in file.items.iter().enumerate() {
            let Some((name, kind)) = declared(declaration) else { continue };
            match names.table.get(&name.text) {
                Some(first) => duplicate(name, kind, *first),
                None => {
                    let symbol = Symbol { kind, item, span: name.span, used: false };
                    names.table.insert(name.text.clone(), symbol);
                }
            }
        }
        names
    }

    /// The declaration of a name.
    pub(super) fn get(&self, name: &str) -> Option<Symbol> {
        self.table.get(name).copied()
    }

    /// Notes that a name is in use.
    pub(super) fn mark_used(&mut self, name: &str) {
        if let Some(symbol) = self.table.get_mut(name) {
            symbol.used = true;
        }
    }

    /// All names with their declarations, in alphabetical order.
    pub(super) fn iter(&self) -> impl Iterator<Item = (&str, Symbol)> {
        self.table.iter().map(|(name, symbol)| (name.as_str(), *symbol))
    }

    /// The name of one of these kinds that is most like the one written, if any is like it at all.
    pub(super) fn nearest(&self, written: &str, kinds: &[Kind]) -> Option<&str> {
        let candidates = self.iter().filter(|(_, s)| kinds.contains(&s.kind)).map(|(name, _)| name);
        nearest(written, candidates)
    }
}

/// The name and kind that a declaration declares.
pub(super) fn declared(item: &Item) -> Option<(&Name, Kind)> {
    match &item.kind {
        ItemKind::Param { name, .. } => Some((name, Kind::Param)),
        ItemKind::Let { name, .. } => Some((name, Kind::Let)),
        ItemKind::Region { name, .. } => Some((&name.name, Kind::Region)),
        ItemKind::Obstacle { name, .. } => Some((&name.name, Kind::Obstacle)),
        ItemKind::Jammer { name, .. } => Some((&name.name, Kind::Jammer)),
        ItemKind::Base { name, .. } => Some((&name.name, Kind::Base)),
        ItemKind::Dynamics { name, .. } => Some((name, Kind::Dynamics)),
        ItemKind::Robot { name, .. } => Some((&name.name, Kind::Robot)),
        ItemKind::Team { name, .. } => Some((name, Kind::Team)),
        ItemKind::Goal { name, .. } => Some((name, Kind::Goal)),
        ItemKind::Define { name, .. } => Some((name, Kind::Define)),
        _ => None,
    }
}

/// The candidate that is most like the written word, if any is like it at all.
pub(super) fn nearest<'a>(written: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let length = written.chars().count();
    let limit = (1 + length / 4).min(length.saturating_sub(1));
    candidates
        .map(|c| (edit_distance(written, c), c))
        .filter(|(distance, _)| *distance <= limit)
        .min()
        .map(|(_, candidate)| candidate)
}

/// The least number of inserted, deleted, changed and swapped neighbouring characters, case aside.
fn edit_distance(a: &str, b: &str) -> usize {
    let a: Vec<char> = a.to_lowercase().chars().collect();
    let b: Vec<char> = b.to_lowercase().chars().collect();
    let mut before = vec![0; b.len() + 1];
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 0..a.len() {
        let mut row = vec![i + 1];
        for j in 0..b.len() {
            let change = last[j] + usize::from(a[i] != b[j]);
            let mut least = change.min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j] {
                least = least.min(before[j - 1] + 1);
            }
            row.push(least);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(written: &str, candidates: &[&str], expect: Option<&str>) {
        assert_eq!(nearest(written, candidates.iter().copied()), expect);
    }

    #[test]
    fn the_nearest_name_is_suggested_and_a_far_one_is_not() {
        check("pi_1", &["pi1", "pi2"], Some("pi1"));
        check("sorce", &["source", "sink"], Some("source"));
        check("Depot", &["depot"], Some("depot"));
        check("ab", &["ba"], Some("ba"));
        check("storage", &["R1", "lab"], None);
        check("x", &[], None);
        check("x", &["y", "X"], Some("X"));
    }
}
