//! One test a threat and an erratum against which the checker is the defence.

use dosmc::entity::EntityId;
use dosmc::exact::{Rational, RationalMatrix};
use dosmc::geometry::HalfSpace;
use dosmc::ir::{
    Atom, BlockerKind, Comparison, Connectivity, Enclosure, Formula, Formulas, Goal, Interval, ModelId, Norm,
    Piece, Problem, Range, RegionId, Relation, RobotId,
};
use dosmc::plan::{Apart, Label, Link, Objective, Plan, Separator};
use dosmc::verify::{Kind, verify};

use crate::scene::{RESERVE, Scene, any_hops, boxed, disc, exact, point};

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
fn hovering(places: &[[f64; 2]], with: Scene) -> (Problem, Plan) {
    const NAMES: [&str; 8] = ["R1", "R2", "R3", "R4", "R5", "R6", "R7", "R8"];
    let last = with.theta.len() - 1;
    let robots = places.iter().enumerate().map(|(i, &p)| (NAMES[i], i.min(last), vec![p])).collect();
    Scene { robots, ..with }.build()
}

/// Half the width of the tube's position with Θ = [−1/8, 1/8].
fn half_tube() -> f64 {
    0.125 * 1.5 + RESERVE * 1.5 + RESERVE / 8.0
}

fn vertical(a: f64, offset: f64) -> Separator {
    Separator { piece: 0, normal: vec![a, 0.0], offset }
}

fn robot_atom(robot: usize, region: usize) -> Atom {
    Atom { robot: RobotId::new(robot), region: RegionId::new(region) }
}

/// Makes one formula the only goal.
fn ask(problem: &mut Problem, formula: Formula) {
    let mut formulas = Formulas::new();
    let formula = formulas.intern(formula);
    problem.formulas = formulas;
    problem.goals = vec![Goal { name: "goal".into(), formula }];
}

#[test]
fn the_relay_holds() {
    let (problem, plan) = relay(Scene::default());
    holds(&problem, &plan);
    let report = verify(&problem, &plan);
    assert!(report.same_text);
    assert!(report.check(Kind::Tube).unwrap().margin == Some(0.0), "{report}");
    assert_eq!(report.to_json()["holds"], true);
}

#[test]
fn threat_2_touching_is_in_but_not_out() {
    let h = half_tube();
    let scene =
        |low: f64| Scene { regions: vec![("pi", vec![boxed([low, 1.0], [8.0, 8.0])])], ..Scene::default() };
    let (problem, mut plan) = hovering(&[[4.0, 4.0]], scene(4.0 - h));
    assert_eq!(plan.robots[0].regions["pi"], [Label::In; 2]);
    holds(&problem, &plan);
    // The same contact from outside: the plane would have to pass through both.
    let (problem, _) = hovering(&[[4.0, 4.0]], scene(4.0 + h));
    plan.robots[0].regions.insert("pi".into(), vec![Label::Out; 2]);
    for offset in [4.0 + h, (4.0 + h).next_up(), (4.0 + h).next_down()] {
        plan.robots[0].outside.insert("pi".into(), vec![Some(vec![vertical(1.0, offset)]); 2]);
        refused(&problem, &plan, Kind::Regions);
    }
}

#[test]
fn threat_2_a_base_on_a_jammer_s_edge_has_no_link() {
    let jammer = |low: f64| ("J", BlockerKind::Jammer, vec![boxed([low, 0.0], [8.0, 8.0])]);
    let scene = |low: f64| Scene {
        blockers: vec![jammer(low)],
        bases: vec![("B", [6.0, 4.0])],
        connectivity: Some(any_hops()),
        links: vec![("R1", "B")],
        ..Scene::default()
    };
    let (problem, mut plan) = hovering(&[[2.0, 4.0]], scene(6.5));
    holds(&problem, &plan);
    let (touching, _) =
        Scene { links: vec![], robots: vec![("R1", 0, vec![[2.0, 4.0]])], ..scene(6.0) }.build();
    for step in plan.links.as_mut().unwrap() {
        step[0].separators[0].1 = vertical(1.0, 6.0);
    }
    refused(&touching, &plan, Kind::Links);
}

#[test]
fn erratum_p3_threat_3_the_tube_is_not_reflected() {
    // The tube is off its nominal by 3/32: it reaches 3/8 to the right, 3/16 to the left.
    let theta = vec![[-0.0625, 0.1875]];
    let wall = |low: f64| vec![("W", BlockerKind::Obstacle, vec![boxed([low, 0.0], [low + 1.0, 8.0])])];
    let scene = |low: f64| Scene { blockers: wall(low), theta: theta.clone(), ..Scene::default() };
    let (problem, plan) = hovering(&[[4.0, 4.0]], scene(4.3));
    holds(&problem, &plan);
    let (problem, mut plan) = hovering(&[[4.0, 4.0]], scene(2.9));
    holds(&problem, &plan);
    // With z ⊕ (−Ω) in place of z ⊕ Ω this one would pass.
    let (nearer, _) = hovering(&[[9.0, 4.0]], scene(4.2));
    plan.robots[0].clear.insert("W".into(), vec![vec![vertical(1.0, 4.2)]; 2]);
    refused(&nearer, &plan, Kind::Blockers);
}

