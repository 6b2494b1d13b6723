//! What is shown to somebody who reads: hovers, hints, signatures, colours, highlights.

use serde_json::{Value, json};

use crate::client::Client;

const URI: &str = "file:///tmp/reading.dosm";

const MISSION: &str = "dosm 1
param n = 2
let far = 2 m + 150 cm
workspace box (0, 0) .. (9, 9)
/* 😀 */ region yard[i in 1..n] = box (i, 1) .. (i + 1.5, 3)
base home at (1, 1)
/// Carries *samples*.
dynamics Cart {
  step 0.5 s
  integrator 2
  bound ax, ay in [-1, 1] m/s^2
  disturbance px, py in [-0.05, 0.05] m
}
robot r[i in 1..n]: Cart at (1.5, 1.5 * i)
goal go: always eventually[0 s, 20 s] r[1] in yard[n]
";

/// The position of a text's first place, plus some characters.
fn position(text: &str, what: &str, plus: usize) -> Value {
    let offset = text.find(what).expect("it stands there") + plus;
    let line_start = text[..offset].rfind('\n').map_or(0, |i| i + 1);
    let line = text[..offset].matches('\n').count();
    json!({ "line": line, "character": text[line_start..offset].encode_utf16().count() })
}

fn at(what: &str, plus: usize) -> Value {
    json!({ "textDocument": { "uri": URI }, "position": position(MISSION, what, plus) })
}

fn document() -> Value {
    json!({ "textDocument": { "uri": URI } })
}

fn opened() -> Client {
    let mut client = Client::begin();
    client.open(URI, MISSION);
    assert_eq!(client.codes(URI), ["dosm::check::unused"]);
    client
}

#[test]
fn hovers_show_models_regions_and_words() {
    let mut client = opened();
    let mut said = |what, plus| {
        let answer = client.ask("textDocument/hover", at(what, plus));
        assert_eq!(answer["contents"]["kind"], "markdown");
        (answer["contents"]["value"].as_str().expect("a text").to_string(), answer["range"].clone())
    };
    let (model, range) = said("Cart", 1);
    for piece in [
        "**dynamics model** of 2 robots",
        "px     m      –        [-0.05, 0.05]  ± 0.075",
        "memory K = ",
        "Carries *samples*.",
    ] {
        assert!(model.contains(piece), "`{piece}` is missing in:\n{model}");
    }
    assert_eq!(range["start"], position(MISSION, "Cart", 0));
    assert_eq!(range["end"], position(MISSION, "Cart", 4));
    let (region, range) = said("yard", 2);
    assert!(region.contains("family of 2 regions") && region.contains("left for `in`"), "{region}");
    assert_eq!(range["start"]["character"], 16, "the characters before it count two units for one");
    assert!(said("workspace", 0).0.contains("9 m × 9 m"));
    assert_eq!(client.ask("textDocument/hover", at("= box", 0)), Value::Null);
    client.end();
}

#[test]
fn a_model_is_known_while_the_rest_is_wrong() {
    let mut client = opened();
    let broken = MISSION
        .replace("box (0, 0) .. (9, 9)", "box (0, 0) .. (9, 9)\nobstacle o = bx (1")
        .replace("always", "alway");
    client.replace(URI, &broken);
    assert!(client.codes(URI).len() >= 2);
    let place = json!({ "textDocument": { "uri": URI }, "position": position(&broken, "Cart", 0) });
    let answer = client.ask("textDocument/hover", place);
    assert!(answer["contents"]["value"].as_str().expect("a text").contains("± "), "{answer}");
    client.end();
}

#[test]
fn hints_are_shown_in_the_range_asked_for() {
    let mut client = opened();
    let mut hints = |from: u32, to: u32| -> Vec<String> {
        let range =
            json!({ "start": { "line": from, "character": 0 }, "end": { "line": to, "character": 0 } });
        let params = json!({ "textDocument": { "uri": URI }, "range": range });
        let answer = client.ask("textDocument/inlayHint", params);
        let label = |hint: &Value| hint["label"].as_str().expect("a text").to_string();
        answer.as_array().expect("a list").iter().map(label).collect()
    };
    assert_eq!(hints(0, 99), ["= 3.5 m", "2 regions", "px, vx, py, vy; ax, ay", "2 robots", "= 0..40 steps"]);
    assert_eq!(hints(4, 6), ["2 regions"]);
    client.end();
}

#[test]
fn signatures_follow_the_typing() {
    let mut client = opened();
    let text = format!("{MISSION}jammer J = ball (é");
    client.replace(URI, &text);
    let end = json!({ "line": text.matches('\n').count(), "character": 18 });
    let params = json!({ "textDocument": { "uri": URI }, "position": end });
    let answer = client.ask("textDocument/signatureHelp", params);
    assert_eq!(answer["signatures"][0]["label"], "ball (x, y) radius r norm n");
    assert_eq!(answer["activeParameter"], 0);
    client.end();
}

#[test]
fn colours_come_whole_in_part_and_as_a_difference() {
    let mut client = opened();
    let whole = client.ask("textDocument/semanticTokens/full", document());
    let data = whole["data"].as_array().expect("numbers").clone();
    assert!(data.len() > 200 && data.len().is_multiple_of(5));
    let range = json!({ "start": { "line": 4, "character": 0 }, "end": { "line": 5, "character": 0 } });
    let part = client
        .ask("textDocument/semanticTokens/range", json!({ "textDocument": { "uri": URI }, "range": range }));
    assert_eq!(part["data"][0], 4, "the first one says its line");
    assert_eq!(part["data"][2], 8, "a comment with a character of two units");
    let change = json!([{ "range": { "start": { "line": 1, "character": 10 }, "end": { "line": 1, "character": 11 } }, "text": "1 + 1" }]);
    client.change(URI, &change);
    let params = json!({ "textDocument": { "uri": URI }, "previousResultId": whole["resultId"] });
    let delta = client.ask("textDocument/semanticTokens/full/delta", params.clone());
    let edit = &delta["edits"][0];
    let (start, count) =
        (edit["start"].as_u64().expect("a number"), edit["deleteCount"].as_u64().expect("a number"));
    let mut changed = data;
    let new = edit["data"].as_array().expect("numbers").clone();
    changed.splice(start as usize..(start + count) as usize, new);
    let now = client.ask("textDocument/semanticTokens/full", document());
    assert_eq!(now["data"].as_array(), Some(&changed));
    // What the server does not know any more it sends whole.
    let again = client.ask("textDocument/semanticTokens/full/delta", params);
    assert!(again["data"].is_array(), "{again}");
    client.end();
}

#[test]
fn places_of_a_name_are_highlighted() {
    let mut client = opened();
    let answer = client.ask("textDocument/documentHighlight", at("yard", 0));
    let kinds: Vec<i64> =
        answer.as_array().expect("a list").iter().filter_map(|h| h["kind"].as_i64()).collect();
    assert_eq!(kinds, [3, 2]);
    client.end();
}
