//! The legend: every mark that the picture uses, and no other.

use super::canvas::{Canvas, Pixel, open, px};
use super::flights;
use super::layout::{FONT, Layout};
use super::mark;
use super::scene::Scene;
use super::stills;
use super::text;
use super::ways::{MARK, START, arrow};
use crate::ir::{BlockerKind, Connectivity, Norm};

/// The most robots listed by name.
const MOST_ROBOTS: usize = 24;
/// Pixels a row.
const ROW: f64 = 23.0;
/// A swatch's width, and where its text begins.
const SWATCH: f64 = 32.0;
const TEXT: f64 = 39.0;

/// One entry.
struct Entry {
    text: String,
    swatch: Swatch,
}

/// What stands before the text.
enum Swatch {
    /// A robot's mark.
    Robot(usize),
    /// Nothing.
    None,
    /// The way before the loop.
    Prefix,
    /// The loop.
    Loop,
    /// The mark of a loop of one step, or of the loop's first step.
    Ring,
    /// The mark of a start.
    Start,
    /// Where a robot can be at the steps and between them.
    Tube,
    /// Simulated runs.
    Runs,
    /// A link.
    Link,
    /// A shadow.
    Shadow,
    /// A base station.
    Base,
    /// A box with a class.
    Box(String),
    /// A box with a class in a larger one.
    Grown(String),
}

/// What only some pictures have.
#[derive(Clone, Copy)]
pub struct Extras {
    /// Links, at some of the moments shown.
    pub links: bool,
    /// The cells of a partition.
    pub cells: bool,
    /// How many simulated runs.
    pub runs: usize,
    /// Shadows on the floor, in space.
    pub space: bool,
}

/// Draws the legend, and says where it ends.
pub fn draw(canvas: &mut Canvas, layout: &Layout, scene: &Scene, extras: Extras) -> f64 {
    let (left, top) = layout.legend;
    let room = layout.legend_width;
    let mut y = top;
    let marks = [moving(scene, extras), still(scene, extras.cells)].into_iter().flatten().collect();
    for entries in [robots(scene), marks] {
        let mut x = left;
        for entry in &entries {
            let short = text::cut(&entry.text, FONT, false, room - TEXT);
            let width = TEXT + text::width(&short, FONT, false);
            if x > left && x + width > left + room {
                x = left;
                y += ROW;
            }
            swatch(canvas, (x, y + ROW / 2.0), &entry.swatch);
            canvas.text((x + TEXT, y + ROW / 2.0 + 0.36 * FONT), "", &short);
            // What is measured is a bound: with most fonts a tenth of it stays empty.
            x += (0.92 * width).max(width - 11.0) + 14.0;
        }
        if !entries.is_empty() {
            y += ROW;
        }
    }
    y
}

fn robots(scene: &Scene) -> Vec<Entry> {
    let named = |(index, robot): (usize, &super::scene::Mover)| Entry {
        text: robot.name.into(),
        swatch: Swatch::Robot(index),
    };
    let mut entries: Vec<Entry> = scene.robots.iter().enumerate().take(MOST_ROBOTS).map(named).collect();
    if scene.robots.len() > MOST_ROBOTS {
        let text = format!("and {} more", scene.robots.len() - MOST_ROBOTS);
        entries.push(Entry { text, swatch: Swatch::None });
    }
    entries
}

/// What a link is, and what is asked of all of them.
fn links(asked: Option<&Connectivity>) -> String {
    let Some(Connectivity { hops, range, redundancy, every }) = asked else { return "radio link".into() };
    let many = |count: u32, one: &str, more: &str| {
        if count == 1 { format!("1 {one}") } else { format!("{count} {more}") }
    };
    let range = range.as_ref().map(|range| {
        let axes = if range.norm == Norm::Infinity { " along each axis" } else { "" };
        format!("at most {} m{axes}", number(range.length.to_f64()))
    });
    let hops = hops.map(|hops| format!("{} to a base", many(hops, "link", "links")));
    let lost = (*redundancy > 0).then(|| format!("{} may be lost", many(*redundancy, "robot", "robots")));
    let every = (*every > 1).then(|| format!("asked every {every} steps"));
    let parts: Vec<String> = [range, hops, lost, every].into_iter().flatten().collect();
    if parts.is_empty() { "radio link".into() } else { format!("radio link ({})", parts.join(", ")) }
}

/// A number of metres to the millimetre, without trailing zeros.
fn number(metres: f64) -> String {
    let text = format!("{metres:.3}");
    text.trim_end_matches('0').trim_end_matches('.').into()
}

/// What the ways are drawn with.
fn moving(scene: &Scene, extras: Extras) -> Vec<Entry> {
    let mut entries = Vec::new();
    let mut add = |swatch, text: &str| entries.push(Entry { text: text.into(), swatch });
    add(Swatch::Start, "start");
    if scene.loop_start() > 0 {
        add(Swatch::Prefix, "before the loop");
    }
    if scene.stays() {
        add(Swatch::Ring, "stays for ever");
    } else {
        add(Swatch::Loop, "the loop, for ever");
        add(Swatch::Ring, "the loop begins");
    }
    add(Swatch::Tube, "where it can be");
    match extras.runs {
        0 => {}
        1 => add(Swatch::Runs, "a simulated run"),
        many => add(Swatch::Runs, &format!("{many} simulated runs")),
    }
    if extras.links {
        add(Swatch::Link, &links(scene.problem.connectivity.as_ref()));
    }
    if extras.space {
        add(Swatch::Shadow, "its shadow on the floor");
    }
    entries
}

