//! Numbers, units, operators, references.

use crate::trees;

/// Checks the tree of an expression.
#[track_caller]
fn check(expression: &str, tree: &str) {
    assert_eq!(trees(&format!("let x = {expression}")), format!("let x {tree}"), "{expression}");
}

#[test]
fn numbers_are_exact() {
    check("12", "12");
    check("007", "7");
    check("0.5", "0.5");
    check("1e-3", "0.001");
    check("2.50E+1", "25");
    check("0.1", "0.1");
    check("0e99999999999999999999", "0");
    check("1e300", &format!("1{}", "0".repeat(300)));
    check("1000e297", &format!("1{}", "0".repeat(300)));
}

#[test]
fn operators_bind_as_the_reference_says() {
    check("1 + 2 * 3", "(+ 1 (* 2 3))");
    check("1 * 2 + 3", "(+ (* 1 2) 3)");
    check("1 - 2 - 3", "(- (- 1 2) 3)");
    check("1 - 2 + 3", "(+ (- 1 2) 3)");
    check("8 / 4 / 2", "(/ (/ 8 4) 2)");
    check("8 / 4 * 2", "(* (/ 8 4) 2)");
    check("2 ^ 3 ^ 2", "(^ 2 (^ 3 2))");
    check("2 * 3 ^ 2", "(* 2 (^ 3 2))");
    check("2 ^ 3 * 2", "(* (^ 2 3) 2)");
    check("-2 ^ 2", "(neg (^ 2 2))");
    check("-2 * 3", "(* (neg 2) 3)");
    check("-2 + 3", "(+ (neg 2) 3)");
    check("2 - -3", "(- 2 (neg 3))");
    check("2--3", "(- 2 (neg 3))");
    check("2 ^ -3 ^ 2", "(^ 2 (neg (^ 3 2)))");
    check("2 ^ -3 * 2", "(* (^ 2 (neg 3)) 2)");
    check("--2", "(neg (neg 2))");
    check("(1 + 2) * 3", "(* (group (+ 1 2)) 3)");
}

#[test]
fn units_bind_tighter_than_operators() {
    check("0.5 s", "(unit 0.5 s)");
    check("1cm", "(unit 1 cm)");
    check("2 m/s^2", "(unit 2 m*s^-2)");
    check("2 m*s^-2", "(unit 2 m*s^-2)");
    check("3 kg*m/s^2", "(unit 3 kg*m*s^-2)");
    check("5 1/s", "(unit 5 1*s^-1)");
    check("2 * 3 m", "(* 2 (unit 3 m))");
    check("-3 m", "(neg (unit 3 m))");
    check("1 / 2 m", "(/ 1 (unit 2 m))");
    check("(10^3) m", "(unit (group (^ 10 3)) m)");
    check("(2 m)^2", "(^ (group (unit 2 m)) 2)");
    check("sqrt(2) m", "(unit (sqrt 2) m)");
    check("[1, 2] m", "(unit (table (row 1 2)) m)");
    for unit in ["m", "cm", "mm", "km", "s", "ms", "min", "rad", "deg", "kg", "g", "N"] {
        check(&format!("4 {unit}"), &format!("(unit 4 {unit})"));
    }
}

#[test]
fn what_only_begins_like_a_unit_is_none() {
    check("2 m/n", "(/ (unit 2 m) n)");
    check("2 m * s", "(* (unit 2 m) s)");
    check("2 m*x", "(* (unit 2 m) x)");
    check("2 m/s2", "(/ (unit 2 m) s2)");
    check("2 m*min(3, 4)", "(* (unit 2 m) (min 3 4))");
    check("2 s*3", "(* (unit 2 s) 3)");
    check("m", "m");
    check("2 * m", "(* 2 m)");
    check("min(1, 2)", "(min 1 2)");
    check("2 min", "(unit 2 min)");
}

#[test]
fn names_tables_and_calls() {
    check("radius", "radius");
    check("P[1]", "P[1]");
    check("P[i, 2 * j]", "P[i, (* 2 j)]");
    check("P[P[1]]", "P[P[1]]");
    check("mod(7, 4)", "(mod 7 4)");
    check("[1, 2; 3, -4]", "(table (row 1 2) (row 3 (neg 4)))");
    check("[a - b, a-b, (1 -2)]", "(table (row (- a b) (- a b) (group (- 1 2))))");
    check("[1 /* one */, // two\n 2]", "(table (row 1 2))");
}

#[test]
fn words_that_are_words_only_in_their_place_are_names() {
    for word in
        ["step", "state", "box", "where", "x", "norm", "radius", "every", "none", "hull", "A", "length", "m"]
    {
        check(word, word);
    }
    for word in ["X1", "inside", "at_", "Rover", "goals", "_all", "allowed", "notes", "G_"] {
        check(word, word);
    }
}

#[test]
fn an_expression_by_itself() {
    use dosmc::syntax::parse_expression;
    assert_eq!(parse_expression(" 1.5 m ").unwrap().span, dosmc::source::Span::new(1, 6));
    assert!(parse_expression("(a + 2) * 3").is_ok());
    for (text, code) in [
        ("", "expected"),
        ("1 +", "expected"),
        ("1 2", "expected"),
        ("(1", "unclosed_bracket"),
        ("1e999", "number_range"),
        ("1 ≤ 2", "lookalike"),
        ("goal", "expected"),
        ("10^3 m", "unit_in_exponent"),
    ] {
        assert_eq!(parse_expression(text).unwrap_err().code, format!("dosm::syntax::{code}"), "{text}");
    }
}
