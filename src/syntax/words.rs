//! Every word and sign of the language, by class: the one place that lists them.
//!
//! The reader, the formatter, messages and the editors' plug-ins (`tests/editors`) take their lists from
//! here. The grammar has to spell its literals itself; the tests below hold each of them against these lists.

/// The words that begin declarations. Reserved.
pub const DECLARATIONS: [&str; 19] = [
    "dosm",
    "mission",
    "param",
    "let",
    "workspace",
    "region",
    "obstacle",
    "opaque",
    "jammer",
    "base",
    "dynamics",
    "robot",
    "team",
    "separation",
    "connectivity",
    "horizon",
    "minimize",
    "goal",
    "define",
];

/// The words between a name and its place or set. Reserved.
pub const PREPOSITIONS: [&str; 2] = ["in", "at"];

/// The words that begin shapes.
pub const SHAPES: [&str; 6] = ["box", "ball", "disc", "polygon", "hull", "where"];

/// The words inside a shape, `norm` also inside `connectivity`.
pub const SHAPE_PARTS: [&str; 2] = ["radius", "norm"];

/// The words that begin the items of a `dynamics` block, but for its matrices.
pub const DYNAMICS_ITEMS: [&str; 10] = [
    "step",
    "state",
    "input",
    "position",
    "continuous",
    "integrator",
    "bound",
    "disturbance",
    "rejection",
    "mode",
];

/// The words inside an item of a `dynamics` block.
pub const DYNAMICS_PARTS: [&str; 1] = ["when"];

/// The matrices of a `dynamics` block or a mode.
pub const MATRICES: [&str; 3] = ["A", "B", "c"];

/// The words that begin the items of a `connectivity` block.
pub const CONNECTIVITY_ITEMS: [&str; 4] = ["hops", "range", "redundancy", "every"];

/// What stands behind `connectivity` in place of a block.
pub const CONNECTIVITY_OFF: [&str; 1] = ["none"];

/// What stands behind `minimize`. The grammar takes any name there.
pub const OBJECTIVES: [&str; 2] = ["effort", "length"];

/// The temporal operators that are words; `weak` and `strong` stand before `until` and `release`. Reserved.
pub const TEMPORAL: [&str; 7] = ["always", "eventually", "next", "until", "release", "weak", "strong"];

/// The temporal operators that are letters. Reserved.
pub const TEMPORAL_LETTERS: [&str; 7] = ["X", "F", "G", "U", "R", "W", "M"];

/// The operators of propositional logic that are words; `or` also joins shapes. Reserved.
pub const LOGIC: [&str; 3] = ["and", "or", "not"];

/// The words that range over robots or numbers. Reserved.
pub const QUANTIFIERS: [&str; 3] = ["forall", "exists", "count"];

/// The set of all robots. Reserved.
pub const SETS: [&str; 1] = ["all"];

/// The two truths. Reserved.
pub const TRUTHS: [&str; 2] = ["true", "false"];

/// The functions, which are names that every mission has. To the grammar they are names like others.
pub const FUNCTIONS: [&str; 8] = ["sqrt", "sin", "cos", "min", "max", "abs", "floor", "mod"];

/// The constants that every mission has. To the grammar they are names like others.
pub const CONSTANTS: [&str; 1] = ["pi"];

/// The names of coordinates inside `where`. To the grammar they are names like others.
pub const COORDINATES: [&str; 3] = ["x", "y", "z"];

/// The symbols of units; `min(` is the function.
pub const UNITS: [&str; 12] = crate::quantity::SYMBOLS;

/// The operators of propositional logic that are signs.
pub const LOGIC_SIGNS: [&str; 5] = ["<->", "->", "||", "&&", "!"];

/// The temporal operators that are signs.
pub const TEMPORAL_SIGNS: [&str; 2] = ["[]", "<>"];

/// The signs that compare.
pub const COMPARISONS: [&str; 6] = ["!=", "<=", ">=", "<", ">", "="];

/// The signs between the operands of expressions.
pub const ARITHMETIC: [&str; 5] = ["+", "-", "*", "/", "^"];

/// The signs between a number and how far it may be off.
pub const UNCERTAINTY: [&str; 2] = ["+/-", "±"];

/// The sign between two ends.
pub const DOTS: [&str; 1] = [".."];

