//! Goals in words, with the mission's names; what they ask of whom.

use std::collections::BTreeSet;

use crate::entity::EntityId;
use crate::ir::{Atom, Comparison, Formula, FormulaId, Problem, Relation};

/// The longest goal that is written out; equal subformulas are one in the problem but not in a text.
const LONGEST: usize = 600;
/// The deepest nesting that is written out.
const DEEPEST: usize = 60;

/// A formula as text, in the words of the language; cut where it is very long.
pub fn text(problem: &Problem, formula: FormulaId) -> String {
    let mut writer = Writer { problem, out: String::new() };
    writer.formula(formula, 0);
    if writer.out.chars().count() > LONGEST {
        return writer.out.chars().take(LONGEST).chain("…".chars()).collect();
    }
    writer.out
}

/// All that a formula asks of any state, by robot and region.
pub fn atoms(problem: &Problem, formula: FormulaId) -> BTreeSet<Atom> {
    let mut seen = BTreeSet::new();
    let mut found = BTreeSet::new();
    let mut open = vec![formula];
    while let Some(id) = open.pop() {
        if !seen.insert(id.index()) {
            continue;
        }
        match &problem.formulas[id] {
            Formula::True | Formula::False => {}
            Formula::In(atom) | Formula::Out(atom) => {
                found.insert(*atom);
            }
            Formula::Compare(comparison) => found.extend(comparison.terms.iter().map(|(atom, _)| *atom)),
            Formula::And(operands) | Formula::Or(operands) => open.extend(operands),
            Formula::Next(operand) => open.push(*operand),
            Formula::Until(_, a, b) | Formula::Release(_, a, b) => open.extend([*a, *b]),
        }
    }
    found
}

struct Writer<'a> {
    problem: &'a Problem,
    out: String,
}

impl Writer<'_> {
    fn formula(&mut self, id: FormulaId, depth: usize) {
        if depth > DEEPEST || self.out.len() > 4 * LONGEST {
            self.out.push('…');
            return;
        }
        let constant = |id: FormulaId| &self.problem.formulas[id];
        match &self.problem.formulas[id] {
            Formula::True => self.out.push_str("true"),
            Formula::False => self.out.push_str("false"),
            Formula::In(atom) => self.atom(atom, " in "),
            Formula::Out(atom) => self.atom(atom, " not in "),
            Formula::Compare(comparison) => self.comparison(comparison),
            Formula::And(operands) => self.joined(operands, " and ", depth),
            Formula::Or(operands) => self.joined(operands, " or ", depth),
            Formula::Next(operand) => self.prefixed("next", None, *operand, depth),
            Formula::Until(window, a, b) if *constant(*a) == Formula::True => {
                self.prefixed("eventually", *window, *b, depth);
            }
            Formula::Release(window, a, b) if *constant(*a) == Formula::False => {
                self.prefixed("always", *window, *b, depth);
            }
            Formula::Until(window, a, b) => self.between("until", *window, [*a, *b], depth),
            Formula::Release(window, a, b) => self.between("release", *window, [*a, *b], depth),
        }
    }

    /// An operand, in parentheses where it has parts.
    fn operand(&mut self, id: FormulaId, depth: usize) {
        let whole = match &self.problem.formulas[id] {
            Formula::And(operands) | Formula::Or(operands) => operands.len() == 1,
            Formula::Until(_, a, _) => self.problem.formulas[*a] == Formula::True,
            Formula::Release(_, a, _) => self.problem.formulas[*a] == Formula::False,
            Formula::Compare(_) => false,
            _ => true,
        };
        self.out.push_str(if whole { "" } else { "(" });
        self.formula(id, depth + 1);
        self.out.push_str(if whole { "" } else { ")" });
    }

    fn joined(&mut self, operands: &[FormulaId], word: &str, depth: usize) {
        for (i, operand) in operands.iter().enumerate() {
            self.out.push_str(if i > 0 { word } else { "" });
            self.operand(*operand, depth);
        }
    }

    fn prefixed(&mut self, word: &str, window: Option<(u32, u32)>, operand: FormulaId, depth: usize) {
        self.word(word, window);
        self.operand(operand, depth);
    }

    fn between(&mut self, word: &str, window: Option<(u32, u32)>, [a, b]: [FormulaId; 2], depth: usize) {
        self.operand(a, depth);
        self.out.push(' ');
        self.word(word, window);
        self.operand(b, depth);
    }

    fn word(&mut self, word: &str, window: Option<(u32, u32)>) {
        self.out.push_str(word);
        if let Some((from, to)) = window {
            self.out.push_str(&format!("[{from}, {to}]"));
        }
        self.out.push(' ');
    }

    fn atom(&mut self, atom: &Atom, relation: &str) {
        self.out.push_str(&self.problem.robots[atom.robot].name);
        self.out.push_str(relation);
        self.out.push_str(&self.problem.regions[atom.region].name);
    }

    fn comparison(&mut self, comparison: &Comparison) {
        for (i, (atom, coefficient)) in comparison.terms.iter().enumerate() {
            let (sign, size) = (if *coefficient < 0 { "−" } else { "+" }, coefficient.unsigned_abs());
            match (i, sign) {
                (0, "+") => {}
                (0, _) => self.out.push('−'),
                _ => self.out.push_str(&format!(" {sign} ")),
            }
            if size != 1 {
                self.out.push_str(&format!("{size}·"));
            }
            self.out.push('[');
            self.atom(atom, " in ");
            self.out.push(']');
        }
        let relation = match comparison.relation {
            Relation::Equal => "=",
            Relation::NotEqual => "≠",
            Relation::AtLeast => "≥",
            Relation::AtMost => "≤",
        };
        self.out.push_str(&format!(" {relation} {}", comparison.bound));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Diagnostics;
    use crate::source::SourceFile;

    /// The texts of a mission's goals.
    fn said(goals: &str) -> Vec<String> {
        let mission = include_str!("../../../tests/missions/solve/reach.dosm");
        let kept = mission.lines().filter(|l| !l.starts_with("goal"));
        let text: String =
            kept.chain(["region home = box (1, 1) .. (3, 3)", goals]).map(|l| format!("{l}\n")).collect();
        let source = SourceFile::new("m.dosm", text);
        let mut diagnostics = Diagnostics::new();
        let loaded = crate::driver::load(&source, &Default::default(), &mut diagnostics);
        let problem = loaded.unwrap_or_else(|_| panic!("{:?}", diagnostics.sorted())).problem;
        problem.goals.iter().map(|goal| super::text(&problem, goal.formula)).collect()
    }

    #[test]
    fn goals_read_as_they_were_written() {
        let goals = [
            "eventually r in target",
            "always eventually r in target",
            "eventually (r in target and always eventually[1, 9] r in home)",
            "(not r in target) until r in home",
        ];
        let text: String = goals.iter().enumerate().map(|(i, g)| format!("goal g{i}: {g}\n")).collect();
        let expected = [goals[0], goals[1], goals[2], "r not in target until r in home"];
        assert_eq!(said(&text), expected);
    }

    #[test]
    fn very_long_goals_are_cut() {
        let mut goal = "r in home".to_string();
        for _ in 0..12 {
            goal = format!("(eventually ({goal}) and next ({goal}))");
        }
        let texts = said(&format!("goal g: {goal}\n"));
        assert!(texts[0].chars().count() <= LONGEST + 1 && texts[0].ends_with('…'));
    }
}
