//! The mission in doubles, as the inspector looks at it, beside what the plan claims.

use std::collections::BTreeMap;

use super::body::{Body, Plane, Point, Solid, length, point};
use super::motion::Motion;
use super::pushes::Lasso;
use crate::entity::EntityId;
use crate::ir::{Interval, Model, Norm, Problem, Region};
use crate::plan::{Label, Link, Plan, RobotPlan, Separator};

/// Everything that runs are held against.
pub(super) struct World<'a> {
    pub(super) problem: &'a Problem,
    pub(super) lasso: Lasso,
    pub(super) workspace: Solid,
    /// All pieces of obstacles and jammers.
    pub(super) pieces: Vec<Blocking>,
    /// Which of these no link may cross.
    pub(super) opaque: Vec<usize>,
    pub(super) regions: Vec<Place>,
    pub(super) bases: Vec<Point>,
    pub(super) robots: Vec<Mover>,
    /// ε.
    pub(super) separation: Option<f64>,
    /// By step and pair, as [`World::pair`] counts: the axis and sign on which the plan keeps it apart.
    pub(super) sides: Vec<Vec<Option<(usize, f64)>>>,
    /// By step: the links that the plan relies on.
    pub(super) links: Vec<Vec<Beam>>,
    /// The most links of a step.
    most_links: usize,
    pub(super) range: Option<(f64, Norm)>,
    /// Differences this small may be rounding: what is nearer to a bound than this is looked at exactly.
    pub(super) guard: f64,
}

/// A piece of a blocker.
pub(super) struct Blocking {
    pub(super) blocker: usize,
    pub(super) piece: usize,
    pub(super) body: Body,
}

/// A region.
pub(super) struct Place {
    /// All that it may be.
    pub(super) shape: Vec<Body>,
    /// What is certain of it.
    pub(super) sure: Vec<Body>,
}

/// A bound of a state or an input.
pub(super) struct Bound {
    pub(super) index: usize,
    pub(super) lo: f64,
    pub(super) hi: f64,
    /// 1 / half of what lies between.
    pub(super) scale: f64,
}

/// A robot.
pub(super) struct Mover {
    pub(super) position: Vec<usize>,
    pub(super) states: Vec<Bound>,
    pub(super) inputs: Vec<Bound>,
    /// Over states and inputs: normals of length 1, and offsets.
    pub(super) mixed: Vec<(Vec<f64>, f64)>,
    pub(super) motion: Motion,
    /// By step and piece: the plane that keeps the robot clear until the next step.
    pub(super) clear: Vec<Vec<Option<Plane>>>,
    pub(super) tracks: Vec<Track>,
}

/// A robot's relation to a region.
pub(super) struct Track {
    pub(super) region: usize,
    /// By step.
    pub(super) labels: Vec<Label>,
    /// By step: the planes that keep it out.
    pub(super) outside: Vec<Vec<Plane>>,
}

/// A link that the plan relies on.
pub(super) struct Beam {
    pub(super) from: usize,
    pub(super) to: End,
    /// By opaque piece: a plane that keeps both ends away from it.
    pub(super) planes: Vec<Option<Plane>>,
}

/// Where a link leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// To a robot.
    Robot(usize),
    /// To a base.
    Base(usize),
}

/// Differences in proportion to the mission's size that may be rounding.
const GUARD: f64 = 1e-9;

