//! The index of names against the compiler, on the whole corpus: a name changed wherever the index says
//! that it stands changes nothing else, and changed at one of these places alone it changes the mission.

mod common;

use std::collections::BTreeSet;

use common::{missions, source};
use dosmc::diag::Diagnostics;
use dosmc::driver::{self, Overrides};
use dosmc::lsp::index::Index;
use dosmc::source::{SourceFile, Span};
use dosmc::syntax;

/// A name that no mission has.
const FRESH: &str = "zz_fresh_name";

/// The missions that check.
fn corpus() -> Vec<SourceFile> {
    let directories = ["tests/missions/ok", "examples", "examples/paper"];
    directories.into_iter().flat_map(missions).map(source).collect()
}

fn index(source: &SourceFile) -> Index {
    let file = syntax::parse(source, &mut Diagnostics::new()).expect("a mission");
    Index::new(&file)
}

/// What a mission means, as text, with the warnings' codes; `None` when it has errors.
fn meaning(source: &SourceFile) -> Option<String> {
    let mut diagnostics = Diagnostics::new();
    let (problem, _) = driver::problem(source, &Overrides::default(), &mut diagnostics).ok()?;
    // That a variable hides a name is over when one of them has another.
    let hidden = |code: &str| code.contains("hidden_");
    let codes: Vec<&str> = diagnostics.iter().map(|d| d.code).filter(|code| !hidden(code)).collect();
    Some(format!("{problem}{codes:?}"))
}

/// The source with other text at some places, which are in order.
fn replaced(source: &SourceFile, places: &[Span], text: &str) -> SourceFile {
    let (mut result, mut at) = (String::new(), 0);
    for place in places {
        result += &source.text[at..place.start as usize];
        result += text;
        at = place.end as usize;
    }
    SourceFile::new(source.name.clone(), result + &source.text[at..])
}

#[test]
fn a_name_changed_everywhere_changes_nothing_else() {
    let (mut symbols, mut seen) = (0, BTreeSet::new());
    for source in corpus() {
        let before = meaning(&source).unwrap_or_else(|| panic!("{} has errors", source.name));
        let index = index(&source);
        for (id, symbol) in index.symbols().filter(|(_, s)| s.is_renamable()) {
            let places: Vec<Span> = index.occurrences_of(id).map(|o| o.span).collect();
            assert!(places.iter().all(|&p| source.slice(p) == symbol.name), "{}: {symbol:?}", source.name);
            let after = meaning(&replaced(&source, &places, FRESH));
            let after = after.map(|text| text.replace(FRESH, &symbol.name));
            assert_eq!(after.as_ref(), Some(&before), "{}: {symbol:?}", source.name);
            symbols += 1;
            seen.insert(symbol.kind);
        }
        assert!(index.unresolved().is_empty(), "{}: {:?}", source.name, index.unresolved());
    }
    assert!(symbols > 300 && seen.len() >= 15, "{symbols} symbols of the kinds {seen:?}");
}

#[test]
fn a_name_changed_at_one_place_alone_changes_the_mission() {
    let mut places = 0;
    // The larger missions take their time and say nothing new.
    for source in corpus().into_iter().filter(|s| s.text.len() < 4_000) {
        let before = meaning(&source).unwrap_or_else(|| panic!("{} has errors", source.name));
        let index = index(&source);
        for occurrence in index.occurrences() {
            let symbol = index.symbol(occurrence.symbol);
            let alone = index.occurrences_of(occurrence.symbol).count() == 1;
            // What hides a robot of the same name may well be that robot.
            let hides =
                index.symbols().filter(|(_, s)| s.name == symbol.name && s.scope.is_none()).count() > 0;
            if !symbol.is_renamable() || alone || hides && symbol.scope.is_some() {
                continue;
            }
            let after = meaning(&replaced(&source, &[occurrence.span], FRESH));
            let place = source.line_column(occurrence.span.start);
            assert_ne!(after.as_ref(), Some(&before), "{}:{place:?}: {symbol:?}", source.name);
            places += 1;
        }
    }
    assert!(places > 400, "{places} places");
}

#[test]
fn no_place_of_a_name_is_missed() {
    for source in corpus() {
        let index = index(&source);
        // Names that are words of the language elsewhere can't be told without reading.
        let names: BTreeSet<&str> = index
            .symbols()
            .filter(|(_, s)| {
                s.is_renamable()
                    && !syntax::words::CLASSES.iter().any(|(_, words)| words.contains(&s.name.as_str()))
            })
            .map(|(_, s)| s.name.as_str())
            .collect();
        for (at, word) in words(&source.text) {
            let comment = source.text[..at].rsplit('\n').next().is_some_and(|line| line.contains("//"));
            if names.contains(word) && !comment {
                assert!(index.at(at as u32).is_some(), "{}: `{word}` at {at}", source.name);
            }
        }
    }
}

/// The words of a text with their places.
fn words(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.split(move |c| !part(c))
        .filter(|w| !w.is_empty())
        .map(move |w| (w.as_ptr() as usize - text.as_ptr() as usize, w))
}

#[test]
fn a_hundred_thousand_declarations_are_no_trouble() {
    let mut text = String::from("dosm 1\nworkspace box (0, 0) .. (9, 9)\n");
    for i in 0..100_000 {
        text +=
            &format!("let constant_number_{i} = 1 // a comment that makes the line long enough, it is {i}\n");
        if i % 10 == 0 {
            text +=
                &format!("region r{i}[k in 1..2] = box (k, constant_number_{i}) .. (9, constant_number_0)\n");
        }
    }
    let source = SourceFile::new("large.dosm", text);
    let file = syntax::parse(&source, &mut Diagnostics::new()).expect("a mission");
    let index = Index::new(&file);
    assert_eq!(index.symbols().count(), 120_000);
    let first = index.global("constant_number_0").expect("declared");
    assert_eq!(index.occurrences_of(first).count(), 10_002);
    // Quadratic work would not end within the test's patience; a nested formula neither.
    let deep = format!("dosm 1 goal g: {} true", "forall r in all: ".repeat(1_900));
    let file =
        syntax::parse(&SourceFile::new("deep.dosm", deep), &mut Diagnostics::new()).expect("a mission");
    assert_eq!(Index::new(&file).symbols().count(), 1_901);
}
