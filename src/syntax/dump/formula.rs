//! Formulas as text.

use super::value;
use crate::syntax::ast::{BinaryConnective, Formula, FormulaKind, Sum, Term, TermKind, UnaryOp, Window};

/// A formula with a blank before it.
pub(super) fn spaced(out: &mut String, formula: &Formula) {
    out.push(' ');
    match &formula.kind {
        FormulaKind::Constant(value) => out.push_str(if *value { "true" } else { "false" }),
        FormulaKind::In { robot, region } => {
            out.push_str("(in ");
            value::reference(out, robot);
            out.push(' ');
            value::reference(out, region);
            out.push(')');
        }
        FormulaKind::Name(name) => out.push_str(&name.text),
        FormulaKind::Compare { left, op, right } => {
            out.push('(');
            out.push_str(value::comparison(*op));
            sum(out, left);
            sum(out, right);
            out.push(')');
        }
        FormulaKind::Unary { op, window, operand } => {
            head(out, unary(*op), window.as_ref());
            spaced(out, operand);
            out.push(')');
        }
        FormulaKind::Binary { op, window, left, right } => {
            head(out, binary(*op), window.as_ref());
            spaced(out, left);
            spaced(out, right);
            out.push(')');
        }
        FormulaKind::QuantifiedRobot { universal, variable, set, body } => {
            out.push_str(if *universal { "(forall " } else { "(exists " });
            out.push_str(&variable.text);
            value::set(out, set);
            spaced(out, body);
            out.push(')');
        }
        FormulaKind::QuantifiedIndex { universal, range, body } => {
            out.push_str(if *universal { "(forall [" } else { "(exists [" });
            value::index_range(out, range);
            out.push(']');
            spaced(out, body);
            out.push(')');
        }
        FormulaKind::Parenthesised(inside) => {
            out.push_str("(group");
            spaced(out, inside);
            out.push(')');
        }
    }
}

fn head(out: &mut String, word: &str, window: Option<&Window>) {
    out.push('(');
    out.push_str(word);
    if let Some(window) = window {
        out.push('[');
        value::expression(out, &window.from);
        out.push(',');
        value::spaced(out, &window.to);
        out.push(']');
    }
}

fn unary(op: UnaryOp) -> &'static str {
    match op {
        UnaryOp::Not => "not",
        UnaryOp::Next => "next",
        UnaryOp::Always => "always",
        UnaryOp::Eventually => "eventually",
    }
}

fn binary(op: BinaryConnective) -> &'static str {
    match op {
        BinaryConnective::Iff => "<->",
        BinaryConnective::Implies => "->",
        BinaryConnective::Or => "or",
        BinaryConnective::And => "and",
        BinaryConnective::Until => "until",
        BinaryConnective::Release => "release",
        BinaryConnective::WeakUntil => "weak-until",
        BinaryConnective::StrongRelease => "strong-release",
    }
}

/// A sum, with a blank before it: its terms, each with its sign.
fn sum(out: &mut String, sum: &Sum) {
    out.push_str(" (sum");
    for term in &sum.terms {
        self::term(out, term);
    }
    out.push(')');
}

fn term(out: &mut String, term: &Term) {
    out.push_str(if term.negative { " -" } else { " +" });
    if let Some(factor) = &term.factor {
        value::expression(out, factor);
        out.push('*');
    }
    match &term.kind {
        TermKind::Count { variable, set, member, region } => {
            out.push_str("(count ");
            out.push_str(&variable.text);
            value::set(out, set);
            out.push(' ');
            value::reference(out, member);
            out.push(' ');
            value::reference(out, region);
            out.push(')');
        }
        TermKind::In { robot, region } => {
            out.push_str("(in ");
            value::reference(out, robot);
            out.push(' ');
            value::reference(out, region);
            out.push(')');
        }
        TermKind::Constant(value) => value::expression(out, value),
    }
}
