//! Intervals of doubles with outward rounding: what they show holds in exact arithmetic.

use std::ops::{Add, Mul};

use crate::exact::Rational;

/// A closed interval that holds the exact value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Not above the exact value.
    pub lo: f64,
    /// Not below the exact value.
    pub hi: f64,
}

impl Interval {
    /// The number 0.
    pub const ZERO: Interval = Interval { lo: 0.0, hi: 0.0 };

    /// A double.
    pub fn point(value: f64) -> Interval {
        Interval { lo: value, hi: value }
    }

    /// The doubles next to an exact number.
    pub fn around(value: &Rational) -> Interval {
        Interval { lo: value.to_f64_down(), hi: value.to_f64_up() }
    }

    /// Whether the exact value is known to be 0.
    pub fn is_zero(self) -> bool {
        self.lo == 0.0 && self.hi == 0.0
    }

    /// An upper bound on the product with any number of an interval.
    pub fn most_over(self, lower: f64, upper: f64) -> f64 {
        if self.is_zero() { 0.0 } else { (self * Interval { lo: lower, hi: upper }).hi }
    }
}

impl Add for Interval {
    type Output = Interval;
    fn add(self, other: Interval) -> Interval {
        if self.is_zero() {
            return other;
        }
        if other.is_zero() {
            return self;
        }
        Interval { lo: (self.lo + other.lo).next_down(), hi: (self.hi + other.hi).next_up() }
    }
}

impl Mul for Interval {
    type Output = Interval;
    fn mul(self, other: Interval) -> Interval {
        if self.is_zero() || other.is_zero() {
            return Interval::ZERO;
        }
        let ends = [self.lo * other.lo, self.lo * other.hi, self.hi * other.lo, self.hi * other.hi];
        // 0 · ∞ is no number; the interval then reaches everywhere.
        if ends.iter().any(|x| x.is_nan()) {
            return Interval { lo: f64::NEG_INFINITY, hi: f64::INFINITY };
        }
        Interval {
            lo: ends.iter().copied().fold(f64::INFINITY, f64::min).next_down(),
            hi: ends.iter().copied().fold(f64::NEG_INFINITY, f64::max).next_up(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_and_products_hold_the_exact_value() {
        let tenth = Interval::around(&Rational::ratio(1, 10));
        assert!(tenth.lo < tenth.hi);
        let sum = (0..10).fold(Interval::ZERO, |a, _| a + tenth);
        assert!(sum.lo <= 1.0 && 1.0 <= sum.hi && sum.hi - sum.lo < 1e-14);
        let product = tenth * Interval::point(-30.0);
        assert!(product.lo <= -3.0 && -3.0 <= product.hi);
        assert_eq!(Interval::ZERO.most_over(f64::NEG_INFINITY, f64::INFINITY), 0.0);
    }
}
