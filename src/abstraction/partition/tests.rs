//! Tests of the partition: convex disjoint cells that cover the free space, with labels and
//! relations that are right at sample points, and nothing lost by merging.

use super::*;
use crate::abstraction::{Body, Owner, SolidId, dot};
use crate::diag::Diagnostics;
use crate::driver::{self, Overrides};
use crate::exact::Rational;
use crate::geometry::Polytope;
use crate::ir::Piece;
use crate::source::SourceFile;

const TABLE: &str = include_str!("../../../examples/paper/table1-4.dosm");
const WALL: &str = include_str!("../../../examples/wall.dosm");
const SLANTED: &str = include_str!("../../../tests/missions/solve/boat_and_rover.dosm");
const ROUND: &str = include_str!("../../../tests/missions/solve/disc.dosm");
const SPACE: &str = include_str!("../../../tests/missions/solve/space.dosm");

/// Numbers in [0, 1) that are always the same ones (a linear congruence).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    /// A point of a cell, its boundary included every now and then.
    fn point_of(&mut self, cell: &Cell) -> Vec<f64> {
        let weights: Vec<f64> = cell.corners().map(|_| self.next().powi(4)).collect();
        let sum: f64 = weights.iter().sum();
        let axes = 0..cell.middle().len();
        axes.map(|axis| cell.corners().zip(&weights).map(|(p, w)| p[axis] * w / sum).sum()).collect()
    }
}

struct Cut {
    problem: Problem,
    abstraction: Abstraction,
    partition: Partition,
}

fn cut(text: &str) -> Cut {
    cut_as(text, Fineness::Coarse)
}

fn cut_as(text: &str, fineness: Fineness) -> Cut {
    let source = SourceFile::new("mission.dosm", text);
    let mission = driver::load(&source, &Overrides::default(), &mut Diagnostics::new()).unwrap();
    let abstraction = Abstraction::new(&mission.problem, &mission.tubes, 1.0);
    let partition = Partition::new(&mission.problem, &abstraction, fineness).unwrap();
    Cut { problem: mission.problem, abstraction, partition }
}

impl Cut {
    fn all() -> Vec<Cut> {
        let coarse = [TABLE, WALL, SLANTED, ROUND, SPACE].into_iter().map(cut);
        coarse.chain([cut_as(TABLE, Fineness::Fine)]).collect()
    }

    fn blockers(&self, links: bool) -> Vec<SolidId> {
        let solids = self.abstraction.solids.iter().filter(|(_, s)| matches!(s.owner, Owner::Blocker(_)));
        let chosen = solids.filter(|(id, _)| !links || self.abstraction.blocks_links(&self.problem, *id));
        chosen.map(|(id, _)| id).collect()
    }

