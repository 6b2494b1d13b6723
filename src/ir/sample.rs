//! A small problem for the unit tests of this and later phases.

use std::collections::BTreeMap;

use super::*;
use crate::entity::{EntityId, Table};
use crate::exact::{Rational, RationalMatrix};
use crate::geometry::Polytope;

/// A double, exactly.
pub fn exact(x: f64) -> Rational {
    Rational::from_f64(x).unwrap()
}

/// An interval of doubles.
pub fn interval(lo: f64, hi: f64) -> Interval {
    Interval { lo: exact(lo), hi: exact(hi) }
}

/// A vector of doubles.
pub fn point(coordinates: &[f64]) -> Vec<Rational> {
    coordinates.iter().map(|&x| exact(x)).collect()
}

/// A box as a shape of one piece.
pub fn box_shape(lo: &[f64], hi: &[f64]) -> Shape {
    Shape { pieces: vec![Piece::Polytope(Polytope::from_box(&point(lo), &point(hi)))] }
}

/// A disc as a shape of one piece.
pub fn disc(center: &[f64], radius: f64) -> Shape {
    let spread = vec![Rational::ZERO; center.len()];
    Shape { pieces: vec![Piece::Ball { center: point(center), spread, radius: exact(radius) }] }
}

/// States or inputs without documentation.
pub fn signals(names: &[&str]) -> Vec<Signal> {
    let signal = |name: &&str| Signal { name: name.to_string(), doc: String::new(), unit: "1".into() };
    names.iter().map(signal).collect()
}

/// A model from rows of A and B, inputs within ±`input`.
pub fn model(a: RationalMatrix, b: RationalMatrix, disturbance: &[(f64, f64)], input: f64) -> Model {
    let (n, m) = b.shape();
    let name = |prefix: &str, count: usize| (0..count).map(|i| format!("{prefix}{i}")).collect::<Vec<_>>();
    let list = |names: &[String]| signals(&names.iter().map(String::as_str).collect::<Vec<_>>());
    Model {
        name: "Rover".into(),
        doc: String::new(),
        states: list(&name("x", n)),
        inputs: list(&name("u", m)),
        position: vec![0],
        a,
        b,
        c: vec![Rational::ZERO; n],
        enclosure: None,
        state_bounds: vec![None; n],
        input_bounds: vec![interval(-input, input); m],
        mixed_bounds: Vec::new(),
        disturbance: disturbance.iter().map(|&(lo, hi)| interval(lo, hi)).collect(),
        rejection: None,
    }
}

/// Chains of `order` integrators along two axes, step 0.5 s, ±0.2 m on the positions, rejection
/// 0.5; `bounds` are those of the velocity, acceleration …
pub fn integrators(order: usize, input: f64, bounds: &[f64]) -> Model {
    let power = |i: usize| (1..=i as i64).fold(Rational::ONE, |p, k| p * Rational::ratio(1, 2 * k));
    let n = 2 * order;
    let a = RationalMatrix::from_fn(n, n, |i, j| {
        if i / order == j / order && j >= i { power(j - i) } else { Rational::ZERO }
    });
    let b =
        RationalMatrix::from_fn(
            n,
            2,
            |i, k| {
                if i / order == k { power(order - i % order) } else { Rational::ZERO }
            },
        );
    let disturbance: Vec<_> = (0..n).map(|i| if i % order == 0 { (-0.2, 0.2) } else { (0.0, 0.0) }).collect();
    let mut model = model(a, b, &disturbance, input);
    model.position = vec![0, order];
    for (i, bound) in model.state_bounds.iter_mut().enumerate() {
        *bound = (i % order).checked_sub(1).map(|k| interval(-bounds[k], bounds[k]));
    }
    model.rejection = Some(Rational::ratio(1, 2));
    model
}

/// One robot a model in an empty workspace of ±`size`, each at the origin.
pub fn empty(models: Vec<Model>, size: f64) -> Problem {
    let start = |(id, m): (usize, &Model)| Robot {
        name: format!("R{id}"),
        doc: String::new(),
        model: ModelId::new(id),
        start: vec![Rational::ZERO; m.n()],
    };
    let dimension = models.first().map_or(2, |m| m.position.len().max(2));
    Problem {
        name: "test".into(),
        doc: String::new(),
        sha256: String::new(),
        set: BTreeMap::new(),
        dimension,
        step: Rational::ratio(1, 2),
        workspace: Polytope::from_box(&point(&vec![-size; dimension]), &point(&vec![size; dimension])),
        regions: Table::new(),
        blockers: Table::new(),
        bases: Table::new(),
        robots: models.iter().enumerate().map(start).collect(),
        models: models.into_iter().collect(),
        separation: None,
        connectivity: None,
        horizon: (1, 8),
        objective: None,
        formulas: Formulas::new(),
        goals: Vec::new(),
    }
}

/// Two robots, a jammer between two regions, and a base: something of everything.
pub fn relay() -> Problem {
    let mut problem = empty(vec![integrators(2, 4.0, &[4.0])], 12.0);
    problem.doc = "A relay.".into();
    problem.set.insert("radius".into(), "1.5".into());
    problem.robots[RobotId::new(0)].start = point(&[-4.0, 0.0, -4.0, 0.0]);
    let second = Robot {
        name: "R1".into(),
        start: point(&[4.0, 0.0, -4.0, 0.0]),
        ..problem.robots[RobotId::new(0)].clone()
    };
    problem.robots.push(second);
    let region = |name: &str, shape| Region { name: name.into(), doc: String::new(), shape, sure: None };
    let left = problem.regions.push(region("left", box_shape(&[-11.0, 5.0], &[-7.0, 9.0])));
    let right = problem.regions.push(region("right", disc(&[8.0, 8.0], 2.0)));
    let shape = box_shape(&[-1.0, 4.0], &[1.0, 12.0]);
    problem.blockers.push(Blocker { name: "J".into(), doc: String::new(), kind: BlockerKind::Jammer, shape });
    problem.bases.push(Base { name: "B".into(), doc: String::new(), position: point(&[0.0, -8.0]) });
    problem.separation = Some(exact(0.25));
    problem.connectivity = Some(Connectivity { hops: Some(2), range: None, redundancy: 0, every: 1 });
    let (first, second) = (RobotId::new(0), RobotId::new(1));
    let formulas = &mut problem.formulas;
    let visit = formulas.intern(Formula::In(Atom { robot: first, region: left }));
    let avoid = formulas.intern(Formula::Out(Atom { robot: second, region: left }));
    let count = Comparison {
        terms: vec![(Atom { robot: first, region: right }, 1), (Atom { robot: second, region: right }, 1)],
        relation: Relation::AtLeast,
        bound: 1,
    };
    let count = formulas.intern(Formula::Compare(count));
    let both = formulas.intern(Formula::And(vec![visit, count]));
    let until = formulas.intern(Formula::Until(Some((0, 6)), avoid, both));
    problem.goals.push(Goal { name: "go".into(), formula: until });
    problem
}
