//! What the checker found: counts, least margins, failures.

use std::collections::BTreeMap;
use std::fmt;

use crate::exact::Rational;

/// How many failures a report lists; the rest is only counted.
const LISTED_FAILURES: usize = 100;

/// The kinds of check, in the order of the report.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// The plan says that it belongs to the mission.
    Mission,
    /// Names, sizes and indices fit together.
    Form,
    /// The disturbance box holds what the tube's model doesn't explain.
    Tube,
    /// The initial states lie in the tube.
    Start,
    /// States keep their bounds.
    States,
    /// Inputs keep their bounds.
    Inputs,
    /// Positions stay in the workspace.
    Workspace,
    /// Labels of regions are certain.
    Regions,
    /// Chords miss obstacles and jammers.
    Blockers,
    /// Links miss jammers and opaque obstacles, and are short enough.
    Links,
    /// Each robot reaches a base.
    Connectivity,
    /// Robots stay apart.
    Separation,
    /// The goals hold.
    Goals,
    /// The value of the objective is what the plan says.
    Objective,
}

impl Kind {
    /// The kind's name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Mission => "mission",
            Kind::Form => "form",
            Kind::Tube => "tube",
            Kind::Start => "start",
            Kind::States => "states",
            Kind::Inputs => "inputs",
            Kind::Workspace => "workspace",
            Kind::Regions => "regions",
            Kind::Blockers => "blockers",
            Kind::Links => "links",
            Kind::Connectivity => "connectivity",
            Kind::Separation => "separation",
            Kind::Goals => "goals",
            Kind::Objective => "objective",
        }
    }
}

/// The outcome of all checks of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Which.
    pub kind: Kind,
    /// How many claims were checked.
    pub count: usize,
    /// How many of them are false.
    pub failed: usize,
    /// The least margin in SI units, negative where a claim is false; `None` where there is no
    /// natural one. It is rounded; verdicts never depend on it.
    pub margin: Option<f64>,
}

impl Check {
    /// Whether every claim holds.
    pub fn holds(&self) -> bool {
        self.failed == 0
    }
}

/// A claim of the plan that is false or missing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// The kind of the claim.
    pub check: Kind,
    /// Where in the plan.
    pub place: Place,
    /// What is wrong.
    pub message: String,
}

/// What a claim is about; absent parts don't apply.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// The robot's or the link's name.
    pub robot: Option<String>,
    /// The step.
    pub step: Option<usize>,
    /// The name of the region, blocker, goal, dynamics or signal.
    pub subject: Option<String>,
}

impl Place {
    /// A robot.
    pub(super) fn robot(name: &str) -> Place {
        Place { robot: Some(name.to_owned()), ..Place::default() }
    }
    /// A region, blocker, goal, model or signal.
    pub(super) fn subject(name: &str) -> Place {
        Place { subject: Some(name.to_owned()), ..Place::default() }
    }
    /// The same place at a step.
    pub(super) fn at(self, step: usize) -> Place {
        Place { step: Some(step), ..self }
    }
    /// The same place, about something.
    pub(super) fn about(self, name: &str) -> Place {
        Place { subject: Some(name.to_owned()), ..self }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let step = self.step.map(|step| format!("step {step}"));
        let parts: Vec<&str> =
            [&self.robot, &self.subject, &step].into_iter().flatten().map(String::as_str).collect();
        f.write_str(&parts.join(", "))
    }
}

/// What the checker found.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The outcomes, in order; kinds that were not reached are absent.
    pub checks: Vec<Check>,
    /// The first failures.
    pub failures: Vec<Failure>,
    /// Whether the plan was made from the same source text; no part of the verdict.
    pub same_text: bool,
}

impl Report {
    /// Whether every claim holds and every check was reached.
    pub fn holds(&self) -> bool {
        self.failures.is_empty() && self.checks.iter().all(Check::holds) && self.check(Kind::Goals).is_some()
    }

    /// The outcome of one kind, if it was reached.
    pub fn check(&self, kind: Kind) -> Option<&Check> {
        self.checks.iter().find(|c| c.kind == kind)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = self.place.to_string();
        let comma = if place.is_empty() { "" } else { " — " };
        write!(f, "{}: {place}{comma}{}", self.check.name(), self.message)
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for check in &self.checks {
            let verdict = if check.holds() { "ok" } else { "FAILED" };
            write!(f, "{:<14}{verdict:<8}{:>7} checked", check.kind.name(), check.count)?;
            if check.failed > 0 {
                write!(f, ", {} false", check.failed)?;
            }
            if let Some(margin) = check.margin {
                write!(f, ", least margin {margin:.3e}")?;
            }
            writeln!(f)?;
        }
        for failure in &self.failures {
            writeln!(f, "  {failure}")?;
        }
        let failed: usize = self.checks.iter().map(|c| c.failed).sum();
        if failed > self.failures.len() {
            writeln!(f, "  … and {} more", failed - self.failures.len())?;
        }
        if !self.same_text {
            writeln!(f, "note: the plan was made from another version of the mission's text")?;
        }
        write!(f, "{}", if self.holds() { "the plan holds" } else { "the plan does not hold" })
    }
}

/// Where checks note their outcomes.
#[derive(Default)]
pub(super) struct Ledger {
    checks: BTreeMap<Kind, (usize, usize, Option<f64>)>,
    failures: Vec<Failure>,
}

impl Ledger {
    /// Notes that a kind is checked, even when it makes no claim.
    pub(super) fn reach(&mut self, kind: Kind) {
        self.checks.entry(kind).or_default();
    }

    /// Notes a claim; the closure says what it was if it is false.
    pub(super) fn claim(&mut self, kind: Kind, holds: bool, failure: impl FnOnce() -> (Place, String)) {
        let (count, failed, _) = self.checks.entry(kind).or_default();
        *count += 1;
        if holds {
            return;
        }
        *failed += 1;
        if self.failures.len() < LISTED_FAILURES {
            let (place, message) = failure();
            self.failures.push(Failure { check: kind, place, message });
        }
    }

    /// Notes a claim that has just been found false.
    pub(super) fn fail(&mut self, kind: Kind, place: Place, message: String) {
        self.claim(kind, false, || (place, message));
    }

    /// Notes the claim `slack ≥ 0`, with `slack / scale` as its margin.
    pub(super) fn not_negative(
        &mut self,
        kind: Kind,
        slack: &Rational,
        scale: f64,
        failure: impl FnOnce() -> (Place, String),
    ) {
        self.margin(kind, slack, scale);
        self.claim(kind, !slack.is_negative(), failure);
    }

    /// Notes the claim `slack > 0`, with `slack / scale` as its margin.
    pub(super) fn positive(
        &mut self,
        kind: Kind,
        slack: &Rational,
        scale: f64,
        failure: impl FnOnce() -> (Place, String),
    ) {
        self.margin(kind, slack, scale);
        self.claim(kind, slack.is_positive(), failure);
    }

    fn margin(&mut self, kind: Kind, slack: &Rational, scale: f64) {
        let margin = slack.to_f64() / scale;
        if margin.is_finite() {
            let (_, _, least) = self.checks.entry(kind).or_default();
            *least = Some(least.map_or(margin, |l: f64| l.min(margin)));
        }
    }

    pub(super) fn into_report(self, same_text: bool) -> Report {
        let check = |(kind, (count, failed, margin))| Check { kind, count, failed, margin };
        Report { checks: self.checks.into_iter().map(check).collect(), failures: self.failures, same_text }
    }
}
