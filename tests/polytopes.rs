//! Polytopes against Fukuda's cddlib, both ways and in exact arithmetic: hulls of points, and
//! intersections of half-spaces, with everything that can be degenerate about them.
//!
//! The program is the one that `DOSMC_CDD` names, or `cddexec_gmp` (Debian's `libcdd-tools`). Without
//! it the tests say loudly that nothing was compared, and fail where `DOSMC_REQUIRE_TOOLS` is set.

#![allow(clippy::disallowed_methods, reason = "runs another program")]

mod common;

use std::collections::BTreeSet;
use std::io::Write;
use std::process::{Command, Stdio};

use dosmc::exact::Rational;
use dosmc::geometry::{HalfSpace, Polytope, ShapeError, rank};

type Point = Vec<Rational>;

/// A half-space in its canonical form, so that sets of them can be compared.
type Facet = (Point, Rational);

/// What cddlib says of a set: its rows as they stand, and how many of them are linearities.
struct Said {
    rows: Vec<Vec<Rational>>,
    linearities: usize,
}

struct Cdd(String);

impl Cdd {
    fn find() -> Option<Cdd> {
        let name = std::env::var("DOSMC_CDD").unwrap_or_else(|_| "cddexec_gmp".into());
        if Command::new(&name).arg("--help").stdin(Stdio::null()).output().is_ok() {
            return Some(Cdd(name));
        }
        common::skipped(&format!("{name} is not there: no polytope compared with cddlib"));
        None
    }

    /// The other representation of a set; each row is (1, vertex), (0, ray) or (b, a) for
    /// b + a · x ≥ 0.
    fn other(&self, kind: &str, rows: &[Vec<Rational>]) -> Said {
        let columns = rows[0].len();
        let mut input = format!("{kind}-representation\nbegin\n{} {columns} rational\n", rows.len());
        for row in rows {
            let numbers: Vec<String> = row.iter().map(fraction).collect();
            input += &(numbers.join(" ") + "\n");
        }
        input += "end\n";
        let mut child = Command::new(&self.0)
            .arg("--rep")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("it could be run before");
        child.stdin.take().expect("piped").write_all(input.as_bytes()).expect("it reads");
        let output = child.wait_with_output().expect("it ends");
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        read(&text).unwrap_or_else(|| panic!("{input}\n{text}"))
    }

    /// The facets of a hull, or none when it is flat.
    fn facets(&self, points: &[Point]) -> Option<BTreeSet<Facet>> {
        let rows: Vec<Vec<Rational>> = points.iter().map(|p| [&[Rational::ONE], &p[..]].concat()).collect();
        let said = self.other("V", &rows);
        (said.linearities == 0).then(|| {
            // A row without a coordinate says nothing: 1 ≥ 0.
            let bounds = said.rows.iter().filter(|row| row[1..].iter().any(|x| !x.is_zero()));
            let facet = |row: &Vec<Rational>| {
                let normal = row[1..].iter().map(|x| -x).collect();
                canonical(&HalfSpace { normal, offset: row[0].clone() })
            };
            bounds.map(facet).collect()
        })
    }

    /// The vertices of an intersection, or why it is no polytope.
    fn vertices(&self, half_spaces: &[HalfSpace]) -> Result<BTreeSet<Point>, &'static str> {
        let row = |h: &HalfSpace| {
            [h.offset.clone()].into_iter().chain(h.normal.iter().map(|x| -x)).collect::<Vec<_>>()
        };
        let said = self.other("H", &half_spaces.iter().map(row).collect::<Vec<_>>());
        let (mut points, rays): (Vec<_>, Vec<_>) = said.rows.into_iter().partition(|row| !row[0].is_zero());
        if half_spaces.iter().all(|h| h.offset.is_zero()) {
            // Of a cone only the rays are said.
            let dimension = half_spaces[0].normal.len();
            points.push([vec![Rational::ONE], vec![Rational::ZERO; dimension]].concat());
        }
        if points.is_empty() {
            return Err("empty");
        }
        if !rays.is_empty() || said.linearities > 0 {
            return Err("unbounded");
        }
        let points: BTreeSet<Point> = points.iter().map(|row| row[1..].to_vec()).collect();
        let first = points.first().expect("one at least").clone();
        let minus = |p: &Point| p.iter().zip(&first).map(|(a, b)| a - b).collect();
        let spread: Vec<Point> = points.iter().map(minus).collect();
        if rank(&spread) < first.len() { Err("flat") } else { Ok(points) }
    }
}

