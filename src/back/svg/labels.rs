//! Where labels go: each tries several places and takes the one that hides least, no two overlap.

use super::canvas::Pixel;

/// A box in pixels: left and upper edge, width, height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    /// The left edge.
    pub x: f64,
    /// The upper edge.
    pub y: f64,
    /// The width.
    pub w: f64,
    /// The height.
    pub h: f64,
}

impl Rect {
    /// A box around a point.
    pub fn around(at: Pixel, w: f64, h: f64) -> Rect {
        Rect { x: at.0 - w / 2.0, y: at.1 - h / 2.0, w, h }
    }

    /// The middle.
    pub fn middle(&self) -> Pixel {
        (self.x + self.w / 2.0, self.y + self.h / 2.0)
    }

    /// Whether the two have inner points in common.
    pub fn overlaps(&self, other: &Rect) -> bool {
        self.x < other.x + other.w
            && other.x < self.x + self.w
            && self.y < other.y + other.h
            && other.y < self.y + self.h
    }

    fn holds(&self, other: &Rect) -> bool {
        self.x <= other.x
            && self.y <= other.y
            && other.x + other.w <= self.x + self.w
            && other.y + other.h <= self.y + self.h
    }
}

/// What is taken already, and what had better stay visible.
#[derive(Default)]
pub struct Places {
    /// Labels stay in here.
    area: Option<Rect>,
    taken: Vec<Rect>,
    /// What a label may cover at a price.
    spots: Vec<(Rect, f64)>,
}

impl Places {
    /// No places taken yet in an area.
    pub fn new(area: Rect) -> Places {
        Places { area: Some(area), ..Places::default() }
    }

    /// Keeps labels off a box.
    pub fn block(&mut self, rect: Rect) {
        self.taken.push(rect);
    }

    /// Lets labels pay for covering a box.
    pub fn spot(&mut self, rect: Rect, price: f64) {
        self.spots.push((rect, price));
    }

    /// Lets labels pay for covering a line.
    pub fn line(&mut self, from: Pixel, to: Pixel, price: f64) {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        // So many little boxes that nothing of the font's size slips between them; a line of
        // nonsensical length gets few.
        let count = (dx.hypot(dy) / 7.0).clamp(1.0, 200.0) as usize;
        for i in 0..=count {
            let share = i as f64 / count as f64;
            self.spot(Rect::around((from.0 + share * dx, from.1 + share * dy), 4.0, 4.0), price);
        }
    }

    /// Takes the cheapest of some boxes, each with a price of its own, if there is one for at most
    /// `most`; the first among equals.
    pub fn take(&mut self, choices: impl IntoIterator<Item = (Rect, f64)>, most: f64) -> Option<Rect> {
        let mut best: Option<(Rect, f64)> = None;
        for (rect, price) in choices {
            let limit = best.map_or(most, |(_, least)| least);
            if price > limit || (best.is_some() && price >= limit) || !self.is_free(&rect) {
                continue;
            }
            let price = price + self.price(&rect);
            if best.map_or(price <= most, |(_, least)| price < least) {
                best = Some((rect, price));
            }
        }
        let (rect, _) = best?;
        self.taken.push(rect);
        Some(rect)
    }

    fn is_free(&self, rect: &Rect) -> bool {
        self.area.is_none_or(|area| area.holds(rect)) && !self.taken.iter().any(|t| t.overlaps(rect))
    }

    fn price(&self, rect: &Rect) -> f64 {
        self.spots.iter().filter(|(spot, _)| spot.overlaps(rect)).map(|(_, price)| price).sum()
    }
}

/// Boxes around a point that keep a distance from it: eight directions, the nearest ones first.
pub fn around(at: Pixel, w: f64, h: f64, distances: &[f64]) -> Vec<(Rect, f64)> {
    // Right above is where the eye looks first.
    const SIDES: [(f64, f64); 8] = [
        (1.0, -1.0),
        (1.0, 0.0),
        (-1.0, -1.0),
        (1.0, 1.0),
        (0.0, -1.0),
        (-1.0, 0.0),
        (-1.0, 1.0),
        (0.0, 1.0),
    ];
    let mut boxes = Vec::new();
    for (ring, distance) in distances.iter().enumerate() {
        for (rank, (sx, sy)) in SIDES.iter().enumerate() {
            // On the diagonals the corner is as far away as the edge is elsewhere.
            let reach = if sx * sy == 0.0 { *distance } else { distance * 0.75 };
            let middle = (at.0 + sx * (w / 2.0 + reach), at.1 + sy * (h / 2.0 + reach));
            boxes.push((Rect::around(middle, w, h), ring as f64 * 3.0 + rank as f64 * 0.1));
        }
    }
    boxes
}