/// The brackets, each opening one before its partner.
pub const BRACKETS: [&str; 6] = ["(", ")", "[", "]", "{", "}"];

/// The signs that separate.
pub const SEPARATORS: [&str; 3] = [",", ";", ":"];

/// The reserved words that begin no declaration.
pub const RESERVED_INSIDE: [&str; 25] =
    joined(&[&PREPOSITIONS, &LOGIC, &TRUTHS, &TEMPORAL, &QUANTIFIERS, &SETS, &TEMPORAL_LETTERS]);

/// The names that every mission has without declaring them.
pub const PREDECLARED: [&str; 9] = joined(&[&CONSTANTS, &FUNCTIONS]);

/// The signs of more than one character, none of them behind its own beginning.
pub const LONG_SIGNS: [&str; 11] = ["<->", "+/-", "->", "<=", ">=", "!=", "||", "&&", "[]", "<>", ".."];

/// All classes, each under its name in lower case.
pub const CLASSES: [(&str, &[&str]); 26] = [
    ("declarations", &DECLARATIONS),
    ("prepositions", &PREPOSITIONS),
    ("shapes", &SHAPES),
    ("shape_parts", &SHAPE_PARTS),
    ("dynamics_items", &DYNAMICS_ITEMS),
    ("dynamics_parts", &DYNAMICS_PARTS),
    ("matrices", &MATRICES),
    ("connectivity_items", &CONNECTIVITY_ITEMS),
    ("connectivity_off", &CONNECTIVITY_OFF),
    ("objectives", &OBJECTIVES),
    ("temporal", &TEMPORAL),
    ("temporal_letters", &TEMPORAL_LETTERS),
    ("logic", &LOGIC),
    ("quantifiers", &QUANTIFIERS),
    ("sets", &SETS),
    ("truths", &TRUTHS),
    ("functions", &FUNCTIONS),
    ("constants", &CONSTANTS),
    ("coordinates", &COORDINATES),
    ("units", &UNITS),
    ("logic_signs", &LOGIC_SIGNS),
    ("temporal_signs", &TEMPORAL_SIGNS),
    ("comparisons", &COMPARISONS),
    ("arithmetic", &ARITHMETIC),
    ("uncertainty", &UNCERTAINTY),
    ("dots", &DOTS),
];

/// Whether a word is reserved everywhere, so that nothing can be called so.
pub fn is_reserved(word: &str) -> bool {
    DECLARATIONS.contains(&word) || RESERVED_INSIDE.contains(&word)
}

