//! Planning in the background.
//!
//! A run has a thread of its own and shows its progress; a mission has at most one at a time. What came of it
//! stays beside the mission's diagnostics until the text changes.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use lsp_server::{ErrorCode, RequestId};
use lsp_types::notification::{Progress as ProgressNote, ShowMessage};
use lsp_types::request::WorkDoneProgressCreate;
use lsp_types::{
    MessageType, NumberOrString, ProgressParams, ProgressParamsValue, ProgressToken, ShowMessageParams,
    WorkDoneProgress, WorkDoneProgressBegin, WorkDoneProgressCreateParams, WorkDoneProgressEnd,
    WorkDoneProgressReport,
};
use serde::Serialize;

use super::document::Document;
use super::location;
use super::session::{Session, lock, refusal};
use crate::solve::{Phase, Progress, Watch};

/// How often progress is shown, at most.
const PERIOD: Duration = Duration::from_millis(100);

/// What came of planning a mission; the answer to the command `dosmc.solve`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// `plan`, `no_plan`, `unknown`, or `error` for a mission with errors, a plan that does not check, or
    /// files that can't be written.
    pub status: &'static str,
    /// The plan's length.
    pub length: Option<usize>,
    /// What there is to say, for people.
    pub message: String,
    /// The picture of the plan.
    pub picture: Option<PathBuf>,
    /// The page on which the robots move.
    pub page: Option<PathBuf>,
    /// The plan.
    pub plan: Option<PathBuf>,
}

impl Outcome {
    /// An outcome without a plan.
    pub fn without_plan(status: &'static str, message: impl Into<String>) -> Outcome {
        Outcome { status, length: None, message: message.into(), picture: None, page: None, plan: None }
    }

    /// Whether there is a plan.
    pub fn is_plan(&self) -> bool {
        self.status == "plan"
    }
}

/// A run of the planner, and what it came to.
#[derive(Default)]
struct Record {
    /// The run that goes on.
    running: Option<Arc<Run>>,
    /// The text that was planned last, and what came of it.
    last: Option<(String, Outcome)>,
}

/// The runs of the planner, by the URIs of their missions.
#[derive(Default)]
pub struct Runs {
    records: Mutex<BTreeMap<String, Record>>,
    started: Mutex<u64>,
}

impl Runs {
    /// What came of planning this very text.
    pub fn outcome(&self, document: &Document) -> Option<Outcome> {
        let records = lock(&self.records);
        let (text, outcome) = records.get(document.uri.as_str())?.last.as_ref()?;
        (*text == document.source.text).then(|| outcome.clone())
    }

    /// A token for a run's progress that no other run has.
    fn token(&self) -> ProgressToken {
        let mut started = lock(&self.started);
        *started += 1;
        NumberOrString::String(format!("dosmc.solve.{started}"))
    }

    /// Whether a mission is being planned.
    pub fn is_running(&self, document: &Document) -> bool {
        lock(&self.records).get(document.uri.as_str()).is_some_and(|r| r.running.is_some())
    }

    /// Stops the run that shows its progress under a token.
    pub fn stop(&self, token: &ProgressToken) {
        self.running(|run| run.token == *token);
    }

    /// Stops the run that answers a request.
    pub fn stop_request(&self, id: &RequestId) {
        self.running(|run| run.request == *id);
    }

    /// Stops the run of a mission that was closed, and forgets what came of earlier ones.
    pub fn close(&self, uri: &str) {
        self.running(|run| run.document.uri.as_str() == uri);
        if let Some(record) = lock(&self.records).get_mut(uri) {
            record.last = None;
        }
    }

    /// Stops all runs.
    pub fn stop_all(&self) {
        self.running(|_| true);
    }

    fn running(&self, which: impl Fn(&Run) -> bool) {
        let records = lock(&self.records);
        let all = records.values().filter_map(|record| record.running.as_ref());
        all.filter(|run| which(run)).for_each(|run| run.stopped.store(true, Ordering::Relaxed));
    }

    /// Enters a run, unless its mission has one.
    fn enter(&self, run: &Arc<Run>) -> bool {
        let mut records = lock(&self.records);
        let record = records.entry(run.document.uri.as_str().to_string()).or_default();
        if record.running.is_some() {
            return false;
        }
        record.running = Some(Arc::clone(run));
        true
    }

    fn leave(&self, run: &Run, outcome: Outcome) {
        let mut records = lock(&self.records);
        let record = records.entry(run.document.uri.as_str().to_string()).or_default();
        record.running = None;
        record.last = Some((run.document.source.text.clone(), outcome));
    }
}

