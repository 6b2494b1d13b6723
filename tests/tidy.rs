//! The architecture as a test: who may name whom, which crate stays behind which border, and what
//! no file may hold. A drawing of it would go stale; this can't.

#![allow(clippy::disallowed_methods, reason = "reads the sources")]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// What every module may name.
const BASE: [&str; 7] = ["diag", "entity", "entity_id", "exact", "json", "quantity", "source"];

/// Each module with the modules that it may name besides itself and, from `geometry` on, [`BASE`].
///
/// `verify` never sees what tube, abstraction, encode or solve computed; no back end sees the
/// syntax tree; nothing sees the command line.
const MAY_NAME: [(&str, &[&str]); 25] = [
    ("entity", &[]),
    ("exact", &[]),
    ("source", &[]),
    ("json", &[]),
    ("quantity", &["exact"]),
    ("diag", &["source"]),
    ("explain", &[]),
    ("geometry", &[]),
    ("ir", &["geometry"]),
    ("syntax", &[]),
    ("typed", &["syntax", "geometry", "ir"]),
    // `lower` for its normal form, in which goals that say nothing are seen.
    ("check", &["syntax", "typed", "geometry", "ir", "lower"]),
    ("lower", &["typed", "check", "geometry", "ir"]),
    ("law", &["ir", "geometry"]),
    // `law` for what its reserve has to hold.
    ("tube", &["ir", "geometry", "law"]),
    ("abstraction", &["ir", "geometry", "tube"]),
    ("encode", &["ir", "geometry", "tube", "abstraction"]),
    ("plan", &["ir", "geometry", "tube", "abstraction", "encode"]),
    ("solve", &["ir", "geometry", "tube", "abstraction", "encode", "plan"]),
    ("simulate", &["ir", "geometry", "plan", "law"]),
    ("verify", &["ir", "geometry", "plan"]),
    ("back", &["ir", "geometry", "plan", "law", "tube", "abstraction", "encode"]),
    (
        "driver",
        &[
            "syntax",
            "typed",
            "check",
            "lower",
            "ir",
            "law",
            "tube",
            "abstraction",
            "encode",
            "solve",
            "plan",
            "verify",
            "back",
        ],
    ),
    // What it shows of a mission whose other parts are wrong, it takes from the phases themselves.
    (
        "lsp",
        &[
            "driver",
            "explain",
            "syntax",
            "typed",
            "check",
            "lower",
            "geometry",
            "ir",
            "law",
            "tube",
            "abstraction",
            "solve",
        ],
    ),
    (
        "cli",
        &[
            "driver", "explain", "syntax", "ir", "law", "tube", "solve", "plan", "verify", "simulate",
            "back", "lsp",
        ],
    ),
];

/// Names of crates and of the standard library with the only places (path prefixes) for them.
const BORDERS: [(&str, &[&str]); 31] = [
    ("pest", &["src/syntax"]),
    ("pest_derive", &["src/syntax"]),
    ("rustsat", &["src/encode", "src/solve", "src/back/cnf"]),
    ("rustsat_batsat", &["src/solve"]),
    ("rustsat_cadical", &["src/solve"]),
    ("dashu_base", &["src/exact"]),
    ("dashu_int", &["src/exact"]),
    ("dashu_ratio", &["src/exact"]),
    ("miette", &["src/diag"]),
    ("clap", &["src/cli"]),
    ("clap_complete", &["src/cli"]),
    ("clap_mangen", &["src/cli"]),
    ("ctrlc", &["src/cli"]),
    ("resvg", &["src/cli/png.rs"]),
    ("tempfile", &["src/cli"]),
    ("indicatif", &["src/cli"]),
    ("terminal_size", &["src/cli"]),
    ("rand_xoshiro", &["src/simulate/random.rs"]),
    ("strsim", &["src/explain"]),
    ("lsp_server", &["src/lsp"]),
    ("lsp_types", &["src/lsp"]),
    ("std::fs", &["src/cli", "src/main.rs"]),
    ("std::env", &["src/cli", "src/main.rs"]),
    ("std::time::Instant", &["src/cli", "src/main.rs"]),
    ("std::time::SystemTime", &["src/cli", "src/main.rs"]),
    ("std::io", &["src/cli", "src/main.rs", "src/lsp/wire.rs"]),
    ("std::process", &["src/cli", "src/main.rs"]),
    ("println!", &["src/cli", "src/main.rs"]),
    ("eprintln!", &["src/cli", "src/main.rs"]),
    ("print!", &["src/cli", "src/main.rs"]),
    ("eprint!", &["src/cli", "src/main.rs"]),
];

/// Crates that only one file may name, wherever it is.
const ONE_FILE: [&str; 2] = ["clarabel", "microlp"];

