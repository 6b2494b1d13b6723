//! Merging cells where nothing is lost by it.
//!
//! Two cells become one if their union is convex, they have the same labels, and the union still
//! gets to and sees everything that either of them did. So every plan over the finer cells is one
//! over the coarser cells. (Merging as far as labels allow makes most missions infeasible.)

use super::Cell;
use super::relation::Relation;
use super::sight::{Place, Sight};
use crate::abstraction::Abstraction;
use crate::ir::ModelId;

/// A cell of some model, on its way to the partition.
#[derive(Clone, Debug)]
pub(super) struct Draft {
    pub(super) model: ModelId,
    pub(super) cell: Cell,
    /// By region of the model: certainly in, certainly out.
    pub(super) labels: Vec<(bool, bool)>,
}

/// All cells of all models, and then the places that are points: starts and bases.
pub(super) struct Merging<'a> {
    pub(super) abstraction: &'a Abstraction,
    pub(super) sight: Sight<'a>,
    pub(super) grain: f64,
    /// 𝒲 ⊖ Ω by model.
    pub(super) rooms: Vec<Option<Cell>>,
    /// `None` where a cell has become part of another one.
    pub(super) drafts: Vec<Option<Draft>>,
    /// By cell, then by point.
    pub(super) places: Vec<Place>,
    /// By place: the model that it is a place of; `None` for a base.
    pub(super) models: Vec<Option<ModelId>>,
    pub(super) moves: Relation,
    pub(super) sees: Relation,
}

impl Merging<'_> {
    /// Finds out who sees whom and who gets where.
    pub(super) fn relate(&mut self) {
        for a in 0..self.places.len() {
            for b in a..self.places.len() {
                if !self.sight.sees(&self.places[a], &self.places[b]) {
                    continue;
                }
                self.sees.relate(a, b);
                let same = self.models[a].is_some() && self.models[a] == self.models[b];
                if same && self.sight.passes(&self.places[a], &self.places[b]) {
                    self.moves.relate(a, b);
                }
            }
        }
    }

    /// Merges until no two cells can be merged any more.
    pub(super) fn run(&mut self) {
        let mut again = true;
        while again {
            again = false;
            for a in 0..self.drafts.len() {
                for b in a + 1..self.drafts.len() {
                    if self.drafts[a].is_none() {
                        break;
                    }
                    again |= self.merge(a, b);
                }
            }
        }
    }

    /// Makes two cells one, if nothing is lost by it.
    fn merge(&mut self, a: usize, b: usize) -> bool {
        let (Some(first), Some(second)) = (&self.drafts[a], &self.drafts[b]) else { return false };
        if first.model != second.model || first.labels != second.labels {
            return false;
        }
        let directions = &self.abstraction.directions;
        let Some(room) = &self.rooms[crate::entity::EntityId::index(first.model)] else { return false };
        let Some(cell) = first.cell.united(&second.cell, directions, room, self.grain) else {
            return false;
        };
        let place = self.sight.of_cell(first.model, &cell);
        if !self.loses_nothing(a, b, &place) {
            return false;
        }
        let draft = Draft { cell, ..first.clone() };
        self.drafts[a] = Some(draft);
        self.drafts[b] = None;
        self.places[a] = place;
        self.moves.absorb(a, b);
        self.sees.absorb(a, b);
        true
    }

    fn loses_nothing(&self, a: usize, b: usize, union: &Place) -> bool {
        let alive = |other: usize| self.drafts.get(other).is_none_or(Option::is_some);
        let kept = |other: usize| {
            let place = if other == a || other == b { union } else { &self.places[other] };
            let either = |relation: &Relation| relation.holds(a, other) || relation.holds(b, other);
            (!either(&self.sees) || self.sight.sees(union, place))
                && (!either(&self.moves) || self.sight.moves(union, place))
        };
        (0..self.places.len()).filter(|&other| alive(other)).all(kept)
    }
}
