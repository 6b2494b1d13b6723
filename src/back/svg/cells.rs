//! The cells of a partition of the workspace, under everything else.

use super::canvas::{Canvas, View};
use super::outline::{Outline, Point};

/// A convex polygon seen from above: its corners in metres.
pub type Cell = Vec<Point>;

/// Draws thin outlines.
pub fn draw(canvas: &mut Canvas, view: &View, cells: &[Cell]) {
    for cell in cells {
        canvas.path("cell", &view.path(&Outline { corners: cell.clone(), radius: 0.0 }));
    }
}
