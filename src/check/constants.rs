//! Parameters and lets: evaluated once, in the order in which they need each other.

use crate::check::expression::{Scope, Value, is_table, mentioned};
use crate::check::names::Kind;
use crate::check::order::dependency_order;
use crate::check::{Checker, Entry, messages};
use crate::diag::{Diagnostics, Reported};
use crate::source::{SourceFile, Span};
use crate::syntax::ast::{Expr, File, ItemKind, Name};

/// The value of a `param` or a `let`.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Constant {
    /// A number with its dimension.
    Scalar(Value),
    /// A table's rows, all of the same length.
    Table(Vec<Vec<Value>>),
}

impl Checker<'_> {
    /// Evaluates every parameter and let, with the command line's assignments for parameters.
    pub(super) fn constants(&mut self, set: &[(String, String)]) {
        let file = self.file;
        let mut constants: Vec<(usize, &Name, &Expr)> = Vec::new();
        for (item, declaration) in file.items.iter().enumerate() {
            if let ItemKind::Param { name, value } | ItemKind::Let { name, value } = &declaration.kind {
                constants.push((item, name, value));
            }
        }
        let edges = constants.iter().map(|(_, _, value)| self.mentioned_constants(value, &constants));
        let (order, circles) = dependency_order(&edges.collect::<Vec<_>>());
        for circle in circles {
            let names: Vec<&Name> = circle.iter().map(|&i| constants[i].1).collect();
            let reported = self.report(messages::circle("constant", &names));
            for i in circle {
                self.entries[constants[i].0] = Entry::Constant(Err(reported));
            }
        }
        let assigned = self.assignments(set);
        for i in order {
            let (item, name, value) = constants[i];
            if matches!(self.entries[item], Entry::Constant(Err(_))) {
                continue;
            }
            let mut constant = self.constant(value);
            if let Some((_, text)) = assigned.iter().find(|(n, _)| *n == name.text) {
                constant = constant.and_then(|declared| self.assigned(name, &declared, text));
            }
            self.entries[item] = Entry::Constant(constant);
        }
    }

    fn mentioned_constants(&self, value: &Expr, constants: &[(usize, &Name, &Expr)]) -> Vec<usize> {
        let mut found = Vec::new();
        mentioned(value, |name| {
            let Some(symbol) = self.names.get(&name.text) else { return };
            found.extend(constants.binary_search_by_key(&symbol.item, |c| c.0).ok());
        });
        found
    }

    fn constant(&mut self, value: &Expr) -> Result<Constant, Reported> {
        let scope = Scope::default();
        if !is_table(value) {
            return self.evaluate(value, &scope).map(Constant::Scalar);
        }
        let rows = self.table(value, &scope)?;
        Ok(Constant::Table(rows.into_iter().map(|row| row.into_iter().map(|(v, _)| v).collect()).collect()))
    }

    /// The assignments to parameters that exist; the last one of a name wins.
    fn assignments(&mut self, set: &[(String, String)]) -> Vec<(String, String)> {
        let mut known: Vec<(String, String)> = Vec::new();
        for (name, text) in set {
            match self.names.get(name) {
                Some(symbol) if symbol.kind == Kind::Param => {
                    known.retain(|(n, _)| n != name);
                    known.push((name.clone(), text.clone()));
                }
                Some(symbol) => {
                    self.report(messages::set_not_a_param(name, symbol.kind, symbol.span));
                }
                None => {
                    let near = self.names.nearest(name, &[Kind::Param]).map(str::to_string);
                    self.report(messages::set_unknown_param(name, near.as_deref()));
                }
            }
        }
        known
    }

    /// The value that `--set` gives a parameter, which must measure what the declared one does.
    fn assigned(&mut self, name: &Name, declared: &Constant, text: &str) -> Result<Constant, Reported> {
        let Constant::Scalar(declared) = declared else {
            return Err(self.report(messages::set_table(name)));
        };
        let mut value = self.assigned_value(name, text)?;
        if value.dimension.is_bare() {
            value.dimension = declared.dimension;
        } else if !value.dimension.agrees(declared.dimension) {
            let message = messages::set_wrong_dimension(name, text, value.dimension, declared.dimension);
            return Err(self.report(message));
        }
        Ok(Constant::Scalar(value))
    }

    /// Parses and evaluates an assignment's text, whose own places mean nothing in the mission.
    fn assigned_value(&mut self, name: &Name, text: &str) -> Result<Value, Reported> {
        let expr = match crate::syntax::parse_expression(text) {
            Ok(expr) => expr,
            Err(error) => return Err(self.report(messages::set_invalid(name, text, &error.message))),
        };
        let source = SourceFile::new("--set", text);
        let file = File {
            doc: None,
            items: Vec::new(),
            stray_docs: Vec::new(),
            broken: Vec::new(),
            span: Span::new(0, text.len()),
        };
        let mut inner = Diagnostics::new();
        let value = Checker::new(&file, &source, &mut inner).evaluate(&expr, &Scope::default());
        value.map_err(|_| {
            let reason = inner.iter().next().map_or("it is no expression", |d| d.message.as_str());
            self.report(messages::set_invalid(name, text, reason))
        })
    }
}
