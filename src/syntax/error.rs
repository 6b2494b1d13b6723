//! The diagnostics of the syntax phase, one small function each.

use crate::diag::{Diagnostic, Edit};
use crate::exact::Rational;
use crate::source::Span;
use crate::syntax::characters::shown;
use crate::syntax::climb::MAX_LEVELS;
use crate::syntax::scan::{Bracket, MAX_NAME, MAX_NESTING};

/// After so many errors the rest isn't looked at.
pub(super) const MAX_ERRORS: usize = 500;

/// The longest text, in bytes.
pub(super) const MAX_TEXT: usize = 64 << 20;

/// The most digits of a number.
pub(super) const MAX_DIGITS: usize = 4_000;

pub(super) fn not_utf8(offset: usize) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::not_utf8",
        format!("the text is no UTF-8: byte {offset} begins no character"),
        Span::new(offset, offset),
        "the first byte that can't be read",
    )
    .with_help("save the file in the encoding UTF-8")
}

pub(super) fn text_too_long(length: usize) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::text_too_long",
        format!("the text has {length} bytes; a mission has at most {MAX_TEXT}"),
        Span::new(0, 0),
        "",
    )
}

pub(super) fn empty(span: Span) -> Diagnostic {
    Diagnostic::error("dosm::syntax::empty", "there is no mission in this text", span, "")
        .with_help("a mission begins with `dosm 1` and needs a `workspace` and a `robot`")
}

pub(super) fn too_many(span: Span) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::too_many_errors",
        format!("more than {MAX_ERRORS} errors; the rest of the text was not looked at"),
        span,
        "given up here",
    )
}

pub(super) fn too_nested(span: Span, what: &str) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::too_nested",
        format!("{what} nest more than {MAX_NESTING} deep"),
        span,
        format!("level {}", MAX_NESTING + 1),
    )
}

pub(super) fn too_deep(span: Span, what: &str) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::too_deep",
        format!("this {what} has more than {MAX_LEVELS} levels"),
        span,
        "",
    )
    .with_help("name parts of it with `define` or `let`")
}

pub(super) fn long_name(span: Span, length: usize) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::long_name",
        format!("a name has at most {MAX_NAME} characters, this one has {length}"),
        span,
        "",
    )
}

pub(super) fn hidden_character(span: Span, character: char, name: &str) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::hidden_character",
        format!("U+{:04X}, {name}, can't stand in a mission", character as u32),
        span,
        "here",
    )
    .with_help("remove it, or put an ordinary blank in its place")
    .mended_by("put a blank in its place", vec![Edit::Replace(span, " ".into())])
}

pub(super) fn lookalike(span: Span, character: char, meant: &str) -> Diagnostic {
    let diagnostic = Diagnostic::error(
        "dosm::syntax::lookalike",
        format!("`{character}` (U+{:04X}) is no sign of the language", character as u32),
        span,
        "",
    );
    with_meant(diagnostic, span, meant)
}

/// With what the language writes for a character, where it has something like it.
fn with_meant(diagnostic: Diagnostic, span: Span, meant: &str) -> Diagnostic {
    if meant == "\"" {
        return diagnostic
            .with_help("there are no quotation marks in missions")
            .mended_by("remove it", vec![Edit::Remove(span)]);
    }
    diagnostic.with_help(format!("write `{meant}`")).meant(span, meant)
}

pub(super) fn foreign_letter(span: Span, character: char) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::foreign_letter",
        format!("`{character}` (U+{:04X}) can't stand in a name", character as u32),
        span,
        "",
    )
    .with_help("names are made of the letters a to z and A to Z, digits and `_`")
}

pub(super) fn unknown_character(span: Span, character: char) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::unknown_character",
        format!("`{character}` (U+{:04X}) is no sign of the language", character as u32),
        span,
        "",
    )
    .perhaps_by("remove it", vec![Edit::Remove(span)])
}

