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

/// The regions of which a model's tube leaves nothing, among those that formulas ask for.
fn emptied(problem: &Problem, sets: &[Option<ErrorSet>]) -> BTreeSet<(ModelId, RegionId)> {
    let model = |atom: &Atom| (problem.robots[atom.robot].model, atom.region);
    let asked: BTreeSet<(ModelId, RegionId)> =
        problem.formulas.nodes().values().flat_map(atoms_in).map(|atom| model(&atom)).collect();
    let rooms: Vec<Vec<HalfSpace>> = sets
        .iter()
        .map(|set| set.as_ref().map_or_else(Vec::new, |s| shrunk(&problem.workspace, s.positions())))
        .collect();
    let fits = |(model, region): &(ModelId, RegionId)| {
        let Some(set) = &sets[model.index()] else { return true };
        let pieces = &problem.regions[*region].sure().pieces;
        pieces.iter().any(|piece| piece_has_room(piece, &rooms[model.index()], set.positions()))
    };
    asked.into_iter().filter(|pair| !fits(pair)).collect()
}

/// Whether some z within the shrunk workspace has z ⊕ Ω in the piece, a single z included.
fn piece_has_room(piece: &Piece, workspace: &[HalfSpace], errors: &Polytope) -> bool {
    let polytope = match piece {
        Piece::Polytope(polytope) => polytope,
        Piece::Ball { radius, .. } => return ball_has_room(radius, errors),
    };
    let half_spaces = [workspace, &shrunk(polytope, errors)].concat();
    let middle = polytope.middle();
    // One point is enough, and the middle nearly always is one.
    half_spaces.iter().all(|h| h.contains(&middle))
        || !matches!(Polytope::from_half_spaces(&half_spaces), Err(ShapeError::Empty))
}

/// Of a ball, only what can be told of Ω alone: its farthest vertices must fit.
fn ball_has_room(radius: &Rational, errors: &Polytope) -> bool {
    let middle = errors.middle();
    let square = |v: &Vec<Rational>| v.iter().zip(&middle).map(|(a, b)| (a - b) * (a - b)).sum::<Rational>();
    errors.vertices.iter().all(|v| square(v) <= radius * radius)
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

/// The atoms that a node itself asks to be in.
fn atoms_in(formula: &Formula) -> Vec<Atom> {
    match formula {
        Formula::In(atom) => vec![*atom],
        Formula::Compare(comparison) => comparison.terms.iter().map(|(atom, _)| *atom).collect(),
        _ => Vec::new(),
    }
}

/// All atoms that a formula and its operands ask to be in.
fn atoms_of(problem: &Problem, root: FormulaId) -> BTreeSet<Atom> {
    let (mut seen, mut open, mut atoms) = (BTreeSet::from([root]), vec![root], BTreeSet::new());
    while let Some(id) = open.pop() {
        let formula = &problem.formulas[id];
        atoms.extend(atoms_in(formula));
        let operands: &[FormulaId] = match formula {
            Formula::And(list) | Formula::Or(list) => list,
            Formula::Next(a) => &[*a],
            Formula::Until(_, a, b) | Formula::Release(_, a, b) => &[*a, *b],
            _ => &[],
        };
        open.extend(operands.iter().filter(|i| seen.insert(**i)));
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
        .with_help(needed(problem, region.sure(), errors));
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
