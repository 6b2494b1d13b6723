//! One diagnostic for each reason why a model has no tube.

use crate::diag::Diagnostic;
use crate::ir::{Model, ModelId, ModelSpans, Problem, Spans};
use crate::source::Span;

use super::Failure;

/// The diagnostic of a failure.
pub(super) fn diagnostic(
    failure: &Failure,
    problem: &Problem,
    id: ModelId,
    spans: &Spans,
    model_spans: &ModelSpans,
) -> Diagnostic {
    let place = Place { model: &problem.models[id], spans: model_spans };
    match failure {
        Failure::Uncontrollable { states } => place.uncontrollable(states),
        Failure::Unbounded => place.unbounded(),
        Failure::WeakInputs { inputs, share, allowed } => place.weak_inputs(inputs, *share, *allowed),
        Failure::NarrowState { state, share } => place.narrow_state(problem, spans, *state, *share),
        Failure::NarrowBounds => place.narrow_bounds(),
        Failure::WiderThanWorkspace { axis, half_width } => {
            place.wider_than_workspace(problem, spans.workspace, *axis, *half_width)
        }
        Failure::Numerics { states } => place.numerics(states),
    }
}

/// A model with its places.
struct Place<'a> {
    model: &'a Model,
    spans: &'a ModelSpans,
}

impl Place<'_> {
    fn state_list(&self, states: &[usize]) -> String {
        names(states.iter().map(|&i| self.model.states[i].name.as_str()))
    }

    /// Labels each disturbance that has a place, the widest relative to what it asks first.
    fn with_disturbances(&self, mut diagnostic: Diagnostic) -> Diagnostic {
        for (i, span) in self.spans.disturbance.iter().enumerate() {
            if let Some(span) = span
                && diagnostic.labels.iter().all(|l| l.span != *span)
            {
                let text = format!("this disturbance of `{}` has to be rejected", self.model.states[i].name);
                diagnostic = diagnostic.with_label(*span, text);
            }
        }
        diagnostic
    }

    fn uncontrollable(&self, states: &[usize]) -> Diagnostic {
        let states = self.state_list(states);
        Diagnostic::error(
            "dosm::tube::uncontrollable",
            format!("`{}` is uncontrollable: its inputs can't bring every error back to 0", self.model.name),
            self.spans.input_matrix,
            format!("together with A, this doesn't reach all of {states}"),
        )
        .with_help("each state that an error can get into must be reachable from the inputs: B, A·B, A²·B, … must have full rank")
    }

    fn unbounded(&self) -> Diagnostic {
        Diagnostic::error(
            "dosm::tube::unbounded",
            format!(
                "the motion of `{}` leaves the range of numbers that can be computed with",
                self.model.name
            ),
            self.spans.name,
            "an input at its bound carries a state beyond 1e300 within a few steps",
        )
        .with_help("check A and B and the bounds of the inputs, or take a shorter `step`")
    }

    fn weak_inputs(&self, inputs: &[usize], share: f64, allowed: f64) -> Diagnostic {
        let list = names(inputs.iter().map(|&k| self.model.inputs[k].name.as_str()));
        let primary = match (self.spans.rejection, inputs.first()) {
            (Some(span), _) if share < 1.0 => {
                (span, format!("{} are kept for the feedback here", percent(allowed)))
            }
            (_, Some(&k)) => {
                let span = self.spans.input_bounds.get(k).copied().unwrap_or(self.spans.name);
                (span, format!("this bound is too narrow for the disturbance ({list})"))
            }
            _ => (self.spans.name, "no input acts on the disturbed states".to_string()),
        };
        let diagnostic = Diagnostic::error(
            "dosm::tube::weak_inputs",
            format!(
                "the inputs of `{}` can't reject its disturbance: the feedback needs {} of their extent and has {}",
                self.model.name,
                percent_up(share),
                percent(allowed)
            ),
            primary.0,
            primary.1,
        );
        self.with_disturbances(diagnostic).with_help(self.what_would_do(inputs, share, allowed))
    }

    fn what_would_do(&self, inputs: &[usize], share: f64, allowed: f64) -> String {
        let mut ways = Vec::new();
        if share < 0.995 {
            ways.push(format!("`rejection {:.2}`", (share * 100.0 + 0.001).ceil() / 100.0));
        }
        let factor = share / allowed;
        if let Some(&k) = inputs.first() {
            let bound = &self.model.input_bounds[k];
            let half = (&bound.hi - &bound.lo).to_f64() / 2.0 * factor;
            let unit = unit_text(&self.model.inputs[k].unit);
            ways.push(format!(
                "a bound of `{}` that is at least {}{unit} wide each way",
                self.model.inputs[k].name,
                three_up(half)
            ));
        }
        ways.push(format!("a disturbance of at most {} of this one", percent(1.0 / factor)));
        format!("any of these would do: {}", ways.join(", "))
    }

    fn narrow_state(&self, problem: &Problem, spans: &Spans, state: usize, share: f64) -> Diagnostic {
        let name = &self.model.states[state].name;
        let axis = self.model.position.iter().position(|&p| p == state);
        let own = self.model.state_bounds[state].as_ref().map(|b| &b.hi - &b.lo);
        if let (None, Some(axis)) = (&own, axis) {
            let (lo, hi) = problem.workspace.bounding_box();
            let half_width = (&hi[axis] - &lo[axis]).to_f64() / 2.0 * share;
            return self.wider_than_workspace(problem, spans.workspace, axis, half_width);
        }
        let half_width = own.map_or(0.0, |w| w.to_f64()) / 2.0 * share;
        let unit = unit_text(&self.model.states[state].unit);
        let span = self.spans.state_bounds.get(state).copied().flatten().unwrap_or(self.spans.name);
        let diagnostic = Diagnostic::error(
            "dosm::tube::wider_than_bound",
            format!("the tube of `{}` is wider than the bound of `{name}`", self.model.name),
            span,
            format!("the error of `{name}` alone needs ±{}{unit}", three_up(half_width)),
        );
        self.with_disturbances(diagnostic).with_help(format!(
            "widen the bound of `{name}` beyond ±{}{unit}, strengthen the inputs, or reduce the disturbance",
            three_up(half_width)
        ))
    }

    fn narrow_bounds(&self) -> Diagnostic {
        let diagnostic = Diagnostic::error(
            "dosm::tube::narrow_bounds",
            format!("the bounds of `{}` together leave no room for a tube", self.model.name),
            self.spans.name,
            "no error feedback stays within all of its bounds",
        );
        self.with_disturbances(diagnostic).with_help(
            "widen the bounds (`bound where` included), raise `rejection`, or reduce the disturbance",
        )
    }

    fn wider_than_workspace(
        &self,
        problem: &Problem,
        span: Span,
        axis: usize,
        half_width: f64,
    ) -> Diagnostic {
        let (lo, hi) = problem.workspace.bounding_box();
        let width = (&hi[axis] - &lo[axis]).to_f64();
        let name = self.model.position.get(axis).map_or("", |&p| self.model.states[p].name.as_str());
        let diagnostic = Diagnostic::error(
            "dosm::tube::wider_than_workspace",
            format!("the tube of `{}` is wider than the workspace", self.model.name),
            self.spans.name,
            format!("`{name}` may be off by ±{} m", three_up(half_width)),
        )
        .with_label(span, format!("the workspace is {width} m wide along this axis"));
        self.with_disturbances(diagnostic)
            .with_help("reduce the disturbance, strengthen the inputs, or enlarge the workspace")
    }

    fn numerics(&self, states: &[usize]) -> Diagnostic {
        let diagnostic = Diagnostic::error(
            "dosm::tube::badly_conditioned",
            format!("`{}` is too badly conditioned for a tube", self.model.name),
            self.spans.input_matrix,
            format!("too large or too small entries for {}", self.state_list(states)),
        );
        self.with_disturbances(diagnostic).with_help(
            "rounding errors, as A and B magnify them, are no longer small: check A, B and their units, or take a shorter `step`",
        )
    }
}

