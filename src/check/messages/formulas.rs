//! What is wrong with formulas.

use crate::diag::{Diagnostic, Edit};
use crate::exact::Rational;
use crate::quantity::Dimension;
use crate::source::Span;
use crate::syntax::ast::{Name, Reference, Window};

pub(in crate::check) fn wrong_window_dimension(span: Span, found: Dimension) -> Diagnostic {
    let message = format!("a window is in steps or in times, not in {found}");
    Diagnostic::error("dosm::check::wrong_dimension", message, span, found.describe())
}

pub(in crate::check) fn mixed_window(span: Span) -> Diagnostic {
    let message = "a window is in steps or in times, not in both";
    Diagnostic::error("dosm::check::mixed_window", message, span, "a step and a time")
        .with_help("give both ends a unit, as in `[1 s, 5 s]`, or neither; 0 needs none")
}

pub(in crate::check) fn negative_window(span: Span, number: &Rational) -> Diagnostic {
    let message = format!("a window looks ahead: {} lies in the past", super::shown(number));
    Diagnostic::error("dosm::check::bad_window", message, span, "below 0")
        .with_help("windows begin at 0, the present, or later")
}

pub(in crate::check) fn reversed_window(window: &Window, m: &Rational, n: &Rational) -> Diagnostic {
    let [m, n] = [m, n].map(super::shown);
    let message = format!("the window ends at step {n} before it begins at step {m}");
    Diagnostic::error("dosm::check::bad_window", message, window.span, "the wrong way round")
        .with_help(format!("write `[{n}, {m}]`"))
        .mended_by("swap the ends", vec![Edit::Swap(window.from.span, window.to.span)])
}

pub(in crate::check) fn long_window(span: Span, most: i64) -> Diagnostic {
    let message = format!("the window reaches beyond {most} steps");
    Diagnostic::error("dosm::check::bad_window", message, span, "too long")
}

/// Names the windows of whole steps around the one that was written.
pub(in crate::check) fn window_between_steps(
    span: Span,
    (m, n): (&Rational, &Rational),
    step: &Rational,
) -> Diagnostic {
    let message = format!("the window's times are no whole numbers of steps of {} s", super::shown(step));
    // Times where they read well; a fraction such as `1/3 s` would not even mean what it says.
    let decimal = !super::shown(step).contains(['/', 'e']);
    let end = |steps: Rational| {
        if decimal { format!("{} s", super::shown(&(steps * step))) } else { super::shown(&steps) }
    };
    let window = |from: Rational, to: Rational| format!("`[{}, {}]`", end(from), end(to));
    let inner = (m.ceil(), n.floor());
    let outer = window(m.floor(), n.ceil());
    let label = format!("steps {} to {}", super::shown(m), super::shown(n));
    let diagnostic = Diagnostic::error("dosm::check::window_between_steps", message, span, label);
    let write = |window: &str| vec![Edit::Replace(span, window.trim_matches('`').into())];
    if inner.0 <= inner.1 {
        let inner = window(inner.0, inner.1);
        return diagnostic
            .with_help(format!("the nearest ones that are: {inner} inside, {outer} around"))
            .perhaps_by(format!("write {inner}, the window inside"), write(&inner))
            .perhaps_by(format!("write {outer}, the window around"), write(&outer));
    }
    diagnostic
        .with_help(format!("the nearest one that is: {outer}"))
        .perhaps_by(format!("write {outer}, the window around"), write(&outer))
}

pub(in crate::check) fn count_of_another(variable: &Name, member: &Reference) -> Diagnostic {
    let message = format!("the count runs over `{}`, but looks at `{}`", variable.text, member.name.text);
    Diagnostic::error("dosm::check::count_of_another", message, member.span, format!("`{}`?", variable.text))
        .with_label(variable.span, "the counted variable")
        .mended_by(
            format!("look at `{}`", variable.text),
            vec![Edit::Replace(member.span, variable.text.clone())],
        )
}

pub(in crate::check) fn formula_too_large(span: Span, most: usize) -> Diagnostic {
    let message = format!("the formulas have more than {most} parts once quantifiers are written out");
    Diagnostic::error("dosm::check::formula_too_large", message, span, "too large from here on")
}

pub(in crate::check) fn false_goal(name: &str, span: Span) -> Diagnostic {
    let message = format!("the goal `{name}` can never hold");
    Diagnostic::error("dosm::check::false_goal", message, span, "contradicts itself")
}

pub(in crate::check) fn trivial_goal(name: &str, span: Span) -> Diagnostic {
    let message = format!("the goal `{name}` always holds");
    Diagnostic::warning("dosm::check::trivial_goal", message, span, "asks for nothing")
}
