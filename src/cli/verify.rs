//! `dosmc verify`: the independent checker.

use std::path::Path;
use std::time::{Duration, Instant};

use serde::Serialize;

use super::mission::Opening;
use super::output::{Output, giving_up, plain_error};
use super::overseer::Overseer;
use super::stats::{Ledger, peak_rss_mib};
use super::{Status, files, phases};
use crate::diag::{Diagnostic, printable};
use crate::driver::{self, Overrides};
use crate::ir::Problem;
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

/// A plan that could be read, with what the exact check says of it.
pub struct Examined {
    /// What it is a plan of.
    pub problem: Problem,
    /// The plan.
    pub plan: Plan,
    /// What the check found; the plan may be refused.
    pub report: Report,
    /// How long the check took.
    pub time: Duration,
}

/// Checks a plan against a mission.
pub fn verify(
    plan: &Path,
    mission: &Path,
    overrides: &Overrides,
    timeout: Option<Duration>,
    output: &Output,
) -> Status {
    let examined = examine(plan, mission, overrides, timeout, output);
    examined.map_or_else(|status| status, |examined| tell(&examined, output))
}

/// Reads a plan and its mission, and checks the one against the other.
///
/// # Errors
/// The command's status when one of them can't be read, which was said.
pub fn examine(
    plan: &Path,
    mission: &Path,
    overrides: &Overrides,
    timeout: Option<Duration>,
    output: &Output,
) -> Result<Examined, Status> {
    let overseer = Overseer::start(timeout, !output.quiet, giving_up(output.clone()));
    let examined = examine_while(&overseer, plan, mission, overrides, output);
    overseer.close();
    examined
}

/// Reads a plan and its mission, and checks the one against the other, as part of a longer command.
///
/// # Errors
/// The command's status when one of them can't be read, which was said.
pub fn examine_while(
    overseer: &Overseer,
    plan: &Path,
    mission: &Path,
    overrides: &Overrides,
    output: &Output,
) -> Result<Examined, Status> {
    let fail = |problem, status| overseer.aside(|| output.fail_with(problem, status));
    if plan == Path::new("-") && mission == Path::new("-") {
        let why = super::usage("the plan and the mission can't both come from standard input");
        return Err(fail(why, Status::Usage));
    }
    let ledger = Ledger::default();
    let opening = Opening { overrides, overseer, ledger: &ledger, output };
    let problem = opening.problem(mission)?;
    let started = Instant::now();
    overseer.enter("checking the plan exactly");
    let plan =
        read_plan(plan).map_err(|why| fail(why, Status::Usage))?.map_err(|why| fail(why, Status::Refused))?;
    let report = driver::verify(&problem, &plan);
    ledger.note(|run| run.time_verify = started.elapsed());
    let run = ledger.so_far();
    if output.verbose > 0 {
        let phases = phases::of_check(&run, &report, overseer.elapsed(), peak_rss_mib());
        overseer.aside(|| output.note(&phases));
    }
    Ok(Examined { problem, plan, report, time: run.time_verify })
}

/// A plan from its file: the outer error is the file's, the inner one the plan's.
pub(super) fn read_plan(path: &Path) -> Result<Result<Plan, Diagnostic>, Diagnostic> {
    let bytes = files::read(path)?;
    let name = printable(&files::shown_name(path)).into_owned();
    let refused = |why: &str| plain_error("dosm::plan::malformed", format!("`{name}` is no plan: {why}"));
    let Ok(text) = String::from_utf8(bytes) else { return Ok(Err(refused("it is no UTF-8"))) };
    Ok(plan::json::read(&text).map_err(|e| refused(&e.to_string())))
}

/// Says what came out.
pub fn tell(examined: &Examined, output: &Output) -> Status {
    let (report, time_s) = (&examined.report, examined.time.as_secs_f64());
    let (status, code) =
        if report.holds() { ("checked", Status::Done) } else { ("refused", Status::Refused) };
    let json = JsonVerify { status, same_text: report.same_text, time_s, report: report.to_json() };
    let said = output.say(&printable(&report.to_string()));
    said.and_then(|()| output.json(&json)).err().unwrap_or(code)
}
