//! A second opinion in plain floating point: flies the plan's own control law through sampled
//! disturbances and looks at the true geometry. It shares nothing with the checker.

use dosmc::exact::{Rational, RationalMatrix};
use dosmc::ir::{Model, Norm, Piece, Problem, Shape};
use dosmc::plan::{Label, Plan, RobotPlan, Tube};

/// What sampling leaves to rounding.
const TOLERANCE: f64 = 1e-9;

/// A small generator of disturbances: the same on every machine.
pub struct Dice(pub u64);

impl Dice {
    pub fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as usize) % bound.max(1)
    }
    /// In [0, 1], both ends often.
    fn share(&mut self) -> f64 {
        match self.below(4) {
            0 => 0.0,
            1 => 1.0,
            _ => self.below(1 << 20) as f64 / f64::from(1 << 20),
        }
    }
}

/// A convex piece in floating point.
enum Solid {
    Facets(Vec<(Vec<f64>, f64)>),
    Ball { center: Vec<f64>, spread: Vec<f64>, radius: f64 },
}

/// A named union of pieces.
struct Place {
    name: String,
    blocks_links: bool,
    pieces: Vec<Solid>,
}

/// What there is in the workspace, in floating point.
struct Ground {
    blockers: Vec<Place>,
    regions: Vec<Place>,
}

impl Ground {
    fn new(problem: &Problem) -> Ground {
        let place = |name: &str, blocks_links: bool, shape: &Shape| {
            let solid = |piece: &Piece| match piece {
                Piece::Polytope(p) => {
                    Solid::Facets(p.facets.iter().map(|f| (floats(&f.normal), f.offset.to_f64())).collect())
                }
                Piece::Ball { center, spread, radius } => {
                    Solid::Ball { center: floats(center), spread: floats(spread), radius: radius.to_f64() }
                }
            };
            Place { name: name.into(), blocks_links, pieces: shape.pieces.iter().map(solid).collect() }
        };
        let blockers = problem.blockers.values();
        Ground {
            blockers: blockers.map(|b| place(&b.name, b.kind.blocks_links(), &b.shape)).collect(),
            regions: problem.regions.values().map(|r| place(&r.name, false, &r.shape)).collect(),
        }
    }
}

/// The true positions of a robot, step by step, and where the plan was.
struct Flight {
    positions: Vec<Vec<f64>>,
    steps: Vec<usize>,
}

/// The first thing that goes wrong in some runs of the plan, if anything does.
pub fn counterexample(problem: &Problem, plan: &Plan, runs: usize, dice: &mut Dice) -> Option<String> {
    let ground = Ground::new(problem);
    for _ in 0..runs {
        let mut flights = vec![];
        for (index, asked) in problem.robots.values().enumerate() {
            let robot = plan.robots.iter().find(|r| r.name == asked.name)?;
            let model = &problem.models[asked.model];
            let tube = plan.tubes.iter().find(|t| t.dynamics == model.name)?;
            match fly(plan, robot, model, tube, &floats(&asked.start), dice) {
                Ok(flight) => flights.push(flight),
                Err(why) => return Some(format!("robot {index}: {why}")),
            }
        }
        let all = [
            workspace(problem, &flights),
            blocked(&ground, &flights),
            labels(problem, &ground, plan, &flights),
        ];
        let found = all.into_iter().flatten().next();
        if found.is_some() {
            return found;
        }
        let found = links(problem, &ground, plan, &flights).or_else(|| separation(problem, &flights));
        if found.is_some() {
            return found;
        }
    }
    None
}

