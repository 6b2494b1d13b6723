//! From an IR file to a problem, strictly.

use std::collections::BTreeSet;

use super::document::{
    Base, Blocker, BlockerKind, Connectivity, Document, Enclosure, Formula, HalfSpace, Interval, Model, Norm,
    Objective, Piece, Polytope, Range, Region, Relation, Robot, Term,
};
use super::number::Number;
use super::{FORMAT, VERSION};
use crate::entity::{EntityId, Table};
use crate::exact::{Rational, RationalMatrix};
use crate::json::{ReadError, Value};
use crate::{geometry, ir};

type Result<T> = std::result::Result<T, ReadError>;

/// Reads a problem that [`write`](super::write) wrote.
///
/// # Errors
/// The first place where the text is no JSON or holds a key twice, is of another format or version,
/// lacks a key or has one of the wrong type, has a list of the wrong length or calls what is not
/// there; or else all invariants of the IR that don't hold.
pub fn read(text: &str) -> Result<ir::Problem> {
    let problem = document(text).and_then(problem).map_err(ReadError::from_root)?;
    ir::validate(&problem).map_err(|violations| {
        let all: Vec<String> = violations.iter().map(ir::Violation::to_string).collect();
        ReadError::new(all.join("; ")).from_root()
    })?;
    Ok(problem)
}

fn document(text: &str) -> Result<Document> {
    known(&Value::parse(text)?)?;
    serde_json::from_str(text).map_err(|e| ReadError::new(e.to_string()))
}

/// Refuses other formats and versions before their keys are looked at.
fn known(value: &Value) -> Result<()> {
    let field = |key: &str| match value {
        Value::Object(fields) => fields.iter().find(|(k, _)| k == key).map(|(_, v)| v),
        _ => None,
    };
    match field("format") {
        Some(Value::Text(format)) if format == FORMAT => {}
        _ => return Err(ReadError::new(format!("expected \"{FORMAT}\"")).in_key("format")),
    }
    match field("version") {
        Some(Value::Natural(version)) if *version == u64::from(VERSION) => Ok(()),
        _ => Err(ReadError::new(format!("only version {VERSION} is known")).in_key("version")),
    }
}

fn problem(document: Document) -> Result<ir::Problem> {
    let models: Table<ir::ModelId, ir::Model> = all(document.models, model, "models")?;
    let regions: Table<ir::RegionId, ir::Region> = all(document.regions, region, "regions")?;
    let robots: Table<ir::RobotId, ir::Robot> = all(document.robots, |r| robot(r, models.len()), "robots")?;
    let formulas = formulas(document.formulas, robots.len(), regions.len())?;
    let goal = |goal: super::document::Goal| {
        let formula = id(goal.formula, formulas.nodes().len()).map_err(|e| e.in_key("formula"))?;
        Ok(ir::Goal { name: goal.name, formula })
    };
    Ok(ir::Problem {
        name: document.mission.name,
        doc: document.mission.doc,
        sha256: document.mission.sha256,
        set: document.mission.set,
        dimension: document.dimension,
        step: document.step_s.0,
        workspace: polytope(document.workspace).map_err(|e| e.in_key("workspace"))?,
        blockers: all(document.blockers, blocker, "blockers")?,
        bases: document.bases.into_iter().map(base).collect(),
        separation: document.separation.map(|x| x.0),
        connectivity: document.connectivity.map(connectivity),
        horizon: (document.horizon.from, document.horizon.to),
        objective: document.objective.map(objective),
        goals: all(document.goals, goal, "goals")?,
        regions,
        models,
        robots,
        formulas,
    })
}

/// The items of a list, each converted, with its place in the error.
fn all<T, U, C: FromIterator<U>>(items: Vec<T>, convert: impl Fn(T) -> Result<U>, key: &str) -> Result<C> {
    let convert = |(i, item)| convert(item).map_err(|e| e.in_item(i));
    items.into_iter().enumerate().map(convert).collect::<Result<C>>().map_err(|e| e.in_key(key))
}

/// An id, if it is one of a table of this length.
fn id<I: EntityId>(index: usize, length: usize) -> Result<I> {
    if index < length {
        Ok(I::new(index))
    } else {
        Err(ReadError::new(format!("there is no entry {index}: the table has {length}")))
    }
}

fn vector(numbers: Vec<Number>) -> Vec<Rational> {
    numbers.into_iter().map(|x| x.0).collect()
}

fn matrix(rows: Vec<Vec<Number>>, height: usize, width: usize) -> Result<RationalMatrix> {
    if rows.len() != height {
        return Err(wrong_length(height, rows.len()));
    }
    if let Some(i) = rows.iter().position(|row| row.len() != width) {
        return Err(wrong_length(width, rows[i].len()).in_item(i));
    }
    Ok(RationalMatrix::from_row_iterator(height, width, rows.into_iter().flatten().map(|x| x.0)))
}

