//! Regions, blockers and bases that lie where they make no sense.

use crate::check::{Checker, messages};
use crate::geometry::Polytope;
use crate::source::Span;

impl Checker<'_> {
    /// Looks at every region, blocker and base; one message for each declaration.
    pub(super) fn placements(&mut self) {
        let Some(Ok(workspace)) = &self.workspace else { return };
        let workspace = workspace.polytope.clone();
        self.regions_outside(&workspace);
        self.blockers_outside(&workspace);
        self.misplaced_bases(&workspace);
    }

    fn regions_outside(&mut self, workspace: &Polytope) {
        let mut last: Option<Span> = None;
        for region in self.regions.iter().flatten() {
            let inside = region.shape.pieces.iter().any(|piece| piece.overlaps(workspace));
            if !inside && last != Some(region.span) {
                last = Some(region.span);
                let place = self.workspace.as_ref().and_then(|w| w.as_ref().ok()).map(|w| w.span);
                self.diagnostics.push(messages::region_outside(&region.name, region.span, place));
            }
        }
    }

    fn blockers_outside(&mut self, workspace: &Polytope) {
        let mut last: Option<Span> = None;
        for blocker in self.blockers.iter().flatten() {
            let inside = blocker.shape.pieces.iter().any(|piece| piece.overlaps(workspace));
            if !inside && last != Some(blocker.span) {
                last = Some(blocker.span);
                let place = self.workspace.as_ref().and_then(|w| w.as_ref().ok()).map(|w| w.span);
                self.diagnostics.push(messages::blocker_outside(blocker, place));
            }
        }
    }

    fn misplaced_bases(&mut self, workspace: &Polytope) {
        let mut last: Option<Span> = None;
        for base in self.bases.iter().flatten() {
            if last == Some(base.span) {
                continue;
            }
            if !workspace.contains(&base.position) {
                last = Some(base.span);
                let place = self.workspace.as_ref().and_then(|w| w.as_ref().ok()).map(|w| w.span);
                self.diagnostics.push(messages::base_outside(&base.name, base.span, place));
            }
            let blocked = self.blockers.iter().flatten().find(|blocker| {
                blocker.kind.blocks_links()
                    && blocker.shape.pieces.iter().any(|piece| piece.contains(&base.position))
            });
            if let Some(blocker) = blocked {
                last = Some(base.span);
                self.diagnostics.push(messages::base_in_blocker(&base.name, base.span, blocker));
            }
        }
    }
}
