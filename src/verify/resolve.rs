//! The plan with its names resolved, its sizes checked and its doubles made exact.

use std::collections::BTreeMap;

use super::report::{Kind, Ledger, Place};
use super::tube::Tube;
use crate::entity::Table;
use crate::exact::Rational;
use crate::ir::{BaseId, BlockerId, Model, ModelId, Problem, RegionId, RobotId, Shape};
use crate::plan::{self, Label, Plan};

/// A plan whose form is right; every list has its length, every number is exact.
pub(super) struct Resolved<'a> {
    pub(super) problem: &'a Problem,
    /// L.
    pub(super) length: usize,
    /// k.
    pub(super) loop_start: usize,
    pub(super) tubes: Table<ModelId, Tube>,
    pub(super) robots: Table<RobotId, Robot<'a>>,
    pub(super) links: Option<Vec<Vec<Link>>>,
    /// One list a step, or none at all.
    pub(super) separation: Vec<Vec<Apart>>,
}

/// A robot's plan.
pub(super) struct Robot<'a> {
    pub(super) name: &'a str,
    pub(super) model: ModelId,
    /// z_0 … z_L.
    pub(super) z: Vec<Vec<Rational>>,
    /// v_0 … v_L.
    pub(super) v: Vec<Vec<Rational>>,
    /// The position part of z.
    pub(super) p: Vec<Vec<Rational>>,
    /// The labels of the regions that the plan names.
    pub(super) regions: BTreeMap<RegionId, &'a [Label]>,
    /// Their witnesses, where the plan has any.
    pub(super) outside: BTreeMap<RegionId, Vec<Option<Vec<Plane>>>>,
    /// Each blocker's separators at each step.
    pub(super) clear: Table<BlockerId, Vec<Vec<Plane>>>,
}

/// A separator: one of its sides is a piece's, the other the robots'.
pub(super) struct Plane {
    pub(super) piece: usize,
    pub(super) normal: Vec<Rational>,
    pub(super) offset: Rational,
}

/// An end of a link.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Node {
    Robot(RobotId),
    Base(BaseId),
}

/// A link with its separators.
pub(super) struct Link {
    pub(super) name: String,
    pub(super) from: RobotId,
    pub(super) to: Node,
    pub(super) separators: Vec<(BlockerId, Plane)>,
}

/// A side on which two robots keep apart.
pub(super) struct Apart {
    pub(super) first: RobotId,
    pub(super) second: RobotId,
    pub(super) axis: usize,
    pub(super) sign: i8,
}

impl Resolved<'_> {
    /// The step after `t`: after L comes k.
    pub(super) fn next(&self, t: usize) -> usize {
        if t < self.length { t + 1 } else { self.loop_start }
    }

    /// All steps, 0 to L.
    pub(super) fn steps(&self) -> std::ops::RangeInclusive<usize> {
        0..=self.length
    }

    /// The tube of a robot.
    pub(super) fn tube(&self, robot: RobotId) -> &Tube {
        &self.tubes[self.robots[robot].model]
    }
}

/// Resolves a plan, or notes what is wrong with its form.
pub(super) fn resolve<'a>(problem: &'a Problem, plan: &'a Plan, ledger: &mut Ledger) -> Option<Resolved<'a>> {
    match Resolver::new(problem, plan.length.saturating_add(1)).plan(plan) {
        Ok(resolved) => {
            ledger.claim(Kind::Form, true, Default::default);
            Some(resolved)
        }
        Err(Malformed(place, message)) => {
            ledger.fail(Kind::Form, place, message);
            None
        }
    }
}

/// The first thing that is wrong with a plan's form.
struct Malformed(Place, String);

impl Malformed {
    fn new(message: impl Into<String>) -> Malformed {
        Malformed(Place::default(), message.into())
    }
    fn of_robot(mut self, name: &str) -> Malformed {
        self.0.robot.get_or_insert(name.to_owned());
        self
    }
    fn about(mut self, name: &str) -> Malformed {
        self.0.subject.get_or_insert(name.to_owned());
        self
    }
    fn at(mut self, step: usize) -> Malformed {
        self.0.step.get_or_insert(step);
        self
    }
}

