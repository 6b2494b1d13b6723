//! Goals as they are written, against their meaning: random formulas with every operator, window and
//! weighted count over random certain and uncertain labels, from text to the exact check.
//!
//! The meaning is that of the language guide, polarity by polarity: an atom needs to be certainly
//! true, a negated one certainly false, a comparison to hold whatever the unknown atoms are.

use std::fmt::Write;

use dosmc::diag::Diagnostics;
use dosmc::driver::{self, Overrides};
use dosmc::ir::Problem;
use dosmc::plan::Label;
use dosmc::source::SourceFile;
use dosmc::verify::{Kind, verify};

use crate::cases::hovering;
use crate::sampling::Dice;
use crate::scene::{Scene, boxed};

type Window = Option<(usize, usize)>;

enum Word {
    In(usize, usize),
    /// Weighted (robot, region) pairs.
    Sum(Vec<(i64, usize, usize)>, &'static str, i64),
    Not(Box<Word>),
    Next(Box<Word>),
    Unary(&'static str, Window, Box<Word>),
    Infix(&'static str, Window, Box<Word>, Box<Word>),
}

const ROBOTS: [&str; 2] = ["R1", "R2"];
const REGIONS: [&str; 2] = ["a", "b"];
const TIMED: [&str; 4] = ["until", "release", "weak until", "strong release"];
const PLAIN: [&str; 4] = ["and", "or", "->", "<->"];
const COMPARE: [&str; 6] = ["=", "!=", "<", "<=", ">", ">="];

fn random(dice: &mut Dice, depth: usize) -> Word {
    let kind = if depth == 0 { dice.below(3) } else { dice.below(10) };
    let window = |dice: &mut Dice| {
        let m = dice.below(5);
        (dice.below(2) == 0).then(|| (m, m + dice.below(7)))
    };
    let inner = |dice: &mut Dice| Box::new(random(dice, depth.saturating_sub(1)));
    match kind {
        0 | 1 => Word::In(dice.below(2), dice.below(2)),
        2 => {
            let terms = 1 + dice.below(3);
            let weight = |dice: &mut Dice| [1, 1, 2, -1, -3][dice.below(5)];
            let terms = (0..terms).map(|_| (weight(dice), dice.below(2), dice.below(2))).collect();
            Word::Sum(terms, COMPARE[dice.below(6)], dice.below(5) as i64 - 2)
        }
        3 => Word::Not(inner(dice)),
        4 => Word::Next(inner(dice)),
        5 | 6 => Word::Unary(["always", "eventually"][dice.below(2)], window(dice), inner(dice)),
        7 => Word::Infix(PLAIN[dice.below(4)], None, inner(dice), inner(dice)),
        _ => Word::Infix(TIMED[dice.below(4)], window(dice), inner(dice), inner(dice)),
    }
}

fn text(word: &Word) -> String {
    let of = |w: &Window| w.map_or(String::new(), |(m, n)| format!("[{m}, {n}]"));
    match word {
        Word::In(robot, region) => format!("({} in {})", ROBOTS[*robot], REGIONS[*region]),
        Word::Sum(terms, op, bound) => {
            let mut sum = String::new();
            for (i, (weight, robot, region)) in terms.iter().enumerate() {
                let plus = if i == 0 { "" } else { " + " };
                write!(sum, "{plus}{weight} * ({} in {})", ROBOTS[*robot], REGIONS[*region]).unwrap();
            }
            format!("({sum} {op} {bound})")
        }
        Word::Not(p) => format!("(not {})", text(p)),
        Word::Next(p) => format!("(next {})", text(p)),
        Word::Unary(op, w, p) => format!("({op}{} {})", of(w), text(p)),
        Word::Infix(op, w, p, q) => format!("({} {op}{} {})", text(p), of(w), text(q)),
    }
}

/// A lasso of labels, by step, robot and region.
struct Run {
    labels: Vec<[[Label; 2]; 2]>,
    back: usize,
}

impl Run {
    fn at(&self, t: usize) -> &[[Label; 2]; 2] {
        let last = self.labels.len();
        &self.labels[if t < last { t } else { self.back + (t - self.back) % (last - self.back) }]
    }

    /// Whether the formula (or its negation) is certain at t.
    fn certain(&self, word: &Word, positive: bool, t: usize) -> bool {
        match word {
            Word::In(robot, region) => {
                self.at(t)[*robot][*region] == if positive { Label::In } else { Label::Out }
            }
            Word::Sum(terms, op, bound) => self.sum(terms, op, *bound, positive, t),
            Word::Not(p) => self.certain(p, !positive, t),
            Word::Next(p) => self.certain(p, positive, t + 1),
            Word::Unary(op, w, p) => {
                let p = |t: usize| self.certain(p, positive, t);
                if (*op == "eventually") == positive {
                    self.until(t, *w, &|_| true, &p)
                } else {
                    !self.until(t, *w, &|_| true, &|t| !p(t))
                }
            }
            Word::Infix(op, w, p, q) if PLAIN.contains(op) => self.plain(op, p, q, positive, t, *w),
            Word::Infix(op, w, p, q) => self.timed(op, *w, p, q, positive, t),
        }
    }

    fn plain(&self, op: &str, p: &Word, q: &Word, positive: bool, t: usize, _: Window) -> bool {
        let yes = |w: &Word| self.certain(w, positive, t);
        let no = |w: &Word| self.certain(w, !positive, t);
        match (op, positive) {
            ("and", true) | ("or", false) => yes(p) && yes(q),
            ("or", true) | ("and", false) => yes(p) || yes(q),
            ("->", true) => no(p) || yes(q),
            ("->", false) => no(p) && yes(q),
            // (p and q) or (not p and not q), and its negation.
            (_, true) => (yes(p) && yes(q)) || (no(p) && no(q)),
            (_, false) => (yes(p) || yes(q)) && (no(p) || no(q)),
        }
    }

    fn timed(&self, op: &str, w: Window, p: &Word, q: &Word, positive: bool, t: usize) -> bool {
        let a = |t: usize| self.certain(p, positive, t);
        let b = |t: usize| self.certain(q, positive, t);
        let (not_a, not_b) = (|t: usize| !a(t), |t: usize| !b(t));
        let all = |x: &dyn Fn(usize) -> bool| {
            let whole = w.map(|(_, n)| (0, n));
            !self.until(t, whole, &|_| true, &|t| !x(t))
        };
        match (op, positive) {
            ("until", true) | ("release", false) => self.until(t, w, &a, &b),
            ("release", true) | ("until", false) => !self.until(t, w, &not_a, &not_b),
            ("weak until", true) | ("strong release", false) => self.until(t, w, &a, &b) || all(&a),
            _ => !(self.until(t, w, &not_a, &not_b) || all(&not_a)),
        }
    }

    /// Some d in the window with b at t + d and a before; without a window, as far as anything new comes.
    fn until(&self, t: usize, w: Window, a: &dyn Fn(usize) -> bool, b: &dyn Fn(usize) -> bool) -> bool {
        let (m, n) = w.unwrap_or((0, 2 * self.labels.len()));
        (m..=n).any(|d| b(t + d) && (0..d).all(|e| a(t + e)))
    }

    /// Every way in which the atoms may be, those that occur twice with one value.
    fn sum(&self, terms: &[(i64, usize, usize)], op: &str, bound: i64, positive: bool, t: usize) -> bool {
        let labels = self.at(t);
        (0..16usize).all(|code| {
            let inside = |robot: usize, region: usize| code >> (2 * robot + region) & 1 == 1;
            let allowed = (0..4).all(|i| match labels[i / 2][i % 2] {
                Label::In => inside(i / 2, i % 2),
                Label::Out => !inside(i / 2, i % 2),
                Label::Unknown => true,
            });
            let sum: i64 = terms.iter().filter(|(_, r, s)| inside(*r, *s)).map(|(k, ..)| k).sum();
            let holds = match op {
                "=" => sum == bound,
                "!=" => sum != bound,
                "<" => sum < bound,
                "<=" => sum <= bound,
                ">" => sum > bound,
                _ => sum >= bound,
            };
            !allowed || holds == positive
        })
    }
}

fn mission(word: &Word) -> Option<Problem> {
    let text = format!(
        "dosm 1\nmission scene\nworkspace box (0, 0) .. (16, 16)\nregion a = box (1, 1) .. (7, 7)\n\
         region b = box (5, 5) .. (9, 9)\nrobot R1: Rover at (4, 4)\nrobot R2: Rover at (12, 12)\nconnectivity none\n\
         dynamics Rover {{ step 0.5 s integrator 1 bound vx, vy in [-4, 4] m/s }}\ngoal g: {}\n",
        text(word)
    );
    let source = SourceFile::new("random.dosm", text);
    driver::problem(&source, &Overrides::default(), &mut Diagnostics::new()).ok().map(|(problem, _)| problem)
}

#[test]
fn goals_mean_what_they_say() {
    let regions =
        vec![("a", vec![boxed([1.0, 1.0], [7.0, 7.0])]), ("b", vec![boxed([5.0, 5.0], [9.0, 9.0])])];
    let robots = ["R1", "R2"].map(|name| (name, 0, vec![[4.0, 4.0]; 3])).to_vec();
    let mut dice = Dice(2028);
    let (mut count, mut held, mut refused) = (0, 0, 0);
    for _ in 0..1200 {
        let word = random(&mut dice, 3);
        // What is false by propositional reasoning alone is refused.
        let Some(asked) = mission(&word) else {
            refused += 1;
            continue;
        };
        for loop_place in 0..3 {
            let scene =
                Scene { regions: regions.clone(), robots: robots.clone(), loop_place, ..Scene::default() };
            let (mut problem, mut plan) = scene.build();
            (problem.formulas, problem.goals) = (asked.formulas.clone(), asked.goals.clone());
            let mut any = || [Label::In, Label::Out, Label::Unknown, Label::In, Label::Out][dice.below(5)];
            let labels: Vec<[[Label; 2]; 2]> = (0..6).map(|_| [[any(), any()], [any(), any()]]).collect();
            for (r, robot) in plan.robots.iter_mut().enumerate() {
                for (s, name) in REGIONS.iter().enumerate() {
                    robot.regions.insert((*name).into(), labels.iter().map(|l| l[r][s]).collect());
                }
            }
            let run = Run { labels, back: plan.loop_start };
            let expected = run.certain(&word, true, 0);
            let report = verify(&problem, &plan);
            let found = report.check(Kind::Goals).expect("it gets that far").holds();
            assert_eq!(found, expected, "{} with {:?} back to {}", text(&word), run.labels, run.back);
            count += 1;
            held += usize::from(expected);
        }
    }
    assert!(held > count / 8 && held < count * 7 / 8, "{held} of {count} hold");
    assert!(refused < 300, "{refused} were refused");
}

#[test]
fn plans_of_other_members_of_a_family_are_refused() {
    // Robots, jammers and steps change places: each is a plan of something else.
    let (problem, plan) = hovering(
        &[[4.0, 4.0], [8.0, 4.0]],
        Scene {
            blockers: vec![
                ("J[1]", dosmc::ir::BlockerKind::Jammer, vec![boxed([6.0, 1.0], [6.5, 2.0])]),
                ("J[2]", dosmc::ir::BlockerKind::Jammer, vec![boxed([6.0, 9.0], [6.5, 10.0])]),
            ],
            ..Scene::default()
        },
    );
    crate::cases::holds(&problem, &plan);
    let mut forged = plan.clone();
    let (one, other) = (forged.robots[0].name.clone(), forged.robots[1].name.clone());
    (forged.robots[0].name, forged.robots[1].name) = (other, one);
    crate::cases::refused(&problem, &forged, Kind::Start);
    let mut forged = plan.clone();
    let clear = &mut forged.robots[0].clear;
    let (first, second) = (clear["J[1]"].clone(), clear["J[2]"].clone());
    clear.insert("J[1]".into(), second);
    clear.insert("J[2]".into(), first);
    crate::cases::refused(&problem, &forged, Kind::Blockers);
}
