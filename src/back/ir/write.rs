//! From a problem to what the file says.

use super::document::{
    Base, Blocker, BlockerKind, Connectivity, Document, Enclosure, Formula, Goal, HalfSpace, Horizon, Input,
    Interval, Mission, Model, Norm, Objective, Piece, Polytope, Range, Region, Relation, Robot, State, Term,
};
use super::number::Number;
use super::{FORMAT, VERSION};
use crate::entity::EntityId;
use crate::exact::{Rational, RationalMatrix};
use crate::{geometry, ir};

/// What the file says of a problem.
pub(super) fn document(problem: &ir::Problem) -> Document {
    Document {
        format: FORMAT.into(),
        version: VERSION,
        tool: concat!("dosmc ", env!("CARGO_PKG_VERSION")).into(),
        mission: Mission {
            name: problem.name.clone(),
            doc: problem.doc.clone(),
            sha256: problem.sha256.clone(),
            set: problem.set.clone(),
        },
        dimension: problem.dimension,
        step_s: number(&problem.step),
        workspace: polytope(&problem.workspace),
        regions: problem.regions.values().map(region).collect(),
        blockers: problem.blockers.values().map(blocker).collect(),
        bases: problem.bases.values().map(base).collect(),
        models: problem.models.values().map(model).collect(),
        robots: problem.robots.values().map(robot).collect(),
        separation: problem.separation.as_ref().map(number),
        connectivity: problem.connectivity.as_ref().map(connectivity),
        horizon: Horizon { from: problem.horizon.0, to: problem.horizon.1 },
        objective: problem.objective.map(objective),
        formulas: problem.formulas.nodes().values().map(formula).collect(),
        goals: problem.goals.iter().map(goal).collect(),
    }
}

fn number(x: &Rational) -> Number {
    Number(x.clone())
}

fn numbers(vector: &[Rational]) -> Vec<Number> {
    vector.iter().map(number).collect()
}

fn rows(matrix: &RationalMatrix) -> Vec<Vec<Number>> {
    matrix.row_iter().map(|row| row.iter().map(number).collect()).collect()
}

fn half_space(half_space: &geometry::HalfSpace) -> HalfSpace {
    HalfSpace { normal: numbers(&half_space.normal), offset: number(&half_space.offset) }
}

fn polytope(polytope: &geometry::Polytope) -> Polytope {
    Polytope {
        vertices: polytope.vertices.iter().map(|v| numbers(v)).collect(),
        facets: polytope.facets.iter().map(half_space).collect(),
    }
}

fn pieces(shape: &ir::Shape) -> Vec<Piece> {
    shape.pieces.iter().map(piece).collect()
}

fn piece(piece: &ir::Piece) -> Piece {
    match piece {
        ir::Piece::Polytope(inner) => {
            let Polytope { vertices, facets } = polytope(inner);
            Piece::Polytope { vertices, facets }
        }
        ir::Piece::Ball { center, spread, radius } => {
            Piece::Ball { center: numbers(center), spread: numbers(spread), radius: number(radius) }
        }
    }
}

fn region(region: &ir::Region) -> Region {
    let sure = region.sure.as_ref().map(pieces);
    Region { name: region.name.clone(), doc: region.doc.clone(), pieces: pieces(&region.shape), sure }
}

fn blocker(blocker: &ir::Blocker) -> Blocker {
    let kind = match blocker.kind {
        ir::BlockerKind::Obstacle => BlockerKind::Obstacle,
        ir::BlockerKind::OpaqueObstacle => BlockerKind::OpaqueObstacle,
        ir::BlockerKind::Jammer => BlockerKind::Jammer,
    };
    Blocker { name: blocker.name.clone(), doc: blocker.doc.clone(), kind, pieces: pieces(&blocker.shape) }
}

fn base(base: &ir::Base) -> Base {
    Base { name: base.name.clone(), doc: base.doc.clone(), position: numbers(&base.position) }
}

fn interval(interval: &ir::Interval) -> Interval {
    Interval { lo: number(&interval.lo), hi: number(&interval.hi) }
}

