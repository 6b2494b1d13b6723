//! Bugs put into what the search believes, each caught by the exact check and by nothing before it.
//!
//! The search gets a problem or tubes that differ from the mission in one respect, as they would if
//! the encoder or the abstraction had the bug; the plan that it finds is then checked against the
//! mission itself.

mod common;

use std::sync::Arc;
use std::time::Duration;

use dosmc::abstraction::Abstraction;
use dosmc::diag::Diagnostics;
use dosmc::driver::{self, Mission, Overrides};
use dosmc::exact::Rational;
use dosmc::ir::Problem;
use dosmc::plan::{self, Nominal};
use dosmc::solve::{self, Options, Outcome, Progress, Reason, Watch};
use dosmc::source::SourceFile;
use dosmc::tube::Tubes;
use dosmc::verify::{Kind, verify};

use common::Patient;

fn load(text: &str) -> Mission {
    let source = SourceFile::new("mission.dosm", text);
    let mut diagnostics = Diagnostics::new();
    driver::load(&source, &Overrides::default(), &mut diagnostics)
        .unwrap_or_else(|_| panic!("{diagnostics:?}"))
}

fn search(problem: &Problem, tubes: &Tubes) -> (Option<Box<Nominal>>, Abstraction) {
    let abstraction = Abstraction::new(problem, tubes, 1.0);
    let options = Options { horizon: problem.horizon, watch: Arc::new(Patient) };
    match solve::solve(problem, tubes, &abstraction, &options).0 {
        Outcome::Plan(nominal) => (Some(nominal), abstraction),
        _ => (None, abstraction),
    }
}

/// Searches what is believed and checks against the mission: the kinds of check that fail.
fn caught(mission: &Mission, believed: &Problem, tubes: &Tubes) -> Vec<Kind> {
    let (nominal, abstraction) = search(believed, tubes);
    let nominal = nominal.expect("the bug lets the search find something");
    let mut plan = plan::extract(believed, tubes, &abstraction, &nominal).expect("it has its witnesses");
    // The plan is one of the mission as far as it says itself, with the mission's own tubes.
    let honest = plan::extract(&mission.problem, &mission.tubes, &abstraction, &nominal);
    if let Some(honest) = honest {
        plan.tubes = honest.tubes;
    }
    let report = verify(&mission.problem, &plan);
    let kinds = [
        Kind::Tube,
        Kind::Start,
        Kind::States,
        Kind::Inputs,
        Kind::Workspace,
        Kind::Regions,
        Kind::Blockers,
        Kind::Links,
        Kind::Connectivity,
        Kind::Separation,
        Kind::Goals,
    ];
    kinds.into_iter().filter(|k| report.check(*k).is_some_and(|c| !c.holds())).collect()
}

fn dynamics(disturbance: &str) -> String {
    format!(
        "dynamics Rover {{\n step 0.5 s\n integrator 2\n bound vx, vy in [-4, 4] m/s\n \
         bound ax, ay in [-6, 6] m/s^2\n {disturbance}\n rejection 0.5\n}}\n"
    )
}

const SLOT: &str = "dosm 1\nworkspace box (0, 0) .. (12, 6)\nobstacle low = box (5, 0) .. (6, 2.4)\n\
    obstacle high = box (5, 3.6) .. (6, 6)\nregion there = box (8, 1) .. (11, 5)\nconnectivity none\n\
    horizon 1..16\nrobot r: Rover at (2, 3)\ngoal g: eventually r in there\n";

#[test]
fn tubes_that_are_too_thin_are_caught() {
    // A slot 1.2 m wide against a tube of ±0.75 m: no plan. With a tenth of the tube there is one.
    let mission = load(&format!("{SLOT}{}", dynamics("disturbance px, py in [-0.5, 0.5] m")));
    assert!(search(&mission.problem, &mission.tubes).0.is_none());
    let thin = mission.tubes.values().cloned().map(|mut tube| {
        tube.half_width.iter_mut().for_each(|w| *w *= 0.1);
        tube
    });
    let thin: Tubes = thin.collect();
    assert!(caught(&mission, &mission.problem, &thin).contains(&Kind::Blockers));
}

