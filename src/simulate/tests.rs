//! Scenes whose distances are known, held against what the inspector says of them.

use std::collections::BTreeMap;

use super::inspect::Inspector;
use super::pushes::Lasso;
use super::world::World;
use super::*;
use crate::entity::EntityId;
use crate::ir::sample::{box_shape, disc, empty, exact, integrators, point};
use crate::ir::{
    Atom, Base, Blocker, BlockerKind, Connectivity, Formula, Goal, Norm, Range, Region, RegionId, Robot,
    RobotId,
};
use crate::plan::{Label, Link, Mission, RobotPlan, Tube};

/// Robots that stand still at these places, in a workspace of ±12 m, linked in a chain to a base at the
/// first of `bases`; nothing keeps anything apart, so that the inspector has to look at everything.
fn standing(
    places: &[[f64; 2]],
    blockers: &[(BlockerKind, crate::ir::Shape)],
    base: Option<[f64; 2]>,
) -> (Problem, Plan) {
    let mut problem = empty(vec![integrators(2, 4.0, &[4.0])], 12.0);
    let model = problem.robots[RobotId::new(0)].model;
    problem.robots = places
        .iter()
        .enumerate()
        .map(|(i, [x, y])| Robot {
            name: format!("R{i}"),
            doc: String::new(),
            model,
            start: point(&[*x, 0.0, *y, 0.0]),
        })
        .collect();
    for (i, (kind, shape)) in blockers.iter().enumerate() {
        problem.blockers.push(Blocker {
            name: format!("K{i}"),
            doc: String::new(),
            kind: *kind,
            shape: shape.clone(),
        });
    }
    let mut links = None;
    if let Some(base) = base {
        problem.bases.push(Base { name: "B".into(), doc: String::new(), position: point(&base) });
        problem.connectivity = Some(Connectivity { hops: None, range: None, redundancy: 0, every: 1 });
        let to = |i: usize| i.checked_sub(1).map_or_else(|| "B".to_string(), |before| format!("R{before}"));
        let link = |i: usize| Link { from: format!("R{i}"), to: to(i), hops: i + 1, separators: Vec::new() };
        links = Some(vec![(0..places.len()).map(link).collect(); 2]);
    }
    let robot = |(i, [x, y]): (usize, &[f64; 2])| RobotPlan {
        name: format!("R{i}"),
        dynamics: "Rover".into(),
        z: vec![vec![*x, 0.0, *y, 0.0]; 2],
        v: vec![vec![0.0, 0.0]; 2],
        regions: BTreeMap::new(),
        outside: BTreeMap::new(),
        clear: BTreeMap::new(),
    };
    let plan = Plan {
        tool: String::new(),
        mission: Mission { name: "test".into(), sha256: String::new(), set: BTreeMap::new() },
        step_s: 0.5,
        length: 1,
        loop_start: 1,
        tubes: vec![Tube {
            dynamics: "Rover".into(),
            center: vec![0.0; 4],
            half_width: vec![0.2, 0.0, 0.2, 0.0],
            reserve: vec![0.0; 4],
            d: vec![(0..4).map(|i| (0..4).map(|j| if i == j { 1.0 } else { 0.0 }).collect()).collect()],
            m: vec![vec![vec![0.0; 4]; 2]],
        }],
        robots: places.iter().enumerate().map(robot).collect(),
        links,
        separation: Vec::new(),
        objective: None,
    };
    (problem, plan)
}

/// What is found when the robots go along these ways, without inputs and with quiet monitors.
fn found(problem: &Problem, plan: &Plan, ways: &[&[[f64; 2]]]) -> Findings {
    let lasso = Lasso { last: plan.length, loop_start: plan.loop_start, memory: 1 };
    let world = World::new(problem, plan, lasso).expect("a plan of this problem");
    let way = |places: &&[[f64; 2]]| {
        let mut way = Way::new(4, 2, places.len());
        way.states = places.iter().flat_map(|[x, y]| [*x, 0.0, *y, 0.0]).collect();
        way
    };
    let mut inspector = Inspector::new(&world);
    inspector.inspect(0, &ways.iter().map(way).collect::<Vec<_>>());
    inspector.take()
}

