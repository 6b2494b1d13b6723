//! Constant expressions: exact values with dimensions.
//!
//! In `where` an expression may also hold coordinates or states, so a value is affine in general.
//! Evaluation runs on a stack of its own: an expression may be thousands of levels deep.

use crate::check::names::Kind;
use crate::check::{Checker, Constant, Entry, messages};
use crate::diag::Reported;
use crate::exact::Rational;
use crate::ir::RobotId;
use crate::quantity::{self, Dimension, Unit, UnitError};
use crate::source::Span;
use crate::syntax::ast::{self, BinaryOp, Expr, ExprKind};
use crate::syntax::words::FUNCTIONS;

/// A value: number + Σ slope · coordinate, in coherent SI.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Value {
    /// The constant part.
    pub(super) number: Rational,
    /// The factor of each coordinate in scope; empty for a constant.
    pub(super) slopes: Vec<Rational>,
    /// What it measures.
    pub(super) dimension: Dimension,
}

impl Value {
    /// A constant.
    pub(super) fn constant(number: Rational, dimension: Dimension) -> Value {
        Value { number, slopes: Vec::new(), dimension }
    }

    fn is_constant(&self) -> bool {
        self.slopes.iter().all(Rational::is_zero)
    }

    fn in_range(&self) -> bool {
        std::iter::once(&self.number).chain(&self.slopes).all(quantity::in_range)
    }

    fn map(self, f: impl Fn(Rational) -> Rational) -> Value {
        Value { number: f(self.number), slopes: self.slopes.into_iter().map(f).collect(), ..self }
    }

    fn zip(self, other: Value, f: impl Fn(Rational, Rational) -> Rational) -> Value {
        let length = self.slopes.len().max(other.slopes.len());
        let pad = |mut slopes: Vec<Rational>| {
            slopes.resize(length, Rational::ZERO);
            slopes
        };
        let slopes = pad(self.slopes).into_iter().zip(pad(other.slopes)).map(|(a, b)| f(a, b)).collect();
        Value { number: f(self.number, other.number), slopes, dimension: self.dimension }
    }
}

/// What a bound variable stands for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Binding {
    /// An index of a family or a quantifier.
    Index(i64),
    /// A robot.
    Robot(RobotId),
    /// Nothing, because its set or range is wrong or empty.
    Unknown(Reported),
}

/// The names in scope besides the mission's own.
#[derive(Clone, Default, Debug)]
pub(super) struct Scope {
    /// Bound variables, innermost last.
    pub(super) bindings: Vec<(String, Binding)>,
    /// Coordinates or states and inputs that an inequality may mention.
    pub(super) coordinates: Vec<(String, Dimension)>,
}

impl Scope {
    /// The innermost binding of a name.
    pub(super) fn binding(&self, name: &str) -> Option<Binding> {
        self.bindings.iter().rev().find(|(n, _)| n == name).map(|(_, b)| *b)
    }

    fn coordinate(&self, name: &str) -> Option<Value> {
        let index = self.coordinates.iter().position(|(n, _)| n == name)?;
        let mut slopes = vec![Rational::ZERO; self.coordinates.len()];
        slopes[index] = Rational::ONE;
        Some(Value { number: Rational::ZERO, slopes, dimension: self.coordinates[index].1 })
    }
}

