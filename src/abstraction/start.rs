//! What can be told before any search: starts with their tubes, and regions that the tube empties.
//!
//! All comparisons are exact, on the tube's doubles as they stand, with z_0 = x̄_0: what passes
//! here passes the checker's tests of step 0.

use crate::diag::{Diagnostic, Diagnostics, Reported};
use crate::entity::EntityId;
use crate::exact::Rational;
use crate::geometry::Polytope;
use crate::ir::{Blocker, BlockerKind, Model, Piece, Problem, Robot, RobotId, Spans};
use crate::source::Span;
use crate::tube::Tubes;

use super::ErrorSet;
use super::error_set::meets;
use super::narrow_region;

/// Reports what is wrong at step 0 and which goals the tubes make impossible by themselves.
///
/// # Errors
/// [`Reported`] when there was anything to report.
pub fn inspect(
    problem: &Problem,
    spans: &Spans,
    tubes: &Tubes,
    diagnostics: &mut Diagnostics,
) -> Result<(), Reported> {
    let mut found: Vec<Diagnostic> = Vec::new();
    let sets: Vec<Option<ErrorSet>> = problem
        .models
        .iter()
        .map(|(id, model)| tubes.get(id).and_then(|t| ErrorSet::new(model, t)))
        .collect();
    let starts: Vec<Option<Start<'_>>> =
        problem.robots.iter().map(|(id, robot)| Start::new(problem, spans, &sets, id, robot)).collect();
    let boxes: Vec<Vec<Bounds>> =
        problem.blockers.values().map(|b| b.shape.pieces.iter().map(piece_bounds).collect()).collect();
    for start in starts.iter().flatten() {
        start.inspect(problem, spans, &boxes, &mut found);
    }
    inspect_pairs(problem, spans, &starts, &mut found);
    narrow_region::inspect(problem, spans, &sets, &mut found);
    let reported = found.into_iter().map(|d| diagnostics.report(d)).last();
    reported.map_or(Ok(()), Err)
}

/// A robot where it starts, with everything that it can be by its error.
struct Start<'a> {
    robot: &'a Robot,
    model: &'a Model,
    errors: &'a ErrorSet,
    span: Span,
    /// x̄_0, position part.
    at: Vec<Rational>,
    /// x̄_0 ⊕ Ω, position part.
    positions: Polytope,
    /// The corners of its bounding box.
    corners: (Vec<Rational>, Vec<Rational>),
}