fn fraction(x: &Rational) -> String {
    let (numerator, denominator) = x.parts();
    format!("{numerator}/{denominator}")
}

/// The rows between `begin` and `end`, and the number of linearities said before.
fn read(text: &str) -> Option<Said> {
    let (head, rest) = text.split_once("begin")?;
    let (table, _) = rest.split_once("end")?;
    let linearities = head
        .lines()
        .find_map(|line| line.trim().strip_prefix("linearity"))
        .map_or(0, |l| l.split_whitespace().next().and_then(|count| count.parse().ok()).unwrap_or(0));
    let number = |text: &str| -> Option<Rational> {
        let (n, d) = text.split_once('/').unwrap_or((text, "1"));
        let (n, negative) = n.strip_prefix('-').map_or((n, false), |rest| (rest, true));
        let value = Rational::from_decimal(n, 0)? / Rational::from_decimal(d, 0)?;
        Some(if negative { -value } else { value })
    };
    let mut lines = table.lines().map(str::trim).filter(|line| !line.is_empty());
    // How many rows and columns.
    lines.next()?;
    let rows: Option<Vec<Vec<Rational>>> =
        lines.map(|line| line.split_whitespace().map(number).collect()).collect();
    Some(Said { rows: rows?, linearities })
}

fn canonical(half_space: &HalfSpace) -> Facet {
    let h = half_space.normalised();
    (h.normal, h.offset)
}

fn facets_of(polytope: &Polytope) -> BTreeSet<Facet> {
    assert!(polytope.facets.iter().all(|f| canonical(f) == (f.normal.clone(), f.offset.clone())));
    let all: BTreeSet<Facet> = polytope.facets.iter().map(canonical).collect();
    assert_eq!(all.len(), polytope.facets.len(), "a facet twice");
    all
}

fn vertices_of(polytope: &Polytope) -> BTreeSet<Point> {
    let all: BTreeSet<Point> = polytope.vertices.iter().cloned().collect();
    assert_eq!(all.len(), polytope.vertices.len(), "a vertex twice");
    all
}

/// Numbers that are always the same ones (a linear congruence).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, count: i64) -> i64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) % count.unsigned_abs()) as i64
    }

    fn number(&mut self, reach: i64, denominators: &[i64]) -> Rational {
        let denominator = denominators[self.below(denominators.len() as i64) as usize];
        Rational::ratio(self.below(2 * reach + 1) - reach, denominator)
    }

    /// Points in general position, on a small grid, with repetitions, all on a line or a plane, or
    /// with more of them on the edges and facets of others.
    fn points(&mut self, dimension: usize) -> Vec<Point> {
        let (reach, denominators): (i64, &[i64]) =
            if self.below(2) == 0 { (2, &[1]) } else { (50, &[1, 2, 3, 7]) };
        let count = 1 + self.below(11);
        let point = |numbers: &mut Numbers| -> Point {
            (0..dimension).map(|_| numbers.number(reach, denominators)).collect()
        };
        let mut points: Vec<Point> = (0..count).map(|_| point(self)).collect();
        match self.below(4) {
            0 => {
                let again = points[self.below(count) as usize].clone();
                points.extend([again.clone(), again]);
            }
            1 => {
                // In the plane or on the line x + … = 1.
                for p in &mut points {
                    let sum: Rational = p[1..].iter().cloned().sum();
                    p[0] = Rational::ONE - sum;
                }
            }
            2 => {
                let half = Rational::ratio(1, 2);
                for i in 1..points.len() {
                    let between = |(a, b): (&Rational, &Rational)| (a + b) * &half;
                    points.push(points[i].iter().zip(&points[i - 1]).map(between).collect());
                }
            }
            _ => {}
        }
        points
    }

    /// Half-spaces around 0 or anywhere, with parallel and opposite ones.
    fn half_spaces(&mut self, dimension: usize) -> Vec<HalfSpace> {
        let count = 1 + self.below(9);
        let around = self.below(2) == 0;
        let mut all: Vec<HalfSpace> = Vec::new();
        while (all.len() as i64) < count {
            let normal: Point = (0..dimension).map(|_| self.number(3, &[1, 2])).collect();
            if normal.iter().all(Rational::is_zero) {
                continue;
            }
            let offset = self.number(6, &[1, 3]);
            all.push(HalfSpace { normal, offset: if around { offset.abs() } else { offset } });
        }
        if self.below(3) == 0 {
            // The same plane from the other side, or moved.
            let HalfSpace { normal, offset } = all[self.below(count) as usize].clone();
            let back = normal.iter().map(|x| -x * Rational::from(2)).collect();
            let moved = Rational::from(self.below(3) - 1);
            all.push(HalfSpace { normal: back, offset: (moved - offset) * Rational::from(2) });
        }
        if self.below(3) > 0 {
            for axis in 0..dimension {
                for sign in [1, -1] {
                    let mut normal = vec![Rational::ZERO; dimension];
                    normal[axis] = Rational::from(sign);
                    all.push(HalfSpace { normal, offset: Rational::from(4) });
                }
            }
        }
        all
    }
}

