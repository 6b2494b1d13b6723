//! What the checker says about `tests/missions/err/check_*.dosm`: one file or more for each of its codes.
//!
//! A file `check_NAME.dosm` gives `dosm::check::NAME` and nothing else; `check_NAME_VARIANT.dosm` is a
//! further way to get it.

#![allow(clippy::disallowed_methods, reason = "reads the corpus")]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use dosmc::check::check;
use dosmc::diag::Diagnostics;
use dosmc::source::SourceFile;
use dosmc::syntax::parse;

/// Codes that come from the command line or stand behind the parser, so that no file gives them.
const WITHOUT_FILE: [&str; 4] = ["unknown_param", "set_value", "misplaced_table", "unknown_unit"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The stems of the corpus's files, without `check_`, with their texts.
fn corpus() -> Vec<(String, String)> {
    let mut files = Vec::new();
    for entry in fs::read_dir(root().join("tests/missions/err")).expect("the corpus") {
        let path = entry.expect("an entry").path();
        let stem = path.file_stem().expect("a name").to_string_lossy().into_owned();
        if let Some(name) = stem.strip_prefix("check_") {
            files.push((name.to_string(), fs::read_to_string(&path).expect("a text")));
        }
    }
    files.sort();
    files
}

fn codes(text: &str) -> BTreeSet<String> {
    let source = SourceFile::new("mission.dosm", text);
    let mut diagnostics = Diagnostics::new();
    if let Ok(file) = parse(&source, &mut diagnostics) {
        let result = check(&file, &source, &[], &mut diagnostics);
        assert_eq!(result.is_err(), diagnostics.has_errors());
    }
    diagnostics.iter().map(|d| d.code.to_string()).collect()
}

/// The codes that the checker's sources name.
fn declared() -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for entry in fs::read_dir(root().join("src/check/messages")).expect("the messages") {
        let text = fs::read_to_string(entry.expect("an entry").path()).expect("a text");
        for rest in text.split("\"dosm::check::").skip(1) {
            found.insert(rest.split('"').next().unwrap_or_default().to_string());
        }
    }
    found
}

#[test]
fn every_file_gives_its_code_and_no_other() {
    let codes_declared = declared();
    let mut wrong = Vec::new();
    for (name, text) in corpus() {
        let code = codes_declared.iter().filter(|c| name == **c || name.starts_with(&format!("{c}_"))).max();
        let found = codes(&text);
        let expected = code.map(|c| BTreeSet::from([format!("dosm::check::{c}")]));
        if expected.as_ref() != Some(&found) {
            wrong.push(format!("check_{name}.dosm: {found:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_code_has_a_file() {
    let names: Vec<String> = corpus().into_iter().map(|(name, _)| name).collect();
    let without = |code: &&String| {
        !WITHOUT_FILE.contains(&code.as_str())
            && !names.iter().any(|n| n == *code || n.starts_with(&format!("{code}_")))
    };
    let declared = declared();
    let missing: Vec<_> = declared.iter().filter(without).collect();
    assert!(declared.len() > 50 && missing.is_empty(), "no file for {missing:?}");
}
