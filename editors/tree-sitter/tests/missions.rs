//! The missions of the repository: what the compiler's parser takes is taken, what it refuses is refused.

mod common;

use common::{first_error, missions, parse};

/// What the compiler's parser refuses and this one takes, with the reason.
const TAKEN: [(&str, &str); 12] = [
    // An editor shows fragments and files that are being begun.
    ("syntax_empty", "a text without a declaration is a beginning"),
    ("syntax_missing_edition", "fragments have none"),
    ("syntax_unknown_edition", "what another edition looks like is not known"),
    // Limits: nothing here has to be protected by them, and the tree is more useful than an error.
    ("syntax_long_name", "a name of any length is read"),
    ("syntax_number_range", "the value of a number is not looked at"),
    ("syntax_number_too_long", "a number of any length is read"),
    ("syntax_too_deep", "formulas of any depth are read"),
    ("syntax_too_nested", "brackets of any depth are read"),
    // Where a unit may stand depends on what is inside brackets and before operators, not on the next token.
    ("syntax_unit_exponent", "the value of an exponent is not looked at"),
    ("syntax_unit_in_exponent", "a unit may follow every number"),
    ("syntax_unit_twice", "a unit may follow every bracket"),
    ("syntax_not_utf8", "bytes that are no UTF-8 inside a comment are read over"),
];

#[test]
fn what_the_compiler_reads_is_read() {
    let mut wrong = Vec::new();
    for mission in missions().iter().filter(|m| m.is_accepted()) {
        if let Some(error) = first_error(&parse(&mission.bytes)) {
            wrong.push(format!("{}:{error}", mission.path));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn what_the_compiler_refuses_is_refused_or_listed() {
    let mut wrong = Vec::new();
    let mut seen = 0;
    for mission in missions().iter().filter(|m| !m.is_accepted()) {
        seen += 1;
        let name = mission.path.rsplit(['/', '.']).nth(1).expect("a name");
        let taken = first_error(&parse(&mission.bytes)).is_none();
        let listed = TAKEN.iter().any(|(listed, _)| *listed == name);
        match (taken, listed) {
            (true, false) => wrong.push(format!("{name} is taken")),
            (false, true) => wrong.push(format!("{name} is refused by now: take it off the list")),
            _ => {}
        }
    }
    assert!(seen >= TAKEN.len(), "a mission of the list is gone");
    assert!(wrong.is_empty(), "{wrong:#?}");
}
