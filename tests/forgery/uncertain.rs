//! Uncertain regions: `in` means in all sets that the region may be, `not … in` in none of them.

use dosmc::driver::{Answer, Overrides};
use dosmc::plan::{Label, Plan};
use dosmc::source::SourceFile;
use dosmc::verify::{Kind, verify};

use crate::common::{load, solve};

const NORMS: [&str; 3] = ["", "norm 1", "norm 2"];
const RADIUS: f64 = 1.5;

/// A robot that comes to rest in (or stays out of) a ball at (5, 5).
fn mission(ball: &str, goal: &str) -> dosmc::driver::Mission {
    let text = format!(
        "dosm 1\nworkspace box (0, 0) .. (10, 10)\nregion a = {ball}\nregion b = box (6.5, 2) .. (8, 3)\n\
         base m at (1, 1)\ndynamics D {{ step 0.5 s  integrator 2\n bound vx, vy in [-3, 3] m/s\n \
         bound ax, ay in [-3, 3] m/s^2\n disturbance px, py in [-0.05, 0.05] m }}\n\
         robot r: D at (2, 4.7)\ngoal g: {goal}\n"
    );
    load(&SourceFile::new("uncertain.dosm", text.as_str()), &Overrides::default())
}

fn planned(ball: &str, goal: &str) -> Plan {
    match solve(&mission(ball, goal)) {
        Answer::Plan { plan, .. } => *plan,
        _ => panic!("{ball}, {goal}: there is a plan"),
    }
}

/// The half-widths of the tube, which is a box: the axes are decoupled.
fn half_widths(plan: &Plan) -> [f64; 2] {
    let tube = &plan.tubes[0];
    [0, 2].map(|s| {
        let sum = |d: &Vec<Vec<f64>>| -> f64 {
            d[s].iter().zip(&tube.half_width).map(|(x, w)| (x * w).abs()).sum()
        };
        tube.d.iter().map(sum).sum()
    })
}

/// How large an uncertainty may be, in every coordinate of the centre or of the radius, until some
/// step that is labelled in (or out) isn't any more.
fn most(plan: &Plan, norm: usize, of_radius: bool, label: Label) -> f64 {
    let widths = half_widths(plan);
    let robot = &plan.robots[0];
    let steps = robot.regions["a"].iter().zip(&robot.z).filter(|(l, _)| **l == label);
    let at_most = |z: &Vec<f64>| {
        // What the error and the uncertainty add where a robot is in, and take away where it is out.
        let sign = if label == Label::In { 1.0 } else { -1.0 };
        let fits = |by: f64| {
            let (spread, radius) = if of_radius { (0.0, RADIUS - sign * by) } else { (by, RADIUS) };
            let far =
                [0, 1].map(|axis| ((z[2 * axis] - 5.0).abs() + sign * (widths[axis] + spread)).max(0.0));
            let size = match norm {
                0 => far[0].max(far[1]),
                1 => far[0] + far[1],
                _ => far[0].hypot(far[1]),
            };
            sign * (radius - size) >= 0.0
        };
        let (mut lo, mut hi) = (0.0, 4.0);
        for _ in 0..60 {
            let middle = 0.5 * (lo + hi);
            if fits(middle) { lo = middle } else { hi = middle }
        }
        lo
    };
    steps.map(|(_, z)| at_most(z)).fold(f64::INFINITY, f64::min)
}

fn refused(plan: &Plan, ball: &str, goal: &str) -> bool {
    let report = verify(&mission(ball, goal).problem, plan);
    if report.holds() {
        return false;
    }
    assert!(report.failures.iter().any(|f| f.check == Kind::Regions), "{ball}: {:?}", report.failures);
    true
}

fn ball(norm: usize, of_radius: bool, by: f64) -> String {
    let (at, of) = if of_radius { (0.0, by) } else { (by, 0.0) };
    format!("ball (5 +/- {at:.12}, 5 +/- {at:.12}) radius {RADIUS} +/- {of:.12} {}", NORMS[norm])
}

#[test]
fn in_is_in_all_that_an_uncertain_region_may_be() {
    let goal = "eventually always r in a";
    for norm in 0..3 {
        for of_radius in [false, true] {
            let plan = planned(&ball(norm, of_radius, 0.05), goal);
            let most = most(&plan, norm, of_radius, Label::In);
            assert!((0.05..RADIUS).contains(&most), "{most}");
            assert!(!refused(&plan, &ball(norm, of_radius, most - 1e-6), goal), "{norm} {of_radius} {most}");
            assert!(refused(&plan, &ball(norm, of_radius, most + 1e-6), goal), "{norm} {of_radius} {most}");
        }
    }
}

#[test]
fn out_is_out_of_all_that_an_uncertain_region_may_be() {
    let goal = "(always not r in a) and eventually r in b";
    for norm in 0..3 {
        for of_radius in [false, true] {
            let plan = planned(&ball(norm, of_radius, 0.05), goal);
            assert!(!refused(&plan, &ball(norm, of_radius, 0.05 - 1e-6), goal));
            // No plane that stands for more: the witnesses were made for 0.05 and give way soon after.
            let most = most(&plan, norm, of_radius, Label::Out);
            assert!(most >= 0.05, "{most}");
            assert!(refused(&plan, &ball(norm, of_radius, most + 1e-6), goal), "{norm} {of_radius} {most}");
        }
    }
}
