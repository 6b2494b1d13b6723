//! Convex polytopes in doubles that half-spaces cut in two: the cells of a partition.
//!
//! A cell knows its facets and its corners, and which facets meet in each corner. That is enough to
//! cut it in the plane and in space alike: the corners that a cut brings lie on edges, and two
//! corners have an edge in common if nothing else lies on all the facets that they share.

use crate::abstraction::{Directions, HalfSpace, dot};

/// A convex polytope with an interior.
#[derive(Clone, Debug)]
pub struct Cell {
    /// The half-spaces whose intersection it is, none redundant.
    pub facets: Vec<HalfSpace>,
    corners: Vec<Corner>,
}

#[derive(Clone, Debug)]
struct Corner {
    at: Vec<f64>,
    /// The facets that meet here, rising.
    on: Vec<usize>,
}

/// Where a cell lies with respect to a half-space, up to a grain.
#[derive(Clone, Debug)]
pub enum Side {
    /// All in it.
    Inside,
    /// All beyond it.
    Outside,
    /// Cut in two: the part inside, the part outside.
    Cut(Box<(Cell, Cell)>),
}

impl Cell {
    /// The box between two corners.
    pub fn from_box(directions: &Directions, lo: &[f64], hi: &[f64]) -> Cell {
        let mut facets = Vec::new();
        for axis in 0..lo.len() {
            facets.push(HalfSpace { direction: directions.axis(axis, false), offset: -lo[axis] });
            facets.push(HalfSpace { direction: directions.axis(axis, true), offset: hi[axis] });
        }
        let corner = |choice: usize| {
            let upper = |axis: usize| choice >> axis & 1;
            let at = (0..lo.len()).map(|axis| if upper(axis) == 0 { lo[axis] } else { hi[axis] });
            let on = (0..lo.len()).map(|axis| 2 * axis + upper(axis));
            Corner { at: at.collect(), on: on.collect() }
        };
        Cell { facets, corners: (0..1usize << lo.len()).map(corner).collect() }
    }

    /// The corners, in no particular order.
    pub fn corners(&self) -> impl Iterator<Item = &[f64]> + Clone {
        self.corners.iter().map(|c| &c.at[..])
    }

    /// The mean of the corners, a point of the interior.
    pub fn middle(&self) -> Vec<f64> {
        let count = self.corners.len() as f64;
        let axes = 0..self.corners.first().map_or(0, |c| c.at.len());
        axes.map(|axis| self.corners().map(|p| p[axis]).sum::<f64>() / count).collect()
    }

