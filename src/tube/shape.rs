//! A model's tube: the law e_t = Σ D_i ŵ_{t−1−i}, and the supports of what it can reach.

use std::fmt;

use nalgebra::DMatrix;

use crate::geometry::Zonotope;

/// The tube of a dynamics model with n states and m inputs (theory.md §2).
///
/// Everything that the chain does not explain is called ŵ and assumed to stay in the box Θ'
/// (`center` ± `half_width`). Then the error is in Ω = {Σ D_i w_i : w_i ∈ Θ'} and the feedback in
/// μ(Ω) = {Σ M_i w_i}, for ever. All numbers are meant exactly as they stand.
#[derive(Clone, Debug, PartialEq)]
pub struct Tube {
    /// D_0 … D_{K−1}, n × n each; D_0 is the identity, D_K counts as 0.
    pub d: Vec<DMatrix<f64>>,
    /// M_0 … M_{K−1}, m × n each.
    pub m: Vec<DMatrix<f64>>,
    /// The middle of Θ', n entries: 0, since the mean of Θ moves to the nominal.
    pub center: Vec<f64>,
    /// The half-widths of Θ', n entries, all positive.
    pub half_width: Vec<f64>,
    /// The part of Θ' that is kept for the controller's own rounding, n entries, all positive.
    pub reserve: Vec<f64>,
    /// What is left of Θ' for the plan: |A z_t + B v_t + c + mean − z_{t+1}| may be as large,
    /// component by component; n entries, all positive.
    pub residual_allowance: Vec<f64>,
    /// The share of 𝒰's extent that the feedback was allowed.
    pub beta: f64,
    /// Why that share.
    pub choice: Choice,
}

/// Why a model's feedback has its share β of the inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Choice {
    /// The mission says so.
    Asked,
    /// It is the least that is tried.
    Least,
    /// With the next smaller share the tube would be so many times as wide as with the largest.
    Wider {
        /// The smaller share.
        share: f64,
        /// The factor.
        factor: f64,
    },
    /// With the next smaller share the feedback would not keep the error in bounds.
    TooWeak {
        /// The smaller share.
        share: f64,
    },
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Choice::Asked => write!(f, "as the mission says"),
            Choice::Least => {
                write!(f, "chosen: the smallest that is tried, and the tube is narrow enough with it")
            }
            Choice::Wider { share, factor } => {
                write!(f, "chosen: with {share} the tube would be {factor:.2} times as wide as with 0.9")
            }
            Choice::TooWeak { share } => write!(f, "chosen: {share} is not enough against the disturbance"),
        }
    }
}

/// Matrices row by row.
pub fn rows(matrices: &[DMatrix<f64>]) -> Vec<Vec<Vec<f64>>> {
    let of = |matrix: &DMatrix<f64>| matrix.row_iter().map(|row| row.iter().copied().collect()).collect();
    matrices.iter().map(of).collect()
}

impl Tube {
    /// K, the length of the law's memory.
    pub fn k(&self) -> usize {
        self.d.len()
    }

    /// The support of Ω in a direction of the state space (n entries), rounded to nearest or so.
    pub fn support(&self, direction: &[f64]) -> f64 {
        self.errors().support(direction)
    }

    /// A double that is at least the support of Ω.
    pub fn support_up(&self, direction: &[f64]) -> f64 {
        self.errors().support_up(direction)
    }

    /// The support of μ(Ω) in a direction of the input space (m entries).
    pub fn input_support(&self, direction: &[f64]) -> f64 {
        self.feedback().support(direction)
    }

    /// A double that is at least the support of μ(Ω).
    pub fn input_support_up(&self, direction: &[f64]) -> f64 {
        self.feedback().support_up(direction)
    }

    /// A double that is at least max {direction · (e, μ(e))} over the joint set of errors and
    /// feedbacks; n + m entries.
    pub fn joint_support_up(&self, direction: &[f64]) -> f64 {
        self.zonotope(vec![&self.d, &self.m]).support_up(direction)
    }

    /// A double that is at least the support of Ω's position part; `position` are the model's
    /// position states, the direction has as many entries.
    pub fn position_support_up(&self, position: &[usize], direction: &[f64]) -> f64 {
        self.support_up(&self.lift(position, direction))
    }

    /// The half-width of Ω along one state, rounded up.
    pub fn state_half_width(&self, state: usize) -> f64 {
        self.position_support_up(&[state], &[1.0])
    }

    /// The half-width of μ(Ω) along one input, rounded up.
    pub fn input_half_width(&self, input: usize) -> f64 {
        let mut direction = vec![0.0; self.m.first().map_or(0, DMatrix::nrows)];
        direction[input] = 1.0;
        self.input_support_up(&direction)
    }

    /// A direction over the position states as one over all states.
    fn lift(&self, position: &[usize], direction: &[f64]) -> Vec<f64> {
        let mut lifted = vec![0.0; self.half_width.len()];
        for (&state, &x) in position.iter().zip(direction) {
            lifted[state] = x;
        }
        lifted
    }

    /// Ω.
    pub fn errors(&self) -> Zonotope<'_> {
        self.zonotope(vec![&self.d])
    }

    /// μ(Ω).
    pub fn feedback(&self) -> Zonotope<'_> {
        self.zonotope(vec![&self.m])
    }

    fn zonotope<'a>(&'a self, parts: Vec<&'a [DMatrix<f64>]>) -> Zonotope<'a> {
        Zonotope { parts, center: &self.center, half_width: &self.half_width }
    }
}
