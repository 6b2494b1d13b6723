//! The robots: a measurement goes in, an acceleration and the next hop of the radio come out. This is
//! all that a firmware has to do with the generated crate.

use fig2_4_controller::dynamics::rover::{Input, State};
use fig2_4_controller::{links, Fleet1, Fleet2, Fleet3, Node, Output};

use crate::plant::Plant;

/// How many robots there are.
pub const ROBOTS: usize = links::ROBOTS;

/// What a robot decides at a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// The acceleration for the next 0.5 s, in metres a second squared.
    pub acceleration: [f64; 2],
    /// Whom it sends what it has to say, and what it was told by others.
    pub next: Option<Node>,
    /// Whether its monitor says that the plan's promise holds.
    pub holds: bool,
}

impl Decision {
    fn new(node: Node, output: Output<Input>) -> Decision {
        Decision {
            acceleration: [output.input.ax, output.input.ay],
            next: links::next_hop(output.moment, node),
            holds: output.status.holds(),
        }
    }
}

/// Whatever steers a robot.
pub trait Robot {
    /// What it does where it measures this; asked once each 0.5 s.
    fn decide(&mut self, measured: &Plant) -> Decision;
}

/// What a robot measures, as its controller wants it.
fn state(plant: &Plant) -> State {
    let ([px, py], [vx, vy]) = (plant.position, plant.velocity);
    State { px, vx, py, vy }
}

impl Robot for Fleet1 {
    fn decide(&mut self, measured: &Plant) -> Decision {
        Decision::new(Fleet1::NODE, self.step(&state(measured)))
    }
}

impl Robot for Fleet2 {
    fn decide(&mut self, measured: &Plant) -> Decision {
        Decision::new(Fleet2::NODE, self.step(&state(measured)))
    }
}

impl Robot for Fleet3 {
    fn decide(&mut self, measured: &Plant) -> Decision {
        Decision::new(Fleet3::NODE, self.step(&state(measured)))
    }
}

/// All three robots, each with the controller that would be on its own processor.
#[derive(Clone, Debug, Default)]
pub struct Team(Fleet1, Fleet2, Fleet3);

impl Team {
    /// What each robot does.
    pub fn decide(&mut self, measured: &[Plant; ROBOTS]) -> [Decision; ROBOTS] {
        let [first, second, third] = measured;
        [self.0.decide(first), self.1.decide(second), self.2.decide(third)]
    }
}
