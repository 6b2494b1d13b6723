//! Motion models: signals, bounds, and the tube.

use super::{Page, View};
use crate::check::{Facts, typed};
use crate::lsp::index::{Symbol, SymbolKind};
use crate::lsp::number::{half_width, measure, number};
use crate::lsp::tubes::ModelTube;

/// The most states or inputs of which a line is shown.
const MOST_SIGNALS: usize = 16;

impl View<'_> {
    /// A whole model.
    pub(super) fn model(&self, page: &mut Page, facts: &Facts, item: usize) {
        let Some((id, model)) = facts.model(item) else {
            page.say("**dynamics model** that has errors");
            return;
        };
        let robots = facts.robots(None).filter(|(_, robot)| robot.dynamics == id).count();
        let used = if robots == 1 { "1 robot".to_string() } else { format!("{robots} robots") };
        page.say(format!("**dynamics model** of {used}, step {} s", number(&model.step)));
        let tube = self.tubes.of(facts, id, self.document.float());
        page.columns(&table(model, tube.as_deref()));
        match tube {
            Some(tube) => page.say(law(&tube)),
            None => page.say("No tube: the mission has no workspace."),
        }
    }

    /// A state or an input.
    pub(super) fn signal(&self, page: &mut Page, symbol: &Symbol, facts: &Facts, item: usize) {
        let index = self.document.index();
        let owner = symbol.parent.map_or("", |id| index.symbol(id).name.as_str());
        page.say(format!("**{}** of `{owner}`", symbol.kind.noun()));
        let Some((id, model)) = facts.model(item) else { return };
        let tube = self.tubes.of(facts, id, self.document.float());
        let rows = table(model, tube.as_deref());
        let wanted = |row: &&Vec<String>| row.first().is_some_and(|name| *name == symbol.name);
        let signals = if symbol.kind == SymbolKind::Input { model.states.len() + 1 } else { 0 };
        let header = rows.get(signals).cloned();
        page.columns(&header.into_iter().chain(rows.iter().find(wanted).cloned()).collect::<Vec<_>>());
    }
}

/// A line for each state and input, below headings.
fn table(model: &typed::Dynamics, tube: Option<&ModelTube>) -> Vec<Vec<String>> {
    let heading = |words: [&str; 5]| words.map(str::to_string).to_vec();
    let found = tube.and_then(|t| t.tube.as_ref().ok());
    let half = |width: Option<f64>| width.map_or("?".to_string(), |w| format!("± {}", half_width(w)));
    let mut rows = vec![heading(["state", "unit", "bound", "disturbance", "tube"])];
    for (i, state) in model.states.iter().enumerate().take(MOST_SIGNALS) {
        rows.push(vec![
            state.name.clone(),
            state.unit.clone(),
            model.state_bounds.get(i).map_or_else(String::new, interval),
            model.disturbance.get(i).map_or_else(String::new, interval),
            half(found.map(|tube| tube.state_half_width(i))),
        ]);
    }
    rows.push(heading(["input", "unit", "bound", "", "feedback"]));
    for (i, input) in model.inputs.iter().enumerate().take(MOST_SIGNALS) {
        rows.push(vec![
            input.name.clone(),
            input.unit.clone(),
            model.input_bounds.get(i).map_or_else(String::new, |b| interval(&Some(b.clone()))),
            String::new(),
            half(found.map(|tube| tube.input_half_width(i))),
        ]);
    }
    rows
}

fn interval(interval: &Option<typed::Interval>) -> String {
    interval.as_ref().map_or("–".to_string(), |i| format!("[{}, {}]", number(&i.lo), number(&i.hi)))
}

/// What the tube's law takes: the share of the inputs and the memory.
fn law(tube: &ModelTube) -> String {
    match &tube.tube {
        Ok(found) => format!(
            "Feedback: share β = {} of the inputs ({}), memory K = {}",
            measure(found.beta),
            found.choice,
            crate::lsp::number::counted(found.k(), "step"),
        ),
        Err(why) => format!("⚠ **No tube**: {why}"),
    }
}

/// `: tube ± 0.25 m × ± 0.25 m` behind a model's name.
pub(super) fn summary(tube: &ModelTube) -> String {
    match &tube.tube {
        Ok(_) => format!(": tube {}", widths(tube)),
        Err(why) => format!(" has no tube: {why}"),
    }
}

/// `± 0.25 m × ± 0.25 m`, along the axes of the workspace.
pub(super) fn widths(tube: &ModelTube) -> String {
    let axes = (0..tube.model.position.len()).filter_map(|axis| tube.half_width(axis));
    axes.map(|w| format!("± {} m", half_width(w))).collect::<Vec<_>>().join(" × ")
}
