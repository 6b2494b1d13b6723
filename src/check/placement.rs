//! Regions, blockers and bases that lie where they make no sense.

use crate::check::{Checker, messages};
use crate::diag::{Diagnostic, Severity};
use crate::exact::{Rational, dot};
use crate::geometry::Polytope;
use crate::ir::Piece;
use crate::source::Span;

impl Checker<'_> {
    /// Looks at every region, blocker and base; one message for each declaration.
    pub(super) fn placements(&mut self) {
        let Some(Ok(workspace)) = &self.workspace else { return };
        let (workspace, place) = (workspace.polytope.clone(), workspace.span);
        self.regions_outside(&workspace, place);
        self.blockers_outside(&workspace, place);
        self.misplaced_bases(&workspace, place);
    }

    fn regions_outside(&mut self, workspace: &Polytope, place: Span) {
        let mut found: Vec<(Span, Diagnostic)> = Vec::new();
        for region in self.regions.iter().flatten() {
            if region.shape.pieces.iter().all(|piece| is_outside(piece, workspace)) {
                found.push((region.span, messages::region_outside(&region.name, region.span, place)));
            }
        }
        self.say_once_a_declaration(found);
    }

    fn blockers_outside(&mut self, workspace: &Polytope, place: Span) {
        let mut found: Vec<(Span, Diagnostic)> = Vec::new();
        for blocker in self.blockers.iter().flatten() {
            if blocker.shape.pieces.iter().all(|piece| is_outside(piece, workspace)) {
                found.push((blocker.span, messages::blocker_outside(blocker, place)));
            }
        }
        self.say_once_a_declaration(found);
    }

    fn misplaced_bases(&mut self, workspace: &Polytope, place: Span) {
        let mut found: Vec<(Span, Diagnostic)> = Vec::new();
        for base in self.bases.iter().flatten() {
            if !workspace.contains(&base.position) {
                found.push((base.span, messages::base_outside(&base.name, base.span, place)));
            }
            let blocked = self.blockers.iter().flatten().find(|blocker| {
                blocker.kind.blocks_links()
                    && blocker.shape.pieces.iter().any(|piece| piece.contains(&base.position))
            });
            if let Some(blocker) = blocked {
                found.push((base.span, messages::base_in_blocker(&base.name, base.span, blocker)));
            }
        }
        self.say_once_a_declaration(found);
    }

    /// Of a family's members, which stand together, the first one speaks for all.
    fn say_once_a_declaration(&mut self, mut found: Vec<(Span, Diagnostic)>) {
        found.dedup_by_key(|(span, _)| *span);
        for (_, diagnostic) in found {
            match diagnostic.severity {
                Severity::Error => {
                    self.report(diagnostic);
                }
                Severity::Warning => self.warn(diagnostic),
            }
        }
    }
}

/// Whether a piece has no interior point in common with the workspace. A ball that is outside only
/// beyond an edge or a corner is not seen to be.
fn is_outside(piece: &Piece, workspace: &Polytope) -> bool {
    match piece {
        Piece::Polytope(polytope) => !polytope.overlaps(workspace),
        Piece::Ball { center, spread, radius } => workspace.facets.iter().any(|facet| {
            let size: Rational = facet.normal.iter().zip(spread).map(|(a, s)| a.abs() * s).sum();
            let beyond = dot(&facet.normal, center) - size - &facet.offset;
            !beyond.is_negative() && &beyond * &beyond >= radius * radius * dot(&facet.normal, &facet.normal)
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(x: i64, y: i64) -> Vec<Rational> {
        vec![Rational::from(x), Rational::from(y)]
    }

    fn disc(x: i64, y: i64, radius: i64, spread: i64) -> Piece {
        Piece::Ball { center: point(x, y), spread: point(spread, spread), radius: Rational::from(radius) }
    }

    #[test]
    fn a_disc_that_only_touches_the_workspace_is_outside() {
        let workspace = Polytope::from_box(&point(0, 0), &point(10, 10));
        assert!(is_outside(&disc(12, 5, 2, 0), &workspace));
        assert!(!is_outside(&disc(12, 5, 2, 1), &workspace));
        assert!(!is_outside(&disc(11, 5, 2, 0), &workspace));
        assert!(!is_outside(&disc(5, 5, 1, 0), &workspace));
    }
}