#[test]
fn erratum_p11_threat_6_the_start_lies_in_the_tube() {
    let (mut problem, mut plan) = hovering(&[[4.0, 4.0]], Scene::default());
    let corner = |sign: f64| 4.0 + sign * (0.125 + RESERVE);
    for sign in [1.0, -1.0] {
        problem.robots[RobotId::new(0)].start[0] = exact(corner(sign));
        holds(&problem, &plan);
        problem.robots[RobotId::new(0)].start[0] = exact(corner(sign) + sign * 1e-12);
        refused(&problem, &plan, Kind::Start);
    }
    problem.robots[RobotId::new(0)].start[0] = exact(4.0);
    holds(&problem, &plan);
    problem.robots[RobotId::new(0)].start[1] = exact(1e-5);
    refused(&problem, &plan, Kind::Start);
    // A box without 0 doesn't hold the ŵ = 0 that went before the start.
    let (problem, _) = hovering(&[[4.0, 4.0]], Scene { theta: vec![[0.25, 0.5]], ..Scene::default() });
    plan.tubes[0].center = vec![0.375, 0.0, 0.375, 0.0];
    plan.robots[0].z = vec![vec![3.625, 0.0, 3.625, 0.0]; 2];
    refused(&problem, &plan, Kind::Tube);
}

#[test]
fn erratum_p12_threat_7_the_whole_state_repeats() {
    let (problem, plan) = relay(Scene::default());
    // Back at the right place, but with another velocity.
    let mut forged = plan.clone();
    for robot in &mut forged.robots {
        robot.v[7][0] += 0.5;
    }
    refused(&problem, &forged, Kind::Tube);
    // The same states round another loop.
    for loop_start in [0, 1, 3, 4, 5, 6, 7] {
        let mut forged = plan.clone();
        forged.loop_start = loop_start;
        refused(&problem, &forged, Kind::Tube);
    }
    let mut forged = plan.clone();
    forged.loop_start = 8;
    refused(&problem, &forged, Kind::Form);
}

#[test]
fn erratum_p2_an_isolated_robot_reaches_nothing() {
    let scene = Scene {
        bases: vec![("B", [1.0, 1.0])],
        connectivity: Some(any_hops()),
        links: vec![("R1", "B")],
        ..Scene::default()
    };
    let (problem, plan) = hovering(&[[2.0, 2.0]], Scene { links: scene.links.clone(), ..scene });
    holds(&problem, &plan);
    let mut alone = plan.clone();
    alone.links = Some(vec![vec![]; 2]);
    refused(&problem, &alone, Kind::Connectivity);
    alone.links = None;
    refused(&problem, &alone, Kind::Form);
}

const CHAIN: [(&str, &str); 8] = [
    ("R1", "B"),
    ("R2", "R1"),
    ("R3", "R2"),
    ("R4", "R3"),
    ("R5", "R4"),
    ("R6", "R5"),
    ("R7", "R6"),
    ("R8", "R7"),
];

fn line(robots: usize, asked: Connectivity, links: Vec<(&'static str, &'static str)>) -> (Problem, Plan) {
    let places: Vec<[f64; 2]> = (0..robots).map(|i| [2.0 + i as f64, 3.0]).collect();
    let bases = vec![("B", [1.0, 3.0]), ("C", [12.0, 3.0])];
    hovering(&places, Scene { bases, connectivity: Some(asked), links, ..Scene::default() })
}

#[test]
fn erratum_p9_threat_10_a_ring_without_a_base_is_no_connection() {
    for robots in 2..=8 {
        let mut ring = CHAIN[1..robots].to_vec();
        ring.push(("R1", CHAIN[robots - 1].0));
        let (problem, plan) = line(robots, any_hops(), ring.clone());
        refused(&problem, &plan, Kind::Connectivity);
        ring.push(("R2", "C"));
        let (problem, plan) = line(robots, any_hops(), ring);
        holds(&problem, &plan);
    }
}

#[test]
fn threat_11_hops_are_counted_from_the_base() {
    for robots in 1..=8 {
        let links = CHAIN[..robots].to_vec();
        let asked = |hops: usize| Connectivity { hops: Some(hops as u32), ..any_hops() };
        let (problem, plan) = line(robots, asked(robots), links.clone());
        holds(&problem, &plan);
        let (problem, plan) = line(robots, asked(robots - 1), links);
        refused(&problem, &plan, Kind::Connectivity);
    }
}

