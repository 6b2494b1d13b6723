//! Facts of the check against the check itself, on the whole corpus: asking for them changes nothing that
//! is said, and what they say is what the mission means.

mod common;

use common::{missions, source};
use dosmc::check::{Facts, check, check_with_facts};
use dosmc::diag::{Diagnostic, Diagnostics};
use dosmc::source::SourceFile;
use dosmc::syntax;

fn corpus() -> Vec<SourceFile> {
    let directories = [
        "tests/missions/ok",
        "tests/missions/err",
        "tests/missions/parse",
        "tests/missions/solve",
        "examples",
        "examples/paper",
    ];
    directories.into_iter().flat_map(missions).filter_map(|path| readable(&path)).collect()
}

/// The missions that are text: some of the corpus are not.
#[allow(clippy::disallowed_methods, reason = "reads the corpus")]
fn readable(path: &std::path::Path) -> Option<SourceFile> {
    std::fs::read_to_string(path).is_ok().then(|| source(path))
}

fn said(diagnostics: &Diagnostics) -> Vec<Diagnostic> {
    diagnostics.iter().cloned().collect()
}

#[test]
fn asking_for_facts_changes_nothing_that_is_said() {
    let mut wrong = 0;
    for source in corpus() {
        let mut plain = Diagnostics::new();
        let Ok(file) = syntax::parse(&source, &mut plain) else { continue };
        let (mut noted, mut facts) = (plain.clone(), Facts::default());
        let mission = check(&file, &source, &[], &mut plain);
        let noting = {
            let (mission, all) = check_with_facts(&file, &source, &[], &mut noted);
            facts.clone_from(&all);
            mission
        };
        assert_eq!(said(&plain), said(&noted), "{}", source.name);
        assert_eq!(mission.is_ok(), noting.is_ok(), "{}", source.name);
        match mission {
            Err(_) => wrong += 1,
            Ok(mission) => {
                let names: Vec<&str> = mission.regions.values().map(|r| r.name.as_str()).collect();
                let known: Vec<&str> = facts.regions(None).map(|(_, r)| r.name.as_str()).collect();
                assert_eq!(names, known, "{}", source.name);
                assert_eq!(facts.robots(None).count(), mission.robots.len());
                assert_eq!(facts.blockers(None).count(), mission.blockers.len());
                assert_eq!(facts.bases(None).count(), mission.bases.len());
                assert_eq!(facts.step.as_ref(), Some(&mission.step));
            }
        }
    }
    assert!(wrong > 80, "{wrong} missions with errors");
}
