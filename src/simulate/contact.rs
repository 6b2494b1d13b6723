//! Links by true geometry, and whether everybody reaches a base over those that hold.
//!
//! Between two samples a robot may rely on the links of either: what counts there is the better of the
//! two lists.

use super::body::{Plane, Point, length, minus};
use super::inspect::{Inspector, far_end, largest};
use super::motion::{Bend, PARTS};
use super::tally::{Against, Kind, short_of};
use super::way::Way;
use super::world::{Beam, End, World};
use crate::ir::Norm;

/// Where a link's ends are, at one moment.
type Ends = (Point, Point);

/// What is needed again for every step: room that is not asked for anew.
#[derive(Default)]
pub(super) struct Scratch {
    /// Of the links of the sample before and after: those that no plane clears.
    open: [Vec<usize>; 2],
    /// How each robot's step bends.
    bends: Vec<Bend>,
    /// How far the links before and after are from being broken.
    strengths: [Vec<f64>; 2],
}

impl Inspector<'_> {
    /// The links that the plan relies on.
    pub(super) fn links(&mut self, ways: &[Way]) {
        if self.world.links.iter().all(Vec::is_empty) {
            return;
        }
        let places = std::mem::take(&mut self.places);
        let count = places.first().map_or(0, Vec::len);
        for sample in 0..count {
            self.links_at(sample, &places);
            if sample + 1 < count {
                self.links_after(sample, &places, ways);
            }
        }
        self.places = places;
    }

    fn links_at(&mut self, sample: usize, places: &[Vec<Point>]) {
        let world = self.world;
        let beams = &world.links[world.lasso.step(sample)];
        let mut broken = false;
        for beam in beams {
            let ends = ends(world, beam, |robot| places[robot][sample]);
            let (who, base) = concerned(beam);
            if short_of(before_planes(beam, &ends), self.samples.level(Kind::Link) + world.guard)
                && let Some((margin, piece)) = clearance(world, beam, &ends)
            {
                let blocking = &world.pieces[piece];
                let against = match base {
                    Some(base) => Against::Base { base, blocker: Some(blocking.blocker) },
                    None => Against::Piece { blocker: blocking.blocker, piece: blocking.piece },
                };
                if short_of(margin, self.samples.level(Kind::Link)) {
                    broken |= self.note(Kind::Link, margin, sample, who, against);
                }
            }
            if let Some(margin) = reserve(world, &ends)
                && short_of(margin, self.samples.level(Kind::Range))
            {
                let against = base.map_or(Against::Each, |base| Against::Base { base, blocker: None });
                broken |= self.note(Kind::Range, margin, sample, who, against);
            }
        }
        if broken && world.asks_for_links(sample) {
            let held = |beam: &&Beam| holds(world, beam, &ends(world, beam, |r| places[r][sample]));
            let kept: Vec<&Beam> = beams.iter().filter(held).collect();
            if !connected(world, &kept) {
                self.note(Kind::Connectivity, -1.0, sample, [None; 2], Against::Nothing);
            }
        }
    }

    /// The links on the way to the next sample.
    fn links_after(&mut self, sample: usize, places: &[Vec<Point>], ways: &[Way]) {
        let world = self.world;
        let step = world.lasso.step(sample);
        let [old, new] = [sample, sample + 1].map(|s| &world.links[world.lasso.step(s)]);
        let mut scratch = std::mem::take(&mut self.scratch);
        let [open_old, open_new] = &mut scratch.open;
        self.open(old, (sample, world.slot(step, false, 0)), places, open_old);
        if !open_old.is_empty() {
            self.open(new, (sample, world.slot(step, true, 0)), places, open_new);
            if !open_new.is_empty() {
                self.links_between(sample, places, ways, &mut scratch);
            }
        }
        self.scratch = scratch;
    }

    /// The links at the instants between two samples, of both of which some are open.
    fn links_between(&mut self, sample: usize, places: &[Vec<Point>], ways: &[Way], scratch: &mut Scratch) {
        let world = self.world;
        let step = world.lasso.step(sample);
        let [old, new] = [sample, sample + 1].map(|s| &world.links[world.lasso.step(s)]);
        let Scratch { open: [open_old, open_new], bends, strengths: [old_ones, new_ones] } = scratch;
        bends.clear();
        bends.extend(ways.iter().enumerate().map(|(robot, way)| self.bend(robot, sample, way)));
        for instant in 1..PARTS {
            let place = |robot: usize| {
                let (from, to) = (&places[robot][sample], &places[robot][sample + 1]);
                bends[robot].place(from, to, instant)
            };
            let enough = self.between.level(Kind::Link) + world.guard;
            let mut strengths = |all: &mut Vec<f64>, beams: &[Beam], open: &[usize], late: bool| {
                all.clear();
                all.resize(beams.len(), enough);
                for &beam in open {
                    let slot = world.slot(step, late, beam);
                    let planes = &mut self.planes[slot..slot + world.opaque.len()];
                    all[beam] = strength(world, planes, &ends(world, &beams[beam], place), enough);
                }
            };
            strengths(old_ones, old, open_old, false);
            if old_ones.iter().all(|s| *s >= enough) {
                continue;
            }
            strengths(new_ones, new, open_new, true);
            if new_ones.iter().any(|s| *s < enough) {
                self.weak((sample, instant), (old, old_ones), (new, new_ones));
            }
        }
    }

    /// The links that no plane clears until the next sample.
    fn open(
        &self,
        beams: &[Beam],
        (sample, slot): (usize, usize),
        places: &[Vec<Point>],
        open: &mut Vec<usize>,
    ) {
        let world = self.world;
        let needed = self.between.level(Kind::Link) + world.guard;
        let pieces = world.opaque.len();
        let is_open = |(index, beam): &(usize, &Beam)| {
            let (p, q) = ends(world, beam, |robot| places[robot][sample]);
            let (p_next, q_next) = ends(world, beam, |robot| places[robot][sample + 1]);
            let bend = |robot: usize| self.bends[robot][sample];
            let far = if let End::Robot(to) = beam.to { bend(to) } else { 0.0 };
            let bend = bend(beam.from);
            let from = slot + index * pieces;
            let before = |plane: &Plane| {
                let near_end = plane.room(&p).min(plane.room(&p_next)) - bend;
                near_end >= needed && plane.room(&q).min(plane.room(&q_next)) - far >= needed
            };
            // Along straight ways no distance between two robots is above the larger of those at the ends.
            let longest = || {
                let ends = [reserve(world, &(p, q)), reserve(world, &(p_next, q_next))];
                ends.into_iter().flatten().fold(f64::INFINITY, f64::min) - bend - far
            };
            !(self.planes[from..from + pieces].iter().all(before) && longest() >= needed)
        };
        open.clear();
        open.extend(beams.iter().enumerate().filter(is_open).map(|(index, _)| index));
    }

    /// Notes an instant at which some link of either list is weak.
    fn weak(&mut self, at: (usize, usize), old: (&[Beam], &[f64]), new: (&[Beam], &[f64])) {
        let world = self.world;
        let weakest = |(beams, strengths): (&'_ [Beam], &[f64])| {
            let each = strengths.iter().copied().zip(0..beams.len());
            each.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, 0))
        };
        let (worst_old, worst_new) = (weakest(old), weakest(new));
        let (margin, beam) = if worst_old.0 >= worst_new.0 {
            (worst_old.0, old.0.get(worst_old.1))
        } else {
            (worst_new.0, new.0.get(worst_new.1))
        };
        let Some(beam) = beam.filter(|_| margin < self.between.level(Kind::Link)) else { return };
        let (who, base) = concerned(beam);
        let against = base.map_or(Against::Each, |base| Against::Base { base, blocker: None });
        let all = old.0.iter().zip(old.1).chain(new.0.iter().zip(new.1));
        let cut_off = margin < 0.0 && {
            let kept: Vec<&Beam> =
                all.filter(|(_, strength)| **strength >= 0.0).map(|(beam, _)| beam).collect();
            !connected(world, &kept)
        };
        self.note_between(Kind::Link, margin, at, who, against);
        if cut_off {
            self.note_between(Kind::Connectivity, -1.0, at, [None; 2], Against::Nothing);
        }
    }
}

