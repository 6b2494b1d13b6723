//! Formulas: names to ids, quantifiers over their members, on a stack of its own.

use crate::check::expression::Scope;
use crate::check::names::Kind;
use crate::check::{Binding, Checker, Entry, messages, typed};
use crate::diag::Reported;
use crate::source::Span;
use crate::syntax::ast::{
    BinaryConnective, Formula, FormulaKind, IndexRange, Name, Reference, UnaryOp, Window,
};

/// The most nodes and terms that all formulas together may have once quantifiers are written out.
const MAX_FORMULA_SIZE: usize = 250_000;

type Built = Result<typed::FormulaId, Reported>;

/// A step of the walk over a formula.
enum Task<'f> {
    /// Builds the formula, operands first.
    Visit(&'f Formula),
    /// Joins the operands that have been built.
    Join(&'f Formula, Result<Option<typed::Window>, Reported>),
    /// Goes on with the next member of a quantifier.
    Quantify(Quantifier<'f>),
    /// Takes the innermost variable out of scope.
    Unbind,
}

/// A quantifier on its way through its members.
struct Quantifier<'f> {
    formula: &'f Formula,
    universal: bool,
    variable: &'f Name,
    body: &'f Formula,
    members: Vec<Binding>,
    next: usize,
}

impl Checker<'_> {
    /// The typed form of a formula that stands alone.
    pub(super) fn formula(&mut self, formula: &Formula) -> Built {
        let mut scope = Scope::default();
        let mut tasks = vec![Task::Visit(formula)];
        let mut built: Vec<Built> = Vec::new();
        while let Some(task) = tasks.pop() {
            match task {
                Task::Visit(formula) => self.visit(formula, &scope, &mut tasks, &mut built),
                Task::Join(formula, window) => {
                    let joined = self.join(formula, window, &mut built);
                    built.push(joined);
                }
                Task::Quantify(quantifier) => self.quantify(quantifier, &mut scope, &mut tasks, &mut built),
                Task::Unbind => {
                    scope.bindings.pop();
                }
            }
        }
        match built.pop() {
            Some(result) => result,
            None => Err(self.reported(|| messages::formula_too_large(formula.span, MAX_FORMULA_SIZE))),
        }
    }

    fn visit<'f>(
        &mut self,
        formula: &'f Formula,
        scope: &Scope,
        tasks: &mut Vec<Task<'f>>,
        built: &mut Vec<Built>,
    ) {
        match &formula.kind {
            FormulaKind::Constant(value) => {
                built.push(self.node(typed::Formula::Constant(*value), formula.span));
            }
            FormulaKind::In { robot, region } => {
                let atom = self.atom(robot, region, scope);
                built.push(atom.and_then(|atom| self.node(typed::Formula::In(atom), formula.span)));
            }
            FormulaKind::Compare { left, op, right } => {
                let comparison = self.comparison(left, *op, right, scope);
                built.push(comparison.and_then(|c| self.node(c, formula.span)));
            }
            FormulaKind::Name(name) => built.push(self.defined(name, scope)),
            FormulaKind::Parenthesised(inner) => tasks.push(Task::Visit(inner)),
            FormulaKind::Unary { window, operand, .. } => {
                tasks.push(Task::Join(formula, self.optional_window(window, scope)));
                tasks.push(Task::Visit(operand));
            }
            FormulaKind::Binary { window, left, right, .. } => {
                tasks.push(Task::Join(formula, self.optional_window(window, scope)));
                tasks.push(Task::Visit(right));
                tasks.push(Task::Visit(left));
            }
            FormulaKind::QuantifiedRobot { universal, variable, set, body } => {
                let members = self.robot_members(variable, set, scope);
                let universal = *universal;
                tasks.push(Task::Quantify(Quantifier {
                    formula,
                    universal,
                    variable,
                    body,
                    members,
                    next: 0,
                }));
            }
            FormulaKind::QuantifiedIndex { universal, range, body } => {
                let members = self.index_members(range, scope);
                let (universal, variable) = (*universal, &range.variable);
                tasks.push(Task::Quantify(Quantifier {
                    formula,
                    universal,
                    variable,
                    body,
                    members,
                    next: 0,
                }));
            }
        }
    }

    fn optional_window(
        &mut self,
        window: &Option<Window>,
        scope: &Scope,
    ) -> Result<Option<typed::Window>, Reported> {
        window.as_ref().map(|window| self.window(window, scope)).transpose()
    }

    /// What a robot variable stands for, one after the other; one unknown where the set is wrong.
    fn robot_members(&mut self, variable: &Name, set: &[Reference], scope: &Scope) -> Vec<Binding> {
        let robots = self.check_variable(variable, scope).and_then(|()| self.set(set, scope));
        match robots {
            Ok(robots) => robots.into_iter().map(Binding::Robot).collect(),
            Err(reported) => vec![Binding::Unknown(reported)],
        }
    }

    fn index_members(&mut self, range: &IndexRange, scope: &Scope) -> Vec<Binding> {
        let ends = self.check_variable(&range.variable, scope).and_then(|()| self.range(range, scope));
        match ends {
            Ok((from, to)) => (from..=to).map(Binding::Index).collect(),
            Err(reported) => vec![Binding::Unknown(reported)],
        }
    }

    fn quantify<'f>(
        &mut self,
        mut quantifier: Quantifier<'f>,
        scope: &mut Scope,
        tasks: &mut Vec<Task<'f>>,
        built: &mut Vec<Built>,
    ) {
        let failed = if quantifier.next > 0 { built.last().and_then(|b| b.err()) } else { None };
        if failed.is_none()
            && let Some(&binding) = quantifier.members.get(quantifier.next)
        {
            self.bind(scope, quantifier.variable, binding);
            quantifier.next += 1;
            let body = quantifier.body;
            tasks.extend([Task::Quantify(quantifier), Task::Unbind, Task::Visit(body)]);
            return;
        }
        // One member that fails is enough: the others would say the same again.
        let bodies = built.split_off(built.len() - quantifier.next);
        let joined = bodies.into_iter().collect::<Result<Vec<_>, _>>().and_then(|bodies| {
            let node =
                if quantifier.universal { typed::Formula::And(bodies) } else { typed::Formula::Or(bodies) };
            self.node(node, quantifier.formula.span)
        });
        built.push(joined);
    }

    fn join(
        &mut self,
        formula: &Formula,
        window: Result<Option<typed::Window>, Reported>,
        built: &mut Vec<Built>,
    ) -> Built {
        let mut operand = || match built.pop() {
            Some(result) => result,
            None => Err(self.reported(|| messages::formula_too_large(formula.span, MAX_FORMULA_SIZE))),
        };
        let node = match &formula.kind {
            FormulaKind::Unary { op, .. } => {
                let a = operand()?;
                unary(*op, window?, a)
            }
            FormulaKind::Binary { op, .. } => {
                let (b, a) = (operand(), operand());
                binary(*op, window?, a?, b?)
            }
            _ => return operand(),
        };
        self.node(node, formula.span)
    }

    fn defined(&mut self, name: &Name, scope: &Scope) -> Built {
        let item = self.resolve(name, &[Kind::Define], "defined formula", scope)?;
        match &self.entries[item] {
            Entry::Formula(result) => *result,
            _ => Err(self.reported(|| messages::unknown_name(name, "defined formula", None))),
        }
    }

    fn node(&mut self, node: typed::Formula, span: Span) -> Built {
        self.grow(1, span)?;
        Ok(self.formulas.push(node))
    }

    /// Counts what formulas take, so that nested quantifiers are stopped before they fill the memory.
    pub(super) fn grow(&mut self, size: usize, span: Span) -> Result<(), Reported> {
        self.formula_size = self.formula_size.saturating_add(size);
        if self.formula_size <= MAX_FORMULA_SIZE {
            return Ok(());
        }
        if let Some(reported) = self.overgrown {
            return Err(reported);
        }
        let reported = self.report(messages::formula_too_large(span, MAX_FORMULA_SIZE));
        self.overgrown = Some(reported);
        Err(reported)
    }
}

