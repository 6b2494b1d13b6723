//! The loop that hears the client, and the workers that answer it.
//!
//! The loop does nothing that takes time: it keeps the texts, and passes requests on with the texts as they
//! are at that moment. So a cancelled request is answered at once, whatever the workers are at, and of many
//! changes in a row only the last is looked at.

use std::panic::{self, AssertUnwindSafe};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender};
use std::thread::{self, JoinHandle};

use lsp_server::{ErrorCode, Message, Notification, Request, RequestId, Response};
use lsp_types::notification::{self, Notification as _};
use lsp_types::request::{self, Request as _};
use lsp_types::{
    CancelParams, DidChangeTextDocumentParams, DidChangeWorkspaceFoldersParams, DidCloseTextDocumentParams,
    DidOpenTextDocumentParams, InitializeParams, NumberOrString, WorkDoneProgressCancelParams,
    WorkspaceFolder,
};
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::document::Document;
use super::queue::{Job, Queue};
use super::session::{Client, Session, refusal};
use super::wire::{self, Arrival};
use super::{Host, capabilities, commands, requests};
use crate::driver::Overrides;

/// The stack of threads that read missions, in bytes: formulas nest.
pub const STACK: usize = 16 << 20;

/// How many threads answer requests.
const ANSWERING: usize = 2;

/// How a session ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// As the protocol asks: `shutdown`, then `exit`.
    Orderly,
    /// Without `shutdown`.
    Abrupt,
    /// Before anything was said: there was no client.
    Unused,
}

/// Serves a client until it says `exit` or goes away.
pub fn serve(
    incoming: &Receiver<Arrival>,
    outgoing: &Sender<Value>,
    overrides: &Overrides,
    host: &Arc<dyn Host>,
) -> Ending {
    let (client, folders) = match handshake(incoming, outgoing) {
        Ok(begun) => begun,
        Err(ending) => return ending,
    };
    let session = Arc::new(Session::new(client, overrides.clone(), Arc::clone(host), outgoing.clone()));
    session.change_folders(&folders, &[]);
    let queue = Arc::new(Queue::default());
    let workers = workers(&session, &queue);
    let ending =
        Server { session: Arc::clone(&session), queue: Arc::clone(&queue), shut: false }.hear(incoming);
    session.runs.stop_all();
    queue.close();
    if ending == Ending::Orderly {
        // What is asked is answered; a look that goes on is of no use to anybody.
        for worker in workers.into_iter().take(ANSWERING) {
            let _ = worker.join();
        }
    }
    ending
}

/// Waits for `initialize` and answers it; all other requests are refused until then. Where it does not come,
/// gives how the session ended.
fn handshake(
    incoming: &Receiver<Arrival>,
    outgoing: &Sender<Value>,
) -> Result<(Client, Vec<WorkspaceFolder>), Ending> {
    let answer = |id, response_result| {
        let _ = outgoing.send(wire::encode(&Message::Response(Response { id, response_result })));
    };
    let mut end = Ending::Unused;
    for arrival in incoming {
        end = Ending::Abrupt;
        match arrival {
            Arrival::Message(Message::Request(Request { id, method, params })) => {
                if method != request::Initialize::METHOD {
                    let why = "the session has not begun: `initialize` comes first";
                    answer(id, Err(refusal(ErrorCode::ServerNotInitialized, why)));
                    continue;
                }
                match serde_json::from_value::<InitializeParams>(params) {
                    Ok(params) => {
                        let client = Client::new(&params.capabilities);
                        answer(id, Ok(capabilities::answer(client)));
                        return Ok((client, folders(params)));
                    }
                    Err(error) => answer(id, Err(refusal(ErrorCode::InvalidParams, error.to_string()))),
                }
            }
            Arrival::Message(Message::Notification(n)) if n.method == notification::Exit::METHOD => {
                break;
            }
            Arrival::Message(_) => {}
            Arrival::Malformed(malformed) => {
                let _ = outgoing.send(malformed.answer());
            }
        }
    }
    Err(end)
}

/// The folders that a session begins with.
#[expect(deprecated, reason = "older clients name one root only")]
fn folders(params: InitializeParams) -> Vec<WorkspaceFolder> {
    let root = params.root_uri.map(|uri| vec![WorkspaceFolder { uri, name: String::new() }]);
    params.workspace_folders.or(root).unwrap_or_default()
}

/// The loop's state.
struct Server {
    session: Arc<Session>,
    queue: Arc<Queue>,
    /// Whether `shutdown` came.
    shut: bool,
}

impl Server {
    fn hear(mut self, incoming: &Receiver<Arrival>) -> Ending {
        for arrival in incoming {
            match arrival {
                Arrival::Malformed(malformed) => self.session.send_value(malformed.answer()),
                Arrival::Message(Message::Request(request)) => self.request(request),
                Arrival::Message(Message::Notification(note))
                    if note.method == notification::Exit::METHOD =>
                {
                    return if self.shut { Ending::Orderly } else { Ending::Abrupt };
                }
                Arrival::Message(Message::Notification(note)) => self.notification(note),
                // What the client says of a picture that it was to open changes nothing.
                Arrival::Message(Message::Response(_)) => {}
            }
        }
        Ending::Abrupt
    }

