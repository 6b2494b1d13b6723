//! `dosmc verify`: the independent checker.

use std::path::Path;
use std::time::Instant;

use serde::Serialize;

use super::output::{Output, plain_error};
use super::{Status, files, mission};
use crate::diag::{Diagnostic, printable};
use crate::driver::{self, Overrides};
use crate::plan::{self, Plan};
use crate::verify::{JsonReport, Report};

/// What `verify --json` prints.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct JsonVerify {
    /// `checked` when the plan holds.
    #[cfg_attr(test, schemars(extend("enum" = ["checked", "refused"])))]
    status: &'static str,
    /// Whether the plan was made from the same source text.
    same_text: bool,
    /// The time that the check took, in seconds.
    time_s: f64,
    /// Each kind of check, and the first failures.
    report: JsonReport,
}

/// Checks a plan against a mission.
pub fn verify(plan: &Path, mission: &Path, overrides: &Overrides, output: &Output) -> Status {
    if plan == Path::new("-") && mission == Path::new("-") {
        return output.fail(super::usage("the plan and the mission can't both come from standard input"));
    }
    let problem = match mission::problem_or_fail(mission, overrides, output) {
        Ok(problem) => problem,
        Err(status) => return status,
    };
    let started = Instant::now();
    match read_plan(plan) {
        Ok(Ok(plan)) => {
            let report = driver::verify(&problem, &plan);
            tell(&report, started.elapsed().as_secs_f64(), output)
        }
        Ok(Err(refused)) => output.fail_with(refused, Status::Refused),
        Err(problem) => output.fail(problem),
    }
}

/// A plan from its file: the outer error is the file's, the inner one the plan's.
fn read_plan(path: &Path) -> Result<Result<Plan, Diagnostic>, Diagnostic> {
    let bytes = files::read(path)?;
    let name = printable(&files::shown_name(path)).into_owned();
    let refused = |why: &str| plain_error("dosm::plan::malformed", format!("`{name}` is no plan: {why}"));
    let Ok(text) = String::from_utf8(bytes) else { return Ok(Err(refused("it is no UTF-8"))) };
    Ok(plan::json::read(&text).map_err(|e| refused(&e.to_string())))
}

/// Says what came out.
fn tell(report: &Report, time_s: f64, output: &Output) -> Status {
    let (status, code) =
        if report.holds() { ("checked", Status::Done) } else { ("refused", Status::Refused) };
    let json = JsonVerify { status, same_text: report.same_text, time_s, report: report.to_json() };
    let said = output.say(&printable(&report.to_string()));
    said.and_then(|()| output.json(&json)).err().unwrap_or(code)
}
