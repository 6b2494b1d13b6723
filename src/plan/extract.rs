//! From a nominal plan to one that carries its own proof: labels, planes, links with their hops.

use std::collections::{BTreeMap, VecDeque};

use crate::abstraction::{Abstraction, Body, Owner, SolidId, dot};
use crate::encode::Link as LinkUse;
use crate::entity::EntityId;
use crate::ir::{BlockerId, Formula, ModelId, Problem, RegionId, RobotId};
use crate::tube::{Tubes, rows};

use super::{Apart, Label, Link, Mission, Nominal, Plan, RobotPlan, Separator, Tube};

/// The plan with every witness; `None` when some witness cannot be found any more, which takes
/// numbers at the limit of their precision.
pub fn extract(problem: &Problem, tubes: &Tubes, abstraction: &Abstraction, found: &Nominal) -> Option<Plan> {
    let witness = Witness { problem, abstraction, found, positions: found.positions(problem) };
    Some(Plan {
        tool: concat!("dosmc ", env!("CARGO_PKG_VERSION")).to_string(),
        mission: Mission {
            name: problem.name.clone(),
            sha256: problem.sha256.clone(),
            set: problem.set.clone(),
        },
        step_s: problem.step.to_f64(),
        length: found.length,
        loop_start: found.loop_start,
        tubes: problem.models.ids().map(|id| tube(problem, tubes, id)).collect(),
        robots: problem.robots.ids().map(|id| witness.robot(id)).collect::<Option<_>>()?,
        links: match problem.connectivity {
            Some(_) => Some((0..=found.length).map(|t| witness.links(t)).collect::<Option<_>>()?),
            None => None,
        },
        separation: match problem.separation {
            Some(_) => (0..=found.length).map(|t| witness.apart(t)).collect::<Option<_>>()?,
            None => Vec::new(),
        },
        objective: None,
    })
}

fn tube(problem: &Problem, tubes: &Tubes, id: ModelId) -> Tube {
    let tube = &tubes[id];
    Tube {
        dynamics: problem.models[id].name.clone(),
        center: tube.center.clone(),
        half_width: tube.half_width.clone(),
        reserve: tube.reserve.clone(),
        d: rows(&tube.d),
        m: rows(&tube.m),
    }
}

struct Witness<'a> {
    problem: &'a Problem,
    abstraction: &'a Abstraction,
    found: &'a Nominal,
    /// By robot and step.
    positions: Vec<Vec<Vec<f64>>>,
}

