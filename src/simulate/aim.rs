//! What a plan keeps its distance from: every bound and every plane of it, as something to aim at.
//!
//! All that a plan claims of states and inputs is linear, thanks to its witnesses. An [`Aim`] is one
//! such claim at one step of the lasso; how near disturbances can bring robots to it is known at once,
//! and so is the sequence of disturbances that does.

use std::collections::BTreeMap;

use crate::exact::Rational;
use crate::geometry::HalfSpace;
use crate::ir::{Model, Norm, Piece, Problem, Range, Robot};
use crate::plan::{Label, Plan, RobotPlan, Separator, Tube};

/// A claim of a plan at one step of the lasso.
#[derive(Clone, Debug)]
pub(super) struct Aim {
    /// The step.
    pub(super) step: usize,
    /// What the nominal leaves, in the claim's own unit.
    pub(super) slack: f64,
    /// The most of it that disturbances can use up.
    pub(super) reach: f64,
    /// Who has to be pushed where: one or two robots.
    pub(super) parts: Vec<Part>,
}

/// A robot's part of a claim: the more of `state · x + input · u`, the less is left.
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// Who.
    pub(super) robot: usize,
    /// n entries, or none.
    pub(super) state: Vec<f64>,
    /// m entries, or none.
    pub(super) input: Vec<f64>,
}

impl Aim {
    /// What disturbances leave of each unit that they can use up: 1 is a claim that they can just not
    /// break.
    pub(super) fn room(&self) -> f64 {
        self.slack / self.reach
    }
}

/// How hard, and to which side, each ŵ_{t−1−i} pushes a robot at t: aᵀD_i + bᵀM_i, n entries for each
/// i from 0.
pub(super) fn leverage(tube: &Tube, part: &Part) -> Vec<Vec<f64>> {
    let along = |row: &[f64], matrix: &[Vec<f64>], j: usize| {
        row.iter().zip(matrix).map(|(a, row)| a * row.get(j).copied().unwrap_or(0.0)).sum::<f64>()
    };
    let of = |(d, m): (&Vec<Vec<f64>>, &Vec<Vec<f64>>)| {
        (0..tube.center.len()).map(|j| along(&part.state, d, j) + along(&part.input, m, j)).collect()
    };
    tube.d.iter().zip(&tube.m).map(of).collect()
}

/// Everything of a plan that can be aimed at, what is nearest first.
pub(super) fn aims(problem: &Problem, plan: &Plan) -> Vec<Aim> {
    let Some(targets) = Targets::new(problem, plan) else { return Vec::new() };
    let mut aims = Vec::new();
    for robot in 0..targets.robots.len() {
        for step in 0..=plan.length {
            targets.bounds(robot, step, &mut aims);
            targets.places(robot, step, &mut aims);
            targets.labels(robot, step, &mut aims);
        }
    }
    targets.links(&mut aims);
    targets.separation(&mut aims);
    aims.retain(|aim| aim.reach > 0.0 && aim.room().is_finite());
    aims.sort_by(|a, b| a.room().total_cmp(&b.room()));
    aims
}

/// A plan beside its problem.
struct Targets<'a> {
    problem: &'a Problem,
    plan: &'a Plan,
    robots: Vec<Target<'a>>,
    names: BTreeMap<&'a str, usize>,
}

/// A robot's part of a plan.
struct Target<'a> {
    model: &'a Model,
    plan: &'a RobotPlan,
    tube: &'a Tube,
    /// The half-widths of Θ.
    push: Vec<f64>,
}

