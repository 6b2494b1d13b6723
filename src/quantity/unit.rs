//! Units: a scale to coherent SI and a dimension.

use crate::exact::Rational;
use crate::quantity::{Dimension, elementary, in_range};

/// The largest exponent in a written unit.
const MAX_EXPONENT: i32 = 64;

/// A unit of measurement: `scale` coherent SI units of `dimension`.
#[derive(Clone, PartialEq, Debug)]
pub struct Unit {
    /// How many coherent SI units it is.
    pub scale: Rational,
    /// What it measures.
    pub dimension: Dimension,
}

/// Why a written unit is none.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum UnitError {
    /// There is no such unit.
    Unknown(String),
    /// An exponent or the whole scale is beyond all measure.
    OutOfRange,
}

/// All unit symbols, for suggestions.
pub const SYMBOLS: [&str; 12] = ["m", "cm", "mm", "km", "s", "ms", "min", "rad", "deg", "kg", "g", "N"];

impl Unit {
    /// The unit with its factors' symbols and exponents.
    ///
    /// # Errors
    /// When a symbol is unknown or the unit is absurdly large or small.
    pub fn from_factors(factors: &[(String, i32)]) -> Result<Unit, UnitError> {
        let mut unit = Unit { scale: Rational::ONE, dimension: Dimension::NONE };
        for (symbol, exponent) in factors {
            let base = Unit::from_symbol(symbol).ok_or_else(|| UnitError::Unknown(symbol.clone()))?;
            unit = base.power(*exponent).and_then(|p| unit.times(&p)).ok_or(UnitError::OutOfRange)?;
        }
        Ok(unit)
    }

    /// Whether it is the coherent SI unit of its dimension.
    pub fn is_coherent(&self) -> bool {
        self.scale == Rational::ONE
    }

    fn from_symbol(symbol: &str) -> Option<Unit> {
        let (scale, dimension) = match symbol {
            "1" => (Rational::ONE, Dimension::NONE),
            "m" => (Rational::ONE, Dimension::LENGTH),
            "cm" => (Rational::ratio(1, 100), Dimension::LENGTH),
            "mm" => (Rational::ratio(1, 1000), Dimension::LENGTH),
            "km" => (Rational::from(1000), Dimension::LENGTH),
            "s" => (Rational::ONE, Dimension::TIME),
            "ms" => (Rational::ratio(1, 1000), Dimension::TIME),
            "min" => (Rational::from(60), Dimension::TIME),
            "kg" => (Rational::ONE, Dimension::MASS),
            "g" => (Rational::ratio(1, 1000), Dimension::MASS),
            "rad" => (Rational::ONE, Dimension::ANGLE),
            // So that `180 deg` is the constant `pi`.
            "deg" => (elementary::pi() / Rational::from(180), Dimension::ANGLE),
            "N" => (Rational::ONE, newton()?),
            _ => return None,
        };
        Some(Unit { scale, dimension })
    }

    fn power(&self, exponent: i32) -> Option<Unit> {
        if exponent.abs() > MAX_EXPONENT {
            return None;
        }
        let dimension = self.dimension.power(exponent.into(), 1)?;
        Some(Unit { scale: self.scale.pow(exponent)?, dimension })
    }

    fn times(&self, other: &Unit) -> Option<Unit> {
        let scale = &self.scale * &other.scale;
        in_range(&scale).then_some(())?;
        Some(Unit { scale, dimension: self.dimension.times(other.dimension)? })
    }
}

/// kg·m/s²
fn newton() -> Option<Dimension> {
    Dimension::MASS.times(Dimension::LENGTH)?.per(Dimension::TIME.power(2, 1)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(factors: &[(&str, i32)], scale: Rational, text: &str) {
        let factors: Vec<(String, i32)> = factors.iter().map(|(s, e)| (s.to_string(), *e)).collect();
        let unit = Unit::from_factors(&factors).unwrap();
        assert_eq!((unit.scale, unit.dimension.to_string()), (scale, text.to_string()));
    }

    #[test]
    fn units_have_scales_and_dimensions() {
        check(&[("cm", 1)], Rational::ratio(1, 100), "m");
        check(&[("km", 1), ("min", -1)], Rational::ratio(1000, 60), "m/s");
        check(&[("m", 1), ("s", -2)], Rational::ONE, "m/s^2");
        check(&[("N", 1)], Rational::ONE, "kg*m/s^2");
        check(&[("g", 1), ("cm", 2)], Rational::ratio(1, 10_000_000), "kg*m^2");
        check(&[("1", 1), ("ms", -1)], Rational::from(1000), "1/s");
        check(&[("deg", 1)], elementary::pi() / Rational::from(180), "rad");
    }

    #[test]
    fn nonsense_is_refused() {
        let error = |s: &str, e| Unit::from_factors(&[(s.to_string(), e)]).unwrap_err();
        assert_eq!(error("parsec", 1), UnitError::Unknown("parsec".into()));
        assert_eq!(error("m", 1_000_000_000), UnitError::OutOfRange);
        assert_eq!(error("mm", i32::MIN + 1), UnitError::OutOfRange);
    }
}
