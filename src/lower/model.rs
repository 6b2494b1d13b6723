//! Motion models: integrators become their exact zero-order hold.

use crate::check::typed::{self, Motion};
use crate::exact::{Rational, RationalMatrix};
use crate::ir;

/// The IR's form of a model.
pub(super) fn model(dynamics: &typed::Dynamics) -> ir::Model {
    let (a, b, c, enclosure) = match &dynamics.motion {
        Motion::Matrices { a, b, c, enclosure } => (
            matrix(dynamics.states.len(), dynamics.states.len(), a),
            matrix(dynamics.states.len(), dynamics.inputs.len(), b),
            c.clone(),
            enclosure.clone(),
        ),
        Motion::Integrator { order } => {
            let (a, b, c) = integrator(*order, dynamics.inputs.len(), &dynamics.step);
            (a, b, c, None)
        }
    };
    let none = || ir::Interval { lo: Rational::ZERO, hi: Rational::ZERO };
    ir::Model {
        name: dynamics.name.clone(),
        doc: dynamics.doc.clone(),
        states: dynamics.states.iter().map(signal).collect(),
        inputs: dynamics.inputs.iter().map(signal).collect(),
        position: dynamics.position.clone(),
        a,
        b,
        c,
        enclosure,
        state_bounds: dynamics.state_bounds.iter().map(|b| b.as_ref().map(interval)).collect(),
        input_bounds: dynamics.input_bounds.iter().map(interval).collect(),
        mixed_bounds: dynamics.mixed_bounds.clone(),
        disturbance: dynamics.disturbance.iter().map(|d| d.as_ref().map_or_else(none, interval)).collect(),
        rejection: dynamics.rejection.as_ref().map(|(share, _)| share.clone()),
    }
}

/// The places of a model's parts.
pub(super) fn spans(dynamics: &typed::Dynamics) -> ir::ModelSpans {
    let place = |interval: &Option<typed::Interval>| interval.as_ref().map(|i| i.span);
    ir::ModelSpans {
        name: dynamics.name_span,
        input_matrix: dynamics.input_matrix_span,
        state_bounds: dynamics.state_bounds.iter().map(place).collect(),
        input_bounds: dynamics.input_bounds.iter().map(|i| i.span).collect(),
        disturbance: dynamics.disturbance.iter().map(place).collect(),
        rejection: dynamics.rejection.as_ref().map(|(_, span)| *span),
    }
}

fn signal(signal: &typed::Signal) -> ir::Signal {
    ir::Signal { name: signal.name.clone(), doc: signal.doc.clone(), unit: signal.unit.clone() }
}

fn interval(interval: &typed::Interval) -> ir::Interval {
    ir::Interval { lo: interval.lo.clone(), hi: interval.hi.clone() }
}

fn matrix(rows: usize, columns: usize, entries: &[Vec<Rational>]) -> RationalMatrix {
    RationalMatrix::from_row_iterator(rows, columns, entries.iter().flatten().cloned())
}

/// One chain of `order` integrators for each of `axes` inputs, held over steps of T:
/// A[i][j] = T^(j−i)/(j−i)! above the diagonal and B[i] = T^(N−i)/(N−i)!, chain by chain.
fn integrator(order: usize, axes: usize, step: &Rational) -> (RationalMatrix, RationalMatrix, Vec<Rational>) {
    let n = order * axes;
    let mut a = RationalMatrix::from_element(n, n, Rational::ZERO);
    let mut b = RationalMatrix::from_element(n, axes, Rational::ZERO);
    let weights = weights(order, step);
    for axis in 0..axes {
        for i in 0..order {
            let row = axis * order + i;
            for j in i..order {
                a[(row, axis * order + j)] = weights[j - i].clone();
            }
            b[(row, axis)] = weights[order - i].clone();
        }
    }
    (a, b, vec![Rational::ZERO; n])
}

/// T^k / k! for k = 0 … `most`.
fn weights(most: usize, step: &Rational) -> Vec<Rational> {
    let mut weights = vec![Rational::ONE];
    for k in 1..=most {
        let next = &weights[k - 1] * step / Rational::from(k as i64);
        weights.push(next);
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_double_integrator_is_the_papers_rover() {
        let (a, b, c) = integrator(2, 2, &Rational::ratio(1, 2));
        let text = |m: &RationalMatrix| {
            let rows = m.row_iter().map(|r| r.iter().map(|x| x.to_string()).collect::<Vec<_>>().join(" "));
            rows.collect::<Vec<_>>().join("; ")
        };
        assert_eq!(text(&a), "1 0.5 0 0; 0 1 0 0; 0 0 1 0.5; 0 0 0 1");
        assert_eq!(text(&b), "0.125 0; 0.5 0; 0 0.125; 0 0.5");
        assert_eq!(c.len(), 4);
    }

    #[test]
    fn a_triple_integrator_has_cubes_and_sixths() {
        let (a, b, _) = integrator(3, 1, &Rational::from(2));
        assert_eq!(a[(0, 2)], Rational::from(2));
        assert_eq!(b[(0, 0)], Rational::ratio(4, 3));
        assert_eq!(b[(2, 0)], Rational::from(2));
    }
}
