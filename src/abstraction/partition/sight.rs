//! Who sees whom, and who gets where: whether the hull of two places misses a blocker.
//!
//! A place is a convex set of possible positions: a cell with the tube around it, a start with the
//! tube around it, or a base. conv(c ∪ c') misses a blocker ⊕ (−Ω) exactly if conv((c ⊕ Ω) ∪ (c' ⊕ Ω))
//! misses the blocker itself, so moves and links ask the same question.

use crate::abstraction::clearance::convex_hull;
use crate::abstraction::nearest::{self, Vector, vector};
use crate::abstraction::{Abstraction, HalfSpace, Owner, SolidId, Stage, dot};
use crate::ir::{ModelId, Problem};

use super::Cell;

/// The share of the gap that must be left between a hull and a blocker: the cells leave all of it.
const MARGIN: f64 = 0.75;

/// A convex set of possible positions.
#[derive(Clone, Debug)]
pub(super) struct Place {
    /// Corners of the set: in the plane of the positions themselves, in space of the nominal ones.
    corners: Vec<Vec<f64>>,
    /// In space, whose tube is around the corners.
    model: Option<ModelId>,
    middle: Vec<f64>,
    /// By blocker and direction: the set is clear of the blocker along it.
    clear: Vec<u64>,
}

/// A blocker's convex piece, with its margin.
struct Screen {
    solid: SolidId,
    blocks_links: bool,
    /// Directions with the levels that a clear place stays below.
    faces: Vec<(Vec<f64>, f64, crate::abstraction::DirectionId)>,
    /// How many of the faces are facets: they bound the piece.
    facets: usize,
    /// The piece's corners; in the plane only.
    corners: Vec<Vec<f64>>,
    /// The words of [`Place::clear`] that are about it.
    words: std::ops::Range<usize>,
}

/// All blockers, ready to be looked past.
pub(super) struct Sight<'a> {
    abstraction: &'a Abstraction,
    screens: Vec<Screen>,
    words: usize,
}