    /// max d · z over the cell.
    pub fn reach(&self, d: &[f64]) -> f64 {
        self.corners().map(|p| dot(d, p)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether a point lies in the cell or within the grain of it.
    pub fn holds(&self, directions: &Directions, point: &[f64], grain: f64) -> bool {
        self.facets.iter().all(|f| dot(&directions[f.direction].vector, point) <= f.offset + grain)
    }

    /// Which side of a half-space the cell lies on. What is thinner than the grain does not count.
    pub fn side(&self, directions: &Directions, half_space: HalfSpace, grain: f64) -> Side {
        let d = &directions[half_space.direction];
        if self.reach(&d.vector) <= half_space.offset + grain {
            return Side::Inside;
        }
        if self.reach(&directions[d.opposite].vector) <= -half_space.offset + grain {
            return Side::Outside;
        }
        let beyond = HalfSpace { direction: d.opposite, offset: -half_space.offset };
        match (self.clip(directions, half_space), self.clip(directions, beyond)) {
            (Some(inside), Some(outside)) => Side::Cut(Box::new((inside, outside))),
            (Some(_), None) => Side::Inside,
            _ => Side::Outside,
        }
    }

    /// The part of the cell in a half-space; `None` when it has no interior.
    pub fn clip(&self, directions: &Directions, half_space: HalfSpace) -> Option<Cell> {
        let d = &directions[half_space.direction].vector;
        let heights: Vec<f64> = self.corners().map(|p| dot(d, p) - half_space.offset).collect();
        let size = heights.iter().fold(0.0f64, |size, h| size.max(h.abs()));
        // A corner this near to the plane, for the size of the cell, lies on it.
        let touch = 1e-12 * (size + half_space.offset.abs());
        if heights.iter().all(|h| *h >= -touch) {
            return None;
        }
        let facet = self.facets.len();
        let mut corners = Vec::new();
        for (corner, height) in self.corners.iter().zip(&heights).filter(|(_, h)| **h <= touch) {
            let mut corner = corner.clone();
            if *height >= -touch {
                corner.on.push(facet);
            }
            corners.push(corner);
        }
        for (i, p) in self.corners.iter().enumerate().filter(|(i, _)| heights[*i] < -touch) {
            for (j, q) in self.corners.iter().enumerate().filter(|(j, _)| heights[*j] > touch) {
                let Some(mut on) = self.edge(p, q) else { continue };
                let share = heights[i] / (heights[i] - heights[j]);
                let at = p.at.iter().zip(&q.at).map(|(a, b)| a + share * (b - a)).collect();
                on.push(facet);
                corners.push(Corner { at, on });
            }
        }
        let mut facets = self.facets.clone();
        facets.push(half_space);
        Cell { facets, corners }.tidied()
    }

    /// The facets that two corners share, if an edge joins them.
    fn edge(&self, p: &Corner, q: &Corner) -> Option<Vec<usize>> {
        let shared: Vec<usize> = p.on.iter().copied().filter(|f| q.on.contains(f)).collect();
        if shared.len() + 1 < p.at.len() {
            return None;
        }
        let on_edge = |c: &&Corner| shared.iter().all(|f| c.on.contains(f));
        (self.corners.iter().filter(on_edge).count() == 2).then_some(shared)
    }

    /// Without the facets that no longer bound anything; `None` when nothing with an interior is left.
    fn tidied(mut self) -> Option<Cell> {
        let dimension = self.corners.first()?.at.len();
        let corners_on = |facet: usize| self.corners.iter().filter(|c| c.on.contains(&facet)).count();
        let kept: Vec<usize> = (0..self.facets.len()).filter(|&f| corners_on(f) >= dimension).collect();
        for corner in &mut self.corners {
            corner.on = corner.on.iter().filter_map(|f| kept.binary_search(f).ok()).collect();
        }
        self.facets = kept.iter().map(|&f| self.facets[f]).collect();
        (self.corners.len() > dimension && self.facets.len() > dimension).then_some(self)
    }

    /// The union with a cell on the other side of a common facet, if it is convex.
    ///
    /// It is convex if it equals its envelope: what the facets of either cell bound that the other
    /// one does not cross (Bemporad, Fukuda and Torrisi 2001).
    pub fn united(&self, other: &Cell, directions: &Directions, room: &Cell, grain: f64) -> Option<Cell> {
        let border = self.border(other, directions, grain)?;
        let mut union = room.clone();
        for (own, across) in [(self, other), (other, self)] {
            for facet in &own.facets {
                if across.reach(&directions[facet.direction].vector) <= facet.offset + grain {
                    union = union.clip_or_keep(directions, *facet, grain)?;
                }
            }
        }
        let beyond = HalfSpace { direction: directions[border.direction].opposite, offset: -border.offset };
        let covered = |part: Option<Cell>, by: &Cell| {
            part.is_some_and(|part| part.corners().all(|p| by.holds(directions, p, grain)))
        };
        let whole =
            covered(union.clip(directions, border), self) && covered(union.clip(directions, beyond), other);
        whole.then_some(union)
    }

    /// The facet that has this cell inside and the other one beyond it.
    fn border(&self, other: &Cell, directions: &Directions, grain: f64) -> Option<HalfSpace> {
        let shared = |f: &&HalfSpace| {
            let opposite = directions[f.direction].opposite;
            other.facets.iter().any(|g| g.direction == opposite && (g.offset + f.offset).abs() <= grain)
        };
        self.facets.iter().find(shared).copied()
    }

    /// As [`clip`](Cell::clip), but a half-space that holds the whole cell leaves it as it is.
    fn clip_or_keep(self, directions: &Directions, half_space: HalfSpace, grain: f64) -> Option<Cell> {
        if self.reach(&directions[half_space.direction].vector) <= half_space.offset + 1e-3 * grain {
            return Some(self);
        }
        self.clip(directions, half_space)
    }
}