/// Boxes in and around a box: its middle, its edges from inside, then from outside. What lies inside
/// and would hide more than half of a box that is `solid` comes last.
pub fn about(target: &Rect, w: f64, h: f64, solid: bool) -> Vec<(Rect, f64)> {
    let hidden = if solid && (w > 0.6 * target.w || h > 0.6 * target.h) { 5.0 } else { 0.0 };
    let (x, y) = target.middle();
    let inside = [
        (0.0, 0.0),
        (0.0, -1.0),
        (0.0, 1.0),
        (-1.0, -1.0),
        (1.0, -1.0),
        (-1.0, 1.0),
        (1.0, 1.0),
        (-1.0, 0.0),
        (1.0, 0.0),
    ];
    let room = (target.w - w - 8.0, target.h - h - 8.0);
    let mut boxes = Vec::new();
    if room.0 < 0.0 && room.1 >= 0.0 && room.0 > -0.5 * w {
        // A little too long: rather across its own edges than elsewhere.
        boxes.push((Rect::around((x, y), w, h), hidden));
    }
    if room.0 >= 0.0 && room.1 >= 0.0 {
        for (rank, (sx, sy)) in inside.iter().enumerate() {
            let middle = (x + sx * room.0 / 2.0, y + sy * room.1 / 2.0);
            boxes.push((Rect::around(middle, w, h), hidden + rank as f64 * 0.2));
        }
    }
    for (ring, gap) in [4.0, 14.0, 28.0, 44.0, 62.0].into_iter().enumerate() {
        for (rank, (sx, sy)) in [
            (0.0, -1.0),
            (0.0, 1.0),
            (1.0, 0.0),
            (-1.0, 0.0),
            (1.0, -1.0),
            (-1.0, -1.0),
            (1.0, 1.0),
            (-1.0, 1.0),
        ]
        .iter()
        .enumerate()
        {
            let middle =
                (x + sx * (target.w / 2.0 + w / 2.0 + gap), y + sy * (target.h / 2.0 + h / 2.0 + gap));
            // Straight above and below the text may as well stand anywhere along the edge.
            boxes.push((Rect::around(middle, w, h), 2.5 + ring as f64 * 3.0 + rank as f64 * 0.1));
        }
    }
    boxes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area() -> Rect {
        Rect { x: 0.0, y: 0.0, w: 100.0, h: 100.0 }
    }

    #[test]
    fn labels_keep_off_each_other_and_inside() {
        let mut places = Places::new(area());
        let mut taken = Vec::new();
        for _ in 0..20 {
            taken.extend(places.take(around((50.0, 50.0), 30.0, 12.0, &[5.0, 20.0]), 100.0));
        }
        assert!(taken.len() >= 6, "{taken:?}");
        for (i, a) in taken.iter().enumerate() {
            assert!(area().holds(a), "{a:?}");
            assert!(taken[..i].iter().all(|b| !a.overlaps(b)), "{a:?}");
        }
    }

    #[test]
    fn the_cheapest_place_is_taken() {
        let mut places = Places::new(area());
        places.line((60.0, 0.0), (60.0, 50.0), 2.0);
        // Right of the point are the line's little boxes, left of it nothing.
        let rect = places.take(around((50.0, 50.0), 30.0, 12.0, &[5.0]), 100.0).expect("room");
        assert!(rect.x + rect.w <= 50.0 || rect.y >= 50.0, "{rect:?}");
    }

    #[test]
    fn what_costs_too_much_is_left_out() {
        let mut places = Places::new(area());
        places.spot(area(), 5.0);
        assert_eq!(places.take(around((50.0, 50.0), 30.0, 12.0, &[5.0]), 4.0), None);
    }
}
