//! Contradictions, proved with outward rounding against the dynamics themselves.
//!
//! A sum of multiples of bounds, Σ λ (b − a · (z, v)) ≥ 0, is refuted by going backwards in time:
//! the coefficient of z_{t+1} moves to z_t and v_t through the dynamics, what is left at v_t is
//! bounded over the input's bounds, what is left at the first state by the start itself or, for a
//! contradiction that holds anywhere, by the bounds on states. If the sum is then below 0 whatever
//! the trajectory, the bounds contradict each other. Every number is an interval that holds the
//! exact one, so rounding can make a proof fail but not succeed.

use nalgebra::DVector;
use rustsat::types::Lit;

use crate::encode::Leaf;
use crate::ir::RobotId;

use super::interval::Interval;
use super::program::Member;
use super::system::System;

/// A linear function of trajectories: a sum of parts.
#[derive(Clone, Debug, Default)]
pub struct Functional {
    /// The parts, each of one robot and step.
    pub parts: Vec<Part>,
}

/// A linear function of one robot's state and input at one step.
#[derive(Clone, Debug)]
pub struct Part {
    /// The robot.
    pub robot: RobotId,
    /// The step.
    pub step: usize,
    /// Coefficients of z.
    pub state: Vec<(usize, f64)>,
    /// Coefficients of v.
    pub input: Vec<(usize, f64)>,
}

/// A bound in a contradiction: `sign · functional ≤ bound`, so many times.
#[derive(Clone, Debug)]
pub struct Term {
    /// The function that is bounded.
    pub functional: Functional,
    /// 1 for an upper bound, −1 for a lower one.
    pub sign: f64,
    /// λ ≥ 0.
    pub multiple: f64,
    /// The bound.
    pub bound: f64,
    /// The candidate's constraint that set the bound; `None` for one that always holds.
    pub constraint: Option<(Lit, Leaf)>,
}

/// The lasso that a contradiction is about.
#[derive(Clone, Copy, Debug)]
pub struct Lasso {
    /// L.
    pub length: usize,
    /// k.
    pub back: usize,
}

/// A sum of bounds that is said to be contradictory.
#[derive(Clone, Debug)]
pub struct Proof {
    /// The bounds.
    pub terms: Vec<Term>,
    /// The lasso.
    pub lasso: Lasso,
}

/// A contradiction that is proved.
#[derive(Clone, Debug)]
pub struct Conflict {
    /// The bounds.
    pub proof: Proof,
    /// Whether it rests on the loop.
    pub uses_loop: bool,
    /// The first step from which it holds wherever the robots are then; `None` when it rests on the
    /// robots' starts.
    pub free_from: Option<usize>,
    /// How far below 0 the sum is at least.
    pub margin: f64,
}

