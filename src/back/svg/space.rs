//! The picture of a plan in space: an axonometric view with the shadows of the ways on the floor,
//! below it the views from above, from the front and from the right at one scale, then the links at
//! chosen moments.

use super::canvas::{Canvas, Pixel, View, open, px};
use super::labels::{Places, Rect};
use super::layout::{LEFT, Layout, MARGIN, MOMENTS, SMALL};
use super::outline::Point;
use super::projection::Projection;
use super::scene::Scene;
use super::solids::Stack;
use super::{axes, flights, legend, mark, moments, panels, solids, stage, stills, text, ways};
use crate::back::Flight;
use crate::exact::Rational;
use crate::ir::Problem;
use crate::plan::Plan;

/// Room for a view's caption.
const CAPTION: f64 = 24.0;
/// Room below a view, for the numbers along its axis.
const NUMBERS: f64 = 30.0;
/// All three views together are at most so high.
const HIGHEST: f64 = 640.0;
/// The legend stands beside the view from above where it has so much room.
const BESIDE: f64 = 215.0;

/// Draws a plan of a problem in space: the whole file.
pub fn draw(problem: &Problem, plan: &Plan, runs: &[Flight]) -> String {
    let space = Scene::new(problem, plan, Projection::axonometric());
    let layout = Layout::new(&space.workspace);
    let room = Room::new(problem);
    let mut canvas = Canvas::default();
    super::title(&mut canvas, &layout, &space);
    axonometric(&mut canvas, &layout, &space, &room, runs);
    let moments = moments::choose(&space, MOMENTS);
    let links = moments.iter().any(|m| !space.links(m.step).is_empty());
    let extras = legend::Extras { links, cells: false, runs: runs.len(), space: true };
    let bottom = views(&mut canvas, &layout, problem, plan, &room, extras);
    let bottom = panels::draw(&mut canvas, &layout, &space, &moments, bottom + 14.0);
    super::file(&layout, bottom, &space, &canvas.finish())
}

/// The box around the workspace.
struct Room {
    low: Vec<f64>,
    high: Vec<f64>,
}

impl Room {
    fn new(problem: &Problem) -> Room {
        let (low, high) = problem.workspace.bounding_box();
        let floats = |v: Vec<Rational>| v.iter().map(Rational::to_f64).collect();
        Room { low: floats(low), high: floats(high) }
    }

    fn extent(&self, axis: usize) -> f64 {
        self.high[axis] - self.low[axis]
    }

    /// A point of the floor.
    fn floor(&self, x: f64, y: f64) -> [f64; 3] {
        [x, y, self.low[2]]
    }
}

/// The layers of the page's stage: what lies below the robots, and the labels.
pub fn stage(layout: &Layout, scene: &Scene, problem: &Problem, runs: &[Flight]) -> (String, String) {
    let (view, room, mut canvas) = (&layout.main, Room::new(problem), Canvas::default());
    floor_and_walls(&mut canvas, view, scene, &room);
    stage::layer(&mut canvas, "ways", |canvas| shadows(canvas, view, scene, &room));
    stage::between_solids(&mut canvas, view, scene, &Stack::new(problem, &scene.projection));
    stage::layer(&mut canvas, "runs", |canvas| flights::draw(canvas, view, scene, runs));
    stills::bases(&mut canvas, view, scene, mark::MAST);
    solids::room(&mut canvas, view, problem, &scene.projection, true);
    let mut places = places(view);
    numbers(&mut canvas, view, scene, &room, &mut places);
    (canvas.finish(), stage::labels(view, scene, &mut places))
}

/// The height of the floor: 0 for a mission in the plane.
pub fn floor(problem: &Problem) -> f64 {
    Room::new(problem).low.get(2).copied().unwrap_or(0.0)
}

/// Labels stay in the panel.
fn places(view: &View) -> Places {
    let ((x, y), [w, h]) = (view.corner, view.size);
    Places::new(Rect { x, y, w, h })
}

