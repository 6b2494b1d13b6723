//! The picture of a plan: the workspace to scale, what is in it, every robot's way with its tube, and
//! below it the links at chosen moments.
//!
//! The picture is static and self-contained, and says the same without its colours: ways differ in
//! their marks, the loop and what comes before it in their lines, blockers in their hatches. Numbers
//! have a fixed number of decimals and everything is drawn in the mission's order, so the same plan
//! gives the same bytes. A mission in space is drawn axonometrically, and from above, from the front
//! and from the side.
//!
//! A [`Scene`](scene::Scene) is what there is to draw, in metres; a [`Layout`](layout::Layout) says
//! where the parts go; all other modules draw one part each.

mod axes;
mod canvas;
mod cells;
mod flights;
mod labels;
mod layout;
mod legend;
mod mark;
mod moments;
mod outline;
mod panels;
mod projection;
mod scene;
mod section;
mod solids;
mod space;
mod stage;
mod stills;
mod text;
mod ways;

#[cfg(test)]
mod sample;
#[cfg(test)]
mod tests;

use crate::back::{Artifact, Flight};
use crate::exact::Rational;
use crate::ir::Problem;
use crate::plan::Plan;
use canvas::{Canvas, View, px};
use labels::{Places, Rect};
use layout::{FONT, Layout, MARGIN, MOMENTS};
use projection::Projection;
use scene::Scene;

pub use cells::Cell;
pub(super) use stage::{Actor, Drawing, Stage};
pub(super) use text::escape;

/// The file's name in the output directory.
pub const NAME: &str = "plan.svg";

/// What a picture shows besides the plan.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options<'a> {
    /// The cells of a partition of the workspace, drawn as thin outlines under everything else.
    pub cells: &'a [Cell],
    /// Simulated runs, drawn as thin lines over the nominal ways.
    pub runs: &'a [Flight],
}

/// Draws a plan of a problem.
pub fn draw(problem: &Problem, plan: &Plan, options: &Options) -> Artifact {
    if problem.dimension > 2 {
        return Artifact { name: NAME.into(), contents: space::draw(problem, plan, options.runs) };
    }
    let scene = Scene::new(problem, plan, Projection::TOP);
    let layout = Layout::new(&scene.workspace);
    let mut canvas = Canvas::default();
    title(&mut canvas, &layout, &scene);
    main_panel(&mut canvas, &layout, &scene, options);
    let moments = moments::choose(&scene, MOMENTS);
    let with_links = moments.iter().any(|m| !scene.links(m.step).is_empty());
    let extras = legend::Extras {
        links: with_links,
        cells: !options.cells.is_empty(),
        runs: options.runs.len(),
        space: false,
    };
    let bottom = legend::draw(&mut canvas, &layout, &scene, extras).max(layout.main_bottom());
    let bottom = panels::draw(&mut canvas, &layout, &scene, &moments, bottom + 14.0);
    let contents = file(&layout, bottom, &scene, &canvas.finish());
    Artifact { name: NAME.into(), contents }
}

fn title(canvas: &mut Canvas, layout: &Layout, scene: &Scene) {
    let room = layout.width - 2.0 * MARGIN;
    canvas.text((MARGIN, 30.0), "title", &text::cut(&scene.problem.name, 20.0, true, room));
    canvas.text((MARGIN, 52.0), "", &text::cut(&scene.plan.summary(), FONT, false, room));
}

/// The workspace with the ways, all labels last.
fn main_panel(canvas: &mut Canvas, layout: &Layout, scene: &Scene, options: &Options) {
    let view = &layout.main;
    canvas.add(&format!("<svg {}>", view.window()));
    cells::draw(canvas, view, options.cells);
    axes::grid(canvas, view);
    stills::draw(canvas, view, scene, true);
    ways::tubes(canvas, view, scene, &|_, _, _| true);
    canvas.add("</svg>");
    stills::frame(canvas, view, scene);
    stills::bases(canvas, view, scene, mark::MAST);
    ways::draw(canvas, view, scene, &|_, _, _| true);
    flights::draw(canvas, view, scene, options.runs);
    let mut places = Places::new(label_area(layout));
    axes::draw(canvas, layout, &mut places);
    labels_of(canvas, view, scene, &mut places);
}

/// Writes all labels of a panel.
fn labels_of(canvas: &mut Canvas, view: &View, scene: &Scene, places: &mut Places) {
    stills::keep_visible(view, scene, places);
    ways::keep_visible(view, scene, places);
    stills::blocker_names(canvas, view, scene, places);
    ways::names(canvas, view, scene, places);
    stills::other_names(canvas, view, scene, places);
    ways::numbers(canvas, view, scene, places);
}

/// Labels stay in the main panel, or in the air around a thin one.
fn label_area(layout: &Layout) -> Rect {
    let ((x, y), [w, h], [side, above]) = (layout.main.corner, layout.main.size, layout.air);
    Rect { x: x - side, y: y - above, w: w + 2.0 * side, h: h + 2.0 * above }
}

/// The whole file around what was drawn.
fn file(layout: &Layout, height: f64, scene: &Scene, body: &str) -> String {
    let (width, height) = (px(layout.width), px(height + MARGIN));
    let title = escape(&scene.problem.name);
    let description = escape(&description(scene));
    let style = style(scene);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"0 0 {width} {height}\" \
         width=\"{width}\" height=\"{height}\" aria-labelledby=\"title desc\">\n\
         <title id=\"title\">{title}</title>\n<desc id=\"desc\">{description}</desc>\n{style}\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{body}</svg>\n"
    )
}

/// Patterns and styles of everything that is drawn.
fn style(scene: &Scene) -> String {
    match scene.projection.axes() {
        Some(_) => include_str!("style.svg").to_string(),
        None => [include_str!("style.svg"), include_str!("space_style.svg")].concat(),
    }
}

/// The picture in words, for those who can't see it.
fn description(scene: &Scene) -> String {
    let (low, high) = scene.problem.workspace.bounding_box();
    let extent = |(l, h): (&Rational, &Rational)| format!("{:.2} m", h.to_f64() - l.to_f64());
    let extents: Vec<String> = low.iter().zip(&high).map(extent).collect();
    let names = |all: Vec<&str>| if all.is_empty() { "none".to_string() } else { all.join(", ") };
    format!(
        "A plan of {}. Workspace of {}. Robots: {}. Base stations: {}. Jammers and obstacles: {}. \
         Regions: {}.",
        scene.plan.summary(),
        extents.join(" by "),
        names(scene.robots.iter().map(|r| r.name).collect()),
        names(scene.bases.iter().map(|b| b.0).collect()),
        names(scene.blockers.iter().map(|(_, b)| b.name).collect()),
        names(scene.regions.iter().map(|r| r.name).collect()),
    )
}
