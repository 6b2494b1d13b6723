//! The second pass: what every name in the tree means where it stands.

use std::collections::BTreeMap;

use crate::check::dimension;
use crate::lsp::index::declared::{family, symbol};
use crate::lsp::index::{Builtin, Index, Occurrence, Role, Symbol, SymbolId, SymbolKind};
use crate::source::Span;
use crate::syntax::ast::{
    Connectivity, ConnectivityKind, Coordinate, DynamicsItem, DynamicsKind, Expr, ExprKind, FamilyName, File,
    Formula, FormulaKind, IndexRange, Inequality, Item, ItemKind, Name, Piece, PieceKind, Point, Reference,
    Shape, State, Sum, TermKind,
};
use crate::syntax::words::{COORDINATES, FUNCTIONS, PREDECLARED};

/// What unindexed names in an expression may mean before all else.
#[derive(Clone, Copy, PartialEq, Eq)]
enum First {
    /// Nothing.
    Nothing,
    /// The first so many of `x`, `y`, `z`.
    Axes(usize),
    /// The states and inputs of a model.
    Signals(SymbolId),
}

/// The pass over the tree.
struct Walk<'f, 'i> {
    index: &'i mut Index,
    /// 2 or 3.
    dimension: usize,
    /// What each bound name means, innermost last.
    bound: BTreeMap<&'f str, Vec<SymbolId>>,
    /// The item that is walked, by its place in the file.
    item: usize,
}

