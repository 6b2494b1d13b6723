//! The style by examples, and what must hold for every text.

#![allow(clippy::disallowed_methods, reason = "reads the corpus")]

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use proptest::prelude::*;

use super::*;
use crate::syntax::token::Kind;

/// A text in the style; it has to be stable.
fn formatted(text: &str) -> String {
    let format = |text: &str| {
        let source = SourceFile::new("test.dosm", text);
        super::format(&source, &mut Diagnostics::new()).expect("it can be read").text
    };
    let once = format(text);
    assert_eq!(format(&once), once, "it changes again");
    once
}

/// The text is not left as it was because something went wrong.
fn assert_laid_out(text: &str) {
    let source = SourceFile::new("test.dosm", text);
    let mut diagnostics = Diagnostics::new();
    if let Ok(file) = parse(&source, &mut diagnostics) {
        let text = layout(&source, &parts(&file, &diagnostics));
        assert!(is_same(&source, &file, &text), "it says something else:\n{}\n---\n{text}", source.text);
    }
}

#[test]
fn the_style_by_an_example() {
    let text = "\
//! What it is.
dosm   1
mission   relay ; region a=box(0,0)..(1,1) // here
region longer = ball ( 2,3 ) radius 1   // there



/// About J.
jammer J=
  ball (4, 7)
  radius 1
dynamics Rover { step 0.5 s; state px:m,vx:m/s // states
input ax:m/s^2 position px
  A=[1,0.5;
  0,1]
  // Of one axis.
  B = [0.125;0.5]
  bound vx in [-4,4]m/s bound ax in [-0.25, 0.25] m/s^2; disturbance px in [-1,1] cm

  mode wet when {x<=1;vx>=0} { A=[1,2;
  10,4] } }
robot T[i in 1 .. 2]:Rover at(P[i,1],0)
connectivity { hops<=2;range 3 m }
connectivity { hops <= 2
range 3 m }
goal g: always (T[1] in a
     -> eventually [0 s,6s] T[2] in a)
/* The
     end */
";
    let text = text.replace("mission   relay ;", "mission   relay");
    insta::assert_snapshot!(formatted(&text));
}

#[test]
fn comments_stay_where_they_belong() {
    for (text, expected) in [
        ("dosm 1 /* a */ // b\nmission m", "dosm 1  /* a */\n// b\nmission m\n"),
        ("dosm 1\n\n\n// a\n\nmission m // b", "dosm 1\n\n// a\n\nmission m  // b\n"),
        ("dosm 1\nlet a = [1, // one\n 2]", "dosm 1\nlet a = [1,  // one\n  2]\n"),
        ("dosm 1\nlet /* why */ a = 1", "dosm 1\nlet /* why */ a = 1\n"),
        ("dosm 1 /// stray\nlet a = 1", "dosm 1  /// stray\nlet a = 1\n"),
        (
            "dosm 1\ndynamics Q { // r\n\n// s\nstep 1 s // t\n}",
            "dosm 1\ndynamics Q {  // r\n  // s\n  step 1 s  // t\n}\n",
        ),
        ("dosm 1\r\nmission m\r\n// x \r\n", "dosm 1\nmission m\n// x\n"),
    ] {
        assert_eq!(formatted(text), expected);
    }
}

#[test]
fn what_can_not_be_read_is_left_as_it_is() {
    let text = "dosm 1\nregion  a =box (0,0)..( 1,1)\nregion  b = bax (0,0)  ..\n   (1,1)\n\n// c\nregion  c= box (0,0)..(2,2)\n";
    let source = SourceFile::new("test.dosm", text);
    let mut diagnostics = Diagnostics::new();
    let formatted = super::format(&source, &mut diagnostics).expect("most of it can be read");
    assert_eq!(formatted.left, 1);
    let expected = "dosm 1\nregion a = box (0, 0) .. (1, 1)\nregion  b = bax (0,0)  ..\n   (1,1)\n\n// c\nregion c = box (0, 0) .. (2, 2)\n";
    assert_eq!(formatted.text, expected);
}

/// The texts of all missions of the repository.
static CORPUS: LazyLock<Vec<String>> = LazyLock::new(corpus);

