//! Simulated runs: thin lines over the nominal ways.

use super::canvas::{Canvas, View, open};
use super::mark;
use super::outline::Point;
use super::scene::Scene;
use crate::back::Flight;

/// Draws every robot's way in every run, cut off at the workspace's bounds.
pub fn draw(canvas: &mut Canvas, view: &View, scene: &Scene, runs: &[Flight]) {
    if runs.is_empty() {
        return;
    }
    canvas.add(&format!("<svg {}>", view.window()));
    for index in 0..scene.robots.len() {
        canvas.add(&group(mark::dark(index)));
        for way in runs.iter().filter_map(|run| run.ways.get(index)) {
            let points: Vec<Point> = way.iter().map(|p| scene.projection.flat(p)).collect();
            canvas.path("", &open(&view.pixels(&points)));
        }
        canvas.add("</g>");
    }
    canvas.add("</svg>");
}

/// The start of a group of thin lines.
pub fn group(color: &str) -> String {
    format!(r#"<g stroke="{color}" stroke-width=".7" stroke-opacity=".5">"#)
}
