//! Axes with round numbers, and a scale bar.

use super::canvas::{Canvas, View, px, unsigned_zero};
use super::labels::{Places, Rect};
use super::layout::{Layout, SMALL};
use super::text;

/// How far a number may reach beyond its panel, in pixels: less than the picture's margin.
const OVERHANG: f64 = 14.0;

/// Draws the grid behind everything.
pub fn grid(canvas: &mut Canvas, view: &View) {
    let ((x, y), [w, h]) = (view.corner, view.size);
    let mut lines = String::new();
    for (value, _) in ticks(view.low[0], w / view.scale, w) {
        lines += &format!("M{} {}v{}", px(view.pixel([value, 0.0]).0), px(y), px(h));
    }
    for (value, _) in ticks(view.low[1], h / view.scale, h) {
        lines += &format!("M{} {}h{}", px(x), px(view.pixel([0.0, value]).1), px(w));
    }
    canvas.path("grid", &lines);
}

/// Draws tick marks and numbers; all of them keep labels off.
pub fn marks(canvas: &mut Canvas, view: &View, places: &mut Places) {
    let [w, h] = view.size;
    let (x, bottom) = (view.corner.0, view.corner.1 + h);
    // The edges, for a workspace that does not reach all of them.
    let mut marks = format!("M{} {}v{}h{}", px(x), px(view.corner.1), px(h), px(w));
    for (value, number) in ticks(view.low[0], w / view.scale, w) {
        let at = view.pixel([value, 0.0]).0;
        marks += &format!("M{} {}v5", px(at), px(bottom));
        // A long number at the right end moves inwards, so that it stays in the picture.
        let half = 0.5 * text::width(&number, SMALL, false);
        let middle = at.min(x + w + OVERHANG - half);
        small(canvas, places, (middle, bottom + 19.0), "tick mid", &number, -0.5);
    }
    for (value, number) in ticks(view.low[1], h / view.scale, h) {
        let at = view.pixel([0.0, value]).1;
        marks += &format!("M{} {}h-5", px(x), px(at));
        small(canvas, places, (x - 9.0, at + 4.5), "tick end", &number, -1.0);
    }
    canvas.path("tickmark", &marks);
}

/// Draws tick marks, numbers, what is along the axes, and the scale bar; all of them keep labels off.
pub fn draw(canvas: &mut Canvas, layout: &Layout, places: &mut Places) {
    marks(canvas, &layout.main, places);
    let row = layout.main.corner.1 + layout.main.size[1] + layout.air[1] + 40.0;
    small(canvas, places, (layout.main.corner.0, row), "tick", "x, y in metres", 0.0);
    scale_bar(canvas, &layout.main, places, row);
}

/// Draws a small text that keeps labels off; `shift` says how much of its width lies left of it.
pub fn small(
    canvas: &mut Canvas,
    places: &mut Places,
    at: (f64, f64),
    class: &str,
    contents: &str,
    shift: f64,
) {
    let width = text::width(contents, SMALL, false);
    places.block(Rect { x: at.0 + shift * width, y: at.1 - SMALL, w: width, h: SMALL + 4.0 });
    canvas.text(at, class, contents);
}

/// A bar with the length of one or more ticks, at the right below the panel.
pub fn scale_bar(canvas: &mut Canvas, view: &View, places: &mut Places, row: f64) {
    let longer = view.size[0].max(view.size[1]) / view.scale;
    let Some((metres, decimals)) = step(longer / 6.0) else { return };
    let length = metres * view.scale;
    let number = format!("{} m", number(metres, decimals));
    let width = text::width(&number, SMALL, false);
    let right = (view.corner.0 + view.size[0]).max(view.corner.0 + 215.0 + length + width);
    let left = right - length;
    let y = row - 4.5;
    canvas.path("bar", &format!("M{} {}v8m0 -4h{}m0 -4v8", px(left), px(y - 4.0), px(length)));
    small(canvas, places, (left - 8.0, row), "tick end", &number, -1.0);
    places.block(Rect { x: left - 2.0, y: y - 6.0, w: length + 4.0, h: 12.0 });
}

/// Round numbers that cover a range drawn that long: each value with its text.
pub fn ticks(low: f64, extent: f64, pixels: f64) -> Vec<(f64, String)> {
    // One tick in 80 pixels or so, at least two.
    let Some((step, decimals)) = step(extent / (pixels / 80.0).clamp(2.0, 8.0)) else { return Vec::new() };
    // A hair of slack, so that rounding does not lose a tick on the edge.
    let first = (low / step - 1e-9).ceil();
    let all = (0..20).map(|i| (first + f64::from(i)) * step);
    let inside = all.take_while(|t| *t <= low + extent + step * 1e-9);
    inside.map(|t| (t, number(t, decimals))).collect()
}

/// The least of 1, 2, 5 times a power of ten that is not below a length, and its decimals.
fn step(least: f64) -> Option<(f64, usize)> {
    if !(least.is_finite() && least > 0.0) {
        return None;
    }
    let power = 10f64.powf(least.log10().floor());
    let found = [1.0, 2.0, 5.0, 10.0].map(|f| f * power).into_iter().find(|s| *s >= least * (1.0 - 1e-9))?;
    let decimals = if found >= 1.0 { 0 } else { (-found.log10()).ceil() as usize };
    Some((found, decimals))
}

/// A number of metres for people: fixed decimals, in powers of ten where it is far from 1.
fn number(value: f64, decimals: usize) -> String {
    if decimals > 4 || value.abs() >= 1e7 {
        format!("{value:.1e}")
    } else {
        unsigned_zero(format!("{value:.decimals$}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let texts =
            |low, extent, pixels| ticks(low, extent, pixels).into_iter().map(|t| t.1).collect::<Vec<_>>();
        assert_eq!(texts(0.0, 12.0, 600.0), ["0", "2", "4", "6", "8", "10", "12"]);
        assert_eq!(texts(-0.3, 0.5, 400.0), ["-0.3", "-0.2", "-0.1", "0.0", "0.1", "0.2"]);
        assert_eq!(texts(0.0, 3.0, 30.0), ["0", "2"]);
        assert_eq!(texts(0.0, f64::INFINITY, 600.0).len(), 0);
    }
}
