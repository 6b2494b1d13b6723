//! Words of missions that look like code: whatever they are, the crate's tokens are those of the
//! template, with identifiers made for the crate in their places.

use std::collections::{BTreeMap, BTreeSet};

use dosmc::back::Artifact;
use dosmc::ir::{Base, Blocker, Model, Problem, Region, Robot, Signal};
use dosmc::law;
use dosmc::plan::Plan;
use proc_macro2::{TokenStream, TokenTree};

use super::luck::Luck;
use super::{PLANNED, Planned, crate_of};

/// How many crates are made of random names.
const CASES: usize = if cfg!(debug_assertions) { 100 } else { 2_000 };

/// What names and texts are put together from.
const PIECES: [&str; 46] = [
    "\"",
    "\"; loop {} //",
    "*/",
    "/*",
    "\n//!",
    "\n#![no_main]",
    "\r",
    "r#\"",
    "\"#",
    "r#fn",
    "{",
    "}",
    "{{",
    "{}",
    "\\",
    "\\u{7d}",
    "'",
    "';",
    "#[cfg(x)]",
    "fn",
    "self",
    "Self",
    "_",
    "__",
    "fleet[1]",
    "fleet_1",
    "Fleet1",
    "fleet1",
    "\u{202e}",
    "\u{2066}",
    "\u{0}",
    "\u{1b}",
    "\u{feff}",
    "\u{2028}",
    "é",
    "ß",
    "µ",
    "状",
    "Option",
    "None",
    "Node",
    "State",
    "```",
    "](x)",
    "1.",
    " ",
];

fn word(luck: &mut Luck) -> String {
    if luck.below(3) == 0 {
        return luck.pick(&PIECES).to_string();
    }
    let count = 1 + luck.below(5);
    let piece = |luck: &mut Luck| match luck.below(6) {
        0 => char::from_u32(luck.below(0x3000) as u32).map(String::from).unwrap_or_default(),
        1 => format!("{}", luck.below(30)),
        _ => luck.pick(&PIECES).to_string(),
    };
    (0..count).map(|_| piece(luck)).collect()
}

/// A word that is not among those given out.
fn fresh(luck: &mut Luck, given: &mut BTreeSet<String>) -> String {
    let mut word = word(luck);
    while !given.insert(word.clone()) {
        word.push_str(["_", " ", "1", "\u{200b}", "x"][luck.below(5)]);
    }
    word
}

/// Gives everything in a mission and its plan another name, and other documentation.
fn renamed(
    planned: &Planned,
    name: &mut dyn FnMut(&str) -> String,
    doc: &mut dyn FnMut() -> String,
) -> Planned {
    let (mut problem, mut plan) = (planned.problem.clone(), planned.plan.clone());
    let mut names: BTreeMap<String, String> = BTreeMap::new();
    let robots = problem.robots.values().map(|r| &r.name);
    let bases = problem.bases.values().map(|b| &b.name);
    let models = problem.models.values().map(|m| &m.name);
    for old in robots.chain(bases).chain(models) {
        names.insert(old.clone(), name(old));
    }
    let new = |old: &String| names.get(old).unwrap_or(old).clone();
    let mut signals = |all: &[Signal]| -> Vec<Signal> {
        let mut given = BTreeSet::new();
        let one = |s: &Signal| {
            let mut called = name(&s.name);
            while !given.insert(called.clone()) {
                called.push('x');
            }
            Signal { name: called, doc: doc(), unit: s.unit.clone() }
        };
        all.iter().map(one).collect()
    };
    let model = |m: &Model| Model {
        name: new(&m.name),
        states: signals(&m.states),
        inputs: signals(&m.inputs),
        ..m.clone()
    };
    problem.models = problem.models.values().map(model).collect();
    problem.models = problem.models.values().map(|m| Model { doc: doc(), ..m.clone() }).collect();
    problem.robots =
        problem.robots.values().map(|r| Robot { name: new(&r.name), doc: doc(), ..r.clone() }).collect();
    problem.bases =
        problem.bases.values().map(|b| Base { name: new(&b.name), doc: doc(), ..b.clone() }).collect();
    problem.regions = problem.regions.values().map(|r| Region { doc: doc(), ..r.clone() }).collect();
    problem.blockers = problem.blockers.values().map(|b| Blocker { doc: doc(), ..b.clone() }).collect();
    (problem.name, problem.doc) = (name("mission"), doc());
    rename_plan(&mut plan, &new);
    plan.tool = doc();
    Planned { name: planned.name.clone(), problem, plan, float: planned.float }
}