/// A step of the evaluation.
enum Step<'e> {
    Visit(&'e Expr),
    Apply(&'e Expr),
}

impl Checker<'_> {
    /// The value of an expression.
    pub(super) fn evaluate(&mut self, expr: &Expr, scope: &Scope) -> Result<Value, Reported> {
        let mut steps = vec![Step::Visit(expr)];
        let mut values: Vec<Value> = Vec::new();
        while let Some(step) = steps.pop() {
            match step {
                Step::Visit(expr) => {
                    steps.push(Step::Apply(expr));
                    steps.extend(operands(expr).into_iter().rev().map(Step::Visit));
                }
                Step::Apply(expr) => {
                    let arguments = values.split_off(values.len() - operands(expr).len());
                    let value = self.apply(expr, arguments, scope)?;
                    if !value.in_range() {
                        return Err(self.report(messages::number_out_of_range(expr.span)));
                    }
                    self.note_value(expr, &value);
                    values.push(value);
                }
            }
        }
        let reported = || self.report(messages::number_out_of_range(expr.span));
        values.pop().ok_or_else(reported)
    }

    /// A value in coherent SI of the dimension that its place expects; a bare number takes its unit.
    pub(super) fn quantity(
        &mut self,
        expr: &Expr,
        scope: &Scope,
        expected: Dimension,
    ) -> Result<Rational, Reported> {
        self.quantity_in(expr, None, scope, expected)
    }

    /// The same with a unit behind the bracket that the expression stands in.
    pub(super) fn quantity_in(
        &mut self,
        expr: &Expr,
        unit: Option<&ast::Unit>,
        scope: &Scope,
        expected: Dimension,
    ) -> Result<Rational, Reported> {
        let value = self.evaluate(expr, scope)?;
        let number = match unit {
            None => self.expect_dimension(value, expr.span, expected)?,
            Some(unit) => {
                let value = self.with_unit(value, unit, expr.span)?;
                // The unit's place, so that a wrong one is one error for the whole bracket.
                self.expect_dimension(value, unit.span, expected)?
            }
        };
        self.note_place(expr.span, &number, expected);
        Ok(number)
    }

    /// The number of a value whose dimension fits its place.
    pub(super) fn expect_dimension(
        &mut self,
        value: Value,
        span: Span,
        expected: Dimension,
    ) -> Result<Rational, Reported> {
        if value.dimension.is_bare() || value.dimension.agrees(expected) {
            return Ok(value.number);
        }
        Err(self.report(messages::wrong_dimension(span, value.dimension, expected)))
    }

    /// A whole number without a unit.
    pub(super) fn whole(&mut self, expr: &Expr, scope: &Scope) -> Result<i64, Reported> {
        let number = self.quantity(expr, scope, Dimension::NONE)?;
        number.to_i64().ok_or_else(|| {
            if number.is_integer() {
                self.report(messages::number_out_of_range(expr.span))
            } else {
                self.report(messages::not_whole(expr.span, &number))
            }
        })
    }

    /// The rows of a table: a literal one, with a unit or not, or the name of one.
    pub(super) fn table(&mut self, expr: &Expr, scope: &Scope) -> Result<Vec<Vec<(Value, Span)>>, Reported> {
        match &expr.kind {
            ExprKind::Table(rows) => self.table_rows(rows, scope, expr.span),
            ExprKind::Parenthesised(inner) => self.table(inner, scope),
            ExprKind::WithUnit(inner, unit) if is_table(inner) => {
                let mut rows = self.table(inner, scope)?;
                for (value, span) in rows.iter_mut().flatten() {
                    *value = self.with_unit(value.clone(), unit, *span)?;
                }
                Ok(rows)
            }
            ExprKind::Name(reference) if reference.indices.is_empty() => {
                let item = self.resolve(&reference.name, &[Kind::Param, Kind::Let], "constant", scope)?;
                match &self.entries[item] {
                    Entry::Constant(Ok(Constant::Table(rows))) => Ok(rows
                        .iter()
                        .map(|row| row.iter().map(|v| (v.clone(), expr.span)).collect())
                        .collect()),
                    Entry::Constant(Err(reported)) => Err(*reported),
                    _ => Err(self.report(messages::not_a_table(&reference.name))),
                }
            }
            _ => Err(self.report(messages::not_a_matrix(expr.span))),
        }
    }

    fn table_rows(
        &mut self,
        rows: &[Vec<Expr>],
        scope: &Scope,
        span: Span,
    ) -> Result<Vec<Vec<(Value, Span)>>, Reported> {
        let width = rows.first().map_or(0, Vec::len);
        if let Some((index, row)) = rows.iter().enumerate().find(|(_, r)| r.len() != width) {
            return Err(self.report(messages::ragged_table(span, index + 1, row.len(), width)));
        }
        let mut table = Vec::new();
        for row in rows {
            let entries = row.iter().map(|e| Ok((self.evaluate(e, scope)?, e.span)));
            table.push(entries.collect::<Result<Vec<_>, Reported>>()?);
        }
        Ok(table)
    }

    /// The unit that is written.
    pub(super) fn unit(&mut self, unit: &ast::Unit) -> Result<Unit, Reported> {
        Unit::from_factors(&unit.factors).map_err(|error| {
            self.report(match error {
                UnitError::Unknown(symbol) => messages::unknown_unit(unit.span, &symbol),
                UnitError::OutOfRange => messages::number_out_of_range(unit.span),
            })
        })
    }

    fn with_unit(&mut self, value: Value, unit: &ast::Unit, span: Span) -> Result<Value, Reported> {
        if !value.dimension.is_bare() {
            return Err(self.report(messages::unit_twice(span, value.dimension, unit.span)));
        }
        let unit = self.unit(unit)?;
        let dimension = unit.dimension;
        Ok(Value { dimension, ..value.map(|n| n * &unit.scale) })
    }

    fn apply(&mut self, expr: &Expr, mut arguments: Vec<Value>, scope: &Scope) -> Result<Value, Reported> {
        match &expr.kind {
            ExprKind::Number(number) => Ok(Value::constant(number.clone(), Dimension::NONE)),
            ExprKind::Name(reference) => self.named(reference, &arguments, scope),
            ExprKind::Table(_) => Err(self.report(messages::misplaced_table(expr.span))),
            ExprKind::Call { function, arguments: written } => {
                self.call(function, written, arguments, expr.span)
            }
            ExprKind::Binary { op, left, right } => {
                let [b, a] = [arguments.pop(), arguments.pop()];
                match (a, b) {
                    (Some(a), Some(b)) => self.binary(*op, (left, a), (right, b), expr.span),
                    _ => Err(self.report(messages::number_out_of_range(expr.span))),
                }
            }
            ExprKind::Negate(_) | ExprKind::Parenthesised(_) | ExprKind::WithUnit(..) => {
                let Some(value) = arguments.pop() else {
                    return Err(self.report(messages::number_out_of_range(expr.span)));
                };
                match &expr.kind {
                    ExprKind::Negate(_) => Ok(value.map(|n| -n)),
                    ExprKind::WithUnit(inner, unit) => self.with_unit(value, unit, inner.span),
                    _ => Ok(value),
                }
            }
        }
    }

    /// The value of a name or of a table's entry.
    fn named(
        &mut self,
        reference: &ast::Reference,
        indices: &[Value],
        scope: &Scope,
    ) -> Result<Value, Reported> {
        let name = &reference.name;
        if indices.is_empty() {
            if let Some(value) = scope.coordinate(&name.text) {
                return Ok(value);
            }
            match scope.binding(&name.text) {
                Some(Binding::Index(i)) => return Ok(Value::constant(Rational::from(i), Dimension::NONE)),
                Some(Binding::Unknown(reported)) => return Err(reported),
                Some(Binding::Robot(_)) => {
                    return Err(self.report(messages::robot_as_number(name)));
                }
                None => {}
            }
            if name.text == "pi" {
                return Ok(Value::constant(quantity::pi(), Dimension::NONE));
            }
        }
        if FUNCTIONS.contains(&name.text.as_str()) {
            return Err(self.report(messages::function_without_arguments(name)));
        }
        if !scope.coordinates.is_empty() && indices.is_empty() && self.names.get(&name.text).is_none() {
            let coordinates: Vec<&str> = scope.coordinates.iter().map(|(n, _)| n.as_str()).collect();
            let near = self.names.nearest(&name.text, &[Kind::Param, Kind::Let]);
            let message = messages::unknown_coordinate(name, &coordinates, near);
            return Err(self.report(message));
        }
        let item = self.resolve(name, &[Kind::Param, Kind::Let], "constant", scope)?;
        match (&self.entries[item], indices) {
            (Entry::Constant(Err(reported)), _) => Err(*reported),
            (Entry::Constant(Ok(Constant::Scalar(value))), []) => Ok(value.clone()),
            (Entry::Constant(Ok(Constant::Scalar(_))), _) => Err(self.report(messages::not_a_table(name))),
            (Entry::Constant(Ok(Constant::Table(_))), []) => {
                Err(self.report(messages::table_as_number(name)))
            }
            (Entry::Constant(Ok(Constant::Table(rows))), _) => {
                let rows = rows.clone();
                self.entry(&rows, reference, indices)
            }
            _ => Err(self.report(messages::not_a_table(name))),
        }
    }

    /// An entry of a table, counted from 1; one index will do for a single row or column.
    fn entry(
        &mut self,
        rows: &[Vec<Value>],
        reference: &ast::Reference,
        indices: &[Value],
    ) -> Result<Value, Reported> {
        let (height, width) = (rows.len(), rows.first().map_or(0, Vec::len));
        let mut whole = Vec::new();
        for (value, expr) in indices.iter().zip(&reference.indices) {
            let number = self.expect_dimension(value.clone(), expr.span, Dimension::NONE)?;
            match number.to_i64() {
                Some(index) => whole.push(index),
                None => return Err(self.report(messages::not_whole(expr.span, &number))),
            }
        }
        let (row, column) = match whole[..] {
            [i, j] => (i, j),
            [i] if height == 1 => (1, i),
            [i] if width == 1 => (i, 1),
            _ => return Err(self.report(messages::wrong_index_count(reference, height, width))),
        };
        let at = |i: i64| usize::try_from(i).ok().and_then(|i| i.checked_sub(1));
        let found = at(row).zip(at(column)).and_then(|(r, c)| rows.get(r)?.get(c)).cloned();
        found
            .ok_or_else(|| self.report(messages::index_out_of_table(reference, (row, column), height, width)))
    }

    fn binary(
        &mut self,
        op: BinaryOp,
        (left, a): (&Expr, Value),
        (right, b): (&Expr, Value),
        span: Span,
    ) -> Result<Value, Reported> {
        match op {
            BinaryOp::Add | BinaryOp::Subtract => {
                if !a.dimension.agrees(b.dimension) {
                    let message =
                        messages::dimensions_disagree((left.span, a.dimension), (right.span, b.dimension));
                    return Err(self.report(message));
                }
                let dimension = if a.dimension.is_bare() { b.dimension } else { a.dimension };
                let minus = op == BinaryOp::Subtract;
                Ok(Value { dimension, ..a.zip(b, |x, y| if minus { x - y } else { x + y }) })
            }
            BinaryOp::Multiply => {
                let dimension = self.absurd(a.dimension.times(b.dimension), span)?;
                let (affine, factor) = if b.is_constant() { (a, b) } else { (b, a) };
                self.expect_constant(&factor, span)?;
                Ok(Value { dimension, ..affine.map(|n| n * &factor.number) })
            }
            BinaryOp::Divide => {
                self.expect_constant(&b, right.span)?;
                if b.number.is_zero() {
                    return Err(self.report(messages::division_by_zero(span, right.span)));
                }
                let dimension = self.absurd(a.dimension.per(b.dimension), span)?;
                Ok(Value { dimension, ..a.map(|n| n / &b.number) })
            }
            BinaryOp::Power => {
                self.expect_constant(&a, left.span)?;
                self.expect_constant(&b, right.span)?;
                self.power((left, a), (right, b), span)
            }
        }
    }

    fn absurd(&mut self, dimension: Option<Dimension>, span: Span) -> Result<Dimension, Reported> {
        dimension.ok_or_else(|| self.report(messages::number_out_of_range(span)))
    }

    pub(super) fn expect_constant(&mut self, value: &Value, span: Span) -> Result<(), Reported> {
        if value.is_constant() { Ok(()) } else { Err(self.report(messages::not_linear(span))) }
    }
}

