//! What the tests share: missions of the repository, and a parser for them.

#![allow(dead_code, reason = "no test program uses all of it")]

use std::fs;
use std::path::{Path, PathBuf};

use tree_sitter::{Language, Node, Parser, Tree};

/// The repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("editors/tree-sitter")
}

/// The language.
pub fn language() -> Language {
    tree_sitter_dosm::LANGUAGE.into()
}

/// A parser for it.
pub fn parser() -> Parser {
    let mut parser = Parser::new();
    parser.set_language(&language()).expect("a version that this library reads");
    parser
}

/// The tree of a text.
pub fn parse(text: impl AsRef<[u8]>) -> Tree {
    parser().parse(text, None).expect("no time limit")
}

/// The first ERROR or MISSING node of a tree, as a place and a word.
pub fn first_error(tree: &Tree) -> Option<String> {
    let mut cursor = tree.walk();
    loop {
        let node = cursor.node();
        if node.is_error() || node.is_missing() {
            let start = node.start_position();
            let what = if node.is_missing() { "MISSING " } else { "" };
            return Some(format!("{}:{} {what}{}", start.row + 1, start.column + 1, node.kind()));
        }
        let into = node.has_error() && cursor.goto_first_child();
        while !into && !cursor.goto_next_sibling() {
            if !cursor.goto_parent() {
                return None;
            }
        }
    }
}

/// A mission: where it lies below the repository, and its bytes.
pub struct Mission {
    /// The path, with `/`.
    pub path: String,
    /// What is in the file.
    pub bytes: Vec<u8>,
}

impl Mission {
    /// Whether the compiler's parser takes it; `cargo test --test editors` holds the names to that.
    pub fn is_accepted(&self) -> bool {
        !self.path.starts_with("tests/missions/err/syntax_")
    }
}

/// All missions of the examples and of the tests, in order.
pub fn missions() -> Vec<Mission> {
    let mut found = Vec::new();
    for directory in ["examples", "tests/missions"] {
        collect(&root().join(directory), &mut found);
    }
    found.sort();
    assert!(found.len() > 250, "only {} missions", found.len());
    let read = |path: PathBuf| Mission {
        bytes: fs::read(&path).expect("a mission"),
        path: path.strip_prefix(root()).expect("below").to_string_lossy().replace('\\', "/"),
    };
    found.into_iter().map(read).collect()
}

fn collect(directory: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(directory).expect("a directory") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(&path, found);
        } else if path.extension().is_some_and(|e| e == "dosm") {
            found.push(path);
        }
    }
}

/// A tree as an S-expression with field names, children indented below their parents.
pub fn shown(node: Node) -> String {
    let mut out = String::new();
    show(node, None, 0, &mut out);
    out
}

fn show(node: Node, field: Option<&str>, depth: usize, out: &mut String) {
    out.push_str(&"  ".repeat(depth));
    if let Some(field) = field {
        out.push_str(field);
        out.push_str(": ");
    }
    let missing = if node.is_missing() { "MISSING " } else { "" };
    out.push_str(&format!("({missing}{}", node.kind()));
    for i in 0..node.child_count() {
        let child = node.child(i as u32).expect("a child");
        if child.is_named() || child.is_missing() {
            out.push('\n');
            show(child, node.field_name_for_child(i as u32), depth + 1, out);
        }
    }
    out.push(')');
}
