//! Each diagnostic of step 0, right at its threshold.

use super::*;
use crate::entity::{EntityId, Table};
use crate::ir::sample::{self, box_shape, disc, exact, interval, point};
use crate::ir::{Atom, Formula, ModelId, RegionId};
use crate::law::Float;
use crate::tube;

/// The codes found in a problem, sorted and without repetition.
fn codes(problem: &Problem) -> Vec<&'static str> {
    let mut codes = all_codes(problem);
    codes.dedup();
    codes
}

/// The codes found in a problem, sorted.
fn all_codes(problem: &Problem) -> Vec<&'static str> {
    let mut diagnostics = Diagnostics::new();
    let spans = Spans::default();
    let tubes = tube::synthesize(problem, &spans, Float::F64, &mut diagnostics).unwrap();
    let _ = inspect(problem, &spans, &tubes, &mut diagnostics);
    let mut codes: Vec<_> =
        diagnostics.iter().map(|d| d.code.trim_start_matches("dosm::abstraction::")).collect();
    codes.sort_unstable();
    codes
}

/// How many pairs of robots that start at these places are told of.
fn too_close(places: &[(f64, f64)]) -> usize {
    let mut problem = sample::relay();
    let robot = problem.robots[RobotId::new(0)].clone();
    // Two diagnostics that say the same are one.
    let named = |i: usize| crate::ir::Robot { name: format!("r{i}"), ..robot.clone() };
    problem.robots = (0..places.len()).map(named).collect();
    places.iter().enumerate().for_each(|(i, (x, y))| start(&mut problem, i, *x, *y));
    all_codes(&problem).iter().filter(|code| **code == "starts_too_close").count()
}

fn with(change: impl FnOnce(&mut Problem)) -> Vec<&'static str> {
    let mut problem = sample::relay();
    change(&mut problem);
    codes(&problem)
}

fn start(problem: &mut Problem, robot: usize, x: f64, y: f64) {
    problem.robots[RobotId::new(robot)].start = point(&[x, 0.0, y, 0.0]);
}

#[test]
fn the_sample_has_nothing_to_report() {
    assert!(with(|_| {}).is_empty());
}

/// The tube is ±0.3000015 m wide, so that 0.3 m is too little and 0.31 m enough.
#[test]
fn starts_keep_their_tube_inside_the_workspace_and_off_blockers() {
    assert_eq!(with(|p| start(p, 0, -11.7, 0.0)), ["start_outside_workspace"]);
    assert!(with(|p| start(p, 0, -11.69, 0.0)).is_empty());
    // The jammer ends at x = −1.
    assert_eq!(with(|p| start(p, 0, -1.3, 8.0)), ["start_in_jammer"]);
    assert!(with(|p| start(p, 0, -1.31, 8.0)).is_empty());
    let kind = |p: &mut Problem| p.blockers[crate::ir::BlockerId::new(0)].kind = BlockerKind::Obstacle;
    assert_eq!(
        with(|p| {
            kind(p);
            start(p, 0, -1.3, 8.0)
        }),
        ["start_in_obstacle"]
    );
}

#[test]
fn discs_are_met_by_corners_and_through_their_uncertainty() {
    let place = |x: f64, spread: f64| {
        with(|p| {
            let mut shape = disc(&[x, 3.0], 1.0);
            if let crate::ir::Piece::Ball { spread: s, .. } = &mut shape.pieces[0] {
                s[0] = exact(spread);
            }
            p.blockers[crate::ir::BlockerId::new(0)].shape = shape;
            start(p, 0, 0.0, 1.8);
        })
    };
    // The corner (0.3, 2.1) is √(1 − 0.81) ≈ 0.4359 short of the disc's edge along x.
    assert_eq!(place(0.73, 0.0), ["start_in_jammer"]);
    assert!(place(0.74, 0.0).is_empty());
    assert_eq!(place(0.74, 0.02), ["start_in_jammer"]);
}

#[test]
fn starts_keep_their_bounds_with_the_tube() {
    let speed = |v: f64| with(|p| p.robots[RobotId::new(0)].start[1] = exact(v));
    assert_eq!(speed(3.9), ["start_outside_bound"]);
    assert!(speed(0.5).is_empty());
}

#[test]
fn starts_keep_their_separation_with_both_tubes() {
    // 0.25 m of separation and two tubes of 0.3 m.
    let gap = |x: f64| {
        with(|p| {
            start(p, 0, 0.0, 0.0);
            start(p, 1, x, 0.0)
        })
    };
    assert_eq!(gap(0.85), ["starts_too_close"]);
    assert!(gap(0.8501).is_empty());
}

/// Whatever the order and the axis, the pairs are those that comparing each with each finds.
#[test]
fn close_starts_are_found_among_all_pairs() {
    for seed in 1..40u32 {
        let at = |i: usize, axis: u32| f64::from((seed * 37 + 11 * i as u32 * (axis + 1) * seed) % 17) * 0.35;
        let places: Vec<(f64, f64)> = (0..3).map(|i| (at(i, 0), at(i, 1))).collect();
        let apart = |(a, b): (f64, f64), (c, d): (f64, f64)| (a - c).abs().max((b - d).abs()) > 0.85 + 1e-9;
        let expected = (0..3).flat_map(|i| (0..i).map(move |j| (i, j)));
        let expected = expected.filter(|(i, j)| !apart(places[*i], places[*j])).count();
        assert_eq!(too_close(&places), expected, "{places:?}");
    }
}

