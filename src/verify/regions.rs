//! Labels of regions: what the plan calls certain must be.

use std::collections::BTreeMap;

use super::report::{Kind, Ledger, Place};
use super::resolve::{Plane, Resolved, Robot};
use super::shape::{beyond, depth, rounded_norm};
use super::tube::Tube;
use crate::exact::{Rational, dot};
use crate::ir::{ModelId, Piece, RegionId, Shape};
use crate::plan::Label;

/// Supports of a tube along the facets of each piece of a region.
type Supports = BTreeMap<(ModelId, RegionId), Vec<Vec<Rational>>>;

/// Checks every label of every robot.
pub(super) fn check(plan: &Resolved, ledger: &mut Ledger) {
    ledger.reach(Kind::Regions);
    let mut supports = Supports::new();
    for (id, robot) in plan.robots.iter() {
        let tube = plan.tube(id);
        for (&region, labels) in &robot.regions {
            // In takes what is certain of the region, out all that it may be.
            let (shape, sure) = (&plan.problem.regions[region].shape, plan.problem.regions[region].sure());
            let along = supports.entry((robot.model, region)).or_insert_with(|| facet_supports(tube, sure));
            for (t, label) in labels.iter().enumerate() {
                let spot = Spot { plan, robot, tube, region, t };
                match label {
                    Label::In => spot.inside(sure, along, ledger),
                    Label::Out => spot.outside(shape, ledger),
                    Label::Unknown => {}
                }
            }
        }
        no_stray_witness(plan, robot, ledger);
    }
}

fn facet_supports(tube: &Tube, shape: &Shape) -> Vec<Vec<Rational>> {
    let piece = |piece: &Piece| match piece {
        Piece::Polytope(p) => p.facets.iter().map(|f| tube.positions.support(&f.normal)).collect(),
        Piece::Ball { .. } => Vec::new(),
    };
    shape.pieces.iter().map(piece).collect()
}

/// A label's robot, region and step.
struct Spot<'a> {
    plan: &'a Resolved<'a>,
    robot: &'a Robot<'a>,
    tube: &'a Tube,
    region: RegionId,
    t: usize,
}

impl Spot<'_> {
    fn place(&self) -> Place {
        Place::robot(self.robot.name).about(&self.plan.problem.regions[self.region].name).at(self.t)
    }

    /// z ⊕ Ω lies in one piece.
    fn inside(&self, shape: &Shape, supports: &[Vec<Rational>], ledger: &mut Ledger) {
        let point = &self.robot.p[self.t];
        let pieces = shape.pieces.iter().zip(supports);
        let deepest = pieces.map(|(piece, h)| depth(point, &self.tube.positions, h, piece)).max();
        let slack = deepest.unwrap_or(Rational::from(-1));
        ledger.not_negative(Kind::Regions, &slack, 1.0, || {
            (self.place(), "labelled in, but not certainly in".into())
        });
    }

    /// A plane between z ⊕ Ω and each piece.
    fn outside(&self, shape: &Shape, ledger: &mut Ledger) {
        let witness = self.robot.outside.get(&self.region).and_then(|steps| steps[self.t].as_ref());
        let Some(planes) = witness else {
            return ledger.fail(Kind::Regions, self.place(), "labelled out without a witness".into());
        };
        covered(Kind::Regions, planes, shape, || self.place(), ledger);
        for plane in planes {
            let slack = &plane.offset
                - dot(&plane.normal, &self.robot.p[self.t])
                - self.tube.positions.support(&plane.normal);
            ledger.positive(Kind::Regions, &slack, rounded_norm(&plane.normal), || {
                (self.place(), format!("labelled out, but the plane of piece {} cuts the tube", plane.piece))
            });
        }
    }
}

/// Every piece has a plane, and every plane has its piece wholly on the other side.
pub(super) fn covered<'a>(
    kind: Kind,
    planes: impl IntoIterator<Item = &'a Plane> + Clone,
    shape: &Shape,
    place: impl Fn() -> Place,
    ledger: &mut Ledger,
) {
    for plane in planes.clone() {
        let holds = beyond(plane, &shape.pieces[plane.piece]);
        ledger
            .claim(kind, holds, || (place(), format!("the plane of piece {} cuts that piece", plane.piece)));
    }
    for piece in 0..shape.pieces.len() {
        let has_plane = planes.clone().into_iter().any(|plane| plane.piece == piece);
        ledger.claim(kind, has_plane, || (place(), format!("no plane for piece {piece}")));
    }
}

/// Witnesses stand only beside labels `out`.
fn no_stray_witness(plan: &Resolved, robot: &Robot, ledger: &mut Ledger) {
    for (region, steps) in &robot.outside {
        let labels = robot.regions.get(region);
        for (t, _) in steps.iter().enumerate().filter(|(_, witness)| witness.is_some()) {
            let out = labels.is_some_and(|labels| labels[t] == Label::Out);
            ledger.claim(Kind::Regions, out, || {
                let place = Place::robot(robot.name).about(&plan.problem.regions[*region].name).at(t);
                (place, "a witness of being out beside another label".into())
            });
        }
    }
}
