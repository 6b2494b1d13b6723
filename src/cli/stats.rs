//! What a run took and counted, for programs; [`phases`](super::phases) shows it to people.

use std::collections::BTreeMap;
use std::fs;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use serde::Serialize;

use crate::driver::{Encoding, Mission};
use crate::ir::Problem;
use crate::solve::Statistics;
use crate::source::SourceFile;

/// What is known of a run besides its search; each part from the moment on when it is done.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// Time spent reading the mission's text and parsing it.
    pub time_read: Duration,
    /// Time spent finding out what it means.
    pub time_check: Duration,
    /// Time spent on tubes and the first step.
    pub time_tube: Duration,
    /// Time spent in the exact check.
    pub time_verify: Duration,
    /// Time spent making the files' contents and writing them.
    pub time_write: Duration,
    /// Lines and bytes of the text.
    pub text: (usize, usize),
    /// Numbers and bytes of the files written.
    pub files: (usize, usize),
    /// What the mission is made of: a count and the name of one.
    pub parts: Vec<(usize, &'static str)>,
    /// The robots' names.
    pub robots: Vec<String>,
    /// By model: its share of the inputs for rejection.
    pub rejection: BTreeMap<String, JsonRejection>,
    /// Variables a step that connectivity takes in the paper's own encoding.
    pub papers_connectivity: usize,
    /// What was searched.
    pub encoding: Encoding,
    /// How many cells the partition has; 0 without one.
    pub cells: usize,
}

/// Each model's share of the inputs for rejection, and why, by the model's name.
pub fn rejection_of(mission: &Mission) -> BTreeMap<String, JsonRejection> {
    let rejection =
        |tube: &crate::tube::Tube| JsonRejection { beta: tube.beta, why: tube.choice.to_string() };
    let models = mission.problem.models.values().zip(mission.tubes.values());
    models.map(|(model, tube)| (model.name.clone(), rejection(tube))).collect()
}

impl Run {
    /// Notes a text that was read.
    pub fn read(&mut self, source: &SourceFile, time: Duration) {
        self.text = (source.text.lines().count(), source.text.len());
        self.time_read = time;
    }

    /// Notes what a mission means.
    pub fn means(&mut self, problem: &Problem) {
        self.parts = vec![
            (problem.robots.len(), "robot"),
            (problem.regions.len(), "region"),
            (problem.blockers.len(), "blocker"),
            (problem.bases.len(), "base"),
            (problem.formulas.nodes().len(), "subformula"),
        ];
        self.robots = problem.robots.values().map(|r| r.name.clone()).collect();
        self.papers_connectivity = papers_connectivity(problem);
    }

    /// Notes a mission's tubes.
    pub fn has_tubes(&mut self, mission: &Mission) {
        self.rejection = rejection_of(mission);
    }

    /// Notes files that were written.
    pub fn wrote(&mut self, files: usize, bytes: usize, time: Duration) {
        self.files = (files, bytes);
        self.time_write = time;
    }
}

/// A run that is noted while it goes on, where several threads can look.
#[derive(Clone, Debug, Default)]
pub struct Ledger(Arc<Mutex<Run>>);

impl Ledger {
    /// Notes something.
    pub fn note(&self, what: impl FnOnce(&mut Run)) {
        what(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner));
    }

    /// What was noted so far.
    pub fn so_far(&self) -> Run {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// Counts and times of a run; times in seconds. What was not reached is 0.
#[derive(Clone, Debug, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct JsonStats {
    /// What the Boolean part spoke of.
    encoding: Encoding,
    /// Half-space literals.
    half_spaces: usize,
    /// Cells of the paper's encoding, 0 without it.
    cells: usize,
    /// SAT variables.
    bool_vars: usize,
    /// SAT variables that connectivity took.
    bool_vars_connectivity: usize,
    /// SAT variables that connectivity would take in the paper's own encoding.
    bool_vars_connectivity_paper: usize,
    /// SAT clauses, lemmas included.
    clauses: usize,
    /// SAT queries.
    sat_calls: u64,
    /// Linear programs.
    convex_calls: u64,
    /// Candidates that the SAT solver proposed.
    candidates: u64,
    /// Lemmas learned.
    lemmas: u64,
    /// By robot: how often its programs refused what a candidate asks of them, alone or together with
    /// others'; several may refuse the same candidate.
    conflicts: BTreeMap<String, u64>,
    /// By model: the share of the inputs that its feedback has.
    rejection: BTreeMap<String, JsonRejection>,
    /// Reading the mission's text.
    time_read_s: f64,
    /// Finding out what it means.
    time_check_s: f64,
    /// Tubes, and the first step.
    time_tube_s: f64,
    /// Half-spaces, and testing candidates against geometry.
    time_geometry_s: f64,
    /// Clauses.
    time_encode_s: f64,
    /// The SAT solver.
    time_sat_s: f64,
    /// Linear programs and their certificates.
    time_convex_s: f64,
    /// Witnesses, and the exact check.
    time_verify_s: f64,
    /// Making and writing files.
    time_write_s: f64,
    /// Everything since the start.
    time_total_s: f64,
    /// The most memory that the process had, in MiB; 0 where the system does not tell.
    peak_rss_mib: f64,
}

/// A model's share of the inputs for the feedback, and why it has that.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct JsonRejection {
    /// The share.
    pub beta: f64,
    /// The reason, for people.
    pub why: String,
}

impl JsonStats {
    /// The statistics of a run and its search, ended or not.
    pub fn new(run: &Run, search: &Statistics, total: Duration) -> JsonStats {
        let steps = if search.length > 0 { search.length + 1 } else { 0 };
        JsonStats {
            encoding: run.encoding,
            half_spaces: search.half_spaces,
            cells: run.cells,
            bool_vars: search.bool_vars,
            bool_vars_connectivity: search.bool_vars_connectivity,
            bool_vars_connectivity_paper: run.papers_connectivity * steps,
            clauses: search.clauses,
            sat_calls: search.sat_calls,
            convex_calls: search.convex_calls,
            candidates: search.candidates,
            lemmas: search.lemmas,
            conflicts: run.robots.iter().cloned().zip(search.conflicts.iter().copied()).collect(),
            rejection: run.rejection.clone(),
            time_read_s: run.time_read.as_secs_f64(),
            time_check_s: run.time_check.as_secs_f64(),
            time_tube_s: run.time_tube.as_secs_f64(),
            time_geometry_s: search.time_geometry.as_secs_f64(),
            time_encode_s: search.time_encode.as_secs_f64(),
            time_sat_s: search.time_sat.as_secs_f64(),
            time_convex_s: search.time_convex.as_secs_f64(),
            time_verify_s: run.time_verify.as_secs_f64(),
            time_write_s: run.time_write.as_secs_f64(),
            time_total_s: total.as_secs_f64(),
            peak_rss_mib: peak_rss_mib(),
        }
    }
}

/// Variables a step that the paper's own encoding takes: with N nodes, one for each pair of them
/// and each number of hops up to N − 1.
fn papers_connectivity(problem: &Problem) -> usize {
    if problem.connectivity.is_none() {
        return 0;
    }
    let nodes = problem.robots.len() + problem.bases.len();
    nodes * nodes.saturating_sub(1) / 2 * nodes.saturating_sub(1)
}

/// The most memory that the process had, in MiB; 0 where the system does not tell.
pub fn peak_rss_mib() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    let kib = line.and_then(|l| l.trim().trim_end_matches("kB").trim().parse::<f64>().ok());
    kib.map_or(0.0, |k| (k / 102.4).round() / 10.0)
}
