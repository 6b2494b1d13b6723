//! The IR as stable text, for people and snapshots.
//!
//! One line a fact, ids as in [`entity`](crate::entity), numbers exact. Everything is written but
//! the hash of the source, which would change with every comment.

use std::fmt::{self, Display, Formatter, Write};

use super::{
    Blocker, BlockerKind, Comparison, Connectivity, Enclosure, Formula, Interval, Model, Norm, Objective,
    Piece, Problem, Relation, Robot, Shape,
};
use crate::exact::{Rational, RationalMatrix};
use crate::geometry::{HalfSpace, Polytope};

impl Display for Problem {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "problem {}", self.name)?;
        write_doc(f, "", &self.doc)?;
        for (name, value) in &self.set {
            writeln!(f, "set {name} = {value}")?;
        }
        writeln!(f, "dimension {}", self.dimension)?;
        writeln!(f, "step {} s", self.step)?;
        writeln!(f, "workspace {}", Corners(&self.workspace))?;
        for (id, region) in self.regions.iter() {
            writeln!(f, "{id} {} = {}", region.name, region.shape)?;
            if let Some(sure) = &region.sure {
                writeln!(f, "  for certain {sure}")?;
            }
            write_doc(f, "  ", &region.doc)?;
        }
        for (id, blocker) in self.blockers.iter() {
            writeln!(f, "{id} {blocker}")?;
            write_doc(f, "  ", &blocker.doc)?;
        }
        for (id, base) in self.bases.iter() {
            writeln!(f, "{id} {} at {}", base.name, Tuple(&base.position))?;
            write_doc(f, "  ", &base.doc)?;
        }
        for (id, model) in self.models.iter() {
            write!(f, "{id} {model}")?;
        }
        for (id, robot) in self.robots.iter() {
            writeln!(f, "{id} {robot}")?;
            write_doc(f, "  ", &robot.doc)?;
        }
        self.write_requirements(f)
    }
}

impl Problem {
    fn write_requirements(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if let Some(separation) = &self.separation {
            writeln!(f, "separation {separation}")?;
        }
        match &self.connectivity {
            Some(connectivity) => writeln!(f, "connectivity {connectivity}")?,
            None => writeln!(f, "connectivity none")?,
        }
        writeln!(f, "horizon {}..{}", self.horizon.0, self.horizon.1)?;
        if let Some(objective) = self.objective {
            writeln!(f, "minimize {objective}")?;
        }
        for (id, formula) in self.formulas.nodes().iter() {
            writeln!(f, "{id} = {formula}")?;
        }
        for goal in &self.goals {
            writeln!(f, "goal {} = {}", goal.name, goal.formula)?;
        }
        Ok(())
    }
}

fn write_doc(f: &mut Formatter<'_>, indent: &str, doc: &str) -> fmt::Result {
    doc.lines().try_for_each(|line| writeln!(f, "{indent}/// {}", line.escape_debug()))
}

/// Items with a separator between them.
fn join<T: Display>(f: &mut impl Write, items: impl IntoIterator<Item = T>, separator: &str) -> fmt::Result {
    for (i, item) in items.into_iter().enumerate() {
        if i > 0 {
            f.write_str(separator)?;
        }
        write!(f, "{item}")?;
    }
    Ok(())
}

/// `(4, 7)`
struct Tuple<'a>(&'a [Rational]);

impl Display for Tuple<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_char('(')?;
        join(f, self.0, ", ")?;
        f.write_char(')')
    }
}

/// A polytope by its vertices, which determine it.
struct Corners<'a>(&'a Polytope);

impl Display for Corners<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("polytope ")?;
        join(f, self.0.vertices.iter().map(|v| Tuple(v)), " ")
    }
}

impl Display for Shape {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        join(f, &self.pieces, " or ")
    }
}

impl Display for Piece {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Piece::Polytope(polytope) => Corners(polytope).fmt(f),
            Piece::Ball { center, spread, radius } => {
                write!(f, "ball {}", Tuple(center))?;
                if spread.iter().any(|s| !s.is_zero()) {
                    write!(f, " +/- {}", Tuple(spread))?;
                }
                write!(f, " radius {radius}")
            }
        }
    }
}

impl Display for Blocker {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let kind = match self.kind {
            BlockerKind::Obstacle => "obstacle",
            BlockerKind::OpaqueObstacle => "opaque obstacle",
            BlockerKind::Jammer => "jammer",
        };
        write!(f, "{kind} {} = {}", self.name, self.shape)
    }
}

impl Display for Robot {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} at {}", self.name, self.model, Tuple(&self.start))
    }
}

impl Display for Interval {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "[{}, {}]", self.lo, self.hi)
    }
}

/// `[1, 0.5; 0, 1]`
struct Rows<'a>(&'a RationalMatrix);