/// The longest source file, in lines.
const LONGEST: usize = 700;

/// A source file: its path from the package root, and its text.
struct Source {
    path: String,
    text: String,
}

impl Source {
    /// The code that is compiled into the product: no comments, no unit tests.
    fn code(&self) -> String {
        let product = self.text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
        let line = |l: &str| l.split("//").next().unwrap_or_default().to_string();
        product.lines().map(line).collect::<Vec<_>>().join("\n")
    }

    /// The top-level module that it belongs to.
    fn module(&self) -> &str {
        let rest = self.path.strip_prefix("src/").unwrap_or(&self.path);
        rest.split('/').next().unwrap_or(rest).trim_end_matches(".rs")
    }

    /// Whether it holds nothing but unit tests.
    fn is_test(&self) -> bool {
        self.path.ends_with("tests.rs") || self.path.contains("/tests/")
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All files with an extension under a directory.
fn files(directory: &str, extension: &str) -> Vec<Source> {
    let mut found = Vec::new();
    let mut open = vec![root().join(directory)];
    while let Some(directory) = open.pop() {
        for entry in fs::read_dir(&directory).expect("a directory of the package") {
            let path: PathBuf = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == extension) {
                let text = fs::read_to_string(&path).expect("a text file");
                let path = path.strip_prefix(root()).expect("inside").to_string_lossy().replace('\\', "/");
                found.push(Source { path, text });
            }
        }
    }
    found.sort_by(|a, b| a.path.cmp(&b.path));
    assert!(!found.is_empty(), "no .{extension} file under {directory}");
    found
}

/// The product's sources, the crate root and pure test files left out.
fn product() -> Vec<Source> {
    files("src", "rs").into_iter().filter(|s| s.path != "src/lib.rs" && !s.is_test()).collect()
}

/// The modules that a piece of code names: `crate::x`, `crate::{x, y::z}`.
fn modules_named(code: &str) -> BTreeSet<String> {
    let mut named = BTreeSet::new();
    for (at, _) in code.match_indices("crate::") {
        let before = code[..at].chars().next_back();
        if before.is_some_and(|c| c.is_alphanumeric() || c == '_') {
            continue;
        }
        let rest = &code[at + "crate::".len()..];
        match rest.strip_prefix('{') {
            Some(group) => named.extend(heads_of_group(group)),
            None => named.extend([word(rest)]),
        }
    }
    named
}

/// The first words of the entries of a `{…}` group, nested groups skipped.
fn heads_of_group(group: &str) -> Vec<String> {
    let (mut depth, mut fresh, mut heads) = (0usize, true, Vec::new());
    for (at, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => fresh = true,
            c if fresh && depth == 0 && !c.is_whitespace() => {
                heads.push(word(&group[at..]));
                fresh = false;
            }
            _ => {}
        }
    }
    heads
}

fn word(text: &str) -> String {
    text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
}

/// Whether code names something as a whole path: `pest` in `pest::x`, not in `pest_derive`.
fn names(code: &str, name: &str) -> bool {
    let part = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == '"');
    code.match_indices(name).any(|(at, _)| {
        let after = code[at + name.len()..].chars().next();
        let whole = !part(code[..at].chars().next_back()) && !part(after);
        whole && (name.contains("::") || name.ends_with('!') || code[at + name.len()..].starts_with("::"))
    })
}

