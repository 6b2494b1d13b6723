//! What is wrong with the mission as a whole.

use crate::check::names::nearest;
use crate::diag::{Diagnostic, Edit};
use crate::exact::Rational;
use crate::source::Span;
use crate::syntax::ast::Name;
use crate::syntax::words::OBJECTIVES;

pub(in crate::check) fn missing_robot(span: Span) -> Diagnostic {
    let end = Span { start: span.end, end: span.end };
    Diagnostic::error("dosm::check::missing_robot", "the mission has no robot", end, "missing")
        .with_help("add one, such as `robot R1: Rover at (4.5, 1)`")
}

/// All robots are families, and none of them has a member.
pub(in crate::check) fn empty_families(names: &[&Name]) -> Diagnostic {
    let [first, others @ ..] = names else { return missing_robot(Span::default()) };
    let message = "the mission has no robot: its families are empty";
    let diagnostic = Diagnostic::error("dosm::check::missing_robot", message, first.span, "has no members");
    others
        .iter()
        .fold(diagnostic, |d, name| d.with_label(name.span, "has no members either"))
        .with_help("let an index run over at least one number")
}

pub(in crate::check) fn missing_base(span: Span) -> Diagnostic {
    let message = "the mission has no base that the robots could reach";
    Diagnostic::error("dosm::check::missing_base", message, span, "must reach a base at every step")
        .with_help("add one, such as `base B1 at (1, 1)`, or write `connectivity none`")
        .perhaps_by("add `base B1 at (1, 1)`", vec![Edit::AtEnd("base B1 at (1, 1)".into())])
        .perhaps_by("add `connectivity none`", vec![Edit::AtEnd("connectivity none".into())])
}

pub(in crate::check) fn bad_horizon(from: Span, to: Span, a: i64, b: i64, most: i64) -> Diagnostic {
    let message = format!("the horizon {a}..{b} is none: 1 ≤ A ≤ B ≤ {most}");
    let diagnostic = Diagnostic::error("dosm::check::bad_horizon", message, from.to(to), "no lengths to try");
    if b < a && (1..=most).contains(&b) {
        return diagnostic
            .with_help(format!("write `horizon {b}..{a}`"))
            .mended_by("swap the ends", vec![Edit::Swap(from, to)]);
    }
    diagnostic
}

pub(in crate::check) fn bad_hops(span: Span, hops: i64) -> Diagnostic {
    let message = format!("a path to a base has at least one link, not {hops}");
    let message = if hops < 1 { message } else { format!("{hops} links are too many") };
    Diagnostic::error("dosm::check::bad_hops", message, span, "not a number of links")
        .with_help("leave `hops` out to allow any number; `connectivity none` asks for no links at all")
}

pub(in crate::check) fn bad_redundancy(span: Span, lost: i64, most: i64) -> Diagnostic {
    let message = format!("0 to {most} robots may be lost, not {lost}");
    Diagnostic::error("dosm::check::bad_redundancy", message, span, "not a number of robots to lose")
        .with_help("more bases, or robots that stay near one, make losses matter less")
}

/// Names the nearest whole numbers of steps; as times of this step, where that is what was written.
pub(in crate::check) fn bad_every(
    span: Span,
    steps: &Rational,
    step: Option<&Rational>,
    most: i64,
) -> Diagnostic {
    let message = format!("links are required every so many whole steps, not every {}", super::shown(steps));
    let time = step.filter(|step| !super::shown(step).contains(['/', 'e']));
    let every = |steps: Rational| match time {
        Some(step) => format!("`every {} s`", super::shown(&(steps * step))),
        None => format!("`every {}`", super::shown(&steps)),
    };
    let longest = Rational::from(most);
    let help = if *steps < Rational::ONE {
        format!("the most often is each step, {}", every(Rational::ONE))
    } else if *steps > longest {
        format!("at most {most} steps may lie between; `connectivity none` asks for no links at all")
    } else {
        format!("the nearest are {} and {}", every(steps.floor()), every(steps.ceil()))
    };
    Diagnostic::error("dosm::check::bad_every", message, span, "not a whole number of steps, 1 or more")
        .with_help(help)
}

pub(in crate::check) fn unknown_objective(word: &Name) -> Diagnostic {
    let message = format!("nothing called `{}` can be minimised", word.text);
    let diagnostic =
        Diagnostic::error("dosm::check::unknown_objective", message, word.span, "not an objective");
    match nearest(&word.text, OBJECTIVES.into_iter()) {
        Some(near) => diagnostic.with_help(format!("did you mean `{near}`?")).meant(word.span, near),
        None => {
            OBJECTIVES.iter().fold(diagnostic.with_help("`effort` or `length`"), |diagnostic, objective| {
                let edits = vec![Edit::Replace(word.span, (*objective).into())];
                diagnostic.perhaps_by(format!("write `{objective}`"), edits)
            })
        }
    }
}