fn rename_plan(plan: &mut Plan, new: &dyn Fn(&String) -> String) {
    for tube in &mut plan.tubes {
        tube.dynamics = new(&tube.dynamics);
    }
    for robot in &mut plan.robots {
        (robot.name, robot.dynamics) = (new(&robot.name), new(&robot.dynamics));
    }
    for link in plan.links.iter_mut().flatten().flatten() {
        (link.from, link.to) = (new(&link.from), new(&link.to));
    }
}

/// A token of the template's kind; groups are their brackets.
#[derive(Clone, Debug, PartialEq)]
enum Token {
    Word(String),
    Sign(char),
    Text,
    Hash,
    Number(String),
}

/// All tokens of a source but documentation, which is comments.
fn tokens(source: &str) -> Vec<Token> {
    let mut all = Vec::new();
    flatten(source.parse().expect("tokens"), &mut all);
    all
}

fn flatten(stream: TokenStream, all: &mut Vec<Token>) {
    for tree in stream {
        match tree {
            TokenTree::Group(group) => {
                let is_doc = group.stream().into_iter().next().is_some_and(|t| t.to_string() == "doc");
                if is_doc {
                    // `#[doc = "…"]`, `#![doc = "…"]`: what a comment of documentation is read as.
                    all.pop_if(|token| *token == Token::Sign('!'));
                    assert_eq!(all.pop(), Some(Token::Sign('#')));
                    assert_eq!(group.stream().into_iter().count(), 3, "nothing but the text");
                    continue;
                }
                let brackets = match group.delimiter() {
                    proc_macro2::Delimiter::Parenthesis => ['(', ')'],
                    proc_macro2::Delimiter::Brace => ['{', '}'],
                    proc_macro2::Delimiter::Bracket => ['[', ']'],
                    proc_macro2::Delimiter::None => [' ', ' '],
                };
                all.push(Token::Sign(brackets[0]));
                flatten(group.stream(), all);
                all.push(Token::Sign(brackets[1]));
            }
            TokenTree::Ident(word) => all.push(Token::Word(word.to_string())),
            TokenTree::Punct(sign) => all.push(Token::Sign(sign.as_char())),
            TokenTree::Literal(literal) => {
                let text = literal.to_string();
                all.push(match () {
                    () if text.starts_with('"') => Token::Text,
                    // A hash of the tables, the names in it.
                    () if text.starts_with("0x") && text.len() == 18 => Token::Hash,
                    () => Token::Number(text),
                });
            }
        }
    }
}

/// Fails where a file has other tokens than its model, but for words that stand for each other, one for
/// one.
fn assert_same_code(file: &Artifact, model: &Artifact, words: &mut BTreeMap<String, String>) {
    assert_eq!(file.name, model.name);
    syn::parse_file(&file.contents).unwrap_or_else(|e| panic!("{}: {e}\n{}", file.name, file.contents));
    let (found, expected) = (tokens(&file.contents), tokens(&model.contents));
    assert_eq!(found.len(), expected.len(), "{}", file.name);
    for (token, wanted) in found.iter().zip(&expected) {
        let (Token::Word(token), Token::Word(wanted)) = (token, wanted) else {
            assert_eq!(token, wanted, "{}", file.name);
            continue;
        };
        let plain = token.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        assert!(plain, "{}: `{token}`", file.name);
        // In every scope a word stands for one word, but scopes may share words.
        words.entry(format!("{wanted} {token}")).or_insert_with(|| wanted.clone());
    }
}

