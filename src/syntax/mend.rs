//! Mistakes whose mend is known, recognised at the place where the parser stopped.

use crate::diag::{Diagnostic, Edit};
use crate::source::Span;
use crate::syntax::error;
use crate::syntax::expected::{Failure, is_word, token_at};
use crate::syntax::grammar::Rule;
use crate::syntax::words::{CONNECTIVITY_ITEMS, DECLARATIONS, DYNAMICS_ITEMS, SHAPES, UNITS, is_reserved};

/// The keywords that may begin what a rule matches, for the rules that messages name as a whole.
const WORDS_OF: [(Rule, &[&str]); 7] = [
    (Rule::EOI, &DECLARATIONS),
    (Rule::declaration, &DECLARATIONS),
    (Rule::dynamics_item, &DYNAMICS_ITEMS),
    (Rule::connectivity_item, &CONNECTIVITY_ITEMS),
    (Rule::shape, &SHAPES),
    (Rule::piece, &SHAPES),
    (Rule::connective, &["and", "or", "until", "release", "weak", "strong"]),
];

/// What to write where a count is asked to look at more than one region.
const COUNT_OF_FORMULA: &str = "a count says how many are in one region: `count(r in all: r in A)`; how many \
                                are outside is the number of robots less that";

/// Words of other languages for temporal operators, in lower case, with ours.
const OPERATORS: [(&str, &str); 9] = [
    ("globally", "always"),
    ("henceforth", "always"),
    ("box", "always"),
    ("finally", "eventually"),
    ("diamond", "eventually"),
    ("sometime", "eventually"),
    ("sometimes", "eventually"),
    ("x", "next"),
    ("nexttime", "next"),
];

/// A place where the parser stopped.
pub(super) struct Case<'a> {
    /// What pest says.
    pub(super) failure: &'a Failure,
    /// The text that pest saw.
    pub(super) text: &'a str,
    /// The token at the place.
    pub(super) found: &'a str,
    /// Its place in the source.
    pub(super) span: Span,
    /// The place in the source of a part of the text.
    pub(super) place: &'a dyn Fn(usize, usize) -> Span,
}

/// The diagnostic of a mistake that is known as such.
pub(super) fn known(case: &Case) -> Option<Diagnostic> {
    const MISTAKES: [fn(&Case) -> Option<Diagnostic>; 10] = [
        counted_sum,
        counted_formula,
        reserved_word,
        double_equals,
        number_form,
        misplaced_unit,
        unit_with_blanks,
        missing_comma,
        chained_comparison,
        sum_bracket,
    ];
    MISTAKES.iter().find_map(|mistake| mistake(case))
}

/// A mend for a sign or word that stands where something else was expected.
pub(super) fn help(case: &Case) -> Option<String> {
    let ends = case.failure.expects(Rule::EOI);
    let text = match case.found {
        "&" => "the operator is `and` or `&&`",
        "|" => "the operator is `or` or `||`",
        "~" | "¬" => "the operator is `not` or `!`",
        "=>" => "the operator is `->`",
        "<=>" => "the operator is `<->`",
        ":=" => "write `=`",
        "#" => "comments begin with `//`",
        "%" => "the remainder is `mod(a, b)`; comments begin with `//`",
        "*" if case.before().ends_with('*') => "powers are written with `^`",
        "\"" | "'" | "`" => "there are no quotation marks in missions",
        ";" if ends => "declarations are not followed by `;`",
        "[" if case.before().ends_with('[') => "rows are separated by `;`: `[1, 0; 0, 1]`",
        "=" if case.failure.expects(Rule::expression) => "leave the `=` out",
        "," if case.failure.expects(Rule::kw_radius) => "no comma stands before `radius`",
        "<" if case.last_is("hops") => "the bound is included: `<=`",
        _ if case.last_is("hops") && case.failure.expects(Rule::at_most) => "write `hops <= 3`",
        "<" | "<=" | "=" if case.last_is("range") => "the length follows at once: `range 6 m`",
        "none" if case.failure.expects(Rule::connectivity_item) => "write `connectivity none`, without `{ }`",
        "[" if case.names_goal() => "goals have no families: write `goal NAME: forall i in 1..3: …`",
        "" if case.declares("horizon") && case.failure.expects(Rule::dots) => {
            "a horizon is a range of lengths, such as `1..40`"
        }
        "and" | "&&" | "or" | "||" if case.inside_count() => COUNT_OF_FORMULA,
        "implies" => "the operator is `->`",
        "iff" => "the operator is `<->`",
        "not" if case.failure.expects(Rule::kw_in) => "`not` stands before the robot: `not R1 in A`",
        "=" | "!=" | "<" | "<=" | ">" | ">=" if case.follows_atom() => {
            "a compared atom needs brackets: `(R1 in A) = 1`"
        }
        word if is_reserved(word) && case.failure.expects_name() => {
            return Some(match error::operator_word(word) {
                Some(operator) => format!("`{word}` stands for `{operator}` and can't be a name"),
                None => "it is a word of the language and can't be a name".to_owned(),
            });
        }
        word if is_word(word) => return case.help_for_word(),
        _ => return None,
    };
    Some(text.to_owned())
}

