//! Trees that stand at another place of the text than they did.

use super::ast::{
    Connectivity, ConnectivityItem, ConnectivityKind, Coordinate, Doc, DynamicsItem, DynamicsKind, Expr,
    ExprKind, FamilyName, Formula, FormulaKind, IndexRange, Inequality, Interval, Item, ItemKind, Name, Norm,
    Number, Piece, PieceKind, Point, Reference, Shape, Signal, State, Sum, Term, TermKind, Unit, Window,
};
use crate::source::Span;

/// What has places in the text.
pub(super) trait Moved {
    /// Moves all places by so many bytes.
    fn move_by(&mut self, bytes: i64);
}

impl Moved for Span {
    fn move_by(&mut self, bytes: i64) {
        // Texts are shorter than 4 GiB: what was a place stays one.
        let moved = |place: u32| u32::try_from(i64::from(place) + bytes).unwrap_or_default();
        (self.start, self.end) = (moved(self.start), moved(self.end));
    }
}

impl<T: Moved> Moved for Vec<T> {
    fn move_by(&mut self, bytes: i64) {
        self.iter_mut().for_each(|part| part.move_by(bytes));
    }
}

impl<T: Moved> Moved for Option<T> {
    fn move_by(&mut self, bytes: i64) {
        self.iter_mut().for_each(|part| part.move_by(bytes));
    }
}

impl<T: Moved> Moved for Box<T> {
    fn move_by(&mut self, bytes: i64) {
        (**self).move_by(bytes);
    }
}

impl<A: Moved, B: Moved> Moved for (A, B) {
    fn move_by(&mut self, bytes: i64) {
        self.0.move_by(bytes);
        self.1.move_by(bytes);
    }
}

/// Structures: the fields with places, and behind `|` those without. A field that is named nowhere does not
/// compile.
macro_rules! structures {
    ($($name:ident: $($moved:ident)* | $($still:ident)*;)*) => {$(
        impl Moved for $name {
            fn move_by(&mut self, bytes: i64) {
                let $name { $($moved,)* $($still: _,)* } = self;
                $($moved.move_by(bytes);)*
            }
        }
    )*};
}

structures! {
    Name: span | text;
    Doc: span | text;
    Item: doc span kind |;
    FamilyName: name indices |;
    IndexRange: variable from to |;
    Reference: name indices span |;
    Number: span | value;
    Unit: span | factors;
    Expr: span kind |;
    Point: coordinates unit span |;
    Coordinate: value uncertainty |;
    Shape: pieces span |;
    Piece: span kind |;
    Norm: value |;
    Inequality: left op_span right span | op;
    DynamicsItem: doc span kind |;
    Signal: doc name unit |;
    Interval: from to unit span |;
    ConnectivityItem: span kind |;
    Formula: span kind |;
    Window: from to span |;
    Sum: terms span |;
    Term: factor kind span | negative;
}

impl Moved for ItemKind {
    fn move_by(&mut self, bytes: i64) {
        match self {
            ItemKind::Edition(number) => number.move_by(bytes),
            ItemKind::Mission(name) | ItemKind::Minimize(name) => name.move_by(bytes),
            ItemKind::Param { name, value } | ItemKind::Let { name, value } => both(name, value, bytes),
            ItemKind::Workspace(shape) => shape.move_by(bytes),
            ItemKind::Region { name, shape }
            | ItemKind::Jammer { name, shape }
            | ItemKind::Obstacle { name, shape, opaque: _ } => both(name, shape, bytes),
            ItemKind::Base { name, at } => both(name, at, bytes),
            ItemKind::Dynamics { name, items } => both(name, items, bytes),
            ItemKind::Robot { name, dynamics, at } => {
                both(name, dynamics, bytes);
                at.move_by(bytes);
            }
            ItemKind::Team { name, members } => both(name, members, bytes),
            ItemKind::Separation(length) => length.move_by(bytes),
            ItemKind::Connectivity(connectivity) => connectivity.move_by(bytes),
            ItemKind::Horizon { from, to } => both(from, to, bytes),
            ItemKind::Goal { name, formula } | ItemKind::Define { name, formula } => {
                both(name, formula, bytes)
            }
        }
    }
}

