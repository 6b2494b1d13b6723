//! Missions as data: what the laws change, and the text that dosmc reads.
//!
//! Numbers are whole millionths, so that moving, turning and scaling are exact.

use std::fmt::Write;

use crate::chance::Chance;
use crate::formula::Formula;

/// A number in millionths.
pub type Num = i64;

/// So many millionths are one.
pub const ONE: Num = 1_000_000;

/// A number as the language writes it.
pub fn text(x: Num) -> String {
    let (sign, x) = (if x < 0 { "-" } else { "" }, x.unsigned_abs());
    let (whole, rest) = (x / ONE as u64, x % ONE as u64);
    match rest {
        0 => format!("{sign}{whole}"),
        _ => format!("{sign}{whole}.{}", format!("{rest:06}").trim_end_matches('0')),
    }
}

fn tuple(point: &[Num]) -> String {
    format!("({})", point.iter().map(|x| text(*x)).collect::<Vec<_>>().join(", "))
}

/// A convex set.
#[derive(Clone, Debug)]
pub enum Piece {
    Box(Vec<Num>, Vec<Num>),
    /// `norm` is 0 (∞), 1 or 2; spread and blur are what is uncertain.
    Ball {
        center: Vec<Num>,
        spread: Option<Vec<Num>>,
        radius: Num,
        blur: Option<Num>,
        norm: u8,
    },
    Polygon(Vec<Vec<Num>>),
    Hull(Vec<Vec<Num>>),
    /// Rows a·p ≤ b.
    Where(Vec<(Vec<Num>, Num)>),
}

impl Piece {
    fn text(&self) -> String {
        let list = |points: &[Vec<Num>]| points.iter().map(|p| tuple(p)).collect::<Vec<_>>().join(", ");
        match self {
            Piece::Box(lo, hi) => format!("box {} .. {}", tuple(lo), tuple(hi)),
            Piece::Polygon(points) => format!("polygon {}", list(points)),
            Piece::Hull(points) => format!("hull {}", list(points)),
            Piece::Ball { center, spread, radius, blur, norm } => {
                let blurred = |x: Num, by: Option<Num>| match by {
                    Some(by) => format!("{} +/- {}", text(x), text(by)),
                    None => text(x),
                };
                let spread = |i: usize| spread.as_ref().map(|s| s[i]).filter(|s| *s > 0);
                let center: Vec<String> =
                    center.iter().enumerate().map(|(i, &x)| blurred(x, spread(i))).collect();
                let norm = if *norm == 0 { String::new() } else { format!(" norm {norm}") };
                format!("ball ({}) radius {}{norm}", center.join(", "), blurred(*radius, *blur))
            }
            Piece::Where(rows) => {
                let rows: Vec<String> = rows.iter().map(|(a, b)| row(a, *b)).collect();
                format!("where {{ {} }}", rows.join("; "))
            }
        }
    }
}

fn row(a: &[Num], b: Num) -> String {
    let terms = a.iter().zip(["x", "y", "z"]).filter(|(a, _)| **a != 0);
    let terms: Vec<String> = terms.map(|(a, x)| format!("{} * {x}", text(*a))).collect();
    format!("{} <= {}", terms.join(" + "), text(b))
}

/// A union.
pub type Shape = Vec<Piece>;

/// What stands in the way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Obstacle,
    Opaque,
    Jammer,
}

/// A set with a name.
#[derive(Clone, Debug)]
pub struct Named<T> {
    pub name: String,
    pub what: T,
}

/// How a model is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    Integrator,
    Explicit,
    Continuous,
}

/// An interval.
pub type Range = (Num, Num);

/// A model. States are ordered axis by axis, `order` of them each; there is one input an axis.
#[derive(Clone, Debug)]
pub struct Model {
    pub name: String,
    pub form: Form,
    pub order: usize,
    /// Unused by integrators.
    pub a: Vec<Vec<Num>>,
    pub b: Vec<Vec<Num>>,
    pub c: Vec<Num>,
    pub state_bounds: Vec<Option<Range>>,
    pub input_bounds: Vec<Range>,
    /// Rows on the velocities (or the inputs, for chains of one): Σ aᵢ vᵢ ≤ b.
    pub joint: Vec<(Vec<Num>, Num)>,
    pub disturbance: Vec<Option<Range>>,
    pub rejection: Option<Num>,
}

