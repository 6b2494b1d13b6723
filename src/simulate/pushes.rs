//! Disturbances: what pushes a robot from each sample to the next.

use super::Disturbance;
use super::aim::{Aim, Part, leverage};
use super::random::Stream;
use crate::plan::Tube;

/// Θ of a robot and what its disturbances are made of.
pub(super) struct Pusher<'a> {
    /// The middle of Θ.
    pub(super) mean: Vec<f64>,
    /// The half-widths of Θ, scaled.
    pub(super) reach: Vec<f64>,
    /// The robot's tube.
    pub(super) tube: &'a Tube,
}

impl Pusher<'_> {
    /// Independent and even, anywhere in Θ.
    pub(super) fn uniform(&self, stream: &mut Stream, pushes: &mut [f64]) {
        for row in pushes.chunks_exact_mut(self.mean.len().max(1)) {
            for (push, (mean, reach)) in row.iter_mut().zip(self.mean.iter().zip(&self.reach)) {
                *push = if *reach > 0.0 { mean + reach * stream.symmetric() } else { *mean };
            }
        }
    }

    /// Another vertex of Θ at each sample.
    pub(super) fn vertices(&self, stream: &mut Stream, pushes: &mut [f64]) {
        for row in pushes.chunks_exact_mut(self.mean.len().max(1)) {
            self.vertex(stream, row);
        }
    }

    /// A random vertex of Θ.
    fn vertex(&self, stream: &mut Stream, row: &mut [f64]) {
        let mut bits = stream.bits();
        for (i, (push, (mean, reach))) in row.iter_mut().zip(self.mean.iter().zip(&self.reach)).enumerate() {
            if i % 64 == 63 {
                bits = stream.bits();
            }
            *push = if bits >> (i % 64) & 1 == 0 { mean + reach } else { mean - reach };
        }
    }

    /// One vertex of Θ for the whole run: the one that, held, brings the robot nearest to a claim; a
    /// random one where the robot has no part in the claim.
    pub(super) fn held(&self, part: Option<&Part>, stream: &mut Stream, pushes: &mut [f64]) {
        let mut row = vec![0.0; self.mean.len()];
        self.vertex(stream, &mut row);
        if let Some(part) = part {
            let levers = leverage(self.tube, part);
            let total: Vec<f64> =
                (0..row.len()).map(|j| levers.iter().map(|of_one| of_one[j]).sum::<f64>()).collect();
            self.point(&total, &mut row);
        }
        pushes.chunks_exact_mut(row.len().max(1)).for_each(|push| push.copy_from_slice(&row));
    }

    /// Makes the pushes before a sample those that bring the robot nearest to a claim at it.
    pub(super) fn aim(&self, part: &Part, sample: usize, pushes: &mut [f64]) {
        let n = self.mean.len();
        for (i, lever) in leverage(self.tube, part).iter().enumerate() {
            let Some(at) = sample.checked_sub(1 + i) else { return };
            if let Some(row) = pushes.get_mut(at * n..(at + 1) * n) {
                self.point(lever, row);
            }
        }
    }

    /// The vertex that is farthest along a direction; components along which it has none stay.
    fn point(&self, direction: &[f64], row: &mut [f64]) {
        let ends = self.mean.iter().zip(&self.reach);
        for ((push, along), (mean, reach)) in row.iter_mut().zip(direction).zip(ends) {
            if *along != 0.0 {
                *push = mean + reach.copysign(*along);
            }
        }
    }
}

/// What the robots are pushed by in a run.
pub(super) struct Script<'a> {
    /// The kind.
    pub(super) kind: Disturbance,
    /// Claims to aim at, each with the sample at which it is to be met.
    targets: Vec<(&'a Aim, usize)>,
}

impl<'a> Script<'a> {
    /// The script of a run: runs aim at one claim after the other, what is nearest first.
    pub(super) fn new(
        kind: Disturbance,
        turn: u64,
        aims: &'a [Aim],
        lasso: Lasso,
        samples: usize,
        stream: &mut Stream,
    ) -> Script<'a> {
        let chosen = usize::try_from(turn % aims.len().max(1) as u64).ok().and_then(|i| aims.get(i));
        let targets = match (kind, chosen) {
            (Disturbance::Held, Some(aim)) => vec![(aim, 0)],
            (Disturbance::Aimed, Some(aim)) => targets(aim, aims, lasso, samples, stream),
            _ => Vec::new(),
        };
        Script { kind, targets }
    }

    /// Fills in a robot's disturbances.
    pub(super) fn write(&self, robot: usize, pusher: &Pusher<'_>, stream: &mut Stream, pushes: &mut [f64]) {
        let part_of = |aim: &'a Aim| aim.parts.iter().find(|part| part.robot == robot);
        match self.kind {
            Disturbance::Uniform => pusher.uniform(stream, pushes),
            Disturbance::Vertex | Disturbance::Adversarial => pusher.vertices(stream, pushes),
            Disturbance::Held => {
                pusher.held(self.targets.first().and_then(|(aim, _)| part_of(aim)), stream, pushes);
            }
            Disturbance::Aimed => {
                pusher.vertices(stream, pushes);
                for (aim, sample) in &self.targets {
                    part_of(aim).into_iter().for_each(|part| pusher.aim(part, *sample, pushes));
                }
            }
        }
    }
}