/// The closed loop for three rounds: ŵ is what the tube didn't expect, u = v + Σ M_i ŵ.
fn fly(
    plan: &Plan,
    robot: &RobotPlan,
    model: &Model,
    tube: &Tube,
    start: &[f64],
    dice: &mut Dice,
) -> Result<Flight, String> {
    let (n, m, k) = (model.n(), model.m(), tube.d.len());
    let mut unexplained = vec![vec![0.0; n]; k];
    let mut x = start.to_vec();
    let mut flight = Flight { positions: vec![], steps: vec![] };
    let rows = |matrix: &RationalMatrix| -> Vec<Vec<f64>> {
        matrix.row_iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect()
    };
    let (a, b, c) = (rows(&model.a), rows(&model.b), floats(&model.c));
    let theta: Vec<(f64, f64)> = model.disturbance.iter().map(|i| (i.lo.to_f64(), i.hi.to_f64())).collect();
    let mut t = 0;
    for _ in 0..3 * (plan.length + 1) {
        let mut w: Vec<f64> = (0..n).map(|i| x[i] - robot.z[t][i]).collect();
        for i in 1..k {
            for (w, row) in w.iter_mut().zip(&tube.d[i]) {
                *w -= product(row, &unexplained[i - 1]);
            }
        }
        unexplained.rotate_right(1);
        unexplained[0] = w;
        let feedback = |row: usize| (0..k).map(|i| product(&tube.m[i][row], &unexplained[i])).sum::<f64>();
        let u: Vec<f64> = (0..m).map(|row| robot.v[t][row] + feedback(row)).collect();
        bounds(model, &x, &u).map_err(|why| format!("step {t}: {why}"))?;
        flight.positions.push(model.position.iter().map(|&i| x[i]).collect());
        flight.steps.push(t);
        x = (0..n)
            .map(|row| {
                let (lo, hi) = theta[row];
                product(&a[row], &x) + product(&b[row], &u) + c[row] + lo + (hi - lo) * dice.share()
            })
            .collect();
        t = if t < plan.length { t + 1 } else { plan.loop_start };
    }
    Ok(flight)
}

fn bounds(model: &Model, x: &[f64], u: &[f64]) -> Result<(), String> {
    for (value, bound) in x.iter().zip(&model.state_bounds) {
        if let Some(bound) = bound {
            within(*value, bound.lo.to_f64(), bound.hi.to_f64())?;
        }
    }
    for (value, bound) in u.iter().zip(&model.input_bounds) {
        within(*value, bound.lo.to_f64(), bound.hi.to_f64())?;
    }
    Ok(())
}

fn within(value: f64, lo: f64, hi: f64) -> Result<(), String> {
    let inside = value >= lo - TOLERANCE && value <= hi + TOLERANCE;
    if inside { Ok(()) } else { Err(format!("{value} is not in [{lo}, {hi}]")) }
}

fn workspace(problem: &Problem, flights: &[Flight]) -> Option<String> {
    let inside = |p: &Vec<f64>| {
        let beyond =
            |f: &dosmc::geometry::HalfSpace| product(&floats(&f.normal), p) > f.offset.to_f64() + TOLERANCE;
        !problem.workspace.facets.iter().any(beyond)
    };
    let left = flights.iter().any(|f| !f.positions.iter().all(inside));
    left.then(|| "left the workspace".into())
}

fn blocked(ground: &Ground, flights: &[Flight]) -> Option<String> {
    for (flight, blocker) in flights.iter().flat_map(|f| ground.blockers.iter().map(move |b| (f, b))) {
        for (i, pair) in flight.positions.windows(2).enumerate() {
            if crosses(&pair[0], &pair[1], blocker) {
                return Some(format!("step {}: hit {}", flight.steps[i], blocker.name));
            }
        }
    }
    None
}

fn labels(problem: &Problem, ground: &Ground, plan: &Plan, flights: &[Flight]) -> Option<String> {
    for (robot, flight) in plan_of(problem, plan).zip(flights) {
        for (name, labels) in &robot.regions {
            let region = ground.regions.iter().find(|r| r.name == *name)?;
            for (p, &t) in flight.positions.iter().zip(&flight.steps) {
                let wrong = match labels[t] {
                    Label::In => !inside(p, region, TOLERANCE),
                    Label::Out => inside(p, region, -TOLERANCE),
                    Label::Unknown => false,
                };
                if wrong {
                    return Some(format!("{} at {t}: label of {name}", robot.name));
                }
            }
        }
    }
    None
}

