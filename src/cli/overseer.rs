//! Time limit, Ctrl-C and the progress line of a long command.
//!
//! The search looks at [`Overseer`] every now and then and stops by itself. A thread of its own
//! draws the progress line, and ends the process when the search does not stop in time; it never
//! does so once results are being written.

use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use super::line::{self, Line};
use super::{Status, output};
use crate::solve::{Phase, Progress, Watch};

/// A progress line appears after this time.
const PATIENCE: Duration = Duration::from_millis(500);
/// How often the thread looks.
const PERIOD: Duration = Duration::from_millis(50);
/// How long the search may take to stop by itself.
const GRACE: Duration = Duration::from_millis(700);

/// Why a command has to stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The time limit.
    Timeout,
    /// Ctrl-C, or a request to terminate.
    Interrupt,
}

impl Cause {
    /// The name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Cause::Timeout => "timeout",
            Cause::Interrupt => "interrupt",
        }
    }

    /// What is said about it.
    pub fn said(self) -> &'static str {
        match self {
            Cause::Timeout => "time ran out",
            Cause::Interrupt => "interrupted",
        }
    }
}

/// Says what was reached when the process has to end without its main thread.
pub type LastWords = Box<dyn Fn(Cause, Progress, Duration) + Send>;

/// What the progress line is about.
#[derive(Clone, Debug)]
enum Stage {
    /// Something with a name.
    Named(&'static str),
    /// A search.
    Search,
    /// Runs of a simulation: how many are done, of how many, and how many violations there were.
    Runs(u64, u64, u64),
}

/// What the search, the signal handler and the thread share.
pub struct Overseer {
    started: Instant,
    deadline: Option<Instant>,
    interrupted: AtomicBool,
    progress: Mutex<Progress>,
    robots: Mutex<Vec<String>>,
    stage: Mutex<Stage>,
    /// Whether the main thread has taken over again: nobody else may end the process then.
    closing: Mutex<bool>,
    thread: Mutex<Option<JoinHandle<()>>>,
    line: Mutex<Line>,
}

impl Overseer {
    /// Starts the clock and the thread.
    pub fn start(timeout: Option<Duration>, show_progress: bool, last_words: LastWords) -> Arc<Overseer> {
        let started = Instant::now();
        let overseer = Arc::new(Overseer {
            started,
            deadline: timeout.and_then(|t| started.checked_add(t)),
            interrupted: AtomicBool::new(false),
            progress: Mutex::new(Progress::default()),
            stage: Mutex::new(Stage::Named("reading")),
            robots: Mutex::new(Vec::new()),
            closing: Mutex::new(false),
            thread: Mutex::new(None),
            line: Mutex::new(Line::default()),
        });
        let signalled = Arc::clone(&overseer);
        // Without a handler Ctrl-C still ends the process; results are written whole or not at all.
        let _ = ctrlc::set_handler(move || signalled.interrupted.store(true, Ordering::SeqCst));
        let watcher = Arc::clone(&overseer);
        let show = show_progress && output::redraws();
        *lock(&overseer.thread) = Some(thread::spawn(move || watcher.oversee(show, &last_words)));
        overseer
    }

    /// Gives the process back to the main thread: from here on it ends by itself, and the progress
    /// line is gone.
    pub fn close(&self) {
        *lock(&self.closing) = true;
        if let Some(thread) = lock(&self.thread).take() {
            thread.thread().unpark();
            // It has nothing to say; if it panicked, only the progress line suffers.
            let _ = thread.join();
        }
    }

    /// Why the search has to stop, if it has to.
    pub fn cause(&self) -> Option<Cause> {
        if self.interrupted.load(Ordering::SeqCst) {
            return Some(Cause::Interrupt);
        }
        self.deadline.is_some_and(|d| Instant::now() >= d).then_some(Cause::Timeout)
    }

    /// How far the search is.
    pub fn reached(&self) -> Progress {
        lock(&self.progress).clone()
    }

    /// Says what is being done, for the progress line.
    pub fn enter(&self, stage: &'static str) {
        *lock(&self.stage) = Stage::Named(stage);
    }

    /// Says how many runs of a simulation are done, for the progress line.
    pub fn count(&self, done: u64, of: u64, violations: u64) {
        *lock(&self.stage) = Stage::Runs(done, of, violations);
    }

    /// Does something that writes on the terminal, while there is no progress line.
    pub fn aside<T>(&self, act: impl FnOnce() -> T) -> T {
        let mut line = lock(&self.line);
        line.clear();
        act()
    }

    /// Says who searches, for the progress line.
    pub fn name_robots(&self, names: Vec<String>) {
        *lock(&self.robots) = names;
    }

    /// The time since the start.
    pub fn elapsed(&self) -> Duration {
        self.started.elapsed()
    }

    /// What is being done, and how far it is.
    fn said(&self) -> String {
        let elapsed = self.elapsed();
        match *lock(&self.stage) {
            Stage::Named(stage) => line::said(stage, elapsed),
            Stage::Runs(done, of, violations) => line::runs(done, of, violations, elapsed),
            Stage::Search => line::search(&lock(&self.progress), &lock(&self.robots), elapsed),
        }
    }

    fn oversee(&self, show_progress: bool, last_words: &LastWords) {
        let mut overdue = None;
        for round in 0usize.. {
            thread::park_timeout(PERIOD);
            let closing = lock(&self.closing);
            if *closing {
                return lock(&self.line).clear();
            }
            if show_progress && self.elapsed() >= PATIENCE && round.is_multiple_of(2) {
                lock(&self.line).draw(&self.said());
            }
            if let Some(cause) = self.cause()
                && overdue.get_or_insert_with(Instant::now).elapsed() >= GRACE
            {
                lock(&self.line).clear();
                last_words(cause, self.reached(), self.elapsed());
                process::exit(Status::Unknown.code().into());
            }
        }
    }
}

impl Watch for Overseer {
    fn stop(&self) -> bool {
        self.cause().is_some()
    }

    fn progress(&self, progress: &Progress) {
        lock(&self.progress).clone_from(progress);
    }

    fn enter(&self, phase: Phase) {
        *lock(&self.stage) = match phase {
            Phase::Geometry => Stage::Named("looking at the geometry"),
            Phase::Search => Stage::Search,
            Phase::ExactCheck => Stage::Named("checking the plan exactly"),
        };
    }

    fn now(&self) -> Duration {
        self.elapsed()
    }
}

/// A mutex's value, whatever happened to those who held it before.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
