//! Regions that a tube shrinks to nothing, where a goal can't do without them.
//!
//! A robot is certainly in a region only when the whole of z ⊕ Ω lies in one of its pieces (and in
//! the workspace). Where no piece is large enough, that atom never holds; a goal that is then false
//! by its connectives alone is reported with the regions to blame. Anything that needs a search is
//! left to the search.

use std::collections::BTreeSet;

use crate::diag::Diagnostic;
use crate::entity::{EntityId, Table};
use crate::exact::{Rational, dot};
use crate::geometry::{HalfSpace, Polytope, ShapeError};
use crate::ir::{
    Atom, Comparison, Formula, FormulaId, Goal, ModelId, Piece, Problem, RegionId, Relation, Shape, Spans,
};

use super::ErrorSet;
use super::start::short;

/// Reports the goals that the tubes make impossible.
pub(super) fn inspect(
    problem: &Problem,
    spans: &Spans,
    sets: &[Option<ErrorSet>],
    found: &mut Vec<Diagnostic>,
) {
    let emptied = emptied(problem, sets);
    if emptied.is_empty() {
        return;
    }
    let impossible = |atom: &Atom| {
        let model = problem.robots[atom.robot].model;
        emptied.contains(&(model, atom.region))
    };
    let hopeless = hopeless(problem, &impossible);
    for (i, goal) in problem.goals.iter().enumerate() {
        if hopeless[goal.formula] {
            let span = spans.goals.get(i).copied().unwrap_or_default();
            let blamed: BTreeSet<Atom> =
                atoms_of(problem, goal.formula).into_iter().filter(|a| impossible(a)).collect();
            report(problem, spans, sets, goal, span, &blamed, found);
        }
    }
}

/// The regions of which a model's tube leaves nothing.
fn emptied(problem: &Problem, sets: &[Option<ErrorSet>]) -> BTreeSet<(ModelId, RegionId)> {
    let mut emptied = BTreeSet::new();
    for (model, set) in problem.models.ids().zip(sets) {
        let Some(set) = set else { continue };
        for (region, declared) in problem.regions.iter() {
            let fits = |piece: &Piece| piece_has_room(piece, &problem.workspace, set.positions());
            if !declared.shape.pieces.iter().any(fits) {
                emptied.insert((model, region));
            }
        }
    }
    emptied
}

/// Whether some z has z ⊕ Ω in both the piece and the workspace, a single z included.
fn piece_has_room(piece: &Piece, workspace: &Polytope, errors: &Polytope) -> bool {
    let mut half_spaces = shrunk(workspace, errors);
    match piece {
        Piece::Polytope(polytope) => half_spaces.extend(shrunk(polytope, errors)),
        // Of a ball, only what can be told of Ω alone: its farthest vertices must fit.
        Piece::Ball { radius, .. } => {
            let middle = errors.middle();
            let off =
                |v: &Vec<Rational>| v.iter().zip(&middle).map(|(a, b)| (a - b) * (a - b)).sum::<Rational>();
            return errors.vertices.iter().all(|v| off(v) <= radius * radius);
        }
    }
    !matches!(Polytope::from_half_spaces(&half_spaces), Err(ShapeError::Empty))
}

fn shrunk(outer: &Polytope, errors: &Polytope) -> Vec<HalfSpace> {
    let shrink =
        |f: &HalfSpace| HalfSpace { normal: f.normal.clone(), offset: &f.offset - errors.support(&f.normal) };
    outer.facets.iter().map(shrink).collect()
}

/// For each formula, whether it is false at every step because some atoms never hold certainly.
fn hopeless(problem: &Problem, impossible: &impl Fn(&Atom) -> bool) -> Table<FormulaId, bool> {
    let mut hopeless: Table<FormulaId, bool> = Table::new();
    for formula in problem.formulas.nodes().values() {
        let of = |id: &FormulaId| hopeless.get(*id).copied().unwrap_or(false);
        let value = match formula {
            Formula::False => true,
            Formula::True | Formula::Out(_) => false,
            Formula::In(atom) => impossible(atom),
            Formula::Compare(comparison) => out_of_reach(comparison, impossible),
            Formula::And(operands) => operands.iter().any(of),
            Formula::Or(operands) => operands.iter().all(of),
            Formula::Next(operand) => of(operand),
            Formula::Until(_, _, last) => of(last),
            // Only a window that begins at once asks for the second operand whatever the first does.
            Formula::Release(window, first, second) => {
                of(second) && (window.is_none_or(|(from, _)| from == 0) || of(first))
            }
        };
        hopeless.push(value);
    }
    hopeless
}