impl<'a> Targets<'a> {
    fn new(problem: &'a Problem, plan: &'a Plan) -> Option<Targets<'a>> {
        let robots =
            problem.robots.values().map(|robot| target(problem, plan, robot)).collect::<Option<_>>()?;
        let names = problem.robots.values().enumerate().map(|(i, r)| (r.name.as_str(), i)).collect();
        Some(Targets { problem, plan, robots, names })
    }

    /// An aim at `Σ state · x + input · u ≤ offset`.
    fn aim(&self, step: usize, offset: f64, parts: Vec<Part>) -> Option<Aim> {
        let (mut slack, mut reach) = (offset, 0.0);
        for part in &parts {
            let target = &self.robots[part.robot];
            slack -= dot(&part.state, target.plan.z.get(step)?) + dot(&part.input, target.plan.v.get(step)?);
            let levers = leverage(target.tube, part);
            reach += levers.iter().map(|row| dot_of_magnitudes(row, &target.push)).sum::<f64>();
        }
        Some(Aim { step, slack, reach, parts })
    }

    /// A robot's part along a direction of the workspace.
    fn toward(&self, robot: usize, direction: &[f64]) -> Part {
        let model = self.robots[robot].model;
        let mut state = vec![0.0; model.n()];
        model.position.iter().zip(direction).for_each(|(&i, a)| state[i] += a);
        Part { robot, state, input: Vec::new() }
    }

    /// Bounds of states and inputs.
    fn bounds(&self, robot: usize, step: usize, aims: &mut Vec<Aim>) {
        let model = self.robots[robot].model;
        let unit = |count: usize, i: usize, sign: f64| {
            (0..count).map(|j| if i == j { sign } else { 0.0 }).collect::<Vec<_>>()
        };
        for (i, bound) in model.state_bounds.iter().enumerate() {
            let Some(bound) = bound else { continue };
            for (sign, end) in [(1.0, &bound.hi), (-1.0, &bound.lo)] {
                let part = Part { robot, state: unit(model.n(), i, sign), input: Vec::new() };
                aims.extend(self.aim(step, sign * end.to_f64(), vec![part]));
            }
        }
        for (i, bound) in model.input_bounds.iter().enumerate() {
            for (sign, end) in [(1.0, &bound.hi), (-1.0, &bound.lo)] {
                let part = Part { robot, state: Vec::new(), input: unit(model.m(), i, sign) };
                aims.extend(self.aim(step, sign * end.to_f64(), vec![part]));
            }
        }
        for bound in &model.mixed_bounds {
            let (normal, offset) = floats(bound);
            let (state, input) = normal.split_at(model.n().min(normal.len()));
            let part = Part { robot, state: state.to_vec(), input: input.to_vec() };
            aims.extend(self.aim(step, offset, vec![part]));
        }
    }

    /// The workspace, obstacles and jammers.
    fn places(&self, robot: usize, step: usize, aims: &mut Vec<Aim>) {
        for facet in &self.problem.workspace.facets {
            let (normal, offset) = floats(facet);
            aims.extend(self.aim(step, offset, vec![self.toward(robot, &normal)]));
        }
        // A blocker's planes clear a step and the one after it.
        let next = if step < self.plan.length { step + 1 } else { self.plan.loop_start };
        for steps in self.robots[robot].plan.clear.values() {
            for plane in steps.get(step).into_iter().flatten() {
                for at in [step, next] {
                    aims.extend(self.aim(at, plane.offset, vec![self.toward(robot, &plane.normal)]));
                }
            }
        }
    }

    /// The regions that the robot is certainly in or out of.
    fn labels(&self, robot: usize, step: usize, aims: &mut Vec<Aim>) {
        let target = &self.robots[robot];
        for region in self.problem.regions.values() {
            let label = target.plan.regions.get(&region.name).and_then(|labels| labels.get(step));
            match label {
                Some(Label::In) => {
                    let at: Vec<f64> =
                        target.model.position.iter().map(|&i| target.plan.z[step][i]).collect();
                    let inside = |faces: &Faces| faces.iter().all(|(a, b)| dot(a, &at) <= *b);
                    // Of several pieces the ones that it is in: it would have to leave all of them.
                    let pieces = region.sure().pieces.iter().map(|piece| faces(piece, &at)).filter(inside);
                    for (normal, offset) in pieces.flatten() {
                        aims.extend(self.aim(step, offset, vec![self.toward(robot, &normal)]));
                    }
                }
                Some(Label::Out) => {
                    let planes =
                        target.plan.outside.get(&region.name).and_then(|steps| steps.get(step)?.as_ref());
                    for plane in planes.into_iter().flatten() {
                        aims.extend(self.aim(step, plane.offset, vec![self.toward(robot, &plane.normal)]));
                    }
                }
                _ => {}
            }
        }
    }

    /// The links' planes, and their range.
    fn links(&self, aims: &mut Vec<Aim>) {
        let range = self.problem.connectivity.as_ref().and_then(|c| c.range.as_ref());
        for (step, links) in self.plan.links.iter().flatten().enumerate() {
            for link in links {
                let ends: Vec<usize> = [&link.from, &link.to]
                    .iter()
                    .filter_map(|e| self.names.get(e.as_str()).copied())
                    .collect();
                for Separator { normal, offset, .. } in link.separators.iter().map(|(_, s)| s) {
                    for &end in &ends {
                        aims.extend(self.aim(step, *offset, vec![self.toward(end, normal)]));
                    }
                }
                aims.extend(range.and_then(|range| self.stretched(step, &ends, &link.to, range)));
            }
        }
    }

    /// A link drawn as long as it can be.
    fn stretched(&self, step: usize, ends: &[usize], to: &str, range: &Range) -> Option<Aim> {
        let at = |robot: usize| -> Option<Vec<f64>> {
            let target = &self.robots[robot];
            let z = target.plan.z.get(step)?;
            Some(target.model.position.iter().map(|&i| z[i]).collect())
        };
        let (&first, second) = (ends.first()?, ends.get(1).copied());
        let base = || self.problem.bases.values().find(|b| b.name == to).map(|b| doubles(&b.position));
        let (p, q) = (at(first)?, second.map_or_else(base, at)?);
        let apart: Vec<f64> = p.iter().zip(&q).map(|(a, b)| a - b).collect();
        let direction = match range.norm {
            Norm::Infinity => {
                let most = (0..apart.len()).max_by(|&i, &j| apart[i].abs().total_cmp(&apart[j].abs()))?;
                (0..apart.len()).map(|i| if i == most { apart[i].signum() } else { 0.0 }).collect::<Vec<_>>()
            }
            Norm::Euclidean => {
                let length = dot(&apart, &apart).sqrt();
                apart.iter().map(|x| x / length).collect()
            }
        };
        let back: Vec<f64> = direction.iter().map(|x| -x).collect();
        let mut parts = vec![self.toward(first, &direction)];
        let mut offset = range.length.to_f64();
        match second {
            Some(second) => parts.push(self.toward(second, &back)),
            None => offset += dot(&direction, &q),
        }
        self.aim(step, offset, parts)
    }

    /// Robots that keep apart.
    fn separation(&self, aims: &mut Vec<Aim>) {
        let Some(least) = self.problem.separation.as_ref().map(Rational::to_f64) else { return };
        for (step, all) in self.plan.separation.iter().enumerate() {
            let next = if step < self.plan.length { step + 1 } else { self.plan.loop_start };
            for apart in all {
                let pair = [&apart.pair.0, &apart.pair.1].map(|name| self.names.get(name.as_str()));
                let [Some(&first), Some(&second)] = pair else { continue };
                let sign = f64::from(apart.sign);
                let mut direction = vec![0.0; self.problem.dimension];
                let Some(entry) = direction.get_mut(apart.axis) else { continue };
                *entry = sign;
                let back: Vec<f64> = direction.iter().map(|x| -x).collect();
                for at in [step, next] {
                    let parts = vec![self.toward(first, &back), self.toward(second, &direction)];
                    aims.extend(self.aim(at, -least, parts));
                }
            }
        }
    }
}