/// The robots of a link, and its base.
fn concerned(beam: &Beam) -> ([Option<usize>; 2], Option<usize>) {
    match beam.to {
        End::Robot(to) => ([Some(beam.from), Some(to)], None),
        End::Base(base) => ([Some(beam.from), None], Some(base)),
    }
}

fn ends(world: &World, beam: &Beam, place: impl Fn(usize) -> Point) -> Ends {
    let from = place(beam.from);
    (from, far_end(world, beam, place))
}

/// How far both ends are before the link's planes, and so the link from what it must not cross.
fn before_planes(beam: &Beam, (p, q): &Ends) -> f64 {
    beam.planes.iter().map(|plane| room(plane.as_ref(), p, q)).fold(f64::INFINITY, f64::min)
}

/// How far a link is from the nearest piece that it must not cross, and which.
fn clearance(world: &World, beam: &Beam, (p, q): &Ends) -> Option<(f64, usize)> {
    let mut least: Option<(f64, usize)> = None;
    for (&piece, plane) in world.opaque.iter().zip(&beam.planes) {
        let enough = least.map_or(f64::INFINITY, |(least, _)| least);
        if room(plane.as_ref(), p, q) >= enough + world.guard {
            continue;
        }
        if let Some(found) = world.pieces[piece].body.segment_clearance(p, q, enough) {
            least = Some((found, piece));
        }
    }
    least
}

