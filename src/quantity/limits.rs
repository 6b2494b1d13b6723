//! How large, small and long a mission's numbers may be.

use std::sync::LazyLock;

use crate::exact::Rational;

/// The most bits of numerator and denominator together: numbers up to 1e300 with over a thousand
/// digits behind the point fit, and nothing slows the exact arithmetic down.
pub const MAX_BITS: usize = 8192;

static LARGEST: LazyLock<Rational> = LazyLock::new(|| ten_to(300));
static SMALLEST: LazyLock<Rational> = LazyLock::new(|| ten_to(-300));

fn ten_to(exponent: i32) -> Rational {
    Rational::from_decimal("1", exponent).unwrap_or_default()
}

/// Whether a number is 0 or between 1e-300 and 1e300 in absolute value, and not too long.
pub fn in_range(value: &Rational) -> bool {
    if value.is_zero() {
        return true;
    }
    if value.bits() > MAX_BITS {
        return false;
    }
    let size = value.abs();
    size <= *LARGEST && size >= *SMALLEST
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_range_holds_its_ends() {
        assert!(in_range(&Rational::ZERO));
        assert!(in_range(&ten_to(300)));
        assert!(in_range(&-ten_to(-300)));
        assert!(!in_range(&(ten_to(300) + Rational::ONE)));
        assert!(!in_range(&ten_to(-301)));
        assert!(!in_range(&Rational::ratio(1, 3).pow(4000).unwrap()));
    }
}
