//! What is checked in below `src/` is what the grammar gives.
//!
//! `DOSMC_UPDATE=1 cargo test --test generated` writes it anew. Node evaluates `grammar.js` (`DOSMC_NODE`, or
//! `node`); without it only `src/grammar.json` is held against the parser, which is said, and fails with
//! `DOSMC_REQUIRE_TOOLS=1`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use tree_sitter_generate::{OptLevel, generate_parser_in_directory};

/// The version of the tables that Neovim 0.7, too, can read.
const ABI: usize = 14;

/// What is generated.
const FILES: [&str; 6] = [
    "grammar.json",
    "node-types.json",
    "parser.c",
    "tree_sitter/alloc.h",
    "tree_sitter/array.h",
    "tree_sitter/parser.h",
];

fn package() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Node, where it is installed.
fn node() -> Option<String> {
    let node = std::env::var("DOSMC_NODE").unwrap_or_else(|_| "node".to_owned());
    let mut version = Command::new(&node);
    version.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
    if version.status().is_ok_and(|status| status.success()) {
        return Some(node);
    }
    let required = std::env::var_os("DOSMC_REQUIRE_TOOLS").is_some();
    assert!(!required, "node is missing (or DOSMC_NODE is wrong)");
    eprintln!("NOT TESTED: whether src/grammar.json is what grammar.js says; node is missing");
    None
}

/// Generates everything into a directory.
fn generate(into: &Path) {
    let node = node();
    let grammar = if node.is_some() { "grammar.js" } else { "src/grammar.json" };
    let mut said = Vec::new();
    generate_parser_in_directory::<PathBuf, PathBuf, PathBuf>(
        package().to_path_buf(),
        Some(into.to_path_buf()),
        Some(package().join(grammar)),
        ABI,
        None,
        node.as_deref(),
        true,
        OptLevel::default(),
        &mut said,
    )
    .unwrap_or_else(|error| panic!("the grammar can't be used: {error}"));
    assert!(said.is_empty(), "{said:?}");
    if node.is_none() {
        fs::copy(package().join("src/grammar.json"), into.join("grammar.json")).expect("it can be copied");
    }
}

#[test]
fn the_parser_is_what_the_grammar_gives() {
    if std::env::var_os("DOSMC_UPDATE").is_some() {
        generate(&package().join("src"));
        return;
    }
    let fresh = Path::new(env!("CARGO_TARGET_TMPDIR")).join("generated");
    generate(&fresh);
    let read = |path: PathBuf| fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let stale = |file: &&&str| read(fresh.join(file)) != read(package().join("src").join(file));
    let stale: Vec<_> = FILES.iter().filter(stale).collect();
    assert!(stale.is_empty(), "not what the grammar gives: {stale:?}; DOSMC_UPDATE=1 writes them anew");
}

#[test]
fn older_editors_can_read_it() {
    let parser = fs::read_to_string(package().join("src/parser.c")).expect("the parser");
    assert!(parser.contains(&format!("#define LANGUAGE_VERSION {ABI}\n")), "another ABI");
}
