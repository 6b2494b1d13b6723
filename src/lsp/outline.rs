//! What a mission declares, as a tree: the outline beside an editor's text.

use lsp_types::{DocumentSymbol, DocumentSymbolResponse, Location, SymbolInformation, SymbolKind};

use super::document::Document;
use super::session::Client;
use crate::source::{SourceFile, Span};
use crate::syntax::ast::{
    Broken, Connectivity, ConnectivityItem, ConnectivityKind, Doc, DynamicsItem, DynamicsKind, FamilyName,
    File, Item, ItemKind, Name, Signal,
};

/// The longest detail, in characters.
const MAX_DETAIL: usize = 60;

/// A node of the outline.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Node {
    /// What it is called; for what has no name, its keyword.
    pub name: String,
    /// What stands behind the name, shortened.
    pub detail: String,
    /// What it is to an editor.
    pub kind: SymbolKind,
    /// All of it, with its comment.
    pub whole: Span,
    /// The name.
    pub place: Span,
    /// What it consists of.
    pub children: Vec<Node>,
}

/// The outline of a document; flat where the client knows no trees.
pub fn outline(document: &Document, client: Client) -> DocumentSymbolResponse {
    let nodes = document.file().map_or_else(Vec::new, |file| nodes(file, &document.source));
    if client.symbol_trees {
        DocumentSymbolResponse::Nested(nodes.iter().map(|node| nested(document, node)).collect())
    } else {
        let mut flat = Vec::new();
        nodes.iter().for_each(|node| flatten(document, node, None, &mut flat));
        DocumentSymbolResponse::Flat(flat)
    }
}

/// The outline's nodes, in the order of their places.
pub fn nodes(file: &File, source: &SourceFile) -> Vec<Node> {
    let read = file.items.iter().filter_map(|item| declaration(source, item));
    let lost = file.broken.iter().filter_map(|broken| unread(source, broken));
    let mut nodes: Vec<Node> = read.chain(lost).collect();
    nodes.sort_by_key(|node| node.whole);
    nodes
}

#[expect(deprecated, reason = "the protocol's type has a field that is not used any more")]
fn nested(document: &Document, node: &Node) -> DocumentSymbol {
    let children: Vec<DocumentSymbol> = node.children.iter().map(|child| nested(document, child)).collect();
    DocumentSymbol {
        name: node.name.clone(),
        detail: (!node.detail.is_empty()).then(|| node.detail.clone()),
        kind: node.kind,
        tags: None,
        deprecated: None,
        range: document.range(node.whole),
        selection_range: document.range(node.place),
        children: (!children.is_empty()).then_some(children),
    }
}

fn flatten(document: &Document, node: &Node, container: Option<&str>, flat: &mut Vec<SymbolInformation>) {
    let location = Location { uri: document.uri.clone(), range: document.range(node.whole) };
    flat.push(information(node, container, location));
    node.children.iter().for_each(|child| flatten(document, child, Some(&node.name), flat));
}

/// A node as an entry of a flat list.
#[expect(deprecated, reason = "the protocol's type has a field that is not used any more")]
pub fn information(node: &Node, container: Option<&str>, location: Location) -> SymbolInformation {
    SymbolInformation {
        name: node.name.clone(),
        kind: node.kind,
        tags: None,
        deprecated: None,
        location,
        container_name: container.map(str::to_string),
    }
}

/// Where something with its comment lies.
fn whole(span: Span, doc: &Option<Doc>) -> Span {
    doc.as_ref().map_or(span, |doc| doc.span.to(span))
}

/// The first word of a span.
fn first_word(source: &SourceFile, span: Span) -> Span {
    let text = source.slice(span);
    let length = text.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(text.len());
    Span::new(span.start as usize, span.start as usize + length)
}

/// What stands behind a place in a declaration, on one line and not too long.
pub fn behind(source: &SourceFile, declaration: Span, place: Span) -> String {
    let rest = source.slice(Span { start: place.end.min(declaration.end), end: declaration.end });
    let mut shown = String::new();
    for word in rest.trim_start().trim_start_matches(['=', ':']).split_whitespace() {
        if shown.chars().count() + word.chars().count() >= MAX_DETAIL {
            return shown + " …";
        }
        if !shown.is_empty() {
            shown.push(' ');
        }
        shown.push_str(word);
    }
    shown
}

