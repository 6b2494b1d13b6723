//! `NAME.smt2`: the whole instance of one length in SMT-LIB 2, for any solver of real arithmetic:
//! linear, but for the cones of a Euclidean range.
//!
//! The file is satisfiable just when a plan of the length exists whose separating planes have the
//! directions at hand. All numbers are exactly the doubles of the search, written as fractions, and
//! all inequalities are non-strict.

mod read;

pub use read::{Assertion, Cone as ReadCone, ReadError, Row as ReadRow, Script, read};

use std::fmt::Write;

use crate::back::{Artifact, Names, dyadic, file_name};
use crate::encode::{self, Block, Cone, Instance, Relation, Row};
use crate::ir::Problem;

/// Writes the instance of a problem's length; the instance has one length, which is assumed.
pub fn write(problem: &Problem, instance: &Instance) -> Artifact {
    let names = Names::new(problem);
    let mut text = header(problem, instance);
    for index in 0..instance.variables {
        let _ = writeln!(text, "(declare-const b{} Bool)", index + 1);
    }
    for variable in &instance.convex.variables {
        let _ = writeln!(text, "(declare-const |{}| Real)", names.variable(variable));
    }
    for clause in instance.clauses.iter() {
        let literals: Vec<String> = clause.iter().map(|l| literal(encode::number(*l))).collect();
        let _ = match &literals[..] {
            [] => writeln!(text, "(assert false)"),
            [only] => writeln!(text, "(assert {only})"),
            _ => writeln!(text, "(assert (or {}))", literals.join(" ")),
        };
    }
    for block in &instance.convex.blocks {
        write_block(block, instance, &names, &mut text);
    }
    text.push_str("(check-sat)\n");
    Artifact { name: file_name(&problem.name, "smt2"), contents: text }
}

fn header(problem: &Problem, instance: &Instance) -> String {
    let length = instance.lengths.first().map_or(0, |(length, _)| *length);
    format!(
        "; dosmc {}: mission {}, length {length}\n\
         ; b1 ... are the Boolean variables of {}.cnf, whose comments say what they stand for.\n\
         (set-logic {})\n\
         (set-info :source |mission sha256 {}|)\n",
        env!("CARGO_PKG_VERSION"),
        problem.name,
        problem.name,
        if instance.convex.blocks.iter().all(|b| b.cones.is_empty()) { "QF_LRA" } else { "QF_NRA" },
        problem.sha256,
    )
}

fn literal(number: i32) -> String {
    if number > 0 { format!("b{number}") } else { format!("(not b{})", -i64::from(number)) }
}

/// Each row of a block as an assertion of its own.
fn write_block(block: &Block, instance: &Instance, names: &Names<'_>, text: &mut String) {
    let _ = writeln!(text, "; {}", block.name);
    let rows = block.rows.iter().map(|row| written(row, instance, names));
    for row in rows.chain(block.cones.iter().map(|cone| written_cone(cone, instance, names))) {
        let _ = match block.literal {
            None => writeln!(text, "(assert {row})"),
            Some(lit) => writeln!(text, "(assert (=> {} {row}))", literal(encode::number(lit))),
        };
    }
}

/// Σ s² ≤ r², which has no root in it.
fn written_cone(cone: &Cone, instance: &Instance, names: &Names<'_>) -> String {
    let square = |(terms, constant): &(Vec<(usize, f64)>, f64)| {
        let mut sum = terms.iter().map(|t| term(t, instance, names)).collect::<Vec<_>>();
        sum.push(number(*constant));
        let sum = added(&sum);
        format!("(* {sum} {sum})")
    };
    let squares: Vec<String> = cone.sums.iter().map(square).collect();
    let bound = number(cone.bound);
    format!("(<= {} (* {bound} {bound}))", added(&squares))
}

fn term(&(variable, coefficient): &(usize, f64), instance: &Instance, names: &Names<'_>) -> String {
    let name = names.variable(&instance.convex.variables[variable]);
    if coefficient == 1.0 { format!("|{name}|") } else { format!("(* {} |{name}|)", number(coefficient)) }
}

fn added(terms: &[String]) -> String {
    match terms {
        [] => "0.0".into(),
        [only] => only.clone(),
        _ => format!("(+ {})", terms.join(" ")),
    }
}

fn written(row: &Row, instance: &Instance, names: &Names<'_>) -> String {
    let terms: Vec<String> = row.terms.iter().map(|t| term(t, instance, names)).collect();
    let sum = added(&terms);
    let relation = match row.relation {
        Relation::Equal => "=",
        Relation::AtMost => "<=",
    };
    format!("({relation} {sum} {})", number(row.bound))
}

/// A double as an exact SMT-LIB term.
fn number(value: f64) -> String {
    let (numerator, denominator) = dyadic(value);
    let digits = numerator.trim_start_matches('-');
    let size =
        if denominator == "1" { format!("{digits}.0") } else { format!("(/ {digits}.0 {denominator}.0)") };
    if numerator.starts_with('-') { format!("(- {size})") } else { size }
}