/// The steps of a plan: 0 … last, then loop_start again.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lasso {
    /// L.
    pub(super) last: usize,
    /// k ≤ L.
    pub(super) loop_start: usize,
    /// K: for so many samples a disturbance is remembered.
    pub(super) memory: usize,
}

impl Lasso {
    /// The steps of one round.
    pub(super) fn round(self) -> usize {
        self.last + 1 - self.loop_start
    }

    /// The step that a sample is at.
    pub(super) fn step(self, sample: usize) -> usize {
        if sample <= self.last { sample } else { self.loop_start + (sample - self.loop_start) % self.round() }
    }

    /// The first sample from `from` on that is at a step.
    fn sample(self, step: usize, from: usize) -> Option<usize> {
        if step >= from {
            return Some(step);
        }
        (step >= self.loop_start).then(|| step + (from - step).div_ceil(self.round()) * self.round())
    }
}

/// As many targets as fit into a run, a whole memory apart: the chosen one, and then any.
fn targets<'a>(
    first: &'a Aim,
    aims: &'a [Aim],
    lasso: Lasso,
    samples: usize,
    stream: &mut Stream,
) -> Vec<(&'a Aim, usize)> {
    // Later, a memory's worth of samples is there to push in, if the step comes again.
    let start = lasso.sample(first.step, lasso.memory).unwrap_or(first.step);
    let mut chosen = vec![(first, start)];
    let mut from = start + lasso.memory;
    while from < samples {
        let Some(aim) = aims.get(stream.below(aims.len().max(1))) else { break };
        match lasso.sample(aim.step, from) {
            Some(sample) if sample < samples => {
                chosen.push((aim, sample));
                from = sample + lasso.memory.max(1);
            }
            // It comes before the loop only, or too late: the run is random for a while.
            _ => from += lasso.memory.max(1),
        }
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_target_is_met_by_the_signs_before_it() {
        let tube = Tube {
            dynamics: String::new(),
            center: vec![0.0; 2],
            half_width: vec![1.0; 2],
            reserve: vec![0.0; 2],
            d: vec![vec![vec![1.0, 0.0], vec![0.0, 1.0]], vec![vec![0.5, -2.0], vec![0.0, 0.0]]],
            m: vec![vec![vec![0.0, 3.0]], vec![vec![-1.0, 1.0]]],
        };
        let pusher = Pusher { mean: vec![10.0, 0.0], reach: vec![1.0, 0.25], tube: &tube };
        let pushed = |state: Vec<f64>, input: Vec<f64>| {
            let mut pushes = vec![7.0; 10];
            pusher.aim(&Part { robot: 0, state, input }, 4, &mut pushes);
            pushes
        };
        // The last push counts through D(0) and M(0), the one before through D(1) and M(1).
        let of_state = pushed(vec![-1.0, 0.0], Vec::new());
        assert_eq!(of_state, [7.0, 7.0, 7.0, 7.0, 9.0, 0.25, 9.0, 7.0, 7.0, 7.0]);
        let of_input = pushed(Vec::new(), vec![2.0]);
        assert_eq!(of_input, [7.0, 7.0, 7.0, 7.0, 9.0, 0.25, 7.0, 0.25, 7.0, 7.0]);
        let mut held = vec![0.0; 4];
        let part = Part { robot: 0, state: vec![1.0, 1.0], input: Vec::new() };
        pusher.held(Some(&part), &mut Stream::new(0, 0), &mut held);
        assert_eq!(held, [11.0, -0.25, 11.0, -0.25], "the signs of the sums 1.5 and −1");
    }

    #[test]
    fn samples_go_round_the_loop() {
        let lasso = Lasso { last: 5, loop_start: 3, memory: 2 };
        let steps: Vec<usize> = (0..12).map(|t| lasso.step(t)).collect();
        assert_eq!(steps, [0, 1, 2, 3, 4, 5, 3, 4, 5, 3, 4, 5]);
        assert_eq!(lasso.sample(2, 3), None);
        for step in 0..=5 {
            for from in 0..12 {
                let found =
                    (from..40).find(|&t| steps.get(t).copied().unwrap_or_else(|| lasso.step(t)) == step);
                assert_eq!(lasso.sample(step, from), found, "{step} from {from}");
            }
        }
        let stay = Lasso { last: 4, loop_start: 4, memory: 2 };
        assert_eq!((stay.step(4), stay.step(9), stay.sample(4, 7)), (4, 4, Some(7)));
    }
}
