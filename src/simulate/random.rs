//! Random numbers: a stream for each run, the same on every machine.

use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// The random numbers of one run.
///
/// xoshiro256++, whose values are fixed by its authors; doubles and choices are made of them here, so
/// that no library's idea of them can change what a seed means.
pub(super) struct Stream(Xoshiro256PlusPlus);

impl Stream {
    /// The stream of a run: another seed or another run gives an unrelated one.
    pub(super) fn new(seed: u64, run: u64) -> Stream {
        Stream(Xoshiro256PlusPlus::seed_from_u64(mixed(mixed(seed).wrapping_add(run))))
    }

    /// 64 random bits.
    pub(super) fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// A number in [−1, 1), a multiple of 2⁻⁵².
    pub(super) fn symmetric(&mut self) -> f64 {
        let unit = (self.bits() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0);
        2.0 * unit - 1.0
    }

    /// A whole number below `bound`, which is at least 1; the bias is below 2⁻³² for bounds below 2³².
    pub(super) fn below(&mut self, bound: usize) -> usize {
        ((u128::from(self.bits()) * bound as u128) >> 64) as usize
    }
}

/// A bijection of the 64-bit numbers that leaves no pattern (the finaliser of SplitMix64).
fn mixed(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_means_the_same_for_ever() {
        let first = |seed, run| Stream::new(seed, run).bits();
        let values = [first(0, 0), first(0, 1), first(1, 0), first(1, 1), first(u64::MAX, u64::MAX)];
        insta::assert_snapshot!(values.map(|v| format!("{v:016x}")).join(" "));
    }

    #[test]
    fn numbers_fill_their_range_evenly() {
        let mut stream = Stream::new(2026, 11);
        let mut seen = [0usize; 8];
        let mut sum = 0.0;
        for _ in 0..80_000 {
            let x = stream.symmetric();
            assert!((-1.0..1.0).contains(&x));
            sum += x;
            seen[((x + 1.0) * 4.0) as usize] += 1;
        }
        assert!(seen.iter().all(|n| (9_500..10_500).contains(n)), "{seen:?}");
        assert!((sum / 80_000.0).abs() < 0.01);
        let mut seen = [0usize; 3];
        (0..30_000).for_each(|_| seen[stream.below(3)] += 1);
        assert!(seen.iter().all(|n| (9_500..10_500).contains(n)), "{seen:?}");
    }
}
