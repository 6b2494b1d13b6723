//! Each invariant, broken once.

use super::*;
use crate::entity::Table;
use crate::ir::sample::{self, exact, interval, point};
use crate::ir::{ModelId, RegionId, RobotId};

fn broken(change: impl FnOnce(&mut Problem)) -> Vec<String> {
    let mut problem = sample::relay();
    change(&mut problem);
    validate(&problem).unwrap_err().iter().map(Violation::to_string).collect()
}

fn model(problem: &mut Problem) -> &mut Model {
    &mut problem.models[ModelId::new(0)]
}

#[test]
fn the_sample_is_valid() {
    assert_eq!(validate(&sample::relay()), Ok(()));
}

#[test]
fn broken_sizes_are_found() {
    let rule = |change: fn(&mut Problem)| broken(change).join("; ");
    assert_eq!(rule(|p| p.horizon = (3, 2)), "horizon: is 1 ≤ from ≤ to");
    assert_eq!(rule(|p| p.step = Rational::ZERO), "step: is positive");
    assert!(rule(|p| p.dimension = 3).contains("workspace: has a coordinate for each dimension"));
    assert_eq!(rule(|p| model(p).c.clear()), "model0: has A, B and c of matching sizes");
    assert_eq!(
        rule(|p| model(p).position = vec![0, 0]),
        "model0: has a different state for each coordinate of the workspace"
    );
    assert_eq!(
        rule(|p| model(p).position = vec![0, 9]),
        "model0: has a different state for each coordinate of the workspace"
    );
    assert_eq!(rule(|p| model(p).input_bounds.clear()), "model0: has a bound for each input");
    assert_eq!(
        rule(|p| model(p).disturbance[0] = interval(1.0, 0.0)),
        "model0: has no interval with swapped ends"
    );
    assert_eq!(rule(|p| model(p).rejection = Some(Rational::ONE)), "model0: has a rejection between 0 and 1");
    assert_eq!(rule(|p| p.robots[RobotId::new(0)].start.clear()), "robot0: has a start value for each state");
    assert_eq!(rule(|p| p.robots[RobotId::new(1)].name = "left".into()), "left: has a name of its own");
    assert_eq!(rule(|p| p.bases = Table::new()), "connectivity: is required only where there is a base");
    assert_eq!(rule(|p| p.separation = Some(Rational::ZERO)), "separation: is positive");
}

#[test]
fn broken_shapes_are_found() {
    let piece = |piece: Piece| broken(|p| p.regions[RegionId::new(0)].shape.pieces = vec![piece]).join("; ");
    let flat = Piece::Ball { center: point(&[0.0, 0.0]), spread: point(&[0.0, 0.0]), radius: Rational::ZERO };
    assert_eq!(piece(flat), "region0: has a positive radius");
    let unit = Polytope::from_box(&point(&[0.0, 0.0]), &point(&[1.0, 1.0]));
    let mut turned = unit.clone();
    turned.facets.rotate_left(1);
    assert_eq!(piece(Piece::Polytope(turned)), "region0: has facet i between vertices i and i + 1");
    let mut moved = unit.clone();
    moved.facets[1].offset = exact(0.5);
    assert!(piece(Piece::Polytope(moved)).contains("has its vertices within its facets"));
}

#[test]
fn broken_formulas_are_found() {
    let node = |formula: Formula| {
        broken(|p| {
            p.formulas.intern(formula);
        })
        .join("; ")
    };
    let (robot, region) = (RobotId::new(0), RegionId::new(0));
    assert_eq!(node(Formula::Next(FormulaId::new(5))), "f5: comes after its operands");
    assert_eq!(
        node(Formula::Until(Some((2, 1)), FormulaId::new(0), FormulaId::new(0))),
        "f5: has a window that begins before it ends"
    );
    let atom = Atom { robot, region: RegionId::new(7) };
    assert_eq!(node(Formula::In(atom)), "f5: names a robot and a region of the tables");
    let twice = vec![(Atom { robot, region }, 1), (Atom { robot, region }, 0)];
    let comparison = Comparison { terms: twice, relation: crate::ir::Relation::Equal, bound: 1 };
    assert_eq!(
        node(Formula::Compare(comparison)),
        "f5: has its terms sorted, each atom once; f5: has no coefficient 0"
    );
    assert_eq!(broken(|p| p.goals[0].formula = FormulaId::new(40)), ["go: names a formula of the table"]);
}

#[test]
fn the_text_form_is_stable() {
    insta::assert_snapshot!(sample::relay().to_string());
}
