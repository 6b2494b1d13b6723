//! A session from beginning to end, and messages that are wrong or come at the wrong time.

use std::process::ExitStatus;

use serde_json::{Value, json};

use crate::client::{Client, everything};

const URI: &str = "file:///tmp/life.dosm";

#[test]
fn a_session_begins_and_ends_as_the_protocol_asks() {
    let mut client = Client::start(&[]);
    let answer = client.ask("initialize", json!({ "capabilities": everything() }));
    assert_eq!(answer["serverInfo"]["name"], "dosmc");
    assert_eq!(answer["capabilities"]["positionEncoding"], "utf-16");
    client.tell("initialized", json!({}));
    assert_eq!(client.end().code(), Some(0));
}

#[test]
fn a_client_that_goes_away_ends_the_server_with_status_1() {
    assert_eq!(Client::begin().vanish().code(), Some(1));
    assert_eq!(Client::start(&[]).vanish().code(), Some(0), "there was no session");
    let mut client = Client::begin();
    client.tell("exit", Value::Null);
    assert_eq!(client.left().code(), Some(1), "`exit` without `shutdown`");
}

#[test]
fn nothing_stays_behind_however_the_server_ends() {
    let endings: [fn(Client) -> ExitStatus; 3] = [Client::end, Client::vanish, Client::terminate];
    for (ending, code) in endings.into_iter().zip([0, 1, 1]) {
        let temporary = tempfile::tempdir().expect("a directory");
        let count = || std::fs::read_dir(temporary.path()).expect("it is there").count();
        let mut client = Client::start_in(temporary.path(), &[]);
        client.ask("initialize", json!({ "capabilities": everything() }));
        client.open(URI, "dosm 1\nrobot");
        // The code's explanation lies there for the link.
        client.diagnostics(URI);
        assert_eq!(count(), 1);
        assert_eq!(ending(client).code(), Some(code));
        assert_eq!(count(), 0);
    }
}

#[test]
fn nothing_is_answered_before_initialize_nor_after_shutdown() {
    let mut client = Client::start(&[]);
    client.open(URI, "dosm 1");
    assert_eq!(client.ask_wrongly("textDocument/hover", json!({})), -32002);
    assert_eq!(client.ask_wrongly("initialize", json!(7)), -32602);
    client.ask("initialize", json!({ "capabilities": {} }));
    assert_eq!(client.ask_wrongly("initialize", json!({ "capabilities": {} })), -32600);
    client.ask("shutdown", Value::Null);
    assert_eq!(client.ask_wrongly("textDocument/hover", json!({})), -32600);
    client.tell("exit", Value::Null);
    assert_eq!(client.left().code(), Some(0));
}

#[test]
fn what_is_no_message_is_answered_and_the_next_one_is_heard() {
    let mut client = Client::begin();
    client.send_raw(b"Content-Length: 1\r\n\r\n{");
    let answer = client.wait(|m| m.get("error").is_some());
    assert_eq!((&answer["id"], &answer["error"]["code"]), (&Value::Null, &json!(-32700)));
    client.send_raw(b"nonsense\r\n\r\n");
    assert_eq!(client.wait(|m| m.get("error").is_some())["error"]["code"], -32700);
    client.send(&json!({ "jsonrpc": "2.0", "id": 4711, "method": 7 }));
    assert_eq!(client.answer(4711)["error"]["code"], -32600);
    client.send(&json!([{ "jsonrpc": "2.0", "id": 1, "method": "shutdown" }]));
    assert_eq!(client.wait(|m| m.get("error").is_some())["error"]["code"], -32600);
    assert_eq!(client.ask_wrongly("textDocument/flyToTheMoon", json!({})), -32601);
    assert_eq!(client.ask_wrongly("textDocument/formatting", json!("what?")), -32602);
    // An answer to nothing, a notification without sense, a change of what is not open.
    client.send(&json!({ "jsonrpc": "2.0", "id": 99, "result": [] }));
    client.tell("textDocument/didChange", json!(["what?"]));
    client.change("file:///nowhere.dosm", &json!([{ "text": "dosm 1" }]));
    client.tell("textDocument/didClose", json!({ "textDocument": { "uri": "file:///nowhere.dosm" } }));
    client.tell("$/setTrace", json!({ "value": "verbose" }));
    let missing = json!({ "textDocument": { "uri": "file:///nowhere.dosm" }, "options": { "tabSize": 2, "insertSpaces": true } });
    assert_eq!(client.ask_wrongly("textDocument/formatting", missing), -32602);
    assert_eq!(client.end().code(), Some(0));
}

#[test]
fn an_id_that_is_in_use_is_refused() {
    let mut client = Client::begin();
    client.open(URI, include_str!("../../examples/first.dosm"));
    let solve = json!({ "command": "dosmc.solve", "arguments": ["untitled:none"] });
    let message =
        json!({ "jsonrpc": "2.0", "id": "a", "method": "workspace/executeCommand", "params": solve });
    client.send(&message);
    let answer = client.wait(|m| m["id"] == "a");
    assert_eq!(answer["error"]["code"], -32602, "no such mission");
    // The id is free again.
    client.send(&message);
    assert_eq!(client.wait(|m| m["id"] == "a")["error"]["code"], -32602);
    client.end();
}

#[test]
fn columns_count_what_was_agreed_upon() {
    let text = "dosm 1\n/* 😀é */ wrkspace box (0, 0) .. (1, 1)\n";
    for (offered, agreed, column) in [
        (json!(null), "utf-16", 10),
        (json!(["utf-16"]), "utf-16", 10),
        (json!(["utf-8", "utf-16"]), "utf-8", 13),
        (json!(["utf-32", "utf-16"]), "utf-32", 9),
    ] {
        let mut capabilities = everything();
        capabilities["general"] = json!({ "positionEncodings": offered });
        let mut client = Client::start(&[]);
        let answer = client.ask("initialize", json!({ "capabilities": capabilities }));
        assert_eq!(answer["capabilities"]["positionEncoding"], agreed);
        client.open(URI, text);
        let diagnostics = client.diagnostics(URI);
        assert_eq!(diagnostics[0]["range"]["start"], json!({ "line": 1, "character": column }), "{agreed}");
        client.end();
    }
}