fn axonometric(canvas: &mut Canvas, layout: &Layout, scene: &Scene, room: &Room, runs: &[Flight]) {
    let (view, projection) = (&layout.main, &scene.projection);
    floor_and_walls(canvas, view, scene, room);
    shadows(canvas, view, scene, room);
    let stack = Stack::new(scene.problem, projection);
    for layer in 0..=stack.count() {
        let place = |robot: usize, from: usize, to: usize| {
            let positions = &scene.robots[robot].positions;
            stack.layer(&positions[from], &positions[to])
        };
        let shown = |robot: usize, from: usize, to: usize| place(robot, from, to) == layer;
        ways::tubes(canvas, view, scene, &shown);
        stems(canvas, view, scene, room, |p, floor| stack.layer(p, floor) == layer);
        ways::draw(canvas, view, scene, &shown);
        stack.draw(canvas, view, layer);
    }
    flights::draw(canvas, view, scene, runs);
    stills::bases(canvas, view, scene, mark::MAST);
    solids::room(canvas, view, scene.problem, projection, true);
    let mut places = places(view);
    numbers(canvas, view, scene, room, &mut places);
    super::labels_of(canvas, view, scene, &mut places);
}

/// What lies behind everything: the walls and the floor's grid.
fn floor_and_walls(canvas: &mut Canvas, view: &View, scene: &Scene, room: &Room) {
    let projection = &scene.projection;
    solids::room(canvas, view, scene.problem, projection, false);
    let ends = |axis: usize| {
        let drawn = axes::ticks(room.low[axis], room.extent(axis), along(view, scene, room, axis));
        drawn.into_iter().map(|(value, _)| value)
    };
    let line = |a: [f64; 3], b: [f64; 3]| open(&[pixel(view, scene, &a), pixel(view, scene, &b)]);
    let mut grid = String::new();
    ends(0).for_each(|x| grid += &line(room.floor(x, room.low[1]), room.floor(x, room.high[1])));
    ends(1).for_each(|y| grid += &line(room.floor(room.low[0], y), room.floor(room.high[0], y)));
    canvas.path("grid", &grid);
}

fn pixel(view: &View, scene: &Scene, point: &[f64]) -> Pixel {
    view.pixel(scene.projection.flat(point))
}

/// How long an axis of the room is drawn.
fn along(view: &View, scene: &Scene, room: &Room, axis: usize) -> f64 {
    let mut end = room.low.clone();
    end[axis] = room.high[axis];
    let (a, b) = (pixel(view, scene, &room.low), pixel(view, scene, &end));
    (a.0 - b.0).hypot(a.1 - b.1)
}

/// The ways on the floor, right below where they are.
fn shadows(canvas: &mut Canvas, view: &View, scene: &Scene, room: &Room) {
    for robot in &scene.robots {
        let on_floor = |p: &Vec<f64>| scene.projection.flat(&room.floor(p[0], p[1]));
        let points: Vec<Point> = robot.positions.iter().filter(|p| p.len() == 3).map(on_floor).collect();
        if points.len() > 1 {
            canvas.path("shadow", &open(&view.pixels(&points)));
        }
    }
}

