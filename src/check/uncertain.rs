//! What is certain of an uncertain ball: the points that are in it whichever its numbers are.
//!
//! As something to stay away from, an uncertain ball is every ball that it may be; as somewhere to
//! be, it is what all of them have in common.

use crate::check::typed;
use crate::exact::Rational;
use crate::geometry::Polytope;

/// The norms that balls may have.
#[derive(Clone, Copy)]
pub(super) enum BallNorm {
    One,
    Two,
    Infinity,
}

/// The numbers of a ball: every center within `spread` of the middle, every radius within `growth`.
pub(super) struct BallNumbers {
    pub(super) norm: BallNorm,
    pub(super) center: Vec<Rational>,
    pub(super) spread: Vec<Rational>,
    pub(super) radius: Rational,
    pub(super) growth: Rational,
}

impl BallNumbers {
    /// Whether some number is uncertain.
    pub(super) fn is_uncertain(&self) -> bool {
        self.spread.iter().chain([&self.growth]).any(|s| !s.is_zero())
    }

    /// The intersection of all the balls that it may be; `None` when it has no interior.
    pub(super) fn sure(&self) -> Option<typed::Piece> {
        let radius = &self.radius - &self.growth;
        if !radius.is_positive() {
            return None;
        }
        match self.norm {
            BallNorm::Infinity => {
                let halves: Vec<Rational> = self.spread.iter().map(|s| &radius - s).collect();
                let all = halves.iter().all(Rational::is_positive);
                let corner = |sign: i64| -> Vec<Rational> {
                    self.center.iter().zip(&halves).map(|(c, h)| c + h * Rational::from(sign)).collect()
                };
                all.then(|| typed::Piece::Polytope(Polytope::from_box(&corner(-1), &corner(1))))
            }
            BallNorm::One => {
                // Moving the centre by s changes the norm by at most the sum of |s|, and by all of it
                // somewhere on each facet's side.
                let left = &radius - self.spread.iter().sum::<Rational>();
                let tip = |axis: usize, by: &Rational| {
                    let mut tip = self.center.clone();
                    tip[axis] += by;
                    tip
                };
                let axes = 0..self.center.len();
                let tips: Vec<_> = axes.flat_map(|axis| [tip(axis, &left), tip(axis, &-&left)]).collect();
                left.is_positive().then(|| Polytope::hull(&tips).ok()).flatten().map(typed::Piece::Polytope)
            }
            BallNorm::Two => {
                let corner: Rational = self.spread.iter().map(|s| s * s).sum();
                (corner < &radius * &radius).then(|| typed::Piece::Ball {
                    center: self.center.clone(),
                    spread: self.spread.clone(),
                    radius,
                })
            }
        }
    }
}
