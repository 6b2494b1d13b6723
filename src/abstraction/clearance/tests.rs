//! The planes that separate, against exact distances.

use super::*;
use crate::abstraction::Owner;
use crate::abstraction::solid::Ball;
use crate::diag::Diagnostics;
use crate::driver::{self, Overrides};
use crate::entity::{EntityId, Table};
use crate::exact::Rational;
use crate::geometry::Polytope;
use crate::ir::BlockerId;
use crate::source::SourceFile;

const PLANE: &str = include_str!("../../../tests/missions/solve/disc.dosm");
const SPACE: &str = include_str!("../../../tests/missions/solve/space.dosm");

/// Numbers that are always the same ones (a linear congruence).
struct Numbers(u64);

impl Numbers {
    /// A whole number from 0 to below `count`.
    fn below(&mut self, count: u64) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) % count) as f64
    }

    /// A point with few bits; coordinates from −reach to reach.
    fn point(&mut self, dimension: usize, reach: u64, grain: f64) -> Vec<f64> {
        (0..dimension).map(|_| (self.below(2 * reach + 1) - reach as f64) * grain).collect()
    }
}

/// An abstraction whose one model and one solid can be replaced.
fn stage(text: &str) -> Abstraction {
    let source = SourceFile::new("mission.dosm", text);
    let mission = driver::load(&source, &Overrides::default(), &mut Diagnostics::new()).unwrap();
    Abstraction::new(&mission.problem, &mission.tubes, 1.0)
}

fn exact(v: &[f64]) -> Vec<Rational> {
    v.iter().map(|x| Rational::from_f64(*x).unwrap()).collect()
}

/// All corners of a tube around a middle, and more points of it.
fn corners(generators: &[Vec<f64>], middle: &[f64]) -> Vec<Vec<Rational>> {
    let mut points = vec![exact(middle)];
    for generator in generators {
        let moved = |sign: f64| {
            let step = exact(&generator.iter().map(|x| sign * x).collect::<Vec<_>>());
            let add = move |p: &Vec<Rational>| p.iter().zip(&step).map(|(a, b)| a + b).collect::<Vec<_>>();
            points.iter().map(add).collect::<Vec<_>>()
        };
        points = [moved(1.0), moved(-1.0)].concat();
    }
    points
}

/// The least distance between points' hull and a solid's core, squared; `None` for a flat difference.
fn squared_distance(points: &[Vec<Rational>], core: &[Vec<Rational>], dimension: usize) -> Option<Rational> {
    let minus = |q: &Vec<Rational>, p: &Vec<Rational>| q.iter().zip(p).map(|(a, b)| a - b).collect();
    let all: Vec<Vec<Rational>> = core.iter().flat_map(|q| points.iter().map(move |p| minus(q, p))).collect();
    Some(Polytope::hull(&all).ok()?.squared_distance(&vec![Rational::ZERO; dimension]))
}

fn random_solid(numbers: &mut Numbers, dimension: usize, abstraction: &mut Abstraction) -> Option<()> {
    let round = numbers.below(3) == 0.0;
    let points: Vec<Vec<f64>> =
        (0..4 + numbers.below(5) as usize).map(|_| numbers.point(dimension, 8, 0.25)).collect();
    let exact: Vec<Vec<Rational>> = points.iter().map(|p| exact(p)).collect();
    let piece = if round {
        let spread = numbers.point(dimension, 2, 0.25).iter().map(|x| x.abs()).collect::<Vec<_>>();
        let center = exact[0].clone();
        crate::ir::Piece::Ball {
            center,
            spread: self::exact(&spread),
            radius: Rational::from_f64(0.5 + 0.25 * numbers.below(4)).unwrap(),
        }
    } else {
        crate::ir::Piece::Polytope(Polytope::hull(&exact).ok()?)
    };
    let owner = Owner::Blocker(BlockerId::new(0));
    let solid = crate::abstraction::solid::solid(owner, 0, &piece, &mut abstraction.directions);
    abstraction.solids = Table::new();
    abstraction.solids.push(solid);
    Some(())
}

/// The core's corners and the radius around them.
fn core(solid: &Solid) -> (Vec<Vec<Rational>>, f64) {
    match &solid.ball {
        None => (solid.vertices.iter().map(|v| exact(v)).collect(), 0.0),
        Some(Ball { center, spread, radius }) => {
            let axes = (0..center.len())
                .map(|k| (0..center.len()).map(|j| if j == k { spread[k] } else { 0.0 }).collect::<Vec<_>>());
            (corners(&axes.collect::<Vec<_>>(), center), *radius)
        }
    }
}

/// In the plane and in space: a plane is found wherever the sets are farther apart than half a gap,
/// it separates exactly, and where none is found the sets are nearer than that.
#[test]
fn planes_are_found_wherever_there_is_room_for_one() {
    let (solid, mut numbers) = (SolidId::new(0), Numbers(7));
    let mut counts = [0; 2];
    for (text, dimension, cases) in [(PLANE, 2, 400), (SPACE, 3, 60)] {
        let mut abstraction = stage(text);
        for _ in 0..cases {
            let tubes = 1 + numbers.below(dimension as u64) as usize;
            let generators: Vec<Vec<f64>> = (0..tubes).map(|_| numbers.point(dimension, 4, 0.125)).collect();
            let outline = Vec::new();
            let model = crate::ir::ModelId::new(0);
            abstraction.tubes = Table::new();
            abstraction.tubes.push(PositionTube { generators: generators.clone(), outline });
            if random_solid(&mut numbers, dimension, &mut abstraction).is_none() {
                continue;
            }
            let (mut first, second) =
                (numbers.point(dimension, 12, 0.25), numbers.point(dimension, 12, 0.25));
            // What touches is moved by about a gap.
            first[0] += abstraction.gap * [0.0, 0.4, 0.6, 1.0, -1.0][numbers.below(5) as usize];
            let base = numbers.below(3) == 0.0;
            let bodies = [
                Body { center: &first, model: Some(model) },
                Body { center: &second, model: (!base).then_some(model) },
            ];
            let tube = corners(&generators, &first);
            let points = [tube, corners(if base { &[] } else { &generators }, &second)].concat();
            let (core, radius) = core(&abstraction.solids[solid]);
            let Some(square) = squared_distance(&points, &core, dimension) else { continue };
            let room = square.to_f64().sqrt() - radius;
            let found = abstraction.separate(&bodies, solid);
            counts[usize::from(found.is_some())] += 1;
            let Some(plane) = found else {
                assert!(room < 0.51 * abstraction.gap, "{room} left by {bodies:?} {:?}", core);
                continue;
            };
            let (normal, offset) = (exact(&plane.normal), Rational::from_f64(plane.offset).unwrap());
            assert!(plane.width <= room * (1.0 + 1e-9) + 1e-12, "{} > {room}", plane.width);
            assert!(points.iter().all(|p| crate::exact::dot(&normal, p) < offset));
            let depth = core.iter().map(|q| crate::exact::dot(&normal, q) - &offset).min().unwrap();
            let square = crate::exact::dot(&normal, &normal) * exact(&[radius * radius])[0].clone();
            assert!(!depth.is_negative() && &depth * &depth >= square);
            let widest = abstraction.nearest_normals(&bodies, &abstraction.solids[solid]);
            let widths = widest.iter().filter_map(|n| abstraction.slab(&bodies, solid, n));
            let most = widths.map(|p| p.width).fold(f64::MIN, f64::max);
            assert!(most >= room - 1e-8, "a slab of {room}, found one of {most}");
        }
    }
    assert!(counts.iter().all(|n| *n > 120), "{counts:?}");
}
