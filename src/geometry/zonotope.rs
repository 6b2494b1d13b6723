//! Zonotopes in doubles, with supports that are rounded outwards.

use nalgebra::DMatrix;

/// The zonotope {Σ_i G_i w_i : w_i in a box}, where each G_i is a matrix of generators and all w_i
/// come from the same box around `center`.
///
/// G_i is the `parts`' i-th matrices on top of each other; directions have as many entries as these
/// have rows together.
#[derive(Clone, Debug)]
pub struct Zonotope<'a> {
    /// Lists of equal length; matrices of one list have the same size.
    pub parts: Vec<&'a [DMatrix<f64>]>,
    /// The middle of the box.
    pub center: &'a [f64],
    /// The half-widths of the box, none negative.
    pub half_width: &'a [f64],
}

impl Zonotope<'_> {
    /// The support max {direction · x}, with an ordinary rounding error of either sign.
    pub fn support(&self, direction: &[f64]) -> f64 {
        let (sum, _) = self.support_with_error(direction);
        sum
    }

    /// A double that is at least the support, exactly understood.
    pub fn support_up(&self, direction: &[f64]) -> f64 {
        let (sum, error) = self.support_with_error(direction);
        (sum + error).next_up()
    }

    /// The support and a bound on how far it can be off.
    ///
    /// Every product and sum of a scalar product of length r loses at most a relative
    /// (1 + ε)^(r+1) − 1 of the sum of absolute values, so the bound is (number of operations on
    /// the longest path) · 2ε · Σ|terms|, and a few subnormal units for underflow.
    fn support_with_error(&self, direction: &[f64]) -> (f64, f64) {
        let (mut sum, mut magnitude, mut terms) = (0.0, 0.0, 0usize);
        for i in 0..self.parts.first().map_or(0, |list| list.len()) {
            for (j, (c, h)) in self.center.iter().zip(self.half_width).enumerate() {
                let (mut product, mut size) = (0.0, 0.0);
                let column = self.parts.iter().flat_map(|list| list[i].column(j).into_iter());
                for (x, a) in column.zip(direction) {
                    product += x * a;
                    size += (x * a).abs();
                }
                sum += product * c + product.abs() * h;
                magnitude += size * (c.abs() + h);
                terms += 1;
            }
        }
        let depth = (terms + direction.len() + 8) as f64;
        (sum, magnitude * depth * 2.0 * f64::EPSILON + depth * depth * f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::Rational;
    use proptest::prelude::*;

    fn exact(x: f64) -> Rational {
        Rational::from_f64(x).unwrap()
    }

    fn exact_support(z: &Zonotope<'_>, direction: &[f64]) -> Rational {
        let mut sum = Rational::ZERO;
        for g in z.parts[0] {
            for (j, column) in g.column_iter().enumerate() {
                let product: Rational =
                    column.iter().zip(direction).map(|(x, a)| exact(*x) * exact(*a)).sum();
                sum += product.abs() * exact(z.half_width[j]) + product * exact(z.center[j]);
            }
        }
        sum
    }

    #[test]
    fn an_off_centre_box_has_different_supports_on_its_sides() {
        let identity = [DMatrix::identity(2, 2)];
        let z = Zonotope { parts: vec![&identity], center: &[1.0, 0.0], half_width: &[2.0, 0.5] };
        assert_eq!((z.support(&[1.0, 0.0]), z.support(&[-1.0, 0.0])), (3.0, 1.0));
        assert_eq!(z.support(&[0.0, 2.0]), 1.0);
    }

    proptest! {
        #[test]
        fn support_up_is_never_below_the_exact_support(
            entries in prop::collection::vec(-1e3f64..1e3, 12),
            direction in prop::collection::vec(-10f64..10.0, 2),
            center in prop::collection::vec(-1f64..1.0, 2),
            half_width in prop::collection::vec(0f64..1.0, 2),
        ) {
            let list: Vec<_> = entries.chunks(4).map(|c| DMatrix::from_row_slice(2, 2, c)).collect();
            let z = Zonotope { parts: vec![&list], center: &center, half_width: &half_width };
            let (up, truth) = (z.support_up(&direction), exact_support(&z, &direction));
            prop_assert!(exact(up) >= truth);
            prop_assert!(up - truth.to_f64() <= 1e-11 * (1.0 + up.abs()) + 1e-7);
        }
    }
}
