//! What stands between two tokens of a line: one blank or none.

use crate::syntax::token::{Kind, Token};
use crate::syntax::words::PREDECLARED;

/// The tokens of a line, joined as the style has it.
pub(super) fn join(tokens: &[Token<'_>]) -> String {
    let mut text = String::new();
    for (at, token) in tokens.iter().enumerate() {
        if at > 0 && is_spaced(tokens, at) {
            text.push(' ');
        }
        text.push_str(token.text);
    }
    text
}

/// Whether a blank stands before a token that is not the first.
pub(super) fn is_spaced(tokens: &[Token<'_>], at: usize) -> bool {
    let (before, token) = (&tokens[at - 1], &tokens[at]);
    if before.is_comment() || token.is_comment() {
        return true;
    }
    if token.kind == Kind::Unit {
        return true;
    }
    let sign =
        |token: &Token<'_>| if token.kind == Kind::Sign { token.text.to_owned() } else { String::new() };
    match (sign(before).as_str(), sign(token).as_str()) {
        ("(" | "[", _) | (_, ")" | "]" | "," | ";" | ":") => false,
        ("{", "}") => false,
        ("^", _) | (_, "^") => false,
        ("!", _) => false,
        ("..", _) => is_between_points(tokens, at - 1),
        (_, "..") => is_between_points(tokens, at),
        ("-", _) => !is_unary(tokens, at - 1),
        // A window or an index; an interval has a blank before it.
        (_, "[") if before.kind == Kind::Word => before.text == "in",
        ("[]" | "<>", "[") => false,
        (_, "(") if before.kind == Kind::Word => !is_called(before.text),
        _ => true,
    }
}

/// Whether an opening `(` follows a word at once: functions, and `count`.
fn is_called(word: &str) -> bool {
    PREDECLARED.contains(&word) || word == "count"
}

/// Whether the dots stand between two points, as in a box, and not between two numbers.
fn is_between_points(tokens: &[Token<'_>], dots: usize) -> bool {
    let behind = tokens.get(dots + 1).is_some_and(|t| t.is("("));
    let mut before = tokens[..dots].iter().rev().skip_while(|t| t.kind == Kind::Unit);
    let depth: i32 = tokens[..dots]
        .iter()
        .map(|t| match t.text {
            "(" | "[" | "{" if t.kind == Kind::Sign => 1,
            ")" | "]" | "}" if t.kind == Kind::Sign => -1,
            _ => 0,
        })
        .sum();
    behind && depth == 0 && before.next().is_some_and(|t| t.is(")"))
}

/// Whether a minus is a sign of what follows. Behind a word, which may be a keyword or a name, it is what
/// the author's blanks say.
fn is_unary(tokens: &[Token<'_>], minus: usize) -> bool {
    let Some(before) = minus.checked_sub(1).map(|i| &tokens[i]) else { return true };
    match before.kind {
        Kind::Number | Kind::Unit => false,
        Kind::Word => {
            let blank_behind = tokens.get(minus + 1).is_some_and(|t| t.blank_before);
            matches!(before.text, "in" | "at" | "and" | "or" | "not")
                || tokens[minus].blank_before && !blank_behind
        }
        _ => !matches!(before.text, ")" | "]" | "}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::token::tokens;

    #[test]
    fn blanks_stand_where_they_help() {
        for (text, expected) in [
            ("region a=box(0,0)..( 12 , 8 )m", "region a = box (0, 0) .. (12, 8) m"),
            ("robot f[i in 1 .. n] :Rover at(P[i,1],-2)", "robot f[i in 1..n]: Rover at (P[i, 1], -2)"),
            ("horizon 1 .. 40", "horizon 1..40"),
            ("let a=-b*(c-d)/2^-3", "let a = -b * (c - d) / 2^-3"),
            ("let a=b - 1", "let a = b - 1"),
            ("bound x,y in[-4,4]m/s", "bound x, y in [-4, 4] m/s"),
            ("goal g:always(a->eventually [0 s,6s]!b)", "goal g: always (a -> eventually[0 s, 6 s] !b)"),
            ("goal g:[]<>a&&count(r in all:r in A)>=2", "goal g: [] <> a && count(r in all: r in A) >= 2"),
            ("jammer j=disc(6+/-0.5,3±1)radius 1.2", "jammer j = disc (6 +/- 0.5, 3 ± 1) radius 1.2"),
            ("a where{x+y<=2;x>=sqrt (2)}", "a where { x + y <= 2; x >= sqrt(2) }"),
            ("state px:m,vx:m/s", "state px: m, vx: m/s"),
            ("a at{px=1 m,py=-2 m}", "a at { px = 1 m, py = -2 m }"),
        ] {
            assert_eq!(join(&tokens(text)), expected);
            assert_eq!(join(&tokens(expected)), expected, "it is not stable");
        }
    }
}
