//! Intersections of half-spaces, by exact enumeration of vertices.

use crate::exact::{Rational, dot};
use crate::geometry::{HalfSpace, Polytope, ShapeError, hull, null_space, rank, solve};

/// The most half-spaces that are enumerated: all pairs in the plane, all triples in space.
const MOST: [usize; 2] = [160, 48];

/// The intersection, see [`Polytope::from_half_spaces`].
pub(super) fn intersection(half_spaces: &[HalfSpace]) -> Result<Polytope, ShapeError> {
    let dimension = check_sizes(half_spaces)?;
    let mut half_spaces: Vec<HalfSpace> = half_spaces.iter().map(HalfSpace::normalised).collect();
    half_spaces.sort_by(hull::compare_half_spaces);
    // Sorted, the first of parallel half-spaces is the tightest.
    half_spaces.dedup_by(|later, first| later.normal == first.normal);
    let most = MOST[dimension - 2];
    if half_spaces.len() > most {
        return Err(ShapeError::TooMany { most });
    }
    if let Some(direction) = lineality(&half_spaces, dimension) {
        return Err(cylinder_error(half_spaces, direction, dimension));
    }
    let vertices = vertices(&half_spaces, dimension);
    if vertices.is_empty() {
        return Err(ShapeError::Empty);
    }
    if let Some(direction) = recession(&half_spaces, dimension) {
        return Err(ShapeError::Unbounded { direction });
    }
    hull::hull(&vertices).map_err(|_| ShapeError::Flat)
}

fn check_sizes(half_spaces: &[HalfSpace]) -> Result<usize, ShapeError> {
    let dimension = half_spaces.first().ok_or(ShapeError::Unbounded { direction: Vec::new() })?.normal.len();
    if !matches!(dimension, 2 | 3) || half_spaces.iter().any(|h| h.normal.len() != dimension) {
        return Err(ShapeError::Dimension);
    }
    match half_spaces.iter().position(|h| h.normal.iter().all(Rational::is_zero)) {
        Some(index) => Err(ShapeError::ZeroNormal { index }),
        None => Ok(dimension),
    }
}

/// A direction along which no inequality changes.
fn lineality(half_spaces: &[HalfSpace], dimension: usize) -> Option<Vec<Rational>> {
    null_space(&normals(half_spaces), dimension).into_iter().next()
}

fn normals(half_spaces: &[HalfSpace]) -> Vec<Vec<Rational>> {
    half_spaces.iter().map(|h| h.normal.clone()).collect()
}

/// Whether a set that is the same all along some line is empty or unbounded: its section across the
/// lines decides.
fn cylinder_error(mut section: Vec<HalfSpace>, direction: Vec<Rational>, dimension: usize) -> ShapeError {
    for line in null_space(&normals(&section), dimension) {
        let back = line.iter().map(|x| -x).collect();
        section.push(HalfSpace { normal: line, offset: Rational::ZERO });
        section.push(HalfSpace { normal: back, offset: Rational::ZERO });
    }
    if vertices(&section, dimension).is_empty() {
        ShapeError::Empty
    } else {
        ShapeError::Unbounded { direction }
    }
}

/// All vertices, possibly repeated.
fn vertices(half_spaces: &[HalfSpace], dimension: usize) -> Vec<Vec<Rational>> {
    let mut found = Vec::new();
    for_each_choice(half_spaces.len(), dimension, &mut |choice| {
        let rows: Vec<_> =
            choice.iter().map(|&i| (&half_spaces[i].normal[..], &half_spaces[i].offset)).collect();
        if let Some(point) = solve(&rows)
            && half_spaces.iter().all(|h| h.contains(&point))
        {
            found.push(point);
        }
    });
    found
}

/// A direction in which a set without lines, but with points, goes on for ever: an extreme ray of
/// {x : normal · x ≤ 0} lies on d − 1 independent bounding planes.
fn recession(half_spaces: &[HalfSpace], dimension: usize) -> Option<Vec<Rational>> {
    let mut found = None;
    for_each_choice(half_spaces.len(), dimension - 1, &mut |choice| {
        let rows: Vec<_> = choice.iter().map(|&i| half_spaces[i].normal.clone()).collect();
        if found.is_some() || rank(&rows) < dimension - 1 {
            return;
        }
        for ray in null_space(&rows, dimension) {
            let back: Vec<Rational> = ray.iter().map(|x| -x).collect();
            let goes_on = |r: &Vec<Rational>| half_spaces.iter().all(|h| !dot(&h.normal, r).is_positive());
            found = found.take().or_else(|| [ray, back].into_iter().find(goes_on));
        }
    });
    found
}

/// Calls `visit` with each increasing choice of `size` indices below `count`.
fn for_each_choice(count: usize, size: usize, visit: &mut impl FnMut(&[usize])) {
    let mut choice: Vec<usize> = (0..size).collect();
    if count < size {
        return;
    }
    loop {
        visit(&choice);
        let Some(place) = (0..size).rev().find(|&i| choice[i] < count - size + i) else { return };
        choice[place] += 1;
        for i in place + 1..size {
            choice[i] = choice[i - 1] + 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(rows: &[([i64; 2], i64)]) -> Result<Polytope, ShapeError> {
        let row = |(normal, offset): &([i64; 2], i64)| HalfSpace {
            normal: normal.iter().map(|&x| Rational::from(x)).collect(),
            offset: Rational::from(*offset),
        };
        intersection(&rows.iter().map(row).collect::<Vec<_>>())
    }

    #[test]
    fn redundant_and_parallel_half_spaces_are_dropped() {
        let triangle = [([1, 1], 2), ([-1, 0], 0), ([0, -1], 0)];
        let more = [&triangle[..], &[([2, 2], 4), ([1, 1], 3), ([1, 0], 2), ([1, 0], 9)]].concat();
        assert_eq!(set(&triangle).unwrap(), set(&more).unwrap());
        assert_eq!(set(&triangle).unwrap().vertices.len(), 3);
    }

    #[test]
    fn sets_that_are_no_polytopes_say_why() {
        assert_eq!(set(&[([1, 0], 0), ([-1, 0], -1)]).unwrap_err(), ShapeError::Empty);
        assert_eq!(set(&[([1, 0], 0), ([-1, 0], -1), ([0, 1], 0)]).unwrap_err(), ShapeError::Empty);
        assert_eq!(set(&[([1, 0], 0), ([0, 1], 0), ([-1, -1], -1)]).unwrap_err(), ShapeError::Empty);
        assert_eq!(
            set(&[([1, 0], 0), ([-1, 0], 0), ([0, 1], 1), ([0, -1], 0)]).unwrap_err(),
            ShapeError::Flat
        );
        assert_eq!(set(&[([1, 0], 0), ([0, 1], 0), ([-1, -1], 0)]).unwrap_err(), ShapeError::Flat);
        assert_eq!(set(&[([0, 0], 1)]).unwrap_err(), ShapeError::ZeroNormal { index: 0 });
        for open in
            [&[([1, 0], 1)][..], &[([1, 0], 1), ([-1, 0], 0)], &[([1, 0], 1), ([0, 1], 0), ([-1, 0], 0)]]
        {
            assert!(matches!(set(open).unwrap_err(), ShapeError::Unbounded { .. }), "{open:?}");
        }
    }
}
