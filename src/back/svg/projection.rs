//! Parallel projections onto the picture: the plane itself, the three views along the axes of a
//! mission in space, and an axonometric one.

use super::outline::Point;
use crate::exact::Rational;

/// The direction in which the viewer of the axonometric picture stands: from the front (small y), a
/// little to the right, half above. The angles are in degrees.
const AZIMUTH: f64 = -62.0;
const ELEVATION: f64 = 27.0;

/// A parallel projection whose lengths are to scale along its two rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// What is drawn to the right, what is drawn upwards, and the way to the viewer: orthonormal.
    rows: [[f64; 3]; 3],
    /// The two coordinates that are drawn, if it is along an axis.
    axes: Option<[usize; 2]>,
}

impl Projection {
    /// From above: x to the right, y upwards. The plane as it is.
    pub const TOP: Projection =
        Projection { rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], axes: Some([0, 1]) };
    /// From the front: x to the right, z upwards.
    pub const FRONT: Projection =
        Projection { rows: [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]], axes: Some([0, 2]) };
    /// From the right: y to the right, z upwards.
    pub const SIDE: Projection =
        Projection { rows: [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]], axes: Some([1, 2]) };

    /// From the front, the right and above at once, with z upwards.
    pub fn axonometric() -> Projection {
        let ((s, c), (up, along)) = (AZIMUTH.to_radians().sin_cos(), ELEVATION.to_radians().sin_cos());
        let rows = [[-s, c, 0.0], [-up * c, -up * s, along], [along * c, along * s, up]];
        Projection { rows, axes: None }
    }

    /// The two coordinates that are drawn; none of the axonometric one.
    pub fn axes(&self) -> Option<[usize; 2]> {
        self.axes
    }

    /// Where a point is drawn; coordinates that it does not have are 0.
    pub fn flat(&self, point: &[f64]) -> Point {
        [0, 1].map(|row| along(&self.rows[row], point))
    }

    /// Where an exact point is drawn.
    pub fn of(&self, point: &[Rational]) -> Point {
        self.flat(&point.iter().map(Rational::to_f64).collect::<Vec<_>>())
    }

    /// How near to the viewer a point is.
    pub fn nearness(&self, point: &[f64]) -> f64 {
        along(&self.rows[2], point)
    }
}

fn along(row: &[f64; 3], point: &[f64]) -> f64 {
    row.iter().zip(point).map(|(a, x)| a * x).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn projections_are_orthonormal_and_right_handed() {
        for p in [Projection::TOP, Projection::FRONT, Projection::SIDE, Projection::axonometric()] {
            let [a, b, c] = p.rows;
            for (i, row) in p.rows.iter().enumerate() {
                for (j, other) in p.rows.iter().enumerate() {
                    assert!((along(row, other) - f64::from(u8::from(i == j))).abs() < 1e-12);
                }
            }
            let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
            assert!(along(&cross, &c) > 0.0, "not mirrored: {p:?}");
        }
    }
}
