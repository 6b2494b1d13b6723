//! Exact-enough tests of what a candidate leaves open, and the planes that separate.
//!
//! The solid's own directions come first. Where none of them separates, the nearest points of solid
//! and hull say which plane does, if any: between edges that pass each other, corners, round parts.

use super::nearest::{self, Vector, vector};
use super::{Abstraction, Solid, SolidId, dot};
use crate::ir::ModelId;
use crate::tube::Tube;

/// A convex set of possible positions: a nominal position with a model's tube around it, or a point.
#[derive(Clone, Copy, Debug)]
pub struct Body<'a> {
    /// The nominal position.
    pub center: &'a [f64],
    /// The model whose tube is around it; `None` for a base.
    pub model: Option<ModelId>,
}

/// The position part of a model's tube.
#[derive(Clone, Debug)]
pub(super) struct PositionTube {
    /// Generators: the tube is the sum of the segments between each and its negative.
    generators: Vec<Vec<f64>>,
    /// In the plane, the corners, counter-clockwise.
    outline: Vec<[f64; 2]>,
}

impl PositionTube {
    /// The tube over a model's position states. Its centre is 0 (theory.md §2).
    pub(super) fn new(tube: &Tube, position: &[usize]) -> PositionTube {
        let mut generators: Vec<Vec<f64>> = Vec::new();
        for d in &tube.d {
            for (j, width) in tube.half_width.iter().enumerate() {
                let generator: Vec<f64> = position.iter().map(|&s| d[(s, j)] * width).collect();
                if generator.iter().any(|x| *x != 0.0) {
                    generators.push(generator);
                }
            }
        }
        let outline = if position.len() == 2 { outline(&generators) } else { Vec::new() };
        PositionTube { generators, outline }
    }

    /// The generators: the tube is the sum of the segments between each and its negative.
    pub(super) fn generators(&self) -> &[Vec<f64>] {
        &self.generators
    }

    /// The corners in the plane, counter-clockwise.
    pub(super) fn outline(&self) -> &[[f64; 2]] {
        &self.outline
    }

    /// The point of the tube around a middle that lies farthest along a direction.
    pub(super) fn farthest(&self, d: &Vector, middle: Vector) -> Vector {
        let mut point = middle;
        for generator in &self.generators {
            let sign = if dot(&d[..generator.len()], generator) < 0.0 { -1.0 } else { 1.0 };
            point.iter_mut().zip(generator).for_each(|(x, g)| *x += sign * g);
        }
        point
    }

    /// A double that is at least the support: the relative error of so short a sum is far below the
    /// share that is added.
    pub(super) fn support(&self, d: &[f64]) -> f64 {
        let sum: f64 = self.generators.iter().map(|g| dot(d, g).abs()).sum();
        sum * (1.0 + 1e-13)
    }
}

/// The corners of a sum of segments in the plane, as the hull of partial sums in order of angle.
fn outline(generators: &[Vec<f64>]) -> Vec<[f64; 2]> {
    let upward = |g: &Vec<f64>| {
        let flip = g[1] < 0.0 || (g[1] == 0.0 && g[0] < 0.0);
        if flip { [-g[0], -g[1]] } else { [g[0], g[1]] }
    };
    let mut sides: Vec<[f64; 2]> = generators.iter().map(upward).collect();
    sides.sort_by(|a, b| a[1].atan2(a[0]).total_cmp(&b[1].atan2(b[0])));
    let mut corner = [0.0, 0.0];
    sides.iter().for_each(|s| corner = [corner[0] - s[0], corner[1] - s[1]]);
    let mut corners = vec![corner];
    for sign in [2.0, -2.0] {
        for side in &sides {
            corner = [corner[0] + sign * side[0], corner[1] + sign * side[1]];
            corners.push(corner);
        }
    }
    convex_hull(corners)
}

/// A plane with room on both sides.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// The normal, which points at the solid.
    pub normal: Vec<f64>,
    /// The offset.
    pub offset: f64,
    /// The width of the empty slab around it.
    pub width: f64,
}

impl Abstraction {
    /// The plane with the widest slab between the hull of some bodies and a solid, if the slab is at
    /// least half a gap wide.
    pub fn separate(&self, bodies: &[Body<'_>], solid: SolidId) -> Option<Plane> {
        let faces = &self.solids[solid].faces;
        let known = faces.iter().map(|(_, d)| self.slab(bodies, solid, &self.directions[*d].vector));
        widest(known).or_else(|| {
            let normals = self.nearest_normals(bodies, &self.solids[solid]);
            widest(normals.iter().map(|normal| self.slab(bodies, solid, normal)))
        })
    }

    /// The slab between the hull of some bodies and a solid along a normal, if it is wide enough.
    fn slab(&self, bodies: &[Body<'_>], solid: SolidId, normal: &[f64]) -> Option<Plane> {
        let level = self.solids[solid].level(normal);
        let reach = bodies.iter().map(|b| self.reach(b, normal)).fold(f64::MIN, f64::max);
        let width = level - reach;
        let plane = || Plane { normal: normal.to_vec(), offset: level - 0.5 * width, width };
        (width >= 0.5 * self.gap).then(plane)
    }

    /// max d · p over a body's possible positions, never too small by more than rounding.
    pub fn reach(&self, body: &Body<'_>, d: &[f64]) -> f64 {
        dot(d, body.center) + body.model.map_or(0.0, |model| self.tubes[model].support(d))
    }

    /// The unit normals of the widest slab that may lie between the hull of some bodies and a solid.
    fn nearest_normals(&self, bodies: &[Body<'_>], solid: &Solid) -> Vec<Vec<f64>> {
        let farthest = |d: &Vector| {
            let of_body = |b: &Body<'_>| {
                let at = vector(b.center);
                b.model.map_or(at, |model| self.tubes[model].farthest(d, at))
            };
            let points = bodies.iter().map(of_body);
            points.max_by(|a, b| nearest::dot(d, a).total_cmp(&nearest::dot(d, b))).unwrap_or_default()
        };
        let least = |d: &Vector| nearest::minus(&solid.lowest(d), &farthest(d));
        let near = solid.ball.as_ref().map_or(0.0, |ball| ball.radius);
        let first =
            bodies.first().map_or([1.0, 0.0, 0.0], |b| nearest::minus(&solid.middle(), &vector(b.center)));
        let found = nearest::normals(least, &first, near);
        found.iter().filter_map(|v| unit(&v[..self.dimension])).collect()
    }
}

fn widest(planes: impl Iterator<Item = Option<Plane>>) -> Option<Plane> {
    planes.flatten().max_by(|a, b| a.width.total_cmp(&b.width))
}

fn unit(v: &[f64]) -> Option<Vec<f64>> {
    let length = dot(v, v).sqrt();
    (length > 0.0).then(|| v.iter().map(|x| x / length).collect())
}

/// The convex hull of points in the plane, counter-clockwise (Andrew's monotone chain).
pub(super) fn convex_hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let turn =
        |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let half = |points: &mut dyn Iterator<Item = &[f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for &p in points {
            while chain.len() > 1 && turn(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0 {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut points.iter());
    hull.extend(half(&mut points.iter().rev()));
    hull
}

#[cfg(test)]
mod tests;
