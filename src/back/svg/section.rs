//! What of a tube concerns positions: where a robot can be around its nominal position.

use super::outline::Outline;
use super::projection::Projection;
use crate::plan::Tube;

/// Generators shorter than this share of all of them together can't be seen.
const UNSEEN: f64 = 1e-6;

/// The zonotope Ω of position errors: center ⊕ Σ [−1, 1] generator, one entry a coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// The middle.
    pub center: Vec<f64>,
    /// The generators.
    pub generators: Vec<Vec<f64>>,
}

impl Section {
    /// The rows `axes` of Σ_i D_i ŵ, where every ŵ comes from the tube's box.
    pub fn new(tube: &Tube, axes: &[usize]) -> Section {
        let column = |d: &Vec<Vec<f64>>, j: usize, weight: f64| -> Vec<f64> {
            axes.iter()
                .map(|&a| d.get(a).and_then(|row| row.get(j)).copied().unwrap_or(0.0) * weight)
                .collect()
        };
        let mut center = vec![0.0; axes.len()];
        let mut generators = Vec::new();
        for d in &tube.d {
            for (j, (middle, half)) in tube.center.iter().zip(&tube.half_width).enumerate() {
                center.iter_mut().zip(column(d, j, *middle)).for_each(|(sum, x)| *sum += x);
                generators.push(column(d, j, *half));
            }
        }
        Section { center, generators }
    }

    /// max a·e over the section.
    pub fn support(&self, direction: &[f64]) -> f64 {
        let dot = |v: &[f64]| direction.iter().zip(v).map(|(a, x)| a * x).sum::<f64>();
        dot(&self.center) + self.generators.iter().map(|g| dot(g).abs()).sum::<f64>()
    }

    /// Its outline in a projection.
    pub fn outline(&self, projection: &Projection) -> Outline {
        let total: f64 = self.generators.iter().map(|g| length(g)).sum();
        let mut outline = Outline { corners: vec![projection.flat(&self.center)], radius: 0.0 };
        for generator in self.generators.iter().filter(|g| length(g) > UNSEEN * total) {
            let g = projection.flat(generator);
            let moved = |sign: f64| {
                outline
                    .corners
                    .iter()
                    .map(move |c| [c[0] + sign * g[0], c[1] + sign * g[1]])
                    .collect::<Vec<_>>()
            };
            outline = Outline::hull([moved(1.0), moved(-1.0)].concat());
        }
        outline
    }

    /// The outline of −Ω: what blockers grow by.
    pub fn mirrored(&self, projection: &Projection) -> Outline {
        let corners = self.outline(projection).corners.iter().map(|c| [-c[0], -c[1]]).collect();
        Outline::hull(corners)
    }

    /// The extreme errors: its corners in the plane, in space those of the box around it.
    pub fn corners(&self) -> Vec<Vec<f64>> {
        if self.center.len() < 3 {
            return self.outline(&Projection::TOP).corners.iter().map(|c| c.to_vec()).collect();
        }
        let half =
            |axis: usize| self.generators.iter().map(|g| g.get(axis).map_or(0.0, |x| x.abs())).sum::<f64>();
        let corner = |bits: usize| {
            let along =
                |(axis, c): (usize, &f64)| c + if bits >> axis & 1 == 1 { half(axis) } else { -half(axis) };
            self.center.iter().enumerate().map(along).collect()
        };
        (0..8).map(corner).collect()
    }
}

fn length(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}
