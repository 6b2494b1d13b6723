//! The chain as a library: what it refuses to give out, and how it stops.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use dosmc::diag::Diagnostics;
use dosmc::driver::{self, Answer, Mission, Overrides};
use dosmc::solve::{Progress, Reason, Watch};
use dosmc::source::SourceFile;
use dosmc::verify::Kind;

const REACH: &str = include_str!("missions/solve/reach.dosm");
const RELAY: &str = include_str!("missions/solve/relay.dosm");

/// Allows so many looks, then stops.
struct Looks(AtomicU32);

impl Watch for Looks {
    fn stop(&self) -> bool {
        self.0.fetch_update(Ordering::SeqCst, Ordering::SeqCst, |left| left.checked_sub(1)).is_err()
    }
    fn progress(&self, _: &Progress) {}
    fn now(&self) -> Duration {
        Duration::ZERO
    }
}

fn load(text: &str, overrides: &Overrides) -> Mission {
    let source = SourceFile::new("mission.dosm", text);
    driver::load(&source, overrides, &mut Diagnostics::new()).expect("a mission without errors")
}

fn solve(mission: &Mission, looks: u32) -> Answer {
    let watch: Arc<dyn Watch> = Arc::new(Looks(AtomicU32::new(looks)));
    driver::solve(mission, &watch).answer
}

#[test]
fn a_plan_that_does_not_check_is_not_given_out() {
    let mut mission = load(REACH, &Overrides::default());
    // A tube for half of the disturbance: the search believes it, the checker does not.
    mission.tubes = mission
        .tubes
        .values()
        .cloned()
        .map(|mut tube| {
            tube.half_width.iter_mut().for_each(|w| *w /= 2.0);
            tube
        })
        .collect();
    match solve(&mission, u32::MAX) {
        Answer::Refused(report) => assert!(report.check(Kind::Tube).is_some_and(|c| !c.holds()), "{report}"),
        other => panic!("given out: {other:?}"),
    }
}

#[test]
fn a_search_that_is_stopped_says_so_and_nothing_else() {
    let mission = load(RELAY, &Overrides::default());
    for looks in 0..20 {
        match solve(&mission, looks) {
            Answer::Unknown(Reason::Stopped) | Answer::Plan { .. } => {}
            other => panic!("after {looks} looks: {other:?}"),
        }
    }
    assert!(matches!(solve(&mission, 0), Answer::Unknown(Reason::Stopped)));
}

#[test]
fn the_horizon_of_the_command_line_replaces_the_missions() {
    let horizon = |from, to| Overrides { horizon: Some((from, to)), ..Overrides::default() };
    let shortest = match solve(&load(REACH, &Overrides::default()), u32::MAX) {
        Answer::Plan { plan, .. } => plan.length,
        other => panic!("{other:?}"),
    };
    let below = solve(&load(REACH, &horizon(1, shortest - 1)), u32::MAX);
    assert!(matches!(below, Answer::NoPlan(_)), "{below:?}");
    match solve(&load(REACH, &horizon(shortest + 2, shortest + 5)), u32::MAX) {
        Answer::Plan { plan, .. } => assert_eq!(plan.length, shortest + 2),
        other => panic!("a plan of length L is one of length L + 1 too: {other:?}"),
    }
}

#[test]
fn no_plan_says_what_it_holds_for() {
    let mission = load(include_str!("missions/unsat/too_far.dosm"), &Overrides::default());
    match solve(&mission, u32::MAX) {
        Answer::NoPlan(scope) => {
            assert!(scope.beta["Rover"] > 0.0 && scope.beta["Rover"] < 1.0);
            assert!(scope.half_widths["Rover"].iter().all(|w| *w >= 0.1), "at least the disturbance itself");
            assert_eq!(scope.half_widths["Rover"].len(), 2);
        }
        other => panic!("{other:?}"),
    }
}