pub(super) fn unclosed_comment(span: Span) -> Diagnostic {
    Diagnostic::error("dosm::syntax::unclosed_comment", "this comment doesn't end", span, "it begins here")
        .with_help("each `/*` needs its own `*/`; comments nest")
}

pub(super) fn bracket(bracket: Bracket, end: Span) -> Diagnostic {
    let span = Span::new(bracket.offset, bracket.offset + 1);
    let sign = bracket.sign;
    if bracket.opening {
        Diagnostic::error(
            "dosm::syntax::unclosed_bracket",
            format!("`{sign}` is never closed"),
            span,
            "opened here",
        )
        .with_label(end, "not closed up to here")
        .perhaps_by("close it here", closed(sign, end))
    } else {
        Diagnostic::error("dosm::syntax::unopened_bracket", format!("`{sign}` closes nothing"), span, "")
            .perhaps_by("remove it", vec![Edit::Remove(span)])
    }
}

/// The partner of an opening bracket, before what can't be in it.
fn closed(sign: char, end: Span) -> Vec<Edit> {
    let partner = match sign {
        '(' => ")",
        '[' => "]",
        _ => "}",
    };
    vec![Edit::Append(Span { end: end.start, ..end }, partner.into())]
}

pub(super) fn missing_edition(span: Span) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::missing_edition",
        "a mission begins with its language's edition",
        span,
        "something else stands first",
    )
    .with_help("begin the file with `dosm 1`")
    .mended_by("write `dosm 1`", vec![Edit::Replace(Span { end: span.start, ..span }, "dosm 1\n\n".into())])
}

pub(super) fn unknown_edition(span: Span, value: &Rational) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::unknown_edition",
        format!("there is no edition {value} of the language here"),
        span,
        "this version knows edition 1",
    )
    .with_help("write `dosm 1`")
    .meant(span, "1")
}

pub(super) fn number_range(span: Span) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::number_range",
        "numbers lie between 1e-300 and 1e300, or are 0",
        span,
        "out of range",
    )
}

pub(super) fn number_too_long(span: Span, digits: usize) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::number_too_long",
        format!("a number has at most {MAX_DIGITS} digits, this one has {digits}"),
        span,
        "",
    )
}

pub(super) fn unit_exponent(span: Span) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::unit_exponent",
        "a unit's exponent lies between -64 and 64 and is not 0",
        span,
        "",
    )
}

pub(super) fn unit_in_exponent(span: Span, inside: Span, power: &str, unit: &str) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::unit_in_exponent",
        "the unit belongs to the exponent, since units bind tighter than every operator",
        span,
        "an exponent with a unit",
    )
    .with_help(format!("write `({}) {}`", shown(power), shown(unit)))
    .mended_by("put the power in brackets", in_brackets(inside))
}

/// Brackets around a place.
fn in_brackets(inside: Span) -> Vec<Edit> {
    let start = Span { end: inside.start, ..inside };
    vec![Edit::Replace(start, "(".into()), Edit::Append(inside, ")".into())]
}

pub(super) fn unit_twice(inner: Span, outer: Span) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::unit_twice",
        "a unit follows a bracket whose inside has a unit already",
        outer,
        "a second unit",
    )
    .with_label(inner, "the first one")
    .with_help("keep one of them")
    .perhaps_by("remove the second one", vec![Edit::Remove(outer)])
}

pub(super) fn window_on_next(span: Span) -> Diagnostic {
    Diagnostic::error("dosm::syntax::window_on_next", "`next` takes no window", span, "this window")
        .with_help("`next` is one step; for the step n write `always[n, n]` or `eventually[n, n]`")
        .perhaps_by("remove the window", vec![Edit::Remove(span)])
}

