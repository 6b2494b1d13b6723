//! Colours of short texts, written out word by word.

use lsp_types::Position;

use super::*;
use crate::driver::Overrides;
use crate::lsp::Encoding;

fn document(text: &str) -> Document {
    let uri = "file:///m.dosm".parse().expect("it is a URI");
    Document::new(uri, 1, text.into(), Encoding::Utf16, Overrides::default())
}

/// The places of tokens (line, column, length in UTF-16) with what is said about them.
fn places(data: &[SemanticToken]) -> Vec<(u32, u32, u32, u32, u32)> {
    let (mut line, mut column) = (0, 0);
    let place = |t: &SemanticToken| {
        column = if t.delta_line == 0 { column + t.delta_start } else { t.delta_start };
        line += t.delta_line;
        (line, column, t.length, t.token_type, t.token_modifiers_bitset)
    };
    data.iter().map(place).collect()
}

/// Each coloured piece with its type, and its modifiers' letters behind a dot.
fn shown(document: &Document, tokens: &SemanticTokens) -> Vec<String> {
    let piece = |(line, column, length, kind, modifiers): (u32, u32, u32, u32, u32)| {
        let from = document.offset(Position::new(line, column));
        let to = document.offset(Position::new(line, column + length));
        let text = document.source.slice(Span { start: from, end: to });
        let letters: String =
            "drol".chars().enumerate().filter(|(i, _)| modifiers & (1 << i) != 0).map(|(_, c)| c).collect();
        let dot = if letters.is_empty() { "" } else { "." };
        format!("{text} {}{dot}{letters}", TYPES[kind as usize].as_str())
    };
    places(&tokens.data).into_iter().map(piece).collect()
}

#[track_caller]
fn check(text: &str, expected: &[&str]) {
    let document = document(text);
    assert_eq!(shown(&document, &full(&document)), expected);
}

#[test]
fn names_are_coloured_by_what_they_are() {
    check(
        "dosm 1\nlet k = pi\nregion a[i in 1..2] = box (k, i) .. (sqrt(9), 3 m)",
        &[
            "dosm keyword",
            "1 number",
            "let keyword",
            "k variable.dr",
            "= operator",
            "pi variable.rl",
            "region keyword",
            "a struct.d",
            "i parameter.d",
            "in keyword",
            "1 number",
            ".. operator",
            "2 number",
            "= operator",
            "box keyword",
            "k variable.r",
            "i parameter",
            ".. operator",
            "sqrt function.l",
            "9 number",
            "3 number",
            "m type.l",
        ],
    );
    check(
        "robot r: D at { px = 1 } dynamics D { step 1 s state px: m } goal g: G r in a",
        &[
            "robot keyword",
            "r variable.d",
            "D class",
            "at keyword",
            "px property",
            "= operator",
            "1 number",
            "dynamics keyword",
            "D class.d",
            "step keyword",
            "1 number",
            "s type.l",
            "state keyword",
            "px property.d",
            "m type.l",
            "goal keyword",
            "g function.d",
            "G keyword",
            "r variable",
            "in keyword",
        ],
    );
}

#[test]
fn a_word_of_the_language_may_be_a_name() {
    check(
        "let step = 1 let m = step",
        &[
            "let keyword",
            "step variable.dr",
            "= operator",
            "1 number",
            "let keyword",
            "m variable.dr",
            "= operator",
            "step variable.r",
        ],
    );
    // A name that nothing declares has no colour, though it be a word elsewhere.
    check("let a = range", &["let keyword", "a variable.dr", "= operator"]);
}

#[test]
fn what_can_t_be_read_is_coloured_as_well() {
    check(
        "let k = 1 jammer J = bal (k, 7 m radius 1",
        &[
            "let keyword",
            "k variable.dr",
            "= operator",
            "1 number",
            "jammer keyword",
            "J struct.d",
            "= operator",
            "k variable.r",
            "7 number",
            "m type.l",
            "radius keyword",
            "1 number",
        ],
    );
    check("always step }", &["always keyword", "step keyword"]);
}

#[test]
fn comments_are_split_at_line_ends() {
    check("/* a 😀\r\n\r\n   b */ let é", &["/* a 😀 comment", "b */ comment", "let keyword"]);
    check("/// Says.\n// no\n", &["/// Says. comment.o", "// no comment"]);
}

#[test]
fn columns_count_utf16() {
    let document = document("/* 😀 */ let a = 1");
    let all = places(&full(&document).data);
    assert_eq!((all[0].1, all[0].2), (0, 8));
    assert_eq!((all[1].1, all[1].2), (9, 3));
}

#[test]
fn tokens_of_the_corpus_are_in_order_and_a_range_has_its_part() {
    for text in [
        include_str!("../../../tests/missions/ok/everything.dosm"),
        include_str!("../../../examples/fleet.dosm"),
        include_str!("../../../examples/drones.dosm"),
    ] {
        let document = document(text);
        let whole = places(&full(&document).data);
        assert!(whole.windows(2).all(|w| (w[0].0, w[0].1 + w[0].2) <= (w[1].0, w[1].1)), "they overlap");
        for from in [0, 7, 20, 31] {
            let asked = Range::new(Position::new(from, 2), Position::new(from + 9, 0));
            let part = places(&range(&document, asked).data);
            let wanted: Vec<_> =
                whole.iter().filter(|t| (t.0, t.1 + t.2) > (from, 2) && t.0 < from + 9).copied().collect();
            assert_eq!(part, wanted, "from line {from}");
        }
    }
}

#[test]
fn a_change_is_one_edit() {
    let (before, after) =
        (full(&document("let a = 1 let b = 2")), full(&document("let a = 1 + 3 let b = 2")));
    let delta = delta(&before.data, &after);
    assert_eq!(delta.edits.len(), 1);
    let flat = |data: &[SemanticToken]| -> Vec<u32> {
        data.iter()
            .flat_map(|t| [t.delta_line, t.delta_start, t.length, t.token_type, t.token_modifiers_bitset])
            .collect()
    };
    let mut changed = flat(&before.data);
    let edit = &delta.edits[0];
    let (start, end) = (edit.start as usize, (edit.start + edit.delete_count) as usize);
    changed.splice(start..end, flat(edit.data.as_deref().unwrap_or(&[])));
    assert_eq!(changed, flat(&after.data));
    assert!(super::delta(&after.data, &after).edits.is_empty());
}

#[test]
fn a_client_with_colours_of_its_own_gets_those_of_names() {
    let text = "dosm 1\nregion A = box (0, 0) .. (1, 1) m // A\n\ngoal g: always R in A or A\n";
    let document = document(text);
    let colours = Colours::new(true);
    let all = places(&full(&document).data);
    let others = ["keyword", "operator", "number", "type", "comment"];
    let is_name = |kind: u32| !others.contains(&TYPES[kind as usize].as_str());
    let names: Vec<_> = all.into_iter().filter(|place| is_name(place.3)).collect();
    assert!(names.len() >= 4, "{names:?}");
    let kept = colours.full(&document);
    assert_eq!(places(&kept.data), names);
    let part = Range::new(Position::new(3, 0), Position::new(4, 0));
    let here: Vec<_> = names.into_iter().filter(|place| place.0 == 3).collect();
    assert_eq!(places(&colours.range(&document, part).data), here);
    let same = colours.delta(&document, kept.result_id.as_deref().expect("a name"));
    assert!(matches!(same, SemanticTokensFullDeltaResult::TokensDelta(delta) if delta.edits.is_empty()));
}
