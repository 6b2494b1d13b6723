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

/// `s` behind a number other than 1.
fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}