/// The operands whose values an expression needs, in order.
fn operands(expr: &Expr) -> Vec<&Expr> {
    match &expr.kind {
        ExprKind::Number(_) | ExprKind::Table(_) => Vec::new(),
        ExprKind::WithUnit(inner, _) | ExprKind::Negate(inner) | ExprKind::Parenthesised(inner) => {
            vec![inner]
        }
        ExprKind::Name(reference) => reference.indices.iter().collect(),
        ExprKind::Call { arguments, .. } => arguments.iter().collect(),
        ExprKind::Binary { left, right, .. } => vec![left, right],
    }
}

/// All names of constants that an expression mentions, indices and tables included.
pub(super) fn mentioned<'e>(expr: &'e Expr, mut found: impl FnMut(&'e ast::Name)) {
    let mut stack = vec![expr];
    while let Some(expr) = stack.pop() {
        match &expr.kind {
            ExprKind::Name(reference) => found(&reference.name),
            ExprKind::Table(rows) => stack.extend(rows.iter().flatten()),
            _ => {}
        }
        stack.extend(operands(expr));
    }
}

/// Whether an expression is a table, in brackets or with a unit or not.
pub(super) fn is_table(expr: &Expr) -> bool {
    let mut expr = expr;
    loop {
        match &expr.kind {
            ExprKind::Table(_) => return true,
            ExprKind::Parenthesised(inner) | ExprKind::WithUnit(inner, _) => expr = inner,
            _ => return false,
        }
    }
}
