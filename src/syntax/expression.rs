//! Building expressions, references, numbers and units.

use crate::exact::Rational;
use crate::source::Span;
use crate::syntax::ast::{BinaryOp, Expr, ExprKind, IndexRange, Name, Number, Reference, Unit};
use crate::syntax::builder::Builder;
use crate::syntax::climb::{Climber, Deep, TooDeep};
use crate::syntax::error::{self, MAX_DIGITS};
use crate::syntax::grammar::{Built, Children, Node, Rule, Stop};

/// The largest absolute value of a unit's exponent.
const MAX_UNIT_EXPONENT: i32 = 64;

impl Builder<'_> {
    /// An expression.
    pub(super) fn expression(&mut self, node: Node) -> Built<Expr> {
        self.deep_expression(node).map(|deep| deep.tree)
    }

    /// A constant's value: a table or an expression.
    pub(super) fn value(&mut self, node: Node) -> Built<Expr> {
        let mark = self.units_read();
        let span = self.span(&node);
        let mut children = Children::of(node);
        let Some(table) = children.take_if(Rule::table) else {
            return self.expression(children.expect(Rule::expression)?);
        };
        let table_span = self.span(&table);
        let mut rows = Vec::new();
        for row in Children::of(table) {
            rows.push(Children::of(row).map(|entry| self.entry(entry)).collect::<Built<_>>()?);
        }
        let inside = Expr { span: table_span, kind: ExprKind::Table(rows) };
        self.with_unit(Deep::leaf(inside), children.take_if(Rule::unit), mark, span).map(|deep| deep.tree)
    }

    /// An entry of a table, where `1 -1` is a comma forgotten rather than a difference.
    fn entry(&mut self, node: Node) -> Built<Expr> {
        let text = node.as_str();
        let offset = node.as_span().start();
        let mut open = 0usize;
        for (i, byte) in text.bytes().enumerate() {
            match byte {
                b'(' | b'[' => open += 1,
                b')' | b']' => open = open.saturating_sub(1),
                b'-' if open == 0 && i > 0 => self.check_minus(text, i, offset),
                _ => {}
            }
        }
        self.expression(node)
    }

    fn check_minus(&mut self, text: &str, at: usize, offset: usize) {
        let before = text.get(..at).unwrap_or("");
        let after = text.get(at + 1..).unwrap_or("");
        let joined_after = !after.starts_with(' ');
        let operand_before = before.trim_end().ends_with(|c: char| c.is_alphanumeric() || ")]_".contains(c));
        if before.ends_with(' ') && operand_before && joined_after {
            let span = self.place(offset + at, offset + at + 1);
            self.report(error::missing_comma(span));
        }
    }

    fn deep_expression(&mut self, node: Node) -> Built<Deep<Expr>> {
        let span = self.span(&node);
        match self.climb_expression(node)? {
            Ok(deep) => Ok(deep),
            Err(TooDeep) => self.stop(error::too_deep(span, "expression")),
        }
    }

    fn climb_expression(&mut self, node: Node) -> Built<Result<Deep<Expr>, TooDeep>> {
        let mut climber = Climber::new(apply);
        let mut base = None;
        let mut power = false;
        for child in Children::of(node) {
            match child.as_rule() {
                Rule::minus => {}
                Rule::arithmetic => power = child.as_str() == "^",
                _ if power => self.check_exponent(base.as_ref(), &child),
                _ => base = Some(child.clone()),
            }
            let read = match child.as_rule() {
                Rule::minus => climber.prefix(Operator::Negate(self.span(&child)), 3),
                Rule::arithmetic => {
                    let (op, level, right) = arithmetic(child.as_str())?;
                    climber.infix(Operator::Binary(op), level, right)
                }
                _ => {
                    climber.operand(self.operand(child)?);
                    Ok(())
                }
            };
            if let Err(deep) = read {
                return Ok(Err(deep));
            }
        }
        match climber.finish() {
            Ok(tree) => tree.ok_or(Stop).map(Ok),
            Err(deep) => Ok(Err(deep)),
        }
    }

    /// Refuses `10^3 m`, which means 10^(3 m) and never was meant so.
    fn check_exponent(&mut self, base: Option<&Node>, exponent: &Node) {
        let Some(quantity) = Children::of(exponent.clone()).take_if(Rule::quantity) else { return };
        let mut children = Children::of(quantity.clone());
        let (Some(number), Some(unit)) = (children.next(), children.take_if(Rule::unit)) else { return };
        let (start, end) = (base.map_or(0, |base| base.as_span().start()), number.as_span().end());
        let power = number.get_input().get(start..end).unwrap_or("");
        let span = self.span(&quantity);
        self.report(error::unit_in_exponent(span, power, unit.as_str()));
    }

    fn operand(&mut self, node: Node) -> Built<Deep<Expr>> {
        let node = Children::of(node).expect_any()?;
        let mark = self.units_read();
        let span = self.span(&node);
        match node.as_rule() {
            Rule::quantity => {
                let mut children = Children::of(node);
                let number = self.number(children.expect(Rule::number)?)?;
                let inside = Expr { span: number.span, kind: ExprKind::Number(number.value) };
                self.with_unit(Deep::leaf(inside), children.take_if(Rule::unit), mark, span)
            }
            Rule::group => {
                let opening = span;
                let mut children = Children::of(node);
                let inside = self.deep_expression(children.expect(Rule::expression)?)?;
                let unit = children.take_if(Rule::unit);
                let end = self.before_unit(span, unit.as_ref());
                let kind = ExprKind::Parenthesised(Box::new(inside.tree));
                let group = Expr { span: Span { start: opening.start, end }, kind };
                self.with_unit(Deep { tree: group, levels: inside.levels + 1 }, unit, mark, span)
            }
            Rule::call => self.call(node, mark, span),
            _ => {
                let (reference, levels) = self.deep_reference(node)?;
                Ok(Deep { tree: Expr { span, kind: ExprKind::Name(reference) }, levels: levels + 1 })
            }
        }
    }

    fn call(&mut self, node: Node, mark: usize, span: Span) -> Built<Deep<Expr>> {
        let mut children = Children::of(node);
        let function = self.name(children.expect(Rule::ident)?);
        let mut arguments = Vec::new();
        let mut levels = 0;
        while let Some(argument) = children.take_if(Rule::expression) {
            let argument = self.deep_expression(argument)?;
            levels = levels.max(argument.levels);
            arguments.push(argument.tree);
        }
        let unit = children.take_if(Rule::unit);
        let end = self.before_unit(span, unit.as_ref());
        let tree = Expr { span: Span { end, ..span }, kind: ExprKind::Call { function, arguments } };
        self.with_unit(Deep { tree, levels: levels + 1 }, unit, mark, span)
    }

    /// The end of what stands before a unit: the end of `span` where there is none.
    fn before_unit(&self, span: Span, unit: Option<&Node>) -> u32 {
        unit.map_or(span.end, |unit| self.end_before(unit.as_span().start()))
    }

    /// `inside` with the unit behind it, which must be the only one in `span`.
    fn with_unit(
        &mut self,
        inside: Deep<Expr>,
        unit: Option<Node>,
        mark: usize,
        span: Span,
    ) -> Built<Deep<Expr>> {
        let Some(unit) = self.trailing_unit(unit, mark)? else {
            return Ok(inside);
        };
        let kind = ExprKind::WithUnit(Box::new(inside.tree), unit);
        Ok(Deep { tree: Expr { span, kind }, levels: inside.levels + 1 })
    }

    /// A unit behind a number or a bracket; none may have been read since `mark`.
    pub(super) fn trailing_unit(&mut self, unit: Option<Node>, mark: usize) -> Built<Option<Unit>> {
        let Some(unit) = unit else {
            return Ok(None);
        };
        let first = self.unit_since(mark);
        let unit = self.unit(unit)?;
        if let Some(first) = first {
            self.report(error::unit_twice(first, unit.span));
        }
        Ok(Some(unit))
    }

    /// A unit.
    pub(super) fn unit(&mut self, node: Node) -> Built<Unit> {
        let span = self.span(&node);
        self.note_unit(span);
        match unit_factors(node.as_str()) {
            Some(factors) => Ok(Unit { factors, span }),
            None => self.stop(error::unit_exponent(span)),
        }
    }

    /// A use of a name.
    pub(super) fn reference(&mut self, node: Node) -> Built<Reference> {
        self.deep_reference(node).map(|(reference, _)| reference)
    }

    /// A use of a name, with the levels of its indices.
    fn deep_reference(&mut self, node: Node) -> Built<(Reference, usize)> {
        let span = self.span(&node);
        let mut children = Children::of(node);
        let name = self.name(children.expect(Rule::ident)?);
        let mut indices = Vec::new();
        let mut levels = 0;
        if let Some(index) = children.take_if(Rule::index) {
            for expression in Children::of(index) {
                let deep = self.deep_expression(expression)?;
                levels = levels.max(deep.levels);
                indices.push(deep.tree);
            }
        }
        Ok((Reference { name, indices, span }, levels))
    }

    /// The ends of a range: `A..B`.
    pub(super) fn range(&mut self, node: Node) -> Built<(Expr, Expr)> {
        let mut children = Children::of(node);
        let from = self.expression(children.expect(Rule::expression)?)?;
        let to = self.expression(children.expect(Rule::expression)?)?;
        Ok((from, to))
    }

    /// `i in A..B`
    pub(super) fn index_range(&mut self, node: Node) -> Built<IndexRange> {
        let mut children = Children::of(node);
        let variable = self.name(children.expect(Rule::ident)?);
        let (from, to) = self.range(children.expect(Rule::range)?)?;
        Ok(IndexRange { variable, from, to })
    }

    /// An identifier.
    pub(super) fn name(&self, node: Node) -> Name {
        Name { text: node.as_str().to_owned(), span: self.span(&node) }
    }

    /// A number.
    pub(super) fn number(&mut self, node: Node) -> Built<Number> {
        let span = self.span(&node);
        let text = node.as_str();
        if text.len() > MAX_DIGITS {
            return self.stop(error::number_too_long(span, text.len()));
        }
        match decimal(text) {
            Some(value) => Ok(Number { value, span }),
            None => self.stop(error::number_range(span)),
        }
    }
}