#[test]
fn modules_name_only_whom_they_may() {
    let mut wrong = Vec::new();
    for source in product().iter().filter(|s| s.module() != "main") {
        let module = source.module();
        let Some((place, (_, allowed))) = MAY_NAME.iter().enumerate().find(|(_, (m, _))| *m == module) else {
            wrong.push(format!("{}: module `{module}` is not in the table", source.path));
            continue;
        };
        let base: &[&str] = if place >= 6 { &BASE } else { &["entity_id"] };
        for named in modules_named(&source.code()) {
            if named != module && !allowed.contains(&named.as_str()) && !base.contains(&named.as_str()) {
                wrong.push(format!("{} names `{named}`", source.path));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn crates_stay_behind_their_borders() {
    let mut wrong = Vec::new();
    for source in product() {
        let code = source.code();
        for (name, places) in BORDERS {
            if names(&code, name) && !places.iter().any(|p| source.path.starts_with(p)) {
                wrong.push(format!("{} names `{name}`", source.path));
            }
        }
    }
    for name in ONE_FILE {
        let all: Vec<String> =
            product().into_iter().filter(|s| names(&s.code(), name)).map(|s| s.path).collect();
        if all.len() > 1 {
            wrong.push(format!("`{name}` is named in {all:?}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn files_are_short_and_explained() {
    let mut wrong = Vec::new();
    for source in files("src", "rs").into_iter().chain(files("tests", "rs")) {
        let lines = source.text.lines().count();
        if lines > LONGEST {
            wrong.push(format!("{} has {lines} lines", source.path));
        }
        if !source.text.starts_with("//!") {
            wrong.push(format!("{} does not say what it is for", source.path));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn nothing_is_left_behind() {
    // Written in two parts, so that this file does not hold them.
    let words = [
        ("TO", "DO"),
        ("FIX", "ME"),
        ("XX", "X"),
        ("todo", "!("),
        ("unimplemented", "!("),
        ("dbg", "!("),
        ("#[ig", "nore"),
    ];
    let mut wrong = Vec::new();
    for source in files("src", "rs").into_iter().chain(files("tests", "rs")) {
        for (a, b) in words {
            if source.text.contains(&[a, b].concat()) {
                wrong.push(format!("{} holds `{a}{b}`", source.path));
            }
        }
        for name in source.text.lines().filter_map(declared_type) {
            if ["Manager", "Helper", "Util", "Utils", "Data"].iter().any(|w| name.ends_with(w)) {
                wrong.push(format!("{} declares `{name}`, which says nothing", source.path));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// The name that a line declares as a type.
fn declared_type(line: &str) -> Option<String> {
    let line = line
        .trim_start()
        .trim_start_matches("pub ")
        .trim_start_matches("pub(crate) ")
        .trim_start_matches("pub(super) ");
    ["struct ", "enum ", "trait "].iter().find_map(|k| line.strip_prefix(k)).map(word)
}

#[test]
fn the_scanner_sees_what_it_is_for() {
    let code = "use crate::{ir::{Problem, Model}, tube::Tubes,\n plan};\nlet x = crate::solve::run(); $crate::hidden::x";
    let named: Vec<String> = modules_named(code).into_iter().collect();
    assert_eq!(named, ["hidden", "ir", "plan", "solve", "tube"]);
    assert!(names("use pest::Parser;", "pest") && !names("use pest_derive::Parser;", "pest"));
    assert!(names("{println!(x)}", "println!") && !names("eprintln!(x)", "println!"));
    assert!(names("std::fs::read(p)", "std::fs") && !names("std::fsx", "std::fs"));
}

/// Codes that no file of the corpus can give, with what tests them instead.
const WITHOUT_MISSION: [(&str, &str); 17] = [
    ("dosm::cli::bad_name", "tests/cli"),
    ("dosm::cli::too_large", "tests/instances.rs"),
    ("dosm::cli::unknown_code", "tests/explain.rs"),
    ("dosm::cli::unreadable", "tests/cli"),
    ("dosm::cli::unwritable", "tests/cli"),
    ("dosm::cli::usage", "tests/cli"),
    ("dosm::controller::rounding", "tests/cli"),
    ("dosm::plan::malformed", "tests/cli"),
    ("dosm::smc::altered", "tests/instances.rs"),
    ("dosm::smc::malformed", "tests/instances.rs"),
    ("dosm::check::set_value", "src/check"),
    ("dosm::check::unknown_param", "tests/cli"),
    ("dosm::syntax::text_too_long", "tests/syntax"),
    ("dosm::syntax::too_many_errors", "tests/syntax, because it comes after all that is drawn"),
    ("dosm::check::unknown_unit", "behind the parser, which refuses it first"),
    ("dosm::ir::invalid", "a bug by definition"),
    ("dosm::check::misplaced_table", "behind the parser, which refuses it first"),
];

/// The diagnostic codes that a text names.
fn codes(text: &str) -> BTreeSet<String> {
    let part = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_' || c == ':';
    text.match_indices("dosm::")
        .map(|(at, _)| text[at..].chars().take_while(|&c| part(c)).collect::<String>())
        .filter(|code| code.matches("::").count() == 2 && !code.ends_with(':'))
        .collect()
}

#[test]
fn every_diagnostic_is_shown_by_a_mission() {
    let declared: BTreeSet<String> = product().iter().flat_map(|s| codes(&s.code())).collect();
    let shown: BTreeSet<String> =
        files("tests/missions", "snap").iter().flat_map(|s| codes(&s.text)).collect();
    let excused = |code: &String| WITHOUT_MISSION.iter().any(|(c, _)| c == code);
    let missing: Vec<&String> = declared.difference(&shown).filter(|c| !excused(c)).collect();
    assert!(missing.is_empty(), "no mission under tests/missions shows {missing:#?}");
    let gone: Vec<&&str> =
        WITHOUT_MISSION.iter().map(|(c, _)| c).filter(|c| !declared.contains(**c)).collect();
    assert!(gone.is_empty(), "excused, but no longer there: {gone:?}");
}
