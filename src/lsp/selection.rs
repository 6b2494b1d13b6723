//! What an editor selects when a selection is to grow: a token, what stands in its brackets, the expressions
//! and formulas around it, its item, its declaration, the text.

use lsp_types::{Position, SelectionRange};

use super::document::Document;
use crate::source::Span;
use crate::syntax::ast::{
    Connectivity, ConnectivityItem, ConnectivityKind, Coordinate, DynamicsItem, DynamicsKind, Expr, ExprKind,
    FamilyName, Formula, FormulaKind, Inequality, Interval, Item, ItemKind, PieceKind, Point, Reference,
    Shape, State, Sum, TermKind, Window,
};
use crate::syntax::token::{Kind, tokens};

/// The ranges around some positions, for each the innermost with those around it.
pub fn ranges(document: &Document, positions: &[Position]) -> Vec<SelectionRange> {
    let brackets = brackets(&document.source.text);
    positions.iter().map(|position| around(document, &brackets, document.offset(*position))).collect()
}

fn around(document: &Document, brackets: &[Span], offset: u32) -> SelectionRange {
    let mut around = Around { offset, spans: Vec::new() };
    brackets.iter().for_each(|span| around.touches(*span));
    for item in document.file().map_or(&[][..], |file| &file.items) {
        around.item(item);
    }
    around.touches(Span::new(0, document.source.text.len()));
    // The smallest first; of those that cross, which broken brackets can do, the smaller one.
    around.spans.sort_by_key(|span| (span.end - span.start, span.start));
    let mut chain: Vec<Span> = Vec::new();
    for span in around.spans {
        let grows =
            chain.last().is_none_or(|last| span.start <= last.start && last.end <= span.end && span != *last);
        if grows {
            chain.push(span);
        }
    }
    let mut result = None;
    for span in chain.into_iter().rev() {
        result = Some(SelectionRange { range: document.range(span), parent: result.map(Box::new) });
    }
    result.unwrap_or(SelectionRange {
        range: document.range(Span { start: offset, end: offset }),
        parent: None,
    })
}

/// All tokens, and all pairs of brackets: with them, and what stands between.
fn brackets(text: &str) -> Vec<Span> {
    let (mut spans, mut open) = (Vec::new(), Vec::new());
    for token in tokens(text) {
        spans.push(Span::new(token.start, token.start + token.text.len()));
        match token.text {
            _ if token.kind != Kind::Sign => {}
            "(" | "[" | "{" => open.push(token.start),
            ")" | "]" | "}" => {
                if let Some(start) = open.pop() {
                    spans.push(Span::new(start, token.end));
                    let inside = text.get(start + 1..token.start).unwrap_or("");
                    let begin = start + 1 + (inside.len() - inside.trim_start().len());
                    spans.push(Span::new(begin, begin + inside.trim().len()));
                }
            }
            _ => {}
        }
    }
    spans
}

/// Collects the spans that touch an offset.
struct Around {
    offset: u32,
    spans: Vec<Span>,
}

impl Around {
    fn touches(&mut self, span: Span) {
        if span.start <= self.offset && self.offset <= span.end {
            self.spans.push(span);
        }
    }

    fn item(&mut self, item: &Item) {
        if let Some(doc) = &item.doc {
            self.touches(doc.span.to(item.span));
        }
        if self.offset < item.span.start || item.span.end < self.offset {
            return;
        }
        self.touches(item.span);
        match &item.kind {
            ItemKind::Edition(_) | ItemKind::Mission(_) | ItemKind::Minimize(_) => {}
            ItemKind::Param { value, .. } | ItemKind::Let { value, .. } => self.expression(value),
            ItemKind::Workspace(shape) => self.shape(shape),
            ItemKind::Region { name, shape }
            | ItemKind::Obstacle { name, shape, .. }
            | ItemKind::Jammer { name, shape } => {
                self.family(name);
                self.shape(shape);
            }
            ItemKind::Base { name, at } => {
                self.family(name);
                self.point(at);
            }
            ItemKind::Dynamics { items, .. } => items.iter().for_each(|item| self.dynamics_item(item)),
            ItemKind::Robot { name, at, .. } => {
                self.family(name);
                self.state(at);
            }
            ItemKind::Team { members, .. } => self.references(members),
            ItemKind::Separation(length) => self.expression(length),
            ItemKind::Connectivity(Connectivity::None) => {}
            ItemKind::Connectivity(Connectivity::Items(items)) => {
                items.iter().for_each(|item| self.connectivity_item(item));
            }
            ItemKind::Horizon { from, to } => self.range(from, to),
            ItemKind::Goal { formula, .. } | ItemKind::Define { formula, .. } => self.formula(formula),
        }
    }

