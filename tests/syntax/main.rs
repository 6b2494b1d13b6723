//! The syntax phase from the outside: trees, messages, whole missions and hostile texts.

#![allow(clippy::disallowed_methods, reason = "reads the corpus")]

mod declarations;
mod expressions;
mod formulas;
mod hostile;
mod missions;
mod mistakes;

use dosmc::diag::{Diagnostic, Diagnostics};
use dosmc::source::SourceFile;
use dosmc::syntax::{self, ast};

/// Parses a text; what could be read, and the diagnostics in order.
fn parse(text: &str) -> (Option<ast::File>, Vec<Diagnostic>) {
    let mut diagnostics = Diagnostics::new();
    let file = syntax::parse(&SourceFile::new("test.dosm", text), &mut diagnostics).ok();
    (file, diagnostics.sorted().into_iter().cloned().collect())
}

/// The trees of some declarations, as lines, without the edition's; they must be free of errors.
#[track_caller]
fn trees(declarations: &str) -> String {
    let (file, diagnostics) = parse(&format!("dosm 1\n{declarations}"));
    assert!(diagnostics.is_empty(), "{declarations}\n{diagnostics:#?}");
    let dump = syntax::dump(&file.unwrap());
    dump.trim_start_matches("edition 1\n").trim_end().to_owned()
}

/// A diagnostic as lines: code, message, labelled text, help.
fn shown(text: &str, diagnostic: &Diagnostic) -> String {
    let source = SourceFile::new("test.dosm", text);
    let mut out = format!("{}: {}\n", diagnostic.code, diagnostic.message);
    for label in &diagnostic.labels {
        let (line, column) = source.line_column(label.span.start);
        let place: String = source.slice(label.span).chars().take(60).collect();
        out.push_str(&format!("  {line}:{column} {place:?} {}\n", label.text));
    }
    if let Some(help) = &diagnostic.help {
        out.push_str(&format!("  help: {help}\n"));
    }
    out
}
