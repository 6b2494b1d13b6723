//! How an exact number is kept: as mantissa · 2^exponent where that is possible, else as a quotient.
//!
//! Plans are made of doubles, and sums and products of doubles never leave the first form. It needs
//! no greatest common divisor, which is what makes the checker several times faster.

use std::borrow::Cow;
use std::cmp::Ordering;

use dashu_base::{BitTest, PowerOfTwo, Signed};
use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;

/// A number in its only form, so that equality is that of the parts.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) enum Repr {
    /// mantissa · 2^exponent, the mantissa odd; 0 is 0 · 2^0.
    Dyadic(IBig, i64),
    /// A quotient in lowest terms whose denominator is no power of two.
    Ratio(RBig),
}

use Repr::{Dyadic, Ratio};

impl Repr {
    pub(super) const ZERO: Repr = Dyadic(IBig::ZERO, 0);
    pub(super) const ONE: Repr = Dyadic(IBig::ONE, 0);

    /// mantissa · 2^exponent.
    pub(super) fn dyadic(mantissa: IBig, exponent: i64) -> Repr {
        match mantissa.trailing_zeros() {
            None => Repr::ZERO,
            Some(0) => Dyadic(mantissa, exponent),
            Some(zeros) => Dyadic(mantissa >> zeros, exponent + zeros as i64),
        }
    }

    /// The number that a quotient is.
    pub(super) fn of(ratio: RBig) -> Repr {
        if !ratio.denominator().is_power_of_two() {
            return Ratio(ratio);
        }
        let (numerator, denominator) = ratio.into_parts();
        Repr::dyadic(numerator, -(denominator.trailing_zeros().unwrap_or(0) as i64))
    }

    /// The double as the number that it is; `None` where it is none.
    pub(super) fn from_f64(value: f64) -> Option<Repr> {
        if !value.is_finite() {
            return None;
        }
        let bits = value.to_bits();
        let (field, fraction) = ((bits >> 52 & 0x7ff) as i64, (bits & ((1 << 52) - 1)) as i64);
        let (mantissa, exponent) =
            if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field - 1075) };
        if mantissa == 0 {
            return Some(Repr::ZERO);
        }
        let zeros = mantissa.trailing_zeros();
        let odd = mantissa >> zeros;
        Some(Dyadic(IBig::from(if value < 0.0 { -odd } else { odd }), exponent + i64::from(zeros)))
    }

    /// The nearest double.
    pub(super) fn to_f64(&self) -> f64 {
        if let Dyadic(mantissa, exponent) = self {
            // Where the mantissa and the result are normal doubles, scaling the rounded mantissa is exact.
            let length = mantissa.bit_len() as i64;
            let top = length + exponent;
            if length < 1000 && (-1000..1000).contains(&top) && (-1000..1000).contains(exponent) {
                let scale = f64::from_bits(((1023 + exponent) as u64) << 52);
                return mantissa.to_f64().value() * scale;
            }
        }
        self.ratio().to_f64().value()
    }

    /// The number as a quotient in lowest terms.
    pub(super) fn ratio(&self) -> Cow<'_, RBig> {
        match self {
            Ratio(ratio) => Cow::Borrowed(ratio),
            Dyadic(mantissa, exponent) => {
                let size = exponent.unsigned_abs() as usize;
                Cow::Owned(if *exponent < 0 {
                    RBig::from_parts(mantissa.clone(), UBig::ONE << size)
                } else {
                    RBig::from(mantissa << size)
                })
            }
        }
    }

    pub(super) fn is_zero(&self) -> bool {
        matches!(self, Dyadic(mantissa, _) if mantissa.is_zero())
    }

    pub(super) fn is_negative(&self) -> bool {
        match self {
            Dyadic(mantissa, _) => mantissa.is_negative(),
            Ratio(ratio) => ratio.is_negative(),
        }
    }

    pub(super) fn is_integer(&self) -> bool {
        match self {
            Dyadic(_, exponent) => *exponent >= 0,
            Ratio(ratio) => ratio.denominator().is_one(),
        }
    }

    pub(super) fn neg(&self) -> Repr {
        match self {
            Dyadic(mantissa, exponent) => Dyadic(-mantissa, *exponent),
            Ratio(ratio) => Ratio(-ratio),
        }
    }

    pub(super) fn add(&self, other: &Repr) -> Repr {
        match (self, other) {
            (Dyadic(a, e), Dyadic(b, f)) => match e.cmp(f) {
                _ if a.is_zero() => other.clone(),
                _ if b.is_zero() => self.clone(),
                Ordering::Equal => Repr::dyadic(a + b, *e),
                // Of two odd mantissas the shifted one is even and the sum odd.
                Ordering::Greater => Dyadic((a << (e - f) as usize) + b, *f),
                Ordering::Less => Dyadic(a + (b << (f - e) as usize), *e),
            },
            _ => Repr::of(self.ratio().as_ref() + other.ratio().as_ref()),
        }
    }

    pub(super) fn sub(&self, other: &Repr) -> Repr {
        match (self, other) {
            (Dyadic(..), Dyadic(..)) => self.add(&other.neg()),
            _ => Repr::of(self.ratio().as_ref() - other.ratio().as_ref()),
        }
    }

    pub(super) fn mul(&self, other: &Repr) -> Repr {
        match (self, other) {
            (Dyadic(a, _), _) if a.is_zero() => Repr::ZERO,
            (_, Dyadic(b, _)) if b.is_zero() => Repr::ZERO,
            (Dyadic(a, e), Dyadic(b, f)) => Dyadic(a * b, e + f),
            _ => Repr::of(self.ratio().as_ref() * other.ratio().as_ref()),
        }
    }

    /// The quotient; as with machine integers, a divisor of 0 is the caller's error.
    pub(super) fn div(&self, other: &Repr) -> Repr {
        match (self, other) {
            (Dyadic(a, _), Dyadic(b, _)) if a.is_zero() && !b.is_zero() => Repr::ZERO,
            (Dyadic(a, e), Dyadic(b, f)) if b.is_one() => Dyadic(a.clone(), e - f),
            _ => Repr::of(self.ratio().as_ref() / other.ratio().as_ref()),
        }
    }

    pub(super) fn pow(&self, exponent: u32) -> Repr {
        match self {
            Dyadic(mantissa, e) => Repr::dyadic(mantissa.pow(exponent as usize), e * i64::from(exponent)),
            Ratio(ratio) => Repr::of(ratio.pow(exponent as isize)),
        }
    }
}

impl Ord for Repr {
    fn cmp(&self, other: &Repr) -> Ordering {
        match (self, other) {
            (Dyadic(a, e), Dyadic(b, f)) => {
                let signs = a.signum().cmp(&b.signum());
                match e.cmp(f) {
                    _ if signs != Ordering::Equal => signs,
                    Ordering::Equal => a.cmp(b),
                    Ordering::Greater => (a << (e - f) as usize).cmp(b),
                    Ordering::Less => a.cmp(&(b << (f - e) as usize)),
                }
            }
            _ => self.ratio().as_ref().cmp(other.ratio().as_ref()),
        }
    }
}

impl PartialOrd for Repr {
    fn partial_cmp(&self, other: &Repr) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