impl<'a> Start<'a> {
    fn new(
        problem: &'a Problem,
        spans: &Spans,
        sets: &'a [Option<ErrorSet>],
        id: RobotId,
        robot: &'a Robot,
    ) -> Option<Start<'a>> {
        let errors = sets.get(robot.model.index())?.as_ref()?;
        let model = problem.models.get(robot.model)?;
        let at: Vec<Rational> = model.position.iter().map(|&i| robot.start[i].clone()).collect();
        let span = spans.robots.get(id.index()).copied().unwrap_or_default();
        let positions = errors.positions().translate(&at);
        Some(Start { robot, model, errors, span, at, corners: positions.bounding_box(), positions })
    }

    fn inspect(&self, problem: &Problem, spans: &Spans, boxes: &[Vec<Bounds>], found: &mut Vec<Diagnostic>) {
        if !self.positions.is_inside(&problem.workspace) {
            found.push(self.outside_workspace(&problem.workspace, spans.workspace));
        }
        self.inspect_bounds(spans, found);
        let own = bounds(&self.corners);
        for ((id, blocker), boxes) in problem.blockers.iter().zip(boxes) {
            let mut pieces = blocker.shape.pieces.iter().zip(boxes);
            if pieces.any(|(piece, around)| overlap(&own, around) && meets(&self.positions, piece)) {
                let span = spans.blockers.get(id.index()).copied().unwrap_or_default();
                found.push(self.in_blocker(blocker, span));
            }
        }
    }

    /// 𝒳's bounds; those that involve inputs are the plan's business.
    fn inspect_bounds(&self, spans: &Spans, found: &mut Vec<Diagnostic>) {
        let n = self.model.n();
        for (i, bound) in self.model.state_bounds.iter().enumerate() {
            let Some(bound) = bound else { continue };
            let mut direction = vec![Rational::ZERO; n];
            direction[i] = Rational::ONE;
            let above = &self.robot.start[i] + self.errors.support(&direction);
            direction[i] = Rational::from(-1);
            let below = &self.robot.start[i] - self.errors.support(&direction);
            if above > bound.hi || below < bound.lo {
                found.push(self.outside_bound(spans, i, &above, &below));
            }
        }
        for row in &self.model.mixed_bounds {
            let (states, inputs) = row.normal.split_at(n);
            let value = crate::exact::dot(states, &self.robot.start) + self.errors.support(states);
            if inputs.iter().all(Rational::is_zero) && value > row.offset {
                found.push(self.outside_general_bound());
            }
        }
    }

    /// `±0.3 m, ±0.3 m`
    fn widths(&self) -> String {
        let width = |axis: usize| format!("±{} m", short(&self.errors.half_width(axis)));
        (0..self.positions.dimension()).map(width).collect::<Vec<_>>().join(", ")
    }

    fn outside_workspace(&self, workspace: &Polytope, span: Span) -> Diagnostic {
        let name = &self.robot.name;
        let (message, label, help) = if workspace.contains(&self.at) {
            (
                format!("`{name}` may be outside the workspace at its start"),
                format!("with its tube ({}) it reaches over the edge", self.widths()),
                format!("start `{name}` further inside, or reduce the disturbance of `{}`", self.model.name),
            )
        } else {
            (
                format!("`{name}` starts outside the workspace"),
                format!("outside, even without its tube ({})", self.widths()),
                format!("start `{name}` inside, with room for its tube"),
            )
        };
        Diagnostic::error("dosm::abstraction::start_outside_workspace", message, self.span, label)
            .with_label(span, "the workspace")
            .with_help(help)
    }

    fn outside_bound(&self, spans: &Spans, state: usize, above: &Rational, below: &Rational) -> Diagnostic {
        let name = &self.model.states[state].name;
        let bound =
            spans.models.get(self.robot.model.index()).and_then(|m| m.state_bounds.get(state)?.as_ref());
        let diagnostic = Diagnostic::error(
            "dosm::abstraction::start_outside_bound",
            format!("`{}` may break the bound of `{name}` at its start", self.robot.name),
            self.span,
            format!("with the tube, `{name}` lies anywhere from {} to {}", short_below(below), short(above)),
        );
        let diagnostic = match bound {
            Some(span) => diagnostic.with_label(*span, "the bound"),
            None => diagnostic,
        };
        diagnostic.with_help("start further inside the bound, or reduce the disturbance")
    }

    fn outside_general_bound(&self) -> Diagnostic {
        Diagnostic::error(
            "dosm::abstraction::start_outside_bound",
            format!("`{}` may break a bound of `{}` at its start", self.robot.name, self.model.name),
            self.span,
            "with its tube, this start doesn't satisfy each inequality of `bound where`",
        )
        .with_help("start further inside the bounds, or reduce the disturbance")
    }

    fn in_blocker(&self, blocker: &Blocker, span: Span) -> Diagnostic {
        let (code, what) = match blocker.kind {
            BlockerKind::Jammer => ("dosm::abstraction::start_in_jammer", "jammer"),
            _ => ("dosm::abstraction::start_in_obstacle", "obstacle"),
        };
        let (name, other) = (&self.robot.name, &blocker.name);
        let (message, label) = if blocker.shape.pieces.iter().any(|piece| piece.contains(&self.at)) {
            (
                format!("`{name}` starts in the {what} `{other}`"),
                format!("inside `{other}`, even without its tube ({})", self.widths()),
            )
        } else {
            (
                format!("`{name}` may be in the {what} `{other}` at its start"),
                format!("with its tube ({}) it touches `{other}`", self.widths()),
            )
        };
        let help = format!("start `{name}` further away from `{other}`");
        Diagnostic::error(code, message, self.span, label)
            .with_label(span, format!("the {what}"))
            .with_help(help)
    }

    /// The greatest gap along any axis that is certain between two robots; negative when none is.
    fn certain_gap(&self, other: &Start<'_>) -> Rational {
        let ((lo, hi), (other_lo, other_hi)) = (&self.corners, &other.corners);
        let along = |i: usize| {
            let (left, right) = (&lo[i] - &other_hi[i], &other_lo[i] - &hi[i]);
            Rational::max_of(&left, &right).clone()
        };
        (0..lo.len()).map(along).max().unwrap_or(Rational::ZERO)
    }
}

/// A box in doubles, rounded outwards: most blockers are told to be far away without exact numbers.
type Bounds = Vec<(f64, f64)>;

fn bounds((lo, hi): &(Vec<Rational>, Vec<Rational>)) -> Bounds {
    lo.iter().zip(hi).map(|(l, h)| (l.to_f64_down(), h.to_f64_up())).collect()
}

