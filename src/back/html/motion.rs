//! What the page's script is given: who is where at each step, in the pixels of the stage, and the
//! numbers that it shows.

use serde::Serialize;

use crate::back::Flight;
use crate::back::svg::{Actor, Stage};
use crate::diag::printable;
use crate::ir::{Model, Problem, Signal};
use crate::plan::{Label, Plan, RobotPlan};

/// A point of the stage.
type Point = [f64; 2];

/// The whole plan as it is shown.
#[derive(Serialize)]
pub struct Motion {
    step_s: f64,
    length: usize,
    loop_start: usize,
    robots: Vec<Robot>,
    bases: Vec<Base>,
    /// By step, the plan's links; nothing where none are asked.
    links: Vec<Vec<Link>>,
    /// By step and robot: whom it talks to, and how many links there are to a base.
    hops: Vec<Vec<Option<(usize, usize)>>>,
    /// How many simulated runs there are.
    runs: usize,
}

#[derive(Serialize)]
struct Robot {
    name: String,
    doc: String,
    dynamics: String,
    color: &'static str,
    ink: String,
    mark: String,
    tube: String,
    points: Vec<Point>,
    feet: Vec<Point>,
    runs: Vec<Vec<Point>>,
    /// Names and units of states and inputs.
    states: Vec<(String, String)>,
    inputs: Vec<(String, String)>,
    z: Vec<Vec<f64>>,
    v: Vec<Vec<f64>>,
    /// By region that the goals ask of this robot: a letter a step, `i` in, `o` out, `u` unknown.
    regions: Vec<(String, String)>,
}

#[derive(Serialize)]
struct Base {
    name: String,
    at: Point,
}

/// A link between two nodes: robots come first, then bases. `beam` is where it can be.
#[derive(Serialize)]
struct Link {
    ends: [usize; 2],
    beam: String,
}

impl Motion {
    /// The motion of a plan on its stage.
    pub fn new(problem: &Problem, plan: &Plan, stage: &Stage, runs: &[Flight]) -> Motion {
        let places = plan.robots.iter().zip(&stage.actors);
        let bases = problem.bases.values().zip(&stage.bases);
        let node = |name: &str| node(problem, plan, name);
        let hops = |step: usize| {
            let found = plan.next_hops(step);
            let hop =
                |robot: &RobotPlan| found.get(robot.name.as_str()).and_then(|h| Some((node(h.to)?, h.links)));
            plan.robots.iter().map(hop).collect()
        };
        Motion {
            step_s: plan.step_s,
            length: steps(plan).saturating_sub(1),
            loop_start: plan.loop_start.min(steps(plan).saturating_sub(1)),
            robots: places.map(|(robot, actor)| shown(problem, robot, actor)).collect(),
            bases: bases.map(|(base, at)| Base { name: harmless(&base.name), at: point(at) }).collect(),
            links: (0..steps(plan)).map(|step| links(plan, stage, step, &node)).collect(),
            hops: (0..steps(plan)).map(hops).collect(),
            runs: runs.len(),
        }
    }
}

/// How many steps there are, the first one included.
pub fn steps(plan: &Plan) -> usize {
    plan.robots.iter().map(|robot| robot.z.len()).min().unwrap_or(0)
}

/// A label as a letter.
pub fn letter(label: Label) -> char {
    match label {
        Label::In => 'i',
        Label::Out => 'o',
        Label::Unknown => 'u',
    }
}

/// The index of a robot, or of a base after all robots.
fn node(problem: &Problem, plan: &Plan, name: &str) -> Option<usize> {
    let robot = plan.robots.iter().position(|robot| robot.name == name);
    let base = || problem.bases.values().position(|base| base.name == name);
    robot.or_else(|| Some(plan.robots.len() + base()?))
}

/// The links of a step that have both their ends.
fn links(plan: &Plan, stage: &Stage, step: usize, node: &dyn Fn(&str) -> Option<usize>) -> Vec<Link> {
    let links = plan.links.as_ref().and_then(|all| all.get(step)).map_or(&[][..], Vec::as_slice);
    let beams = stage.beams.get(step).map_or(&[][..], Vec::as_slice);
    let link = |(link, beam): (&crate::plan::Link, &String)| {
        Some(Link { ends: [node(&link.from)?, node(&link.to)?], beam: beam.clone() })
    };
    links.iter().zip(beams).filter_map(link).collect()
}

fn shown(problem: &Problem, robot: &RobotPlan, actor: &Actor) -> Robot {
    let model = problem.models.values().find(|model| model.name == robot.dynamics);
    let doc = problem.robots.values().find(|r| r.name == robot.name).map_or("", |r| r.doc.as_str());
    let signals = |pick: fn(&Model) -> &[Signal]| {
        let all = model.map_or(&[][..], pick);
        all.iter().map(|s| (harmless(&s.name), harmless(&s.unit))).collect()
    };
    let points = |pixels: &[(f64, f64)]| pixels.iter().map(point).collect::<Vec<Point>>();
    Robot {
        name: harmless(&robot.name),
        doc: harmless(doc),
        dynamics: harmless(&robot.dynamics),
        color: actor.color,
        ink: actor.ink.clone(),
        mark: actor.mark.clone(),
        tube: actor.tube.clone(),
        points: points(&actor.points),
        feet: points(&actor.feet),
        runs: actor.runs.iter().map(|run| points(run)).collect(),
        states: signals(|model| &model.states),
        inputs: signals(|model| &model.inputs),
        z: robot.z.clone(),
        v: robot.v.clone(),
        regions: robot
            .regions
            .iter()
            .map(|(name, labels)| (harmless(name), labels.iter().map(|l| letter(*l)).collect()))
            .collect(),
    }
}

/// A text without control characters and what reorders.
fn harmless(text: &str) -> String {
    printable(text).into_owned()
}

/// A point to the hundredth of a pixel, as the pictures have it.
fn point(pixel: &(f64, f64)) -> Point {
    [pixel.0, pixel.1].map(|x| if x.is_finite() { (x * 100.0).round() / 100.0 } else { 0.0 })
}
