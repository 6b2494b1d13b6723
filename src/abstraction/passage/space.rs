//! The free space in space, covered by the boxes of a grid.
//!
//! The grid has planes just inside the bounding box of every blocker with its tube, so that it is
//! exact for blockers and tubes that are boxes; for others there are planes in between. A box of the
//! grid is blocked only where it lies wholly inside one inflated blocker, or wholly outside 𝒲 ⊖ Ω.
//! All others count as free, so what is free really is covered by them: a path in the free space
//! leads from box to neighbouring box.

use std::ops::Range;

use crate::abstraction::nearest::{Vector, cross, dot, minus, vector};
use crate::abstraction::{Abstraction, HalfSpace, Owner, Solid};
use crate::ir::ModelId;

use super::TOUCH;

/// The most boxes: more would take more time than most searches.
const MOST_BOXES: usize = 1 << 16;

/// So many planes across an axis that some blocker is slanted or round to.
const PLANES: usize = 24;

/// At most so many generators of a tube that are along no axis are used: without the others the
/// tube is smaller, and more is free.
const MOST_OBLIQUE: usize = 6;

/// The components of a model's free space in space.
#[derive(Clone, Debug)]
pub(super) struct Space {
    /// The planes across each axis, rising.
    lines: [Vec<f64>; 3],
    /// By box, the last axis fastest: its component; none where it is blocked.
    component: Vec<Option<usize>>,
    touch: f64,
}

/// A blocker ⊕ (−Ω), or a part of it.
enum Inflated {
    /// The intersection of half-spaces {p : normal · p ≤ offset}.
    Polytope(Vec<(Vector, f64)>),
    /// The points that are at most so far from a box, by its middle and half-widths.
    Round(Vector, Vector, f64),
}

impl Space {
    /// The free space of a model's nominal positions; `None` when it takes too many boxes.
    pub(super) fn new(abstraction: &Abstraction, model: ModelId) -> Option<Space> {
        let touch = TOUCH * abstraction.size;
        let tube = Tube::new(abstraction.tubes[model].generators());
        let blockers = abstraction.solids.values().filter(|s| matches!(s.owner, Owner::Blocker(_)));
        let blocked: Vec<Inflated> = blockers.map(|solid| tube.inflate(solid)).collect();
        let lines = [0, 1, 2].map(|axis| planes(abstraction, &blocked, axis, touch));
        let counts = lines.each_ref().map(|l| l.len() - 1);
        if counts.iter().product::<usize>() > MOST_BOXES {
            return None;
        }
        let mut space = Space { component: vec![Some(0); counts.iter().product()], lines, touch };
        for wall in &abstraction.workspace[model] {
            // Beyond a wall is a blocker, too.
            let normal = vector(&abstraction.directions[wall.direction].vector).map(|x| -x);
            space.block(&Inflated::Polytope(vec![(normal, -wall.offset)]));
        }
        blocked.iter().for_each(|set| space.block(set));
        space.join();
        Some(space)
    }

    /// Whether some point of a convex set, given by half-spaces, may lie in the component of a point.
    pub(super) fn connects(&self, abstraction: &Abstraction, from: &[f64], region: &[HalfSpace]) -> bool {
        let facets: Vec<(Vector, f64)> = region
            .iter()
            .map(|f| (vector(&abstraction.directions[f.direction].vector), f.offset + self.touch))
            .collect();
        let holds = |(middle, half): &(Vector, Vector)| {
            (0..3).all(|axis| (from[axis] - middle[axis]).abs() <= half[axis] + self.touch)
        };
        let meets = |(middle, half): &(Vector, Vector)| {
            facets.iter().all(|(n, offset)| dot(n, middle) - reach(n, half) <= *offset)
        };
        let free = || {
            let boxes = (0..self.component.len()).filter_map(|at| Some((at, self.component[at]?)));
            boxes.map(|(at, component)| (self.extent(at), component))
        };
        let home: Vec<usize> = free().filter(|(b, _)| holds(b)).map(|(_, component)| component).collect();
        // A start that is in no free box by rounding says nothing.
        home.is_empty() || free().any(|(b, component)| home.contains(&component) && meets(&b))
    }

