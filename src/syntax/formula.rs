//! Building formulas.

use crate::source::Span;
use crate::syntax::ast::{
    BinaryConnective, BinaryOp, Expr, ExprKind, Formula, FormulaKind, IndexRange, Name, Reference, Sum, Term,
    TermKind, UnaryOp, Window,
};
use crate::syntax::builder::Builder;
use crate::syntax::climb::{Climber, Deep, MAX_LEVELS};
use crate::syntax::error;
use crate::syntax::grammar::{Built, Children, Node, Rule, Stop};
use crate::syntax::shape::comparison;

/// Quantifiers reach as far right as possible: looser than every infix operator.
const QUANTIFIER_LEVEL: u8 = 0;
/// The other prefixes bind tighter than every infix operator.
const PREFIX_LEVEL: u8 = 6;

impl Builder<'_> {
    /// Reads the chains of a formula and of all brackets in it, with a stack of their own.
    pub(super) fn formula(&mut self, node: Node) -> Built<Formula> {
        let span = self.span(&node);
        let mut open = vec![Chain { span, rest: Children::of(node), climber: Climber::new(apply) }];
        while let Some(chain) = open.last_mut() {
            match chain.rest.next() {
                Some(child) => {
                    if let Some(inner) = self.formula_link(child, chain)? {
                        open.push(inner);
                    }
                }
                None => {
                    if let Some(whole) = self.close_chain(&mut open)? {
                        return Ok(whole);
                    }
                }
            }
        }
        Err(Stop)
    }

    /// Reads one operator or operand of a chain; gives the chain in a bracket, which has to be read first.
    fn formula_link<'i>(&mut self, node: Node<'i>, chain: &mut Chain) -> Built<Option<Chain<'i>>> {
        let read = match node.as_rule() {
            Rule::prefix => {
                let (operator, level) = self.prefix(node)?;
                chain.climber.prefix(operator, level)
            }
            Rule::connective => {
                let (operator, level, right) = self.connective(node)?;
                chain.climber.infix(operator, level, right)
            }
            _ => {
                let atom = Children::of(node).expect_any()?;
                let span = self.span(&atom);
                if atom.as_rule() == Rule::formula_group {
                    let rest = Children::of(Children::of(atom).expect(Rule::formula)?);
                    return Ok(Some(Chain { span, rest, climber: Climber::new(apply) }));
                }
                let kind = self.atom(atom)?;
                chain.climber.operand(Deep::leaf(Formula { span, kind }));
                Ok(())
            }
        };
        self.shallow(read, "formula", chain.span)?;
        Ok(None)
    }

    /// Ends the innermost chain: an operand of the one around it, or the whole formula.
    fn close_chain(&mut self, open: &mut Vec<Chain>) -> Built<Option<Formula>> {
        let Chain { span, climber, .. } = open.pop().ok_or(Stop)?;
        let inside = self.shallow(climber.finish(), "formula", span)?.ok_or(Stop)?;
        let Some(around) = open.last_mut() else {
            return Ok(Some(inside.tree));
        };
        let kind = FormulaKind::Parenthesised(Box::new(inside.tree));
        around.climber.operand(Deep { tree: Formula { span, kind }, levels: inside.levels + 1 });
        Ok(None)
    }

    fn prefix(&mut self, node: Node) -> Built<(Operator, u8)> {
        let span = self.span(&node);
        let mut children = Children::of(node);
        let operator = children.expect_any()?;
        let op = match operator.as_rule() {
            Rule::not => UnaryOp::Not,
            Rule::next => UnaryOp::Next,
            Rule::always => UnaryOp::Always,
            Rule::eventually => UnaryOp::Eventually,
            _ => return Ok((self.quantifier(operator)?, QUANTIFIER_LEVEL)),
        };
        let window = self.window(&mut children)?;
        if let (UnaryOp::Next, Some(window)) = (op, &window) {
            self.report(error::window_on_next(window.span));
        }
        Ok((Operator::Unary { op, window, span }, PREFIX_LEVEL))
    }

    fn quantifier(&mut self, node: Node) -> Built<Operator> {
        let span = self.span(&node);
        let universal = node.as_str().starts_with("forall");
        let mut children = Children::of(node);
        let variable = self.name(children.expect(Rule::ident)?);
        let over = match children.take_if(Rule::range) {
            Some(range) => {
                let (from, to) = self.range(range)?;
                Over::Range(from, to)
            }
            None => Over::Set(self.set(children.expect(Rule::set)?)?),
        };
        Ok(Operator::Quantifier { universal, variable, over, span })
    }

    fn connective(&mut self, node: Node) -> Built<(Operator, u8, bool)> {
        let mut children = Children::of(node);
        let (op, level, right) = match children.expect_any()?.as_rule() {
            Rule::iff => (BinaryConnective::Iff, 1, false),
            Rule::implies => (BinaryConnective::Implies, 2, true),
            Rule::or => (BinaryConnective::Or, 3, false),
            Rule::and => (BinaryConnective::And, 4, false),
            Rule::until => (BinaryConnective::Until, 5, true),
            Rule::release => (BinaryConnective::Release, 5, true),
            Rule::weak_until => (BinaryConnective::WeakUntil, 5, true),
            Rule::strong_release => (BinaryConnective::StrongRelease, 5, true),
            _ => return Err(Stop),
        };
        Ok((Operator::Binary { op, window: self.window(&mut children)? }, level, right))
    }

    fn window(&mut self, children: &mut Children) -> Built<Option<Window>> {
        let Some(node) = children.take_if(Rule::window) else {
            return Ok(None);
        };
        let span = self.span(&node);
        let mut children = Children::of(node);
        let from = self.expression(children.expect(Rule::expression)?)?;
        let to = self.expression(children.expect(Rule::expression)?)?;
        Ok(Some(Window { from, to, span }))
    }

    fn atom(&mut self, node: Node) -> Built<FormulaKind> {
        Ok(match node.as_rule() {
            Rule::truth => FormulaKind::Constant(node.as_str() == "true"),
            Rule::comparison => self.comparison(node)?,
            Rule::membership => {
                let (robot, region) = self.membership(node)?;
                FormulaKind::In { robot, region }
            }
            _ => FormulaKind::Name(self.name(Children::of(node).expect(Rule::ident)?)),
        })
    }

    fn membership(&mut self, node: Node) -> Built<(Reference, Reference)> {
        let mut children = Children::of(node);
        let robot = self.reference(children.expect(Rule::reference)?)?;
        let region = self.reference(children.expect(Rule::reference)?)?;
        Ok((robot, region))
    }

    fn comparison(&mut self, node: Node) -> Built<FormulaKind> {
        let mut children = Children::of(node);
        let left = self.sum(children.expect(Rule::sum)?)?;
        let op = comparison(children.expect(Rule::comparator)?.as_str())?;
        let right = self.sum(children.expect(Rule::sum)?)?;
        Ok(FormulaKind::Compare { left, op, right })
    }

    fn sum(&mut self, node: Node) -> Built<Sum> {
        let span = self.span(&node);
        let mut terms = Vec::new();
        let mut subtract = false;
        for child in Children::of(node) {
            match child.as_rule() {
                Rule::sum_operator => subtract = child.as_str() == "-",
                _ => terms.push(self.term(child, subtract)?),
            }
        }
        Ok(Sum { terms, span })
    }

    fn term(&mut self, node: Node, subtract: bool) -> Built<Term> {
        let whole = self.span(&node);
        let mut children = Children::of(node);
        let negated = children.take_if(Rule::minus).is_some();
        let mut start = None;
        let mut factor: Option<Expr> = None;
        let mut kind = None;
        for (count, child) in children.enumerate() {
            let span = self.span(&child);
            if count >= MAX_LEVELS {
                return self.stop(error::too_deep(whole, "product"));
            }
            start.get_or_insert(span.start);
            match child.as_rule() {
                Rule::factor => factor = Some(self.times(factor, child)?),
                _ => kind = Some(self.counted(child)?),
            }
        }
        let (factor, kind) = match (factor, kind) {
            (factor, Some(kind)) => (factor, kind),
            (Some(constant), None) => (None, TermKind::Constant(constant)),
            (None, None) => return Err(Stop),
        };
        let span = Span { start: start.unwrap_or(whole.start), ..whole };
        Ok(Term { negative: subtract != negated, factor, kind, span })
    }

    /// A product's left part times one more constant.
    fn times(&mut self, left: Option<Expr>, node: Node) -> Built<Expr> {
        let span = self.span(&node);
        let node = Children::of(node).expect_any()?;
        let kind = match node.as_rule() {
            Rule::number => ExprKind::Number(self.number(node)?.value),
            _ => ExprKind::Name(self.reference(node)?),
        };
        let right = Expr { span, kind };
        Ok(match left {
            None => right,
            Some(left) => Expr {
                span: left.span.to(right.span),
                kind: ExprKind::Binary {
                    op: BinaryOp::Multiply,
                    left: Box::new(left),
                    right: Box::new(right),
                },
            },
        })
    }

    fn counted(&mut self, node: Node) -> Built<TermKind> {
        let rule = node.as_rule();
        let mut children = Children::of(node);
        if rule == Rule::counted {
            let (robot, region) = self.membership(children.expect(Rule::membership)?)?;
            return Ok(TermKind::In { robot, region });
        }
        let variable = self.name(children.expect(Rule::ident)?);
        let set = self.set(children.expect(Rule::set)?)?;
        let (member, region) = self.membership(children.expect(Rule::membership)?)?;
        Ok(TermKind::Count { variable, set, member, region })
    }
}

