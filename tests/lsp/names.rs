//! Going to declarations and uses, and giving things another name.

use serde_json::{Value, json};

use crate::client::Client;

const URI: &str = "file:///tmp/names.dosm";

const MISSION: &str = "dosm 1
param n = 2
workspace box (0, 0) .. (9, 9)
/* 😀 */ region yard[i in 1..n] = box (i, 1) .. (i + 1, 2)
base home at (1, 1)
dynamics Cart {
  step 0.5 s
  state px: m, vx: m/s, py: m, vy: m/s
  input ax: m/s^2, ay: m/s^2
  position px, py
  A = [1, 0.5, 0, 0; 0, 1, 0, 0; 0, 0, 1, 0.5; 0, 0, 0, 1]
  B = [0.125, 0; 0.5, 0; 0, 0.125; 0, 0.5]
  bound vx, vy in [-1, 1] m/s
  bound ax, ay in [-1, 1] m/s^2
}
robot r[i in 1..n]: Cart at { px = 1.5, py = 1.5 * i }
goal go: forall q in all: eventually q in yard[n]
goal one: always r[1] in yard[1]
";

/// The position of the `nth` place (from 0) where a text stands, plus some characters.
fn position(text: &str, what: &str, nth: usize, plus: usize) -> Value {
    let offset = text.match_indices(what).nth(nth).expect("it stands there").0 + plus;
    let line_start = text[..offset].rfind('\n').map_or(0, |i| i + 1);
    let line = text[..offset].matches('\n').count();
    json!({ "line": line, "character": text[line_start..offset].encode_utf16().count() })
}

fn at(position: &Value) -> Value {
    json!({ "textDocument": { "uri": URI }, "position": position })
}

fn opened() -> Client {
    let mut client = Client::begin();
    client.open(URI, MISSION);
    assert_eq!(client.codes(URI), [""; 0]);
    client
}

/// The mission with the edits of a rename, or why there are none.
fn renamed(client: &mut Client, position: &Value, name: &str) -> Result<String, String> {
    let mut params = at(position);
    params["newName"] = name.into();
    let id = client.request("textDocument/rename", params);
    let answer = client.answer(id);
    if let Some(error) = answer.get("error") {
        assert_eq!(error["code"], -32803, "{answer}");
        return Err(error["message"].as_str().expect("a text").to_string());
    }
    let mut lines: Vec<Vec<u16>> = MISSION.split('\n').map(|l| l.encode_utf16().collect()).collect();
    let edits = answer["result"]["changes"][URI].as_array().expect("a list").clone();
    for edit in edits.iter().rev() {
        let place = |end: &str, which: &str| edit["range"][end][which].as_u64().expect("a number") as usize;
        let new = edit["newText"].as_str().expect("a text").encode_utf16();
        let columns = place("start", "character")..place("end", "character");
        lines[place("start", "line")].splice(columns, new);
    }
    let lines: Vec<String> = lines.iter().map(|l| String::from_utf16_lossy(l)).collect();
    Ok(lines.join("\n"))
}

#[test]
fn a_use_leads_to_its_declaration_and_back() {
    let mut client = opened();
    for (what, nth, declared) in [
        ("yard", 2, position(MISSION, "yard", 0, 0)),
        ("q in yard", 0, position(MISSION, "q in all", 0, 0)),
        ("vx,", 0, position(MISSION, "vx", 0, 0)),
    ] {
        let found = client.ask("textDocument/definition", at(&position(MISSION, what, nth, 1)));
        assert_eq!(found["range"]["start"], declared, "{what}");
        assert_eq!(found["uri"], URI);
    }
    let mut params = at(&position(MISSION, "yard", 0, 2));
    for (with_declaration, count) in [(true, 3), (false, 2)] {
        params["context"] = json!({ "includeDeclaration": with_declaration });
        let found = client.ask("textDocument/references", params.clone());
        assert_eq!(found.as_array().map(Vec::len), Some(count));
    }
    let model = client.ask("textDocument/typeDefinition", at(&position(MISSION, "r[1]", 0, 0)));
    assert_eq!(model["range"]["start"], position(MISSION, "Cart", 0, 0));
    for nowhere in [position(MISSION, "workspace", 0, 2), json!({ "line": 900, "character": 900 })] {
        assert_eq!(client.ask("textDocument/definition", at(&nowhere)), Value::Null);
    }
    client.end();
}

#[test]
fn a_name_is_changed_wherever_it_stands() {
    let mut client = opened();
    for (what, nth, old, new, count) in [
        ("yard", 1, "yard", "garden", 3),
        ("Cart", 1, "Cart", "Truck", 2),
        ("q in yard", 0, "q in", "anyone in", 2),
        ("vx", 1, "vx", "speed", 2),
        ("go:", 0, "go:", "travel:", 1),
    ] {
        let name = new.trim_end_matches([':']).trim_end_matches(" in");
        let place = position(MISSION, what, nth, 0);
        let prepared = client.ask("textDocument/prepareRename", at(&place));
        assert_eq!(prepared["placeholder"], old.trim_end_matches([':']).trim_end_matches(" in"));
        let text = renamed(&mut client, &place, name).expect("it can be renamed");
        assert_eq!(text, MISSION.replace(old, new), "{old}");
        assert_eq!(text.matches(new).count(), count);
    }
    client.end();
}

#[test]
fn a_name_that_would_change_what_is_meant_is_refused() {
    let mut client = opened();
    let yard = position(MISSION, "yard", 0, 0);
    for (name, why) in [
        ("1st", "no name"),
        ("", "no name"),
        ("é", "no name"),
        ("until", "a word of the language"),
        ("home", "there is a base station `home`"),
        ("sqrt", "a word of the language"),
        ("q", "another thing"),
    ] {
        let refused = renamed(&mut client, &yard, name).expect_err(name);
        assert!(refused.contains(why), "{name}: {refused}");
    }
    for (place, why) in [
        (position(MISSION, "A = ", 0, 0), "from the language"),
        (position(MISSION, "workspace", 0, 0), "no name of the mission"),
    ] {
        let refused = renamed(&mut client, &place, "other").expect_err("it has no name of its own");
        assert!(refused.contains(why), "{refused}");
    }
    client.end();
}
