//! Robots' colours and marks: told apart by shape where there is no colour.

use super::canvas::{Pixel, closed, px};
use super::layout::FONT;

/// Colours that people with any colour vision can tell apart (Okabe and Ito), without those that
/// jammers and regions have. The classes `r0`, `r1` … are darker ones for text.
const COLORS: [&str; 5] = ["#0072b2", "#e69f00", "#cc79a7", "#222222", "#56b4e9"];

/// The same, darker: those of the classes `r0`, `r1` …
const DARK: [&str; 5] = ["#005a8c", "#7d5600", "#8a3d68", "#222222", "#1b658f"];

/// Shapes by their corners: how many, and the angle of the first one in degrees. None for a circle.
const SHAPES: [Option<(usize, f64)>; 6] =
    [None, Some((4, 45.0)), Some((3, -90.0)), Some((4, 0.0)), Some((3, 90.0)), Some((6, 0.0))];

/// The colour of a robot's lines.
pub fn color(robot: usize) -> &'static str {
    COLORS[robot % COLORS.len()]
}

/// The colour of a robot's thin lines over its others, as dark as its name.
pub fn dark(robot: usize) -> &'static str {
    DARK[robot % DARK.len()]
}

/// The class of a robot's name and numbers.
pub fn ink(robot: usize) -> String {
    format!("r{}", robot % COLORS.len())
}

/// The path of a robot's mark, whatever its shape about as large as a circle of this radius.
pub fn path(robot: usize, at: Pixel, radius: f64) -> String {
    let Some((count, first)) = SHAPES[robot % SHAPES.len()] else {
        let (left, right, y, r) = (px(at.0 - radius), px(at.0 + radius), px(at.1), px(radius));
        return format!("M{left} {y}A{r} {r} 0 1 0 {right} {y}A{r} {r} 0 1 0 {left} {y}Z");
    };
    // The circumscribed radius of the polygon with the circle's area, a little less for points.
    let angle = std::f64::consts::TAU / count as f64;
    let reach = radius * (std::f64::consts::TAU / (count as f64 * angle.sin())).sqrt() * 0.97;
    let corner = |i: usize| {
        let a = first.to_radians() + angle * i as f64;
        (at.0 + reach * a.cos(), at.1 + reach * a.sin())
    };
    closed(&(0..count).map(corner).collect::<Vec<_>>())
}

/// A base station's mark: a mast on a triangle.
pub fn mast(at: Pixel, size: f64) -> String {
    let (x, y) = at;
    let corners = [(x, y - size), (x + 0.85 * size, y + 0.75 * size), (x - 0.85 * size, y + 0.75 * size)];
    closed(&corners)
}

/// A base station's mark has this size in the main panel.
pub const MAST: f64 = FONT * 0.62;
