//! The corpus: every mission through every stage that it reaches, one test a (mission, stage).
//!
//! A snapshot stands beside its mission, `NAME.STAGE.snap`. An empty directory fails: the harness
//! wants at least one mission for each pattern.

mod common;
mod picture;
mod schema;

use std::path::Path;
use std::sync::Arc;

use dosmc::diag::render::{Style, render};
use dosmc::diag::{Diagnostic, Diagnostics, Severity};
use dosmc::driver::{self, Answer, Mission, Overrides};
use dosmc::solve::Watch;
use dosmc::source::SourceFile;
use dosmc::{back, plan, syntax, verify};

use common::Patient;

type Outcome = datatest_stable::Result<()>;

datatest_stable::harness! {
    { test = tree, root = "tests/missions/ok", pattern = r"\.dosm$" },
    { test = ir, root = "tests/missions/ok", pattern = r"\.dosm$" },
    { test = ir, root = "tests/missions/solve", pattern = r"\.dosm$" },
    { test = ir, root = "tests/missions/field", pattern = r"\.dosm$" },
    { test = refused, root = "tests/missions/err", pattern = r"\.dosm$" },
    { test = accepted, root = "tests/missions/ok", pattern = r"\.dosm$" },
    { test = written, root = "tests/missions/ok", pattern = r"\.dosm$" },
    { test = accepted, root = "tests/missions/solve", pattern = r"\.dosm$" },
    { test = accepted, root = "tests/missions/field", pattern = r"\.dosm$" },
    { test = written, root = "tests/missions/solve", pattern = r"\.dosm$" },
    { test = written, root = "tests/missions/field", pattern = r"\.dosm$" },
    { test = accepted, root = "tests/missions/unsat", pattern = r"\.dosm$" },
    { test = written, root = "tests/missions/unsat", pattern = r"\.dosm$" },
    { test = accepted, root = "examples", pattern = r"\.dosm$" },
    { test = written, root = "examples", pattern = r"\.dosm$" },
    { test = planned, root = "tests/missions/solve", pattern = r"\.dosm$" },
    { test = planned, root = "tests/missions/field", pattern = r"\.dosm$" },
    { test = planned, root = "examples", pattern = r"\.dosm$" },
    { test = not_planned, root = "tests/missions/unsat", pattern = r"\.dosm$" },
}

/// The mission's text; bytes that are no text stop at the diagnostic that says so.
fn open(path: &Path, bytes: &[u8]) -> Result<SourceFile, Box<(SourceFile, Diagnostic)>> {
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    match syntax::decode(bytes) {
        Ok(text) => Ok(SourceFile::new(name, text)),
        Err(problem) => Err(Box::new((SourceFile::new(name, String::from_utf8_lossy(bytes)), problem))),
    }
}

/// A mission that has no errors.
fn load(path: &Path, bytes: &[u8]) -> Result<(Mission, SourceFile, Diagnostics), String> {
    let source = open(path, bytes).map_err(|wrong| wrong.1.message)?;
    let mut diagnostics = Diagnostics::new();
    match driver::load(&source, &Overrides::default(), &mut diagnostics) {
        Ok(mission) => Ok((mission, source, diagnostics)),
        Err(_) => Err(render(&source, diagnostics.sorted(), Style::PLAIN)),
    }
}

/// Compares a stage's text with the snapshot beside the mission; those of the examples stand apart, where
/// nobody who reads an example stumbles over them.
fn snapshot(path: &Path, stage: &str, text: &str) {
    let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let beside = path.parent().unwrap_or(Path::new(""));
    let example =
        beside.strip_prefix("examples").ok().map(|rest| Path::new("tests/missions/examples").join(rest));
    let directory = example.unwrap_or_else(|| beside.to_path_buf());
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(Path::new(env!("CARGO_MANIFEST_DIR")).join(directory));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!(format!("{stem}.{stage}"), text));
}