#[test]
fn redundancy_survives_every_loss() {
    let asked = |redundancy| Connectivity { redundancy, ..any_hops() };
    let chain = CHAIN[..4].to_vec();
    let both_ends = [&chain[..], &[("R4", "C")]].concat();
    let (problem, plan) = line(4, asked(0), chain.clone());
    holds(&problem, &plan);
    let (problem, plan) = line(4, asked(1), chain);
    refused(&problem, &plan, Kind::Connectivity);
    let (problem, plan) = line(4, asked(1), both_ends.clone());
    holds(&problem, &plan);
    // Without R1 and R3, R2 is on its own.
    let (problem, plan) = line(4, asked(2), both_ends.clone());
    refused(&problem, &plan, Kind::Connectivity);
    let more = [&both_ends[..], &[("R2", "C"), ("R3", "B")]].concat();
    let (problem, plan) = line(4, asked(3), more);
    holds(&problem, &plan);
    // More losses than robots: each one alone needs a base of its own.
    let (problem, plan) = line(2, asked(3), vec![("R1", "B"), ("R2", "B")]);
    holds(&problem, &plan);
    let (problem, plan) = line(2, asked(3), vec![("R1", "B"), ("R2", "R1")]);
    refused(&problem, &plan, Kind::Connectivity);
}

#[test]
fn redundancy_counts_hops_after_the_loss() {
    let asked = Connectivity { redundancy: 1, hops: Some(2), ..any_hops() };
    let links = vec![("R1", "B"), ("R2", "R1"), ("R2", "R3"), ("R3", "R4"), ("R4", "B"), ("R3", "B")];
    let (problem, plan) = line(4, asked.clone(), links);
    holds(&problem, &plan);
    let links = vec![("R1", "B"), ("R2", "R1"), ("R2", "R3"), ("R3", "R4"), ("R4", "B"), ("R3", "R1")];
    let (problem, plan) = line(4, asked, links);
    refused(&problem, &plan, Kind::Connectivity);
}

#[test]
fn links_are_needed_at_the_times_of_the_infinite_run() {
    // Eight steps of which the last six repeat: every 4 means 0 in the prefix, then 2, 4, 6.
    let cases = [
        (4, vec![0, 2, 4, 6], true),
        (4, vec![0, 4, 6], false),
        (4, vec![0, 4], false),
        (3, vec![0, 3, 6], true),
        (3, vec![0, 6], false),
        (5, vec![0, 2, 3, 4, 5, 6, 7], true),
        (5, vec![0, 3, 4, 5, 6, 7], false),
        (12, vec![0, 6], true),
        (12, vec![6], false),
        (1, vec![0, 2, 3, 4, 5, 6, 7], false),
    ];
    for (every, at, right) in cases {
        let scene = Scene {
            bases: vec![("B", [1.0, 1.0])],
            robots: vec![("R1", 0, vec![[2.0, 2.0]; 4])],
            loop_place: 1,
            connectivity: Some(Connectivity { every, ..any_hops() }),
            links: vec![("R1", "B")],
            ..Scene::default()
        };
        let (problem, mut plan) = scene.build();
        for (t, links) in plan.links.as_mut().unwrap().iter_mut().enumerate() {
            if !at.contains(&t) {
                links.clear();
            }
        }
        let report = verify(&problem, &plan);
        assert_eq!(report.holds(), right, "every {every} at {at:?}: {report}");
    }
}

#[test]
fn erratum_p10_ranges_have_their_own_norms() {
    // Ends 3 and 4 apart; the base has no tube.
    let h = half_tube();
    let scene = |length: f64, norm: Norm| {
        let range = Some(Range { length: exact(length), norm });
        let connectivity = Some(Connectivity { range, ..any_hops() });
        let bases = vec![("B", [1.0, 1.0])];
        hovering(&[[4.0, 5.0]], Scene { bases, connectivity, links: vec![("R1", "B")], ..Scene::default() })
    };
    let farthest = (3.0 + h).hypot(4.0 + h);
    for (length, norm, right) in [
        (4.0 + h, Norm::Infinity, true),
        (4.0 + h - 1e-12, Norm::Infinity, false),
        (farthest + 1e-12, Norm::Euclidean, true),
        (farthest - 1e-12, Norm::Euclidean, false),
        (4.0 + h, Norm::Euclidean, false),
    ] {
        let (problem, plan) = scene(length, norm);
        let report = verify(&problem, &plan);
        assert_eq!(report.holds(), right, "{length} {norm:?}: {report}");
    }
}

