//! Places in the source of what the IR holds, for the diagnostics of later phases.

use crate::source::Span;

/// Side tables, each indexed as the problem's own table of the same name.
#[derive(Clone, Debug, Default)]
pub struct Spans {
    /// The `workspace` declaration.
    pub workspace: Span,
    /// Each region's declaration.
    pub regions: Vec<Span>,
    /// Each blocker's declaration.
    pub blockers: Vec<Span>,
    /// Each base's declaration.
    pub bases: Vec<Span>,
    /// Each model's parts.
    pub models: Vec<ModelSpans>,
    /// Each robot's declaration.
    pub robots: Vec<Span>,
    /// Each goal's declaration.
    pub goals: Vec<Span>,
    /// The `separation` declaration.
    pub separation: Option<Span>,
}

/// The places of a model's parts.
#[derive(Clone, Debug, Default)]
pub struct ModelSpans {
    /// The model's name.
    pub name: Span,
    /// What says B (the `B = …` item, or `integrator`).
    pub input_matrix: Span,
    /// Each state's bound, where there is one.
    pub state_bounds: Vec<Option<Span>>,
    /// Each input's bound.
    pub input_bounds: Vec<Span>,
    /// Each state's disturbance, where there is one.
    pub disturbance: Vec<Option<Span>>,
    /// The `rejection` item.
    pub rejection: Option<Span>,
}
