//! Lemmas: contradictions made as general as their margin allows.

use rustsat::types::Lit;

use crate::abstraction::{Abstraction, HalfSpace};
use crate::encode::{Encoder, Leaf};
use crate::ir::{Problem, RobotId};

use super::convex::{Conflict, Member};

/// The share of a contradiction's margin that relaxing may use up.
const SPENDABLE: f64 = 0.9;

/// A contradiction's half-spaces, each as weak as it may be, in terms of one robot's time.
#[derive(Clone, Debug)]
pub struct Lemma {
    /// What can't all be true.
    pub rows: Vec<Row>,
    /// The loop that it is about, as length and loop start.
    pub lasso: Option<(usize, usize)>,
    /// Whether it holds at other times, and for other robots with the same model.
    pub shiftable: bool,
}

/// One constraint of a lemma.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The literal of the candidate.
    pub lit: Lit,
    /// Its meaning, with the offset moved as far as it may be.
    pub leaf: Leaf,
}

impl Lemma {
    /// The lemma of a conflict.
    pub fn new(
        conflict: &Conflict,
        problem: &Problem,
        abstraction: &Abstraction,
        encoder: &Encoder<'_>,
        members: &[Member<'_>],
    ) -> Lemma {
        let mut bounds: Vec<f64> = conflict.proof.terms.iter().map(|t| t.bound).collect();
        let mut rows: Vec<Option<Row>> = Vec::new();
        let mut budget = SPENDABLE * conflict.margin;
        for (term, bound) in conflict.proof.terms.iter().zip(&mut bounds) {
            let Some((lit, leaf)) = term.constraint else {
                rows.push(None);
                continue;
            };
            let room = if term.multiple > 0.0 { budget / term.multiple } else { 0.0 };
            let (row, used) = relax(lit, leaf, room, problem, abstraction, encoder);
            *bound += used;
            budget -= used * term.multiple;
            rows.push(row);
        }
        if !conflict.holds_with(&bounds, members) {
            let strict = |t: &super::convex::Term| t.constraint.map(|(lit, leaf)| Row { lit, leaf });
            rows = conflict.proof.terms.iter().map(strict).collect();
        }
        let lasso = conflict.uses_loop.then_some((conflict.proof.lasso.length, conflict.proof.lasso.back));
        let shiftable = conflict.free_from.is_some() && members.len() == 1;
        let mut rows: Vec<Row> = rows.into_iter().flatten().collect();
        rows.sort_by_key(|r| r.lit);
        rows.dedup_by_key(|r| r.lit);
        Lemma { rows, lasso, shiftable }
    }

    /// The lemma's literals at another time and for another robot, where all of them exist.
    pub fn shifted(&self, encoder: &Encoder<'_>, robot: RobotId, from: usize, to: usize) -> Option<Vec<Lit>> {
        let literal = |row: &Row| match row.leaf {
            Leaf::HalfSpace { step, half_space, .. } => {
                // The weakest literal that still implies the row's half-space.
                let parallel = encoder.parallel(robot, step - from + to, half_space);
                let at = parallel.partition_point(|(offset, _)| *offset <= half_space.offset);
                at.checked_sub(1).map(|at| parallel[at].1)
            }
            Leaf::Apart(_) | Leaf::Near(_) => None,
        };
        self.rows.iter().map(literal).collect()
    }

    /// The first and the last step of its rows.
    pub fn span(&self) -> Option<(usize, usize)> {
        let step = |row: &Row| match row.leaf {
            Leaf::HalfSpace { step, .. } => step,
            Leaf::Apart(face) => face.step,
            Leaf::Near(near) => near.step,
        };
        let first = self.rows.iter().map(step).min()?;
        Some((first, self.rows.iter().map(step).max()?))
    }
}

/// The weakest literal in the constraint's place whose offset is at most `room` farther out, and how
/// much of the room that takes; no row at all where the workspace's own bound is near enough.
fn relax(
    lit: Lit,
    leaf: Leaf,
    room: f64,
    problem: &Problem,
    abstraction: &Abstraction,
    encoder: &Encoder<'_>,
) -> (Option<Row>, f64) {
    let Leaf::HalfSpace { robot, step, half_space } = leaf else {
        return (Some(Row { lit, leaf }), 0.0);
    };
    let ceiling = abstraction.ceiling(problem.robots[robot].model, half_space.direction);
    if ceiling <= half_space.offset + room {
        return (None, ceiling - half_space.offset);
    }
    let parallel = encoder.parallel(robot, step, half_space);
    let at = parallel.partition_point(|(offset, _)| *offset <= half_space.offset + room);
    match at.checked_sub(1).map(|at| parallel[at]) {
        Some((offset, weaker)) if offset > half_space.offset => {
            let used = offset - half_space.offset;
            let leaf = Leaf::HalfSpace { robot, step, half_space: HalfSpace { offset, ..half_space } };
            (Some(Row { lit: weaker, leaf }), used)
        }
        _ => (Some(Row { lit, leaf }), 0.0),
    }
}
