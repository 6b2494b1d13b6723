//! Every mend of every mission that shows a diagnostic mends it, and breaks nothing.

#![allow(clippy::disallowed_methods, reason = "reads the corpus")]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use lsp_types::{CodeActionOrCommand, Position};

use super::*;
use crate::diag::Severity;
use crate::driver::Overrides;
use crate::lsp::lines::Encoding;

/// The codes that no mend is known for that an edit could make: what is meant is not in the text.
const WITHOUT_MEND: &[&str] = &[
    "dosm::abstraction::region_too_small",
    "dosm::abstraction::start_in_jammer",
    "dosm::abstraction::start_in_obstacle",
    "dosm::abstraction::start_outside_bound",
    "dosm::abstraction::start_outside_workspace",
    "dosm::abstraction::starts_too_close",
    "dosm::check::bad_every",
    "dosm::check::bad_hops",
    "dosm::check::bad_order",
    "dosm::check::bad_redundancy",
    "dosm::check::bad_rejection",
    "dosm::check::bad_workspace",
    "dosm::check::base_in_blocker",
    "dosm::check::base_outside",
    "dosm::check::blocker_outside",
    "dosm::check::circle",
    "dosm::check::division_by_zero",
    "dosm::check::duplicate_point",
    "dosm::check::empty_shape",
    "dosm::check::false_goal",
    "dosm::check::family_as_member",
    "dosm::check::family_too_large",
    "dosm::check::flat_shape",
    "dosm::check::formula_too_large",
    "dosm::check::hidden_name",
    "dosm::check::index_out_of_table",
    "dosm::check::misplaced_uncertainty",
    "dosm::check::missing_item",
    "dosm::check::mixed_window",
    "dosm::check::negative_uncertainty",
    "dosm::check::no_coordinate",
    "dosm::check::no_such_member",
    "dosm::check::not_a_table",
    "dosm::check::not_linear",
    "dosm::check::not_positive",
    "dosm::check::number_out_of_range",
    "dosm::check::outside_domain",
    "dosm::check::ragged_table",
    "dosm::check::region_outside",
    "dosm::check::stiff_model",
    "dosm::check::too_many_parts",
    "dosm::check::trivial_goal",
    "dosm::check::unbounded_shape",
    "dosm::check::unsupported",
    "dosm::check::wrong_argument_count",
    "dosm::check::wrong_index_count",
    "dosm::check::wrong_kind",
    "dosm::check::wrong_matrix_size",
    "dosm::check::wrong_position",
    "dosm::syntax::chained_comparison",
    "dosm::syntax::empty",
    "dosm::syntax::foreign_letter",
    "dosm::syntax::long_name",
    "dosm::syntax::number_range",
    "dosm::syntax::number_too_long",
    "dosm::syntax::sum_bracket",
    "dosm::syntax::too_deep",
    "dosm::syntax::too_nested",
    "dosm::syntax::unclosed_comment",
    "dosm::syntax::unit_exponent",
    "dosm::tube::badly_conditioned",
    "dosm::tube::narrow_bounds",
    "dosm::tube::unbounded",
    "dosm::tube::uncontrollable",
    "dosm::tube::weak_inputs",
    "dosm::tube::wider_than_bound",
    "dosm::tube::wider_than_workspace",
];

/// The mends that bring out another error, which was behind the one that they mend.
const BRINGS_OUT: &[(&str, &str)] = &[
    // 0 times something is never as much as the goal asks.
    ("check_not_whole_factor.dosm", "write `0`"),
    // `minimize` itself is not supported.
    ("check_unknown_objective.dosm", "write `length`"),
    ("unknown_objective.md", "write `effort`"),
    ("unknown_objective.md", "write `length`"),
    // The name is right, but it is named twice then, or with values that fit the other one.
    ("check_unknown_signal.dosm", "write `vx`"),
    ("unknown_signal.md", "write `px`"),
    ("unknown_signal.md", "write `py`"),
    // Two points are flat in space whatever they are called.
    ("check_wrong_point_polygon_space.dosm", "write `hull`"),
    // Without its unit the number means metres.
    ("misplaced_unit.md", "remove `cm`"),
];

