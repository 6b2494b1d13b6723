//! Sums of products of doubles without any rounding, fast: a number with a fixed point that has room for
//! all of them (U. Kulisch). What the law computes is held against it a million times.

/// Bits below the point: as many as the product of the two least numbers has.
const BELOW: i32 = 2176;
/// Digits of 32 bits: those below the point, and those of the product of the two greatest numbers.
const DIGITS: usize = 68 + 66;

/// A sum.
#[derive(Clone)]
pub struct ExactSum {
    /// The lowest digit first; between additions digits may be out of range, of either sign.
    digits: [i64; DIGITS],
}

impl ExactSum {
    /// 0.
    pub fn zero() -> ExactSum {
        ExactSum { digits: [0; DIGITS] }
    }

    /// Adds a number.
    pub fn add(&mut self, value: f64) {
        self.add_product(value, 1.0);
    }

    /// Adds the product of two numbers; at most 2³⁰ times.
    pub fn add_product(&mut self, a: f64, b: f64) {
        let ((mantissa_a, exponent_a), (mantissa_b, exponent_b)) = (parts(a), parts(b));
        let product = u128::from(mantissa_a) * u128::from(mantissa_b);
        if product == 0 {
            return;
        }
        let sign = if (a < 0.0) == (b < 0.0) { 1 } else { -1 };
        let place = (exponent_a + exponent_b + BELOW) as usize;
        let (digit, shift) = (place / 32, place % 32);
        // In two halves: shifted, the whole would be too long.
        for (half, offset) in [(product & u128::from(u64::MAX), 0), (product >> 64, 2)] {
            let mut rest = half << shift;
            let mut at = digit + offset;
            while rest != 0 {
                self.digits[at] += sign * (rest & 0xffff_ffff) as i64;
                rest >>= 32;
                at += 1;
            }
        }
    }

    /// Whether it is at most 0.
    pub fn is_at_most_zero(&self) -> bool {
        // Carried upwards, every digit but the highest is from 0 to 2³² − 1, so that one has the sign.
        let mut carry = 0;
        let mut some = false;
        for digit in self.digits {
            let whole = digit + carry;
            some |= whole & 0xffff_ffff != 0;
            carry = whole >> 32;
        }
        carry < 0 || (carry == 0 && !some)
    }

    /// Whether its absolute value is at most a bound.
    pub fn is_within(&self, bound: f64) -> bool {
        let (mut above, mut below) = (self.clone(), self.clone());
        above.add(-bound);
        below.add(bound);
        for digit in &mut below.digits {
            *digit = -*digit;
        }
        above.is_at_most_zero() && below.is_at_most_zero()
    }
}

/// Mantissa and exponent: |value| = mantissa · 2^exponent.
fn parts(value: f64) -> (u64, i32) {
    assert!(value.is_finite());
    let bits = value.to_bits();
    let (fraction, exponent) = (bits & ((1 << 52) - 1), (bits >> 52 & 0x7ff) as i32);
    if exponent == 0 { (fraction, -1074) } else { (fraction | 1 << 52, exponent - 1075) }
}

#[test]
fn exact_sums_agree_with_rationals() {
    use super::luck::Luck;
    use dosmc::exact::Rational;

    let mut luck = Luck::new(8);
    let exact = |x: f64| Rational::from_f64(x).expect("finite");
    let mut odd = 0;
    for case in 0..2_000 {
        let mut number = || {
            let scale =
                [1.0, 1e-3, 1e8, 1e-300, 1e150, 5e-324][luck.below(if case % 2 == 0 { 3 } else { 6 })];
            (2.0 * luck.share() - 1.0) * scale
        };
        let (mut sum, mut rational) = (ExactSum::zero(), Rational::ZERO);
        for _ in 0..12 {
            let (a, b) = (number(), number());
            sum.add_product(a, b);
            rational += exact(a) * exact(b);
        }
        let value = rational.to_f64();
        assert!(value.is_finite(), "{rational}");
        sum.add(-value);
        let off = rational - exact(value);
        assert_eq!(sum.is_at_most_zero(), !off.is_positive());
        // The nearest double of what is left, and its neighbours, are bounds or are none.
        let near = off.abs().to_f64();
        for bound in [near, near.next_up(), near.next_down().max(0.0), 0.0] {
            assert_eq!(sum.is_within(bound), off.abs() <= exact(bound), "{bound:e}");
            odd += usize::from(sum.is_within(bound));
        }
    }
    assert!(odd > 1_000 && odd < 7_000, "{odd}");
}
