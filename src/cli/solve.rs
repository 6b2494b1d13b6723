//! `dosmc solve`: from a mission to files.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use serde::Serialize;

use super::files::OutputDirectory;
use super::instance::Asked;
use super::mission::Opening;
use super::output::Output;
use super::overseer::{Cause, LastWords, Overseer};
use super::stats::{JsonStats, Ledger, peak_rss_mib};
use super::{Status, phases, png};
use crate::back::{Artifact, controller, svg};
use crate::diag::{Diagnostic, printable};
use crate::driver::{self, Answer, Encoding, Overrides, Scope, Solved};
use crate::law::Float;
use crate::plan::{self, Plan};
use crate::solve::{Progress, Reason, Statistics, Watch};
use crate::verify::JsonReport;

/// What `solve --json` prints.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct JsonSolve {
    /// `plan`, `no_plan`, `unknown`, or `error` for a plan that was found but does not check.
    #[cfg_attr(test, schemars(extend("enum" = ["plan", "no_plan", "unknown", "error"])))]
    status: &'static str,
    /// The plan's length L, `null` without a plan.
    length: Option<usize>,
    /// The step that comes again after the last one, `null` without a plan.
    loop_start: Option<usize>,
    /// Whether no shorter plan exists, for its tube, rejection share and directions.
    shortest: bool,
    /// The time since the start, in seconds.
    time_s: f64,
    /// Counts and times.
    stats: JsonStats,
    /// For `no_plan`: what it holds for.
    #[serde(skip_serializing_if = "Option::is_none")]
    scope: Option<Scope>,
    /// For `unknown`: `timeout`, `interrupt`, `numerics`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("enum" = ["timeout", "interrupt", "numerics"])))]
    reason: Option<&'static str>,
    /// For `unknown`: the length that was being tried.
    #[serde(skip_serializing_if = "Option::is_none")]
    reached: Option<usize>,
    /// For a plan: the files written.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    files: Vec<String>,
    /// For a plan that was found but refused by the exact check: what it refused.
    #[serde(skip_serializing_if = "Option::is_none")]
    report: Option<JsonReport>,
}

impl JsonSolve {
    fn new(status: &'static str, time: Duration, stats: JsonStats) -> JsonSolve {
        JsonSolve {
            status,
            length: None,
            loop_start: None,
            shortest: false,
            time_s: time.as_secs_f64(),
            stats,
            scope: None,
            reason: None,
            reached: None,
            files: Vec::new(),
            report: None,
        }
    }
}

/// How to search.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// When to stop.
    pub timeout: Option<Duration>,
    /// What the search speaks of.
    pub encoding: Option<Encoding>,
    /// Whether to write the picture as PNG too.
    pub png: bool,
}

/// Where the plan and its pictures go.
struct Destination {
    directory: OutputDirectory,
    png: bool,
}

impl Destination {
    /// Sees whether all can be written.
    fn probe(directory: &Path, png: bool) -> Result<Destination, Diagnostic> {
        if png {
            png::available()?;
        }
        Ok(Destination { directory: OutputDirectory::probe(directory)?, png })
    }

    /// Writes the pictures, the controller and the plan, the plan itself last: where it is, all is.
    /// Gives their paths and how many bytes they are.
    fn write(
        &self,
        picture: &Artifact,
        controller: &[Artifact],
        plan: &Plan,
    ) -> Result<(Vec<String>, usize), Diagnostic> {
        let pixels = if self.png { Some(png::from_svg(&picture.contents)?) } else { None };
        let text = plan::json::write(plan);
        let mut files = vec![(svg::NAME, picture.contents.as_bytes())];
        files.extend(pixels.iter().map(|p| (png::NAME, p.as_slice())));
        files.extend(controller.iter().map(|a| (a.name.as_str(), a.contents.as_bytes())));
        files.push(("plan.json", text.as_bytes()));
        let written = self.directory.write_bytes(&files)?;
        let size = files.iter().map(|(_, contents)| contents.len()).sum();
        Ok((written.iter().map(|f| f.to_string_lossy().into_owned()).collect(), size))
    }
}

