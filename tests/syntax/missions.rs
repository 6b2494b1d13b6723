//! The corpus: whole missions, and one broken mission for each error code.

use std::path::Path;

use dosmc::diag::Diagnostic;
use dosmc::syntax;

use crate::{parse, shown};

#[test]
fn the_references_mission_parses() {
    let (file, diagnostics) = parse(include_str!("../missions/ok/relay.dosm"));
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    let file = file.unwrap();
    assert_eq!(file.items.len(), 17, "{:#?}", file.items);
    assert!(file.stray_docs.is_empty());
}

#[test]
fn the_tree_of_every_construct() {
    let (file, diagnostics) = parse(include_str!("../missions/parse/everything.dosm"));
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    let tree = syntax::dump(&file.unwrap());
    let blank = tree.lines().position(|line| line.trim().is_empty());
    assert_eq!(blank, None, "a declaration that `syntax::dump` does not know");
    insta::assert_snapshot!(tree);
}

/// The missions whose only errors are of the code that their name says.
fn broken_missions() -> Vec<(String, Vec<u8>)> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/missions/err");
    let mut found = Vec::new();
    for entry in std::fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        let stem = path.file_stem().unwrap().to_string_lossy().into_owned();
        if let Some(name) =
            stem.strip_prefix("syntax_").filter(|_| path.extension().is_some_and(|e| e == "dosm"))
        {
            found.push((name.to_owned(), std::fs::read(&path).unwrap()));
        }
    }
    found.sort();
    found
}

/// The diagnostics of a text that may be no text.
fn diagnose(bytes: &[u8]) -> Vec<Diagnostic> {
    match syntax::decode(bytes) {
        Ok(text) => parse(&text).1,
        Err(diagnostic) => vec![diagnostic],
    }
}

#[test]
fn each_broken_mission_has_the_error_of_its_name() {
    let mut report = String::new();
    for (name, bytes) in broken_missions() {
        let diagnostics = diagnose(&bytes);
        assert!(!diagnostics.is_empty(), "{name} has no error");
        for diagnostic in diagnostics.iter().filter(|d| name != "too_many_errors" || d.code.ends_with(&name))
        {
            // `expected_horizon` is a second way to get `expected`.
            let code = diagnostic.code.trim_start_matches("dosm::syntax::");
            let variant =
                name.strip_prefix(code).is_some_and(|rest| rest.is_empty() || rest.starts_with('_'));
            assert!(variant, "{name}: {diagnostic:#?}");
            report.push_str(&shown(&String::from_utf8_lossy(&bytes), diagnostic));
        }
    }
    insta::assert_snapshot!(report);
}

#[test]
fn each_code_has_a_broken_mission() {
    let missions = broken_missions();
    let source = include_str!("../../src/syntax/error.rs");
    let codes = source.split("\"dosm::syntax::").skip(1).filter_map(|rest| rest.split('"').next());
    let mut count = 0;
    for code in codes.filter(|code| *code != "text_too_long") {
        assert!(missions.iter().any(|(name, _)| name == code), "no mission for {code}");
        count += 1;
    }
    assert!(count > 20, "{count}");
}