fn document(text: &str) -> Document {
    let uri = "file:///tmp/m.dosm".parse().expect("it is a URI");
    Document::new(uri, 1, text.into(), Encoding::Utf16, Overrides::default())
}

fn files(below: &str, extension: &str) -> Vec<PathBuf> {
    let mut open = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join(below)];
    let mut found = Vec::new();
    while let Some(directory) = open.pop() {
        for entry in std::fs::read_dir(directory).expect("the directory can be read") {
            let path = entry.expect("the entry can be read").path();
            match path.extension() {
                _ if path.is_dir() => open.push(path),
                Some(e) if e == extension => found.push(path),
                _ => {}
            }
        }
    }
    found.sort();
    found
}

/// The missions that show diagnostics: of the corpus, and of the explanations.
fn corpus() -> Vec<(String, String)> {
    let mut all = Vec::new();
    for path in files("tests/missions/err", "dosm") {
        // Not all of them are UTF-8.
        if let Ok(text) = std::fs::read_to_string(&path) {
            all.push((path.file_name().unwrap_or_default().to_string_lossy().into_owned(), text));
        }
    }
    for path in files("docs/codes", "md") {
        let text = std::fs::read_to_string(&path).expect("it is text");
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        for block in text.split("```dosm\n").skip(1) {
            all.push((name.clone(), block.split("```").next().unwrap_or("").to_string()));
        }
    }
    assert!(all.len() > 250, "{}", all.len());
    all
}

/// The errors of a mission, each by its code and what it says.
fn errors(document: &Document) -> BTreeSet<(&'static str, String)> {
    let list = document.whole().diagnostics.iter();
    list.filter(|d| d.severity == Severity::Error).map(|d| (d.code, d.message.clone())).collect()
}

fn count(document: &Document, code: &str) -> usize {
    document.whole().diagnostics.iter().filter(|d| d.code == code).count()
}

fn changed(text: &str, fix: &Fix) -> String {
    let mut changed = text.to_string();
    for (span, new) in fix.replacements(text).expect("the edits fit").into_iter().rev() {
        changed.replace_range(span.range(), &new);
    }
    changed
}

/// Whether there is a diagnostic of the same code at the place where this one moved.
fn is_still_there(text: &str, fix: &Fix, diagnostic: &Diagnostic, after: &Document) -> bool {
    let place = |d: &Diagnostic| d.labels.first().map_or(0, |l| i64::from(l.span.start));
    let before: i64 = fix
        .replacements(text)
        .unwrap_or_default()
        .iter()
        .filter(|(span, _)| i64::from(span.end) <= place(diagnostic))
        .map(|(span, new)| new.len() as i64 - span.range().len() as i64)
        .sum();
    after
        .whole()
        .diagnostics
        .iter()
        .any(|d| d.code == diagnostic.code && place(d) == place(diagnostic) + before)
}

#[test]
fn every_mend_mends_and_breaks_nothing() {
    let (mut wrong, mut mended, mut shown) = (Vec::new(), BTreeSet::new(), BTreeSet::new());
    let mut count_of_mends = 0;
    for (name, text) in corpus() {
        let before = document(&text);
        if text.len() > 100_000 {
            continue;
        }
        for diagnostic in before.whole().diagnostics.iter() {
            shown.insert(diagnostic.code);
            // One of many repetitions is enough.
            if count(&before, diagnostic.code) > 20 {
                continue;
            }
            for fix in fixes(&before, diagnostic) {
                mended.insert(diagnostic.code);
                count_of_mends += 1;
                let after = document(&changed(&text, &fix));
                let (was, is) = (count(&before, diagnostic.code), count(&after, diagnostic.code));
                let new: Vec<_> = errors(&after).difference(&errors(&before)).cloned().collect();
                let known = BRINGS_OUT.contains(&(name.as_str(), fix.title.as_str()));
                if is >= was && is_still_there(&text, &fix, diagnostic, &after) || !new.is_empty() && !known {
                    wrong.push(format!("{name}: {} ({}): {was} → {is}, {new:?}", fix.title, diagnostic.code));
                }
            }
        }
    }
    wrong.dedup();
    assert!(wrong.is_empty(), "{} of {count_of_mends}: {wrong:#?}", wrong.len());
    let without: Vec<_> = shown.difference(&mended).copied().collect();
    assert_eq!(without, WITHOUT_MEND, "the codes without a mend");
    assert!(count_of_mends > 100, "{count_of_mends}");
}