#[test]
fn erratum_p1_no_link_crosses_a_jammer() {
    let scene = |kind| Scene {
        blockers: vec![("J", kind, vec![boxed([5.0, 3.0], [6.0, 5.0]), boxed([5.0, 5.0], [6.0, 8.0])])],
        bases: vec![("B", [9.0, 4.0])],
        connectivity: Some(any_hops()),
        ..Scene::default()
    };
    let (jammed, plan) = hovering(&[[2.0, 4.0]], scene(BlockerKind::Jammer));
    let link = |planes: Vec<Separator>| Link {
        from: "R1".into(),
        to: "B".into(),
        hops: 1,
        separators: planes.into_iter().map(|p| ("J".into(), p)).collect(),
    };
    let with = |planes: Vec<Separator>| Plan { links: Some(vec![vec![link(planes)]; 2]), ..plan.clone() };
    refused(&jammed, &with(vec![]), Kind::Links);
    let slanted = |piece, x: f64, y: f64, offset| Separator { piece, normal: vec![x, y], offset };
    for angle in 0..64 {
        let (y, x) = (f64::from(angle) / 32.0 * std::f64::consts::PI).sin_cos();
        for offset in [x * 5.0 + y * 3.0, x * 6.0 + y * 5.0, x * 2.0 + y * 4.0, x * 9.0 + y * 4.0, 0.0] {
            refused(&jammed, &with(vec![slanted(0, x, y, offset), slanted(1, 0.0, 1.0, 4.7)]), Kind::Links);
        }
    }
    // An obstacle that isn't opaque is no hindrance; an opaque one is.
    let (opaque, _) = hovering(&[[2.0, 4.0]], scene(BlockerKind::OpaqueObstacle));
    refused(&opaque, &with(vec![]), Kind::Links);
    let (clear, _) = hovering(&[[2.0, 4.0]], scene(BlockerKind::Obstacle));
    holds(&clear, &with(vec![]));
}

#[test]
fn erratum_p6_each_end_of_a_link_has_its_own_tube() {
    // The wide tube of R2 reaches 0.75, that of R1 0.1875; the jammer is 0.5 above both.
    let scene = |wide: f64| Scene {
        blockers: vec![("J", BlockerKind::Jammer, vec![boxed([4.0, 4.5], [5.0, 6.0])])],
        bases: vec![("B", [1.0, 1.0])],
        connectivity: Some(any_hops()),
        links: vec![("R1", "B"), ("R2", "R1")],
        theta: vec![[-0.125, 0.125], [-wide, wide]],
        ..Scene::default()
    };
    let (problem, plan) = hovering(&[[2.0, 4.0], [7.0, 4.0]], scene(0.125));
    holds(&problem, &plan);
    let (wider, wide_plan) = hovering(&[[2.0, 4.0], [7.0, 4.0]], Scene { blockers: vec![], ..scene(0.5) });
    let mut forged = Plan { links: plan.links.clone(), ..wide_plan };
    for (robot, with_clear) in forged.robots.iter_mut().zip(&plan.robots) {
        robot.clear = with_clear.clear.clone();
    }
    let wider = Problem { blockers: problem.blockers.clone(), ..wider };
    refused(&wider, &forged, Kind::Links);
}

#[test]
fn erratum_p8_a_base_is_a_point() {
    // Closer to the jammer than any tube: the base's link holds, a robot's there would not.
    let scene = Scene {
        blockers: vec![("J", BlockerKind::Jammer, vec![boxed([4.0, 0.0], [5.0, 6.0])])],
        bases: vec![("B", [3.9990234375, 4.0])],
        connectivity: Some(any_hops()),
        ..Scene::default()
    };
    let (problem, plan) = hovering(&[[2.0, 4.0]], scene);
    let separators = vec![("J".to_string(), vertical(1.0, 4.0))];
    let link = Link { from: "R1".into(), to: "B".into(), hops: 1, separators };
    let with = Plan { links: Some(vec![vec![link.clone()]; 2]), ..plan.clone() };
    holds(&problem, &with);
    // No base links to a base or from one, and no robot to itself.
    for (from, to) in [("B", "R1"), ("B", "B"), ("R1", "R1"), ("R1", "R9")] {
        let other = Link { from: from.into(), to: to.into(), ..link.clone() };
        let forged = Plan { links: Some(vec![vec![link.clone(), other]; 2]), ..plan.clone() };
        refused(&problem, &forged, Kind::Form);
    }
}

