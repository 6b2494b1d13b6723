//! The nearest points of two convex sets that are known by their farthest points only.
//!
//! The algorithm of Gilbert, Johnson and Keerthi (1988), in the plane and in space alike: the point
//! of the difference {q − p} that is nearest to 0 is approached by simplices of farthest points. Its
//! direction is the normal of the widest slab between the sets, whatever touches there: faces,
//! edges, corners or round parts.

/// A point or a vector; in the plane the last coordinate is 0.
pub(super) type Vector = [f64; 3];

/// Far more steps than polytopes take; round sets converge to rounding in as many.
const MOST_STEPS: usize = 100;

/// A gain below this share of the distance is rounding.
const PROGRESS: f64 = 1e-14;

/// The scalar product.
pub(super) fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a − b.
pub(super) fn minus(a: &Vector, b: &Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The vector product.
pub(super) fn cross(a: &Vector, b: &Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A point with its missing coordinates 0.
pub(super) fn vector(point: &[f64]) -> Vector {
    [0, 1, 2].map(|axis| point.get(axis).copied().unwrap_or(0.0))
}

/// Directions, not of unit length, along which a convex set lies farther than `near` beyond 0, the
/// best ones known; none when it comes as near as that.
///
/// `least` gives a point x of the set with the least d · x.
pub(super) fn normals(least: impl Fn(&Vector) -> Vector, first: &Vector, near: f64) -> Vec<Vector> {
    let mut simplex = vec![least(first)];
    let mut nearest = simplex[0];
    for _ in 0..MOST_STEPS {
        let square = dot(&nearest, &nearest);
        // The nearest point so far is a point of the set.
        if square <= near * near {
            return Vec::new();
        }
        let next = least(&nearest);
        if square - dot(&nearest, &next) <= PROGRESS * square || simplex.contains(&next) {
            break;
        }
        simplex.push(next);
        let Some((face, point)) = nearest_face(&simplex) else { break };
        // No farther point is ever nearer but by rounding.
        if dot(&point, &point) >= square {
            break;
        }
        (simplex, nearest) = (face, point);
    }
    directions(&simplex, &nearest)
}

/// The direction to the nearest point and, less prone to rounding where the sets are very near to
/// each other, the normal of the last face.
fn directions(simplex: &[Vector], nearest: &Vector) -> Vec<Vector> {
    let mut found = vec![*nearest];
    if let [a, b, c, ..] = simplex {
        let normal = cross(&minus(b, a), &minus(c, a));
        let sign = if dot(&normal, nearest) < 0.0 { -1.0 } else { 1.0 };
        found.push(normal.map(|x| sign * x));
    }
    found.retain(|v| dot(v, v) > 0.0);
    found
}

/// The face of a simplex of at most four points that is nearest to 0, and its nearest point.
fn nearest_face(simplex: &[Vector]) -> Option<(Vec<Vector>, Vector)> {
    let mut best: Option<(Vec<Vector>, Vector, f64)> = None;
    for choice in 1..1usize << simplex.len() {
        let face: Vec<Vector> =
            simplex.iter().enumerate().filter(|(i, _)| choice >> i & 1 == 1).map(|(_, p)| *p).collect();
        let Some(point) = projection(&face) else { continue };
        let square = dot(&point, &point);
        if best.as_ref().is_none_or(|(.., least)| square < *least) {
            best = Some((face, point, square));
        }
    }
    best.map(|(face, point, _)| (face, point))
}

/// The projection of 0 onto the affine hull of points, if it lies between all of them.
fn projection(face: &[Vector]) -> Option<Vector> {
    let (origin, rest) = face.split_first()?;
    let edges: Vec<Vector> = rest.iter().map(|p| minus(p, origin)).collect();
    let shares = shares(&edges, origin)?;
    if shares.iter().any(|s| *s < 0.0) || shares.iter().sum::<f64>() > 1.0 {
        return None;
    }
    let mut point = *origin;
    for (edge, share) in edges.iter().zip(&shares) {
        point.iter_mut().zip(edge).for_each(|(x, e)| *x += share * e);
    }
    Some(point)
}

/// The λ with least |origin + Σ λ_i edge_i|; `None` for dependent edges.
fn shares(edges: &[Vector], origin: &Vector) -> Option<Vec<f64>> {
    match edges {
        [] => Some(Vec::new()),
        [e] => {
            let square = dot(e, e);
            (square > 0.0).then(|| vec![-dot(e, origin) / square])
        }
        [e, f] => {
            let normal = cross(e, f);
            let square = dot(&normal, &normal);
            // By Cramer's rule in the plane of the two edges.
            let share = |a: Vector| dot(&a, &normal) / square;
            let back = origin.map(|x| -x);
            (square > 0.0).then(|| vec![share(cross(&back, f)), share(cross(e, &back))])
        }
        [e, f, g] => {
            let volume = dot(e, &cross(f, g));
            let back = origin.map(|x| -x);
            let all = [cross(f, g), cross(g, e), cross(e, f)].map(|n| dot(&back, &n) / volume);
            (volume != 0.0).then(|| all.to_vec())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The widest slab between 0 and the hull of points, by trying every normal that can be best: of
    /// all points, edges' and triangles' nearest points.
    fn widest(points: &[Vector]) -> f64 {
        let width = |n: &Vector| {
            let length = dot(n, n).sqrt();
            if length.is_nan() || length < 1e-12 {
                return f64::NEG_INFINITY;
            }
            points.iter().map(|p| dot(n, p) / length).fold(f64::INFINITY, f64::min)
        };
        let mut best = f64::NEG_INFINITY;
        for (i, a) in points.iter().enumerate() {
            best = best.max(width(a));
            for (j, b) in points.iter().enumerate().skip(i + 1) {
                let e = minus(b, a);
                let share = -dot(&e, a) / dot(&e, &e);
                best = best.max(width(&[0, 1, 2].map(|k| a[k] + share * e[k])));
                for c in &points[j + 1..] {
                    let n = cross(&e, &minus(c, a));
                    best = best.max(width(&n)).max(width(&n.map(|x| -x)));
                }
            }
        }
        best
    }

    fn found(points: &[Vector]) -> f64 {
        let least =
            |d: &Vector| *points.iter().min_by(|a, b| dot(d, a).total_cmp(&dot(d, b))).expect("points");
        let width = |n: &Vector| dot(n, &least(n)) / dot(n, n).sqrt();
        normals(least, &[1.0, 0.0, 0.0], 0.0).iter().map(width).fold(f64::NEG_INFINITY, f64::max)
    }

    #[test]
    fn edges_that_pass_each_other_are_separated_across_both() {
        // One edge along x at height 0, the other one along y at height 0.01: no facet separates them.
        let (a, b) = ([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]], [[0.0, -1.0, 0.01], [0.0, 1.0, 0.01]]);
        let difference: Vec<Vector> = b.iter().flat_map(|q| a.iter().map(|p| minus(q, p))).collect();
        assert!((found(&difference) - 0.01).abs() < 1e-15);
    }

    #[test]
    fn a_hair_between_large_faces_is_found() {
        let square = |z: f64| [[-9.0, -7.0, z], [8.0, -7.0, z], [8.0, 9.0, z], [-9.0, 9.0, z]];
        let points: Vec<Vector> =
            square(1e-9).iter().flat_map(|q| square(0.0).map(|p| minus(q, &p))).collect();
        assert!((found(&points) - 1e-9).abs() < 1e-12, "{}", found(&points));
    }

    fn cloud() -> impl Strategy<Value = Vec<Vector>> {
        // Whole numbers make faces with many corners and points on one line.
        let coarse = (-4i32..5).prop_map(f64::from);
        let coordinate = prop_oneof![coarse, -4.0f64..4.0];
        prop::collection::vec([coordinate.clone(), coordinate.clone(), coordinate], 4..12)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]
        #[test]
        fn no_slab_is_wider(points in cloud(), shift in [-6i32..7, -6i32..7, -6i32..7]) {
            let moved: Vec<Vector> =
                points.iter().map(|p| [0, 1, 2].map(|k| p[k] + f64::from(shift[k]))).collect();
            let truth = widest(&moved);
            if truth > 1e-9 {
                prop_assert!(found(&moved) >= truth - 1e-9, "{} {truth}", found(&moved));
            } else if truth < -1e-9 {
                // `widest` is no depth, but negative exactly when 0 lies inside.
                prop_assert!(found(&moved) <= 1e-9);
            }
        }
    }
}
