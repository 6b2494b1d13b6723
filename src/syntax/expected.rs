//! What pest's failures mean in people's words, with a mend where one is known.

use crate::diag::Diagnostic;
use crate::source::Span;
use crate::syntax::characters::shown;
use crate::syntax::condensed::Condensed;
use crate::syntax::error;
use crate::syntax::grammar::Rule;
use crate::syntax::scan::{Bracket, MAX_NESTING, STARTERS};

/// The longest piece of the text that a message repeats, in characters.
const MAX_SHOWN: usize = 40;

/// Where pest stopped, and what it would have taken there.
pub(super) struct Failure {
    /// The offset in the text that pest saw.
    pub(super) position: usize,
    expected: Vec<Rule>,
    /// pest ran out of stack.
    exhausted: bool,
}

impl Failure {
    /// What a pest error says.
    pub(super) fn of(error: &pest::error::Error<Rule>) -> Failure {
        let position = match error.location {
            pest::error::InputLocation::Pos(position) => position,
            pest::error::InputLocation::Span((start, _)) => start,
        };
        match &error.variant {
            pest::error::ErrorVariant::ParsingError { positives, .. } => {
                Failure { position, expected: positives.clone(), exhausted: false }
            }
            pest::error::ErrorVariant::CustomError { .. } => {
                Failure { position, expected: Vec::new(), exhausted: true }
            }
        }
    }

    /// Whether a rule was tried where the parser stopped.
    pub(super) fn expects(&self, rule: Rule) -> bool {
        self.expected.contains(&rule)
    }
}

/// What a failure's explanation has to know besides the text that pest saw.
pub(super) struct Surroundings<'a> {
    /// The whole source.
    pub(super) source: &'a str,
    /// The whole condensed text.
    pub(super) condensed: &'a Condensed,
    /// Where the text that pest saw begins in the condensed text.
    pub(super) base: usize,
    /// The word behind it.
    pub(super) next: Option<&'a str>,
    /// A bracket in it without partner.
    pub(super) bracket: Option<Bracket>,
}

impl Surroundings<'_> {
    fn place(&self, start: usize, end: usize) -> Span {
        self.condensed.span(self.base + start, self.base + end, self.source)
    }
}

/// Explains a failure.
pub(super) fn explain(failure: &Failure, text: &str, around: &Surroundings) -> Diagnostic {
    let found = token_at(text, failure.position);
    let span = around.place(failure.position, failure.position + found.len());
    if failure.exhausted {
        return error::too_nested(span, &format!("brackets or operators (up to {MAX_NESTING})"));
    }
    if let Some(bracket) = around.bracket {
        let at_it = !bracket.opening && span.start as usize == bracket.offset;
        if at_it || (bracket.opening && found.is_empty()) {
            return error::bracket(bracket, span);
        }
    }
    if failure.expects(Rule::ident) && is_reserved(found) {
        return error::reserved_word(span, found);
    }
    let message = format!("expected {}, found {}", alternatives(&failure.expected), seen(found, around.next));
    Diagnostic::error("dosm::syntax::expected", message, span, "unexpected")
}

/// What was found, for a message.
fn seen(found: &str, next: Option<&str>) -> String {
    match (found, next) {
        ("", Some(next)) => format!("`{next}`"),
        ("", None) => "the end of the text".to_owned(),
        _ if is_reserved(found) => format!("the word `{found}` of the language"),
        _ => {
            let short: String = found.chars().take(MAX_SHOWN).collect();
            let dots = if short.len() < found.len() { "…" } else { "" };
            format!("`{}{dots}`", shown(&short))
        }
    }
}

/// The expected things as an enumeration.
fn alternatives(expected: &[Rule]) -> String {
    let mut words: Vec<String> = Vec::new();
    for &rule in expected {
        let word = name(rule);
        if !words.contains(&word) {
            words.push(word);
        }
    }
    match words.as_slice() {
        [] => "something else".to_owned(),
        [one] => one.clone(),
        [most @ .., last] => format!("{} or {last}", most.join(", ")),
    }
}

