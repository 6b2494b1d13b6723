//! Exact rational numbers: the arithmetic of missions and of the checker.
//!
//! This is the only module that names `dashu`. Every number of a mission is a [`Rational`] from the
//! moment it is read; a double becomes one without loss, and the way back rounds in a direction
//! that the caller chooses.

use std::cmp::Ordering;
use std::fmt;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use dashu_base::{BitTest, Gcd, Signed, UnsignedAbs};
use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;

/// A matrix of exact numbers, row-major in meaning (`m[(row, column)]`).
pub type RationalMatrix = nalgebra::DMatrix<Rational>;

/// An exact rational number, always in lowest terms.
#[derive(Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct Rational(RBig);

impl Rational {
    /// The number 0.
    pub const ZERO: Rational = Rational(RBig::ZERO);
    /// The number 1.
    pub const ONE: Rational = Rational(RBig::ONE);

    /// The quotient of two machine integers.
    ///
    /// # Panics
    /// When `denominator` is 0.
    pub fn ratio(numerator: i64, denominator: i64) -> Rational {
        Rational(RBig::from_parts_signed(numerator.into(), denominator.into()))
    }

    /// The double as the exact number that it is; `None` for NaN and infinities.
    pub fn from_f64(value: f64) -> Option<Rational> {
        RBig::try_from(value).ok().map(Rational)
    }

    /// `digits · 10^exponent`, where `digits` is a run of decimal digits.
    ///
    /// The caller bounds the length of `digits` and the size of `exponent`: nothing here does.
    pub fn from_decimal(digits: &str, exponent: i32) -> Option<Rational> {
        let mantissa = UBig::from_str_radix(digits, 10).ok()?;
        let power = UBig::from(10u8).pow(exponent.unsigned_abs() as usize);
        let (num, den) = if exponent < 0 { (mantissa, power) } else { (mantissa * power, UBig::ONE) };
        Some(Rational(RBig::from_parts(num.into(), den)))
    }

    /// The double nearest to the number (infinite beyond the range of doubles).
    pub fn to_f64(&self) -> f64 {
        self.0.to_f64().value()
    }

    /// The largest double that is not above the number.
    pub fn to_f64_down(&self) -> f64 {
        let near = self.to_f64();
        match Rational::from_f64(near) {
            Some(r) if r <= *self => near,
            _ => near.next_down(),
        }
    }

    /// The smallest double that is not below the number.
    pub fn to_f64_up(&self) -> f64 {
        -(-self).to_f64_down()
    }

    /// The absolute value.
    pub fn abs(&self) -> Rational {
        if self.is_negative() { -self } else { self.clone() }
    }

    /// Whether the number is below 0.
    pub fn is_negative(&self) -> bool {
        self.0.is_negative()
    }

    /// Whether the number is above 0.
    pub fn is_positive(&self) -> bool {
        !self.is_zero() && !self.is_negative()
    }

    /// Whether the number is 0.
    pub fn is_zero(&self) -> bool {
        self.0.is_zero()
    }

    /// Whether the number is whole.
    pub fn is_integer(&self) -> bool {
        self.0.denominator().is_one()
    }

    /// The value as a machine integer, if it is whole and fits.
    pub fn to_i64(&self) -> Option<i64> {
        if !self.is_integer() {
            return None;
        }
        i64::try_from(self.0.numerator()).ok()
    }

    /// The largest whole number that is not above the number.
    pub fn floor(&self) -> Rational {
        Rational(RBig::from(self.0.floor()))
    }

    /// The smallest whole number that is not below the number.
    pub fn ceil(&self) -> Rational {
        Rational(RBig::from(self.0.ceil()))
    }

    /// The number to a whole power; `None` for 0 to a negative one.
    ///
    /// The caller bounds `exponent`: nothing here does.
    pub fn pow(&self, exponent: i32) -> Option<Rational> {
        if exponent < 0 {
            if self.is_zero() {
                return None;
            }
            return (Rational::ONE / self).pow(exponent.checked_neg()?);
        }
        Some(Rational(self.0.pow(exponent as isize)))
    }

