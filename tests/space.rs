//! Threats where sets just touch, in the plane and in space, through the whole chain: plans against
//! balls that are a hair too large, bases and starts on facets, edges and corners.

mod common;

use dosmc::diag::Diagnostics;
use dosmc::driver::{self, Answer, Mission, Overrides};
use dosmc::exact::{Rational, dot};
use dosmc::ir::{BlockerId, Piece};
use dosmc::plan::{Plan, Separator};
use dosmc::source::SourceFile;
use dosmc::verify::{Kind, verify};

use common::{load, overrides, solve};

fn planned(text: &str) -> (Mission, Plan) {
    let mission = load(&SourceFile::new("mission.dosm", text), &overrides(&[], None));
    match solve(&mission) {
        Answer::Plan { plan, .. } => (mission, *plan),
        other => panic!("{other:?}"),
    }
}

/// All planes of a plan that keep clear of a blocker: those of moves, then those of links.
fn planes(plan: &Plan, blocker: &str) -> [Vec<Separator>; 2] {
    let moves = plan.robots.iter().flat_map(|r| r.clear[blocker].iter().flatten().cloned());
    let links = plan.links.iter().flatten().flatten().flat_map(|link| &link.separators);
    let links = links.filter(|(name, _)| name == blocker).map(|(_, separator)| separator.clone());
    [moves.collect(), links.collect()]
}

fn exact(v: &[f64]) -> Vec<Rational> {
    v.iter().map(|x| Rational::from_f64(*x).expect("finite")).collect()
}

/// How far a ball's middle lies beyond a plane.
fn room(plane: &Separator, center: &[Rational]) -> f64 {
    let normal = exact(&plane.normal);
    let depth = dot(&normal, center) - Rational::from_f64(plane.offset).expect("finite");
    depth.to_f64() / dot(&normal, &normal).to_f64().sqrt()
}

/// The mission with its one Euclidean ball in another place and size.
fn with_ball(mission: &Mission, id: BlockerId, center: &[Rational], radius: f64) -> dosmc::ir::Problem {
    let mut problem = mission.problem.clone();
    for piece in &mut problem.blockers[id].shape.pieces {
        let Piece::Ball { center: c, radius: r, .. } = piece else { panic!("no ball") };
        (*c, *r) = (center.to_vec(), Rational::from_f64(radius).expect("finite"));
    }
    problem
}

const PLANE: &str = "\
dosm 1
workspace box (0, 0) .. (10, 10)
jammer J = disc (5, 5) radius 1.5
region a = box (7, 7) .. (9.5, 9.5)
base B at (1, 4)
dynamics Rover {
  step 0.5 s
  integrator 2
  bound vx, vy in [-3, 3] m/s
  bound ax, ay in [-3, 3] m/s^2
  disturbance px, py in [-0.05, 0.05] m
}
robot r: Rover at (2, 3)
robot s: Rover at (2, 7)
goal g: always eventually r in a
";

const SPACE: &str = "\
dosm 1
workspace box (0, 0, 0) .. (10, 10, 8)
jammer J = ball (5, 5, 4) radius 1.5 norm 2
region a = box (7, 7, 4) .. (9.5, 9.5, 6)
base B at (1, 4, 3)
dynamics Drone {
  step 0.5 s
  integrator 2
  bound vx, vy, vz in [-3, 3] m/s
  bound ax, ay, az in [-3, 3] m/s^2
  disturbance px, py, pz in [-0.05, 0.05] m
}
robot r: Drone at (2, 3, 4)
robot s: Drone at (2, 7, 2)
goal g: always eventually r in a
";

/// A ball that all but touches the nearest of a plan's planes is clear; one that reaches over it by
/// 1e-12 of its radius is not, wherever it stands behind the plane of a move or a link.
#[test]
fn threat_4_moves_and_links_are_tangent_to_the_true_ball() {
    for text in [PLANE, SPACE] {
        let (mission, plan) = planned(text);
        let (id, blocker) = mission.problem.blockers.iter().next().expect("a jammer");
        let Piece::Ball { center, .. } = &blocker.shape.pieces[0] else { panic!("no ball") };
        let all = planes(&plan, &blocker.name);
        assert!(all.iter().all(|list| list.len() > 3), "planes of moves and of links");
        let mut tight = 0;
        // The ball is moved about where it is, so that each time another plane is the nearest one.
        for turn in 0..60 {
            let angle = f64::from(turn) * std::f64::consts::TAU / 60.0;
            let way = [angle.cos(), angle.sin(), (5.0 * angle).cos()];
            let moved: Vec<Rational> = center
                .iter()
                .zip(way)
                .map(|(c, w)| c + Rational::from_f64(0.75 * w).expect("finite"))
                .collect();
            let most = all.iter().flatten().map(|plane| room(plane, &moved)).fold(f64::MAX, f64::min);
            if most <= 0.1 {
                continue;
            }
            tight += 1;
            for (share, right) in [(1.0 - 1e-12, true), (1.0 + 1e-12, false)] {
                let report = verify(&with_ball(&mission, id, &moved, most * share), &plan);
                assert_eq!(report.holds(), right, "{most} by {share} around {moved:?}: {report}");
            }
        }
        assert!(tight > 20, "{tight}");
    }
}

