//! The extension for VS Code: its grammar in the engine that VS Code has, its snippets, what is packed.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use dosmc::diag::Diagnostics;
use dosmc::source::SourceFile;
use dosmc::syntax;
use serde_json::Value;

use crate::common::{missions, package, skipped};
use crate::tools::{command, output, tool};

/// The extension's directory.
pub const HERE: &str = "editors/vscode";

fn json(path: &str) -> Value {
    let text = fs::read_to_string(package(HERE).join(path)).unwrap_or_else(|e| panic!("{path}: {e}"));
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{path}: {e}"))
}

/// A script of the extension for Node, or a program of one of its packages; says loudly when they aren't there.
pub fn node(script: &str, what: &str) -> Option<Command> {
    let node = tool(&["node"], what)?;
    if !package(HERE).join("node_modules/.package-lock.json").is_file() {
        skipped(&format!("{what} was not run: `npm ci` in {HERE} gets its packages"));
        return None;
    }
    let mut command = command(node);
    command.current_dir(package(HERE)).arg(script);
    Some(command)
}

/// Missions that parse.
pub fn corpus() -> Vec<PathBuf> {
    let directories = ["examples", "examples/paper"];
    let tested = ["ok", "solve", "unsat", "field", "parse"].map(|part| format!("tests/missions/{part}"));
    let all = directories.map(str::to_owned).into_iter().chain(tested);
    all.flat_map(|directory| missions(&directory)).collect()
}

#[test]
fn tokens_have_the_scopes_that_are_asserted() {
    let script = "node_modules/vscode-tmgrammar-test/dist/unit.js";
    let Some(mut test) = node(script, "vscode-tmgrammar-test") else { return };
    let printed = output(test.arg("test/grammar/*.dosm"));
    let count = fs::read_dir(package(HERE).join("test/grammar")).expect("assertions").count();
    assert_eq!(printed.matches("run successfuly").count(), count, "{printed}");
}

#[test]
fn every_token_of_every_mission_has_a_scope() {
    let Some(mut tokens) = node("test/tokens.mjs", "the grammar for VS Code") else { return };
    let printed = output(tokens.args(corpus()));
    let count: usize = printed.split_whitespace().next().and_then(|n| n.parse().ok()).expect("a count");
    assert!(count > 15_000, "{printed}");
}

/// A snippet's text with its suggestions filled in: `${1:name}`, `${1|one,two|}`, `$0`.
fn expanded(body: &str) -> String {
    let mut text = String::new();
    let mut rest = body;
    while let Some((before, after)) = rest.split_once('$') {
        text.push_str(before);
        let Some(inside) = after.strip_prefix('{') else {
            rest = after.trim_start_matches(|c: char| c.is_ascii_digit());
            continue;
        };
        let (place, behind) = inside.split_once('}').expect("it is closed");
        let suggestion = place.trim_start_matches(|c: char| c.is_ascii_digit());
        let one = suggestion.strip_prefix('|').map(first_choice);
        text.push_str(&one.unwrap_or_else(|| suggestion.strip_prefix(':').unwrap_or("").to_owned()));
        rest = behind;
    }
    text + rest
}

/// The first of some choices, in which commas are escaped.
pub fn first_choice(choices: &str) -> String {
    let marked = choices.replace("\\,", "\0");
    marked.split([',', '|']).next().unwrap_or("").replace('\0', ",")
}

/// The texts of a value that is one or several.
pub fn texts(value: &Value) -> Vec<&str> {
    value
        .as_array()
        .map_or_else(|| vec![value], |all| all.iter().collect())
        .into_iter()
        .filter_map(Value::as_str)
        .collect()
}

#[test]
fn snippets_are_missions_and_written_as_the_formatter_has_it() {
    let snippets = json("snippets/dosm.json");
    let mut begun = Vec::new();
    for (name, snippet) in snippets.as_object().expect("an object") {
        let text = expanded(&texts(&snippet["body"]).join("\n"));
        let body = text.trim_end();
        let whole = if body.contains("dosm 1") { format!("{body}\n") } else { format!("dosm 1\n\n{body}\n") };
        let source = SourceFile::new("snippet.dosm", whole.as_str());
        let mut diagnostics = Diagnostics::new();
        let parsed = syntax::parse(&source, &mut diagnostics);
        assert!(parsed.is_ok() && diagnostics.sorted().is_empty(), "{name}: {whole}\n{diagnostics:?}");
        let formatted = syntax::format::format(&source, &mut diagnostics).map(|formatted| formatted.text);
        assert_eq!(formatted.as_ref(), Ok(&whole), "{name}");
        assert!(snippet["description"].as_str().is_some_and(|d| !d.is_empty()), "{name}");
        begun.extend(body.lines().filter_map(|line| line.split_whitespace().next()).map(str::to_owned));
    }
    for word in dosmc::syntax::words::DECLARATIONS {
        assert!(begun.iter().any(|first| first == word), "no snippet shows `{word}`");
    }
}

#[test]
fn a_mission_to_start_from_checks() {
    let snippets = json("snippets/dosm.json");
    let text = expanded(&texts(&snippets["Mission"]["body"]).join("\n"));
    let mission = crate::common::load(&SourceFile::new("mission.dosm", text), &Default::default());
    assert_eq!(mission.problem.robots.len(), 1);
}