    /// The quotient; `None` when `divisor` is 0.
    pub fn checked_div(&self, divisor: &Rational) -> Option<Rational> {
        (!divisor.is_zero()).then(|| self / divisor)
    }

    /// The number of bits of numerator and denominator together: what computing with it costs.
    pub fn bits(&self) -> usize {
        self.0.numerator().bit_len() + self.0.denominator().bit_len()
    }

    /// A whole number e with 2^(e−1) < |x| < 2^(e+1); meaningless for 0.
    pub fn binary_magnitude(&self) -> i64 {
        self.0.numerator().bit_len() as i64 - self.0.denominator().bit_len() as i64
    }

    /// Numerator and denominator as decimal text, in lowest terms with a positive denominator.
    pub fn parts(&self) -> (String, String) {
        (self.0.numerator().to_string(), self.0.denominator().to_string())
    }

    /// The smaller of two numbers.
    pub fn min_of<'a>(a: &'a Rational, b: &'a Rational) -> &'a Rational {
        if b < a { b } else { a }
    }

    /// The larger of two numbers.
    pub fn max_of<'a>(a: &'a Rational, b: &'a Rational) -> &'a Rational {
        if b > a { b } else { a }
    }
}

/// The scalar product of two vectors of the same length.
pub fn dot(a: &[Rational], b: &[Rational]) -> Rational {
    debug_assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(x, y)| !x.is_zero() && !y.is_zero()).map(|(x, y)| x * y).sum()
}

/// The positive multiple of a vector whose entries are whole and have no common divisor; a zero
/// vector is returned as it is.
pub fn primitive(vector: &[Rational]) -> Vec<Rational> {
    let mut denominator = UBig::ONE;
    for x in vector {
        let d = x.0.denominator();
        denominator = &denominator / (&denominator).gcd(d) * d;
    }
    let scale = Rational(RBig::from(denominator));
    let whole: Vec<Rational> = vector.iter().map(|x| x * &scale).collect();
    let divisor = whole.iter().fold(UBig::ZERO, |g, x| gcd(&g, x.0.numerator()));
    if divisor == UBig::ZERO {
        return vector.to_vec();
    }
    let divisor = Rational(RBig::from(divisor));
    whole.into_iter().map(|x| x / &divisor).collect()
}

/// The greatest common divisor where 0 divides nothing but itself.
fn gcd(a: &UBig, b: &IBig) -> UBig {
    let b = b.clone().unsigned_abs();
    if *a == UBig::ZERO {
        b
    } else if b == UBig::ZERO {
        a.clone()
    } else {
        a.gcd(&b)
    }
}

impl From<i64> for Rational {
    fn from(value: i64) -> Rational {
        Rational(RBig::from(IBig::from(value)))
    }
}

impl num_traits::Zero for Rational {
    fn zero() -> Rational {
        Rational::ZERO
    }
    fn is_zero(&self) -> bool {
        Rational::is_zero(self)
    }
}

impl num_traits::One for Rational {
    fn one() -> Rational {
        Rational::ONE
    }
}

macro_rules! binary {
    ($op:ident, $method:ident) => {
        impl $op for Rational {
            type Output = Rational;
            fn $method(self, other: Rational) -> Rational {
                Rational($op::$method(self.0, other.0))
            }
        }
        impl $op<&Rational> for Rational {
            type Output = Rational;
            fn $method(self, other: &Rational) -> Rational {
                Rational($op::$method(self.0, &other.0))
            }
        }
        impl $op<Rational> for &Rational {
            type Output = Rational;
            fn $method(self, other: Rational) -> Rational {
                Rational($op::$method(&self.0, other.0))
            }
        }
        impl $op<&Rational> for &Rational {
            type Output = Rational;
            fn $method(self, other: &Rational) -> Rational {
                Rational($op::$method(&self.0, &other.0))
            }
        }
    };
}
binary!(Add, add);
binary!(Sub, sub);
binary!(Mul, mul);
binary!(Div, div);

