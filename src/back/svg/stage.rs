//! The stage of the animated page: what of the picture stands still, in layers that the page can hide,
//! and the pieces that move on it.
//!
//! Everything is in the pixels of one drawing, which the still picture shares.

use super::canvas::{Canvas, Pixel, View};
use super::labels::Places;
use super::layout::{Layout, MARGIN, TOP};
use super::legend::{self, Extras};
use super::outline::{Outline, Point};
use super::projection::Projection;
use super::scene::{Mover, Scene};
use super::solids::Stack;
use super::ways::{self, MARK};
use super::{Options, axes, cells, flights, mark, space, stills};
use crate::ir::Problem;
use crate::plan::Plan;

/// How wide the legend beside the stage is.
const LEGEND: f64 = 340.0;

/// A drawing with a size, in pixels.
pub struct Drawing {
    /// Left and upper edge, width, height: what `viewBox` wants.
    pub frame: [f64; 4],
    /// SVG elements.
    pub body: String,
}

/// A robot that moves on the stage.
pub struct Actor {
    /// The colour of its lines.
    pub color: &'static str,
    /// The class of its name.
    pub ink: String,
    /// The path of its mark around the origin.
    pub mark: String,
    /// The path of its tube around the origin.
    pub tube: String,
    /// Its nominal position at each step.
    pub points: Vec<Pixel>,
    /// In space: the points of the floor right below.
    pub feet: Vec<Pixel>,
    /// Its position at each step of each simulated run.
    pub runs: Vec<Vec<Pixel>>,
}

/// What the page moves things on.
pub struct Stage {
    /// Styles and patterns, to stand before any drawing.
    pub style: String,
    /// What lies below the robots.
    pub below: Drawing,
    /// What lies above them: labels.
    pub above: String,
    /// Every mark that is used.
    pub legend: Drawing,
    /// The robots, in the plan's order.
    pub actors: Vec<Actor>,
    /// The base stations, in the problem's order.
    pub bases: Vec<Pixel>,
    /// At each step where each of the plan's links can be: its outline, empty for a link that lacks
    /// an end.
    pub beams: Vec<Vec<String>>,
}

impl Stage {
    /// The stage of a plan, which need not fit its problem.
    pub fn new(problem: &Problem, plan: &Plan, options: &Options) -> Stage {
        let in_space = problem.dimension > 2;
        let projection = if in_space { Projection::axonometric() } else { Projection::TOP };
        let mut scene = Scene::new(problem, plan, projection);
        if in_space {
            // Nothing that a tube grew or shrank is drawn, so the legend has none of it.
            scene.tubes.clear();
        }
        let layout = Layout::new(&scene.workspace);
        let view = &layout.main;
        let (below, above) = if in_space {
            space::stage(&layout, &scene, problem, options.runs)
        } else {
            flat(&layout, &scene, options)
        };
        let top = TOP - MARGIN;
        let width = (view.corner.0 + view.size[0] + layout.air[0] + MARGIN).max(layout.width.min(500.0));
        let frame = [0.0, top, width, layout.main_bottom() - top];
        Stage {
            style: super::style(&scene),
            below: Drawing { frame, body: below },
            above,
            legend: legend_of(&scene, &layout, options),
            actors: actors(&scene, view, problem, options),
            bases: scene.bases.iter().map(|(_, at)| view.pixel(*at)).collect(),
            beams: beams(&scene, view),
        }
    }
}

/// The layers of a mission in the plane.
fn flat(layout: &Layout, scene: &Scene, options: &Options) -> (String, String) {
    let (view, mut canvas) = (&layout.main, Canvas::default());
    canvas.add(&format!("<svg {}>", view.window()));
    cells::draw(&mut canvas, view, options.cells);
    axes::grid(&mut canvas, view);
    stills::draw(&mut canvas, view, scene, true);
    layer(&mut canvas, "tubes", |canvas| ways::tubes(canvas, view, scene, &|_, _, _| true));
    canvas.add("</svg>");
    stills::frame(&mut canvas, view, scene);
    layer(&mut canvas, "runs", |canvas| flights::draw(canvas, view, scene, options.runs));
    stills::bases(&mut canvas, view, scene, mark::MAST);
    layer(&mut canvas, "ways", |canvas| ways::draw(canvas, view, scene, &|_, _, _| true));
    let mut places = Places::new(super::label_area(layout));
    axes::draw(&mut canvas, layout, &mut places);
    (canvas.finish(), labels(view, scene, &mut places))
}