fn piece_bounds(piece: &Piece) -> Bounds {
    match piece {
        Piece::Polytope(polytope) => bounds(&polytope.bounding_box()),
        Piece::Ball { center, spread, radius } => {
            let reach = |s: &Rational| s + radius;
            let lo = center.iter().zip(spread).map(|(c, s)| c - reach(s)).collect();
            bounds(&(lo, center.iter().zip(spread).map(|(c, s)| c + reach(s)).collect()))
        }
    }
}

fn overlap(a: &Bounds, b: &Bounds) -> bool {
    a.iter().zip(b).all(|((lo, hi), (other_lo, other_hi))| lo <= other_hi && other_lo <= hi)
}

fn inspect_pairs(
    problem: &Problem,
    spans: &Spans,
    starts: &[Option<Start<'_>>],
    found: &mut Vec<Diagnostic>,
) {
    let Some(separation) = &problem.separation else { return };
    let starts: Vec<&Start<'_>> = starts.iter().flatten().collect();
    for (first, second) in close_pairs(&starts, separation) {
        let (first, second) = (starts[first], starts[second]);
        let gap = first.certain_gap(second);
        found.push(too_close(first, second, &gap, separation, spans.separation));
    }
}

/// The pairs of starts that are too close, in order: the first [`MOST_PAIRS`] from one end of the
/// mission to the other. Only neighbours along the axis that spreads the starts most are compared.
fn close_pairs(starts: &[&Start<'_>], separation: &Rational) -> Vec<(usize, usize)> {
    let lo = |i: usize, axis: usize| &starts[i].corners.0[axis];
    let extent = |axis: usize| {
        let all = || (0..starts.len()).map(|i| lo(i, axis));
        all().max().zip(all().min()).map(|(max, min)| max - min)
    };
    let dimension = starts.first().map_or(0, |start| start.at.len());
    let Some(axis) = (0..dimension).max_by_key(|&axis| extent(axis)) else { return Vec::new() };
    let mut order: Vec<usize> = (0..starts.len()).collect();
    order.sort_by(|&i, &j| lo(i, axis).cmp(lo(j, axis)));
    let mut pairs = Vec::new();
    for (place, &i) in order.iter().enumerate() {
        let end = &starts[i].corners.1[axis] + separation;
        let near = order[place + 1..].iter().take_while(|&&j| *lo(j, axis) < end);
        let close = near.filter(|&&j| starts[i].certain_gap(starts[j]) < *separation);
        pairs.extend(close.take(MOST_PAIRS - pairs.len()).map(|&j| (i.min(j), i.max(j))));
        if pairs.len() == MOST_PAIRS {
            break;
        }
    }
    pairs.sort_unstable();
    pairs
}

/// So many pairs of starts that are too close are told: nobody reads more, and a family that starts in
/// one place has millions.
const MOST_PAIRS: usize = 100;

fn too_close(
    first: &Start<'_>,
    second: &Start<'_>,
    gap: &Rational,
    separation: &Rational,
    span: Option<Span>,
) -> Diagnostic {
    let certain = if gap.is_negative() { "nothing".to_string() } else { format!("{} m", short(gap)) };
    let diagnostic = Diagnostic::error(
        "dosm::abstraction::starts_too_close",
        format!(
            "`{}` and `{}` start closer together than the separation",
            first.robot.name, second.robot.name
        ),
        second.span,
        format!("with both tubes, {certain} is certain along any axis"),
    )
    .with_label(first.span, format!("the start of `{}`", first.robot.name));
    let diagnostic = match span {
        Some(span) => diagnostic.with_label(span, format!("{} m are asked for", short(separation))),
        None => diagnostic,
    };
    let missing = short(&(separation - gap));
    diagnostic.with_help(format!("move them apart by another {missing} m along one axis"))
}

/// A number for people: four digits behind the point or so, rounded up.
pub(super) fn short(x: &Rational) -> String {
    of_ten_thousandths(x, (x * Rational::from(10_000)).ceil())
}

/// As [`short`], rounded down.
fn short_below(x: &Rational) -> String {
    of_ten_thousandths(x, (x * Rational::from(10_000)).floor())
}

fn of_ten_thousandths(x: &Rational, rounded: Rational) -> String {
    let rounded = rounded / Rational::from(10_000);
    if x.is_integer() || rounded.is_zero() { format!("{}", x.to_f64()) } else { rounded.to_string() }
}

#[cfg(test)]
mod tests;
