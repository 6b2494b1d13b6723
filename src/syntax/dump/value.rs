//! Expressions, shapes and what consists of them, as text.

use crate::syntax::ast::{
    BinaryOp, Comparison, Coordinate, Expr, ExprKind, IndexRange, Inequality, Interval, Norm, PieceKind,
    Point, Reference, Shape, Unit,
};

/// An expression with a blank before it.
pub(super) fn spaced(out: &mut String, value: &Expr) {
    out.push(' ');
    expression(out, value);
}

/// An expression.
pub(super) fn expression(out: &mut String, value: &Expr) {
    match &value.kind {
        ExprKind::Number(number) => out.push_str(&number.to_string()),
        ExprKind::WithUnit(inside, behind) => {
            out.push_str("(unit");
            spaced(out, inside);
            out.push(' ');
            unit(out, behind);
            out.push(')');
        }
        ExprKind::Name(name) => reference(out, name),
        ExprKind::Call { function, arguments } => list(out, &function.text, arguments),
        ExprKind::Negate(inside) => {
            out.push_str("(neg");
            spaced(out, inside);
            out.push(')');
        }
        ExprKind::Binary { op, left, right } => {
            out.push('(');
            out.push_str(sign(*op));
            spaced(out, left);
            spaced(out, right);
            out.push(')');
        }
        ExprKind::Parenthesised(inside) => {
            out.push_str("(group");
            spaced(out, inside);
            out.push(')');
        }
        ExprKind::Table(rows) => {
            out.push_str("(table");
            for row in rows {
                out.push(' ');
                list(out, "row", row);
            }
            out.push(')');
        }
    }
}

fn list(out: &mut String, head: &str, values: &[Expr]) {
    out.push('(');
    out.push_str(head);
    for value in values {
        spaced(out, value);
    }
    out.push(')');
}

fn sign(op: BinaryOp) -> &'static str {
    match op {
        BinaryOp::Add => "+",
        BinaryOp::Subtract => "-",
        BinaryOp::Multiply => "*",
        BinaryOp::Divide => "/",
        BinaryOp::Power => "^",
    }
}

/// A unit: factors joined by `*`.
pub(super) fn unit(out: &mut String, unit: &Unit) {
    for (i, (symbol, exponent)) in unit.factors.iter().enumerate() {
        out.push_str(if i == 0 { "" } else { "*" });
        out.push_str(symbol);
        if *exponent != 1 {
            out.push_str(&format!("^{exponent}"));
        }
    }
}

fn spaced_unit(out: &mut String, behind: Option<&Unit>) {
    if let Some(behind) = behind {
        out.push(' ');
        unit(out, behind);
    }
}

/// A reference.
pub(super) fn reference(out: &mut String, reference: &Reference) {
    out.push_str(&reference.name.text);
    for (i, index) in reference.indices.iter().enumerate() {
        out.push_str(if i == 0 { "[" } else { ", " });
        expression(out, index);
    }
    out.push_str(if reference.indices.is_empty() { "" } else { "]" });
}

/// A set of robots, with a blank before it.
pub(super) fn set(out: &mut String, members: &[Reference]) {
    out.push_str(" {");
    for (i, member) in members.iter().enumerate() {
        out.push_str(if i == 0 { "" } else { " " });
        reference(out, member);
    }
    out.push('}');
}

/// `i in A..B`
pub(super) fn index_range(out: &mut String, range: &IndexRange) {
    out.push_str(&range.variable.text);
    spaced(out, &range.from);
    spaced(out, &range.to);
}

fn coordinate(out: &mut String, coordinate: &Coordinate) {
    spaced(out, &coordinate.value);
    if let Some(uncertainty) = &coordinate.uncertainty {
        out.push_str(" +/-");
        spaced(out, uncertainty);
    }
}

/// A point, with a blank before it.
pub(super) fn point(out: &mut String, point: &Point) {
    out.push_str(" (point");
    for coordinate in &point.coordinates {
        self::coordinate(out, coordinate);
    }
    out.push(')');
    spaced_unit(out, point.unit.as_ref());
}

/// An interval, with a blank before it.
pub(super) fn interval(out: &mut String, interval: &Interval) {
    out.push_str(" (interval");
    spaced(out, &interval.from);
    spaced(out, &interval.to);
    out.push(')');
    spaced_unit(out, interval.unit.as_ref());
}

/// A norm, with a blank before it.
pub(super) fn norm(out: &mut String, norm: Option<&Norm>) {
    if let Some(norm) = norm {
        out.push_str(&format!(" norm {}", norm.value.value));
    }
}

/// A shape, with a blank before it.
pub(super) fn shape(out: &mut String, shape: &Shape) {
    for (i, piece) in shape.pieces.iter().enumerate() {
        out.push_str(if i == 0 { " (" } else { " or (" });
        self::piece(out, &piece.kind);
        out.push(')');
    }
}

fn piece(out: &mut String, kind: &PieceKind) {
    match kind {
        PieceKind::Box(low, high) => {
            out.push_str("box");
            point(out, low);
            point(out, high);
        }
        PieceKind::Ball { center, radius, norm, disc } => {
            out.push_str(if *disc { "disc" } else { "ball" });
            point(out, center);
            coordinate(out, radius);
            self::norm(out, norm.as_ref());
        }
        PieceKind::Polygon(points) => listed(out, "polygon", points),
        PieceKind::Hull(points) => listed(out, "hull", points),
        PieceKind::Where(inequalities) => {
            out.push_str("where");
            self::inequalities(out, inequalities);
        }
    }
}

fn listed(out: &mut String, word: &str, points: &[Point]) {
    out.push_str(word);
    for point in points {
        self::point(out, point);
    }
}

/// Inequalities, with a blank before them.
pub(super) fn inequalities(out: &mut String, inequalities: &[Inequality]) {
    out.push_str(" {");
    for (i, inequality) in inequalities.iter().enumerate() {
        out.push_str(if i == 0 { "(" } else { " (" });
        out.push_str(comparison(inequality.op));
        spaced(out, &inequality.left);
        spaced(out, &inequality.right);
        out.push(')');
    }
    out.push('}');
}

/// A comparison's sign.
pub(super) fn comparison(op: Comparison) -> &'static str {
    match op {
        Comparison::Equal => "=",
        Comparison::NotEqual => "!=",
        Comparison::Less => "<",
        Comparison::LessEqual => "<=",
        Comparison::Greater => ">",
        Comparison::GreaterEqual => ">=",
    }
}
