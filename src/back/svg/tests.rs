//! Tests of the picture on a small plan made by hand.

use super::projection::Projection;
use super::sample::{link, plan, problem};
use super::scene::Scene;
use super::{Options, draw, moments};
use crate::back::Flight;
use crate::plan::Label;

#[test]
fn the_picture_of_a_small_plan() {
    insta::assert_snapshot!(draw(&problem("small"), &plan(), &Options::default()).contents);
}

#[test]
fn no_text_of_the_mission_becomes_markup() {
    let text = draw(&problem("</title><script>x</script>\u{1b}"), &plan(), &Options::default()).contents;
    assert!(!text.contains("<script") && !text.contains('\u{1b}'));
    assert!(text.contains("&lt;goal&gt; &amp; co"));
    assert_eq!(text.matches("<title").count(), text.matches("</title>").count());
}

/// The pixel of a point in the main panel: 606 pixels for 12 m, 58 and 72 pixels from the corner.
fn pixel(x: f64, y: f64) -> String {
    let scale = 606.0 / 12.0;
    format!("{:.2} {:.2}", 58.0 + x * scale, 72.0 + (8.0 - y) * scale)
}

#[test]
fn tubes_stand_off_centre_and_to_scale() {
    let text = draw(&problem("small"), &plan(), &Options::default()).contents;
    // R1 starts at (1, 1); its tube is 0.4 m by 0.6 m around (0.1, 0).
    let corners = [pixel(0.9, 0.7), pixel(1.3, 0.7), pixel(1.3, 1.3), pixel(0.9, 1.3)];
    let expected = format!("M{}Z", corners.join("L"));
    assert!(text.contains(&expected), "{expected}");
}

#[test]
fn a_plan_that_does_not_fit_its_problem_is_still_drawn() {
    let mut odd = plan();
    odd.loop_start = 99;
    odd.links = Some(vec![vec![link("nobody", "B1")]; 5]);
    odd.robots[0].z[1].clear();
    odd.robots[1].dynamics = "Other".into();
    odd.tubes[0].d[0].clear();
    assert!(draw(&problem("odd"), &odd, &Options::default()).contents.ends_with("</svg>\n"));
}

