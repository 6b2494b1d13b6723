//! What the server offers at single places, as it goes over the wire. What exactly it says is tested beside
//! each feature; here, that it is asked and answered as the protocol has it.

use serde_json::{Value, json};

use crate::client::Client;

const URI: &str = "file:///tmp/relay.dosm";
const RELAY: &str = include_str!("../../examples/relay.dosm");

/// The position of a text's first character, after the first place where something stands.
fn position(after: &str, what: &str) -> Value {
    let start = RELAY.find(after).expect("it stands there");
    let offset = start + RELAY[start..].find(what).expect("it stands behind it");
    let line_start = RELAY[..offset].rfind('\n').map_or(0, |i| i + 1);
    let column = RELAY[line_start..offset].encode_utf16().count();
    json!({ "line": RELAY[..offset].matches('\n').count(), "character": column })
}

fn at(position: &Value) -> Value {
    json!({ "textDocument": { "uri": URI }, "position": position })
}

fn document() -> Value {
    json!({ "textDocument": { "uri": URI } })
}

fn everywhere() -> Value {
    let end = json!({ "line": RELAY.lines().count(), "character": 0 });
    json!({ "start": { "line": 0, "character": 0 }, "end": end })
}

fn opened() -> Client {
    let mut client = Client::begin();
    client.open(URI, RELAY);
    client.diagnostics(URI);
    client
}

/// The labels of what may stand at a place.
fn labels(list: &Value) -> Vec<&str> {
    let items = list["items"].as_array().or(list.as_array()).expect("a list");
    items.iter().filter_map(|item| item["label"].as_str()).collect()
}

#[test]
fn hover_says_what_a_model_s_tube_is() {
    let mut client = opened();
    let hover = client.ask("textDocument/hover", at(&position("robot scout", "Rover")));
    let text = hover["contents"]["value"].as_str().expect("Markdown");
    assert!(text.contains("tube") && text.contains("0.15"), "{text}");
    assert_eq!(hover["range"]["start"], position("robot scout", "Rover"));
    client.end();
}

#[test]
fn completion_knows_that_a_region_is_wanted() {
    let mut client = opened();
    let list = client.ask("textDocument/completion", at(&position("goal work", "shadow")));
    let labels = labels(&list);
    assert!(labels.contains(&"shadow") && !labels.contains(&"scout"), "{labels:?}");
    client.end();
}

#[test]
fn a_shape_s_signature_is_shown() {
    let mut client = opened();
    let help = client.ask("textDocument/signatureHelp", at(&position("workspace box (", "0")));
    let label = help["signatures"][0]["label"].as_str().expect("a label");
    assert!(label.starts_with("box"), "{label}");
    client.end();
}

#[test]
fn tokens_are_coloured_and_brought_up_to_date() {
    let mut client = opened();
    let all = client.ask("textDocument/semanticTokens/full", document());
    let count = all["data"].as_array().expect("numbers").len();
    assert!(count > 100 && count.is_multiple_of(5), "{count}");
    let mut part = document();
    part["range"] = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 6, "character": 0 } });
    let some = client.ask("textDocument/semanticTokens/range", part);
    assert!(some["data"].as_array().is_some_and(|data| !data.is_empty() && data.len() < count));
    client.replace(URI, &format!("{RELAY}\n// more\n"));
    let mut delta = document();
    delta["previousResultId"] = all["resultId"].clone();
    let changed = client.ask("textDocument/semanticTokens/full/delta", delta);
    assert!(changed["edits"].as_array().is_some_and(|edits| edits.len() <= 1), "{changed}");
    client.end();
}

#[test]
fn constants_are_computed_in_the_text() {
    let mut client = Client::begin();
    client.open(URI, &RELAY.replacen("workspace", "let half = 3 / 2\nworkspace", 1));
    let hints = client
        .ask("textDocument/inlayHint", json!({ "textDocument": { "uri": URI }, "range": everywhere() }));
    assert!(hints.to_string().contains("1.5"), "{hints}");
    client.end();
}

#[test]
fn other_places_of_a_name_are_highlighted() {
    let mut client = opened();
    let places = client.ask("textDocument/documentHighlight", at(&position("goal work", "shadow")));
    assert_eq!(places.as_array().map(Vec::len), Some(2));
    client.end();
}

/// The methods that the server answers, from its table.
fn answered() -> Vec<String> {
    let table = include_str!("../../src/lsp/requests.rs");
    let names = table.split("request::").skip(1).filter_map(|rest| rest.split_once("::METHOD"));
    let mut names: Vec<String> =
        names.map(|(name, _)| name.to_string()).filter(|n| !n.contains('\n')).collect();
    names.sort();
    names.dedup();
    names
}

/// What the protocol calls a request, from `lsp_types`' name of it.
fn method(name: &str) -> String {
    let stem = name.trim_end_matches("Request");
    match stem {
        "GotoDefinition" => "textDocument/definition".into(),
        "GotoTypeDefinition" => "textDocument/typeDefinition".into(),
        "SemanticTokensFull" => "textDocument/semanticTokens/full".into(),
        "SemanticTokensFullDelta" => "textDocument/semanticTokens/full/delta".into(),
        "SemanticTokensRange" => "textDocument/semanticTokens/range".into(),
        "WorkspaceSymbol" => "workspace/symbol".into(),
        _ => {
            let (first, rest) = stem.split_at(1);
            format!("textDocument/{}{rest}", first.to_lowercase())
        }
    }
}

#[test]
fn every_request_of_the_table_is_asked_by_a_test() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/lsp");
    let files = std::fs::read_dir(folder).expect("the tests").map(|entry| entry.expect("an entry").path());
    let tests: Vec<String> = files.filter_map(|path| std::fs::read_to_string(path).ok()).collect();
    let names = answered();
    assert!(names.len() > 10, "{names:?}");
    let asked = |method: &str| tests.iter().any(|text| text.contains(&format!("\"{method}\"")));
    let missing: Vec<String> = names.iter().map(|name| method(name)).filter(|m| !asked(m)).collect();
    assert!(missing.is_empty(), "nobody asks {missing:?}");
}
