//! A reader of the SMT-LIB that is written here: declarations, clauses, linear rows and cones.

use std::fmt;

use crate::exact::Rational;

/// The deepest nesting of brackets that is read.
const DEEPEST: usize = 20;

/// A script.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Script {
    /// The logic.
    pub logic: String,
    /// The Boolean constants, in order.
    pub booleans: Vec<String>,
    /// The real constants, in order.
    pub reals: Vec<String>,
    /// The assertions, in order.
    pub assertions: Vec<Assertion>,
}

/// A clause that may end in a row: some literal is true, or the row holds, linear or of a cone.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Assertion {
    /// Boolean constants, each with whether it stands unnegated.
    pub literals: Vec<(String, bool)>,
    /// The row, if there is one.
    pub row: Option<Row>,
    /// The row of a cone, if there is one.
    pub cone: Option<Cone>,
}

/// Σ sum² ≤ bound².
#[derive(Clone, Debug, PartialEq)]
pub struct Cone {
    /// The sums: terms, and a constant.
    pub sums: Vec<(Vec<(Rational, String)>, Rational)>,
    /// The bound.
    pub bound: Rational,
}

/// Σ coefficient · constant ⋈ bound.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The terms as written.
    pub terms: Vec<(Rational, String)>,
    /// Whether both sides are equal; at most otherwise.
    pub equal: bool,
    /// The right-hand side.
    pub bound: Rational,
}

/// Why a text is no such script.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadError {
    /// The number of the command, from 1.
    pub command: usize,
    /// What is wrong with it.
    pub message: String,
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "command {}: {}", self.command, self.message)
    }
}

impl std::error::Error for ReadError {}

/// Reads a script.
///
/// # Errors
/// The first command that is none of those that [`write`](super::write) writes.
pub fn read(text: &str) -> Result<Script, ReadError> {
    let mut tokens = Tokens { rest: text };
    let mut script = Script::default();
    let mut count = 0;
    while let Some(token) = tokens.next() {
        count += 1;
        let command = tokens.expression(token, 0).and_then(|e| take(&e, &mut script));
        command.map_err(|message| ReadError { command: count, message })?;
    }
    Ok(script)
}

/// A symbol or a list.
#[derive(Clone, Debug)]
enum Expression<'a> {
    Symbol(&'a str),
    List(Vec<Expression<'a>>),
}

use Expression::{List, Symbol};

struct Tokens<'a> {
    rest: &'a str,
}

impl<'a> Iterator for Tokens<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        loop {
            self.rest = self.rest.trim_start();
            let Some(comment) = self.rest.strip_prefix(';') else { break };
            self.rest = comment.split_once('\n').map_or("", |(_, rest)| rest);
        }
        let length = match self.rest.chars().next()? {
            '(' | ')' => 1,
            // Quoted symbols keep their bars here, so that they differ from plain ones.
            '|' => self.rest[1..].find('|').map_or(self.rest.len(), |end| end + 2),
            _ => self
                .rest
                .find(|c: char| c.is_whitespace() || matches!(c, '(' | ')' | ';' | '|'))
                .unwrap_or(self.rest.len()),
        };
        let (token, rest) = self.rest.split_at(length);
        self.rest = rest;
        Some(token)
    }
}