fn margin(findings: &Findings, kind: Kind) -> f64 {
    findings.samples.least(kind).map_or(f64::INFINITY, |least| least.margin)
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-12
}

#[test]
fn a_robot_beside_things_has_the_margins_that_are_known() {
    let square = (BlockerKind::Obstacle, box_shape(&[-2.0, -2.0], &[0.0, 0.0]));
    let (problem, plan) =
        standing(&[[3.0, 4.0]], &[square, (BlockerKind::Jammer, disc(&[11.0, 10.0], 1.0))], None);
    let still = [[3.0, 4.0]; 3];
    let findings = found(&problem, &plan, &[&still]);
    assert!(near(margin(&findings, Kind::Blocker), 5.0), "the corner of the square is 3 and 4 m away");
    assert!(near(margin(&findings, Kind::Workspace), 8.0));
    assert_eq!(findings.samples.all_shortfalls() + findings.between.all_shortfalls(), 0);
    // Through the disc between two samples that are both outside, straight through its middle.
    let through = [[8.0, 10.0], [14.0, 10.0]];
    let findings = found(&problem, &plan, &[&through]);
    assert!(near(margin(&findings, Kind::Blocker), 2.0));
    assert!(near(margin(&findings, Kind::Workspace), -2.0));
    let between = findings.between.least(Kind::Blocker).expect("it was looked at");
    assert!(near(between.margin, -1.0) && between.spot.eighths == 4, "{between:?}");
    assert_eq!(findings.between.shortfalls(Kind::Blocker), 3, "at the eighths 3, 4 and 5");
}

#[test]
fn two_robots_are_apart_along_their_farthest_axis() {
    let (mut problem, plan) = standing(&[[0.0, 0.0], [3.0, 1.0]], &[], None);
    problem.separation = Some(exact(0.5));
    let findings = found(&problem, &plan, &[&[[0.0, 0.0]; 2], &[[3.0, 1.0]; 2]]);
    assert!(near(margin(&findings, Kind::Separation), 2.5));
    let swap = found(&problem, &plan, &[&[[0.0, 0.0], [4.0, 0.0]], &[[4.0, 0.0], [0.0, 0.0]]]);
    assert!(near(margin(&swap, Kind::Separation), 3.5));
    let between = swap.between.least(Kind::Separation).expect("it was looked at");
    assert!(near(between.margin, -0.5) && between.spot.eighths == 4, "{between:?}");
}

#[test]
fn links_pass_jammers_at_their_true_distance() {
    let jammer = (BlockerKind::Jammer, disc(&[0.0, 2.0], 1.0));
    let clear = (BlockerKind::Obstacle, box_shape(&[-1.0, -1.0], &[1.0, 1.0]));
    let (mut problem, plan) = standing(&[[-4.0, 0.0], [4.0, 0.0]], &[jammer, clear], Some([-4.0, -6.0]));
    problem.connectivity.as_mut().expect("links").range =
        Some(Range { length: exact(9.0), norm: Norm::Euclidean });
    let [left, right] = [[[-4.0, 0.0]; 2], [[4.0, 0.0]; 2]];
    let findings = found(&problem, &plan, &[&left, &right]);
    assert!(near(margin(&findings, Kind::Link), 1.0), "links pass obstacles that are not opaque");
    assert!(near(margin(&findings, Kind::Range), 1.0));
    assert_eq!(findings.samples.all_shortfalls(), 0);
    // A metre further up the link grazes the disc, 1.5 m up it crosses it.
    let up = |y: f64| [[[-4.0, y]; 2], [[4.0, y]; 2]];
    let [a, b] = up(1.5);
    let cut = found(&problem, &plan, &[&a, &b]);
    assert!(near(margin(&cut, Kind::Link), -0.5));
    assert_eq!(cut.samples.shortfalls(Kind::Link), 2);
    assert_eq!(cut.samples.shortfalls(Kind::Connectivity), 2, "and the second robot has no other way");
    assert_eq!(cut.unreported, 4, "no monitor had said anything");
    let [a, b] = up(0.9);
    assert_eq!(found(&problem, &plan, &[&a, &b]).samples.all_shortfalls(), 0);
}

