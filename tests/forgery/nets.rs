//! Connectivity against brute force: random lists of links at random steps, and every way to lose
//! robots at every time of the infinite run.

use dosmc::ir::Connectivity;
use dosmc::plan::Link;
use dosmc::verify::{Kind, verify};

use crate::sampling::Dice;
use crate::scene::Scene;

const NAMES: [&str; 5] = ["R1", "R2", "R3", "R4", "R5"];
const BASES: [&str; 2] = ["B1", "B2"];

/// Whether every robot that is left reaches a base over at most so many of the links.
fn reaches(links: &[Link], robots: usize, lost: usize, hops: usize) -> bool {
    let gone = |name: &str| NAMES.iter().position(|n| *n == name).is_some_and(|i| lost >> i & 1 == 1);
    let mut near: Vec<&str> = BASES.to_vec();
    for _ in 0..hops {
        let mut more: Vec<&str> = Vec::new();
        for (from, to) in links.iter().flat_map(|l| [(&l.from, &l.to), (&l.to, &l.from)]) {
            if near.contains(&from.as_str()) && !gone(to) {
                more.push(to);
            }
        }
        near.extend(more);
    }
    NAMES[..robots].iter().all(|name| gone(name) || near.contains(name))
}

/// The definition: at every time t ≡ 0 mod n, whichever k robots are lost (or fewer, or all but none).
fn connected(asked: &Connectivity, lists: &[Vec<Link>], back: usize, robots: usize) -> bool {
    let every = asked.every as usize;
    let hops = asked.hops.map_or(robots, |h| h as usize);
    let rounds = lists.len() + every * (lists.len() - back) * 2;
    let step = |t: usize| if t < lists.len() { t } else { back + (t - back) % (lists.len() - back) };
    (0..rounds).filter(|t| t % every == 0).all(|t| {
        let may_go = |lost: &usize| lost.count_ones() <= asked.redundancy;
        (0..1usize << robots).filter(may_go).all(|lost| reaches(&lists[step(t)], robots, lost, hops))
    })
}

#[test]
fn connectivity_is_what_brute_force_finds() {
    let mut dice = Dice(2027);
    let (mut held, mut failed) = (0, 0);
    for round in 0..1500 {
        let robots = 1 + dice.below(5);
        let legs = 1 + dice.below(3);
        let loop_place = dice.below(legs);
        let asked = Connectivity {
            hops: (dice.below(3) == 0).then(|| 1 + dice.below(robots) as u32),
            range: None,
            redundancy: dice.below(4) as u32,
            every: 1 + dice.below(4) as u32,
        };
        let places = |i: usize| vec![[2.0 + 2.0 * i as f64, 3.0]; legs];
        let scene = Scene {
            bases: vec![("B1", [1.0, 1.0]), ("B2", [14.0, 9.0])],
            robots: (0..robots).map(|i| (NAMES[i], 0, places(i))).collect(),
            loop_place,
            connectivity: Some(asked.clone()),
            ..Scene::default()
        };
        let (problem, mut plan) = scene.build();
        // Mostly dense, so that the loss of robots matters and is survived now and then.
        let density = 50 + dice.below(50);
        for list in plan.links.as_mut().unwrap() {
            for (i, from) in NAMES[..robots].iter().enumerate() {
                for to in NAMES[..i].iter().chain(&BASES) {
                    if dice.below(100) < density {
                        list.push(Link {
                            from: (*from).into(),
                            to: (*to).into(),
                            hops: 1,
                            separators: vec![],
                        });
                    }
                }
            }
        }
        let expected = connected(&asked, plan.links.as_ref().unwrap(), plan.loop_start, robots);
        let report = verify(&problem, &plan);
        assert_eq!(report.holds(), expected, "{round}: {asked:?} {:?}: {report}", plan.links);
        assert!(expected || report.failures.iter().all(|f| f.check == Kind::Connectivity), "{report}");
        held += usize::from(expected);
        failed += usize::from(!expected);
    }
    assert!(held > 300 && failed > 300, "{held} held, {failed} did not");
}
