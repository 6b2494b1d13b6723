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
use dosmc::driver::{self, Overrides};
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
        if path.extension().is_none_or(|extension| extension != "dosm") {
            continue;
        }
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

/// A small generator of pseudo-random numbers, so that failures repeat.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 33) as usize % n.max(1)
    }
}

/// Words, numbers and single other characters.
fn tokens(text: &str) -> Vec<String> {
    let mut tokens: Vec<String> = Vec::new();
    for line in text.lines().filter(|l| !l.trim_start().starts_with("//")) {
        let mut joined = false;
        for c in line.chars().chain(['\n']) {
            let word = c.is_alphanumeric() || c == '_' || c == '.';
            match tokens.last_mut() {
                Some(last) if word && joined => last.push(c),
                _ => tokens.push(c.to_string()),
            }
            joined = word;
        }
    }
    tokens
}

/// Numbers, words and all the rest: damage that stays within a class gets past the parser.
fn class(token: &str) -> usize {
    match token.chars().next() {
        Some(c) if c.is_numeric() => 0,
        Some(c) if c.is_alphabetic() => 1,
        _ => 2,
    }
}

/// How many damaged missions are tried; `DAMAGED` in the environment asks for more.
fn damaged() -> usize {
    std::env::var("DAMAGED").ok().and_then(|n| n.parse().ok()).unwrap_or(400)
}

#[test]
fn whatever_passes_the_check_is_a_valid_problem() {
    let mut texts = Vec::new();
    for folder in ["ok", "solve", "unsat"] {
        for entry in fs::read_dir(root().join("tests/missions").join(folder)).expect("the corpus") {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|extension| extension == "dosm") {
                texts.push(fs::read_to_string(&path).expect("a text"));
            }
        }
    }
    texts.sort();
    let wrong = corpus().into_iter().map(|(_, text)| text).filter(|text| !text.contains("10000"));
    let pool: Vec<String> = texts.iter().cloned().chain(wrong).flat_map(|text| tokens(&text)).collect();
    let alike = [0, 1, 2].map(|c| pool.iter().filter(|t| class(t) == c).collect::<Vec<_>>());
    let mut numbers = Numbers(5);
    let mut passed = 0;
    for _ in 0..damaged() {
        let mut mission = tokens(&texts[numbers.below(texts.len())]);
        for _ in 0..1 + numbers.below(3) {
            let at = numbers.below(mission.len());
            let alike = &alike[class(&mission[at])];
            match numbers.below(8) {
                0 => drop(mission.remove(at)),
                1 => mission[at] = pool[numbers.below(pool.len())].clone(),
                _ => mission[at] = alike[numbers.below(alike.len())].clone(),
            }
        }
        let source = SourceFile::new("mission.dosm", mission.concat());
        let mut diagnostics = Diagnostics::new();
        let Ok(file) = parse(&source, &mut diagnostics) else { continue };
        let Ok(typed) = check(&file, &source, &[], &mut diagnostics) else {
            assert!(diagnostics.has_errors());
            continue;
        };
        assert!(!diagnostics.has_errors());
        let (problem, spans) = dosmc::lower::lower(&typed);
        assert_eq!(dosmc::ir::validate(&problem), Ok(()), "{}", source.text);
        assert_eq!(spans.robots.len(), problem.robots.len());
        passed += 1;
    }
    assert!(passed > damaged() / 20, "only {passed} missions survived the damage");
}

/// What a mission means and what is said about it, as text.
fn meaning(text: &str) -> String {
    let source = SourceFile::new("mission.dosm", text);
    let mut diagnostics = Diagnostics::new();
    let mission = driver::load(&source, &Overrides::default(), &mut diagnostics);
    let problem = mission.map(|mission| mission.problem.to_string()).unwrap_or_default();
    diagnostics.iter().fold(problem, |text, d| format!("{text}{}\n", d.message))
}

#[test]
fn no_declaration_is_read_and_then_forgotten() {
    let path = root().join("tests/missions/ok/everything.dosm");
    let text = fs::read_to_string(path).expect("a text");
    let file = parse(&SourceFile::new("mission.dosm", text.as_str()), &mut Diagnostics::new());
    let whole = meaning(&text);
    let declarations = file.expect("it parses").items.into_iter().map(|item| item.span.range());
    let without = |range: &std::ops::Range<usize>| [&text[..range.start], &text[range.end..]].concat();
    let idle: Vec<&str> =
        declarations.filter(|range| meaning(&without(range)) == whole).map(|range| &text[range]).collect();
    assert!(idle.is_empty(), "without these the IR's text is the same: {idle:#?}");
}
