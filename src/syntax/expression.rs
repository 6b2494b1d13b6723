//! Building expressions and references.

use crate::source::Span;
use crate::syntax::ast::{BinaryOp, Expr, ExprKind, IndexRange, Name, Reference};
use crate::syntax::builder::Builder;
use crate::syntax::climb::{Climber, Deep};
use crate::syntax::error;
use crate::syntax::grammar::{Built, Children, Node, Rule, Stop};

impl Builder<'_> {
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

    /// Reads the chains of an expression and of all brackets in it, with a stack of their own.
    pub(super) fn expression(&mut self, node: Node) -> Built<Expr> {
        let mut open = vec![self.chain(node, None)];
        while let Some(chain) = open.last_mut() {
            if let Some(child) = chain.rest.next() {
                if let Some(inner) = self.expression_link(child, chain)? {
                    open.push(inner);
                }
                continue;
            }
            let Chain { span, climber, around, .. } = open.pop().ok_or(Stop)?;
            let inside = self.shallow(climber.finish(), "expression", span)?.ok_or(Stop)?;
            match around {
                Some(bracket) => self.go_on(bracket, inside, &mut open)?,
                None => return Ok(inside.tree),
            }
        }
        Err(Stop)
    }

    fn chain<'i>(&self, expression: Node<'i>, around: Option<Bracket<'i>>) -> Chain<'i> {
        let span = self.span(&expression);
        let climber = Climber::new(apply);
        Chain { span, rest: Children::of(expression), climber, base: None, power: false, around }
    }

    /// Reads one operator or operand of a chain; gives the chain in a bracket, which has to be read first.
    fn expression_link<'i>(&mut self, node: Node<'i>, chain: &mut Chain<'i>) -> Built<Option<Chain<'i>>> {
        let read = match node.as_rule() {
            Rule::minus => chain.climber.prefix(Operator::Negate(self.span(&node)), 3),
            Rule::arithmetic => {
                chain.power = node.as_str() == "^";
                let (op, level, right) = arithmetic(node.as_str())?;
                chain.climber.infix(Operator::Binary(op), level, right)
            }
            _ => {
                if chain.power {
                    self.check_exponent(chain.base.as_ref(), &node);
                } else {
                    chain.base = Some(node.clone());
                }
                let operand = Children::of(node).expect_any()?;
                if let Some(bracket) = self.bracket(&operand)? {
                    return Ok(Some(bracket));
                }
                chain.climber.operand(self.operand(operand)?);
                Ok(())
            }
        };
        self.shallow(read, "expression", chain.span)?;
        Ok(None)
    }

    /// The chain inside an operand's bracket, if it has one.
    fn bracket<'i>(&mut self, operand: &Node<'i>) -> Built<Option<Chain<'i>>> {
        let mark = self.units_read();
        let span = self.span(operand);
        let mut rest = Children::of(operand.clone());
        let kind = match operand.as_rule() {
            Rule::group => BracketKind::Group,
            Rule::call => BracketKind::Call(self.name(rest.expect(Rule::ident)?)),
            Rule::reference => {
                let name = self.name(rest.expect(Rule::ident)?);
                match rest.take_if(Rule::index) {
                    Some(index) => rest = Children::of(index),
                    None => return Ok(None),
                }
                BracketKind::Index(name)
            }
            _ => return Ok(None),
        };
        let first = rest.expect(Rule::expression)?;
        let bracket = Bracket { kind, span, mark, rest, inside: Vec::new(), levels: 0 };
        Ok(Some(self.chain(first, Some(bracket))))
    }

    /// Takes what was read inside a bracket, and reads on inside it or ends it.
    fn go_on<'i>(
        &mut self,
        mut bracket: Bracket<'i>,
        inside: Deep<Expr>,
        open: &mut Vec<Chain<'i>>,
    ) -> Built<()> {
        bracket.levels = bracket.levels.max(inside.levels);
        bracket.inside.push(inside.tree);
        if let Some(next) = bracket.rest.take_if(Rule::expression) {
            open.push(self.chain(next, Some(bracket)));
            return Ok(());
        }
        let operand = self.close_bracket(bracket)?;
        open.last_mut().ok_or(Stop)?.climber.operand(operand);
        Ok(())
    }

    fn close_bracket(&mut self, mut bracket: Bracket) -> Built<Deep<Expr>> {
        let unit = bracket.rest.take_if(Rule::unit);
        let end = unit.as_ref().map_or(bracket.span.end, |unit| self.end_before(unit.as_span().start()));
        let span = Span { end, ..bracket.span };
        let kind = match bracket.kind {
            BracketKind::Group => ExprKind::Parenthesised(Box::new(bracket.inside.pop().ok_or(Stop)?)),
            BracketKind::Call(function) => ExprKind::Call { function, arguments: bracket.inside },
            BracketKind::Index(name) => ExprKind::Name(Reference { name, indices: bracket.inside, span }),
        };
        let deep = Deep { tree: Expr { span, kind }, levels: bracket.levels + 1 };
        self.with_unit(deep, unit, bracket.mark, bracket.span)
    }

    /// Refuses `10^3 m`, which means 10^(3 m) and never was meant so.
    fn check_exponent(&mut self, base: Option<&Node>, exponent: &Node) {
        let Some(quantity) = Children::of(exponent.clone()).take_if(Rule::quantity) else { return };
        let mut children = Children::of(quantity.clone());
        let (Some(number), Some(unit)) = (children.next(), children.take_if(Rule::unit)) else { return };
        let (start, end) = (base.map_or(0, |base| base.as_span().start()), number.as_span().end());
        let power = number.get_input().get(start..end).unwrap_or("");
        let span = self.span(&quantity);
        let begin = base.map_or(span, |base| self.span(base));
        let inside = Span { start: begin.start, end: self.span(&number).end };
        self.report(error::unit_in_exponent(span, inside, power, unit.as_str()));
    }

    /// An operand without brackets.
    fn operand(&mut self, node: Node) -> Built<Deep<Expr>> {
        let span = self.span(&node);
        let mut children = Children::of(node);
        let Some(number) = children.take_if(Rule::number) else {
            let name = self.name(children.expect(Rule::ident)?);
            let kind = ExprKind::Name(Reference { name, indices: Vec::new(), span });
            return Ok(Deep::leaf(Expr { span, kind }));
        };
        let mark = self.units_read();
        let number = self.number(number)?;
        let inside = Expr { span: number.span, kind: ExprKind::Number(number.value) };
        self.with_unit(Deep::leaf(inside), children.take_if(Rule::unit), mark, span)
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

    /// A use of a name.
    pub(super) fn reference(&mut self, node: Node) -> Built<Reference> {
        let span = self.span(&node);
        let mut children = Children::of(node);
        let name = self.name(children.expect(Rule::ident)?);
        let mut indices = Vec::new();
        if let Some(index) = children.take_if(Rule::index) {
            for expression in Children::of(index) {
                indices.push(self.expression(expression)?);
            }
        }
        Ok(Reference { name, indices, span })
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
}

/// An operator chain that is being read: a whole expression, or one of those in a bracket.
struct Chain<'i> {
    span: Span,
    rest: Children<'i>,
    climber: Climber<Operator, Expr>,
    /// The operand before the last run of `^`, and whether such a run is being read.
    base: Option<Node<'i>>,
    power: bool,
    around: Option<Bracket<'i>>,
}

/// An operand with brackets whose inside is being read.
struct Bracket<'i> {
    kind: BracketKind,
    /// All of the operand.
    span: Span,
    /// The units read before it.
    mark: usize,
    rest: Children<'i>,
    inside: Vec<Expr>,
    levels: usize,
}

enum BracketKind {
    Group,
    Call(Name),
    Index(Name),
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
