//! Texts that are deep, huge or random: an answer without absurd work, no panic, no stack gone.

use std::num::NonZeroUsize;

use dosmc::diag::Diagnostics;
use dosmc::source::SourceFile;
use dosmc::syntax;
use proptest::prelude::*;

use crate::parse;

/// The most steps that the parser may take for a declaration: some hundred a byte of the longest chain here.
///
/// Work that grows with the square of the text's length is far beyond it, on every machine.
const STEPS: usize = 20_000_000;

/// Checks that a text has an error of a code, and that it takes no absurd work to say so.
#[track_caller]
fn refused(what: &str, text: &str, code: &str) {
    pest::set_call_limit(NonZeroUsize::new(STEPS));
    let (_, diagnostics) = parse(text);
    let codes: Vec<&str> = diagnostics.iter().map(|d| d.code).collect();
    assert!(codes.contains(&format!("dosm::syntax::{code}").as_str()), "{what}: {codes:?}");
}

const MANY: usize = 100_000;

#[test]
fn deep_texts_are_refused_at_once() {
    for (open, close) in [("(", ")"), ("[", "]"), ("{", "}")] {
        let nested = format!("{}1{}", open.repeat(20_000), close.repeat(20_000));
        refused(open, &format!("dosm 1 let x = {nested}"), "too_nested");
        refused(open, &format!("dosm 1 goal g: {nested}"), "too_nested");
        refused(open, &format!("dosm 1 region a = {nested}"), "too_nested");
        refused(open, &nested, "too_nested");
    }
    refused("comments", &format!("dosm 1 {}", "/*".repeat(MANY)), "too_nested");
    refused("comments", &format!("dosm 1 {}{}", "/*".repeat(257), "*/".repeat(257)), "too_nested");
}

#[test]
fn long_chains_are_refused_at_once() {
    const SOME: usize = 4_000;
    refused("!", &format!("dosm 1 goal g: {}a", "!".repeat(MANY)), "too_deep");
    refused("->", &format!("dosm 1 goal g: {}a", "a->".repeat(20_000)), "too_deep");
    refused("-", &format!("dosm 1 let x = {}1", "-".repeat(MANY)), "too_deep");
    refused("^", &format!("dosm 1 let x = {}1", "1^".repeat(20_000)), "too_deep");
    for prefix in ["not ", "G ", "[]", "<>", "next[1,2] ", "forall r in all: ", "exists i in 1..2: "] {
        refused(prefix, &format!("dosm 1 goal g: {}a", prefix.repeat(SOME)), "too_deep");
    }
    for infix in ["->", "&&", "<->", "||", "U", "until[1, 2]"] {
        refused(infix, &format!("dosm 1 goal g: {}a", format!("a {infix} ").repeat(SOME)), "too_deep");
    }
    for infix in ["+", "-", "*", "/", "^", "^-"] {
        refused(infix, &format!("dosm 1 let x = {}1", format!("1{infix}").repeat(SOME)), "too_deep");
    }
    refused("product", &format!("dosm 1 goal g: {}n = 1", "2*".repeat(SOME)), "too_deep");
    refused("sum", &format!("dosm 1 goal g: {}n", "n+".repeat(SOME)), "expected");
    refused("brackets", &format!("dosm 1 goal g: {}", "(R1 in A) + ".repeat(SOME)), "expected");
}

