//! A symmetric relation among places, as a matrix of bits.

/// A symmetric relation on 0 … n − 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Relation {
    size: usize,
    /// Words a row.
    stride: usize,
    words: Vec<u64>,
}

impl Relation {
    /// The empty relation.
    pub(super) fn new(size: usize) -> Relation {
        let stride = size.div_ceil(64);
        Relation { size, stride, words: vec![0; size * stride] }
    }

    /// Whether two are related.
    pub(super) fn holds(&self, a: usize, b: usize) -> bool {
        self.words[a * self.stride + b / 64] >> (b % 64) & 1 == 1
    }

    /// Relates two.
    pub(super) fn relate(&mut self, a: usize, b: usize) {
        self.words[a * self.stride + b / 64] |= 1 << (b % 64);
        self.words[b * self.stride + a / 64] |= 1 << (a % 64);
    }

    /// Gives a everything that b is related to.
    pub(super) fn absorb(&mut self, a: usize, b: usize) {
        for other in 0..self.size {
            if self.holds(b, other) {
                self.relate(a, other);
            }
        }
    }

    /// The relation among some of its members, which get their places in the list as numbers.
    pub(super) fn restricted(&self, members: &[usize]) -> Relation {
        let mut relation = Relation::new(members.len());
        for (i, &a) in members.iter().enumerate() {
            for (j, &b) in members.iter().enumerate().skip(i) {
                if self.holds(a, b) {
                    relation.relate(i, j);
                }
            }
        }
        relation
    }
}
