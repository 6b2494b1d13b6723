//! The syntax for Sublime Text, in `bat`, which has Sublime's engine without the window.
//!
//! A theme of the test's own gives every scope a colour of its own, so that what bat prints says which scope each
//! character has. They have to be those of the grammar for VS Code, character by character, over the whole corpus.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;
use tempfile::TempDir;

use crate::common::package;
use crate::tools::{command, output, tool};
use crate::vscode;

/// The syntax.
const SYNTAX: &str = "editors/sublime/dosm.sublime-syntax";

/// The scope of each character that is not blank, by line and column from 1; empty where there is none.
type Scopes = BTreeMap<(usize, usize), (char, String)>;

/// bat with the syntax and a theme with a colour for each scope.
struct Bat {
    program: std::path::PathBuf,
    directory: TempDir,
    /// The scopes; the colour of the n-th is n + 1.
    scopes: Vec<String>,
}

impl Bat {
    /// Sets bat up; says loudly when it isn't there.
    fn new() -> Option<Bat> {
        let program = tool(&["batcat", "bat"], "the syntax for bat and Sublime Text")?;
        let directory = tempfile::tempdir().expect("a directory");
        let text = fs::read_to_string(package(SYNTAX)).expect("the syntax");
        let mut scopes: Vec<String> = text.lines().filter_map(scope_of).map(str::to_owned).collect();
        scopes.sort();
        scopes.dedup();
        for (folder, name, content) in
            [("syntaxes", "dosm.sublime-syntax", text.clone()), ("themes", "scopes.tmTheme", theme(&scopes))]
        {
            fs::create_dir(directory.path().join(folder)).expect("a directory");
            fs::write(directory.path().join(folder).join(name), content).expect("a file");
        }
        let bat = Bat { program, directory, scopes };
        output(bat.command().args(["cache", "--build"]));
        Some(bat)
    }

    fn command(&self) -> Command {
        let mut command = command(&self.program);
        let cache = self.directory.path().join("cache");
        command.env("BAT_CONFIG_DIR", self.directory.path()).env("BAT_CACHE_PATH", cache);
        command.env("COLORTERM", "truecolor").env_remove("NO_COLOR").env_remove("BAT_THEME");
        command
    }

    /// The scopes of a file.
    fn scopes(&self, file: &Path) -> Scopes {
        let flags = ["--color=always", "--style=plain", "--paging=never", "--wrap=never", "--tabs=0"];
        let printed = output(self.command().args(flags).arg("--theme=scopes").arg(file));
        let (mut found, mut scope) = (Scopes::new(), String::new());
        for (index, line) in printed.lines().enumerate() {
            let mut column = 1;
            for (at, piece) in line.split('\u{1b}').enumerate() {
                // Behind each escape: `[38;2;R;G;Bm` or `[0m`, and text.
                let code = piece.strip_prefix('[').and_then(|rest| rest.split_once('m')).filter(|_| at > 0);
                let text = code.map_or(piece, |(_, text)| text);
                scope = code.map_or(scope, |(code, _)| self.meant(code).to_owned());
                for character in text.chars() {
                    if !character.is_whitespace() {
                        found.insert((index + 1, column), (character, scope.clone()));
                    }
                    column += 1;
                }
            }
        }
        found
    }

    /// The scope whose colour a code sets.
    fn meant(&self, code: &str) -> &str {
        let number = code.strip_prefix("38;2;0;0;").and_then(|blue| blue.parse::<usize>().ok()).unwrap_or(0);
        number.checked_sub(1).and_then(|at| self.scopes.get(at)).map_or("", String::as_str)
    }
}

/// The scope that a line of the syntax gives: `scope: a.b` or `1: a.b`, with the language's name at its end.
fn scope_of(line: &str) -> Option<&str> {
    let value = line.split_once(": ")?.1.trim();
    let scope = value.ends_with(".dosm") && !value.starts_with("source.") && !value.starts_with("meta.");
    scope.then_some(value)
}

