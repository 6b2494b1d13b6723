//! Which moments are worth a panel of their own.

use std::collections::BTreeSet;

use super::scene::Scene;

/// A step, and what happens there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Moment {
    /// The step.
    pub step: usize,
    /// What happens, in a few words each.
    pub what: Vec<String>,
}

/// A link without its direction.
type Pair<'a> = (&'a str, &'a str);

/// At most so many moments, in order: the start, where the loop begins and ends, then arrivals in
/// regions and changes of the links, those first that are great and far from what is shown already.
pub fn choose(scene: &Scene, most: usize) -> Vec<Moment> {
    let count = scene.steps();
    let ends = [0, scene.loop_start(), count.saturating_sub(1)];
    let mut chosen: BTreeSet<usize> = ends.into_iter().filter(|s| *s < count).collect();
    let weights: Vec<usize> = (0..count).map(|step| weight(scene, step)).collect();
    while chosen.len() < most {
        let gap = |step: usize| chosen.iter().map(|c| c.abs_diff(step)).min().unwrap_or(1);
        let worth = |step: &usize| (weights[*step] * gap(*step), std::cmp::Reverse(*step));
        let Some(next) = (0..count).max_by_key(worth).filter(|step| worth(step).0 > 0) else { break };
        chosen.insert(next);
    }
    chosen.into_iter().map(|step| Moment { step, what: what(scene, step) }).collect()
}

/// How much happens at a step: an arrival counts more than any link that comes or goes.
fn weight(scene: &Scene, step: usize) -> usize {
    let arrivals = (0..scene.robots.len()).filter(|&r| scene.arrival(r, step).is_some()).count();
    arrivals * 4 + changes(scene, step)
}

/// How many links came or went since the step before.
fn changes(scene: &Scene, step: usize) -> usize {
    let (now, before) = (pairs(scene, step), pairs(scene, step.saturating_sub(1)));
    now.symmetric_difference(&before).count()
}

fn pairs<'a>(scene: &'a Scene, step: usize) -> BTreeSet<Pair<'a>> {
    let links = scene.plan.links.as_ref().and_then(|all| all.get(step)).map_or(&[][..], Vec::as_slice);
    links.iter().map(|l| (l.from.as_str().min(&l.to), l.from.as_str().max(&l.to))).collect()
}

/// What happens at a step, the most important first.
fn what(scene: &Scene, step: usize) -> Vec<String> {
    let last = scene.steps().saturating_sub(1);
    let mut all: Vec<String> = Vec::new();
    if scene.stays() && step == last {
        all.push("stays so for ever".into());
    } else if step == last {
        all.push(format!("then step {} again", scene.loop_start()));
    } else if step == scene.loop_start() {
        all.push("the loop begins".into());
    } else if step == 0 {
        all.push("start".into());
    }
    let arrived = scene.robots.iter().enumerate();
    all.extend(
        arrived.filter_map(|(r, robot)| Some(format!("{} in {}", robot.name, scene.arrival(r, step)?))),
    );
    if all.is_empty() {
        all.push("the links change".into());
    }
    all
}