fn unary(op: UnaryOp, window: Option<typed::Window>, a: typed::FormulaId) -> typed::Formula {
    match op {
        UnaryOp::Not => typed::Formula::Not(a),
        UnaryOp::Next => typed::Formula::Next(a),
        UnaryOp::Always => typed::Formula::Always(window, a),
        UnaryOp::Eventually => typed::Formula::Eventually(window, a),
    }
}

fn binary(
    op: BinaryConnective,
    window: Option<typed::Window>,
    a: typed::FormulaId,
    b: typed::FormulaId,
) -> typed::Formula {
    match op {
        BinaryConnective::Iff => typed::Formula::Iff(a, b),
        BinaryConnective::Implies => typed::Formula::Implies(a, b),
        BinaryConnective::Or => typed::Formula::Or(vec![a, b]),
        BinaryConnective::And => typed::Formula::And(vec![a, b]),
        BinaryConnective::Until => typed::Formula::Until(window, a, b),
        BinaryConnective::Release => typed::Formula::Release(window, a, b),
        BinaryConnective::WeakUntil => typed::Formula::WeakUntil(window, a, b),
        BinaryConnective::StrongRelease => typed::Formula::StrongRelease(window, a, b),
    }
}

/// All names of defined formulas that a formula mentions.
pub(super) fn mentioned<'f>(formula: &'f Formula, mut found: impl FnMut(&'f Name)) {
    let mut stack = vec![formula];
    while let Some(formula) = stack.pop() {
        match &formula.kind {
            FormulaKind::Name(name) => found(name),
            FormulaKind::Unary { operand, .. } => stack.push(operand),
            FormulaKind::Binary { left, right, .. } => stack.extend([&**left, &**right]),
            FormulaKind::QuantifiedRobot { body, .. } | FormulaKind::QuantifiedIndex { body, .. } => {
                stack.push(body);
            }
            FormulaKind::Parenthesised(inner) => stack.push(inner),
            FormulaKind::Constant(_) | FormulaKind::In { .. } | FormulaKind::Compare { .. } => {}
        }
    }
}