/// Whether a sum cannot get where it should: an atom that is never certain can count 0 at best.
fn out_of_reach(comparison: &Comparison, impossible: &impl Fn(&Atom) -> bool) -> bool {
    let counts = comparison.terms.iter().filter(|(atom, _)| !impossible(atom)).map(|(_, k)| i128::from(*k));
    let (least, most) = counts.fold((0, 0), |(lo, hi), k| (lo + k.min(0), hi + k.max(0)));
    let bound = i128::from(comparison.bound);
    match comparison.relation {
        Relation::AtLeast => most < bound,
        Relation::AtMost => least > bound,
        Relation::Equal => most < bound || least > bound,
        Relation::NotEqual => least == most && least == bound,
    }
}

/// All atoms that a formula asks to be in.
fn atoms_of(problem: &Problem, root: FormulaId) -> BTreeSet<Atom> {
    let (mut seen, mut open, mut atoms) = (BTreeSet::from([root]), vec![root], BTreeSet::new());
    while let Some(id) = open.pop() {
        match &problem.formulas[id] {
            Formula::True | Formula::False | Formula::Out(_) => {}
            Formula::In(atom) => {
                atoms.insert(*atom);
            }
            Formula::Compare(comparison) => atoms.extend(comparison.terms.iter().map(|(atom, _)| *atom)),
            Formula::And(list) | Formula::Or(list) => open.extend(list.iter().filter(|i| seen.insert(**i))),
            Formula::Next(a) => open.extend([a].into_iter().filter(|i| seen.insert(**i))),
            Formula::Until(_, a, b) | Formula::Release(_, a, b) => {
                open.extend([a, b].into_iter().filter(|i| seen.insert(**i)));
            }
        }
    }
    atoms
}

/// One diagnostic a region, with the widest tube of those that have to fit.
fn report(
    problem: &Problem,
    spans: &Spans,
    sets: &[Option<ErrorSet>],
    goal: &Goal,
    goal_span: crate::source::Span,
    blamed: &BTreeSet<Atom>,
    found: &mut Vec<Diagnostic>,
) {
    let regions: BTreeSet<RegionId> = blamed.iter().map(|a| a.region).collect();
    for id in regions {
        let region = &problem.regions[id];
        let robots: Vec<&Atom> = blamed.iter().filter(|a| a.region == id).collect();
        let mut errors = robots.iter().filter_map(|a| sets[problem.robots[a.robot].model.index()].as_ref());
        let Some(errors) = errors.next_back() else { continue };
        let names: Vec<String> =
            robots.iter().map(|a| format!("`{}`", problem.robots[a.robot].name)).collect();
        let span = spans.regions.get(id.index()).copied().unwrap_or_default();
        let diagnostic = Diagnostic::error(
            "dosm::abstraction::region_too_small",
            format!(
                "the tube leaves nothing of `{}`: {} can never be certain to be in it",
                region.name,
                names.join(", ")
            ),
            span,
            "no piece of this is as large as the tube",
        )
        .with_label(goal_span, format!("`{}` can't hold without it", goal.name))
        .with_help(needed(problem, &region.shape, errors));
        found.push(diagnostic);
    }
}

/// What size would do.
fn needed(problem: &Problem, shape: &Shape, errors: &ErrorSet) -> String {
    let two = Rational::from(2);
    let widths = (0..problem.dimension).map(|axis| format!("{} m", short(&(errors.half_width(axis) * &two))));
    let mut help = format!(
        "a piece within the workspace must hold the tube, which is {} wide; or reduce the disturbance",
        widths.collect::<Vec<_>>().join(" by ")
    );
    if shape.pieces.iter().any(|p| matches!(p, Piece::Ball { .. })) {
        let farthest = errors.positions().vertices.iter().map(|v| dot(v, v)).max().unwrap_or_default();
        help.push_str(&format!(" (a disc: radius {:.4} m)", farthest.to_f64_up().sqrt() + 5e-5));
    }
    help
}