/// Draws a group that the page can hide.
pub fn layer(canvas: &mut Canvas, class: &str, draw: impl FnOnce(&mut Canvas)) {
    canvas.add(&format!(r#"<g class="layer-{class}">"#));
    draw(canvas);
    canvas.add("</g>");
}

/// The labels of what stands still; the robots carry theirs along.
pub fn labels(view: &View, scene: &Scene, places: &mut Places) -> String {
    let mut canvas = Canvas::default();
    stills::keep_visible(view, scene, places);
    ways::keep_visible(view, scene, places);
    layer(&mut canvas, "labels", |canvas| {
        stills::blocker_names(canvas, view, scene, places);
        stills::other_names(canvas, view, scene, places);
        layer(canvas, "ways", |canvas| ways::numbers(canvas, view, scene, places));
    });
    canvas.finish()
}

/// The ways and tubes of a mission in space, between the solids.
pub fn between_solids(canvas: &mut Canvas, view: &View, scene: &Scene, stack: &Stack) {
    for index in 0..=stack.count() {
        let shown = |robot: usize, from: usize, to: usize| {
            let positions = &scene.robots[robot].positions;
            stack.layer(&positions[from], &positions[to]) == index
        };
        layer(canvas, "tubes", |canvas| ways::tubes(canvas, view, scene, &shown));
        layer(canvas, "ways", |canvas| ways::draw(canvas, view, scene, &shown));
        stack.draw(canvas, view, index);
    }
}

/// Every mark that the stage uses.
fn legend_of(scene: &Scene, layout: &Layout, options: &Options) -> Drawing {
    let extras = Extras {
        links: (0..scene.steps()).any(|step| !scene.links(step).is_empty()),
        cells: !options.cells.is_empty(),
        space: scene.projection.axes().is_none(),
        runs: options.runs.len(),
    };
    let place = Layout { legend: (2.0, 2.0), legend_width: LEGEND - 4.0, ..*layout };
    let mut canvas = Canvas::default();
    let height = legend::draw(&mut canvas, &place, scene, extras);
    Drawing { frame: [0.0, 0.0, LEGEND, height + 2.0], body: canvas.finish() }
}

fn actors(scene: &Scene, view: &View, problem: &Problem, options: &Options) -> Vec<Actor> {
    let around_origin = View { low: [0.0, 0.0], corner: (0.0, 0.0), size: [0.0, 0.0], scale: view.scale };
    let floor = space::floor(problem);
    let foot = |p: &Vec<f64>| view.pixel(scene.projection.flat(&[p[0], p[1], floor]));
    let flown = |way: Option<&Vec<Vec<f64>>>| {
        let positions = way.map_or(&[][..], Vec::as_slice);
        positions.iter().map(|p| view.pixel(scene.projection.flat(p))).collect()
    };
    let actor = |(index, robot): (usize, &Mover)| Actor {
        color: mark::color(index),
        ink: mark::ink(index),
        mark: mark::path(index, (0.0, 0.0), MARK + 3.0),
        tube: around_origin.path(&robot.tube),
        points: view.pixels(&robot.points),
        feet: if problem.dimension > 2 && robot.positions.iter().all(|p| p.len() == 3) {
            robot.positions.iter().map(foot).collect()
        } else {
            Vec::new()
        },
        runs: options.runs.iter().map(|run| flown(run.ways.get(index))).collect(),
    };
    scene.robots.iter().enumerate().map(actor).collect()
}

fn beams(scene: &Scene, view: &View) -> Vec<Vec<String>> {
    let outline = |ends: Option<[(Outline, Point); 2]>| {
        ends.map(|[(a, _), (b, _)]| view.path(&a.joined(&b))).unwrap_or_default()
    };
    (0..scene.steps()).map(|step| scene.all_links(step).map(outline).collect()).collect()
}
