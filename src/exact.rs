//! Exact rational numbers: the arithmetic of missions and of the checker.
//!
//! This is the only module that names `dashu`. Every number of a mission is a [`Rational`] from the
//! moment it is read; a double becomes one without loss, and the way back rounds in a direction
//! that the caller chooses.

use std::cmp::Ordering;
use std::fmt;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use dashu_base::{BitTest, Gcd, UnsignedAbs};
use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;

mod repr;

use repr::Repr;

/// A matrix of exact numbers, row-major in meaning (`m[(row, column)]`).
pub type RationalMatrix = nalgebra::DMatrix<Rational>;

/// An exact rational number, always in lowest terms.
#[derive(Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Rational(Repr);

impl Rational {
    /// The number 0.
    pub const ZERO: Rational = Rational(Repr::ZERO);
    /// The number 1.
    pub const ONE: Rational = Rational(Repr::ONE);

    /// The quotient of two machine integers.
    ///
    /// # Panics
    /// When `denominator` is 0.
    pub fn ratio(numerator: i64, denominator: i64) -> Rational {
        Rational(Repr::of(RBig::from_parts_signed(numerator.into(), denominator.into())))
    }

    /// The double as the exact number that it is; `None` for NaN and infinities.
    pub fn from_f64(value: f64) -> Option<Rational> {
        Repr::from_f64(value).map(Rational)
    }

    /// `digits · 10^exponent`, where `digits` is a run of decimal digits.
    ///
    /// The caller bounds the length of `digits` and the size of `exponent`: nothing here does.
    pub fn from_decimal(digits: &str, exponent: i32) -> Option<Rational> {
        let mantissa = UBig::from_str_radix(digits, 10).ok()?;
        let power = UBig::from(10u8).pow(exponent.unsigned_abs() as usize);
        let (num, den) = if exponent < 0 { (mantissa, power) } else { (mantissa * power, UBig::ONE) };
        Some(Rational(Repr::of(RBig::from_parts(num.into(), den))))
    }

    /// The double nearest to the number (infinite beyond the range of doubles).
    pub fn to_f64(&self) -> f64 {
        self.0.to_f64()
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
        self.0.is_integer()
    }

    /// The value as a machine integer, if it is whole and fits.
    pub fn to_i64(&self) -> Option<i64> {
        if !self.is_integer() {
            return None;
        }
        i64::try_from(self.0.ratio().numerator()).ok()
    }

    /// The largest whole number that is not above the number.
    pub fn floor(&self) -> Rational {
        Rational(Repr::dyadic(self.0.ratio().floor(), 0))
    }

    /// The smallest whole number that is not below the number.
    pub fn ceil(&self) -> Rational {
        Rational(Repr::dyadic(self.0.ratio().ceil(), 0))
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
        Some(Rational(self.0.pow(exponent.unsigned_abs())))
    }

    /// The quotient; `None` when `divisor` is 0.
    pub fn checked_div(&self, divisor: &Rational) -> Option<Rational> {
        (!divisor.is_zero()).then(|| self / divisor)
    }

    /// The number of bits of numerator and denominator together: what computing with it costs.
    pub fn bits(&self) -> usize {
        let ratio = self.0.ratio();
        ratio.numerator().bit_len() + ratio.denominator().bit_len()
    }

    /// A whole number e with 2^(e−1) < |x| < 2^(e+1); meaningless for 0.
    pub fn binary_magnitude(&self) -> i64 {
        let ratio = self.0.ratio();
        ratio.numerator().bit_len() as i64 - ratio.denominator().bit_len() as i64
    }

    /// Numerator and denominator as decimal text, in lowest terms with a positive denominator.
    pub fn parts(&self) -> (String, String) {
        let ratio = self.0.ratio();
        (ratio.numerator().to_string(), ratio.denominator().to_string())
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
        let ratio = x.0.ratio();
        let d = ratio.denominator();
        denominator = &denominator / (&denominator).gcd(d) * d;
    }
    let scale = Rational(Repr::dyadic(denominator.into(), 0));
    let whole: Vec<Rational> = vector.iter().map(|x| x * &scale).collect();
    let divisor = whole.iter().fold(UBig::ZERO, |g, x| gcd(&g, x.0.ratio().numerator()));
    if divisor == UBig::ZERO {
        return vector.to_vec();
    }
    let divisor = Rational(Repr::dyadic(divisor.into(), 0));
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
        Rational(Repr::dyadic(IBig::from(value), 0))
    }
}

impl Default for Rational {
    fn default() -> Rational {
        Rational::ZERO
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
                Rational(self.0.$method(&other.0))
            }
        }
        impl $op<&Rational> for Rational {
            type Output = Rational;
            fn $method(self, other: &Rational) -> Rational {
                Rational(self.0.$method(&other.0))
            }
        }
        impl $op<Rational> for &Rational {
            type Output = Rational;
            fn $method(self, other: Rational) -> Rational {
                Rational(self.0.$method(&other.0))
            }
        }
        impl $op<&Rational> for &Rational {
            type Output = Rational;
            fn $method(self, other: &Rational) -> Rational {
                Rational(self.0.$method(&other.0))
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
        Rational(self.0.neg())
    }
}
impl Neg for &Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        Rational(self.0.neg())
    }
}

