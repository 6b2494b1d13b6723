//! Solids in the axonometric view: translucent faces from back to front, balls with their equators.

use super::canvas::{Canvas, View, closed, open};
use super::outline::{Outline, Point};
use super::projection::Projection;
use super::stills;
use crate::exact::Rational;
use crate::geometry::Polytope;
use crate::ir::{Piece, Problem};

/// How many corners stand for half an equator.
const ARC_CORNERS: usize = 32;

/// A piece with its class and name.
type Item<'a> = (&'a str, &'a str, &'a Piece);

/// Draws all regions, obstacles and jammers, the farthest ones first.
pub fn draw(canvas: &mut Canvas, view: &View, problem: &Problem, projection: &Projection) {
    let stack = Stack::new(problem, projection);
    (0..stack.count()).for_each(|index| stack.draw(canvas, view, index));
}

/// All pieces, the farthest ones first.
pub struct Stack<'a> {
    projection: &'a Projection,
    items: Vec<Item<'a>>,
}

impl<'a> Stack<'a> {
    /// The pieces of a problem's regions, obstacles and jammers.
    pub fn new(problem: &'a Problem, projection: &'a Projection) -> Stack<'a> {
        let regions = problem.regions.values().map(|r| ("region", r.name.as_str(), &r.shape));
        let blockers = problem.blockers.values().map(|b| (stills::class(b.kind), b.name.as_str(), &b.shape));
        let mut items: Vec<Item<'_>> = Vec::new();
        for (class, name, shape) in regions.chain(blockers) {
            items.extend(shape.pieces.iter().map(|piece| (class, name, piece)));
        }
        let nearness = |item: &Item<'_>| projection.nearness(&middle(item.2));
        items.sort_by(|a, b| nearness(a).total_cmp(&nearness(b)));
        Stack { projection, items }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.items.len()
    }

    /// How many pieces are drawn before a segment: all that lie before the first one that may hide it.
    pub fn layer(&self, a: &[f64], b: &[f64]) -> usize {
        let hides = |(class, _, piece): &Item<'_>| *class != "region" && self.may_hide(piece, a, b);
        self.items.iter().position(hides).unwrap_or(self.items.len())
    }

    /// Whether a segment may lie behind a piece. It does not where they are apart on the picture, or
    /// where a face that is turned to the viewer has the whole segment before it.
    fn may_hide(&self, piece: &Piece, a: &[f64], b: &[f64]) -> bool {
        let ends = Outline::hull([a, b].map(|p| self.projection.flat(p)).to_vec());
        let ((low, high), (left, right)) = (Outline::of(piece, self.projection).bounds(), ends.bounds());
        if (0..2).any(|k| right[k] < low[k] || high[k] < left[k]) {
            return false;
        }
        match piece {
            Piece::Ball { .. } => {
                let nearness = |p: &[f64]| self.projection.nearness(p);
                0.5 * (nearness(a) + nearness(b)) <= nearness(&middle(piece))
            }
            Piece::Polytope(polytope) => !polytope.facets.iter().any(|facet| {
                let normal: Vec<f64> = facet.normal.iter().map(Rational::to_f64).collect();
                let before = |p: &[f64]| {
                    normal.iter().zip(p).map(|(n, x)| n * x).sum::<f64>() >= facet.offset.to_f64()
                };
                self.projection.nearness(&normal) > 0.0 && before(a) && before(b)
            }),
        }
    }

    /// Draws one of them; nothing when there are not so many.
    pub fn draw(&self, canvas: &mut Canvas, view: &View, index: usize) {
        let Some((class, name, piece)) = self.items.get(index) else { return };
        canvas.add(r#"<g class="solid">"#);
        match piece {
            Piece::Polytope(polytope) => faces(canvas, view, polytope, self.projection, class, name),
            Piece::Ball { center, spread, radius } => {
                canvas.titled_path(class, &view.path(&Outline::of(piece, self.projection)), name);
                let floats: Vec<f64> = center.iter().map(Rational::to_f64).collect();
                if spread.iter().any(|s| !s.is_zero()) {
                    let corners = vec![self.projection.flat(&floats)];
                    canvas.path("hidden", &view.path(&Outline { corners, radius: radius.to_f64() }));
                }
                equator(canvas, view, &floats, radius.to_f64(), self.projection);
            }
        }
        canvas.add("</g>");
    }
}