fn links(problem: &Problem, ground: &Ground, plan: &Plan, flights: &[Flight]) -> Option<String> {
    let (lists, asked) = (plan.links.as_ref()?, problem.connectivity.as_ref()?);
    for (i, &t) in flights[0].steps.iter().enumerate() {
        let end = |name: &str| -> Option<Vec<f64>> {
            let robot = problem.robots.values().position(|r| r.name == name);
            let base = problem.bases.values().find(|b| b.name == name).map(|b| floats(&b.position));
            robot.map(|r| flights[r].positions[i].clone()).or(base)
        };
        for link in &lists[t] {
            let (from, to) = (end(&link.from)?, end(&link.to)?);
            let jams = ground.blockers.iter().filter(|b| b.blocks_links);
            if let Some(b) = jams.into_iter().find(|b| crosses(&from, &to, b)) {
                return Some(format!("link {} to {} at {t} crosses {}", link.from, link.to, b.name));
            }
            if let Some(range) = &asked.range {
                let apart: Vec<f64> = from.iter().zip(&to).map(|(a, b)| a - b).collect();
                let length = match range.norm {
                    Norm::Infinity => apart.iter().fold(0.0, |l: f64, d| l.max(d.abs())),
                    Norm::Euclidean => product(&apart, &apart).sqrt(),
                };
                if length > range.length.to_f64() + TOLERANCE {
                    return Some(format!("link {} to {} at {t} is too long", link.from, link.to));
                }
            }
        }
        if asked.every == 1 && !reached(problem, &lists[t]) {
            return Some(format!("cut off at {t}"));
        }
    }
    None
}

/// Whether every robot reaches a base, by spreading from the bases until nothing changes.
fn reached(problem: &Problem, links: &[dosmc::plan::Link]) -> bool {
    let mut known: Vec<&str> = problem.bases.values().map(|b| b.name.as_str()).collect();
    for _ in 0..problem.robots.len() {
        for link in links {
            for (one, other) in [(&link.from, &link.to), (&link.to, &link.from)] {
                if known.contains(&one.as_str()) {
                    known.push(other);
                }
            }
        }
    }
    problem.robots.values().all(|r| known.contains(&r.name.as_str()))
}

fn separation(problem: &Problem, flights: &[Flight]) -> Option<String> {
    let least = problem.separation.as_ref()?.to_f64() - TOLERANCE;
    for (j, second) in flights.iter().enumerate() {
        for first in &flights[..j] {
            for i in 0..first.positions.len().min(second.positions.len()) - 1 {
                for share in 0..=8 {
                    let at =
                        |f: &Flight| between(&f.positions[i], &f.positions[i + 1], f64::from(share) / 8.0);
                    let apart =
                        at(first).iter().zip(at(second)).fold(0.0, |l: f64, (a, b)| l.max((a - b).abs()));
                    if apart < least {
                        return Some(format!("too close after step {}", first.steps[i]));
                    }
                }
            }
        }
    }
    None
}

fn plan_of<'a>(problem: &'a Problem, plan: &'a Plan) -> impl Iterator<Item = &'a RobotPlan> {
    problem.robots.values().filter_map(|asked| plan.robots.iter().find(|r| r.name == asked.name))
}

fn crosses(p: &[f64], q: &[f64], place: &Place) -> bool {
    (0..=16).any(|share| inside(&between(p, q, f64::from(share) / 16.0), place, -TOLERANCE))
}

fn between(p: &[f64], q: &[f64], share: f64) -> Vec<f64> {
    p.iter().zip(q).map(|(a, b)| a + (b - a) * share).collect()
}

/// Whether the point is in one of the pieces, grown by `margin`.
fn inside(p: &[f64], place: &Place, margin: f64) -> bool {
    place.pieces.iter().any(|piece| match piece {
        Solid::Facets(facets) => facets.iter().all(|(normal, offset)| product(normal, p) <= offset + margin),
        Solid::Ball { center, spread, radius } => {
            let off = |i: usize| ((p[i] - center[i]).abs() - spread[i]).max(0.0);
            (0..p.len()).map(|i| off(i) * off(i)).sum::<f64>().sqrt() <= radius + margin
        }
    })
}

fn floats(exact: &[Rational]) -> Vec<f64> {
    exact.iter().map(Rational::to_f64).collect()
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