impl<'a> Tokens<'a> {
    fn expression(&mut self, token: &'a str, depth: usize) -> Result<Expression<'a>, String> {
        match token {
            "(" if depth >= DEEPEST => Err("too deeply nested".into()),
            "(" => {
                let mut items = Vec::new();
                loop {
                    match self.next() {
                        Some(")") => return Ok(List(items)),
                        Some(token) => items.push(self.expression(token, depth + 1)?),
                        None => return Err("a bracket is not closed".into()),
                    }
                }
            }
            ")" => Err("a bracket is not opened".into()),
            symbol => Ok(Symbol(symbol)),
        }
    }
}

fn take(command: &Expression<'_>, script: &mut Script) -> Result<(), String> {
    let List(items) = command else { return Err("a command is a list".into()) };
    match &items[..] {
        [Symbol("set-logic"), Symbol(logic)] => script.logic = (*logic).into(),
        [Symbol("set-info"), Symbol(_), Symbol(_)] | [Symbol("check-sat")] => {}
        [Symbol("declare-const"), Symbol(name), Symbol("Bool")] => script.booleans.push((*name).into()),
        [Symbol("declare-const"), Symbol(name), Symbol("Real")] => script.reals.push(unquoted(name)),
        [Symbol("assert"), term] => script.assertions.push(assertion(term)?),
        _ => return Err("an unknown command".into()),
    }
    Ok(())
}

fn unquoted(name: &str) -> String {
    name.trim_matches('|').into()
}

fn assertion(term: &Expression<'_>) -> Result<Assertion, String> {
    let clause =
        |literals: Result<Vec<_>, String>| Ok(Assertion { literals: literals?, row: None, cone: None });
    match term {
        Symbol("false") => Ok(Assertion::default()),
        Symbol(_) => clause(literal(term).map(|l| vec![l])),
        List(items) => match &items[..] {
            [Symbol("not"), _] => clause(literal(term).map(|l| vec![l])),
            [Symbol("or"), literals @ ..] => clause(literals.iter().map(literal).collect()),
            [Symbol("=>"), condition, row] => {
                let (name, sign) = literal(condition)?;
                constraint(vec![(name, !sign)], row)
            }
            _ => constraint(Vec::new(), term),
        },
    }
}

/// A row under literals. That of a cone has a square on its right-hand side.
fn constraint(literals: Vec<(String, bool)>, term: &Expression<'_>) -> Result<Assertion, String> {
    let cone = match term {
        List(items) => {
            matches!(items.last(), Some(List(square)) if matches!(square[..], [Symbol("*"), _, _]))
        }
        Symbol(_) => false,
    };
    if cone {
        Ok(Assertion { literals, row: None, cone: Some(self::cone(term)?) })
    } else {
        Ok(Assertion { literals, row: Some(row(term)?), cone: None })
    }
}

fn cone(term: &Expression<'_>) -> Result<Cone, String> {
    let List(items) = term else { return Err("a cone is a list".into()) };
    let [Symbol("<="), List(squares), List(bound)] = &items[..] else {
        return Err("a cone compares squares by <=".into());
    };
    let (Some(Symbol("+")), [Symbol("*"), bound, again]) = (squares.first(), &bound[..]) else {
        return Err("a cone compares added squares with a square".into());
    };
    let bound = (number(bound)?, number(again)?);
    if bound.0 != bound.1 {
        return Err("a bound is multiplied by itself".into());
    }
    Ok(Cone { sums: squares[1..].iter().map(square).collect::<Result<_, _>>()?, bound: bound.0 })
}

fn square(term: &Expression<'_>) -> Result<(Vec<(Rational, String)>, Rational), String> {
    let List(items) = term else { return Err("a square is a list".into()) };
    let [Symbol("*"), sum, again] = &items[..] else { return Err("a square is a product".into()) };
    let sums = (affine(sum)?, affine(again)?);
    if sums.0 == sums.1 { Ok(sums.0) } else { Err("a sum is multiplied by itself".into()) }
}

/// Terms with a constant behind them.
fn affine(term: &Expression<'_>) -> Result<(Vec<(Rational, String)>, Rational), String> {
    match term {
        List(items) if matches!(items.first(), Some(Symbol("+"))) => {
            let (constant, terms) = items[1..].split_last().ok_or("an empty sum")?;
            Ok((terms.iter().map(product).collect::<Result<_, _>>()?, number(constant)?))
        }
        _ => Err("a sum ends in a constant".into()),
    }
}

fn literal(term: &Expression<'_>) -> Result<(String, bool), String> {
    match term {
        Symbol(name) => Ok(((*name).into(), true)),
        List(items) => match &items[..] {
            [Symbol("not"), Symbol(name)] => Ok(((*name).into(), false)),
            _ => Err("a literal is a constant or its negation".into()),
        },
    }
}

fn row(term: &Expression<'_>) -> Result<Row, String> {
    let List(items) = term else { return Err("a row is a list".into()) };
    let [Symbol(relation @ ("=" | "<=")), sum, bound] = &items[..] else {
        return Err("a row compares a sum with a number by = or <=".into());
    };
    Ok(Row { terms: self::sum(sum)?, equal: *relation == "=", bound: number(bound)? })
}

fn sum(term: &Expression<'_>) -> Result<Vec<(Rational, String)>, String> {
    match term {
        Symbol("0.0") => Ok(Vec::new()),
        List(items) if matches!(items.first(), Some(Symbol("+"))) => items[1..].iter().map(product).collect(),
        _ => Ok(vec![product(term)?]),
    }
}

fn product(term: &Expression<'_>) -> Result<(Rational, String), String> {
    match term {
        Symbol(name) => Ok((Rational::from(1), unquoted(name))),
        List(items) => match &items[..] {
            [Symbol("*"), factor, Symbol(name)] => Ok((number(factor)?, unquoted(name))),
            _ => Err("a term is a constant or a number times one".into()),
        },
    }
}

fn number(term: &Expression<'_>) -> Result<Rational, String> {
    let natural = |text: &str| {
        let digits =
            text.strip_suffix(".0").filter(|d| !d.is_empty() && d.bytes().all(|b| b.is_ascii_digit()));
        digits.and_then(|d| Rational::from_decimal(d, 0)).ok_or_else(|| format!("`{text}` is no number"))
    };
    match term {
        Symbol(text) => natural(text),
        List(items) => match &items[..] {
            [Symbol("-"), size] => Ok(-number(size)?),
            [Symbol("/"), Symbol(above), Symbol(below)] => {
                natural(above)?.checked_div(&natural(below)?).ok_or_else(|| "a division by zero".into())
            }
            _ => Err("an unknown number".into()),
        },
    }
}
