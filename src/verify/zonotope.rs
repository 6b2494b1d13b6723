//! Zonotopes in the workspace: the tubes' position parts, exactly.

use std::cmp::Ordering;

use crate::exact::{Rational, dot};

/// The set center + {Σ λ_g g : |λ_g| ≤ 1} in two or three dimensions.
#[derive(Clone, Debug)]
pub(super) struct Zonotope {
    /// The centre of symmetry.
    pub(super) center: Vec<Rational>,
    /// The half-width of the axis-aligned part along each axis.
    box_part: Vec<Rational>,
    /// The generators that are along no axis.
    oblique: Vec<Vec<Rational>>,
}

impl Zonotope {
    /// The zonotope of these generators; those along an axis are gathered.
    pub(super) fn new(
        center: Vec<Rational>,
        generators: impl IntoIterator<Item = Vec<Rational>>,
    ) -> Zonotope {
        let mut zonotope =
            Zonotope { box_part: vec![Rational::ZERO; center.len()], oblique: Vec::new(), center };
        for g in generators {
            let mut along = (0..g.len()).filter(|&axis| !g[axis].is_zero());
            match (along.next(), along.next()) {
                (None, _) => {}
                (Some(axis), None) => zonotope.box_part[axis] += g[axis].abs(),
                _ => zonotope.oblique.push(g),
            }
        }
        zonotope
    }

    /// The single point at the origin.
    pub(super) fn origin(dimension: usize) -> Zonotope {
        Zonotope::new(vec![Rational::ZERO; dimension], [])
    }

    /// max a·p over the zonotope.
    pub(super) fn support(&self, a: &[Rational]) -> Rational {
        let boxed: Rational = a
            .iter()
            .zip(&self.box_part)
            .filter(|(x, w)| !x.is_zero() && !w.is_zero())
            .map(|(x, w)| x.abs() * w)
            .sum();
        let oblique: Rational = self.oblique.iter().map(|g| dot(a, g).abs()).sum();
        dot(a, &self.center) + boxed + oblique
    }

    /// max sign·p[axis] over the zonotope.
    pub(super) fn reach(&self, axis: usize, sign: i8) -> Rational {
        let half = self.half_width(axis);
        if sign < 0 { half - &self.center[axis] } else { half + &self.center[axis] }
    }

    /// {p − q : p in this, q in the other}.
    pub(super) fn minus(&self, other: &Zonotope) -> Zonotope {
        let oblique = self.oblique.iter().chain(&other.oblique).cloned().collect();
        Zonotope {
            center: self.center.iter().zip(&other.center).map(|(a, b)| a - b).collect(),
            box_part: self.box_part.iter().zip(&other.box_part).map(|(a, b)| a + b).collect(),
            oblique,
        }
    }

    /// Points whose hull holds the zonotope: its vertices in the plane, and wherever it is a box;
    /// else those of its bounding box.
    pub(super) fn corners(&self) -> Vec<Vec<Rational>> {
        if self.center.len() == 2 && !self.oblique.is_empty() {
            self.vertices_in_plane()
        } else {
            self.box_corners()
        }
    }

    fn half_width(&self, axis: usize) -> Rational {
        self.oblique.iter().map(|g| g[axis].abs()).sum::<Rational>() + &self.box_part[axis]
    }

    fn box_corners(&self) -> Vec<Vec<Rational>> {
        let mut corners = vec![Vec::new()];
        for axis in 0..self.center.len() {
            let (half, middle) = (self.half_width(axis), &self.center[axis]);
            corners = corners
                .into_iter()
                .flat_map(|corner| {
                    [middle - &half, middle + &half].map(|x| [corner.clone(), vec![x]].concat())
                })
                .collect();
        }
        corners
    }

    /// Walks round the boundary: generators by angle, each added twice.
    fn vertices_in_plane(&self) -> Vec<Vec<Rational>> {
        let axes = (0..2).map(|axis| {
            let mut g = vec![Rational::ZERO; 2];
            g[axis] = self.box_part[axis].clone();
            g
        });
        let mut generators: Vec<Vec<Rational>> =
            axes.chain(self.oblique.iter().cloned()).map(upward).collect();
        generators.sort_by(|g, h| counter_clockwise(g, h));
        let mut at: Vec<Rational> =
            (0..2).map(|axis| -generators.iter().map(|g| &g[axis]).sum::<Rational>()).collect();
        let mut vertices = Vec::new();
        for g in &generators {
            let offset =
                |sign: i64| (0..2).map(|i| &self.center[i] + Rational::from(sign) * &at[i]).collect();
            vertices.extend([offset(1), offset(-1)]);
            for axis in 0..2 {
                at[axis] += &g[axis] + &g[axis];
            }
        }
        vertices
    }
}

/// The generator or its opposite, whichever has an angle in [0, π).
fn upward(g: Vec<Rational>) -> Vec<Rational> {
    let down = g[1].is_negative() || (g[1].is_zero() && g[0].is_negative());
    if down { g.into_iter().map(|x| -x).collect() } else { g }
}

fn counter_clockwise(g: &[Rational], h: &[Rational]) -> Ordering {
    // Zero generators would compare equal to everything and spoil the order: they go first.
    let zero = |g: &[Rational]| g.iter().all(Rational::is_zero);
    match (zero(g), zero(h)) {
        (true, true) => Ordering::Equal,
        (true, false) => Ordering::Less,
        (false, true) => Ordering::Greater,
        _ => (&g[1] * &h[0]).cmp(&(&g[0] * &h[1])),
    }
}