impl Witness<'_> {
    /// The step that follows, round the loop.
    fn after(&self, step: usize) -> usize {
        if step == self.found.length { self.found.loop_start } else { step + 1 }
    }

    fn body(&self, robot: RobotId, step: usize) -> Body<'_> {
        let model = Some(self.problem.robots[robot].model);
        Body { center: &self.positions[robot.index()][step], model }
    }

    fn separator(&self, bodies: &[Body<'_>], solid: SolidId) -> Option<Separator> {
        let plane = self.abstraction.separate(bodies, solid)?;
        let piece = self.abstraction.solids[solid].piece;
        Some(Separator { piece, normal: plane.normal, offset: plane.offset })
    }

    fn robot(&self, robot: RobotId) -> Option<RobotPlan> {
        let entry = &self.problem.robots[robot];
        let mut plan = RobotPlan {
            name: entry.name.clone(),
            dynamics: self.problem.models[entry.model].name.clone(),
            z: self.found.states[robot.index()].clone(),
            v: self.found.inputs[robot.index()].clone(),
            regions: BTreeMap::new(),
            outside: BTreeMap::new(),
            clear: BTreeMap::new(),
        };
        for region in self.asked(robot) {
            let name = &self.problem.regions[region].name;
            let (labels, witnesses) = (0..=self.found.length).map(|t| self.label(robot, region, t)).unzip();
            plan.regions.insert(name.clone(), labels);
            plan.outside.insert(name.clone(), witnesses);
        }
        for (id, blocker) in self.problem.blockers.iter() {
            let steps = (0..=self.found.length).map(|t| self.clear(robot, id, t));
            plan.clear.insert(blocker.name.clone(), steps.collect::<Option<_>>()?);
        }
        Some(plan)
    }

    /// The regions that ψ asks of a robot.
    fn asked(&self, robot: RobotId) -> Vec<RegionId> {
        let mut regions = Vec::new();
        for node in self.problem.formulas.nodes().values() {
            match node {
                Formula::In(atom) | Formula::Out(atom) => regions.push(*atom),
                Formula::Compare(comparison) => {
                    regions.extend(comparison.terms.iter().map(|(atom, _)| *atom))
                }
                _ => {}
            }
        }
        let mut regions: Vec<RegionId> =
            regions.into_iter().filter(|atom| atom.robot == robot).map(|atom| atom.region).collect();
        regions.sort_unstable();
        regions.dedup();
        regions
    }

    fn label(&self, robot: RobotId, region: RegionId, step: usize) -> (Label, Option<Vec<Separator>>) {
        let model = self.problem.robots[robot].model;
        let z = &self.positions[robot.index()][step];
        // The offsets lie a whole gap inside the region: part of it is left for rounding.
        let slack = 0.75 * self.abstraction.gap;
        let inside = self.abstraction.inside(model, region).iter().any(|facets| {
            let within = |f: &crate::abstraction::HalfSpace| {
                dot(&self.abstraction.directions[f.direction].vector, z) <= f.offset + slack
            };
            facets.iter().all(within)
        });
        if inside {
            return (Label::In, None);
        }
        let solids = self.abstraction.solids_of(Owner::Region(region));
        let body = self.body(robot, step);
        match solids.map(|solid| self.separator(&[body], solid)).collect::<Option<Vec<_>>>() {
            Some(separators) => (Label::Out, Some(separators)),
            None => (Label::Unknown, None),
        }
    }

    fn clear(&self, robot: RobotId, blocker: BlockerId, step: usize) -> Option<Vec<Separator>> {
        let ends = [self.body(robot, step), self.body(robot, self.after(step))];
        let solids = self.abstraction.solids_of(Owner::Blocker(blocker));
        solids.map(|solid| self.separator(&ends, solid)).collect()
    }

    fn links(&self, step: usize) -> Option<Vec<Link>> {
        let hops = self.hops(step);
        let mut links = Vec::new();
        for &link in &self.found.links[step] {
            let (from, to) = self.oriented(link, &hops);
            let mut separators = Vec::new();
            for (id, blocker) in self.problem.blockers.iter().filter(|(_, b)| b.kind.blocks_links()) {
                for solid in self.abstraction.solids_of(Owner::Blocker(id)) {
                    let separator = self.separator(&self.ends(link, step), solid)?;
                    separators.push((blocker.name.clone(), separator));
                }
            }
            let name = |robot: RobotId| self.problem.robots[robot].name.clone();
            let to_name = match to {
                LinkUse::Robots(_, to) => name(to),
                LinkUse::Base(_, base) => self.problem.bases[base].name.clone(),
            };
            links.push(Link { from: name(from), to: to_name, hops: hops[from.index()], separators });
        }
        Some(links)
    }

    /// A link read from the end that is farther from a base.
    fn oriented(&self, link: LinkUse, hops: &[usize]) -> (RobotId, LinkUse) {
        match link {
            LinkUse::Robots(a, b) if hops[a.index()] < hops[b.index()] => (b, LinkUse::Robots(b, a)),
            LinkUse::Robots(a, _) | LinkUse::Base(a, _) => (a, link),
        }
    }

    fn ends(&self, link: LinkUse, step: usize) -> Vec<Body<'_>> {
        match link {
            LinkUse::Robots(a, b) => vec![self.body(a, step), self.body(b, step)],
            LinkUse::Base(robot, base) => {
                vec![self.body(robot, step), Body { center: self.abstraction.base(base), model: None }]
            }
        }
    }

    /// Each robot's least number of links to a base over a step's list.
    fn hops(&self, step: usize) -> Vec<usize> {
        let mut hops = vec![usize::MAX; self.problem.robots.len()];
        let mut queue = VecDeque::new();
        for link in &self.found.links[step] {
            if let LinkUse::Base(robot, _) = link
                && hops[robot.index()] == usize::MAX
            {
                hops[robot.index()] = 1;
                queue.push_back(*robot);
            }
        }
        while let Some(robot) = queue.pop_front() {
            for link in &self.found.links[step] {
                let other = match *link {
                    LinkUse::Robots(a, b) if a == robot => b,
                    LinkUse::Robots(a, b) if b == robot => a,
                    _ => continue,
                };
                if hops[other.index()] == usize::MAX {
                    hops[other.index()] = hops[robot.index()] + 1;
                    queue.push_back(other);
                }
            }
        }
        hops
    }

    fn apart(&self, step: usize) -> Option<Vec<Apart>> {
        let mut faces = Vec::new();
        for first in self.problem.robots.ids() {
            for second in self.problem.robots.ids().filter(|other| *other > first) {
                let at =
                    |robot: RobotId| [step, self.after(step)].map(|t| &self.positions[robot.index()][t][..]);
                let ends = [at(first), at(second)];
                let (axis, positive) =
                    self.abstraction.separating_face(self.problem, [first, second], ends)?;
                let name = |robot: RobotId| self.problem.robots[robot].name.clone();
                let pair = (name(first), name(second));
                faces.push(Apart { pair, axis, sign: if positive { 1 } else { -1 } });
            }
        }
        Some(faces)
    }
}
