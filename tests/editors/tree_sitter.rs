//! The grammar for tree-sitter: it spells the words of the compiler's grammar, and the tests of its own package
//! (`editors/tree-sitter`) pass. These need a C compiler (`CC`, or `cc`).

use std::collections::BTreeSet;
use std::path::Path;
use std::process::{Command, Stdio};

use dosmc::diag::Diagnostics;
use dosmc::source::SourceFile;
use dosmc::syntax;
use dosmc::syntax::words::{BRACKETS, CLASSES, SEPARATORS};
use serde_json::Value;

use crate::common::{missions, package, skipped};

/// The classes of words that are names to the grammar, and those that the scanner reads.
const NOT_SPELLED: [&str; 5] = ["functions", "constants", "coordinates", "objectives", "units"];

/// The strings that a grammar's rules spell.
fn spelled(rule: &Value, into: &mut BTreeSet<String>) {
    if rule["type"] == "STRING" {
        into.insert(rule["value"].as_str().expect("a string").to_owned());
    }
    let parts: Box<dyn Iterator<Item = &Value>> = match rule {
        Value::Array(parts) => Box::new(parts.iter()),
        Value::Object(parts) => Box::new(parts.values()),
        _ => Box::new(std::iter::empty()),
    };
    parts.for_each(|part| spelled(part, into));
}

#[test]
fn the_grammar_spells_every_word_and_no_other() {
    let text = std::fs::read_to_string(package("editors/tree-sitter/src/grammar.json")).expect("the grammar");
    let grammar: Value = serde_json::from_str(&text).expect("JSON");
    let mut there = BTreeSet::new();
    spelled(&grammar["rules"], &mut there);
    let classes = CLASSES.iter().filter(|(class, _)| !NOT_SPELLED.contains(class));
    let signs = BRACKETS.into_iter().chain(SEPARATORS);
    let here: BTreeSet<String> =
        classes.flat_map(|(_, words)| words.iter().copied()).chain(signs).map(str::to_owned).collect();
    let missing: Vec<_> = here.difference(&there).collect();
    let surplus: Vec<_> = there.difference(&here).collect();
    assert!(missing.is_empty() && surplus.is_empty(), "missing {missing:?}, surplus {surplus:?}");
}

/// Whether the compiler's parser has nothing to say about a file.
fn is_parsed(path: &Path) -> bool {
    let Ok(text) = syntax::decode(&std::fs::read(path).expect("a mission")) else { return false };
    let mut diagnostics = Diagnostics::new();
    let parsed = syntax::parse(&SourceFile::new("mission.dosm", text), &mut diagnostics);
    parsed.is_ok() && !diagnostics.sorted().iter().any(|d| d.code.starts_with("dosm::syntax::"))
}

#[test]
fn the_names_of_missions_say_whether_they_can_be_parsed() {
    let stages =
        ["ok", "err", "parse", "solve", "unsat", "field"].map(|stage| format!("tests/missions/{stage}"));
    let directories = ["examples", "examples/paper"].map(str::to_owned).into_iter().chain(stages);
    for path in directories.flat_map(|directory| missions(&directory)) {
        let broken = path.file_name().expect("a file").to_string_lossy().starts_with("syntax_");
        assert_eq!(is_parsed(&path), !broken, "{}", path.display());
    }
}

#[test]
fn its_own_tests_pass() {
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let mut version = Command::new(&compiler);
    version.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
    if !version.status().is_ok_and(|status| status.success()) {
        return skipped("the grammar for tree-sitter was not compiled: there is no C compiler (CC, or cc)");
    }
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["test", "--quiet", "--manifest-path"]).arg(package("editors/tree-sitter/Cargo.toml"));
    cargo.arg("--target-dir").arg(package("target/tmp/tree-sitter"));
    // What is for this package is not for that one.
    for (name, _) in std::env::vars_os() {
        if name.to_string_lossy().starts_with("CARGO_") && name != "CARGO_HOME" {
            cargo.env_remove(name);
        }
    }
    cargo.env_remove("DOSMC_UPDATE");
    let output = cargo.output().expect("cargo runs");
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
}
