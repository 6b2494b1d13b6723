//! The invariants of the IR, and their check.
//!
//! If [`validate`] is `Ok`, no later phase panics. It holds that:
//!
//! 1. `dimension` is 2 or 3; `step` is positive; 1 ≤ `horizon.0` ≤ `horizon.1`.
//! 2. The workspace and each piece have `dimension` coordinates; a polytope has more than
//!    `dimension` vertices, as many facets at least, each vertex within all of them and on
//!    `dimension` of them at least, and the vertices' mean in its interior; in the plane facet i
//!    joins vertices i and i + 1. A ball has a positive radius and no negative spread. A shape has
//!    a piece.
//! 3. A model has states and inputs; A is n × n, B n × m, c has n entries, an enclosure the same
//!    sizes and no negative entry; `state_bounds` and `disturbance` have n intervals, `input_bounds` m,
//!    none with swapped ends; general bounds have n + m coefficients, not all 0; `position` names
//!    `dimension` different states; 0 < `rejection` < 1; some robot uses the model.
//! 4. There is a robot; each has a model of the table and as many start values as that has states.
//! 5. Base stations have `dimension` coordinates; without one, `connectivity` is `None`.
//! 6. `separation`, `range` and `hops` are positive; `redundancy` is at most 3, `every` at least 1.
//! 7. Operands come before their users in `formulas`; atoms name robots and regions of the tables;
//!    comparisons are sorted by atom, each once, none with coefficient 0; windows don't end before
//!    they begin; goals name formulas of the table.
//! 8. Names are not empty; no two of regions, blockers, bases and robots share one; nor do two models.
//! 9. Every number is within the range of doubles.

use std::collections::BTreeSet;

use super::{
    Atom, Base, Blocker, Comparison, Connectivity, Enclosure, Formula, FormulaId, Interval, Model, Piece,
    Problem, Region, Robot, Shape,
};
use crate::entity::EntityId;
use crate::exact::{Rational, RationalMatrix};
use crate::geometry::{HalfSpace, Polytope};

/// A broken invariant: always a bug of an earlier phase.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Violation {
    /// Which entity, by its id or its field's name.
    pub place: String,
    /// What does not hold.
    pub rule: &'static str,
}

impl std::fmt::Display for Violation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.place, self.rule)
    }
}

/// Checks the invariants above.
///
/// # Errors
/// All violations found.
pub fn validate(problem: &Problem) -> Result<(), Vec<Violation>> {
    let mut checker = Checker { problem, violations: Vec::new() };
    checker.problem();
    if checker.violations.is_empty() { Ok(()) } else { Err(checker.violations) }
}

struct Checker<'a> {
    problem: &'a Problem,
    violations: Vec<Violation>,
}

