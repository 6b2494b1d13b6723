//! What is wrong with numbers, units and expressions.

use crate::check::names::{Kind, nearest};
use crate::diag::{Diagnostic, Edit};
use crate::exact::Rational;
use crate::quantity::{Dimension, SYMBOLS};
use crate::source::Span;
use crate::syntax::ast::{Name, Reference};

pub(in crate::check) fn number_out_of_range(span: Span) -> Diagnostic {
    Diagnostic::error(
        "dosm::check::number_out_of_range",
        "the number is out of range",
        span,
        "beyond 1e300, below 1e-300, or of too many digits",
    )
}

pub(in crate::check) fn not_whole(span: Span, number: &Rational) -> Diagnostic {
    let message = format!("a whole number is needed, not {}", super::shown(number));
    let [below, above] = [number.floor(), number.ceil()].map(|n| super::shown(&n));
    let write = |number: &str| vec![Edit::Replace(span, number.into())];
    Diagnostic::error("dosm::check::not_whole", message, span, "not a whole number")
        .with_help(format!("the nearest are {below} and {above}"))
        .perhaps_by(format!("write `{below}`"), write(&below))
        .perhaps_by(format!("write `{above}`"), write(&above))
}

pub(in crate::check) fn wrong_dimension(span: Span, found: Dimension, expected: Dimension) -> Diagnostic {
    let message = format!("{} is needed here, not {}", expected.describe(), found.describe());
    Diagnostic::error("dosm::check::wrong_dimension", message, span, format!("measures {found}"))
}

pub(in crate::check) fn dimensions_disagree(
    (left, a): (Span, Dimension),
    (right, b): (Span, Dimension),
) -> Diagnostic {
    let message = format!("{} and {} do not go together", a.describe(), b.describe());
    let diagnostic = Diagnostic::error("dosm::check::wrong_dimension", message, left, a.describe())
        .with_label(right, b.describe());
    if a.is_bare() || b.is_bare() {
        let (bare, unit) = if a.is_bare() { (left, b) } else { (right, a) };
        let edits = vec![Edit::GiveUnit(bare, unit.to_string())];
        return diagnostic
            .with_help(format!("give the number its unit, such as `1 {unit}`"))
            .perhaps_by(format!("give it the unit `{unit}`"), edits);
    }
    diagnostic
}

pub(in crate::check) fn unit_twice(span: Span, dimension: Dimension, unit: Span) -> Diagnostic {
    Diagnostic::error(
        "dosm::check::unit_twice",
        "a unit after something that has one already",
        unit,
        "the second unit",
    )
    .with_label(span, format!("already {}", dimension.describe()))
    .mended_by("remove the second unit", vec![Edit::Remove(unit)])
}

pub(in crate::check) fn unknown_unit(span: Span, symbol: &str) -> Diagnostic {
    let message = format!("there is no unit `{symbol}`");
    let diagnostic = Diagnostic::error("dosm::check::unknown_unit", message, span, "not a unit");
    match nearest(symbol, SYMBOLS.into_iter()) {
        Some(near) => diagnostic.with_help(format!("did you mean `{near}`?")).meant(span, near),
        None => diagnostic.with_help(format!("the units are {}", SYMBOLS.join(", "))),
    }
}

pub(in crate::check) fn unit_power(span: Span, dimension: Dimension, exponent: &Rational) -> Diagnostic {
    let message =
        format!("{} to the power {} has no whole unit", dimension.describe(), super::shown(exponent));
    Diagnostic::error("dosm::check::wrong_dimension", message, span, "no unit measures this")
}

pub(in crate::check) fn exponent_with_unit(span: Span, dimension: Dimension) -> Diagnostic {
    let message = format!("an exponent is a number without a unit, not {}", dimension.describe());
    Diagnostic::error("dosm::check::wrong_dimension", message, span, "the exponent")
}

pub(in crate::check) fn division_by_zero(span: Span, zero: Span) -> Diagnostic {
    Diagnostic::error("dosm::check::division_by_zero", "a division by 0", zero, "this is 0")
        .with_label(span, "in this expression")
}

pub(in crate::check) fn outside_domain(span: Span, reason: &str) -> Diagnostic {
    Diagnostic::error("dosm::check::outside_domain", reason, span, "negative")
}

pub(in crate::check) fn not_linear(span: Span) -> Diagnostic {
    Diagnostic::error(
        "dosm::check::not_linear",
        "only sums of coordinates with constant factors make a half-space",
        span,
        "not linear in the coordinates",
    )
}

pub(in crate::check) fn unknown_function(function: &Name, near: Option<&str>) -> Diagnostic {
    let message = format!("there is no function `{}`", function.text);
    let diagnostic =
        Diagnostic::error("dosm::check::unknown_function", message, function.span, "not a function");
    let all = "the functions are sqrt, sin, cos, min, max, abs, floor and mod";
    match near {
        Some(near) => diagnostic.with_help(format!("did you mean `{near}`?")).meant(function.span, near),
        None => diagnostic.with_help(all),
    }
}