#[test]
fn versions_are_the_compilers_and_pinned() {
    let manifest = json("package.json");
    assert_eq!(manifest["version"], env!("CARGO_PKG_VERSION"));
    for (name, version) in manifest["devDependencies"].as_object().expect("packages") {
        let plain = version.as_str().is_some_and(|v| v.split('.').all(|n| n.parse::<u32>().is_ok()));
        assert!(plain, "{name} is not pinned: {version}");
    }
    let lock = fs::read_to_string(package(HERE).join("package-lock.json")).expect("a lock");
    assert!(!lock.contains("\"resolved\""), "the lock names a registry");
    let changelog = fs::read_to_string(package(HERE).join("CHANGELOG.md")).expect("a changelog");
    assert!(changelog.contains(&format!("\n## {}\n", env!("CARGO_PKG_VERSION"))), "{changelog}");
}

#[test]
fn the_client_has_no_type_errors() {
    let Some(mut check) = node("node_modules/typescript/bin/tsc", "TypeScript's check") else { return };
    output(check.args(["--noEmit", "--project", "tsconfig.json"]));
}

#[test]
fn the_program_is_found_and_lines_go_on_as_they_should() {
    let Some(mut test) = node("--test", "the test of the client by itself") else { return };
    let printed = output(test.args(["test/program.test.mjs", "test/configuration.test.mjs"]));
    assert!(printed.contains("# fail 0") && !printed.contains("# pass 0"), "{printed}");
}

/// Whether a JSON value of a manifest is a file's name inside the extension.
fn named_files(value: &Value, found: &mut Vec<String>) {
    match value {
        Value::String(text) if text.starts_with("./") => found.push(text.clone()),
        Value::Array(all) => all.iter().for_each(|v| named_files(v, found)),
        Value::Object(all) => all.values().for_each(|v| named_files(v, found)),
        _ => {}
    }
}

#[test]
fn the_packed_extension_holds_what_it_names_and_nothing_else() {
    let Some(mut pack) = node("node_modules/@vscode/vsce/vsce", "`vsce package`") else { return };
    let Some(python) = tool(&["python3"], "a look into the packed extension") else { return };
    let dir = tempfile::tempdir().expect("a directory");
    let packed = dir.path().join("dosm.vsix");
    let flags =
        ["package", "--no-dependencies", "--allow-missing-repository", "--no-rewrite-relative-links", "-o"];
    output(pack.args(flags).arg(&packed));
    output(command(python).args(["-m", "zipfile", "-e"]).arg(&packed).arg(dir.path()));
    let inside = dir.path().join("extension");
    let manifest: Value =
        serde_json::from_str(&fs::read_to_string(inside.join("package.json")).expect("a manifest"))
            .expect("JSON");
    let mut named =
        vec!["dist/THIRD-PARTY.txt".to_owned(), manifest["icon"].as_str().expect("an icon").to_owned()];
    named_files(&manifest["contributes"], &mut named);
    named.push(manifest["main"].as_str().expect("a program").to_owned());
    for name in &named {
        assert!(inside.join(name).is_file(), "{name} is named and not packed");
    }
    let packed = files(&inside);
    // Besides: readme, changelog, licence and the manifest itself.
    assert!(packed.len() == named.len() + 4, "{packed:#?}\n{named:#?}");
    let script = fs::read_to_string(inside.join("dist/extension.js")).expect("a program");
    assert!(script.len() < 600_000 && !script.contains(env!("CARGO_MANIFEST_DIR")), "{}", script.len());
}

/// All files under a directory.
fn files(directory: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(directory).expect("a directory").map(|entry| entry.expect("an entry").path());
    entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

#[test]
fn the_guide_names_every_setting_and_command() {
    let manifest = json("package.json");
    let contributes = &manifest["contributes"];
    for page in ["docs/editors/vscode.md", "editors/vscode/README.md"] {
        let text = fs::read_to_string(package(page)).unwrap_or_else(|e| panic!("{page}: {e}"));
        for (name, setting) in contributes["configuration"]["properties"].as_object().expect("settings") {
            let shown =
                setting["default"].as_str().map_or_else(|| setting["default"].to_string(), str::to_owned);
            assert!(text.contains(&format!("| `{name}` | `{shown}` |")), "{page}: {name} = {shown}");
        }
    }
    let readme = fs::read_to_string(package("editors/vscode/README.md")).expect("the readme");
    for command in contributes["commands"].as_array().expect("commands") {
        let title = command["title"].as_str().expect("a title");
        let last = title.rsplit(' ').next().unwrap_or("");
        assert!(readme.contains(title) || readme.contains(&format!("… {last}`")), "{title}");
    }
}

#[test]
fn links_between_the_pages_about_editors_lead_somewhere() {
    let mut count = 0;
    for entry in fs::read_dir(package("docs/editors")).expect("a directory") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|extension| extension != "md") {
            continue;
        }
        let text = fs::read_to_string(&path).expect("a page");
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let file = link.split('#').next().unwrap_or("");
            if !link.starts_with("http") && !file.is_empty() {
                assert!(path.with_file_name(file).exists(), "{}: {link}", path.display());
                count += 1;
            }
        }
    }
    assert!(count > 10, "{count}");
}