const LETTERS: [&str; 5] = ["p", "v", "a", "j", "s"];
const UNITS: [&str; 5] = ["m", "m/s", "m/s^2", "m/s^3", "m/s^4"];

impl Model {
    fn name(&self, axis: usize, depth: usize) -> String {
        let letter = if self.form == Form::Integrator { LETTERS[depth] } else { ["q", "r", "u", "w"][depth] };
        format!("{letter}{}", ["x", "y", "z"][axis])
    }

    /// The name of a state, or of an input past the last of an axis.
    pub fn state(&self, i: usize) -> String {
        self.name(i / self.order, i % self.order)
    }

    fn text(&self, dimension: usize) -> String {
        let mut out = format!("dynamics {} {{\n  step 0.5 s\n", self.name);
        let states = dimension * self.order;
        match self.form {
            Form::Integrator => writeln!(out, "  integrator {}", self.order).unwrap(),
            form => self.matrices(&mut out, form, dimension),
        }
        for i in 0..states {
            let unit = UNITS[i % self.order];
            if let Some(range) = self.state_bounds[i] {
                writeln!(out, "  bound {} in {} {unit}", self.state(i), interval(range)).unwrap();
            }
            if let Some(range) = self.disturbance[i] {
                writeln!(out, "  disturbance {} in {} {unit}", self.state(i), interval(range)).unwrap();
            }
        }
        for axis in 0..dimension {
            let (name, range) = (self.name(axis, self.order), interval(self.input_bounds[axis]));
            writeln!(out, "  bound {name} in {range} {}", UNITS[self.order]).unwrap();
        }
        if !self.joint.is_empty() {
            let row = |(a, b): &(Vec<Num>, Num)| {
                let terms = a.iter().enumerate().filter(|(_, a)| **a != 0);
                let terms = terms.map(|(axis, a)| format!("{} * {}", text(*a), self.name(axis, 1)));
                format!("{} <= {} m/s", terms.collect::<Vec<_>>().join(" + "), text(*b))
            };
            let rows: Vec<String> = self.joint.iter().map(row).collect();
            writeln!(out, "  bound where {{ {} }}", rows.join("; ")).unwrap();
        }
        if let Some(beta) = self.rejection {
            writeln!(out, "  rejection {}", text(beta)).unwrap();
        }
        out + "}\n"
    }

    fn matrices(&self, out: &mut String, form: Form, dimension: usize) {
        let states = dimension * self.order;
        if form == Form::Continuous {
            out.push_str("  continuous\n");
        }
        let names = |list: Vec<String>| list.join(", ");
        let state = |i: usize| format!("{}: {}", self.state(i), UNITS[i % self.order]);
        let input = |axis: usize| format!("{}: {}", self.name(axis, self.order), UNITS[self.order]);
        writeln!(out, "  state {}", names((0..states).map(state).collect())).unwrap();
        writeln!(out, "  input {}", names((0..dimension).map(input).collect())).unwrap();
        let position = (0..dimension).map(|axis| self.name(axis, 0)).collect();
        writeln!(out, "  position {}", names(position)).unwrap();
        let matrix = |rows: &[Vec<Num>]| {
            let row = |row: &Vec<Num>| row.iter().map(|x| text(*x)).collect::<Vec<_>>().join(", ");
            rows.iter().map(row).collect::<Vec<_>>().join(";\n       ")
        };
        writeln!(out, "  A = [{}]\n  B = [{}]", matrix(&self.a), matrix(&self.b)).unwrap();
        if self.c.iter().any(|c| *c != 0) {
            let column: Vec<Vec<Num>> = self.c.iter().map(|c| vec![*c]).collect();
            writeln!(out, "  c = [{}]", matrix(&column)).unwrap();
        }
    }
}