#[test]
fn a_mean_that_is_forgotten_is_caught() {
    let mission = load(&format!("{SLOT}{}", dynamics("disturbance px, py in [0.1, 0.3] m")));
    let mut believed = mission.problem.clone();
    let id = believed.models.ids().next().unwrap();
    for interval in &mut believed.models[id].disturbance {
        let half = (&interval.hi - &interval.lo) * Rational::ratio(1, 2);
        (interval.lo, interval.hi) = (-&half, half);
    }
    assert!(caught(&mission, &believed, &mission.tubes).contains(&Kind::Tube));
}

#[test]
fn a_separation_without_the_tubes_is_caught() {
    let text = "dosm 1\nworkspace box (0, 0) .. (12, 3)\nregion left = box (0, 0) .. (3, 3)\n\
        region right = box (9, 0) .. (12, 3)\nconnectivity none\nhorizon 1..20\nseparation 1.4 m\n\
        robot a: Rover at (1.5, 0.6)\nrobot b: Rover at (10.5, 2.4)\n\
        goal g: eventually (a in right)\ngoal h: eventually (b in left)\n";
    let mission = load(&format!("{text}{}", dynamics("disturbance px, py in [-0.2, 0.2] m")));
    // What a separation that leaves the tubes out amounts to.
    let mut believed = mission.problem.clone();
    let width = mission.tubes.values().next().unwrap().state_half_width(0);
    believed.separation = Some(Rational::from_f64(1.4 - 2.0 * width).unwrap());
    assert!(caught(&mission, &believed, &mission.tubes).contains(&Kind::Separation));
}

#[test]
fn hop_levels_that_are_dropped_are_caught() {
    let mission = load(include_str!("missions/unsat/one_hop_short.dosm"));
    let mut believed = mission.problem.clone();
    believed.connectivity.as_mut().unwrap().hops = None;
    assert!(caught(&mission, &believed, &mission.tubes).contains(&Kind::Connectivity));
}

#[test]
fn a_jammer_that_links_may_cross_is_caught() {
    let mission = load(include_str!("missions/solve/relay.dosm"));
    let mut believed = mission.problem.clone();
    for id in believed.blockers.ids() {
        believed.blockers[id].kind = dosmc::ir::BlockerKind::Obstacle;
    }
    let kinds = caught(&mission, &believed, &mission.tubes);
    assert!(kinds.contains(&Kind::Links), "{kinds:?}");
}

#[test]
fn a_loop_that_does_not_close_is_caught() {
    let mission = load(include_str!("missions/solve/patrol.dosm"));
    let (nominal, abstraction) = search(&mission.problem, &mission.tubes);
    let mut nominal = *nominal.unwrap();
    let last = nominal.length;
    // The last input no longer leads back to where the loop begins.
    nominal.inputs[0][last][0] += 0.5;
    let plan = plan::extract(&mission.problem, &mission.tubes, &abstraction, &nominal).unwrap();
    let report = verify(&mission.problem, &plan);
    assert!(report.check(Kind::Tube).is_some_and(|c| !c.holds()), "{report}");
}

/// Errata P14: only an exhausted horizon is 'no plan', and it is so for its own lengths alone.
#[test]
fn erratum_p14_no_plan_is_said_of_exhausted_lengths_only() {
    let mission = load(include_str!("missions/solve/reach.dosm"));
    let (nominal, abstraction) = search(&mission.problem, &mission.tubes);
    let length = nominal.unwrap().length;
    let watch: Arc<dyn Watch> = Arc::new(Patient);
    let short = Options { horizon: (1, length - 1), watch };
    let (outcome, _) = solve::solve(&mission.problem, &mission.tubes, &abstraction, &short);
    assert!(matches!(outcome, Outcome::NoPlan), "{outcome:?}");

    struct Impatience;
    impl Watch for Impatience {
        fn stop(&self) -> bool {
            true
        }
        fn progress(&self, _: &Progress) {}
        fn now(&self) -> Duration {
            Duration::ZERO
        }
    }
    let stopped = Options { horizon: (1, length - 1), watch: Arc::new(Impatience) };
    let (outcome, _) = solve::solve(&mission.problem, &mission.tubes, &abstraction, &stopped);
    assert!(matches!(outcome, Outcome::Unknown(Reason::Stopped)), "{outcome:?}");
}
