//! What is wrong with motion models and starts.

use crate::check::names::nearest;
use crate::check::typed::Signal;
use crate::diag::{Diagnostic, Edit};
use crate::exact::Rational;
use crate::quantity::Dimension;
use crate::source::Span;
use crate::syntax::ast::Name;

pub(in crate::check) fn missing_step(name: &Name) -> Diagnostic {
    let message = format!("the model `{}` has no sampling time", name.text);
    Diagnostic::error("dosm::check::missing_step", message, name.span, "`step` is missing")
        .with_help("add an item such as `step 0.5 s`")
        .perhaps_by("add `step 0.5 s`", vec![Edit::IntoBlock(name.span, "step 0.5 s".into())])
}

pub(in crate::check) fn different_steps(
    (a, a_span, a_step): (&str, Span, &Rational),
    (b, b_span, b_step): (&str, Span, &Rational),
) -> Diagnostic {
    let [a_step, b_step] = [a_step, b_step].map(super::shown);
    let message = format!("the models `{a}` and `{b}` have different steps: {a_step} s and {b_step} s");
    Diagnostic::error("dosm::check::different_steps", message, b_span, format!("{b_step} s"))
        .with_label(a_span, format!("{a_step} s"))
        .with_help("all models in use share one sampling time")
        .perhaps_by(
            format!("write `step {a_step} s` here"),
            vec![Edit::Replace(b_span, format!("step {a_step} s"))],
        )
        .perhaps_by(
            format!("write `step {b_step} s` there"),
            vec![Edit::Replace(a_span, format!("step {b_step} s"))],
        )
}

pub(in crate::check) fn not_positive(span: Span, what: &str, value: &Rational) -> Diagnostic {
    let message = format!("{what} is above 0, not {}", super::shown(value));
    Diagnostic::error("dosm::check::not_positive", message, span, "not positive")
}

pub(in crate::check) fn bad_rejection(span: Span, share: &Rational) -> Diagnostic {
    let message = format!("the rejection share lies between 0 and 1, not at {}", super::shown(share));
    Diagnostic::error("dosm::check::bad_rejection", message, span, "not between 0 and 1")
}

pub(in crate::check) fn missing_items(name: &Name, missing: &[&str]) -> Diagnostic {
    let message = format!("the model `{}` lacks {}", name.text, missing.join(", "));
    Diagnostic::error("dosm::check::missing_item", message, name.span, "incomplete")
        .with_help("give state, input, position, A and B, or `integrator 2` in their place")
}

pub(in crate::check) fn integrator_clash(integrator: Span, other: Span, what: &str) -> Diagnostic {
    let message = format!("`integrator` stands for the whole model: `{what}` may not be given too");
    Diagnostic::error("dosm::check::integrator_clash", message, other, "given here")
        .with_label(integrator, "the integrator")
        .perhaps_by(format!("remove `{what}`"), vec![Edit::Remove(other)])
}

pub(in crate::check) fn stiff_model(span: Span) -> Diagnostic {
    let message = "the model changes too much within a step to be sampled";
    Diagnostic::error("dosm::check::stiff_model", message, span, "its exponential is out of range")
        .with_help("take a shorter step, or leave the fastest states out")
}

pub(in crate::check) fn bad_order(span: Span, order: i64, most: usize) -> Diagnostic {
    let message = format!("a chain has 1 to {most} integrators, not {order}");
    Diagnostic::error("dosm::check::bad_order", message, span, "not an order that there is")
}

pub(in crate::check) fn duplicate_signal(name: &Name, first: Span) -> Diagnostic {
    let message = format!("`{}` is given twice", name.text);
    let other = format!("{}_2", name.text);
    Diagnostic::error("dosm::check::duplicate", message, name.span, "again")
        .with_label(first, "first here")
        .perhaps_by(format!("call this one `{other}`"), vec![Edit::Replace(name.span, other)])
}

