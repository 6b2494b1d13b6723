//! The laws.

use dosmc::plan::Plan;
use dosmc::verify::verify;

use crate::chance::Chance;
use crate::draft::{Draft, Links, Named, ONE};
use crate::formula::Formula;
use crate::generate;
use crate::luck::{grown, lucky};
use crate::motion::{self, Motion};
use crate::verdict::{Verdict, load, verdict};

/// A number from the environment.
#[allow(clippy::disallowed_methods, reason = "soaking takes more cases than a test run")]
fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|value| value.parse().ok()).unwrap_or(default)
}

/// The seeds of a law: each has its own block.
fn seeds(law: u64) -> impl Iterator<Item = u64> {
    let (count, from) = (number("DOSMC_METAMORPHIC", 24), number("DOSMC_METAMORPHIC_FROM", 0));
    (from..from + count).map(move |i| law * 1_000_000 + i)
}

/// What became of the cases.
#[derive(Default, Debug)]
struct Tally {
    plans: usize,
    none: usize,
    errors: usize,
    unknown: usize,
    excused: usize,
    wrong: Vec<String>,
}

impl Tally {
    fn count(&mut self, verdict: &Verdict) {
        match verdict {
            Verdict::Plan(_) => self.plans += 1,
            Verdict::NoPlan => self.none += 1,
            Verdict::Errors(_) => self.errors += 1,
            Verdict::Unknown => self.unknown += 1,
            // Said by the law, with the mission.
            Verdict::Refused(_) => {}
        }
    }

    /// Fails when anything was wrong, or when the cases showed too little.
    fn conclude(self, law: &str) {
        let all = self.plans + self.none + self.errors + self.unknown;
        // Shown when a test is run alone or fails.
        println!("{law}: {} plans, {} none, {} errors", self.plans, self.none, self.errors);
        println!("{law}: {} unknown, {} excused", self.unknown, self.excused);
        assert!(self.wrong.is_empty(), "{} of {all} cases:\n{}", self.wrong.len(), self.wrong.join("\n"));
        assert!(2 * self.plans >= all, "too few have a plan: {self:?}");
        assert!(10 * self.errors <= 2 * all, "too many have errors: {self:?}");
        assert!(20 * self.unknown <= all + 20, "too many are unknown: {self:?}");
        assert!(50 * self.excused <= all + 50, "too many are excused: {self:?}");
    }
}

/// Same verdict, same shortest length.
fn same(law: &str, number: u64, change: impl Fn(&Draft, &mut Chance) -> (Draft, Draft)) {
    let mut tally = Tally::default();
    for seed in seeds(number) {
        let (one, other) = change(&generate::draft(seed), &mut Chance::new(!seed));
        let (first, second) = (verdict(&one), verdict(&other));
        let unknown = [&first, &second].into_iter().find(|v| matches!(v, Verdict::Unknown));
        tally.count(unknown.unwrap_or(&first));
        let refused = matches!(first, Verdict::Refused(_)) || matches!(second, Verdict::Refused(_));
        if !refused && (first.word() == second.word() || unknown.is_some()) {
            continue;
        }
        if excused(&one, &first, &other, &second) {
            tally.excused += 1;
        } else {
            tally.wrong.push(format!(
                "{law} {seed}: {}\n{}\nthen {}\n{}",
                first.word(),
                one.text(),
                second.word(),
                other.text()
            ));
        }
    }
    tally.conclude(law);
}

