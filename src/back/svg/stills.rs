//! What stands still: workspace, regions, obstacles, jammers, bases.

use super::canvas::{Canvas, Pixel, View, px};
use super::labels::{self, Places, Rect};
use super::layout::FONT;
use super::mark;
use super::outline::Outline;
use super::scene::{Scene, Still};
use super::text;
use crate::ir::BlockerKind;

/// Draws the shapes, with the copies that tubes make of them if asked for.
pub fn draw(canvas: &mut Canvas, view: &View, scene: &Scene, copies: bool) {
    for region in &scene.regions {
        pieces(canvas, view, region, "region");
    }
    if copies {
        for region in &scene.regions {
            draw_copies(canvas, view, region, "shrunk");
        }
        // One group for all that has grown: where they overlap it is no darker.
        canvas.add(r#"<g class="kept">"#);
        for (kind, blocker) in &scene.blockers {
            let class = if *kind == BlockerKind::Jammer { "jam" } else { "" };
            blocker.copies.iter().flatten().for_each(|piece| canvas.path(class, &view.path(piece)));
        }
        canvas.add("</g>");
    }
    for (kind, blocker) in &scene.blockers {
        pieces(canvas, view, blocker, class(*kind));
    }
    if copies {
        for (kind, blocker) in &scene.blockers {
            let class = if *kind == BlockerKind::Jammer { "grown jam" } else { "grown" };
            draw_copies(canvas, view, blocker, class);
        }
    }
}

/// Draws the workspace's edge.
pub fn frame(canvas: &mut Canvas, view: &View, scene: &Scene) {
    canvas.path("frame", &view.path(&scene.workspace));
}

/// Draws the base stations.
pub fn bases(canvas: &mut Canvas, view: &View, scene: &Scene, size: f64) {
    for (name, at) in &scene.bases {
        canvas.titled_path("base", &mark::mast(view.pixel(*at), size), name);
    }
}

/// The style of a blocker.
pub fn class(kind: BlockerKind) -> &'static str {
    match kind {
        BlockerKind::Jammer => "jammer",
        BlockerKind::Obstacle => "obstacle",
        BlockerKind::OpaqueObstacle => "opaque",
    }
}

fn pieces(canvas: &mut Canvas, view: &View, still: &Still, class: &str) {
    for piece in &still.pieces {
        canvas.titled_path(class, &view.path(piece), still.name);
    }
}

/// The copies by tube, each tube with a style of its own.
fn draw_copies(canvas: &mut Canvas, view: &View, still: &Still, class: &str) {
    for (tube, copy) in still.copies.iter().enumerate() {
        for piece in copy {
            canvas.path(&format!("{class} t{}", tube % 3), &view.path(piece));
        }
    }
}

/// Keeps labels off bases, and makes them pay for covering edges.
pub fn keep_visible(view: &View, scene: &Scene, places: &mut Places) {
    for (_, at) in &scene.bases {
        places.block(Rect::around(view.pixel(*at), 2.0 * mark::MAST, 2.0 * mark::MAST));
    }
    let blockers = scene.blockers.iter().map(|(_, b)| (b, 0.6));
    for (still, price) in scene.regions.iter().map(|r| (r, 0.3)).chain(blockers) {
        for piece in &still.pieces {
            edge(view, piece).windows(2).for_each(|pair| places.line(pair[0], pair[1], price));
        }
    }
    edge(view, &scene.workspace).windows(2).for_each(|pair| places.line(pair[0], pair[1], 0.8));
}

/// Makes other labels pay for standing in a shape.
fn keep_to_itself(view: &View, still: &Still, price: f64, places: &mut Places) {
    still.pieces.iter().for_each(|piece| places.spot(bounds(view, piece), price));
}

