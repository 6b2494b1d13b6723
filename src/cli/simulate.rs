//! `dosmc simulate`: a plan that checks, flown in closed loop.

use std::io::{self, Write};
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use serde::Serialize;

use super::files::{GrowingFile, OutputFile};
use super::output::{Output, counted, giving_up};
use super::overseer::{Cause, Overseer};
use super::verify::{self, Examined};
use super::weather::Weather;
use super::{Status, sheet};
use crate::back::Flight;
use crate::diag::{Diagnostic, printable};
use crate::driver::Overrides;
use crate::law::Float;
use crate::simulate::{self, JsonSummary, Observer, Options, Rows, Summary, Unfit, Way};

/// What `simulate --json` prints; for a plan that is refused it prints what `verify --json` does.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct JsonSimulate {
    /// `held` when nothing was violated, `violated` when something was, `unknown` when it was stopped before
    /// anything was.
    #[cfg_attr(test, schemars(extend("enum" = ["held", "violated", "unknown"])))]
    status: &'static str,
    /// Why it was stopped, if it was.
    #[cfg_attr(test, schemars(extend("enum" = ["timeout", "interrupt", null])))]
    reason: Option<&'static str>,
    /// Whether the plan was made from the same source text.
    same_text: bool,
    #[serde(flatten)]
    summary: JsonSummary,
    /// The time that it took, in seconds.
    time_s: f64,
    /// Robot-steps a second.
    robot_steps_per_s: f64,
}

/// All that `simulate --json` prints.
#[cfg(test)]
#[derive(Serialize, schemars::JsonSchema)]
#[serde(untagged)]
#[allow(dead_code, reason = "only the schema is made of it")]
pub(super) enum JsonSimulated {
    /// A simulation.
    Flown(Box<JsonSimulate>),
    /// A plan that is refused.
    Refused(verify::JsonVerify),
}

/// What is asked for.
pub struct Wanted<'a> {
    /// The runs.
    pub options: Options,
    /// Where to write each of them.
    pub csv: Option<&'a Path>,
}

/// The simulation that the flags ask for.
pub fn options(runs: u64, weather: Weather, float: Float, threads: Option<u16>) -> Options {
    let cores = || thread::available_parallelism().map_or(1, usize::from);
    Options {
        runs,
        seed: weather.seed,
        steps: weather.steps,
        disturbances: weather.disturbance.kinds(),
        exceed: weather.exceed,
        float,
        threads: threads.map_or_else(cores, usize::from),
    }
}

/// Simulates a plan of a mission, if it checks.
pub fn simulate(
    plan: &Path,
    mission: &Path,
    wanted: &Wanted<'_>,
    overrides: &Overrides,
    timeout: Option<Duration>,
    output: &Output,
) -> Status {
    let file = match Csv::file(wanted.csv, output) {
        Ok(file) => file,
        Err(problem) => return output.fail(problem),
    };
    let csv = match Csv::new(wanted.csv, file.as_ref()) {
        Ok(csv) => csv,
        Err(problem) => return output.fail(problem),
    };
    let overseer = Overseer::start(timeout, !output.quiet, giving_up(output.clone()));
    let flown = verify::examine_while(&overseer, plan, mission, overrides, output)
        .map(|examined| (flown(&examined, wanted, csv, &overseer), examined));
    overseer.close();
    match flown {
        Ok((None, refused)) => verify::tell(&refused, output),
        Ok((Some(Ok(flown)), examined)) => tell(&examined, wanted, flown, output),
        Ok((Some(Err(why)), _)) => output.fail(why),
        Err(status) => status,
    }
}

/// A simulation that is over.
struct Flown {
    summary: Summary,
    time: Duration,
    stopped: Option<Cause>,
    csv: Option<String>,
}

/// Simulates; nothing for a plan that is refused.
fn flown(
    examined: &Examined,
    wanted: &Wanted<'_>,
    csv: Csv<'_>,
    overseer: &Overseer,
) -> Option<Result<Flown, Diagnostic>> {
    let Examined { problem, plan, report, .. } = examined;
    if !report.holds() {
        return None;
    }
    let started = Instant::now();
    let rows = Rows::new(problem, &wanted.options);
    let writes = !matches!(csv, Csv::None);
    let of = wanted.options.runs;
    let watcher = Watcher { overseer, of, rows: &rows, csv: Mutex::new((csv, None)), writes };
    watcher.write(&rows.head());
    let summary = simulate::run(problem, plan, &wanted.options, &watcher);
    let (csv, failed) = watcher.csv.into_inner().unwrap_or_else(PoisonError::into_inner);
    let time = started.elapsed();
    Some(match (summary, failed) {
        (_, Some(why)) => Err(why),
        (Err(unfit), _) => Err(misfit(unfit)),
        (Ok(summary), None) => {
            let stopped = overseer.cause().filter(|_| summary.runs < wanted.options.runs);
            // A table that stops in the middle would be taken for a whole one.
            let kept = if stopped.is_none() { csv.finish() } else { Ok(None) };
            kept.map(|csv| Flown { summary, time, stopped, csv })
        }
    })
}

fn misfit(unfit: Unfit) -> Diagnostic {
    super::usage(unfit.to_string())
}

/// Hears how far the simulation is, and writes down each run where that is asked for.
struct Watcher<'a, 'f> {
    overseer: &'a Overseer,
    of: u64,
    rows: &'a Rows<'a>,
    /// The table, and why it could not be written.
    csv: Mutex<(Csv<'f>, Option<Diagnostic>)>,
    /// Whether there is one.
    writes: bool,
}

impl Watcher<'_, '_> {
    fn write(&self, text: &str) {
        let mut held = self.csv.lock().unwrap_or_else(PoisonError::into_inner);
        let (csv, failed) = &mut *held;
        if failed.is_none() {
            *failed = csv.add(text).err();
        }
    }
}

impl Observer for Watcher<'_, '_> {
    fn stop(&self) -> bool {
        self.overseer.cause().is_some()
    }

