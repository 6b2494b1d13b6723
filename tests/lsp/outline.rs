//! Completion, outlines, symbols of the workspace, folds and growing selections.

use serde_json::{Value, json};

use crate::client::{self, Client};

const URI: &str = "file:///tmp/outline.dosm";

const MISSION: &str = "dosm 1
workspace box (0, 0) .. (9, 9)
/* 😀 */ region yard = box (1, 1) .. (3, 2)
base home at (1, 1)
dynamics Cart {
  step 0.5 s
  integrator 2
  bound ax, ay in [-1, 1] m/s^2
}
robot cart: Cart at (1.5, 1.5)
goal go: always cart in yard
";

fn document() -> Value {
    json!({ "textDocument": { "uri": URI } })
}

fn names(symbols: &Value) -> Vec<&str> {
    symbols.as_array().expect("a list").iter().filter_map(|s| s["name"].as_str()).collect()
}

#[test]
fn completion_is_told_from_the_place_and_the_character_typed() {
    let mut client = Client::begin();
    client.open(URI, MISSION);
    let mut ask = |line: u32, character: u32, typed: Option<&str>| {
        let context = match typed {
            Some(typed) => json!({ "triggerKind": 2, "triggerCharacter": typed }),
            None => json!({ "triggerKind": 1 }),
        };
        let position = json!({ "line": line, "character": character });
        let answer = client.ask(
            "textDocument/completion",
            json!({ "textDocument": { "uri": URI }, "position": position, "context": context }),
        );
        answer["items"].as_array().map_or(Vec::new(), |items| {
            items.iter().map(|i| i["label"].as_str().unwrap_or_default().to_string()).collect::<Vec<_>>()
        })
    };
    assert_eq!(ask(10, 24, Some(" ")), ["yard"]);
    assert_eq!(ask(10, 24, None), ["yard"]);
    assert_eq!(ask(9, 12, Some(" ")), ["Cart"]);
    assert_eq!(ask(7, 0, None).first().map(String::as_str), Some("bound"));
    assert!(ask(2, 5, None).is_empty(), "in a comment");
    client.end();
}

#[test]
fn an_outline_is_a_tree_or_a_list() {
    let mut client = Client::begin();
    client.open(URI, MISSION);
    let outline = client.ask("textDocument/documentSymbol", document());
    assert_eq!(names(&outline), ["workspace", "yard", "home", "Cart", "cart", "go"]);
    assert_eq!(names(&outline[3]["children"]), ["step", "integrator", "bound"]);
    // Behind a character of two UTF-16 units.
    assert_eq!(outline[1]["selectionRange"]["start"], json!({ "line": 2, "character": 16 }));
    client.end();
    let mut client = Client::begin_with(&[], json!({}));
    client.open(URI, MISSION);
    let outline = client.ask("textDocument/documentSymbol", document());
    assert_eq!(outline[4]["containerName"], "Cart");
    client.end();
}

#[test]
fn symbols_of_the_workspace_are_those_of_open_missions_first() {
    let folder = tempfile::tempdir().expect("a folder");
    let closed = folder.path().join("closed one.dosm");
    std::fs::write(&closed, "dosm 1\nregion yard_2 = box (0, 0) .. (1, 1)\nregion orchard = bax")
        .expect("written");
    let open = folder.path().join("open.dosm");
    std::fs::write(&open, "dosm 1\nregion yard_of_old = box (0, 0) .. (1, 1)").expect("written");
    let mut client = Client::begin();
    client.open(&client::uri(&open), MISSION);
    let mut ask = |query: &str| client.ask("workspace/symbol", json!({ "query": query }));
    assert_eq!(names(&ask("yard")), ["yard"]);
    let added = json!([{ "uri": client::uri(folder.path()), "name": "missions" }]);
    client.tell("workspace/didChangeWorkspaceFolders", json!({ "event": { "added": added, "removed": [] } }));
    let mut ask = |query: &str| client.ask("workspace/symbol", json!({ "query": query }));
    let found = ask("YARD");
    assert_eq!(names(&found), ["yard", "yard_2"]);
    assert!(found[1]["location"]["uri"].as_str().expect("a URI").ends_with("/closed%20one.dosm"), "{found}");
    assert_eq!(found[1]["location"]["range"]["start"], json!({ "line": 1, "character": 7 }));
    assert_eq!(names(&ask("ochd")), ["orchard"]);
    // What has changed on the disk is read anew.
    std::fs::write(&closed, "dosm 1\nregion yard_3 = box (0, 0) .. (1, 1)").expect("written");
    assert_eq!(names(&ask("yard_")), ["yard_3"]);
    client.tell("workspace/didChangeWorkspaceFolders", json!({ "event": { "added": [], "removed": added } }));
    assert!(names(&client.ask("workspace/symbol", json!({ "query": "yard_" }))).is_empty());
    client.end();
}

#[test]
fn blocks_fold_and_selections_grow() {
    let mut client = Client::begin();
    client.open(URI, MISSION);
    let folds = client.ask("textDocument/foldingRange", document());
    assert_eq!(folds, json!([{ "startLine": 4, "endLine": 7 }]));
    let mut params = document();
    params["positions"] = json!([{ "line": 10, "character": 25 }, { "line": 99, "character": 0 }]);
    let ranges = client.ask("textDocument/selectionRange", params);
    assert_eq!(ranges[0]["range"]["start"], json!({ "line": 10, "character": 24 }));
    assert_eq!(ranges[0]["parent"]["range"]["start"], json!({ "line": 10, "character": 16 }));
    assert_eq!(ranges.as_array().map(Vec::len), Some(2));
    client.end();
}