fn node(source: &SourceFile, name: &Name, kind: SymbolKind, span: Span, doc: &Option<Doc>) -> Node {
    Node {
        name: name.text.clone(),
        detail: behind(source, span, name.span),
        kind,
        whole: whole(span, doc),
        place: name.span,
        children: Vec::new(),
    }
}

/// Something that its keyword names.
fn setting(source: &SourceFile, span: Span, doc: &Option<Doc>) -> Node {
    let place = first_word(source, span);
    let name = Name { text: source.slice(place).to_string(), span: place };
    node(source, &name, SymbolKind::PROPERTY, span, doc)
}

/// A declared name with its indices.
fn family(source: &SourceFile, name: &FamilyName, kind: SymbolKind, item: &Item) -> Node {
    let plain = node(source, &name.name, kind, item.span, &item.doc);
    let indices: Vec<&str> = name.indices.iter().map(|index| index.variable.text.as_str()).collect();
    if indices.is_empty() {
        return plain;
    }
    Node { name: format!("{}[{}]", plain.name, indices.join(", ")), ..plain }
}

fn declaration(source: &SourceFile, item: &Item) -> Option<Node> {
    let plain = |name: &Name, kind| node(source, name, kind, item.span, &item.doc);
    let of_family = |name: &FamilyName, kind| family(source, name, kind, item);
    let setting = || setting(source, item.span, &item.doc);
    Some(match &item.kind {
        ItemKind::Edition(_) => return None,
        ItemKind::Mission(name) => plain(name, SymbolKind::MODULE),
        ItemKind::Param { name, .. } | ItemKind::Let { name, .. } => plain(name, SymbolKind::CONSTANT),
        ItemKind::Region { name, .. } => of_family(name, SymbolKind::STRUCT),
        ItemKind::Obstacle { name, .. } | ItemKind::Jammer { name, .. } => {
            of_family(name, SymbolKind::OBJECT)
        }
        ItemKind::Base { name, .. } => of_family(name, SymbolKind::INTERFACE),
        ItemKind::Dynamics { name, items } => Node {
            children: items.iter().flat_map(|item| dynamics_item(source, item)).collect(),
            detail: String::new(),
            ..plain(name, SymbolKind::CLASS)
        },
        ItemKind::Robot { name, .. } => of_family(name, SymbolKind::VARIABLE),
        ItemKind::Team { name, .. } => plain(name, SymbolKind::ARRAY),
        ItemKind::Connectivity(Connectivity::Items(items)) => Node {
            children: items.iter().map(|item| connectivity_item(source, item)).collect(),
            detail: String::new(),
            ..setting()
        },
        ItemKind::Goal { name, .. } => plain(name, SymbolKind::EVENT),
        ItemKind::Define { name, .. } => plain(name, SymbolKind::FUNCTION),
        ItemKind::Workspace(_) => Node { kind: SymbolKind::NAMESPACE, ..setting() },
        ItemKind::Separation(_)
        | ItemKind::Connectivity(Connectivity::None)
        | ItemKind::Horizon { .. }
        | ItemKind::Minimize(_) => setting(),
    })
}

/// A declaration that can't be read, by the name that it was to declare.
fn unread(source: &SourceFile, broken: &Broken) -> Option<Node> {
    let name = broken.name.as_ref()?;
    let kind = match broken.keyword.as_str() {
        "mission" => SymbolKind::MODULE,
        "param" | "let" => SymbolKind::CONSTANT,
        "region" => SymbolKind::STRUCT,
        "obstacle" | "jammer" => SymbolKind::OBJECT,
        "base" => SymbolKind::INTERFACE,
        "dynamics" => SymbolKind::CLASS,
        "team" => SymbolKind::ARRAY,
        "goal" => SymbolKind::EVENT,
        "define" => SymbolKind::FUNCTION,
        _ => SymbolKind::VARIABLE,
    };
    // Its place may lie at the end of what is broken.
    let span = broken.span.to(name.span);
    Some(Node { detail: String::new(), ..node(source, name, kind, span, &None) })
}