fn wrong_length(expected: usize, found: usize) -> ReadError {
    ReadError::new(format!("expected {expected} entries, found {found}"))
}

fn half_space(half_space: HalfSpace) -> geometry::HalfSpace {
    geometry::HalfSpace { normal: vector(half_space.normal), offset: half_space.offset.0 }
}

/// A polytope whose two forms are of the same set.
fn polytope(polytope: Polytope) -> Result<geometry::Polytope> {
    let given = geometry::Polytope {
        facets: polytope.facets.into_iter().map(half_space).collect(),
        vertices: polytope.vertices.into_iter().map(vector).collect(),
    };
    match geometry::Polytope::hull(&given.vertices) {
        Ok(hull) if same(&given, &hull) => Ok(given),
        Ok(_) => Err(ReadError::new("the facets are not those of the vertices' hull, or not in order")),
        Err(error) => Err(ReadError::new(error.to_string()).in_key("vertices")),
    }
}

/// Whether two polytopes are the same up to where their lists begin, or in space up to order.
fn same(given: &geometry::Polytope, hull: &geometry::Polytope) -> bool {
    if given.vertices.len() != hull.vertices.len() || given.facets.len() != hull.facets.len() {
        return false;
    }
    let at = hull.vertices.iter().position(|v| Some(v) == given.vertices.first()).unwrap_or(0);
    if given.dimension() == 2 {
        let turned = |i: usize| (i + at) % hull.vertices.len();
        return (0..given.vertices.len()).all(|i| {
            given.vertices[i] == hull.vertices[turned(i)] && given.facets[i] == hull.facets[turned(i)]
        });
    }
    let facets = |p: &geometry::Polytope| -> BTreeSet<(Vec<Rational>, Rational)> {
        p.facets.iter().map(|f| (f.normal.clone(), f.offset.clone())).collect()
    };
    let vertices = |p: &geometry::Polytope| p.vertices.iter().cloned().collect::<BTreeSet<_>>();
    facets(given) == facets(hull) && vertices(given) == vertices(hull)
}

fn pieces(pieces: Vec<Piece>) -> Result<ir::Shape> {
    let piece = |piece| match piece {
        Piece::Polytope { vertices, facets } => {
            polytope(Polytope { vertices, facets }).map(ir::Piece::Polytope)
        }
        Piece::Ball { center, spread, radius } => {
            Ok(ir::Piece::Ball { center: vector(center), spread: vector(spread), radius: radius.0 })
        }
    };
    Ok(ir::Shape { pieces: all(pieces, piece, "pieces")? })
}

fn region(region: Region) -> Result<ir::Region> {
    let sure = region.sure.map(pieces).transpose()?;
    Ok(ir::Region { name: region.name, doc: region.doc, shape: pieces(region.pieces)?, sure })
}

fn blocker(blocker: Blocker) -> Result<ir::Blocker> {
    let kind = match blocker.kind {
        BlockerKind::Obstacle => ir::BlockerKind::Obstacle,
        BlockerKind::OpaqueObstacle => ir::BlockerKind::OpaqueObstacle,
        BlockerKind::Jammer => ir::BlockerKind::Jammer,
    };
    Ok(ir::Blocker { name: blocker.name, doc: blocker.doc, kind, shape: pieces(blocker.pieces)? })
}

fn base(base: Base) -> ir::Base {
    ir::Base { name: base.name, doc: base.doc, position: vector(base.position) }
}

fn interval(interval: Interval) -> ir::Interval {
    ir::Interval { lo: interval.lo.0, hi: interval.hi.0 }
}

fn model(model: Model) -> Result<ir::Model> {
    let (n, m) = (model.states.len(), model.inputs.len());
    let (mut states, mut state_bounds, mut disturbance) = (Vec::new(), Vec::new(), Vec::new());
    for state in model.states {
        states.push(ir::Signal { name: state.name, doc: state.doc, unit: state.unit });
        state_bounds.push(state.bounds.map(interval));
        disturbance.push(interval(state.disturbance));
    }
    let (mut inputs, mut input_bounds) = (Vec::new(), Vec::new());
    for input in model.inputs {
        inputs.push(ir::Signal { name: input.name, doc: input.doc, unit: input.unit });
        input_bounds.push(interval(input.bounds));
    }
    let enclosed = |e: Enclosure| enclosure(e, n, m).map_err(|e| e.in_key("enclosure"));
    Ok(ir::Model {
        name: model.name,
        doc: model.doc,
        states,
        inputs,
        position: model.position,
        a: matrix(model.a, n, n).map_err(|e| e.in_key("A"))?,
        b: matrix(model.b, n, m).map_err(|e| e.in_key("B"))?,
        c: sized(model.c, n).map_err(|e| e.in_key("c"))?,
        enclosure: model.enclosure.map(enclosed).transpose()?,
        state_bounds,
        input_bounds,
        mixed_bounds: model.mixed_bounds.into_iter().map(half_space).collect(),
        disturbance,
        rejection: model.rejection.map(|x| x.0),
    })
}