pub(super) fn missing_comma(span: Span) -> Diagnostic {
    Diagnostic::error("dosm::syntax::missing_comma", "a comma is missing between two entries", span, "")
        .with_help(
            "entries are separated by commas, rows by `;`: `[0, 1; 1, 0]`; a difference is written `a - b`",
        )
        .mended_by("write a comma", vec![Edit::Append(Span { end: span.start, ..span }, ",".into())])
}

pub(super) fn unreadable(span: Span) -> Diagnostic {
    Diagnostic::error("dosm::syntax::expected", "this can't be read", span, "")
}

pub(super) fn reserved_word(span: Span, word: &str) -> Diagnostic {
    let what = match operator_word(word) {
        Some(operator) => format!("the operator `{operator}`"),
        None => "a word of the language".to_owned(),
    };
    Diagnostic::error(
        "dosm::syntax::reserved_word",
        format!("`{word}` is {what} and can't be a name"),
        span,
        "a name is expected here",
    )
    .with_help(format!("choose another name, such as `{}`", other_name(word)))
    .perhaps_by(format!("write `{}`", other_name(word)), vec![Edit::Replace(span, other_name(word))])
}

/// The word that an operator's letter stands for.
pub(super) fn operator_word(letter: &str) -> Option<&'static str> {
    Some(match letter {
        "X" => "next",
        "F" => "eventually",
        "G" => "always",
        "U" => "until",
        "R" => "release",
        "W" => "weak until",
        "M" => "strong release",
        _ => return None,
    })
}

/// A name near a reserved word.
fn other_name(word: &str) -> String {
    if word.len() == 1 { format!("{word}1") } else { format!("{word}_1") }
}

pub(super) fn double_equals(span: Span) -> Diagnostic {
    Diagnostic::error("dosm::syntax::double_equals", "`==` is no operator", span, "")
        .with_help("equality is written `=`")
        .meant(span, "=")
}

pub(super) fn number_form(span: Span, mend: Option<String>) -> Diagnostic {
    let plain = Diagnostic::error("dosm::syntax::number_form", "this is no number", span, "");
    plain.with_help(mend.unwrap_or_else(|| "numbers look like `12`, `0.5` and `1e-3`".to_owned()))
}

pub(super) fn unit_after_bracket(span: Span) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::misplaced_unit",
        "no unit follows the bracket of an index or of a window",
        span,
        "this unit",
    )
    .with_help("write `(P[1, 2]) m` for an entry, and units inside a window: `[0 s, 5 s]`")
}

pub(super) fn unit_after_name(span: Span, name: &str, unit: &str) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::misplaced_unit",
        "a unit follows a number or a closing bracket, not a name",
        span,
        "this unit",
    )
    .with_help(format!("write `({name}) {unit}` if `{name}` has no unit itself, else leave the unit out"))
    .perhaps_by(format!("remove `{unit}`"), vec![Edit::Remove(span)])
}

pub(super) fn unit_with_blanks(span: Span, left: &str, sign: &str, right: &str) -> Diagnostic {
    Diagnostic::error("dosm::syntax::unit_with_blanks", "units are written without blanks inside", span, "")
        .with_help(format!("write `{left}{sign}{right}`"))
        .mended_by(format!("write `{left}{sign}{right}`"), vec![Edit::Tighten(span)])
}

pub(super) fn chained_comparison(span: Span) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::chained_comparison",
        "a comparison has two sides only",
        span,
        "a second comparison",
    )
    .with_help("write two comparisons: `0 <= x; x <= 5` among half-spaces, `… and …` in a formula")
}

pub(super) fn counted_formula(span: Span, help: &str) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::expected",
        "a count is over `ROBOT in REGION` alone",
        span,
        "not a robot",
    )
    .with_help(help)
}

pub(super) fn sum_bracket(span: Span) -> Diagnostic {
    Diagnostic::error(
        "dosm::syntax::sum_bracket",
        "sums have no brackets but `count(…)` and `(ROBOT in REGION)`",
        span,
        "",
    )
    .with_help("multiply the bracket out, or name the constant with `let`")
}
