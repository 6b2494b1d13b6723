//! The statistics of a run, for programs and for `-v`.

use std::fmt;
use std::fs;
use std::time::Duration;

use serde::Serialize;

use crate::driver::{Encoding, Mission, Solved};
use crate::solve::Progress;

/// `stats` in `solve --json`; times in seconds.
#[derive(Clone, Debug, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct JsonStats {
    encoding: Encoding,
    half_spaces: usize,
    /// 0 without the paper's encoding.
    cells: usize,
    bool_vars: usize,
    bool_vars_connectivity: usize,
    bool_vars_connectivity_paper: usize,
    clauses: usize,
    sat_calls: u64,
    convex_calls: u64,
    candidates: u64,
    lemmas: u64,
    time_tube_s: f64,
    time_geometry_s: f64,
    time_encode_s: f64,
    time_sat_s: f64,
    time_convex_s: f64,
    time_verify_s: f64,
    peak_rss_mib: f64,
}

impl JsonStats {
    /// The statistics of a search that ended.
    pub fn new(mission: &Mission, solved: &Solved, time_tube: Duration) -> JsonStats {
        let s = &solved.statistics;
        JsonStats {
            encoding: solved.encoding,
            half_spaces: s.half_spaces,
            cells: solved.cells,
            bool_vars: s.bool_vars,
            bool_vars_connectivity: s.bool_vars_connectivity,
            bool_vars_connectivity_paper: papers_connectivity(mission) * (s.length + 1),
            clauses: s.clauses,
            sat_calls: s.sat_calls,
            convex_calls: s.convex_calls,
            candidates: s.candidates,
            lemmas: s.lemmas,
            time_tube_s: time_tube.as_secs_f64(),
            time_geometry_s: s.time_geometry.as_secs_f64(),
            time_encode_s: s.time_encode.as_secs_f64(),
            time_sat_s: s.time_sat.as_secs_f64(),
            time_convex_s: s.time_convex.as_secs_f64(),
            time_verify_s: solved.time_verify.as_secs_f64(),
            peak_rss_mib: peak_rss_mib(),
        }
    }

    /// What is known in the middle of a search.
    pub fn of_progress(progress: &Progress) -> JsonStats {
        JsonStats {
            candidates: progress.candidates,
            lemmas: progress.lemmas,
            peak_rss_mib: peak_rss_mib(),
            ..JsonStats::default()
        }
    }
}

/// Variables a step that the paper's own encoding takes: with N nodes, one for each pair of them
/// and each number of hops up to N − 1.
fn papers_connectivity(mission: &Mission) -> usize {
    if mission.problem.connectivity.is_none() {
        return 0;
    }
    let nodes = mission.problem.robots.len() + mission.problem.bases.len();
    nodes * nodes.saturating_sub(1) / 2 * nodes.saturating_sub(1)
}

/// The most memory that the process had, in MiB; 0 where the system does not tell.
fn peak_rss_mib() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    let kib = line.and_then(|l| l.trim().trim_end_matches("kB").trim().parse::<f64>().ok());
    kib.map_or(0.0, |k| (k / 102.4).round() / 10.0)
}

impl fmt::Display for JsonStats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ms = |s: f64| format!("{:.2} ms", s * 1e3);
        writeln!(f, "half-spaces      {:>12}", self.half_spaces)?;
        if self.encoding == Encoding::Paper {
            writeln!(f, "cells            {:>12}", self.cells)?;
        }
        let paper = self.bool_vars_connectivity_paper;
        writeln!(
            f,
            "variables        {:>12}   of these {} for connectivity (the paper: {paper})",
            self.bool_vars, self.bool_vars_connectivity
        )?;
        writeln!(f, "clauses          {:>12}   of these {} lemmas", self.clauses, self.lemmas)?;
        writeln!(f, "SAT calls        {:>12}   {}", self.sat_calls, ms(self.time_sat_s))?;
        writeln!(f, "linear programs  {:>12}   {}", self.convex_calls, ms(self.time_convex_s))?;
        for (what, time) in [
            ("tubes", self.time_tube_s),
            ("geometry", self.time_geometry_s),
            ("encoding", self.time_encode_s),
            ("exact check", self.time_verify_s),
        ] {
            writeln!(f, "{what:<17}{:>12}", ms(time))?;
        }
        write!(f, "peak memory      {:>9} MiB", self.peak_rss_mib)
    }
}
