//! Negation normal form: until and release only, negation at the atoms, equal parts shared.
//!
//! Only laws that hold for three values are used: `p or not p` stays what it is, since it asks for
//! a certain p or a certain not p. There is no recursion: operands come before their users in the
//! typed table, so one pass down finds what is needed in which polarity and one pass up builds it.

use crate::check::typed::{self, Formula as Typed, Window};
use crate::entity::{EntityId, Table};
use crate::ir::{Formula, FormulaId, Formulas};
use crate::lower::comparison::comparison;

/// The longest list that is merged into the one around it: a chain of a thousand `and`s has a
/// thousand lists on its way, and they must not add up to their square.
const MAX_FLATTENED: usize = 64;

/// The negation normal forms of some formulas, in one table.
pub fn normalise(
    typed: &Table<typed::FormulaId, Typed>,
    roots: &[typed::FormulaId],
) -> (Formulas, Vec<FormulaId>) {
    let needed = polarities(typed, roots);
    let mut builder = Builder { formulas: Formulas::new(), built: vec![[None; 2]; typed.len()] };
    for (id, formula) in typed.iter() {
        for negated in [false, true] {
            if needed[id.index()][usize::from(negated)] {
                let normal = builder.normal(formula, negated);
                builder.built[id.index()][usize::from(negated)] = Some(normal);
            }
        }
    }
    let roots = roots.iter().map(|&root| builder.get(root, false)).collect();
    (builder.formulas, roots)
}

/// Which formulas are needed as they are (`[0]`) and negated (`[1]`).
fn polarities(typed: &Table<typed::FormulaId, Typed>, roots: &[typed::FormulaId]) -> Vec<[bool; 2]> {
    let mut needed = vec![[false; 2]; typed.len()];
    for root in roots {
        needed[root.index()][0] = true;
    }
    for (id, formula) in typed.iter().rev() {
        for negated in [false, true] {
            if needed[id.index()][usize::from(negated)] {
                operands(formula, negated, |operand, negated| {
                    needed[operand.index()][usize::from(negated)] = true;
                });
            }
        }
    }
    needed
}

/// The operands of a formula's normal form, each with whether it is needed negated.
fn operands(formula: &Typed, negated: bool, mut need: impl FnMut(typed::FormulaId, bool)) {
    match formula {
        Typed::Constant(_) | Typed::In(_) | Typed::Compare { .. } => {}
        Typed::Not(a) => need(*a, !negated),
        Typed::Next(a) | Typed::Always(_, a) | Typed::Eventually(_, a) => need(*a, negated),
        Typed::And(list) | Typed::Or(list) => list.iter().for_each(|a| need(*a, negated)),
        Typed::Implies(a, b) => {
            need(*a, !negated);
            need(*b, negated);
        }
        Typed::Iff(a, b) => {
            for operand in [*a, *b] {
                need(operand, false);
                need(operand, true);
            }
        }
        Typed::Until(_, a, b)
        | Typed::Release(_, a, b)
        | Typed::WeakUntil(_, a, b)
        | Typed::StrongRelease(_, a, b) => {
            need(*a, negated);
            need(*b, negated);
        }
    }
}

/// The table that is being built, and the normal forms so far by typed formula and polarity.
struct Builder {
    formulas: Formulas,
    built: Vec<[Option<FormulaId>; 2]>,
}

impl Builder {
    fn get(&mut self, id: typed::FormulaId, negated: bool) -> FormulaId {
        match self.built[id.index()][usize::from(negated)] {
            Some(built) => built,
            // Operands come before their users, so this is never taken; true would be unsound.
            None => self.constant(false),
        }
    }

    fn normal(&mut self, formula: &Typed, negated: bool) -> FormulaId {
        match formula {
            Typed::Constant(value) => self.constant(*value != negated),
            Typed::In(atom) if negated => self.formulas.intern(Formula::Out(*atom)),
            Typed::In(atom) => self.formulas.intern(Formula::In(*atom)),
            Typed::Compare { terms, op, bound } => {
                self.formulas.intern(comparison(terms, *op, *bound, negated))
            }
            Typed::Not(a) => self.get(*a, !negated),
            Typed::Next(a) => {
                let a = self.get(*a, negated);
                self.next(a)
            }
            Typed::Always(window, a) | Typed::Eventually(window, a) => {
                let a = self.get(*a, negated);
                if matches!(formula, Typed::Always(..)) != negated {
                    self.always(*window, a)
                } else {
                    self.eventually(*window, a)
                }
            }
            Typed::And(list) | Typed::Or(list) => {
                let list = list.iter().map(|a| self.get(*a, negated)).collect();
                self.junction(matches!(formula, Typed::And(_)) != negated, list)
            }
            Typed::Implies(a, b) => {
                let (a, b) = (self.get(*a, !negated), self.get(*b, negated));
                self.junction(negated, vec![a, b])
            }
            Typed::Iff(a, b) => self.iff(*a, *b, negated),
            Typed::Until(window, a, b) | Typed::Release(window, a, b) => {
                let (a, b) = (self.get(*a, negated), self.get(*b, negated));
                self.fixpoint(matches!(formula, Typed::Until(..)) != negated, *window, a, b)
            }
            Typed::WeakUntil(window, a, b) | Typed::StrongRelease(window, a, b) => {
                let (a, b) = (self.get(*a, negated), self.get(*b, negated));
                if matches!(formula, Typed::WeakUntil(..)) != negated {
                    self.weak_until(*window, a, b)
                } else {
                    self.strong_release(*window, a, b)
                }
            }
        }
    }