/// The mend of [`help`] as an edit, where it can be made without knowing more.
pub(super) fn with_fix(case: &Case, diagnostic: Diagnostic) -> Diagnostic {
    let found = case.found;
    let written = |word: &str| diagnostic.clone().meant(case.span, word);
    let left_out =
        || diagnostic.clone().mended_by(format!("leave `{found}` out"), vec![Edit::Remove(case.span)]);
    let ends = case.failure.expects(Rule::EOI);
    match found {
        "&" => written("and"),
        "|" => written("or"),
        "~" => written("not"),
        "=>" | "implies" => written("->"),
        "<=>" | "iff" => written("<->"),
        ":=" => written("="),
        "*" if case.before().ends_with('*') => diagnostic
            .mended_by("write `^`", vec![Edit::Replace(case.place_of_last(1).to(case.span), "^".into())]),
        ";" if ends => left_out(),
        "=" if case.failure.expects(Rule::expression) => left_out(),
        "," if case.failure.expects(Rule::kw_radius) => left_out(),
        "<" if case.last_is("hops") => written("<="),
        _ if case.last_is("hops") && case.failure.expects(Rule::at_most) => {
            let place = Span { end: case.span.start, ..case.span };
            diagnostic.mended_by("write `<=`", vec![Edit::Replace(place, "<= ".into())])
        }
        "<" | "<=" | "=" if case.last_is("range") => left_out(),
        word if is_word(word) && !is_reserved(word) => match case.operator_meant() {
            Some((other, own)) => {
                let edits = vec![Edit::Replace(case.place_of_last(other.len()), own.clone())];
                diagnostic.mended_by(format!("write `{own}`"), edits)
            }
            None => match case.word_meant() {
                Some(near) => written(&near),
                None => diagnostic,
            },
        },
        _ => diagnostic,
    }
}