/// Thin lines from the steps down to the floor, as far as they are shown.
fn stems(
    canvas: &mut Canvas,
    view: &View,
    scene: &Scene,
    room: &Room,
    shown: impl Fn(&[f64], &[f64]) -> bool,
) {
    for (index, robot) in scene.robots.iter().enumerate() {
        let mut lines = String::new();
        for p in robot.positions.iter().filter(|p| p.len() == 3) {
            let foot = room.floor(p[0], p[1]);
            if shown(p, &foot) {
                lines += &open(&[pixel(view, scene, p), pixel(view, scene, &foot)]);
            }
        }
        if !lines.is_empty() {
            canvas.add(&format!(r#"<path class="stem" stroke="{}" d="{lines}"/>"#, mark::color(index)));
        }
    }
}

/// The numbers along three edges of the room: x and y before the floor, z at its left.
fn numbers(canvas: &mut Canvas, view: &View, scene: &Scene, room: &Room, places: &mut Places) {
    let edge = view.corner.0 + view.size[0] + MARGIN - 3.0;
    // Where each axis is drawn, and where its numbers stand beside it.
    let edges = [
        (room.low.clone(), (-5.0, 17.0), "tick mid", -0.5),
        (room.floor(room.high[0], room.low[1]).to_vec(), (7.0, 14.0), "tick", 0.0),
        (room.low.clone(), (-8.0, 4.5), "tick end", -1.0),
    ];
    let mut taken: Vec<Rect> = Vec::new();
    let mut marks = String::new();
    for (axis, (origin, (dx, dy), class, shift)) in edges.into_iter().enumerate() {
        let at = |value: f64| {
            let mut point = origin.clone();
            point[axis] = value;
            pixel(view, scene, &point)
        };
        let mut write = |canvas: &mut Canvas, (x, y): Pixel, contents: &str| {
            let width = text::width(contents, SMALL, false);
            // At the right end a long number is moved below its mark.
            let x = x.min(edge - (1.0 + shift) * width);
            let rect = Rect { x: x + shift * width, y: y - SMALL, w: width, h: SMALL + 2.0 };
            if taken.iter().all(|t| !t.overlaps(&rect)) {
                taken.push(rect);
                axes::small(canvas, places, (x, y), class, contents, shift);
            }
        };
        let middle = at(0.5 * (room.low[axis] + room.high[axis]));
        let away = if axis == 2 { (dx - 18.0, dy) } else { (1.6 * dx, dy + 15.0) };
        write(canvas, (middle.0 + away.0, middle.1 + away.1), ["x", "y", "z"][axis]);
        for (value, number) in axes::ticks(room.low[axis], room.extent(axis), along(view, scene, room, axis))
        {
            let (x, y) = at(value);
            marks +=
                &format!("M{} {}l{} {}", px(x), px(y), px(0.5 * dx), px(if axis == 2 { 0.0 } else { 4.0 }));
            write(canvas, (x + dx, y + dy), &number);
        }
    }
    canvas.path("tickmark", &marks);
}

/// The views along the axes at one scale, and the legend; says where they end.
fn views(
    canvas: &mut Canvas,
    layout: &Layout,
    problem: &Problem,
    plan: &Plan,
    room: &Room,
    extras: legend::Extras,
) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|axis| room.extent(axis));
    let width = layout.width - 2.0 * LEFT - MARGIN;
    let scale = (width / (x + y)).min(HIGHEST / (y + z));
    let top = layout.main_bottom() + CAPTION;
    let right = LEFT + x * scale + LEFT;
    let above =
        View { low: [room.low[0], room.low[1]], corner: (LEFT, top), size: [x * scale, y * scale], scale };
    let scene = Scene::new(problem, plan, Projection::TOP);
    panel(canvas, &above, &scene, "from above");
    let mut bottom = top + above.size[1] + NUMBERS;
    let beside = layout.width - right - MARGIN >= BESIDE;
    if beside {
        let area = Layout { legend: (right, top), legend_width: layout.width - right - MARGIN, ..*layout };
        bottom = bottom.max(legend::draw(canvas, &area, &scene, extras) + 6.0);
    }
    let second = bottom + CAPTION;
    let front =
        View { low: [room.low[0], room.low[2]], corner: (LEFT, second), size: [x * scale, z * scale], scale };
    panel(canvas, &front, &Scene::new(problem, plan, Projection::FRONT), "from the front");
    let side = View {
        low: [room.low[1], room.low[2]],
        corner: (right, second),
        size: [y * scale, z * scale],
        scale,
    };
    panel(canvas, &side, &Scene::new(problem, plan, Projection::SIDE), "from the right");
    let row = second + z * scale + NUMBERS + 16.0;
    let mut places = Places::default();
    axes::small(canvas, &mut places, (LEFT, row), "tick", "x, y, z in metres", 0.0);
    let all = View { size: [x * scale + LEFT + y * scale, above.size[1]], ..front };
    axes::scale_bar(canvas, &all, &mut places, row);
    let bottom = row + 10.0;
    if beside {
        return bottom;
    }
    let area = Layout { legend: (MARGIN, bottom), legend_width: layout.width - 2.0 * MARGIN, ..*layout };
    legend::draw(canvas, &area, &scene, extras)
}

/// One view along an axis.
fn panel(canvas: &mut Canvas, view: &View, scene: &Scene, caption: &str) {
    let (x, y) = view.corner;
    let names = scene.projection.axes().unwrap_or([0, 1]).map(|axis| ["x", "y", "z"][axis]);
    let caption = format!("{caption}: {}, {}", names[0], names[1]);
    canvas.text((x, y - 8.0), "sub", &caption);
    canvas.add(&format!("<svg {}>", view.window()));
    axes::grid(canvas, view);
    stills::draw(canvas, view, scene, true);
    ways::tubes(canvas, view, scene, &|_, _, _| true);
    canvas.add("</svg>");
    stills::frame(canvas, view, scene);
    stills::bases(canvas, view, scene, mark::MAST * 0.8);
    ways::draw(canvas, view, scene, &|_, _, _| true);
    let mut places = Places::new(Rect { x, y, w: view.size[0], h: view.size[1] });
    axes::marks(canvas, view, &mut places);
    super::labels_of(canvas, view, scene, &mut places);
}
