//! The check's diagnostics, one small function each.

mod dynamics;
mod formulas;
mod names;
mod numbers;
mod settings;
mod shapes;

pub(super) use dynamics::*;
pub(super) use formulas::*;
pub(super) use names::*;
pub(super) use numbers::*;
pub(super) use settings::*;
pub(super) use shapes::*;

use crate::diag::Diagnostic;
use crate::exact::Rational;
use crate::source::Span;

/// A construct that the language has and this version does not.
pub(in crate::check) fn unsupported(construct: &str, span: Span) -> Diagnostic {
    Diagnostic::error(
        "dosm::check::unsupported",
        format!("{construct} is not supported yet"),
        span,
        "not supported yet",
    )
}

/// A number as a message shows it: exactly where that is short, else as the nearest double.
fn shown(number: &Rational) -> String {
    let exact = number.to_string();
    if exact.len() <= 16 { exact } else { plain(number.to_f64()) }
}

/// A double without an exponent where that is short.
fn plain(number: f64) -> String {
    if (1e-6..1e9).contains(&number.abs()) { number.to_string() } else { format!("{number:e}") }
}

/// `s` behind a number other than 1.
fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_shown_short() {
        assert_eq!(shown(&Rational::ratio(1, 3)), "1/3");
        assert_eq!(shown(&Rational::ratio(-5, 4)), "-1.25");
        assert_eq!(shown(&Rational::from(10).pow(200).unwrap()), "1e200");
        assert_eq!(shown(&Rational::from_f64(std::f64::consts::SQRT_2).unwrap()), "1.4142135623730951");
    }
}
