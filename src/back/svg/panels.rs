//! Small panels: who is where at chosen moments, and the links that the plan relies on then.

use super::canvas::{Canvas, View, open};
use super::layout::{CAPTION, FONT, Layout, SMALL};
use super::mark;
use super::moments::Moment;
use super::scene::Scene;
use super::solids;
use super::stills;
use super::text;
use super::ways::MARK;

/// Draws one panel a moment below `top`, and says where they end.
pub fn draw(canvas: &mut Canvas, layout: &Layout, scene: &Scene, moments: &[Moment], top: f64) -> f64 {
    let (views, bottom) = layout.panels(top, moments.len());
    for (view, moment) in views.iter().zip(moments) {
        panel(canvas, view, scene, moment.step);
        let room = layout.caption_width();
        let (x, y) = (view.corner.0, view.corner.1 - CAPTION);
        let title = format!("step {}, {} s", moment.step, seconds(moment.step, scene.plan.step_s));
        canvas.text((x, y + 15.0), "name", &text::cut(&title, FONT, true, room));
        canvas.text((x, y + 32.0), "sub", &caption(&moment.what, room));
    }
    bottom
}

/// As much of what happens as fits.
fn caption(what: &[String], room: f64) -> String {
    let fits = |count: &usize| text::width(&what[..*count].join(", "), SMALL, false) <= room;
    match (1..=what.len()).rev().find(fits) {
        Some(count) => what[..count].join(", "),
        None => text::cut(what.first().map_or("", String::as_str), SMALL, false, room).into_owned(),
    }
}

fn panel(canvas: &mut Canvas, view: &View, scene: &Scene, step: usize) {
    canvas.add(&format!("<svg class=\"small\" {}>", view.window()));
    match scene.projection.axes() {
        Some(_) => stills::draw(canvas, view, scene, false),
        None => {
            solids::room(canvas, view, scene.problem, &scene.projection, false);
            solids::draw(canvas, view, scene.problem, &scene.projection);
        }
    }
    for (index, robot) in scene.robots.iter().enumerate() {
        let so_far = &robot.points[..(step + 1).min(robot.points.len())];
        let color = mark::color(index);
        canvas.add(&format!(r#"<path class="trail" stroke="{color}" d="{}"/>"#, open(&view.pixels(so_far))));
    }
    links(canvas, view, scene, step);
    stills::bases(canvas, view, scene, mark::MAST * 0.8);
    for (index, robot) in scene.robots.iter().enumerate() {
        let Some(point) = robot.points.get(step) else { continue };
        let color = mark::color(index);
        canvas.add(&format!(r#"<g class="tube" stroke="{color}">"#));
        canvas.path("", &view.path(&robot.tube.at(*point)));
        canvas.add("</g>");
        canvas.add(&format!(r#"<g stroke="{color}" fill="{color}">"#));
        canvas.titled_path("stop", &mark::path(index, view.pixel(*point), MARK + 1.5), robot.name);
        canvas.add("</g>");
    }
    canvas.add("</svg>");
    match scene.projection.axes() {
        Some(_) => stills::frame(canvas, view, scene),
        None => solids::room(canvas, view, scene.problem, &scene.projection, true),
    }
}

/// Draws the links of a step: where each can be, and the line between the nominal positions.
pub fn links(canvas: &mut Canvas, view: &View, scene: &Scene, step: usize) {
    let all = scene.links(step);
    canvas.add(r#"<g class="beam">"#);
    for [(a, _), (b, _)] in &all {
        canvas.path("", &view.path(&a.joined(b)));
    }
    canvas.add("</g>");
    for [(_, a), (_, b)] in &all {
        canvas.path("link", &open(&[view.pixel(*a), view.pixel(*b)]));
    }
}

/// A time in seconds with at most three decimals.
pub fn seconds(step: usize, step_s: f64) -> String {
    let text = format!("{:.3}", step as f64 * step_s);
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}