/// Some lists behind one another; `N` is their length together.
const fn joined<const N: usize>(lists: &[&[&'static str]]) -> [&'static str; N] {
    let mut all = [""; N];
    let (mut list, mut count) = (0, 0);
    while list < lists.len() {
        let mut word = 0;
        while word < lists[list].len() {
            all[count] = lists[list][word];
            (word, count) = (word + 1, count + 1);
        }
        list += 1;
    }
    assert!(count == N, "the lists are shorter");
    all
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    const GRAMMAR: &str = include_str!("../../grammar/dosm.pest");

    /// What the grammar spells for the characters of numbers, names, blanks and comments.
    const LEXICAL: [&str; 11] = [" ", "\\t", "\\r", "\\n", "//", "/*", "*/", "_", ".", "e", "1"];

    /// The classes of words that are names to the grammar.
    const NAMES: [&str; 4] = ["functions", "constants", "coordinates", "objectives"];

    /// The literals in a piece of the grammar, comments left out.
    fn literals(grammar: &str) -> BTreeSet<&str> {
        let code = grammar.lines().filter(|line| !line.trim_start().starts_with("//"));
        code.flat_map(|line| line.split('"').skip(1).step_by(2)).collect()
    }

    /// The body of a rule.
    fn rule(name: &str) -> &'static str {
        let whole = |line: &str| line.split_whitespace().take(2).eq([name, "="]);
        let start = GRAMMAR.lines().position(whole).unwrap_or_else(|| panic!("no rule {name}"));
        let from: usize = GRAMMAR.split_inclusive('\n').take(start).map(str::len).sum();
        let body = &GRAMMAR[from..];
        let end = body.find("\n\n").unwrap_or(body.len());
        let one_line = body.lines().next().filter(|line| line.trim_end().ends_with('}'));
        one_line.unwrap_or_else(|| body[..end].split("\n}").next().unwrap_or(""))
    }

    /// The keywords that the alternatives of a rule begin with.
    fn first_words(name: &str) -> BTreeSet<&'static str> {
        let list = rule(name).split_once('{').expect("a body").1.trim_end_matches(['}', ' ', '\n']);
        let first = |alternative: &'static str| {
            let word = rule(alternative).split("kw_").nth(1)?;
            word.split(|c: char| !c.is_ascii_alphanumeric()).next()
        };
        list.split('|').map(str::trim).filter_map(first).collect()
    }

    #[track_caller]
    fn same<'a>(what: &str, there: BTreeSet<&'a str>, here: impl IntoIterator<Item = &'a str>) {
        let here: BTreeSet<&str> = here.into_iter().collect();
        let missing: Vec<_> = there.difference(&here).collect();
        let surplus: Vec<_> = here.difference(&there).collect();
        assert!(
            missing.is_empty() && surplus.is_empty(),
            "{what}: only in the grammar {missing:?}, only here {surplus:?}"
        );
    }

    #[test]
    fn every_literal_of_the_grammar_is_listed_and_the_other_way_round() {
        let mut there = literals(GRAMMAR);
        for lexical in LEXICAL {
            assert!(there.remove(lexical), "the grammar has no {lexical:?}");
        }
        let spelled = CLASSES.iter().filter(|(class, _)| !NAMES.contains(class));
        let signs = BRACKETS.into_iter().chain(SEPARATORS);
        let here = spelled.flat_map(|(_, words)| words.iter().copied()).chain(signs);
        // What the tests of a sign's surroundings spell are no signs themselves.
        there.remove("/-");
        same("literals", there, here);
    }

    #[test]
    fn the_grammar_reserves_the_same_words() {
        same("reserved", literals(rule("reserved")), DECLARATIONS.into_iter().chain(RESERVED_INSIDE));
    }

    #[test]
    fn units_and_letters_are_those_of_the_grammar() {
        let mut units = literals(rule("unit_symbol"));
        assert!(units.remove("("), "`min(` is told from `min`");
        same("unit_symbol", units, UNITS);
        same("letter", literals(rule("letter")), MATRICES);
        same("plus_minus", literals(rule("plus_minus")), UNCERTAINTY);
        same("truth", literals(rule("truth")), TRUTHS);
    }

    #[test]
    fn the_words_that_begin_things_are_those_of_the_grammar() {
        // `opaque` is not the first alternative's word, but an optional one before it.
        let declarations = DECLARATIONS.into_iter().filter(|word| *word != "obstacle");
        same("declaration", first_words("declaration"), declarations);
        same("piece", first_words("piece"), SHAPES);
        same("dynamics_item", first_words("dynamics_item"), DYNAMICS_ITEMS);
        same("connectivity_item", first_words("connectivity_item"), CONNECTIVITY_ITEMS);
    }

    #[test]
    fn every_keyword_rule_is_called_like_its_word() {
        let mut count = 0;
        for line in GRAMMAR.lines() {
            let Some(name) = line.strip_prefix("kw_").and_then(|rest| rest.split(' ').next()) else {
                continue;
            };
            assert_eq!(literals(line), BTreeSet::from([name]), "{line}");
            count += 1;
        }
        assert!(count > 50, "{count}");
    }

    #[test]
    fn no_word_has_two_classes() {
        let mut seen = BTreeSet::new();
        for (class, words) in CLASSES {
            for word in words {
                // `min` is a unit and a function, told apart by what follows.
                assert!(seen.insert(*word) || *word == "min", "`{word}` again in {class}");
            }
        }
    }

    #[test]
    fn long_signs_are_all_and_come_before_their_beginnings() {
        let of_classes =
            [LOGIC_SIGNS.as_slice(), &TEMPORAL_SIGNS, &COMPARISONS, &UNCERTAINTY, &DOTS].concat();
        let long = of_classes.into_iter().filter(|sign| sign.chars().count() > 1);
        same("long signs", long.collect(), LONG_SIGNS);
        for (at, sign) in LONG_SIGNS.iter().enumerate() {
            assert!(!LONG_SIGNS[..at].iter().any(|before| sign.starts_with(before)), "{sign}");
        }
    }
}
