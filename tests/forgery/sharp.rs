//! Every number of a mission, moved to just where the plan stops being one: the checker accepts it a
//! nanometre before and refuses it a nanometre after, and says which part is at fault.
//!
//! Where that is follows from the plan by a formula of its own, in plain floating point. Two missions
//! have between them every construct with a number, in the plane and in space.

use dosmc::entity::EntityId;
use dosmc::exact::Rational;
use dosmc::geometry::HalfSpace;
use dosmc::ir::{BlockerId, Interval, ModelId, Norm, Piece, Problem, Range, RegionId};
use dosmc::plan::{Label, Plan, Separator};
use dosmc::verify::{Kind, verify};

use crate::flights::solved_text;
use crate::scene::exact;

/// In metres.
const HAIR: f64 = 1e-9;

/// A limit: how far something may move before this kind of check fails.
struct Limit {
    kind: Kind,
    at: f64,
}

/// What moves at `rate` has `slack` left.
fn limit(kind: Kind, slack: f64, rate: f64) -> Option<Limit> {
    (rate > 1e-6).then(|| Limit { kind, at: slack / rate })
}

/// The first of the limits is where the verdict changes, and its kind of check is what is said to fail.
#[track_caller]
fn sharp(
    what: &str,
    plan: &Plan,
    limits: impl IntoIterator<Item = Option<Limit>>,
    moved: impl Fn(f64) -> Problem,
) {
    let limits: Vec<Limit> = limits.into_iter().flatten().collect();
    let first = limits.iter().map(|limit| limit.at).fold(f64::INFINITY, f64::min);
    assert!(first.is_finite(), "{what}: nothing limits it");
    assert!(first > HAIR, "{what}: only {first} left");
    let before = verify(&moved(first - HAIR), plan);
    assert!(before.holds(), "{what}, a hair before {first}: {before}");
    let after = verify(&moved(first + HAIR), plan);
    assert!(!after.holds(), "{what}: accepted a hair after {first}");
    // One plane may serve several checks.
    let at_fault =
        |kind: Kind| limits.iter().any(|limit| limit.kind == kind && limit.at < first + 2.0 * HAIR);
    let named = after.failures.iter().all(|failure| at_fault(failure.check));
    assert!(named, "{what}: another part is at fault: {after}");
}

struct Case {
    problem: Problem,
    plan: Plan,
}

type Vector = Vec<f64>;

