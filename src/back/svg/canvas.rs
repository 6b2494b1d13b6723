//! The drawing surface: metres to pixels, y upwards, and SVG elements as text.

use std::borrow::Cow;
use std::fmt::Write;

use crate::diag::printable;
use crate::exact::Rational;
use crate::geometry::Polytope;

/// The longer side of the workspace, in pixels.
const LONG_SIDE: f64 = 760.0;
/// The workspace's sides are drawn at least this long, however thin it is.
const SHORT_SIDE: f64 = 40.0;
/// Room to the left, for the axis.
const LEFT: f64 = 52.0;
/// Room above, for the title.
const TOP: f64 = 64.0;
/// Room below, for the axis.
const BOTTOM: f64 = 48.0;
/// Room to the right, for the legend.
pub const LEGEND: f64 = 240.0;

/// A point on the picture, in pixels.
pub type Pixel = (f64, f64);

/// A picture under way.
pub struct Canvas {
    body: String,
    low: [f64; 2],
    /// Pixels a metre.
    scale: f64,
    /// Width and height of the workspace in pixels.
    size: [f64; 2],
    height: f64,
}

impl Canvas {
    /// A canvas for a workspace, at least so many pixels high.
    pub fn new(workspace: &Polytope, least_height: f64) -> Canvas {
        let corner = |axis: usize, pick: fn(f64, f64) -> f64, start: f64| {
            workspace.vertices.iter().filter_map(|v| v.get(axis)).map(Rational::to_f64).fold(start, pick)
        };
        let low = [0, 1].map(|a| corner(a, f64::min, f64::INFINITY));
        let high = [0, 1].map(|a| corner(a, f64::max, f64::NEG_INFINITY));
        let extent = [0, 1].map(|a| high[a] - low[a]);
        let scale = LONG_SIDE / extent[0].max(extent[1]);
        let size = extent.map(|e| (e * scale).max(SHORT_SIDE));
        let height = (TOP + size[1] + BOTTOM).max(least_height);
        let mut canvas = Canvas { body: String::new(), low, scale, size, height };
        canvas.axes();
        canvas
    }

    /// The pixel of a point in metres; coordinates beyond the second are looked at from above.
    pub fn pixel(&self, point: &[f64]) -> Pixel {
        let metres = |axis: usize| point.get(axis).copied().unwrap_or(0.0) - self.low[axis];
        (LEFT + metres(0) * self.scale, TOP + self.size[1] - metres(1) * self.scale)
    }

    /// A length in pixels.
    pub fn length(&self, metres: f64) -> f64 {
        metres * self.scale
    }

    /// The left edge of the legend and the height of the picture.
    pub fn legend_corner(&self) -> Pixel {
        (LEFT + self.size[0] + 28.0, TOP)
    }

    /// Adds a line of SVG.
    pub fn add(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }

    /// Adds a name that stays readable over whatever lies below it.
    ///
    /// The halo is a text of its own: not every viewer knows `paint-order`.
    pub fn name(&mut self, at: Pixel, class: &str, contents: &str) {
        self.text(at, &format!("halo {class}"), contents);
        self.text(at, &format!("name {class}"), contents);
    }

    /// Adds a text; its contents are escaped here.
    pub fn text(&mut self, at: Pixel, class: &str, contents: &str) {
        let element =
            format!(r#"<text class="{class}" x="{}" y="{}">{}</text>"#, px(at.0), px(at.1), escape(contents));
        self.add(&element);
    }

    /// The whole file.
    pub fn finish(self, title: &str) -> String {
        let (width, height) = (px(LEFT + self.size[0] + LEGEND), px(self.height));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"0 0 {width} {height}\" \
             width=\"{width}\" height=\"{height}\">\n<title>{title}</title>\n{}\
             <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{}</svg>\n",
            include_str!("style.svg"),
            self.body
        )
    }

