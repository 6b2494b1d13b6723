//! The normal form against the language's own definitions, by brute force over small lassos.

use super::*;
use crate::check::typed::FormulaId as TypedId;
use crate::ir::{Atom, RegionId, RobotId};

/// An infinite run of labels: positions 0 … n − 1, and then on at `back`.
struct Lasso {
    labels: Vec<u32>,
    back: usize,
}

impl Lasso {
    fn at(&self, t: usize) -> usize {
        if t < self.labels.len() { t } else { self.back + (t - self.back) % (self.labels.len() - self.back) }
    }

    fn holds(&self, atom: &Atom, t: usize) -> bool {
        self.labels[self.at(t)] >> atom.robot.index() & 1 == 1
    }

    /// The offsets that a window means; an unbounded one has seen everything after two rounds.
    fn window(&self, window: Option<Window>) -> std::ops::RangeInclusive<usize> {
        window.map_or(0..=2 * self.labels.len(), |(m, n)| m as usize..=n as usize)
    }
}

type Typed2 = Table<TypedId, Typed>;

/// What the language says, two-valued; language.md §4.
fn meant(f: &Typed2, id: TypedId, run: &Lasso, t: usize) -> bool {
    let at = |id: &TypedId, t: usize| meant(f, *id, run, run.at(t));
    let until = |w: Option<Window>, a: &dyn Fn(usize) -> bool, b: &dyn Fn(usize) -> bool| {
        run.window(w).any(|d| b(t + d) && (0..d).all(|e| a(t + e)))
    };
    let throughout =
        |w: Option<Window>, a: &dyn Fn(usize) -> bool| (0..=*run.window(w).end()).all(|d| a(t + d));
    match &f[id] {
        Typed::Constant(value) => *value,
        Typed::In(atom) => run.holds(atom, t),
        Typed::Compare { .. } => unreachable!("tested beside its own code"),
        Typed::Not(a) => !at(a, t),
        Typed::Next(a) => at(a, t + 1),
        Typed::And(list) => list.iter().all(|a| at(a, t)),
        Typed::Or(list) => list.iter().any(|a| at(a, t)),
        Typed::Implies(a, b) => !at(a, t) || at(b, t),
        Typed::Iff(a, b) => at(a, t) == at(b, t),
        Typed::Always(w, a) => run.window(*w).all(|d| at(a, t + d)),
        Typed::Eventually(w, a) => run.window(*w).any(|d| at(a, t + d)),
        Typed::Until(w, a, b) => until(*w, &|s| at(a, s), &|s| at(b, s)),
        Typed::Release(w, a, b) => !until(*w, &|s| !at(a, s), &|s| !at(b, s)),
        Typed::WeakUntil(w, a, b) => until(*w, &|s| at(a, s), &|s| at(b, s)) || throughout(*w, &|s| at(a, s)),
        Typed::StrongRelease(w, a, b) => {
            !(until(*w, &|s| !at(a, s), &|s| !at(b, s)) || throughout(*w, &|s| !at(a, s)))
        }
    }
}

/// What the IR's nodes mean, two-valued; `ir/formula.rs`.
fn lowered(f: &Formulas, id: FormulaId, run: &Lasso, t: usize) -> bool {
    let at = |id: &FormulaId, t: usize| lowered(f, *id, run, run.at(t));
    match &f[id] {
        Formula::True => true,
        Formula::False => false,
        Formula::In(atom) => run.holds(atom, t),
        Formula::Out(atom) => !run.holds(atom, t),
        Formula::Compare(_) => unreachable!("tested beside its own code"),
        Formula::And(list) => list.iter().all(|a| at(a, t)),
        Formula::Or(list) => list.iter().any(|a| at(a, t)),
        Formula::Next(a) => at(a, t + 1),
        Formula::Until(w, a, b) => run.window(*w).any(|d| at(b, t + d) && (0..d).all(|e| at(a, t + e))),
        Formula::Release(w, a, b) => run.window(*w).all(|d| at(b, t + d) || (0..d).any(|e| at(a, t + e))),
    }
}