impl Case<'_> {
    /// What stands before the place, without the blanks at its end.
    fn before(&self) -> &str {
        self.text.get(..self.failure.position).unwrap_or("").trim_end()
    }

    /// What stands behind the found token.
    fn after(&self) -> &str {
        self.text.get(self.failure.position + self.found.len()..).unwrap_or("")
    }

    /// Whether the found token touches what stands before it.
    fn touches(&self) -> bool {
        self.before().len() == self.failure.position
    }

    fn place_of_last(&self, length: usize) -> Span {
        let end = self.before().len();
        (self.place)(end.saturating_sub(length), end)
    }

    /// Whether the found token stands behind `ROBOT in REGION`.
    fn follows_atom(&self) -> bool {
        let mut words = self.before().rsplit(char::is_whitespace);
        self.failure.expects(Rule::connective) && words.nth(1) == Some("in")
    }

    /// Whether the last word before the place is this one.
    fn last_is(&self, word: &str) -> bool {
        last_word(self.before()) == word
    }

    /// Whether the text seen begins with this word.
    fn declares(&self, word: &str) -> bool {
        first_word(self.text) == word
    }

    /// Whether the place is behind the name of a goal, where `:` should be.
    fn names_goal(&self) -> bool {
        self.declares("goal") && self.failure.expects(Rule::colon) && !self.before().contains(':')
    }

    /// Whether the place is behind the colon of a `count(…: …`.
    fn inside_count(&self) -> bool {
        let Some((head, body)) = self.before().rsplit_once(':') else { return false };
        let open = head.rsplit_once('(').is_some_and(|(before, _)| last_word(before.trim_end()) == "count");
        open && !body.contains(')')
    }

    /// A mend for an operator of another language, or in capitals, that was taken for a name.
    fn help_for_operator(&self) -> Option<String> {
        let (word, own) = self.operator_meant()?;
        Some(format!("did you mean `{own}` for `{word}`?"))
    }

    /// The operator of another language, or in capitals, that was taken for a name, and ours.
    fn operator_meant(&self) -> Option<(&str, String)> {
        if !self.failure.expects(Rule::connective) {
            return None;
        }
        let word = last_word(self.before());
        let lower = word.to_ascii_lowercase();
        let own = OPERATORS.iter().find(|(other, _)| *other == lower).map(|(_, own)| *own);
        let capital = lower != word && is_reserved(&lower) && lower.len() > 1;
        own.or(capital.then_some(lower.as_str())).map(|own| (word, own.to_owned()))
    }

    /// The word of the language that is meant by the one found, as the help for it says.
    fn word_meant(&self) -> Option<String> {
        let help = self.help_for_word()?;
        help.strip_prefix("did you mean `")?.strip_suffix("`?").map(str::to_owned)
    }

    /// A mend for a word that is no word of the language.
    fn help_for_word(&self) -> Option<String> {
        if let Some(help) = self.help_for_operator() {
            return Some(help);
        }
        let lower = self.found.to_ascii_lowercase();
        if lower != self.found && lower.len() > 1 && is_reserved(&lower) {
            return Some(format!("did you mean `{lower}`?"));
        }
        let near = self.nearest_keyword();
        let number_before = self.before().ends_with(|c: char| c.is_ascii_digit());
        // `5 feet` is not meant to begin with `let`.
        let unlike = near.as_ref().is_none_or(|near| 3 * distance(self.found, near) > self.found.len());
        if unlike && number_before && self.failure.expects(Rule::unit) {
            return Some(format!("the units are {}; products are written with `*`", UNITS.join(", ")));
        }
        if near.is_none() && self.failure.expects(Rule::connectivity_item) {
            return Some("the items are `hops`, `range`, `redundancy` and `every`".to_owned());
        }
        if near.is_none() && [Rule::shape, Rule::piece].iter().any(|r| self.failure.expects(*r)) {
            return Some("the shapes are `box`, `ball`, `disc`, `polygon`, `hull` and `where`".to_owned());
        }
        near.map(|near| format!("did you mean `{near}`?"))
    }

    /// The keyword that would fit and is spelt nearly like the found word.
    fn nearest_keyword(&self) -> Option<String> {
        let mut keywords: Vec<String> = self
            .failure
            .rules()
            .iter()
            .filter_map(|rule| format!("{rule:?}").strip_prefix("kw_").map(str::to_owned))
            .collect();
        for (rule, words) in WORDS_OF {
            if self.failure.expects(rule) {
                keywords.extend(words.iter().map(|word| (*word).to_owned()));
            }
        }
        nearest(self.found, keywords.iter().map(String::as_str)).map(str::to_owned)
    }
}

/// `2 * (count(r in all: r in A) + 1)`
fn counted_sum(case: &Case) -> Option<Diagnostic> {
    let factor = case.before().strip_suffix('(').is_some_and(|rest| rest.trim_end().ends_with('*'));
    (case.found == "count" && factor).then(|| error::sum_bracket(case.place_of_last(1)))
}

