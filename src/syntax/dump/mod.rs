//! The tree as text, for tests: one line a declaration or item, nested parts in brackets.
//!
//! The form is stable and tells all that the tree holds but the places.

mod formula;
mod value;

use crate::syntax::ast::{
    Broken, Connectivity, ConnectivityKind, Doc, DynamicsItem, DynamicsKind, FamilyName, File, Item,
    ItemKind, Name, Signal, State,
};

/// The tree of a file as text.
pub fn dump(file: &File) -> String {
    let mut out = String::new();
    doc_line(&mut out, "//! ", file.doc.as_ref());
    for item in &file.items {
        self::item(&mut out, item);
    }
    for Broken { keyword, name, .. } in &file.broken {
        let name = name.as_ref().map_or("?", |n| n.text.as_str());
        out.push_str(&format!("broken {keyword} {name}\n"));
    }
    if !file.stray_docs.is_empty() {
        out.push_str(&format!("stray-docs {}\n", file.stray_docs.len()));
    }
    out
}

fn doc_line(out: &mut String, mark: &str, doc: Option<&Doc>) {
    for line in doc.iter().flat_map(|d| d.text.split('\n')) {
        out.push_str(mark);
        out.push_str(line);
        out.push('\n');
    }
}

fn item(out: &mut String, item: &Item) {
    doc_line(out, "/// ", item.doc.as_ref());
    match &item.kind {
        ItemKind::Edition(number) => out.push_str(&format!("edition {}", number.value)),
        ItemKind::Mission(name) => words(out, "mission", name),
        ItemKind::Param { name, value } => {
            words(out, "param", name);
            value::spaced(out, value);
        }
        ItemKind::Let { name, value } => {
            words(out, "let", name);
            value::spaced(out, value);
        }
        ItemKind::Separation(length) => {
            out.push_str("separation");
            value::spaced(out, length);
        }
        ItemKind::Horizon { from, to } => {
            out.push_str("horizon");
            value::spaced(out, from);
            value::spaced(out, to);
        }
        ItemKind::Minimize(what) => words(out, "minimize", what),
        ItemKind::Goal { name, formula } => {
            words(out, "goal", name);
            formula::spaced(out, formula);
        }
        ItemKind::Define { name, formula } => {
            words(out, "define", name);
            formula::spaced(out, formula);
        }
        ItemKind::Team { name, members } => {
            words(out, "team", name);
            value::set(out, members);
        }
        ItemKind::Connectivity(connectivity) => self::connectivity(out, connectivity),
        ItemKind::Dynamics { name, items } => {
            words(out, "dynamics", name);
            dynamics_items(out, items, 1);
        }
        _ => placed(out, &item.kind),
    }
    out.push('\n');
}

/// The declarations of things in the workspace.
fn placed(out: &mut String, kind: &ItemKind) {
    match kind {
        ItemKind::Workspace(shape) => {
            out.push_str("workspace");
            value::shape(out, shape);
        }
        ItemKind::Region { name, shape } => {
            family(out, "region", name);
            value::shape(out, shape);
        }
        ItemKind::Obstacle { opaque, name, shape } => {
            family(out, if *opaque { "opaque obstacle" } else { "obstacle" }, name);
            value::shape(out, shape);
        }
        ItemKind::Jammer { name, shape } => {
            family(out, "jammer", name);
            value::shape(out, shape);
        }
        ItemKind::Base { name, at } => {
            family(out, "base", name);
            value::point(out, at);
        }
        ItemKind::Robot { name, dynamics, at } => {
            family(out, "robot", name);
            out.push_str(": ");
            out.push_str(&dynamics.text);
            state(out, at);
        }
        _ => {}
    }
}

fn words(out: &mut String, keyword: &str, name: &Name) {
    out.push_str(keyword);
    out.push(' ');
    out.push_str(&name.text);
}

fn family(out: &mut String, keyword: &str, family: &FamilyName) {
    words(out, keyword, &family.name);
    for range in &family.indices {
        out.push_str(" [");
        value::index_range(out, range);
        out.push(']');
    }
}

fn state(out: &mut String, state: &State) {
    match state {
        State::Position(point) => value::point(out, point),
        State::Full { entries, .. } => {
            out.push_str(" {");
            for (i, (name, expression)) in entries.iter().enumerate() {
                words(out, if i == 0 { "" } else { "," }, name);
                out.push_str(" =");
                value::spaced(out, expression);
            }
            out.push_str(" }");
        }
    }
}

fn connectivity(out: &mut String, connectivity: &Connectivity) {
    out.push_str("connectivity");
    let items = match connectivity {
        Connectivity::None => {
            out.push_str(" none");
            return;
        }
        Connectivity::Items(items) => items,
    };
    for item in items {
        let (word, value, norm) = match &item.kind {
            ConnectivityKind::Hops(value) => ("hops", value, &None),
            ConnectivityKind::Range { length, norm } => ("range", length, norm),
            ConnectivityKind::Redundancy(value) => ("redundancy", value, &None),
            ConnectivityKind::Every(value) => ("every", value, &None),
        };
        out.push_str(&format!("\n  {word}"));
        value::spaced(out, value);
        value::norm(out, norm.as_ref());
    }
}

fn dynamics_items(out: &mut String, items: &[DynamicsItem], depth: usize) {
    for item in items {
        for line in item.doc.iter().flat_map(|d| d.text.split('\n')) {
            out.push_str(&format!("\n{:width$}/// {line}", "", width = 2 * depth));
        }
        out.push_str(&format!("\n{:width$}", "", width = 2 * depth));
        dynamics_item(out, &item.kind, depth);
    }
}

fn dynamics_item(out: &mut String, kind: &DynamicsKind, depth: usize) {
    match kind {
        DynamicsKind::Step(value) => keyed(out, "step", value),
        DynamicsKind::State(signals) => self::signals(out, "state", signals),
        DynamicsKind::Input(signals) => self::signals(out, "input", signals),
        DynamicsKind::Position(names) => listed(out, "position", names),
        DynamicsKind::Matrix { letter, value } => keyed(out, &letter.text, value),
        DynamicsKind::Continuous => out.push_str("continuous"),
        DynamicsKind::Integrator(order) => keyed(out, "integrator", order),
        DynamicsKind::Bound { names, interval } => {
            listed(out, "bound", names);
            value::interval(out, interval);
        }
        DynamicsKind::BoundWhere(inequalities) => {
            out.push_str("bound");
            value::inequalities(out, inequalities);
        }
        DynamicsKind::Disturbance { names, interval } => {
            listed(out, "disturbance", names);
            value::interval(out, interval);
        }
        DynamicsKind::Rejection(share) => keyed(out, "rejection", share),
        DynamicsKind::Mode { name, when, items } => {
            words(out, "mode", name);
            value::inequalities(out, when);
            dynamics_items(out, items, depth + 1);
        }
    }
}

fn keyed(out: &mut String, keyword: &str, value: &crate::syntax::ast::Expr) {
    out.push_str(keyword);
    value::spaced(out, value);
}

fn listed(out: &mut String, keyword: &str, names: &[Name]) {
    out.push_str(keyword);
    for name in names {
        out.push(' ');
        out.push_str(&name.text);
    }
}

fn signals(out: &mut String, keyword: &str, signals: &[Signal]) {
    out.push_str(keyword);
    for signal in signals {
        out.push_str(&format!(" {}:", signal.name.text));
        value::unit(out, &signal.unit);
        if let Some(doc) = &signal.doc {
            out.push_str(&format!(" /*{}*/", doc.text.replace('\n', " | ")));
        }
    }
}