const SWAPPED: &str = "dosm 1\nworkspace box (0, 0) .. (9, 9)\n/* 😀 */ region a = box (5, 5) .. (1, 1)\n";

fn context(only: Option<Vec<CodeActionKind>>, document: &Document) -> CodeActionContext {
    let shown = document.said().into_iter().map(|d| Shown {
        range: document.range(d.labels.first().map_or(Span::default(), |l| l.span)),
        code: Some(NumberOrString::String(d.code.into())),
        ..Shown::default()
    });
    CodeActionContext { diagnostics: shown.collect(), only, trigger_kind: None }
}

fn asked(
    document: &Document,
    line: u32,
    only: Option<Vec<CodeActionKind>>,
    client: Client,
) -> Vec<CodeActionOrCommand> {
    let range = Range::new(Position::new(line, 0), Position::new(line, 99));
    actions(document, range, &context(only, document), client)
}

fn titles(actions: &[CodeActionOrCommand]) -> Vec<&str> {
    actions
        .iter()
        .map(|action| match action {
            CodeActionOrCommand::CodeAction(action) => action.title.as_str(),
            CodeActionOrCommand::Command(command) => command.title.as_str(),
        })
        .collect()
}

#[test]
fn actions_belong_to_the_place_and_to_what_is_asked_for() {
    let document = document(SWAPPED);
    let client = Client { action_literals: true, ..Client::default() };
    let here = asked(&document, 2, None, client);
    assert_eq!(titles(&here), ["swap the coordinates", "explain dosm::check::box_corners_swapped"]);
    let CodeActionOrCommand::CodeAction(action) = &here[0] else { panic!("a command") };
    assert_eq!(action.is_preferred, Some(true));
    assert_eq!(action.diagnostics.as_ref().map(Vec::len), Some(1));
    let edits = action.edit.as_ref().and_then(|e| e.changes.as_ref()?.values().next()).expect("edits");
    assert_eq!(edits[0].range.start, Position::new(2, 25), "behind a character of two units");
    assert!(!titles(&asked(&document, 1, None, client)).contains(&"swap the coordinates"));
    let all = vec![CodeActionKind::new("source.fixAll")];
    assert_eq!(titles(&asked(&document, 1, Some(all), client)), ["mend all that can be mended surely"]);
    assert!(asked(&document, 2, Some(vec![CodeActionKind::REFACTOR]), client).is_empty());
    let commands = asked(&document, 2, None, Client::default());
    assert_eq!(titles(&commands), ["explain dosm::check::box_corners_swapped"]);
}

#[test]
fn all_sure_mends_are_made_at_once() {
    let text = format!("{SWAPPED}region b = box (7, 7) .. (6, 6)\nhorizon 9..2\nlet c = 1 &&& 2\n");
    let document = document(&text);
    let edit = all_at_once(&document).expect("there are some");
    let edits = edit.changes.and_then(|changes| changes.into_values().next()).expect("edits");
    let mut changed = text.clone();
    for edit in edits.into_iter().rev() {
        changed.replace_range(document.lines.span_of(edit.range).range(), &edit.new_text);
    }
    assert!(
        changed.contains("box (1, 1) .. (5, 5)") && changed.contains("box (6, 6) .. (7, 7)"),
        "{changed}"
    );
    assert!(changed.contains("horizon 2..9"), "{changed}");
}