impl<'a> Sight<'a> {
    /// The sight among a problem's blockers.
    pub(super) fn new(problem: &Problem, abstraction: &'a Abstraction) -> Sight<'a> {
        let mut sight = Sight { abstraction, screens: Vec::new(), words: 0 };
        let blockers = abstraction.solids.iter().filter(|(_, s)| matches!(s.owner, Owner::Blocker(_)));
        for (solid, _) in blockers {
            sight.add(solid, abstraction.blocks_links(problem, solid));
        }
        // What blocks links blocks moves too: it comes first.
        sight.screens.sort_by_key(|s| !s.blocks_links);
        sight
    }

    fn add(&mut self, solid: SolidId, blocks_links: bool) {
        let abstraction = self.abstraction;
        let entry = &abstraction.solids[solid];
        let mut directions = abstraction.facets_of(solid);
        let facets = directions.len();
        directions.extend(entry.faces.iter().filter(|(s, _)| *s != Stage::Facets).map(|(_, d)| *d));
        for axis in 0..abstraction.dimension {
            let both = [true, false].map(|positive| abstraction.directions.axis(axis, positive));
            directions.extend(both.into_iter().filter(|d| entry.faces.iter().all(|(_, f)| f != d)));
        }
        let face = |d: &crate::abstraction::DirectionId| {
            let vector = abstraction.directions[*d].vector.clone();
            let level = entry.level(&vector) - MARGIN * abstraction.gap;
            (vector, level, *d)
        };
        let faces: Vec<_> = directions.iter().map(face).collect();
        let first = self.words;
        self.words += faces.len().div_ceil(64);
        let mut screen =
            Screen { solid, blocks_links, facets, faces, corners: Vec::new(), words: first..self.words };
        if abstraction.dimension == 2 {
            screen.corners = outline(abstraction, &screen);
        }
        self.screens.push(screen);
    }

    /// The place of a cell with a model's tube around it.
    pub(super) fn of_cell(&self, model: ModelId, cell: &Cell) -> Place {
        self.place(Some(model), cell.corners().map(<[f64]>::to_vec).collect(), cell.middle())
    }

    /// The place of a point, with a model's tube around it or none.
    pub(super) fn of_point(&self, model: Option<ModelId>, point: &[f64]) -> Place {
        self.place(model, vec![point.to_vec()], point.to_vec())
    }

    fn place(&self, model: Option<ModelId>, nominal: Vec<Vec<f64>>, middle: Vec<f64>) -> Place {
        let mut clear = vec![0; self.words];
        for screen in &self.screens {
            for (at, (vector, level, direction)) in screen.faces.iter().enumerate() {
                let reach = nominal.iter().map(|p| dot(vector, p)).fold(f64::NEG_INFINITY, f64::max);
                let tube = model.map_or(0.0, |m| self.abstraction.support(m, *direction));
                if reach + tube <= *level {
                    clear[screen.words.start + at / 64] |= 1 << (at % 64);
                }
            }
        }
        let corners = match model {
            Some(model) if self.abstraction.dimension == 2 => {
                self.abstraction.inflated(model, &nominal).into_iter().map(|p| p.to_vec()).collect()
            }
            _ => nominal,
        };
        Place { corners, model, middle, clear }
    }

    /// Whether the hull of two places misses everything that blocks links.
    pub(super) fn sees(&self, a: &Place, b: &Place) -> bool {
        self.screens.iter().filter(|s| s.blocks_links).all(|s| self.clear(a, b, s))
    }

    /// Whether the hull of two places misses every blocker.
    pub(super) fn moves(&self, a: &Place, b: &Place) -> bool {
        self.screens.iter().all(|s| self.clear(a, b, s))
    }

    /// Whether the hull of two places misses everything that blocks no links.
    pub(super) fn passes(&self, a: &Place, b: &Place) -> bool {
        self.screens.iter().filter(|s| !s.blocks_links).all(|s| self.clear(a, b, s))
    }

    fn clear(&self, a: &Place, b: &Place, screen: &Screen) -> bool {
        if screen.words.clone().any(|w| a.clear[w] & b.clear[w] != 0) {
            return true;
        }
        if self.abstraction.dimension == 2 {
            return !screen.cuts(&a.middle, &b.middle) && screen.misses(a, b);
        }
        // A ball's facets bound more than the ball.
        let round = self.abstraction.solids[screen.solid].ball.is_some();
        (round || !screen.cuts(&a.middle, &b.middle)) && self.separates(a, b, screen.solid)
    }

    /// Whether a plane in space leaves the margin between the hull of two places and a blocker.
    fn separates(&self, a: &Place, b: &Place, solid: SolidId) -> bool {
        let solid = &self.abstraction.solids[solid];
        let farthest = |d: &Vector| {
            let ends = [a, b].map(|place| place.farthest(d, self.abstraction));
            if nearest::dot(d, &ends[0]) < nearest::dot(d, &ends[1]) { ends[1] } else { ends[0] }
        };
        let least = |d: &Vector| nearest::minus(&solid.lowest(d), &farthest(d));
        let near = solid.ball.as_ref().map_or(0.0, |ball| ball.radius);
        let first = nearest::minus(&solid.middle(), &vector(&a.middle));
        let wide = |n: &Vector| {
            let length = nearest::dot(n, n).sqrt();
            nearest::dot(n, &least(n)) >= (near + MARGIN * self.abstraction.gap) * length
        };
        nearest::normals(least, &first, near).iter().any(wide)
    }
}

impl Place {
    /// The point that lies farthest along a direction in space.
    fn farthest(&self, d: &Vector, abstraction: &Abstraction) -> Vector {
        let heights = self.corners.iter().map(|c| (dot(d, c), c));
        let corner = heights.max_by(|a, b| a.0.total_cmp(&b.0)).map_or([0.0; 3], |(_, c)| vector(c));
        self.model.map_or(corner, |model| abstraction.tubes[model].farthest(d, corner))
    }
}

/// The corners of a piece with its margin.
fn outline(abstraction: &Abstraction, screen: &Screen) -> Vec<Vec<f64>> {
    let facets = &screen.faces[..screen.facets];
    let far = facets.iter().map(|f| f.1.abs()).fold(abstraction.size, f64::max) * 8.0;
    let whole = Cell::from_box(&abstraction.directions, &[-far; 2], &[far; 2]);
    let bound = |rest: Cell, (_, level, direction): &(Vec<f64>, f64, crate::abstraction::DirectionId)| {
        let opposite = abstraction.directions[*direction].opposite;
        rest.clip(&abstraction.directions, HalfSpace { direction: opposite, offset: -level })
    };
    let piece = facets.iter().try_fold(whole, bound);
    piece.map_or_else(Vec::new, |cell| cell.corners().map(<[f64]>::to_vec).collect())
}

impl Screen {
    /// Whether the segment between two points cuts the piece: most pairs that are not clear are
    /// told so at once.
    fn cuts(&self, a: &[f64], b: &[f64]) -> bool {
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for (vector, level, _) in &self.faces[..self.facets] {
            let (p, q) = (dot(vector, a) - level, dot(vector, b) - level);
            if p <= 0.0 && q <= 0.0 {
                return false;
            }
            let share = p / (p - q);
            if p < 0.0 {
                from = from.max(share);
            } else if q < 0.0 {
                to = to.min(share);
            }
        }
        from < to
    }

    /// Whether an edge of the hull of two places in the plane has the whole piece beyond it.
    fn misses(&self, a: &Place, b: &Place) -> bool {
        let points = a.corners.iter().chain(&b.corners).map(|p| [p[0], p[1]]).collect();
        let hull = convex_hull(points);
        let beyond = |(i, p): (usize, &[f64; 2])| {
            let q = hull[(i + 1) % hull.len()];
            let normal = [q[1] - p[1], p[0] - q[0]];
            let level = dot(&normal, p);
            self.corners.iter().all(|c| dot(&normal, c) >= level)
        };
        hull.len() > 1 && !self.corners.is_empty() && hull.iter().enumerate().any(beyond)
    }
}
