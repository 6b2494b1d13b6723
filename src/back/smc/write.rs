//! From an instance to its file's document.

use std::collections::HashMap;

use nalgebra::DMatrix;

use super::document as doc;
use super::{FORMAT, HALF_SPACES, PAPER, VERSION};
use crate::abstraction::{Abstraction, Cell, HalfSpace, Partition};
use crate::back::Names;
use crate::encode::{self, Instance, Leaf, Meaning, Relation};
use crate::entity::EntityId;
use crate::ir::{ModelId, Problem};
use crate::tube::{Tube, Tubes};

/// The document of an instance made from a source text.
pub fn document(
    source: &str,
    problem: &Problem,
    tubes: &Tubes,
    abstraction: &Abstraction,
    instance: &Instance,
) -> doc::Document {
    let names = Names::new(problem);
    let (half_spaces, map) = map(problem, abstraction, instance, &names);
    doc::Document {
        format: FORMAT.into(),
        version: VERSION,
        tool: format!("dosmc {}", env!("CARGO_PKG_VERSION")),
        mission: doc::Mission {
            name: problem.name.clone(),
            sha256: problem.sha256.clone(),
            source: source.into(),
            set: problem.set.clone(),
        },
        encoding: if abstraction.partition.is_some() { PAPER } else { HALF_SPACES }.into(),
        tubes: tubes.iter().map(|(id, t)| tube(&problem.models[id].name, t)).collect(),
        half_spaces,
        cells: abstraction.partition.as_ref().map(|p| cells(problem, abstraction, p)),
        lengths: lengths(instance),
        cnf: cnf(instance),
        convex: convex(instance, &names),
        map,
    }
}

/// All models' cells, one model after the other.
fn cells(problem: &Problem, abstraction: &Abstraction, partition: &Partition) -> Vec<doc::Cell> {
    let facet = |f: &HalfSpace| doc::Facet {
        direction: abstraction.directions[f.direction].vector.clone(),
        offset: f.offset,
    };
    let of_model = |model: ModelId| {
        let dynamics = &problem.models[model].name;
        let cell = move |cell: &Cell| doc::Cell {
            dynamics: dynamics.clone(),
            facets: cell.facets.iter().map(facet).collect(),
        };
        partition.cells(model).values().map(cell)
    };
    problem.models.ids().flat_map(of_model).collect()
}

/// The place of each model's first cell in the list of all cells.
fn first_cells(problem: &Problem, abstraction: &Abstraction) -> Vec<usize> {
    let count = |model| abstraction.partition.as_ref().map_or(0, |p| p.cells(model).len());
    let mut first = vec![0];
    problem.models.ids().for_each(|model| first.push(first[first.len() - 1] + count(model)));
    first
}

fn tube(dynamics: &str, tube: &Tube) -> doc::Tube {
    let rows = |matrix: &DMatrix<f64>| -> Vec<Vec<f64>> {
        matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
    };
    doc::Tube {
        dynamics: dynamics.into(),
        disturbance: doc::Disturbance { center: tube.center.clone(), half_width: tube.half_width.clone() },
        reserve: tube.reserve.clone(),
        beta: tube.beta,
        d: tube.d.iter().map(rows).collect(),
        m: tube.m.iter().map(rows).collect(),
    }
}

fn lengths(instance: &Instance) -> Vec<doc::Length> {
    let length = |&(length, lit): &(usize, _)| doc::Length { length, literal: encode::number(lit) };
    instance.lengths.iter().map(length).collect()
}

fn cnf(instance: &Instance) -> doc::Cnf {
    let clauses = instance.clauses.iter();
    let clauses = clauses.map(|clause| clause.iter().map(|&lit| encode::number(lit)).collect());
    doc::Cnf { vars: instance.variables, clauses: clauses.collect() }
}

