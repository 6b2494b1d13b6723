//! Euclidean distances, squared so that they stay rational.

use crate::exact::{Rational, dot};
use crate::geometry::{Polytope, solve};

/// The squared distance of a point from a polytope.
///
/// The nearest point is the projection onto the affine hull of some face, and that face is cut out
/// by at most `d` independent facets that hold the projection: all choices are tried.
pub(super) fn squared_distance(polytope: &Polytope, point: &[Rational]) -> Rational {
    if polytope.contains(point) {
        return Rational::ZERO;
    }
    let mut chosen = Vec::new();
    let mut best = None;
    visit(polytope, point, 0, &mut chosen, &mut best);
    best.unwrap_or(Rational::ZERO)
}

fn visit(
    polytope: &Polytope,
    point: &[Rational],
    from: usize,
    chosen: &mut Vec<usize>,
    best: &mut Option<Rational>,
) {
    if !chosen.is_empty() {
        let Some(nearest) = project(polytope, point, chosen) else { return };
        if polytope.contains(&nearest) {
            let gap: Rational = nearest.iter().zip(point).map(|(a, b)| (a - b) * (a - b)).sum();
            if best.as_ref().is_none_or(|b| gap < *b) {
                *best = Some(gap);
            }
        }
    }
    if chosen.len() < point.len() {
        for i in from..polytope.facets.len() {
            chosen.push(i);
            visit(polytope, point, i + 1, chosen, best);
            chosen.pop();
        }
    }
}

/// The projection onto the intersection of facets' planes: point + Σ λ_i normal_i; `None` when the
/// normals are dependent.
fn project(polytope: &Polytope, point: &[Rational], chosen: &[usize]) -> Option<Vec<Rational>> {
    let facets: Vec<_> = chosen.iter().map(|&i| &polytope.facets[i]).collect();
    let gram: Vec<Vec<Rational>> =
        facets.iter().map(|f| facets.iter().map(|g| dot(&f.normal, &g.normal)).collect()).collect();
    let gaps: Vec<Rational> = facets.iter().map(|f| &f.offset - dot(&f.normal, point)).collect();
    let rows: Vec<_> = gram.iter().map(Vec::as_slice).zip(&gaps).collect();
    let factors = solve(&rows)?;
    let mut nearest = point.to_vec();
    for (facet, factor) in facets.iter().zip(&factors) {
        nearest.iter_mut().zip(&facet.normal).for_each(|(x, n)| *x += n * factor);
    }
    Some(nearest)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn p(coordinates: &[i64]) -> Vec<Rational> {
        coordinates.iter().map(|&x| Rational::from(x)).collect()
    }

    #[test]
    fn distances_to_faces_edges_and_corners() {
        let square = Polytope::from_box(&p(&[0, 0]), &p(&[2, 2]));
        assert_eq!(square.squared_distance(&p(&[1, 2])), Rational::ZERO);
        assert_eq!(square.squared_distance(&p(&[1, 5])), Rational::from(9));
        assert_eq!(square.squared_distance(&p(&[5, 6])), Rational::from(25));
        let cube = Polytope::from_box(&p(&[0, 0, 0]), &p(&[2, 2, 2]));
        assert_eq!(cube.squared_distance(&p(&[3, 4, 4])), Rational::from(9));
        assert_eq!(cube.squared_distance(&p(&[1, 4, 4])), Rational::from(8));
        assert_eq!(cube.squared_distance(&p(&[1, 1, -3])), Rational::from(9));
        let wedge = Polytope::polygon(&[p(&[0, 0]), p(&[4, 0]), p(&[0, 4])]).unwrap();
        assert_eq!(wedge.squared_distance(&p(&[4, 4])), Rational::from(8));
    }
}
