//! The tokens of a text, comments included: what a formatter lays out again and an editor colours.

use crate::syntax::words::{LONG_SIGNS, UNITS};

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A name or a keyword.
    Word,
    /// A number, without sign.
    Number,
    /// A unit, which has no blanks inside.
    Unit,
    /// Brackets, operators, separators.
    Sign,
    /// `// …`
    LineComment,
    /// `/// …` and `//! …`
    Doc,
    /// `/* … */`
    BlockComment,
}

/// A token and what stood before it.
#[derive(Clone, Copy, Debug)]
pub struct Token<'s> {
    /// What it is.
    pub kind: Kind,
    /// As written; comments without blanks at their end.
    pub text: &'s str,
    /// Where it begins.
    pub start: usize,
    /// One past its last byte.
    pub end: usize,
    /// How many line ends stand between it and the token before.
    pub lines_before: usize,
    /// Whether blanks or line ends stand between them.
    pub blank_before: bool,
}

impl Token<'_> {
    /// Whether it is this sign or word.
    pub fn is(&self, text: &str) -> bool {
        matches!(self.kind, Kind::Sign | Kind::Word) && self.text == text
    }

    /// Whether it is a comment of any kind.
    pub fn is_comment(&self) -> bool {
        matches!(self.kind, Kind::LineComment | Kind::Doc | Kind::BlockComment)
    }
}

/// All tokens of a text. Whatever a mission can't hold comes as a sign of one character.
pub fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut tokens: Vec<Token<'_>> = Vec::new();
    let mut position = 0;
    while let Some(begin) = text[position..].find(|c: char| !c.is_whitespace()).map(|at| position + at) {
        let unit = tokens.last().filter(|last| takes_unit(last)).and_then(|_| unit(&text[begin..]));
        let (kind, length) = unit.map_or_else(|| token(&text[begin..]), |length| (Kind::Unit, length));
        let end = begin + length;
        let written = &text[begin..end];
        tokens.push(Token {
            kind,
            text: written.trim_end(),
            start: begin,
            end,
            lines_before: text[position..begin].matches('\n').count(),
            blank_before: position < begin,
        });
        position = end;
    }
    tokens
}

/// Whether a unit may follow.
fn takes_unit(token: &Token<'_>) -> bool {
    token.kind == Kind::Number || matches!(token.text, ")" | "]" | ":")
}

/// The kind and the length of the token at the beginning of a text that begins with no blank.
fn token(text: &str) -> (Kind, usize) {
    if text.starts_with("//") {
        let length = text.find('\n').unwrap_or(text.len());
        let plain = text.starts_with("////") || !(text.starts_with("///") || text.starts_with("//!"));
        return (if plain { Kind::LineComment } else { Kind::Doc }, length);
    }
    if text.starts_with("/*") {
        return (Kind::BlockComment, block_comment(text));
    }
    let first = text.chars().next().unwrap_or(' ');
    if first.is_ascii_digit() {
        return (Kind::Number, number(text));
    }
    let word = text.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(text.len());
    if word > 0 {
        return (Kind::Word, word);
    }
    let sign = LONG_SIGNS.iter().find(|sign| text.starts_with(**sign));
    (Kind::Sign, sign.map_or(first.len_utf8(), |sign| sign.len()))
}

/// The length of a comment that nests; one that never ends takes all.
fn block_comment(text: &str) -> usize {
    let (mut depth, mut position) = (0usize, 0);
    while position < text.len() {
        let rest = &text[position..];
        if rest.starts_with("/*") {
            depth += 1;
            position += 2;
        } else if rest.starts_with("*/") {
            depth = depth.saturating_sub(1);
            position += 2;
            if depth == 0 {
                return position;
            }
        } else {
            position += rest.chars().next().map_or(1, char::len_utf8);
        }
    }
    text.len()
}

/// The length of `12`, `0.5`, `1e-3`; the dots of `1..3` are none of its.
fn number(text: &str) -> usize {
    let digits = |text: &str| text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    let mut length = digits(text);
    if let Some(fraction) = text[length..].strip_prefix('.') {
        let more = digits(fraction);
        length += if more > 0 { 1 + more } else { 0 };
    }
    if let Some(exponent) = text[length..].strip_prefix(['e', 'E']) {
        let signed = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
        let more = digits(signed);
        if more > 0 {
            length += 1 + (exponent.len() - signed.len()) + more;
        }
    }
    length
}

/// The length of the unit at the beginning of a text.
fn unit(text: &str) -> Option<usize> {
    let mut length = match text.strip_prefix('1') {
        Some(rest) if rest.starts_with('/') && symbol(&rest[1..]).is_some() => 1,
        _ => factor(text)?,
    };
    while let Some(rest) = text[length..].strip_prefix(['*', '/']) {
        let Some(more) = factor(rest) else { break };
        length += 1 + more;
    }
    Some(length)
}

/// The length of `m` or `s^-2`.
fn factor(text: &str) -> Option<usize> {
    let length = symbol(text)?;
    let Some(power) = text[length..].strip_prefix('^') else { return Some(length) };
    let unsigned = power.strip_prefix('-').unwrap_or(power);
    let digits = unsigned.find(|c: char| !c.is_ascii_digit()).unwrap_or(unsigned.len());
    Some(if digits > 0 { length + 1 + (power.len() - unsigned.len()) + digits } else { length })
}

/// The length of a unit's symbol; `min(` is the function.
fn symbol(text: &str) -> Option<usize> {
    let word = text.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(text.len());
    let symbol = UNITS.iter().find(|unit| **unit == &text[..word])?;
    let function = *symbol == "min" && text[word..].trim_start().starts_with('(');
    (!function).then_some(word)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str) -> String {
        tokens(text).iter().map(|t| t.text).collect::<Vec<_>>().join("|")
    }

    #[test]
    fn tokens_are_what_the_grammar_has() {
        for (text, expected) in [
            ("1..3", "1|..|3"),
            ("1.5e-3m/s^2", "1.5e-3|m/s^2"),
            ("2 m / s", "2|m|/|s"),
            ("(1, 2)m..", "(|1|,|2|)|m|.."),
            ("4 +/- 0.3±1", "4|+/-|0.3|±|1"),
            ("a<->b->!c", "a|<->|b|->|!|c"),
            ("[]<>x", "[]|<>|x"),
            ("x: 1/s", "x|:|1/s"),
            ("2 min(1)", "2|min|(|1|)"),
            ("a // b \nc", "a|// b|c"),
            ("/* a /* b */ c */ d", "/* a /* b */ c */|d"),
            ("1e", "1|e"),
            ("è∧", "è|∧"),
        ] {
            assert_eq!(shown(text), expected);
        }
    }
}