fn times(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn length(a: &[f64]) -> f64 {
    times(a, a).sqrt()
}

fn floats(v: &[Rational]) -> Vector {
    v.iter().map(Rational::to_f64).collect()
}

impl Case {
    fn new(name: &str, text: &str) -> Case {
        let (problem, plan) = solved_text(name, text);
        Case { problem, plan }
    }

    fn with(&self, change: impl FnOnce(&mut Problem)) -> Problem {
        let mut problem = self.problem.clone();
        change(&mut problem);
        problem
    }

    fn model_of(&self, robot: usize) -> ModelId {
        self.problem.robots.values().nth(robot).unwrap().model
    }

    fn p(&self, robot: usize, t: usize) -> Vector {
        let model = &self.problem.models[self.model_of(robot)];
        model.position.iter().map(|&i| self.plan.robots[robot].z[t][i]).collect()
    }

    fn next(&self, t: usize) -> usize {
        if t < self.plan.length { t + 1 } else { self.plan.loop_start }
    }

    /// max a·e + b·μ over a model's tube.
    fn reach(&self, model: ModelId, a: &[f64], b: &[f64]) -> f64 {
        let name = &self.problem.models[model].name;
        let tube = self.plan.tubes.iter().find(|t| t.dynamics == *name).unwrap();
        let mut sum = 0.0;
        for (d, m) in tube.d.iter().zip(&tube.m) {
            for j in 0..tube.center.len() {
                let column = |rows: &Vec<Vector>, a: &[f64]| -> f64 {
                    a.iter().zip(rows).map(|(x, row)| x * row[j]).sum()
                };
                let entry = column(d, a) + column(m, b);
                sum += entry * tube.center[j] + entry.abs() * tube.half_width[j];
            }
        }
        sum
    }

    /// The same for a direction of the workspace.
    fn width(&self, model: ModelId, direction: &[f64]) -> f64 {
        let states = &self.problem.models[model];
        let mut a = vec![0.0; states.n()];
        states.position.iter().zip(direction).for_each(|(&i, x)| a[i] = *x);
        self.reach(model, &a, &[])
    }

    /// Every plane before a piece of a blocker, with the check that it belongs to.
    fn planes(&self, blocker: &str, piece: usize) -> Vec<(Kind, &Separator)> {
        let clear = self.plan.robots.iter().flat_map(|r| r.clear[blocker].iter().flatten());
        let links = self.plan.links.iter().flatten().flatten().flat_map(|link| &link.separators);
        let links = links.filter(|(name, _)| name == blocker).map(|(_, plane)| plane);
        let all = clear.map(|p| (Kind::Blockers, p)).chain(links.map(|p| (Kind::Links, p)));
        all.filter(|(_, plane)| plane.piece == piece).collect()
    }

    /// Each blocker that is a polytope, pushed towards the plane that is nearest to it.
    fn polytopes_are_sharp(&self) -> usize {
        let mut count = 0;
        for (id, blocker) in self.problem.blockers.iter() {
            for (i, piece) in blocker.shape.pieces.iter().enumerate() {
                let Piece::Polytope(polytope) = piece else { continue };
                let vertices: Vec<Vector> = polytope.vertices.iter().map(|v| floats(v)).collect();
                let slack = |plane: &Separator| {
                    let level = vertices.iter().map(|v| times(&plane.normal, v)).fold(f64::MAX, f64::min);
                    level - plane.offset
                };
                let planes = self.planes(&blocker.name, i);
                let relative = |plane: &Separator| slack(plane) / length(&plane.normal);
                let nearest = planes.iter().min_by(|a, b| relative(a.1).total_cmp(&relative(b.1))).unwrap().1;
                let size = length(&nearest.normal);
                let direction: Vector = nearest.normal.iter().map(|x| -x / size).collect();
                let limits =
                    planes.iter().map(|(kind, p)| limit(*kind, slack(p), -times(&p.normal, &direction)));
                sharp(&format!("{}, piece {i}", blocker.name), &self.plan, limits, |by| {
                    let offset: Vec<Rational> = direction.iter().map(|x| exact(x * by)).collect();
                    self.with_piece(id, i, Piece::Polytope(polytope.translate(&offset)))
                });
                count += 1;
            }
        }
        count
    }

    fn with_piece(&self, id: BlockerId, i: usize, piece: Piece) -> Problem {
        self.with(|problem| problem.blockers[id].shape.pieces[i] = piece)
    }

    /// Each Euclidean ball among the blockers, with a larger radius and a less certain centre.
    fn balls_are_sharp(&self) -> usize {
        let mut count = 0;
        for (id, blocker) in self.problem.blockers.iter() {
            for (i, piece) in blocker.shape.pieces.iter().enumerate() {
                let Piece::Ball { center, spread, radius } = piece else { continue };
                let planes = self.planes(&blocker.name, i);
                let slack = |plane: &Separator| {
                    let a = &plane.normal;
                    let blur: f64 = a.iter().zip(spread).map(|(a, s)| a.abs() * s.to_f64()).sum();
                    times(a, &floats(center)) - blur - radius.to_f64() * length(a) - plane.offset
                };
                let ball = |spread: Vec<Rational>, radius: Rational| {
                    self.with_piece(id, i, Piece::Ball { center: center.clone(), spread, radius })
                };
                let limits = planes.iter().map(|(k, p)| limit(*k, slack(p), length(&p.normal)));
                sharp(&format!("the radius of {}", blocker.name), &self.plan, limits, |by| {
                    ball(spread.clone(), radius + exact(by))
                });
                for axis in 0..center.len() {
                    let limits: Vec<Option<Limit>> =
                        planes.iter().map(|(k, p)| limit(*k, slack(p), p.normal[axis].abs())).collect();
                    if limits.iter().all(Option::is_none) {
                        continue;
                    }
                    sharp(&format!("the place of {} along {axis}", blocker.name), &self.plan, limits, |by| {
                        let mut spread = spread.clone();
                        spread[axis] += exact(by);
                        ball(spread, radius.clone())
                    });
                }
                count += 1;
            }
        }
        count
    }

    /// Each region of one piece: a polytope pushed along each axis, a ball grown and shrunk.
    fn regions_are_sharp(&self) -> usize {
        let mut count = 0;
        for (id, region) in self.problem.regions.iter() {
            let [piece] = &region.shape.pieces[..] else { continue };
            match piece {
                Piece::Polytope(polytope) => {
                    for (axis, sign) in
                        (0..self.problem.dimension).flat_map(|axis| [(axis, 1.0), (axis, -1.0)])
                    {
                        let mut direction = vec![0.0; self.problem.dimension];
                        direction[axis] = sign;
                        let limits = self.region_limits(id, &polytope.facets, &direction);
                        if limits.iter().all(Option::is_none) {
                            continue;
                        }
                        sharp(&format!("{} along {axis}", region.name), &self.plan, limits, |by| {
                            let offset: Vec<Rational> = direction.iter().map(|x| exact(x * by)).collect();
                            let moved = Piece::Polytope(polytope.translate(&offset));
                            self.with(|problem| problem.regions[id].shape.pieces = vec![moved])
                        });
                        count += 1;
                    }
                }
                Piece::Ball { center, spread, radius } => {
                    let limits = self.ball_limits(id, &floats(center), &floats(spread), radius.to_f64());
                    sharp(&format!("the radius of {}", region.name), &self.plan, limits, |by| {
                        let (center, spread) = (center.clone(), spread.clone());
                        let ball = Piece::Ball { center, spread, radius: radius - exact(by) };
                        self.with(|problem| problem.regions[id].shape.pieces = vec![ball])
                    });
                    count += 1;
                }
            }
        }
        count
    }

    /// By robot and step: the label of a region.
    fn labels(&self, region: RegionId) -> impl Iterator<Item = (usize, usize, Label)> {
        let name = &self.problem.regions[region].name;
        let robots = self.plan.robots.iter().enumerate();
        robots.flat_map(move |(i, robot)| {
            let labels = robot.regions.get(name).into_iter().flatten();
            labels.enumerate().map(move |(t, label)| (i, t, *label))
        })
    }

    fn region_limits(&self, id: RegionId, facets: &[HalfSpace], direction: &[f64]) -> Vec<Option<Limit>> {
        let mut limits = vec![];
        for (robot, t, label) in self.labels(id) {
            if label == Label::In {
                for facet in facets {
                    let normal = floats(&facet.normal);
                    let width = self.width(self.model_of(robot), &normal);
                    let slack = facet.offset.to_f64() - times(&normal, &self.p(robot, t)) - width;
                    limits.push(limit(Kind::Regions, slack, -times(&normal, direction)));
                }
            }
            let witness = self.plan.robots[robot].outside.get(&self.problem.regions[id].name);
            for plane in witness.and_then(|w| w[t].as_ref()).into_iter().flatten() {
                let Piece::Polytope(polytope) = &self.problem.regions[id].shape.pieces[0] else { continue };
                let level = |v: &Vec<Rational>| times(&plane.normal, &floats(v));
                let level = polytope.vertices.iter().map(level).fold(f64::MAX, f64::min);
                limits.push(limit(Kind::Regions, level - plane.offset, -times(&plane.normal, direction)));
            }
        }
        limits
    }

    /// How much smaller a ball may be; the tubes are boxes here.
    fn ball_limits(&self, id: RegionId, center: &[f64], spread: &[f64], radius: f64) -> Vec<Option<Limit>> {
        let inside = self.labels(id).filter(|(_, _, label)| *label == Label::In);
        let slack = |(robot, t, _): (usize, usize, Label)| {
            let p = self.p(robot, t);
            let far = |axis: usize| {
                let ends = [1.0, -1.0].map(|sign| {
                    let mut unit = vec![0.0; center.len()];
                    unit[axis] = sign;
                    let end = p[axis] + sign * self.width(self.model_of(robot), &unit);
                    (end - center[axis]).abs() + spread[axis]
                });
                ends[0].max(ends[1])
            };
            let far: Vector = (0..center.len()).map(far).collect();
            limit(Kind::Regions, radius - length(&far), 1.0)
        };
        inside.map(slack).collect()
    }

    fn workspace_is_sharp(&self) -> usize {
        let facets = &self.problem.workspace.facets;
        for (i, facet) in facets.iter().enumerate() {
            let normal = floats(&facet.normal);
            let slack = |(robot, t): (usize, usize)| {
                let width = self.width(self.model_of(robot), &normal);
                facet.offset.to_f64() - times(&normal, &self.p(robot, t)) - width
            };
            let limits = self.moments().map(|moment| limit(Kind::Workspace, slack(moment), 1.0));
            sharp(&format!("wall {i}"), &self.plan, limits, |by| {
                self.with(|problem| problem.workspace.facets[i].offset = &facet.offset - exact(by))
            });
        }
        facets.len()
    }

    fn moments(&self) -> impl Iterator<Item = (usize, usize)> {
        (0..self.plan.robots.len()).flat_map(|robot| (0..=self.plan.length).map(move |t| (robot, t)))
    }

    /// Each bound of each model, alone and joint, on both sides.
    fn bounds_are_sharp(&self) -> usize {
        let mut count = 0;
        for (id, model) in self.problem.models.iter() {
            let (n, m) = (model.n(), model.m());
            let mut single = |i: usize, bound: &Interval, kind: Kind| {
                for sign in [1.0, -1.0] {
                    let mut row = vec![0.0; n + m];
                    row[i] = sign;
                    let end = if sign > 0.0 { bound.hi.to_f64() } else { -bound.lo.to_f64() };
                    let limits = self.bound_limits(id, &row, end, kind);
                    sharp(&format!("bound {i} of {}", model.name), &self.plan, limits, |by| {
                        let tighter = match sign > 0.0 {
                            true => Interval { lo: bound.lo.clone(), hi: &bound.hi - exact(by) },
                            false => Interval { lo: &bound.lo + exact(by), hi: bound.hi.clone() },
                        };
                        self.with(|problem| match i.checked_sub(n) {
                            None => problem.models[id].state_bounds[i] = Some(tighter),
                            Some(input) => problem.models[id].input_bounds[input] = tighter,
                        })
                    });
                    count += 1;
                }
            };
            for (i, bound) in model.state_bounds.iter().enumerate() {
                bound.iter().for_each(|bound| single(i, bound, Kind::States));
            }
            for (i, bound) in model.input_bounds.iter().enumerate() {
                single(n + i, bound, Kind::Inputs);
            }
            for (i, bound) in model.mixed_bounds.iter().enumerate() {
                let kind =
                    if bound.normal[n..].iter().all(Rational::is_zero) { Kind::States } else { Kind::Inputs };
                let limits = self.bound_limits(id, &floats(&bound.normal), bound.offset.to_f64(), kind);
                sharp(&format!("row {i} of {}", model.name), &self.plan, limits, |by| {
                    self.with(|problem| problem.models[id].mixed_bounds[i].offset = &bound.offset - exact(by))
                });
                count += 1;
            }
        }
        count
    }

    fn bound_limits(&self, id: ModelId, row: &[f64], end: f64, kind: Kind) -> Vec<Option<Limit>> {
        let (a, b) = row.split_at(self.problem.models[id].n());
        let width = self.reach(id, a, b);
        let mine = self.moments().filter(|(robot, _)| self.model_of(*robot) == id);
        let slack = |(robot, t): (usize, usize)| {
            let plan = &self.plan.robots[robot];
            end - times(a, &plan.z[t]) - times(b, &plan.v[t]) - width
        };
        mine.map(|moment| limit(kind, slack(moment), 1.0)).collect()
    }

    fn separation_is_sharp(&self) {
        let least = self.problem.separation.as_ref().unwrap();
        let robot = |name: &str| self.plan.robots.iter().position(|r| r.name == name).unwrap();
        let mut limits = vec![];
        for (t, sides) in self.plan.separation.iter().enumerate() {
            for side in sides {
                let (i, j) = (robot(&side.pair.0), robot(&side.pair.1));
                let mut toward = vec![0.0; self.problem.dimension];
                toward[side.axis] = -f64::from(side.sign);
                let away: Vector = toward.iter().map(|x| -x).collect();
                let tubes = self.width(self.model_of(i), &toward) + self.width(self.model_of(j), &away);
                for t in [t, self.next(t)] {
                    let apart = times(&away, &self.p(i, t)) - times(&away, &self.p(j, t));
                    limits.push(limit(Kind::Separation, apart - tubes - least.to_f64(), 1.0));
                }
            }
        }
        sharp("separation", &self.plan, limits, |by| {
            self.with(|problem| problem.separation = Some(least + exact(by)))
        });
    }

    /// The longest link that is listed; the tubes are boxes here.
    fn range_is_sharp(&self) {
        for norm in [Norm::Infinity, Norm::Euclidean] {
            let mut longest: f64 = 0.0;
            for (t, links) in self.plan.links.iter().flatten().enumerate() {
                for link in links {
                    let [from, to] = [&link.from, &link.to].map(|name| self.end(name, t));
                    let far = |axis: usize| {
                        let (low, high) = (from.0[axis] - to.1[axis], from.1[axis] - to.0[axis]);
                        low.abs().max(high.abs())
                    };
                    let far: Vector = (0..self.problem.dimension).map(far).collect();
                    longest = longest.max(match norm {
                        Norm::Infinity => far.iter().copied().fold(0.0, f64::max),
                        Norm::Euclidean => length(&far),
                    });
                }
            }
            let wide = 2.0 * longest;
            let limits = [limit(Kind::Links, wide - longest, 1.0)];
            sharp(&format!("range in the norm {norm:?}"), &self.plan, limits, |by| {
                let range = Some(Range { length: exact(wide - by), norm });
                self.with(|problem| problem.connectivity.as_mut().unwrap().range = range)
            });
        }
    }

    /// Where an end of a link may be: the corners of its box.
    fn end(&self, name: &str, t: usize) -> (Vector, Vector) {
        let Some(robot) = self.plan.robots.iter().position(|r| r.name == *name) else {
            let base = self.problem.bases.values().find(|b| b.name == *name).unwrap();
            return (floats(&base.position), floats(&base.position));
        };
        let p = self.p(robot, t);
        let corner = |sign: f64| {
            let along = |axis: usize| {
                let mut unit = vec![0.0; p.len()];
                unit[axis] = sign;
                p[axis] + sign * self.width(self.model_of(robot), &unit)
            };
            (0..p.len()).map(along).collect()
        };
        (corner(-1.0), corner(1.0))
    }

    /// Starts, and disturbances beyond what the tube was made for.
    fn tubes_are_sharp(&self) {
        for (id, robot) in self.problem.robots.iter() {
            let model = &self.problem.models[robot.model];
            let tube = self.plan.tubes.iter().find(|t| t.dynamics == model.name).unwrap();
            for i in 0..model.n() {
                for sign in [1.0, -1.0] {
                    let off = robot.start[i].to_f64() - self.plan.robots[id.index()].z[0][i] - tube.center[i];
                    let limits = [limit(Kind::Start, tube.half_width[i] - sign * off, 1.0)];
                    if limits.iter().flatten().any(|l| l.at <= 2.0 * HAIR) {
                        continue;
                    }
                    sharp("a start", &self.plan, limits, |by| {
                        self.with(|p| p.robots[id].start[i] = &robot.start[i] + exact(sign * by))
                    });
                }
            }
        }
        for (id, model) in self.problem.models.iter() {
            for i in 0..model.n() {
                let wider = self.with(|problem| {
                    let theta = &mut problem.models[id].disturbance[i];
                    theta.hi = &theta.hi + exact(1e-4);
                });
                crate::cases::refused(&wider, &self.plan, Kind::Tube);
            }
        }
    }
}

const PLANE: &str = r"
dosm 1
mission plane
workspace polygon (0, 0), (15, 0), (16, 8), (12, 14), (0, 14)
region a = polygon (11, 3), (14.5, 4), (13, 8), (11, 7)
region b = disc (4, 11) radius 2
region c = where { x + y <= 9; x >= 4; y >= 1 }
obstacle rock = hull (6, 9), (7.5, 9.2), (7, 10.5), (6, 10.2), (6.6, 9.6)
opaque obstacle house = polygon (8, 1), (9, 1.2), (8.6, 2.5) or box (9.5, 9) .. (10.5, 10)
jammer J1 = ball (7, 6) radius 0.8 norm 1
jammer J2 = disc (10 +/- 0.2, 6 +/- 0.1) radius 0.6 +/- 0.1
jammer J3 = ball (2, 7) radius 0.4 or where { x >= 4.2; y >= 7.6; x + 2 * y <= 21.2 }
base B1 at (1, 1)
base B2 at (15, 2)
dynamics Rover {
  step 0.5 s
  integrator 2
  bound vx, vy in [-4, 3.5] m/s
  bound ax, ay in [-4, 4] m/s^2
  bound where { vx + vy <= 5; vx + 0.5 s * ax <= 4.5 m/s }
  disturbance px in [-0.02, 0.08] m
  disturbance py in [-0.05, 0.05] m
}
dynamics Point { step 0.5 s integrator 1 bound vx, vy in [-3, 3] m/s disturbance px, py in [-0.1, 0.02] m }
robot R1: Rover at (2, 2)
robot R2: Point at (3, 4)
robot R3: Rover at (6, 2)
separation 0.3 m
connectivity { hops <= 3 }
horizon 1..24
goal g1: eventually R1 in a
goal g2: always eventually R2 in b
goal g3: not R2 in c until R3 in a
";

const SPACE: &str = r"
dosm 1
mission space
workspace where { x >= 0; y >= 0; z >= 0; x <= 12; y <= 12; z <= 8; x + y + z <= 28 }
region a = hull (8, 8, 1), (11.5, 8, 1), (8, 11.5, 1), (8, 8, 5), (11, 11, 5)
region b = ball (3, 9, 3) radius 2 norm 2
obstacle rock = hull (5, 5, 0), (6.5, 5, 0), (5, 6.5, 0), (5.2, 5.2, 3)
opaque obstacle tower = box (8, 3, 0) .. (9, 4, 5)
jammer J1 = ball (6 +/- 0.1, 8.5, 4 +/- 0.2) radius 0.7 norm 2
jammer J2 = ball (3, 5.5, 2) radius 0.6 norm 1
jammer J3 = ball (10, 6, 3) radius 0.5
base B1 at (1, 1, 1)
base B2 at (11, 1, 1)
dynamics Drone {
  step 0.5 s
  integrator 2
  bound vx, vy, vz in [-4, 4] m/s
  bound ax, ay, az in [-5, 5] m/s^2
  disturbance px, py in [-0.05, 0.05] m
  disturbance pz in [-0.06, 0.01] m
}
robot D1: Drone at (2, 2, 2)
robot D2: Drone at (4, 2, 2)
separation 0.4 m
horizon 1..20
goal g1: eventually D1 in a
goal g2: eventually D2 in b
";

#[test]
fn every_number_in_the_plane_is_sharp() {
    let case = Case::new("plane", PLANE);
    assert_eq!(case.polytopes_are_sharp(), 6);
    assert_eq!(case.balls_are_sharp(), 1);
    assert!(case.regions_are_sharp() >= 5);
    assert_eq!(case.workspace_is_sharp(), 5);
    assert!(case.bounds_are_sharp() >= 14);
    case.separation_is_sharp();
    case.range_is_sharp();
    case.tubes_are_sharp();
}

#[test]
fn every_number_in_space_is_sharp() {
    let case = Case::new("space", SPACE);
    assert_eq!(case.polytopes_are_sharp(), 4);
    assert_eq!(case.balls_are_sharp(), 1);
    assert!(case.regions_are_sharp() >= 4);
    assert_eq!(case.workspace_is_sharp(), 7);
    assert!(case.bounds_are_sharp() >= 12);
    case.separation_is_sharp();
    case.range_is_sharp();
    case.tubes_are_sharp();
}
