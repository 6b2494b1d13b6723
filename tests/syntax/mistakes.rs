//! What common mistakes are answered with: the code, the place, and a word of the message or help.

use dosmc::source::SourceFile;

use crate::parse;

/// Checks the only error of some declarations: its code, the text of its place, words of message and help.
#[track_caller]
fn check(declarations: &str, code: &str, place: &str, words: &str) {
    let text = format!("dosm 1\n{declarations}");
    let (_, diagnostics) = parse(&text);
    let [diagnostic] = diagnostics.as_slice() else {
        panic!("{declarations}\n{diagnostics:#?}");
    };
    let said = format!("{}; {}", diagnostic.message, diagnostic.help.as_deref().unwrap_or(""));
    let found = SourceFile::new("", text).slice(diagnostic.labels[0].span).to_owned();
    assert_eq!(
        (diagnostic.code, found.as_str()),
        (format!("dosm::syntax::{code}").as_str(), place),
        "{said}"
    );
    assert!(said.contains(words), "{said}");
}

#[test]
fn what_was_expected_is_said_in_peoples_words() {
    check("goal g always a", "expected", "always", "expected `:`, found the word `always`");
    check("region a = box (0, 0) (1, 1)", "expected", "(", "expected a unit or `..`, found `(`");
    check("region a = bal (0, 0) radius 1", "expected", "bal", "did you mean `ball`?");
    check("region a = ball (0, 0) raduis 1", "expected", "raduis", "did you mean `radius`?");
    check("robot R1 at (0, 0)", "expected", "at", "`:`");
    check("robot R1: Rover (0, 0)", "expected", "(", "expected `at`");
    check("horizon 40", "expected", "", "`..`, found the end of the text");
    check("goal g: a and", "expected", "", "expected a formula");
    check("goal g: a adn b", "expected", "adn", "did you mean `and`?");
    check("goal g: always (a", "unclosed_bracket", "(", "never closed");
    check("goal g: a)", "unopened_bracket", ")", "closes nothing");
    check("dynamics D { stat a: m }", "expected", "stat", "did you mean `state`?");
    check("dynamics D { state a }", "expected", "}", "expected `:`");
    check("dynamics D { state a: furlong }", "expected", "furlong", "expected a unit");
    check("connectivity { hops 3 }", "expected", "3", "expected `<=`");
    check("connectivity { hop <= 3 }", "expected", "hop", "did you mean `hops`?");
    check("regoin a = hull (1, 1)", "expected", "regoin", "did you mean `region`?");
    check("horizon = 1..2", "expected", "=", "leave the `=` out");
    check("mission a;", "expected", ";", "not followed by `;`");
    check("goal g: a & b", "expected", "&", "`&&`");
    check("goal g: a | b", "expected", "|", "`||`");
    check("goal g: a => b", "expected", "=>", "`->`");
    check("goal g: ~a", "expected", "~", "`not`");
    check("let x = 2**3", "expected", "*", "`^`");
    check("let x := 2", "expected", ":=", "`=`");
    check("mission \"a\"", "expected", "\"", "quotation");
    check("# note\nmission a", "expected", "#", "`//`");
    check("let x = until", "expected", "until", "can't be a name");
}

#[test]
fn what_is_usual_elsewhere_is_answered_with_what_is_usual_here() {
    check("jammer a = ball (0, 0) radius 5 feet", "expected", "feet", "the units are m, cm,");
    check("jammer a = ball (0, 0) radius 5 ft", "expected", "ft", "the units are m, cm,");
    check("jammer a = ball (0, 0) radius 5 nrom 2", "expected", "nrom", "did you mean `norm`?");
    check("horizon 1..5\nregoin a = hull (1, 1)", "expected", "regoin", "did you mean `region`?");
    check("region a = circle (0, 0) radius 1", "expected", "circle", "the shapes are `box`");
    check("jammer a = ball (0, 0), radius 5", "expected", ",", "no comma stands before `radius`");
    check("goal g: R1 not in a", "expected", "not", "`not R1 in A`");
    check("goal g: R1 in a = 1", "expected", "=", "`(R1 in A) = 1`");
}

#[test]
fn reserved_words_are_no_names() {
    check("region base = hull (1, 1)", "reserved_word", "base", "`base`");
    check("robot R: Rover at (1, 1)", "reserved_word", "R", "operator");
    check("region in = hull (1, 1)", "reserved_word", "in", "`in_1`");
    check("dynamics D { state goal: m }", "reserved_word", "goal", "`goal_1`");
    check("goal g: forall X in all: a", "reserved_word", "X", "operator `next`");
    check("goal g: always R in a", "expected", "R", "`R` stands for `release` and can't be a name");
    check("dynamics D { position a, region }", "reserved_word", "region", "`region`");
}

#[test]
fn commas() {
    check("let A = [0 1]", "missing_comma", "1", "`[0, 1; 1, 0]`");
    check("let A = [1, 0\n 0, 1]", "missing_comma", "0", "rows by `;`");
    check("let A = [[1, 0], [0, 1]]", "expected", "[", "rows are separated by `;`");
    check("let A = [0, 1; 2 3]", "missing_comma", "3", "commas");
    check("let A = [1 -1]", "missing_comma", "-", "commas");
    check("let A = [a -b, c]", "missing_comma", "-", "`a - b`");
    check("base B at (1 2)", "missing_comma", "2", "comma");
    check("let a = max(1 2)", "missing_comma", "2", "comma");
    check("region a = hull (1, 1) (2, 2)", "missing_comma", "(", "comma");
    check("dynamics D { bound a in [0 1] }", "missing_comma", "1", "comma");
    check("goal g: always[1 2] a", "missing_comma", "2", "comma");
}

