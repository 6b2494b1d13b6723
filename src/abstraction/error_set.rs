//! The exact Ω of a model: supports, and the position part as a polytope.

use std::collections::BTreeMap;

use crate::exact::{Rational, primitive};
use crate::geometry::Polytope;
use crate::ir::{Model, Piece};
use crate::tube::Tube;

/// Ω of a model in exact numbers, taken from the tube's doubles as they stand.
#[derive(Clone, Debug)]
pub struct ErrorSet {
    center: Vec<Rational>,
    /// The columns D_i e_j · half_width_j that are not 0.
    generators: Vec<Vec<Rational>>,
    /// The position part.
    positions: Polytope,
}

impl ErrorSet {
    /// The exact Ω of a tube with finite numbers; `None` when some are not.
    pub fn new(model: &Model, tube: &Tube) -> Option<ErrorSet> {
        let exact = |x: &f64| Rational::from_f64(*x);
        let half_width = tube.half_width.iter().map(exact).collect::<Option<Vec<_>>>()?;
        let box_center = tube.center.iter().map(exact).collect::<Option<Vec<_>>>()?;
        let mut center = vec![Rational::ZERO; model.n()];
        let mut generators = Vec::new();
        for d in &tube.d {
            for (j, column) in d.column_iter().enumerate() {
                let column = column.iter().map(exact).collect::<Option<Vec<_>>>()?;
                center.iter_mut().zip(&column).for_each(|(c, x)| *c += x * &box_center[j]);
                if column.iter().any(|x| !x.is_zero()) {
                    generators.push(column.iter().map(|x| x * &half_width[j]).collect());
                }
            }
        }
        let positions = positions(&model.position, &center, &generators)?;
        Some(ErrorSet { center, generators, positions })
    }

    /// max {direction · e : e ∈ Ω}; one entry a state, exact.
    pub fn support(&self, direction: &[Rational]) -> Rational {
        let dot = |v: &[Rational]| crate::exact::dot(direction, v);
        dot(&self.center) + self.generators.iter().map(|g| dot(g).abs()).sum::<Rational>()
    }

    /// The position part of Ω, around the nominal position.
    pub fn positions(&self) -> &Polytope {
        &self.positions
    }

    /// The half-width of the position part along a coordinate (of its bounding box).
    pub fn half_width(&self, axis: usize) -> Rational {
        let (lo, hi) = self.positions.bounding_box();
        (&hi[axis] - &lo[axis]) / Rational::from(2)
    }
}

/// The zonotope of the generators' position parts; parallel ones are added up first, so that
/// decoupled axes give a box at once. `None` when it is flat.
fn positions(position: &[usize], center: &[Rational], generators: &[Vec<Rational>]) -> Option<Polytope> {
    let mut directions: BTreeMap<Vec<Rational>, Rational> = BTreeMap::new();
    for generator in generators {
        let part: Vec<Rational> = position.iter().map(|&i| generator[i].clone()).collect();
        let Some(axis) = part.iter().position(|x| !x.is_zero()) else { continue };
        let mut direction = primitive(&part);
        if direction[axis].is_negative() {
            direction.iter_mut().for_each(|x| *x = -&*x);
        }
        let length = (&part[axis] / &direction[axis]).abs();
        *directions.entry(direction).or_default() += length;
    }
    let middle: Vec<Rational> = position.iter().map(|&i| center[i].clone()).collect();
    let mut points = vec![middle];
    let mut hull = None;
    for (direction, length) in &directions {
        let step: Vec<Rational> = direction.iter().map(|x| x * length).collect();
        let moved = |sign: i64| {
            move |p: &Vec<Rational>| -> Vec<Rational> {
                p.iter().zip(&step).map(|(x, s)| x + s * Rational::from(sign)).collect()
            }
        };
        let (back, forth) = (moved.clone()(-1), moved(1));
        points = points.iter().map(back).chain(points.iter().map(forth)).collect();
        if let Ok(polytope) = Polytope::hull(&points) {
            points.clone_from(&polytope.vertices);
            hull = Some(polytope);
        }
    }
    hull
}

/// Whether a closed polytope and a piece have a point in common.
pub(super) fn meets(polytope: &Polytope, piece: &Piece) -> bool {
    match piece {
        Piece::Polytope(other) => polytope.intersects(other),
        Piece::Ball { center, spread, radius } => {
            let reach = polytope.widened(spread);
            reach.squared_distance(center) <= radius * radius
        }
    }
}
