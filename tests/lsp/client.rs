//! A scripted client: speaks to `dosmc lsp` over its standard input and output, as an editor does.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::time::Duration;

use serde_json::{Value, json};

/// How long an answer may take before the test gives up on it: long, since machines can be busy.
const PATIENCE: Duration = Duration::from_secs(120);

/// A client and its server.
pub struct Client {
    server: Child,
    input: Option<ChildStdin>,
    messages: Receiver<Value>,
    /// What has come and was not asked for yet.
    waiting: Vec<Value>,
    requests: i64,
    versions: i64,
}

impl Client {
    /// Starts a server that has not heard `initialize` yet.
    pub fn start(arguments: &[&str]) -> Client {
        Client::start_in(&std::env::temp_dir(), arguments)
    }

    /// Starts a server that puts temporary files into a directory.
    pub fn start_in(temporary: &Path, arguments: &[&str]) -> Client {
        let mut server = Command::new(env!("CARGO_BIN_EXE_dosmc"))
            .arg("lsp")
            .args(arguments)
            .env("TMPDIR", temporary)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the server can be started");
        let output = server.stdout.take().expect("it has an output");
        let (sender, messages) = mpsc::channel();
        std::thread::spawn(move || {
            let mut output = BufReader::new(output);
            while let Some(body) = body(&mut output) {
                let value = serde_json::from_slice(&body).expect("the server sends JSON");
                if sender.send(value).is_err() {
                    break;
                }
            }
        });
        let input = server.stdin.take();
        Client { server, input, messages, waiting: Vec::new(), requests: 0, versions: 0 }
    }

    /// Starts a session with a client that can do all that the server asks about.
    pub fn begin() -> Client {
        Client::begin_with(&[], everything())
    }

    /// Starts a session with a client of some capabilities.
    pub fn begin_with(arguments: &[&str], capabilities: Value) -> Client {
        let mut client = Client::start(arguments);
        client.ask("initialize", json!({ "processId": null, "rootUri": null, "capabilities": capabilities }));
        client.tell("initialized", json!({}));
        client
    }

    /// Sends bytes as they are.
    pub fn send_raw(&mut self, bytes: &[u8]) {
        let input = self.input.as_mut().expect("the input is open");
        input.write_all(bytes).and_then(|()| input.flush()).expect("the server listens");
    }

    /// Sends a message.
    pub fn send(&mut self, value: &Value) {
        let mut bytes = Vec::new();
        let text = value.to_string();
        write!(bytes, "Content-Length: {}\r\n\r\n{text}", text.len()).expect("memory can be written");
        self.send_raw(&bytes);
    }

