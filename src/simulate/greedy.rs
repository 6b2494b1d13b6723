//! The greedy adversary: at each step the vertex of Θ that leaves least at the next sample.

use super::aim::Aim;

/// What a robot can be pushed towards, by the step before.
pub(super) struct Greedy {
    /// By the step that the push is given at.
    steps: Vec<Vec<Claim>>,
    /// The middle of Θ, and its half-widths, scaled.
    mean: Vec<f64>,
    reach: Vec<f64>,
}

/// `offset − normal · x`, of which at most `reach` can ever be used up.
struct Claim {
    normal: Vec<f64>,
    offset: f64,
    scale: f64,
    /// What one push can use up.
    bite: f64,
}

impl Greedy {
    /// The claims on a robot whose nominal states are `z`; after the last of them comes `loop_start`.
    pub(super) fn new(
        robot: usize,
        aims: &[Aim],
        z: &[Vec<f64>],
        loop_start: usize,
        mean: &[f64],
        reach: &[f64],
    ) -> Greedy {
        let mut at: Vec<Vec<(f64, Claim)>> = z.iter().map(|_| Vec::new()).collect();
        for aim in aims {
            let part = aim.parts.iter().find(|part| part.robot == robot && part.input.is_empty());
            if let (Some(part), Some(nominal), Some(list)) = (part, z.get(aim.step), at.get_mut(aim.step)) {
                let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
                // Another robot's part of it stays where its nominal is.
                let claim = Claim {
                    offset: aim.slack + dot(&part.state, nominal),
                    scale: 1.0 / aim.reach,
                    bite: part.state.iter().zip(reach).map(|(a, r)| a.abs() * r).sum(),
                    normal: part.state.clone(),
                };
                list.push((aim.room(), claim));
            }
        }
        let mut at: Vec<Vec<Claim>> = at.into_iter().map(nearest).collect();
        let last = at.len().saturating_sub(1);
        // By the step before: the last one is followed by the loop's first.
        let again = at.get_mut(loop_start).map(|claims| claims.iter().map(Claim::copy).collect());
        let mut steps: Vec<Vec<Claim>> = at.drain(1.min(last + 1)..).collect();
        steps.extend(again);
        Greedy { steps, mean: mean.to_vec(), reach: reach.to_vec() }
    }

    /// Chooses the push of a step, after which the robot will be at `predicted` plus the push;
    /// components that nothing depends on keep what they have.
    pub(super) fn choose(&self, step: usize, predicted: &[f64], push: &mut [f64]) {
        let Some(claims) = self.steps.get(step) else { return };
        let mut worst: Option<(f64, &Claim)> = None;
        for claim in claims {
            let used: f64 = claim
                .normal
                .iter()
                .zip(predicted.iter().zip(&self.mean))
                .map(|(a, (x, w))| a * (x + w))
                .sum();
            let left = (claim.offset - used - claim.bite) * claim.scale;
            if worst.is_none_or(|(least, _)| left < least) {
                worst = Some((left, claim));
            }
        }
        let Some((_, claim)) = worst else { return };
        let ends = self.mean.iter().zip(&self.reach);
        for ((push, normal), (mean, reach)) in push.iter_mut().zip(&claim.normal).zip(ends) {
            if *normal != 0.0 {
                *push = mean + reach.copysign(*normal);
            }
        }
    }
}

impl Claim {
    fn copy(&self) -> Claim {
        Claim { normal: self.normal.clone(), ..*self }
    }
}

/// The claims that can ever be the nearest: disturbances use up at most the whole reach of each, once to
/// either side.
fn nearest(claims: Vec<(f64, Claim)>) -> Vec<Claim> {
    let least = claims.iter().map(|(room, _)| *room).fold(f64::INFINITY, f64::min);
    claims.into_iter().filter(|(room, _)| *room <= least + 2.0).map(|(_, claim)| claim).collect()
}
