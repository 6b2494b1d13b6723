//! The free space in the plane, cut into trapezoids by vertical lines through all corners and
//! crossings (the vertical decomposition).
//!
//! A Euclidean ball counts as a polygon inside it. Whatever touches up to rounding counts as connected.

use crate::abstraction::{Abstraction, HalfSpace, Owner, Solid, clearance, dot};
use crate::ir::ModelId;

use super::TOUCH;

/// How many corners stand for a Euclidean ball.
const ARC_CORNERS: u32 = 48;

/// A trapezoid of the free space between two vertical lines.
#[derive(Clone, Copy, Debug)]
struct Cell {
    slab: usize,
    /// Lower and upper end at the left line.
    left: [f64; 2],
    /// Lower and upper end at the right line.
    right: [f64; 2],
}

/// The components of a model's free space in the plane.
#[derive(Clone, Debug)]
pub(super) struct Plane {
    lines: Vec<f64>,
    cells: Vec<Cell>,
    component: Vec<usize>,
    touch: f64,
}

impl Plane {
    /// The free space of a model's nominal positions.
    pub(super) fn new(abstraction: &Abstraction, model: ModelId) -> Plane {
        let blockers = abstraction.solids.values().filter(|s| matches!(s.owner, Owner::Blocker(_)));
        let blocked: Vec<Vec<[f64; 2]>> =
            blockers.map(|solid| abstraction.inflated(model, &within(solid))).collect();
        let walls: Vec<(&[f64], f64)> = abstraction.workspace[model]
            .iter()
            .map(|w| (&abstraction.directions[w.direction].vector[..], w.offset))
            .collect();
        let room = clip(&abstraction.outer_box(), &walls);
        let touch = TOUCH * abstraction.size;
        let lines = lines(&blocked, &room, touch);
        let cells = cells(&lines, &blocked, &room, touch);
        let component = components(&cells, touch);
        Plane { lines, cells, component, touch }
    }

    /// Whether some point of a convex set, given by half-spaces, may lie in the component of a point.
    pub(super) fn connects(&self, abstraction: &Abstraction, from: &[f64], region: &[HalfSpace]) -> bool {
        let home: Vec<usize> = (0..self.cells.len())
            .filter(|&cell| self.holds(cell, from))
            .map(|cell| self.component[cell])
            .collect();
        let facets: Vec<(&[f64], f64)> = region
            .iter()
            .map(|f| (&abstraction.directions[f.direction].vector[..], f.offset + self.touch))
            .collect();
        // A start that rounding puts in no cell says nothing.
        home.is_empty()
            || (0..self.cells.len())
                .filter(|&cell| home.contains(&self.component[cell]))
                .any(|cell| !clip(&self.corners(cell), &facets).is_empty())
    }

    fn corners(&self, cell: usize) -> Vec<[f64; 2]> {
        let Cell { slab, left, right } = self.cells[cell];
        let (a, b, e) = (self.lines[slab] - self.touch, self.lines[slab + 1] + self.touch, self.touch);
        vec![[a, left[0] - e], [b, right[0] - e], [b, right[1] + e], [a, left[1] + e]]
    }

    fn holds(&self, cell: usize, point: &[f64]) -> bool {
        let corners = self.corners(cell);
        corners.iter().enumerate().all(|(i, a)| {
            let b = corners[(i + 1) % corners.len()];
            (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]) >= 0.0
        })
    }
}

/// Points whose hull lies in a solid: its corners, or points on the edge of a Euclidean ball.
fn within(solid: &Solid) -> Vec<Vec<f64>> {
    let Some(ball) = &solid.ball else { return solid.vertices.clone() };
    let mut points = Vec::new();
    for i in 0..ARC_CORNERS {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / f64::from(ARC_CORNERS)).sin_cos();
        for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            points.push(vec![
                ball.center[0] + x * ball.spread[0] + ball.radius * cos,
                ball.center[1] + y * ball.spread[1] + ball.radius * sin,
            ]);
        }
    }
    let hull = clearance::convex_hull(points.iter().map(|p| [p[0], p[1]]).collect());
    hull.into_iter().map(|p| p.to_vec()).collect()
}

