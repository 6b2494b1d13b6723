//! Missions through text, check, tubes and step 0: what must pass does, what must not is refused
//! with the code that the file is named after.

#![allow(clippy::disallowed_methods, reason = "reads the corpus")]

use std::fs;
use std::path::{Path, PathBuf};

use dosmc::abstraction;
use dosmc::check::check;
use dosmc::diag::{Diagnostics, Severity};
use dosmc::ir::validate;
use dosmc::law::Float;
use dosmc::lower::lower;
use dosmc::source::SourceFile;
use dosmc::{syntax, tube};

/// The missions of a directory of the repository, sorted; never none.
fn missions(directory: &str) -> Vec<PathBuf> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join(directory);
    let entries = fs::read_dir(&directory).unwrap().map(|entry| entry.unwrap().path());
    let mut found: Vec<_> = entries.filter(|p| p.extension().is_some_and(|e| e == "dosm")).collect();
    found.sort();
    assert!(!found.is_empty(), "no mission in {}", directory.display());
    found
}

/// The codes of a mission's errors.
fn errors(path: &Path) -> Vec<String> {
    let source = SourceFile::new(path.display().to_string(), fs::read_to_string(path).unwrap());
    let mut diagnostics = Diagnostics::new();
    let _ = run(&source, &mut diagnostics);
    let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error);
    errors.map(|d| d.code.to_string()).collect()
}

fn run(source: &SourceFile, diagnostics: &mut Diagnostics) -> Result<(), dosmc::diag::Reported> {
    let file = syntax::parse(source, diagnostics)?;
    let mission = check(&file, source, &[], diagnostics)?;
    let (problem, spans) = lower(&mission);
    assert_eq!(validate(&problem), Ok(()), "{}", source.name);
    let tubes = tube::synthesize(&problem, &spans, Float::F64, diagnostics)?;
    for (id, model) in problem.models.iter() {
        assert!(tube::admits(model, &tubes[id]), "{}", source.name);
    }
    abstraction::inspect(&problem, &spans, &tubes, diagnostics)
}

#[test]
fn good_missions_have_tubes_and_good_starts() {
    let directories = ["tests/missions/ok", "tests/missions/solve", "tests/missions/unsat", "examples"];
    let refused = directories.into_iter().flat_map(missions).map(|path| (errors(&path), path));
    // What check itself refuses is its own tests' business.
    let later = |codes: &Vec<String>| codes.iter().any(|code| !code.starts_with("dosm::check::"));
    let refused: Vec<_> = refused.filter(|(errors, _)| later(errors)).collect();
    assert!(refused.is_empty(), "{refused:#?}");
}

#[test]
fn bad_tubes_and_starts_have_the_code_of_their_name() {
    let (mut seen, mut wrong) = (0, Vec::new());
    for path in missions("tests/missions/err") {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let Some((phase @ ("tube" | "abstraction"), code)) = name.split_once('_') else { continue };
        let found = errors(&path);
        seen += 1;
        // Behind the code a name may say which misuse it is.
        let prefix = format!("dosm::{phase}::");
        let known = |found: &String| {
            let found = found.strip_prefix(&prefix);
            found.is_some_and(|f| code == f || code.strip_prefix(f).is_some_and(|rest| rest.starts_with('_')))
        };
        if found.len() != 1 || !known(&found[0]) {
            wrong.push((name, found));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(seen >= 13, "only {seen} missions");
}