#[test]
fn a_link_that_is_lost_matters_only_where_it_is_needed() {
    let jammer = (BlockerKind::Jammer, disc(&[0.0, 2.0], 1.0));
    let (mut problem, mut plan) = standing(&[[-4.0, 2.0], [4.0, 2.0]], &[jammer], Some([0.0, -6.0]));
    // Besides the chain both have a link of their own to the base.
    let link = |from: &str| Link { from: from.into(), to: "B".into(), hops: 1, separators: Vec::new() };
    plan.links = Some(vec![vec![link("R0"), link("R1"), Link { to: "R0".into(), ..link("R1") }]; 2]);
    let ways: [&[[f64; 2]]; 2] = [&[[-4.0, 2.0]; 2], &[[4.0, 2.0]; 2]];
    let connectivity = |problem: &Problem, plan: &Plan| {
        let samples = found(problem, plan, &ways).samples;
        (samples.shortfalls(Kind::Link), samples.shortfalls(Kind::Connectivity))
    };
    assert_eq!(connectivity(&problem, &plan), (2, 0));
    problem.connectivity.as_mut().expect("links").redundancy = 1;
    assert_eq!(connectivity(&problem, &plan), (2, 0), "each reaches the base alone");
    // Now one link to the base is gone: without the other robot, or in one hop, it is not enough.
    plan.links = Some(vec![vec![link("R0"), Link { to: "R0".into(), ..link("R1") }]; 2]);
    assert_eq!(connectivity(&problem, &plan), (2, 2));
    problem.connectivity.as_mut().expect("links").every = 2;
    assert_eq!(connectivity(&problem, &plan), (2, 1), "asked at even samples only");
}

#[test]
fn who_is_lost_relays_for_nobody() {
    let jammer = (BlockerKind::Jammer, disc(&[1.5, -3.0], 0.25));
    let places = [[-3.0, 0.0], [3.0, 0.0], [-9.0, 0.0]];
    let (mut problem, mut plan) = standing(&places, &[jammer], Some([0.0, -6.0]));
    let link =
        |from: &str, to: &str| Link { from: from.into(), to: to.into(), hops: 1, separators: Vec::new() };
    let all = [("R2", "B"), ("R0", "B"), ("R2", "R0"), ("R1", "R0"), ("R1", "B")].map(|(a, b)| link(a, b));
    plan.links = Some(vec![all.to_vec(); 2]);
    let ways = places.map(|place| [place; 2]);
    let ways: Vec<&[[f64; 2]]> = ways.iter().map(|way| &way[..]).collect();
    for (redundancy, cut_off) in [(0, 0), (1, 2)] {
        // The last link is cut. Without R0, which R2 still has a link to, R1 has nobody.
        problem.connectivity.as_mut().expect("links").redundancy = redundancy;
        let samples = found(&problem, &plan, &ways).samples;
        assert_eq!(samples.shortfalls(Kind::Link), 2);
        assert_eq!(samples.shortfalls(Kind::Connectivity), cut_off, "{redundancy} lost");
    }
}