fn dynamics_item(source: &SourceFile, item: &DynamicsItem) -> Vec<Node> {
    match &item.kind {
        DynamicsKind::State(signals) => {
            signals.iter().map(|s| signal(source, s, SymbolKind::FIELD)).collect()
        }
        DynamicsKind::Input(signals) => {
            signals.iter().map(|s| signal(source, s, SymbolKind::PROPERTY)).collect()
        }
        DynamicsKind::Matrix { letter, .. } => {
            vec![node(source, letter, SymbolKind::ARRAY, item.span, &item.doc)]
        }
        DynamicsKind::Mode { name, items, .. } => vec![Node {
            children: items.iter().flat_map(|item| dynamics_item(source, item)).collect(),
            detail: String::new(),
            ..node(source, name, SymbolKind::NAMESPACE, item.span, &item.doc)
        }],
        DynamicsKind::Step(_)
        | DynamicsKind::Position(_)
        | DynamicsKind::Continuous
        | DynamicsKind::Integrator(_)
        | DynamicsKind::Bound { .. }
        | DynamicsKind::BoundWhere(_)
        | DynamicsKind::Disturbance { .. }
        | DynamicsKind::Rejection(_) => vec![setting(source, item.span, &item.doc)],
    }
}

fn signal(source: &SourceFile, signal: &Signal, kind: SymbolKind) -> Node {
    node(source, &signal.name, kind, signal.name.span.to(signal.unit.span), &signal.doc)
}

fn connectivity_item(source: &SourceFile, item: &ConnectivityItem) -> Node {
    match item.kind {
        ConnectivityKind::Hops(_)
        | ConnectivityKind::Range { .. }
        | ConnectivityKind::Redundancy(_)
        | ConnectivityKind::Every(_) => setting(source, item.span, &None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::driver::Overrides;
    use crate::lsp::lines::Encoding;

    fn document(text: &str) -> Document {
        let uri = "file:///tmp/m.dosm".parse().expect("it is a URI");
        Document::new(uri, 1, text.into(), Encoding::Utf16, Overrides::default())
    }

    fn all(document: &Document) -> Vec<Node> {
        document.file().map_or_else(Vec::new, |file| nodes(file, &document.source))
    }

    /// The outline on lines, children indented, with their details.
    fn shown(nodes: &[Node], indent: &str) -> String {
        let one = |n: &Node| {
            let children = shown(&n.children, &format!("{indent}  "));
            format!("{indent}{:?} {} | {}\n{children}", n.kind, n.name, n.detail)
        };
        nodes.iter().map(one).collect()
    }

    const TEXT: &str = "dosm 1 workspace box (0, 0) .. (9, 9)
/// What for.
region a[i in 1..2, j in 1..3] = box (i, j) .. (9, 9)
dynamics D { step 0.5 s state px: m, /// fast
 vx: m/s A = [1, 2;\n 3, 4] bound px in [1, 2] mode fast when { px >= 1 } { A = [1] } }
region broken = bax (1, 2)
connectivity { hops <= 3 range 6 m }
goal g: always eventually exists r in all: (r in a[1, 1] until r in a[1, 2]) and not r in a[2, 2]";

    #[test]
    fn the_outline_has_blocks_with_their_items() {
        let outline = shown(&all(&document(TEXT)), "");
        assert_eq!(
            outline,
            "Namespace workspace | box (0, 0) .. (9, 9)
Struct a[i, j] | [i in 1..2, j in 1..3] = box (i, j) .. (9, 9)
Class D | 
  Property step | 0.5 s
  Field px | m
  Field vx | m/s
  Array A | [1, 2; 3, 4]
  Property bound | px in [1, 2]
  Namespace fast | 
    Array A | [1]
Struct broken | 
Property connectivity | 
  Property hops | <= 3
  Property range | 6 m
Event g | always eventually exists r in all: (r in a[1, 1] until r in …
"
        );
    }

    /// Each node lies in its parent, and its name in it.
    fn check_nesting(nodes: &[Node], parent: Span) {
        for node in nodes {
            assert!(
                parent.start <= node.whole.start && node.whole.end <= parent.end,
                "{node:?} in {parent:?}"
            );
            assert!(node.whole.start <= node.place.start && node.place.end <= node.whole.end, "{node:?}");
            check_nesting(&node.children, node.whole);
        }
    }

    #[test]
    fn ranges_lie_within_each_other_also_in_texts_that_are_cut_off() {
        for end in 0..TEXT.len() {
            let document = document(&TEXT[..end]);
            check_nesting(&all(&document), Span::new(0, end));
        }
        let all = all(&document(TEXT));
        assert_eq!(&TEXT[all[1].whole.range()][..3], "///");
    }

    #[test]
    fn clients_without_trees_get_a_list() {
        let DocumentSymbolResponse::Flat(list) = outline(&document(TEXT), Client::default()) else {
            panic!("no list")
        };
        let px = list.iter().find(|entry| entry.name == "px").expect("it is there");
        assert_eq!(px.container_name.as_deref(), Some("D"));
    }
}