    /// The middle and the half-widths of a box.
    fn extent(&self, at: usize) -> (Vector, Vector) {
        let place = self.place(at);
        let ends = |axis: usize| (self.lines[axis][place[axis]], self.lines[axis][place[axis] + 1]);
        let along = |f: fn((f64, f64)) -> f64| [0, 1, 2].map(|axis| f(ends(axis)));
        (along(|(lo, hi)| 0.5 * (lo + hi)), along(|(lo, hi)| 0.5 * (hi - lo)))
    }

    fn counts(&self) -> [usize; 3] {
        self.lines.each_ref().map(|l| l.len() - 1)
    }

    fn place(&self, at: usize) -> [usize; 3] {
        let [_, m, n] = self.counts();
        [at / (m * n), at / n % m, at % n]
    }

    fn number(&self, [i, j, k]: [usize; 3]) -> usize {
        let [_, m, n] = self.counts();
        (i * m + j) * n + k
    }

    /// Blocks the boxes that lie wholly inside a set.
    fn block(&mut self, set: &Inflated) {
        let bounds = set.bounds();
        let range = |axis: usize| -> Range<usize> {
            let (lo, hi) = bounds[axis];
            let lines = &self.lines[axis];
            let first = lines.partition_point(|x| *x < lo);
            first..lines.partition_point(|x| *x <= hi).saturating_sub(1).max(first)
        };
        let ranges = [0, 1, 2].map(range);
        for i in ranges[0].clone() {
            for j in ranges[1].clone() {
                for k in ranges[2].clone() {
                    let at = self.number([i, j, k]);
                    if self.component[at].is_some() && set.holds(self.extent(at), self.touch) {
                        self.component[at] = None;
                    }
                }
            }
        }
    }

    /// Numbers the components.
    fn join(&mut self) {
        const UNKNOWN: usize = usize::MAX;
        self.component.iter_mut().flatten().for_each(|c| *c = UNKNOWN);
        // The number of its first box is a component's number.
        for first in 0..self.component.len() {
            let mut rest = vec![first];
            while let Some(at) = rest.pop() {
                if self.component[at] == Some(UNKNOWN) {
                    self.component[at] = Some(first);
                    rest.extend(self.neighbours(at));
                }
            }
        }
    }

    fn neighbours(&self, at: usize) -> impl Iterator<Item = usize> {
        let (place, counts) = (self.place(at), self.counts());
        let step = |axis: usize| {
            let moved = |to: usize| {
                let mut place = place;
                place[axis] = to;
                place
            };
            let down = place[axis].checked_sub(1).map(moved);
            let up = (place[axis] + 1 < counts[axis]).then(|| moved(place[axis] + 1));
            [down, up]
        };
        [step(0), step(1), step(2)].into_iter().flatten().flatten().map(|place| self.number(place))
    }
}

/// The position part of a tube, as far as it is used.
struct Tube {
    /// The half-widths of the part along the axes.
    half: Vector,
    /// Generators along no axis.
    oblique: Vec<Vector>,
}

impl Tube {
    fn new(generators: &[Vec<f64>]) -> Tube {
        let mut tube = Tube { half: [0.0; 3], oblique: Vec::new() };
        for generator in generators {
            let mut along = (0..generator.len()).filter(|&axis| generator[axis] != 0.0);
            match (along.next(), along.next()) {
                (Some(axis), None) => tube.half[axis] += generator[axis].abs(),
                _ => tube.oblique.push(vector(generator)),
            }
        }
        tube.oblique.sort_by(|a, b| dot(b, b).total_cmp(&dot(a, a)));
        tube.oblique.truncate(MOST_OBLIQUE);
        tube
    }

    fn generators(&self) -> Vec<Vector> {
        let axis = |axis: usize| [0, 1, 2].map(|k| if k == axis { self.half[axis] } else { 0.0 });
        let boxed = (0..3).filter(|&k| self.half[k] > 0.0).map(axis);
        boxed.chain(self.oblique.iter().copied()).collect()
    }

    fn inflate(&self, solid: &Solid) -> Inflated {
        match &solid.ball {
            Some(ball) => {
                let spread = vector(&ball.spread);
                let half = [0, 1, 2].map(|axis| spread[axis] + self.half[axis]);
                Inflated::Round(vector(&ball.center), half, ball.radius)
            }
            None => Inflated::Polytope(self.facets(solid)),
        }
    }