#[test]
fn the_deepest_trees_are_built_walked_and_dropped() {
    let build = || {
        let ok = |text: String| {
            let (file, diagnostics) = parse(&text);
            assert!(diagnostics.is_empty(), "{diagnostics:#?}");
            let file = file.unwrap();
            assert!(syntax::dump(&file).len() > 512);
        };
        ok(format!("dosm 1 goal g: {}a", "!".repeat(1_999)));
        ok(format!("dosm 1 goal g: {}a", "forall r in all: ".repeat(1_999)));
        ok(format!("dosm 1 goal g: {}a", "a -> ".repeat(1_999)));
        ok(format!("dosm 1 goal g: {}a", "a and ".repeat(1_999)));
        ok(format!("dosm 1 let x = {}1", "-".repeat(1_999)));
        ok(format!("dosm 1 let x = {}1", "1 + ".repeat(1_999)));
        ok(format!("dosm 1 let x = {}1", "1^".repeat(1_999)));
        for (declaration, open, close) in [
            ("let x = ", "(", ")"),
            ("let x = ", "f(", ")"),
            ("let x = ", "P[", "]"),
            ("goal g: ", "(", ")"),
            ("goal g: ", "not always(", ")"),
            ("goal g: ", "(b and ", " or c)"),
            ("goal g: ", "(forall r in all: ", ")"),
        ] {
            ok(format!("dosm 1 {declaration}{}a{}", open.repeat(256), close.repeat(256)));
            refused(
                "256 and more",
                &format!("dosm 1 {declaration}{}a{}", open.repeat(257), close.repeat(257)),
                "too_nested",
            );
        }
        ok(format!("dosm 1 base b at ({}1{}, 2)", "(".repeat(255), ")".repeat(255)));
        ok(format!(
            "dosm 1 {}{} mission m let x = {}1",
            "/*".repeat(256),
            "*/".repeat(256),
            "-".repeat(1_500)
        ));
        refused("2001 levels", &format!("dosm 1 goal g: {}a", "!".repeat(2_000)), "too_deep");
        refused("2001 levels", &format!("dosm 1 let x = {}1", "1+".repeat(2_000)), "too_deep");
        let inner = format!("({}1)", "1+".repeat(20)).repeat(1);
        let nested = (0..200).fold(inner, |inside, _| format!("(1+1+1+1+1+1+1+1+1+1+{inside})"));
        refused(
            "levels through brackets",
            &format!("dosm 1 let x = {}{nested}", "-".repeat(1_700)),
            "too_deep",
        );
    };
    std::thread::Builder::new().stack_size(2 << 20).spawn(build).unwrap().join().unwrap();
}

#[test]
fn huge_texts_are_answered() {
    let ten_megabytes = 10 << 20;
    let noise = |alphabet: &str, length: usize| -> String {
        let signs: Vec<char> = alphabet.chars().collect();
        let mut state = 1u64;
        let mut text = String::new();
        while text.len() < length {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            text.extend(signs.get((state >> 33) as usize % signs.len()));
        }
        text
    };
    refused("letters", &noise("abcdefgh \n", ten_megabytes), "expected");
    refused("signs", &noise("+-*/^=<>!&|,;:. ab1", 1 << 20), "expected");
    refused("brackets", &noise("()[]{} ab1", ten_megabytes), "too_nested");
    refused("odd", &noise("ä☃\u{200b}≤ ", ten_megabytes), "too_many_errors");
    refused("one word", &"a".repeat(ten_megabytes), "long_name");
    refused("digits", &format!("dosm 1 let x = {}", "7".repeat(ten_megabytes)), "number_too_long");
    refused("digits", &format!("dosm 1 let x = 0.{}", "7".repeat(ten_megabytes)), "number_too_long");
    refused("keywords", &"region ".repeat(200_000), "too_many_errors");
    refused("declarations", &"goal g: a b\n".repeat(100_000), "too_many_errors");
    refused("blanks", &format!("dosm 1 {} let x = 1 1", " ".repeat(ten_megabytes)), "expected");
    refused("blanks", &format!("dosm 1 let x {} = 1 1", "\n".repeat(ten_megabytes)), "expected");
    refused("comment", &format!("dosm 1 goal g: a /* {} */ b", "/ * ".repeat(ten_megabytes / 4)), "expected");
    refused("comment", &format!("dosm 1 goal g: a /* {}", "x".repeat(ten_megabytes)), "unclosed_comment");
    refused("docs", &format!("{}mission m", "/// d\n".repeat(200_000)), "missing_edition");
    refused("too long", &" ".repeat(100 << 20), "text_too_long");
    refused("nothing", "", "empty");
    refused("nothing", " \n\t// c\n/* d */", "empty");
}