fn enclosure(enclosure: Enclosure, n: usize, m: usize) -> Result<ir::Enclosure> {
    Ok(ir::Enclosure {
        a: matrix(enclosure.a, n, n).map_err(|e| e.in_key("A"))?,
        b: matrix(enclosure.b, n, m).map_err(|e| e.in_key("B"))?,
        c: sized(enclosure.c, n).map_err(|e| e.in_key("c"))?,
    })
}

fn sized(numbers: Vec<Number>, length: usize) -> Result<Vec<Rational>> {
    if numbers.len() == length { Ok(vector(numbers)) } else { Err(wrong_length(length, numbers.len())) }
}

fn robot(robot: Robot, models: usize) -> Result<ir::Robot> {
    let model = id(robot.model, models).map_err(|e| e.in_key("model"))?;
    Ok(ir::Robot { name: robot.name, doc: robot.doc, model, start: vector(robot.start) })
}

fn connectivity(asked: Connectivity) -> ir::Connectivity {
    let range = |range: Range| ir::Range {
        length: range.length.0,
        norm: match range.norm {
            Norm::Infinity => ir::Norm::Infinity,
            Norm::Euclidean => ir::Norm::Euclidean,
        },
    };
    ir::Connectivity {
        hops: asked.hops,
        range: asked.range.map(range),
        redundancy: asked.redundancy,
        every: asked.every,
    }
}

fn objective(objective: Objective) -> ir::Objective {
    match objective {
        Objective::Effort => ir::Objective::Effort,
        Objective::Length => ir::Objective::Length,
    }
}

/// The table of formulas; each node has the place that it had in the file.
fn formulas(nodes: Vec<Formula>, robots: usize, regions: usize) -> Result<ir::Formulas> {
    let mut table = ir::Formulas::new();
    for (i, node) in nodes.into_iter().enumerate() {
        let node = formula(node, i, robots, regions);
        let place = |e: ReadError| e.in_item(i).in_key("formulas");
        let twin = table.intern(node.map_err(place)?);
        if twin.index() != i {
            return Err(place(ReadError::new(format!("says the same as entry {}", twin.index()))));
        }
    }
    Ok(table)
}

/// A formula whose operands are among the first `before`.
fn formula(formula: Formula, before: usize, robots: usize, regions: usize) -> Result<ir::Formula> {
    let operand = |index: usize| id::<ir::FormulaId>(index, before);
    let operands = |list: Vec<usize>| all(list, operand, "operands");
    let window = |window: Option<[u32; 2]>| window.map(|[from, to]| (from, to));
    let atom = |robot: usize, region: usize| -> Result<ir::Atom> {
        Ok(ir::Atom {
            robot: id(robot, robots).map_err(|e| e.in_key("robot"))?,
            region: id(region, regions).map_err(|e| e.in_key("region"))?,
        })
    };
    let term = |Term { coefficient, robot, region }| Ok((atom(robot, region)?, coefficient));
    Ok(match formula {
        Formula::True => ir::Formula::True,
        Formula::False => ir::Formula::False,
        Formula::In { robot, region } => ir::Formula::In(atom(robot, region)?),
        Formula::Out { robot, region } => ir::Formula::Out(atom(robot, region)?),
        Formula::Compare { terms, relation: how, bound } => {
            let terms = all(terms, term, "terms")?;
            ir::Formula::Compare(ir::Comparison { terms, relation: relation(how), bound })
        }
        Formula::And { operands: list } => ir::Formula::And(operands(list)?),
        Formula::Or { operands: list } => ir::Formula::Or(operands(list)?),
        Formula::Next { operand: inner } => {
            ir::Formula::Next(operand(inner).map_err(|e| e.in_key("operand"))?)
        }
        Formula::Until { window: steps, hold, then } => ir::Formula::Until(
            window(steps),
            operand(hold).map_err(|e| e.in_key("hold"))?,
            operand(then).map_err(|e| e.in_key("then"))?,
        ),
        Formula::Release { window: steps, release, hold } => ir::Formula::Release(
            window(steps),
            operand(release).map_err(|e| e.in_key("release"))?,
            operand(hold).map_err(|e| e.in_key("hold"))?,
        ),
    })
}

fn relation(relation: Relation) -> ir::Relation {
    match relation {
        Relation::Equal => ir::Relation::Equal,
        Relation::NotEqual => ir::Relation::NotEqual,
        Relation::AtLeast => ir::Relation::AtLeast,
        Relation::AtMost => ir::Relation::AtMost,
    }
}
