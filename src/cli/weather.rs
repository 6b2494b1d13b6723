//! The flags that say how runs are simulated.

use clap::ValueEnum;

use super::args::parse_length;
use crate::simulate;

/// How runs are simulated.
#[derive(clap::Args, Debug, Clone, Copy)]
pub struct Weather {
    /// What all random numbers are made of: the same seed, the same runs
    #[arg(long, default_value_t = 0, value_name = "S", help_heading = "Simulation")]
    pub seed: u64,
    /// How robots are disturbed
    #[arg(long, value_enum, default_value_t = Disturbance::Mixed, value_name = "KIND", help_heading = "Simulation")]
    pub disturbance: Disturbance,
    /// Scale disturbances by so much about their middle: beyond 1 the plan promises nothing
    #[arg(long, default_value_t = 1.0, value_name = "F", value_parser = parse_scale, help_heading = "Simulation")]
    pub exceed: f64,
    /// Steps of each run; left out, the plan and three rounds of its loop, and at least 60
    #[arg(long, value_name = "N", value_parser = parse_length, help_heading = "Simulation")]
    pub steps: Option<usize>,
}

/// How robots are disturbed.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Disturbance {
    /// All of those below, runs in turn
    Mixed,
    /// Anywhere that is allowed, independently at each step
    Uniform,
    /// As far as is allowed, to random sides at each step
    Vertex,
    /// As far as is allowed, always to the side that is worst for the plan
    Held,
    /// As far as is allowed, at each step to the side that leaves least
    Adversarial,
    /// By the very sequence that uses up most of what the plan leaves
    Aimed,
}

impl Disturbance {
    /// The kinds that runs take in turn.
    pub fn kinds(self) -> Vec<simulate::Disturbance> {
        match self {
            Disturbance::Mixed => simulate::Disturbance::ALL.to_vec(),
            Disturbance::Uniform => vec![simulate::Disturbance::Uniform],
            Disturbance::Vertex => vec![simulate::Disturbance::Vertex],
            Disturbance::Held => vec![simulate::Disturbance::Held],
            Disturbance::Adversarial => vec![simulate::Disturbance::Adversarial],
            Disturbance::Aimed => vec![simulate::Disturbance::Aimed],
        }
    }
}

/// A number of at least 0
fn parse_scale(text: &str) -> Result<f64, String> {
    let scale = text.trim().parse::<f64>().ok().filter(|x| (0.0..=1e6).contains(x));
    scale.ok_or_else(|| "it must be a number from 0 to 1000000".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_finite_and_not_negative() {
        assert_eq!((parse_scale("1.3"), parse_scale("0")), (Ok(1.3), Ok(0.0)));
        for bad in ["", "-1", "NaN", "inf", "1e7", "x"] {
            assert!(parse_scale(bad).is_err(), "{bad}");
        }
    }
}