/// How many sets of each kind and dimension are compared.
const CASES: usize = 250;

#[test]
fn threat_21_hulls_are_those_of_cddlib() {
    let Some(cdd) = Cdd::find() else { return };
    let mut numbers = Numbers(1);
    for dimension in [2, 3] {
        let mut counts = [0; 2];
        for _ in 0..CASES {
            let points = numbers.points(dimension);
            let truth = cdd.facets(&points);
            counts[usize::from(truth.is_some())] += 1;
            match (Polytope::hull(&points), truth) {
                (Ok(hull), Some(facets)) => {
                    assert_eq!(facets_of(&hull), facets, "{points:?}");
                    assert_eq!(Ok(vertices_of(&hull)), cdd.vertices(&hull.facets), "{points:?}");
                }
                (Err(ShapeError::Flat | ShapeError::TooFewPoints), None) => {}
                (ours, truth) => panic!("{ours:?}, but {truth:?} for {points:?}"),
            }
        }
        assert!(counts.iter().all(|n| *n > 50), "{counts:?}");
    }
}

#[test]
fn threat_21_intersections_are_those_of_cddlib() {
    let Some(cdd) = Cdd::find() else { return };
    let mut numbers = Numbers(2);
    for dimension in [2, 3] {
        let mut counts = [0; 4];
        for _ in 0..CASES {
            let half_spaces = numbers.half_spaces(dimension);
            let truth = cdd.vertices(&half_spaces);
            let kind = match &truth {
                Ok(_) => 0,
                Err("empty") => 1,
                Err("unbounded") => 2,
                Err(_) => 3,
            };
            counts[kind] += 1;
            match (Polytope::from_half_spaces(&half_spaces), truth) {
                (Ok(set), Ok(vertices)) => {
                    assert_eq!(vertices_of(&set), vertices, "{half_spaces:?}");
                    let corners: Vec<Point> = vertices.into_iter().collect();
                    assert_eq!(Some(facets_of(&set)), cdd.facets(&corners), "{half_spaces:?}");
                }
                (Err(ShapeError::Empty), Err("empty")) | (Err(ShapeError::Flat), Err("flat")) => {}
                (Err(ShapeError::Unbounded { direction }), Err("unbounded")) => {
                    // Along the direction that is named no inequality ends.
                    let ends = |h: &HalfSpace| dosmc::exact::dot(&h.normal, &direction).is_positive();
                    assert!(direction.iter().any(|x| !x.is_zero()) && !half_spaces.iter().any(ends));
                }
                (ours, truth) => panic!("{ours:?}, but {truth:?} for {half_spaces:?}"),
            }
        }
        assert!(counts[..3].iter().all(|n| *n > 30) && counts[3] > 0, "{counts:?}");
    }
}

/// What can only be wrong in one place: a set that is moved, in another order, or said twice.
#[test]
fn threat_21_the_order_and_repetition_of_points_change_nothing() {
    let mut numbers = Numbers(3);
    for dimension in [2, 3] {
        for _ in 0..100 {
            let mut points = numbers.points(dimension);
            let Ok(hull) = Polytope::hull(&points) else { continue };
            points.extend(points.clone());
            points.reverse();
            let again = Polytope::hull(&points).expect("the same points");
            assert_eq!((&again.facets, vertices_of(&again)), (&hull.facets, vertices_of(&hull)));
            points.push(hull.middle());
            assert_eq!(Polytope::hull(&points).map(|h| h.vertices.len()), Ok(hull.vertices.len()));
        }
    }
}
