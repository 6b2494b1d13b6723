//! Zonotopes in the workspace: the tubes' position parts, exactly.

use std::cell::RefCell;
use std::cmp::Ordering;
use std::collections::HashMap;

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
    /// What the oblique generators reach along the directions asked so far: planes repeat their
    /// normals from step to step, and coupled dynamics have dozens of generators.
    asked: RefCell<HashMap<Vec<Rational>, Rational>>,
}

impl Zonotope {
    /// The zonotope of these generators; those along an axis are gathered.
    pub(super) fn new(
        center: Vec<Rational>,
        generators: impl IntoIterator<Item = Vec<Rational>>,
    ) -> Zonotope {
        let mut zonotope = Zonotope {
            box_part: vec![Rational::ZERO; center.len()],
            oblique: Vec::new(),
            center,
            asked: RefCell::default(),
        };
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
        dot(a, &self.center) + boxed + self.oblique_reach(a)
    }

    /// Σ |a·g| over the oblique generators.
    fn oblique_reach(&self, a: &[Rational]) -> Rational {
        if self.oblique.is_empty() {
            return Rational::ZERO;
        }
        let mut asked = self.asked.borrow_mut();
        if let Some(reach) = asked.get(a) {
            return reach.clone();
        }
        let reach: Rational = self.oblique.iter().map(|g| dot(a, g).abs()).sum();
        asked.insert(a.to_vec(), reach.clone());
        reach
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
            asked: RefCell::default(),
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

#[cfg(test)]
mod tests {
    use super::*;

    fn row<const N: usize>(entries: [i64; N]) -> Vec<Rational> {
        entries.map(Rational::from).to_vec()
    }

    /// The hull of all sign combinations, by its supports.
    fn agrees(center: Vec<Rational>, generators: &[Vec<Rational>], exact: bool) {
        let zonotope = Zonotope::new(center.clone(), generators.to_vec());
        let sums: Vec<Vec<Rational>> = (0..1usize << generators.len())
            .map(|bits| {
                let signed = |i: usize, x: &Rational| if bits >> i & 1 == 1 { x.clone() } else { -x };
                let along = |axis: usize| {
                    generators.iter().enumerate().map(|(i, g)| signed(i, &g[axis])).sum::<Rational>()
                };
                (0..center.len()).map(|axis| &center[axis] + along(axis)).collect()
            })
            .collect();
        for (x, y, z) in (-3..=3).flat_map(|x| (-3..=3).flat_map(move |y| (-1..=1).map(move |z| (x, y, z)))) {
            let a = row([x, y, z])[..center.len()].to_vec();
            let highest = |points: &[Vec<Rational>]| points.iter().map(|p| dot(&a, p)).max().unwrap();
            assert_eq!(zonotope.support(&a), highest(&sums));
            let cornered = highest(&zonotope.corners());
            assert!(
                if exact { cornered == highest(&sums) } else { cornered >= highest(&sums) },
                "along {a:?}"
            );
        }
        for axis in 0..center.len() {
            assert_eq!(zonotope.reach(axis, 1), sums.iter().map(|p| p[axis].clone()).max().unwrap());
            assert_eq!(zonotope.reach(axis, -1), -sums.iter().map(|p| p[axis].clone()).min().unwrap());
        }
    }

    #[test]
    fn supports_and_corners_are_those_of_all_sign_combinations() {
        agrees(row([1, -2]), &[row([2, 0]), row([0, -3]), row([-1, 0])], true);
        agrees(row([0, 0]), &[row([2, 1]), row([-1, 3]), row([0, 2]), row([-4, -2]), row([5, -1])], true);
        agrees(row([3, 1]), &[row([1, 1]), row([0, 0])], true);
        agrees(row([0, 7]), &[], true);
        agrees(row([1, 2, 3]), &[row([1, 0, 0]), row([0, 0, -2]), row([0, 1, 0]), row([0, 0, 1])], true);
        agrees(row([1, 2, 3]), &[row([1, 1, 0]), row([0, 1, -2])], false);
    }

    #[test]
    fn a_difference_reflects_the_second() {
        let one = Zonotope::new(row([1, 0]), [row([1, 1])]);
        let other = Zonotope::new(row([5, 2]), [row([2, 0])]);
        let difference = one.minus(&other);
        assert_eq!(difference.support(&row([1, 0])), one.reach(0, 1) + other.reach(0, -1));
        assert_eq!(difference.center, row([-4, -2]));
    }
}