#[test]
fn a_large_mission_is_read() {
    let region = "region r1 = box (9, 1) .. (11.5, 3.5) m // note\ngoal g: always eventually R3 in pi1\n";
    let (file, diagnostics) = parse(&format!("dosm 1\n{}", region.repeat(500)));
    assert!(diagnostics.is_empty() && file.unwrap().items.len() == 1_001);
}

#[test]
fn bytes_that_are_no_text() {
    assert_eq!(syntax::decode(b"dosm 1").unwrap(), "dosm 1");
    assert_eq!(syntax::decode(b"\xef\xbb\xbfdosm 1").unwrap(), "dosm 1");
    for (bytes, offset) in [(b"dosm \xff".as_slice(), 5), (b"\xef\xbb\xbf\xc3\x28", 3), (b"\xed\xa0\x80", 0)]
    {
        let diagnostic = syntax::decode(bytes).unwrap_err();
        assert_eq!(diagnostic.code, "dosm::syntax::not_utf8");
        assert!(diagnostic.message.contains(&format!("byte {offset} ")), "{}", diagnostic.message);
        assert_eq!(diagnostic.labels[0].span.start, offset);
    }
}

/// Either there is a tree of everything, or an error; every place lies in the text, between characters.
fn parses_or_says_why(text: &str) {
    let mut diagnostics = Diagnostics::new();
    let source = SourceFile::new("test.dosm", text);
    let parsed = syntax::parse(&source, &mut diagnostics);
    for label in diagnostics.iter().flat_map(|d| &d.labels) {
        assert!(text.get(label.span.range()).is_some(), "{label:?} in {text:?}");
    }
    match parsed {
        Err(_) => assert!(diagnostics.has_errors()),
        Ok(file) => {
            assert_eq!(
                file.broken.is_empty(),
                file.broken.is_empty() && syntax::dump(&file).find("broken ").is_none()
            );
            assert!(file.broken.is_empty() || diagnostics.has_errors(), "{text:?}");
            for item in &file.items {
                assert!(!source.slice(item.span).is_empty(), "{item:?} in {text:?}");
            }
        }
    }
}

const EVERYTHING: &str = include_str!("../missions/parse/everything.dosm");

/// What is put into missions to break them.
const PIECES: [&str; 40] = [
    "(", ")", "[", "]", "{", "}", ",", ";", ":", "=", "==", "..", ".", "-", "->", "<->", "!", "&", "^", "/*",
    "*/", "//", "/// d\n", "goal", "region", "dosm 1", "R", "in", "all", "1e999", "0x", "m/s", " ", "\n",
    "é", "∀", "（", "\u{202e}", "²", "name",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mutated_missions_parse_or_say_why(
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0usize..12, prop::sample::select(&PIECES[..])), 1..8),
        part in any::<prop::sample::Index>(),
    ) {
        let mut characters: Vec<char> = EVERYTHING.chars().collect();
        let from = part.index(characters.len());
        characters.drain(..from);
        for (place, removed, inserted) in edits {
            let at = place.index(characters.len() + 1);
            let end = (at + removed).min(characters.len());
            characters.splice(at..end, inserted.chars());
        }
        parses_or_says_why(&characters.into_iter().collect::<String>());
    }

    #[test]
    fn random_pieces_parse_or_say_why(pieces in prop::collection::vec(prop::sample::select(&PIECES[..]), 0..60)) {
        parses_or_says_why(&pieces.concat());
        parses_or_says_why(&format!("dosm 1 goal g: {}", pieces.join(" ")));
    }

    #[test]
    fn random_characters_parse_or_say_why(text in any::<String>()) {
        parses_or_says_why(&text);
        parses_or_says_why(&format!("dosm 1 let x = {text}"));
        let _ = syntax::parse_expression(&text);
    }
}