type Result<T> = std::result::Result<T, Malformed>;

struct Resolver<'a> {
    problem: &'a Problem,
    /// L + 1.
    steps: usize,
    robots: BTreeMap<&'a str, RobotId>,
    regions: BTreeMap<&'a str, RegionId>,
    blockers: BTreeMap<&'a str, BlockerId>,
    bases: BTreeMap<&'a str, BaseId>,
}

impl<'a> Resolver<'a> {
    fn new(problem: &'a Problem, steps: usize) -> Resolver<'a> {
        Resolver {
            problem,
            steps,
            robots: problem.robots.iter().map(|(id, r)| (r.name.as_str(), id)).collect(),
            regions: problem.regions.iter().map(|(id, r)| (r.name.as_str(), id)).collect(),
            blockers: problem.blockers.iter().map(|(id, b)| (b.name.as_str(), id)).collect(),
            bases: problem.bases.iter().map(|(id, b)| (b.name.as_str(), id)).collect(),
        }
    }

    fn plan(&self, plan: &'a Plan) -> Result<Resolved<'a>> {
        if plan.length < 1 {
            return Err(Malformed::new("the length must be at least 1"));
        }
        if plan.loop_start > plan.length {
            return Err(Malformed::new("the loop starts after the last state"));
        }
        let problem = self.problem;
        Ok(Resolved {
            problem,
            length: plan.length,
            loop_start: plan.loop_start,
            tubes: self.tubes(plan)?,
            robots: self.robots(plan)?,
            links: self.links(plan)?,
            separation: self.separation(plan)?,
        })
    }

    fn tubes(&self, plan: &Plan) -> Result<Table<ModelId, Tube>> {
        let models = &self.problem.models;
        if plan.tubes.len() != models.len() {
            return Err(Malformed::new(format!("{} tubes for {} models", plan.tubes.len(), models.len())));
        }
        let tube = |model: &Model| {
            let tube = plan.tubes.iter().find(|t| t.dynamics == model.name);
            let tube = tube.ok_or_else(|| Malformed::new("the model has no tube"))?;
            exact_tube(tube, model)
        };
        models.values().map(|model| tube(model).map_err(|e| e.about(&model.name))).collect()
    }

    fn robots(&self, plan: &'a Plan) -> Result<Table<RobotId, Robot<'a>>> {
        let robots = &self.problem.robots;
        if plan.robots.len() != robots.len() {
            return Err(Malformed::new(format!("{} plans for {} robots", plan.robots.len(), robots.len())));
        }
        let robot = |robot: &'a crate::ir::Robot| {
            let planned = plan.robots.iter().find(|r| r.name == robot.name);
            let planned = planned.ok_or_else(|| Malformed::new("the robot has no plan"))?;
            self.robot(planned, robot.model)
        };
        robots.values().map(|r| robot(r).map_err(|e| e.of_robot(&r.name))).collect()
    }

    fn robot(&self, robot: &'a plan::RobotPlan, model_id: ModelId) -> Result<Robot<'a>> {
        let model = &self.problem.models[model_id];
        if robot.dynamics != model.name {
            return Err(Malformed::new(format!("its dynamics is {}, not {}", model.name, robot.dynamics)));
        }
        let rows = |rows: &[Vec<f64>], width: usize, what: &str| {
            self.per_step(rows).and_then(|rows| matrix(rows, width)).map_err(|e| e.about(what))
        };
        let z = rows(&robot.z, model.n(), "z")?;
        let p = z.iter().map(|z| model.position.iter().map(|&i| z[i].clone()).collect()).collect();
        Ok(Robot {
            name: &robot.name,
            model: model_id,
            v: rows(&robot.v, model.m(), "v")?,
            p,
            z,
            regions: self.regions(robot)?,
            outside: self.outside(robot)?,
            clear: self.clear(robot)?,
        })
    }

    fn regions(&self, robot: &'a plan::RobotPlan) -> Result<BTreeMap<RegionId, &'a [Label]>> {
        let labels = |(name, labels): (&String, &'a Vec<Label>)| {
            let id = self.region(name)?;
            Ok((id, self.per_step(labels).map_err(|e| e.about(name))?))
        };
        robot.regions.iter().map(labels).collect()
    }

    fn outside(&self, robot: &plan::RobotPlan) -> Result<BTreeMap<RegionId, Vec<Option<Vec<Plane>>>>> {
        let mut outside = BTreeMap::new();
        for (name, witnesses) in &robot.outside {
            let id = self.region(name)?;
            let shape = &self.problem.regions[id].shape;
            let witness = |(t, planes): (usize, &Option<Vec<plan::Separator>>)| {
                let planes = planes.as_ref().map(|planes| self.planes(planes, shape)).transpose();
                planes.map_err(|e| e.at(t))
            };
            let rows = self.per_step(witnesses).and_then(|w| w.iter().enumerate().map(witness).collect());
            outside.insert(id, rows.map_err(|e| e.about(name))?);
        }
        Ok(outside)
    }

    fn clear(&self, robot: &plan::RobotPlan) -> Result<Table<BlockerId, Vec<Vec<Plane>>>> {
        if let Some(name) = robot.clear.keys().find(|name| self.blocker(name).is_err()) {
            return Err(Malformed::new("there is no such blocker").about(name));
        }
        let one = |blocker: &crate::ir::Blocker| {
            let steps = robot.clear.get(&blocker.name).ok_or_else(|| Malformed::new("no separators"))?;
            let planes = |(t, planes): (usize, &Vec<plan::Separator>)| {
                self.planes(planes, &blocker.shape).map_err(|e| e.at(t))
            };
            self.per_step(steps)?.iter().enumerate().map(planes).collect::<Result<Vec<_>>>()
        };
        self.problem.blockers.values().map(|b| one(b).map_err(|e| e.about(&b.name))).collect()
    }

    fn links(&self, plan: &Plan) -> Result<Option<Vec<Vec<Link>>>> {
        match (&plan.links, &self.problem.connectivity) {
            (None, None) => Ok(None),
            (None, Some(_)) => Err(Malformed::new("the mission asks for links, the plan has none")),
            (Some(_), None) => Err(Malformed::new("the mission asks for no links, the plan lists some")),
            (Some(steps), Some(_)) => {
                let step = |(t, links): (usize, &Vec<plan::Link>)| {
                    links.iter().map(|link| self.link(link).map_err(|e| e.at(t))).collect()
                };
                self.per_step(steps)?.iter().enumerate().map(step).collect::<Result<_>>().map(Some)
            }
        }
    }

    fn link(&self, link: &plan::Link) -> Result<Link> {
        let name = format!("{} to {}", link.from, link.to);
        let base = || self.bases.get(link.to.as_str()).map(|&id| Node::Base(id));
        let to = self.find_robot(&link.to).map(Node::Robot).or_else(base);
        let (Some(from), Some(to)) = (self.find_robot(&link.from), to) else {
            return Err(Malformed::new("there is no such robot or base").of_robot(&name));
        };
        if to == Node::Robot(from) {
            return Err(Malformed::new("a link from a robot to itself").of_robot(&name));
        }
        let named = |(blocker, separator): &(String, plan::Separator)| {
            let id = self.blocker(blocker)?;
            let plane = self.plane(separator, &self.problem.blockers[id].shape);
            Ok((id, plane.map_err(|e| e.about(blocker))?))
        };
        let separators = link.separators.iter().map(named).collect::<Result<_>>();
        Ok(Link { separators: separators.map_err(|e| e.of_robot(&name))?, name, from, to })
    }

    fn separation(&self, plan: &Plan) -> Result<Vec<Vec<Apart>>> {
        if plan.separation.is_empty() {
            return Ok(Vec::new());
        }
        if self.problem.separation.is_none() {
            return Err(Malformed::new("the mission asks for no separation, the plan lists sides"));
        }
        let step = |(t, pairs): (usize, &Vec<plan::Apart>)| {
            pairs.iter().map(|pair| self.apart(pair).map_err(|e| e.at(t))).collect()
        };
        self.per_step(&plan.separation)?.iter().enumerate().map(step).collect()
    }

    fn apart(&self, apart: &plan::Apart) -> Result<Apart> {
        let (one, other) = (&apart.pair.0, &apart.pair.1);
        let (Some(first), Some(second)) = (self.find_robot(one), self.find_robot(other)) else {
            return Err(Malformed::new(format!("there is no such pair of robots as {one} and {other}")));
        };
        let right = first != second && apart.axis < self.problem.dimension && apart.sign.unsigned_abs() == 1;
        if !right {
            return Err(Malformed::new(format!("{one} and {other}: no such pair, axis or sign")));
        }
        Ok(Apart { first, second, axis: apart.axis, sign: apart.sign })
    }

    fn find_robot(&self, name: &str) -> Option<RobotId> {
        self.robots.get(name).copied()
    }

    fn region(&self, name: &str) -> Result<RegionId> {
        let found = self.regions.get(name).copied();
        found.ok_or_else(|| Malformed::new("there is no such region").about(name))
    }

    fn blocker(&self, name: &str) -> Result<BlockerId> {
        let found = self.blockers.get(name).copied();
        found.ok_or_else(|| Malformed::new("there is no such blocker").about(name))
    }

    fn planes(&self, separators: &[plan::Separator], shape: &Shape) -> Result<Vec<Plane>> {
        separators.iter().map(|s| self.plane(s, shape)).collect()
    }

    fn plane(&self, separator: &plan::Separator, shape: &Shape) -> Result<Plane> {
        if separator.piece >= shape.pieces.len() {
            return Err(Malformed::new(format!("there is no piece {}", separator.piece)));
        }
        Ok(Plane {
            piece: separator.piece,
            normal: vector(&separator.normal, self.problem.dimension)?,
            offset: number(separator.offset)?,
        })
    }

    fn per_step<'b, T>(&self, list: &'b [T]) -> Result<&'b [T]> {
        if list.len() == self.steps {
            return Ok(list);
        }
        Err(Malformed::new(format!("{} entries for {} steps", list.len(), self.steps)))
    }
}

fn exact_tube(tube: &plan::Tube, model: &Model) -> Result<Tube> {
    let (n, m) = (model.n(), model.m());
    if tube.d.is_empty() || tube.d.len() != tube.m.len() {
        return Err(Malformed::new(format!("{} matrices D, {} matrices M", tube.d.len(), tube.m.len())));
    }
    let matrices = |list: &[Vec<Vec<f64>>], height: usize| -> Result<Vec<Vec<Vec<Rational>>>> {
        let sized = |rows: &Vec<Vec<f64>>| match rows.len() == height {
            true => matrix(rows, n),
            false => Err(Malformed::new(format!("a matrix of {} rows, not {height}", rows.len()))),
        };
        list.iter().map(sized).collect()
    };
    Ok(Tube::new(
        &model.position,
        vector(&tube.center, n)?,
        vector(&tube.half_width, n)?,
        vector(&tube.reserve, n)?,
        matrices(&tube.d, n)?,
        matrices(&tube.m, m)?,
    ))
}

fn matrix(rows: &[Vec<f64>], width: usize) -> Result<Vec<Vec<Rational>>> {
    rows.iter().enumerate().map(|(i, row)| vector(row, width).map_err(|e| e.at(i))).collect()
}

fn vector(entries: &[f64], size: usize) -> Result<Vec<Rational>> {
    if entries.len() != size {
        return Err(Malformed::new(format!("{} entries, not {size}", entries.len())));
    }
    entries.iter().map(|&x| number(x)).collect()
}

fn number(x: f64) -> Result<Rational> {
    Rational::from_f64(x).ok_or_else(|| Malformed::new("a number that is not finite"))
}