macro_rules! assign {
    ($op:ident, $method:ident, $plain:ident) => {
        impl $op for Rational {
            fn $method(&mut self, other: Rational) {
                self.0 = self.0.$plain(&other.0);
            }
        }
        impl $op<&Rational> for Rational {
            fn $method(&mut self, other: &Rational) {
                self.0 = self.0.$plain(&other.0);
            }
        }
    };
}
assign!(AddAssign, add_assign, add);
assign!(SubAssign, sub_assign, sub);
assign!(MulAssign, mul_assign, mul);

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
        let other = Rational::from(*other);
        *self == other
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
            return write!(f, "{}", self.0.ratio().numerator());
        }
        let mut scaled = self.abs();
        let ten = Rational::from(10);
        for places in 1..=18usize {
            scaled *= &ten;
            if scaled.is_integer() {
                let digits =
                    format!("{:0>width$}", scaled.0.ratio().numerator().to_string(), width = places + 1);
                let (whole, fraction) = digits.split_at(digits.len() - places);
                let sign = if self.is_negative() { "-" } else { "" };
                return write!(f, "{sign}{whole}.{fraction}");
            }
        }
        {
            let ratio = self.0.ratio();
            write!(f, "{}/{}", ratio.numerator(), ratio.denominator())
        }
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

    /// Numbers of both forms, extreme doubles among them.
    fn numbers() -> Vec<Rational> {
        let doubles = [0.0, 1.0, -0.5, 0.1, 12.0, -1e300, 5e-324, 4.9e-310, f64::MAX, 1.0 + f64::EPSILON];
        let ratios = [(1, 3), (-2, 3), (1, 48), (7, 10), (5, 6), (-1, 6)];
        let doubles = doubles.iter().map(|&x| Rational::from_f64(x).unwrap());
        doubles.chain(ratios.map(|(n, d)| Rational::ratio(n, d))).collect()
    }

    #[test]
    fn both_forms_compute_like_quotients() {
        let same = |found: Rational, expected: RBig, what: &str| {
            assert_eq!(*found.0.ratio(), expected, "{what}");
            // One form only: equality and hashes rely on it.
            assert_eq!(found, Rational(Repr::of(expected)), "{what}");
        };
        for (a, b) in numbers().iter().flat_map(|a| numbers().into_iter().map(move |b| (a.clone(), b))) {
            let (x, y) = (a.0.ratio().into_owned(), b.0.ratio().into_owned());
            let what = format!("{a} and {b}");
            same(&a + &b, &x + &y, &what);
            same(&a - &b, &x - &y, &what);
            same(&a * &b, &x * &y, &what);
            if !b.is_zero() {
                same(&a / &b, &x / &y, &what);
            }
            assert_eq!(a.cmp(&b), x.cmp(&y), "{what}");
        }
    }

    #[test]
    fn every_double_comes_back() {
        let mut bits = 1u64;
        for _ in 0..20_000 {
            bits = bits.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let x = f64::from_bits(bits);
            let exact = Rational::from_f64(x);
            assert_eq!(exact.is_some(), x.is_finite());
            let Some(exact) = exact else { continue };
            assert_eq!(exact.to_f64(), x);
            assert_eq!(*exact.0.ratio(), RBig::try_from(x).unwrap());
            // Between two doubles the nearer one, and the even one in the middle.
            let (up, eps) = (x.next_up(), Rational::ratio(1, 1 << 40));
            if !up.is_finite() || x == 0.0 || up == 0.0 {
                continue;
            }
            let gap = Rational::from_f64(up).unwrap() - &exact;
            let middle = &exact + &gap * Rational::ratio(1, 2);
            assert_eq!(middle.to_f64(), if x.to_bits().is_multiple_of(2) { x } else { up });
            assert_eq!((&middle - &gap * &eps).to_f64(), x);
            assert_eq!((&middle + &gap * &eps).to_f64(), up);
        }
    }

    #[test]
    fn primitive_vectors_keep_their_direction() {
        let v = [Rational::ratio(-3, 10), Rational::ZERO, Rational::ratio(9, 4)];
        assert_eq!(primitive(&v), [Rational::from(-2), Rational::ZERO, Rational::from(15)]);
        assert_eq!(primitive(&[Rational::ZERO]), [Rational::ZERO]);
    }

    #[test]
    fn long_numbers_of_moderate_size_have_a_nearest_double() {
        // Their mantissas are beyond the range of doubles, they themselves are not.
        for (long, down) in [(1500, 1400), (1100, 990), (2300, 1900), (1030, 1030)] {
            let power = |n: i32| Rational::from(2).pow(n).expect("a power");
            let number = (power(long) + Rational::ONE) * power(-down);
            let expected = 2f64.powi(long - down);
            assert_eq!(number.to_f64(), expected, "{long} {down}");
            assert_eq!(number.to_f64_down(), expected);
            assert_eq!(number.to_f64_up(), expected.next_up());
        }
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
