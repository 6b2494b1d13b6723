//! Declarations, shapes, motion models, documentation comments, recovery.

use crate::{parse, trees};

/// Checks the tree of a declaration.
#[track_caller]
fn check(declaration: &str, tree: &str) {
    assert_eq!(trees(declaration), tree, "{declaration}");
}

#[test]
fn simple_declarations() {
    check("mission relay", "mission relay");
    check("param n = 3", "param n 3");
    check("let v = 2 m/s", "let v (unit 2 m*s^-1)");
    check("separation 0.1 m", "separation (unit 0.1 m)");
    check("horizon 1..40", "horizon 1 40");
    check("horizon n .. 2*n", "horizon n (* 2 n)");
    check("minimize effort", "minimize effort");
    check("minimize length", "minimize length");
    check("team T = R1, fleet[2], S", "team T {R1 fleet[2] S}");
    check("team T = all", "team T {all}");
    check("define d = a", "define d a");
    check("connectivity none", "connectivity none");
    check("connectivity { }", "connectivity");
    check(
        "connectivity{hops<=3 range 6 m norm 2;every 4}",
        "connectivity\n  hops 3\n  range (unit 6 m) norm 2\n  every 4",
    );
}

#[test]
fn shapes() {
    check("workspace box (0, 0) .. (12, 12)", "workspace (box (point 0 0) (point 12 12))");
    check("workspace box (0, 0, 0)..(1, 2, 3) m", "workspace (box (point 0 0 0) (point 1 2 3) m)");
    check("region a = ball (1, 2) radius 3", "region a (ball (point 1 2) 3)");
    check("region a = ball (1, 2) radius 3 norm 1", "region a (ball (point 1 2) 3 norm 1)");
    check("region a = disc (1, 2) cm radius r", "region a (disc (point 1 2) cm r)");
    check("region a = polygon (0,0), (1,0), (0,1)", "region a (polygon (point 0 0) (point 1 0) (point 0 1))");
    check("region a = hull (0,0), (1,0)", "region a (hull (point 0 0) (point 1 0))");
    check("region a = where { x + y <= 2; }", "region a (where {(<= (+ x y) 2)})");
    check(
        "region a = box (0,0)..(1,1) or ball (1,2) radius 3 or hull (1,1)",
        "region a (box (point 0 0) (point 1 1)) or (ball (point 1 2) 3) or (hull (point 1 1))",
    );
    check(
        "jammer J = ball (4 +/- 0.3, 7 ± 1) radius 1 +/- 2 cm norm 2",
        "jammer J (ball (point 4 +/- 0.3 7 +/- 1) 1 +/- (unit 2 cm) norm 2)",
    );
}

#[test]
fn placed_things_and_families() {
    check("obstacle a = hull (1, 1)", "obstacle a (hull (point 1 1))");
    check("opaque obstacle a = hull (1, 1)", "opaque obstacle a (hull (point 1 1))");
    check("opaque /* so */ obstacle a = hull (1, 1)", "opaque obstacle a (hull (point 1 1))");
    check("base B at (1, 2) m", "base B (point 1 2) m");
    check("base B[k in 1..2] at (k, 0)", "base B [k 1 2] (point k 0)");
    check("robot R1: Rover at (1, 2)", "robot R1: Rover (point 1 2)");
    check(
        "robot R1: Rover at {px = 1, vx = -2 m/s,}",
        "robot R1: Rover { px = 1, vx = (neg (unit 2 m*s^-1)) }",
    );
    check(
        "robot f[i in 1..n, j in i..2]: Rover at (P[i, 1], j)",
        "robot f [i 1 n] [j i 2]: Rover (point P[i, 1] j)",
    );
}

#[test]
fn motion_models() {
    check("dynamics D { }", "dynamics D");
    check(
        "dynamics D { step 1 min; continuous; integrator 2 }",
        "dynamics D\n  step (unit 1 min)\n  continuous\n  integrator 2",
    );
    check("dynamics D { state a: 1, b: 1/s, c: m^2 }", "dynamics D\n  state a:1 b:1*s^-1 c:m^2");
    check(
        "dynamics D { A = M1 c = [0; 1] B = [1] m }",
        "dynamics D\n  A M1\n  c (table (row 0) (row 1))\n  B (unit (table (row 1)) m)",
    );
    check("dynamics D { bound a, b in [-1, 1] 1/s }", "dynamics D\n  bound a b (interval (neg 1) 1) 1*s^-1");
    check("dynamics D { bound where { a <= 1 } }", "dynamics D\n  bound {(<= a 1)}");
    check("dynamics D { bound where in [0, 1] }", "dynamics D\n  bound where (interval 0 1)");
    check(
        "dynamics D { disturbance a in [-1, 1] rejection 0.5 }",
        "dynamics D\n  disturbance a (interval (neg 1) 1)\n  rejection 0.5",
    );
    check(
        "dynamics D { mode wet when { x >= 5 } { A = [1]; c = [2] } }",
        "dynamics D\n  mode wet {(>= x 5)}\n    A (table (row 1))\n    c (table (row 2))",
    );
    check(
        "dynamics D { state step: m, mode: s position step, mode }",
        "dynamics D\n  state step:m mode:s\n  position step mode",
    );
}