/// A theme in which the n-th scope has the blue n + 1, and all else none.
fn theme(scopes: &[String]) -> String {
    let color = |blue: usize| format!("<key>foreground</key><string>#0000{blue:02X}</string>");
    let rule = |(at, scope): (usize, &String)| {
        let color = color(at + 1);
        format!(
            "<dict><key>scope</key><string>{scope}</string><key>settings</key><dict>{color}</dict></dict>\n"
        )
    };
    assert!(scopes.len() < 255, "more scopes than colours");
    let rules: String = scopes.iter().enumerate().map(rule).collect();
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<plist version=\"1.0\"><dict><key>name</key><string>scopes</string>\n\
         <key>settings</key><array><dict><key>settings</key><dict>{}</dict></dict>\n{rules}</array></dict></plist>\n",
        color(0)
    )
}

/// The scopes that VS Code's engine gives to some files.
fn scopes_in_vscode(files: &[std::path::PathBuf]) -> Option<Vec<Scopes>> {
    let mut tokens = vscode::node("test/tokens.mjs", "the comparison of bat with VS Code")?;
    let list: Value = serde_json::from_str(&output(tokens.arg("--json").args(files))).expect("JSON");
    let of = |file: &std::path::PathBuf| {
        let mut found = Scopes::new();
        for token in list[file.to_string_lossy().as_ref()].as_array().expect("tokens") {
            let place =
                |at: usize| token[at].as_u64().and_then(|n| usize::try_from(n).ok()).expect("a place");
            let scope = token[3].as_str().filter(|s| !s.starts_with("source.") && !s.starts_with("meta."));
            for (at, character) in token[2].as_str().expect("text").chars().enumerate() {
                if !character.is_whitespace() {
                    let scope = scope.unwrap_or("").to_owned();
                    found.insert((place(0), place(1) + at), (character, scope));
                }
            }
        }
        found
    };
    Some(files.iter().map(of).collect())
}

#[test]
fn bat_gives_every_character_the_scope_that_vscode_gives_it() {
    let Some(bat) = Bat::new() else { return };
    let mut files = vscode::corpus();
    let assertions = fs::read_dir(package(vscode::HERE).join("test/grammar")).expect("a directory");
    files.extend(assertions.map(|entry| entry.expect("an entry").path()));
    let Some(expected) = scopes_in_vscode(&files) else { return };
    let mut compared = 0;
    for (file, expected) in files.iter().zip(expected) {
        let found = bat.scopes(file);
        let differing = expected.iter().find(|(place, scope)| found.get(place) != Some(scope));
        if let Some((place, scope)) = differing {
            panic!("{}:{place:?}: {scope:?} in VS Code, {:?} in bat", file.display(), found.get(place));
        }
        assert_eq!(found.len(), expected.len(), "{}", file.display());
        compared += expected.len();
    }
    assert!(compared > 50_000, "{compared}");
}

#[test]
fn bat_colours_what_stands_at_some_places() {
    let Some(bat) = Bat::new() else { return };
    let scopes = bat.scopes(&package("examples/relay.dosm"));
    let text = fs::read_to_string(package("examples/relay.dosm")).expect("a mission");
    for (needle, scope) in [
        ("//! A relay", "punctuation.definition.comment.dosm"),
        ("A relay around", "comment.line.documentation.dosm"),
        ("mission relay", "storage.type.mission.dosm"),
        ("relay\n", "entity.name.namespace.mission.dosm"),
        ("box (0, 0)", "support.function.shape.dosm"),
        ("shadow = box", "entity.name.type.area.dosm"),
        ("radius 1.5", "keyword.other.shape.dosm"),
        ("1.5", "constant.numeric.dosm"),
        ("vx, vy in", "variable.other.member.dosm"),
        ("m/s^2", "keyword.other.unit.dosm"),
        ("scout: Rover", "variable.other.robot.dosm"),
        ("Rover at", "entity.name.type.dynamics.dosm"),
        ("work: eventually", "entity.name.function.formula.dosm"),
        ("eventually scout", "keyword.control.temporal.dosm"),
        ("shadow\n", "entity.name.type.area.dosm"),
    ] {
        let at = text.find(needle).unwrap_or_else(|| panic!("no {needle:?}"));
        let line = text[..at].matches('\n').count() + 1;
        let column = at - text[..at].rfind('\n').map_or(0, |end| end + 1) + 1;
        assert_eq!(scopes.get(&(line, column)).map(|(_, s)| s.as_str()), Some(scope), "{needle:?}");
    }
}
