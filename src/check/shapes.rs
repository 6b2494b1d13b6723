//! Shapes: points, boxes, balls, polygons, hulls and half-spaces, always with an interior.

use crate::check::expression::{Scope, Value};
use crate::check::families::Family;
use crate::check::uncertain::{BallNorm, BallNumbers};
use crate::check::{Checker, Entry, doc_text, messages, typed};
use crate::diag::Reported;
use crate::exact::Rational;
use crate::geometry::{HalfSpace, Polytope, ShapeError};
use crate::ir::BlockerKind;
use crate::quantity::{Dimension, in_range};
use crate::source::Span;
use crate::syntax::ast::{
    Comparison, Coordinate, FamilyName, Inequality, Item, ItemKind, Norm, Piece, PieceKind, Point, Shape,
    State,
};

/// The most corners of a polygon, points of a hull or half-spaces of a `where`.
pub(super) const MAX_PARTS: usize = 256;

/// The same in space, where exact hulls take the cube of it.
const MAX_PARTS_IN_SPACE: usize = 48;

impl Checker<'_> {
    /// The workspace, which fixes the dimension of every shape.
    pub(super) fn workspace(&mut self) {
        let file = self.file;
        let mut first: Option<&Item> = None;
        for item in &file.items {
            let ItemKind::Workspace(shape) = &item.kind else { continue };
            if let Some(first) = first {
                self.report(messages::repeated("workspace", first.span, item.span));
                continue;
            }
            first = Some(item);
            self.workspace = Some(self.workspace_shape(shape, item.span));
        }
        if first.is_some() {
            return;
        }
        // Not each point shall be wrong only because the workspace could not be read.
        self.dimension = dimension(&file.items);
        if !file.has_broken_keyword("workspace") {
            self.report(messages::missing_workspace(file.span));
        }
    }

    fn workspace_shape(&mut self, shape: &Shape, span: Span) -> Result<typed::Workspace, Reported> {
        self.dimension = dimension_of(shape).unwrap_or(2);
        let [piece] = &shape.pieces[..] else {
            return Err(self.report(messages::workspace_union(shape.span)));
        };
        let scope = Scope::default();
        let whole = self.piece(piece, &scope)?;
        match self.sure_piece(piece, &scope)?.unwrap_or(Some(whole)) {
            None => Err(self.report(messages::nothing_sure(piece.span))),
            Some(typed::Piece::Polytope(polytope)) => Ok(typed::Workspace { polytope, span }),
            Some(typed::Piece::Ball { .. }) => Err(self.report(messages::round_workspace(piece.span))),
        }
    }

    /// Regions, obstacles, jammers and bases, members of families one by one.
    pub(super) fn declare_shapes(&mut self) {
        let file = self.file;
        for (index, item) in file.items.iter().enumerate() {
            let family = match &item.kind {
                ItemKind::Region { name, shape } => self.region(name, shape, item),
                ItemKind::Obstacle { opaque, name, shape } => {
                    let kind = if *opaque { BlockerKind::OpaqueObstacle } else { BlockerKind::Obstacle };
                    self.blocker(kind, name, shape, item)
                }
                ItemKind::Jammer { name, shape } => self.blocker(BlockerKind::Jammer, name, shape, item),
                ItemKind::Base { name, at } => self.base(name, at, item),
                _ => continue,
            };
            self.entries[index] = Entry::Family(family);
        }
    }

    fn region(&mut self, name: &FamilyName, shape: &Shape, item: &Item) -> Result<Family, Reported> {
        let (family, members) = self.family(name, self.regions.len())?;
        let mut failed = false;
        for member in members {
            let both = if failed { None } else { self.region_shape(shape, &member.scope).ok() };
            failed = both.is_none();
            let (name, doc, span) = (member.name, doc_text(&item.doc), item.span);
            self.regions.push(both.map(|(shape, sure)| typed::Region { name, doc, shape, sure, span }));
        }
        Ok(family)
    }

    fn blocker(
        &mut self,
        kind: BlockerKind,
        name: &FamilyName,
        shape: &Shape,
        item: &Item,
    ) -> Result<Family, Reported> {
        let (family, members) = self.family(name, self.blockers.len())?;
        let mut failed = false;
        for member in members {
            let shape = if failed { None } else { self.shape(shape, &member.scope).ok() };
            failed = shape.is_none();
            let (doc, span) = (doc_text(&item.doc), item.span);
            self.blockers.push(shape.map(|shape| typed::Blocker {
                name: member.name,
                doc,
                kind,
                shape,
                span,
            }));
        }
        Ok(family)
    }

    fn base(&mut self, name: &FamilyName, at: &Point, item: &Item) -> Result<Family, Reported> {
        let (family, members) = self.family(name, self.bases.len())?;
        let mut failed = false;
        for member in members {
            let position = if failed { None } else { self.point(at, &member.scope).ok() };
            failed = position.is_none();
            let (doc, span) = (doc_text(&item.doc), item.span);
            self.bases.push(position.map(|position| typed::Base { name: member.name, doc, position, span }));
        }
        Ok(family)
    }

    fn shape(&mut self, shape: &Shape, scope: &Scope) -> Result<typed::Shape, Reported> {
        // Every piece is looked at, so that the errors of all of them are found.
        let pieces: Vec<_> = shape.pieces.iter().map(|piece| self.piece(piece, scope)).collect();
        Ok(typed::Shape { pieces: pieces.into_iter().collect::<Result<_, _>>()? })
    }

    /// A region's shape, and what is certain of it where it is uncertain.
    fn region_shape(
        &mut self,
        shape: &Shape,
        scope: &Scope,
    ) -> Result<(typed::Shape, Option<typed::Shape>), Reported> {
        let whole = self.shape(shape, scope)?;
        let mut uncertain = false;
        let mut pieces = Vec::new();
        for (piece, whole) in shape.pieces.iter().zip(&whole.pieces) {
            let sure = self.sure_piece(piece, scope)?;
            uncertain |= sure.is_some();
            pieces.extend(sure.unwrap_or_else(|| Some(whole.clone())));
        }
        Ok((whole, uncertain.then_some(typed::Shape { pieces })))
    }

    /// What is certain of an uncertain ball; `None` for any other piece.
    fn sure_piece(&mut self, piece: &Piece, scope: &Scope) -> Result<Option<Option<typed::Piece>>, Reported> {
        let PieceKind::Ball { center, radius, norm, disc } = &piece.kind else { return Ok(None) };
        let ball = self.ball_numbers(center, radius, norm, *disc, scope)?;
        Ok(ball.is_uncertain().then(|| ball.sure()))
    }

    fn piece(&mut self, piece: &Piece, scope: &Scope) -> Result<typed::Piece, Reported> {
        let shape = match &piece.kind {
            PieceKind::Ball { center, radius, norm, disc } => {
                let ball = self.ball_numbers(center, radius, norm, *disc, scope)?;
                self.ball(ball, center.span)?
            }
            _ => typed::Piece::Polytope(self.polytope(piece, scope)?),
        };
        if is_in_range(&shape) {
            Ok(shape)
        } else {
            Err(self.report(messages::number_out_of_range(piece.span)))
        }
    }

    fn polytope(&mut self, piece: &Piece, scope: &Scope) -> Result<Polytope, Reported> {
        match &piece.kind {
            PieceKind::Box(p, q) => self.box_shape(p, q, scope, piece.span),
            PieceKind::Ball { .. } => Err(self.report(messages::round_workspace(piece.span))),
            PieceKind::Polygon(points) => {
                if self.dimension != 2 {
                    return Err(self.report(messages::polygon_in_space(piece.span)));
                }
                let corners = self.points(points, piece.span, scope)?;
                Polytope::polygon(&corners)
                    .map_err(|e| self.report(messages::bad_points("polygon", piece.span, points, &e)))
            }
            PieceKind::Hull(points) => {
                let corners = self.points(points, piece.span, scope)?;
                Polytope::hull(&corners)
                    .map_err(|e| self.report(messages::bad_points("hull", piece.span, points, &e)))
            }
            PieceKind::Where(inequalities) => self.half_spaces(inequalities, scope, piece.span),
        }
    }

    /// The most corners, points or half-spaces of a piece.
    fn most_parts(&self) -> usize {
        if self.dimension == 2 { MAX_PARTS } else { MAX_PARTS_IN_SPACE }
    }

    fn points(
        &mut self,
        points: &[Point],
        span: Span,
        scope: &Scope,
    ) -> Result<Vec<Vec<Rational>>, Reported> {
        if points.len() > self.most_parts() {
            return Err(self.report(messages::too_many_parts(span, points.len(), self.most_parts())));
        }
        let all: Vec<_> = points.iter().map(|p| self.point(p, scope)).collect();
        all.into_iter().collect()
    }

    /// A point's coordinates in metres.
    pub(super) fn point(&mut self, point: &Point, scope: &Scope) -> Result<Vec<Rational>, Reported> {
        if let Some(uncertainty) = point.coordinates.iter().find_map(|c| c.uncertainty.as_ref()) {
            return Err(self.report(messages::misplaced_uncertainty(uncertainty.span)));
        }
        self.coordinates(point, |c| Some(&c.value), scope)
    }

    /// One number a coordinate, in metres; 0 where `part` picks nothing.
    fn coordinates<'p>(
        &mut self,
        point: &'p Point,
        part: impl Fn(&'p Coordinate) -> Option<&'p crate::syntax::ast::Expr>,
        scope: &Scope,
    ) -> Result<Vec<Rational>, Reported> {
        if point.coordinates.len() != self.dimension {
            let (found, wanted) = (point.coordinates.len(), self.dimension);
            return Err(self.report(messages::wrong_point_dimension(point.span, found, wanted)));
        }
        let mut numbers = Vec::new();
        for coordinate in &point.coordinates {
            numbers.push(match part(coordinate) {
                Some(expr) => self.quantity_in(expr, point.unit.as_ref(), scope, Dimension::LENGTH)?,
                None => Rational::ZERO,
            });
        }
        Ok(numbers)
    }

    fn box_shape(&mut self, p: &Point, q: &Point, scope: &Scope, span: Span) -> Result<Polytope, Reported> {
        let lo = self.point(p, scope);
        let hi = self.point(q, scope);
        let (lo, hi) = (lo?, hi?);
        if lo.iter().zip(&hi).any(|(a, b)| a == b) {
            return Err(self.report(messages::flat_shape(span, "two of the box's sides coincide")));
        }
        if lo.iter().zip(&hi).any(|(a, b)| a > b) {
            return Err(self.report(messages::box_corners_swapped((p, q), &lo, &hi)));
        }
        Ok(Polytope::from_box(&lo, &hi))
    }

    /// Every ball that it may be: box(center ± spread) ⊕ ball(radius + growth).
    fn ball(&mut self, ball: BallNumbers, span: Span) -> Result<typed::Piece, Reported> {
        let BallNumbers { norm, center, spread, radius, growth } = ball;
        let radius = radius + growth;
        Ok(match norm {
            BallNorm::Infinity => typed::Piece::Polytope(cube(&center, &spread, &radius)),
            BallNorm::One => typed::Piece::Polytope(self.cross_polytope(&center, &spread, &radius, span)?),
            BallNorm::Two => typed::Piece::Ball { center, spread, radius },
        })
    }

    fn ball_numbers(
        &mut self,
        center: &Point,
        radius: &Coordinate,
        norm: &Option<Norm>,
        disc: bool,
        scope: &Scope,
    ) -> Result<BallNumbers, Reported> {
        let norm = self.ball_norm(norm, disc, center.span)?;
        let uncertain = center.coordinates.iter().chain([radius]).find_map(|c| c.uncertainty.as_ref());
        let middle = self.coordinates(center, |c| Some(&c.value), scope)?;
        let spread = self.coordinates(center, |c| c.uncertainty.as_ref(), scope)?;
        let size = self.quantity(&radius.value, scope, Dimension::LENGTH)?;
        let growth = match &radius.uncertainty {
            Some(expr) => self.quantity(expr, scope, Dimension::LENGTH)?,
            None => Rational::ZERO,
        };
        if !size.is_positive() {
            return Err(self.report(messages::bad_radius(radius.value.span, &size)));
        }
        if let Some((uncertainty, _)) =
            uncertain.zip(spread.iter().chain([&growth]).find(|s| s.is_negative()))
        {
            return Err(self.report(messages::negative_uncertainty(uncertainty.span)));
        }
        Ok(BallNumbers { norm, center: middle, spread, radius: size, growth })
    }

    fn ball_norm(&mut self, norm: &Option<Norm>, disc: bool, span: Span) -> Result<BallNorm, Reported> {
        if let (Some(norm), true) = (norm, disc)
            && norm.value.value != 2
        {
            return Err(self.report(messages::unknown_norm(norm.value.span, &norm.value.value)));
        }
        if disc && self.dimension != 2 {
            return Err(self.report(messages::disc_in_space(span)));
        }
        match norm {
            None if disc => Ok(BallNorm::Two),
            None => Ok(BallNorm::Infinity),
            Some(norm) if norm.value.value == 2 => Ok(BallNorm::Two),
            Some(norm) if norm.value.value == 1 => Ok(BallNorm::One),
            Some(norm) => Err(self.report(messages::unknown_norm(norm.value.span, &norm.value.value))),
        }
    }

    /// box(center ± spread) ⊕ {‖·‖₁ ≤ radius}, as the hull of the vertices' sums.
    fn cross_polytope(
        &mut self,
        center: &[Rational],
        spread: &[Rational],
        radius: &Rational,
        span: Span,
    ) -> Result<Polytope, Reported> {
        let mut corners = vec![center.to_vec()];
        for (axis, extent) in spread.iter().enumerate().filter(|(_, s)| !s.is_zero()) {
            corners =
                corners.iter().flat_map(|c| [moved(c, axis, extent), moved(c, axis, &-extent)]).collect();
        }
        let tips = |c: &Vec<Rational>| -> Vec<Vec<Rational>> {
            (0..center.len()).flat_map(|axis| [moved(c, axis, radius), moved(c, axis, &-radius)]).collect()
        };
        let points: Vec<Vec<Rational>> = corners.iter().flat_map(tips).collect();
        Polytope::hull(&points).map_err(|e| self.report(messages::bad_points("ball", span, &[], &e)))
    }

    fn half_spaces(
        &mut self,
        inequalities: &[Inequality],
        scope: &Scope,
        span: Span,
    ) -> Result<Polytope, Reported> {
        if inequalities.len() > self.most_parts() {
            return Err(self.report(messages::too_many_parts(span, inequalities.len(), self.most_parts())));
        }
        let axes = ["x", "y", "z"].iter().take(self.dimension);
        let scope = Scope {
            coordinates: axes.map(|a| (a.to_string(), Dimension::LENGTH)).collect(),
            ..scope.clone()
        };
        let rows: Vec<_> = inequalities.iter().map(|i| self.half_space(i, &scope)).collect();
        let rows = rows.into_iter().collect::<Result<Vec<_>, _>>()?;
        Polytope::from_half_spaces(&rows)
            .map_err(|e| self.report(messages::bad_half_spaces(span, inequalities, &e)))
    }

    /// An inequality over the coordinates in scope as normal · x ≤ offset.
    pub(super) fn half_space(
        &mut self,
        inequality: &Inequality,
        scope: &Scope,
    ) -> Result<HalfSpace, Reported> {
        let left = self.evaluate(&inequality.left, scope)?;
        let right = self.evaluate(&inequality.right, scope)?;
        let (a, b) = (left.dimension, right.dimension);
        let fits =
            a.agrees(b) || left.slopes.is_empty() && a.is_bare() || right.slopes.is_empty() && b.is_bare();
        if !fits {
            let pair = ((inequality.left.span, a), (inequality.right.span, b));
            return Err(self.report(messages::dimensions_disagree(pair.0, pair.1)));
        }
        let sign = match inequality.op {
            Comparison::LessEqual => Rational::ONE,
            Comparison::GreaterEqual => Rational::from(-1),
            op => return Err(self.report(messages::open_inequality(inequality.op_span, op))),
        };
        let count = scope.coordinates.len();
        let slope = |v: &Value, i: usize| v.slopes.get(i).cloned().unwrap_or_default();
        let normal: Vec<Rational> =
            (0..count).map(|i| (slope(&left, i) - slope(&right, i)) * &sign).collect();
        if normal.iter().all(Rational::is_zero) {
            return Err(self.report(messages::no_coordinate(inequality.span)));
        }
        let offset = (right.number - left.number) * sign;
        if !in_range(&offset) || !normal.iter().all(in_range) {
            return Err(self.report(messages::number_out_of_range(inequality.span)));
        }
        Ok(HalfSpace { normal, offset })
    }
}

