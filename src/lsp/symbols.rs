//! Symbols of all missions: those that are open, then those in the workspace's folders.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use lsp_types::{Location, Range, SymbolInformation, Uri, WorkspaceSymbolResponse};

use super::lines::{Encoding, Lines};
use super::location;
use super::outline::{self, Node};
use super::session::{Documents, Session, lock};
use crate::diag::Diagnostics;
use crate::source::SourceFile;
use crate::syntax;

/// The most symbols that are sent.
const MOST: usize = 512;

/// A symbol of a mission with its place.
struct Entry {
    node: Node,
    container: Option<String>,
    range: Range,
}

/// The symbols of missions in the workspace's folders that were looked through, with the texts that they were
/// found in.
#[derive(Default)]
pub struct Shelf {
    missions: Mutex<BTreeMap<PathBuf, Kept>>,
}

/// A text with the symbols in it.
type Kept = (String, Arc<Vec<Entry>>);

/// The symbols whose names have the query's letters in their order, the best matches first.
pub fn find(session: &Session, documents: &Documents, query: &str) -> WorkspaceSymbolResponse {
    let mut found: Vec<(u32, SymbolInformation)> = Vec::new();
    for document in documents.values() {
        let nodes = document.file().map_or_else(Vec::new, |file| outline::nodes(file, &document.source));
        add(&mut found, &document.uri, &entries(nodes, &document.lines), query);
    }
    let folders = session.folders();
    let missions = if folders.is_empty() { Vec::new() } else { session.host.missions(&folders) };
    let mut kept = lock(&session.shelf.missions);
    kept.retain(|path, _| missions.iter().any(|(other, _)| other == path));
    for (path, text) in missions {
        let Some(uri) = location::uri(&path) else { continue };
        // An editor may write a path in another way than we do.
        let is_open =
            documents.values().any(|d| d.uri == uri || location::path(&d.uri).as_deref() == Some(&*path));
        if is_open {
            continue;
        }
        let entries = match kept.get(&path) {
            Some((before, entries)) if *before == text => Arc::clone(entries),
            _ => {
                let entries = Arc::new(read(&path, &text, session.client.encoding));
                kept.insert(path, (text, Arc::clone(&entries)));
                entries
            }
        };
        add(&mut found, &uri, &entries, query);
    }
    // Open missions come before others with as good a match.
    found.sort_by_key(|(rank, _)| *rank);
    WorkspaceSymbolResponse::Flat(found.into_iter().take(MOST).map(|(_, symbol)| symbol).collect())
}

/// The symbols of a mission that is not open.
fn read(path: &Path, text: &str, encoding: Encoding) -> Vec<Entry> {
    let source = SourceFile::new(path.to_string_lossy(), text);
    let Ok(file) = syntax::parse(&source, &mut Diagnostics::new()) else { return Vec::new() };
    entries(outline::nodes(&file, &source), &Lines::new(text, encoding))
}

fn entries(nodes: Vec<Node>, lines: &Lines) -> Vec<Entry> {
    let mut list = Vec::new();
    let mut open: Vec<(Node, Option<String>)> = nodes.into_iter().rev().map(|node| (node, None)).collect();
    while let Some((mut node, container)) = open.pop() {
        let children = std::mem::take(&mut node.children);
        open.extend(children.into_iter().rev().map(|child| (child, Some(node.name.clone()))));
        list.push(Entry { range: lines.range(node.place), node, container });
    }
    list
}

fn add(found: &mut Vec<(u32, SymbolInformation)>, uri: &Uri, entries: &[Entry], query: &str) {
    for entry in entries {
        if let Some(rank) = rank(&entry.node.name, query) {
            let location = Location { uri: uri.clone(), range: entry.range };
            found.push((rank, outline::information(&entry.node, entry.container.as_deref(), location)));
        }
    }
}

/// How badly a name fits a query: 0 if it is the name, more if letters stand between; `None` if one is missing.
fn rank(name: &str, query: &str) -> Option<u32> {
    let lower = name.to_lowercase();
    let query = query.to_lowercase();
    if lower == query || query.is_empty() {
        return Some(0);
    }
    if lower.starts_with(&query) {
        return Some(1);
    }
    if lower.contains(&query) {
        return Some(2);
    }
    let mut letters = lower.chars();
    let mut rank = 3u32;
    for wanted in query.chars().filter(|c| !c.is_whitespace()) {
        rank = rank.saturating_add(letters.position(|letter| letter == wanted)? as u32);
    }
    Some(rank)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_ranked_by_how_well_they_fit() {
        let names = ["relay", "Relay2", "a_relay", "r1_early", "rally", "survey"];
        let mut ranked: Vec<(u32, &str)> =
            names.iter().filter_map(|n| Some((rank(n, "relay")?, *n))).collect();
        ranked.sort();
        assert_eq!(ranked.iter().map(|r| r.1).collect::<Vec<_>>(), ["relay", "Relay2", "a_relay"]);
        assert_eq!(rank("fleet_home", "fh"), Some(3 + 5));
        assert_eq!(rank("fleet", "tf"), None);
        assert_eq!(rank("aa", "aaa"), None);
        assert_eq!(rank("anything", ""), Some(0));
    }
}
