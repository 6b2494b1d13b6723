//! Title and legend.

use super::canvas::{Canvas, Pixel, px};
use super::{links, shapes, ways};
use crate::ir::{BlockerKind, Problem};
use crate::plan::Plan;

/// The most robots listed by name.
const MOST_LISTED: usize = 24;
/// Pixels a row.
const ROW: f64 = 22.0;
/// The longest name that fits beside a mark, in characters.
const LONGEST: usize = 28;

/// How high the picture has to be for its legend.
pub fn height(problem: &Problem) -> f64 {
    100.0 + ROW * (rows(problem) as f64 + 10.0)
}

fn rows(problem: &Problem) -> usize {
    problem.robots.len().min(MOST_LISTED + 1)
}

/// Draws the title above and the legend to the right.
pub fn draw(canvas: &mut Canvas, problem: &Problem, plan: &Plan) {
    let (x, y) = canvas.legend_corner();
    canvas.text((52.0, 30.0), "title", &problem.name);
    let view = if problem.dimension > 2 { ", seen from above" } else { "" };
    canvas.text((52.0, 50.0), "sub", &(plan.summary() + view));
    let mut at = (x, y + 8.0);
    heading(canvas, &mut at, "ROBOTS");
    for (index, robot) in plan.robots.iter().take(MOST_LISTED).enumerate() {
        swatch_line(canvas, at, ways::color(index), "2.4", "");
        row(canvas, &mut at, &robot.name);
    }
    if plan.robots.len() > MOST_LISTED {
        row(canvas, &mut at, &format!("and {} more", plan.robots.len() - MOST_LISTED));
    }
    at.1 += ROW / 2.0;
    heading(canvas, &mut at, "MARKS");
    swatch_line(canvas, at, "#57606a", "1.8", r#" stroke-dasharray="2 5" stroke-linecap="round""#);
    row(canvas, &mut at, "before the loop");
    swatch_line(canvas, at, "#57606a", "2.4", "");
    row(canvas, &mut at, "the loop, for ever");
    canvas.add(&format!(
        r##"<rect x="{}" y="{}" width="14" height="14" fill="#57606a" fill-opacity=".10" stroke="#57606a" stroke-opacity=".45"/>"##,
        px(at.0 + 5.0),
        px(at.1 - 11.0)
    ));
    row(canvas, &mut at, "where it can be at a step");
    if !links::at_last_step(plan).is_empty() {
        let (x, y) = (px(at.0), px(at.1 - 4.0));
        canvas.add(&format!(r#"<path class="link" d="M{x} {y}h24"/>"#));
        row(canvas, &mut at, &format!("radio links at step {}", plan.length));
    }
    still(canvas, &mut at, problem);
}

/// The marks of what stands still, as far as the mission has it.
fn still(canvas: &mut Canvas, at: &mut Pixel, problem: &Problem) {
    if !problem.bases.is_empty() {
        shapes::mast(canvas, (at.0 + 12.0, at.1 - 4.0));
        row(canvas, at, "base");
    }
    if !problem.regions.is_empty() {
        swatch_box(canvas, *at, "region");
        row(canvas, at, "region");
    }
    for (kind, text) in [
        (BlockerKind::Jammer, "jammer"),
        (BlockerKind::Obstacle, "obstacle"),
        (BlockerKind::OpaqueObstacle, "opaque obstacle"),
    ] {
        if problem.blockers.values().any(|b| b.kind == kind) {
            swatch_box(canvas, *at, shapes::class(kind));
            row(canvas, at, text);
        }
    }
}

fn heading(canvas: &mut Canvas, at: &mut Pixel, text: &str) {
    canvas.text(*at, "head", text);
    at.1 += ROW;
}

fn row(canvas: &mut Canvas, at: &mut Pixel, text: &str) {
    let short: String = text.chars().take(LONGEST).collect();
    let text = if short.len() < text.len() { short + "…" } else { short };
    canvas.text((at.0 + 34.0, at.1), "", &text);
    at.1 += ROW;
}

fn swatch_line(canvas: &mut Canvas, at: Pixel, color: &str, width: &str, more: &str) {
    let (x, y) = (px(at.0), px(at.1 - 4.0));
    canvas.add(&format!(r#"<path d="M{x} {y}h24" stroke="{color}" stroke-width="{width}"{more}/>"#));
}

fn swatch_box(canvas: &mut Canvas, at: Pixel, class: &str) {
    let (x, y) = (px(at.0), px(at.1 - 11.0));
    canvas.add(&format!(r#"<rect class="{class}" x="{x}" y="{y}" width="24" height="14"/>"#));
}