#[test]
fn erratum_p4_bounds_hold_with_the_tube() {
    // Brakes and accelerates with 4 m/s², the feedback takes another one.
    let scene = Scene { robots: vec![("R1", 0, vec![[4.0, 4.0], [5.0, 4.0]])], ..Scene::default() };
    let (problem, plan) = scene.build();
    let report = verify(&problem, &plan);
    let margin = report.check(Kind::Inputs).unwrap().margin.unwrap();
    let with_bounds = |input: f64, state: f64| {
        let mut problem = problem.clone();
        let model = &mut problem.models[ModelId::new(0)];
        let interval = |b: f64| Interval { lo: exact(-b), hi: exact(b) };
        model.input_bounds[0] = interval(input);
        model.state_bounds[1] = Some(interval(state));
        problem
    };
    holds(&with_bounds(12.0 - margin, 8.0), &plan);
    refused(&with_bounds(12.0 - margin - 1e-9, 8.0), &plan, Kind::Inputs);
    refused(&with_bounds(4.5, 8.0), &plan, Kind::Inputs);
    // The nominal velocity is 2 m/s at most, its error 1/4.
    holds(&with_bounds(12.0, 2.25 + 4e-6), &plan);
    refused(&with_bounds(12.0, 2.25), &plan, Kind::States);
    refused(&with_bounds(12.0, 2.0), &plan, Kind::States);
}

#[test]
fn bounds_on_states_and_inputs_together_see_one_error() {
    let (mut problem, plan) = hovering(&[[4.0, 4.0]], Scene::default());
    let half_space =
        |normal: [f64; 6], offset: f64| HalfSpace { normal: point(&normal), offset: exact(offset) };
    // a + 3 v + 4 p: the feedback of the latest ŵ cancels, what is left is 4 p₁ + 3 v₁ + a₁ = 0 too.
    let joint = half_space([4.0, 3.0, 0.0, 0.0, 1.0, 0.0], 16.0);
    problem.models[ModelId::new(0)].mixed_bounds = vec![joint.clone()];
    holds(&problem, &plan);
    problem.models[ModelId::new(0)].mixed_bounds = vec![HalfSpace { offset: exact(16.0 - 1e-12), ..joint }];
    refused(&problem, &plan, Kind::Inputs);
    problem.models[ModelId::new(0)].mixed_bounds = vec![half_space([1.0, 0.0, 0.0, 0.0, 0.0, 0.0], 4.1)];
    refused(&problem, &plan, Kind::States);
}

#[test]
fn erratum_p5_separation_holds_with_both_tubes_at_both_ends() {
    let h = half_tube();
    let apart = |gap: f64, separation: f64| {
        let scene = Scene { separation: Some(separation), ..Scene::default() };
        hovering(&[[4.0, 4.0], [4.0 + gap, 4.5]], scene)
    };
    for (gap, separation, right) in [
        (1.0, 1.0 - 2.0 * h, true),
        (1.0, 1.0 - 2.0 * h + 1e-12, false),
        (1.0, 0.99, false),
        (1.0, 1.0, false),
    ] {
        let (problem, plan) = apart(gap, separation);
        let report = verify(&problem, &plan);
        assert_eq!(report.holds(), right, "{gap} {separation}: {report}");
    }
    // They swap sides: every side serves at one end of the step only.
    let scene = Scene {
        robots: vec![("R1", 0, vec![[4.0, 4.0], [4.0, 5.0]]), ("R2", 0, vec![[5.0, 5.0], [5.0, 4.0]])],
        ..Scene::default()
    };
    let (mut problem, plan) = scene.build();
    problem.separation = Some(exact(0.25));
    let pair = ("R1".to_string(), "R2".to_string());
    let by = |axis, sign| Plan {
        separation: vec![vec![Apart { pair: pair.clone(), axis, sign }]; 4],
        ..plan.clone()
    };
    holds(&problem, &by(0, -1));
    for (axis, sign) in [(0, 1), (1, 1), (1, -1)] {
        refused(&problem, &by(axis, sign), Kind::Separation);
    }
    refused(&problem, &by(2, 1), Kind::Form);
    refused(&problem, &by(0, 0), Kind::Form);
    refused(&problem, &by(0, -2), Kind::Form);
    let mut once = by(0, -1);
    once.separation[2].clear();
    refused(&problem, &once, Kind::Separation);
    refused(&problem, &Plan { separation: vec![], ..plan.clone() }, Kind::Separation);
}