impl Neg for Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        Rational(-self.0)
    }
}
impl Neg for &Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        Rational(-&self.0)
    }
}

macro_rules! assign {
    ($op:ident, $method:ident) => {
        impl $op for Rational {
            fn $method(&mut self, other: Rational) {
                $op::$method(&mut self.0, other.0);
            }
        }
        impl $op<&Rational> for Rational {
            fn $method(&mut self, other: &Rational) {
                $op::$method(&mut self.0, &other.0);
            }
        }
    };
}
assign!(AddAssign, add_assign);
assign!(SubAssign, sub_assign);
assign!(MulAssign, mul_assign);

impl Sum for Rational {
    fn sum<I: Iterator<Item = Rational>>(iter: I) -> Rational {
        iter.fold(Rational::ZERO, |a, b| a + b)
    }
}
impl<'a> Sum<&'a Rational> for Rational {
    fn sum<I: Iterator<Item = &'a Rational>>(iter: I) -> Rational {
        iter.fold(Rational::ZERO, |a, b| a + b)
    }
}

impl PartialEq<i64> for Rational {
    fn eq(&self, other: &i64) -> bool {
        *self == Rational::from(*other)
    }
}
impl PartialOrd<i64> for Rational {
    fn partial_cmp(&self, other: &i64) -> Option<Ordering> {
        self.partial_cmp(&Rational::from(*other))
    }
}

/// Writes a terminating decimal where there is a short one, else `numerator/denominator`.
impl fmt::Display for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_integer() {
            return write!(f, "{}", self.0.numerator());
        }
        let mut scaled = self.abs();
        let ten = Rational::from(10);
        for places in 1..=18usize {
            scaled *= &ten;
            if scaled.is_integer() {
                let digits = format!("{:0>width$}", scaled.0.numerator().to_string(), width = places + 1);
                let (whole, fraction) = digits.split_at(digits.len() - places);
                let sign = if self.is_negative() { "-" } else { "" };
                return write!(f, "{sign}{whole}.{fraction}");
            }
        }
        write!(f, "{}/{}", self.0.numerator(), self.0.denominator())
    }
}

impl fmt::Debug for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_exact_and_print_short() {
        let tenth = Rational::from_decimal("1", -1).unwrap();
        assert_eq!(tenth, Rational::ratio(1, 10));
        assert_eq!(tenth.to_string(), "0.1");
        assert_eq!((-&tenth).to_string(), "-0.1");
        assert_eq!(Rational::ratio(1, 3).to_string(), "1/3");
        assert_eq!(Rational::ratio(-5, 4).to_string(), "-1.25");
        assert_eq!(Rational::from(12).to_string(), "12");
    }

    #[test]
    fn primitive_vectors_keep_their_direction() {
        let v = [Rational::ratio(-3, 10), Rational::ZERO, Rational::ratio(9, 4)];
        assert_eq!(primitive(&v), [Rational::from(-2), Rational::ZERO, Rational::from(15)]);
        assert_eq!(primitive(&[Rational::ZERO]), [Rational::ZERO]);
    }

    #[test]
    fn rounding_has_the_direction_it_names() {
        let third = Rational::ratio(1, 3);
        let (down, up) = (third.to_f64_down(), third.to_f64_up());
        assert!(Rational::from_f64(down).unwrap() < third);
        assert!(Rational::from_f64(up).unwrap() > third);
        assert_eq!(down.next_up(), up);
        assert_eq!(Rational::from(3).to_f64_down(), 3.0);
        assert_eq!(Rational::from(3).to_f64_up(), 3.0);
        assert!(Rational::from_f64(f64::NAN).is_none());
    }
}
