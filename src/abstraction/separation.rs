//! Keeping two robots apart along an axis.

use super::Abstraction;
use crate::ir::{Problem, RobotId};

impl Abstraction {
    /// What `(z_first − z_second)[axis]` must be at least (or, for the other side, its negative): the
    /// separation, both tubes, and the gap.
    pub fn least_apart(&self, problem: &Problem, pair: [RobotId; 2], axis: usize, positive: bool) -> f64 {
        let least = problem.separation.as_ref().map_or(0.0, |e| e.to_f64());
        let [first, second] = pair.map(|robot| problem.robots[robot].model);
        // The first robot's tube reaches towards the second, and the other way round.
        let down = self.support(first, self.directions.axis(axis, !positive));
        let up = self.support(second, self.directions.axis(axis, positive));
        least + down + up + self.gap
    }

    /// The axis and side along which two robots are farthest apart, if far enough, given each robot's
    /// nominal positions at both ends of a step.
    pub fn separating_face(
        &self,
        problem: &Problem,
        pair: [RobotId; 2],
        [a, b]: [[&[f64]; 2]; 2],
    ) -> Option<(usize, bool)> {
        let slack = |&(axis, positive): &(usize, bool)| {
            let sign = if positive { 1.0 } else { -1.0 };
            let apart = |t: usize| sign * (a[t][axis] - b[t][axis]);
            apart(0).min(apart(1)) - self.least_apart(problem, pair, axis, positive) + 0.5 * self.gap
        };
        let faces = (0..problem.dimension).flat_map(|axis| [(axis, true), (axis, false)]);
        let best = faces.max_by(|x, y| slack(x).total_cmp(&slack(y)))?;
        (slack(&best) >= 0.0).then_some(best)
    }
}
