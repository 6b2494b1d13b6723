//! The longest link, in terms of nominal positions.
//!
//! A link is short enough when no two possible positions of its ends are farther apart than the
//! range: ‖z_i − z_j + e‖ ≤ range for every e in Ω_i ⊕ (−Ω_j), which it is enough to ask of the
//! corners of that set (theory.md §5). Along a normal a this says a · (z_i − z_j) ≤ ‖a‖ range − h(a);
//! the axes' normals say all of the ∞-norm, and the Euclidean norm takes normals as they are needed.

use std::collections::BTreeMap;

use super::clearance::{PositionTube, convex_hull};
use super::{Abstraction, dot};
use crate::ir::{ModelId, Norm, Problem};

/// The models at the two ends of a link; `None` for a base.
pub type Ends = [Option<ModelId>; 2];

/// The bound on links, moved inwards by the gap.
#[derive(Clone, Debug)]
pub struct LinkRange {
    /// How it is measured.
    pub norm: Norm,
    /// In metres, less the gap.
    pub length: f64,
    gap: f64,
    dimension: usize,
    /// By ends: points whose hull holds all differences of errors.
    corners: BTreeMap<Ends, Vec<Vec<f64>>>,
}

impl LinkRange {
    /// The range that a problem asks; `None` when links may be of any length.
    pub(super) fn new(problem: &Problem, abstraction: &Abstraction) -> Option<LinkRange> {
        let asked = problem.connectivity.as_ref()?.range.as_ref()?;
        let mut corners = BTreeMap::new();
        let models: Vec<ModelId> = problem.models.ids().collect();
        for &first in &models {
            for second in models.iter().copied().map(Some).chain([None]) {
                let tubes = [Some(first), second].map(|m| m.map(|id| &abstraction.tubes[id]));
                corners.insert([Some(first), second], difference(tubes, problem.dimension, asked.norm));
            }
        }
        Some(LinkRange {
            norm: asked.norm,
            length: asked.length.to_f64() - abstraction.gap,
            gap: abstraction.gap,
            dimension: problem.dimension,
            corners,
        })
    }

    /// The corners of the differences of both ends' errors (of their bounding box in space).
    pub fn corners(&self, ends: Ends) -> &[Vec<f64>] {
        self.corners.get(&ends).map_or(&[], Vec::as_slice)
    }

    /// The normals of the axes, in both directions.
    pub fn axes(&self) -> Vec<Vec<f64>> {
        let unit = |axis: usize, sign: f64| {
            (0..self.dimension).map(|i| if i == axis { sign } else { 0.0 }).collect::<Vec<f64>>()
        };
        (0..self.dimension).flat_map(|axis| [unit(axis, 1.0), unit(axis, -1.0)]).collect()
    }

    /// What `normal · (z_first − z_second)` may be at most.
    pub fn offset(&self, ends: Ends, normal: &[f64]) -> f64 {
        let most = self.corners(ends).iter().map(|c| dot(c, normal)).fold(0.0, f64::max);
        self.length * dot(normal, normal).sqrt() - most
    }

    /// A normal along which `between` = z_first − z_second is too long, if there is one.
    pub fn excess(&self, ends: Ends, between: &[f64]) -> Option<Vec<f64>> {
        let least = self.length + 0.5 * self.gap;
        match self.norm {
            Norm::Infinity => {
                let slack = |normal: &Vec<f64>| self.offset(ends, normal) - dot(normal, between);
                let worst = self.axes().into_iter().min_by(|a, b| slack(a).total_cmp(&slack(b)))?;
                (slack(&worst) < self.length - least).then_some(worst)
            }
            Norm::Euclidean => {
                let moved =
                    |c: &Vec<f64>| -> Vec<f64> { between.iter().zip(c).map(|(a, b)| a + b).collect() };
                let square = |d: &Vec<f64>| dot(d, d);
                let all = self.corners(ends).iter().map(moved);
                let worst = all.max_by(|a, b| square(a).total_cmp(&square(b)))?;
                let distance = square(&worst).sqrt();
                (distance > least).then(|| worst.iter().map(|x| x / distance).collect())
            }
        }
    }
}

/// The corners of the sum of one tube and the reflected other; tubes are symmetric.
fn difference(tubes: [Option<&PositionTube>; 2], dimension: usize, norm: Norm) -> Vec<Vec<f64>> {
    if dimension == 2 && norm == Norm::Euclidean {
        let outline = |tube: Option<&PositionTube>| tube.map_or(vec![[0.0, 0.0]], |t| t.outline().to_vec());
        let [first, second] = tubes.map(outline);
        let sums = first.iter().flat_map(|a| second.iter().map(|b| [a[0] + b[0], a[1] + b[1]]));
        return convex_hull(sums.collect()).into_iter().map(|c| c.to_vec()).collect();
    }
    let mut corners = vec![Vec::new()];
    for axis in 0..dimension {
        let unit: Vec<f64> = (0..dimension).map(|i| f64::from(u8::from(i == axis))).collect();
        let half: f64 = tubes.iter().flatten().map(|tube| tube.support(&unit)).sum();
        let both = |corner: Vec<f64>| [-half, half].map(|x| [corner.clone(), vec![x]].concat());
        corners = corners.into_iter().flat_map(both).collect();
    }
    corners
}