/// The part of a convex polygon (counter-clockwise) in which all `d · p ≤ offset`.
fn clip(polygon: &[[f64; 2]], half_spaces: &[(&[f64], f64)]) -> Vec<[f64; 2]> {
    let mut rest = polygon.to_vec();
    for (d, offset) in half_spaces {
        let above = |p: &[f64; 2]| dot(d, p) - offset;
        let mut next = Vec::new();
        for (i, p) in rest.iter().enumerate() {
            let q = rest[(i + 1) % rest.len()];
            let (a, b) = (above(p), above(&q));
            if a <= 0.0 {
                next.push(*p);
            }
            if (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0) {
                let s = a / (a - b);
                next.push([p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])]);
            }
        }
        rest = next;
    }
    rest
}

fn edges(polygon: &[[f64; 2]]) -> impl Iterator<Item = ([f64; 2], [f64; 2])> + '_ {
    (0..polygon.len()).map(|i| (polygon[i], polygon[(i + 1) % polygon.len()]))
}

/// The vertical lines through all corners and crossings.
fn lines(blocked: &[Vec<[f64; 2]>], room: &[[f64; 2]], touch: f64) -> Vec<f64> {
    let polygons: Vec<&[[f64; 2]]> = blocked.iter().map(|p| &p[..]).chain([room]).collect();
    let mut lines: Vec<f64> = polygons.iter().flat_map(|p| p.iter().map(|v| v[0])).collect();
    for (i, a) in polygons.iter().enumerate() {
        for b in &polygons[i + 1..] {
            for (p, q) in edges(a) {
                lines.extend(edges(b).filter_map(|(r, s)| crossing([p, q], [r, s])));
            }
        }
    }
    let (lo, hi) = extremes(room.iter().map(|v| v[0]));
    lines.retain(|x| (lo..=hi).contains(x));
    lines.sort_by(f64::total_cmp);
    lines.dedup_by(|b, a| *b - *a <= touch);
    lines
}

fn extremes(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| (lo.min(x), hi.max(x)))
}

/// The x coordinate at which two segments cross.
fn crossing([p, q]: [[f64; 2]; 2], [r, s]: [[f64; 2]; 2]) -> Option<f64> {
    let (u, v) = ([q[0] - p[0], q[1] - p[1]], [s[0] - r[0], s[1] - r[1]]);
    let cross = u[0] * v[1] - u[1] * v[0];
    let w = [r[0] - p[0], r[1] - p[1]];
    let (a, b) = ((w[0] * v[1] - w[1] * v[0]) / cross, (w[0] * u[1] - w[1] * u[0]) / cross);
    let within = |x: f64| (-1e-9..=1.0 + 1e-9).contains(&x);
    (within(a) && within(b)).then(|| p[0] + a * u[0])
}

/// A polygon's part of a slab as a trapezoid, if its middle line meets the polygon.
fn trapezoid(polygon: &[[f64; 2]], a: f64, b: f64) -> Option<[[f64; 2]; 2]> {
    let middle = 0.5 * (a + b);
    let mut hits: Vec<(f64, f64, f64)> = edges(polygon)
        .filter(|(p, q)| p[0].min(q[0]) < middle && middle < p[0].max(q[0]))
        .map(|(p, q)| {
            let slope = (q[1] - p[1]) / (q[0] - p[0]);
            let at = |x: f64| p[1] + slope * (x - p[0]);
            (at(middle), at(a), at(b))
        })
        .collect();
    hits.sort_by(|x, y| x.0.total_cmp(&y.0));
    let (low, high) = (hits.first()?, hits.last()?);
    Some([[low.1, high.1], [low.2, high.2]])
}

