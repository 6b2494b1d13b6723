//! The table of `-v`: what took how long, and what came out of it.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::time::Duration;

use super::output::counted;
use super::stats::{JsonRejection, Run};
use crate::diag::printable;
use crate::driver::Encoding;
use crate::solve::Statistics;
use crate::verify::Report;

/// A phase, its time, and its counts in words.
struct Phase {
    name: &'static str,
    time: Duration,
    what: String,
}

/// The table of a run with a search.
pub fn of_search(run: &Run, search: &Statistics, total: Duration, peak_mib: f64) -> String {
    let phases = [
        read(run),
        check(run),
        tubes(run),
        phase("geometry", search.time_geometry, geometry(run, search)),
        phase("encoding", search.time_encode, encoded(search)),
        phase("SAT", search.time_sat, counted(search.sat_calls as usize, "call")),
        phase("convex", search.time_convex, convex(search)),
        phase("exact check", run.time_verify, String::new()),
        files(run),
    ];
    let steps = if search.length > 0 { search.length + 1 } else { 0 };
    let paper = run.papers_connectivity * steps;
    let mut notes = rejection(&run.rejection);
    if paper > 0 {
        let own = search.bool_vars_connectivity;
        notes.push(format!("links      {} (the paper's encoding: {paper})", counted(own, "variable")));
    }
    notes.extend(conflicts(run, search));
    table(phases.into(), &notes, total, peak_mib)
}

/// The table of a run that writes files without a search.
pub fn of_files(run: &Run, total: Duration, peak_mib: f64) -> String {
    table(vec![read(run), check(run), tubes(run), files(run)], &rejection(&run.rejection), total, peak_mib)
}

/// The table of a run that checks a plan.
pub fn of_check(run: &Run, report: &Report, total: Duration, peak_mib: f64) -> String {
    let claims = report.checks.iter().map(|c| c.count).sum();
    let exact = phase("exact check", run.time_verify, counted(claims, "claim"));
    table(vec![read(run), check(run), exact], &[], total, peak_mib)
}

fn phase(name: &'static str, time: Duration, what: String) -> Phase {
    Phase { name, time, what }
}

fn read(run: &Run) -> Phase {
    phase("read", run.time_read, format!("{}, {}", counted(run.text.0, "line"), size(run.text.1)))
}

fn check(run: &Run) -> Phase {
    let there = run.parts.iter().filter(|(count, _)| *count > 0);
    let parts: Vec<String> = there.map(|(count, noun)| counted(*count, noun)).collect();
    phase("check", run.time_check, parts.join(", "))
}

fn tubes(run: &Run) -> Phase {
    phase("tubes", run.time_tube, counted(run.rejection.len(), "model"))
}

fn files(run: &Run) -> Phase {
    let (count, bytes) = run.files;
    let written = format!("{}, {}", counted(count, "file"), size(bytes));
    phase("files", run.time_write, if count > 0 { written } else { "none".into() })
}

fn table(mut phases: Vec<Phase>, notes: &[String], total: Duration, peak_mib: f64) -> String {
    let named: Duration = phases.iter().map(|p| p.time).sum();
    phases.push(phase("other", total.saturating_sub(named), String::new()));
    phases.push(phase("total", total, format!("peak memory {peak_mib:.1} MiB")));
    let mut text = format!("{:<12}{:>12}{:>8}\n", "phase", "time", "share");
    for Phase { name, time, what } in &phases {
        let share = if total.is_zero() { 0.0 } else { 100.0 * time.as_secs_f64() / total.as_secs_f64() };
        let line = format!("{name:<12}{:>12}{share:>6.0} %   {what}", shown(*time, total));
        let _ = writeln!(text, "{}", line.trim_end());
    }
    notes.iter().for_each(|note| text.extend(["\n", note]));
    text.trim_end().into()
}

/// A time in the unit that suits the whole run.
fn shown(time: Duration, total: Duration) -> String {
    if total >= Duration::from_secs(10) {
        format!("{:.2} s", time.as_secs_f64())
    } else {
        format!("{:.1} ms", time.as_secs_f64() * 1e3)
    }
}

fn size(bytes: usize) -> String {
    match bytes {
        0..1024 => format!("{bytes} B"),
        1024..1_048_576 => format!("{:.1} KiB", bytes as f64 / 1024.0),
        _ => format!("{:.1} MiB", bytes as f64 / 1_048_576.0),
    }
}