/// A plan stays a plan: the old one holds for the changed mission where it is told so, and the search
/// finds one that is no longer.
fn stays(law: &str, number: u64, keeps: bool, change: impl Fn(&Draft, &mut Chance) -> Option<Draft>) {
    let mut tally = Tally::default();
    for seed in seeds(number) {
        let before = generate::draft(seed);
        let old = verdict(&before);
        if let Verdict::Refused(_) = &old {
            tally.wrong.push(format!("{law} {seed}: {}\n{}", old.word(), before.text()));
        }
        let (Verdict::Plan(plan), Some(after)) = (&old, change(&before, &mut Chance::new(!seed))) else {
            tally.count(&old);
            continue;
        };
        let new = verdict(&after);
        tally.count(if matches!(new, Verdict::Unknown) { &new } else { &old });
        let Some(why) = lost(plan, &after, &new, keeps) else { continue };
        let excused = excused(&before, &old, &after, &new) || has_grown(&before, &after);
        if why == NOT_FOUND && excused {
            tally.excused += 1;
        } else {
            let (was, is) = (old.word(), new.word());
            let texts = format!("{}\nthen\n{}", before.text(), after.text());
            tally.wrong.push(format!("{law} {seed}: {was}, then {is}: {why}\n{texts}"));
        }
    }
    tally.conclude(law);
}

/// Whether the shorter of two plans is one that the directions of the search do not have.
fn excused(one: &Draft, first: &Verdict, other: &Draft, second: &Verdict) -> bool {
    let shorter = |plan: &Plan, than: &Verdict| match than {
        Verdict::Plan(than) => plan.length < than.length,
        _ => matches!(than, Verdict::NoPlan),
    };
    let by_luck = |draft: &Draft, verdict: &Verdict, than: &Verdict| match (verdict, load(draft)) {
        (Verdict::Plan(plan), Ok(mission)) => shorter(plan, than) && lucky(&mission, plan),
        _ => false,
    };
    by_luck(one, first, second) || by_luck(other, second, first)
}

/// Whether the changed mission has tubes that take more of something than before.
fn has_grown(before: &Draft, after: &Draft) -> bool {
    match (load(before), load(after)) {
        (Ok(before), Ok(after)) => grown(&before, &after),
        _ => false,
    }
}

const NOT_FOUND: &str = "the search does not find it";

fn lost(plan: &Plan, after: &Draft, new: &Verdict, keeps: bool) -> Option<String> {
    let mission = match load(after) {
        Ok(mission) => mission,
        Err(codes) => return Some(format!("{codes:?}")),
    };
    if keeps {
        let report = verify(&mission.problem, plan);
        if !report.holds() {
            return Some(format!("the old plan is refused: {report}"));
        }
    }
    match new {
        Verdict::Plan(new) if new.length <= plan.length => None,
        Verdict::Unknown => None,
        _ => Some(NOT_FOUND.into()),
    }
}

/// A law about a similarity of the workspace.
fn moved(law: &str, number: u64, motion: impl Fn(&Draft, &mut Chance) -> Motion) {
    same(law, number, |draft, chance| (draft.clone(), motion(draft, chance).apply(draft)));
}

#[test]
fn translated() {
    moved("translated", 1, |draft, chance| {
        let shift = (0..draft.dimension).map(|_| chance.between(-40, 40) * ONE / 8).collect();
        Motion { shift, ..Motion::none(draft.dimension) }
    });
}

#[test]
fn scaled_by_a_power_of_two() {
    moved("scaled by a power of two", 2, |draft, chance| {
        let scale = *chance.pick(&[(1, 8), (1, 2), (2, 1), (64, 1)]);
        Motion { scale, ..Motion::none(draft.dimension) }
    });
}

#[test]
fn scaled_by_ten() {
    moved("scaled by ten", 3, |draft, chance| {
        let scale = *chance.pick(&[(10, 1), (100, 1), (1000, 1)]);
        Motion { scale, ..Motion::none(draft.dimension) }
    });
}

#[test]
fn turned_by_a_right_angle() {
    moved("turned", 4, |draft, chance| {
        let mut motion = Motion::none(draft.dimension);
        for _ in 0..1 + chance.below(3) {
            let (i, j) =
                *chance.pick(if draft.dimension == 3 { &[(0, 1), (1, 2), (2, 0)][..] } else { &[(0, 1)] });
            // A quarter turn in the plane of two axes.
            for axis in 0..draft.dimension {
                match motion.axis[axis] {
                    a if a == i => motion.axis[axis] = j,
                    a if a == j => (motion.axis[axis], motion.sign[axis]) = (i, -motion.sign[axis]),
                    _ => {}
                }
            }
        }
        motion
    });
}

