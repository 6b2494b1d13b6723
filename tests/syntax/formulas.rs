//! Operators of formulas: aliases, precedence, windows, quantifiers, sums.

use crate::trees;

/// Checks the tree of a formula.
#[track_caller]
fn check(formula: &str, tree: &str) {
    assert_eq!(trees(&format!("goal g: {formula}")), format!("goal g {tree}"), "{formula}");
}

/// The infix operators, all spellings of each, from loosest to tightest: name, level, right-associative.
const INFIX: [(&str, &[&str], u8, bool); 8] = [
    ("<->", &["<->"], 1, false),
    ("->", &["->"], 2, true),
    ("or", &["or", "||"], 3, false),
    ("and", &["and", "&&"], 4, false),
    ("until", &["until", "U"], 5, true),
    ("release", &["release", "R"], 5, true),
    ("weak-until", &["weak until", "W"], 5, true),
    ("strong-release", &["strong release", "M"], 5, true),
];

const PREFIX: [(&str, &[&str]); 4] = [
    ("not", &["not", "!"]),
    ("next", &["next", "X"]),
    ("always", &["always", "G", "[]"]),
    ("eventually", &["eventually", "F", "<>"]),
];

#[test]
fn words_and_symbols_are_the_same_operator() {
    for (name, spellings, _, _) in INFIX {
        for spelling in spellings {
            check(&format!("a {spelling} b"), &format!("({name} a b)"));
        }
    }
    for (name, spellings) in PREFIX {
        for spelling in spellings {
            check(&format!("{spelling} a"), &format!("({name} a)"));
            check(&format!("{spelling}(a)"), &format!("({name} (group a))"));
        }
    }
    check("!a&&!b||c->d<->e", "(<-> (-> (or (and (not a) (not b)) c) d) e)");
    check("[]<>a", "(always (eventually a))");
    check("G F a", "(always (eventually a))");
    check("[] [] a", "(always (always a))");
}

#[test]
fn each_pair_of_infix_operators() {
    for (first, first_spellings, first_level, right) in INFIX {
        for (second, second_spellings, second_level, _) in INFIX {
            let to_the_left = first_level > second_level || (first_level == second_level && !right);
            let tree = if to_the_left {
                format!("({second} ({first} a b) c)")
            } else {
                format!("({first} a ({second} b c))")
            };
            for x in first_spellings {
                for y in second_spellings {
                    check(&format!("a {x} b {y} c"), &tree);
                }
            }
        }
    }
}

#[test]
fn prefixes_are_the_tightest() {
    for (name, spellings) in PREFIX {
        for (infix, infix_spellings, _, _) in INFIX {
            for p in spellings {
                for i in infix_spellings {
                    check(&format!("{p} a {i} b"), &format!("({infix} ({name} a) b)"));
                    check(&format!("a {i} {p} b"), &format!("({infix} a ({name} b))"));
                }
            }
        }
    }
    check("not always a until not b until c", "(until (not (always a)) (until (not b) c))");
}

#[test]
fn quantifiers_reach_as_far_right_as_possible() {
    check("forall r in all: a and b -> c", "(forall r {all} (-> (and a b) c))");
    check("a and exists r in R1, T: b or c", "(and a (exists r {R1 T} (or b c)))");
    check("a <-> forall r in all: b <-> c", "(<-> a (forall r {all} (<-> b c)))");
    check("not forall i in 1..n: a until b", "(not (forall [i 1 n] (until a b)))");
    check("(forall r in all: a) and b", "(and (group (forall r {all} a)) b)");
    check("forall i in 1..3: exists j in i..2*i: a", "(forall [i 1 3] (exists [j i (* 2 i)] a))");
    check("exists r in fleet[1], J[2, i]: r in A", "(exists r {fleet[1] J[2, i]} (in r A))");
}

#[test]
fn windows() {
    check("always[5, 9] a", "(always[5, 9] a)");
    check("[][5, 9] a", "(always[5, 9] a)");
    check("G [0, n + 1] a", "(always[0, (+ n 1)] a)");
    check("<>[0 s, 10 s] a", "(eventually[(unit 0 s), (unit 10 s)] a)");
    check("F[0, 2] a", "(eventually[0, 2] a)");
    for (name, spellings, level, _) in INFIX {
        for spelling in spellings.iter().filter(|_| level == 5) {
            check(&format!("a {spelling}[1, 2] b"), &format!("({name}[1, 2] a b)"));
            check(&format!("a {spelling} [] b"), &format!("({name} a (always b))"));
        }
    }
}

#[test]
fn atoms() {
    check("true", "true");
    check("false", "false");
    check("R1 in A", "(in R1 A)");
    check("fleet[i] in J[1, i + 1]", "(in fleet[i] J[1, (+ i 1)])");
    check("truest", "truest");
    check("(R1 in A)", "(group (in R1 A))");
    check("((a))", "(group (group a))");
    check("not R1 in A and R2 in B", "(and (not (in R1 A)) (in R2 B))");
}

#[test]
fn comparisons_of_sums() {
    for sign in ["=", "!=", "<", "<=", ">", ">="] {
        check(&format!("(R1 in A) {sign} 1"), &format!("({sign} (sum +(in R1 A)) (sum +1))"));
        check(&format!("n{sign}m"), &format!("({sign} (sum +n) (sum +m))"));
    }
    check("count(r in all: r in A) = 1", "(= (sum +(count r {all} r A)) (sum +1))");
    check("2 * count(r in R1, T: r in A) <= n", "(<= (sum +2*(count r {R1 T} r A)) (sum +n))");
    check("-3*(R1 in A) - n + 2*k > -1", "(> (sum -3*(in R1 A) -n +(* 2 k)) (sum -1))");
    check("1 - -2*(R1 in A) = 0", "(= (sum +1 +2*(in R1 A)) (sum +0))");
    check("not (R1 in A) + (R2 in A) = 1", "(not (= (sum +(in R1 A) +(in R2 A)) (sum +1)))");
    check("(R1 in A) and n = 1", "(and (group (in R1 A)) (= (sum +n) (sum +1)))");
    check("(n = 1) -> a", "(-> (group (= (sum +n) (sum +1))) a)");
    check("n <-> m", "(<-> n m)");
    check("n -> m", "(-> n m)");
    check("n<-m", "(< (sum +n) (sum -m))");
    check("w[1] = 2", "(= (sum +w[1]) (sum +2))");
    check(
        "a until count(r in all: r in A) >= 2 and b",
        "(and (until a (>= (sum +(count r {all} r A)) (sum +2))) b)",
    );
}
