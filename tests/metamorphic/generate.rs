//! Random missions over the whole language, most of them with a plan.

use crate::chance::Chance;
use crate::draft::{Draft, Form, Kind, Links, Model, Named, Num, ONE, Piece, Robot, Shape};
use crate::formula::{Formula, TIMED, Window};

/// Half the millimetres of a metre: the grid of the drafts is 8 mm, so that an eighth is exact.
const GRID: Num = ONE / 125;

/// The width of the workspace, in metres.
const SIZE: i64 = 12;

/// A mission from a seed.
pub fn draft(seed: u64) -> Draft {
    let mut chance = Chance::new(seed);
    let dimension = if chance.percent(25) { 3 } else { 2 };
    Generator { chance, dimension }.draft()
}

struct Generator {
    chance: Chance,
    dimension: usize,
}

impl Generator {
    fn draft(mut self) -> Draft {
        let count = if self.dimension == 3 { 2 } else { 3 };
        let robots = 1 + self.chance.below(count) + usize::from(self.chance.percent(12));
        let models: Vec<Model> =
            (0..1 + self.chance.below(2).min(robots - 1)).map(|i| self.model(i)).collect();
        let spots: Vec<Vec<Num>> = (0..robots).map(|i| self.spot(i)).collect();
        let bases = if self.chance.percent(30) { 2 } else { 1 };
        let bases = (0..bases).map(|i| self.base(i)).collect::<Vec<_>>();
        let mut taken = spots.clone();
        taken.extend(bases.iter().map(|b: &Named<Vec<Num>>| b.what.clone()));
        let blockers = self.chance.below(4);
        let blockers = (0..blockers).map(|i| self.blocker(i, &taken)).collect();
        let regions = 1 + self.chance.below(3);
        let regions: Vec<_> = (0..regions).map(|i| self.region(i)).collect();
        let robots: Vec<Named<Robot>> =
            spots.into_iter().enumerate().map(|(i, p)| self.robot(i, p, &models)).collect();
        let goals = 1 + self.chance.below(3);
        let goals = (0..goals).map(|_| self.goal(robots.len(), regions.len())).collect();
        Draft {
            dimension: self.dimension,
            workspace: self.workspace(),
            regions,
            blockers,
            bases,
            separation: self.chance.percent(35).then(|| self.metres(200, 700)),
            links: self.links(robots.len()),
            models,
            robots,
            horizon: (1, if self.dimension == 3 { 9 } else { 11 }),
            goals,
            shuffle: None,
        }
    }

    /// A length between so many thousandths.
    fn metres(&mut self, lo: i64, hi: i64) -> Num {
        self.chance.between(lo * ONE / 1000 / GRID, hi * ONE / 1000 / GRID) * GRID
    }

    fn point(&mut self, lo: i64, hi: i64) -> Vec<Num> {
        (0..self.dimension).map(|_| self.metres(lo * 1000, hi * 1000)).collect()
    }

    fn workspace(&mut self) -> Piece {
        let hi = SIZE * ONE;
        if self.dimension == 2 && self.chance.percent(25) {
            let cut = self.metres(500, 1500);
            let corners = [[0, 0], [hi - cut, 0], [hi, cut], [hi, hi], [cut, hi], [0, hi - cut]];
            return Piece::Polygon(corners.map(|p| p.to_vec()).to_vec());
        }
        Piece::Box(vec![0; self.dimension], vec![hi; self.dimension])
    }

    /// Starts on the left, apart from each other.
    fn spot(&mut self, i: usize) -> Vec<Num> {
        let mut p = self.point(1, 3);
        p[1] = (2 + 2 * i as i64) * ONE + self.metres(0, 600);
        p
    }

    fn base(&mut self, i: usize) -> Named<Vec<Num>> {
        let mut p = self.point(1, 11);
        p[0] = self.metres(300, 800);
        if i == 1 {
            p[0] = SIZE * ONE - p[0];
        }
        Named { name: format!("B{i}"), what: p }
    }