fn middle(piece: &Piece) -> Vec<f64> {
    let exact = match piece {
        Piece::Polytope(polytope) => polytope.middle(),
        Piece::Ball { center, .. } => center.clone(),
    };
    exact.iter().map(Rational::to_f64).collect()
}

/// A face as it is drawn: its outline, and how much it is turned to the viewer and upwards.
struct Face {
    outline: Outline,
    turned: f64,
    upwards: f64,
}

fn faces_of(polytope: &Polytope, projection: &Projection) -> Vec<Face> {
    let face = |facet: &crate::geometry::HalfSpace| {
        let on = polytope.vertices.iter().filter(|v| !facet.contains_interior(v));
        let normal: Vec<f64> = facet.normal.iter().map(Rational::to_f64).collect();
        let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        Face {
            outline: Outline::hull(on.map(|v| projection.of(v)).collect()),
            turned: projection.nearness(&normal) / length,
            upwards: normal.last().map_or(0.0, |z| z / length),
        }
    };
    polytope.facets.iter().map(face).collect()
}

/// Draws the faces that are turned away by their edges, then the others, the lower the darker.
fn faces(
    canvas: &mut Canvas,
    view: &View,
    polytope: &Polytope,
    projection: &Projection,
    class: &str,
    name: &str,
) {
    let all = faces_of(polytope, projection);
    let (front, back): (Vec<&Face>, Vec<&Face>) = all.iter().partition(|f| f.turned > 0.0);
    back.iter().for_each(|face| canvas.path("hidden", &view.path(&face.outline)));
    for face in front {
        canvas.titled_path(class, &view.path(&face.outline), name);
        let shade = match face.upwards {
            u if u > 0.7 => continue,
            _ if face.turned > 0.6 => "shade",
            _ => "shade dark",
        };
        canvas.path(shade, &view.path(&face.outline));
    }
}

/// The circle around a ball's middle at its height: its far half dashed.
fn equator(canvas: &mut Canvas, view: &View, center: &[f64], radius: f64, projection: &Projection) {
    let at = |i: usize| {
        let angle = std::f64::consts::PI * i as f64 / ARC_CORNERS as f64;
        let (sin, cos) = angle.sin_cos();
        vec![center[0] + radius * cos, center[1] + radius * sin, center[2]]
    };
    // It crosses the edge where it is as far away as the middle.
    let behind = projection.nearness(center);
    let is_near = |i: usize| projection.nearness(&at(i)) >= behind;
    let round = 2 * ARC_CORNERS;
    let first = (0..round).find(|&i| is_near(i) && !is_near(i + round - 1)).unwrap_or(0);
    let half = |from: usize| -> Vec<Point> {
        (from..=from + ARC_CORNERS).map(|i| projection.flat(&at(i))).collect()
    };
    canvas.path("hidden", &open(&view.pixels(&half(first + ARC_CORNERS))));
    canvas.path("equator", &open(&view.pixels(&half(first))));
}

/// Draws the edges of the workspace: those behind everything, or those before it.
pub fn room(canvas: &mut Canvas, view: &View, problem: &Problem, projection: &Projection, front: bool) {
    for face in faces_of(&problem.workspace, projection).iter().filter(|f| (f.turned > 0.0) == front) {
        let class = if front { "glass" } else { "wall" };
        canvas.path(class, &closed(&view.pixels(&face.outline.corners)));
    }
}