/// Plans a mission and writes the plan and its picture into a directory.
pub fn solve(
    path: &Path,
    directory: &Path,
    overrides: &Overrides,
    settings: Settings,
    output: &Output,
) -> Status {
    let destination = match Destination::probe(directory, settings.png) {
        Ok(destination) => destination,
        Err(problem) => return output.fail(problem),
    };
    let ledger = Ledger::default();
    let overseer =
        Overseer::start(settings.timeout, !output.quiet, last_words(ledger.clone(), output.clone()));
    let opening = Opening { overrides, overseer: &overseer, ledger: &ledger, output };
    let opened = opening.open(path).and_then(|text| {
        let asked = Asked::new(text, settings.encoding, &opening)?;
        ledger.note(|run| run.encoding = asked.encoding);
        Ok((asked.load(&opening)?, asked))
    });
    let (mission, asked) = match opened {
        Ok(opened) => opened,
        Err(status) => {
            overseer.close();
            return status;
        }
    };
    let watch: Arc<dyn Watch> = Arc::<Overseer>::clone(&overseer);
    let solved = driver::solve_with(&mission, asked.encoding, &watch);
    overseer.close();
    let Solved { answer: found, statistics, time_verify, cells, outlines, .. } = match solved {
        Ok(solved) => solved,
        Err(too_fine) => return output.fail(super::usage(too_fine.to_string())),
    };
    ledger.note(|run| (run.time_verify, run.cells) = (time_verify, cells));
    let (mission, overseer, ledger) = (&mission, &*overseer, &ledger);
    let float = overrides.float;
    let ending = Ending { mission, statistics, float, outlines, overseer, ledger, output };
    ending.answer(found, &destination).unwrap_or_else(|status| status)
}

/// A search that has ended.
struct Ending<'a> {
    mission: &'a driver::Mission,
    statistics: Statistics,
    /// What the controller computes with.
    float: Float,
    /// The cells to draw.
    outlines: Vec<svg::Cell>,
    overseer: &'a Overseer,
    ledger: &'a Ledger,
    output: &'a Output,
}

impl Ending<'_> {
    /// Writes what came out, and says so.
    fn answer(&self, answer: Answer, destination: &Destination) -> Result<Status, Status> {
        let output = self.output;
        match answer {
            Answer::Plan { plan, shortest } => self.plan(&plan, shortest, destination),
            Answer::NoPlan(scope) => {
                self.note_phases();
                output.say(&no_plan(self.mission, &scope))?;
                output.json(&JsonSolve { scope: Some(scope), ..self.json("no_plan") })?;
                Ok(Status::NoPlan)
            }
            Answer::Unknown(reason) => {
                self.note_phases();
                let (name, why) = why_unknown(reason, self.overseer.cause());
                let reached = self.statistics.length;
                output.say(&unknown(why, reached, self.overseer.elapsed()))?;
                output.json(&JsonSolve {
                    reason: Some(name),
                    reached: Some(reached),
                    ..self.json("unknown")
                })?;
                Ok(Status::Unknown)
            }
            Answer::Refused(report) => {
                self.note_phases();
                output.say(&format!(
                    "the plan that was found does not check exactly, and wider margins did not help:\n{}",
                    printable(&report.to_string())
                ))?;
                output.json(&JsonSolve { report: Some(report.to_json()), ..self.json("error") })?;
                Ok(Status::Refused)
            }
        }
    }

    fn plan(&self, plan: &Plan, shortest: bool, destination: &Destination) -> Result<Status, Status> {
        let started = Instant::now();
        let options = svg::Options { cells: &self.outlines, ..Default::default() };
        let picture = svg::draw(&self.mission.problem, plan, &options);
        let controller = self.controller(plan);
        let written = destination.write(&picture, &controller, plan);
        let (files, size) = written.map_err(|problem| self.output.fail(problem))?;
        self.ledger.note(|run| run.wrote(files.len(), size, started.elapsed()));
        self.note_phases();
        self.output.say(&found(plan, shortest, self.ledger.so_far().encoding, &files))?;
        let (length, loop_start) = (Some(plan.length), Some(plan.loop_start));
        self.output.json(&JsonSolve { length, loop_start, shortest, files, ..self.json("plan") })?;
        Ok(Status::Done)
    }

    /// The files of the plan's controller; none, and a warning, where its proof does not go through.
    fn controller(&self, plan: &Plan) -> Vec<Artifact> {
        driver::controller(&self.mission.problem, plan, self.float).unwrap_or_else(|why| {
            let why = printable(&why.to_string()).into_owned();
            self.output.note(&format!("warning: no controller in {} is written: {why}", self.float));
            Vec::new()
        })
    }

    fn json(&self, status: &'static str) -> JsonSolve {
        let time = self.overseer.elapsed();
        JsonSolve::new(status, time, JsonStats::new(&self.ledger.so_far(), &self.statistics, time))
    }

    /// With `-v`, what took how long.
    fn note_phases(&self) {
        if self.output.verbose > 0 {
            let (run, total) = (self.ledger.so_far(), self.overseer.elapsed());
            self.output.note(&phases::of_search(&run, &self.statistics, total, peak_rss_mib()));
        }
    }
}