/// A step of the walk over a formula.
enum Task<'f> {
    Visit(&'f Formula),
    Unbind(&'f str),
}

impl Index {
    /// Finds out what the names of a file mean, once its declarations are known.
    pub(super) fn resolve(&mut self, file: &File) {
        let dimension = dimension(&file.items);
        // A model's symbol by the place of its name: with two of one name, each has its own signals.
        let models: BTreeMap<Span, SymbolId> = self
            .symbols
            .iter()
            .filter(|(_, s)| s.kind == SymbolKind::Dynamics)
            .map(|(id, s)| (s.place, id))
            .collect();
        let mut walk = Walk { index: self, dimension, bound: BTreeMap::new(), item: 0 };
        for (place, item) in file.items.iter().enumerate() {
            walk.item = place;
            walk.item(item, &models);
        }
    }
}

impl<'f> Walk<'f, '_> {
    fn item(&mut self, item: &'f Item, models: &BTreeMap<Span, SymbolId>) {
        if let Some(family) = family(&item.kind) {
            self.open_family(family, item.span);
        }
        match &item.kind {
            ItemKind::Param { value, .. } | ItemKind::Let { value, .. } => self.expr(value, First::Nothing),
            ItemKind::Workspace(shape)
            | ItemKind::Region { shape, .. }
            | ItemKind::Obstacle { shape, .. }
            | ItemKind::Jammer { shape, .. } => self.shape(shape),
            ItemKind::Base { at, .. } => self.point(at),
            ItemKind::Dynamics { name, items } => {
                if let Some(&model) = models.get(&name.span) {
                    self.dynamics(model, items);
                }
            }
            ItemKind::Robot { dynamics, at, .. } => self.robot(dynamics, at),
            ItemKind::Team { members, .. } => self.references(members),
            ItemKind::Separation(expr) => self.expr(expr, First::Nothing),
            ItemKind::Connectivity(Connectivity::Items(items)) => {
                items.iter().for_each(|item| self.connectivity(&item.kind));
            }
            ItemKind::Horizon { from, to } => {
                [from, to].into_iter().for_each(|e| self.expr(e, First::Nothing))
            }
            ItemKind::Goal { formula, .. } | ItemKind::Define { formula, .. } => self.formula(formula),
            ItemKind::Edition(_)
            | ItemKind::Mission(_)
            | ItemKind::Connectivity(Connectivity::None)
            | ItemKind::Minimize(_) => {}
        }
        self.bound.clear();
    }

    /// Brings a family's indices into scope; their ranges don't see each other.
    fn open_family(&mut self, name: &'f FamilyName, scope: Span) {
        for index in &name.indices {
            self.range(index);
        }
        for index in &name.indices {
            self.bind(&index.variable, SymbolKind::IndexVariable, scope);
        }
    }

    fn range(&mut self, index: &'f IndexRange) {
        self.expr(&index.from, First::Nothing);
        self.expr(&index.to, First::Nothing);
    }

    /// Declares a bound variable.
    fn bind(&mut self, name: &'f Name, kind: SymbolKind, scope: Span) {
        let item = Some(self.item);
        let symbol = Symbol { item, scope: Some(scope), ..symbol(name, kind, scope, &None) };
        let id = self.index.add(symbol);
        self.bound.entry(&name.text).or_default().push(id);
    }

    fn unbind(&mut self, name: &str) {
        if let Some(stack) = self.bound.get_mut(name) {
            stack.pop();
        }
    }

    fn occurrence(&mut self, span: Span, symbol: SymbolId, role: Role) {
        self.index.occurrences.push(Occurrence { span, symbol, role });
    }

    /// A name that is bound or else declared in the mission's name space.
    fn name(&mut self, name: &'f Name) {
        let bound = self.bound.get(name.text.as_str()).and_then(|stack| stack.last().copied());
        match bound.or_else(|| self.index.global(&name.text)) {
            Some(symbol) => self.occurrence(name.span, symbol, Role::Read),
            None => self.index.unresolved.push(name.span),
        }
    }

    /// The name of a state or an input of a model.
    fn signal(&mut self, model: Option<SymbolId>, name: &Name, role: Role) {
        match model.and_then(|model| self.index.signal(model, &name.text)) {
            Some(signal) => self.occurrence(name.span, signal, role),
            None => self.index.unresolved.push(name.span),
        }
    }

    fn references(&mut self, list: &'f [Reference]) {
        for reference in list {
            self.reference(reference);
        }
    }

    /// A robot, region, team or family, with the expressions of its indices.
    fn reference(&mut self, reference: &'f Reference) {
        if reference.name.text == "all" && reference.indices.is_empty() {
            self.index.builtins.push((reference.name.span, Builtin::All));
            return;
        }
        self.name(&reference.name);
        for index in &reference.indices {
            self.expr(index, First::Nothing);
        }
    }

    /// Everything that an expression mentions, on a stack of its own.
    fn expr(&mut self, expr: &'f Expr, first: First) {
        let mut stack = vec![expr];
        while let Some(expr) = stack.pop() {
            match &expr.kind {
                ExprKind::Number(_) => {}
                ExprKind::WithUnit(inner, _) | ExprKind::Negate(inner) | ExprKind::Parenthesised(inner) => {
                    stack.push(inner);
                }
                ExprKind::Name(reference) => {
                    self.value(reference, first);
                    stack.extend(&reference.indices);
                }
                ExprKind::Call { function, arguments } => {
                    self.function(function);
                    stack.extend(arguments);
                }
                ExprKind::Binary { left, right, .. } => stack.extend([&**left, &**right]),
                ExprKind::Table(rows) => stack.extend(rows.iter().flatten()),
            }
        }
    }

    /// A name in an expression, in the order in which the language looks: coordinates, bound variables,
    /// `pi`, the mission's names.
    fn value(&mut self, reference: &'f Reference, first: First) {
        let name = &reference.name;
        let bound = self.bound.get(name.text.as_str()).is_some_and(|stack| !stack.is_empty());
        if reference.indices.is_empty() {
            match first {
                First::Axes(count) if axes(count).contains(&name.text.as_str()) => {
                    self.index.builtins.push((name.span, Builtin::Coordinate));
                    return;
                }
                First::Signals(model) if self.index.signal(model, &name.text).is_some() => {
                    self.signal(Some(model), name, Role::Read);
                    return;
                }
                _ => {}
            }
        }
        if !bound && PREDECLARED.contains(&name.text.as_str()) {
            let builtin = if name.text == "pi" { Builtin::Constant } else { Builtin::Function };
            self.index.builtins.push((name.span, builtin));
            return;
        }
        self.name(name);
    }

    fn function(&mut self, function: &Name) {
        if FUNCTIONS.contains(&function.text.as_str()) {
            self.index.builtins.push((function.span, Builtin::Function));
        } else {
            self.index.unresolved.push(function.span);
        }
    }

    fn shape(&mut self, shape: &'f Shape) {
        shape.pieces.iter().for_each(|piece| self.piece(piece));
    }

    fn piece(&mut self, piece: &'f Piece) {
        match &piece.kind {
            PieceKind::Box(p, q) => [p, q].into_iter().for_each(|point| self.point(point)),
            PieceKind::Ball { center, radius, .. } => {
                self.point(center);
                self.coordinate(radius);
            }
            PieceKind::Polygon(points) | PieceKind::Hull(points) => {
                points.iter().for_each(|point| self.point(point));
            }
            PieceKind::Where(list) => self.inequalities(list, First::Axes(self.dimension)),
        }
    }

    fn point(&mut self, point: &'f Point) {
        point.coordinates.iter().for_each(|coordinate| self.coordinate(coordinate));
    }

    fn coordinate(&mut self, coordinate: &'f Coordinate) {
        self.expr(&coordinate.value, First::Nothing);
        if let Some(uncertainty) = &coordinate.uncertainty {
            self.expr(uncertainty, First::Nothing);
        }
    }

    fn inequalities(&mut self, list: &'f [Inequality], first: First) {
        for inequality in list {
            self.expr(&inequality.left, first);
            self.expr(&inequality.right, first);
        }
    }

    fn dynamics(&mut self, model: SymbolId, items: &'f [DynamicsItem]) {
        for item in items {
            match &item.kind {
                DynamicsKind::Step(expr)
                | DynamicsKind::Integrator(expr)
                | DynamicsKind::Rejection(expr)
                | DynamicsKind::Matrix { value: expr, .. } => self.expr(expr, First::Nothing),
                DynamicsKind::Position(names) => {
                    names.iter().for_each(|name| self.signal(Some(model), name, Role::Read));
                }
                DynamicsKind::Bound { names, interval } | DynamicsKind::Disturbance { names, interval } => {
                    names.iter().for_each(|name| self.signal(Some(model), name, Role::Write));
                    self.expr(&interval.from, First::Nothing);
                    self.expr(&interval.to, First::Nothing);
                }
                DynamicsKind::BoundWhere(list) => self.inequalities(list, First::Signals(model)),
                DynamicsKind::Mode { when, items, .. } => {
                    self.inequalities(when, First::Signals(model));
                    self.dynamics(model, items);
                }
                DynamicsKind::State(_) | DynamicsKind::Input(_) | DynamicsKind::Continuous => {}
            }
        }
    }

    /// A robot's model, which no index hides, and its start.
    fn robot(&mut self, dynamics: &'f Name, at: &'f State) {
        let model = self.index.global(&dynamics.text);
        match model {
            Some(symbol) => self.occurrence(dynamics.span, symbol, Role::Read),
            None => self.index.unresolved.push(dynamics.span),
        }
        match at {
            State::Position(point) => self.point(point),
            State::Full { entries, .. } => {
                for (name, value) in entries {
                    self.signal(model, name, Role::Write);
                    self.expr(value, First::Nothing);
                }
            }
        }
    }

    fn connectivity(&mut self, kind: &'f ConnectivityKind) {
        match kind {
            ConnectivityKind::Hops(expr)
            | ConnectivityKind::Range { length: expr, .. }
            | ConnectivityKind::Redundancy(expr)
            | ConnectivityKind::Every(expr) => self.expr(expr, First::Nothing),
        }
    }

    /// Everything that a formula mentions, on a stack of its own.
    fn formula(&mut self, formula: &'f Formula) {
        let mut tasks = vec![Task::Visit(formula)];
        while let Some(task) = tasks.pop() {
            match task {
                Task::Visit(formula) => self.visit(formula, &mut tasks),
                Task::Unbind(name) => self.unbind(name),
            }
        }
    }

    fn visit(&mut self, formula: &'f Formula, tasks: &mut Vec<Task<'f>>) {
        match &formula.kind {
            FormulaKind::Constant(_) => {}
            FormulaKind::In { robot, region } => [robot, region].into_iter().for_each(|r| self.reference(r)),
            FormulaKind::Name(name) => self.name(name),
            FormulaKind::Compare { left, right, .. } => {
                [left, right].into_iter().for_each(|sum| self.sum(sum))
            }
            FormulaKind::Unary { window, operand, .. } => {
                window
                    .iter()
                    .for_each(|w| [&w.from, &w.to].into_iter().for_each(|e| self.expr(e, First::Nothing)));
                tasks.push(Task::Visit(operand));
            }
            FormulaKind::Binary { window, left, right, .. } => {
                window
                    .iter()
                    .for_each(|w| [&w.from, &w.to].into_iter().for_each(|e| self.expr(e, First::Nothing)));
                tasks.extend([Task::Visit(right), Task::Visit(left)]);
            }
            FormulaKind::QuantifiedRobot { variable, set, body, .. } => {
                self.references(set);
                self.bind(variable, SymbolKind::RobotVariable, formula.span);
                tasks.extend([Task::Unbind(&variable.text), Task::Visit(body)]);
            }
            FormulaKind::QuantifiedIndex { range, body, .. } => {
                self.range(range);
                self.bind(&range.variable, SymbolKind::IndexVariable, formula.span);
                tasks.extend([Task::Unbind(&range.variable.text), Task::Visit(body)]);
            }
            FormulaKind::Parenthesised(inner) => tasks.push(Task::Visit(inner)),
        }
    }

    fn sum(&mut self, sum: &'f Sum) {
        for term in &sum.terms {
            if let Some(factor) = &term.factor {
                self.expr(factor, First::Nothing);
            }
            match &term.kind {
                TermKind::Constant(expr) => self.expr(expr, First::Nothing),
                TermKind::In { robot, region } => [robot, region].into_iter().for_each(|r| self.reference(r)),
                TermKind::Count { variable, set, member, region } => {
                    // The region is read outside of the variable's scope: that is the checker's rule.
                    self.references(set);
                    self.reference(region);
                    self.bind(variable, SymbolKind::RobotVariable, term.span);
                    self.reference(member);
                    self.unbind(&variable.text);
                }
            }
        }
    }
}

/// The first so many coordinates.
fn axes(count: usize) -> &'static [&'static str] {
    &COORDINATES[..count.min(COORDINATES.len())]
}
