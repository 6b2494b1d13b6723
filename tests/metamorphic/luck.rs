//! The two exceptions to the laws, made exact.
//!
//! A length is refuted for the half-spaces of the search's directions only. A candidate of the search
//! may keep clear of a blocker along no such direction all the same: chords and links are tested
//! exactly, before anything is demanded of them. Such a plan is one, and right; but whether the search
//! comes upon it depends on the order in which it looks. So two lengths may differ when the shorter
//! plan has a chord or link of this kind, and only then.
//!
//! And a smaller disturbance has a tube of its own, for which the planner makes positions narrow, not
//! everything: where it takes more of an input or a state than the old tube did, a plan that needed
//! these to the full may be lost. (The old plan, with the old tube, stays a plan.)

use dosmc::abstraction::{Abstraction, HalfSpace, Owner, SolidId};
use dosmc::driver::Mission;
use dosmc::ir::{BaseId, ModelId, RobotId};
use dosmc::plan::Plan;
use dosmc::tube::Tube;
use nalgebra::DMatrix;

/// Whether a chord or a link of the plan keeps clear of a blocker along no direction of the search.
pub fn lucky(mission: &Mission, plan: &Plan) -> bool {
    let problem = &mission.problem;
    let abstraction = Abstraction::new(problem, &mission.tubes, 1.0);
    let scene = Scene { mission, plan, abstraction };
    problem.blockers.iter().any(|(id, blocker)| {
        let links = blocker.kind.blocks_links();
        scene.abstraction.solids_of(Owner::Blocker(id)).any(|solid| {
            problem.robots.ids().any(|robot| scene.chords(robot, solid)) || (links && scene.links(solid))
        })
    })
}

/// Whether a model's tube takes more of a state or an input than it did.
pub fn grown(before: &Mission, after: &Mission) -> bool {
    let reaches = |tube: &Tube| -> Vec<f64> {
        let reach = |list: &[DMatrix<f64>], row: usize| -> f64 {
            let entries = list
                .iter()
                .flat_map(|m| m.row(row).iter().copied().zip(&tube.half_width).collect::<Vec<_>>());
            entries.map(|(x, w)| x.abs() * w).sum()
        };
        let rows = |list: &[DMatrix<f64>]| 0..list.first().map_or(0, DMatrix::nrows);
        let states = rows(&tube.d).map(|row| reach(&tube.d, row));
        states.chain(rows(&tube.m).map(|row| reach(&tube.m, row))).collect()
    };
    let pairs = before.tubes.values().zip(after.tubes.values());
    pairs.flat_map(|(old, new)| reaches(old).into_iter().zip(reaches(new))).any(|(old, new)| new > old + 1e-9)
}

struct Scene<'a> {
    mission: &'a Mission,
    plan: &'a Plan,
    abstraction: Abstraction,
}

/// An end of a chord or link.
enum End {
    At(ModelId, Vec<f64>),
    Base(BaseId),
}

impl Scene<'_> {
    fn robot(&self, id: RobotId, t: usize) -> End {
        let robot = &self.mission.problem.robots[id];
        let model = &self.mission.problem.models[robot.model];
        let plan = self.plan.robots.iter().find(|r| r.name == robot.name).expect("it has a plan");
        End::At(robot.model, model.position.iter().map(|&i| plan.z[t][i]).collect())
    }

    /// Whether some direction of the solid has both ends beyond it.
    fn clear(&self, ends: &[End; 2], solid: SolidId) -> bool {
        let faces = &self.abstraction.solids[solid].faces;
        faces.iter().any(|(_, direction)| {
            ends.iter().all(|end| match end {
                End::At(model, p) => {
                    let HalfSpace { offset, .. } = self.abstraction.below(*model, solid, *direction);
                    let d = &self.abstraction.directions[*direction].vector;
                    d.iter().zip(p).map(|(a, b)| a * b).sum::<f64>() <= offset
                }
                End::Base(id) => self.abstraction.point_below(self.abstraction.base(*id), solid, *direction),
            })
        })
    }

    fn chords(&self, robot: RobotId, solid: SolidId) -> bool {
        (0..=self.plan.length).any(|t| {
            let next = if t < self.plan.length { t + 1 } else { self.plan.loop_start };
            !self.clear(&[self.robot(robot, t), self.robot(robot, next)], solid)
        })
    }

    fn links(&self, solid: SolidId) -> bool {
        let problem = &self.mission.problem;
        let end = |name: &str, t: usize| {
            let robot = problem.robots.iter().find(|(_, r)| r.name == name);
            let base = || problem.bases.iter().find(|(_, b)| b.name == name).expect("a base");
            robot.map_or_else(|| End::Base(base().0), |(id, _)| self.robot(id, t))
        };
        let steps = self.plan.links.iter().flatten().enumerate();
        steps
            .flat_map(|(t, links)| links.iter().map(move |l| (t, l)))
            .any(|(t, link)| !self.clear(&[end(&link.from, t), end(&link.to, t)], solid))
    }
}
