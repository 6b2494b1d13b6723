//! Tubes against closed forms, simulation, and models that have none.

use super::*;
use crate::diag::Diagnostics;
use crate::exact::RationalMatrix;
use crate::ir::sample::{empty, exact, integrators, model};

/// A matrix of so many columns, row by row.
fn matrix(columns: usize, entries: &[f64]) -> RationalMatrix {
    let entries: Vec<_> = entries.iter().map(|&x| exact(x)).collect();
    RationalMatrix::from_row_slice(entries.len() / columns, columns, &entries)
}

fn tube_for(model: Model) -> Result<Tube, Diagnostics> {
    let mut diagnostics = Diagnostics::new();
    let tubes = synthesize(&empty(vec![model], 1000.0), &Spans::default(), &mut diagnostics);
    let first = |tubes: Tubes| tubes.values().next().cloned();
    tubes.ok().and_then(first).ok_or(diagnostics)
}

fn code_for(model: Model) -> &'static str {
    tube_for(model).unwrap_err().iter().next().unwrap().code
}

#[test]
fn chains_of_integrators_have_the_known_half_widths() {
    for (order, input, bounds, expected) in
        [(2, 4.0, &[4.0][..], 0.300), (3, 16.0, &[4.0, 8.0], 0.383), (4, 64.0, &[4.0, 8.0, 40.0], 0.483)]
    {
        let model = integrators(order, input, bounds);
        let tube = tube_for(model.clone()).unwrap();
        let width = tube.state_half_width(0);
        assert!((width - expected).abs() < 0.001, "order {order}: {width}, K = {}", tube.k());
        assert_eq!(width, tube.state_half_width(order), "both axes are alike");
        assert!(tube.input_half_width(0) <= 0.5 * input * 1.0001);
        assert!(admits(&model, &tube));
    }
}

#[test]
fn models_that_inputs_cannot_steer_are_refused() {
    let a = matrix(2, &[1.0, 0.0, 0.0, 1.0]);
    let b = matrix(1, &[1.0, 0.0]);
    assert_eq!(code_for(model(a.clone(), b.clone(), &[(-0.1, 0.1); 2], 1.0)), "dosm::tube::uncontrollable");
    // What forgets by itself need not be steered.
    let nilpotent = matrix(2, &[1.0, 1.0, 0.0, 0.0]);
    assert!(tube_for(model(nilpotent, b, &[(-0.1, 0.1); 2], 1.0)).is_ok());
}
