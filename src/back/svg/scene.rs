//! What there is to draw, in metres: a problem and its plan in a projection.

use super::outline::{Outline, Point, shrunk};
use super::projection::Projection;
use super::section::Section;
use crate::ir::{BlockerKind, Piece, Problem, Shape};
use crate::plan::{Label, Plan};

/// A picture's contents.
pub struct Scene<'a> {
    /// What was planned.
    pub problem: &'a Problem,
    /// The plan.
    pub plan: &'a Plan,
    /// How it is looked at.
    pub projection: Projection,
    /// The workspace.
    pub workspace: Outline,
    /// The regions, with their copies shrunk by each tube.
    pub regions: Vec<Still<'a>>,
    /// Obstacles and jammers, with their copies grown by each tube.
    pub blockers: Vec<(BlockerKind, Still<'a>)>,
    /// The base stations.
    pub bases: Vec<(&'a str, Point)>,
    /// The robots.
    pub robots: Vec<Mover<'a>>,
    /// The models whose tubes differ in their positions: how each copy came about.
    pub tubes: Vec<&'a str>,
}

/// Something that stands still.
pub struct Still<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its pieces.
    pub pieces: Vec<Outline>,
    /// By tube: what the nominal position must keep out of, or in.
    pub copies: Vec<Vec<Outline>>,
}

/// A robot and its way.
pub struct Mover<'a> {
    /// Its name.
    pub name: &'a str,
    /// The nominal position at each step, all coordinates.
    pub positions: Vec<Vec<f64>>,
    /// Where these are drawn.
    pub points: Vec<Point>,
    /// Where it can be around its nominal position.
    pub tube: Outline,
}

impl<'a> Scene<'a> {
    /// The scene of a plan, which need not fit its problem.
    ///
    /// In the axonometric projection there are no copies: they would hide everything else.
    pub fn new(problem: &'a Problem, plan: &'a Plan, projection: Projection) -> Scene<'a> {
        let sections = sections(problem, plan);
        let shown = if projection.axes().is_some() { &sections[..] } else { &[] };
        let mirrors: Vec<Outline> = shown.iter().map(|(_, s)| s.mirrored(&projection)).collect();
        let region = |name: &'a str, shape: &Shape, sure: &Shape| {
            let copy = |(_, section): &(&str, Section)| {
                sure.pieces.iter().filter_map(|piece| shrunk(piece, section, &projection)).collect()
            };
            Still { name, pieces: outlines(shape, &projection), copies: shown.iter().map(copy).collect() }
        };
        let blocker = |name: &'a str, shape: &Shape| {
            let pieces = outlines(shape, &projection);
            let copies = mirrors.iter().map(|m| pieces.iter().map(|p| p.plus(m)).collect()).collect();
            Still { name, pieces, copies }
        };
        Scene {
            problem,
            plan,
            projection,
            workspace: Outline::of_polytope(&problem.workspace, &projection),
            regions: problem.regions.values().map(|r| region(&r.name, &r.shape, r.sure())).collect(),
            blockers: problem.blockers.values().map(|b| (b.kind, blocker(&b.name, &b.shape))).collect(),
            bases: problem.bases.values().map(|b| (b.name.as_str(), projection.of(&b.position))).collect(),
            robots: movers(problem, plan, &projection),
            tubes: sections.iter().map(|(name, _)| *name).collect(),
        }
    }

    /// How many steps there are, the first one included.
    pub fn steps(&self) -> usize {
        self.robots.iter().map(|r| r.points.len()).max().unwrap_or(0)
    }

    /// The first step of the loop, as far as there is one.
    pub fn loop_start(&self) -> usize {
        self.plan.loop_start.min(self.steps().saturating_sub(1))
    }

    /// Whether the loop is one step long: everybody stays.
    pub fn stays(&self) -> bool {
        self.loop_start() + 1 >= self.steps()
    }

    /// The links at a step that have both their ends: outline of where each end can be, and its
    /// nominal position.
    pub fn links(&self, step: usize) -> Vec<[(Outline, Point); 2]> {
        self.all_links(step).flatten().collect()
    }

    /// The same for each link of the plan at a step, nothing for one that lacks an end.
    pub fn all_links(&self, step: usize) -> impl Iterator<Item = Option<[(Outline, Point); 2]>> {
        let links = self.plan.links.as_ref().and_then(|all| all.get(step)).map_or(&[][..], Vec::as_slice);
        links.iter().map(move |l| Some([self.end(&l.from, step)?, self.end(&l.to, step)?]))
    }

    fn end(&self, name: &str, step: usize) -> Option<(Outline, Point)> {
        if let Some((_, at)) = self.bases.iter().find(|(base, _)| *base == name) {
            return Some((Outline { corners: vec![*at], radius: 0.0 }, *at));
        }
        let robot = self.robots.iter().find(|r| r.name == name)?;
        let at = *robot.points.get(step)?;
        Some((robot.tube.at(at), at))
    }

    /// The region, if any, that a robot is certainly in from this step on, but was not before.
    pub fn arrival(&self, robot: usize, step: usize) -> Option<&'a str> {
        let regions = &self.plan.robots.get(robot)?.regions;
        let arrived = |labels: &Vec<Label>| {
            labels.get(step) == Some(&Label::In)
                && step.checked_sub(1).is_none_or(|before| labels.get(before) != Some(&Label::In))
        };
        regions.iter().find(|(_, labels)| arrived(labels)).map(|(name, _)| name.as_str())
    }
}

fn outlines(shape: &Shape, projection: &Projection) -> Vec<Outline> {
    shape.pieces.iter().map(|piece: &Piece| Outline::of(piece, projection)).collect()
}

/// The tubes' sections that differ, each with the name of the first model that has it.
fn sections<'a>(problem: &'a Problem, plan: &Plan) -> Vec<(&'a str, Section)> {
    let mut all: Vec<(&str, Section)> = Vec::new();
    for model in problem.models.values() {
        let Some(tube) = plan.tubes.iter().find(|t| t.dynamics == model.name) else { continue };
        let section = Section::new(tube, &model.position);
        if all.iter().all(|(_, s)| *s != section) {
            all.push((&model.name, section));
        }
    }
    all
}

fn movers<'a>(problem: &Problem, plan: &'a Plan, projection: &Projection) -> Vec<Mover<'a>> {
    let still = Outline { corners: vec![[0.0, 0.0]], radius: 0.0 };
    let mover = |robot: &'a crate::plan::RobotPlan| {
        let model = problem.models.values().find(|m| m.name == robot.dynamics);
        let axes: &[usize] = model.map_or(&[], |m| &m.position);
        let tube = plan.tubes.iter().find(|t| t.dynamics == robot.dynamics);
        let at = |z: &Vec<f64>| axes.iter().map(|&a| z.get(a).copied().unwrap_or(0.0)).collect::<Vec<f64>>();
        let positions: Vec<Vec<f64>> = robot.z.iter().map(at).collect();
        Mover {
            name: &robot.name,
            points: positions.iter().map(|p| projection.flat(p)).collect(),
            positions,
            tube: tube.map_or_else(|| still.clone(), |tube| Section::new(tube, axes).outline(projection)),
        }
    };
    plan.robots.iter().map(mover).collect()
}
