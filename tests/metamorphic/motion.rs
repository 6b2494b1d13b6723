//! Similarities of the workspace, and what else can be done to a draft without changing its meaning.

use crate::chance::Chance;
use crate::draft::{Draft, Form, Kind, Model, Named, Num, ONE, Piece, Range};

/// p ↦ scale · S p + shift, where S permutes the axes and turns some of them round.
pub struct Motion {
    /// Where each axis goes.
    pub axis: Vec<usize>,
    /// Its sign there.
    pub sign: Vec<i64>,
    pub shift: Vec<Num>,
    /// A fraction.
    pub scale: (i64, i64),
}

impl Motion {
    pub fn none(dimension: usize) -> Motion {
        Motion {
            axis: (0..dimension).collect(),
            sign: vec![1; dimension],
            shift: vec![0; dimension],
            scale: (1, 1),
        }
    }

    /// The image of a draft.
    pub fn apply(&self, draft: &Draft) -> Draft {
        let shape = |shape: &Vec<Piece>| shape.iter().map(|p| self.piece(p)).collect::<Vec<_>>();
        let mut image = draft.clone();
        image.workspace = self.piece(&draft.workspace);
        image.regions.iter_mut().for_each(|r| r.what = shape(&r.what));
        image.blockers.iter_mut().for_each(|b| b.what.1 = shape(&b.what.1));
        image.bases.iter_mut().for_each(|b| b.what = self.point(&b.what));
        image.models.iter_mut().for_each(|m| *m = self.model(m));
        for robot in &mut image.robots {
            robot.what.start = self.state(&robot.what.start);
        }
        image.separation = draft.separation.map(|s| self.length(s));
        if let Some(links) = &mut image.links {
            links.range = links.range.map(|(r, norm)| (self.length(r), norm));
        }
        image
    }

    fn length(&self, x: Num) -> Num {
        assert!(x * self.scale.0 % self.scale.1 == 0, "not a whole number of millionths");
        x * self.scale.0 / self.scale.1
    }

    fn turned(&self, v: &[Num]) -> Vec<Num> {
        let mut image = vec![0; v.len()];
        for (i, x) in v.iter().enumerate() {
            image[self.axis[i]] = self.sign[i] * x;
        }
        image
    }

    fn vector(&self, v: &[Num]) -> Vec<Num> {
        self.turned(v).into_iter().map(|x| self.length(x)).collect()
    }

    fn point(&self, p: &[Num]) -> Vec<Num> {
        self.vector(p).iter().zip(&self.shift).map(|(x, s)| x + s).collect()
    }

    fn points(&self, points: &[Vec<Num>]) -> Vec<Vec<Num>> {
        points.iter().map(|p| self.point(p)).collect()
    }

    fn piece(&self, piece: &Piece) -> Piece {
        match piece {
            Piece::Box(p, q) => {
                let (p, q) = (self.point(p), self.point(q));
                let pairs = || p.iter().zip(&q);
                Piece::Box(
                    pairs().map(|(a, b)| *a.min(b)).collect(),
                    pairs().map(|(a, b)| *a.max(b)).collect(),
                )
            }
            Piece::Ball { center, spread, radius, blur, norm } => Piece::Ball {
                center: self.point(center),
                spread: spread.as_ref().map(|s| self.vector(s).into_iter().map(i64::abs).collect()),
                radius: self.length(*radius),
                blur: blur.map(|b| self.length(b)),
                norm: *norm,
            },
            Piece::Polygon(points) => Piece::Polygon(self.points(points)),
            Piece::Hull(points) => Piece::Hull(self.points(points)),
            Piece::Where(rows) => Piece::Where(rows.iter().map(|(a, b)| self.half_space(a, *b)).collect()),
        }
    }

    fn half_space(&self, a: &[Num], b: Num) -> (Vec<Num>, Num) {
        let a = self.turned(a);
        let moved: i128 = a.iter().zip(&self.shift).map(|(a, s)| i128::from(*a) * i128::from(*s)).sum();
        assert!(moved % i128::from(ONE) == 0, "not a whole number of millionths");
        (a, self.length(b) + (moved / i128::from(ONE)) as i64)
    }

    /// The index of the state (or input) that one becomes, and its sign; `order` of them an axis.
    fn index(&self, i: usize, order: usize) -> (usize, i64) {
        (self.axis[i / order] * order + i % order, self.sign[i / order])
    }

    fn ranges(&self, old: &[Option<Range>], order: usize) -> Vec<Option<Range>> {
        let mut new = vec![None; old.len()];
        for (i, range) in old.iter().enumerate() {
            let (to, sign) = self.index(i, order);
            new[to] = range.map(|(lo, hi)| {
                let (lo, hi) = (self.length(lo), self.length(hi));
                if sign < 0 { (-hi, -lo) } else { (lo, hi) }
            });
        }
        new
    }

    fn model(&self, model: &Model) -> Model {
        let mut image = model.clone();
        let some: Vec<_> = model.input_bounds.iter().map(|r| Some(*r)).collect();
        image.input_bounds = self.ranges(&some, 1).into_iter().flatten().collect();
        image.state_bounds = self.ranges(&model.state_bounds, model.order);
        image.disturbance = self.ranges(&model.disturbance, model.order);
        for (a, b) in &mut image.joint {
            (*a, *b) = (self.turned(a), self.length(*b));
        }
        if model.form == Form::Integrator {
            return image;
        }
        for (i, row) in model.a.iter().enumerate() {
            let (to, sign) = self.index(i, model.order);
            for (j, x) in row.iter().enumerate() {
                let (from, other) = self.index(j, model.order);
                image.a[to][from] = sign * other * x;
            }
            for (j, x) in model.b[i].iter().enumerate() {
                let (from, other) = self.index(j, 1);
                image.b[to][from] = sign * other * x;
            }
            image.c[to] = sign * self.length(model.c[i]);
        }
        image
    }