impl<'a> World<'a> {
    /// The world of a plan that has been checked against its problem.
    pub(super) fn new(problem: &'a Problem, plan: &Plan, lasso: Lasso) -> Option<World<'a>> {
        let mut pieces = Vec::new();
        for (id, blocker) in problem.blockers.iter() {
            for (piece, shape) in blocker.shape.pieces.iter().enumerate() {
                pieces.push(Blocking { blocker: id.index(), piece, body: Body::new(shape) });
            }
        }
        let opaque = |(_, piece): &(usize, &Blocking)| {
            problem.blockers.values().nth(piece.blocker).is_some_and(|b| b.kind.blocks_links())
        };
        let opaque: Vec<usize> = pieces.iter().enumerate().filter(opaque).map(|(i, _)| i).collect();
        let size = problem.workspace.vertices.iter().map(|v| length(&point(v))).fold(0.0, f64::max);
        let size = pieces.iter().map(|p| p.body.size()).fold(size, f64::max);
        let mut world = World {
            problem,
            lasso,
            workspace: Solid::new(&problem.workspace),
            opaque,
            regions: problem.regions.values().map(place).collect(),
            bases: problem.bases.values().map(|b| point(&b.position)).collect(),
            robots: Vec::new(),
            separation: problem.separation.as_ref().map(|s| s.to_f64()),
            sides: Vec::new(),
            links: Vec::new(),
            most_links: 0,
            range: problem
                .connectivity
                .as_ref()
                .and_then(|c| Some((c.range.as_ref()?.length.to_f64(), c.range.as_ref()?.norm))),
            guard: GUARD * (1.0 + size),
            pieces,
        };
        for robot in problem.robots.values() {
            let planned = plan.robots.iter().find(|r| r.name == robot.name)?;
            let mover = world.mover(&problem.models[robot.model], planned, robot.name.as_str());
            world.robots.push(mover);
        }
        world.sides = world.sides_of(plan);
        world.links = plan
            .links
            .iter()
            .flatten()
            .map(|links| links.iter().filter_map(|l| world.beam(l)).collect())
            .collect();
        world.links.resize_with(plan.length + 1, Vec::new);
        world.most_links = world.links.iter().map(Vec::len).max().unwrap_or(0);
        Some(world)
    }

    /// The index of a pair of robots, `first < second`.
    pub(super) fn pair(&self, first: usize, second: usize) -> usize {
        let count = self.robots.len();
        first * (2 * count - first - 1) / 2 + second - first - 1
    }

    /// Where in a list of planes those of a link begin: by the step before, whether it is a link of that
    /// step or of the one after, and its place in the list.
    pub(super) fn slot(&self, step: usize, late: bool, beam: usize) -> usize {
        ((2 * step + usize::from(late)) * self.most_links + beam) * self.opaque.len()
    }

    /// Room for a plane for each link and piece: the plan's own, to begin with.
    pub(super) fn planes_of_links(&self) -> Vec<Plane> {
        let nothing = Plane { normal: [0.0; 3], offset: f64::NEG_INFINITY };
        let mut planes = vec![nothing; self.slot(self.links.len(), false, 0)];
        for step in 0..self.links.len() {
            for late in [false, true] {
                let at = if late { self.lasso.step(step + 1) } else { step };
                for (beam, link) in self.links.get(at).into_iter().flatten().enumerate() {
                    let from = self.slot(step, late, beam);
                    let own = planes[from..].iter_mut().zip(&link.planes);
                    own.for_each(|(to, plane)| *to = plane.unwrap_or(nothing));
                }
            }
        }
        planes
    }

    /// Whether links are asked for at a sample.
    pub(super) fn asks_for_links(&self, sample: usize) -> bool {
        let asked = self.problem.connectivity.as_ref();
        asked.is_some_and(|asked| (sample as u64).is_multiple_of(u64::from(asked.every.max(1))))
    }

    fn mover(&self, model: &Model, planned: &RobotPlan, name: &str) -> Mover {
        let steps = planned.z.len();
        let bounds = |all: &mut dyn Iterator<Item = (usize, &Interval)>| {
            let bound = |(index, i): (usize, &Interval)| {
                let (lo, hi) = (i.lo.to_f64(), i.hi.to_f64());
                Bound { index, lo, hi, scale: 2.0 / (hi - lo) }
            };
            all.map(bound).collect::<Vec<_>>()
        };
        let clear = |step: usize| {
            let plane = |piece: &Blocking| {
                let blocker = self.problem.blockers.values().nth(piece.blocker)?;
                first_plane(planned.clear.get(&blocker.name)?.get(step)?, piece.piece)
            };
            self.pieces.iter().map(plane).collect()
        };
        let mixed = |bound: &crate::geometry::HalfSpace| {
            let normal: Vec<f64> = bound.normal.iter().map(|x| x.to_f64()).collect();
            let scale = 1.0 / normal.iter().map(|x| x * x).sum::<f64>().sqrt();
            (normal.iter().map(|x| x * scale).collect(), bound.offset.to_f64() * scale)
        };
        Mover {
            position: model.position.clone(),
            states: bounds(
                &mut model.state_bounds.iter().enumerate().filter_map(|(i, b)| Some((i, b.as_ref()?))),
            ),
            inputs: bounds(&mut model.input_bounds.iter().enumerate()),
            mixed: model.mixed_bounds.iter().map(mixed).collect(),
            motion: Motion::new(model),
            clear: (0..steps).map(clear).collect(),
            tracks: self.tracks(planned, name, steps),
        }
    }

    /// The regions that the plan names for a robot, and those that goals ask of it.
    fn tracks(&self, planned: &RobotPlan, name: &str, steps: usize) -> Vec<Track> {
        let asked = self.problem.formulas.nodes().values().flat_map(super::goals::atoms);
        let of_robot = |atom: &crate::ir::Atom| {
            self.problem.robots.get(atom.robot).is_some_and(|robot| robot.name == name)
        };
        let asked: Vec<usize> = asked.filter(of_robot).map(|atom| atom.region.index()).collect();
        let mut tracks = Vec::new();
        for (id, region) in self.problem.regions.iter() {
            let labels = planned.regions.get(&region.name);
            if labels.is_none() && !asked.contains(&id.index()) {
                continue;
            }
            let mut labels = labels.cloned().unwrap_or_default();
            labels.resize(steps, Label::Unknown);
            let witnesses = planned.outside.get(&region.name);
            let planes = |step: usize| {
                let all = witnesses.and_then(|w| w.get(step)?.as_ref());
                all.into_iter().flatten().map(plane).collect()
            };
            let outside = (0..steps).map(planes).collect();
            tracks.push(Track { region: id.index(), labels, outside });
        }
        tracks
    }

    fn sides_of(&self, plan: &Plan) -> Vec<Vec<Option<(usize, f64)>>> {
        let names: BTreeMap<&str, usize> =
            self.problem.robots.values().enumerate().map(|(i, r)| (r.name.as_str(), i)).collect();
        let count = self.robots.len();
        let step = |step: usize| {
            let mut sides = vec![None; count * count.saturating_sub(1) / 2];
            for apart in plan.separation.get(step).into_iter().flatten() {
                let pair = [&apart.pair.0, &apart.pair.1].map(|name| names.get(name.as_str()).copied());
                let [Some(a), Some(b)] = pair else { continue };
                let sign = f64::from(apart.sign) * if a < b { 1.0 } else { -1.0 };
                if a != b && apart.axis < 3 {
                    let pair = self.pair(a.min(b), a.max(b));
                    sides[pair] = Some((apart.axis, sign));
                }
            }
            sides
        };
        (0..=plan.length).map(step).collect()
    }

    fn beam(&self, link: &Link) -> Option<Beam> {
        let robot = |name: &str| self.problem.robots.values().position(|r| r.name == name);
        let base = |name: &str| self.problem.bases.values().position(|b| b.name == name);
        let plane_of = |&piece: &usize| {
            let piece = &self.pieces[piece];
            let blocker = self.problem.blockers.values().nth(piece.blocker)?;
            let mut own = link.separators.iter().filter(|(name, _)| *name == blocker.name).map(|(_, s)| s);
            own.find(|s| s.piece == piece.piece).map(plane)
        };
        Some(Beam {
            from: robot(&link.from)?,
            to: robot(&link.to).map(End::Robot).or_else(|| base(&link.to).map(End::Base))?,
            planes: self.opaque.iter().map(plane_of).collect(),
        })
    }
}

fn place(region: &Region) -> Place {
    Place {
        shape: region.shape.pieces.iter().map(Body::new).collect(),
        sure: region.sure().pieces.iter().map(Body::new).collect(),
    }
}

fn first_plane(separators: &[Separator], piece: usize) -> Option<Plane> {
    separators.iter().find(|s| s.piece == piece).map(plane)
}

fn plane(separator: &Separator) -> Plane {
    let mut normal = [0.0; 3];
    normal.iter_mut().zip(&separator.normal).for_each(|(to, from)| *to = *from);
    let size = length(&normal);
    // A normal of length 0 says nothing, and no verified plan has one.
    let scale = if size > 0.0 { 1.0 / size } else { 0.0 };
    let offset = if size > 0.0 { separator.offset * scale } else { f64::NEG_INFINITY };
    Plane { normal: normal.map(|x| x * scale), offset }
}