/// A run of the planner.
struct Run {
    document: Arc<Document>,
    session: Arc<Session>,
    request: RequestId,
    token: ProgressToken,
    stopped: AtomicBool,
    /// When progress was last shown.
    shown: Mutex<Option<Duration>>,
}

/// Plans a mission in a thread of its own; the request is answered when that is done. `token` is the client's
/// for the progress, if it gave one.
pub fn start(session: &Arc<Session>, id: RequestId, document: Arc<Document>, token: Option<ProgressToken>) {
    let (own, token) = match token {
        Some(token) => (false, token),
        None => (true, session.runs.token()),
    };
    let run = Arc::new(Run {
        document,
        session: Arc::clone(session),
        request: id.clone(),
        token,
        stopped: AtomicBool::new(false),
        shown: Mutex::new(None),
    });
    if !session.runs.enter(&run) {
        return session.answer(id, Err(refusal(ErrorCode::RequestFailed, "this mission is being planned")));
    }
    if own && session.client.progress {
        session.ask::<WorkDoneProgressCreate>(WorkDoneProgressCreateParams { token: run.token.clone() });
    }
    // Formulas nest, as for the workers.
    let spawned = thread::Builder::new().name("planner".into()).stack_size(super::server::STACK);
    let planner = Arc::clone(&run);
    if let Err(error) = spawned.spawn(move || planner.run()) {
        run.end(Outcome::without_plan("error", format!("no thread to plan in: {error}")));
    }
}

impl Run {
    fn run(self: Arc<Run>) {
        let begin = WorkDoneProgressBegin {
            title: "planning".into(),
            cancellable: Some(true),
            message: Some("reading".into()),
            percentage: None,
        };
        self.show(WorkDoneProgress::Begin(begin));
        self.session.refresh_lenses();
        let outcome = match &self.document.whole().mission {
            None => Outcome::without_plan("error", "the mission has errors"),
            Some(mission) => {
                let watch: Arc<dyn Watch> = Arc::<Run>::clone(&self);
                self.session.host.plan(mission, &self.directory(), &watch)
            }
        };
        self.end(outcome);
    }

    /// Where the plan goes: `out/NAME` beside the mission.
    fn directory(&self) -> PathBuf {
        let path = location::path(&self.document.uri);
        let home = path.as_deref().and_then(|p| p.parent()).map(|p| p.join("out"));
        let stem = path.as_deref().and_then(|p| p.file_stem()).map(PathBuf::from);
        home.unwrap_or_else(|| self.session.host.temporary()).join(stem.unwrap_or_else(|| "mission".into()))
    }

    fn end(&self, outcome: Outcome) {
        let first = outcome.message.lines().next().unwrap_or_default().to_string();
        self.show(WorkDoneProgress::End(WorkDoneProgressEnd { message: Some(first.clone()) }));
        let typ = match outcome.status {
            "plan" => MessageType::INFO,
            "error" => MessageType::ERROR,
            _ => MessageType::WARNING,
        };
        self.session.notify::<ShowMessage>(ShowMessageParams { typ, message: first });
        let value = serde_json::to_value(&outcome).unwrap_or_default();
        self.session.runs.leave(self, outcome);
        self.session.answer(self.request.clone(), Ok(value));
        if let Some(document) = self.session.document(&self.document.uri) {
            self.session.publish(&document);
        }
        self.session.refresh_lenses();
    }

    fn show(&self, progress: WorkDoneProgress) {
        if self.session.client.progress {
            let value = ProgressParamsValue::WorkDone(progress);
            self.session.notify::<ProgressNote>(ProgressParams { token: self.token.clone(), value });
        }
    }

    fn report(&self, message: String) {
        let report =
            WorkDoneProgressReport { cancellable: Some(true), message: Some(message), percentage: None };
        self.show(WorkDoneProgress::Report(report));
    }
}

impl Watch for Run {
    fn stop(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    fn enter(&self, phase: Phase) {
        let what = match phase {
            Phase::Geometry => "looking at the geometry",
            Phase::Search => "searching",
            Phase::ExactCheck => "checking the plan exactly",
        };
        self.report(what.into());
    }

    fn progress(&self, progress: &Progress) {
        let now = self.now();
        let mut shown = lock(&self.shown);
        if shown.is_none_or(|before| now.saturating_sub(before) >= PERIOD) {
            *shown = Some(now);
            let to = self.document.whole().mission.as_ref().map_or(0, |m| m.problem.horizon.1);
            self.report(format!(
                "length {} of at most {to}, {} candidates, {} lemmas",
                progress.length, progress.candidates, progress.lemmas
            ));
        }
    }

    fn now(&self) -> Duration {
        self.session.host.now()
    }
}