fn geometry(run: &Run, search: &Statistics) -> String {
    let half_spaces = counted(search.half_spaces, "half-space");
    match run.encoding {
        Encoding::HalfSpaces => half_spaces,
        Encoding::Paper => format!("{half_spaces}, {}", counted(run.cells, "cell")),
    }
}

fn encoded(search: &Statistics) -> String {
    format!("{}, {}", counted(search.bool_vars, "variable"), counted(search.clauses, "clause"))
}

fn convex(search: &Statistics) -> String {
    let [programs, candidates, lemmas] =
        [search.convex_calls, search.candidates, search.lemmas].map(|n| n as usize);
    let programs = counted(programs, "program");
    format!("{programs}, {}, {}", counted(candidates, "candidate"), counted(lemmas, "lemma"))
}

/// How much of the inputs each model's feedback has, and why.
pub fn rejection(models: &BTreeMap<String, JsonRejection>) -> Vec<String> {
    let width = models.keys().map(|name| printable(name).chars().count()).max().unwrap_or(0);
    let line = |(i, (name, chosen)): (usize, (&String, &JsonRejection))| {
        let head = if i == 0 { "rejection" } else { "" };
        format!("{head:<11}{:<width$}  {:<3}  {}", printable(name), chosen.beta, chosen.why)
    };
    models.iter().enumerate().map(line).collect()
}

/// How often each robot's programs have refused what a candidate asks, the most often first.
fn conflicts(run: &Run, search: &Statistics) -> Option<String> {
    let mut robots: Vec<(&String, u64)> = run.robots.iter().zip(search.conflicts.iter().copied()).collect();
    robots.retain(|(_, count)| *count > 0);
    robots.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let shown: Vec<String> =
        robots.iter().take(MOST_ROBOTS).map(|(name, count)| format!("{} {count}", printable(name))).collect();
    let more = robots.len().saturating_sub(MOST_ROBOTS);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    (!shown.is_empty()).then(|| format!("refusals   {}{more}", shown.join(", ")))
}

/// So many robots are named.
const MOST_ROBOTS: usize = 6;

#[cfg(test)]
mod tests {
    use super::*;

    fn run() -> Run {
        let ms = Duration::from_millis;
        let rejection = |why: &str| JsonRejection { beta: 0.5, why: why.into() };
        Run {
            time_read: ms(1),
            time_check: ms(2),
            time_tube: ms(40),
            time_verify: ms(7),
            time_write: Duration::from_micros(1250),
            text: (120, 4321),
            files: (2, 3 << 20),
            parts: vec![(2, "robot"), (1, "region"), (0, "blocker"), (3, "base"), (12, "subformula")],
            robots: (1..=10).map(|i| format!("fleet[{i}]")).collect(),
            rejection: BTreeMap::from([
                ("Cart".into(), rejection("as the mission says")),
                ("Rover".into(), rejection("chosen: for a reason")),
            ]),
            papers_connectivity: 300,
            encoding: Encoding::HalfSpaces,
            cells: 0,
        }
    }

    fn search() -> Statistics {
        let ms = Duration::from_millis;
        Statistics {
            length: 7,
            half_spaces: 1,
            bool_vars: 5124,
            bool_vars_connectivity: 312,
            clauses: 20_123,
            sat_calls: 44,
            convex_calls: 120,
            candidates: 43,
            lemmas: 35,
            not_clear: 0,
            conflicts: vec![0, 2, 9, 1, 9, 3, 4, 5, 6, 7],
            time_encode: ms(12),
            time_sat: ms(20),
            time_convex: ms(90),
            time_geometry: ms(10),
        }
    }

    #[test]
    fn a_search_is_shown_whole() {
        insta::assert_snapshot!(of_search(&run(), &search(), Duration::from_millis(200), 14.0));
    }

    #[test]
    fn a_long_search_is_shown_in_seconds() {
        let search = Statistics { time_sat: Duration::from_secs(3600), conflicts: Vec::new(), ..search() };
        let run = Run { files: (0, 0), rejection: BTreeMap::new(), papers_connectivity: 0, ..run() };
        insta::assert_snapshot!(of_search(&run, &search, Duration::from_secs(3720), 2048.5));
    }

    #[test]
    fn a_run_without_a_search_is_shorter() {
        insta::assert_snapshot!(of_files(&run(), Duration::from_millis(50), 14.0));
    }
}
