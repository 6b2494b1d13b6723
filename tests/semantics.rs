//! The planner against brute force: verdict, shortest length, labels, on random formulas.
//!
//! A robot that can jump anywhere in one step turns planning into choosing labels: position 0 is
//! out of both regions, every other position may be in any of the four places (in or out of each of
//! two overlapping regions), and the loop may go back to any position. All lassos of up to five
//! positions are tried, and the formulas are evaluated here by walking along the lasso.

mod common;

use std::fmt;
use std::sync::Arc;

use dosmc::diag::Diagnostics;
use dosmc::driver::{self, Answer, Overrides};
use dosmc::plan::{Label, Plan};
use dosmc::solve::Watch;
use dosmc::source::SourceFile;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use common::Patient;

/// The longest length tried.
const LONGEST: usize = 4;

/// What a formula asks of one position: in the first region, in the second.
type Place = [bool; 2];

#[derive(Clone, Debug)]
enum Ltl {
    True,
    In(usize),
    Count(&'static str, i64),
    Not(Box<Ltl>),
    Next(Box<Ltl>),
    /// Whether it is 'always', with its window.
    Box(bool, Option<(usize, usize)>, Box<Ltl>),
    /// The operator's name, with its window.
    Infix(&'static str, Option<(usize, usize)>, Box<Ltl>, Box<Ltl>),
}

impl fmt::Display for Ltl {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let window = |w: &Option<(usize, usize)>| w.map_or(String::new(), |(m, n)| format!("[{m}, {n}]"));
        match self {
            Ltl::True => write!(f, "true"),
            Ltl::In(region) => write!(f, "(r in {})", ["a", "b"][*region]),
            Ltl::Count(op, bound) => write!(f, "(2 * (r in a) - (r in b) {op} {bound})"),
            Ltl::Not(p) => write!(f, "(not {p})"),
            Ltl::Next(p) => write!(f, "(next {p})"),
            Ltl::Box(always, w, p) => {
                write!(f, "({}{} {p})", if *always { "always" } else { "eventually" }, window(w))
            }
            Ltl::Infix(op, w, p, q) => write!(f, "({p} {op}{} {q})", window(w)),
        }
    }
}

/// A lasso of places.
struct Lasso<'a> {
    places: &'a [Place],
    back: usize,
}

impl Lasso<'_> {
    fn after(&self, i: usize) -> usize {
        if i + 1 == self.places.len() { self.back } else { i + 1 }
    }

    /// The positions at distance m, m + 1, … n from i; without a window as far as anything new comes.
    fn holds(&self, formula: &Ltl, i: usize) -> bool {
        match formula {
            Ltl::True => true,
            Ltl::In(region) => self.places[i][*region],
            Ltl::Count(op, bound) => {
                let [a, b] = self.places[i].map(i64::from);
                compare(2 * a - b, op, *bound)
            }
            Ltl::Not(p) => !self.holds(p, i),
            Ltl::Next(p) => self.holds(p, self.after(i)),
            Ltl::Box(true, w, p) => !self.until(i, *w, &|_| true, &|j| !self.holds(p, j)),
            Ltl::Box(false, w, p) => self.until(i, *w, &|_| true, &|j| self.holds(p, j)),
            Ltl::Infix(op, w, p, q) => self.infix(op, *w, p, q, i),
        }
    }

    fn infix(&self, op: &str, w: Option<(usize, usize)>, p: &Ltl, q: &Ltl, i: usize) -> bool {
        let (a, b) = (|j: usize| self.holds(p, j), |j: usize| self.holds(q, j));
        let throughout = |x: &dyn Fn(usize) -> bool| {
            let all = w.map(|(_, n)| (0, n));
            !self.until(i, all, &|_| true, &|j| !x(j))
        };
        match op {
            "and" => a(i) && b(i),
            "or" => a(i) || b(i),
            "->" => !a(i) || b(i),
            "<->" => a(i) == b(i),
            "until" => self.until(i, w, &a, &b),
            "release" => !self.until(i, w, &|j| !a(j), &|j| !b(j)),
            "weak until" => self.until(i, w, &a, &b) || throughout(&a),
            // The dual of weak until.
            _ => !(self.until(i, w, &|j| !a(j), &|j| !b(j)) || throughout(&|j| !a(j))),
        }
    }

    fn until(
        &self,
        i: usize,
        window: Option<(usize, usize)>,
        a: &dyn Fn(usize) -> bool,
        b: &dyn Fn(usize) -> bool,
    ) -> bool {
        let (m, n) = window.unwrap_or((0, 2 * self.places.len()));
        let mut at = i;
        for d in 0..=n {
            if d >= m && b(at) {
                return true;
            }
            if !a(at) {
                return false;
            }
            at = self.after(at);
        }
        false
    }
}

fn compare(sum: i64, op: &str, bound: i64) -> bool {
    match op {
        "=" => sum == bound,
        "!=" => sum != bound,
        "<" => sum < bound,
        "<=" => sum <= bound,
        ">" => sum > bound,
        _ => sum >= bound,
    }
}