/// The least of a link's clearance and what it could be longer; anything above `enough` stands for more.
/// Planes that show that it is clear are kept for the next time.
fn strength(world: &World, planes: &mut [Plane], ends: &Ends, enough: f64) -> f64 {
    let (p, q) = ends;
    let mut least = reserve(world, ends).unwrap_or(f64::INFINITY).min(enough);
    for (&piece, plane) in world.opaque.iter().zip(planes) {
        if room(Some(plane), p, q) >= enough {
            continue;
        }
        let (found, left) = world.pieces[piece].body.plane_before(p, q, enough);
        *plane = found.unwrap_or(*plane);
        least = left.map_or(least, |left| least.min(left));
    }
    least
}

/// How far both ends of a link are before a plane.
fn room(plane: Option<&Plane>, p: &Point, q: &Point) -> f64 {
    plane.map_or(f64::NEG_INFINITY, |plane| plane.room(p).min(plane.room(q)))
}

/// How much longer a link could be.
fn reserve(world: &World, (p, q): &Ends) -> Option<f64> {
    let (range, norm) = world.range?;
    let apart = minus(p, q);
    Some(range - if norm == Norm::Infinity { largest(&apart) } else { length(&apart) })
}

/// Whether a link is not blocked and not too long.
fn holds(world: &World, beam: &Beam, ends: &Ends) -> bool {
    clearance(world, beam, ends).is_none_or(|(margin, _)| margin >= 0.0)
        && reserve(world, ends).is_none_or(|margin| margin >= 0.0)
}

/// Whether every robot reaches a base as the mission asks, whichever robots are lost.
fn connected(world: &World, links: &[&Beam]) -> bool {
    let Some(asked) = &world.problem.connectivity else { return true };
    let robots = world.robots.len();
    let hops = asked.hops.map_or(robots, |hops| (hops as usize).min(robots));
    let losses = (asked.redundancy as usize).min(robots.saturating_sub(1));
    survives(robots, losses, &mut vec![false; robots], &mut |lost| reached(links, lost, hops))
}

/// Whether something holds for each way to lose so many of the first `below` robots.
fn survives(
    below: usize,
    losses: usize,
    lost: &mut Vec<bool>,
    holds: &mut dyn FnMut(&[bool]) -> bool,
) -> bool {
    if losses == 0 {
        return holds(lost);
    }
    (losses - 1..below).all(|robot| {
        lost[robot] = true;
        let still = survives(robot, losses - 1, lost, holds);
        lost[robot] = false;
        still
    })
}

/// Whether all robots that are left reach a base over so many links.
fn reached(links: &[&Beam], lost: &[bool], hops: usize) -> bool {
    // Which robots reach a base over at most so many links, one more in each round.
    let mut reach = vec![false; lost.len()];
    for _ in 0..hops {
        let before = reach.clone();
        for beam in links.iter().filter(|beam| !lost[beam.from]) {
            match beam.to {
                End::Base(_) => reach[beam.from] = true,
                End::Robot(to) if !lost[to] => {
                    reach[beam.from] |= before[to];
                    reach[to] |= before[beam.from];
                }
                End::Robot(_) => {}
            }
        }
    }
    reach.iter().zip(lost).all(|(reach, lost)| *reach || *lost)
}