#[test]
fn mirrored() {
    moved("mirrored", 5, |draft, chance| {
        let mut motion = Motion::none(draft.dimension);
        motion.sign[chance.below(draft.dimension)] = -1;
        motion
    });
}

#[test]
fn renamed() {
    same("renamed", 6, |draft, chance| (draft.clone(), motion::renamed(draft, chance)));
}

#[test]
fn declared_in_another_order() {
    same("permuted", 7, |draft, chance| {
        (draft.clone(), Draft { shuffle: Some(chance.below(1 << 30) as u64), ..draft.clone() })
    });
}

#[test]
fn with_a_jammer_far_away() {
    same("far jammer", 8, motion::with_far_jammer);
}

#[test]
fn with_padded_formulas() {
    same("padded", 9, |draft, chance| {
        let goals = draft.goals.iter().map(|goal| goal.padded(chance)).collect();
        (draft.clone(), Draft { goals, ..draft.clone() })
    });
}

#[test]
fn unrolled_by_one() {
    let mut tally = Tally::default();
    for seed in seeds(10) {
        let draft = generate::draft(seed);
        let first = verdict(&draft);
        let Verdict::Plan(plan) = &first else {
            tally.count(&first);
            continue;
        };
        let longer = plan.length + 1 + (seed % 2) as usize;
        let second = verdict(&Draft { horizon: (longer, longer), ..draft.clone() });
        tally.count(if matches!(second, Verdict::Unknown) { &second } else { &first });
        if !matches!(second, Verdict::Plan(_) | Verdict::Unknown) {
            let (was, is) = (first.word(), second.word());
            tally.wrong.push(format!("{seed}: {was}, at {longer} {is}\n{}", draft.text()));
        }
    }
    tally.conclude("unrolled");
}

#[test]
fn with_smaller_blockers() {
    stays("smaller blockers", 11, true, |draft, chance| Some(motion::with_smaller_blockers(draft, chance)));
}

#[test]
fn with_less_disturbance() {
    stays("less disturbance", 12, true, |draft, chance| Some(motion::with_less_disturbance(draft, chance)));
}

#[test]
fn with_another_base() {
    stays("another base", 13, true, |draft, chance| {
        draft.links.as_ref()?;
        let mut image = draft.clone();
        let what =
            (0..draft.dimension).map(|axis| if axis == 0 { ONE / 5 } else { chance.between(2, 10) * ONE });
        image.bases.push(Named { name: "another".into(), what: what.collect() });
        Some(image)
    });
}

#[test]
fn with_relaxed_goals() {
    stays("relaxed goals", 14, true, |draft, chance| {
        let mut image = draft.clone();
        let at = chance.below(image.goals.len());
        if image.goals.len() > 1 && chance.percent(40) {
            image.goals.remove(at);
        } else {
            image.goals[at] = image.goals[at].relaxed(chance);
        }
        Some(image)
    });
}

#[test]
fn with_relaxed_settings() {
    stays("relaxed settings", 15, true, |draft, chance| {
        let mut image = draft.clone();
        match (&mut image.links, chance.percent(50)) {
            (Some(Links { range: Some((range, _)), .. }), true) => *range += ONE,
            (Some(Links { hops: Some(hops), .. }), true) => *hops += 1,
            (Some(links), false) => *links = Links { every: 2 * links.every, ..Links::default() },
            _ => image.separation = image.separation.map(|s| s / 16 * 8),
        }
        Some(image)
    });
}

#[test]
fn contradictions_have_no_plan() {
    for seed in seeds(16) {
        let mut draft = generate::draft(seed);
        let atom = Formula::In(0, 0);
        draft.horizon.1 = 6;
        draft.goals.push(Formula::Eventually(None, Box::new(atom.clone().infix("and", atom.not()))));
        let verdict = verdict(&draft);
        assert!(!matches!(verdict, Verdict::Plan(_)), "{seed}: {}", verdict.word());
    }
}