/// A rule in people's words.
fn name(rule: Rule) -> String {
    let text = match rule {
        Rule::EOI => "the next declaration",
        Rule::declaration => "a declaration",
        Rule::ident => "a name",
        Rule::reference => "a name",
        Rule::expression | Rule::value => "an expression",
        Rule::operand | Rule::quantity | Rule::factor => "a number or a name",
        Rule::arithmetic => "an operator",
        Rule::minus => "`-`",
        Rule::unit | Rule::unit_one => "a unit",
        Rule::number => "a number",
        Rule::table | Rule::row => "a table",
        Rule::shape | Rule::piece => "a shape",
        Rule::point => "a point",
        Rule::formula | Rule::atom | Rule::prefix => "a formula",
        Rule::connective => "a connective",
        Rule::window => "a window",
        Rule::comparator => "a comparison",
        Rule::dynamics_item => "an item of `dynamics`",
        Rule::connectivity_item => "an item of `connectivity`",
        Rule::plus_minus => "`+/-`",
        Rule::lparen | Rule::group | Rule::formula_group | Rule::counted => "`(`",
        Rule::rparen => "`)`",
        Rule::lbracket | Rule::index => "`[`",
        Rule::rbracket => "`]`",
        Rule::lbrace | Rule::full_state => "`{`",
        Rule::rbrace => "`}`",
        Rule::comma => "`,`",
        Rule::semicolon => "`;`",
        Rule::colon => "`:`",
        Rule::dots => "`..`",
        Rule::equals => "`=`",
        Rule::at_most => "`<=`",
        Rule::times => "`*`",
        Rule::sum_operator => "`+` or `-`",
        other => return format!("`{}`", format!("{other:?}").trim_start_matches("kw_")),
    };
    text.to_owned()
}

/// The reserved words that begin no declaration.
const INNER_WORDS: [&str; 25] = [
    "in",
    "at",
    "or",
    "and",
    "not",
    "true",
    "false",
    "always",
    "eventually",
    "next",
    "until",
    "release",
    "weak",
    "strong",
    "count",
    "forall",
    "exists",
    "all",
    "X",
    "F",
    "G",
    "U",
    "R",
    "W",
    "M",
];

/// Whether a word is reserved everywhere.
pub(super) fn is_reserved(word: &str) -> bool {
    STARTERS.contains(&word) || INNER_WORDS.contains(&word)
}

/// Whether a token is a word.
pub(super) fn is_word(token: &str) -> bool {
    token.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
}

/// The token that begins at a place (blanks skipped), empty at the end of the text.
pub(super) fn token_at(text: &str, position: usize) -> &str {
    tokens(text.get(position..).unwrap_or("")).next().map_or("", |(_, token)| token)
}

/// The tokens of a text, each with its place.
pub(super) fn tokens(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut position = 0;
    std::iter::from_fn(move || {
        let rest = text.get(position..)?;
        let blanks = rest.len() - rest.trim_start().len();
        let rest = rest.trim_start();
        let start = position + blanks;
        let length = token_length(rest)?;
        position = start + length;
        rest.get(..length).map(|token| (start, token))
    })
}

fn token_length(rest: &str) -> Option<usize> {
    const SIGNS: [&str; 14] =
        ["<->", "+/-", "<=>", "->", "=>", "<=", ">=", "!=", "==", "<>", "&&", "||", "..", ":="];
    let first = rest.chars().next()?;
    if first.is_ascii_alphanumeric() || first == '_' {
        return Some(rest.bytes().take_while(|b| b.is_ascii_alphanumeric() || *b == b'_').count());
    }
    let sign = SIGNS.iter().find(|sign| rest.starts_with(**sign));
    Some(sign.map_or(first.len_utf8(), |sign| sign.len()))
}
