//! The queries of editors with names of captures of their own, written from `editors/tree-sitter/queries`.
//!
//! `DOSMC_UPDATE=1 cargo test --test editors queries` writes them anew. That they fit the grammar is tested with
//! the grammar, in `editors/tree-sitter`.

use std::fs;

use crate::common::package;

/// An editor's queries.
struct Target {
    /// Where they are.
    folder: &'static str,
    /// Which of the grammar's are taken.
    files: &'static [&'static str],
    /// What captures are called there, where it is something else.
    names: &'static [(&'static str, &'static str)],
}

const TARGETS: [Target; 3] = [
    Target {
        folder: "editors/vim/queries/dosm",
        files: &["folds", "highlights", "indents", "injections", "locals"],
        names: &[],
    },
    Target {
        folder: "editors/helix/queries/dosm",
        files: &["highlights"],
        names: &[
            ("boolean", "constant.builtin.boolean"),
            ("comment.documentation", "comment.line.documentation"),
            ("function.call", "function"),
            ("keyword.modifier", "keyword.storage.modifier"),
            ("module", "namespace"),
            ("number", "constant.numeric"),
            ("property", "variable.other.member"),
            ("type.definition", "type"),
            ("variable.member", "variable.other.member"),
        ],
    },
    Target {
        folder: "editors/zed/languages/dosm",
        files: &["highlights"],
        names: &[
            ("comment.documentation", "comment.doc"),
            ("constant.builtin", "constant"),
            ("function.builtin", "function"),
            ("function.call", "function"),
            ("keyword.modifier", "keyword"),
            ("keyword.operator", "keyword"),
            ("module", "title"),
            ("type.builtin", "type"),
            ("type.definition", "type"),
            ("variable.member", "property"),
            ("variable.parameter", "variable.special"),
        ],
    },
];

/// A query with other names of captures.
fn renamed(query: &str, names: &[(&str, &str)]) -> String {
    let part = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
    let mut pieces = query.split('@');
    let mut out = pieces.next().unwrap_or("").to_owned();
    for piece in pieces {
        let end = piece.find(|c| !part(c)).unwrap_or(piece.len());
        let (name, rest) = piece.split_at(end);
        let name = names.iter().find(|(here, _)| *here == name).map_or(name, |(_, there)| there);
        out.push('@');
        out.push_str(name);
        out.push_str(rest);
    }
    out
}

#[test]
fn queries_are_those_of_the_grammar() {
    let update = std::env::var_os("DOSMC_UPDATE").is_some();
    let mut stale = Vec::new();
    for target in &TARGETS {
        for file in target.files {
            let source = format!("editors/tree-sitter/queries/{file}.scm");
            let query = fs::read_to_string(package(&source)).unwrap_or_else(|e| panic!("{source}: {e}"));
            let fresh =
                format!("; Generated from {source} by tests/editors.\n{}", renamed(&query, target.names));
            let there = format!("{}/{file}.scm", target.folder);
            if update {
                fs::write(package(&there), fresh).expect("it can be written");
            } else if fs::read_to_string(package(&there)).ok().as_ref() != Some(&fresh) {
                stale.push(there);
            }
        }
    }
    assert!(stale.is_empty(), "not the grammar's queries: {stale:?}; DOSMC_UPDATE=1 writes them anew");
}

#[test]
fn whole_names_are_renamed() {
    let names = [("function", "f"), ("function.call", "g")];
    assert_eq!(renamed("(a) @function.call (b)@function\n@functions", &names), "(a) @g (b)@f\n@functions");
}
