//! Building formulas.

use crate::source::Span;
use crate::syntax::ast::{
    BinaryConnective, BinaryOp, Expr, ExprKind, Formula, FormulaKind, IndexRange, Name, Reference, Sum, Term,
    TermKind, UnaryOp, Window,
};
use crate::syntax::builder::Builder;
use crate::syntax::climb::{Climber, Deep, MAX_LEVELS, TooDeep};
use crate::syntax::error;
use crate::syntax::grammar::{Built, Children, Node, Rule, Stop};
use crate::syntax::shape::comparison;

/// Quantifiers reach as far right as possible: looser than every infix operator.
const QUANTIFIER_LEVEL: u8 = 0;
/// The other prefixes bind tighter than every infix operator.
const PREFIX_LEVEL: u8 = 6;

impl Builder<'_> {
    /// A formula.
    pub(super) fn formula(&mut self, node: Node) -> Built<Formula> {
        self.deep_formula(node).map(|deep| deep.tree)
    }

    /// Reads the chains of a formula and of all brackets in it, with a stack of their own.
    fn deep_formula(&mut self, node: Node) -> Built<Deep<Formula>> {
        let whole = self.span(&node);
        let mut open = vec![Chain { span: whole, rest: Children::of(node), climber: Climber::new(apply) }];
        while let Some(chain) = open.last_mut() {
            let read = match chain.rest.next() {
                Some(child) => match self.formula_link(child, &mut chain.climber)? {
                    Link::Read(read) => read,
                    Link::Bracket(inner) => {
                        open.push(inner);
                        Ok(())
                    }
                },
                None => match self.close_chain(&mut open)? {
                    Some(whole) => return Ok(whole),
                    None => Ok(()),
                },
            };
            if read.is_err() {
                return self.stop(error::too_deep(whole, "formula"));
            }
        }
        Err(Stop)
    }

    /// Reads one operator or operand of a chain.
    fn formula_link<'i>(&mut self, node: Node<'i>, climber: &mut FormulaClimber) -> Built<Link<'i>> {
        Ok(match node.as_rule() {
            Rule::prefix => {
                let (operator, level) = self.prefix(node)?;
                Link::Read(climber.prefix(operator, level))
            }
            Rule::connective => {
                let (operator, level, right) = self.connective(node)?;
                Link::Read(climber.infix(operator, level, right))
            }
            _ => {
                let atom = Children::of(node).expect_any()?;
                let span = self.span(&atom);
                if atom.as_rule() == Rule::formula_group {
                    let rest = Children::of(Children::of(atom).expect(Rule::formula)?);
                    return Ok(Link::Bracket(Chain { span, rest, climber: Climber::new(apply) }));
                }
                let kind = self.atom(atom)?;
                climber.operand(Deep::leaf(Formula { span, kind }));
                Link::Read(Ok(()))
            }
        })
    }

    /// Ends the innermost chain: an operand of the one around it, or the whole formula.
    fn close_chain(&mut self, open: &mut Vec<Chain>) -> Built<Option<Deep<Formula>>> {
        let done = open.pop().ok_or(Stop)?;
        let inside = match done.climber.finish() {
            Ok(tree) => tree.ok_or(Stop)?,
            Err(TooDeep) => return self.stop(error::too_deep(done.span, "formula")),
        };
        let Some(around) = open.last_mut() else {
            return Ok(Some(inside));
        };
        let kind = FormulaKind::Parenthesised(Box::new(inside.tree));
        around.climber.operand(Deep { tree: Formula { span: done.span, kind }, levels: inside.levels + 1 });
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

type FormulaClimber = Climber<Operator, Formula>;

/// An operator chain that is being read: a whole formula or the inside of a bracket.
struct Chain<'i> {
    span: Span,
    rest: Children<'i>,
    climber: FormulaClimber,
}

/// What reading one part of a chain leads to.
enum Link<'i> {
    /// It was read, unless the chain is too deep.
    Read(Result<(), TooDeep>),
    /// A bracket has to be read first.
    Bracket(Chain<'i>),
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