impl Display for Rows<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_char('[')?;
        for (i, row) in self.0.row_iter().enumerate() {
            f.write_str(if i > 0 { "; " } else { "" })?;
            join(f, row.iter(), ", ")?;
        }
        f.write_char(']')
    }
}

impl Display for Model {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.name)?;
        write_doc(f, "  ", &self.doc)?;
        self.write_signals(f)?;
        write!(f, "  position ")?;
        join(f, self.position.iter().filter_map(|&i| self.states.get(i)).map(|s| &s.name), ", ")?;
        writeln!(f, "\n  A = {}\n  B = {}\n  c = {}", Rows(&self.a), Rows(&self.b), Tuple(&self.c))?;
        if let Some(enclosure) = &self.enclosure {
            writeln!(f, "  {enclosure}")?;
        }
        for row in &self.mixed_bounds {
            writeln!(f, "  bound {}", self.inequality(row))?;
        }
        if let Some(rejection) = &self.rejection {
            writeln!(f, "  rejection {rejection}")?;
        }
        Ok(())
    }
}

impl Model {
    fn write_signals(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for (i, state) in self.states.iter().enumerate() {
            write!(f, "  state {}: {}", state.name, state.unit)?;
            if let Some(Some(bound)) = self.state_bounds.get(i) {
                write!(f, " in {bound}")?;
            }
            if let Some(disturbance) = self.disturbance.get(i).filter(|d| !d.lo.is_zero() || !d.hi.is_zero())
            {
                write!(f, " disturbed by {disturbance}")?;
            }
            writeln!(f)?;
            write_doc(f, "    ", &state.doc)?;
        }
        for (input, bound) in self.inputs.iter().zip(&self.input_bounds) {
            writeln!(f, "  input {}: {} in {bound}", input.name, input.unit)?;
            write_doc(f, "    ", &input.doc)?;
        }
        Ok(())
    }

    /// `1 vx + -2 ax <= 5`
    fn inequality(&self, row: &HalfSpace) -> String {
        let names = self.states.iter().chain(&self.inputs).map(|s| &s.name);
        let terms = row.normal.iter().zip(names).filter(|(c, _)| !c.is_zero());
        let terms: Vec<String> = terms.map(|(c, name)| format!("{c} {name}")).collect();
        format!("{} <= {}", terms.join(" + "), row.offset)
    }
}

impl Display for Enclosure {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        // Its entries are long fractions that nobody reads: an upper bound says enough.
        let largest = self.a.iter().chain(self.b.iter()).chain(&self.c).map(Rational::to_f64_up);
        write!(f, "enclosed within {:e}", largest.fold(0.0, f64::max))
    }
}

impl Display for Connectivity {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.hops {
            Some(hops) => write!(f, "hops {hops}")?,
            None => write!(f, "hops any")?,
        }
        if let Some(range) = &self.range {
            let norm = match range.norm {
                Norm::Infinity => "infinity",
                Norm::Euclidean => "2",
            };
            write!(f, ", range {} norm {norm}", range.length)?;
        }
        write!(f, ", redundancy {}, every {}", self.redundancy, self.every)
    }
}

impl Display for Objective {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Objective::Effort => "effort",
            Objective::Length => "length",
        })
    }
}

impl Display for Formula {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Formula::True => f.write_str("true"),
            Formula::False => f.write_str("false"),
            Formula::In(atom) => write!(f, "{} in {}", atom.robot, atom.region),
            Formula::Out(atom) => write!(f, "{} out {}", atom.robot, atom.region),
            Formula::Compare(comparison) => comparison.fmt(f),
            Formula::And(operands) => {
                f.write_str("and ")?;
                join(f, operands, " ")
            }
            Formula::Or(operands) => {
                f.write_str("or ")?;
                join(f, operands, " ")
            }
            Formula::Next(operand) => write!(f, "next {operand}"),
            Formula::Until(window, a, b) => write!(f, "until{} {a} {b}", Window(*window)),
            Formula::Release(window, a, b) => write!(f, "release{} {a} {b}", Window(*window)),
        }
    }
}

/// `[2, 5]`, or nothing.
struct Window(Option<(u32, u32)>);

impl Display for Window {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.map_or(Ok(()), |(from, to)| write!(f, "[{from}, {to}]"))
    }
}

impl Display for Comparison {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let term = |(atom, k): &(super::Atom, i64)| format!("{k}({} in {})", atom.robot, atom.region);
        f.write_str("sum ")?;
        join(f, self.terms.iter().map(term), " + ")?;
        let relation = match self.relation {
            Relation::Equal => "=",
            Relation::NotEqual => "!=",
            Relation::AtLeast => ">=",
            Relation::AtMost => "<=",
        };
        write!(f, " {relation} {}", self.bound)
    }
}
