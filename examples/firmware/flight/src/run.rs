//! The closed loop: measure, step, report, move, and look at the truth all the while.

use core::fmt;

use fig2_4_controller::Node;

use crate::plant::{Plant, Wind};
use crate::radio::{in_the_clear, Radio};
use crate::team::{Decision, Team, ROBOTS};

/// Where each robot starts.
const STARTS: [[f64; 2]; ROBOTS] = [[4.5, 1.0], [2.5, 3.0], [1.5, 5.0]];

/// The side of the square workspace, in metres.
const SIDE: f64 = 12.0;
/// The most speed along an axis, in metres a second, and acceleration, in metres a second squared.
const FASTEST: f64 = 4.0;
const HARDEST: f64 = 4.0;
/// How near two robots may come to each other, in metres.
const SEPARATION: f64 = 0.1;
/// Lower and upper corner of the regions: the third robot has to go to the first for ever, and
/// exactly one robot to the second.
const PI1: [[f64; 2]; 2] = [[9.0, 1.9], [11.5, 4.4]];
const PI2: [[f64; 2]; 2] = [[0.5, 9.0], [3.0, 11.5]];

/// One step, for whoever wants to watch.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The step, from 0.
    pub step: usize,
    /// Where the robots are, and how fast.
    pub plants: &'a [Plant; ROBOTS],
    /// What they do.
    pub decisions: &'a [Decision; ROBOTS],
    /// Whose reports reached the base.
    pub arrived: [bool; ROBOTS],
    /// How many transmissions that took.
    pub hops: u32,
}

/// What came of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Steps that were run.
    pub steps: usize,
    /// Reports that reached the base, and those that did not.
    pub arrived: u32,
    /// Reports that did not.
    pub lost: u32,
    /// Transmissions that were heard.
    pub hops: u32,
    /// Transmissions that were drowned by a jammer.
    pub jammed: u32,
    /// Moves that touched a jammer or left the workspace, speeds and accelerations out of bounds.
    pub violations: u32,
    /// The least distance between two robots, squared, in square metres.
    pub closest: f64,
    /// Steps of robots whose monitor said that the promise does not hold.
    pub warnings: u32,
    /// For each goal, the most steps in a row without it.
    pub waits: [u32; 2],
    /// A hash of every bit of every state and input, in order.
    pub hash: u64,
}

impl Summary {
    /// Whether everything was as planned, with goals met at least every `patience` steps.
    pub fn good(&self, patience: u32) -> bool {
        self.lost == 0
            && self.violations == 0
            && self.warnings == 0
            && self.closest >= SEPARATION * SEPARATION
            && self.waits.iter().all(|wait| *wait <= patience)
    }

    /// Adds a number to the hash (FNV-1a).
    fn mix(&mut self, number: f64) {
        for byte in number.to_bits().to_le_bytes() {
            self.hash = (self.hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01B3);
        }
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "steps                       {}", self.steps)?;
        writeln!(f, "reports at the base         {}, lost {}", self.arrived, self.lost)?;
        writeln!(f, "transmissions               {}, jammed {}", self.hops, self.jammed)?;
        writeln!(f, "bounds, jammers, walls      {} violations", self.violations)?;
        writeln!(f, "least distance squared      {:.3} m²", self.closest)?;
        writeln!(f, "warnings of the monitors    {}", self.warnings)?;
        writeln!(f, "longest wait for the goals  {} and {} steps", self.waits[0], self.waits[1])?;
        writeln!(f, "hash of states and inputs   {:016x}", self.hash)
    }
}

/// What a run is to be like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How many steps.
    pub steps: usize,
    /// Scales the disturbances; 1 is what the plan is made for.
    pub push: f64,
    /// Everybody calls the base itself, whatever the plan's links say.
    pub direct: bool,
}

impl Default for Settings {
    /// What the plan is made for, 1000 steps long.
    fn default() -> Settings {
        Settings { steps: 1000, push: 1.0, direct: false }
    }
}

/// Runs the team, and shows each step to `watch`.
pub fn run(settings: &Settings, watch: &mut dyn FnMut(&Scene<'_>)) -> Summary {
    let mut team = Team::default();
    let mut plants = STARTS.map(Plant::at);
    let mut winds: [Wind; ROBOTS] = core::array::from_fn(|robot| Wind::new(robot as u64));
    let mut summary = Summary {
        steps: settings.steps,
        arrived: 0,
        lost: 0,
        hops: 0,
        jammed: 0,
        violations: 0,
        closest: f64::INFINITY,
        warnings: 0,
        waits: [0; 2],
        hash: 0xCBF2_9CE4_8422_2325,
    };
    let mut waiting = [0; 2];
    for step in 0..settings.steps {
        let mut decisions = team.decide(&plants);
        if settings.direct {
            decisions.iter_mut().for_each(|decision| decision.next = Some(Node::Station1));
        }
        let mut radio = Radio::new(plants.map(|plant| plant.position));
        let arrived = radio.forward(decisions.map(|decision| decision.next));
        watch(&Scene { step, plants: &plants, decisions: &decisions, arrived, hops: radio.hops });
        count(&mut summary, &plants, &decisions, arrived, &radio);
        wait(&mut summary, &mut waiting, &plants);
        for robot in 0..ROBOTS {
            let from = plants[robot].position;
            let shift = winds[robot].next().map(|shift| shift * settings.push);
            plants[robot].step(decisions[robot].acceleration, shift);
            summary.violations += u32::from(!in_the_clear(from, plants[robot].position));
        }
    }
    summary
}

/// Counts what a step shows.
fn count(
    summary: &mut Summary,
    plants: &[Plant; ROBOTS],
    decisions: &[Decision; ROBOTS],
    arrived: [bool; ROBOTS],
    radio: &Radio,
) {
    summary.hops += radio.hops;
    summary.jammed += radio.jammed;
    for robot in 0..ROBOTS {
        let (plant, decision) = (&plants[robot], &decisions[robot]);
        summary.arrived += u32::from(arrived[robot]);
        summary.lost += u32::from(!arrived[robot]);
        summary.warnings += u32::from(!decision.holds);
        let inside = plant.position.iter().all(|p| (0.0..=SIDE).contains(p));
        let slow = plant.velocity.iter().all(|v| (-FASTEST..=FASTEST).contains(v));
        let gentle = decision.acceleration.iter().all(|a| (-HARDEST..=HARDEST).contains(a));
        summary.violations += u32::from(!inside) + u32::from(!slow) + u32::from(!gentle);
        for other in &plants[..robot] {
            let off = [0, 1].map(|axis| plant.position[axis] - other.position[axis]);
            summary.closest = summary.closest.min(off[0] * off[0] + off[1] * off[1]);
        }
        for number in [plant.position, plant.velocity, decision.acceleration].into_iter().flatten() {
            summary.mix(number);
        }
    }
}

/// Counts how long each goal was not met.
fn wait(summary: &mut Summary, waiting: &mut [u32; 2], plants: &[Plant; ROBOTS]) {
    let within = |plant: &Plant, region: &[[f64; 2]; 2]| {
        (0..2).all(|axis| (region[0][axis]..=region[1][axis]).contains(&plant.position[axis]))
    };
    let surveyors = plants.iter().filter(|plant| within(plant, &PI2)).count();
    for (goal, met) in [within(&plants[2], &PI1), surveyors == 1].into_iter().enumerate() {
        waiting[goal] = if met { 0 } else { waiting[goal] + 1 };
        summary.waits[goal] = summary.waits[goal].max(waiting[goal]);
    }
}
