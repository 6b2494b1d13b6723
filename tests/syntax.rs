//! The syntax phase from the outside: whole missions, hostile texts, every error code.

use dosmc::diag::Diagnostics;
use dosmc::source::SourceFile;
use dosmc::syntax;
use dosmc::syntax::ast;

/// Parses a text; what could be read, and the diagnostics in order.
fn parse(text: &str) -> (Option<ast::File>, Vec<dosmc::diag::Diagnostic>) {
    let mut diagnostics = Diagnostics::new();
    let file = syntax::parse(&SourceFile::new("test.dosm", text), &mut diagnostics).ok();
    (file, diagnostics.sorted().into_iter().cloned().collect())
}

#[test]
fn the_references_mission_parses() {
    let (file, diagnostics) = parse(include_str!("missions/ok/relay.dosm"));
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    let file = file.unwrap();
    assert_eq!(file.items.len(), 17, "{:#?}", file.items);
    assert!(file.stray_docs.is_empty());
}

#[test]
fn the_tree_of_every_construct() {
    let (file, diagnostics) = parse(include_str!("missions/parse/everything.dosm"));
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    insta::assert_snapshot!(syntax::dump(&file.unwrap()));
}