    fn links(&mut self, robots: usize) -> Option<Links> {
        if self.chance.percent(25) {
            return None;
        }
        let hops = self.chance.percent(30).then(|| 1 + self.chance.below(robots));
        let range = self.chance.percent(25).then(|| {
            let norm = *self.chance.pick(&[0, 2]);
            (self.metres(6000, 11000), norm)
        });
        let redundancy = usize::from(robots > 1 && self.chance.percent(15));
        let every = if self.chance.percent(20) { 2 + self.chance.below(2) } else { 1 };
        Some(Links { hops, range, redundancy, every })
    }

    fn blocker(&mut self, i: usize, taken: &[Vec<Num>]) -> Named<(Kind, Shape)> {
        let kind = *self.chance.pick(&[Kind::Jammer, Kind::Jammer, Kind::Opaque, Kind::Obstacle]);
        let mut shape = vec![self.small_piece(taken)];
        if self.chance.percent(20) {
            shape.push(self.small_piece(taken));
        }
        Named { name: format!("J{i}"), what: (kind, shape) }
    }

    /// At most about 1.3 m from its middle, which is farther from everything that must be free.
    fn small_piece(&mut self, taken: &[Vec<Num>]) -> Piece {
        let mut center = self.point(3, 11);
        for _ in 0..60 {
            let near = |p: &Vec<Num>| p.iter().zip(&center).all(|(a, b)| (a - b).abs() < 2 * ONE);
            if !taken.iter().any(near) {
                break;
            }
            center = self.point(3, 11);
        }
        let radius = self.metres(300, 1100);
        match self.chance.below(6) {
            0 => self.boxed(&center, 300, 1200),
            1 => self.slanted(&center, radius),
            2 if self.dimension == 2 => self.half_planes(&center, radius),
            _ => {
                let spread = self
                    .chance
                    .percent(25)
                    .then(|| (0..self.dimension).map(|_| self.metres(0, 200)).collect());
                let blur = self.chance.percent(20).then(|| self.metres(40, 160));
                Piece::Ball { center, spread, radius, blur, norm: *self.chance.pick(&[0, 1, 2]) }
            }
        }
    }

    fn boxed(&mut self, center: &[Num], lo: i64, hi: i64) -> Piece {
        let half: Vec<Num> = center.iter().map(|_| self.metres(lo, hi)).collect();
        Piece::Box(
            center.iter().zip(&half).map(|(c, h)| c - h).collect(),
            center.iter().zip(&half).map(|(c, h)| c + h).collect(),
        )
    }

    /// A polygon of three to five corners (or a hull of them, with one more inside), a simplex in space.
    fn slanted(&mut self, center: &[Num], radius: Num) -> Piece {
        let around = |offsets: &[Vec<i64>]| -> Vec<Vec<Num>> {
            let corner = |o: &Vec<i64>| center.iter().zip(o).map(|(c, o)| c + radius / 800 * 8 * o).collect();
            offsets.iter().map(corner).collect()
        };
        if self.dimension == 3 {
            let corners = [[100, 0, 0], [-60, 80, 10], [-50, -70, 20], [0, 10, 100], [10, 0, -90]];
            let corners: Vec<Vec<i64>> = corners.iter().map(|c| c.to_vec()).collect();
            return Piece::Hull(around(&corners[..if self.chance.percent(50) { 4 } else { 5 }]));
        }
        let corners = [[100, 10], [30, 90], [-60, 80], [-100, -20], [20, -90]];
        let mut corners: Vec<Vec<i64>> = corners.iter().map(|c| c.to_vec()).collect();
        for _ in 0..self.chance.below(3) {
            corners.remove(self.chance.below(corners.len()));
        }
        match self.chance.percent(50) {
            true => Piece::Polygon(around(&corners)),
            false => {
                // The middle of two opposite corners is no corner.
                let inner = corners[0].iter().zip(&corners[2]).map(|(a, b)| (a + b) / 2).collect();
                corners.push(inner);
                Piece::Hull(around(&corners))
            }
        }
    }

