//! Time limit, Ctrl-C and the progress line of a long command.
//!
//! The search looks at [`Overseer`] every now and then and stops by itself. A thread of its own
//! draws the progress line, and ends the process when the search does not stop in time; it never
//! does so once results are being written.

use std::io::IsTerminal;
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::Status;
use crate::solve::{Progress, Watch};

/// A progress line appears after this time.
const PATIENCE: Duration = Duration::from_millis(500);
/// How often the thread looks.
const PERIOD: Duration = Duration::from_millis(50);
/// How long the search may take to stop by itself.
const GRACE: Duration = Duration::from_millis(700);

/// Why a search has to stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The time limit.
    Timeout,
    /// Ctrl-C, or a request to terminate.
    Interrupt,
}

/// Says what was reached when the process has to end without its main thread.
pub type LastWords = Box<dyn Fn(Cause, Progress, Duration) + Send>;

/// What the search, the signal handler and the thread share.
pub struct Overseer {
    started: Instant,
    deadline: Option<Instant>,
    interrupted: AtomicBool,
    progress: Mutex<Progress>,
    /// Whether the main thread has taken over again: nobody else may end the process then.
    closing: Mutex<bool>,
    thread: Mutex<Option<JoinHandle<()>>>,
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
            closing: Mutex::new(false),
            thread: Mutex::new(None),
        });
        let signalled = Arc::clone(&overseer);
        // Without a handler Ctrl-C still ends the process; results are written whole or not at all.
        let _ = ctrlc::set_handler(move || signalled.interrupted.store(true, Ordering::SeqCst));
        let watcher = Arc::clone(&overseer);
        let show = show_progress && std::io::stderr().is_terminal();
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
        *lock(&self.progress)
    }

    /// The time since the start.
    pub fn elapsed(&self) -> Duration {
        self.started.elapsed()
    }

    fn oversee(&self, show_progress: bool, last_words: &LastWords) {
        let mut line = None;
        let mut overdue = None;
        loop {
            thread::park_timeout(PERIOD);
            let closing = lock(&self.closing);
            if *closing {
                return clear(line);
            }
            if show_progress && self.elapsed() >= PATIENCE {
                draw(line.get_or_insert_with(new_line), &self.reached());
            }
            if let Some(cause) = self.cause()
                && overdue.get_or_insert_with(Instant::now).elapsed() >= GRACE
            {
                clear(line);
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
        *lock(&self.progress) = *progress;
    }

    fn now(&self) -> Duration {
        self.elapsed()
    }
}

/// A mutex's value, whatever happened to those who held it before.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn new_line() -> ProgressBar {
    let line = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} [{elapsed}]") {
        line.set_style(style);
    }
    line
}

fn draw(line: &ProgressBar, reached: &Progress) {
    line.set_message(match reached.length {
        0 => "preparing".into(),
        length => format!("length {length}: {} candidates, {} lemmas", reached.candidates, reached.lemmas),
    });
    line.tick();
}

fn clear(line: Option<ProgressBar>) {
    if let Some(line) = line {
        line.finish_and_clear();
    }
}
