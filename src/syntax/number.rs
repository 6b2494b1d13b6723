//! Building numbers and units.

use crate::exact::Rational;
use crate::syntax::ast::{Number, Unit};
use crate::syntax::builder::Builder;
use crate::syntax::error::{self, MAX_DIGITS};
use crate::syntax::grammar::{Built, Node};

/// The largest absolute value of a unit's exponent.
const MAX_UNIT_EXPONENT: i32 = 64;

impl Builder<'_> {
    /// A unit behind a number or a bracket; none may have been read since `mark`.
    pub(super) fn trailing_unit(&mut self, unit: Option<Node>, mark: usize) -> Built<Option<Unit>> {
        let Some(unit) = unit else {
            return Ok(None);
        };
        let first = self.unit_since(mark);
        let unit = self.unit(unit)?;
        if let Some(first) = first {
            self.report(error::unit_twice(first, unit.span));
        }
        Ok(Some(unit))
    }

    /// A unit.
    pub(super) fn unit(&mut self, node: Node) -> Built<Unit> {
        let span = self.span(&node);
        self.note_unit(span);
        match unit_factors(node.as_str()) {
            Some(factors) => Ok(Unit { factors, span }),
            None => self.stop(error::unit_exponent(span)),
        }
    }

    /// A number.
    pub(super) fn number(&mut self, node: Node) -> Built<Number> {
        let span = self.span(&node);
        let text = node.as_str();
        if text.len() > MAX_DIGITS {
            return self.stop(error::number_too_long(span, text.len()));
        }
        match decimal(text) {
            Some(value) => Ok(Number { value, span }),
            None => self.stop(error::number_range(span)),
        }
    }
}

/// The factors of a unit, `None` for an exponent that is 0 or absurd.
fn unit_factors(text: &str) -> Option<Vec<(String, i32)>> {
    let mut factors = Vec::new();
    let mut sign = 1;
    for part in text.split_inclusive(['*', '/']) {
        let factor = part.trim_end_matches(['*', '/']);
        let (symbol, exponent) = match factor.split_once('^') {
            Some((symbol, power)) => (symbol, power.parse::<i32>().ok()?),
            None => (factor, 1),
        };
        if exponent == 0 || exponent.abs() > MAX_UNIT_EXPONENT {
            return None;
        }
        factors.push((symbol.to_owned(), sign * exponent));
        sign = if part.ends_with('/') { -1 } else { 1 };
    }
    Some(factors)
}

/// The exact value of a decimal; `None` out of 1e-300..=1e300 (0 is in). The text's length is bounded.
fn decimal(text: &str) -> Option<Rational> {
    const MAX_EXPONENT: i64 = 300;
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = format!("{whole}{fraction}");
    let digits = digits.trim_start_matches('0');
    if digits.is_empty() {
        return Some(Rational::ZERO);
    }
    let exponent = saturating(exponent).saturating_sub(fraction.len() as i64);
    // The value lies in 10^top .. 10^(top + 1).
    let top = exponent.saturating_add(digits.len() as i64 - 1);
    let power_of_ten = digits.starts_with('1') && digits.bytes().skip(1).all(|d| d == b'0');
    if !(-MAX_EXPONENT..=MAX_EXPONENT).contains(&top) || (top == MAX_EXPONENT && !power_of_ten) {
        return None;
    }
    Rational::from_decimal(digits, i32::try_from(exponent).ok()?)
}

/// A whole number of any length, as near as an `i64` comes.
fn saturating(text: &str) -> i64 {
    let negative = text.starts_with('-');
    let size = text.trim_start_matches(['+', '-']).parse::<i64>().unwrap_or(i64::MAX / 2);
    if negative { -size } else { size }
}