/// An operator chain that is being read: a whole formula or the inside of a bracket.
struct Chain<'i> {
    span: Span,
    rest: Children<'i>,
    climber: Climber<Operator, Formula>,
}

/// What a quantifier runs over.
enum Over {
    Range(Expr, Expr),
    Set(Vec<Reference>),
}

/// What waits for its operand.
enum Operator {
    Unary { op: UnaryOp, window: Option<Window>, span: Span },
    Quantifier { universal: bool, variable: Name, over: Over, span: Span },
    Binary { op: BinaryConnective, window: Option<Window> },
}

fn apply(operator: Operator, left: Option<Formula>, right: Formula) -> Formula {
    let end = right.span;
    match (operator, left) {
        (Operator::Unary { op, window, span }, _) => {
            let kind = FormulaKind::Unary { op, window, operand: Box::new(right) };
            Formula { span: span.to(end), kind }
        }
        (Operator::Quantifier { universal, variable, over, span }, _) => {
            Formula { span: span.to(end), kind: quantified(universal, variable, over, right) }
        }
        (Operator::Binary { op, window }, Some(left)) => Formula {
            span: left.span.to(end),
            kind: FormulaKind::Binary { op, window, left: Box::new(left), right: Box::new(right) },
        },
        (Operator::Binary { .. }, None) => right,
    }
}

fn quantified(universal: bool, variable: Name, over: Over, body: Formula) -> FormulaKind {
    let body = Box::new(body);
    match over {
        Over::Set(set) => FormulaKind::QuantifiedRobot { universal, variable, set, body },
        Over::Range(from, to) => {
            FormulaKind::QuantifiedIndex { universal, range: IndexRange { variable, from, to }, body }
        }
    }
}