#[test]
fn units() {
    check("let a = 10^3 m", "unit_in_exponent", "3 m", "`(10^3) m`");
    check("let a = 2 * b[1]^-2 m/s", "unit_in_exponent", "2 m/s", "`(b[1]^-2) m/s`");
    check("let a = b m", "misplaced_unit", "m", "`(b) m`");
    check("let a = P[1, 2] m", "misplaced_unit", "m", "`(P[1, 2]) m`");
    check("goal g: always[0, 5] s a", "misplaced_unit", "s", "`[0 s, 5 s]`");
    check("dynamics D { state a: m / s }", "unit_with_blanks", "/", "`m/s`");
    check("dynamics D { state a: m ^2 }", "unit_with_blanks", "^", "`m^2`");
    check("dynamics D { bound a in [0, 1] m / s }", "unit_with_blanks", "/", "`m/s`");
    check("base B at (1 m, 2) m", "unit_twice", "m", "has a unit already");
    check("let a = (1 m) cm", "unit_twice", "cm", "has a unit already");
    check("let a = sqrt(4 m^2) m", "unit_twice", "m", "keep one");
    check("dynamics D { bound a in [0 m, 1 m] m }", "unit_twice", "m", "keep one");
    check("let a = [1 m, 2] m", "unit_twice", "m", "keep one");
    check("let a = 1 m^0", "unit_exponent", "m^0", "exponent");
    check("let a = 1 m^99999999999999999999", "unit_exponent", "m^99999999999999999999", "exponent");
}

#[test]
fn numbers() {
    check("let a = .5", "number_form", ".5", "`0.5`");
    check("let a = 1.", "number_form", "1.", "`1`");
    check("let a = 1.2.3", "number_form", "1.2.3", "numbers look like");
    check("let a = 12abc", "number_form", "12abc", "numbers look like");
    check("let a = 1_000", "number_form", "1_000", "separators");
    check("let a = 0x10", "number_form", "0x10", "numbers look like");
    check("let a = 1e", "number_form", "1e", "numbers look like");
    check("let a = 1e301", "number_range", "1e301", "1e300");
    check("let a = 1.01e300", "number_range", "1.01e300", "1e300");
    check("let a = 9e-301", "number_range", "9e-301", "1e-300");
    check("let a = 1e-99999999999999999999999", "number_range", "1e-99999999999999999999999", "");
    check("let a = 1e999999999", "number_range", "1e999999999", "");
}

#[test]
fn comparisons() {
    check("goal g: count(r in all: r in a) == 1", "double_equals", "==", "`=`");
    check("mission a let b == 2", "double_equals", "==", "`=`");
    check("region a = where { 0 <= x <= 5 }", "chained_comparison", "<=", "two");
    check("goal g: 1 < n < 3", "chained_comparison", "<", "two");
    check("goal g: a = b = c", "chained_comparison", "=", "two");
    check("goal g: (n + 1) * count(r in all: r in a) = 1", "sum_bracket", ")", "`let`");
    check("goal g: (a or b) = 1", "sum_bracket", "=", "no brackets");
    check("goal g: next[1, 2] a", "window_on_next", "[1, 2]", "`always[n, n]`");
}

#[test]
fn odd_characters() {
    check("let a = 2\u{a0}m", "hidden_character", "\u{a0}", "U+00A0");
    check("let a\u{200b} = 2", "hidden_character", "\u{200b}", "without width");
    check("let a = 2 \u{1b}", "hidden_character", "\u{1b}", "escape");
    check("let a = 2 // \u{202e}", "hidden_character", "\u{202e}", "direction");
    check("let a = 2 /* \u{7} */", "hidden_character", "\u{7}", "control");
    check("let a = 2 – 1", "lookalike", "–", "`-`");
    check("let a = 2 m/s²", "lookalike", "²", "`^2`");
    check("goal g: ∀r in all: a", "lookalike", "∀", "`forall`");
    check("let a = ２", "lookalike", "２", "`2`");
    check("goal g: （a and b)", "lookalike", "（", "`(`");
    check("mission “a", "lookalike", "“", "quotation");
    check("mission größe", "foreign_letter", "größe", "a to z");
    check("let β = 1", "foreign_letter", "β", "a to z");
    check("mission a ☃", "unknown_character", "☃", "U+2603");
    check(&format!("mission {}", "a".repeat(65)), "long_name", &"a".repeat(65), "64");
    assert!(parse(&format!("dosm 1 mission {}", "a".repeat(64))).1.is_empty());
    assert!(parse("dosm 1 // größe, ²\u{a0}\u{200b} \u{feff}\r\n\tmission a").1.is_empty());
}

#[test]
fn messages_hold_no_raw_control_or_bidi_characters() {
    for odd in ["\u{1b}[31m", "\u{202e}", "\u{7f}", "\0", "\u{2066}", "\u{200b}", "\u{85}"] {
        for text in [
            format!("dosm 1 mission a{odd}b"),
            odd.to_owned(),
            format!("let {odd} = {odd}"),
            format!("dosm {odd}1"),
        ] {
            for diagnostic in parse(&text).1 {
                let mut said = diagnostic.message + diagnostic.help.as_deref().unwrap_or("");
                said.extend(diagnostic.labels.into_iter().map(|label| label.text));
                assert!(!said.contains(odd.chars().next().unwrap()), "{said:?}");
            }
        }
    }
}