#[test]
fn erratum_p13_threat_12_no_wall_is_jumped_and_no_corner_cut() {
    // 20 m in two steps through a wall of 1 cm; both rests are clear of it.
    let wall = vec![("W", BlockerKind::Obstacle, vec![boxed([10.0, 0.0], [10.01, 40.0])])];
    let scene = |blockers| Scene {
        size: 40.0,
        blockers,
        robots: vec![("R1", 0, vec![[2.0, 20.0], [3.0, 20.0]])],
        ..Scene::default()
    };
    let (mut walled, plan) = scene(wall).build();
    holds(&walled, &plan);
    let jump = Scene { robots: vec![("R1", 0, vec![[2.0, 20.0], [22.0, 20.0]])], ..scene(vec![]) };
    let (_, mut forged) = jump.build();
    let model = &mut walled.models[ModelId::new(0)];
    model.input_bounds = vec![Interval { lo: exact(-100.0), hi: exact(100.0) }; 2];
    model.state_bounds = vec![None; 4];
    let (left, right) = (vertical(1.0, 10.0), vertical(-1.0, -10.01));
    for sides in 0..16 {
        let side = |t: usize| vec![if sides >> t & 1 == 1 { left.clone() } else { right.clone() }];
        forged.robots[0].clear.insert("W".into(), (0..4).map(side).collect());
        refused(&walled, &forged, Kind::Blockers);
    }
    // Round a corner: each position is clear of the box, the chord between them is not.
    let corner = Scene {
        blockers: vec![("W", BlockerKind::Obstacle, vec![boxed([4.5, 2.0], [8.0, 5.5])])],
        robots: vec![("R1", 0, vec![[4.0, 4.0]])],
        ..Scene::default()
    };
    let (cornered, _) = corner.build();
    let round = Scene { robots: vec![("R1", 0, vec![[4.0, 4.0], [6.0, 6.0]])], ..Scene::default() };
    let (_, mut forged) = round.build();
    let above = Separator { piece: 0, normal: vec![0.0, -1.0], offset: -5.5 };
    let planes = [vertical(1.0, 4.5), above.clone(), above, vertical(1.0, 4.5)];
    forged.robots[0].clear.insert("W".into(), planes.map(|p| vec![p]).to_vec());
    refused(&cornered, &forged, Kind::Blockers);
}

#[test]
fn threat_18_what_the_matrices_miss_must_fit_into_the_box() {
    let (problem, plan) = hovering(&[[4.0, 4.0]], Scene::default());
    for entry in 0..16 {
        for (gain, by) in [(false, 1e-6), (false, -1e-6), (true, 1e-6), (true, -1e-6)] {
            let mut forged = plan.clone();
            let tube = &mut forged.tubes[0];
            let matrix = if gain { &mut tube.m[1] } else { &mut tube.d[1] };
            let rows = matrix.len();
            matrix[entry / 4 % rows][entry % 4] += by;
            refused(&problem, &forged, Kind::Tube);
            // With room to spare the very same matrices are proved.
            for width in &mut forged.tubes[0].half_width {
                *width += 1e-5;
            }
            holds(&problem, &forged);
        }
    }
    let mut forged = plan.clone();
    forged.tubes[0].reserve[2] = 0.0;
    refused(&problem, &forged, Kind::Tube);
    let mut forged = plan.clone();
    forged.tubes[0].d.truncate(1);
    forged.tubes[0].m.truncate(1);
    refused(&problem, &forged, Kind::Tube);
}

#[test]
fn enclosures_widen_what_the_box_must_hold() {
    let (mut problem, mut plan) = hovering(&[[4.0, 4.0]], Scene::default());
    let zeros = |columns| RationalMatrix::from_element(4, columns, Rational::ZERO);
    let mut enclosure = Enclosure { a: zeros(4), b: zeros(2), c: point(&[0.0; 4]) };
    let model = ModelId::new(0);
    problem.models[model].enclosure = Some(enclosure.clone());
    holds(&problem, &plan);
    // |ΔA| 2⁻²⁰ on the position's own entry: 4·2⁻²⁰ for z, and less than 2⁻²⁰ for the tube.
    enclosure.a[(0, 0)] = exact(RESERVE);
    problem.models[model].enclosure = Some(enclosure);
    refused(&problem, &plan, Kind::Tube);
    plan.tubes[0].half_width[0] += 4.0 * RESERVE;
    refused(&problem, &plan, Kind::Tube);
    plan.tubes[0].half_width[0] += RESERVE;
    holds(&problem, &plan);
    for (part, index) in [("b", 0), ("c", 0)] {
        let mut open = Enclosure { a: zeros(4), b: zeros(2), c: point(&[0.0; 4]) };
        if part == "b" {
            open.b[(1, index)] = exact(1e-5);
        } else {
            open.c[1] = exact(1e-5);
        }
        problem.models[model].enclosure = Some(open);
        refused(&problem, &plan, Kind::Tube);
    }
}

#[test]
fn threat_20_no_tube_fits_into_a_region_narrower_than_itself() {
    let region = |width: f64| vec![("pi", vec![boxed([4.0 - width, 1.0], [4.0 + width, 8.0])])];
    for steps in -8..=8 {
        let width = half_tube() + f64::from(steps) * 1e-9;
        let (problem, mut plan) =
            hovering(&[[4.0, 4.0]], Scene { regions: region(width), ..Scene::default() });
        plan.robots[0].regions.insert("pi".into(), vec![Label::In; 2]);
        plan.robots[0].outside.insert("pi".into(), vec![None; 2]);
        let report = verify(&problem, &plan);
        assert_eq!(report.holds(), steps >= 0, "{steps}: {report}");
    }
}