/// What waits for its operand.
enum Operator {
    Negate(Span),
    Binary(BinaryOp),
}

fn apply(operator: Operator, left: Option<Expr>, right: Expr) -> Expr {
    match (operator, left) {
        (Operator::Binary(op), Some(left)) => Expr {
            span: left.span.to(right.span),
            kind: ExprKind::Binary { op, left: Box::new(left), right: Box::new(right) },
        },
        (Operator::Negate(span), _) => {
            Expr { span: span.to(right.span), kind: ExprKind::Negate(Box::new(right)) }
        }
        (Operator::Binary(_), None) => right,
    }
}

/// An operator with its level and whether it is right-associative.
fn arithmetic(sign: &str) -> Built<(BinaryOp, u8, bool)> {
    Ok(match sign {
        "+" => (BinaryOp::Add, 1, false),
        "-" => (BinaryOp::Subtract, 1, false),
        "*" => (BinaryOp::Multiply, 2, false),
        "/" => (BinaryOp::Divide, 2, false),
        "^" => (BinaryOp::Power, 4, true),
        _ => return Err(Stop),
    })
}

/// The factors of a unit, `None` for an exponent that is 0 or absurd.
fn unit_factors(text: &str) -> Option<Vec<(String, i32)>> {
    let mut factors = Vec::new();
    let mut sign = 1;
    for part in text.split_inclusive(['*', '/']) {
        let factor = part.trim_end_matches(['*', '/']);
        let (symbol, exponent) = match factor.split_once('^') {
            Some((symbol, power)) => (symbol, power.parse::<i32>().ok()?),
            None => (factor, 1),
        };
        if exponent == 0 || exponent.abs() > MAX_UNIT_EXPONENT {
            return None;
        }
        factors.push((symbol.to_owned(), sign * exponent));
        sign = if part.ends_with('/') { -1 } else { 1 };
    }
    Some(factors)
}

/// The exact value of a decimal; `None` out of 1e-300..=1e300 (0 is in). The text's length is bounded.
fn decimal(text: &str) -> Option<Rational> {
    const MAX_EXPONENT: i64 = 300;
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = format!("{whole}{fraction}");
    let digits = digits.trim_start_matches('0');
    if digits.is_empty() {
        return Some(Rational::ZERO);
    }
    let exponent = saturating(exponent).saturating_sub(fraction.len() as i64);
    // The value lies in 10^top .. 10^(top + 1).
    let top = exponent.saturating_add(digits.len() as i64 - 1);
    let power_of_ten = digits.starts_with('1') && digits.bytes().skip(1).all(|d| d == b'0');
    if !(-MAX_EXPONENT..=MAX_EXPONENT).contains(&top) || (top == MAX_EXPONENT && !power_of_ten) {
        return None;
    }
    Rational::from_decimal(digits, i32::try_from(exponent).ok()?)
}

/// A whole number of any length, as near as an `i64` comes.
fn saturating(text: &str) -> i64 {
    let negative = text.starts_with('-');
    let size = text.trim_start_matches(['+', '-']).parse::<i64>().unwrap_or(i64::MAX / 2);
    if negative { -size } else { size }
}