fn convex(instance: &Instance, names: &Names<'_>) -> doc::Convex {
    let row = |row: &encode::Row| {
        doc::Row::Linear(doc::Linear {
            terms: row.terms.clone(),
            relation: match row.relation {
                Relation::Equal => doc::Relation::Equal,
                Relation::AtMost => doc::Relation::AtMost,
            },
            bound: row.bound,
        })
    };
    let sum =
        |(terms, constant): &(Vec<(usize, f64)>, f64)| doc::Sum { terms: terms.clone(), constant: *constant };
    let cone = |cone: &encode::Cone| {
        doc::Row::Cone(doc::Cone { norm: cone.sums.iter().map(sum).collect(), bound: cone.bound })
    };
    let block = |block: &encode::Block| doc::Block {
        name: block.name.clone(),
        literal: block.literal.map(encode::number),
        rows: block.rows.iter().map(row).chain(block.cones.iter().map(cone)).collect(),
    };
    doc::Convex {
        variables: instance.convex.variables.iter().map(|v| names.variable(v)).collect(),
        blocks: instance.convex.blocks.iter().map(block).collect(),
    }
}

/// The half-spaces that occur, each once a model, and what literals stand for.
fn map(
    problem: &Problem,
    abstraction: &Abstraction,
    instance: &Instance,
    names: &Names<'_>,
) -> (Vec<doc::HalfSpace>, doc::Map) {
    let mut map = doc::Map { cells: abstraction.partition.is_some().then(Vec::new), ..doc::Map::default() };
    let first_cells = first_cells(problem, abstraction);
    let mut half_spaces = HalfSpaces { problem, abstraction, list: Vec::new(), places: HashMap::new() };
    for &(lit, meaning) in &instance.map {
        let literal = encode::number(lit);
        match meaning {
            // The lengths have a list of their own.
            Meaning::Length(_) => {}
            Meaning::Loop { length, start } => {
                map.loops.push(doc::Loop { literal, length, loop_start: start });
            }
            Meaning::Link(link, step) => {
                let (from, to) = names.ends(link);
                map.links.push(doc::Link { literal, from: from.into(), to: to.into(), step });
            }
            Meaning::Cell { robot, cell, step } => {
                let cell = first_cells[problem.robots[robot].model.index()] + cell.index();
                let robot = names.robot(robot).into();
                map.cells.get_or_insert_default().push(doc::InCell { literal, robot, cell, step });
            }
            Meaning::Leaf(Leaf::HalfSpace { robot, step, half_space }) => {
                let half_space = half_spaces.place(problem.robots[robot].model, half_space);
                let robot = names.robot(robot).into();
                map.half_spaces.push(doc::InHalfSpace { literal, robot, half_space, step });
            }
            Meaning::Leaf(Leaf::Apart(face)) => map.faces.push(doc::Face {
                literal,
                pair: [face.first, face.second].map(|robot| names.robot(robot).into()),
                axis: face.axis,
                sign: if face.positive { 1 } else { -1 },
                step: face.step,
            }),
            Meaning::Leaf(Leaf::Near(near)) => map.near.get_or_insert_default().push(doc::Near {
                literal,
                robots: near.robots().map(|(robot, _)| names.robot(robot).into()).collect(),
                normal: near.normal[..problem.dimension].to_vec(),
                offset: near.offset,
                step: near.step,
            }),
        }
    }
    (half_spaces.list, map)
}

/// The half-spaces that occur, in order of their first occurrence.
struct HalfSpaces<'a> {
    problem: &'a Problem,
    abstraction: &'a Abstraction,
    list: Vec<doc::HalfSpace>,
    places: HashMap<(ModelId, usize, u64), usize>,
}

impl HalfSpaces<'_> {
    fn place(&mut self, model: ModelId, half_space: HalfSpace) -> usize {
        let HalfSpace { direction, offset } = half_space;
        let key = (model, direction.index(), offset.to_bits());
        *self.places.entry(key).or_insert_with(|| {
            let dynamics = self.problem.models[model].name.clone();
            let direction = self.abstraction.directions[direction].vector.clone();
            self.list.push(doc::HalfSpace { dynamics, direction, offset });
            self.list.len() - 1
        })
    }
}
