//! The animated page of a plan: one file that needs nothing else, no network and no server.
//!
//! Without its script it is the picture of [`svg`](super::svg) with the goals below it. The script puts
//! the picture's stage in its place and moves the robots on it. What it moves is data in a JSON block;
//! no text of a mission becomes markup or code, and the page's policy lets nothing run but the script
//! whose hash it names. The same plan gives the same bytes.

mod formula;
mod goals;
mod motion;
mod template;

use std::fmt::Write;

use crate::back::Artifact;
use crate::back::svg::{self, Drawing, Options, Stage, escape};
use crate::ir::{BlockerKind, Problem};
use crate::plan::Plan;
use motion::Motion;

/// The file's name where none is asked for.
pub const NAME: &str = "plan.html";

/// The page of a plan of a problem.
pub fn write(problem: &Problem, plan: &Plan, options: &Options) -> Artifact {
    let stage = Stage::new(problem, plan, options);
    let motion = Motion::new(problem, plan, &stage, options.runs);
    // What can't be written as JSON does not occur in it: keys are fields, numbers may be null.
    let data = serde_json::to_string(&motion).unwrap_or_default();
    let still = svg::draw(problem, plan, options).contents;
    let page = template::fill(
        include_str!("page.html"),
        &[
            ("policy", &template::policy()),
            ("title", &escape(&problem.name)),
            ("doc", &paragraphs(&problem.doc)),
            ("summary", &escape(&plan.summary())),
            ("style", include_str!("page.css")),
            ("still", &still),
            ("stage", &drawing(&stage.below, "stage", &[&stage.style], &layers(&stage))),
            ("legend", &drawing(&stage.legend, "stage", &[], "")),
            ("goals", &goals::write(problem, plan)),
            ("places", &places(problem)),
            ("source", &escape(&source(problem, plan))),
            ("data", &template::harmless_json(&data)),
            ("script", template::SCRIPT),
        ],
    );
    Artifact { name: NAME.into(), contents: page }
}

/// A drawing as an element of the page.
fn drawing(drawing: &Drawing, class: &str, before: &[&str], after: &str) -> String {
    let [x, y, width, height] = drawing.frame.map(|v| format!("{v:.2}"));
    let before = before.concat();
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"{class}\" viewBox=\"{x} {y} {width} {height}\" \
         role=\"group\">\n{before}{}{after}</svg>",
        drawing.body
    )
}

/// The groups that the script fills, and what stands above them.
fn layers(stage: &Stage) -> String {
    let group = |name: &str| format!("<g data-layer=\"{name}\"></g>\n");
    let [beams, shadows, trails, tubes] = ["beams", "shadows", "trails", "tubes"].map(group);
    let [links, dots, robots, names] = ["links", "dots", "robots", "names"].map(group);
    [&beams, &shadows, &trails, &tubes, &links, &dots, &stage.above, &robots, &names]
        .map(String::as_str)
        .concat()
}

/// A documentation comment as paragraphs.
fn paragraphs(doc: &str) -> String {
    let paragraph = |text: &str| format!("<p>{}</p>\n", escape(text.trim()));
    doc.split("\n\n").filter(|text| !text.trim().is_empty()).map(paragraph).collect()
}

/// What there is in the workspace, with its documentation.
fn places(problem: &Problem) -> String {
    let mut rows = String::new();
    let mut row = |name: &str, kind: &str, doc: &str| {
        let (name, doc) = (escape(name), escape(doc.trim()));
        // Writing to a string can't fail.
        let _ = writeln!(rows, "<tr><th scope=\"row\">{name}</th><td>{kind}</td><td>{doc}</td></tr>");
    };
    problem.regions.values().for_each(|region| row(&region.name, "region", &region.doc));
    for blocker in problem.blockers.values() {
        let kind = match blocker.kind {
            BlockerKind::Jammer => "jammer",
            BlockerKind::Obstacle => "obstacle",
            BlockerKind::OpaqueObstacle => "opaque obstacle",
        };
        row(&blocker.name, kind, &blocker.doc);
    }
    problem.bases.values().for_each(|base| row(&base.name, "base", &base.doc));
    rows
}

/// What the page was made from.
fn source(problem: &Problem, plan: &Plan) -> String {
    let set: Vec<String> =
        plan.mission.set.iter().map(|(name, value)| format!("--set {name}={value}")).collect();
    let set = if set.is_empty() { String::new() } else { format!(" with {}", set.join(" ")) };
    let sha =
        if problem.sha256.is_empty() { String::new() } else { format!(" (SHA-256 {})", problem.sha256) };
    format!("A plan of {}{sha}{set}, made by {}.", problem.name, plan.tool)
}