/// The marks of what stands still, as far as the mission has it.
fn still(scene: &Scene, cells: bool) -> Vec<Entry> {
    let mut entries = Vec::new();
    let mut add = |swatch, text: &str| entries.push(Entry { text: text.into(), swatch });
    let kinds = [
        (BlockerKind::Jammer, "jammer"),
        (BlockerKind::Obstacle, "obstacle"),
        (BlockerKind::OpaqueObstacle, "opaque obstacle"),
    ];
    for (kind, text) in kinds {
        if scene.blockers.iter().any(|(k, _)| *k == kind) {
            add(Swatch::Box(stills::class(kind).into()), text);
        }
    }
    let several = scene.tubes.len() > 1;
    let whose = |index: usize| if several { format!(" of {}", scene.tubes[index]) } else { String::new() };
    let jammed = scene.blockers.iter().any(|(kind, _)| *kind == BlockerKind::Jammer);
    if !scene.blockers.is_empty() {
        for index in 0..scene.tubes.len() {
            let class = if jammed { "grown jam" } else { "grown" };
            add(
                Swatch::Grown(format!("{class} t{}", index % 3)),
                &format!("grown by the tube{}", whose(index)),
            );
        }
    }
    if !scene.regions.is_empty() {
        add(Swatch::Box("region".into()), "region");
        for index in 0..scene.tubes.len() {
            add(
                Swatch::Box(format!("shrunk t{}", index % 3)),
                &format!("shrunk by the tube{}", whose(index)),
            );
        }
    }
    if cells {
        add(Swatch::Box("cell".into()), "cell of the partition");
    }
    if !scene.bases.is_empty() {
        add(Swatch::Base, "base");
    }
    entries
}

/// Draws a swatch whose left edge's middle is given.
fn swatch(canvas: &mut Canvas, (x, y): Pixel, swatch: &Swatch) {
    let middle = (x + SWATCH / 2.0, y);
    let line = open(&[(x, y), (x + SWATCH, y)]);
    match swatch {
        Swatch::None => {}
        Swatch::Robot(index) => {
            grouped(canvas, mark::color(*index), &[("stop", mark::path(*index, middle, MARK + 2.5))])
        }
        Swatch::Prefix => grouped(canvas, GREY, &[("prefix", line), ("passed", mark::path(0, middle, MARK))]),
        Swatch::Loop => {
            grouped(canvas, GREY, &[("loop", line)]);
            arrow(canvas, GREY, (x, y), (x + SWATCH, y));
        }
        Swatch::Ring => {
            grouped(
                canvas,
                GREY,
                &[("ring", mark::path(0, middle, MARK + 4.5)), ("stop", mark::path(0, middle, MARK))],
            );
        }
        Swatch::Start => grouped(canvas, GREY, &[("passed", mark::path(0, middle, START))]),
        Swatch::Tube => {
            canvas.add(&format!(
                r#"<g class="swept" fill="{GREY}"><path d="{}"/></g>"#,
                boxed(x, y, SWATCH, 16.0)
            ));
            let ends = [boxed(x, y, 16.0, 16.0), boxed(x + SWATCH - 16.0, y, 16.0, 16.0)].concat();
            canvas.add(&format!(r#"<g class="tube" stroke="{GREY}"><path d="{ends}"/></g>"#));
        }
        Swatch::Runs => {
            let line = |dy: f64| open(&[(x, y + dy), (x + SWATCH / 2.0, y - dy / 2.0), (x + SWATCH, y + dy)]);
            canvas.add(&flights::group(GREY));
            [-3.0, 0.0, 3.0].iter().for_each(|dy| canvas.path("", &line(*dy)));
            canvas.add("</g>");
        }
        Swatch::Link => {
            canvas.add(&format!(r#"<g class="beam"><path d="{}"/></g>"#, boxed(x, y, SWATCH, 14.0)));
            canvas.path("link", &line);
        }
        Swatch::Shadow => canvas.path("shadow", &line),
        Swatch::Base => canvas.path("base", &mark::mast(middle, mark::MAST)),
        Swatch::Box(class) => canvas.path(class, &boxed(x, y, SWATCH, 16.0)),
        Swatch::Grown(class) => {
            canvas.add(&format!(
                r#"<g class="kept"><path class="{class}" d="{}"/></g>"#,
                boxed(x, y, SWATCH, 16.0)
            ));
            canvas.path(class, &boxed(x, y, SWATCH, 16.0));
        }
    }
}

/// The colour of what belongs to every robot.
const GREY: &str = "#4b535d";

fn grouped(canvas: &mut Canvas, color: &str, paths: &[(&str, String)]) {
    canvas.add(&format!(r#"<g stroke="{color}" fill="{color}">"#));
    paths.iter().for_each(|(class, d)| canvas.path(class, d));
    canvas.add("</g>");
}

/// A box by the middle of its left edge.
fn boxed(x: f64, y: f64, width: f64, height: f64) -> String {
    format!("M{} {}h{}v{}h{}Z", px(x), px(y - height / 2.0), px(width), px(height), px(-width))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::Rational;
    use crate::ir::Range;

    #[test]
    fn a_link_says_what_is_asked_of_it() {
        let plain = Connectivity { hops: None, range: None, redundancy: 0, every: 1 };
        assert_eq!(links(None), "radio link");
        assert_eq!(links(Some(&plain)), "radio link");
        let range = |norm| Some(Range { length: Rational::ratio(21, 4), norm });
        let round = Connectivity { range: range(Norm::Euclidean), ..plain.clone() };
        assert_eq!(links(Some(&round)), "radio link (at most 5.25 m)");
        let all = Connectivity { hops: Some(2), range: range(Norm::Infinity), redundancy: 1, every: 4 };
        let said = "radio link (at most 5.25 m along each axis, 2 links to a base, 1 robot may be lost, \
                    asked every 4 steps)";
        assert_eq!(links(Some(&all)), said);
    }
}