/// The least length of a lasso that fulfils the formula, by trying all of them.
fn shortest(formula: &Ltl) -> Option<usize> {
    (1..=LONGEST).find(|&length| {
        (0..4usize.pow(length as u32)).any(|code| {
            let place = |i: u32| {
                let digit = code >> (2 * i) & 3;
                [digit & 1 == 1, digit & 2 == 2]
            };
            let places: Vec<Place> =
                std::iter::once([false; 2]).chain((0..length as u32).map(place)).collect();
            (0..=length).any(|back| Lasso { places: &places, back }.holds(formula, 0))
        })
    })
}

fn mission(formula: &Ltl) -> String {
    format!(
        "dosm 1\nworkspace box (0, 0) .. (40, 4)\nregion a = box (2, 0.5) .. (12, 3.5)\n\
         region b = box (8, 0.5) .. (18, 3.5)\nrobot r: Jumper at (30, 2)\nconnectivity none\n\
         horizon 1..{LONGEST}\ngoal g: {formula}\ndynamics Jumper {{\n  step 1 s\n  integrator 1\n  \
         bound vx, vy in [-50, 50] m/s\n  disturbance px in [-0.1, 0.1] m\n  rejection 0.5\n}}\n"
    )
}

fn formulas() -> impl Strategy<Value = Ltl> {
    let window = prop_oneof![
        2 => Just(None),
        1 => (0usize..4, 0usize..4).prop_map(|(m, d)| Some((m, m + d))),
        1 => (0usize..9, 0usize..12).prop_map(|(m, d)| Some((m, m + d))),
    ];
    let op = prop::sample::select(vec!["=", "!=", "<", "<=", ">", ">="]);
    let leaf = prop_oneof![
        1 => Just(Ltl::True),
        6 => (0usize..2).prop_map(Ltl::In),
        2 => (op, -2i64..3).prop_map(|(op, bound)| Ltl::Count(op, bound)),
    ];
    leaf.prop_recursive(4, 14, 2, move |inner| {
        let pair = (inner.clone(), inner.clone());
        let plain = prop::sample::select(vec!["and", "or", "->", "<->"]);
        let timed = prop::sample::select(vec!["until", "release", "weak until", "strong release"]);
        prop_oneof![
            1 => inner.clone().prop_map(|p| Ltl::Not(Box::new(p))),
            1 => inner.clone().prop_map(|p| Ltl::Next(Box::new(p))),
            3 => (any::<bool>(), window.clone(), inner.clone())
                .prop_map(|(always, w, p)| Ltl::Box(always, w, Box::new(p))),
            2 => (plain, pair.clone()).prop_map(|(op, (p, q))| Ltl::Infix(op, None, Box::new(p), Box::new(q))),
            3 => (timed, window.clone(), pair)
                .prop_map(|(op, w, (p, q))| Ltl::Infix(op, w, Box::new(p), Box::new(q))),
        ]
    })
}

/// The plan's own labels as places; `None` where one is unknown.
fn labels(plan: &Plan) -> Vec<[Option<bool>; 2]> {
    let label = |region: &str, t: usize| match plan.robots[0].regions.get(region).map(|l| l[t]) {
        Some(Label::In) => Some(true),
        Some(Label::Out) => Some(false),
        _ => None,
    };
    (0..=plan.length).map(|t| ["a", "b"].map(|region| label(region, t))).collect()
}

/// Every completion of the unknown labels.
fn completions(labels: &[[Option<bool>; 2]]) -> Vec<Vec<Place>> {
    labels.iter().fold(vec![Vec::new()], |all, [a, b]| {
        let values = |x: &Option<bool>| x.map_or(vec![false, true], |v| vec![v]);
        let places: Vec<Place> =
            values(a).into_iter().flat_map(|a| values(b).into_iter().map(move |b| [a, b])).collect();
        all.iter()
            .flat_map(|run| places.iter().map(|p| [run.clone(), vec![*p]].concat()).collect::<Vec<_>>())
            .collect()
    })
}

fn agrees(formula: &Ltl) -> Result<(), TestCaseError> {
    let expected = shortest(formula);
    let source = SourceFile::new("random.dosm", mission(formula));
    let mut diagnostics = Diagnostics::new();
    let Ok(mission) = driver::load(&source, &Overrides::default(), &mut diagnostics) else {
        // Only a goal that nothing can fulfil is refused, and rightly.
        prop_assert_eq!(expected, None, "{} is refused: {:?}", formula, diagnostics);
        return Ok(());
    };
    let watch: Arc<dyn Watch> = Arc::new(Patient);
    match driver::solve(&mission, &watch).answer {
        Answer::Plan { plan, shortest, .. } => {
            prop_assert!(shortest);
            prop_assert_eq!(Some(plan.length), expected, "{}", formula);
            let runs = completions(&labels(&plan));
            let sure = runs.iter().all(|places| Lasso { places, back: plan.loop_start }.holds(formula, 0));
            prop_assert!(sure, "{} does not follow from the plan's labels", formula);
        }
        Answer::NoPlan(_) => prop_assert_eq!(expected, None, "no plan for {}", formula),
        other => prop_assert!(false, "{}: {:?}", formula, other),
    }
    Ok(())
}

#[test]
fn random_formulas_have_the_shortest_plans_that_brute_force_finds() {
    let config = Config { cases: 3000, failure_persistence: None, ..Config::default() };
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    let mut runner = TestRunner::new_with_rng(config, rng);
    runner.run(&formulas(), |formula| agrees(&formula)).unwrap();
}
