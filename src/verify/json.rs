//! Reports for programs.

use serde::Serialize;

use super::report::{Check, Failure, Report};

/// What the independent checker found.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct JsonReport {
    /// Whether every claim holds and every check was reached.
    pub holds: bool,
    /// Whether the plan was made from the same source text; no part of the verdict.
    pub same_text: bool,
    /// The outcomes by kind, in order; kinds that were not reached are absent.
    pub checks: Vec<JsonCheck>,
    /// The first failures.
    pub failures: Vec<JsonFailure>,
}

/// The outcome of all checks of one kind.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "KindOfCheck"))]
pub struct JsonCheck {
    /// The kind: `mission`, `form`, `tube`, `start`, `states`, `inputs`, `workspace`, `regions`,
    /// `blockers`, `links`, `connectivity`, `separation`, `goals` or `objective`.
    pub name: &'static str,
    /// Whether every claim holds.
    pub holds: bool,
    /// How many claims were checked.
    pub count: usize,
    /// How many of them are false.
    pub failed: usize,
    /// The least margin in SI units, negative where a claim is false; `null` where there is no
    /// natural one. It is rounded; verdicts never depend on it.
    pub margin: Option<f64>,
}

/// A claim of the plan that is false or missing.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "FailedClaim"))]
pub struct JsonFailure {
    /// The kind of the claim.
    pub check: &'static str,
    /// The robot's or the link's name.
    pub robot: Option<String>,
    /// The name of the region, blocker, goal, dynamics or signal.
    pub subject: Option<String>,
    /// The step.
    pub step: Option<usize>,
    /// What is wrong.
    pub message: String,
}

impl Report {
    /// The report for programs.
    pub fn to_json(&self) -> JsonReport {
        JsonReport {
            holds: self.holds(),
            same_text: self.same_text,
            checks: self.checks.iter().map(check).collect(),
            failures: self.failures.iter().map(failure).collect(),
        }
    }
}

fn check(check: &Check) -> JsonCheck {
    JsonCheck {
        name: check.kind.name(),
        holds: check.holds(),
        count: check.count,
        failed: check.failed,
        margin: check.margin,
    }
}

fn failure(failure: &Failure) -> JsonFailure {
    JsonFailure {
        check: failure.check.name(),
        robot: failure.place.robot.clone(),
        subject: failure.place.subject.clone(),
        step: failure.place.step,
        message: failure.message.clone(),
    }
}