#[test]
fn a_union_holds_a_tube_only_in_one_piece() {
    let halves = vec![boxed([2.0, 2.0], [4.0, 6.0]), boxed([4.0, 2.0], [6.0, 6.0])];
    let scene = Scene { regions: vec![("pi", halves)], ..Scene::default() };
    let (mut problem, mut plan) = hovering(&[[4.0, 4.0]], scene);
    assert_eq!(plan.robots[0].regions["pi"], [Label::Unknown; 2]);
    holds(&problem, &plan);
    ask(&mut problem, Formula::In(robot_atom(0, 0)));
    refused(&problem, &plan, Kind::Goals);
    plan.robots[0].regions.insert("pi".into(), vec![Label::In; 2]);
    refused(&problem, &plan, Kind::Regions);
}

#[test]
fn erratum_p7_unknown_is_neither_in_nor_out() {
    let scene = Scene { regions: vec![("pi", vec![boxed([4.0, 2.0], [6.0, 6.0])])], ..Scene::default() };
    let (mut problem, mut plan) = hovering(&[[4.0, 4.0]], scene);
    for formula in [Formula::In(robot_atom(0, 0)), Formula::Out(robot_atom(0, 0))] {
        ask(&mut problem, formula);
        refused(&problem, &plan, Kind::Goals);
    }
    // A region left out counts as unknown; its witnesses alone are not enough.
    plan.robots[0].regions.clear();
    refused(&problem, &plan, Kind::Goals);
    let compare = |relation, bound| {
        Formula::Compare(Comparison { terms: vec![(robot_atom(0, 0), 1)], relation, bound })
    };
    ask(&mut problem, compare(Relation::AtMost, 1));
    holds(&problem, &plan);
    for (relation, bound) in
        [(Relation::AtMost, 0), (Relation::AtLeast, 1), (Relation::Equal, 0), (Relation::Equal, 1)]
    {
        ask(&mut problem, compare(relation, bound));
        refused(&problem, &plan, Kind::Goals);
    }
}

#[test]
fn threat_4_the_disc_is_the_true_disc() {
    // A tube of zero width would be no tube: 2⁻²⁰ is what is left of it.
    let theta = vec![[0.0, 0.0]];
    for step in 0..48 {
        let angle = f64::from(step) * std::f64::consts::TAU / 48.0;
        let (y, x) = angle.sin_cos();
        for (radius, right) in [(1.0 - 1e-5, true), (1.0 - 1e-12, false), (1.0, false), (1.0 + 1e-12, false)]
        {
            let disc = disc([8.0, 8.0], radius);
            let scene = Scene {
                blockers: vec![("J", BlockerKind::Jammer, vec![disc])],
                theta: theta.clone(),
                ..Scene::default()
            };
            let robot = [8.0 + x, 8.0 + y];
            let (problem, _) = Scene { robots: vec![("R1", 0, vec![[1.0, 1.0]])], ..scene }.build();
            let (mut problem, mut plan) =
                (problem, hovering(&[robot], Scene { theta: theta.clone(), ..Scene::default() }).1);
            problem.robots[RobotId::new(0)].start = point(&[robot[0], 0.0, robot[1], 0.0]);
            let offset = -(x * 8.0 + y * 8.0) - (1.0 - 5e-6);
            let plane = Separator { piece: 0, normal: vec![-x, -y], offset };
            plan.robots[0].clear.insert("J".into(), vec![vec![plane]; 2]);
            let report = verify(&problem, &plan);
            assert_eq!(report.holds(), right, "{angle} {radius}: {report}");
        }
    }
}

#[test]
fn uncertain_balls_count_in_every_place() {
    let spread =
        |s: f64| Piece::Ball { center: point(&[8.0, 8.0]), spread: point(&[s, 0.0]), radius: exact(1.0) };
    for (s, right) in [(0.0, true), (0.5, true), (0.8, false), (3.0, false)] {
        let certain = Scene {
            blockers: vec![("J", BlockerKind::Jammer, vec![spread(0.0)])],
            regions: vec![("pi", vec![disc([4.0, 4.0], 1.0)])],
            ..Scene::default()
        };
        let (mut problem, mut plan) = hovering(&[[6.0, 8.0]], certain);
        problem.blockers[dosmc::ir::BlockerId::new(0)].shape.pieces = vec![spread(s)];
        plan.robots[0].clear.insert("J".into(), vec![vec![vertical(1.0, 6.25)]; 2]);
        let report = verify(&problem, &plan);
        assert_eq!(report.holds(), right, "{s}: {report}");
    }
    // In a disc that may be elsewhere: in it wherever it is.
    for (s, right) in [(0.0, true), (0.5, true), (0.85, false)] {
        let scene = Scene { regions: vec![("pi", vec![disc([4.0, 4.0], 1.0)])], ..Scene::default() };
        let (mut problem, plan) = hovering(&[[4.0, 4.0]], scene);
        assert_eq!(plan.robots[0].regions["pi"], [Label::In; 2]);
        problem.regions[RegionId::new(0)].shape.pieces =
            vec![Piece::Ball { center: point(&[4.0, 4.0]), spread: point(&[s, 0.0]), radius: exact(1.0) }];
        let report = verify(&problem, &plan);
        assert_eq!(report.holds(), right, "{s}: {report}");
    }
}

