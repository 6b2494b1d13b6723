//! The declarations of a text that was read before, for reading it again after an edit.
//!
//! Most declarations stay as they are while somebody types. What a declaration is depends on its own text
//! alone, with the comments before it: from the end of the one before up to its own end. So the tree of such a
//! text, once read, serves for the same text wherever it stands.

use std::collections::HashMap;

use super::ast::Item;
use super::docs::Docs;
use super::moved::Moved;

/// A declaration as it was read, with places from the beginning of its text.
#[derive(Clone, Debug)]
struct Known {
    item: Item,
    /// The places of the comments that it claimed, from the beginning of its stretch.
    docs: Vec<usize>,
}

/// The declarations that were read last, by their texts.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    known: HashMap<String, Known>,
    /// The declarations of the text that is being read.
    next: HashMap<String, Known>,
}

/// Where a declaration stands.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    /// Its text with all that stands before it, up to the declaration before.
    pub(super) text: &'a str,
    /// Where that begins in the source.
    pub(super) start: u32,
    /// Where its stretch begins in the condensed text.
    pub(super) stretch: usize,
}

impl Memory {
    /// The declaration with this text; its comments are claimed.
    pub(super) fn recall(&mut self, place: Place<'_>, docs: &mut Docs) -> Option<Item> {
        if !self.next.contains_key(place.text) {
            let (text, known) = self.known.remove_entry(place.text)?;
            self.next.insert(text, known);
        }
        let known = self.next.get(place.text)?;
        for claimed in &known.docs {
            docs.claim(place.stretch + claimed);
        }
        let mut item = known.item.clone();
        item.move_by(i64::from(place.start));
        Some(item)
    }

    /// Keeps a declaration; `docs` are the places of the comments that it claimed, in the condensed text.
    pub(super) fn keep(&mut self, place: Place<'_>, item: &Item, docs: &[usize]) {
        let mut item = item.clone();
        item.move_by(-i64::from(place.start));
        let docs = docs.iter().map(|doc| doc - place.stretch).collect();
        self.next.insert(place.text.to_string(), Known { item, docs });
    }

    /// Ends a text: what was not in it is forgotten.
    pub(super) fn turn(&mut self) {
        self.known = std::mem::take(&mut self.next);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::disallowed_methods, reason = "reads the corpus")]

    use proptest::prelude::*;

    use super::*;
    use crate::diag::Diagnostics;
    use crate::source::SourceFile;
    use crate::syntax::{parse, parse_again};

    /// Reads a text with and without memory: both say the same.
    fn check(text: &str, memory: &mut Memory) {
        let source = SourceFile::new("m.dosm", text);
        let (mut fresh, mut again) = (Diagnostics::new(), Diagnostics::new());
        let expected = parse(&source, &mut fresh).ok();
        let read = parse_again(&source, memory, &mut again).ok();
        assert!(read == expected, "{text}");
        assert!(again.iter().eq(fresh.iter()), "{text}");
    }

    fn corpus() -> Vec<String> {
        let mut texts = Vec::new();
        for folder in ["tests/missions/ok", "tests/missions/err", "tests/missions/parse", "examples"] {
            let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
            let entries = std::fs::read_dir(path).expect("a directory of the package");
            let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
            paths.sort();
            let texts_of = paths.iter().filter(|p| p.extension().is_some_and(|e| e == "dosm"));
            texts.extend(texts_of.filter_map(|path| std::fs::read_to_string(path).ok()));
        }
        texts
    }

    #[test]
    fn a_text_that_moves_is_read_as_a_new_one() {
        for text in corpus() {
            let mut memory = Memory::default();
            check(&text, &mut memory);
            check(&text, &mut memory);
            check(&format!("// é→😀 above\n\n{text}"), &mut memory);
            check(&format!("{text}{text}"), &mut memory);
            check(&text, &mut memory);
        }
    }

    #[test]
    fn what_did_not_change_is_not_read_again() {
        let text = include_str!("../../examples/first.dosm");
        let mut memory = Memory::default();
        check(text, &mut memory);
        let before = memory.known.len();
        assert!(before > 5, "{before}");
        check(&text.replacen("workspace box", "workspace bx", 1), &mut memory);
        assert_eq!(memory.known.len(), before - 1, "but for the workspace, which is not known now");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn after_any_edits_a_text_is_read_as_a_new_one(
            which in 0usize..1000,
            edits in prop::collection::vec((0.0..1.0f64, 0usize..40, 0usize..14), 1..12),
        ) {
            let corpus = corpus();
            let mut text = corpus[which % corpus.len()].clone();
            let mut memory = Memory::default();
            check(&text, &mut memory);
            let pieces = [
                "", "", " ", "\n", "/// doc\n", "// c\n", "/*", "*/", "}", "goal", " region r = box (0, 0) .. (1, 1)\n",
                "é", "(", "//! d\n",
            ];
            for (place, length, piece) in edits {
                let floor = |mut at: usize| { while !text.is_char_boundary(at) { at -= 1; } at };
                let from = floor((place * text.len() as f64) as usize);
                let to = floor((from + length).min(text.len())).max(from);
                let old = text.clone();
                text.replace_range(from..to, pieces[piece]);
                check(&text, &mut memory);
                if piece % 3 == 0 {
                    check(&old, &mut memory);
                    check(&text, &mut memory);
                }
            }
        }
    }
}
