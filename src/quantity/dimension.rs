//! Dimensions: products of powers of length, time, mass and angle.

use std::fmt;

/// The largest exponent of a base dimension that an expression may reach.
const MAX_EXPONENT: i32 = 1000;

/// A physical dimension as exponents of the base units m, s, kg and rad.
///
/// An angle is a plain number in SI, so its exponent does not take part in comparisons of
/// dimensions; it is kept so that `2 rad` is not mistaken for a number without a unit.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Dimension {
    length: i32,
    time: i32,
    mass: i32,
    angle: i32,
}

impl Dimension {
    /// A number without a unit.
    pub const NONE: Dimension = Dimension { length: 0, time: 0, mass: 0, angle: 0 };
    /// m
    pub const LENGTH: Dimension = Dimension { length: 1, ..Dimension::NONE };
    /// s
    pub const TIME: Dimension = Dimension { time: 1, ..Dimension::NONE };
    /// kg
    pub const MASS: Dimension = Dimension { mass: 1, ..Dimension::NONE };
    /// rad
    pub const ANGLE: Dimension = Dimension { angle: 1, ..Dimension::NONE };

    /// Whether a value of this dimension has no unit at all and so takes the one its place expects.
    pub fn is_bare(self) -> bool {
        self == Dimension::NONE
    }

    /// Whether a value of this dimension is a plain number in SI (angles are).
    pub fn is_number(self) -> bool {
        self.agrees(Dimension::NONE)
    }

    /// Whether values of both dimensions may be added and compared.
    pub fn agrees(self, other: Dimension) -> bool {
        (self.length, self.time, self.mass) == (other.length, other.time, other.mass)
    }

    /// The dimension of a product; `None` when an exponent gets absurd.
    pub fn times(self, other: Dimension) -> Option<Dimension> {
        self.zip(other, |a, b| a.checked_add(b))
    }

    /// The dimension of a quotient; `None` when an exponent gets absurd.
    pub fn per(self, other: Dimension) -> Option<Dimension> {
        self.zip(other, |a, b| a.checked_sub(b))
    }

    /// The dimension of the power `numerator / denominator`; `None` when it is not whole or absurd.
    pub fn power(self, numerator: i64, denominator: i64) -> Option<Dimension> {
        let part = |exponent: i32| -> Option<i32> {
            let product = i64::from(exponent).checked_mul(numerator)?;
            if denominator == 0 || product % denominator != 0 {
                return None;
            }
            i32::try_from(product / denominator).ok()
        };
        Dimension {
            length: part(self.length)?,
            time: part(self.time)?,
            mass: part(self.mass)?,
            angle: part(self.angle)?,
        }
        .bounded()
    }

    fn zip(self, other: Dimension, f: impl Fn(i32, i32) -> Option<i32>) -> Option<Dimension> {
        Dimension {
            length: f(self.length, other.length)?,
            time: f(self.time, other.time)?,
            mass: f(self.mass, other.mass)?,
            angle: f(self.angle, other.angle)?,
        }
        .bounded()
    }

    fn bounded(self) -> Option<Dimension> {
        let parts = [self.length, self.time, self.mass, self.angle];
        parts.iter().all(|e| e.abs() <= MAX_EXPONENT).then_some(self)
    }

    /// What a message calls it: `a length (m)`, `m/s^2`, `a number without a unit`.
    pub fn describe(self) -> String {
        match self {
            Dimension::NONE => "a number without a unit".into(),
            Dimension::LENGTH => "a length (m)".into(),
            Dimension::TIME => "a time (s)".into(),
            Dimension::MASS => "a mass (kg)".into(),
            Dimension::ANGLE => "an angle (rad)".into(),
            other => format!("a quantity in {other}"),
        }
    }
}

/// Writes the coherent SI unit as in a mission: `m/s^2`, `1/s`, `kg*m`, `1`.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = [("kg", self.mass), ("m", self.length), ("rad", self.angle), ("s", self.time)];
        let mut text = String::new();
        for (symbol, exponent) in parts.iter().filter(|(_, e)| *e > 0) {
            let star = if text.is_empty() { "" } else { "*" };
            text += &format!("{star}{}", factor(symbol, *exponent));
        }
        if text.is_empty() {
            text.push('1');
        }
        for (symbol, exponent) in parts.iter().filter(|(_, e)| *e < 0) {
            text += &format!("/{}", factor(symbol, -exponent));
        }
        f.write_str(&text)
    }
}

fn factor(symbol: &str, exponent: i32) -> String {
    if exponent == 1 { symbol.to_string() } else { format!("{symbol}^{exponent}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dimensions_print_as_units() {
        let speed = Dimension::LENGTH.per(Dimension::TIME).unwrap();
        let acceleration = speed.per(Dimension::TIME).unwrap();
        assert_eq!(speed.to_string(), "m/s");
        assert_eq!(acceleration.to_string(), "m/s^2");
        assert_eq!(Dimension::MASS.times(acceleration).unwrap().to_string(), "kg*m/s^2");
        assert_eq!(Dimension::NONE.per(Dimension::TIME).unwrap().to_string(), "1/s");
        assert_eq!(Dimension::NONE.to_string(), "1");
    }

    #[test]
    fn angles_are_numbers_but_not_bare() {
        assert!(Dimension::ANGLE.is_number());
        assert!(!Dimension::ANGLE.is_bare());
        assert!(!Dimension::ANGLE.agrees(Dimension::TIME));
        let speed = Dimension::ANGLE.per(Dimension::TIME).and_then(|d| d.times(Dimension::LENGTH)).unwrap();
        assert!(speed.agrees(Dimension::LENGTH.per(Dimension::TIME).unwrap()));
    }

    #[test]
    fn powers_must_stay_whole_and_small() {
        let area = Dimension::LENGTH.power(2, 1).unwrap();
        assert_eq!(area.power(1, 2), Some(Dimension::LENGTH));
        assert_eq!(Dimension::LENGTH.power(1, 2), None);
        assert_eq!(Dimension::LENGTH.power(1_000_000, 1), None);
        assert_eq!(Dimension::LENGTH.power(i64::MAX, 1), None);
    }
}