/// `count(r in all: not r in A)`
fn counted_formula(case: &Case) -> Option<Diagnostic> {
    let not = matches!(case.found, "not" | "!") && case.inside_count();
    not.then(|| error::counted_formula(case.span, COUNT_OF_FORMULA))
}

fn reserved_word(case: &Case) -> Option<Diagnostic> {
    (case.failure.expects(Rule::ident) && is_reserved(case.found))
        .then(|| error::reserved_word(case.span, case.found))
}

fn double_equals(case: &Case) -> Option<Diagnostic> {
    (case.found == "==").then(|| error::double_equals(case.span))
}

/// `.5`, `1.`, `12abc`, `1_000`, `0x10`, `1e`
fn number_form(case: &Case) -> Option<Diagnostic> {
    let digit_follows = case.after().starts_with(|c: char| c.is_ascii_digit());
    if case.found == "." && !case.before().ends_with('.') {
        let run = if case.touches() { trailing_number(case.before()) } else { "" };
        let digits = case.after().bytes().take_while(u8::is_ascii_digit).count();
        let end = case.failure.position + 1 + digits;
        let start = case.failure.position - run.len();
        let mend = match (run, digit_follows) {
            ("", true) => Some(format!("write `0{}`", case.text.get(start..end).unwrap_or(""))),
            (whole, false) if !whole.is_empty() && !whole.contains('.') => Some(format!("write `{whole}`")),
            _ => None,
        };
        let form = |diagnostic: Diagnostic| match &mend {
            Some(mend) => diagnostic
                .meant((case.place)(start, end), mend.trim_start_matches("write ").trim_matches('`')),
            None => diagnostic,
        };
        return (digit_follows || !run.is_empty())
            .then(|| form(error::number_form((case.place)(start, end), mend.clone())));
    }
    let touching = case.touches() && case.found.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
    let run = trailing_number(case.before());
    if !touching || run.is_empty() {
        return None;
    }
    let start = case.failure.position - run.len();
    let end = case.failure.position + case.found.len();
    let mend = case.found.starts_with('_').then(|| "digits are written without separators".to_owned());
    Some(error::number_form((case.place)(start, end), mend))
}

/// The number that a text ends in.
fn trailing_number(text: &str) -> &str {
    let kept = text.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.');
    let number = text.get(kept.len()..).unwrap_or("");
    if kept.ends_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
        ""
    } else {
        number.trim_start_matches('.')
    }
}

/// A unit behind a name, an index or a window.
fn misplaced_unit(case: &Case) -> Option<Diagnostic> {
    let before = case.before();
    if UNITS.contains(&case.found) {
        if before.ends_with(']') {
            return Some(error::unit_after_bracket(case.span));
        }
        let name = last_word(before);
        let named = is_word(name) && !is_reserved(name);
        return named.then(|| error::unit_after_name(case.span, name, case.found));
    }
    // `always[0, 5] s p`: the unit was taken for a formula's name.
    let unit = last_word(before);
    let bracket = before.strip_suffix(unit).is_some_and(|rest| rest.trim_end().ends_with(']'));
    (UNITS.contains(&unit) && bracket && case.failure.expects(Rule::connective))
        .then(|| error::unit_after_bracket(case.place_of_last(unit.len())))
}

/// `m / s`
fn unit_with_blanks(case: &Case) -> Option<Diagnostic> {
    let unit = last_word(case.before());
    let next = token_at(case.after(), 0);
    let goes_on = match case.found {
        "/" | "*" => UNITS.contains(&next),
        "^" => next == "-" || next.starts_with(|c: char| c.is_ascii_digit()),
        _ => false,
    };
    (goes_on && UNITS.contains(&unit)).then(|| error::unit_with_blanks(case.span, unit, case.found, next))
}

/// `[0 1]`, `(4 7)`, `polygon (0, 0) (1, 0)`
fn missing_comma(case: &Case) -> Option<Diagnostic> {
    let value = case.found == "("
        || (case.found.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '_')
            && !is_reserved(case.found));
    if !value || !case.failure.expects(Rule::comma) || case.failure.expects(Rule::colon) {
        return None;
    }
    let listed = match innermost_bracket(case.before()) {
        Some('(' | '[') => true,
        _ => case.found == "(",
    };
    listed.then(|| error::missing_comma(case.span))
}