#[test]
fn labels_and_goals_are_those_of_real_positions() {
    let (mut problem, mut plan) = standing(&[[0.0, 0.0]], &[], None);
    let shape = box_shape(&[-1.0, -1.0], &[1.0, 1.0]);
    problem.regions.push(Region { name: "home".into(), doc: String::new(), shape, sure: None });
    let atom = Atom { robot: RobotId::new(0), region: RegionId::new(0) };
    let (home, yes, no) = (
        problem.formulas.intern(Formula::In(atom)),
        problem.formulas.intern(Formula::True),
        problem.formulas.intern(Formula::False),
    );
    let eventually = problem.formulas.intern(Formula::Until(None, yes, home));
    let again = problem.formulas.intern(Formula::Release(None, no, eventually));
    problem.goals = vec![Goal { name: "again".into(), formula: again }];
    plan.robots[0].regions.insert("home".into(), vec![Label::In, Label::Unknown]);
    // The loop is the last sample alone.
    let home_at_last = found(&problem, &plan, &[&[[0.25, 0.0], [3.0, 0.0], [0.5, 0.0]]]);
    assert!(near(margin(&home_at_last, Kind::Region), 0.75), "only the first sample has a label");
    assert_eq!(home_at_last.samples.all_shortfalls(), 0);
    let away_at_last = found(&problem, &plan, &[&[[2.0, 0.0], [0.0, 0.0], [3.0, 0.0]]]);
    assert!(near(margin(&away_at_last, Kind::Region), -1.0));
    assert_eq!(away_at_last.samples.shortfalls(Kind::Goal), 1);
    plan.robots[0].regions.insert("home".into(), vec![Label::Out, Label::Unknown]);
    let out = found(&problem, &plan, &[&[[4.0, 5.0], [0.0, 0.0], [0.0, 0.0]]]);
    assert!(near(margin(&out, Kind::Region), 5.0), "the corner is 3 and 4 m away");
}

#[test]
fn bounds_are_shares_of_half_their_range() {
    let (problem, plan) = standing(&[[0.0, 0.0]], &[], None);
    let lasso = Lasso { last: 1, loop_start: 1, memory: 1 };
    let world = World::new(&problem, &plan, lasso).expect("a plan of this problem");
    let mut way = Way::new(4, 2, 2);
    // Velocities within ±4, inputs within ±4.
    way.states = vec![0.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0, -5.0];
    way.inputs = vec![0.0, 0.0, 1.0, -2.0];
    let mut inspector = Inspector::new(&world);
    inspector.inspect(0, &[way]);
    let findings = inspector.take();
    assert!(near(margin(&findings, Kind::State), -0.25) && near(margin(&findings, Kind::Input), 0.5));
    let least = findings.samples.least(Kind::State).expect("it was looked at");
    assert_eq!((least.spot.sample, least.spot.against), (1, Against::State(3)));
    assert_eq!((findings.samples.shortfalls(Kind::State), findings.runs_with_violation), (1, 1));
}

#[test]
fn bounds_on_the_way_never_hide_anything() {
    // The same run, once with planes that let most be skipped, once without any.
    let jammer = (BlockerKind::Jammer, box_shape(&[0.0, 3.0], &[2.0, 5.0]));
    let (problem, bare) = standing(&[[-4.0, 0.0], [4.0, 0.0]], &[jammer], Some([0.0, -6.0]));
    let mut aided = bare.clone();
    let plane = crate::plan::Separator { piece: 0, normal: vec![0.0, 2.0], offset: 6.0 };
    for robot in &mut aided.robots {
        robot.clear.insert("K0".into(), vec![vec![plane.clone()]; 2]);
    }
    for link in aided.links.iter_mut().flatten().flatten() {
        link.separators = vec![("K0".into(), plane.clone())];
    }
    let mut stream = Stream::new(7, 7);
    for _ in 0..300 {
        let mut way = || -> Vec<[f64; 2]> {
            (0..6).map(|_| [6.0 * stream.symmetric(), 4.0 * stream.symmetric()]).collect()
        };
        let (a, b) = (way(), way());
        let [all, some] = [&bare, &aided].map(|plan| found(&problem, plan, &[&a, &b]));
        assert_eq!(all, some, "{a:?} {b:?}");
    }
}
