//! What waits for the worker: requests in their order, then missions to look at.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, PoisonError};

use lsp_server::RequestId;
use lsp_types::Uri;
use serde_json::Value;

use super::session::{Documents, lock};

/// A request with the missions as they were when it came.
pub struct Job {
    /// Its id.
    pub id: RequestId,
    /// What is asked.
    pub method: String,
    /// The question's parameters.
    pub params: Value,
    /// The open missions.
    pub documents: Arc<Documents>,
}

/// Something for the worker to do.
pub enum Task {
    /// A request to answer.
    Answer(Job),
    /// A mission to look at, in whatever state it is then.
    Look(Uri),
}

#[derive(Default)]
struct Waiting {
    requests: VecDeque<Job>,
    /// Each mission at most once.
    looks: VecDeque<Uri>,
    closed: bool,
}

/// What waits for the worker.
#[derive(Default)]
pub struct Queue {
    waiting: Mutex<Waiting>,
    changed: Condvar,
}

impl Queue {
    /// Adds a request.
    pub fn ask(&self, job: Job) {
        lock(&self.waiting).requests.push_back(job);
        self.changed.notify_one();
    }

    /// Has a mission looked at; a look at it that is waiting is dropped, as it would see the same.
    pub fn look(&self, uri: Uri) {
        let mut waiting = lock(&self.waiting);
        waiting.looks.retain(|other| *other != uri);
        waiting.looks.push_back(uri);
        self.changed.notify_one();
    }

    /// Whether a look at a mission waits: then it has changed.
    pub fn awaits_look(&self, uri: &Uri) -> bool {
        lock(&self.waiting).looks.contains(uri)
    }

    /// Ends the worker when it has answered what is asked.
    pub fn close(&self) {
        lock(&self.waiting).closed = true;
        self.changed.notify_one();
    }

    /// Waits for the next task: requests before looks; `None` when there will be no more.
    pub fn next(&self) -> Option<Task> {
        let mut waiting = lock(&self.waiting);
        loop {
            if let Some(job) = waiting.requests.pop_front() {
                return Some(Task::Answer(job));
            }
            if waiting.closed {
                return None;
            }
            if let Some(uri) = waiting.looks.pop_front() {
                return Some(Task::Look(uri));
            }
            waiting = self.changed.wait(waiting).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uri(name: &str) -> Uri {
        format!("file:///{name}").parse().expect("it is a URI")
    }

    #[test]
    fn requests_come_first_and_each_mission_is_looked_at_once() {
        let queue = Queue::default();
        queue.look(uri("a"));
        queue.look(uri("b"));
        queue.look(uri("a"));
        let documents = Arc::default();
        queue.ask(Job { id: 1.into(), method: "m".into(), params: Value::Null, documents });
        let mut said = Vec::new();
        queue.close();
        // Closed: the request is answered, looks are dropped.
        while let Some(task) = queue.next() {
            said.push(match task {
                Task::Answer(job) => job.method,
                Task::Look(uri) => uri.as_str().to_string(),
            });
        }
        assert_eq!(said, ["m"]);
        lock(&queue.waiting).closed = false;
        assert!(queue.awaits_look(&uri("b")) && !queue.awaits_look(&uri("d")));
        let order = [queue.next(), queue.next()].map(|task| match task {
            Some(Task::Look(uri)) => uri.as_str().to_string(),
            _ => "none".into(),
        });
        assert_eq!(order, ["file:///b", "file:///a"]);
    }
}
