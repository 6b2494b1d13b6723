//! The one exception to 'same shortest length', made exact.
//!
//! A length is refuted for the half-spaces of the search's directions only. A candidate of the search
//! may keep clear of a blocker along no such direction all the same: chords and links are tested
//! exactly, before anything is demanded of them. Such a plan is one, and right; but whether the search
//! comes upon it depends on the order in which it looks. So two lengths may differ when the shorter
//! plan has a chord or link of this kind, and only then.

use dosmc::abstraction::{Abstraction, HalfSpace, Owner, SolidId};
use dosmc::driver::Mission;
use dosmc::ir::{BaseId, ModelId, RobotId};
use dosmc::plan::Plan;

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