fn target<'a>(problem: &'a Problem, plan: &'a Plan, robot: &Robot) -> Option<Target<'a>> {
    let model = &problem.models[robot.model];
    let half = |i: &crate::ir::Interval| (&i.hi - &i.lo).to_f64() / 2.0;
    Some(Target {
        model,
        plan: plan.robots.iter().find(|r| r.name == robot.name)?,
        tube: plan.tubes.iter().find(|t| t.dynamics == model.name)?,
        push: model.disturbance.iter().map(half).collect(),
    })
}

/// Half-spaces: normals and offsets.
type Faces = Vec<(Vec<f64>, f64)>;

/// The half-spaces that hold a piece, as far as they can be left from a point: facets, or the tangent
/// plane of a ball that is nearest to it.
fn faces(piece: &Piece, at: &[f64]) -> Faces {
    match piece {
        Piece::Polytope(polytope) => polytope.facets.iter().map(floats).collect(),
        Piece::Ball { center, spread, radius } => {
            let (center, spread) = (doubles(center), doubles(spread));
            let out: Vec<f64> = at.iter().zip(&center).map(|(p, c)| p - c).collect();
            let length = dot(&out, &out).sqrt();
            let normal: Vec<f64> = if length > 0.0 {
                out.iter().map(|x| x / length).collect()
            } else {
                (0..out.len()).map(|i| if i == 0 { 1.0 } else { 0.0 }).collect()
            };
            // What is certain of a ball whose centre is not lies in all of them.
            let offset = dot(&normal, &center) - dot_of_magnitudes(&normal, &spread) + radius.to_f64();
            vec![(normal, offset)]
        }
    }
}

fn floats(half_space: &HalfSpace) -> (Vec<f64>, f64) {
    (doubles(&half_space.normal), half_space.offset.to_f64())
}

fn doubles(values: &[Rational]) -> Vec<f64> {
    values.iter().map(Rational::to_f64).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn dot_of_magnitudes(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.abs() * b).sum()
}