/// The corners of a piece's edge in pixels, the first one again at the end; circles have eight.
fn edge(view: &View, piece: &Outline) -> Vec<Pixel> {
    let r = piece.radius;
    let turned = |[x, y]: [f64; 2]| {
        let count = if r > 0.0 { 8 } else { 1 };
        (0..count).map(move |i| {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(count);
            [x + r * angle.cos(), y + r * angle.sin()]
        })
    };
    let all = Outline::hull(piece.corners.iter().flat_map(|c| turned(*c)).collect());
    let corners = view.pixels(&all.corners);
    corners.iter().chain(corners.first()).copied().collect()
}

/// Writes the blockers' names.
pub fn blocker_names(canvas: &mut Canvas, view: &View, scene: &Scene, places: &mut Places) {
    for (kind, blocker) in &scene.blockers {
        let class = if *kind == BlockerKind::Jammer { "name mid in-jammer" } else { "name mid" };
        shape_name(canvas, view, blocker, class, true, places);
    }
    scene.blockers.iter().for_each(|(_, blocker)| keep_to_itself(view, blocker, 5.0, places));
}

/// Writes the names of bases and regions.
pub fn other_names(canvas: &mut Canvas, view: &View, scene: &Scene, places: &mut Places) {
    for (name, at) in &scene.bases {
        let short = text::cut(name, FONT, true, room(view));
        let w = text::width(&short, FONT, true);
        let distances = [2.0, 14.0, 30.0, 50.0].map(|d| mark::MAST + d);
        if let Some(rect) = places.take(labels::around(view.pixel(*at), w, FONT, &distances), 200.0) {
            label(canvas, &rect, "name mid", &short);
        }
    }
    for region in &scene.regions {
        shape_name(canvas, view, region, "name mid in-region", false, places);
    }
    scene.regions.iter().for_each(|region| keep_to_itself(view, region, 0.5, places));
}

/// How long a name may be.
fn room(view: &View) -> f64 {
    (view.size[0] * 0.45).clamp(90.0, 190.0)
}

/// Writes a shape's name in or at its largest piece.
fn shape_name(
    canvas: &mut Canvas,
    view: &View,
    still: &Still,
    class: &str,
    solid: bool,
    places: &mut Places,
) {
    let boxes = still.pieces.iter().map(|piece| bounds(view, piece));
    let Some(target) = boxes.reduce(|a, b| if b.w * b.h > a.w * a.h { b } else { a }) else { return };
    let short = text::cut(still.name, FONT, true, room(view));
    let w = text::width(&short, FONT, true);
    if let Some(rect) = places.take(labels::about(&target, w, FONT + 1.0, solid), 200.0) {
        leader(canvas, &target, &rect);
        label(canvas, &rect, class, &short);
    }
}

/// Joins a label with what it names, where it stands apart.
fn leader(canvas: &mut Canvas, target: &Rect, rect: &Rect) {
    let near = |from: f64, low: f64, length: f64| from.clamp(low, low + length);
    let (x, y) = target.middle();
    let from = (near(x, rect.x, rect.w), near(y, rect.y, rect.h));
    let to = (near(from.0, target.x, target.w), near(from.1, target.y, target.h));
    if (from.0 - to.0).hypot(from.1 - to.1) > 12.0 {
        canvas.path("leader", &format!("M{} {}L{} {}", px(from.0), px(from.1), px(to.0), px(to.1)));
    }
}

/// Writes a text that is centred in its box.
pub fn label(canvas: &mut Canvas, rect: &Rect, class: &str, contents: &str) {
    // Letters without descenders are centred around 0.36 em above the baseline.
    let (x, y) = rect.middle();
    canvas.haloed((x, y + 0.36 * FONT), class, contents);
}

fn bounds(view: &View, piece: &Outline) -> Rect {
    let (low, high) = piece.bounds();
    let ((x, y), (right, bottom)) = (view.pixel([low[0], high[1]]), view.pixel([high[0], low[1]]));
    Rect { x, y, w: right - x, h: bottom - y }
}
