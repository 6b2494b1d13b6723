//! `src/dynamics.rs`: states, inputs and the feedback's tables, a module for each motion model.

use std::fmt::Write;

use super::words::{code, doc, literal, plain};
use super::{Contents, ModelPart};
use crate::ir::Signal;
use crate::law::Float;
use crate::law::tracking::Bounds;

/// What the file begins with.
const HEAD: &str = "\
//! The motion models: what is measured, what is given out, and the tables of the feedback.

// The tables are numbers as they come, not constants of nature.
#![allow(clippy::approx_constant, clippy::excessive_precision, clippy::unreadable_literal)]
// The mission's own words are plain text.
#![allow(clippy::doc_markdown)]
";

/// The whole file.
pub(super) fn file(contents: &Contents<'_>) -> String {
    let mut text = format!("{HEAD}\n{}", contents.stamp());
    for (at, part) in contents.models.iter().enumerate() {
        text.push('\n');
        module(&mut text, contents, at, part);
    }
    text
}

fn module(text: &mut String, contents: &Contents<'_>, at: usize, part: &ModelPart<'_>) {
    let model = &contents.problem.models[part.id];
    let names = &contents.names.models[at];
    let (n, m, k) = (model.n(), model.m(), part.tube.d.len());
    let real = contents.float;
    let mut add = |line: &str| {
        text.push_str(line);
        text.push('\n');
    };
    add(&format!(
        "/// {}: {n} states, {m} inputs; the last {k} disturbances are remembered.",
        code(&model.name)
    ));
    if !model.doc.is_empty() {
        add("///");
        add(doc("/// ", &model.doc).trim_end());
    }
    add(&format!("pub mod {} {{", names.module));
    add("    use crate::law::{Bounds, Tube};\n");
    let state = Struct {
        name: "State",
        what: "A measured state",
        real,
        signals: &model.states,
        fields: &names.states,
    };
    add(&state.text());
    let input =
        Struct { name: "Input", what: "An input", real, signals: &model.inputs, fields: &names.inputs };
    add(&input.text());
    add(&name_list("STATES", "states", &model.states));
    add(&name_list("INPUTS", "inputs", &model.inputs));
    add(&format!("    pub(crate) type Memory = [[{real}; {n}]; {k}];\n"));
    add("    pub(crate) const FORGOTTEN: Memory =");
    add(&format!("        [[0.0; {n}]; {k}];\n"));
    add(&tube(part, real, (n, m)));
    add("}");
}

/// A struct of signals.
struct Struct<'a> {
    name: &'a str,
    what: &'a str,
    real: Float,
    signals: &'a [Signal],
    fields: &'a [String],
}

impl Struct<'_> {
    fn text(&self) -> String {
        let Struct { name, what, real, .. } = self;
        let mut text = format!("    /// {what}.\n    #[derive(Clone, Copy, Debug, Default, PartialEq)]\n");
        let _ = writeln!(text, "    pub struct {name} {{");
        for (signal, field) in self.signals.iter().zip(self.fields) {
            let unit =
                if signal.unit == "1" { "a plain number".into() } else { format!("in {}", signal.unit) };
            let _ = writeln!(text, "        /// {}, {}.", code(&signal.name), plain(&unit));
            if !signal.doc.is_empty() {
                text.push_str("        ///\n");
                text.push_str(&doc("        /// ", &signal.doc));
            }
            let _ = writeln!(text, "        pub {field}: {real},");
        }
        text.push_str("    }\n\n");
        text.push_str(&self.conversions());
        text
    }

    fn conversions(&self) -> String {
        let Struct { name, real, fields, .. } = self;
        let size = fields.len();
        let entries: Vec<String> = fields.iter().map(|f| format!("{}.{f}", name.to_lowercase())).collect();
        let fields = fields.join(", ");
        let entries = entries.join(", ");
        let variable = name.to_lowercase();
        format!(
            "    impl From<{name}> for [{real}; {size}] {{\n        \
             fn from({variable}: {name}) -> Self {{\n            [{entries}]\n        }}\n    }}\n\n    \
             impl From<[{real}; {size}]> for {name} {{\n        \
             fn from([{fields}]: [{real}; {size}]) -> Self {{\n            \
             {name} {{ {fields} }}\n        }}\n    }}\n"
        )
    }
}

fn name_list(constant: &str, what: &str, signals: &[Signal]) -> String {
    let names: Vec<String> = signals.iter().map(|s| literal(&s.name)).collect();
    format!(
        "    /// The names of the {what}, in order.\n    pub const {constant}: [&str; {}] = [{}];\n",
        names.len(),
        names.join(", ")
    )
}

/// The tables of the feedback.
fn tube(part: &ModelPart<'_>, real: Float, (n, m): (usize, usize)) -> String {
    let tables = &part.tables;
    let mut text = String::from("    /// Theory: `errors` are the `D`, `gains` the `M`, a column a line.\n");
    text.push_str("    #[rustfmt::skip]\n");
    let _ =
        writeln!(text, "    pub(crate) static TUBE: Tube<'static, [{real}; {n}], [{real}; {m}]> = Tube {{");
    matrices(&mut text, real, "errors", &tables.errors, (n, 1));
    matrices(&mut text, real, "gains", &tables.gains, (n, 0));
    bounds(&mut text, real, "disturbance", &tables.disturbance);
    let _ = writeln!(text, "        assumed: {},", column(real, &tables.assumed));
    bounds(&mut text, real, "hull", &tables.hull);
    bounds(&mut text, real, "state", &tables.state);
    let _ = writeln!(text, "        state_near: {},", column(real, &tables.state_near));
    bounds(&mut text, real, "input", &tables.input);
    let _ = writeln!(text, "        input_near: {},", column(real, &tables.input_near));
    text.push_str("    };");
    text
}

/// Columns of matrices, each matrix with its number; `first` is the first one's.
fn matrices(text: &mut String, real: Float, name: &str, columns: &[Vec<f64>], (n, first): (usize, usize)) {
    let _ = writeln!(text, "        {name}: &[");
    let letter = if name == "errors" { 'D' } else { 'M' };
    for (number, matrix) in columns.chunks(n.max(1)).enumerate() {
        let _ = writeln!(text, "            // {letter}({})", number + first);
        for entries in matrix {
            let _ = writeln!(text, "            {},", column(real, entries));
        }
    }
    text.push_str("        ],\n");
}

fn bounds(text: &mut String, real: Float, name: &str, bounds: &Bounds<Vec<f64>>) {
    let _ = writeln!(text, "        {name}: Bounds {{");
    let _ = writeln!(text, "            lo: {},", column(real, &bounds.lo));
    let _ = writeln!(text, "            hi: {},", column(real, &bounds.hi));
    text.push_str("        },\n");
}

/// A column as an array.
pub(super) fn column(real: Float, entries: &[f64]) -> String {
    let entries: Vec<String> = entries.iter().map(|x| real.literal(*x)).collect();
    format!("[{}]", entries.join(", "))
}