    /// Frame and ticks in metres.
    fn axes(&mut self) {
        let (x, y, bottom) = (LEFT, TOP, TOP + self.size[1]);
        let mut grid = String::new();
        for tick in ticks(self.low[0], self.size[0] / self.scale) {
            let at = px(self.pixel(&[tick.0, 0.0]).0);
            let _ = write!(grid, r#"<path class="grid" d="M{at} {}V{}"/>"#, px(y), px(bottom));
            let _ = writeln!(
                grid,
                r#"<text class="tick mid" x="{at}" y="{}">{}</text>"#,
                px(bottom + 18.0),
                tick.1
            );
        }
        for tick in ticks(self.low[1], self.size[1] / self.scale) {
            let at = self.pixel(&[0.0, tick.0]).1;
            let _ =
                write!(grid, r#"<path class="grid" d="M{} {}H{}"/>"#, px(x), px(at), px(x + self.size[0]));
            let _ = writeln!(
                grid,
                r#"<text class="tick end" x="{}" y="{}">{}</text>"#,
                px(x - 8.0),
                px(at + 4.0),
                tick.1
            );
        }
        self.add(grid.trim_end());
        self.text((x + self.size[0] / 2.0, bottom + 38.0), "tick mid", "metres");
    }
}

/// Round numbers that cover a range: each value with its text.
fn ticks(low: f64, extent: f64) -> Vec<(f64, String)> {
    let rough = extent / 7.0;
    if !(rough.is_finite() && rough > 0.0) {
        return Vec::new();
    }
    let power = rough.log10().floor();
    let step = [1.0, 2.0, 5.0, 10.0]
        .map(|f| f * 10f64.powf(power))
        .into_iter()
        .find(|s| *s >= rough)
        .unwrap_or(rough);
    let decimals = if step >= 1.0 { 0 } else { (-step.log10()).ceil() as usize };
    // A hair of slack, so that rounding does not lose a tick on the edge.
    let first = (low / step - 1e-9).ceil();
    let all =
        (0..20).map(|i| (first + f64::from(i)) * step).take_while(|t| *t <= low + extent * (1.0 + 1e-9));
    all.map(|t| (t, number(t, decimals))).collect()
}

/// A number of metres for people: fixed decimals, in powers of ten where it is far from 1.
fn number(value: f64, decimals: usize) -> String {
    if decimals > 4 || value.abs() >= 1e7 {
        format!("{value:.2e}")
    } else {
        unsigned_zero(format!("{value:.decimals$}"))
    }
}

/// A number of pixels, with two decimals.
pub fn px(value: f64) -> String {
    // A picture has to open even where a number overflowed on the way to pixels.
    if value.is_finite() { unsigned_zero(format!("{value:.2}")) } else { "0.00".into() }
}

fn unsigned_zero(text: String) -> String {
    if text.starts_with('-') && text.bytes().all(|b| matches!(b, b'-' | b'0' | b'.')) {
        text[1..].into()
    } else {
        text
    }
}

/// A text as SVG character data: no markup, no control characters.
pub fn escape(text: &str) -> String {
    let text: Cow<str> = printable(text);
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            // Not allowed in XML, and not printable text either.
            '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            _ => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_becomes_neither_markup_nor_control() {
        assert_eq!(
            escape("</title><script>\"'&\u{1b}"),
            "&lt;/title&gt;&lt;script&gt;&quot;&#39;&amp;\u{241b}"
        );
    }

    #[test]
    fn pixels_have_two_decimals_and_one_zero() {
        assert_eq!([-0.001, 1.0, 2.345_6, f64::NAN].map(px), ["0.00", "1.00", "2.35", "0.00"]);
    }

    #[test]
    fn ticks_are_round_and_inside() {
        let texts = |low, extent| ticks(low, extent).into_iter().map(|t| t.1).collect::<Vec<_>>();
        assert_eq!(texts(0.0, 12.0), ["0", "2", "4", "6", "8", "10", "12"]);
        assert_eq!(texts(-0.3, 0.5), ["-0.3", "-0.2", "-0.1", "0.0", "0.1", "0.2"]);
        assert_eq!(texts(0.0, f64::INFINITY).len(), 0);
    }
}
