//! What dosmc says of a draft.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use dosmc::diag::{Diagnostics, Severity};
use dosmc::driver::{self, Answer, Mission, Overrides};
use dosmc::plan::Plan;
use dosmc::solve::{Progress, Watch};
use dosmc::source::SourceFile;

use crate::draft::Draft;

/// After so many looks at the watch a search is given up: work, not time.
const PATIENCE: usize = 60_000;

/// A clock that stands still, and a limit on work.
#[derive(Default)]
struct Limit(AtomicUsize);

impl Watch for Limit {
    fn stop(&self) -> bool {
        self.0.fetch_add(1, Ordering::Relaxed) >= PATIENCE
    }
    fn progress(&self, _: &Progress) {}
    fn now(&self) -> Duration {
        Duration::ZERO
    }
}

/// The outcome for a draft.
#[derive(Debug)]
pub enum Verdict {
    /// The mission has errors; their codes, sorted.
    Errors(Vec<String>),
    Plan(Box<Plan>),
    NoPlan,
    /// The search gave up.
    Unknown,
    /// The exact check accepts nothing of what the search finds.
    Refused(String),
}

impl Verdict {
    /// In a word, with the length.
    pub fn word(&self) -> String {
        match self {
            Verdict::Errors(codes) => format!("errors {}", codes.join(" ")),
            Verdict::Plan(plan) => format!("plan of length {}", plan.length),
            Verdict::NoPlan => "no plan".into(),
            Verdict::Unknown => "unknown".into(),
            Verdict::Refused(why) => format!("refused: {why}"),
        }
    }
}

/// Loads a draft: the mission, or the codes of its errors.
pub fn load(draft: &Draft) -> Result<Mission, Vec<String>> {
    let source = SourceFile::new("random.dosm", draft.text());
    let mut diagnostics = Diagnostics::new();
    driver::load(&source, &Overrides::default(), &mut diagnostics).map_err(|_| {
        let errors = diagnostics.sorted().into_iter().filter(|d| d.severity == Severity::Error);
        let mut codes: Vec<String> = errors.map(|d| d.code.to_string()).collect();
        codes.sort();
        codes.dedup();
        codes
    })
}

/// Searches.
pub fn verdict(draft: &Draft) -> Verdict {
    match load(draft) {
        Err(codes) => Verdict::Errors(codes),
        Ok(mission) => solve(&mission),
    }
}

/// Searches a mission.
pub fn solve(mission: &Mission) -> Verdict {
    let watch: Arc<dyn Watch> = Arc::new(Limit::default());
    match driver::solve(mission, &watch).answer {
        Answer::Plan { plan, shortest: true, .. } => Verdict::Plan(plan),
        Answer::Plan { .. } | Answer::Unknown(_) => Verdict::Unknown,
        Answer::NoPlan(_) => Verdict::NoPlan,
        Answer::Refused(report) => Verdict::Refused(report.to_string()),
    }
}
