//! What the tests start from: a mission with a bit of everything, robots that hover, verdicts.

use dosmc::entity::EntityId;
use dosmc::ir::{Atom, BlockerKind, Formula, Formulas, Goal, Problem, RegionId, RobotId};
use dosmc::plan::{Plan, Separator};
use dosmc::verify::{Kind, verify};

use crate::scene::{RESERVE, Scene, any_hops, boxed, disc};

/// A relay: R2 works behind a jammer, R1 stays where both it and the base can be seen.
pub fn relay(with: Scene) -> (Problem, Plan) {
    let scene = Scene {
        blockers: vec![
            ("J1", BlockerKind::Jammer, vec![boxed([6.0, 0.0], [7.0, 5.0]), disc([6.5, 5.0], 0.5)]),
            ("wall", BlockerKind::Obstacle, vec![boxed([2.0, 9.0], [14.0, 9.25])]),
        ],
        regions: vec![
            ("pi1", vec![boxed([9.0, 2.0], [11.0, 4.0]), boxed([12.0, 12.0], [13.0, 13.0])]),
            ("pi2", vec![disc([9.0, 6.0], 1.0)]),
        ],
        bases: vec![("B1", [1.0, 1.0])],
        robots: vec![
            ("R1", 0, vec![[5.0, 8.25], [5.0, 8.25], [5.5, 8.25], [5.5, 8.25]]),
            ("R2", 1, vec![[9.0, 6.0], [9.5, 4.0], [10.0, 3.25], [10.0, 4.5]]),
        ],
        loop_place: 1,
        separation: Some(1.0),
        connectivity: Some(any_hops()),
        links: vec![("R1", "B1"), ("R2", "R1")],
        theta: vec![[-0.125, 0.125], [-0.0625, 0.1875]],
        ..with
    };
    let (mut problem, plan) = scene.build();
    let atom =
        |robot: usize, region: usize| Atom { robot: RobotId::new(robot), region: RegionId::new(region) };
    let mut f = Formulas::new();
    let (yes, no) = (f.intern(Formula::True), f.intern(Formula::False));
    let sample = f.intern(Formula::In(atom(1, 0)));
    let often = f.intern(Formula::Until(None, yes, sample));
    let always = f.intern(Formula::Release(None, no, often));
    let out = f.intern(Formula::Out(atom(0, 0)));
    let never = f.intern(Formula::Release(None, no, out));
    let start = f.intern(Formula::In(atom(1, 1)));
    problem.formulas = f;
    problem.goals = [("sample", always), ("keep_out", never), ("start", start)]
        .map(|(name, formula)| Goal { name: name.into(), formula })
        .to_vec();
    (problem, plan)
}

#[track_caller]
pub fn holds(problem: &Problem, plan: &Plan) {
    let report = verify(problem, plan);
    assert!(report.holds(), "{report}");
}

/// The plan must be refused, for this kind of reason among others.
#[track_caller]
pub fn refused(problem: &Problem, plan: &Plan, kind: Kind) {
    let report = verify(problem, plan);
    assert!(!report.holds(), "accepted: {report}");
    assert!(report.failures.iter().any(|f| f.check == kind), "refused otherwise: {report}");
}

/// Robots that stay where they are, for good.
pub fn hovering(places: &[[f64; 2]], with: Scene) -> (Problem, Plan) {
    const NAMES: [&str; 8] = ["R1", "R2", "R3", "R4", "R5", "R6", "R7", "R8"];
    let last = with.theta.len() - 1;
    let robots = places.iter().enumerate().map(|(i, &p)| (NAMES[i], i.min(last), vec![p])).collect();
    Scene { robots, ..with }.build()
}

/// Half the width of the tube's position with Θ = [−1/8, 1/8].
pub fn half_tube() -> f64 {
    0.125 * 1.5 + RESERVE * 1.5 + RESERVE / 8.0
}

pub fn vertical(a: f64, offset: f64) -> Separator {
    Separator { piece: 0, normal: vec![a, 0.0], offset }
}

pub fn robot_atom(robot: usize, region: usize) -> Atom {
    Atom { robot: RobotId::new(robot), region: RegionId::new(region) }
}

/// Makes one formula the only goal.
pub fn ask(problem: &mut Problem, formula: Formula) {
    let mut formulas = Formulas::new();
    let formula = formulas.intern(formula);
    problem.formulas = formulas;
    problem.goals = vec![Goal { name: "goal".into(), formula }];
}