    fn half_planes(&mut self, center: &[Num], radius: Num) -> Piece {
        let rows = [[1, 2], [-2, 1], [1, -1], [-1, 0]];
        let row = |a: &[i64; 2]| {
            let middle: i64 = a.iter().zip(center).map(|(a, c)| a * c).sum();
            (a.iter().map(|a| a * ONE).collect(), middle + radius)
        };
        Piece::Where(rows.iter().map(row).collect())
    }

    fn region(&mut self, i: usize) -> Named<Shape> {
        let mut shape = vec![self.large_piece()];
        if self.chance.percent(20) {
            shape.push(self.large_piece());
        }
        Named { name: format!("A{i}"), what: shape }
    }

    /// Wide enough for any of the tubes.
    fn large_piece(&mut self) -> Piece {
        let center = self.point(2, 10);
        let radius = self.metres(2000, 2800);
        match self.chance.below(6) {
            0 => self.slanted(&center, radius),
            1 => Piece::Ball { center, spread: None, radius, blur: None, norm: 2 },
            2 => Piece::Ball { center, spread: None, radius, blur: None, norm: 0 },
            3 if self.dimension == 2 => self.half_planes(&center, radius),
            _ => self.boxed(&center, 1300, 2200),
        }
    }

    fn model(&mut self, i: usize) -> Model {
        let form = *self.chance.pick(&[Form::Integrator, Form::Integrator, Form::Explicit, Form::Continuous]);
        let order = match form {
            Form::Integrator => *self.chance.pick(&[1, 2, 2, 3]),
            _ => 2,
        };
        let states = self.dimension * order;
        let (a, b) = match form {
            Form::Integrator => (vec![], vec![]),
            form => self.matrices(form, order),
        };
        let mut model = Model {
            name: format!("Model{i}"),
            form,
            order,
            a,
            b,
            c: vec![0; states],
            state_bounds: vec![None; states],
            input_bounds: vec![],
            joint: vec![],
            disturbance: vec![None; states],
            rejection: self.chance.percent(30).then(|| *self.chance.pick(&[ONE / 2, ONE * 7 / 10])),
        };
        self.limits(&mut model);
        model
    }

    /// Two states an axis, with some drag, sometimes with the axes coupled.
    fn matrices(&mut self, form: Form, order: usize) -> (Vec<Vec<Num>>, Vec<Vec<Num>>) {
        let states = self.dimension * order;
        let (mut a, mut b) = (vec![vec![0; states]; states], vec![vec![0; self.dimension]; states]);
        let drag = self.metres(0, 300);
        for (axis, p) in (0..states).step_by(order).enumerate() {
            let v = p + 1;
            if form == Form::Continuous {
                a[p][v] = ONE;
                a[v][v] = -drag;
                b[v][axis] = ONE;
            } else {
                (a[p][p], a[p][v]) = (ONE, ONE / 2);
                a[v][v] = ONE - drag / 2;
                (b[p][axis], b[v][axis]) = (ONE / 8, ONE / 2);
            }
        }
        if self.chance.percent(40) {
            let turn = self.metres(30, 150);
            (a[1][order + 1], a[order + 1][1]) = (turn, -turn);
        }
        (a, b)
    }