/// The same of the links alone, whatever is said of the moves.
#[test]
fn threat_4_links_are_tangent_to_the_true_ball() {
    for text in [PLANE, SPACE] {
        let (mission, plan) = planned(text);
        let (id, blocker) = mission.problem.blockers.iter().next().expect("a jammer");
        let Piece::Ball { center, .. } = &blocker.shape.pieces[0] else { panic!("no ball") };
        let [_, links] = planes(&plan, &blocker.name);
        let mut tight = 0;
        for turn in 0..240 {
            let angle = f64::from(turn) * std::f64::consts::TAU / 240.0;
            let way = [angle.cos(), angle.sin(), (7.0 * angle).sin()];
            let moved: Vec<Rational> = center
                .iter()
                .zip(way)
                .map(|(c, w)| c + Rational::from_f64(1.25 * w).expect("finite"))
                .collect();
            let most = links.iter().map(|plane| room(plane, &moved)).fold(f64::MAX, f64::min);
            if most <= 0.05 {
                continue;
            }
            tight += 1;
            for (share, right) in [(1.0 - 1e-12, true), (1.0 + 1e-12, false)] {
                let report = verify(&with_ball(&mission, id, &moved, most * share), &plan);
                let links = report.check(Kind::Links).expect("links are checked");
                assert_eq!(links.holds(), right, "{most} by {share} around {moved:?}: {report}");
            }
        }
        assert!(tight > 60, "{tight}");
    }
}

/// The codes that loading a mission gives, warnings left out.
fn codes(text: &str) -> Vec<String> {
    let mut diagnostics = Diagnostics::new();
    let source = SourceFile::new("mission.dosm", text);
    let _ = driver::load(&source, &Overrides::default(), &mut diagnostics);
    let errors = diagnostics.iter().filter(|d| d.severity == dosmc::diag::Severity::Error);
    errors.map(|d| d.code.rsplit("::").next().unwrap_or_default().to_string()).collect()
}

/// A box from (4, 4, 3) to (6, 6, 5), then a ball of radius 1 around (5, 5, 4): a base on the edge of
/// a jammer is in it, a hair outside it is not.
#[test]
fn threat_2_a_base_on_a_jammer_in_space_is_in_it() {
    let boxed = SPACE.replace("ball (5, 5, 4) radius 1.5 norm 2", "box (4, 4, 3) .. (6, 6, 5)");
    let round = SPACE.replace("radius 1.5", "radius 1");
    let ramp =
        SPACE.replace("ball (5, 5, 4) radius 1.5 norm 2", "hull (4, 4, 3), (6, 4, 3), (4, 6, 3), (4, 4, 5)");
    let cases: [(&str, &str, bool); 15] = [
        (&boxed, "(4, 5, 4)", true),
        (&boxed, "(4, 4, 4)", true),
        (&boxed, "(4, 4, 3)", true),
        (&boxed, "(6, 6, 5)", true),
        (&boxed, "(3.9999999999, 5, 4)", false),
        (&boxed, "(6.0000000001, 6, 5)", false),
        (&round, "(5, 5, 5)", true),
        (&round, "(4.4, 5.8, 4)", true),
        (&round, "(5, 5, 5.0000000001)", false),
        (&round, "(4.4, 5.8000000001, 4)", false),
        // On the slanted facet x + y + z = 13, on its edge, at its corner, and just beyond.
        (&ramp, "(5, 4.5, 3.5)", true),
        (&ramp, "(5, 5, 3)", true),
        (&ramp, "(4, 4, 5)", true),
        (&ramp, "(5, 4.5, 3.5000000001)", false),
        (&ramp, "(4, 4, 5.0000000001)", false),
    ];
    for (text, base, inside) in cases {
        let found = codes(&text.replace("B at (1, 4, 3)", &format!("B at {base}")));
        let expected: &[&str] = if inside { &["base_in_blocker"] } else { &[] };
        assert_eq!(found, expected, "{base}");
    }
}

/// A start with its tube that touches a facet, an edge or a corner is in the jammer. The tube is
/// ±0.0750003 m wide or so: what is 0.0749 m away touches, 0.0751 m away does not.
#[test]
fn threat_2_a_start_that_touches_a_jammer_in_space_is_in_it() {
    let boxed = SPACE.replace("ball (5, 5, 4) radius 1.5 norm 2", "box (4, 4, 3) .. (6, 6, 5)");
    for (away, expected) in [(0.0749, &["start_in_jammer"][..]), (0.0751, &[])] {
        let far = 4.0 - away;
        let low = 3.0 - away;
        for at in [format!("({far}, 5, 4)"), format!("({far}, {far}, 4)"), format!("({far}, {far}, {low})")] {
            let found = codes(&boxed.replace("r: Drone at (2, 3, 4)", &format!("r: Drone at {at}")));
            assert_eq!(found, expected, "{at}");
        }
    }
}