/// A small generator of pseudo-random numbers, so that failures repeat.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 33) as usize % n
    }
}

fn random_formula(numbers: &mut Numbers, size: usize) -> Typed2 {
    let mut table = Typed2::new();
    for i in 0..2 {
        table.push(Typed::In(Atom { robot: RobotId::new(i), region: RegionId::new(0) }));
    }
    table.push(Typed::Constant(numbers.below(2) == 0));
    for _ in 0..size {
        let (a, b) = (TypedId::new(numbers.below(table.len())), TypedId::new(numbers.below(table.len())));
        let m = numbers.below(3) as u32;
        let w = if numbers.below(2) == 0 { None } else { Some((m, m + numbers.below(3) as u32)) };
        let node = match numbers.below(12) {
            0 => Typed::Not(a),
            1 => Typed::Next(a),
            2 => Typed::Always(w, a),
            3 => Typed::Eventually(w, a),
            4 => Typed::And(vec![a, b]),
            5 => Typed::Or(vec![a, b]),
            6 => Typed::Implies(a, b),
            7 => Typed::Iff(a, b),
            8 => Typed::Until(w, a, b),
            9 => Typed::Release(w, a, b),
            10 => Typed::WeakUntil(w, a, b),
            _ => Typed::StrongRelease(w, a, b),
        };
        table.push(node);
    }
    table
}

#[test]
fn the_normal_form_means_what_the_language_says() {
    let mut numbers = Numbers(7);
    let runs: Vec<Lasso> = (1..=3usize)
        .flat_map(|n| (0..n).map(move |back| (n, back)))
        .flat_map(|(n, back)| {
            (0..1u32 << (2 * n))
                .map(move |bits| Lasso { labels: (0..n).map(|t| bits >> (2 * t) & 3).collect(), back })
        })
        .collect();
    for _ in 0..400 {
        let table = random_formula(&mut numbers, 4);
        let root = TypedId::new(table.len() - 1);
        let (formulas, roots) = normalise(&table, &[root]);
        for run in &runs {
            let (ours, theirs) = (lowered(&formulas, roots[0], run, 0), meant(&table, root, run, 0));
            assert_eq!(ours, theirs, "{table:?} on {:?} back to {}: {formulas:?}", run.labels, run.back);
        }
    }
}

fn atom(table: &mut Typed2) -> TypedId {
    table.push(Typed::In(Atom { robot: RobotId::new(0), region: RegionId::new(0) }))
}

#[test]
fn an_unknown_atom_is_neither_so_p_or_not_p_stays() {
    let mut table = Typed2::new();
    let p = atom(&mut table);
    let not = table.push(Typed::Not(p));
    let root = table.push(Typed::Or(vec![p, not]));
    let (formulas, roots) = normalise(&table, &[root]);
    assert!(matches!(formulas[roots[0]], Formula::Or(_)));
    let same = table.push(Typed::Iff(p, p));
    let (formulas, roots) = normalise(&table, &[same]);
    assert!(matches!(formulas[roots[0]], Formula::Or(_)), "p <-> p asks for a certain p or a certain not p");
}

#[test]
fn equal_parts_are_shared_and_iff_does_not_blow_up() {
    let mut table = Typed2::new();
    let mut last = atom(&mut table);
    for _ in 0..500 {
        let next = table.push(Typed::Next(last));
        last = table.push(Typed::Iff(last, next));
    }
    let (formulas, _) = normalise(&table, &[last]);
    assert!(formulas.nodes().len() < 6000, "{} nodes", formulas.nodes().len());
}

#[test]
fn depth_needs_no_stack() {
    let mut table = Typed2::new();
    let mut last = atom(&mut table);
    for _ in 0..200_000 {
        let not = table.push(Typed::Not(last));
        last = table.push(Typed::Next(not));
    }
    let (formulas, _) = normalise(&table, &[last]);
    assert_eq!(formulas.nodes().len(), 200_001);
}