    fn progress(&self, runs: u64, violations: u64) {
        self.overseer.count(runs, self.of, violations);
    }

    fn wants_ways(&self) -> bool {
        self.writes
    }

    fn see(&self, run: u64, ways: &[Way]) {
        self.write(&self.rows.run(run, ways));
    }
}

/// Where the table goes.
enum Csv<'a> {
    None,
    Standard,
    File(GrowingFile<'a>),
}

impl<'a> Csv<'a> {
    /// The file that is asked for, if one is.
    fn file(path: Option<&Path>, output: &Output) -> Result<Option<OutputFile>, Diagnostic> {
        match path {
            None => Ok(None),
            Some(path) if path == Path::new("-") && output.json => {
                Err(super::usage("`--csv -` and `--json` can't both have standard output"))
            }
            Some(path) if path == Path::new("-") => Ok(None),
            Some(path) => OutputFile::probe(path).map(Some),
        }
    }

    fn new(path: Option<&Path>, file: Option<&'a OutputFile>) -> Result<Csv<'a>, Diagnostic> {
        match (path, file) {
            (_, Some(file)) => file.begin().map(Csv::File),
            (Some(_), None) => Ok(Csv::Standard),
            (None, None) => Ok(Csv::None),
        }
    }

    fn add(&mut self, text: &str) -> Result<(), Diagnostic> {
        match self {
            Csv::None => Ok(()),
            Csv::File(file) => file.add(text),
            Csv::Standard => match io::stdout().lock().write_all(text.as_bytes()) {
                // Whoever closed the pipe has read enough.
                Err(e) if e.kind() != io::ErrorKind::BrokenPipe => Err(super::output::plain_error(
                    "dosm::cli::unwritable",
                    format!("can't write to standard output: {e}"),
                )),
                _ => Ok(()),
            },
        }
    }

    fn finish(self) -> Result<Option<String>, Diagnostic> {
        match self {
            Csv::File(file) => file.finish().map(|path| Some(path.to_string_lossy().into_owned())),
            _ => Ok(None),
        }
    }
}

/// Says what came out.
fn tell(examined: &Examined, wanted: &Wanted<'_>, flown: Flown, output: &Output) -> Status {
    let options = &wanted.options;
    let Flown { summary, time, stopped, csv } = flown;
    let violations = summary.findings.samples.all_shortfalls();
    let beyond = options.exceed > 1.0;
    let status = match (violations, stopped) {
        (1.., _) if !beyond => Status::Refused,
        (_, Some(_)) => Status::Unknown,
        _ => Status::Done,
    };
    let named = match (violations, stopped) {
        (1.., _) => "violated",
        (_, Some(_)) => "unknown",
        _ => "held",
    };
    if !examined.report.same_text {
        output.note("warning: the plan was made from another text of the mission; it holds for this one too");
    }
    let seconds = time.as_secs_f64();
    let summary = JsonSummary::new(&examined.problem, options, &summary);
    let mut text = sheet::of(&summary, options.runs, seconds);
    if let Some(cause) = stopped {
        let made = counted(usize::try_from(summary.runs).unwrap_or(usize::MAX), "run");
        let note = format!("{} after {made} of {}", cause.said(), options.runs);
        text = format!("{note}\n{text}");
    }
    if let Some(path) = csv {
        text = format!("{text}\n\nwritten\n  {path}");
    }
    let rate = if seconds > 0.0 { summary.robot_steps as f64 / seconds } else { 0.0 };
    let json = JsonSimulate {
        status: named,
        reason: stopped.map(Cause::name),
        same_text: examined.report.same_text,
        summary,
        time_s: seconds,
        robot_steps_per_s: rate,
    };
    let text = printable(&text);
    let said = if wanted.csv == Some(Path::new("-")) {
        // The table has standard output.
        output.note(&text);
        Ok(())
    } else {
        output.say(&text)
    };
    said.and_then(|()| output.json(&json)).err().unwrap_or(status)
}

/// The ways of some runs, for a picture.
///
/// # Errors
/// A diagnostic when the plan can't be simulated as asked.
pub fn flights(examined: &Examined, options: &Options) -> Result<Vec<Flight>, Diagnostic> {
    if options.runs == 0 {
        return Ok(Vec::new());
    }
    let plan = &examined.plan;
    // The way and the loop once more: what comes after would only be drawn over them.
    let once = plan.length + 1 + (plan.length + 1).saturating_sub(plan.loop_start);
    let options = Options { steps: options.steps.or(Some(once)), ..options.clone() };
    let seen = Positions { examined, flights: Mutex::new(Vec::new()) };
    simulate::run(&examined.problem, plan, &options, &seen).map_err(misfit)?;
    Ok(seen.flights.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// Keeps the positions of each run.
struct Positions<'a> {
    examined: &'a Examined,
    flights: Mutex<Vec<Flight>>,
}

impl Observer for Positions<'_> {
    fn wants_ways(&self) -> bool {
        true
    }

    fn see(&self, _: u64, ways: &[Way]) {
        let problem = &self.examined.problem;
        let positions = |(robot, way): (&crate::ir::Robot, &Way)| {
            let axes = &problem.models[robot.model].position;
            (0..way.samples()).map(|t| axes.iter().map(|&i| way.state(t)[i]).collect()).collect()
        };
        let ways = problem.robots.values().zip(ways).map(positions).collect();
        self.flights.lock().unwrap_or_else(PoisonError::into_inner).push(Flight { ways });
    }
}
