//! What is wrong with shapes and where they lie.

use crate::check::shapes::error_point;
use crate::check::typed::Blocker;
use crate::diag::{Diagnostic, Edit};
use crate::exact::Rational;
use crate::geometry::ShapeError;
use crate::ir::BlockerKind;
use crate::source::Span;
use crate::syntax::ast::{Comparison, Inequality, Point};

pub(in crate::check) fn missing_workspace(span: Span) -> Diagnostic {
    let end = Span { start: span.end, end: span.end };
    Diagnostic::error("dosm::check::missing_workspace", "the mission has no workspace", end, "missing")
        .with_help("add one, such as `workspace box (0, 0) .. (12, 12)`")
        .perhaps_by(
            "add `workspace box (0, 0) .. (12, 12)`",
            vec![Edit::AtEnd("workspace box (0, 0) .. (12, 12)".into())],
        )
}

pub(in crate::check) fn workspace_union(span: Span) -> Diagnostic {
    let message = "the workspace is one convex shape, not a union";
    Diagnostic::error("dosm::check::bad_workspace", message, span, "a union")
        .with_help("declare the smallest convex shape around it and obstacles for the rest")
}

pub(in crate::check) fn round_workspace(span: Span) -> Diagnostic {
    let message = "the workspace is a polytope, not a round shape";
    Diagnostic::error("dosm::check::bad_workspace", message, span, "not a polytope")
}

pub(in crate::check) fn wrong_point_dimension(span: Span, found: usize, wanted: usize) -> Diagnostic {
    let message = format!(
        "a point with {found} coordinate{} in a workspace of {wanted} dimensions",
        super::plural(found)
    );
    Diagnostic::error("dosm::check::wrong_point", message, span, format!("{wanted} coordinates are needed"))
}

pub(in crate::check) fn polygon_in_space(span: Span) -> Diagnostic {
    Diagnostic::error(
        "dosm::check::wrong_point",
        "a polygon lies in the plane",
        span,
        "the workspace has 3 dimensions",
    )
    .with_help("use `hull` in space")
    .perhaps_by("write `hull`", first_word(span, "polygon", "hull"))
}

pub(in crate::check) fn disc_in_space(span: Span) -> Diagnostic {
    let message = "a disc lies in the plane";
    Diagnostic::error("dosm::check::wrong_point", message, span, "the workspace has 3 dimensions")
        .with_help("write `ball … radius … norm 2` in space")
}

/// The word that a piece begins with, exchanged.
fn first_word(piece: Span, word: &str, other: &str) -> Vec<Edit> {
    let end = piece.end.min(piece.start + word.len() as u32);
    vec![Edit::Replace(Span { end, ..piece }, other.into())]
}

pub(in crate::check) fn misplaced_uncertainty(span: Span) -> Diagnostic {
    let message = "only a ball's centre and radius may be uncertain";
    Diagnostic::error("dosm::check::misplaced_uncertainty", message, span, "not here")
}

pub(in crate::check) fn nothing_sure(span: Span) -> Diagnostic {
    let message = "no point is certain to be in the workspace";
    Diagnostic::error("dosm::check::empty_shape", message, span, "so uncertain that nothing is left")
        .with_help("make the ball larger, or its uncertainty smaller")
}

pub(in crate::check) fn negative_uncertainty(span: Span) -> Diagnostic {
    Diagnostic::error(
        "dosm::check::negative_uncertainty",
        "an uncertainty is not negative",
        span,
        "of this ball",
    )
}

pub(in crate::check) fn bad_radius(span: Span, radius: &Rational) -> Diagnostic {
    let message = format!("a ball's radius is above 0, not {} m", super::shown(radius));
    Diagnostic::error("dosm::check::flat_shape", message, span, "not positive")
}

pub(in crate::check) fn unknown_norm(span: Span, norm: &Rational) -> Diagnostic {
    let message = format!("there is no ball of norm {}", super::shown(norm));
    Diagnostic::error("dosm::check::unknown_norm", message, span, "1 or 2, or none for the ∞-norm")
        .perhaps_by("write `norm 2`", vec![Edit::Replace(span, "2".into())])
}

pub(in crate::check) fn unknown_range_norm(span: Span, norm: &Rational) -> Diagnostic {
    let message = format!("links have no length in norm {}", super::shown(norm));
    Diagnostic::error("dosm::check::unknown_norm", message, span, "2, or none for the ∞-norm")
        .perhaps_by("write `norm 2`", vec![Edit::Replace(span, "2".into())])
        .with_help("`range 6 m` is along each axis, `range 6 m norm 2` as the crow flies")
}

pub(in crate::check) fn too_many_parts(span: Span, found: usize, most: usize) -> Diagnostic {
    let message = format!("{found} are too many: at most {most} are allowed");
    Diagnostic::error("dosm::check::too_many_parts", message, span, "too many")
}

pub(in crate::check) fn flat_shape(span: Span, reason: &str) -> Diagnostic {
    Diagnostic::error(
        "dosm::check::flat_shape",
        format!("the shape is flat: {reason}"),
        span,
        "has no interior",
    )
}

