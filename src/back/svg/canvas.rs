//! The drawing surface: pixels, and SVG elements as text.

use std::fmt::Write;

use super::outline::{Outline, Point};
use super::text::escape;

/// A point on the picture, in pixels, y downwards.
pub type Pixel = (f64, f64);

/// A part of the picture with a scale of its own: metres to pixels, y upwards.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// The workspace's lower left corner in metres.
    pub low: Point,
    /// Its left and upper edge in pixels.
    pub corner: Pixel,
    /// Its width and height in pixels.
    pub size: [f64; 2],
    /// Pixels a metre.
    pub scale: f64,
}

impl View {
    /// The pixel of a point.
    pub fn pixel(&self, point: Point) -> Pixel {
        let [x, y] = [0, 1].map(|axis| (point[axis] - self.low[axis]) * self.scale);
        (self.corner.0 + x, self.corner.1 + self.size[1] - y)
    }

    /// The pixels of an outline's corners.
    pub fn pixels(&self, points: &[Point]) -> Vec<Pixel> {
        points.iter().map(|p| self.pixel(*p)).collect()
    }

    /// The path of an outline.
    pub fn path(&self, outline: &Outline) -> String {
        let corners = self.pixels(&outline.corners);
        if outline.radius > 0.0 { rounded(&corners, outline.radius * self.scale) } else { closed(&corners) }
    }

    /// The attributes of an element that cuts its contents off at the workspace's bounds.
    pub fn window(&self) -> String {
        let [x, y, w, h] = [self.corner.0, self.corner.1, self.size[0], self.size[1]].map(px);
        format!(r#"x="{x}" y="{y}" width="{w}" height="{h}" viewBox="{x} {y} {w} {h}""#)
    }
}

/// A picture under way.
#[derive(Default)]
pub struct Canvas {
    body: String,
}

impl Canvas {
    /// Adds a line of SVG.
    pub fn add(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }

    /// Adds a path.
    pub fn path(&mut self, class: &str, d: &str) {
        self.add(&format!(r#"<path class="{class}" d="{d}"/>"#));
    }

    /// Adds a path that says something when it is pointed at.
    pub fn titled_path(&mut self, class: &str, d: &str, title: &str) {
        self.add(&format!(r#"<path class="{class}" d="{d}"><title>{}</title></path>"#, escape(title)));
    }

    /// Adds a text; its contents are escaped here.
    pub fn text(&mut self, at: Pixel, class: &str, contents: &str) {
        let (x, y) = (px(at.0), px(at.1));
        self.add(&format!(r#"<text class="{class}" x="{x}" y="{y}">{}</text>"#, escape(contents)));
    }

    /// Adds a text that stays readable over whatever lies below it.
    ///
    /// The halo is a text of its own: not every viewer knows `paint-order`.
    pub fn haloed(&mut self, at: Pixel, class: &str, contents: &str) {
        self.text(at, &format!("halo {class}"), contents);
        self.text(at, class, contents);
    }

    /// What was drawn.
    pub fn finish(self) -> String {
        self.body
    }
}

/// A number of pixels, with two decimals.
pub fn px(value: f64) -> String {
    // A picture has to open even where a number overflowed on the way to pixels.
    if value.is_finite() { unsigned_zero(format!("{value:.2}")) } else { "0.00".into() }
}

/// The text without the sign of a zero.
pub fn unsigned_zero(text: String) -> String {
    if text.starts_with('-') && text.bytes().all(|b| matches!(b, b'-' | b'0' | b'.')) {
        text[1..].into()
    } else {
        text
    }
}

/// An open path through points.
pub fn open(points: &[Pixel]) -> String {
    let at: Vec<String> = points.iter().map(|p| format!("{} {}", px(p.0), px(p.1))).collect();
    format!("M{}", at.join("L"))
}

/// A closed path through points.
pub fn closed(points: &[Pixel]) -> String {
    open(points) + "Z"
}

/// A convex polygon, counter-clockwise to the eye, widened by a disc: straight edges, round corners.
fn rounded(corners: &[Pixel], radius: f64) -> String {
    let r = px(radius);
    if let [(x, y)] = corners {
        let (left, right, y) = (px(x - radius), px(x + radius), px(*y));
        return format!("M{left} {y}A{r} {r} 0 1 0 {right} {y}A{r} {r} 0 1 0 {left} {y}Z");
    }
    let edge = |i: usize| {
        let (from, to) = (corners[i], corners[(i + 1) % corners.len()]);
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length = dx.hypot(dy);
        // Outwards is to the right of the way around, which with y downwards is (−dy, dx).
        let (ox, oy) = (-dy / length * radius, dx / length * radius);
        [(from.0 + ox, from.1 + oy), (to.0 + ox, to.1 + oy)]
    };
    let mut path = String::new();
    for i in 0..corners.len() {
        if i == 0 {
            let [start, _] = edge(0);
            let _ = write!(path, "M{} {}", px(start.0), px(start.1));
        }
        let ([_, end], [next, _]) = (edge(i), edge((i + 1) % corners.len()));
        let _ = write!(path, "L{} {}A{r} {r} 0 0 0 {} {}", px(end.0), px(end.1), px(next.0), px(next.1));
    }
    path + "Z"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_have_two_decimals_and_one_zero() {
        assert_eq!([-0.001, 1.0, 2.345_6, f64::NAN].map(px), ["0.00", "1.00", "2.35", "0.00"]);
    }

    #[test]
    fn a_widened_square_has_straight_edges_and_round_corners() {
        // Counter-clockwise to the eye: left bottom, right bottom, right top, left top.
        let square = [(0.0, 10.0), (10.0, 10.0), (10.0, 0.0), (0.0, 0.0)];
        assert_eq!(
            rounded(&square, 2.0),
            "M0.00 12.00L10.00 12.00A2.00 2.00 0 0 0 12.00 10.00L12.00 0.00\
             A2.00 2.00 0 0 0 10.00 -2.00L0.00 -2.00A2.00 2.00 0 0 0 -2.00 0.00L-2.00 10.00\
             A2.00 2.00 0 0 0 0.00 12.00Z"
        );
    }
}