/// Whether every number of a piece is in range; corners and sums are computed, so they may not be.
fn is_in_range(piece: &typed::Piece) -> bool {
    match piece {
        typed::Piece::Polytope(polytope) => {
            let facets = polytope.facets.iter().flat_map(|f| f.normal.iter().chain([&f.offset]));
            facets.chain(polytope.vertices.iter().flatten()).all(in_range)
        }
        typed::Piece::Ball { center, spread, radius } => {
            center.iter().chain(spread).chain([radius]).all(in_range)
        }
    }
}

fn cube(center: &[Rational], spread: &[Rational], radius: &Rational) -> Polytope {
    let lo: Vec<Rational> = center.iter().zip(spread).map(|(c, s)| c - s - radius).collect();
    let hi: Vec<Rational> = center.iter().zip(spread).map(|(c, s)| c + s + radius).collect();
    Polytope::from_box(&lo, &hi)
}

fn moved(point: &[Rational], axis: usize, by: &Rational) -> Vec<Rational> {
    point.iter().enumerate().map(|(i, x)| if i == axis { x + by } else { x.clone() }).collect()
}

/// The dimension of a mission's shapes, 2 or 3: its workspace's, or where there is none the one that
/// bases, robots and blockers speak of.
pub fn dimension(items: &[Item]) -> usize {
    let workspace = items.iter().find_map(|item| match &item.kind {
        ItemKind::Workspace(shape) => Some(dimension_of(shape).unwrap_or(2)),
        _ => None,
    });
    workspace.unwrap_or_else(|| guessed_dimension(items))
}

