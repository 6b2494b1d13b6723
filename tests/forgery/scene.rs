//! Valid pairs of problem and plan, made by hand: double integrators with dead-beat tubes in dyadic
//! numbers, so that every equation holds exactly and every slack is known.

use std::collections::BTreeMap;

use dosmc::entity::EntityId;
use dosmc::exact::{Rational, RationalMatrix};
use dosmc::geometry::Polytope;
use dosmc::ir::{
    Base, Blocker, BlockerKind, Connectivity, Formulas, Goal, Interval, Model, ModelId, Piece, Problem,
    Region, Robot, Shape, Signal,
};
use dosmc::plan::{Apart, Label, Link, Mission, Plan, RobotPlan, Separator, Tube};

/// What the controller's rounding may take; the tube has exactly this much to spare.
pub const RESERVE: f64 = 1.0 / 1048576.0;

/// What is around and who moves where; the rest follows.
pub struct Scene {
    /// Workspace: a box from the origin.
    pub size: f64,
    pub blockers: Vec<(&'static str, BlockerKind, Vec<Piece>)>,
    pub regions: Vec<(&'static str, Vec<Piece>)>,
    pub bases: Vec<(&'static str, [f64; 2])>,
    /// Name, model, places where the robot rests; each leg takes two steps.
    pub robots: Vec<(&'static str, usize, Vec<[f64; 2]>)>,
    /// The resting place after the last one.
    pub loop_place: usize,
    pub separation: Option<f64>,
    pub connectivity: Option<Connectivity>,
    /// The links listed at every step.
    pub links: Vec<(&'static str, &'static str)>,
    /// Least and greatest disturbance of each position, a model each.
    pub theta: Vec<[f64; 2]>,
    /// Whether separating planes all but touch the tubes, instead of standing midway.
    pub tight: bool,
}

impl Default for Scene {
    fn default() -> Scene {
        Scene {
            size: 16.0,
            blockers: vec![],
            regions: vec![],
            bases: vec![],
            robots: vec![],
            loop_place: 0,
            separation: None,
            connectivity: None,
            links: vec![],
            theta: vec![[-0.125, 0.125]],
            tight: false,
        }
    }
}

pub fn exact(x: f64) -> Rational {
    Rational::from_f64(x).unwrap()
}

pub fn point(p: &[f64]) -> Vec<Rational> {
    p.iter().map(|&x| exact(x)).collect()
}

pub fn boxed(lo: [f64; 2], hi: [f64; 2]) -> Piece {
    Piece::Polytope(Polytope::from_box(&point(&lo), &point(&hi)))
}

pub fn disc(center: [f64; 2], radius: f64) -> Piece {
    Piece::Ball { center: point(&center), spread: point(&[0.0, 0.0]), radius: exact(radius) }
}

pub fn any_hops() -> Connectivity {
    Connectivity { hops: None, range: None, redundancy: 0, every: 1 }
}

impl Scene {
    /// The problem, without goals, and a plan of it.
    pub fn build(&self) -> (Problem, Plan) {
        let problem = self.problem();
        let plan = self.plan(&problem);
        (problem, plan)
    }

    fn problem(&self) -> Problem {
        let shape = |pieces: &Vec<Piece>| Shape { pieces: pieces.clone() };
        Problem {
            name: "scene".into(),
            doc: String::new(),
            sha256: "00ff".into(),
            set: BTreeMap::from([("radius".into(), "1.5".into())]),
            dimension: 2,
            step: Rational::ratio(1, 2),
            workspace: Polytope::from_box(&point(&[0.0, 0.0]), &point(&[self.size, self.size])),
            regions: self
                .regions
                .iter()
                .map(|(name, pieces)| Region {
                    name: (*name).into(),
                    doc: String::new(),
                    shape: shape(pieces),
                    sure: None,
                })
                .collect(),
            blockers: self
                .blockers
                .iter()
                .map(|(name, kind, pieces)| {
                    let shape = shape(pieces);
                    Blocker { name: (*name).into(), doc: String::new(), kind: *kind, shape }
                })
                .collect(),
            bases: self
                .bases
                .iter()
                .map(|(name, p)| Base { name: (*name).into(), doc: String::new(), position: point(p) })
                .collect(),
            models: self.theta.iter().enumerate().map(|(i, theta)| model(i, *theta)).collect(),
            robots: self
                .robots
                .iter()
                .map(|(name, model, places)| Robot {
                    name: (*name).into(),
                    doc: String::new(),
                    model: ModelId::new(*model),
                    start: point(&[places[0][0], 0.0, places[0][1], 0.0]),
                })
                .collect(),
            separation: self.separation.map(exact),
            connectivity: self.connectivity.clone(),
            horizon: (1, 64),
            objective: None,
            formulas: Formulas::new(),
            goals: Vec::<Goal>::new(),
        }
    }

    fn plan(&self, problem: &Problem) -> Plan {
        let legs = self.robots[0].2.len();
        let steps = 2 * legs;
        let mut plan = Plan {
            tool: "by hand".into(),
            mission: Mission { name: "scene".into(), sha256: "00ff".into(), set: problem.set.clone() },
            step_s: 0.5,
            length: steps - 1,
            loop_start: 2 * self.loop_place,
            tubes: self.theta.iter().enumerate().map(|(i, theta)| tube(i, *theta)).collect(),
            robots: vec![],
            links: None,
            separation: vec![],
            objective: None,
        };
        for (name, model, places) in &self.robots {
            let (z, v) = self.motion(places);
            let dynamics = format!("Rover{model}");
            let (regions, outside, clear) = (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
            let mut robot = RobotPlan { name: (*name).into(), dynamics, z, v, regions, outside, clear };
            self.label(&mut robot, *model);
            self.clear(&mut robot, *model, plan.loop_start);
            plan.robots.push(robot);
        }
        plan.links =
            self.connectivity.as_ref().map(|_| (0..steps).map(|t| self.links_at(&plan, t)).collect());
        if self.separation.is_some() {
            plan.separation = (0..steps).map(|t| self.sides(&plan, t)).collect();
        }
        plan
    }

    /// From rest to rest: accelerate for one step, brake for one step.
    fn motion(&self, places: &[[f64; 2]]) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let (mut z, mut v) = (vec![], vec![]);
        for (i, from) in places.iter().enumerate() {
            let to = places.get(i + 1).unwrap_or(&places[self.loop_place]);
            let a = [0, 1].map(|axis| 4.0 * (to[axis] - from[axis]));
            z.push(vec![from[0], 0.0, from[1], 0.0]);
            v.push(a.to_vec());
            z.push(vec![from[0] + a[0] / 8.0, a[0] / 2.0, from[1] + a[1] / 8.0, a[1] / 2.0]);
            v.push(vec![-a[0], -a[1]]);
        }
        (z, v)
    }

    /// max a·e over the position part of the tube: D_0 and D_1 add up to 1 + 1/2 of the position's
    /// disturbance and 1/8 of the velocity's.
    fn support(&self, model: usize, a: [f64; 2]) -> f64 {
        let ([center, _], [half, slow]) = disturbance_box(self.theta[model]);
        a.iter().map(|x| x * center * 1.5 + x.abs() * (half * 1.5 + slow / 8.0)).sum()
    }

    fn label(&self, robot: &mut RobotPlan, model: usize) {
        for (name, pieces) in &self.regions {
            let mut labels = vec![];
            let mut witnesses = vec![];
            for z in &robot.z {
                let p = [z[0], z[2]];
                let witness: Option<Vec<Separator>> = (0..pieces.len())
                    .map(|i| self.separate(i, &pieces[i], &[p], |a| self.support(model, a)))
                    .collect();
                let inside = pieces.iter().any(|piece| self.inside(piece, p, model));
                labels.push(if inside {
                    Label::In
                } else if witness.is_some() {
                    Label::Out
                } else {
                    Label::Unknown
                });
                witnesses.push(if labels.last() == Some(&Label::Out) { witness } else { None });
            }
            robot.regions.insert((*name).into(), labels);
            robot.outside.insert((*name).into(), witnesses);
        }
    }

    fn inside(&self, piece: &Piece, p: [f64; 2], model: usize) -> bool {
        let h = |a: [f64; 2]| self.support(model, a);
        match piece {
            Piece::Polytope(polytope) => polytope.facets.iter().all(|f| {
                let a = [f.normal[0].to_f64(), f.normal[1].to_f64()];
                a[0] * p[0] + a[1] * p[1] + h(a) <= f.offset.to_f64()
            }),
            Piece::Ball { center, radius, .. } => {
                let farthest = |axis: usize| {
                    let d = p[axis] - center[axis].to_f64();
                    let mut unit = [0.0; 2];
                    unit[axis] = 1.0;
                    (d + h(unit)).abs().max((d - h(unit.map(|x| -x))).abs())
                };
                farthest(0).hypot(farthest(1)) < radius.to_f64()
            }
        }
    }

    fn clear(&self, robot: &mut RobotPlan, model: usize, loop_start: usize) {
        for (name, _, pieces) in &self.blockers {
            let planes = |t: usize| {
                let next = if t + 1 < robot.z.len() { t + 1 } else { loop_start };
                let ends = [t, next].map(|t| [robot.z[t][0], robot.z[t][2]]);
                let plane = |(i, piece)| {
                    self.separate(i, piece, &ends, |a| self.support(model, a)).expect("no plane")
                };
                pieces.iter().enumerate().map(plane).collect()
            };
            let steps = (0..robot.z.len()).map(planes).collect();
            robot.clear.insert((*name).into(), steps);
        }
    }

    fn links_at(&self, plan: &Plan, t: usize) -> Vec<Link> {
        let end = |name: &str| {
            let robot = plan.robots.iter().find(|r| r.name == name).map(|r| [r.z[t][0], r.z[t][2]]);
            robot.unwrap_or_else(|| self.bases.iter().find(|(b, _)| *b == name).unwrap().1)
        };
        let reach = |a: [f64; 2]| (0..self.theta.len()).map(|m| self.support(m, a)).fold(0.0, f64::max);
        let link = |(from, to): &(&str, &str)| {
            let ends = [end(from), end(to)];
            let mut separators = vec![];
            for (name, kind, pieces) in &self.blockers {
                if kind.blocks_links() {
                    let planes = pieces.iter().enumerate().map(|(i, p)| self.separate(i, p, &ends, reach));
                    separators.extend(planes.map(|p| ((*name).to_string(), p.expect("no plane"))));
                }
            }
            Link { from: (*from).into(), to: (*to).into(), hops: 1, separators }
        };
        self.links.iter().map(link).collect()
    }

    fn sides(&self, plan: &Plan, t: usize) -> Vec<Apart> {
        let next = if t < plan.length { t + 1 } else { plan.loop_start };
        let mut sides = vec![];
        for (j, second) in plan.robots.iter().enumerate() {
            for first in &plan.robots[..j] {
                let distance = |axis: usize, sign: f64| {
                    let at = |t: usize| sign * (first.z[t][2 * axis] - second.z[t][2 * axis]);
                    at(t).min(at(next))
                };
                let all = [(0, 1i8), (0, -1), (1, 1), (1, -1)];
                let by = |s: &(usize, i8)| distance(s.0, f64::from(s.1));
                let (axis, sign) = all.into_iter().max_by(|a, b| by(a).total_cmp(&by(b))).unwrap();
                sides.push(Apart { pair: (first.name.clone(), second.name.clone()), axis, sign });
            }
        }
        sides
    }

    /// A plane midway between points with their tube and a piece, among sixteen directions.
    fn separate(
        &self,
        piece: usize,
        shape: &Piece,
        points: &[[f64; 2]],
        support: impl Fn([f64; 2]) -> f64,
    ) -> Option<Separator> {
        let directions = (0..16).map(|i| {
            let angle = f64::from(i) * std::f64::consts::PI / 8.0;
            // Multiples of 1/64: short numbers, none of them needs to be a unit vector.
            [(angle.cos() * 64.0).round() / 64.0, (angle.sin() * 64.0).round() / 64.0]
        });
        let gap = |a: [f64; 2]| {
            let near = points.iter().map(|p| a[0] * p[0] + a[1] * p[1]).fold(f64::MIN, f64::max) + support(a);
            let far = match shape {
                Piece::Polytope(polytope) => polytope
                    .vertices
                    .iter()
                    .map(|q| a[0] * q[0].to_f64() + a[1] * q[1].to_f64())
                    .fold(f64::MAX, f64::min),
                Piece::Ball { center, spread, radius } => {
                    let along = |x: &[Rational]| a[0] * x[0].to_f64() + a[1] * x[1].to_f64();
                    let spread = a[0].abs() * spread[0].to_f64() + a[1].abs() * spread[1].to_f64();
                    along(center) - spread - radius.to_f64() * a[0].hypot(a[1])
                }
            };
            (far - near, if self.tight { near + 1e-12 } else { (far + near) / 2.0 })
        };
        let best = directions.max_by(|a, b| gap(*a).0.total_cmp(&gap(*b).0))?;
        let (room, offset) = gap(best);
        (room > 1e-9).then(|| Separator { piece, normal: best.to_vec(), offset })
    }
}

fn model(index: usize, theta: [f64; 2]) -> Model {
    let signal = |name: &str, unit: &str| Signal { name: name.into(), doc: String::new(), unit: unit.into() };
    let matrix = |rows: usize, columns: usize, entries: &[f64]| {
        RationalMatrix::from_row_iterator(rows, columns, entries.iter().map(|&x| exact(x)))
    };
    let bound = |b: f64| Interval { lo: exact(-b), hi: exact(b) };
    let disturbed = Interval { lo: exact(theta[0]), hi: exact(theta[1]) };
    Model {
        name: format!("Rover{index}"),
        doc: String::new(),
        states: vec![signal("px", "m"), signal("vx", "m/s"), signal("py", "m"), signal("vy", "m/s")],
        inputs: vec![signal("ax", "m/s^2"), signal("ay", "m/s^2")],
        position: vec![0, 2],
        a: matrix(4, 4, &[1.0, 0.5, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.5, 0.0, 0.0, 0.0, 1.0]),
        b: matrix(4, 2, &[0.125, 0.0, 0.5, 0.0, 0.0, 0.125, 0.0, 0.5]),
        c: point(&[0.0; 4]),
        enclosure: None,
        state_bounds: vec![None, Some(bound(8.0)), None, Some(bound(8.0))],
        input_bounds: vec![bound(12.0), bound(12.0)],
        mixed_bounds: vec![],
        disturbance: vec![disturbed.clone(), bound(0.0), disturbed, bound(0.0)],
        rejection: None,
    }
}

/// Centre and half-width for position and velocity: Θ and the reserve, no more.
fn disturbance_box(theta: [f64; 2]) -> ([f64; 2], [f64; 2]) {
    ([(theta[0] + theta[1]) / 2.0, 0.0], [(theta[1] - theta[0]) / 2.0 + RESERVE, RESERVE])
}

/// The dead-beat tube of u = −4 p − 3 v: D_1 = A + B K, D_1² = 0.
fn tube(index: usize, theta: [f64; 2]) -> Tube {
    let (center, half_width) = disturbance_box(theta);
    let twice = |x: [f64; 2]| vec![x[0], x[1], x[0], x[1]];
    let blocks = |rows: &[[f64; 2]]| -> Vec<Vec<f64>> {
        let left = rows.iter().map(|r| vec![r[0], r[1], 0.0, 0.0]);
        left.chain(rows.iter().map(|r| vec![0.0, 0.0, r[0], r[1]])).collect()
    };
    Tube {
        dynamics: format!("Rover{index}"),
        center: twice(center),
        half_width: twice(half_width),
        reserve: vec![RESERVE; 4],
        d: vec![blocks(&[[1.0, 0.0], [0.0, 1.0]]), blocks(&[[0.5, 0.125], [-2.0, -0.5]])],
        m: vec![blocks(&[[-4.0, -3.0]]), blocks(&[[4.0, 1.0]])],
    }
}