#[test]
fn threat_26_a_plan_of_another_mission_is_refused() {
    let (problem, plan) = relay(Scene::default());
    let refused_with = |forge: &dyn Fn(&mut Plan), kind| {
        let mut forged = plan.clone();
        forge(&mut forged);
        refused(&problem, &forged, kind);
    };
    refused_with(&|p| p.mission.name.push('x'), Kind::Mission);
    refused_with(&|p| drop(p.mission.set.insert("radius".into(), "1.50".into())), Kind::Mission);
    refused_with(&|p| p.mission.set.clear(), Kind::Mission);
    refused_with(&|p| p.step_s = p.step_s.next_up(), Kind::Mission);
    refused_with(&|p| p.step_s = f64::NAN, Kind::Mission);
    refused_with(&|p| p.length = 0, Kind::Form);
    refused_with(&|p| p.length = usize::MAX, Kind::Form);
    refused_with(&|p| drop(p.robots.pop()), Kind::Form);
    refused_with(&|p| p.robots.push(p.robots[0].clone()), Kind::Form);
    refused_with(&|p| p.robots[1] = p.robots[0].clone(), Kind::Form);
    refused_with(&|p| p.robots[0].dynamics = "Rover1".into(), Kind::Form);
    refused_with(&|p| p.tubes.swap_remove(0).center.clear(), Kind::Form);
    refused_with(&|p| p.tubes[1].dynamics = "Rover0".into(), Kind::Form);
    refused_with(&|p| p.robots[0].z[3][2] = f64::INFINITY, Kind::Form);
    refused_with(&|p| p.tubes[0].m[1][0][0] = f64::NAN, Kind::Form);
    refused_with(&|p| drop(p.robots[0].clear.remove("wall")), Kind::Form);
    refused_with(&|p| drop(p.robots[0].clear.insert("J9".into(), vec![])), Kind::Form);
    refused_with(&|p| drop(p.robots[0].regions.insert("pi9".into(), vec![])), Kind::Form);
    refused_with(&|p| p.robots[0].clear.get_mut("J1").unwrap()[2][1].piece = 2, Kind::Form);
    refused_with(&|p| p.robots[0].clear.get_mut("J1").unwrap()[2][1].normal.push(0.0), Kind::Form);
    refused_with(&|p| drop(p.robots[0].clear.get_mut("J1").unwrap()[2].pop()), Kind::Blockers);
    let mut other_text = plan.clone();
    other_text.mission.sha256 = "11".into();
    let report = verify(&problem, &other_text);
    assert!(report.holds() && !report.same_text);
}

#[test]
fn the_horizon_is_no_part_of_the_check() {
    let (mut problem, plan) = relay(Scene::default());
    problem.horizon = (50, 60);
    holds(&problem, &plan);
}

#[test]
fn the_objective_s_value_is_computed_again() {
    let (mut problem, mut plan) = relay(Scene::default());
    let claim =
        |kind: &str, value: f64| Some(Objective { kind: kind.into(), value, bound: 0.0, proved: true });
    plan.objective = claim("effort", 1.0);
    refused(&problem, &plan, Kind::Objective);
    let effort: f64 = plan.robots.iter().flat_map(|r| r.v.iter().flatten()).map(|v| v * v).sum();
    for (objective, kind, value) in
        [(dosmc::ir::Objective::Effort, "effort", effort), (dosmc::ir::Objective::Length, "length", 5.5)]
    {
        problem.objective = Some(objective);
        plan.objective = claim(kind, value);
        holds(&problem, &plan);
        plan.objective = claim(kind, value * (1.0 - 1e-6));
        refused(&problem, &plan, Kind::Objective);
        plan.objective = claim("other", value);
        refused(&problem, &plan, Kind::Objective);
        plan.objective = claim(kind, f64::NAN);
        refused(&problem, &plan, Kind::Objective);
    }
}

#[test]
fn a_report_lists_some_failures_and_counts_all() {
    let (problem, mut plan) = relay(Scene::default());
    for robot in &mut plan.robots {
        for planes in robot.clear.values_mut().chain(std::iter::empty()) {
            for plane in planes.iter_mut().flatten() {
                plane.offset = -1e3;
            }
        }
        robot.outside.values_mut().flatten().flatten().flatten().for_each(|plane| plane.offset = -1e3);
    }
    let report = verify(&problem, &plan);
    assert_eq!(report.failures.len(), 100);
    assert!(report.to_string().contains("more"), "{report}");
    assert!(report.to_string().ends_with("the plan does not hold"), "{report}");
}
