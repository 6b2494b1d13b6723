//! Building shapes, points and inequalities.

use crate::syntax::ast::{Comparison, Coordinate, Inequality, Norm, Piece, PieceKind, Point, Shape};
use crate::syntax::builder::Builder;
use crate::syntax::grammar::{Built, Children, Node, Rule, Stop};

impl Builder<'_> {
    /// A shape.
    pub(super) fn shape(&mut self, node: Node) -> Built<Shape> {
        let span = self.span(&node);
        let pieces = Children::of(node).map(|piece| self.piece(piece)).collect::<Built<_>>()?;
        Ok(Shape { pieces, span })
    }

    fn piece(&mut self, node: Node) -> Built<Piece> {
        let span = self.span(&node);
        let node = Children::of(node).expect_any()?;
        let rule = node.as_rule();
        let mut children = Children::of(node);
        let kind = match rule {
            Rule::box_shape => {
                let low = self.point(children.expect(Rule::point)?)?;
                PieceKind::Box(low, self.point(children.expect(Rule::point)?)?)
            }
            Rule::polygon => PieceKind::Polygon(self.points(children)?),
            Rule::hull => PieceKind::Hull(self.points(children)?),
            Rule::half_spaces => PieceKind::Where(self.inequalities(children.expect(Rule::inequalities)?)?),
            _ => PieceKind::Ball {
                center: self.point(children.expect(Rule::point)?)?,
                radius: self.coordinate(children.expect(Rule::coordinate)?)?,
                norm: self.norm(&mut children)?,
                disc: rule == Rule::disc,
            },
        };
        Ok(Piece { span, kind })
    }

    fn points(&mut self, children: Children) -> Built<Vec<Point>> {
        children.map(|point| self.point(point)).collect()
    }

    /// The number behind `norm`, where there is one.
    pub(super) fn norm(&mut self, children: &mut Children) -> Built<Option<Norm>> {
        match children.take_if(Rule::number) {
            Some(number) => Ok(Some(Norm { value: self.number(number)? })),
            None => Ok(None),
        }
    }

    /// A point.
    pub(super) fn point(&mut self, node: Node) -> Built<Point> {
        let mark = self.units_read();
        let span = self.span(&node);
        let mut children = Children::of(node);
        let mut coordinates = Vec::new();
        while let Some(coordinate) = children.take_if(Rule::coordinate) {
            coordinates.push(self.coordinate(coordinate)?);
        }
        let unit = self.trailing_unit(children.take_if(Rule::unit), mark)?;
        Ok(Point { coordinates, unit, span })
    }

    fn coordinate(&mut self, node: Node) -> Built<Coordinate> {
        let mut children = Children::of(node);
        let value = self.expression(children.expect(Rule::expression)?)?;
        children.take_if(Rule::plus_minus);
        let uncertainty = match children.take_if(Rule::expression) {
            Some(uncertainty) => Some(self.expression(uncertainty)?),
            None => None,
        };
        Ok(Coordinate { value, uncertainty })
    }

    /// Inequalities in braces.
    pub(super) fn inequalities(&mut self, node: Node) -> Built<Vec<Inequality>> {
        Children::of(node).map(|inequality| self.inequality(inequality)).collect()
    }

    fn inequality(&mut self, node: Node) -> Built<Inequality> {
        let span = self.span(&node);
        let mut children = Children::of(node);
        let left = self.expression(children.expect(Rule::expression)?)?;
        let comparator = children.expect(Rule::comparator)?;
        let (op, op_span) = (comparison(comparator.as_str())?, self.span(&comparator));
        let right = self.expression(children.expect(Rule::expression)?)?;
        Ok(Inequality { left, op, op_span, right, span })
    }
}

/// The comparison that a sign stands for.
pub(super) fn comparison(sign: &str) -> Built<Comparison> {
    Ok(match sign {
        "=" => Comparison::Equal,
        "!=" => Comparison::NotEqual,
        "<" => Comparison::Less,
        "<=" => Comparison::LessEqual,
        ">" => Comparison::Greater,
        ">=" => Comparison::GreaterEqual,
        _ => return Err(Stop),
    })
}