/// `0 <= x <= 5`
fn chained_comparison(case: &Case) -> Option<Diagnostic> {
    let comparison = matches!(case.found, "<" | "<=" | ">" | ">=" | "=" | "!=");
    let fits = [Rule::comparator, Rule::equals, Rule::at_most].iter().any(|r| case.failure.expects(*r));
    if !comparison || fits {
        return None;
    }
    let before = case.before();
    let start = before.rfind(['{', ';', ':']).map_or(0, |i| i + 1);
    let clause = before.get(start..).unwrap_or("");
    let first =
        clause.rfind(['<', '>', '=']).filter(|i| !clause.get(i + 1..).unwrap_or("").trim().is_empty())?;
    let declared = clause.get(..first).unwrap_or("");
    // In `define p = a = b = c` the first sign is no comparison; `->` and `<->` aren't either.
    let arrow = declared.ends_with('-')
        || clause.get(first..first + 1) == Some("=") && DECLARATIONS.contains(&first_word(clause));
    let in_clause = case.failure.expects(Rule::arithmetic) || case.failure.expects(Rule::sum_operator);
    (!arrow && in_clause).then(|| error::chained_comparison(case.span))
}

/// `(n + 1) * count(…)`, `(R1 in A or p) = 1`
fn sum_bracket(case: &Case) -> Option<Diagnostic> {
    let operator = matches!(case.found, "+" | "-" | "*" | "<" | "<=" | ">" | ">=" | "=" | "!=");
    let behind = operator && case.failure.expects(Rule::connective) && case.before().ends_with(')');
    let inside = case.found == ")" && case.failure.expects(Rule::sum_operator);
    (behind || inside).then(|| error::sum_bracket(case.span))
}

fn first_word(text: &str) -> &str {
    token_at(text, 0)
}

/// The word or number that a text ends in.
fn last_word(text: &str) -> &str {
    let kept = text.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_');
    text.get(kept.len()..).unwrap_or("")
}

/// The innermost bracket that is open at the end of a text.
fn innermost_bracket(text: &str) -> Option<char> {
    let mut closed = 0usize;
    for character in text.chars().rev() {
        match character {
            ')' | ']' | '}' => closed += 1,
            '(' | '[' | '{' if closed == 0 => return Some(character),
            '(' | '[' | '{' => closed -= 1,
            _ => {}
        }
    }
    None
}

/// The word that begins declarations and is spelt nearly like this one.
pub(super) fn nearest_starter(word: &str) -> Option<&'static str> {
    nearest(word, DECLARATIONS.into_iter())
}

/// The candidate that is spelt nearly like a word.
fn nearest<'a>(word: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let limit = if word.len() <= 3 { 1 } else { 2 };
    let near = candidates.map(|candidate| (distance(word, candidate), candidate));
    near.filter(|(distance, _)| *distance <= limit).min().map(|(_, candidate)| candidate)
}

/// The number of letters to change, add, leave out or swap with their neighbour.
fn distance(a: &str, b: &str) -> usize {
    if a.len().abs_diff(b.len()) > 2 {
        return usize::MAX;
    }
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut rows: Vec<Vec<usize>> = vec![(0..=b.len()).collect()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let change = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = change.min(rows[i - 1][j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(rows[i - 2][j - 2] + 1);
            }
            row.push(best);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_count_changes() {
        assert_eq!(distance("regoin", "region"), 1);
        assert_eq!(distance("raduis", "radius"), 1);
        assert_eq!(distance("ca", "abc"), 3);
        assert_eq!(distance("jamer", "jammer"), 1);
        assert_eq!(distance("goal", "goal"), 0);
        assert_eq!(distance("", "ab"), 2);
        assert_eq!(distance("goals", "goal"), 1);
    }
}