fn corpus() -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut texts = Vec::new();
    let mut open = vec![root.join("tests/missions"), root.join("examples")];
    while let Some(directory) = open.pop() {
        for entry in fs::read_dir(directory).expect("a directory") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == "dosm") {
                texts.extend(fs::read_to_string(path));
            }
        }
    }
    assert!(texts.len() > 100, "the corpus is gone");
    texts.sort();
    texts
}

/// The text with every run of blanks replaced by another; comments keep their own and end their lines.
fn with_blanks(text: &str, blanks: &str) -> String {
    let mut out = String::new();
    let mut ends_line = false;
    for token in super::tokens(text) {
        // What a comment documents may depend on the line it stands on.
        if ends_line || token.is_comment() && token.lines_before > 0 {
            out.push('\n');
        } else if token.is_comment() && token.blank_before {
            out.push(' ');
        } else if token.blank_before {
            out.push_str(blanks);
        }
        out.push_str(token.text);
        ends_line = matches!(token.kind, Kind::LineComment | Kind::Doc);
    }
    out
}

#[test]
fn no_mission_of_the_corpus_changes_its_meaning() {
    for text in CORPUS.iter() {
        for text in
            [text.clone(), with_blanks(text, " "), with_blanks(text, "\n"), with_blanks(text, "\t \n\n ")]
        {
            assert_laid_out(&text);
            let source = SourceFile::new("test.dosm", text.clone());
            if parse(&source, &mut Diagnostics::new()).is_ok() {
                formatted(&text);
            }
        }
    }
}

#[test]
fn examples_are_in_the_style() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for directory in ["examples", "examples/paper"] {
        for entry in fs::read_dir(root.join(directory)).expect("a directory") {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|e| e == "dosm") {
                let text = fs::read_to_string(&path).expect("a text");
                assert!(formatted(&text) == text, "`dosmc fmt {}` would change it", path.display());
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    /// Pieces of missions in any order, cut anywhere.
    #[test]
    fn no_text_changes_its_meaning(
        pieces in proptest::collection::vec((any::<proptest::sample::Index>(), any::<proptest::sample::Index>(), 1usize..80), 1..8),
        blanks in prop_oneof![Just(" "), Just("\n"), Just("\n\n\n"), Just("")],
    ) {
        let mut text = String::from("dosm 1\n");
        for (which, at, length) in pieces {
            let from = which.get(&CORPUS).chars().collect::<Vec<_>>();
            if !from.is_empty() {
                let at = at.index(from.len());
                text.extend(&from[at..(at + length).min(from.len())]);
            }
            text.push_str(blanks);
        }
        assert_laid_out(&text);
        if parse(&SourceFile::new("test.dosm", text.clone()), &mut Diagnostics::new()).is_ok() {
            formatted(&text);
        }
    }
}

/// A text after some edits, made all at once.
fn edited(text: &str, edits: &[(Span, String)]) -> String {
    let mut result = String::new();
    let mut from = 0;
    for (span, new) in edits {
        assert!(from <= span.range().start, "edits stand in order");
        result.push_str(&text[from..span.range().start]);
        result.push_str(new);
        from = span.range().end;
    }
    result + &text[from..]
}

#[test]
fn edits_touch_nothing_but_blanks_and_make_the_formatted_text() {
    for text in corpus() {
        for text in [with_blanks(&text, " \n  "), with_blanks(&text, "\t"), text] {
            let source = SourceFile::new("m.dosm", text);
            let Ok(formatted) = format(&source, &mut Diagnostics::new()) else { continue };
            let edits = edits(&source, &mut Diagnostics::new()).expect("it can be formatted");
            assert_eq!(edited(&source.text, &edits), formatted.text);
            let is_blank = |t: &str| t.chars().all(|c| c.is_whitespace() || c == ';');
            let touched = edits.iter().find(|(span, new)| !is_blank(source.slice(*span)) || !is_blank(new));
            assert_eq!(touched, None);
        }
    }
    assert!(edits(&SourceFile::new("m", "dosm 1\n"), &mut Diagnostics::new()).is_ok_and(|e| e.is_empty()));
}
