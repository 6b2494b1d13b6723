//! A small problem and a plan of it, made by hand, for the tests of the picture.

use std::collections::BTreeMap;

use crate::entity::EntityId;
use crate::exact::{Rational, RationalMatrix};
use crate::geometry::{HalfSpace, Polytope};
use crate::ir::{
    Base, Blocker, BlockerKind, Formula, Formulas, Goal, Interval, Model, ModelId, Piece, Problem, Region,
    Robot, Shape, Signal,
};
use crate::plan::{Link, Mission, Plan, RobotPlan, Tube};

fn number(value: f64) -> Rational {
    Rational::from_f64(value).expect("finite")
}

fn numbers(values: &[f64]) -> Vec<Rational> {
    values.iter().copied().map(number).collect()
}

fn boxed(x: (f64, f64), y: (f64, f64)) -> Polytope {
    let vertices = [(x.0, y.0), (x.1, y.0), (x.1, y.1), (x.0, y.1)];
    let facets = [([0.0, -1.0], -y.0), ([1.0, 0.0], x.1), ([0.0, 1.0], y.1), ([-1.0, 0.0], -x.0)];
    Polytope {
        facets: facets.iter().map(|(n, b)| HalfSpace { normal: numbers(n), offset: number(*b) }).collect(),
        vertices: vertices.iter().map(|v| numbers(&[v.0, v.1])).collect(),
    }
}

fn shape(piece: Piece) -> Shape {
    Shape { pieces: vec![piece] }
}

fn blocker(name: &str, kind: BlockerKind, piece: Piece) -> Blocker {
    Blocker { name: name.into(), doc: String::new(), kind, shape: shape(piece) }
}

fn cart() -> Model {
    let signal = |name: &str| Signal { name: name.into(), doc: String::new(), unit: "m".into() };
    let interval = || Interval { lo: number(-1.0), hi: number(1.0) };
    Model {
        name: "Cart".into(),
        doc: String::new(),
        states: ["px", "py"].map(signal).into(),
        inputs: ["vx", "vy"].map(signal).into(),
        position: vec![0, 1],
        a: RationalMatrix::identity(2, 2),
        b: RationalMatrix::identity(2, 2),
        c: numbers(&[0.0, 0.0]),
        enclosure: None,
        state_bounds: vec![None, None],
        input_bounds: vec![interval(), interval()],
        mixed_bounds: Vec::new(),
        disturbance: vec![interval(), interval()],
        rejection: None,
    }
}

/// A workspace of 12 m by 8 m with one of everything.
pub fn problem(name: &str) -> Problem {
    let mut formulas = Formulas::new();
    let formula = formulas.intern(Formula::True);
    let disc =
        Piece::Ball { center: numbers(&[8.0, 2.0]), spread: numbers(&[0.5, 0.0]), radius: number(1.0) };
    let robot = |name: &str, x: f64| Robot {
        name: name.into(),
        doc: String::new(),
        model: ModelId::new(0),
        start: numbers(&[x, 1.0]),
    };
    let region = Region {
        name: "<goal> & co".into(),
        doc: String::new(),
        shape: shape(Piece::Polytope(boxed((8.0, 11.0), (5.0, 7.5)))),
        sure: None,
    };
    Problem {
        name: name.into(),
        doc: String::new(),
        sha256: String::new(),
        set: BTreeMap::new(),
        dimension: 2,
        step: number(0.5),
        workspace: boxed((0.0, 12.0), (0.0, 8.0)),
        regions: [region].into_iter().collect(),
        blockers: [
            blocker("J1", BlockerKind::Jammer, Piece::Polytope(boxed((4.0, 6.0), (3.0, 5.0)))),
            blocker("disc", BlockerKind::Obstacle, disc),
            blocker("wall", BlockerKind::OpaqueObstacle, Piece::Polytope(boxed((2.0, 2.4), (4.0, 8.0)))),
        ]
        .into_iter()
        .collect(),
        bases: [Base { name: "B1".into(), doc: String::new(), position: numbers(&[1.0, 7.0]) }]
            .into_iter()
            .collect(),
        models: [cart()].into_iter().collect(),
        robots: [robot("R1", 1.0), robot("R2", 3.0)].into_iter().collect(),
        separation: None,
        connectivity: None,
        horizon: (1, 8),
        objective: None,
        formulas,
        goals: vec![Goal { name: "g".into(), formula }],
    }
}

/// A link without its witnesses.
pub fn link(from: &str, to: &str) -> Link {
    Link { from: from.into(), to: to.into(), hops: 1, separators: Vec::new() }
}

/// Four steps, the last two of them a loop; its tube stands off its middle.
pub fn plan() -> Plan {
    let robot = |name: &str, z: &[[f64; 2]]| RobotPlan {
        name: name.into(),
        dynamics: "Cart".into(),
        z: z.iter().map(|p| p.to_vec()).collect(),
        v: vec![vec![0.0; 2]; z.len()],
        regions: BTreeMap::new(),
        outside: BTreeMap::new(),
        clear: BTreeMap::new(),
    };
    Plan {
        tool: "dosmc 0.1.0".into(),
        mission: Mission { name: "m".into(), sha256: String::new(), set: BTreeMap::new() },
        step_s: 0.5,
        length: 4,
        loop_start: 2,
        tubes: vec![Tube {
            dynamics: "Cart".into(),
            center: vec![0.1, 0.0],
            half_width: vec![0.2, 0.3],
            reserve: vec![0.0; 2],
            d: vec![vec![vec![1.0, 0.0], vec![0.0, 1.0]]],
            m: vec![vec![vec![-1.0, 0.0], vec![0.0, -1.0]]],
        }],
        robots: vec![
            robot("R1", &[[1.0, 1.0], [3.0, 2.0], [7.0, 4.0], [9.0, 6.0], [10.0, 5.5]]),
            robot("R2", &[[3.0, 1.0], [3.0, 2.5], [3.2, 6.0], [5.0, 7.0], [4.0, 6.5]]),
        ],
        links: Some(vec![
            Vec::new(),
            Vec::new(),
            Vec::new(),
            Vec::new(),
            vec![link("R1", "R2"), link("R2", "B1")],
        ]),
        separation: Vec::new(),
        objective: None,
    }
}