/// `a`, `b` and `c`.
fn names<'a>(list: impl Iterator<Item = &'a str>) -> String {
    let quoted: Vec<String> = list.map(|name| format!("`{name}`")).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        Some((last, _)) => last.clone(),
        None => "its states".to_string(),
    }
}

fn unit_text(unit: &str) -> String {
    if unit == "1" { String::new() } else { format!(" {unit}") }
}

/// A share in per cent, rounded down so that it may be relied on.
fn percent(share: f64) -> String {
    format!("{} %", three_down(share * 100.0))
}

fn percent_up(share: f64) -> String {
    format!("{} %", three_up(share * 100.0))
}

/// A positive number with three significant digits, rounded up.
fn three_up(x: f64) -> String {
    three_digits(x, f64::ceil)
}

fn three_down(x: f64) -> String {
    three_digits(x, f64::floor)
}

fn three_digits(x: f64, round: fn(f64) -> f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    // The first digits as they print decide the place: no logarithm, hence the same everywhere.
    let exponent: i32 = format!("{x:e}").rsplit('e').next().and_then(|e| e.parse().ok()).unwrap_or(0);
    let places = 2 - exponent;
    let scaled = if places >= 0 { x * 10f64.powi(places) } else { x / 10f64.powi(-places) };
    let nearest = scaled.round();
    let scaled = if (scaled - nearest).abs() < 1e-9 * scaled.abs() { nearest } else { round(scaled) };
    let value = if places >= 0 { scaled / 10f64.powi(places) } else { scaled * 10f64.powi(-places) };
    value.to_string()
}
