//! Regions, blockers and what makes a plan one of its mission.

use dosmc::entity::EntityId;
use dosmc::ir::{BlockerKind, Comparison, Formula, Interval, ModelId, Piece, RegionId, Relation, RobotId};
use dosmc::plan::{Label, Plan, Separator};
use dosmc::verify::{Kind, verify};

use crate::cases::{ask, half_tube, holds, hovering, refused, relay, robot_atom, vertical};
use crate::scene::{Scene, boxed, disc, exact, point};

#[test]
fn the_relay_holds() {
    let (problem, plan) = relay(Scene::default());
    holds(&problem, &plan);
    let report = verify(&problem, &plan);
    assert!(report.same_text);
    assert!(report.check(Kind::Tube).unwrap().margin == Some(0.0), "{report}");
    assert!(report.to_json().holds);
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
    refused_with(&|p| p.robots[0].z.push(vec![5.0, 0.0, 8.25, 0.0]), Kind::Form);
    refused_with(&|p| drop(p.robots[0].z.pop()), Kind::Form);
    refused_with(&|p| drop(p.robots[0].v.pop()), Kind::Form);
    refused_with(&|p| p.robots[0].v[0].push(0.0), Kind::Form);
    refused_with(&|p| drop(p.links.as_mut().unwrap().pop()), Kind::Form);
    refused_with(&|p| drop(p.separation.pop()), Kind::Form);
    refused_with(&|p| p.robots[0].regions.get_mut("pi1").unwrap().truncate(3), Kind::Form);
    refused_with(&|p| p.robots[0].regions.get_mut("pi1").unwrap()[1] = Label::Unknown, Kind::Regions);
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
