//! The parser that pest makes of `grammar/dosm.pest`, and a reader of its trees.

#![allow(missing_docs, reason = "the rules are documented in the grammar")]

use pest::Parser;
use pest::iterators::{Pair, Pairs};
use pest_derive::Parser;

/// The generated parser.
#[derive(Parser)]
#[grammar = "grammar/dosm.pest"]
struct Grammar;

/// A node of pest's tree.
pub(super) type Node<'i> = Pair<'i, Rule>;

/// Runs one rule over a text.
pub(super) fn run(rule: Rule, text: &str) -> Result<Pairs<'_, Rule>, Box<pest::error::Error<Rule>>> {
    Grammar::parse(rule, text).map_err(Box::new)
}

/// Proof that a declaration can't be built; why has been said.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Stop;

/// What building a part of the tree gives.
pub(super) type Built<T> = Result<T, Stop>;

/// The children of a node, without signs and keywords.
pub(super) struct Children<'i>(std::iter::Peekable<Pairs<'i, Rule>>);

impl<'i> Children<'i> {
    /// The children of a node.
    pub(super) fn of(node: Node<'i>) -> Children<'i> {
        Children(node.into_inner().peekable())
    }

    /// The next child's rule.
    pub(super) fn peek(&mut self) -> Option<Rule> {
        while self.0.next_if(|node| is_mark(node.as_rule())).is_some() {}
        self.0.peek().map(Pair::as_rule)
    }

    /// The next child, if it is of this rule.
    pub(super) fn take_if(&mut self, rule: Rule) -> Option<Node<'i>> {
        if self.peek() == Some(rule) { self.0.next() } else { None }
    }

    /// The next child, which the grammar makes one of this rule.
    pub(super) fn expect(&mut self, rule: Rule) -> Built<Node<'i>> {
        self.take_if(rule).ok_or(Stop)
    }

    /// The next child of whatever rule.
    pub(super) fn expect_any(&mut self) -> Built<Node<'i>> {
        self.next().ok_or(Stop)
    }
}

impl<'i> Iterator for Children<'i> {
    type Item = Node<'i>;

    fn next(&mut self) -> Option<Node<'i>> {
        self.peek()?;
        self.0.next()
    }
}

/// Whether a rule is a sign or a keyword: these stand last in the grammar, from `lparen` on.
pub(super) fn is_mark(rule: Rule) -> bool {
    rule >= Rule::lparen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grammar_alone_reads_a_whole_file_with_its_comments() {
        let text = include_str!("../../tests/missions/parse/everything.dosm");
        let file = run(Rule::file, text).unwrap().next().unwrap();
        let declarations = file.into_inner().filter(|node| node.as_rule() == Rule::declaration).count();
        assert!(declarations > 40, "{declarations}");
        assert!(run(Rule::file, &text.replace("*/", "")).is_err());
    }

    /// Rules that leave no node: parts of tokens, blanks, and those for texts that are no whole file.
    fn is_unseen(rule: Rule) -> bool {
        use Rule::*;
        let parts =
            [WHITESPACE, COMMENT, line_comment, block_comment, idchar, digits, unit_symbol, unit_power];
        let others = [lone_declaration, leading_declaration, lone_expression, reserved];
        parts.contains(&rule) || others.contains(&rule)
    }

    #[test]
    fn a_mission_of_the_corpus_shows_every_rule() {
        // Of connectivity there is only one in a mission.
        let texts = [include_str!("../../tests/missions/parse/everything.dosm"), "connectivity none"];
        let nodes = texts.into_iter().flat_map(|text| run(Rule::file, text).unwrap().flatten());
        let seen: Vec<Rule> = nodes.map(|node| node.as_rule()).collect();
        let missing: Vec<&Rule> =
            Rule::all_rules().iter().filter(|rule| !seen.contains(rule) && !is_unseen(**rule)).collect();
        assert!(missing.is_empty(), "tests/missions/parse/everything.dosm has no {missing:?}");
    }

    #[test]
    fn signs_and_keywords_stand_last() {
        for rule in Rule::all_rules() {
            let word = format!("{rule:?}");
            let keyword = word.starts_with("kw_") || word.starts_with("letter_");
            assert!(!keyword || is_mark(*rule), "{word}");
        }
        assert!(is_mark(Rule::times) && !is_mark(Rule::sum_operator) && !is_mark(Rule::EOI));
    }
}
