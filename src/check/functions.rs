//! Powers and functions in constant expressions.

use crate::check::expression::Value;
use crate::check::names::nearest;
use crate::check::{Checker, messages};
use crate::diag::Reported;
use crate::exact::Rational;
use crate::quantity::{self, Dimension};
use crate::source::Span;
use crate::syntax::ast::{self, Expr};
use crate::syntax::words::FUNCTIONS;

/// The largest whole exponent that is computed exactly.
const MAX_EXACT_EXPONENT: i64 = 64;

impl Checker<'_> {
    /// A power: exact for small whole exponents, else the nearest double.
    pub(super) fn power(
        &mut self,
        (left, a): (&Expr, Value),
        (right, b): (&Expr, Value),
        span: Span,
    ) -> Result<Value, Reported> {
        if !b.dimension.is_bare() {
            return Err(self.report(messages::exponent_with_unit(right.span, b.dimension)));
        }
        let dimension = power_dimension(a.dimension, &b.number);
        let Some(dimension) = dimension else {
            return Err(self.report(messages::unit_power(span, a.dimension, &b.number)));
        };
        if a.number.is_zero() && b.number.is_negative() {
            return Err(self.report(messages::division_by_zero(span, left.span)));
        }
        if a.number.is_negative() && !b.number.is_integer() {
            return Err(self.report(messages::outside_domain(span, "a negative number has no such power")));
        }
        match power_of(&a.number, &b.number) {
            Some(number) => Ok(Value::constant(number, dimension)),
            None => Err(self.report(messages::number_out_of_range(span))),
        }
    }

    /// The value of a function at constants.
    pub(super) fn call(
        &mut self,
        function: &ast::Name,
        written: &[Expr],
        values: Vec<Value>,
        span: Span,
    ) -> Result<Value, Reported> {
        let name = function.text.as_str();
        if !FUNCTIONS.contains(&name) {
            let near = nearest(name, FUNCTIONS.into_iter());
            return Err(self.report(messages::unknown_function(function, near)));
        }
        let expected = match name {
            "min" | "max" => values.len().max(1),
            "mod" => 2,
            _ => 1,
        };
        if values.len() != expected {
            return Err(self.report(messages::wrong_argument_count(function, expected, values.len())));
        }
        for (value, expr) in values.iter().zip(written) {
            self.expect_constant(value, expr.span)?;
        }
        let (first, rest) = match values.split_first() {
            Some((first, rest)) => (first.clone(), rest),
            None => return Err(self.report(messages::wrong_argument_count(function, expected, 0))),
        };
        let first_span = written.first().map_or(span, |e| e.span);
        for (value, expr) in rest.iter().zip(written.iter().skip(1)) {
            if !value.dimension.agrees(first.dimension) {
                let pair = ((first_span, first.dimension), (expr.span, value.dimension));
                return Err(self.report(messages::dimensions_disagree(pair.0, pair.1)));
            }
        }
        self.call_checked(name, first, rest, first_span)
    }

    fn call_checked(
        &mut self,
        name: &str,
        first: Value,
        rest: &[Value],
        span: Span,
    ) -> Result<Value, Reported> {
        let dimension = first.dimension;
        let numbers = || rest.iter().map(|v| &v.number);
        let same = |number: Rational| Ok(Value::constant(number, dimension));
        match name {
            "abs" => same(first.number.abs()),
            "min" => same(numbers().fold(first.number.clone(), |a, b| Rational::min_of(&a, b).clone())),
            "max" => same(numbers().fold(first.number.clone(), |a, b| Rational::max_of(&a, b).clone())),
            "mod" => match numbers().next().and_then(|b| Some((b, first.number.checked_div(b)?))) {
                Some((b, quotient)) => same(&first.number - quotient.floor() * b),
                None => Err(self.report(messages::division_by_zero(span, span))),
            },
            "sqrt" => {
                let Some(half) = power_dimension(dimension, &Rational::ratio(1, 2)) else {
                    return Err(self.report(messages::unit_power(span, dimension, &Rational::ratio(1, 2))));
                };
                match quantity::sqrt(&first.number) {
                    Some(root) => Ok(Value::constant(root, half)),
                    None => Err(self.report(messages::outside_domain(span, "a negative number has no root"))),
                }
            }
            _ => {
                let number = self.expect_dimension(first, span, Dimension::NONE)?;
                let result = match name {
                    "sin" => quantity::sin(&number),
                    "cos" => quantity::cos(&number),
                    _ => number.floor(),
                };
                Ok(Value::constant(result, Dimension::NONE))
            }
        }
    }
}

/// The dimension of a power; angles are dropped where they do not divide.
fn power_dimension(dimension: Dimension, exponent: &Rational) -> Option<Dimension> {
    if dimension.is_bare() {
        return Some(dimension);
    }
    let (numerator, denominator) = exponent.parts();
    let power = dimension.power(numerator.parse().ok()?, denominator.parse().ok()?);
    if power.is_none() && dimension.is_number() { Some(Dimension::NONE) } else { power }
}

/// The power of a number: exact for small whole exponents, else the nearest double; `None` out of range.
fn power_of(base: &Rational, exponent: &Rational) -> Option<Rational> {
    if base.is_zero() {
        return Some(if exponent.is_zero() { Rational::ONE } else { Rational::ZERO });
    }
    match exponent.to_i64() {
        Some(n) if n.abs() <= MAX_EXACT_EXPONENT => {
            if base.bits() * n.unsigned_abs() as usize > 2 * quantity::MAX_BITS {
                return None;
            }
            base.pow(n as i32)
        }
        _ if base.is_negative() => {
            let odd = !(exponent / Rational::from(2)).is_integer();
            let size = quantity::power(&base.abs(), exponent)?;
            Some(if odd { -size } else { size })
        }
        _ => quantity::power(base, exponent),
    }
}
