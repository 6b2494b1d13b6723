//! The directions along which half-spaces lie, each known once.

use std::collections::HashMap;
use std::ops::Index;

use super::dot;
use crate::entity::{EntityId, Table};
use crate::entity_id;

entity_id!(
    /// A unit vector of the workspace.
    DirectionId, "direction"
);

/// Directions that agree to this many parts of one are one direction.
const GRAIN: f64 = 1e-11;

/// The grid of directions that are a choice: a turn by so much moves nothing in the workspace by a
/// tenth of the gap.
pub const COARSE: f64 = 1.0 / (1 << 24) as f64;

/// A unit vector with its opposite.
#[derive(Clone, Debug)]
pub struct Direction {
    /// The vector, of unit length up to rounding or [`COARSE`]; exact along an axis.
    pub vector: Vec<f64>,
    /// The direction that points the other way.
    pub opposite: DirectionId,
}

/// All directions in use. With each direction its opposite is there too.
#[derive(Clone, Debug)]
pub struct Directions {
    table: Table<DirectionId, Direction>,
    keys: HashMap<Vec<i64>, DirectionId>,
}

impl Directions {
    /// The directions of the axes, in the order +x, −x, +y, −y, ….
    pub fn new(dimension: usize) -> Directions {
        let mut directions = Directions { table: Table::new(), keys: HashMap::new() };
        for axis in 0..dimension {
            let unit: Vec<f64> = (0..dimension).map(|i| f64::from(u8::from(i == axis))).collect();
            directions.intern(&unit);
        }
        directions
    }

    /// The direction of a vector that is not zero.
    pub fn intern(&mut self, vector: &[f64]) -> DirectionId {
        let length = dot(vector, vector).sqrt();
        self.intern_unit(vector.iter().map(|x| x / length + 0.0).collect())
    }

    /// A direction near that of a vector that is not zero, with numbers of few bits; its length is 1
    /// up to [`COARSE`].
    ///
    /// For directions that are a choice, not a facet's: exact solvers that read an instance take a
    /// third of the time.
    pub fn intern_near(&mut self, vector: &[f64]) -> DirectionId {
        let length = dot(vector, vector).sqrt();
        self.intern_unit(vector.iter().map(|x| (x / length / COARSE).round() * COARSE + 0.0).collect())
    }

    fn intern_unit(&mut self, unit: Vec<f64>) -> DirectionId {
        if let Some(&id) = self.keys.get(&key(&unit)) {
            return id;
        }
        let next = self.table.len();
        let (here, there) = (DirectionId::new(next), DirectionId::new(next + 1));
        let opposite: Vec<f64> = unit.iter().map(|x| 0.0 - x).collect();
        self.keys.insert(key(&unit), here);
        self.keys.insert(key(&opposite), there);
        self.table.push(Direction { vector: unit, opposite: there });
        self.table.push(Direction { vector: opposite, opposite: here });
        here
    }

    /// The direction along an axis, positive or negative.
    pub fn axis(&self, axis: usize, positive: bool) -> DirectionId {
        DirectionId::new(2 * axis + usize::from(!positive))
    }

    /// All directions, in order of their ids.
    pub fn iter(&self) -> impl Iterator<Item = &Direction> {
        self.table.values()
    }

    /// How many directions there are.
    pub fn len(&self) -> usize {
        self.table.len()
    }

    /// Whether there is no direction (never: the axes are always there).
    pub fn is_empty(&self) -> bool {
        self.table.is_empty()
    }
}

impl Index<DirectionId> for Directions {
    type Output = Direction;
    fn index(&self, id: DirectionId) -> &Direction {
        &self.table[id]
    }
}

fn key(unit: &[f64]) -> Vec<i64> {
    unit.iter().map(|x| (x / GRAIN).round() as i64).collect()
}
