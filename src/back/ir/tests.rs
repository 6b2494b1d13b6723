//! Tests of the IR file: there and back again, and what must be refused.

use proptest::prelude::*;

use super::{read, write};
use crate::entity::{EntityId, Table};
use crate::exact::{Rational, RationalMatrix};
use crate::geometry::{HalfSpace, Polytope};
use crate::ir::*;

/// Something of everything that the format can say.
fn everything() -> Problem {
    let mut problem = sample::relay();
    problem.sha256 = "00ff".into();
    problem.doc = "Two \"lines\"\n\u{1b}[31m \u{202e} é".into();
    let third = Rational::ratio(1, 3);
    let model = &mut problem.models[ModelId::new(0)];
    let n = model.n();
    model.enclosure = Some(Enclosure {
        a: RationalMatrix::from_element(n, n, third.clone()),
        b: RationalMatrix::from_element(n, 2, Rational::ZERO),
        c: vec![third.clone(); n],
    });
    let normal = (0..n + 2).map(|i| Rational::ratio(i as i64 - 2, 7)).collect();
    model.mixed_bounds.push(HalfSpace { normal, offset: Rational::from(3) });
    let triangle =
        Polytope::polygon(&[[0.0, 0.0], [1.0, 0.5], [-0.1, 2.0]].map(|p| sample::point(&p))).unwrap();
    let pieces = vec![
        Piece::Polytope(triangle),
        Piece::Ball { center: sample::point(&[1.0, 2.0]), spread: sample::point(&[0.5, 0.0]), radius: third },
    ];
    for kind in [BlockerKind::Obstacle, BlockerKind::OpaqueObstacle] {
        let shape = Shape { pieces: pieces.clone() };
        problem.blockers.push(Blocker { name: format!("{kind:?}"), doc: "A wall.".into(), kind, shape });
    }
    let connectivity = problem.connectivity.as_mut().unwrap();
    connectivity.range = Some(Range { length: Rational::ratio(21, 2), norm: Norm::Euclidean });
    problem.objective = Some(Objective::Effort);
    add_docs(&mut problem);
    add_formulas(&mut problem);
    problem
}

/// A documentation of its own for each entity.
fn add_docs(problem: &mut Problem) {
    let said = |id: &dyn std::fmt::Display| format!("What {id} is.");
    problem.regions.ids().for_each(|id| problem.regions[id].doc = said(&id));
    problem.bases.ids().for_each(|id| problem.bases[id].doc = said(&id));
    problem.robots.ids().for_each(|id| problem.robots[id].doc = said(&id));
    let model = &mut problem.models[ModelId::new(0)];
    model.doc = said(&"model");
    for signal in model.states.iter_mut().chain(&mut model.inputs) {
        (signal.doc, signal.unit) = (said(&signal.name), format!("m/{}", signal.name));
    }
}

fn add_formulas(problem: &mut Problem) {
    let formulas = &mut problem.formulas;
    let atom = Atom { robot: RobotId::new(1), region: RegionId::new(1) };
    let inside = formulas.intern(Formula::In(atom));
    let yes = formulas.intern(Formula::True);
    let no = formulas.intern(Formula::False);
    let next = formulas.intern(Formula::Next(inside));
    let either = formulas.intern(Formula::Or(vec![next, no]));
    let release = formulas.intern(Formula::Release(None, yes, either));
    let mut and = vec![release];
    for relation in [Relation::Equal, Relation::NotEqual, Relation::AtMost] {
        let sum = Comparison { terms: vec![(atom, -2)], relation, bound: -2 };
        and.push(formulas.intern(Formula::Compare(sum)));
    }
    let all = formulas.intern(Formula::And(and));
    problem.goals.push(Goal { name: "all".into(), formula: all });
}

/// In space, where lists of facets have no order.
fn in_space() -> Problem {
    let mut problem = sample::empty(vec![sample::integrators(1, 4.0, &[])], 12.0);
    let third =
        sample::model(RationalMatrix::identity(3, 3), RationalMatrix::identity(3, 3), &[(0.0, 0.0); 3], 1.0);
    problem.models = Table::from_iter([Model { position: vec![2, 0, 1], ..third }]);
    problem.robots[RobotId::new(0)].start = vec![Rational::ZERO; 3];
    problem.dimension = 3;
    let cube = |size: f64| Polytope::from_box(&sample::point(&[-size; 3]), &sample::point(&[size; 3]));
    problem.workspace = cube(9.0);
    let mut corners = cube(1.0).vertices;
    corners.push(sample::point(&[0.25, 0.0, 4.0]));
    let pieces = vec![Piece::Polytope(Polytope::hull(&corners).unwrap())];
    problem.blockers.push(Blocker {
        name: "J".into(),
        doc: String::new(),
        kind: BlockerKind::Jammer,
        shape: Shape { pieces },
    });
    problem
}

#[test]
fn nothing_is_lost() {
    for problem in [everything(), in_space(), sample::relay()] {
        validate(&problem).unwrap();
        let file = write(&problem);
        let back = read(&file.contents).unwrap();
        assert_eq!(back, problem);
        assert_eq!(write(&back), file, "one problem, one text");
    }
}

#[test]
fn the_file_reads_well() {
    insta::assert_snapshot!(write(&sample::relay()).contents);
}

/// One replacement in the text, and what the refusal must show.
#[track_caller]
fn refused(old: &str, new: &str, shows: &str) {
    let text = write(&everything()).contents;
    assert!(text.contains(old), "{old} is not in {text}");
    let error = read(&text.replacen(old, new, 1)).expect_err("must be refused").to_string();
    assert!(error.contains(shows), "{error:?} doesn't show {shows:?}");
}