pub(in crate::check) fn box_corners_swapped(
    (first, second): (&Point, &Point),
    p: &[Rational],
    q: &[Rational],
) -> Diagnostic {
    let point = |pick: fn(&Rational, &Rational) -> bool| {
        let list = p.iter().zip(q).map(|(a, b)| super::shown(if pick(a, b) { a } else { b }));
        format!("({})", list.collect::<Vec<_>>().join(", "))
    };
    let help = format!("write `box {} .. {}`", point(|a, b| a < b), point(|a, b| a > b));
    // Coordinate by coordinate, as they are written: they may depend on an index.
    let pairs = first.coordinates.iter().zip(&second.coordinates).zip(p.iter().zip(q));
    let swapped = pairs.filter(|(_, (a, b))| a > b).map(|((a, b), _)| (a.value.span, b.value.span));
    let edits = swapped.map(|(a, b)| Edit::Swap(a, b)).collect();
    Diagnostic::error(
        "dosm::check::box_corners_swapped",
        "the box's corners are swapped",
        first.span,
        "below the second corner in each coordinate, please",
    )
    .with_label(second.span, "the second corner")
    .with_help(help)
    .mended_by("swap the coordinates", edits)
}

/// Why points make no polygon, hull or ball.
pub(in crate::check) fn bad_points(
    shape: &str,
    span: Span,
    points: &[Point],
    error: &ShapeError,
) -> Diagnostic {
    let at = error_point(error).and_then(|index| points.get(index)).map_or(span, |p| p.span);
    let in_space = points.first().is_some_and(|p| p.coordinates.len() > 2);
    match error {
        ShapeError::NotConvex { .. } => Diagnostic::error(
            "dosm::check::not_convex",
            format!("the {shape} is not convex"),
            at,
            "the outline turns the wrong way here",
        )
        .with_label(span, format!("this {shape}"))
        .with_help("cut it into convex pieces joined by `or`, or use `hull`")
        .perhaps_by("write `hull`, which fills the dent", first_word(span, shape, "hull")),
        ShapeError::Duplicate { first, .. } => Diagnostic::error(
            "dosm::check::duplicate_point",
            format!("the {shape} has the same corner twice"),
            at,
            "again",
        )
        .with_label(points.get(*first).map_or(span, |p| p.span), "first here"),
        ShapeError::TooFewPoints => {
            let message = format!("the {shape} has too few corners");
            let least = if in_space { "at least four different ones" } else { "at least three" };
            Diagnostic::error("dosm::check::flat_shape", message, span, format!("{least} are needed"))
        }
        _ if in_space => flat_shape(span, "all its points lie on one plane"),
        _ => flat_shape(span, "all its points lie on one line"),
    }
}

/// Why half-spaces make no shape.
pub(in crate::check) fn bad_half_spaces(
    span: Span,
    inequalities: &[Inequality],
    error: &ShapeError,
) -> Diagnostic {
    match error {
        ShapeError::Empty => {
            let message = "no point satisfies all these inequalities";
            Diagnostic::error("dosm::check::empty_shape", message, span, "empty")
        }
        ShapeError::Unbounded { direction } => {
            let list: Vec<String> = direction.iter().map(super::shown).collect();
            let message = format!("the shape goes on for ever in the direction ({})", list.join(", "));
            Diagnostic::error("dosm::check::unbounded_shape", message, span, "not bounded")
                .with_help("add an inequality that ends it there")
        }
        ShapeError::ZeroNormal { index } => no_coordinate(inequalities.get(*index).map_or(span, |i| i.span)),
        ShapeError::TooMany { most } => too_many_parts(span, inequalities.len(), *most),
        _ => flat_shape(span, "it has no width"),
    }
}

pub(in crate::check) fn no_coordinate(span: Span) -> Diagnostic {
    let message = "the inequality has no coordinate in it";
    Diagnostic::error("dosm::check::no_coordinate", message, span, "always or never true")
}

pub(in crate::check) fn open_inequality(span: Span, op: Comparison) -> Diagnostic {
    let message = "shapes are closed sets: only `<=` and `>=` make a half-space";
    let diagnostic =
        Diagnostic::error("dosm::check::open_inequality", message, span, "not a closed half-space");
    match op {
        Comparison::Less => diagnostic.with_help("write `<=`").meant(span, "<="),
        Comparison::Greater => diagnostic.with_help("write `>=`").meant(span, ">="),
        _ => diagnostic.with_help("two inequalities with some room between them make a strip"),
    }
}

fn outside(code: &'static str, message: String, span: Span, workspace: Span) -> Diagnostic {
    Diagnostic::error(code, message, span, "outside").with_label(workspace, "the workspace")
}

pub(in crate::check) fn region_outside(name: &str, span: Span, workspace: Span) -> Diagnostic {
    let message = format!("the region `{name}` lies outside the workspace");
    outside("dosm::check::region_outside", message, span, workspace)
}

pub(in crate::check) fn blocker_outside(blocker: &Blocker, workspace: Span) -> Diagnostic {
    let message = format!("the {} `{}` lies outside the workspace", blocker_noun(blocker), blocker.name);
    let diagnostic = outside("dosm::check::blocker_outside", message, blocker.span, workspace);
    Diagnostic { severity: crate::diag::Severity::Warning, ..diagnostic }
}

pub(in crate::check) fn base_outside(name: &str, span: Span, workspace: Span) -> Diagnostic {
    let message = format!("the base `{name}` lies outside the workspace");
    outside("dosm::check::base_outside", message, span, workspace)
}

pub(in crate::check) fn base_in_blocker(name: &str, span: Span, blocker: &Blocker) -> Diagnostic {
    let noun = blocker_noun(blocker);
    let message = format!("the base `{name}` lies in the {noun} `{}`: nothing can reach it", blocker.name);
    Diagnostic::error("dosm::check::base_in_blocker", message, span, "the base")
        .with_label(blocker.span, format!("the {noun}"))
}

fn blocker_noun(blocker: &Blocker) -> &'static str {
    match blocker.kind {
        BlockerKind::Obstacle => "obstacle",
        BlockerKind::OpaqueObstacle => "opaque obstacle",
        BlockerKind::Jammer => "jammer",
    }
}