impl Moved for ExprKind {
    fn move_by(&mut self, bytes: i64) {
        match self {
            ExprKind::Number(_) => {}
            ExprKind::WithUnit(inside, unit) => both(inside, unit, bytes),
            ExprKind::Name(reference) => reference.move_by(bytes),
            ExprKind::Call { function, arguments } => both(function, arguments, bytes),
            ExprKind::Negate(inside) | ExprKind::Parenthesised(inside) => inside.move_by(bytes),
            ExprKind::Binary { op: _, left, right } => both(left, right, bytes),
            ExprKind::Table(rows) => rows.move_by(bytes),
        }
    }
}

impl Moved for PieceKind {
    fn move_by(&mut self, bytes: i64) {
        match self {
            PieceKind::Box(one, other) => both(one, other, bytes),
            PieceKind::Ball { center, radius, norm, disc: _ } => {
                both(center, radius, bytes);
                norm.move_by(bytes);
            }
            PieceKind::Polygon(points) | PieceKind::Hull(points) => points.move_by(bytes),
            PieceKind::Where(inequalities) => inequalities.move_by(bytes),
        }
    }
}

impl Moved for DynamicsKind {
    fn move_by(&mut self, bytes: i64) {
        match self {
            DynamicsKind::Step(value) | DynamicsKind::Integrator(value) | DynamicsKind::Rejection(value) => {
                value.move_by(bytes);
            }
            DynamicsKind::State(signals) | DynamicsKind::Input(signals) => signals.move_by(bytes),
            DynamicsKind::Position(names) => names.move_by(bytes),
            DynamicsKind::Matrix { letter, value } => both(letter, value, bytes),
            DynamicsKind::Continuous => {}
            DynamicsKind::Bound { names, interval } | DynamicsKind::Disturbance { names, interval } => {
                both(names, interval, bytes);
            }
            DynamicsKind::BoundWhere(inequalities) => inequalities.move_by(bytes),
            DynamicsKind::Mode { name, when, items } => {
                both(name, when, bytes);
                items.move_by(bytes);
            }
        }
    }
}

impl Moved for State {
    fn move_by(&mut self, bytes: i64) {
        match self {
            State::Position(point) => point.move_by(bytes),
            State::Full { entries, span } => both(entries, span, bytes),
        }
    }
}

impl Moved for Connectivity {
    fn move_by(&mut self, bytes: i64) {
        match self {
            Connectivity::None => {}
            Connectivity::Items(items) => items.move_by(bytes),
        }
    }
}

impl Moved for ConnectivityKind {
    fn move_by(&mut self, bytes: i64) {
        match self {
            ConnectivityKind::Hops(value)
            | ConnectivityKind::Redundancy(value)
            | ConnectivityKind::Every(value) => value.move_by(bytes),
            ConnectivityKind::Range { length, norm } => both(length, norm, bytes),
        }
    }
}

impl Moved for FormulaKind {
    fn move_by(&mut self, bytes: i64) {
        match self {
            FormulaKind::Constant(_) => {}
            FormulaKind::In { robot, region } => both(robot, region, bytes),
            FormulaKind::Name(name) => name.move_by(bytes),
            FormulaKind::Compare { left, op: _, right } => both(left, right, bytes),
            FormulaKind::Unary { op: _, window, operand } => both(window, operand, bytes),
            FormulaKind::Binary { op: _, window, left, right } => {
                window.move_by(bytes);
                both(left, right, bytes);
            }
            FormulaKind::QuantifiedRobot { universal: _, variable, set, body } => {
                both(variable, set, bytes);
                body.move_by(bytes);
            }
            FormulaKind::QuantifiedIndex { universal: _, range, body } => both(range, body, bytes),
            FormulaKind::Parenthesised(inside) => inside.move_by(bytes),
        }
    }
}

impl Moved for TermKind {
    fn move_by(&mut self, bytes: i64) {
        match self {
            TermKind::Count { variable, set, member, region } => {
                both(variable, set, bytes);
                both(member, region, bytes);
            }
            TermKind::In { robot, region } => both(robot, region, bytes),
            TermKind::Constant(value) => value.move_by(bytes),
        }
    }
}

fn both(one: &mut impl Moved, other: &mut impl Moved, bytes: i64) {
    one.move_by(bytes);
    other.move_by(bytes);
}