    /// Whether the hull of two bodies is clear of all blockers, or of those that block links.
    fn clear(&self, bodies: [Body<'_>; 2], links: bool) -> bool {
        self.blockers(links).iter().all(|s| self.abstraction.separate(&bodies, *s).is_some())
    }

    /// Free: in the workspace, and below every blocker along one of its directions or an axis.
    fn free(&self, model: ModelId, z: &[f64], slack: f64) -> bool {
        let directions = &self.abstraction.directions;
        let within =
            |h: &crate::abstraction::HalfSpace| dot(&directions[h.direction].vector, z) <= h.offset + slack;
        let axes = (0..z.len()).flat_map(|axis| [true, false].map(|up| directions.axis(axis, up)));
        let below = |solid: &SolidId| {
            let faces = self.abstraction.facets_of(*solid);
            let mut ways = faces.into_iter().chain(axes.clone());
            ways.any(|d| within(&self.abstraction.below(model, *solid, d)))
        };
        self.abstraction.workspace[model].iter().all(within) && self.blockers(false).iter().all(below)
    }

    fn holding(&self, model: ModelId, z: &[f64], grain: f64) -> Vec<CellId> {
        let cells = self.partition.cells(model).iter();
        cells.filter(|(_, c)| c.holds(&self.abstraction.directions, z, grain)).map(|(id, _)| id).collect()
    }

    fn random_point(&self, numbers: &mut Numbers) -> Vec<f64> {
        let corners = super::super::floats(&self.problem.workspace);
        let along = |axis: usize, share: f64| {
            let values = corners.iter().map(|p| p[axis]);
            let (lo, hi) = (values.clone().fold(f64::MAX, f64::min), values.fold(f64::MIN, f64::max));
            lo + share * (hi - lo)
        };
        (0..self.problem.dimension).map(|axis| along(axis, numbers.next())).collect()
    }
}

#[test]
fn cells_cover_the_free_space_and_do_not_overlap() {
    for cut in Cut::all() {
        let mut numbers = Numbers(1);
        let gap = cut.abstraction.gap;
        for model in cut.problem.models.ids() {
            let (mut free, mut blocked) = (0, 0);
            for _ in 0..1000 {
                let z = cut.random_point(&mut numbers);
                if cut.free(model, &z, -gap) {
                    free += 1;
                    assert!(!cut.holding(model, &z, gap).is_empty(), "no cell at {z:?}");
                } else if !cut.free(model, &z, gap) {
                    blocked += 1;
                    assert!(cut.holding(model, &z, -gap).is_empty(), "a cell in a blocker at {z:?}");
                }
                assert!(cut.holding(model, &z, -gap).len() <= 1, "overlap at {z:?}");
            }
            assert!(free > 200 && blocked > 20, "{free} free, {blocked} blocked");
        }
    }
}

#[test]
fn facets_and_corners_of_a_cell_say_the_same() {
    for cut in Cut::all() {
        let directions = &cut.abstraction.directions;
        for model in cut.problem.models.ids() {
            for cell in cut.partition.cells(model).values() {
                for facet in &cell.facets {
                    let reach = cell.reach(&directions[facet.direction].vector);
                    assert!((reach - facet.offset).abs() < 1e-9, "{facet:?} is reached up to {reach}");
                }
                assert!(cell.holds(directions, &cell.middle(), -1e-3 * cut.abstraction.gap));
            }
        }
    }
}

#[test]
fn labels_are_right_at_every_point_of_a_cell() {
    for cut in Cut::all() {
        let mut numbers = Numbers(2);
        let (directions, gap) = (&cut.abstraction.directions, cut.abstraction.gap);
        let mut seen = [0; 3];
        for model in cut.problem.models.ids() {
            for region in asked(&cut.problem, model) {
                for (id, cell) in cut.partition.cells(model).iter() {
                    let label = cut.partition.label(model, id, region);
                    seen[match label {
                        (true, _) => 0,
                        (_, true) => 1,
                        _ => 2,
                    }] += 1;
                    for _ in 0..20 {
                        let z = numbers.point_of(cell);
                        let copies = cut.abstraction.inside(model, region);
                        let inside = |slack: f64| {
                            let within = |h: &crate::abstraction::HalfSpace| {
                                dot(&directions[h.direction].vector, &z) <= h.offset + slack
                            };
                            copies.iter().any(|piece| piece.iter().all(within))
                        };
                        assert!(!label.0 || inside(0.1 * gap), "not in {region} at {z:?}");
                        assert!(label.0 || !inside(-0.1 * gap), "in {region} at {z:?}");
                        let body = Body { center: &z, model: Some(model) };
                        let mut solids = cut.abstraction.solids_of(Owner::Region(region));
                        let outside = solids.all(|s| cut.abstraction.separate(&[body], s).is_some());
                        assert!(!label.1 || outside, "not out of {region} at {z:?}");
                    }
                }
            }
        }
        assert!(seen.iter().all(|n| *n > 0), "cells in, out and neither: {seen:?}");
    }
}

/// What the relations allow holds of all positions in the two places.
#[test]
fn relations_are_right_at_every_pair_of_points() {
    for cut in Cut::all() {
        let mut numbers = Numbers(3);
        let mut places = Vec::new();
        for model in cut.problem.models.ids() {
            places.extend(cut.partition.cells(model).ids().map(|c| Place::Cell(model, c)));
        }
        places.extend(cut.problem.robots.ids().map(Place::Start));
        places.extend(cut.problem.bases.ids().map(Place::Base));
        let mut point = |place: Place| match place {
            Place::Cell(model, cell) => (numbers.point_of(&cut.partition.cells(model)[cell]), Some(model)),
            Place::Start(robot) => {
                let entry = &cut.problem.robots[robot];
                let position = &cut.problem.models[entry.model].position;
                (position.iter().map(|&s| entry.start[s].to_f64()).collect(), Some(entry.model))
            }
            Place::Base(base) => (cut.abstraction.base(base).to_vec(), None),
        };
        let mut choice = Numbers(4);
        let (mut moves, mut sights) = (0, 0);
        for _ in 0..5000 {
            let (a, b) = (places[choice.below(places.len())], places[choice.below(places.len())]);
            if let (Place::Base(_), Place::Base(_)) = (a, b) {
                continue;
            }
            let ((p, model), (q, other)) = (point(a), point(b));
            let bodies = [Body { center: &p, model }, Body { center: &q, model: other }];
            if cut.partition.sees(a, b) {
                sights += 1;
                assert!(cut.clear(bodies, true), "{a:?} does not see {b:?} from {p:?} to {q:?}");
            }
            if cut.partition.moves(a, b) {
                moves += 1;
                assert!(cut.clear(bodies, false), "{a:?} does not move to {b:?} from {p:?} to {q:?}");
            }
            assert_eq!(cut.partition.sees(a, b), cut.partition.sees(b, a));
        }
        assert!(moves > 250 && sights > 250, "{moves} moves, {sights} sights");
    }
}

/// Adj_c, both ways, by other means: the exact hull of both sets of positions against the jammers.
#[test]
fn sight_is_that_of_exact_hulls() {
    let cut = cut(TABLE);
    let model = ModelId::new(0);
    let exact = |x: f64| Rational::from_f64(x).unwrap();
    let grown: Vec<Rational> = vec![exact(cut.abstraction.gap); 2];
    let cells: Vec<(CellId, Vec<Vec<Rational>>)> = cut
        .partition
        .cells(model)
        .iter()
        .map(|(id, cell)| {
            let corners: Vec<Vec<f64>> = cell.corners().map(<[f64]>::to_vec).collect();
            let inflated = cut.abstraction.inflated(model, &corners);
            (id, inflated.into_iter().map(|p| p.map(exact).to_vec()).collect())
        })
        .collect();
    let mut numbers = Numbers(6);
    let mut counts = [0, 0];
    for _ in 0..500 {
        let (a, b) = (&cells[numbers.below(cells.len())], &cells[numbers.below(cells.len())]);
        let hull = Polytope::hull(&[&a.1[..], &b.1[..]].concat()).unwrap();
        let sees = cut.partition.sees(Place::Cell(model, a.0), Place::Cell(model, b.0));
        counts[usize::from(sees)] += 1;
        let jammers = || {
            cut.problem.blockers.values().flat_map(|j| &j.shape.pieces).filter_map(|piece| match piece {
                Piece::Polytope(p) => Some(p),
                Piece::Ball { .. } => None,
            })
        };
        if sees {
            assert!(!jammers().any(|j| j.overlaps(&hull)), "{} sees {} through a jammer", a.0, b.0);
        } else {
            assert!(jammers().any(|j| j.widened(&grown).overlaps(&hull)), "{} doesn't see {}", a.0, b.0);
        }
    }
    assert!(counts.iter().all(|n| *n > 50), "{counts:?}");
}

#[test]
fn merging_loses_no_label_no_sight_and_no_move() {
    for text in [TABLE, WALL, SLANTED, SPACE] {
        let cut = cut(text);
        let mut fine = drafts(&cut.problem, &cut.abstraction, Fineness::Coarse).unwrap();
        fine.relate();
        let cells: Vec<(usize, Draft)> =
            fine.drafts.iter().enumerate().filter_map(|(i, d)| Some((i, d.clone()?))).collect();
        assert!(cut.partition.count() < cells.len(), "{} of {}", cut.partition.count(), cells.len());
        let home = |draft: &Draft| {
            let holding = cut.holding(draft.model, &draft.cell.middle(), 0.0);
            assert_eq!(holding.len(), 1);
            Place::Cell(draft.model, holding[0])
        };
        let mut places: Vec<(usize, Place)> = cells.iter().map(|(i, d)| (*i, home(d))).collect();
        let points =
            cut.problem.robots.ids().map(Place::Start).chain(cut.problem.bases.ids().map(Place::Base));
        places.extend((fine.drafts.len()..).zip(points));
        for &(i, a) in &places {
            for &(j, b) in &places {
                assert!(!fine.sees.holds(i, j) || cut.partition.sees(a, b), "{a:?} no longer sees {b:?}");
                assert!(!fine.moves.holds(i, j) || cut.partition.moves(a, b), "no more moves: {a:?}, {b:?}");
            }
        }
        for (i, draft) in &cells {
            let Some((_, Place::Cell(model, cell))) = places.iter().find(|(at, _)| at == i).copied() else {
                panic!("a cell without a home")
            };
            for (at, region) in asked(&cut.problem, model).into_iter().enumerate() {
                assert_eq!(cut.partition.label(model, cell, region), draft.labels[at]);
            }
        }
    }
}

/// A base is a point: what it sees is exactly what no blocker hides from it.
#[test]
fn cells_see_a_base_wholly_or_not_at_all() {
    let cut = cut(TABLE);
    let (model, base) = (ModelId::new(0), BaseId::new(0));
    let mut numbers = Numbers(5);
    let mut hidden = 0;
    for (id, cell) in cut.partition.cells(model).iter() {
        let z = cell.middle();
        let bodies = [
            Body { center: &z, model: Some(model) },
            Body { center: cut.abstraction.base(base), model: None },
        ];
        let sees = cut.partition.sees(Place::Cell(model, id), Place::Base(base));
        assert_eq!(sees, cut.clear(bodies, true), "at {z:?}, and so at {:?}", numbers.point_of(cell));
        hidden += usize::from(!sees);
    }
    assert!(hidden > 3, "{hidden}");
}

#[test]
fn too_many_cells_are_refused() {
    let source = SourceFile::new("mission.dosm", TABLE);
    let mission = driver::load(&source, &Overrides::default(), &mut Diagnostics::new()).unwrap();
    let abstraction = Abstraction::new(&mission.problem, &mission.tubes, 1.0);
    let knife = |most| Knife {
        problem: &mission.problem,
        abstraction: &abstraction,
        model: ModelId::new(0),
        fineness: Fineness::Coarse,
        grain: GRAIN * abstraction.gap,
        most,
    };
    assert_eq!(knife(20).carve(&[]).unwrap_err(), TooFine { most: 20 });
    assert!(knife(500).carve(&[]).is_ok());
}