    fn family(&mut self, name: &FamilyName) {
        for index in &name.indices {
            self.touches(index.variable.span.to(index.to.span));
            self.range(&index.from, &index.to);
        }
    }

    fn range(&mut self, from: &Expr, to: &Expr) {
        self.touches(from.span.to(to.span));
        self.expression(from);
        self.expression(to);
    }

    fn expression(&mut self, expression: &Expr) {
        self.touches(expression.span);
        match &expression.kind {
            ExprKind::Number(_) => {}
            ExprKind::WithUnit(inside, unit) => {
                self.expression(inside);
                self.touches(unit.span);
            }
            ExprKind::Name(reference) => self.reference(reference),
            ExprKind::Call { arguments, .. } => arguments.iter().for_each(|e| self.expression(e)),
            ExprKind::Negate(inside) | ExprKind::Parenthesised(inside) => self.expression(inside),
            ExprKind::Binary { left, right, .. } => {
                self.expression(left);
                self.expression(right);
            }
            ExprKind::Table(rows) => {
                for row in rows {
                    if let (Some(first), Some(last)) = (row.first(), row.last()) {
                        self.touches(first.span.to(last.span));
                    }
                    row.iter().for_each(|entry| self.expression(entry));
                }
            }
        }
    }

    fn reference(&mut self, reference: &Reference) {
        self.touches(reference.span);
        reference.indices.iter().for_each(|index| self.expression(index));
    }

    /// A list with commas.
    fn references(&mut self, list: &[Reference]) {
        if let (Some(first), Some(last)) = (list.first(), list.last()) {
            self.touches(first.span.to(last.span));
        }
        list.iter().for_each(|reference| self.reference(reference));
    }

    fn shape(&mut self, shape: &Shape) {
        self.touches(shape.span);
        for piece in &shape.pieces {
            self.touches(piece.span);
            match &piece.kind {
                PieceKind::Box(from, to) => {
                    self.point(from);
                    self.point(to);
                }
                PieceKind::Ball { center, radius, .. } => {
                    self.point(center);
                    self.coordinate(radius);
                }
                PieceKind::Polygon(points) | PieceKind::Hull(points) => {
                    points.iter().for_each(|p| self.point(p))
                }
                PieceKind::Where(list) => self.inequalities(list),
            }
        }
    }

    fn point(&mut self, point: &Point) {
        self.touches(point.span);
        point.coordinates.iter().for_each(|coordinate| self.coordinate(coordinate));
    }

    fn coordinate(&mut self, coordinate: &Coordinate) {
        self.expression(&coordinate.value);
        if let Some(uncertainty) = &coordinate.uncertainty {
            self.touches(coordinate.value.span.to(uncertainty.span));
            self.expression(uncertainty);
        }
    }

    fn inequalities(&mut self, list: &[Inequality]) {
        for inequality in list {
            self.touches(inequality.span);
            self.expression(&inequality.left);
            self.expression(&inequality.right);
        }
    }

    fn state(&mut self, state: &State) {
        match state {
            State::Position(point) => self.point(point),
            State::Full { entries, span } => {
                self.touches(*span);
                for (name, value) in entries {
                    self.touches(name.span.to(value.span));
                    self.expression(value);
                }
            }
        }
    }

    fn dynamics_item(&mut self, item: &DynamicsItem) {
        if let Some(doc) = &item.doc {
            self.touches(doc.span.to(item.span));
        }
        self.touches(item.span);
        match &item.kind {
            DynamicsKind::Step(value)
            | DynamicsKind::Matrix { value, .. }
            | DynamicsKind::Integrator(value)
            | DynamicsKind::Rejection(value) => self.expression(value),
            DynamicsKind::State(signals) | DynamicsKind::Input(signals) => {
                for signal in signals {
                    let span = signal.name.span.to(signal.unit.span);
                    self.touches(span);
                    self.touches(signal.doc.as_ref().map_or(span, |doc| doc.span.to(span)));
                }
            }
            DynamicsKind::Position(_) | DynamicsKind::Continuous => {}
            DynamicsKind::Bound { interval, .. } | DynamicsKind::Disturbance { interval, .. } => {
                self.interval(interval);
            }
            DynamicsKind::BoundWhere(list) => self.inequalities(list),
            DynamicsKind::Mode { when, items, .. } => {
                self.inequalities(when);
                items.iter().for_each(|item| self.dynamics_item(item));
            }
        }
    }

    fn interval(&mut self, interval: &Interval) {
        self.touches(interval.span);
        self.expression(&interval.from);
        self.expression(&interval.to);
    }

    fn connectivity_item(&mut self, item: &ConnectivityItem) {
        self.touches(item.span);
        match &item.kind {
            ConnectivityKind::Hops(value)
            | ConnectivityKind::Range { length: value, .. }
            | ConnectivityKind::Redundancy(value)
            | ConnectivityKind::Every(value) => self.expression(value),
        }
    }

