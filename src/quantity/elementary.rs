//! Roots, sines and powers, rounded to the nearest double.
//!
//! Each function is enclosed between two rationals by a truncated series; when both ends round to
//! the same double, that double is the answer, else the enclosure is made finer. No floating-point
//! library function is trusted, so the answers are the same on every platform.

use crate::exact::Rational;

/// The first precision tried, in bits behind the point.
const FIRST_PRECISION: u32 = 128;
/// The last one: only values that lie exactly between two doubles get here.
const LAST_PRECISION: u32 = 4096;
/// Powers beyond 2^±this are out of every mission's range.
const MAX_BINARY_EXPONENT: i64 = 1100;

/// The double nearest to π.
pub fn pi() -> Rational {
    exactly(std::f64::consts::PI)
}

/// The double nearest to √x; `None` when x is negative.
pub fn sqrt(x: &Rational) -> Option<Rational> {
    if x.is_negative() {
        return None;
    }
    if x.is_zero() {
        return Some(Rational::ZERO);
    }
    let mut root = x.to_f64().sqrt();
    while x > &middle_squared(root, root.next_up()) {
        root = root.next_up();
    }
    while x < &middle_squared(root.next_down(), root) {
        root = root.next_down();
    }
    Some(exactly(root))
}

/// The double nearest to the sine of x radians.
pub fn sin(x: &Rational) -> Rational {
    if x.is_zero() {
        return Rational::ZERO;
    }
    nearest(|precision| sine_of_quarter(x, 0, precision))
}

/// The double nearest to the cosine of x radians.
pub fn cos(x: &Rational) -> Rational {
    if x.is_zero() {
        return Rational::ONE;
    }
    nearest(|precision| sine_of_quarter(x, 1, precision))
}

/// The double nearest to x^y for x > 0; `None` when it is beyond the range of all missions.
pub fn power(x: &Rational, y: &Rational) -> Option<Rational> {
    if !x.is_positive() {
        return None;
    }
    if *x == Rational::ONE || y.is_zero() {
        return Some(Rational::ONE);
    }
    let rough = y * &logarithm(x, FIRST_PRECISION + magnitude_bits(y));
    if rough.abs() > MAX_BINARY_EXPONENT {
        return None;
    }
    Some(nearest(|precision| {
        let exponent = y * &logarithm(x, precision + magnitude_bits(y) + 8);
        let value = exponential(&exponent, precision + 8);
        let slack = &value * &two_to(-(i64::from(precision)));
        (&value - &slack, value + slack)
    }))
}

/// Refines an enclosure until both ends round to one double.
fn nearest(enclose: impl Fn(u32) -> (Rational, Rational)) -> Rational {
    let mut precision = FIRST_PRECISION;
    loop {
        let (lo, hi) = enclose(precision);
        let (from, to) = (lo.to_f64(), hi.to_f64());
        if from == to || precision >= LAST_PRECISION {
            return exactly(from);
        }
        precision *= 2;
    }
}

/// sin(x + quarters·π/2), enclosed to 2^−precision.
///
/// With |Δπ| ≤ 2^−(p+8+bits of x) the reduced angle is off by less than 2^−(p+6); its truncation and
/// that of at most 2¹² series terms stay below 2^−(p+3) together, and sine and cosine don't amplify.
fn sine_of_quarter(x: &Rational, quarters: i64, precision: u32) -> (Rational, Rational) {
    let fine = precision + 16;
    let half_pi = pi_to(precision + 8 + magnitude_bits(x)) / Rational::from(2);
    let turns = (x / &half_pi + Rational::ratio(1, 2)).floor();
    let angle = truncate(&(x - &turns * &half_pi), fine);
    let quadrant = (&turns + Rational::from(quarters)) / Rational::from(4);
    let quadrant = ((&quadrant - quadrant.floor()) * Rational::from(4)).to_i64();
    let value = match quadrant {
        Some(0) => sine_series(&angle, false, fine),
        Some(1) => sine_series(&angle, true, fine),
        Some(2) => -sine_series(&angle, false, fine),
        _ => -sine_series(&angle, true, fine),
    };
    let slack = two_to(-(i64::from(precision)));
    (&value - &slack, value + slack)
}

/// The Taylor series of sine (or cosine) for |x| < 1.
fn sine_series(x: &Rational, cosine: bool, fine: u32) -> Rational {
    let square = truncate(&(x * x), fine);
    let mut term = if cosine { Rational::ONE } else { x.clone() };
    let mut sum = term.clone();
    let mut k = if cosine { 0 } else { 1 };
    while !term.is_zero() {
        term = truncate(&(-(&term * &square) / Rational::from((k + 1) * (k + 2))), fine);
        if term.abs() <= two_to(-i64::from(fine)) {
            break;
        }
        sum += &term;
        k += 2;
    }
    sum
}

/// π to 2^−bits, by Machin's formula.
fn pi_to(bits: u32) -> Rational {
    let fine = bits + 24;
    Rational::from(16) * arc_tangent_of_inverse(5, fine, false)
        - Rational::from(4) * arc_tangent_of_inverse(239, fine, false)
}

/// atan(1/n), or atanh(1/n) when `hyperbolic`.
fn arc_tangent_of_inverse(n: i64, fine: u32, hyperbolic: bool) -> Rational {
    odd_series(&Rational::ratio(1, n), fine, hyperbolic)
}