#[test]
fn what_is_wrong_is_refused_with_its_place() {
    refused("\"dosm-ir\"", "\"dosm-plan\"", "$.format: expected \"dosm-ir\"");
    refused("\"version\": 1", "\"version\": 2", "$.version: only version 1 is known");
    refused("\"version\": 1", "\"version\": 1.0", "$.version: ");
    refused("\"dimension\": 2,", "\"dimension\": 2, \"dimension\": 2,", "$.dimension: the key occurs twice");
    refused("\"radius\": \"1.5\"", "\"a\": \"\", \"a\": \"\"", "$.mission.set.a: the key occurs twice");
    refused("\"objective\": \"effort\",", "", "missing field `objective`");
    refused("\"objective\": \"effort\"", "\"objective\": \"time\"", "unknown variant `time`");
    refused("\"step_s\": \"1/2\"", "\"step_s\": 0.5", "expected a string");
    refused("\"step_s\": \"1/2\"", "\"step_s\": \"2/4\"", "no exact number");
    refused("\"step_s\": \"1/2\"", "\"step_s\": \"-1/2\"", "step: is positive");
    refused("\"dimension\": 2", "\"dimension\": 3", "has a coordinate for each dimension");
    refused("\"model\": 0", "\"model\": 1", "$.robots[0].model: there is no entry 1: the table has 1");
    refused("\"model\": 0", "\"model\": 4294967296", "$.robots[0].model: ");
    refused("\"op\": \"in\", \"robot\": 0", "\"op\": \"in\", \"robot\": 9", "$.formulas[0].robot: ");
    refused("\"operands\": [0, 2]", "\"operands\": [0, 3]", "$.formulas[3].operands[1]: there is no entry 3");
    refused("\"operands\": [0, 2]", "\"operands\": [0, -2]", "invalid value");
    refused("\"op\": \"false\"", "\"op\": \"true\"", "says the same as entry");
    refused("\"formula\": 4", "\"formula\": 400", "$.goals[0].formula: there is no entry 400");
    refused("\"window\": [0, 6]", "\"window\": [0]", "invalid length");
    refused("\"window\": [0, 6]", "\"window\": [7, 6]", "f4: has a window that begins before it ends");
    refused("\"redundancy\": 0", "\"redundancy\": 4", "redundancy: is at most 3");
    refused("\"B\": [[", "\"B\": [[\"0\", \"0\", \"0\"], [", "$.models[0].B: expected 4 entries, found 5");
    refused("\"A\": [[\"1\", ", "\"A\": [[", "$.models[0].A[0]: expected 4 entries, found 3");
    refused("\"c\": [\"0\", ", "\"c\": [", "$.models[0].c: expected 4 entries, found 3");
    refused("\"c\": [\"1/3\", ", "\"c\": [", "$.models[0].enclosure.c: ");
    refused("\"position\": [0, 2]", "\"position\": [0, 9]", "model0: has a different state");
    refused("\"name\": \"J\"", "\"name\": \"left\"", "has a name of its own");
}

#[test]
fn a_polytope_must_be_one_set() {
    let text = write(&in_space()).contents;
    let mut value: serde_json::Value = serde_json::from_str(&text).unwrap();
    value["blockers"][0]["pieces"][0]["facets"].as_array_mut().unwrap().remove(2);
    let error = read(&value.to_string()).expect_err("a facet is missing").to_string();
    assert!(error.starts_with("$.blockers[0].pieces[0]: the facets are not those"), "{error}");
    // Clockwise lists whose facets still join their vertices.
    let mut value: serde_json::Value = serde_json::from_str(&write(&everything()).contents).unwrap();
    value["workspace"]["vertices"].as_array_mut().unwrap().reverse();
    let facets = value["workspace"]["facets"].as_array_mut().unwrap();
    facets.reverse();
    facets.rotate_left(1);
    let error = read(&value.to_string()).expect_err("it runs clockwise").to_string();
    assert!(error.starts_with("$.workspace: the facets"), "{error}");
}

#[test]
fn what_is_no_ir_at_all_is_refused() {
    let deep = "[".repeat(100_000);
    for text in
        ["", "null", "[]", "{}", "{\"format\": \"dosm-ir\", \"version\": 1}", "{} {}", &deep, "\u{feff}{}"]
    {
        assert!(read(text).is_err());
    }
    assert!(read(&(write(&everything()).contents + "]")).is_err());
}

#[test]
fn unknown_keys_are_ignored() {
    let problem = everything();
    let text = write(&problem).contents.replacen("\"step_s\"", "\"note\": [{}], \"step_s\"", 1);
    assert_eq!(read(&text).unwrap(), problem);
}

proptest! {
    #[test]
    fn no_text_is_too_hostile(text in "\\PC{0,200}") {
        let _ = read(&text);
    }

    #[test]
    fn no_change_of_a_file_is_too_hostile(
        at in 0.0..1.0f64, length in 0usize..40, put in "(\"-?[0-9/]{0,9}\"|[0-9]{1,20}|null|\\[|\\]|\\{|\\}|,|:|-|)",
    ) {
        let text = write(&everything()).contents;
        let floor = |i: usize| (0..=i.min(text.len())).rev().find(|i| text.is_char_boundary(*i)).unwrap_or(0);
        let from = floor((at * text.len() as f64) as usize);
        let changed = format!("{}{put}{}", &text[..from], &text[floor(from + length).max(from)..]);
        if let Ok(problem) = read(&changed) {
            prop_assert_eq!(validate(&problem), Ok(()));
        }
    }
}
