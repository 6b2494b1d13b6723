//! What moves: each robot's nominal way with its steps, and the tube around it.

use std::cmp::Ordering;

use super::canvas::{Canvas, Pixel, View, open};
use super::labels::{self, Places, Rect};
use super::layout::{FONT, SMALL};
use super::mark;
use super::scene::{Mover, Scene};
use super::stills::label;
use super::text;

/// The radius of a step's mark.
pub const MARK: f64 = 4.0;
/// The radius of the mark of the start.
pub const START: f64 = 7.0;
/// The most step numbers in a picture; where there are more steps, every other one has one, or
/// every third …
const MOST_NUMBERS: usize = 160;

/// Which parts of the ways are drawn: by robot, from a step to a step; of a step's mark the same step
/// twice.
pub type Shown<'a> = &'a dyn Fn(usize, usize, usize) -> bool;

/// Draws where every robot can be, between the steps and at them.
pub fn tubes(canvas: &mut Canvas, view: &View, scene: &Scene, shown: Shown) {
    for (index, robot) in scene.robots.iter().enumerate() {
        let color = mark::color(index);
        // One group for the whole way: where it crosses itself it is no darker.
        canvas.add(&format!(r#"<g class="swept" fill="{color}">"#));
        for (from, to) in legs(scene, robot).into_iter().filter(|(from, to)| shown(index, *from, *to)) {
            let between = robot.tube.at(robot.points[from]).joined(&robot.tube.at(robot.points[to]));
            canvas.path("", &view.path(&between));
        }
        canvas.add("</g>");
        canvas.add(&format!(r#"<g class="tube" stroke="{color}">"#));
        for (_, point) in robot.points.iter().enumerate().filter(|(step, _)| shown(index, *step, *step)) {
            canvas.path("", &view.path(&robot.tube.at(*point)));
        }
        canvas.add("</g>");
    }
}

/// The pairs of steps that follow each other, the loop's closing one included.
pub fn legs(scene: &Scene, robot: &Mover) -> Vec<(usize, usize)> {
    let count = robot.points.len();
    let along = (1..count).map(|t| (t - 1, t));
    let back = (count > 0).then(|| (count - 1, scene.plan.loop_start.min(count - 1)));
    along.chain(back).collect()
}

/// Draws the nominal ways: the prefix dashed with hollow marks, the loop solid with full ones.
pub fn draw(canvas: &mut Canvas, view: &View, scene: &Scene, shown: Shown) {
    for (index, robot) in scene.robots.iter().enumerate() {
        let points = view.pixels(&robot.points);
        let k = scene.loop_start();
        if points.len() <= k {
            continue;
        }
        let color = mark::color(index);
        let (before, round): (Vec<_>, Vec<_>) = legs(scene, robot).into_iter().partition(|leg| leg.0 < k);
        let visible = |&(from, to): &(usize, usize)| shown(index, from, to);
        canvas.add(&format!(r#"<g stroke="{color}">"#));
        runs(&before, visible).iter().for_each(|run| canvas.path("prefix", &along(&points, run)));
        if !scene.stays() {
            runs(&round, visible).iter().for_each(|run| canvas.path("loop", &along(&points, run)));
        }
        canvas.add("</g>");
        if !scene.stays() {
            let seen = round.iter().filter(|leg| visible(leg));
            seen.for_each(|(from, to)| arrow(canvas, color, points[*from], points[*to]));
        }
    }
    for (index, robot) in scene.robots.iter().enumerate() {
        marks(canvas, view, scene, (index, robot), shown);
    }
}

/// The visible stretches of legs that follow each other.
fn runs(legs: &[(usize, usize)], visible: impl Fn(&(usize, usize)) -> bool) -> Vec<&[(usize, usize)]> {
    legs.split(|leg| !visible(leg)).filter(|run| !run.is_empty()).collect()
}

/// The path along a stretch of legs.
fn along(points: &[Pixel], run: &[(usize, usize)]) -> String {
    let first = run.first().map(|(from, _)| points[*from]);
    open(&first.into_iter().chain(run.iter().map(|(_, to)| points[*to])).collect::<Vec<_>>())
}

fn marks(canvas: &mut Canvas, view: &View, scene: &Scene, (index, robot): (usize, &Mover), shown: Shown) {
    let color = mark::color(index);
    canvas.add(&format!(r#"<g stroke="{color}" fill="{color}">"#));
    for (step, point) in robot.points.iter().enumerate().filter(|(step, _)| shown(index, *step, *step)) {
        let at = view.pixel(*point);
        let looping = step >= scene.loop_start();
        let class = if looping { "stop" } else { "passed" };
        if step == scene.loop_start() {
            canvas.path("ring", &mark::path(index, at, MARK + 4.5));
        }
        let radius = if step == 0 { START } else { MARK };
        canvas.titled_path(class, &mark::path(index, at, radius), &note(scene, robot, step));
    }
    canvas.add("</g>");
}

/// What the pointer shows over a step.
fn note(scene: &Scene, robot: &Mover, step: usize) -> String {
    let at: Vec<String> = robot.positions[step].iter().map(|x| format!("{x:.3}")).collect();
    let time = step as f64 * scene.plan.step_s;
    format!("{}, step {step}, {time:.3} s: ({}) m", robot.name, at.join(", "))
}

/// Makes labels pay for covering ways and marks.
pub fn keep_visible(view: &View, scene: &Scene, places: &mut Places) {
    for robot in &scene.robots {
        let points = view.pixels(&robot.points);
        for (from, to) in legs(scene, robot) {
            places.line(points[from], points[to], 1.0);
        }
        for (step, at) in points.iter().enumerate() {
            let size = if step == 0 { 2.0 * START + 2.0 } else { 2.0 * MARK + 3.0 };
            places.spot(Rect::around(*at, size, size), 6.0);
        }
    }
}

/// Writes the robots' names where they start.
pub fn names(canvas: &mut Canvas, view: &View, scene: &Scene, places: &mut Places) {
    let room = (view.size[0] * 0.4).clamp(90.0, 170.0);
    for (index, robot) in scene.robots.iter().enumerate() {
        let Some(start) = robot.points.first() else { continue };
        let short = text::cut(robot.name, FONT, true, room);
        let w = text::width(&short, FONT, true);
        let choices = labels::around(view.pixel(*start), w, FONT, &[START + 3.0, START + 16.0, START + 34.0]);
        if let Some(rect) = places.take(choices, 300.0) {
            label(canvas, &rect, &format!("name mid {}", mark::ink(index)), &short);
        }
    }
}

/// Writes the steps' numbers where they fit.
pub fn numbers(canvas: &mut Canvas, view: &View, scene: &Scene, places: &mut Places) {
    let all: usize = scene.robots.iter().map(|r| r.points.len()).sum();
    let stride = all.div_ceil(MOST_NUMBERS).max(1);
    for (index, robot) in scene.robots.iter().enumerate() {
        for (step, point) in robot.points.iter().enumerate().skip(1) {
            // Where the loop begins and where it ends is what people look for.
            if step % stride != 0 && step != scene.loop_start() && step + 1 != robot.points.len() {
                continue;
            }
            let number = step.to_string();
            let w = text::width(&number, SMALL, false);
            let choices = labels::around(view.pixel(*point), w, SMALL - 1.5, &[MARK + 3.0, MARK + 7.0]);
            if let Some(rect) = places.take(choices, 5.5) {
                let (x, y) = rect.middle();
                canvas.haloed((x, y + 0.36 * SMALL), &format!("step mid {}", mark::ink(index)), &number);
            }
        }
    }
}

/// A small arrow head in the middle of a segment, where the segment is long enough for one.
pub fn arrow(canvas: &mut Canvas, color: &str, from: Pixel, to: Pixel) {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = dx.hypot(dy);
    // Not a number is no length either.
    if length.partial_cmp(&26.0).is_none_or(Ordering::is_lt) {
        return;
    }
    let (ux, uy) = (dx / length, dy / length);
    let tip = (from.0 + dx / 2.0 + ux * 6.5, from.1 + dy / 2.0 + uy * 6.5);
    let wing = |side: f64| (tip.0 - ux * 13.0 - uy * side, tip.1 - uy * 13.0 + ux * side);
    let head = open(&[tip, wing(6.0), wing(-6.0)]);
    canvas.add(&format!(r#"<g fill="{color}"><path class="arrow" d="{head}Z"/></g>"#));
}