#[test]
fn a_crowd_in_one_place_is_told_of_at_once() {
    assert_eq!(too_close(&vec![(0.0, 4.0); 2000]), MOST_PAIRS);
}

#[test]
fn regions_that_the_tube_empties_are_errors_only_where_a_goal_needs_them() {
    let region =
        |width: f64| with(|p| p.regions[RegionId::new(0)].shape = box_shape(&[0.0, 0.0], &[5.0, width]));
    assert_eq!(region(0.6), ["region_too_small"]);
    assert!(region(0.6001).is_empty());
    // Out of a small region is always possible, and so is another region.
    let other = with(|p| {
        p.regions[RegionId::new(0)].shape = box_shape(&[0.0, 0.0], &[5.0, 0.1]);
        let inside =
            |region: usize| Formula::In(Atom { robot: RobotId::new(0), region: RegionId::new(region) });
        let (small, large) = (p.formulas.intern(inside(0)), p.formulas.intern(inside(1)));
        p.goals[0].formula = p.formulas.intern(Formula::Or(vec![small, large]));
    });
    assert!(other.is_empty());
    // Only the part within the workspace counts.
    let outside = with(|p| p.regions[RegionId::new(0)].shape = box_shape(&[11.5, 0.0], &[20.0, 5.0]));
    assert_eq!(outside, ["region_too_small"]);
}

/// A release may do with its first operand once its window begins later.
#[test]
fn a_release_asks_for_its_second_operand_only_at_once() {
    let release = |from: u32, first: usize| {
        with(|p| {
            p.regions[RegionId::new(0)].shape = box_shape(&[0.0, 0.0], &[5.0, 0.1]);
            let inside =
                |region: usize| Formula::In(Atom { robot: RobotId::new(0), region: RegionId::new(region) });
            let (small, other) = (p.formulas.intern(inside(0)), p.formulas.intern(inside(first)));
            p.goals[0].formula = p.formulas.intern(Formula::Release(Some((from, 5)), other, small));
        })
    };
    assert_eq!(release(0, 1), ["region_too_small"]);
    assert!(release(1, 1).is_empty());
    assert_eq!(release(1, 0), ["region_too_small"]);
}

#[test]
fn small_discs_are_emptied_by_the_tubes_corners() {
    // The tube's corners are 0.42427 m away from its middle; both robots count.
    let radius = |r: f64| with(|p| p.regions[RegionId::new(1)].shape = disc(&[8.0, 8.0], r));
    assert_eq!(radius(0.424), ["region_too_small"]);
    assert!(radius(0.425).is_empty());
}

#[test]
fn coupled_axes_give_an_exact_polygon() {
    let mut model = sample::integrators(2, 4.0, &[4.0]);
    model.a[(0, 2)] = exact(0.25);
    model.disturbance[1] = interval(-0.01, 0.01);
    let problem = sample::empty(vec![model.clone()], 50.0);
    let tubes = tube::synthesize(&problem, &Spans::default(), Float::F64, &mut Diagnostics::new()).unwrap();
    let tube = &tubes[ModelId::new(0)];
    let set = ErrorSet::new(&model, tube).unwrap();
    assert!(set.positions().facets.len() > 4);
    for facet in &set.positions().facets {
        let mut direction = vec![Rational::ZERO; 4];
        direction[0] = facet.normal[0].clone();
        direction[2] = facet.normal[1].clone();
        assert_eq!(set.support(&direction), facet.offset);
        let up = tube.position_support_up(&[0, 2], &[facet.normal[0].to_f64(), facet.normal[1].to_f64()]);
        assert!((up - facet.offset.to_f64()).abs() < 1e-9);
    }
    let _: Table<ModelId, tube::Tube> = tubes;
}

/// x = z + e hits J iff z ∈ J ⊕ (−Ω): an off-centre tube hits on the side where it lies.
#[test]
fn erratum_p3_an_off_centre_tube_hits_on_its_own_side() {
    let at = |x: f64| {
        let mut problem = sample::relay();
        problem.blockers[crate::ir::BlockerId::new(0)].shape = box_shape(&[x - 0.5, -5.0], &[x + 0.5, 5.0]);
        start(&mut problem, 0, 0.0, 0.0);
        let spans = Spans::default();
        let mut tubes = tube::synthesize(&problem, &spans, Float::F64, &mut Diagnostics::new()).unwrap();
        let tube = &mut tubes[ModelId::new(0)];
        tube.center[0] = 0.2;
        let mut diagnostics = Diagnostics::new();
        let _ = inspect(&problem, &spans, &tubes, &mut diagnostics);
        diagnostics.iter().any(|d| d.code == "dosm::abstraction::start_in_jammer")
    };
    // D_0 + D_1 moves the middle by 0.3 m: the robot is between 0 and 0.6 m.
    assert!(at(1.0) && at(1.09) && !at(1.11));
    assert!(!at(-0.51) && at(-0.49));
}
