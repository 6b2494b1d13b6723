//! The lists of words in the plug-ins, written from `dosmc::syntax::words`.
//!
//! A list stands behind a marker, which is a comment (in JSON a `"comment"` entry) that holds
//! `words(CLASS, CLASS -WORD)`: those classes, without that word. What stands between the first `open` and the
//! `close` after it, from the marker's next line on, is the list. `DOSMC_UPDATE=1 cargo test --test editors
//! generated` writes all lists anew; without it a list that differs fails the test.

use std::collections::BTreeSet;
use std::fs;

use dosmc::syntax::words::CLASSES;

use crate::common::package;

/// How a list is written.
struct Style {
    /// What begins a list.
    open: &'static str,
    /// What ends it.
    close: &'static str,
    /// How a word is written.
    item: fn(&str) -> String,
    /// What stands between two words.
    separator: &'static str,
    /// What begins the further lines of a long list; without it lists have one line, however long.
    indent: Option<&'static str>,
}

/// A file of a plug-in.
struct Target {
    file: &'static str,
    style: Style,
    /// Whether all words of the language have to be in its lists, signs aside.
    complete: bool,
}

/// `(?:a|b)` in a regular expression in JSON.
const JSON_REGEX: Style = Style { open: "(?:", close: ")", item: json_regex, separator: "|", indent: None };

/// `["a", "b"]` in JavaScript.
const JS_ARRAY: Style = Style { open: "[", close: "]", item: quoted, separator: ", ", indent: Some("  ") };

/// `[] = {"a", "b"}` in C.
const C_ARRAY: Style = Style { open: "{", close: "}", item: quoted, separator: ", ", indent: Some("  ") };

/// `["a" "b"]` in a query of tree-sitter.
const QUERY: Style = Style { open: "[", close: "]", item: quoted, separator: " ", indent: Some("  ") };

/// The words of `syn keyword` on lines of their own, with an empty line behind them.
const VIM_KEYWORDS: Style =
    Style { open: "\n  \\ ", close: "\n\n", item: str::to_owned, separator: " ", indent: Some("  \\ ") };

/// `['a', 'b']` in Vim script, on lines of its own.
const VIM_LIST: Style = Style {
    open: "[\n  \\ ",
    close: ",\n  \\ ]",
    item: |word| format!("'{word}'"),
    separator: ", ",
    indent: Some("  \\ "),
};

/// `'("a" "b")` in Lisp.
const LISP: Style = Style { open: "'(", close: ")", item: quoted, separator: " ", indent: Some("    ") };

/// `(?:a|b)` in a regular expression.
const REGEX: Style = Style { open: "(?:", close: ")", item: regex, separator: "|", indent: None };

/// The files with lists. Add a line for another one.
const TARGETS: &[Target] = &[
    Target { file: "editors/vim/syntax/dosm.vim", style: VIM_KEYWORDS, complete: false },
    Target { file: "editors/vim/indent/dosm.vim", style: VIM_LIST, complete: false },
    Target { file: "editors/vscode/syntaxes/dosm.tmLanguage.json", style: JSON_REGEX, complete: true },
    Target { file: "editors/sublime/dosm.sublime-syntax", style: REGEX, complete: true },
    Target { file: "editors/emacs/dosm-mode.el", style: LISP, complete: true },
    Target { file: "editors/tree-sitter/grammar.js", style: JS_ARRAY, complete: false },
    Target { file: "editors/tree-sitter/src/words.h", style: C_ARRAY, complete: false },
    Target { file: "editors/tree-sitter/queries/highlights.scm", style: QUERY, complete: false },
];

/// The longest line that a list with several lines has.
const WIDTH: usize = 100;

/// A word as a string.
fn quoted(word: &str) -> String {
    format!("\"{word}\"")
}

/// A word in a regular expression.
fn regex(word: &str) -> String {
    let special = |c: char| "\\^$.|?*+()[]{}/".contains(c);
    word.chars().flat_map(|c| special(c).then_some('\\').into_iter().chain([c])).collect()
}

/// A word in a regular expression in a JSON string.
fn json_regex(word: &str) -> String {
    regex(word).replace('\\', "\\\\").replace('"', "\\\"")
}

/// The words of a class.
fn class(name: &str) -> Result<&'static [&'static str], String> {
    let found = CLASSES.iter().find(|(class, _)| *class == name);
    found.map(|(_, words)| *words).ok_or_else(|| format!("there is no class `{name}` in src/syntax/words.rs"))
}

/// The words that a marker asks for.
fn words(asked: &str) -> Result<Vec<&'static str>, String> {
    let mut words: Vec<&str> = Vec::new();
    for part in asked.split(',') {
        let mut pieces = part.split_whitespace();
        let mut wanted = class(pieces.next().unwrap_or(""))?.to_vec();
        for piece in pieces {
            let left_out = piece.strip_prefix('-').ok_or_else(|| format!("`{piece}`: a comma is missing"))?;
            let place = wanted.iter().position(|word| *word == left_out);
            wanted.remove(place.ok_or_else(|| format!("`{left_out}` isn't in it: {part}"))?);
        }
        words.extend(wanted);
    }
    Ok(words)
}