pub(in crate::check) fn unknown_signal<'s>(
    name: &Name,
    wanted: &str,
    signals: impl Iterator<Item = &'s Signal>,
) -> Diagnostic {
    let names: Vec<&str> = signals.map(|s| s.name.as_str()).collect();
    let message = format!("the model has no {wanted} `{}`", name.text);
    let diagnostic = Diagnostic::error("dosm::check::unknown_signal", message, name.span, "not declared");
    match nearest(&name.text, names.iter().copied()) {
        Some(near) => diagnostic.with_help(format!("did you mean `{near}`?")).meant(name.span, near),
        None => diagnostic.with_help(format!("it has {}", names.join(", "))),
    }
}

pub(in crate::check) fn disturbed_input(name: &Name) -> Diagnostic {
    let message = format!("`{}` is an input; a disturbance is added to states", name.text);
    Diagnostic::error("dosm::check::unknown_signal", message, name.span, "not a state")
        .with_help("name the states that it moves, each step")
}

pub(in crate::check) fn incoherent_unit(span: Span, dimension: Dimension) -> Diagnostic {
    let message = "the unit of a state or an input is a coherent SI unit";
    Diagnostic::error("dosm::check::incoherent_unit", message, span, "another scale")
        .with_help(format!("write `{dimension}`; values elsewhere may have any unit"))
        .meant(span, &dimension.to_string())
}

pub(in crate::check) fn repeated_position(name: &Name) -> Diagnostic {
    let message = format!("`{}` is two coordinates at once", name.text);
    Diagnostic::error("dosm::check::wrong_position", message, name.span, "again")
}

pub(in crate::check) fn wrong_position_count(span: Span, found: usize, wanted: usize) -> Diagnostic {
    let message = format!("{found} position{} in a workspace of {wanted} dimensions", super::plural(found));
    Diagnostic::error("dosm::check::wrong_position", message, span, format!("{wanted} states are needed"))
}

pub(in crate::check) fn wrong_matrix_size(
    span: Span,
    letter: &str,
    (height, width): (usize, usize),
    (rows, columns): (usize, usize),
) -> Diagnostic {
    let message = format!("{letter} is {height} × {width}, but must be {rows} × {columns}");
    let reason = match letter {
        "A" => "a row and a column for each state",
        "B" => "a row for each state and a column for each input",
        _ => "an entry for each state",
    };
    Diagnostic::error("dosm::check::wrong_matrix_size", message, span, reason)
}

pub(in crate::check) fn missing_bound(name: &Name, inputs: &[&str]) -> Diagnostic {
    let list = inputs.join(", ");
    let message = format!("the model `{}` has an input without a bound: {list}", name.text);
    let item = format!("bound {list} in [-4, 4]");
    Diagnostic::error("dosm::check::missing_bound", message, name.span, "every input needs a bound")
        .with_help(format!("add an item such as `{item}`"))
        .perhaps_by(format!("add `{item}`"), vec![Edit::IntoBlock(name.span, item)])
}

pub(in crate::check) fn repeated_interval(name: &Name, first: Span) -> Diagnostic {
    let message = format!("`{}` has an interval already", name.text);
    Diagnostic::error("dosm::check::duplicate", message, name.span, "again").with_label(first, "first here")
}

/// The ends are given as written, so that the help can swap them.
pub(in crate::check) fn empty_interval(
    span: Span,
    (from, from_span): (&str, Span),
    (to, to_span): (&str, Span),
) -> Diagnostic {
    let message = format!("the interval is empty: {from} is above {to}");
    Diagnostic::error("dosm::check::empty_interval", message, span, "lower end above the upper one")
        .with_help(format!("write `[{to}, {from}]`"))
        .mended_by("swap the ends", vec![Edit::Swap(from_span, to_span)])
}

pub(in crate::check) fn point_bound(span: Span) -> Diagnostic {
    let message = "a bound that leaves one value leaves no room for feedback";
    Diagnostic::error("dosm::check::empty_interval", message, span, "both ends are the same")
}
