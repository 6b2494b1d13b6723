//! What happened to one robot in one run.

use crate::law::tracking::{Assumption, Containment, Status};

/// One robot's run, sample by sample. Rows lie one after the other.
#[derive(Clone, Debug)]
pub struct Way {
    /// n, the number of states.
    pub n: usize,
    /// m, the number of inputs.
    pub m: usize,
    /// The state at each sample: n numbers each.
    pub states: Vec<f64>,
    /// The input from each sample to the next: m numbers each.
    pub inputs: Vec<f64>,
    /// The disturbance from each sample to the next: n numbers each.
    pub pushes: Vec<f64>,
    /// What the monitor said at each sample.
    pub reports: Vec<Report>,
}

impl Way {
    /// Room for so many samples.
    pub(super) fn new(n: usize, m: usize, samples: usize) -> Way {
        let reports = vec![Report::default(); samples];
        Way {
            n,
            m,
            states: vec![0.0; n * samples],
            inputs: vec![0.0; m * samples],
            pushes: vec![0.0; n * samples],
            reports,
        }
    }

    /// The number of samples.
    pub fn samples(&self) -> usize {
        self.reports.len()
    }

    /// The state at a sample.
    pub fn state(&self, sample: usize) -> &[f64] {
        &self.states[sample * self.n..(sample + 1) * self.n]
    }

    /// The input from a sample to the next.
    pub fn input(&self, sample: usize) -> &[f64] {
        &self.inputs[sample * self.m..(sample + 1) * self.m]
    }

    /// The disturbance from a sample to the next.
    pub fn push(&self, sample: usize) -> &[f64] {
        &self.pushes[sample * self.n..(sample + 1) * self.n]
    }

    /// The first sample at which the monitor said that more happened than was assumed.
    pub fn first_excess(&self) -> Option<usize> {
        self.reports.iter().position(Report::is_excess)
    }
}

/// What the monitor said at a sample, as far as it is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// Whether the last step agreed with what is assumed of disturbances.
    pub word: Word,
    /// Whether the robot is in its tube.
    pub place: Place,
    /// With [`Word::Exceeded`]: which state.
    pub component: u16,
    /// With [`Word::Exceeded`]: by how much, in that state's unit.
    pub amount: f64,
}

/// What the monitor says of the last step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Word {
    /// It agrees with the assumption.
    Within,
    /// It was disturbed more than assumed.
    Exceeded,
    /// The measurement was no number.
    NotANumber,
}

/// Where the monitor sees the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In its tube.
    Inside,
    /// In it again.
    Returned,
    /// Perhaps outside.
    Unproved,
    /// Outside.
    Outside,
}

impl Default for Report {
    fn default() -> Report {
        Report { word: Word::Within, place: Place::Inside, component: 0, amount: 0.0 }
    }
}

impl Report {
    pub(super) fn new<R: super::size::Number>(status: &Status<R>) -> Report {
        let place = match &status.containment {
            Containment::Inside => Place::Inside,
            Containment::Returned => Place::Returned,
            Containment::Unproved => Place::Unproved,
            Containment::Outside(_) => Place::Outside,
        };
        let index = |component: usize| u16::try_from(component).unwrap_or(u16::MAX);
        match &status.assumption {
            Assumption::Within => Report { place, ..Report::default() },
            Assumption::Exceeded(reading) => Report {
                word: Word::Exceeded,
                place,
                component: index(reading.component),
                amount: reading.amount.double(),
            },
            Assumption::NotANumber { component } => {
                Report { word: Word::NotANumber, place, component: index(*component), amount: 0.0 }
            }
            Assumption::Missing => Report { word: Word::NotANumber, place, ..Report::default() },
        }
    }

    /// Whether more happened than was assumed.
    pub fn is_excess(&self) -> bool {
        self.word != Word::Within
    }
}