/// Σ ± z^(2k+1)/(2k+1): atan z, or atanh z when `hyperbolic`, for |z| ≤ 1/3.
fn odd_series(z: &Rational, fine: u32, hyperbolic: bool) -> Rational {
    let square = truncate(&(z * z), fine);
    let square = if hyperbolic { square } else { -square };
    let mut power = truncate(z, fine);
    let mut sum = power.clone();
    let mut k = 1;
    let tiny = two_to(-i64::from(fine));
    while power.abs() > tiny {
        k += 2;
        power = truncate(&(&power * &square), fine);
        sum += truncate(&(&power / Rational::from(k)), fine);
    }
    sum
}

/// ln 2 to about 2^−fine.
fn logarithm_of_two(fine: u32) -> Rational {
    Rational::from(2) * arc_tangent_of_inverse(3, fine + 16, true)
}

/// ln x for x > 0, to 2^−precision.
fn logarithm(x: &Rational, precision: u32) -> Rational {
    let fine = precision + 32;
    let mut shift = x.binary_magnitude();
    let mut mantissa = x * two_to(-shift);
    // The mantissa lies between 1/2 and 2; the series wants |z| ≤ 1/3, which that gives.
    if mantissa > Rational::ratio(3, 2) {
        shift += 1;
        mantissa *= Rational::ratio(1, 2);
    }
    let z = (&mantissa - Rational::ONE) / (&mantissa + Rational::ONE);
    Rational::from(2) * odd_series(&z, fine, true) + Rational::from(shift) * logarithm_of_two(fine)
}

/// e^x with a relative error below 2^−precision, for moderate x.
fn exponential(x: &Rational, precision: u32) -> Rational {
    let fine = precision + 32;
    let ln2 = logarithm_of_two(fine);
    let shift = (x / &ln2 + Rational::ratio(1, 2)).floor();
    let rest = truncate(&(x - &shift * &ln2), fine);
    let mut term = Rational::ONE;
    let mut sum = Rational::ONE;
    let mut k = 0;
    let tiny = two_to(-i64::from(fine));
    loop {
        k += 1;
        term = truncate(&(&term * &rest / Rational::from(k)), fine);
        if term.abs() <= tiny {
            break;
        }
        sum += &term;
    }
    sum * two_to(shift.to_i64().unwrap_or(0))
}

/// How many bits the whole part of a number has, at least 1.
fn magnitude_bits(x: &Rational) -> u32 {
    if x.is_zero() { 1 } else { (x.binary_magnitude() + 1).clamp(1, 1 << 14) as u32 }
}

/// The number cut to a multiple of 2^−bits, downwards.
fn truncate(x: &Rational, bits: u32) -> Rational {
    let scale = two_to(i64::from(bits));
    (x * &scale).floor() / scale
}

fn two_to(exponent: i64) -> Rational {
    Rational::from(2).pow(exponent as i32).unwrap_or_default()
}

fn middle_squared(a: f64, b: f64) -> Rational {
    let sum = exactly(a) + exactly(b);
    &sum * &sum / Rational::from(4)
}

/// A finite double as a rational.
fn exactly(value: f64) -> Rational {
    Rational::from_f64(value).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(ours: &Rational, theirs: f64) {
        let ours = ours.to_f64();
        let ok = ours == theirs || ours.next_up() == theirs || ours.next_down() == theirs;
        assert!(ok, "{ours} is not {theirs}");
    }

    #[test]
    fn roots_are_correctly_rounded() {
        for (x, root) in [(2.0, 2f64.sqrt()), (1e-290, 1e-290f64.sqrt()), (0.0, 0.0), (4.0, 2.0)] {
            assert_eq!(sqrt(&exactly(x)).unwrap().to_f64(), root);
        }
        assert_eq!(sqrt(&Rational::ratio(1, 100)).unwrap().to_f64(), 0.1);
        assert!(sqrt(&Rational::from(-1)).is_none());
        // Just above the square of the middle between 1 and the next double: rounding first would lose it.
        let middle = exactly(1.0) + two_to(-53);
        let above = &middle * &middle + two_to(-300);
        assert_eq!(sqrt(&above).unwrap().to_f64(), 1f64.next_up());
    }

    #[test]
    fn sines_and_cosines_agree_with_the_library_everywhere() {
        for x in [1e-30, 0.5, 1.0, 1.6, -2.0, 3.0, 4.0, 5.5, 6.5, 100.0, 1e10, -1e22, 1e300, 1e-299] {
            close(&sin(&exactly(x)), x.sin());
            close(&cos(&exactly(x)), x.cos());
        }
        // The double nearest to π is not π.
        assert_eq!(sin(&pi()).to_f64(), 1.2246467991473532e-16);
        assert_eq!(cos(&pi()).to_f64(), -1.0);
    }

    #[test]
    fn powers_agree_with_the_library_and_are_exact_where_they_can_be() {
        for (x, y) in [(2.0, 0.5), (10.0, -3.7), (0.1, 2.5), (7.0, 350.25), (1.5, 99.0), (1e-200, 1.25)] {
            close(&power(&exactly(x), &exactly(y)).unwrap(), f64::powf(x, y));
        }
        assert_eq!(power(&Rational::from(8), &Rational::ratio(1, 3)), Some(Rational::from(2)));
        assert_eq!(power(&Rational::ratio(9, 4), &Rational::ratio(1, 2)), Some(Rational::ratio(3, 2)));
        assert_eq!(power(&Rational::from(2), &Rational::from(387_420_489)), None);
        assert_eq!(power(&Rational::from(-2), &Rational::ratio(1, 2)), None);
        // (1 + h)^(1/h) is e·(1 − h/2 + …).
        let h = Rational::ratio(1, 1_000_000_000_000);
        close(&power(&(Rational::ONE + &h), &(Rational::ONE / &h)).unwrap(), 2.718281828457686);
    }
}
