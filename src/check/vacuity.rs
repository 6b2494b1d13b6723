//! Formulas that no mission can satisfy, as far as constants and propositional reasoning show it.
//!
//! Everything here errs on one side: a formula that is called contradictory is, one that isn't may
//! still be. An atom is certainly in, certainly out or unknown, so `p and not p` is contradictory
//! and `p or not p` is not trivial.

use std::collections::BTreeMap;

use crate::entity::EntityId;
use crate::ir::{Atom, Comparison, Formula, FormulaId, Formulas, Relation};

/// The most steps for all searches of one mission together.
const BUDGET: usize = 2_000_000;
/// The most steps of a single search.
const BUDGET_OF_ONE: usize = 20_000;

/// Which formulas of a table are contradictory, indexed by their ids.
pub(super) fn contradictions(formulas: &Formulas) -> Vec<bool> {
    let mut search = Search { formulas, dead: Vec::new(), budget: BUDGET };
    for (id, formula) in formulas.nodes().iter() {
        let dead = match formula {
            Formula::False => true,
            Formula::Next(a) => search.is_dead(*a),
            Formula::Or(list) => list.iter().all(|a| search.is_dead(*a)),
            Formula::Until(window, a, b) => {
                search.is_dead(*b) || (begins_later(*window) && search.is_dead(*a))
            }
            Formula::Release(window, a, b) => {
                search.is_dead(*b) && (!begins_later(*window) || search.is_dead(*a))
            }
            Formula::And(list) => list.iter().any(|a| search.is_dead(*a)) || search.refutes(id),
            Formula::True | Formula::In(_) | Formula::Out(_) | Formula::Compare(_) => false,
        };
        search.dead.push(dead);
    }
    search.dead
}

fn begins_later(window: Option<(u32, u32)>) -> bool {
    window.is_some_and(|(m, _)| m > 0)
}

/// The searches over one table.
struct Search<'f> {
    formulas: &'f Formulas,
    /// The verdicts so far; operands come before their users.
    dead: Vec<bool>,
    budget: usize,
}

/// A branch of a search: what must hold now, and what that says of the atoms.
#[derive(Clone, Default)]
struct Branch<'f> {
    todo: Vec<FormulaId>,
    choices: Vec<&'f [FormulaId]>,
    pairs: Vec<[FormulaId; 2]>,
    atoms: BTreeMap<Atom, bool>,
    comparisons: Vec<&'f Comparison>,
}

impl<'f> Search<'f> {
    fn is_dead(&self, id: FormulaId) -> bool {
        self.dead.get(id.index()).copied().unwrap_or(false)
    }

    /// Whether every way to make the formula hold at one instant contradicts itself.
    fn refutes(&mut self, root: FormulaId) -> bool {
        let mut left = BUDGET_OF_ONE.min(self.budget);
        let before = left;
        let mut open = vec![Branch { todo: vec![root], ..Branch::default() }];
        while let Some(mut branch) = open.pop() {
            let consistent = self.expand(&mut branch, &mut left);
            if left == 0 {
                self.budget -= before;
                return false;
            }
            if !consistent {
                continue;
            }
            let alternatives = match (branch.choices.pop(), branch.pairs.pop()) {
                (Some(list), pair) => {
                    branch.pairs.extend(pair);
                    list.to_vec()
                }
                (None, Some(pair)) => pair.to_vec(),
                (None, None) => {
                    self.budget -= before - left;
                    return false;
                }
            };
            for alternative in alternatives {
                let mut next = branch.clone();
                next.todo.push(alternative);
                left = left.saturating_sub(1 + next.atoms.len() + next.choices.len());
                open.push(next);
            }
        }
        self.budget -= before - left;
        true
    }

    /// Works off what must hold without a choice; gives whether it is consistent so far.
    fn expand(&self, branch: &mut Branch<'f>, left: &mut usize) -> bool {
        let formulas = self.formulas;
        while let Some(id) = branch.todo.pop() {
            *left = left.saturating_sub(1);
            if *left == 0 {
                return true;
            }
            if self.is_dead(id) {
                return false;
            }
            match &formulas[id] {
                Formula::In(atom) | Formula::Out(atom) => {
                    let inside = matches!(formulas[id], Formula::In(_));
                    if *branch.atoms.entry(*atom).or_insert(inside) != inside {
                        return false;
                    }
                }
                Formula::Compare(comparison) => branch.comparisons.push(comparison),
                Formula::And(list) => branch.todo.extend(list),
                Formula::Or(list) => branch.choices.push(list),
                Formula::Until(window, a, b) if !begins_later(*window) => branch.pairs.push([*a, *b]),
                Formula::Release(window, _, b) if !begins_later(*window) => branch.todo.push(*b),
                Formula::False => return false,
                _ => {}
            }
        }
        branch.comparisons.iter().all(|c| is_reachable(c, &branch.atoms)) && agree(&branch.comparisons)
    }
}