impl Conflict {
    /// A conflict from its proof; `None` when the proof doesn't hold.
    pub fn new(proof: Proof, members: &[Member<'_>]) -> Option<Conflict> {
        let last = proof.lasso.length + 1;
        let is_loop = |t: &Term| t.constraint.is_none() && t.functional.is_loop(proof.lasso);
        let uses_loop = proof.terms.iter().any(is_loop);
        let steps = || proof.terms.iter().flat_map(|t| t.functional.parts.iter().map(|p| p.step));
        let first = steps().min().unwrap_or(0);
        if !uses_loop && first > 0 {
            let margin = -refute(&proof, members, Some(first), last);
            if margin > 0.0 {
                return Some(Conflict { proof, uses_loop, free_from: Some(first), margin });
            }
        }
        let margin = -refute(&proof, members, None, last);
        (margin > 0.0).then_some(Conflict { proof, uses_loop, free_from: None, margin })
    }

    /// A conflict of a robot that starts anywhere; `None` when the proof doesn't hold.
    pub fn free(proof: Proof, members: &[Member<'_>]) -> Option<Conflict> {
        let last = proof.lasso.length + 1;
        let steps = proof.terms.iter().flat_map(|t| t.functional.parts.iter().map(|p| p.step));
        let first = steps.min().unwrap_or(0);
        let margin = -refute(&proof, members, Some(first), last);
        (margin > 0.0).then_some(Conflict { proof, uses_loop: false, free_from: Some(first), margin })
    }

    /// Whether the contradiction still holds with these bounds in place of the constraints' own.
    pub fn holds_with(&self, bounds: &[f64], members: &[Member<'_>]) -> bool {
        let mut proof = self.proof.clone();
        for (term, bound) in proof.terms.iter_mut().zip(bounds) {
            term.bound = *bound;
        }
        refute(&proof, members, self.free_from, self.proof.lasso.length + 1) < 0.0
    }
}

impl Functional {
    /// Whether this is a component of z_{L+1} − z_k.
    fn is_loop(&self, lasso: Lasso) -> bool {
        match &self.parts[..] {
            [a, b] => a.robot == b.robot && a.step == lasso.length + 1 && b.step == lasso.back,
            _ => false,
        }
    }
}

/// An upper bound on Σ λ (b − a · (z, v)) over all trajectories.
fn refute(proof: &Proof, members: &[Member<'_>], free_from: Option<usize>, last: usize) -> f64 {
    let mut total = Interval::ZERO;
    for term in &proof.terms {
        total = total + Interval::point(term.multiple) * Interval::point(term.bound);
    }
    for member in members {
        total = total + trajectory(proof, member, free_from, last);
    }
    if total.hi.is_nan() { f64::INFINITY } else { total.hi }
}

/// The most that one robot's trajectory adds to the sum.
fn trajectory(proof: &Proof, member: &Member<'_>, free_from: Option<usize>, last: usize) -> Interval {
    let system = member.system;
    let first = free_from.unwrap_or(0);
    let mut states = vec![vec![Interval::ZERO; system.n]; last + 1];
    let mut inputs = vec![vec![Interval::ZERO; system.m]; last + 1];
    for term in &proof.terms {
        for part in term.functional.parts.iter().filter(|p| p.robot == member.robot) {
            let factor = Interval::point(-term.sign) * Interval::point(term.multiple);
            for &(s, x) in &part.state {
                states[part.step][s] = states[part.step][s] + factor * Interval::point(x);
            }
            for &(u, x) in &part.input {
                inputs[part.step][u] = inputs[part.step][u] + factor * Interval::point(x);
            }
        }
    }
    let mut total = Interval::ZERO;
    for t in (first..=last).rev() {
        let costate = states[t].clone();
        total = total + most_input(system, &inputs[t]);
        if t > first {
            total = total + step_back(system, &costate, &mut states[t - 1], &mut inputs[t - 1]);
        } else if free_from.is_some() {
            total = total + most_state(system, &costate);
        } else {
            total = total + at_start(&member.start, &costate);
        }
    }
    total
}

/// Moves the coefficient of z_{t+1} to z_t and v_t, and returns what the drift adds.
fn step_back(
    system: &System,
    costate: &[Interval],
    state: &mut [Interval],
    input: &mut [Interval],
) -> Interval {
    let mut drift = Interval::ZERO;
    for (row, &p) in costate.iter().enumerate() {
        if p.is_zero() {
            continue;
        }
        drift = drift + p * system.exact_drift[row];
        for (entry, &a) in state.iter_mut().zip(&system.exact_a[row]) {
            *entry = *entry + p * a;
        }
        for (entry, &b) in input.iter_mut().zip(&system.exact_b[row]) {
            *entry = *entry + p * b;
        }
    }
    drift
}

fn most_input(system: &System, coefficients: &[Interval]) -> Interval {
    let most = coefficients.iter().zip(&system.input_bounds).map(|(c, (lo, hi))| c.most_over(*lo, *hi));
    most.fold(Interval::ZERO, |a, b| a + Interval { lo: f64::NEG_INFINITY, hi: b })
}

fn most_state(system: &System, coefficients: &[Interval]) -> Interval {
    let most = coefficients.iter().zip(&system.state_bounds).map(|(c, (lo, hi))| c.most_over(*lo, *hi));
    most.fold(Interval::ZERO, |a, b| a + Interval { lo: f64::NEG_INFINITY, hi: b })
}

fn at_start(start: &DVector<f64>, coefficients: &[Interval]) -> Interval {
    // The start is a rational rounded to nearest: the exact one lies between its neighbours.
    let exact = |x: f64| Interval { lo: x.next_down(), hi: x.next_up() };
    coefficients.iter().zip(start.iter()).fold(Interval::ZERO, |a, (c, x)| a + *c * exact(*x))
}