fn model(model: &ir::Model) -> Model {
    let states = model.states.iter().zip(&model.state_bounds).zip(&model.disturbance);
    let inputs = model.inputs.iter().zip(&model.input_bounds);
    Model {
        name: model.name.clone(),
        doc: model.doc.clone(),
        states: states.map(|((signal, bounds), disturbance)| state(signal, bounds, disturbance)).collect(),
        inputs: inputs.map(|(signal, bounds)| input(signal, bounds)).collect(),
        position: model.position.clone(),
        a: rows(&model.a),
        b: rows(&model.b),
        c: numbers(&model.c),
        enclosure: model.enclosure.as_ref().map(enclosure),
        mixed_bounds: model.mixed_bounds.iter().map(half_space).collect(),
        rejection: model.rejection.as_ref().map(number),
    }
}

fn state(signal: &ir::Signal, bounds: &Option<ir::Interval>, disturbance: &ir::Interval) -> State {
    State {
        name: signal.name.clone(),
        doc: signal.doc.clone(),
        unit: signal.unit.clone(),
        bounds: bounds.as_ref().map(interval),
        disturbance: interval(disturbance),
    }
}

fn input(signal: &ir::Signal, bounds: &ir::Interval) -> Input {
    Input {
        name: signal.name.clone(),
        doc: signal.doc.clone(),
        unit: signal.unit.clone(),
        bounds: interval(bounds),
    }
}

fn enclosure(enclosure: &ir::Enclosure) -> Enclosure {
    Enclosure { a: rows(&enclosure.a), b: rows(&enclosure.b), c: numbers(&enclosure.c) }
}

fn robot(robot: &ir::Robot) -> Robot {
    Robot {
        name: robot.name.clone(),
        doc: robot.doc.clone(),
        model: robot.model.index(),
        start: numbers(&robot.start),
    }
}

fn connectivity(asked: &ir::Connectivity) -> Connectivity {
    let range = |range: &ir::Range| Range {
        length: number(&range.length),
        norm: match range.norm {
            ir::Norm::Infinity => Norm::Infinity,
            ir::Norm::Euclidean => Norm::Euclidean,
        },
    };
    Connectivity {
        hops: asked.hops,
        range: asked.range.as_ref().map(range),
        redundancy: asked.redundancy,
        every: asked.every,
    }
}

fn objective(objective: ir::Objective) -> Objective {
    match objective {
        ir::Objective::Effort => Objective::Effort,
        ir::Objective::Length => Objective::Length,
    }
}

fn formula(formula: &ir::Formula) -> Formula {
    let all = |list: &[ir::FormulaId]| list.iter().map(|f| f.index()).collect();
    let window = |window: Option<(u32, u32)>| window.map(|(from, to)| [from, to]);
    match formula {
        ir::Formula::True => Formula::True,
        ir::Formula::False => Formula::False,
        ir::Formula::In(atom) => Formula::In { robot: atom.robot.index(), region: atom.region.index() },
        ir::Formula::Out(atom) => Formula::Out { robot: atom.robot.index(), region: atom.region.index() },
        ir::Formula::Compare(comparison) => compare(comparison),
        ir::Formula::And(operands) => Formula::And { operands: all(operands) },
        ir::Formula::Or(operands) => Formula::Or { operands: all(operands) },
        ir::Formula::Next(operand) => Formula::Next { operand: operand.index() },
        ir::Formula::Until(steps, hold, then) => {
            Formula::Until { window: window(*steps), hold: hold.index(), then: then.index() }
        }
        ir::Formula::Release(steps, release, hold) => {
            Formula::Release { window: window(*steps), release: release.index(), hold: hold.index() }
        }
    }
}

fn compare(comparison: &ir::Comparison) -> Formula {
    let term = |(atom, coefficient): &(ir::Atom, i64)| Term {
        coefficient: *coefficient,
        robot: atom.robot.index(),
        region: atom.region.index(),
    };
    let relation = match comparison.relation {
        ir::Relation::Equal => Relation::Equal,
        ir::Relation::NotEqual => Relation::NotEqual,
        ir::Relation::AtLeast => Relation::AtLeast,
        ir::Relation::AtMost => Relation::AtMost,
    };
    Formula::Compare { terms: comparison.terms.iter().map(term).collect(), relation, bound: comparison.bound }
}

fn goal(goal: &ir::Goal) -> Goal {
    Goal { name: goal.name.clone(), formula: goal.formula.index() }
}