    fn state(&self, start: &[Num]) -> Vec<Num> {
        let dimension = self.axis.len();
        let order = start.len() / dimension;
        let mut image = vec![0; start.len()];
        for (i, x) in start.iter().enumerate() {
            let (to, sign) = self.index(i, order);
            let shift = if i % order == 0 { self.shift[self.axis[i / order]] } else { 0 };
            image[to] = sign * self.length(*x) + shift;
        }
        image
    }
}

/// Other names for everything, in another alphabetical order.
pub fn renamed(draft: &Draft, chance: &mut Chance) -> Draft {
    let mut letters: Vec<char> = ('a'..='z').collect();
    chance.shuffle(&mut letters);
    let mut fresh =
        letters.into_iter().cycle().enumerate().map(|(i, c)| format!("{c}_{}{}", 97 - i % 89, i / 26));
    let mut image = draft.clone();
    image.regions.iter_mut().for_each(|r| r.name = fresh.next().unwrap());
    image.blockers.iter_mut().for_each(|b| b.name = fresh.next().unwrap());
    image.bases.iter_mut().for_each(|b| b.name = fresh.next().unwrap());
    image.models.iter_mut().for_each(|m| m.name = fresh.next().unwrap());
    image.robots.iter_mut().for_each(|r| r.name = fresh.next().unwrap());
    image
}

/// One more jammer, farther away than any robot comes: first the draft in a workspace that has room
/// for it, then with it.
pub fn with_far_jammer(draft: &Draft, chance: &mut Chance) -> (Draft, Draft) {
    let mut roomy = draft.clone();
    let far = 200 * ONE;
    let mut corner = vec![-far; draft.dimension];
    let lo: Vec<Num> = vec![-ONE; draft.dimension];
    let hi = vec![20 * ONE; draft.dimension];
    let axis = chance.below(draft.dimension);
    roomy.workspace = {
        let mut hi = hi;
        hi[axis] = far;
        Piece::Box(lo, hi)
    };
    let mut jammed = roomy.clone();
    corner[axis] = far - 20 * ONE;
    corner.iter_mut().enumerate().filter(|(i, _)| *i != axis).for_each(|(_, c)| *c = 4 * ONE);
    let radius = chance.between(1, 5) * ONE;
    let norm = *chance.pick(&[0, 1, 2]);
    let ball = Piece::Ball { center: corner, spread: None, radius, blur: None, norm };
    jammed.blockers.push(Named { name: "far_away".into(), what: (Kind::Jammer, vec![ball]) });
    (roomy, jammed)
}

/// Every piece of a jammer or obstacle made smaller, inside what it was.
pub fn with_smaller_blockers(draft: &Draft, chance: &mut Chance) -> Draft {
    let mut image = draft.clone();
    for blocker in &mut image.blockers {
        if chance.percent(70) {
            blocker.what.1.iter_mut().for_each(|piece| *piece = smaller(piece, chance));
        }
    }
    image
}

fn smaller(piece: &Piece, chance: &mut Chance) -> Piece {
    let percent = *chance.pick(&[50, 75, 90]);
    let about = |points: &[Vec<Num>]| -> Vec<Vec<Num>> {
        // Towards the first point: every point stays in the hull.
        let toward = |p: &Vec<Num>| {
            p.iter().zip(&points[0]).map(|(x, first)| first + (x - first) / 100 * percent).collect()
        };
        points.iter().map(toward).collect()
    };
    match piece {
        Piece::Box(lo, hi) => {
            let inset = |i: usize| (hi[i] - lo[i]) / 400 * (100 - percent);
            Piece::Box(
                (0..lo.len()).map(|i| lo[i] + inset(i)).collect(),
                (0..lo.len()).map(|i| hi[i] - inset(i)).collect(),
            )
        }
        Piece::Ball { center, spread, radius, blur, norm } => Piece::Ball {
            center: center.clone(),
            spread: spread.as_ref().map(|s| s.iter().map(|s| s / 2).collect()),
            radius: radius / 100 * percent,
            blur: blur.map(|b| b / 2),
            norm: *norm,
        },
        Piece::Polygon(points) => Piece::Polygon(about(points)),
        Piece::Hull(points) => Piece::Hull(about(points)),
        Piece::Where(rows) => {
            let mut rows = rows.clone();
            if let Some(last) = rows.last_mut() {
                last.1 -= ONE / 10;
            }
            Piece::Where(rows)
        }
    }
}

/// Every disturbance replaced by a part of it.
pub fn with_less_disturbance(draft: &Draft, chance: &mut Chance) -> Draft {
    let mut image = draft.clone();
    let percent = *chance.pick(&[0, 25, 50, 75, 90]);
    for model in &mut image.models {
        for (lo, hi) in model.disturbance.iter_mut().flatten() {
            let (middle, half) = ((*lo + *hi) / 2, (*hi - *lo) / 2);
            (*lo, *hi) = (middle - half * percent / 100, middle + half * percent / 100);
        }
    }
    image
}
