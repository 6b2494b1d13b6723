//! What stands still: workspace, regions, obstacles, jammers, bases.

use super::canvas::{Canvas, Pixel, escape, px};
use crate::exact::Rational;
use crate::ir::{BlockerKind, Piece, Problem, Shape};

/// Draws all of it.
pub fn draw(canvas: &mut Canvas, problem: &Problem) {
    for region in problem.regions.values() {
        shape(canvas, &region.shape, "region", &region.name);
    }
    for blocker in problem.blockers.values() {
        shape(canvas, &blocker.shape, class(blocker.kind), &blocker.name);
    }
    let corners = outline(canvas, &problem.workspace.vertices);
    canvas.add(&format!(r#"<path class="frame" d="{}"/>"#, closed(&corners)));
    for base in problem.bases.values() {
        let at = canvas.pixel(&doubles(&base.position));
        mast(canvas, at);
    }
}

/// Writes the names of all of it.
pub fn draw_names(canvas: &mut Canvas, problem: &Problem) {
    for region in problem.regions.values() {
        name(canvas, &region.shape, "mid in-region", &region.name);
    }
    for blocker in problem.blockers.values() {
        let color = if blocker.kind == BlockerKind::Jammer { "mid in-jammer" } else { "mid" };
        name(canvas, &blocker.shape, color, &blocker.name);
    }
    for base in problem.bases.values() {
        let at = canvas.pixel(&doubles(&base.position));
        canvas.name((at.0, at.1 + 22.0), "mid", &base.name);
    }
}

/// The style of a blocker.
pub fn class(kind: BlockerKind) -> &'static str {
    match kind {
        BlockerKind::Jammer => "jammer",
        BlockerKind::Obstacle => "obstacle",
        BlockerKind::OpaqueObstacle => "opaque",
    }
}

/// A base station's mark.
pub fn mast(canvas: &mut Canvas, at: Pixel) {
    let corners = [(at.0, at.1 - 9.0), (at.0 + 8.0, at.1 + 7.0), (at.0 - 8.0, at.1 + 7.0)];
    canvas.add(&format!(r#"<path class="base" d="{}"/>"#, closed(&corners)));
}

fn shape(canvas: &mut Canvas, shape: &Shape, class: &str, name: &str) {
    for piece in &shape.pieces {
        let element = match piece {
            Piece::Polytope(polytope) => {
                let corners = outline(canvas, &polytope.vertices);
                format!(r#"<path class="{class}" d="{}">"#, closed(&corners))
            }
            Piece::Ball { center, spread, radius } => rounded_box(canvas, class, center, spread, radius),
        };
        let tag = if element.starts_with("<path") { "path" } else { "rect" };
        canvas.add(&format!("{element}<title>{}</title></{tag}>", escape(name)));
    }
}

/// box(center ± spread) ⊕ ball₂(radius), seen from above.
fn rounded_box(
    canvas: &Canvas,
    class: &str,
    center: &[Rational],
    spread: &[Rational],
    radius: &Rational,
) -> String {
    let (center, spread, radius) = (doubles(center), doubles(spread), radius.to_f64());
    let half = |axis: usize| canvas.length(spread.get(axis).copied().unwrap_or(0.0) + radius);
    let (x, y) = canvas.pixel(&center);
    let (left, top) = (px(x - half(0)), px(y - half(1)));
    let (width, height, round) = (px(2.0 * half(0)), px(2.0 * half(1)), px(canvas.length(radius)));
    format!(
        r#"<rect class="{class}" x="{left}" y="{top}" width="{width}" height="{height}" rx="{round}" ry="{round}">"#
    )
}

/// Writes a shape's name in the middle of its first piece.
fn name(canvas: &mut Canvas, shape: &Shape, class: &str, name: &str) {
    let middle = match shape.pieces.first() {
        Some(Piece::Polytope(polytope)) => {
            let corners = outline(canvas, &polytope.vertices);
            let count = corners.len().max(1) as f64;
            (
                corners.iter().map(|c| c.0).sum::<f64>() / count,
                corners.iter().map(|c| c.1).sum::<f64>() / count,
            )
        }
        Some(Piece::Ball { center, .. }) => canvas.pixel(&doubles(center)),
        None => return,
    };
    canvas.name((middle.0, middle.1 + 4.0), class, name);
}

/// The convex outline of points seen from above, in pixels.
fn outline(canvas: &Canvas, vertices: &[Vec<Rational>]) -> Vec<Pixel> {
    let mut points: Vec<Pixel> = vertices.iter().map(|v| canvas.pixel(&doubles(v))).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let lower = half_outline(points.iter());
    let upper = half_outline(points.iter().rev());
    lower.into_iter().chain(upper).collect()
}

/// One side of the outline of sorted points, its last point left out (Andrew's monotone chain).
fn half_outline<'a>(points: impl Iterator<Item = &'a Pixel>) -> Vec<Pixel> {
    let mut chain: Vec<Pixel> = Vec::new();
    for &p in points {
        while let [.., a, b] = chain[..]
            && (b.0 - a.0) * (p.1 - a.1) <= (b.1 - a.1) * (p.0 - a.0)
        {
            chain.pop();
        }
        chain.push(p);
    }
    chain.pop();
    chain
}

/// A closed path through points.
pub fn closed(points: &[Pixel]) -> String {
    let at: Vec<String> = points.iter().map(|p| format!("{} {}", px(p.0), px(p.1))).collect();
    format!("M{}Z", at.join("L"))
}

/// Exact numbers as doubles, for drawing only.
fn doubles(numbers: &[Rational]) -> Vec<f64> {
    numbers.iter().map(Rational::to_f64).collect()
}