    /// Sends a notification.
    pub fn tell(&mut self, method: &str, params: Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    /// Sends a request and gives its id.
    pub fn request(&mut self, method: &str, params: Value) -> i64 {
        self.requests += 1;
        self.send(&json!({ "jsonrpc": "2.0", "id": self.requests, "method": method, "params": params }));
        self.requests
    }

    /// The answer to a request: all of the message.
    pub fn answer(&mut self, id: i64) -> Value {
        self.wait(|message| message.get("method").is_none() && message["id"] == id)
    }

    /// Sends a request and waits for its result, which must be one.
    pub fn ask(&mut self, method: &str, params: Value) -> Value {
        let id = self.request(method, params);
        let answer = self.answer(id);
        assert!(answer.get("error").is_none(), "{method}: {answer}");
        answer["result"].clone()
    }

    /// Sends a request and waits for the error that it must be answered with: its code.
    pub fn ask_wrongly(&mut self, method: &str, params: Value) -> i64 {
        let id = self.request(method, params);
        let answer = self.answer(id);
        answer["error"]["code"].as_i64().unwrap_or_else(|| panic!("{method} is answered: {answer}"))
    }

    /// Waits for the first message that is wanted; others stay for later.
    pub fn wait(&mut self, wanted: impl Fn(&Value) -> bool) -> Value {
        if let Some(at) = self.waiting.iter().position(&wanted) {
            return self.waiting.remove(at);
        }
        loop {
            let message = match self.messages.recv_timeout(PATIENCE) {
                Ok(message) => message,
                Err(why) => panic!("{why}; so far: {:#?}", self.waiting),
            };
            // What the server asks of its client is granted.
            if let (Some(id), Some(_)) = (message.get("id"), message.get("method")) {
                let id = id.clone();
                self.send(&json!({ "jsonrpc": "2.0", "id": id, "result": null }));
            }
            if wanted(&message) {
                return message;
            }
            self.waiting.push(message);
        }
    }

    /// Waits for a notification or a request of the server: its parameters.
    pub fn heard(&mut self, method: &str) -> Value {
        self.wait(|message| message["method"] == method)["params"].clone()
    }

    /// Opens a mission.
    pub fn open(&mut self, uri: &str, text: &str) {
        self.versions += 1;
        let document = json!({ "uri": uri, "languageId": "dosm", "version": self.versions, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
    }

    /// Replaces a mission's text.
    pub fn replace(&mut self, uri: &str, text: &str) {
        self.change(uri, &json!([{ "text": text }]));
    }

    /// Changes a mission.
    pub fn change(&mut self, uri: &str, changes: &Value) {
        self.versions += 1;
        let document = json!({ "uri": uri, "version": self.versions });
        self.tell("textDocument/didChange", json!({ "textDocument": document, "contentChanges": changes }));
    }

    /// The diagnostics that are published for a mission as it was last changed.
    pub fn diagnostics(&mut self, uri: &str) -> Vec<Value> {
        let version = self.versions;
        let message = self.wait(|m| {
            let params = &m["params"];
            let is_it = params["uri"] == uri && params["version"] == version;
            m["method"] == "textDocument/publishDiagnostics" && is_it
        });
        message["params"]["diagnostics"].as_array().expect("a list").clone()
    }

    /// The codes of the diagnostics of a mission, in their order.
    pub fn codes(&mut self, uri: &str) -> Vec<String> {
        let code = |d: &Value| d["code"].as_str().unwrap_or_default().to_string();
        self.diagnostics(uri).iter().map(code).collect()
    }

    /// The most memory that the server has taken, in bytes, where the system tells.
    pub fn peak_memory(&self) -> Option<u64> {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.server.id())).ok()?;
        let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
        let kibibytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
        Some(kibibytes << 10)
    }

    /// Ends the session as the protocol asks.
    pub fn end(mut self) -> ExitStatus {
        self.ask("shutdown", Value::Null);
        self.tell("exit", Value::Null);
        self.server.wait().expect("the server ends")
    }

    /// Goes away.
    pub fn vanish(mut self) -> ExitStatus {
        self.input = None;
        self.server.wait().expect("the server ends")
    }

    /// Asks the system to end the server.
    pub fn terminate(mut self) -> ExitStatus {
        // A shell has `kill` where there is no program of that name.
        let kill = format!("kill -TERM {}", self.server.id());
        let sent = Command::new("sh").args(["-c", &kill]).status().expect("a shell");
        assert!(sent.success());
        self.server.wait().expect("the server ends")
    }

    /// Waits until the server ends by itself.
    pub fn left(mut self) -> ExitStatus {
        self.server.wait().expect("the server ends")
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        // A test that failed leaves no server behind.
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// The body of the next message; `None` at the end.
fn body(input: &mut impl BufRead) -> Option<Vec<u8>> {
    let mut length = None;
    loop {
        let mut line = String::new();
        if input.read_line(&mut line).expect("the output can be read") == 0 {
            return None;
        }
        match line.trim_end().split_once(": ") {
            Some(("Content-Length", value)) => length = value.parse().ok(),
            _ => break,
        }
    }
    let mut body = vec![0; length.expect("a header has a length")];
    input.read_exact(&mut body).expect("the output can be read");
    Some(body)
}

/// The capabilities of a client that can do all that the server asks about.
pub fn everything() -> Value {
    json!({
        "window": { "workDoneProgress": true, "showDocument": { "support": true } },
        "workspace": { "codeLens": { "refreshSupport": true } },
        "textDocument": {
            "publishDiagnostics": { "relatedInformation": true, "codeDescriptionSupport": true },
            "completion": { "completionItem": { "snippetSupport": true } },
            "documentSymbol": { "hierarchicalDocumentSymbolSupport": true },
        },
    })
}

/// The URI of a path.
pub fn uri(path: &Path) -> String {
    format!("file://{}", path.display())
}