#[test]
fn cells_lie_under_everything_else() {
    let cells = [vec![[0.0, 0.0], [6.0, 0.0], [6.0, 8.0]]];
    let text = draw(&problem("small"), &plan(), &Options { cells: &cells, ..Default::default() }).contents;
    let outline = format!("M{}L{}L{}Z", pixel(0.0, 0.0), pixel(6.0, 0.0), pixel(6.0, 8.0));
    let at = |part: &str| text.find(part).expect(part);
    assert!(at(&outline) < at(r#"class="region""#));
    assert!(text.contains("cell of the partition"));
    assert!(!draw(&problem("small"), &plan(), &Options::default()).contents.contains("cell of"));
}

/// What one of the picture's classes is drawn with: the paths, in order.
fn paths(text: &str, class: &str) -> Vec<String> {
    let start = format!(r#"<path class="{class}" d=""#);
    let path = |rest: &str| rest.split('"').next().unwrap_or_default().to_string();
    text.split(&start).skip(1).map(path).collect()
}

/// A box's path in the main panel.
fn boxed(x: (f64, f64), y: (f64, f64)) -> String {
    let corners = [pixel(x.0, y.0), pixel(x.1, y.0), pixel(x.1, y.1), pixel(x.0, y.1)];
    format!("M{}Z", corners.join("L"))
}

fn drawn() -> String {
    draw(&problem("small"), &plan(), &Options::default()).contents
}

// The tube is 0.1 ± 0.2 by 0 ± 0.3, so blockers grow by 0.3 to the left, 0.1 to the right, and 0.3 up and
// down; regions shrink by 0.1 on the left, 0.3 on the right.

#[test]
fn jammers_grow_by_the_mirrored_tube() {
    let expected = boxed((3.7, 6.1), (2.7, 5.3));
    assert!(paths(&drawn(), "grown jam t0").contains(&expected), "{expected}");
}

#[test]
fn regions_shrink_by_the_tube() {
    let expected = boxed((8.1, 10.7), (5.3, 7.2));
    assert!(paths(&drawn(), "shrunk t0").contains(&expected), "{expected}");
}

#[test]
fn grown_discs_are_round_at_their_corners() {
    // box(8 ± 0.5, 2) ⊕ disc(1), grown: corners 7.2 … 8.6 by 1.7 … 2.3, radius 1 m.
    let path = paths(&drawn(), "grown t0").into_iter().find(|p| p.contains('A')).expect("a round one");
    assert!(path.starts_with(&format!("M{}L{}A50.50 50.50", pixel(7.2, 0.7), pixel(8.6, 0.7))), "{path}");
}

#[test]
fn ways_go_through_the_nominal_positions_and_close() {
    let text = drawn();
    let prefix = format!("M{}L{}L{}", pixel(1.0, 1.0), pixel(3.0, 2.0), pixel(7.0, 4.0));
    let round = format!("M{}L{}L{}L{}", pixel(7.0, 4.0), pixel(9.0, 6.0), pixel(10.0, 5.5), pixel(7.0, 4.0));
    assert!(paths(&text, "prefix").contains(&prefix) && paths(&text, "loop").contains(&round));
}

#[test]
fn the_scale_bar_is_as_long_as_it_says() {
    let text = drawn();
    // 2 m at 50.5 pixels a metre.
    assert!(paths(&text, "bar")[0].contains("h101.00"), "{:?}", paths(&text, "bar"));
    assert!(text.contains(">2 m</text>"));
}

#[test]
fn links_are_in_the_panels_of_their_steps() {
    let text = drawn();
    assert_eq!(paths(&text, "link").len(), 2 + 1, "two at the last step, one in the legend");
    let mut without = plan();
    without.links = None;
    let text = draw(&problem("small"), &without, &Options::default()).contents;
    assert_eq!(paths(&text, "link").len(), 0, "and no legend for what is not there");
}

#[test]
fn panels_show_the_start_the_loop_and_arrivals() {
    let (problem, mut plan) = (problem("small"), plan());
    let of = |plan: &_| {
        let all = moments::choose(&Scene::new(&problem, plan, Projection::TOP), 4);
        all.into_iter().map(|m| (m.step, m.what.join(", "))).collect::<Vec<_>>()
    };
    let expected = [(0, "start"), (2, "the loop begins"), (4, "then step 2 again")];
    assert_eq!(of(&plan), expected.map(|(s, w)| (s, w.to_string())));
    plan.robots[1]
        .regions
        .insert("goal".into(), [Label::Out, Label::Out, Label::Out, Label::In, Label::In].into());
    assert_eq!(of(&plan)[2], (3, "R2 in goal".to_string()));
    plan.loop_start = 4;
    assert_eq!(of(&plan)[2], (4, "stays so for ever".to_string()));
}

/// The picture of a mission in space: a jammer that is a cube of 2 m.
fn drawn_in_space() -> String {
    let text = include_str!("../../../tests/missions/solve/space.dosm");
    let source = crate::source::SourceFile::new("space.dosm", text);
    let mut diagnostics = crate::diag::Diagnostics::new();
    let mission = crate::driver::load(&source, &Default::default(), &mut diagnostics).expect("no errors");
    let mut plan = plan();
    plan.robots.truncate(1);
    plan.robots[0].name = "r".into();
    plan.robots[0].dynamics = "Drone".into();
    let place = |x: f64, y: f64, z: f64| vec![x, 0.0, y, 0.0, z, 0.0];
    plan.robots[0].z = [1.0, 2.0, 3.0, 4.0, 5.0].map(|x| place(x, 7.0, 0.5 * x)).into();
    draw(&mission.problem, &plan, &Options::default()).contents
}

/// Width and height of a path of straight lines.
fn extent(path: &str) -> [f64; 2] {
    let numbers: Vec<f64> =
        path.split(['M', 'L', 'Z', ' ']).filter_map(|number| number.parse().ok()).collect();
    [0, 1].map(|axis| {
        let along = numbers.iter().skip(axis).step_by(2);
        along.clone().fold(f64::MIN, |a, b| a.max(*b)) - along.fold(f64::MAX, |a, b| a.min(*b))
    })
}

#[test]
fn a_mission_in_space_is_shown_from_four_sides() {
    let text = drawn_in_space();
    for caption in ["from above: x, y", "from the front: x, z", "from the right: y, z"] {
        assert!(text.contains(&format!(">{caption}</text>")), "{caption}");
    }
    assert!(text.contains("Workspace of 8.00 m by 8.00 m by 6.00 m."));
    // Three faces of the cube are turned to the viewer, the other three show by their edges; then
    // comes the view from above, the legend, the other views. Small panels have three faces again.
    let jammers = paths(&text, "jammer");
    assert_eq!(jammers.len(), 3 + 3 + 1 + 3 * 3);
    let bar = paths(&text, "bar")[0].clone();
    let length: f64 =
        bar.split('h').nth(1).and_then(|rest| rest.split('m').next()?.parse().ok()).expect("a bar");
    let metres: f64 = if text.contains(">5 m</text>") { 5.0 } else { 2.0 };
    for square in [3, 5, 6].map(|at| &jammers[at]) {
        let [w, h] = extent(square);
        assert!((w - 2.0 * length / metres).abs() < 0.02 && (h - w).abs() < 0.02, "{square} {bar}");
    }
}

#[test]
fn the_axonometric_view_is_to_scale_along_its_picture_plane() {
    // The diagonal of the floor that is drawn level is as long as it is, in the scale of a ball's
    // circle; every edge of a cube along one axis is equally long.
    let p = Projection::axonometric();
    let [a, b] = [p.flat(&[0.0; 3]), p.flat(&[0.0, 0.0, 2.0])];
    assert!(a[0] == b[0] && b[1] > a[1], "z is drawn upwards");
    let circle = (0..360).map(|i| {
        let (sin, cos) = f64::from(i).to_radians().sin_cos();
        let [x, y] = p.flat(&[cos, sin, 0.0]);
        x.hypot(y)
    });
    assert!((circle.fold(0.0, f64::max) - 1.0).abs() < 1e-4);
}

#[test]
fn shadows_lie_on_the_floor_below_the_ways() {
    let text = drawn_in_space();
    assert_eq!(paths(&text, "shadow").len(), 1 + 1, "one a robot, one in the legend");
    assert!(text.contains(r#"<path class="stem""#));
}

#[test]
fn simulated_runs_are_thin_lines_of_their_own() {
    let (problem, plan) = (problem("small"), plan());
    let nominal = draw(&problem, &plan, &Options::default()).contents;
    let way = vec![vec![1.0, 2.0], vec![2.0, 2.5], vec![4.0, 2.0]];
    let runs = vec![Flight { ways: vec![way; plan.robots.len()] }; 3];
    let drawn = draw(&problem, &plan, &Options { runs: &runs, ..Default::default() }).contents;
    assert!(roxmltree::Document::parse(&drawn).is_ok());
    assert!(drawn.contains("3 simulated runs") && !nominal.contains("simulated"));
    let thin = |text: &str| text.matches(r#"stroke-width=".7""#).count();
    assert_eq!(
        (thin(&nominal), thin(&drawn)),
        (0, plan.robots.len() + 1),
        "one group a robot, and the legend"
    );
    let more = paths(&drawn, "").len() - paths(&nominal, "").len();
    assert!(more >= 3 * plan.robots.len() + 3, "{more}");
}