#[test]
fn documentation_goes_to_what_stands_behind_it() {
    check(
        "/// One.\n///  Two.\n/// \nregion a = hull (1, 1)",
        "/// One.\n///  Two.\n/// \nregion a (hull (point 1 1))",
    );
    check("/// One.\n// between\n/// Two.\nmission a", "/// One.\n/// Two.\nmission a");
    check("//// no\nmission a", "mission a");
    check(
        "dynamics D {\n/// S.\nstate\n/// A.\na: m,\n/// B.\nb: m\n}",
        "dynamics D\n  /// S.\n  state a:m /*A.*/ b:m /*B.*/",
    );
    assert_eq!(parse("//! A\n//!  B\ndosm 1").0.unwrap().doc.unwrap().text, "A\n B");
}

#[test]
fn documentation_elsewhere_is_stray() {
    for (text, count) in [
        ("dosm 1\nregion a = /// inside\nhull (1, 1)", 1),
        ("dosm 1\nregion a = hull (1, 1) /// behind\nregion b = hull (1, 1)", 1),
        ("dosm 1\n/// at the end", 1),
        ("dosm 1\n//! not at the top", 1),
        ("dosm 1\nconnectivity {\n/// no item of a model\nhops <= 1 }", 1),
        ("/// The mission's edition.\ndosm 1", 0),
        ("dosm 1\n/// of a broken one\nregion a hull (1, 1)", 0),
    ] {
        assert_eq!(parse(text).0.unwrap().stray_docs.len(), count, "{text}");
    }
}

/// What is left of a text with errors: the tree's lines, and the number of errors.
fn recovered(text: &str) -> (String, usize) {
    let (file, diagnostics) = parse(&format!("dosm 1\n{text}"));
    let dump = dosmc::syntax::dump(&file.unwrap());
    (dump.trim_start_matches("edition 1\n").trim_end().to_owned(), diagnostics.len())
}

#[test]
fn each_broken_declaration_is_one_error_and_leaves_the_others_alone() {
    for (text, left, errors) in [
        ("region a hull (1, 1)\nmission b", "mission b\nbroken region a", 1),
        (
            "region a hull\nlet = 2\nmission b\nbase B (0)",
            "mission b\nbroken region a\nbroken let ?\nbroken base B",
            3,
        ),
        ("opaque obstacle a hull\nmission b", "mission b\nbroken obstacle a", 1),
        ("region goal = hull (1, 1)\nmission b", "mission b\nbroken region ?", 1),
        ("dynamics D { state base: m }\nmission b", "mission b\nbroken dynamics D", 1),
        ("dynamics D { state a: m\nmission b", "mission b\nbroken dynamics D", 1),
        ("region\nmission b", "mission b\nbroken region ?", 1),
        ("mission b\nregoin a = hull (1, 1)\nlet c = 1", "mission b\nlet c 1\nbroken region a", 1),
        ("define d = a b", "broken define d", 1),
        ("define d = a\nb", "define d a\nbroken b ?", 1),
        ("mission a; let b = 1;", "mission a\nlet b 1\nbroken ; ?\nbroken ; ?", 2),
        ("define d = a and (b c)", "broken define d", 1),
        ("let a = 1e999\nlet b = 1e-999 + 1e999", "broken let a\nbroken let b", 2),
        ("let a = 2 ≤ 3\nlet b = “1”", "broken let a\nbroken let b", 3),
        ("let a = 2 − 1", "let a (- 2 1)", 1),
        ("let a = /* 1", "broken let a", 1),
    ] {
        assert_eq!(recovered(text), (left.to_owned(), errors), "{text}");
    }
}

#[test]
fn a_text_must_begin_with_its_edition() {
    for (text, codes) in [
        ("dosm 1", &[] as &[&str]),
        ("\u{feff}// note\ndosm 1", &[]),
        ("mission a", &["missing_edition"]),
        ("mission a dosm 1", &["missing_edition"]),
        ("dosmc 1\nmission a", &["expected"]),
        ("dosm 2", &["unknown_edition"]),
        ("dosm", &["expected"]),
    ] {
        let found: Vec<&str> =
            parse(text).1.iter().map(|d| d.code.trim_start_matches("dosm::syntax::")).collect();
        assert_eq!(found, codes, "{text}");
    }
}
