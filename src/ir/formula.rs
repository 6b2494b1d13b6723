//! Temporal formulas in negation normal form, hash-consed.

use std::collections::HashMap;

use crate::entity::Table;
use crate::entity_id;
use crate::ir::{RegionId, RobotId};

entity_id!(
    /// A subformula.
    FormulaId, "f"
);

/// A robot in a region: the only thing that formulas ask of a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Atom {
    /// Who.
    pub robot: RobotId,
    /// Where.
    pub region: RegionId,
}

/// The comparison of a sum with 0 that holds for every value of the unknown atoms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Relation {
    /// Σ = k
    Equal,
    /// Σ ≠ k
    NotEqual,
    /// Σ ≥ k
    AtLeast,
    /// Σ ≤ k
    AtMost,
}

/// Σ coefficient · atom ⋈ bound, each atom at most once, no coefficient 0, sorted by atom.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Comparison {
    /// The terms.
    pub terms: Vec<(Atom, i64)>,
    /// ⋈
    pub relation: Relation,
    /// The right-hand side.
    pub bound: i64,
}

/// A node in negation normal form; operands come before their users in the table.
///
/// Always, eventually, weak until and strong release are lowered to `Until` and `Release`
/// (language.md §4); a window `(m, n)` is in steps, `None` means [0, ∞).
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Formula {
    /// Holds always.
    True,
    /// Never holds.
    False,
    /// The robot is certainly in the region.
    In(Atom),
    /// The robot is certainly out of the region.
    Out(Atom),
    /// The comparison holds for every value of the unknown atoms.
    Compare(Comparison),
    /// All operands hold.
    And(Vec<FormulaId>),
    /// Some operand holds.
    Or(Vec<FormulaId>),
    /// The operand holds at the next step.
    Next(FormulaId),
    /// Some d in the window: the second at t + d, and the first at t … t + d − 1.
    Until(Option<(u32, u32)>, FormulaId, FormulaId),
    /// Each d in the window: the second at t + d, or the first at some of t … t + d − 1.
    Release(Option<(u32, u32)>, FormulaId, FormulaId),
}

/// The table of subformulas; equal formulas have one id.
#[derive(Clone, Debug, Default)]
pub struct Formulas {
    nodes: Table<FormulaId, Formula>,
    ids: HashMap<Formula, FormulaId>,
}

impl PartialEq for Formulas {
    fn eq(&self, other: &Formulas) -> bool {
        self.nodes == other.nodes
    }
}

impl Formulas {
    /// An empty table.
    pub fn new() -> Formulas {
        Formulas::default()
    }

    /// The id of a node, which is added when it is new.
    pub fn intern(&mut self, formula: Formula) -> FormulaId {
        if let Some(&id) = self.ids.get(&formula) {
            return id;
        }
        let id = self.nodes.push(formula.clone());
        self.ids.insert(formula, id);
        id
    }

    /// All nodes, operands before their users.
    pub fn nodes(&self) -> &Table<FormulaId, Formula> {
        &self.nodes
    }
}

impl std::ops::Index<FormulaId> for Formulas {
    type Output = Formula;
    fn index(&self, id: FormulaId) -> &Formula {
        &self.nodes[id]
    }
}
