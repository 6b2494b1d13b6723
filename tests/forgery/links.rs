//! Connectivity: every link safe and short enough, every robot at a base.

use dosmc::ir::{BlockerKind, Connectivity, Norm, Problem, Range};
use dosmc::plan::{Link, Plan, Separator};
use dosmc::verify::{Kind, verify};

use crate::cases::{half_tube, holds, hovering, refused, vertical};
use crate::scene::{Scene, any_hops, boxed, exact};

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