    fn request(&mut self, Request { id, method, params }: Request) {
        if !self.session.begin(&id) {
            let response_result = Err(refusal(ErrorCode::InvalidRequest, format!("there is a request {id}")));
            return self.session.send(&Message::Response(Response { id, response_result }));
        }
        match method.as_str() {
            _ if self.shut => {
                self.session.answer(id, Err(refusal(ErrorCode::InvalidRequest, "the session has ended")));
            }
            request::Initialize::METHOD => {
                self.session.answer(id, Err(refusal(ErrorCode::InvalidRequest, "the session has begun")));
            }
            request::Shutdown::METHOD => {
                self.shut = true;
                self.session.answer(id, Ok(Value::Null));
            }
            request::ExecuteCommand::METHOD => commands::execute(&self.session, id, params),
            _ => self.queue.ask(Job { id, method, params, documents: self.session.documents() }),
        }
    }

    fn notification(&self, note: Notification) {
        match note.method.as_str() {
            notification::DidOpenTextDocument::METHOD => with(note.params, |p| self.open(p)),
            notification::DidChangeTextDocument::METHOD => with(note.params, |p| self.change(p)),
            notification::DidCloseTextDocument::METHOD => with(note.params, |p| self.close(p)),
            notification::DidChangeWorkspaceFolders::METHOD => {
                with(note.params, |p: DidChangeWorkspaceFoldersParams| {
                    self.session.change_folders(&p.event.added, &p.event.removed);
                });
            }
            notification::Cancel::METHOD => with(note.params, |p: CancelParams| {
                let id = match p.id {
                    NumberOrString::Number(id) => RequestId::from(id),
                    NumberOrString::String(id) => RequestId::from(id),
                };
                self.session.runs.stop_request(&id);
                self.session.cancel(id);
            }),
            notification::WorkDoneProgressCancel::METHOD => {
                with(note.params, |p: WorkDoneProgressCancelParams| self.session.runs.stop(&p.token));
            }
            _ => {}
        }
    }

    fn open(&self, DidOpenTextDocumentParams { text_document: opened }: DidOpenTextDocumentParams) {
        let uri = opened.uri.clone();
        let encoding = self.session.client.encoding;
        let overrides = self.session.overrides.clone();
        self.session.put(Document::new(opened.uri, opened.version, opened.text, encoding, overrides));
        self.queue.look(uri);
    }

    fn change(
        &self,
        DidChangeTextDocumentParams { text_document: id, content_changes }: DidChangeTextDocumentParams,
    ) {
        // A mission that was never opened has no text to change.
        let Some(document) = self.session.document(&id.uri) else { return };
        let changed = document.changed(id.version, content_changes, self.session.client.encoding);
        drop(document);
        self.session.put(changed);
        self.queue.look(id.uri);
    }

    fn close(&self, DidCloseTextDocumentParams { text_document: id }: DidCloseTextDocumentParams) {
        self.session.close(id.uri);
    }
}

/// Does something with a notification's parameters; those that can't be read are passed over, since nothing
/// can be answered.
fn with<P: DeserializeOwned>(params: Value, act: impl FnOnce(P)) {
    if let Ok(params) = serde_json::from_value(params) {
        act(params);
    }
}

/// Starts the threads that answer and the one that looks: a mission that takes long to look at keeps nobody
/// from asking about another.
fn workers(session: &Arc<Session>, queue: &Arc<Queue>) -> Vec<JoinHandle<()>> {
    let spawn = |name: &str, work: fn(&Session, &Queue)| {
        let (session, queue) = (Arc::clone(session), Arc::clone(queue));
        thread::Builder::new().name(name.into()).stack_size(STACK).spawn(move || work(&session, &queue))
    };
    let answering = (0..ANSWERING).map(|_| spawn("answers", answer_all));
    answering.chain([spawn("looks", look_at_all)]).flatten().collect()
}

/// Answers what is asked until the queue is closed.
fn answer_all(session: &Session, queue: &Queue) {
    while let Some(job) = queue.next_request() {
        if session.is_wanted(&job.id) {
            let id = job.id.clone();
            // A bug in an answer must not end the session.
            let answer = panic::catch_unwind(AssertUnwindSafe(|| requests::answer(session, job)));
            let failed = |_| Err(refusal(ErrorCode::InternalError, "internal error: please report it"));
            session.answer(id, answer.unwrap_or_else(failed));
        }
    }
}

/// Looks at what has changed until the queue is closed.
fn look_at_all(session: &Session, queue: &Queue) {
    while let Some(uri) = queue.next_look() {
        if let Some(document) = session.document(&uri) {
            let _ = panic::catch_unwind(AssertUnwindSafe(|| look(session, queue, &document)));
        }
    }
}

/// Looks at a mission and publishes what is wrong with it, once for each text that stands for a while.
fn look(session: &Session, queue: &Queue, document: &Document) {
    document.whole();
    if !queue.awaits_look(&document.uri) {
        session.publish(document);
    }
}
