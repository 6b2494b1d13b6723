//! What the threads of a server share.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicI32, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;

use lsp_server::{ErrorCode, Message, Notification, Request, RequestId, Response, ResponseError};
use lsp_types::notification::PublishDiagnostics;
use lsp_types::{ClientCapabilities, PublishDiagnosticsParams, Uri, WorkspaceFolder};
use serde::Serialize;
use serde_json::Value;

use super::document::Document;
use super::lines::Encoding;
use super::semantic::Colours;
use super::server::STACK;
use super::solve::Runs;
use super::symbols::Shelf;
use super::tubes::Tubes;
use super::wire;
use super::{Host, diagnostics, location};
use crate::driver::Overrides;

/// From how many bytes on a mission is large.
const LARGE: usize = 1 << 18;

/// The open missions, by their URIs.
pub type Documents = BTreeMap<String, Arc<Document>>;

/// What the client can do.
#[derive(Clone, Copy, Debug, Default)]
pub struct Client {
    /// What columns count.
    pub encoding: Encoding,
    /// Whether it shows the progress of what the server does.
    pub progress: bool,
    /// Whether it opens files that the server names.
    pub show_document: bool,
    /// Whether it shows links behind codes.
    pub code_links: bool,
    /// Whether it asks again for lenses when told to.
    pub refresh_lenses: bool,
    /// Whether it takes actions that are more than commands.
    pub action_literals: bool,
    /// Whether it shows an outline as a tree.
    pub symbol_trees: bool,
    /// Whether a completion may have places to fill in.
    pub snippets: bool,
    /// Whether a completion may say how to insert and how to replace.
    pub insert_replace: bool,
    /// Whether what is said about a completion may be Markdown.
    pub markdown_completion: bool,
    /// Whether it colours what needs no meaning by itself.
    pub own_colours: bool,
}

impl Client {
    /// What the capabilities that a client sends say.
    pub fn new(capabilities: &ClientCapabilities) -> Client {
        let general = capabilities.general.as_ref();
        let window = capabilities.window.as_ref();
        let text = capabilities.text_document.as_ref();
        let item = text.and_then(|t| t.completion.as_ref()?.completion_item.as_ref());
        Client {
            encoding: Encoding::agree(general.and_then(|g| g.position_encodings.as_deref())),
            progress: window.and_then(|w| w.work_done_progress).unwrap_or(false),
            show_document: window.and_then(|w| w.show_document.as_ref()).is_some_and(|s| s.support),
            code_links: text
                .and_then(|t| t.publish_diagnostics.as_ref()?.code_description_support)
                .unwrap_or(false),
            refresh_lenses: capabilities
                .workspace
                .as_ref()
                .and_then(|w| w.code_lens.as_ref()?.refresh_support)
                .unwrap_or(false),
            action_literals: text
                .and_then(|t| t.code_action.as_ref()?.code_action_literal_support.as_ref())
                .is_some(),
            symbol_trees: text
                .and_then(|t| t.document_symbol.as_ref()?.hierarchical_document_symbol_support)
                .unwrap_or(false),
            snippets: item.and_then(|i| i.snippet_support).unwrap_or(false),
            insert_replace: item.and_then(|i| i.insert_replace_support).unwrap_or(false),
            markdown_completion: item
                .and_then(|i| i.documentation_format.as_ref())
                .is_some_and(|formats| formats.contains(&lsp_types::MarkupKind::Markdown)),
            own_colours: text
                .and_then(|t| t.semantic_tokens.as_ref()?.augments_syntax_tokens)
                .unwrap_or(false),
        }
    }
}

/// What the threads of a server share.
pub struct Session {
    /// What the client can do.
    pub client: Client,
    /// What the command line says about all missions.
    pub overrides: Overrides,
    /// Files, clock and planner.
    pub host: Arc<dyn Host>,
    /// The runs of the planner.
    pub runs: Runs,
    /// The tubes of single models.
    pub tubes: Tubes,
    /// The colours that the client was sent last.
    pub colours: Colours,
    /// The symbols of missions that are not open.
    pub shelf: Shelf,
    folders: Mutex<Vec<PathBuf>>,
    outgoing: Sender<Value>,
    documents: Mutex<Arc<Documents>>,
    /// The requests that have no answer yet; who takes one out answers it.
    pending: Mutex<BTreeSet<RequestId>>,
    /// Held by who publishes.
    publishing: Mutex<()>,
    requests: AtomicI32,
}

impl Session {
    /// A session without documents.
    pub fn new(
        client: Client,
        overrides: Overrides,
        host: Arc<dyn Host>,
        outgoing: Sender<Value>,
    ) -> Session {
        Session {
            client,
            overrides,
            host,
            runs: Runs::default(),
            tubes: Tubes::default(),
            colours: Colours::new(client.own_colours),
            shelf: Shelf::default(),
            folders: Mutex::default(),
            outgoing,
            documents: Mutex::default(),
            pending: Mutex::default(),
            publishing: Mutex::default(),
            requests: AtomicI32::new(0),
        }
    }

    /// The workspace's folders.
    pub fn folders(&self) -> Vec<PathBuf> {
        lock(&self.folders).clone()
    }

