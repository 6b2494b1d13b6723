//! `NAME.cnf`: the Boolean part of one length in DIMACS, with what literals stand for in comments.
//!
//! It is satisfiable where nothing but the convex part may be in the way of a plan of the length.

use std::fmt::{self, Write};

use crate::abstraction::Abstraction;
use crate::back::{Artifact, Names, file_name};
use crate::encode::{Instance, number};
use crate::ir::Problem;

/// Writes the Boolean part of a problem's instance; the instance has one length, which is assumed.
pub fn write(problem: &Problem, abstraction: &Abstraction, instance: &Instance) -> Artifact {
    let names = Names::new(problem);
    let length = instance.lengths.first().map_or(0, |(length, _)| *length);
    let version = env!("CARGO_PKG_VERSION");
    let mut text = format!("c dosmc {version}: mission {}, length {length}\n", problem.name);
    let _ = writeln!(text, "c sha256 {}", problem.sha256);
    for (lit, meaning) in &instance.map {
        let _ = writeln!(text, "c map {} {}", number(*lit), names.meaning(meaning, abstraction));
    }
    let _ = writeln!(text, "p cnf {} {}", instance.variables, instance.clauses.len());
    for clause in instance.clauses.iter() {
        for lit in clause.iter() {
            let _ = write!(text, "{} ", number(*lit));
        }
        text.push_str("0\n");
    }
    Artifact { name: file_name(&problem.name, "cnf"), contents: text }
}

/// A formula as DIMACS says it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Formula {
    /// The number of variables, which are 1, 2, ….
    pub variables: i32,
    /// The clauses.
    pub clauses: Vec<Vec<i32>>,
    /// What literals stand for, from the comments.
    pub map: Vec<(i32, String)>,
}

/// Why a text is no DIMACS file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadError {
    /// The line, from 1.
    pub line: usize,
    /// What is wrong there.
    pub message: &'static str,
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.message)
    }
}

impl std::error::Error for ReadError {}

/// Reads a DIMACS file.
///
/// # Errors
/// The first line that does not belong there, and a number of clauses or variables that is not as
/// announced.
pub fn read(text: &str) -> Result<Formula, ReadError> {
    let mut formula = Formula::default();
    let mut announced = None;
    let mut clause = Vec::new();
    let mut lines = 0;
    for (index, line) in text.lines().enumerate() {
        lines = index + 1;
        let wrong = |message| ReadError { line: index + 1, message };
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match words[..] {
            ["c", "map", lit, ..] => {
                let lit: i32 = lit.parse().map_err(|_| wrong("a map names a literal"))?;
                formula.map.push((lit, words[3..].join(" ")));
            }
            [] | ["c", ..] => {}
            ["p", "cnf", variables, clauses] if announced.is_none() => {
                formula.variables = variables.parse().map_err(|_| wrong("no number of variables"))?;
                announced = Some(clauses.parse::<usize>().map_err(|_| wrong("no number of clauses"))?);
            }
            _ if announced.is_none() => return Err(wrong("the line `p cnf …` must come first")),
            _ => read_literals(&words, &mut clause, &mut formula).map_err(wrong)?,
        }
    }
    let wrong = |message| ReadError { line: lines, message };
    match announced {
        None => Err(wrong("there is no line `p cnf …`")),
        Some(_) if !clause.is_empty() => Err(wrong("the last clause has no end")),
        Some(count) if count != formula.clauses.len() => {
            Err(wrong("there are not as many clauses as announced"))
        }
        Some(_) => Ok(formula),
    }
}

/// Adds the literals of a line; a clause ends at 0.
fn read_literals(words: &[&str], clause: &mut Vec<i32>, formula: &mut Formula) -> Result<(), &'static str> {
    for word in words {
        match word.parse::<i32>() {
            Ok(0) => formula.clauses.push(std::mem::take(clause)),
            Ok(lit) if lit.checked_abs().is_some_and(|v| v <= formula.variables) => clause.push(lit),
            _ => return Err("a literal is a number of a variable, negated or not"),
        }
    }
    Ok(())
}