fn cells(lines: &[f64], blocked: &[Vec<[f64; 2]>], room: &[[f64; 2]], touch: f64) -> Vec<Cell> {
    let mut cells = Vec::new();
    for slab in 0..lines.len().saturating_sub(1) {
        let (a, b) = (lines[slab], lines[slab + 1]);
        let Some([left, right]) = trapezoid(room, a, b) else { continue };
        let mut taken: Vec<[[f64; 2]; 2]> = blocked.iter().filter_map(|p| trapezoid(p, a, b)).collect();
        let low = |t: &[[f64; 2]; 2]| t[0][0] + t[1][0];
        taken.sort_by(|s, t| low(s).total_cmp(&low(t)));
        let mut floor = [left[0], right[0]];
        let mut add = |floor: [f64; 2], ceiling: [f64; 2]| {
            if ceiling[0] + ceiling[1] >= floor[0] + floor[1] - touch {
                cells.push(Cell { slab, left: [floor[0], ceiling[0]], right: [floor[1], ceiling[1]] });
            }
        };
        for [l, r] in taken {
            add(floor, [l[0].min(left[1]), r[0].min(right[1])]);
            if l[1] + r[1] > floor[0] + floor[1] {
                floor = [l[1], r[1]];
            }
        }
        add(floor, [left[1], right[1]]);
    }
    cells
}

fn components(cells: &[Cell], touch: f64) -> Vec<usize> {
    let mut component: Vec<usize> = (0..cells.len()).collect();
    for (i, a) in cells.iter().enumerate() {
        for (j, b) in cells.iter().enumerate().skip(i + 1) {
            let meet =
                b.slab == a.slab + 1 && a.right[0].max(b.left[0]) <= a.right[1].min(b.left[1]) + 2.0 * touch;
            if meet && component[i] != component[j] {
                let (from, to) = (component[j], component[i]);
                component.iter_mut().filter(|c| **c == from).for_each(|c| *c = to);
            }
        }
    }
    component
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, w: f64, h: f64) -> Vec<[f64; 2]> {
        vec![[x, y], [x + w, y], [x + w, y + h], [x, y + h]]
    }

    fn parts(blocked: &[Vec<[f64; 2]>]) -> usize {
        let room = square(0.0, 0.0, 10.0, 10.0);
        let lines = lines(blocked, &room, 1e-9);
        let cells = cells(&lines, blocked, &room, 1e-9);
        let mut names = components(&cells, 1e-9);
        names.sort_unstable();
        names.dedup();
        names.len()
    }

    #[test]
    fn a_wall_cuts_the_room_and_a_gap_joins_it_again() {
        assert_eq!(parts(&[]), 1);
        assert_eq!(parts(&[square(4.0, -1.0, 1.0, 12.0)]), 2);
        assert_eq!(parts(&[square(4.0, -1.0, 1.0, 6.0), square(4.0, 6.0, 1.0, 5.0)]), 1);
        assert_eq!(parts(&[square(4.0, -1.0, 1.0, 6.0), square(3.0, 4.0, 3.0, 7.0)]), 2);
        // A closed diamond of four slanted bars has an inside.
        let bar = |a: [f64; 2], b: [f64; 2]| {
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let n = [-0.1 * dy, 0.1 * dx];
            let ends = [[a[0] - 0.1 * dx, a[1] - 0.1 * dy], [b[0] + 0.1 * dx, b[1] + 0.1 * dy]];
            let [p, q] = ends;
            vec![
                [p[0] - n[0], p[1] - n[1]],
                [q[0] - n[0], q[1] - n[1]],
                [q[0] + n[0], q[1] + n[1]],
                [p[0] + n[0], p[1] + n[1]],
            ]
        };
        let (e, n, w, s) = ([8.0, 5.0], [5.0, 8.0], [2.0, 5.0], [5.0, 2.0]);
        assert_eq!(parts(&[bar(e, n), bar(n, w), bar(w, s), bar(s, e)]), 2);
        assert_eq!(parts(&[bar(e, n), bar(n, w), bar(w, s)]), 1);
    }

    #[test]
    fn touching_walls_leave_the_benefit_of_the_doubt() {
        assert_eq!(parts(&[square(4.0, -1.0, 1.0, 6.0), square(4.0, 5.0, 1.0, 6.0)]), 1);
    }
}