pub(super) fn found(plan: &Plan, shortest: bool, encoding: Encoding, files: &[String]) -> String {
    let rank = match (shortest, encoding) {
        (true, Encoding::HalfSpaces) => "no shorter one exists for its tube and directions",
        (true, Encoding::Paper) => "no shorter one exists for its tube and cells",
        (false, _) => "a shorter one may exist",
    };
    let files = shown(files).join("\n  ");
    format!("plan: {}; checked exactly; {rank}\n  {}", plan.summary(), printable(&files))
}

/// The files for people: those of the controller as its directory alone.
fn shown(files: &[String]) -> Vec<String> {
    let mut shown: Vec<String> = Vec::new();
    for file in files {
        let ancestors = Path::new(file).ancestors();
        let directory = ancestors.skip(1).find(|a| a.file_name().is_some_and(|n| n == controller::DIRECTORY));
        let path = directory.map_or_else(|| file.clone(), |d| format!("{}/", d.to_string_lossy()));
        if shown.last() != Some(&path) {
            shown.push(path);
        }
    }
    shown
}

pub(super) fn no_plan(mission: &driver::Mission, scope: &Scope) -> String {
    let (from, to) = mission.problem.horizon;
    let widths: Vec<String> =
        scope.half_widths.iter().map(|(name, w)| format!("{name} ±({})", list(w))).collect();
    let with = match scope.cells {
        0 => format!("{} separating directions", scope.directions),
        cells => format!("a partition into {cells} cells (try without `--encoding paper`)"),
    };
    format!(
        "no plan of any length in {from}..{to}\n  for tubes of {} (metres), rejection {}, and {with}",
        printable(&widths.join(", ")),
        list(&scope.beta.values().copied().collect::<Vec<_>>()),
    )
}

fn list(numbers: &[f64]) -> String {
    numbers.iter().map(|x| format!("{x:.3}")).collect::<Vec<_>>().join(", ")
}

pub(super) fn why_unknown(reason: Reason, cause: Option<Cause>) -> (&'static str, &'static str) {
    match reason {
        Reason::Numerics => ("numerics", "some length could not be decided numerically"),
        Reason::Stopped => {
            let cause = cause.unwrap_or(Cause::Interrupt);
            (cause.name(), cause.said())
        }
    }
}

pub(super) fn unknown(why: &str, reached: usize, elapsed: Duration) -> String {
    let at = if reached == 0 { "before the search began".into() } else { format!("at length {reached}") };
    format!("unknown: {why} {at}, after {:.1} s; no plan was written", elapsed.as_secs_f64())
}

/// What is said when the process has to end in the middle of something.
fn last_words(ledger: Ledger, output: Output) -> LastWords {
    Box::new(move |cause: Cause, reached: Progress, elapsed: Duration| {
        let length = reached.length;
        // Nothing more can be done about an output that fails here.
        let _ = output.say(&unknown(cause.said(), length, elapsed));
        let stats = JsonStats::new(&ledger.so_far(), &reached, elapsed);
        let json = JsonSolve::new("unknown", elapsed, stats);
        let _ = output.json(&JsonSolve { reason: Some(cause.name()), reached: Some(length), ..json });
    })
}