    /// The facets of the sum: normals of the solid's facets and of the tube's, and across each edge
    /// of one and each generator of the other. More half-spaces that hold the sum do no harm.
    fn facets(&self, solid: &Solid) -> Vec<(Vector, f64)> {
        let generators = self.generators();
        let sides = solid.edges.iter().map(|edge| minus(&edge.ends[1], &edge.ends[0]));
        let across: Vec<Vector> = sides.chain(generators.iter().copied()).collect();
        let mut normals: Vec<Vector> = solid.normals.clone();
        for side in &across {
            normals.extend(generators.iter().map(|g| cross(side, g)).flat_map(|n| [n, n.map(|x| -x)]));
        }
        let mut unit: Vec<Vector> = Vec::new();
        for normal in normals {
            let length = dot(&normal, &normal).sqrt();
            let normal = normal.map(|x| x / length);
            // The same but for rounding: one of them is enough.
            let known = |n: &Vector| (0..3).all(|k| (n[k] - normal[k]).abs() < 1e-12);
            if length > 0.0 && !unit.iter().any(known) {
                unit.push(normal);
            }
        }
        let offset = |n: &Vector| {
            let top = -solid.level(&n.map(|x| -x));
            top + generators.iter().map(|g| dot(n, g).abs()).sum::<f64>()
        };
        unit.into_iter().map(|n| (n, offset(&n))).collect()
    }
}

impl Inflated {
    /// Lower and upper end along each axis, as far as half-spaces along the axes say so.
    fn bounds(&self) -> [(f64, f64); 3] {
        match self {
            Inflated::Round(middle, half, radius) => {
                [0, 1, 2].map(|k| (middle[k] - half[k] - radius, middle[k] + half[k] + radius))
            }
            Inflated::Polytope(facets) => [0, 1, 2].map(|axis| {
                let along = |sign: f64| {
                    let one = facets.iter().find(|(n, _)| n[axis] * sign == 1.0);
                    one.map_or(f64::INFINITY, |(_, offset)| *offset)
                };
                (-along(-1.0), along(1.0))
            }),
        }
    }

    /// Whether it is a box.
    fn is_box(&self) -> bool {
        match self {
            Inflated::Round(..) => false,
            Inflated::Polytope(facets) => {
                facets.iter().all(|(n, _)| n.iter().filter(|x| **x != 0.0).count() == 1)
            }
        }
    }

    /// Whether a box, by its middle and half-widths, lies inside by more than rounding.
    fn holds(&self, (at, size): (Vector, Vector), touch: f64) -> bool {
        match self {
            Inflated::Polytope(facets) => {
                facets.iter().all(|(n, offset)| dot(n, &at) + reach(n, &size) <= offset - touch)
            }
            Inflated::Round(middle, half, radius) => {
                let beyond = |k: usize| ((at[k] - middle[k]).abs() + size[k] - half[k]).max(0.0);
                let farthest = [0, 1, 2].map(beyond);
                dot(&farthest, &farthest).sqrt() <= radius - touch
            }
        }
    }
}

/// max n · p over a box around 0.
fn reach(n: &Vector, half: &Vector) -> f64 {
    (0..3).map(|k| n[k].abs() * half[k]).sum()
}

