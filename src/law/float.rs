//! The floating-point types that a controller can compute with.

use std::fmt;

use crate::exact::Rational;

/// The numbers that a controller computes with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Float {
    /// IEEE double precision.
    #[default]
    F64,
    /// IEEE single precision.
    F32,
}

impl Float {
    /// All of them.
    pub const ALL: [Float; 2] = [Float::F64, Float::F32];

    /// Its name in Rust.
    pub fn name(self) -> &'static str {
        match self {
            Float::F64 => "f64",
            Float::F32 => "f32",
        }
    }

    /// u: rounding to nearest changes a number by at most this share of it.
    pub fn unit_roundoff(self) -> Rational {
        power_of_two(match self {
            Float::F64 => -53,
            Float::F32 => -24,
        })
    }

    /// What a product may lose besides, where it is so small that it is rounded to a multiple of the
    /// least number, or to 0: the least normal number.
    pub fn underflow(self) -> Rational {
        power_of_two(match self {
            Float::F64 => -1022,
            Float::F32 => -126,
        })
    }

    /// A double, rounded to this type.
    pub fn round(self, value: f64) -> f64 {
        match self {
            Float::F64 => value,
            #[allow(clippy::cast_possible_truncation, reason = "rounding is what is asked")]
            Float::F32 => f64::from(value as f32),
        }
    }

    /// The greatest number of this type that is not above `value`.
    pub fn down(self, value: &Rational) -> f64 {
        let below = value.to_f64_down();
        let rounded = self.round(below);
        if rounded <= below { rounded } else { -self.next_above(-rounded) }
    }

    /// The least number of this type that is not below `value`.
    pub fn up(self, value: &Rational) -> f64 {
        -self.down(&-value)
    }

    /// The next number of this type.
    fn next_above(self, value: f64) -> f64 {
        match self {
            Float::F64 => value.next_up(),
            #[allow(clippy::cast_possible_truncation, reason = "it is a number of this type")]
            Float::F32 => f64::from((value as f32).next_up()),
        }
    }

    /// Whether its numbers reach as far as a double.
    pub fn holds(self, value: f64) -> bool {
        self.round(value).is_finite()
    }

    /// A number of this type as Rust writes it; reading it gives the same number.
    pub fn literal(self, value: f64) -> String {
        if value.is_infinite() {
            let sign = if value < 0.0 { "NEG_" } else { "" };
            return format!("{}::{sign}INFINITY", self.name());
        }
        match self {
            Float::F64 => format!("{value:?}"),
            #[allow(clippy::cast_possible_truncation, reason = "it is a number of this type")]
            Float::F32 => format!("{:?}", value as f32),
        }
    }
}

impl fmt::Display for Float {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

fn power_of_two(exponent: i32) -> Rational {
    Rational::from(2).pow(exponent).unwrap_or(Rational::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_to_the_side_that_is_asked() {
        let third = Rational::ratio(1, 3);
        for float in Float::ALL {
            for value in [third.clone(), -&third, Rational::from(2), Rational::ZERO] {
                let (low, high) = (float.down(&value), float.up(&value));
                let exact = |x: f64| Rational::from_f64(x).expect("finite");
                assert!(exact(low) <= value && value <= exact(high));
                assert!(low == high || float.next_above(low) == high, "{float}: {low} {high}");
            }
        }
        assert_eq!(Float::F32.down(&Rational::from(2)), 2.0);
        assert!(!Float::F32.holds(1e300) && Float::F64.holds(1e300));
    }

    #[test]
    fn literals_read_back_as_the_same_number() {
        for value in [0.1, -1e-320, 1.5e300, 0.0, -0.0, 1e21, f64::INFINITY] {
            for float in Float::ALL {
                let rounded = float.round(value);
                let text = float.literal(rounded);
                let bare = text.replace("f32::", "").replace("f64::", "").replace("INFINITY", "inf");
                let back: f64 = match float {
                    Float::F64 => bare.parse().expect("a number"),
                    Float::F32 => f64::from(bare.parse::<f32>().expect("a number")),
                };
                assert_eq!(back.to_bits(), rounded.to_bits(), "{text}");
            }
        }
    }

    #[test]
    fn the_unit_roundoff_is_half_of_epsilon() {
        assert_eq!(Float::F64.unit_roundoff().to_f64() * 2.0, f64::EPSILON);
        assert_eq!(Float::F32.unit_roundoff().to_f64() * 2.0, f64::from(f32::EPSILON));
        assert_eq!(Float::F64.underflow().to_f64(), f64::MIN_POSITIVE);
        assert_eq!(Float::F32.underflow().to_f64(), f64::from(f32::MIN_POSITIVE));
    }
}