    fn formula(&mut self, formula: &Formula) {
        self.touches(formula.span);
        match &formula.kind {
            FormulaKind::Constant(_) | FormulaKind::Name(_) => {}
            FormulaKind::In { robot, region } => {
                self.reference(robot);
                self.reference(region);
            }
            FormulaKind::Compare { left, right, .. } => {
                self.sum(left);
                self.sum(right);
            }
            FormulaKind::Unary { window, operand, .. } => {
                self.window(window.as_ref());
                self.formula(operand);
            }
            FormulaKind::Binary { window, left, right, .. } => {
                self.formula(left);
                self.window(window.as_ref());
                self.formula(right);
            }
            FormulaKind::QuantifiedRobot { set, body, .. } => {
                self.references(set);
                self.formula(body);
            }
            FormulaKind::QuantifiedIndex { range, body, .. } => {
                self.range(&range.from, &range.to);
                self.formula(body);
            }
            FormulaKind::Parenthesised(inside) => self.formula(inside),
        }
    }

    fn window(&mut self, window: Option<&Window>) {
        if let Some(window) = window {
            self.touches(window.span);
            self.expression(&window.from);
            self.expression(&window.to);
        }
    }

    fn sum(&mut self, sum: &Sum) {
        self.touches(sum.span);
        for term in &sum.terms {
            self.touches(term.span);
            if let Some(factor) = &term.factor {
                self.expression(factor);
            }
            match &term.kind {
                TermKind::Count { set, member, region, .. } => {
                    self.references(set);
                    self.touches(member.span.to(region.span));
                    self.reference(member);
                    self.reference(region);
                }
                TermKind::In { robot, region } => {
                    self.touches(robot.span.to(region.span));
                    self.reference(robot);
                    self.reference(region);
                }
                TermKind::Constant(value) => self.expression(value),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::driver::Overrides;
    use crate::lsp::lines::Encoding;

    fn document(text: &str) -> Document {
        let uri = "file:///tmp/m.dosm".parse().expect("it is a URI");
        Document::new(uri, 1, text.into(), Encoding::Utf8, Overrides::default())
    }

    /// The texts that are selected one after the other, from the cursor `|` on.
    #[track_caller]
    fn check(text: &str, expected: &[&str]) {
        let at = text.find('|').expect("a cursor");
        let document = document(&text.replacen('|', "", 1));
        let position = document.lines.position(at as u32);
        let mut range = ranges(&document, &[position]).pop();
        let mut texts = Vec::new();
        while let Some(SelectionRange { range: inner, parent }) = range {
            texts.push(document.source.slice(document.lines.span_of(inner)).to_string());
            range = parent.map(|parent| *parent);
        }
        let whole = document.source.text.as_str();
        assert_eq!(texts.iter().map(String::as_str).filter(|t| *t != whole).collect::<Vec<_>>(), expected);
        assert_eq!(texts.last().map(String::as_str), Some(whole));
    }

    #[test]
    fn a_selection_grows_by_what_the_language_has() {
        check(
            "dosm 1 let a = 1 + 2 * max(3, |40) let b = 1",
            &[
                "40",
                "3, 40",
                "(3, 40)",
                "max(3, 40)",
                "2 * max(3, 40)",
                "1 + 2 * max(3, 40)",
                "let a = 1 + 2 * max(3, 40)",
            ],
        );
        check(
            "dosm 1 goal g: always (R1 in pi|1 and R2 in b)",
            &[
                "pi1",
                "R1 in pi1",
                "R1 in pi1 and R2 in b",
                "(R1 in pi1 and R2 in b)",
                "always (R1 in pi1 and R2 in b)",
                "goal g: always (R1 in pi1 and R2 in b)",
            ],
        );
        check(
            "dosm 1 dynamics D { step 1 s state p|x: m, vx: m/s } let a = 1",
            &[
                "px",
                "px: m",
                "state px: m, vx: m/s",
                "step 1 s state px: m, vx: m/s",
                "{ step 1 s state px: m, vx: m/s }",
                "dynamics D { step 1 s state px: m, vx: m/s }",
            ],
        );
        check("dosm 1\n/// why\nlet a| = 1\nlet b = 2", &["a", "let a = 1", "/// why\nlet a = 1"]);
        check(
            "dosm 1 let P = [1, 2; |3, 4]",
            &["3", "3, 4", "1, 2; 3, 4", "[1, 2; 3, 4]", "let P = [1, 2; 3, 4]"],
        );
    }

    #[test]
    fn broken_texts_have_tokens_and_brackets() {
        check("dosm 1 region a = bax (1, |2", &["2"]);
        check("dosm 1 region a = bax (1, |2) ] let b", &["2", "1, 2", "(1, 2)"]);
        check("|", &[]);
    }
}