/// The same with a few steps and matrices only: the names are what matters.
fn shortened(planned: &Planned) -> Planned {
    let mut plan = planned.plan.clone();
    (plan.length, plan.loop_start) = (2, 1);
    for tube in &mut plan.tubes {
        tube.d.truncate(2);
        tube.m.truncate(2);
    }
    for robot in &mut plan.robots {
        robot.z.truncate(3);
        robot.v.truncate(3);
    }
    plan.links.iter_mut().for_each(|links| links.truncate(3));
    Planned { name: planned.name.clone(), problem: planned.problem.clone(), plan, float: planned.float }
}

/// The words of the template's own; all others in the model are names, which the model has made
/// recognisable.
fn is_name(word: &str) -> bool {
    let word = word.to_lowercase();
    word.starts_with("qq") || word.contains("qqmission")
}

#[test]
fn threat_29_names_that_look_like_code_are_names() {
    let planned = PLANNED.iter().find(|p| p.name == "wind_f64").expect("an example with two models");
    let planned = &shortened(planned);
    let mut count = 0;
    let mut plain = |_: &str| {
        count += 1;
        if count == 0 { String::new() } else { format!("qq{}", letters(count)) }
    };
    let model = renamed(planned, &mut plain, &mut || "Text.".into());
    let model = Planned { problem: Problem { name: "qqmission".into(), ..model.problem }, ..model };
    let model = crate_of(&model);
    let mut changed = 0;
    for seed in 0..CASES {
        let mut luck = Luck::new(seed as u64);
        let mut given = BTreeSet::new();
        let mut texts = Luck::new(1_000_000 + seed as u64);
        let hostile = renamed(planned, &mut |_| fresh(&mut luck, &mut given), &mut || word(&mut texts));
        let files = crate_of(&hostile);
        assert_eq!(files.len(), model.len());
        let mut words = BTreeMap::new();
        for (file, model) in files.iter().zip(&model) {
            match file.name.rsplit('.').next() {
                _ if file.name.ends_with("/law.rs") => assert_eq!(file.contents, law::SOURCE),
                Some("rs") => assert_same_code(file, model, &mut words),
                _ => assert_no_control(file),
            }
        }
        for (pair, wanted) in words {
            let token = pair.rsplit(' ').next().expect("a pair");
            assert!(token == wanted || is_name(&wanted), "seed {seed}: `{wanted}` has become `{token}`");
            changed += usize::from(token != wanted);
        }
    }
    assert!(changed > CASES, "{changed}");
}

/// `qqa`, `qqb` …: names that every rule for identifiers leaves alone.
fn letters(number: usize) -> String {
    let letter = |n: usize| char::from(b'a' + (n % 26) as u8);
    [letter(number / 26), letter(number)].iter().collect()
}

/// Cargo.toml has lines of its own only, and neither file anything that hides.
fn assert_no_control(file: &Artifact) {
    let hides = |c: char| {
        (c.is_control() && c != '\n')
            || matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    assert!(!file.contents.contains(hides), "{}: {:?}", file.name, file.contents);
    if file.name.ends_with("Cargo.toml") {
        let keys: Vec<&str> =
            file.contents.lines().filter_map(|l| l.split_once(" = ")).map(|(key, _)| key).collect();
        let expected = ["name", "version", "edition", "rust-version", "description", "publish"];
        assert_eq!(keys.iter().filter(|k| !k.starts_with('#')).copied().collect::<Vec<_>>(), expected);
        assert!(!file.contents.contains("dependencies]"));
    }
}

#[test]
fn crates_have_no_unsafe_code_no_heap_and_no_dependencies() {
    for planned in PLANNED.iter() {
        for file in crate_of(planned).iter().filter(|f| f.name.ends_with(".rs")) {
            for token in tokens(&file.contents) {
                let Token::Word(word) = token else { continue };
                let banned =
                    ["unsafe", "std", "alloc", "extern", "Vec", "Box", "String", "panic", "unwrap", "expect"];
                assert!(!banned.contains(&word.as_str()), "{}: {}: {word}", planned.name, file.name);
            }
            let forbids = file.contents.contains("#![no_std]\n#![forbid(unsafe_code)]");
            assert_eq!(forbids, file.name.ends_with("lib.rs"), "{}", file.name);
        }
    }
}
