//! Instances as files: what is written is read back the same, and a plan that the planner finds
//! satisfies them.

mod common;
mod schema;

use std::path::Path;

use dosmc::abstraction::{Abstraction, Fineness};
use dosmc::back::{cnf, smc, smt2};
use dosmc::driver::{Answer, Encoding, Mission, Overrides};
use dosmc::encode::{Cone, Convex, Instance, Relation, Row, Variable, number};
use dosmc::exact::Rational;
use dosmc::plan::Plan;
use dosmc::source::SourceFile;
use rustsat::solvers::{Solve, SolveIncremental, SolverResult};
use rustsat::types::Lit;
use rustsat_batsat::BasicSolver;

use common::{load, missions, overrides, solve, source};

/// A mission with its instance for some lengths.
struct Written {
    source: SourceFile,
    mission: Mission,
    abstraction: Abstraction,
    instance: Instance,
}

impl Written {
    fn new(source: SourceFile, lengths: (usize, usize)) -> Written {
        Written::with(source, lengths, Encoding::HalfSpaces)
    }

    fn with(source: SourceFile, lengths: (usize, usize), encoding: Encoding) -> Written {
        let mission = load(&source, &overrides(&[], Some(lengths)));
        let mut abstraction = Abstraction::new(&mission.problem, &mission.tubes, 1.0);
        if encoding == Encoding::Paper {
            abstraction =
                abstraction.with_cells(&mission.problem, Fineness::Coarse).expect("a coarse partition");
        }
        let instance = Instance::new(&mission.problem, &mission.tubes, &abstraction, lengths);
        Written { instance: instance.expect("a small instance"), source, mission, abstraction }
    }

    fn smc(&self) -> smc::Document {
        let Mission { problem, tubes, .. } = &self.mission;
        smc::document(&self.source.text, problem, tubes, &self.abstraction, &self.instance)
    }
}

fn corpus() -> Vec<std::path::PathBuf> {
    let directories = ["examples", "examples/paper", "tests/missions/solve", "tests/missions/unsat"];
    directories.into_iter().flat_map(missions).collect()
}

#[test]
fn an_instance_file_reads_back_as_it_was_written() {
    let paper = missions("examples").into_iter().map(|path| (path, Encoding::Paper));
    for (path, encoding) in corpus().into_iter().map(|path| (path, Encoding::HalfSpaces)).chain(paper) {
        let written = Written::with(source(&path), (1, 2), encoding);
        let document = written.smc();
        let artifact = smc::write(&document);
        let read = smc::read(&artifact.contents).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        assert!(read == document, "{}: not all of the instance was written", path.display());
        assert!(smc::write(&read) == artifact, "{}: two texts for one instance", path.display());
        let value = serde_json::from_str(&artifact.contents).expect("JSON");
        schema::Closed::of("smc").assert_accepts(&value);
        assert_eq!(artifact.name, format!("{}.smc.json", written.mission.problem.name));
    }
}

#[test]
fn a_dimacs_file_reads_back_as_it_was_written() {
    for path in corpus() {
        let written = Written::new(source(&path), (2, 2));
        let Written { mission, abstraction, instance, .. } = &written;
        let read = cnf::read(&cnf::write(&mission.problem, abstraction, instance).contents);
        let read = read.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        assert_eq!(read.variables as usize, instance.variables);
        let clauses: Vec<Vec<i32>> =
            instance.clauses.iter().map(|c| c.iter().map(|l| number(*l)).collect()).collect();
        assert!(read.clauses == clauses, "{}: other clauses", path.display());
        let literals: Vec<i32> = instance.map.iter().map(|(lit, _)| number(*lit)).collect();
        assert_eq!(read.map.iter().map(|(lit, _)| *lit).collect::<Vec<_>>(), literals);
        let texts: std::collections::BTreeSet<&String> = read.map.iter().map(|(_, text)| text).collect();
        assert_eq!(texts.len(), literals.len(), "{}: two literals with one meaning", path.display());
    }
}

