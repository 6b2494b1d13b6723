//! What waits for the workers: requests in their order, and missions to look at.

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

#[derive(Default)]
struct Waiting {
    requests: VecDeque<Job>,
    /// Each mission at most once.
    looks: VecDeque<Uri>,
    closed: bool,
}

/// What waits for the workers.
#[derive(Default)]
pub struct Queue {
    waiting: Mutex<Waiting>,
    changed: Condvar,
}

impl Queue {
    /// Adds a request.
    pub fn ask(&self, job: Job) {
        lock(&self.waiting).requests.push_back(job);
        self.changed.notify_all();
    }

    /// Has a mission looked at; a look at it that is waiting is dropped, as it would see the same.
    pub fn look(&self, uri: Uri) {
        let mut waiting = lock(&self.waiting);
        waiting.looks.retain(|other| *other != uri);
        waiting.looks.push_back(uri);
        self.changed.notify_all();
    }

    /// Whether a look at a mission waits: then it has changed.
    pub fn awaits_look(&self, uri: &Uri) -> bool {
        lock(&self.waiting).looks.contains(uri)
    }

    /// Lets the workers end when they have answered what is asked.
    pub fn close(&self) {
        lock(&self.waiting).closed = true;
        self.changed.notify_all();
    }

    /// Waits for the next request; `None` when there will be no more.
    pub fn next_request(&self) -> Option<Job> {
        self.next(|waiting| waiting.requests.pop_front(), |waiting| waiting.closed)
    }

    /// Waits for the next mission to look at; `None` when nobody wants to know any more.
    pub fn next_look(&self) -> Option<Uri> {
        self.next(|waiting| waiting.looks.pop_front().filter(|_| !waiting.closed), |waiting| waiting.closed)
    }

    fn next<T>(
        &self,
        take: impl Fn(&mut Waiting) -> Option<T>,
        is_over: impl Fn(&Waiting) -> bool,
    ) -> Option<T> {
        let mut waiting = lock(&self.waiting);
        loop {
            if let Some(task) = take(&mut waiting) {
                return Some(task);
            }
            if is_over(&waiting) {
                return None;
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
    fn each_mission_is_looked_at_once_and_each_request_is_answered() {
        let queue = Queue::default();
        queue.look(uri("a"));
        queue.look(uri("b"));
        queue.look(uri("a"));
        let documents = Arc::default();
        queue.ask(Job { id: 1.into(), method: "m".into(), params: Value::Null, documents });
        assert!(queue.awaits_look(&uri("b")) && !queue.awaits_look(&uri("d")));
        let looks = [queue.next_look(), queue.next_look()];
        assert_eq!(looks, [Some(uri("b")), Some(uri("a"))]);
        queue.look(uri("c"));
        queue.close();
        // What is asked is answered; what nobody will see is not looked at.
        assert_eq!(queue.next_request().map(|job| job.method).as_deref(), Some("m"));
        assert!(queue.next_request().is_none() && queue.next_look().is_none());
    }
}