pub(in crate::check) fn function_without_arguments(name: &Name) -> Diagnostic {
    let message = format!("`{}` is a function", name.text);
    Diagnostic::error("dosm::check::wrong_argument_count", message, name.span, "its arguments are missing")
}

pub(in crate::check) fn wrong_argument_count(function: &Name, wanted: usize, found: usize) -> Diagnostic {
    let message =
        format!("`{}` takes {wanted} argument{}, not {found}", function.text, super::plural(wanted));
    Diagnostic::error("dosm::check::wrong_argument_count", message, function.span, "called here")
}

pub(in crate::check) fn misplaced_table(span: Span) -> Diagnostic {
    Diagnostic::error(
        "dosm::check::misplaced_table",
        "a table stands alone, as the value of a `let` or a matrix",
        span,
        "not inside an expression",
    )
}

pub(in crate::check) fn ragged_table(span: Span, row: usize, found: usize, wanted: usize) -> Diagnostic {
    let message =
        format!("row {row} has {found} entr{}, the first has {wanted}", if found == 1 { "y" } else { "ies" });
    Diagnostic::error("dosm::check::ragged_table", message, span, "rows of different lengths")
}

pub(in crate::check) fn not_a_table(name: &Name) -> Diagnostic {
    let message = format!("`{}` is a number, not a table", name.text);
    Diagnostic::error("dosm::check::not_a_table", message, name.span, "has no entries")
}

pub(in crate::check) fn not_a_matrix(span: Span) -> Diagnostic {
    Diagnostic::error("dosm::check::not_a_table", "a matrix is needed here", span, "not a matrix")
        .with_help("write its rows in brackets: `[1, 0.5; 0, 1]`")
}

pub(in crate::check) fn table_as_number(name: &Name) -> Diagnostic {
    let message = format!("`{}` is a table, not a number", name.text);
    Diagnostic::error("dosm::check::table_as_number", message, name.span, "which entry?")
        .with_help(format!("name an entry, such as `{}[1, 1]`", name.text))
        .perhaps_by(format!("write `{}[1, 1]`", name.text), vec![Edit::Append(name.span, "[1, 1]".into())])
}

pub(in crate::check) fn wrong_index_count(reference: &Reference, height: usize, width: usize) -> Diagnostic {
    let message = format!("`{}` is a table of {height} × {width} entries", reference.name.text);
    Diagnostic::error("dosm::check::wrong_index_count", message, reference.span, "row and column are needed")
}

pub(in crate::check) fn index_out_of_table(
    reference: &Reference,
    (row, column): (i64, i64),
    height: usize,
    width: usize,
) -> Diagnostic {
    let name = &reference.name.text;
    let message = format!("`{name}` has no entry [{row}, {column}]: it has {height} × {width} entries");
    let whole = |n: usize| i64::try_from(n).unwrap_or(i64::MAX);
    let help = if row == whole(height) + 1 && height > 1 && (1..=whole(width)).contains(&column) {
        format!("give `{name}` a row {row}, or let the index end at {height}")
    } else {
        "rows and columns count from 1".to_string()
    };
    Diagnostic::error("dosm::check::index_out_of_table", message, reference.span, "out of the table")
        .with_help(help)
}

fn set_error(code: &'static str, message: String) -> Diagnostic {
    Diagnostic { labels: Vec::new(), ..Diagnostic::error(code, message, Span::default(), "") }
}

pub(in crate::check) fn set_unknown_param(name: &str, near: Option<&str>) -> Diagnostic {
    let message = format!("--set {name}: the mission has no parameter `{name}`");
    let diagnostic = set_error("dosm::check::unknown_param", message);
    match near {
        Some(near) => diagnostic.with_help(format!("did you mean `{near}`?")),
        None => diagnostic,
    }
}

pub(in crate::check) fn set_not_a_param(name: &str, kind: Kind, span: Span) -> Diagnostic {
    let message = format!("--set {name}: `{name}` is {}, not a parameter", kind.a_noun());
    let diagnostic = Diagnostic::error("dosm::check::unknown_param", message, span, "declared here");
    if kind == Kind::Let {
        return diagnostic.with_help(format!("declare it as `param {name} = …`"));
    }
    diagnostic
}

pub(in crate::check) fn set_table(name: &Name) -> Diagnostic {
    let message = format!("--set {}: a table cannot be set from the command line", name.text);
    Diagnostic::error("dosm::check::set_value", message, name.span, "declared here")
}

pub(in crate::check) fn set_wrong_dimension(
    name: &Name,
    text: &str,
    found: Dimension,
    expected: Dimension,
) -> Diagnostic {
    let message =
        format!("--set {}={text}: {} is needed, not {}", name.text, expected.describe(), found.describe());
    Diagnostic::error("dosm::check::wrong_dimension", message, name.span, "the parameter")
}

pub(in crate::check) fn set_invalid(name: &Name, text: &str, reason: &str) -> Diagnostic {
    let message = format!("--set {}={text}: {reason}", name.text);
    Diagnostic::error("dosm::check::set_value", message, name.span, "the parameter")
        .with_help("the value is an expression over numbers, units and predeclared names")
}
