//! `dosmc compile`: from a mission to files of other formats.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::Serialize;

use super::args::Format;
use super::files::OutputDirectory;
use super::mission::Opening;
use super::output::{Output, plain_error};
use super::overseer::Overseer;
use super::stats::{Ledger, peak_rss_mib};
use super::verify::{self, Examined};
use super::{Status, output, phases};
use crate::back::{Artifact, Emit};
use crate::diag::{Diagnostic, printable};
use crate::driver::{self, Encoding, NotWritten, Overrides, TooLarge};
use crate::law::{Float, Misfit};
use crate::source::SourceFile;

/// What `compile --json` prints.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct JsonCompile {
    /// Always `done`.
    #[cfg_attr(test, schemars(extend("const" = "done")))]
    status: &'static str,
    /// The paths of the files written.
    files: Vec<String>,
}

/// All that `compile --json` prints.
#[cfg(test)]
#[derive(Serialize, schemars::JsonSchema)]
#[serde(untagged)]
#[allow(dead_code, reason = "only the schema is made of it")]
pub(super) enum JsonCompiled {
    /// Files.
    Written(JsonCompile),
    /// A plan that is refused, and so has no controller.
    Refused(verify::JsonVerify),
}

/// What is to be written.
pub struct Wanted {
    /// The formats; all that there are when empty.
    pub emit: Vec<Format>,
    /// The plan whose controller is wanted.
    pub plan: Option<PathBuf>,
    /// What the controller computes with.
    pub float: Float,
    /// The length of the plans, for formats that speak of one or several.
    pub length: Option<usize>,
    /// What instances speak of.
    pub encoding: Encoding,
}

impl Wanted {
    /// What is wrong with it, for a mission.
    fn contradiction(&self, mission: &Path) -> Option<&'static str> {
        let controller = self.emit.contains(&Format::Controller);
        match &self.plan {
            None if controller => Some("a controller is a plan's: name the plan with `--plan plan.json`"),
            Some(_) if !controller && !self.emit.is_empty() => {
                Some("`--plan` is for the controller, which `--emit` leaves out")
            }
            Some(plan) if plan == Path::new("-") && mission == plan => {
                Some("the plan and the mission can't both come from standard input")
            }
            _ => None,
        }
    }
}

/// Writes a mission in the formats wanted.
pub fn compile(
    path: &Path,
    directory: &Path,
    wanted: &Wanted,
    overrides: &Overrides,
    timeout: Option<Duration>,
    output: &Output,
) -> Status {
    let probed = wanted.contradiction(path).map_or(Ok(()), |why| Err(super::usage(why)));
    let directory = match probed.and_then(|()| OutputDirectory::probe(directory)) {
        Ok(directory) => directory,
        Err(problem) => return output.fail(problem),
    };
    let ledger = Ledger::default();
    let overseer = Overseer::start(timeout, !output.quiet, output::giving_up(output.clone()));
    let opening = Opening { overrides, overseer: &overseer, ledger: &ledger, output };
    let opened = opening.open(path).and_then(|source| Ok((opening.load(&source)?, source)));
    let artifacts = opened.and_then(|(mission, source)| {
        let started = Instant::now();
        overseer.enter("writing");
        let artifacts = artifacts(&mission, &source, wanted);
        let mut artifacts = artifacts.map_err(|why| overseer.aside(|| output.fail(not_written(why))))?;
        if let Some(plan) = &wanted.plan {
            overseer.enter("checking the plan exactly");
            artifacts.extend(overseer.aside(|| controller(plan, &mission, wanted.float, output))?);
        }
        let size = artifacts.iter().map(|a| a.contents.len()).sum();
        ledger.note(|run| run.wrote(artifacts.len(), size, started.elapsed()));
        Ok(artifacts)
    });
    overseer.close();
    let done = artifacts.and_then(|artifacts| match overseer.cause() {
        Some(cause) => Err(output.give_up(cause, overseer.elapsed())),
        None => write(&artifacts, &directory, &overseer, &ledger, output),
    });
    done.unwrap_or_else(|status| status)
}

/// The files of the controller of a plan, which is checked first.
fn controller(
    path: &Path,
    mission: &driver::Mission,
    float: Float,
    output: &Output,
) -> Result<Vec<Artifact>, Status> {
    let plan = verify::read_plan(path)
        .map_err(|problem| output.fail(problem))?
        .map_err(|malformed| output.fail_with(malformed, Status::Refused))?;
    let started = Instant::now();
    let report = driver::verify(&mission.problem, &plan);
    if !report.holds() {
        let problem = mission.problem.clone();
        return Err(verify::tell(&Examined { problem, plan, report, time: started.elapsed() }, output));
    }
    let artifacts = driver::controller(&mission.problem, &plan, float);
    artifacts.map_err(|why| output.fail_with(does_not_fit(&why, float), Status::Refused))
}

/// What is said where a plan's proof does not hold for a controller.
fn does_not_fit(why: &Misfit, float: Float) -> Diagnostic {
    let message = format!("no controller in {float}: {why}");
    let problem = plain_error("dosm::controller::rounding", message);
    match float {
        Float::F32 => problem.with_help("`dosmc solve --float f32` makes a plan with room for its rounding"),
        Float::F64 => problem,
    }
}

/// The files wanted, in the order of the formats, each once.
fn artifacts(
    mission: &driver::Mission,
    source: &SourceFile,
    wanted: &Wanted,
) -> Result<Vec<Artifact>, NotWritten> {
    let named: BTreeSet<Emit> = wanted
        .emit
        .iter()
        .filter_map(|format| match format {
            Format::Mission(emit) => Some(*emit),
            Format::Controller => None,
        })
        .collect();
    let emit = Emit::ALL.iter().filter(|e| wanted.emit.is_empty() || named.contains(e));
    emit.map(|e| driver::compile(mission, source, wanted.encoding, *e, wanted.length)).collect()
}

fn not_written(why: NotWritten) -> Diagnostic {
    match why {
        NotWritten::TooFine(why) => super::usage(why.to_string()),
        NotWritten::TooLarge(TooLarge { clauses }) => {
            let millions = clauses.div_ceil(1_000_000);
            let message = format!("the instance would have some {millions} million clauses");
            plain_error("dosm::cli::too_large", message)
                .with_help("write one length with `--length L`, or fewer with `--horizon A..B`")
        }
    }
}

fn write(
    artifacts: &[Artifact],
    directory: &OutputDirectory,
    overseer: &Overseer,
    ledger: &Ledger,
    output: &Output,
) -> Result<Status, Status> {
    let started = Instant::now();
    let files = directory.write(artifacts).map_err(|problem| output.fail(problem))?;
    ledger.note(|run| run.time_write += started.elapsed());
    if output.verbose > 0 {
        output.note(&phases::of_files(&ledger.so_far(), overseer.elapsed(), peak_rss_mib()));
    }
    let files: Vec<String> = files.iter().map(|f| f.to_string_lossy().into_owned()).collect();
    output.say(&format!("written:\n  {}", printable(&files.join("\n  "))))?;
    output.json(&JsonCompile { status: "done", files })?;
    Ok(Status::Done)
}
