//! `dosmc compile`: from a mission to files of other formats.

use std::collections::BTreeSet;
use std::path::Path;
use std::time::{Duration, Instant};

use serde::Serialize;

use super::files::OutputDirectory;
use super::mission::Opening;
use super::output::Output;
use super::overseer::Overseer;
use super::stats::{Ledger, peak_rss_mib};
use super::{Status, output, phases};
use crate::back::{Artifact, Emit};
use crate::diag::printable;
use crate::driver::{self, Overrides};

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
    let ledger = Ledger::default();
    let overseer = Overseer::start(timeout, !output.quiet, output::giving_up(output.clone()));
    let opening = Opening { overrides, overseer: &overseer, ledger: &ledger, output };
    let artifacts = opening.mission(path).map(|mission| {
        let started = Instant::now();
        overseer.enter("writing");
        let artifacts = artifacts(&mission, wanted);
        let size = artifacts.iter().map(|a| a.contents.len()).sum();
        ledger.note(|run| run.wrote(artifacts.len(), size, started.elapsed()));
        artifacts
    });
    overseer.close();
    let done = artifacts.and_then(|artifacts| match overseer.cause() {
        Some(cause) => Err(output.give_up(cause, overseer.elapsed())),
        None => write(&artifacts, &directory, &overseer, &ledger, output),
    });
    done.unwrap_or_else(|status| status)
}

/// The files wanted, in the order of the formats, each once.
fn artifacts(mission: &driver::Mission, wanted: &Wanted) -> Vec<Artifact> {
    let named: BTreeSet<Emit> = wanted.emit.iter().copied().collect();
    let emit = Emit::ALL.iter().filter(|e| named.is_empty() || named.contains(e));
    emit.flat_map(|e| driver::compile(mission, *e, wanted.length)).collect()
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
