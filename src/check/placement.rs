//! Regions, blockers and bases that lie where they make no sense.

use crate::check::{Checker, messages};
use crate::diag::{Diagnostic, Severity};
use crate::geometry::Polytope;
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
            if !region.shape.pieces.iter().any(|piece| piece.overlaps(workspace)) {
                found.push((region.span, messages::region_outside(&region.name, region.span, place)));
            }
        }
        self.say_once_a_declaration(found);
    }

    fn blockers_outside(&mut self, workspace: &Polytope, place: Span) {
        let mut found: Vec<(Span, Diagnostic)> = Vec::new();
        for blocker in self.blockers.iter().flatten() {
            if !blocker.shape.pieces.iter().any(|piece| piece.overlaps(workspace)) {
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
