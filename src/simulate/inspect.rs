//! Looks at what really happened in a run: at every sample, and between them.
//!
//! Exact distances cost something and are seldom needed: a plan's planes bound them from below wherever
//! robots are, because each has its piece wholly behind it. Only what such a bound leaves open, a margin
//! below the least one so far, is computed.

use super::body::{Body, Plane, Point, minus};
use super::contact::Scratch;
use super::goals::{Evaluation, Labels, Trace};
use super::motion::{Bend, PARTS};
use super::tally::{Against, Book, Kind, Spot, Tally, short_of};
use super::way::Way;
use super::world::{Beam, End, World};
use crate::entity::EntityId;
use crate::ir::Atom;
use crate::plan::Label;

/// What runs came to, as far as they were looked at.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// At samples.
    pub samples: Tally,
    /// Between samples.
    pub between: Tally,
    /// How often a monitor said that more happened than was assumed.
    pub excesses: u64,
    /// In how many runs one did.
    pub runs_with_excess: u64,
    /// In how many runs something was violated.
    pub runs_with_violation: u64,
    /// How many violations there were of which no robot concerned had reported an excess by then.
    pub unreported: u64,
}

impl Findings {
    /// Adds those of later runs.
    pub(super) fn add(&mut self, later: &Findings) {
        self.samples.add(&later.samples);
        self.between.add(&later.between);
        self.excesses += later.excesses;
        self.runs_with_excess += later.runs_with_excess;
        self.runs_with_violation += later.runs_with_violation;
        self.unreported += later.unreported;
    }
}

/// Looks at one run after the other.
pub(super) struct Inspector<'w> {
    pub(super) world: &'w World<'w>,
    pub(super) samples: Book,
    pub(super) between: Book,
    excesses: u64,
    runs_with_excess: u64,
    runs_with_violation: u64,
    unreported: u64,
    /// By robot: the positions of the run that is looked at.
    pub(super) places: Vec<Vec<Point>>,
    /// By robot: at least how far each of its steps bends at most.
    pub(super) bends: Vec<Vec<f64>>,
    /// Planes that had links before them when last looked at, in the order of [`World::slot`].
    pub(super) planes: Vec<Plane>,
    /// By robot: when its monitor first reported an excess.
    first_excess: Vec<Option<usize>>,
    /// By robot and track: where it is certainly in, and certainly out.
    labels: Vec<Vec<[Vec<bool>; 2]>>,
    evaluation: Evaluation,
    pub(super) scratch: Scratch,
    pub(super) run: u64,
    violated: bool,
}

