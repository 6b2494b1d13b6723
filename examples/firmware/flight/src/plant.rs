//! How a robot really moves.

/// A robot in the plane: two integrators for each axis, sampled every 0.5 s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plant {
    /// Position, in metres.
    pub position: [f64; 2],
    /// Velocity, in metres a second.
    pub velocity: [f64; 2],
}

impl Plant {
    /// A robot at rest.
    pub const fn at(position: [f64; 2]) -> Plant {
        Plant { position, velocity: [0.0; 2] }
    }

    /// One step with an acceleration held for 0.5 s, and with a push that shifts the position.
    pub fn step(&mut self, acceleration: [f64; 2], push: [f64; 2]) {
        for axis in 0..2 {
            self.position[axis] += 0.5 * self.velocity[axis] + 0.125 * acceleration[axis] + push[axis];
            self.velocity[axis] += 0.5 * acceleration[axis];
        }
    }
}

/// A source of disturbances: by turns anywhere in their box, in its corners, and for a while in one
/// and the same corner, which is what drives robots furthest from their plan.
#[derive(Clone, Debug)]
pub struct Wind {
    seed: u64,
    held: [f64; 2],
    left: u32,
}

impl Wind {
    /// The most that a robot is shifted along an axis in a step, in metres.
    pub const MOST: f64 = 0.2;

    /// A source for each seed.
    pub const fn new(seed: u64) -> Wind {
        Wind { seed: seed.wrapping_mul(2).wrapping_add(1), held: [0.0; 2], left: 0 }
    }

    /// The shift of the next step, in metres.
    pub fn next(&mut self) -> [f64; 2] {
        if self.left > 0 {
            self.left -= 1;
            return self.held;
        }
        let corner = |bits: u64| if bits & 1 == 0 { -Wind::MOST } else { Wind::MOST };
        let bits = self.draw();
        let corners = [corner(bits >> 3), corner(bits >> 4)];
        match bits & 7 {
            0..=2 => [self.anywhere(), self.anywhere()],
            3..=5 => corners,
            _ => {
                self.held = corners;
                self.left = 6;
                corners
            }
        }
    }

    /// A number between the least and the most shift.
    fn anywhere(&mut self) -> f64 {
        // 32 random bits, over 2³² (exactly), from 0 to 1.
        let share = (self.draw() >> 32) as u32;
        Wind::MOST * (f64::from(share) * (2.0 / 4_294_967_296.0) - 1.0)
    }

    /// 64 random bits (splitmix64).
    fn draw(&mut self) -> u64 {
        self.seed = self.seed.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.seed;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }
}