/// The planes across an axis: the workspace's ends, just inside each blocker's, and planes in
/// between where some blocker is no box.
fn planes(abstraction: &Abstraction, blocked: &[Inflated], axis: usize, touch: f64) -> Vec<f64> {
    let end = |positive| {
        abstraction.reaches[crate::entity::EntityId::index(abstraction.directions.axis(axis, positive))]
    };
    let (lo, hi) = (-end(false), end(true));
    let mut lines = vec![lo, hi];
    for (low, high) in blocked.iter().map(|set| set.bounds()[axis]) {
        lines.extend([low + 2.0 * touch, high - 2.0 * touch]);
    }
    if !blocked.iter().all(Inflated::is_box) {
        lines.extend((1..PLANES).map(|i| lo + (hi - lo) * i as f64 / PLANES as f64));
    }
    lines.retain(|x| (lo..=hi).contains(x));
    lines.sort_by(f64::total_cmp);
    lines.dedup();
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Diagnostics;
    use crate::driver::{self, Overrides};
    use crate::entity::EntityId;
    use crate::ir::RegionId;
    use crate::source::SourceFile;

    const ROOM: &str = include_str!("../../../tests/missions/unsat/walled_room.dosm");
    const TENT: &str = include_str!("../../../tests/missions/unsat/sealed_tent.dosm");

    /// Whether the first robot may get to the first region.
    fn connected(text: &str) -> bool {
        let source = SourceFile::new("mission.dosm", text);
        let mission = driver::load(&source, &Overrides::default(), &mut Diagnostics::new()).unwrap();
        let problem = &mission.problem;
        let abstraction = Abstraction::new(problem, &mission.tubes, 1.0);
        let model = ModelId::new(0);
        let space = Space::new(&abstraction, model).unwrap();
        let robot = problem.robots.values().next().unwrap();
        let start: Vec<f64> =
            problem.models[model].position.iter().map(|&s| robot.start[s].to_f64()).collect();
        let pieces = abstraction.inside(model, RegionId::new(0));
        pieces.iter().any(|facets| space.connects(&abstraction, &start, facets))
    }

    #[test]
    fn a_closed_room_is_cut_off_and_any_door_joins_it() {
        assert!(!connected(ROOM));
        // The tube is 0.06 m wide: a slit that it passes, and one that it does not.
        assert!(connected(&ROOM.replace("roof  = box (5, 4.5, 4.7)", "roof  = box (5.4, 4.5, 4.7)")));
        assert!(!connected(&ROOM.replace("roof  = box (5, 4.5, 4.7)", "roof  = box (5.35, 4.5, 4.7)")));
        for wall in ["west", "east", "south", "north", "ground", "roof"] {
            let text: Vec<&str> =
                ROOM.lines().filter(|line| !line.starts_with(&format!("obstacle {wall} "))).collect();
            assert!(connected(&text.join("\n")), "without {wall}");
        }
    }

    #[test]
    fn slanted_walls_and_a_ball_close_a_tent() {
        assert!(!connected(TENT));
        assert!(connected(&TENT.replace("ball (6, 6, 3.2)", "ball (2, 10, 4)")));
    }

    /// Boxes that are blocked lie in a blocker with every point, by the planes that separate.
    #[test]
    fn nothing_free_is_blocked() {
        let text = TENT.replace("hull (3, 3, 0), (9, 3, 0)", "hull (3.2, 2.9, 0.1), (9, 3, 0)");
        let source = SourceFile::new("mission.dosm", text);
        let mission = driver::load(&source, &Overrides::default(), &mut Diagnostics::new()).unwrap();
        let abstraction = Abstraction::new(&mission.problem, &mission.tubes, 1.0);
        let model = Some(ModelId::new(0));
        let space = Space::new(&abstraction, ModelId::new(0)).unwrap();
        let mut blocked = 0;
        for at in (0..space.component.len()).filter(|&at| space.component[at].is_none()) {
            let (middle, half) = space.extent(at);
            let corner = |bits: usize| {
                let sign = |k: usize| if bits >> k & 1 == 1 { 1.0 } else { -1.0 };
                [0, 1, 2].map(|k| middle[k] + sign(k) * half[k])
            };
            let walls = &abstraction.workspace[ModelId::new(0)];
            let outside = walls.iter().any(|w| {
                let n = vector(&abstraction.directions[w.direction].vector);
                dot(&n, &middle) - reach(&n, &half) > w.offset
            });
            if outside {
                continue;
            }
            blocked += 1;
            let inside_one = abstraction.solids.iter().any(|(solid, entry)| {
                let free = |bits| {
                    let center = corner(bits);
                    let body = crate::abstraction::Body { center: &center, model };
                    abstraction.separate(&[body], solid).is_some()
                };
                matches!(entry.owner, Owner::Blocker(_)) && !(0..8).any(free)
            });
            assert!(inside_one, "{middle:?} {half:?}");
        }
        assert!(blocked > 300, "{blocked}");
    }
}