impl Checker<'_> {
    fn require(&mut self, holds: bool, place: impl ToString, rule: &'static str) {
        if !holds {
            self.violations.push(Violation { place: place.to_string(), rule });
        }
    }

    fn problem(&mut self) {
        let p = self.problem;
        self.require(matches!(p.dimension, 2 | 3), "dimension", "is 2 or 3");
        self.require(p.step.is_positive(), "step", "is positive");
        self.require(1 <= p.horizon.0 && p.horizon.0 <= p.horizon.1, "horizon", "is 1 ≤ from ≤ to");
        self.polytope("workspace", &p.workspace);
        for (id, Region { shape, sure, .. }) in p.regions.iter() {
            self.shape(&id.to_string(), shape);
            // Nothing at all may be certain.
            if let Some(sure) = sure.as_ref().filter(|sure| !sure.pieces.is_empty()) {
                self.shape(&format!("what is certain of {id}"), sure);
            }
        }
        p.blockers.iter().for_each(|(id, Blocker { shape, .. })| self.shape(&id.to_string(), shape));
        for (id, Base { position, .. }) in p.bases.iter() {
            self.require(position.len() == p.dimension, id, "has a coordinate for each dimension");
            self.numbers(id, position);
        }
        for (id, model) in p.models.iter() {
            self.model(&id.to_string(), model);
            self.require(p.robots.values().any(|r| r.model == id), id, "is used by a robot");
        }
        self.require(!p.robots.is_empty(), "robots", "are at least one");
        p.robots.iter().for_each(|(id, robot)| self.robot(&id.to_string(), robot));
        self.requirements();
        p.formulas.nodes().iter().for_each(|(id, formula)| self.formula(id, formula));
        for goal in &p.goals {
            let known = p.formulas.nodes().get(goal.formula).is_some();
            self.require(known, &goal.name, "names a formula of the table");
        }
        self.names();
    }

    fn requirements(&mut self) {
        let p = self.problem;
        self.require(p.separation.as_ref().is_none_or(Rational::is_positive), "separation", "is positive");
        self.numbers("separation", &p.separation);
        let Some(Connectivity { hops, range, redundancy, every }) = &p.connectivity else { return };
        self.require(!p.bases.is_empty(), "connectivity", "is required only where there is a base");
        self.require(*hops != Some(0), "connectivity", "allows a hop");
        self.require(range.as_ref().is_none_or(|r| r.length.is_positive()), "range", "is positive");
        self.numbers("range", range.as_ref().map(|r| &r.length));
        self.require(*redundancy <= 3, "redundancy", "is at most 3");
        self.require(*every >= 1, "every", "is at least 1");
    }

    fn numbers<'n>(&mut self, place: impl ToString, numbers: impl IntoIterator<Item = &'n Rational>) {
        let finite = numbers.into_iter().all(|x| x.to_f64().is_finite());
        self.require(finite, place, "is within the range of doubles");
    }

    fn shape(&mut self, place: &str, shape: &Shape) {
        self.require(!shape.pieces.is_empty(), place, "has a piece");
        for piece in &shape.pieces {
            match piece {
                Piece::Polytope(polytope) => self.polytope(place, polytope),
                Piece::Ball { center, spread, radius } => {
                    let d = self.problem.dimension;
                    self.require(
                        center.len() == d && spread.len() == d,
                        place,
                        "has a coordinate for each dimension",
                    );
                    self.require(spread.iter().all(|s| !s.is_negative()), place, "has no negative spread");
                    self.require(radius.is_positive(), place, "has a positive radius");
                    self.numbers(place, center.iter().chain(spread).chain([radius]));
                }
            }
        }
    }

    fn polytope(&mut self, place: &str, polytope: &Polytope) {
        let d = self.problem.dimension;
        let Polytope { facets, vertices } = polytope;
        let sizes = vertices.iter().all(|v| v.len() == d) && facets.iter().all(|f| f.normal.len() == d);
        self.require(sizes, place, "has a coordinate for each dimension");
        self.require(vertices.len() > d && facets.len() > d, place, "has enough vertices and facets");
        if !sizes || vertices.len() <= d {
            return;
        }
        self.numbers(place, vertices.iter().flatten().chain(facets.iter().map(|f| &f.offset)));
        self.require(
            vertices.iter().all(|v| polytope.contains(v)),
            place,
            "has its vertices within its facets",
        );
        let tight = |v: &Vec<Rational>| facets.iter().filter(|f| !f.contains_interior(v)).count();
        self.require(vertices.iter().all(|v| tight(v) >= d), place, "has its vertices on facets");
        self.require(polytope.contains_interior(&polytope.middle()), place, "has an interior");
        let joins = |(i, f): (usize, &HalfSpace)| {
            let ends = [&vertices[i % vertices.len()], &vertices[(i + 1) % vertices.len()]];
            ends.iter().all(|v| !f.contains_interior(v))
        };
        let ordered = d != 2 || facets.len() == vertices.len() && facets.iter().enumerate().all(joins);
        self.require(ordered, place, "has facet i between vertices i and i + 1");
    }

    fn model(&mut self, place: &str, model: &Model) {
        let (n, m) = (model.n(), model.m());
        self.require(n > 0 && m > 0, place, "has states and inputs");
        let sized = |a: &RationalMatrix, b: &RationalMatrix, c: &[Rational]| {
            a.shape() == (n, n) && b.shape() == (n, m) && c.len() == n
        };
        self.require(sized(&model.a, &model.b, &model.c), place, "has A, B and c of matching sizes");
        self.numbers(place, model.a.iter().chain(model.b.iter()).chain(&model.c));
        if let Some(Enclosure { a, b, c }) = &model.enclosure {
            self.require(sized(a, b, c), place, "has an enclosure of matching sizes");
            let mut entries = a.iter().chain(b.iter()).chain(c);
            self.require(
                entries.all(|x| !x.is_negative()),
                place,
                "has an enclosure without negative entries",
            );
        }
        self.require(model.state_bounds.len() == n, place, "has a bound, or none, for each state");
        self.require(model.input_bounds.len() == m, place, "has a bound for each input");
        self.require(model.disturbance.len() == n, place, "has a disturbance for each state");
        let intervals =
            model.state_bounds.iter().flatten().chain(&model.input_bounds).chain(&model.disturbance);
        for Interval { lo, hi } in intervals {
            self.require(lo <= hi, place, "has no interval with swapped ends");
            self.numbers(place, [lo, hi]);
        }
        for HalfSpace { normal, offset } in &model.mixed_bounds {
            let proper = normal.len() == n + m && normal.iter().any(|x| !x.is_zero());
            self.require(proper, place, "has general bounds over all states and inputs");
            self.numbers(place, normal.iter().chain([offset]));
        }
        self.positions(place, model);
        let share = |b: &Rational| b.is_positive() && *b < Rational::ONE;
        self.require(model.rejection.as_ref().is_none_or(share), place, "has a rejection between 0 and 1");
    }

    fn positions(&mut self, place: &str, model: &Model) {
        let different: BTreeSet<usize> = model.position.iter().copied().collect();
        let proper = different.len() == model.position.len()
            && different.len() == self.problem.dimension
            && different.iter().all(|&i| i < model.n());
        self.require(proper, place, "has a different state for each coordinate of the workspace");
    }

    fn robot(&mut self, place: &str, robot: &Robot) {
        let model = self.problem.models.get(robot.model);
        self.require(model.is_some(), place, "has a model of the table");
        let n = model.map_or(0, Model::n);
        self.require(robot.start.len() == n, place, "has a start value for each state");
        self.numbers(place, &robot.start);
    }

    fn formula(&mut self, id: FormulaId, formula: &Formula) {
        let (operands, window): (&[FormulaId], _) = match formula {
            Formula::True | Formula::False => (&[], None),
            Formula::In(atom) | Formula::Out(atom) => return self.atom(id, atom),
            Formula::Compare(comparison) => return self.comparison(id, comparison),
            Formula::And(list) | Formula::Or(list) => (list, None),
            Formula::Next(operand) => (&[*operand], None),
            Formula::Until(window, a, b) | Formula::Release(window, a, b) => (&[*a, *b], *window),
        };
        self.require(operands.iter().all(|o| o.index() < id.index()), id, "comes after its operands");
        self.require(
            window.is_none_or(|(from, to)| from <= to),
            id,
            "has a window that begins before it ends",
        );
    }

    fn atom(&mut self, id: FormulaId, atom: &Atom) {
        let known =
            self.problem.robots.get(atom.robot).is_some() && self.problem.regions.get(atom.region).is_some();
        self.require(known, id, "names a robot and a region of the tables");
    }

    fn comparison(&mut self, id: FormulaId, comparison: &Comparison) {
        comparison.terms.iter().for_each(|(atom, _)| self.atom(id, atom));
        let sorted = comparison.terms.windows(2).all(|pair| pair[0].0 < pair[1].0);
        self.require(sorted, id, "has its terms sorted, each atom once");
        self.require(comparison.terms.iter().all(|(_, k)| *k != 0), id, "has no coefficient 0");
    }

    fn names(&mut self) {
        let p = self.problem;
        let mut seen = BTreeSet::new();
        let places = p.regions.values().map(|x| &x.name).chain(p.blockers.values().map(|x| &x.name));
        let places = places.chain(p.bases.values().map(|x| &x.name));
        for name in places.chain(p.robots.values().map(|x| &x.name)) {
            self.require(!name.is_empty() && seen.insert(name), name, "has a name of its own");
        }
        let mut seen = BTreeSet::new();
        for model in p.models.values() {
            self.require(
                !model.name.is_empty() && seen.insert(&model.name),
                &model.name,
                "has a name of its own",
            );
        }
    }
}

#[cfg(test)]
mod tests;