/// What the text says.
fn tree(path: &Path, bytes: Vec<u8>) -> Outcome {
    let source = open(path, &bytes).map_err(|wrong| wrong.1.message)?;
    let mut diagnostics = Diagnostics::new();
    let file = syntax::parse(&source, &mut diagnostics).map_err(|_| "it does not parse")?;
    snapshot(path, "tree", &syntax::dump(&file));
    Ok(())
}

/// What it means.
fn ir(path: &Path, bytes: Vec<u8>) -> Outcome {
    let (mission, _, _) = load(path, &bytes)?;
    snapshot(path, "ir", &mission.problem.to_string());
    Ok(())
}

/// That the IR's file says all of it, always in the same way.
fn written(path: &Path, bytes: Vec<u8>) -> Outcome {
    let (mission, _, _) = load(path, &bytes)?;
    let file = back::ir::write(&mission.problem);
    let read = back::ir::read(&file.contents).map_err(|e| e.to_string())?;
    assert_eq!(read, mission.problem, "the file does not say all of the IR");
    assert_eq!(back::ir::write(&read), file, "one problem, one text");
    assert_schema("ir", &file.contents);
    Ok(())
}

/// What is said about a mission with something wrong in it.
fn refused(path: &Path, bytes: Vec<u8>) -> Outcome {
    let (source, found) = match open(path, &bytes) {
        Err(wrong) => (wrong.0, vec![wrong.1]),
        Ok(source) => {
            let mut diagnostics = Diagnostics::new();
            let loaded = driver::load(&source, &Overrides::default(), &mut diagnostics);
            assert_eq!(
                loaded.is_err(),
                diagnostics.has_errors(),
                "refused without a word, or the other way round"
            );
            (source, diagnostics.sorted().into_iter().cloned().collect())
        }
    };
    if found.is_empty() {
        return Err("nothing is wrong with it".into());
    }
    snapshot(path, "said", &render(&source, &found, Style::PLAIN));
    Ok(())
}

/// That nothing is wrong, and what is worth a look.
fn accepted(path: &Path, bytes: Vec<u8>) -> Outcome {
    let (_, source, diagnostics) = load(path, &bytes)?;
    assert!(diagnostics.iter().all(|d| d.severity == Severity::Warning));
    if diagnostics.iter().next().is_some() {
        snapshot(path, "said", &render(&source, diagnostics.sorted(), Style::PLAIN));
    }
    Ok(())
}

/// That there is a plan, how long it is, and that nothing of it is lost on the way to a file.
fn planned(path: &Path, bytes: Vec<u8>) -> Outcome {
    let (mission, _, _) = load(path, &bytes)?;
    let Answer::Plan { plan, shortest } = solve(&mission) else { return Err("no plan was found".into()) };
    let text = plan::json::write(&plan);
    let read = plan::json::read(&text).map_err(|e| e.to_string())?;
    assert_schema("plan", &text);
    assert_eq!(read, *plan, "plan.json does not say all of the plan");
    let report = verify::verify(&mission.problem, &read);
    assert!(report.holds(), "{report}");
    let drawn = back::svg::draw(&mission.problem, &read, &back::svg::Options::default()).contents;
    picture::assert_fine(&drawn);
    // Several loops may be as short: which one is found is the search's business.
    let text = format!("length {}, shortest: {shortest}", plan.length);
    snapshot(path, "plan", &text);
    Ok(())
}

/// That a file is as its schema says.
#[track_caller]
fn assert_schema(name: &str, text: &str) {
    schema::Closed::of(name).assert_accepts(&serde_json::from_str(text).expect("JSON"));
}

/// That there is none.
fn not_planned(path: &Path, bytes: Vec<u8>) -> Outcome {
    let (mission, _, _) = load(path, &bytes)?;
    match solve(&mission) {
        Answer::NoPlan(_) => Ok(()),
        other => Err(format!("expected no plan, got {other:?}").into()),
    }
}

fn solve(mission: &Mission) -> Answer {
    let watch: Arc<dyn Watch> = Arc::new(Patient);
    driver::solve(mission, &watch).answer
}
