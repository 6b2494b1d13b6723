//! Oblique directions: between facets, so that robots see and get past edges and corners.

use super::nearest::{Vector, vector};
use super::solid::Solid;
use super::{Directions, Stage};
use crate::exact::Rational;
use crate::geometry::HalfSpace;
use crate::ir::Piece;

/// An edge of a polytope in space.
#[derive(Clone, Debug)]
pub struct Edge {
    /// Its ends.
    pub(super) ends: [Vector; 2],
    /// The outward normal halfway between those of its two facets.
    pub(super) normal: Vector,
}

/// The edges of a polytope in space; none in the plane, none of a ball.
pub(super) fn edges(piece: &Piece) -> Vec<Edge> {
    let Piece::Polytope(polytope) = piece else { return Vec::new() };
    if polytope.dimension() != 3 {
        return Vec::new();
    }
    let on = |facet: &HalfSpace| -> Vec<bool> {
        polytope.vertices.iter().map(|v| !facet.contains_interior(v)).collect()
    };
    let incident: Vec<Vec<bool>> = polytope.facets.iter().map(on).collect();
    let mut edges = Vec::new();
    for (i, f) in polytope.facets.iter().enumerate() {
        for (j, g) in polytope.facets.iter().enumerate().skip(i + 1) {
            let shared = (0..polytope.vertices.len()).filter(|&v| incident[i][v] && incident[j][v]);
            let ends: Vec<Vector> = shared.map(|v| floats(&polytope.vertices[v])).collect();
            if let [a, b] = ends[..] {
                let (f, g) = (unit(&floats(&f.normal)), unit(&floats(&g.normal)));
                let normal = [0, 1, 2].map(|k| f[k] + g[k]);
                edges.push(Edge { ends: [a, b], normal });
            }
        }
    }
    edges
}

fn floats(v: &[Rational]) -> Vector {
    vector(&v.iter().map(Rational::to_f64).collect::<Vec<_>>())
}

fn unit(v: &Vector) -> Vector {
    let length = super::nearest::dot(v, v).sqrt();
    v.map(|x| x / length)
}

/// Adds the diagonals of the axes, and the normals halfway between the facets at each edge.
pub(super) fn add(solid: &mut Solid, dimension: usize, directions: &mut Directions) {
    let signs = [1.0, -1.0];
    let mut normals: Vec<Vector> = Vec::new();
    for i in 0..dimension {
        for j in i + 1..dimension {
            for (a, b) in signs.iter().flat_map(|a| signs.map(|b| (*a, b))) {
                let mut normal = [0.0; 3];
                (normal[i], normal[j]) = (a, b);
                normals.push(normal);
            }
        }
    }
    // A ball has the diagonals of all three axes among its facets' normals.
    if dimension == 3 && solid.ball.is_none() {
        let pairs = signs.iter().flat_map(|a| signs.map(|b| (*a, b)));
        normals.extend(pairs.flat_map(|(a, b)| signs.map(|c| [a, b, c])));
    }
    // They point at the solid.
    normals.extend(solid.edges.iter().map(|edge| edge.normal.map(|x| -x)));
    for normal in normals {
        solid.add_face(Stage::Oblique, directions.intern_near(&normal[..dimension]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Polytope;

    fn point(p: [i64; 3]) -> Vec<Rational> {
        p.iter().map(|&x| Rational::from(x)).collect()
    }

    #[test]
    fn polytopes_have_the_edges_that_euler_counts() {
        let cube = Polytope::from_box(&point([0; 3]), &point([2; 3]));
        let pyramid = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1, 1, 3]].map(point);
        let pyramid = Polytope::hull(&pyramid).expect("a pyramid");
        for polytope in [cube, pyramid] {
            let found = edges(&Piece::Polytope(polytope.clone()));
            assert_eq!(found.len() + 2, polytope.vertices.len() + polytope.facets.len());
            for edge in found {
                let level = |p: &Vector| super::super::nearest::dot(&edge.normal, p);
                let most = polytope.vertices.iter().map(|v| level(&floats(v))).fold(f64::MIN, f64::max);
                assert!(edge.ends.iter().all(|end| (level(end) - most).abs() < 1e-12));
            }
        }
    }
}
