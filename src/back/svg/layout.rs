//! Where the parts of the picture stand.

use super::canvas::View;
use super::outline::Outline;

/// The font size of names and legend; the picture is about as wide as 45 such letters are long, so
/// that they can be read at 400 pixels.
pub const FONT: f64 = 15.0;
/// The font size of ticks, step numbers and other small print.
pub const SMALL: f64 = 13.0;
/// Room to the left of the main panel, for its axis.
pub const LEFT: f64 = 58.0;
/// Room around everything.
pub const MARGIN: f64 = 16.0;
/// Room above, for the title.
pub const TOP: f64 = 72.0;
/// Room below the main panel, for its axis and the scale bar.
pub const AXIS: f64 = 50.0;
/// The main panel is at most so wide and so high.
const MAIN: [f64; 2] = [606.0, 606.0];
/// The picture is at least so wide: its title and legend need that.
const NARROWEST: f64 = 500.0;
/// A panel lower or narrower than this gets air around it for its labels.
const THIN: f64 = 130.0;
/// That air.
const AIR: f64 = 60.0;
/// A panel narrower than this has its legend beside it.
const BESIDE: f64 = 260.0;
/// How many moments are shown.
pub const MOMENTS: usize = 4;
/// Space between small panels.
pub const GAP: f64 = 14.0;
/// A small panel is at most so high.
const SMALL_HEIGHT: f64 = 260.0;
/// Room above a small panel, for two lines of caption.
pub const CAPTION: f64 = 40.0;

/// The places of the parts.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// The picture's width.
    pub width: f64,
    /// The main panel.
    pub main: View,
    /// Air around the main panel, to its sides and above and below it.
    pub air: [f64; 2],
    /// The legend's left and upper edge.
    pub legend: (f64, f64),
    /// The legend's width.
    pub legend_width: f64,
    /// Small panels in a row.
    pub columns: usize,
}

impl Layout {
    /// The places for a workspace.
    pub fn new(workspace: &Outline) -> Layout {
        let (low, high) = workspace.bounds();
        let extent = [high[0] - low[0], high[1] - low[1]];
        let scale = (MAIN[0] / extent[0]).min(MAIN[1] / extent[1]);
        let size = extent.map(|e| e * scale);
        let air = [size[0] < THIN, size[1] < THIN].map(|thin| if thin { AIR } else { 0.0 });
        let (left, top) = (LEFT + air[0], TOP + air[1]);
        let main = View { low, corner: (left, top), size, scale };
        let (right, bottom) = (left + size[0] + air[0], top + size[1] + air[1] + AXIS);
        let width = (right + MARGIN).max(NARROWEST);
        let beside = size[0] < BESIDE;
        let legend = if beside { (right + 24.0, top) } else { (MARGIN, bottom + 8.0) };
        let aspect = extent[0] / extent[1];
        let columns = match aspect {
            a if a > 4.0 => 1,
            a if a > 1.45 => 2,
            _ => 4,
        };
        let width = if beside { width.max(legend.0 + 230.0) } else { width };
        Layout { width, main, air, legend, legend_width: width - legend.0 - MARGIN, columns }
    }

    /// The lower edge of the main panel with its axis.
    pub fn main_bottom(&self) -> f64 {
        self.main.corner.1 + self.main.size[1] + self.air[1] + AXIS
    }

    /// The small panels of so many moments below `top`, and where they end.
    pub fn panels(&self, top: f64, count: usize) -> (Vec<View>, f64) {
        let columns = self.columns.min(count).max(1);
        let room = self.width - 2.0 * MARGIN;
        // A single panel of a row is not blown up: all rows and pictures look alike.
        let pitch = (room + GAP) / self.columns as f64;
        let [w, h] = self.main.size;
        let shrink = ((pitch - GAP) / w).min(SMALL_HEIGHT / h).min(0.7);
        let (size, scale) = ([w * shrink, h * shrink], self.main.scale * shrink);
        let row = CAPTION + size[1] + GAP;
        let view = |index: usize| {
            let (column, line) = ((index % columns) as f64, (index / columns) as f64);
            let corner = (MARGIN + column * pitch, top + line * row + CAPTION);
            View { low: self.main.low, corner, size, scale }
        };
        (((0..count).map(view)).collect(), top + row * count.div_ceil(columns) as f64)
    }

    /// How wide a small panel's caption may be.
    pub fn caption_width(&self) -> f64 {
        (self.width - 2.0 * MARGIN + GAP) / self.columns as f64 - GAP
    }
}