/// Whether the atoms that are open can still make the comparison hold.
fn is_reachable(comparison: &Comparison, atoms: &BTreeMap<Atom, bool>) -> bool {
    let (mut least, mut most) = (0, 0);
    for (atom, coefficient) in &comparison.terms {
        let (lo, hi) = match atoms.get(atom) {
            Some(inside) => (coefficient * i64::from(*inside), coefficient * i64::from(*inside)),
            None => ((*coefficient).min(0), (*coefficient).max(0)),
        };
        least += lo;
        most += hi;
    }
    let bound = comparison.bound;
    match comparison.relation {
        Relation::AtLeast => most >= bound,
        Relation::AtMost => least <= bound,
        Relation::Equal => (least..=most).contains(&bound),
        Relation::NotEqual => least != most || least != bound,
    }
}

/// Whether comparisons of the same sum leave it a value.
fn agree(comparisons: &[&Comparison]) -> bool {
    let mut ranges: BTreeMap<&[(Atom, i64)], (i64, i64)> = BTreeMap::new();
    for comparison in comparisons {
        let range = ranges.entry(&comparison.terms).or_insert((i64::MIN, i64::MAX));
        let bound = comparison.bound;
        match comparison.relation {
            Relation::AtLeast => range.0 = range.0.max(bound),
            Relation::AtMost => range.1 = range.1.min(bound),
            Relation::Equal => *range = (range.0.max(bound), range.1.min(bound)),
            Relation::NotEqual => {}
        }
    }
    let open =
        |c: &&&Comparison| c.relation != Relation::NotEqual || ranges[&c.terms[..]] != (c.bound, c.bound);
    ranges.values().all(|(lo, hi)| lo <= hi) && comparisons.iter().all(|c| open(&c))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ir::{RegionId, RobotId};

    fn atom(i: usize) -> Atom {
        Atom { robot: RobotId::new(i), region: RegionId::new(0) }
    }

    fn count(formulas: &mut Formulas, relation: Relation, bound: i64) -> FormulaId {
        let terms = (0..3).map(|i| (atom(i), 1)).collect();
        formulas.intern(Formula::Compare(Comparison { terms, relation, bound }))
    }

    fn check(build: impl Fn(&mut Formulas) -> FormulaId, expect: bool) {
        let mut formulas = Formulas::new();
        let root = build(&mut formulas);
        assert_eq!(contradictions(&formulas)[root.index()], expect, "{:?}", formulas.nodes());
    }

    fn literals(f: &mut Formulas) -> [FormulaId; 4] {
        [Formula::In(atom(0)), Formula::Out(atom(0)), Formula::In(atom(1)), Formula::Out(atom(1))]
            .map(|l| f.intern(l))
    }

    #[test]
    fn an_atom_is_not_both() {
        check(
            |f| {
                let [p, np, ..] = literals(f);
                f.intern(Formula::And(vec![p, np]))
            },
            true,
        );
        check(
            |f| {
                let [p, np, ..] = literals(f);
                f.intern(Formula::Or(vec![p, np]))
            },
            false,
        );
        check(
            |f| {
                let [p, _, q, _] = literals(f);
                f.intern(Formula::And(vec![p, q]))
            },
            false,
        );
    }

    #[test]
    fn choices_are_all_tried() {
        let xor = |f: &mut Formulas, close: bool| {
            let [p, np, q, nq] = literals(f);
            let list = [[p, q], [p, nq], [np, q], [np, nq]];
            let list = if close { &list[..] } else { &list[..3] };
            let list = list.iter().map(|pair| f.intern(Formula::Or(pair.to_vec()))).collect();
            f.intern(Formula::And(list))
        };
        check(|f| xor(f, true), true);
        check(|f| xor(f, false), false);
    }

    #[test]
    fn temporal_operators_pass_on_what_holds_now() {
        let always = |f: &mut Formulas, a| {
            let no = f.intern(Formula::False);
            f.intern(Formula::Release(None, no, a))
        };
        check(
            |f| {
                let [p, np, ..] = literals(f);
                let g = always(f, p);
                f.intern(Formula::And(vec![g, np]))
            },
            true,
        );
        let later = |f: &mut Formulas, a| f.intern(Formula::Next(a));
        check(
            |f| {
                let [p, np, ..] = literals(f);
                let x = later(f, p);
                f.intern(Formula::And(vec![x, np]))
            },
            false,
        );
        check(
            |f| {
                let [p, np, q, _] = literals(f);
                let u = f.intern(Formula::Until(None, p, q));
                f.intern(Formula::And(vec![u, np]))
            },
            false,
        );
        check(
            |f| {
                let [p, np, q, nq] = literals(f);
                let u = f.intern(Formula::Until(None, p, q));
                f.intern(Formula::And(vec![u, np, nq]))
            },
            true,
        );
        check(
            |f| {
                let [p, np, q, nq] = literals(f);
                let u = f.intern(Formula::Until(Some((1, 2)), p, q));
                f.intern(Formula::And(vec![u, np, nq]))
            },
            false,
        );
    }

    #[test]
    fn counts_are_bounded_by_what_is_known() {
        check(
            |f| {
                let [p, _, q, _] = literals(f);
                let c = count(f, Relation::AtMost, 1);
                f.intern(Formula::And(vec![c, p, q]))
            },
            true,
        );
        check(
            |f| {
                let [p, _, q, _] = literals(f);
                let c = count(f, Relation::AtMost, 2);
                f.intern(Formula::And(vec![c, p, q]))
            },
            false,
        );
        check(
            |f| {
                let (a, b) = (count(f, Relation::AtMost, 1), count(f, Relation::AtLeast, 2));
                f.intern(Formula::And(vec![a, b]))
            },
            true,
        );
        check(
            |f| {
                let (a, b) = (count(f, Relation::Equal, 1), count(f, Relation::NotEqual, 1));
                f.intern(Formula::And(vec![a, b]))
            },
            true,
        );
        check(
            |f| {
                let (a, b) = (count(f, Relation::AtMost, 1), count(f, Relation::NotEqual, 1));
                f.intern(Formula::And(vec![a, b]))
            },
            false,
        );
    }

    #[test]
    fn a_hard_formula_is_given_up_and_not_called_contradictory_wrongly() {
        // 60 robots, none in: every pair of neighbours has someone in.
        check(
            |f| {
                let mut list = Vec::new();
                for i in 0..60 {
                    let pair = [i, (i + 1) % 60].map(|i| f.intern(Formula::In(atom(i))));
                    list.push(f.intern(Formula::Or(pair.to_vec())));
                }
                f.intern(Formula::And(list))
            },
            false,
        );
    }

    /// What a node says of a run of labels (a bit an atom) that goes on at `back`, two-valued.
    fn holds(f: &Formulas, id: FormulaId, run: &[u32], back: usize, t: usize) -> bool {
        let wrap = |t: usize| if t < run.len() { t } else { back + (t - back) % (run.len() - back) };
        let at = |id: &FormulaId, t: usize| holds(f, *id, run, back, wrap(t));
        let bit = |a: &Atom| i64::from(run[t] >> a.robot.index() & 1);
        let window = |w: &Option<(u32, u32)>| w.map_or(0..=2 * run.len(), |(m, n)| m as usize..=n as usize);
        match &f[id] {
            Formula::True => true,
            Formula::False => false,
            Formula::In(a) => bit(a) == 1,
            Formula::Out(a) => bit(a) == 0,
            Formula::Compare(c) => {
                let sum: i64 = c.terms.iter().map(|(a, k)| k * bit(a)).sum();
                match c.relation {
                    Relation::Equal => sum == c.bound,
                    Relation::NotEqual => sum != c.bound,
                    Relation::AtLeast => sum >= c.bound,
                    Relation::AtMost => sum <= c.bound,
                }
            }
            Formula::And(list) => list.iter().all(|a| at(a, t)),
            Formula::Or(list) => list.iter().any(|a| at(a, t)),
            Formula::Next(a) => at(a, t + 1),
            Formula::Until(w, a, b) => window(w).any(|d| at(b, t + d) && (0..d).all(|e| at(a, t + e))),
            Formula::Release(w, a, b) => window(w).all(|d| at(b, t + d) || (0..d).any(|e| at(a, t + e))),
        }
    }

    #[test]
    fn what_is_called_contradictory_holds_on_no_run() {
        let mut state = 11u64;
        let mut below = |n: usize| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) as usize % n
        };
        let (mut called, mut satisfiable) = (0, 0);
        for _ in 0..600 {
            let mut f = Formulas::new();
            let mut pool = literals(&mut f).to_vec();
            let relations = [Relation::Equal, Relation::NotEqual, Relation::AtLeast, Relation::AtMost];
            pool.push(count(&mut f, relations[below(4)], below(5) as i64 - 1));
            for _ in 0..5 {
                let (a, b) = (pool[below(pool.len())], pool[below(pool.len())]);
                let m = below(2) as u32;
                let w = if below(2) == 0 { None } else { Some((m, m + below(2) as u32)) };
                let node = match below(6) {
                    0 | 1 => Formula::And(vec![a, b]),
                    2 => Formula::Or(vec![a, b]),
                    3 => Formula::Next(a),
                    4 => Formula::Until(w, a, b),
                    _ => Formula::Release(w, a, b),
                };
                pool.push(f.intern(node));
            }
            let dead = contradictions(&f);
            for (id, _) in f.nodes().iter().filter(|(id, _)| dead[id.index()]) {
                called += 1;
                for bits in 0..1u32 << 6 {
                    let run = [bits & 7, bits >> 3];
                    satisfiable += (0..2).filter(|back| holds(&f, id, &run, *back, 0)).count();
                }
            }
        }
        assert!(called > 100, "only {called} were called contradictory");
        assert_eq!(satisfiable, 0);
    }
}