impl<'w> Inspector<'w> {
    pub(super) fn new(world: &'w World<'w>) -> Inspector<'w> {
        let robots = world.robots.len();
        let labels = world.robots.iter().map(|r| vec![[Vec::new(), Vec::new()]; r.tracks.len()]).collect();
        Inspector {
            world,
            samples: Book::default(),
            between: Book::default(),
            excesses: 0,
            runs_with_excess: 0,
            runs_with_violation: 0,
            unreported: 0,
            places: vec![Vec::new(); robots],
            bends: vec![Vec::new(); robots],
            planes: world.planes_of_links(),
            first_excess: vec![None; robots],
            labels,
            evaluation: Evaluation::default(),
            scratch: Scratch::default(),
            run: 0,
            violated: false,
        }
    }

    /// Looks at a run.
    pub(super) fn inspect(&mut self, run: u64, ways: &[Way]) {
        (self.run, self.violated) = (run, false);
        for (robot, way) in ways.iter().enumerate() {
            self.locate(robot, way);
        }
        for (robot, way) in ways.iter().enumerate() {
            self.bounds(robot, way);
            self.surroundings(robot, way);
            self.regions(robot);
        }
        self.separation(ways);
        self.links(ways);
        self.goals();
        let excesses = ways.iter().flat_map(|way| &way.reports).filter(|r| r.is_excess()).count();
        self.excesses += excesses as u64;
        self.runs_with_excess += u64::from(excesses > 0);
        self.runs_with_violation += u64::from(self.violated);
    }

    /// What was found since the last time.
    pub(super) fn take(&mut self) -> Findings {
        Findings {
            samples: self.samples.take(),
            between: self.between.take(),
            excesses: std::mem::take(&mut self.excesses),
            runs_with_excess: std::mem::take(&mut self.runs_with_excess),
            runs_with_violation: std::mem::take(&mut self.runs_with_violation),
            unreported: std::mem::take(&mut self.unreported),
        }
    }

    /// The number of samples.
    pub(super) fn count(&self) -> usize {
        self.places.first().map_or(0, Vec::len)
    }

    fn locate(&mut self, robot: usize, way: &Way) {
        let mover = &self.world.robots[robot];
        let (places, bends) = (&mut self.places[robot], &mut self.bends[robot]);
        places.clear();
        bends.clear();
        for (state, input) in way.states.chunks_exact(way.n.max(1)).zip(way.inputs.chunks_exact(way.m.max(1)))
        {
            let mut place = [0.0; 3];
            place.iter_mut().zip(&mover.position).for_each(|(to, &from)| *to = state[from]);
            places.push(place);
            bends.push(mover.motion.most(state, input));
        }
        self.first_excess[robot] = way.first_excess();
    }

    /// Notes a margin at a sample.
    pub(super) fn note(
        &mut self,
        kind: Kind,
        margin: f64,
        sample: usize,
        robots: [Option<usize>; 2],
        against: Against,
    ) -> bool {
        let spot = Spot { run: self.run, sample, eighths: 0, robots, against };
        let short = self.samples.note(kind, margin, spot);
        if short {
            self.violated = true;
            let by_then = |robot: usize| self.first_excess[robot].is_some_and(|first| first <= sample);
            let reported = match robots {
                [None, None] => (0..self.first_excess.len()).any(by_then),
                concerned => concerned.into_iter().flatten().any(by_then),
            };
            self.unreported += u64::from(!reported);
        }
        short
    }

    /// Notes a margin between samples.
    pub(super) fn note_between(
        &mut self,
        kind: Kind,
        margin: f64,
        at: (usize, usize),
        robots: [Option<usize>; 2],
        against: Against,
    ) {
        let (sample, instant) = at;
        let spot = Spot { run: self.run, sample, eighths: instant as u8, robots, against };
        self.between.note(kind, margin, spot);
    }

    /// The bounds of states and inputs.
    fn bounds(&mut self, robot: usize, way: &Way) {
        let world = self.world;
        let mover = &world.robots[robot];
        let who = [Some(robot), None];
        let rows = way.states.chunks_exact(way.n.max(1)).zip(way.inputs.chunks_exact(way.m.max(1)));
        for (sample, (state, input)) in rows.enumerate() {
            for bound in &mover.states {
                let x = state[bound.index];
                let margin = (x - bound.lo).min(bound.hi - x) * bound.scale;
                if short_of(margin, self.samples.level(Kind::State)) {
                    self.note(Kind::State, margin, sample, who, Against::State(bound.index));
                }
            }
            for bound in &mover.inputs {
                let u = input[bound.index];
                let margin = (u - bound.lo).min(bound.hi - u) * bound.scale;
                if short_of(margin, self.samples.level(Kind::Input)) {
                    self.note(Kind::Input, margin, sample, who, Against::Input(bound.index));
                }
            }
            for (index, (normal, offset)) in mover.mixed.iter().enumerate() {
                let margin =
                    offset - normal.iter().zip(state.iter().chain(input)).map(|(a, x)| a * x).sum::<f64>();
                if short_of(margin, self.samples.level(Kind::Mixed)) {
                    self.note(Kind::Mixed, margin, sample, who, Against::Bound(index));
                }
            }
        }
    }

    /// How a step bends.
    pub(super) fn bend(&self, robot: usize, sample: usize, way: &Way) -> Bend {
        self.world.robots[robot].motion.bend(way.state(sample), way.input(sample))
    }

    /// The workspace, obstacles and jammers, at samples and on the way to the next.
    fn surroundings(&mut self, robot: usize, way: &Way) {
        let world = self.world;
        let (mover, who) = (&world.robots[robot], [Some(robot), None]);
        let places = std::mem::take(&mut self.places[robot]);
        let mut inside = f64::INFINITY;
        for (sample, place) in places.iter().enumerate() {
            let margin = -world.workspace.most(place);
            if short_of(margin, self.samples.level(Kind::Workspace)) {
                self.note(Kind::Workspace, margin, sample, who, Against::Workspace);
            }
            let next = places.get(sample + 1);
            let bend = self.bends[robot][sample];
            if let (Some(next), true) =
                (next, short_of(inside.min(margin) - bend, self.between.level(Kind::Workspace) + world.guard))
            {
                self.leaving(robot, sample, (place, next), way);
            }
            inside = margin;
            let planes = mover.clear.get(world.lasso.step(sample)).map_or(&[][..], Vec::as_slice);
            for (index, plane) in planes.iter().enumerate() {
                let room = |p: &Point| plane.as_ref().map_or(f64::NEG_INFINITY, |plane| plane.room(p));
                let here = room(place);
                if short_of(here, self.samples.level(Kind::Blocker) + world.guard) {
                    self.blocked(robot, sample, index, place);
                }
                let Some(next) = next else { continue };
                let on_the_way = here.min(room(next)) - bend;
                if short_of(on_the_way, self.between.level(Kind::Blocker) + world.guard) {
                    self.blocked_between(robot, sample, index, (place, next), way);
                }
            }
        }
        self.places[robot] = places;
    }

    fn leaving(&mut self, robot: usize, sample: usize, (from, to): (&Point, &Point), way: &Way) {
        let bend = self.bend(robot, sample, way);
        for instant in 1..PARTS {
            let margin = -self.world.workspace.most(&bend.place(from, to, instant));
            if short_of(margin, self.between.level(Kind::Workspace)) {
                self.note_between(
                    Kind::Workspace,
                    margin,
                    (sample, instant),
                    [Some(robot), None],
                    Against::Workspace,
                );
            }
        }
    }

    fn blocked(&mut self, robot: usize, sample: usize, index: usize, place: &Point) {
        let piece = &self.world.pieces[index];
        let enough = self.samples.level(Kind::Blocker);
        if let Some(margin) = piece.body.clearance_below(place, enough) {
            let against = Against::Piece { blocker: piece.blocker, piece: piece.piece };
            self.note(Kind::Blocker, margin, sample, [Some(robot), None], against);
        }
    }

    fn blocked_between(
        &mut self,
        robot: usize,
        sample: usize,
        index: usize,
        (from, to): (&Point, &Point),
        way: &Way,
    ) {
        let bend = self.bend(robot, sample, way);
        let piece = &self.world.pieces[index];
        for instant in 1..PARTS {
            let enough = self.between.level(Kind::Blocker);
            if let Some(margin) = piece.body.clearance_below(&bend.place(from, to, instant), enough) {
                let against = Against::Piece { blocker: piece.blocker, piece: piece.piece };
                self.note_between(Kind::Blocker, margin, (sample, instant), [Some(robot), None], against);
            }
        }
    }

    /// The labels that the plan claims, and those that goals are evaluated on.
    fn regions(&mut self, robot: usize) {
        let world = self.world;
        let places = std::mem::take(&mut self.places[robot]);
        for (index, track) in world.robots[robot].tracks.iter().enumerate() {
            let region = &world.regions[track.region];
            let [mut inside, mut outside] = std::mem::take(&mut self.labels[robot][index]);
            inside.clear();
            outside.clear();
            for (sample, place) in places.iter().enumerate() {
                let step = world.lasso.step(sample);
                let planes = track.outside.get(step).map_or(&[][..], Vec::as_slice);
                let label = track.labels.get(step).copied().unwrap_or(Label::Unknown);
                // Far enough before the planes it is out, and nothing else has to be known.
                let bound = if label == Label::Out { rooms(planes, place) } else { f64::NEG_INFINITY };
                if bound >= self.samples.level(Kind::Region) + world.guard {
                    inside.push(false);
                    outside.push(true);
                    continue;
                }
                let depth = deepest(&region.sure, place);
                let away = || nearest(&region.shape, place);
                let (margin, out) = match label {
                    Label::In => (depth, depth < 0.0 && away() > 0.0),
                    Label::Out => (away(), away() > 0.0),
                    Label::Unknown => (f64::INFINITY, depth < 0.0 && away() > 0.0),
                };
                inside.push(depth >= 0.0);
                outside.push(out);
                if short_of(margin, self.samples.level(Kind::Region)) {
                    self.note(
                        Kind::Region,
                        margin,
                        sample,
                        [Some(robot), None],
                        Against::Region(track.region),
                    );
                }
            }
            self.labels[robot][index] = [inside, outside];
        }
        self.places[robot] = places;
    }

    /// Every two robots.
    fn separation(&mut self, ways: &[Way]) {
        let Some(least) = self.world.separation else { return };
        let places = std::mem::take(&mut self.places);
        for first in 0..places.len() {
            for second in first + 1..places.len() {
                self.pair(first, second, &places, least, ways);
            }
        }
        self.places = places;
    }

    fn pair(&mut self, first: usize, second: usize, places: &[Vec<Point>], least: f64, ways: &[Way]) {
        let world = self.world;
        let (pair, who) = (world.pair(first, second), [Some(first), Some(second)]);
        for (sample, (p, q)) in places[first].iter().zip(&places[second]).enumerate() {
            let apart = minus(p, q);
            let margin = largest(&apart) - least;
            if short_of(margin, self.samples.level(Kind::Separation)) {
                self.note(Kind::Separation, margin, sample, who, Against::Each);
            }
            let next = (places[first].get(sample + 1), places[second].get(sample + 1));
            let (Some(p_next), Some(q_next)) = next else { continue };
            let side = world.sides.get(world.lasso.step(sample)).and_then(|pairs| *pairs.get(pair)?);
            let then = minus(p_next, q_next);
            let kept =
                side.map_or(f64::NEG_INFINITY, |(axis, sign)| (sign * apart[axis]).min(sign * then[axis]));
            let bound = kept - least - self.bends[first][sample] - self.bends[second][sample];
            if bound >= self.between.level(Kind::Separation) + world.guard {
                continue;
            }
            let bends = [first, second].map(|robot| self.bend(robot, sample, &ways[robot]));
            for instant in 1..PARTS {
                let at = minus(&bends[0].place(p, p_next, instant), &bends[1].place(q, q_next, instant));
                let margin = largest(&at) - least;
                if short_of(margin, self.between.level(Kind::Separation)) {
                    self.note_between(Kind::Separation, margin, (sample, instant), who, Against::Each);
                }
            }
        }
    }

    /// The goals, on an infinite run whose last round comes again and again.
    fn goals(&mut self) {
        let count = self.count();
        let problem = self.world.problem;
        if problem.goals.is_empty() || count <= self.world.lasso.last {
            return;
        }
        let trace = Trace { count, again: count - self.world.lasso.round() };
        let (world, labels) = (self.world, &self.labels);
        let of = |atom: Atom| {
            let robot = atom.robot.index();
            let track = world.robots[robot].tracks.iter().position(|t| t.region == atom.region.index());
            let rows = track.and_then(|track| labels[robot].get(track));
            rows.map_or(Labels { inside: &[], outside: &[] }, |[inside, outside]| Labels { inside, outside })
        };
        self.evaluation.run(&problem.formulas, trace, of);
        for (index, goal) in problem.goals.iter().enumerate() {
            if !self.evaluation.holds(goal.formula) {
                self.note(Kind::Goal, -1.0, count - 1, [None; 2], Against::Goal(index));
            }
        }
    }
}

/// The largest coordinate.
pub(super) fn largest(p: &Point) -> f64 {
    p.iter().fold(0.0, |a: f64, b| a.max(b.abs()))
}

fn deepest(pieces: &[Body], p: &Point) -> f64 {
    pieces.iter().map(|piece| piece.depth(p)).fold(f64::NEG_INFINITY, f64::max)
}

fn nearest(pieces: &[Body], p: &Point) -> f64 {
    pieces.iter().map(|piece| piece.clearance(p)).fold(f64::INFINITY, f64::min)
}

/// How far a point is before some planes.
fn rooms(planes: &[Plane], p: &Point) -> f64 {
    if planes.is_empty() {
        return f64::NEG_INFINITY;
    }
    planes.iter().map(|plane| plane.room(p)).fold(f64::INFINITY, f64::min)
}

/// Where the far end of a link is.
pub(super) fn far_end(world: &World, beam: &Beam, places: impl Fn(usize) -> Point) -> Point {
    match beam.to {
        End::Robot(robot) => places(robot),
        End::Base(base) => world.bases[base],
    }
}