    /// (a and b) or (not a and not b); negated, (not a or not b) and (a or b).
    fn iff(&mut self, a: typed::FormulaId, b: typed::FormulaId, negated: bool) -> FormulaId {
        let same = [false, true].map(|polarity| {
            let pair = vec![self.get(a, polarity != negated), self.get(b, polarity != negated)];
            self.junction(!negated, pair)
        });
        self.junction(negated, same.to_vec())
    }

    /// a W b = b R (a or b); a W\[m,n\] b = (a U\[m,n\] b) or always\[0,n\] a.
    fn weak_until(&mut self, window: Option<Window>, a: FormulaId, b: FormulaId) -> FormulaId {
        let Some((_, n)) = window else {
            let either = self.junction(false, vec![a, b]);
            return self.fixpoint(false, None, b, either);
        };
        let until = self.fixpoint(true, window, a, b);
        let always = self.always(Some((0, n)), a);
        self.junction(false, vec![until, always])
    }

    /// a M b = b U (a and b); a M\[m,n\] b = (a R\[m,n\] b) and eventually\[0,n\] a.
    fn strong_release(&mut self, window: Option<Window>, a: FormulaId, b: FormulaId) -> FormulaId {
        let Some((_, n)) = window else {
            let both = self.junction(true, vec![a, b]);
            return self.fixpoint(true, None, b, both);
        };
        let release = self.fixpoint(false, window, a, b);
        let eventually = self.eventually(Some((0, n)), a);
        self.junction(true, vec![release, eventually])
    }

    fn always(&mut self, window: Option<Window>, a: FormulaId) -> FormulaId {
        let never = self.constant(false);
        self.fixpoint(false, window, never, a)
    }

    fn eventually(&mut self, window: Option<Window>, a: FormulaId) -> FormulaId {
        let ever = self.constant(true);
        self.fixpoint(true, window, ever, a)
    }

    fn constant(&mut self, value: bool) -> FormulaId {
        self.formulas.intern(if value { Formula::True } else { Formula::False })
    }

    fn value(&self, id: FormulaId) -> Option<bool> {
        match self.formulas[id] {
            Formula::True => Some(true),
            Formula::False => Some(false),
            _ => None,
        }
    }

    fn next(&mut self, a: FormulaId) -> FormulaId {
        if self.value(a).is_some() { a } else { self.formulas.intern(Formula::Next(a)) }
    }

    /// A conjunction or a disjunction, flattened, without repetitions and neutral operands.
    fn junction(&mut self, conjunction: bool, list: Vec<FormulaId>) -> FormulaId {
        let mut operands = Vec::new();
        for id in list {
            match &self.formulas[id] {
                Formula::And(inner) if conjunction && inner.len() <= MAX_FLATTENED => operands.extend(inner),
                Formula::Or(inner) if !conjunction && inner.len() <= MAX_FLATTENED => operands.extend(inner),
                _ => operands.push(id),
            }
        }
        if operands.iter().any(|&id| self.value(id) == Some(!conjunction)) {
            return self.constant(!conjunction);
        }
        operands.retain(|&id| self.value(id) != Some(conjunction));
        let mut seen = std::collections::BTreeSet::new();
        operands.retain(|&id| seen.insert(id));
        match operands[..] {
            [] => self.constant(conjunction),
            [only] => only,
            _ if conjunction => self.formulas.intern(Formula::And(operands)),
            _ => self.formulas.intern(Formula::Or(operands)),
        }
    }

    /// `a U b` or `a R b`, folded where constants decide it; below, v is true for until and false for
    /// release, so that the laws of one are the duals of the other's.
    fn fixpoint(&mut self, until: bool, window: Option<Window>, a: FormulaId, b: FormulaId) -> FormulaId {
        let from_now = window.is_none_or(|(m, _)| m == 0);
        let (v, not_v) = (Some(until), Some(!until));
        let (first, second) = (self.value(a), self.value(b));
        // b = ¬v leaves nothing to wait for; b = v is there at once, or once a's run has held.
        if second == not_v || (second == v && (from_now || first == v)) {
            return b;
        }
        if window == Some((0, 0)) || (first == not_v && from_now) {
            return b;
        }
        // a = ¬v can't hold up to a window that begins later.
        if first == not_v {
            return a;
        }
        let node = if until { Formula::Until(window, a, b) } else { Formula::Release(window, a, b) };
        self.formulas.intern(node)
    }
}

#[cfg(test)]
mod tests;
