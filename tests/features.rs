//! Everything that an editor may ask, at every place of every mission of the corpus and of texts that were
//! cut or stirred: an answer or none, but no panic.

mod common;

use dosmc::driver::Overrides;
use dosmc::lsp::tubes::Tubes;
use dosmc::lsp::{Document, Encoding, hover, inlay, semantic, signature};
use lsp_types::{Position, Range};

fn corpus() -> Vec<(String, String)> {
    let directories = ["tests/missions/ok", "tests/missions/err", "tests/missions/parse", "examples"];
    let paths = directories.into_iter().flat_map(common::missions);
    #[allow(clippy::disallowed_methods, reason = "reads the corpus")]
    let text = |path: &std::path::Path| std::fs::read_to_string(path).ok();
    paths
        .filter_map(|path| Some((path.display().to_string(), text(&path)?)))
        .filter(|(_, t)| t.len() < 20_000)
        .collect()
}

fn document(text: &str) -> Document {
    let uri = "file:///m.dosm".parse().expect("it is a URI");
    Document::new(uri, 1, text.to_string(), Encoding::Utf16, Overrides::default())
}

/// Asks everything about some places, and gives how many hovers there were.
fn ask(text: &str, tubes: &Tubes, stride: usize) -> usize {
    let document = document(text);
    let mut hovers = 0;
    for offset in (0..=text.len()).step_by(stride) {
        let position = document.lines.position(offset as u32);
        hovers += usize::from(hover::hover(&document, position, tubes).is_some());
        signature::help(&document, position);
    }
    let whole = Range::new(Position::new(0, 0), Position::new(u32::MAX, u32::MAX));
    let middle = document.lines.position(text.len() as u32 / 2);
    inlay::hints(&document, whole);
    inlay::hints(&document, Range::new(middle, Position::new(0, 0)));
    semantic::full(&document);
    semantic::range(&document, Range::new(middle, whole.end));
    hovers
}

#[test]
fn every_place_of_the_corpus_can_be_asked_about() {
    let tubes = Tubes::default();
    let hovers: usize = corpus().iter().map(|(_, text)| ask(text, &tubes, 7)).sum();
    assert!(hovers > 3_000, "{hovers} hovers");
}

#[test]
fn texts_that_were_cut_or_stirred_can_be_asked_about() {
    let tubes = Tubes::default();
    for (at, (_, text)) in corpus().iter().enumerate().filter(|(at, _)| at % 5 == 0) {
        let middle = (0..=text.len() / 2).rev().find(|i| text.is_char_boundary(*i)).unwrap_or(0);
        let (head, tail) = text.split_at(middle);
        let swapped = format!("{tail}{head}");
        let garbled: String = text
            .chars()
            .enumerate()
            .map(|(i, c)| if (i + at) % 37 == 0 { ['(', '😀', ']', 'é', '\r'][i % 5] } else { c })
            .collect();
        for text in [head, tail, &swapped, &garbled] {
            ask(text, &tubes, 31);
        }
    }
}