fn dimension_of(shape: &Shape) -> Option<usize> {
    shape.pieces.iter().find_map(points_dimension)
}

fn guessed_dimension(items: &[Item]) -> usize {
    let dimension = |item: &Item| match &item.kind {
        ItemKind::Base { at, .. } | ItemKind::Robot { at: State::Position(at), .. } => {
            Some(at.coordinates.len())
        }
        ItemKind::Region { shape, .. }
        | ItemKind::Obstacle { shape, .. }
        | ItemKind::Jammer { shape, .. } => dimension_of(shape),
        _ => None,
    };
    items.iter().find_map(dimension).map_or(2, |count| if count == 3 { 3 } else { 2 })
}

/// How many coordinates the points of a piece have; `None` when it has no points.
fn points_dimension(piece: &Piece) -> Option<usize> {
    let point = match &piece.kind {
        PieceKind::Box(p, _) => p,
        PieceKind::Ball { center, .. } => center,
        PieceKind::Polygon(_) => return Some(2),
        PieceKind::Hull(points) => points.first()?,
        PieceKind::Where(inequalities) => return Some(if mentions_z(inequalities) { 3 } else { 2 }),
    };
    Some(if point.coordinates.len() == 3 { 3 } else { 2 })
}

fn mentions_z(inequalities: &[Inequality]) -> bool {
    let mut found = false;
    for inequality in inequalities {
        for side in [&inequality.left, &inequality.right] {
            crate::check::expression::mentioned(side, |name| found |= name.text == "z");
        }
    }
    found
}

/// The index of the point that a shape error is about.
pub(super) fn error_point(error: &ShapeError) -> Option<usize> {
    match error {
        ShapeError::NotConvex { corner } => Some(*corner),
        ShapeError::Duplicate { second, .. } => Some(*second),
        _ => None,
    }
}
