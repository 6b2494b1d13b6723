//! The tube itself, and what must hold with it: bounds, separation, start and loop.

use dosmc::entity::EntityId;
use dosmc::exact::{Rational, RationalMatrix};
use dosmc::geometry::HalfSpace;
use dosmc::ir::{Enclosure, Interval, ModelId, RobotId};
use dosmc::plan::{Apart, Objective, Plan};
use dosmc::verify::{Kind, verify};

use crate::cases::{half_tube, holds, hovering, refused, relay};
use crate::scene::{RESERVE, Scene, exact, point};

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
fn erratum_p5_a_side_serves_until_the_next_step() {
    // R2 goes round R1's corner: along x they are apart up to step 1, along y from there on.
    let scene = Scene {
        robots: vec![("R1", 0, vec![[4.0, 4.0]; 2]), ("R2", 0, vec![[6.0, 4.0], [4.0, 6.0]])],
        ..Scene::default()
    };
    let (mut problem, plan) = scene.build();
    problem.separation = Some(exact(0.5));
    let with = |axes: [usize; 4]| {
        let side = |axis| vec![Apart { pair: ("R2".into(), "R1".into()), axis, sign: 1 }];
        Plan { separation: axes.map(side).to_vec(), ..plan.clone() }
    };
    holds(&problem, &with([0, 1, 1, 0]));
    refused(&problem, &with([0, 0, 1, 0]), Kind::Separation);
    refused(&problem, &with([0, 1, 1, 1]), Kind::Separation);
}

#[test]
fn threat_6_the_start_is_measured_from_the_box_s_own_centre() {
    let (mut problem, plan) =
        hovering(&[[4.0, 4.0]], Scene { theta: vec![[-0.0625, 0.1875]], ..Scene::default() });
    for (offset, right) in [(0.1875, true), (-0.0625, true), (0.1876, false), (-0.0626, false)] {
        problem.robots[RobotId::new(0)].start[0] = exact(4.0 + offset);
        assert_eq!(verify(&problem, &plan).holds(), right, "{offset}");
    }
}

#[test]
fn the_tube_starts_with_the_disturbance_itself() {
    // Half of every matrix satisfies the recursion just as well, for an error half the true one.
    let (problem, mut plan) = hovering(&[[4.0, 4.0]], Scene::default());
    let tube = &mut plan.tubes[0];
    for x in tube.d.iter_mut().chain(&mut tube.m).flatten().flatten() {
        *x /= 2.0;
    }
    refused(&problem, &plan, Kind::Tube);
}

#[test]
fn the_workspace_holds_the_tube() {
    let h = half_tube();
    for (x, right) in [(h, true), (h - 1e-12, false), (0.0, false)] {
        let (problem, plan) = hovering(&[[x, 4.0]], Scene::default());
        let report = verify(&problem, &plan);
        assert_eq!(report.holds(), right, "{x}: {report}");
        assert_eq!(report.check(Kind::Workspace).unwrap().holds(), right);
    }
}
