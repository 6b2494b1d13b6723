//! `dosmc compile`: from a mission to files of other formats.

use std::collections::BTreeSet;
use std::path::Path;
use std::time::Duration;

use serde::Serialize;

use super::files::OutputDirectory;
use super::output::Output;
use super::overseer::{Cause, LastWords, Overseer};
use super::{Status, mission};
use crate::back::{Artifact, Emit};
use crate::diag::printable;
use crate::driver::{self, Overrides};
use crate::solve::Progress;

/// What `compile --json` prints.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct JsonCompile {
    /// `done`, or `unknown` when time ran out before anything was written.
    #[cfg_attr(test, schemars(extend("enum" = ["done", "unknown"])))]
    status: &'static str,
    /// The paths of the files written.
    files: Vec<String>,
}

/// What is to be written.
pub struct Wanted {
    /// The formats; all that there are when empty.
    pub emit: Vec<Emit>,
    /// The length of the plans, for formats that speak of one or several.
    pub length: Option<usize>,
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
    let directory = match OutputDirectory::probe(directory) {
        Ok(directory) => directory,
        Err(problem) => return output.fail(problem),
    };
    let source = match mission::open_or_fail(path, output) {
        Ok(source) => source,
        Err(status) => return status,
    };
    let overseer = Overseer::start(timeout, !output.quiet, last_words(output.clone()));
    let artifacts =
        mission::load_or_fail(&source, overrides, output).map(|(mission, _)| artifacts(&mission, wanted));
    overseer.close();
    let done = artifacts.and_then(|artifacts| match overseer.cause() {
        Some(cause) => given_up(cause, overseer.elapsed(), output),
        None => write(&artifacts, &directory, output),
    });
    done.unwrap_or_else(|status| status)
}

/// The files wanted, in the order of the formats, each once.
fn artifacts(mission: &driver::Mission, wanted: &Wanted) -> Vec<Artifact> {
    let named: BTreeSet<Emit> = wanted.emit.iter().copied().collect();
    let emit = Emit::ALL.iter().filter(|e| named.is_empty() || named.contains(e));
    emit.flat_map(|e| driver::compile(mission, *e, wanted.length)).collect()
}

fn write(artifacts: &[Artifact], directory: &OutputDirectory, output: &Output) -> Result<Status, Status> {
    let files = directory.write(artifacts).map_err(|problem| output.fail(problem))?;
    let files: Vec<String> = files.iter().map(|f| f.to_string_lossy().into_owned()).collect();
    output.say(&format!("written:\n  {}", printable(&files.join("\n  "))))?;
    output.json(&JsonCompile { status: "done", files })?;
    Ok(Status::Done)
}

/// Says that nothing was written, and why.
fn given_up(cause: Cause, elapsed: Duration, output: &Output) -> Result<Status, Status> {
    let why = match cause {
        Cause::Timeout => "time ran out",
        Cause::Interrupt => "interrupted",
    };
    output.say(&format!("unknown: {why} after {:.1} s; nothing was written", elapsed.as_secs_f64()))?;
    output.json(&JsonCompile { status: "unknown", files: Vec::new() })?;
    Ok(Status::Unknown)
}

/// What is said when the process has to end in the middle of something.
fn last_words(output: Output) -> LastWords {
    Box::new(move |cause: Cause, _: Progress, elapsed: Duration| {
        // Nothing more can be done about an output that fails here.
        let _ = given_up(cause, elapsed, &output);
    })
}
