//! What pest's failures mean in people's words, with a mend where one is known.

use crate::diag::Diagnostic;
use crate::source::Span;
use crate::syntax::characters::shown;
use crate::syntax::condensed::Condensed;
use crate::syntax::error;
use crate::syntax::grammar::Rule;
use crate::syntax::mend::{self, Case};
use crate::syntax::scan::Bracket;
use crate::syntax::words::is_reserved;

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

    /// The rules that were tried where the parser stopped.
    pub(super) fn rules(&self) -> &[Rule] {
        &self.expected
    }

    /// Whether a name could have stood where the parser stopped.
    pub(super) fn expects_name(&self) -> bool {
        use Rule::{
            atom, expression, factor, formula, ident, operand, reference, set, set_member, sum, term, value,
        };
        let named =
            [atom, expression, factor, formula, ident, operand, reference, set, set_member, sum, term, value];
        named.iter().any(|rule| self.expects(*rule))
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
        return error::too_nested(span, "brackets");
    }
    if let Some(bracket) = around.bracket {
        let at_it = !bracket.opening && span.start as usize == bracket.offset;
        if at_it || (bracket.opening && found.is_empty()) {
            return error::bracket(bracket, span);
        }
    }
    let place = |start, end| around.place(start, end);
    let case = Case { failure, text, found, span, place: &place };
    if let Some(diagnostic) = mend::known(&case) {
        return diagnostic;
    }
    let message = format!("expected {}, found {}", alternatives(&failure.expected), seen(found, around.next));
    let plain = Diagnostic::error("dosm::syntax::expected", message, span, "unexpected");
    match mend::help(&case) {
        Some(help) => mend::with_fix(&case, plain.with_help(help)),
        None => plain,
    }
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
    // What may follow a whole declaration comes last.
    let ends = expected.iter().filter(|&&rule| rule == Rule::EOI);
    for &rule in expected.iter().filter(|&&rule| rule != Rule::EOI).chain(ends) {
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
    match phrase(rule) {
        Some(phrase) => phrase.to_owned(),
        // Keywords are called `kw_` and the word; other rules are named after what they are.
        None => format!("`{}`", format!("{rule:?}").trim_start_matches("kw_")),
    }
}

/// The words for a rule that is no single word of the language.
fn phrase(rule: Rule) -> Option<&'static str> {
    Some(match rule {
        Rule::EOI => "the next declaration",
        Rule::declaration | Rule::lone_declaration | Rule::leading_declaration | Rule::file => {
            "a declaration"
        }
        Rule::ident | Rule::reference | Rule::family | Rule::names => "a name",
        Rule::index_range => "an index",
        Rule::range => "a range",
        Rule::set | Rule::set_member => "a set of robots",
        Rule::expression | Rule::value | Rule::lone_expression => "an expression",
        Rule::operand | Rule::quantity | Rule::factor | Rule::call => "a number or a name",
        Rule::coordinate => "a coordinate",
        Rule::arithmetic => "an operator",
        Rule::minus => "`-`",
        Rule::unit | Rule::unit_one => "a unit",
        Rule::number => "a number",
        Rule::table | Rule::row => "a table",
        Rule::shape | Rule::piece => "a shape",
        Rule::point => "a point",
        Rule::inequality => "an inequality",
        Rule::initial => "a point or `{`",
        Rule::entry => "the value of a state",
        Rule::signal => "a name with its unit",
        Rule::formula | Rule::atom | Rule::prefix => "a formula",
        Rule::membership => "`ROBOT in REGION`",
        Rule::connective => "a connective",
        Rule::comparator => "a comparison sign",
        Rule::sum | Rule::term | Rule::comparison => "a sum",
        Rule::sum_operator => "`+` or `-`",
        Rule::truth => "`true` or `false`",
        Rule::dynamics_item => "an item of `dynamics`",
        Rule::mode_item | Rule::matrix => "a matrix `A`, `B` or `c`",
        Rule::letter => "`A`, `B` or `c`",
        Rule::connectivity_item => "an item of `connectivity`",
        Rule::plus_minus => "`+/-`",
        Rule::lparen | Rule::group | Rule::formula_group | Rule::counted => "`(`",
        Rule::rparen => "`)`",
        Rule::lbracket | Rule::index | Rule::window | Rule::interval => "`[`",
        Rule::rbracket => "`]`",
        Rule::lbrace | Rule::full_state | Rule::inequalities => "`{`",
        Rule::rbrace => "`}`",
        Rule::comma => "`,`",
        Rule::semicolon => "`;`",
        Rule::colon => "`:`",
        Rule::dots => "`..`",
        Rule::equals => "`=`",
        Rule::at_most => "`<=`",
        Rule::times => "`*`",
        Rule::iff => "`<->`",
        Rule::implies => "`->`",
        Rule::weak_until => "`weak until`",
        Rule::strong_release => "`strong release`",
        Rule::box_shape => "`box`",
        Rule::half_spaces => "`where`",
        Rule::reach => "`range`",
        Rule::constant => "`let`",
        Rule::edition => "`dosm`",
        Rule::defined => "a name",
        Rule::letter_w => "`W`",
        Rule::letter_m => "`M`",
        _ => return None,
    })
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_for_people() {
        for rule in Rule::all_rules() {
            let name = name(*rule);
            assert!(!name.contains('_') || is_lexical(*rule), "{rule:?} is called {name}");
        }
    }

    /// Rules that are parts of tokens or not tracked.
    fn is_lexical(rule: Rule) -> bool {
        matches!(rule, Rule::line_comment | Rule::block_comment | Rule::unit_symbol | Rule::unit_power)
    }
}