fn interval((lo, hi): Range) -> String {
    format!("[{}, {}]", text(lo), text(hi))
}

/// A robot: its model, and its whole initial state.
#[derive(Clone, Debug)]
pub struct Robot {
    pub model: usize,
    pub start: Vec<Num>,
}

/// What links have to be like.
#[derive(Clone, Debug, Default)]
pub struct Links {
    pub hops: Option<usize>,
    /// With its norm: 0 (∞) or 2.
    pub range: Option<(Num, u8)>,
    pub redundancy: usize,
    pub every: usize,
}

/// A mission.
#[derive(Clone, Debug)]
pub struct Draft {
    pub dimension: usize,
    pub workspace: Piece,
    pub regions: Vec<Named<Shape>>,
    pub blockers: Vec<Named<(Kind, Shape)>>,
    pub bases: Vec<Named<Vec<Num>>>,
    pub models: Vec<Model>,
    pub robots: Vec<Named<Robot>>,
    pub separation: Option<Num>,
    /// `None` with `connectivity none`.
    pub links: Option<Links>,
    pub horizon: (usize, usize),
    pub goals: Vec<Formula>,
    /// In which order things are declared, when not in that of the fields.
    pub shuffle: Option<u64>,
}

impl Draft {
    /// The mission's text.
    pub fn text(&self) -> String {
        let mut parts = self.declarations();
        if let Some(seed) = self.shuffle {
            Chance::new(seed).shuffle(&mut parts);
        }
        format!("dosm 1\nmission random\n{}", parts.concat())
    }

    fn declarations(&self) -> Vec<String> {
        let shape = |shape: &Shape| shape.iter().map(Piece::text).collect::<Vec<_>>().join(" or ");
        let mut parts = vec![format!("workspace {}\n", self.workspace.text())];
        parts.extend(self.regions.iter().map(|r| format!("region {} = {}\n", r.name, shape(&r.what))));
        let blocker = |b: &Named<(Kind, Shape)>| {
            let word = match b.what.0 {
                Kind::Obstacle => "obstacle",
                Kind::Opaque => "opaque obstacle",
                Kind::Jammer => "jammer",
            };
            format!("{word} {} = {}\n", b.name, shape(&b.what.1))
        };
        parts.extend(self.blockers.iter().map(blocker));
        parts.extend(self.bases.iter().map(|b| format!("base {} at {}\n", b.name, tuple(&b.what))));
        parts.extend(self.models.iter().map(|m| m.text(self.dimension)));
        let robot = |r: &Named<Robot>| {
            let model = &self.models[r.what.model];
            let states = r.what.start.iter().enumerate();
            let states: Vec<String> =
                states.map(|(i, x)| format!("{} = {}", model.state(i), text(*x))).collect();
            format!("robot {}: {} at {{ {} }}\n", r.name, model.name, states.join(", "))
        };
        parts.extend(self.robots.iter().map(robot));
        parts.extend(self.separation.map(|s| format!("separation {}\n", text(s))));
        parts.extend(self.connectivity());
        parts.push(format!("horizon {}..{}\n", self.horizon.0, self.horizon.1));
        let goals = self.goals.iter().enumerate();
        parts.extend(goals.map(|(i, goal)| format!("goal g{i}: {}\n", goal.text(self))));
        parts
    }

    fn connectivity(&self) -> Option<String> {
        let Some(links) = &self.links else { return Some("connectivity none\n".into()) };
        let mut items = vec![];
        items.extend(links.hops.map(|h| format!("hops <= {h}")));
        items.extend(links.range.map(|(length, norm)| {
            let norm = if norm == 2 { " norm 2" } else { "" };
            format!("range {}{norm}", text(length))
        }));
        items.extend((links.redundancy > 0).then(|| format!("redundancy {}", links.redundancy)));
        items.extend((links.every > 1).then(|| format!("every {}", links.every)));
        (!items.is_empty()).then(|| format!("connectivity {{ {} }}\n", items.join("  ")))
    }
}
