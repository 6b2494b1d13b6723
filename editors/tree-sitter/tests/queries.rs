//! The queries: they fit the grammar, and capture what they should.

mod common;

use std::fs;
use std::path::Path;

use common::{language, missions, parse};
use tree_sitter::{Query, QueryCursor, StreamingIterator};

/// A query in a file.
fn query(path: &Path) -> Query {
    let text = fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    Query::new(&language(), &text).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// A query of the repository.
fn query_of(path: &str) -> Query {
    query(&common::root().join(path))
}

/// What is captured, in the order of the text: where from, where to, as what.
fn captures(query: &Query, text: &[u8]) -> Vec<(usize, usize, String)> {
    let tree = parse(text);
    let mut cursor = QueryCursor::new();
    let mut found = Vec::new();
    let mut matches = cursor.matches(query, tree.root_node(), text);
    while let Some(one) = matches.next() {
        for capture in one.captures() {
            let name = query.capture_names()[capture.index as usize].to_owned();
            found.push((capture.node.start_byte(), capture.node.end_byte(), name));
        }
    }
    found.sort();
    found
}

/// An editor: where its queries are, and the captures that it documents, each with all that begin so.
struct Editor {
    queries: &'static str,
    documented: &'static str,
}

const EDITORS: [Editor; 4] = [
    Editor {
        queries: "editors/tree-sitter/queries",
        documented: "comment constant constructor function keyword label module number boolean operator property \
            punctuation string type variable local.scope local.definition local.reference fold indent name definition \
            reference injection.content",
    },
    Editor {
        queries: "editors/vim/queries/dosm",
        documented: "variable variable.builtin variable.parameter variable.member constant constant.builtin module \
            label string boolean number type type.builtin type.definition property function function.builtin \
            function.call constructor operator keyword keyword.modifier keyword.operator punctuation.delimiter \
            punctuation.bracket comment comment.documentation local.scope local.definition local.reference fold \
            indent.begin indent.end indent.align indent.branch indent.ignore indent.auto injection.content",
    },
    Editor {
        queries: "editors/helix/queries/dosm",
        documented: "attribute type type.builtin constructor constant constant.builtin constant.builtin.boolean \
            constant.numeric comment comment.line.documentation variable variable.parameter variable.other.member \
            label punctuation.delimiter punctuation.bracket keyword keyword.operator keyword.storage.modifier \
            operator function function.builtin namespace local.scope local.definition local.reference indent \
            outdent align anchor injection.content function.inside function.around class.inside class.around \
            parameter.inside comment.inside comment.around entry.inside",
    },
    Editor {
        queries: "editors/zed/languages/dosm",
        documented: "boolean comment comment.doc constant constructor function keyword label number operator property \
            punctuation.bracket punctuation.delimiter title type variable variable.special open close indent end \
            item name context annotation function.inside function.around class.inside class.around comment.around",
    },
];

#[test]
fn all_fit_the_grammar_and_use_names_that_the_editor_documents() {
    for editor in EDITORS {
        let documented: Vec<_> = editor.documented.split_whitespace().collect();
        let mut count = 0;
        for entry in fs::read_dir(common::root().join(editor.queries)).expect("the queries") {
            let path = entry.expect("an entry").path();
            if path.extension().is_none_or(|e| e != "scm") {
                continue;
            }
            let query = query(&path);
            for name in query.capture_names() {
                let known =
                    |d: &&str| name == d || name.strip_prefix(*d).is_some_and(|rest| rest.starts_with('.'));
                let exact = documented.contains(name);
                // Definitions say of what, and the grammar's own queries leave the details to who uses them.
                let free =
                    name.starts_with("local.definition.") || editor.queries.ends_with("tree-sitter/queries");
                assert!(
                    exact || (free && documented.iter().any(|d| known(&d))),
                    "{}: @{name}",
                    path.display()
                );
            }
            // It runs over every mission, and finds something.
            let found: usize = missions().iter().map(|mission| captures(&query, &mission.bytes).len()).sum();
            assert!(found > 10, "{}: only {found} captures", path.display());
            count += 1;
        }
        assert!(count >= 5, "{}: only {count}", editor.queries);
    }
}

#[test]
fn outlines_and_indents_are_those_of_the_missions() {
    let text = b"dosm 1 mission a region b = box (0, 0) .. (1, 1) dynamics C { state x: m } goal d: R1 in b";
    let at = |query: &str, wanted: &str| {
        let found = captures(&query_of(query), text);
        let names = found.iter().filter(|(.., name)| name == wanted);
        names.map(|(a, b, _)| String::from_utf8_lossy(&text[*a..*b]).into_owned()).collect::<Vec<_>>()
    };
    assert_eq!(at("editors/zed/languages/dosm/outline.scm", "name"), ["a", "b", "C", "d"]);
    assert_eq!(
        at("editors/zed/languages/dosm/outline.scm", "context"),
        ["mission", "region", "dynamics", "goal"]
    );
    assert_eq!(at("editors/zed/languages/dosm/indents.scm", "end"), ["}"]);
    assert_eq!(at("editors/helix/queries/dosm/indents.scm", "outdent"), ["}"]);
    assert_eq!(at("editors/vim/queries/dosm/folds.scm", "fold"), ["{ state x: m }", "goal d: R1 in b"]);
    assert_eq!(
        at("editors/helix/queries/dosm/highlights.scm", "constant.numeric"),
        ["1", "0", "0", "1", "1"]
    );
    assert_eq!(at("editors/zed/languages/dosm/highlights.scm", "title"), ["a"]);
}

/// Places in the missions, with what is captured there: the text of the token, how many such tokens come before
/// it, the capture.
const PLACES: [(&str, &[(&str, usize, &str)]); 2] = [
    ("examples/relay.dosm", &[("dosm", 0, "keyword"), ("1", 0, "number"), ("relay", 0, "module")]),
    (
        "tests/missions/parse/everything.dosm",
        &[
            ("//! Every construct of the language, edition 1.", 0, "comment.documentation"),
            ("/* Comments /* nest */ and are skipped. */", 0, "comment"),
            ("//// Four slashes make a plain comment.", 0, "comment"),
            ("/// A union of pieces.", 0, "comment.documentation"),
            ("radius", 0, "constant"),
            ("radius", 1, "keyword"),
            ("min", 0, "type.builtin"),
            ("min", 1, "function.builtin"),
            ("max", 0, "function.builtin"),
            ("pi", 0, "constant.builtin"),
            ("m/s", 0, "type.builtin"),
            ("opaque", 0, "keyword.modifier"),
            ("box", 0, "constructor"),
            ("where", 0, "constructor"),
            ("where", 1, "constructor"),
            ("depot", 0, "variable"),
            ("i", 0, "variable.parameter"),
            ("Rover", 0, "type.definition"),
            ("Rover", 1, "type"),
            ("px", 0, "variable.member"),
            ("px", 1, "variable.member"),
            ("step", 0, "keyword"),
            ("continuous", 0, "keyword"),
            ("A", 0, "property"),
            ("dry", 0, "label"),
            ("in", 0, "keyword.operator"),
            ("all", 0, "constant.builtin"),
            ("count", 0, "function.builtin"),
            ("busy", 0, "function"),
            ("busy", 1, "function.call"),
            ("true", 0, "boolean"),
            ("G", 0, "keyword.operator"),
            ("[]", 0, "operator"),
            ("±", 0, "operator"),
            ("effort", 0, "constant.builtin"),
            ("norm", 0, "keyword"),
        ],
    ),
];

#[test]
fn tokens_are_what_they_should_be() {
    let query = query_of("editors/tree-sitter/queries/highlights.scm");
    for (path, places) in PLACES {
        let text = fs::read(common::root().join(path)).expect("a mission");
        let found = captures(&query, &text);
        for (token, before, name) in places {
            let same: Vec<_> = found.iter().filter(|(a, b, _)| &text[*a..*b] == token.as_bytes()).collect();
            let there = same.get(*before).map(|(.., name)| name.as_str());
            assert_eq!(there, Some(*name), "{path}: `{token}` number {before}");
        }
    }
}

#[test]
fn every_token_is_captured_once() {
    let query = query_of("editors/tree-sitter/queries/highlights.scm");
    for mission in missions().iter().filter(|m| m.is_accepted()) {
        let found = captures(&query, &mission.bytes);
        for pair in found.windows(2) {
            assert!(pair[0].1 <= pair[1].0, "{}: {:?} and {:?}", mission.path, pair[0], pair[1]);
        }
        // All but blanks.
        let mut rest = mission.bytes.clone();
        for (start, end, _) in found {
            rest[start..end].fill(b' ');
        }
        let rest = String::from_utf8_lossy(&rest).split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(rest, "", "{}", mission.path);
    }
}

#[test]
fn declarations_are_tagged() {
    let text = b"dosm 1 mission a region b = box (0, 0) .. (1, 1) dynamics C { } goal d: R1 in b";
    let found = captures(&query_of("editors/tree-sitter/queries/tags.scm"), text);
    let of = |wanted: &str| {
        let names = found.iter().filter(|(.., name)| name == wanted);
        names.map(|(a, b, _)| String::from_utf8_lossy(&text[*a..*b])).collect::<Vec<_>>()
    };
    assert_eq!(of("name"), ["a", "b", "C", "d", "R1", "b"]);
    assert_eq!(of("definition.class"), ["dynamics C { }"]);
    assert_eq!(of("reference.variable"), ["R1", "b"]);
}
