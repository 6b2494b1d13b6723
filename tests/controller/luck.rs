//! Random numbers that are the same on every machine (SplitMix64).

/// A stream of random numbers.
pub struct Luck(u64);

impl Luck {
    /// A stream of its own for each seed.
    pub fn new(seed: u64) -> Luck {
        Luck(seed)
    }

    /// Any 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// A number below `bound`.
    pub fn below(&mut self, bound: usize) -> usize {
        (self.bits() % bound as u64) as usize
    }

    /// A number from 0 to 1.
    pub fn share(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number from −1 to 1, the ends every other time.
    pub fn push(&mut self) -> f64 {
        match self.below(4) {
            0 => -1.0,
            1 => 1.0,
            _ => 2.0 * self.share() - 1.0,
        }
    }

    /// One of several.
    pub fn pick<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[self.below(all.len())]
    }
}