/// The text of a list.
fn written(words: &[&str], style: &Style, column: usize) -> String {
    let (mut text, mut width) = (String::new(), column);
    for (at, word) in words.iter().enumerate() {
        let item = (style.item)(word);
        if at > 0 {
            text.push_str(style.separator);
            width += style.separator.len();
        }
        if let Some(indent) = style.indent.filter(|_| at > 0 && width + item.len() > WIDTH) {
            text.truncate(text.trim_end().len());
            text.push('\n');
            text.push_str(indent);
            width = indent.len();
        }
        text.push_str(&item);
        width += item.len();
    }
    text
}

/// A text with its lists written anew, and the words in them.
fn rewritten(text: &str, style: &Style) -> Result<(String, BTreeSet<&'static str>), String> {
    let (mut done, mut rest, mut seen) = (String::new(), text, BTreeSet::new());
    while let Some(marker) = rest.find("words(") {
        let asked = &rest[marker + "words(".len()..];
        let asked = asked.split_once(')').map(|(asked, _)| asked).ok_or("a marker doesn't end")?;
        let words = words(asked).map_err(|e| format!("words({asked}): {e}"))?;
        let line = rest[marker..].find('\n').map(|end| marker + end).ok_or("nothing follows a marker")?;
        let open = rest[line..].find(style.open).map(|at| line + at + style.open.len());
        let open = open.ok_or_else(|| format!("words({asked}): no `{}` follows", style.open))?;
        let close = rest[open..].find(style.close).map(|at| open + at);
        let close = close.ok_or_else(|| format!("words({asked}): no `{}` follows", style.close))?;
        let column = open - rest[..open].rfind('\n').map_or(0, |end| end + 1);
        done.push_str(&rest[..open]);
        done.push_str(&written(&words, style, column));
        seen.extend(words);
        rest = &rest[close..];
    }
    if seen.is_empty() {
        return Err("there is no marker, such as words(declarations)".to_owned());
    }
    Ok((done + rest, seen))
}

#[test]
fn lists_are_those_of_the_compiler() {
    let update = std::env::var_os("DOSMC_UPDATE").is_some();
    let mut stale = Vec::new();
    for target in TARGETS {
        let kept =
            fs::read_to_string(package(target.file)).unwrap_or_else(|e| panic!("{}: {e}", target.file));
        let (fresh, seen) =
            rewritten(&kept, &target.style).unwrap_or_else(|e| panic!("{}: {e}", target.file));
        let all = CLASSES.iter().flat_map(|(_, words)| words.iter()).filter(|word| is_word(word));
        let missing: Vec<_> = all.filter(|word| !seen.contains(**word)).collect();
        assert!(!target.complete || missing.is_empty(), "{}: no list has {missing:?}", target.file);
        if update {
            fs::write(package(target.file), fresh).expect("it can be written");
        } else if fresh != kept {
            stale.push(target.file);
        }
    }
    assert!(stale.is_empty(), "not the compiler's words: {stale:?}; DOSMC_UPDATE=1 writes them anew");
}

/// Whether it is no sign.
fn is_word(word: &str) -> bool {
    word.starts_with(|c: char| c.is_ascii_alphabetic())
}

#[test]
fn a_list_is_written_behind_its_marker() {
    let style =
        Style { open: "[", close: "]", item: |w| format!("\"{w}\""), separator: " ", indent: Some("  ") };
    let text = "; words(truths, logic -or)\nx [stale] @k [\"kept\"]\n; words(uncertainty)\n[]";
    let (fresh, seen) = rewritten(text, &style).expect("it is fine");
    let expect = "; words(truths, logic -or)\nx [\"true\" \"false\" \"and\" \"not\"] @k [\"kept\"]\n";
    assert_eq!(fresh, format!("{expect}; words(uncertainty)\n[\"+/-\" \"±\"]"));
    assert_eq!(seen.len(), 6);
    assert_eq!(rewritten(&fresh, &style).expect("still").0, fresh, "it is stable");
    for (text, part) in [
        ("x", "no marker"),
        ("words(truth)\n[]", "no class `truth`"),
        ("words(logic -true)\n[]", "isn't in it"),
        ("words(logic truths)\n[]", "a comma is missing"),
        ("words(logic)\n(", "no `[` follows"),
        ("words(logic)\n[", "no `]` follows"),
        ("words(logic) []", "nothing follows"),
    ] {
        let error = rewritten(text, &style).expect_err(text);
        assert!(error.contains(part), "{error}");
    }
}

#[test]
fn long_lists_have_several_lines_and_signs_are_escaped() {
    let style = Style { open: "(", close: ")", item: str::to_owned, separator: " ", indent: Some("    ") };
    let fresh = rewritten("words(declarations)\n(defconst)", &style).expect("it is fine").0;
    assert!(fresh.lines().count() > 2 && fresh.lines().all(|l| l.len() <= WIDTH + 1), "{fresh}");
    assert!(fresh.lines().all(|l| l.trim_end() == l), "{fresh}");
    assert_eq!(json_regex("||"), "\\\\|\\\\|");
    assert_eq!(json_regex("+/-"), "\\\\+\\\\/-");
}