/// A row as an SMT-LIB file says it.
fn row_of(row: &Row, names: &[String]) -> smt2::ReadRow {
    let exact = |x: f64| Rational::from_f64(x).expect("a finite number");
    smt2::ReadRow {
        terms: row.terms.iter().map(|(v, x)| (exact(*x), names[*v].clone())).collect(),
        equal: row.relation == Relation::Equal,
        bound: exact(row.bound),
    }
}

/// A cone as an SMT-LIB file says it.
fn cone_of(cone: &Cone, names: &[String]) -> smt2::ReadCone {
    let exact = |x: f64| Rational::from_f64(x).expect("a finite number");
    let sum = |(terms, constant): &(Vec<(usize, f64)>, f64)| {
        (terms.iter().map(|(v, x)| (exact(*x), names[*v].clone())).collect(), exact(*constant))
    };
    smt2::ReadCone { sums: cone.sums.iter().map(sum).collect(), bound: exact(cone.bound) }
}

#[test]
fn an_smt_lib_file_says_exactly_the_instance() {
    for path in corpus() {
        let written = Written::new(source(&path), (2, 2));
        let instance = &written.instance;
        let names = written.smc().convex.variables;
        let text = smt2::write(&written.mission.problem, instance).contents;
        let script = smt2::read(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let cones = instance.convex.blocks.iter().any(|b| !b.cones.is_empty());
        assert_eq!(script.logic, if cones { "QF_NRA" } else { "QF_LRA" });
        assert_eq!(script.reals, names);
        assert_eq!(script.booleans.len(), instance.variables);
        let literal = |lit: Lit| (format!("b{}", number(lit).abs()), number(lit) > 0);
        let clauses = instance.clauses.iter().map(|clause| smt2::Assertion {
            literals: clause.iter().map(|l| literal(*l)).collect(),
            row: None,
            cone: None,
        });
        let rows = instance.convex.blocks.iter().flat_map(|block| {
            let names = &names;
            let literals = move || block.literal.iter().map(|l| literal(!*l)).collect();
            let rows = block.rows.iter().map(move |row| smt2::Assertion {
                literals: literals(),
                row: Some(row_of(row, names)),
                cone: None,
            });
            let cones = block.cones.iter().map(move |cone| smt2::Assertion {
                literals: literals(),
                row: None,
                cone: Some(cone_of(cone, names)),
            });
            rows.chain(cones)
        });
        let all: Vec<smt2::Assertion> = clauses.chain(rows).collect();
        assert!(script.assertions == all, "{}: other assertions", path.display());
    }
}

/// The numbers of a plan in the order of an instance's variables, the closing state included.
fn values(convex: &Convex, plan: &Plan) -> Vec<f64> {
    let value = |variable: &Variable| match *variable {
        Variable::State { robot, step, state } => {
            let step = if step > plan.length { plan.loop_start } else { step };
            plan.robots[dosmc::entity::EntityId::index(robot)].z[step][state]
        }
        Variable::Input { robot, step, input } => {
            plan.robots[dosmc::entity::EntityId::index(robot)].v[step][input]
        }
    };
    convex.variables.iter().map(value).collect()
}

fn holds(row: &Row, values: &[f64]) -> bool {
    let sum: f64 = row.terms.iter().map(|(v, x)| x * values[*v]).sum();
    let size: f64 = row.terms.iter().map(|(v, x)| (x * values[*v]).abs()).sum();
    let off = if row.relation == Relation::Equal { (sum - row.bound).abs() } else { sum - row.bound };
    off <= 1e-9 * (1.0 + size)
}

fn holds_cone(cone: &Cone, values: &[f64]) -> bool {
    let sum = |(terms, constant): &(Vec<(usize, f64)>, f64)| {
        terms.iter().map(|(v, x)| x * values[*v]).sum::<f64>() + constant
    };
    cone.sums.iter().map(|s| sum(s).powi(2)).sum::<f64>().sqrt() <= cone.bound * (1.0 + 1e-9)
}

/// Whether the Boolean part has a model with these literals.
fn satisfiable(instance: &Instance, assumptions: &[Lit]) -> bool {
    let mut solver = BasicSolver::default();
    solver.add_cnf(instance.clauses.clone()).expect("enough memory");
    solver.solve_assumps(assumptions).expect("an answer") == SolverResult::Sat
}

/// The planner's plan of a mission with the instance of its length.
fn planned(path: &Path) -> Option<(Written, Box<Plan>)> {
    let Answer::Plan { plan, .. } = solve(&load(&source(path), &Overrides::default())) else { return None };
    Some((Written::new(source(path), (plan.length, plan.length)), plan))
}

#[test]
fn a_plan_satisfies_the_instance() {
    let (mut satisfied, mut others) = (0, Vec::new());
    for path in corpus() {
        let Some((written, plan)) = planned(&path) else { continue };
        let instance = &written.instance;
        let values = values(&instance.convex, &plan);
        let mut assumptions: Vec<Lit> = instance.lengths.iter().map(|(_, lit)| *lit).collect();
        for block in &instance.convex.blocks {
            let all = block.rows.iter().all(|row| holds(row, &values))
                && block.cones.iter().all(|cone| holds_cone(cone, &values));
            match block.literal {
                None => assert!(all, "{}: the plan violates {}", path.display(), block.name),
                Some(lit) if !all => assumptions.push(!lit),
                Some(_) => {}
            }
        }
        match satisfiable(instance, &assumptions) {
            true => satisfied += 1,
            false => others.push(written.mission.problem.name.clone()),
        }
    }
    // A link or move that the search accepted along some other direction is not in the file.
    assert!(satisfied >= 30 && others.len() * 5 <= satisfied, "{satisfied} satisfied, not so {others:?}");
}

#[test]
fn a_whole_horizon_has_all_its_lengths() {
    let written = Written::new(source("tests/missions/solve/reach.dosm"), (1, 6));
    let Answer::Plan { plan, .. } = solve(&written.mission) else { panic!("there is a plan") };
    let lengths: Vec<usize> = written.instance.lengths.iter().map(|(length, _)| *length).collect();
    assert_eq!(lengths, [1, 2, 3, 4, 5, 6]);
    let both = |a: usize, b: usize| {
        let lit = |length: usize| written.instance.lengths[length - 1].1;
        satisfiable(&written.instance, &[lit(a), lit(b)])
    };
    assert!(both(plan.length, plan.length));
    assert!(!both(plan.length, plan.length - 1), "two lengths at once");
}

/// The rows that a literal switches on, with the names of variables.
fn switched(document: &smc::Document, literal: i32) -> Vec<(Vec<(&str, f64)>, f64)> {
    let blocks = document.convex.blocks.iter().filter(|b| b.literal == Some(literal));
    let named = |row: &smc::document::Row| {
        let smc::document::Row::Linear(row) = row else { panic!("a cone is no literal's meaning") };
        let terms = row.terms.iter().map(|(v, x)| (document.convex.variables[*v].as_str(), *x));
        (terms.collect(), row.bound)
    };
    blocks.flat_map(|b| b.rows.iter().map(named)).collect()
}

#[test]
fn the_map_says_what_the_rows_do() {
    let mut seen = [0, 0, 0, 0];
    for path in corpus() {
        let document = Written::new(source(&path), (2, 2)).smc();
        let at = |robot: &str, step: usize| format!("{robot}.z[{step}].");
        for entry in &document.map.half_spaces {
            let half_space = &document.half_spaces[entry.half_space];
            let rows = switched(&document, entry.literal);
            let [(terms, bound)] = &rows[..] else { panic!("{}: {rows:?}", path.display()) };
            assert_eq!(*bound, half_space.offset);
            assert!(terms.iter().all(|(name, _)| name.starts_with(&at(&entry.robot, entry.step))));
            // A model may declare its coordinates in another order than the workspace's.
            let mut coefficients: Vec<f64> = terms.iter().map(|(_, x)| *x).collect();
            let mut direction: Vec<f64> =
                half_space.direction.iter().copied().filter(|x| *x != 0.0).collect();
            coefficients.sort_by(f64::total_cmp);
            direction.sort_by(f64::total_cmp);
            assert_eq!(coefficients, direction);
            seen[0] += 1;
        }
        for face in &document.map.faces {
            let rows = switched(&document, face.literal);
            assert_eq!(rows.len(), 2);
            for (step, (terms, bound)) in (face.step..).zip(&rows) {
                // sign · (first − second) ≥ −bound
                let [first, second] = face.pair.each_ref().map(|robot| {
                    terms.iter().find(|(name, _)| name.starts_with(&at(robot, step))).map(|(_, x)| *x)
                });
                let sign = f64::from(face.sign);
                assert_eq!((terms.len(), first, second), (2, Some(-sign), Some(sign)), "{}", path.display());
                assert!(*bound < 0.0);
            }
            seen[1] += 1;
        }
        for near in document.map.near.iter().flatten() {
            let rows = switched(&document, near.literal);
            let [(terms, bound)] = &rows[..] else { panic!("{}: {rows:?}", path.display()) };
            let axis = near.normal.iter().position(|x| *x != 0.0).expect("a normal");
            let named =
                |robot: &String, x: f64| (format!("{}p{}", at(robot, near.step), ["x", "y", "z"][axis]), x);
            let signs = near.robots.iter().zip([near.normal[axis], -near.normal[axis]]);
            let expected: Vec<(String, f64)> = signs.map(|(robot, x)| named(robot, x)).collect();
            let terms: Vec<(String, f64)> = terms.iter().map(|(name, x)| (name.to_string(), *x)).collect();
            assert_eq!((terms, *bound), (expected, near.offset), "{}", path.display());
            seen[3] += 1;
        }
        for entry in &document.map.loops {
            for (terms, bound) in switched(&document, entry.literal) {
                let [(there, x), (here, y)] = terms[..] else { panic!("{}: {terms:?}", path.display()) };
                assert!(there.contains(&format!(".z[{}].", entry.loop_start)));
                assert!(here.contains(&format!(".z[{}].", entry.length + 1)));
                assert_eq!((x, y, bound), (-1.0, 1.0, 0.0));
            }
            seen[2] += 1;
        }
    }
    assert!(seen.iter().all(|count| *count > 25), "{seen:?}");
}

/// Numbers rounded to what does not depend on the machine's last digits.
fn rounded(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let end = start
            + rest[start..]
                .find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | 'e')))
                .unwrap_or(rest.len() - start);
        let word = &rest[start..end];
        out.push_str(&rest[..start]);
        match word.parse::<f64>() {
            Ok(value) if word.len() > 6 && word.contains('.') => out.push_str(&format!("~{value:.3e}")),
            _ => out.push_str(word),
        }
        rest = &rest[end..];
    }
    out + rest
}

/// The smallest mission with a jammer and a base.
const SMALL: &str = "\
dosm 1
mission small
workspace box (0, 0) .. (4, 3)
region shelf = box (2, 0.5) .. (3.5, 2.5)
jammer noise = box (1, 2) .. (1.5, 3)
base tower at (0.5, 0.5)
dynamics Cart {
  step 1 s
  integrator 1
  bound vx, vy in [-2, 2] m/s
  disturbance px, py in [-0.125, 0.125] m
}
robot cart: Cart at (0.75, 0.75)
goal there: eventually cart in shelf
";

#[test]
fn the_formats_of_a_small_mission() {
    let written = Written::new(SourceFile::new("small.dosm", SMALL), (1, 1));
    insta::assert_snapshot!("small_smc", rounded(&smc::write(&written.smc()).contents));
    let one = Written { instance: written.instance.clone().assuming_first_length(), ..written };
    let problem = &one.mission.problem;
    let dimacs = cnf::write(problem, &one.abstraction, &one.instance).contents;
    insta::assert_snapshot!("small_cnf", rounded(&dimacs));
    insta::assert_snapshot!("small_smt2", rounded(&smt2::write(problem, &one.instance).contents));
}
