//! What the server says of a mission's text: diagnostics and formatting.

use serde_json::{Value, json};

use crate::client::{Client, everything};

const URI: &str = "file:///tmp/texts.dosm";
const FIRST: &str = include_str!("../../examples/first.dosm");

#[test]
fn diagnostics_come_as_one_types() {
    let mut client = Client::begin();
    client.open(URI, FIRST);
    assert_eq!(client.codes(URI), [""; 0]);
    let line = FIRST.lines().position(|l| l.starts_with("goal")).expect("it has a goal");
    let end = json!({ "line": line, "character": 4 });
    client.change(URI, &json!([{ "range": { "start": end, "end": end }, "text": "s" }]));
    let diagnostics = client.diagnostics(URI);
    let one = &diagnostics[0];
    assert_eq!(one["range"]["start"], json!({ "line": line, "character": 0 }));
    assert_eq!(one["source"], "dosmc");
    assert_eq!(one["severity"], 1);
    let end = json!({ "line": line, "character": 5 });
    let start = json!({ "line": line, "character": 4 });
    client.change(URI, &json!([{ "range": { "start": start, "end": end }, "text": "" }]));
    assert_eq!(client.codes(URI), [""; 0]);
    client.tell("textDocument/didClose", json!({ "textDocument": { "uri": URI } }));
    let closed = client.heard("textDocument/publishDiagnostics");
    assert_eq!(closed["diagnostics"], json!([]));
    client.end();
}

#[test]
fn a_code_links_to_its_explanation_and_others_places_are_named() {
    let text = "dosm 1\nworkspace box (0, 0) .. (9, 9)\nregion a = box (1, 1) .. (2, 2)\nregion a = box (3, 3) .. (4, 4)\n";
    let mut client = Client::begin();
    client.open(URI, text);
    let diagnostics = client.diagnostics(URI);
    let duplicate = diagnostics.iter().find(|d| d["code"] == "dosm::check::duplicate").expect("it is said");
    let message = "`a` is declared twice\nhere: again, as a region";
    assert_eq!(duplicate["message"].as_str().map(|m| m.split("\nhelp").next()), Some(Some(message)));
    let related = &duplicate["relatedInformation"][0]["location"];
    assert_eq!(related["uri"], URI);
    assert_eq!(related["range"]["start"]["line"], 2);
    let href = duplicate["codeDescription"]["href"].as_str().expect("a link").to_string();
    let file = href.strip_prefix("file://").expect("a file");
    let page = std::fs::read_to_string(file).expect("it is there");
    assert!(page.starts_with("# `dosm::check::duplicate`"), "{page}");
    let explain = json!({ "command": "dosmc.explain", "arguments": ["dosm::check::duplicate"] });
    assert_eq!(client.ask("workspace/executeCommand", explain), page);
    assert_eq!(client.heard("window/showDocument")["uri"], href);
    client.end();
    assert!(!std::path::Path::new(file).exists(), "nothing is left behind");
}

#[test]
fn a_client_that_shows_no_links_gets_none() {
    let mut capabilities = everything();
    capabilities["textDocument"]["publishDiagnostics"] = json!({});
    let mut client = Client::begin_with(&[], capabilities);
    client.open(URI, "dosm 1\nrobot");
    assert_eq!(client.diagnostics(URI)[0].get("codeDescription"), None);
    client.end();
}

#[test]
fn what_the_command_line_sets_holds_for_the_session() {
    let text = FIRST.replacen("goal", "param unused_one = 1\ngoal", 1);
    for (arguments, codes) in [(&[][..], 1), (&["--set", "unused_one=two"][..], 1)] {
        let mut client = Client::begin_with(arguments, everything());
        client.open(URI, &text);
        let found = client.codes(URI);
        assert_eq!(found.len(), codes, "{found:?}");
        assert_eq!(found[0] == "dosm::check::unused", arguments.is_empty(), "{found:?}");
        client.end();
    }
}

/// The text after edits, from the last to the first.
fn edited(text: &str, edits: &Value) -> String {
    let offset = |position: &Value| {
        let line = position["line"].as_u64().expect("a line") as usize;
        let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
        start + position["character"].as_u64().expect("a column") as usize
    };
    let mut result = text.to_string();
    for edit in edits.as_array().expect("a list").iter().rev() {
        let range = offset(&edit["range"]["start"])..offset(&edit["range"]["end"]);
        result.replace_range(range, edit["newText"].as_str().expect("a text"));
    }
    result
}

#[test]
fn formatting_gives_edits_that_make_the_style() {
    let messy = FIRST.replace('\n', "\n\n\n").replace(" = ", "   =  ");
    let mut client = Client::begin();
    client.open(URI, &messy);
    let options = json!({ "tabSize": 2, "insertSpaces": true });
    let edits =
        client.ask("textDocument/formatting", json!({ "textDocument": { "uri": URI }, "options": options }));
    let neat = edited(&messy, &edits);
    assert!(edits.as_array().is_some_and(|e| e.len() > 3), "gap by gap: {edits}");
    client.replace(URI, &neat);
    let again =
        client.ask("textDocument/formatting", json!({ "textDocument": { "uri": URI }, "options": options }));
    assert_eq!(again, json!([]));
    client.replace(URI, &messy);
    let range = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 4, "character": 0 } });
    let params = json!({ "textDocument": { "uri": URI }, "range": range, "options": options });
    let some = client.ask("textDocument/rangeFormatting", params);
    let (some, all) = (some.as_array().expect("a list").len(), edits.as_array().expect("a list").len());
    assert!(0 < some && some < all, "{some} of {all}");
    client.replace(URI, "\u{1}");
    let none =
        client.ask("textDocument/formatting", json!({ "textDocument": { "uri": URI }, "options": options }));
    assert_eq!(none, Value::Null);
    client.end();
}
