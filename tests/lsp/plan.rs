//! The command that plans a mission, with its progress, its lenses and what is published.

use std::path::Path;

use serde_json::{Value, json};

use crate::client::{Client, uri};

const FIRST: &str = include_str!("../../examples/first.dosm");

fn solve(uri: &str) -> Value {
    json!({ "command": "dosmc.solve", "arguments": [uri] })
}

fn titles(client: &mut Client, uri: &str) -> Vec<String> {
    let lenses = client.ask("textDocument/codeLens", json!({ "textDocument": { "uri": uri } }));
    let title = |l: &Value| l["command"]["title"].as_str().unwrap_or_default().to_string();
    lenses.as_array().expect("a list").iter().map(title).collect()
}

#[test]
fn a_plan_is_found_written_and_linked_to() {
    let directory = tempfile::tempdir().expect("a directory");
    let uri = uri(&directory
        .path()
        .join("héllo.dosm")
        .canonicalize()
        .unwrap_or(directory.path().join("hello.dosm")));
    let mut client = Client::begin();
    client.open(&uri, FIRST);
    assert_eq!(client.codes(&uri), [""; 0]);
    assert_eq!(titles(&mut client, &uri), ["▶ plan this mission"]);
    let outcome = client.ask("workspace/executeCommand", solve(&uri));
    assert_eq!(outcome["status"], "plan");
    let token = client.heard("window/workDoneProgress/create")["token"].clone();
    let mut kinds = Vec::new();
    while kinds.last().is_none_or(|kind| kind != "end") {
        let progress = client.wait(|m| m["method"] == "$/progress" && m["params"]["token"] == token);
        kinds.push(progress["params"]["value"]["kind"].clone());
    }
    assert_eq!(kinds[0], "begin");
    assert!(kinds.len() > 3, "{kinds:?}");
    for name in ["plan.json", "plan.svg", "plan.html", "controller/src/lib.rs"] {
        assert!(directory.path().join("out/hello").join(name).exists(), "{name}");
    }
    let diagnostics = client.diagnostics(&uri);
    let link = diagnostics[0]["codeDescription"]["href"].as_str().expect("a link");
    assert!(Path::new(link.strip_prefix("file://").expect("a file")).exists());
    assert_eq!(diagnostics[0]["severity"], 3);
    let length = outcome["length"].as_u64().expect("a length");
    assert_eq!(titles(&mut client, &uri)[1], format!("plan of {length} steps: picture"));
    let open = json!({ "command": "dosmc.openPage", "arguments": [uri] });
    let page = client.ask("workspace/executeCommand", open.clone());
    assert!(page.as_str().is_some_and(|p| p.ends_with("plan.html")), "{page}");
    assert!(client.heard("window/showDocument")["uri"].as_str().is_some_and(|u| u.ends_with("plan.html")));
    // With another text the plan is of the past.
    client.replace(&uri, &format!("{FIRST}\n// another\n"));
    assert_eq!(client.codes(&uri), [""; 0]);
    assert_eq!(client.ask_wrongly("workspace/executeCommand", open), -32602);
    client.end();
}

#[test]
fn why_there_is_no_plan_is_a_diagnostic() {
    let text = FIRST.replacen("\ngoal", "\nhorizon 1..1\ngoal", 1);
    let text =
        if FIRST.contains("\nhorizon") { FIRST.replace("horizon 1..", "horizon 1..1 //") } else { text };
    let uri = "untitled:Untitled-1";
    let mut client = Client::begin();
    client.open(uri, &text);
    assert_eq!(client.codes(uri), [""; 0]);
    let outcome = client.ask("workspace/executeCommand", solve(uri));
    assert_eq!(outcome["status"], "no_plan", "{outcome}");
    let diagnostics = client.diagnostics(uri);
    assert_eq!(diagnostics[0]["code"], "no_plan");
    assert_eq!(diagnostics[0]["severity"], 2);
    assert!(
        diagnostics[0]["message"].as_str().is_some_and(|m| m.starts_with("no plan of any length in 1..1"))
    );
    client.replace(uri, "dosm 1\nrobot");
    client.diagnostics(uri);
    assert_eq!(client.ask("workspace/executeCommand", solve(uri))["status"], "error");
    client.end();
}

/// A mission that takes long: nobody waits for its plan.
const LONG: &str = include_str!("long.dosm");

#[test]
fn a_run_can_be_stopped_and_there_is_one_at_a_time() {
    let uri = "untitled:long";
    let mut client = Client::begin();
    client.open(uri, LONG);
    client.diagnostics(uri);
    let id = client.request("workspace/executeCommand", solve(uri));
    let token = client.heard("window/workDoneProgress/create")["token"].clone();
    client.wait(|m| m["method"] == "$/progress" && m["params"]["value"]["kind"] == "report");
    assert_eq!(titles(&mut client, uri), ["planning…"]);
    assert_eq!(client.ask_wrongly("workspace/executeCommand", solve(uri)), -32803);
    // Its id is in use, and it is not the other request's to take.
    client.send(&json!({ "jsonrpc": "2.0", "id": id, "method": "textDocument/codeLens", "params": {} }));
    assert_eq!(client.answer(id)["error"]["code"], -32600);
    client.tell("window/workDoneProgress/cancel", json!({ "token": token }));
    let answer = client.answer(id);
    assert_eq!(answer["result"]["status"], "unknown", "{answer}");
    assert_eq!(titles(&mut client, uri).len(), 2);
    // Who closes the mission wants no plan of it any more.
    let id = client.request("workspace/executeCommand", solve(uri));
    client.tell("textDocument/didClose", json!({ "textDocument": { "uri": uri } }));
    assert_eq!(client.answer(id)["result"]["status"], "unknown");
    client.open(uri, LONG);
    client.diagnostics(uri);
    // The request can be cancelled, too, and a session can end while a run goes on.
    let id = client.request("workspace/executeCommand", solve(uri));
    client.tell("$/cancelRequest", json!({ "id": id }));
    assert_eq!(client.answer(id)["error"]["code"], -32800);
    client.heard("window/workDoneProgress/create");
    let token = client.heard("window/workDoneProgress/create")["token"].clone();
    client.wait(|m| m["params"]["token"] == token && m["params"]["value"]["kind"] == "end");
    client.end();
}