    /// Adds folders to the workspace, after taking some away.
    pub fn change_folders(&self, added: &[WorkspaceFolder], removed: &[WorkspaceFolder]) {
        let path = |folder: &WorkspaceFolder| location::path(&folder.uri);
        let removed: Vec<PathBuf> = removed.iter().filter_map(path).collect();
        let mut folders = lock(&self.folders);
        folders.retain(|folder| !removed.contains(folder));
        for folder in added.iter().filter_map(path) {
            if !folders.contains(&folder) {
                folders.push(folder);
            }
        }
    }

    /// The open missions as they are now.
    pub fn documents(&self) -> Arc<Documents> {
        Arc::clone(&lock(&self.documents))
    }

    /// A mission as it is now.
    pub fn document(&self, uri: &Uri) -> Option<Arc<Document>> {
        lock(&self.documents).get(uri.as_str()).cloned()
    }

    /// Opens a mission, or puts a later moment of it in the earlier one's place.
    pub fn put(&self, document: Document) {
        let key = document.uri.as_str().to_string();
        discard(Arc::make_mut(&mut lock(&self.documents)).insert(key, Arc::new(document)));
    }

    /// Closes a mission: nothing is wrong with it any more, and nobody wants a plan of it.
    pub fn close(&self, uri: Uri) {
        let _order = lock(&self.publishing);
        discard(Arc::make_mut(&mut lock(&self.documents)).remove(uri.as_str()));
        self.colours.forget(&uri);
        self.runs.close(uri.as_str());
        self.notify::<PublishDiagnostics>(PublishDiagnosticsParams {
            uri,
            diagnostics: Vec::new(),
            version: None,
        });
    }

    /// Notes that a request has come; false if there is one of its id.
    pub fn begin(&self, id: &RequestId) -> bool {
        lock(&self.pending).insert(id.clone())
    }

    /// Whether a request still wants an answer.
    pub fn is_wanted(&self, id: &RequestId) -> bool {
        lock(&self.pending).contains(id)
    }

    /// Answers a request, unless that was done.
    pub fn answer(&self, id: RequestId, result: Result<Value, ResponseError>) {
        if lock(&self.pending).remove(&id) {
            self.send(&Message::Response(Response { id, response_result: result }));
        }
    }

    /// Answers a request that the client wants no more.
    pub fn cancel(&self, id: RequestId) {
        self.answer(id, Err(refusal(ErrorCode::RequestCanceled, "cancelled")));
    }

    /// Tells the client something.
    pub fn notify<N: lsp_types::notification::Notification>(&self, params: N::Params)
    where
        N::Params: Serialize,
    {
        let params = serde_json::to_value(params).unwrap_or_default();
        self.send(&Message::Notification(Notification { method: N::METHOD.into(), params }));
    }

    /// Asks the client something to which the answer does not matter.
    pub fn ask<R: lsp_types::request::Request>(&self, params: R::Params)
    where
        R::Params: Serialize,
    {
        let id = RequestId::from(self.requests.fetch_add(1, Ordering::Relaxed));
        let params = serde_json::to_value(params).unwrap_or_default();
        self.send(&Message::Request(Request { id, method: R::METHOD.into(), params }));
    }

    /// Publishes what is known to be wrong with a mission, with what came of planning it, unless it has
    /// changed meanwhile: then it is looked at again, and what is said of a later text must come last.
    pub fn publish(&self, document: &Document) {
        document.whole();
        let _order = lock(&self.publishing);
        if self.document(&document.uri).is_none_or(|now| now.version != document.version) {
            return;
        }
        let outcome = self.runs.outcome(document);
        self.notify::<PublishDiagnostics>(PublishDiagnosticsParams {
            uri: document.uri.clone(),
            diagnostics: diagnostics::all(document, outcome.as_ref(), self),
            version: Some(document.version),
        });
    }

    /// Has the client ask for its lenses again.
    pub fn refresh_lenses(&self) {
        if self.client.refresh_lenses {
            self.ask::<lsp_types::request::CodeLensRefresh>(());
        }
    }

    /// Opens a file beside the editor, if the client can.
    pub fn show(&self, path: &Path, external: bool) {
        let Some(uri) = super::location::uri(path).filter(|_| self.client.show_document) else { return };
        self.ask::<lsp_types::request::ShowDocument>(lsp_types::ShowDocumentParams {
            uri,
            external: Some(external),
            take_focus: Some(true),
            selection: None,
        });
    }

    /// Sends anything; who has gone hears nothing.
    pub fn send(&self, message: &Message) {
        self.send_value(wire::encode(message));
    }

    /// Sends anything, as JSON.
    pub fn send_value(&self, value: Value) {
        let _ = self.outgoing.send(value);
    }
}

/// Drops a mission. Taking a large tree apart takes longer than the client should wait for anything else.
fn discard(document: Option<Arc<Document>>) {
    if let Some(large) = document.filter(|d| d.source.text.len() > LARGE) {
        let _ = thread::Builder::new().stack_size(STACK).spawn(move || drop(large));
    }
}

/// An error to answer with.
pub fn refusal(code: ErrorCode, message: impl Into<String>) -> ResponseError {
    ResponseError { code: code as i32, message: message.into(), data: None }
}

/// A mutex's value, whatever happened to those who held it before.
pub fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
