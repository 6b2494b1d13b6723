//! The cells of a partition of the workspace, under everything else.

use super::canvas::Canvas;
use super::shapes::closed;

/// A convex polygon seen from above: its corners in metres.
pub type Cell = Vec<[f64; 2]>;

/// Draws thin outlines.
pub fn draw(canvas: &mut Canvas, cells: &[Cell]) {
    for cell in cells {
        let corners: Vec<_> = cell.iter().map(|corner| canvas.pixel(corner)).collect();
        canvas.add(&format!(r#"<path class="cell" d="{}"/>"#, closed(&corners)));
    }
}
