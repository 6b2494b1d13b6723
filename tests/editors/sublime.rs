//! The package for Sublime Text, as far as it can be tested without Sublime Text (`bat` runs its syntax).

use std::fs;

use dosmc::syntax::words::CLASSES;
use serde_json::{Value, json};

use crate::common::package;
use crate::vscode;

/// The package's directory.
const HERE: &str = "editors/sublime";

/// The completions: the snippets of the extension for VS Code, and the words that no snippet is called by.
fn completions() -> Value {
    let text = fs::read_to_string(package(vscode::HERE).join("snippets/dosm.json")).expect("the snippets");
    let snippets: Value = serde_json::from_str(&text).expect("JSON");
    let mut all: Vec<Value> = Vec::new();
    for (name, snippet) in snippets.as_object().expect("an object") {
        let contents = without_choices(&vscode::texts(&snippet["body"]).join("\n"));
        for trigger in vscode::texts(&snippet["prefix"]) {
            all.push(
                json!({ "trigger": trigger, "contents": contents, "annotation": name, "kind": "snippet" }),
            );
        }
    }
    let words = CLASSES.iter().flat_map(|(_, words)| words.iter().copied());
    for word in words.filter(|word| word.len() > 1 && word.starts_with(|c: char| c.is_ascii_alphabetic())) {
        if !all.iter().any(|one| one["trigger"] == word) {
            all.push(json!({ "trigger": word, "contents": word, "kind": "keyword" }));
        }
    }
    json!({ "scope": "source.dosm - comment", "completions": all })
}

/// A snippet's text with the first of some choices in their place: Sublime Text has none.
fn without_choices(body: &str) -> String {
    let (mut text, mut rest) = (String::new(), body);
    while let Some((before, after)) = rest.split_once("${") {
        let (place, behind) = after.split_once('}').expect("it is closed");
        let suggestion = match place.split_once('|') {
            Some((number, choices)) => format!("{number}:{}", vscode::first_choice(choices)),
            None => place.to_owned(),
        };
        text.push_str(&format!("{before}${{{suggestion}}}"));
        rest = behind;
    }
    text + rest
}

#[test]
fn completions_are_the_snippets_and_the_words() {
    let path = package(HERE).join("dosm.sublime-completions");
    let fresh = serde_json::to_string_pretty(&completions()).expect("JSON") + "\n";
    if std::env::var_os("DOSMC_UPDATE").is_some() {
        fs::write(&path, &fresh).expect("it can be written");
    }
    let kept = fs::read_to_string(&path).expect("the completions");
    assert!(kept == fresh, "{} is stale; DOSMC_UPDATE=1 writes it anew", path.display());
}

#[test]
fn choices_become_suggestions() {
    assert_eq!(without_choices("a ${1|b\\, c,d|} ${2:e} $0"), "a ${1:b, c} ${2:e} $0");
}

#[test]
fn preferences_can_be_read_and_name_scopes_that_the_syntax_gives() {
    let syntax = fs::read_to_string(package(HERE).join("dosm.sublime-syntax")).expect("the syntax");
    let mut count = 0;
    for entry in fs::read_dir(package(HERE)).expect("a directory") {
        let path = entry.expect("an entry").path();
        let text = fs::read_to_string(&path).expect("a text");
        match path.extension().and_then(|e| e.to_str()) {
            Some("tmPreferences") => {
                let document = roxmltree::Document::parse(&text).unwrap_or_else(|e| panic!("{path:?}: {e}"));
                let scope = document.descendants().find(|n| n.has_tag_name("string")).and_then(|n| n.text());
                for name in scope.expect("a scope").split([' ', ',']).filter(|name| !name.is_empty()) {
                    assert!(syntax.contains(name), "{path:?}: nothing has the scope {name}");
                }
                count += 1;
            }
            Some("sublime-settings") => {
                let code: String = text.lines().filter(|line| !line.starts_with("//")).collect();
                let parsed: Result<Value, _> = serde_json::from_str(&code);
                assert!(parsed.is_ok(), "{path:?}: {parsed:?}");
                count += 1;
            }
            _ => {}
        }
    }
    assert_eq!(count, 5);
}
