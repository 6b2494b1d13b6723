//! Short cases: a mission's text, and the diagnostics or values that it must give.

use super::*;
use crate::ir;
use crate::syntax::parse;

/// Every code that checking a text gives, errors and warnings, in the order of their places.
fn codes(text: &str) -> Vec<String> {
    run(text, &[]).1.sorted().iter().map(|d| d.code.rsplit("::").next().unwrap_or("").to_string()).collect()
}

fn run(text: &str, set: &[(&str, &str)]) -> (Result<typed::Mission, Reported>, Diagnostics) {
    let source = SourceFile::new("test.dosm", text);
    let set: Vec<(String, String)> = set.iter().map(|(n, e)| (n.to_string(), e.to_string())).collect();
    let mut diagnostics = Diagnostics::new();
    let mission =
        parse(&source, &mut diagnostics).and_then(|file| check(&file, &source, &set, &mut diagnostics));
    (mission, diagnostics)
}

fn problem(text: &str) -> ir::Problem {
    let (mission, diagnostics) = run(text, &[]);
    let errors: Vec<_> = diagnostics.iter().collect();
    crate::lower::lower(&mission.unwrap_or_else(|_| panic!("{errors:#?}"))).0
}

#[test]
fn the_references_mission_checks() {
    let problem = problem(include_str!("../../tests/missions/ok/relay.dosm"));
    assert_eq!(problem.robots.len(), 3);
    assert_eq!(problem.models.len(), 1);
    assert_eq!(problem.goals.len(), 2);
}

#[test]
fn a_goal_that_is_false_by_its_constants_is_refused() {
    let text = include_str!("../../tests/missions/ok/relay.dosm");
    assert_eq!(codes(&format!("{text}\ngoal no: always false")), ["false_goal"]);
}