    fn limits(&mut self, model: &mut Model) {
        let last = model.order;
        let reach = |depth: usize| [0, 3500, 5000, 12000, 0][depth];
        for axis in 0..self.dimension {
            for depth in 1..last {
                let (lo, hi) = (
                    self.metres(reach(depth) * 8 / 10, reach(depth)),
                    self.metres(reach(depth) * 8 / 10, reach(depth)),
                );
                if depth == 1 || self.chance.percent(50) {
                    model.state_bounds[axis * last + depth] = Some((-lo, hi));
                }
            }
            let most = if last == 1 { 4000 } else { reach(last) };
            let (lo, hi) = (self.metres(most * 8 / 10, most), self.metres(most * 8 / 10, most));
            model.input_bounds.push((-lo, hi));
            let kind = self.chance.below(6);
            model.disturbance[axis * last] = self.disturbance(kind);
            if last > 1 && self.chance.percent(15) {
                model.disturbance[axis * last + 1] = Some((-40 * GRID / 10, 40 * GRID / 10));
            }
        }
        if self.chance.percent(25) {
            let mut row = vec![0; self.dimension];
            (row[0], row[1]) = (ONE, *self.chance.pick(&[ONE, -ONE, ONE / 2]));
            model.joint.push((row, self.metres(4000, 6000)));
        }
        if model.form != Form::Integrator && self.chance.percent(30) {
            model.c[0] = self.metres(8, 96);
        }
    }

    /// Even, uneven, on one side, away from zero, fixed, or none.
    fn disturbance(&mut self, kind: usize) -> Option<(Num, Num)> {
        let wide = self.metres(16, 120);
        let narrow = self.metres(0, 16);
        match kind {
            0 | 1 => Some((-wide, wide)),
            2 => Some((-narrow, wide)),
            3 => Some((0, wide)),
            4 => Some((-wide - narrow - GRID, -narrow)),
            _ => None,
        }
    }

    fn robot(&mut self, i: usize, p: Vec<Num>, models: &[Model]) -> Named<Robot> {
        let model = i % models.len();
        let order = models[model].order;
        let mut start = vec![0; self.dimension * order];
        for (axis, x) in p.iter().enumerate() {
            start[axis * order] = *x;
            if order > 1 && self.chance.percent(20) {
                start[axis * order + 1] = self.metres(-400, 400);
            }
        }
        Named { name: format!("R{i}"), what: Robot { model, start } }
    }

    fn goal(&mut self, robots: usize, regions: usize) -> Formula {
        let eventually = |p: Formula| Formula::Eventually(None, Box::new(p));
        let always = |p: Formula| Formula::Always(None, Box::new(p));
        let (a, b) = (self.atom(robots, regions), self.atom(robots, regions));
        match self.chance.below(10) {
            0 => eventually(a),
            1 => always(eventually(a)),
            2 => {
                let n = 3 + self.chance.below(4);
                let m = self.chance.below(3);
                always(a.infix("->", Formula::Eventually(Some((m, n)), Box::new(b))))
            }
            3 => Formula::Infix(TIMED[self.chance.below(4)], self.window(), Box::new(a.not()), Box::new(b)),
            4 => Formula::Eventually(Some((0, 10)), Box::new(a)),
            5 => eventually(always(a)),
            6 => eventually(self.count(robots, regions)),
            7 => always(self.count(robots, regions)),
            8 => always(eventually(a)).infix("and", always(eventually(b.not()))),
            _ => eventually(a.infix("and", Formula::Next(Box::new(eventually(b))))),
        }
    }

    fn atom(&mut self, robots: usize, regions: usize) -> Formula {
        Formula::In(self.chance.below(robots), self.chance.below(regions))
    }

    fn window(&mut self) -> Window {
        let m = self.chance.below(2);
        self.chance.percent(40).then(|| (m, m + 5 + self.chance.below(6)))
    }

    fn count(&mut self, robots: usize, regions: usize) -> Formula {
        let all: Vec<usize> = (0..robots).collect();
        let mut terms = vec![(1, all.clone(), self.chance.below(regions))];
        if self.chance.percent(40) {
            let weight = *self.chance.pick(&[2, -1, -2]);
            terms.push((weight, all[self.chance.below(robots)..].to_vec(), self.chance.below(regions)));
        }
        let op = *self.chance.pick(&[">=", "<=", "=", "!=", "<", ">"]);
        Formula::Compare(terms, op, self.chance.between(0, robots as i64 - 1))
    }
}
