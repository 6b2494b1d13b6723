//! Motion models: signals, matrices or integrators, bounds, disturbance, rejection.

use crate::check::bounds::Bounds;
use crate::check::expression::Scope;
use crate::check::hold::zero_order_hold;
use crate::check::{Checker, Entry, doc_text, messages, typed};
use crate::diag::{Diagnostic, Reported};
use crate::exact::{Rational, RationalMatrix};
use crate::ir;
use crate::quantity::{Dimension, in_range};
use crate::source::Span;
use crate::syntax::ast::{self, DynamicsItem, DynamicsKind, Expr, Name};

/// The names of a position and its derivatives; a chain has one name less than there are here.
const CHAIN: [&str; 5] = ["p", "v", "a", "j", "s"];
/// The most states or inputs of a model.
const MAX_SIGNALS: usize = 64;

/// The items of a `dynamics` block by what they say; the first of each kind.
#[derive(Default)]
struct Items<'i> {
    step: Option<(&'i DynamicsItem, &'i Expr)>,
    states: Vec<&'i ast::Signal>,
    inputs: Vec<&'i ast::Signal>,
    state_item: Option<&'i DynamicsItem>,
    input_item: Option<&'i DynamicsItem>,
    position: Option<(&'i DynamicsItem, &'i [Name])>,
    a: Option<(&'i DynamicsItem, &'i Expr)>,
    b: Option<(&'i DynamicsItem, &'i Expr)>,
    c: Option<(&'i DynamicsItem, &'i Expr)>,
    integrator: Option<(&'i DynamicsItem, &'i Expr)>,
    rejection: Option<(&'i DynamicsItem, &'i Expr)>,
    mode: Option<&'i DynamicsItem>,
    continuous: Option<&'i DynamicsItem>,
}

/// The signals and the law of motion of a model.
struct Law {
    states: Vec<typed::Signal>,
    inputs: Vec<typed::Signal>,
    position: Vec<usize>,
    motion: typed::Motion,
    input_matrix_span: Span,
}

impl Checker<'_> {
    /// All motion models.
    pub(super) fn declare_dynamics(&mut self) {
        let file = self.file;
        for (index, item) in file.items.iter().enumerate() {
            if let ast::ItemKind::Dynamics { name, items } = &item.kind {
                let dynamics = self.model(name, items, doc_text(&item.doc));
                self.entries[index] = Entry::Dynamics(dynamics.map(|d| self.dynamics.push(d)));
            }
        }
    }

    fn model(
        &mut self,
        name: &Name,
        list: &[DynamicsItem],
        doc: String,
    ) -> Result<typed::Dynamics, Reported> {
        let sorted = self.sort_items(list);
        let (items, complete) = sorted;
        let step = self.step(name, &items);
        let law = self.law(name, &items, step.clone().ok());
        let rejection = self.rejection(&items);
        let law = law?;
        let bounds = self.bounds(list, &law.states, &law.inputs);
        complete?;
        let Bounds { states: state_bounds, inputs: input_bounds, mixed: mixed_bounds, disturbance } = bounds?;
        let input_bounds = self.complete_input_bounds(name, &law.inputs, input_bounds)?;
        Ok(typed::Dynamics {
            name: name.text.clone(),
            doc,
            name_span: name.span,
            step: step?,
            states: law.states,
            inputs: law.inputs,
            position: law.position,
            motion: law.motion,
            input_matrix_span: law.input_matrix_span,
            state_bounds,
            input_bounds,
            mixed_bounds,
            disturbance,
            rejection: rejection?,
        })
    }

    /// Sorts a block's items by kind; `Err` where one is repeated, unknown or not supported.
    fn sort_items<'i>(&mut self, list: &'i [DynamicsItem]) -> (Items<'i>, Result<(), Reported>) {
        let mut items = Items::default();
        let mut complete = Ok(());
        for item in list {
            let first = match &item.kind {
                DynamicsKind::Step(expr) => items.step.replace((item, expr)).map(|f| f.0),
                DynamicsKind::State(signals) => {
                    items.states.extend(signals);
                    items.state_item.get_or_insert(item);
                    None
                }
                DynamicsKind::Input(signals) => {
                    items.inputs.extend(signals);
                    items.input_item.get_or_insert(item);
                    None
                }
                DynamicsKind::Position(names) => items.position.replace((item, names)).map(|f| f.0),
                DynamicsKind::Matrix { letter, value } => match letter.text.as_str() {
                    "A" => items.a.replace((item, value)).map(|f| f.0),
                    "B" => items.b.replace((item, value)).map(|f| f.0),
                    _ => items.c.replace((item, value)).map(|f| f.0),
                },
                DynamicsKind::Integrator(expr) => items.integrator.replace((item, expr)).map(|f| f.0),
                DynamicsKind::Rejection(expr) => items.rejection.replace((item, expr)).map(|f| f.0),
                DynamicsKind::Bound { .. }
                | DynamicsKind::BoundWhere(_)
                | DynamicsKind::Disturbance { .. } => None,
                DynamicsKind::Continuous => items.continuous.replace(item),
                DynamicsKind::Mode { .. } => {
                    complete = Err(self.report(messages::unsupported("a `mode`", item.span)));
                    items.mode = Some(item);
                    None
                }
            };
            if let Some(first) = first {
                complete = Err(self.report(messages::repeated("item", first.span, item.span)));
            }
        }
        (items, complete)
    }

    fn step(&mut self, name: &Name, items: &Items) -> Result<Rational, Reported> {
        let Some((item, expr)) = items.step else {
            return Err(self.report(messages::missing_step(name)));
        };
        let step = self.quantity(expr, &Scope::default(), Dimension::TIME)?;
        if !step.is_positive() {
            return Err(self.report(messages::not_positive(expr.span, "the step", &step)));
        }
        self.settings.steps.push((name.span, item.span, step.clone()));
        Ok(step)
    }

    fn rejection(&mut self, items: &Items) -> Result<Option<(Rational, Span)>, Reported> {
        let Some((item, expr)) = items.rejection else { return Ok(None) };
        let share = self.quantity(expr, &Scope::default(), Dimension::NONE)?;
        if !share.is_positive() || share >= Rational::ONE {
            return Err(self.report(messages::bad_rejection(expr.span, &share)));
        }
        Ok(Some((share, item.span)))
    }

    fn law(&mut self, name: &Name, items: &Items, step: Option<Rational>) -> Result<Law, Reported> {
        if let Some((item, order)) = items.integrator {
            return self.integrator(item, order, items, step);
        }
        let states = self.signals(&items.states, &[]);
        let inputs = self.signals(&items.inputs, &items.states);
        let mut missing = Vec::new();
        for (absent, what) in [
            (items.state_item.is_none(), "`state`"),
            (items.input_item.is_none(), "`input`"),
            (items.position.is_none(), "`position`"),
            (items.a.is_none() && items.mode.is_none(), "`A`"),
            (items.b.is_none() && items.mode.is_none(), "`B`"),
        ] {
            missing.extend(absent.then_some(what));
        }
        let (Some((position_item, position)), Some(a), Some(b)) = (items.position, items.a, items.b) else {
            if missing.is_empty() {
                // Modes have matrices of their own; that there are modes has been reported.
                return Err(self.reported(|| messages::missing_items(name, &["`A`", "`B`"])));
            }
            return Err(self.report(messages::missing_items(name, &missing)));
        };
        if !missing.is_empty() {
            return Err(self.report(messages::missing_items(name, &missing)));
        }
        let (states, inputs) = (states?, inputs?);
        let position = self.position(position, position_item.span, &states);
        let state_dimensions: Vec<Dimension> = states.iter().map(|s| s.dimension).collect();
        let input_dimensions: Vec<Dimension> = inputs.iter().map(|s| s.dimension).collect();
        let rate = |d: &Dimension| if items.continuous.is_some() { d.per(Dimension::TIME) } else { Some(*d) };
        let rows: Vec<Dimension> = state_dimensions.iter().map(|d| rate(d).unwrap_or_default()).collect();
        let square = self.matrix("A", a.1, &rows, &state_dimensions);
        let wide = self.matrix("B", b.1, &rows, &input_dimensions);
        let offset = items.c.map(|(_, expr)| self.column(expr, &rows)).transpose();
        let c = offset?.unwrap_or_else(|| vec![Rational::ZERO; states.len()]);
        let (a, b_rows) = (square?, wide?);
        let motion = match (items.continuous, step) {
            (None, _) => typed::Motion::Matrices { a, b: b_rows, c, enclosure: None },
            (Some(item), Some(step)) => self.held(item, (&a, &b_rows, &c), &step)?,
            (Some(item), None) => return Err(self.reported(|| messages::stiff_model(item.span))),
        };
        Ok(Law { states, inputs, position: position?, motion, input_matrix_span: b.0.span })
    }

    /// The declared states or inputs; names must differ, from the `others` too.
    fn signals(
        &mut self,
        list: &[&ast::Signal],
        others: &[&ast::Signal],
    ) -> Result<Vec<typed::Signal>, Reported> {
        let mut signals = Vec::new();
        let mut failed = None;
        for (index, signal) in list.iter().enumerate() {
            let earlier = list[..index].iter().chain(others).find(|s| s.name.text == signal.name.text);
            if let Some(first) = earlier {
                failed = Some(self.report(messages::duplicate_signal(&signal.name, first.name.span)));
            }
            match self.signal(signal) {
                Ok(signal) => signals.push(signal),
                Err(reported) => failed = Some(reported),
            }
        }
        if list.len() > MAX_SIGNALS {
            let span = list[MAX_SIGNALS].name.span;
            failed = Some(self.report(messages::too_many_parts(span, list.len(), MAX_SIGNALS)));
        }
        failed.map_or(Ok(signals), Err)
    }

    fn signal(&mut self, signal: &ast::Signal) -> Result<typed::Signal, Reported> {
        let unit = self.unit(&signal.unit)?;
        if !unit.is_coherent() {
            return Err(self.report(messages::incoherent_unit(signal.unit.span, unit.dimension)));
        }
        let text = self.source.slice(signal.unit.span);
        Ok(typed::Signal {
            name: signal.name.text.clone(),
            doc: doc_text(&signal.doc),
            unit: if text.is_empty() { unit.dimension.to_string() } else { text.to_string() },
            dimension: unit.dimension,
        })
    }

    fn position(
        &mut self,
        names: &[Name],
        span: Span,
        states: &[typed::Signal],
    ) -> Result<Vec<usize>, Reported> {
        let mut position = Vec::new();
        for name in names {
            let Some(index) = states.iter().position(|s| s.name == name.text) else {
                return Err(self.report(messages::unknown_signal(name, "state", states.iter())));
            };
            if !states[index].dimension.agrees(Dimension::LENGTH) {
                let message =
                    messages::wrong_dimension(name.span, states[index].dimension, Dimension::LENGTH);
                return Err(self.report(message));
            }
            if position.contains(&index) {
                return Err(self.report(messages::repeated_position(name)));
            }
            position.push(index);
        }
        if position.len() != self.dimension {
            return Err(self.report(messages::wrong_position_count(span, position.len(), self.dimension)));
        }
        Ok(position)
    }

    /// A matrix whose entry (i, j) measures row i's dimension per column j's.
    fn matrix(
        &mut self,
        letter: &str,
        expr: &Expr,
        rows: &[Dimension],
        columns: &[Dimension],
    ) -> Result<Vec<Vec<Rational>>, Reported> {
        let table = self.table(expr, &Scope::default())?;
        let (height, width) = (table.len(), table.first().map_or(0, Vec::len));
        if (height, width) != (rows.len(), columns.len()) {
            let (found, wanted) = ((height, width), (rows.len(), columns.len()));
            return Err(self.report(messages::wrong_matrix_size(expr.span, letter, found, wanted)));
        }
        let mut matrix = Vec::new();
        for (row, row_dimension) in table.into_iter().zip(rows) {
            let mut entries = Vec::new();
            for ((value, span), column_dimension) in row.into_iter().zip(columns) {
                let expected = row_dimension.per(*column_dimension).unwrap_or_default();
                entries.push(self.expect_dimension(value, span, expected)?);
            }
            matrix.push(entries);
        }
        Ok(matrix)
    }

    /// c, written as a row or as a column.
    fn column(&mut self, expr: &Expr, rows: &[Dimension]) -> Result<Vec<Rational>, Reported> {
        let table = self.table(expr, &Scope::default())?;
        let (height, width) = (table.len(), table.first().map_or(0, Vec::len));
        let flat: Vec<_> = table.into_iter().flatten().collect();
        if flat.len() != rows.len() || (height != 1 && width != 1) {
            let message = messages::wrong_matrix_size(expr.span, "c", (height, width), (rows.len(), 1));
            return Err(self.report(message));
        }
        flat.into_iter().zip(rows).map(|((v, span), d)| self.expect_dimension(v, span, *d)).collect()
    }

    fn integrator(
        &mut self,
        item: &DynamicsItem,
        order: &Expr,
        items: &Items,
        step: Option<Rational>,
    ) -> Result<Law, Reported> {
        let clash: Vec<(&DynamicsItem, &str)> = [
            (items.state_item, "state"),
            (items.input_item, "input"),
            (items.position.map(|p| p.0), "position"),
            (items.a.map(|a| a.0), "A"),
            (items.b.map(|b| b.0), "B"),
            (items.c.map(|c| c.0), "c"),
            (items.continuous, "continuous"),
        ]
        .into_iter()
        .filter_map(|(item, what)| Some((item?, what)))
        .collect();
        if let Some((other, what)) = clash.first() {
            return Err(self.report(messages::integrator_clash(item.span, other.span, what)));
        }
        let number = self.whole(order, &Scope::default())?;
        let Some(length) = usize::try_from(number).ok().filter(|n| (1..CHAIN.len()).contains(n)) else {
            return Err(self.report(messages::bad_order(order.span, number, CHAIN.len() - 1)));
        };
        let (states, inputs) = self.chains(length);
        if step.is_some_and(|step| !has_powers(&step, length)) {
            return Err(self.report(messages::number_out_of_range(item.span)));
        }
        let position = (0..self.dimension).map(|axis| axis * length).collect();
        let motion = typed::Motion::Integrator { order: length };
        Ok(Law { states, inputs, position, motion, input_matrix_span: item.span })
    }

    /// The states and inputs of one chain of integrators an axis.
    fn chains(&self, order: usize) -> (Vec<typed::Signal>, Vec<typed::Signal>) {
        let signal = |axis: &str, derivative: usize| {
            let time = Dimension::TIME.power(derivative as i64, 1).unwrap_or_default();
            let dimension = Dimension::LENGTH.per(time).unwrap_or_default();
            let name = format!("{}{axis}", CHAIN[derivative]);
            typed::Signal { name, doc: String::new(), unit: dimension.to_string(), dimension }
        };
        let axes = ["x", "y", "z"].iter().take(self.dimension);
        let states = axes.clone().flat_map(|axis| (0..order).map(move |d| (axis, d)));
        (states.map(|(a, d)| signal(a, d)).collect(), axes.map(|axis| signal(axis, order)).collect())
    }

    /// The zero-order hold of dx/dt = A x + B u + c.
    fn held(
        &mut self,
        item: &DynamicsItem,
        (a, b, c): (&[Vec<Rational>], &[Vec<Rational>], &[Rational]),
        step: &Rational,
    ) -> Result<typed::Motion, Reported> {
        let (n, m) = (a.len(), b.first().map_or(0, Vec::len));
        let entries = a.iter().zip(b).zip(c).flat_map(|((a, b), c)| a.iter().chain(b).chain([c]).cloned());
        let rates = RationalMatrix::from_row_iterator(n, n + m + 1, entries);
        let Some(hold) = zero_order_hold(&rates, step) else {
            return Err(self.report(messages::stiff_model(item.span)));
        };
        let rows = |columns: std::ops::Range<usize>| -> Vec<Vec<Rational>> {
            (0..n).map(|i| columns.clone().map(|j| hold.value[(i, j)].clone()).collect()).collect()
        };
        let enclosure = hold.error.as_ref().map(|error| ir::Enclosure {
            a: error.columns(0, n).into_owned(),
            b: error.columns(n, m).into_owned(),
            c: error.column(n + m).iter().cloned().collect(),
        });
        let c = hold.value.column(n + m).iter().cloned().collect();
        Ok(typed::Motion::Matrices { a: rows(0..n), b: rows(n..n + m), c, enclosure })
    }

    fn complete_input_bounds(
        &mut self,
        name: &Name,
        inputs: &[typed::Signal],
        bounds: Vec<Option<typed::Interval>>,
    ) -> Result<Vec<typed::Interval>, Reported> {
        let unbounded: Vec<&str> =
            inputs.iter().zip(&bounds).filter(|(_, b)| b.is_none()).map(|(i, _)| i.name.as_str()).collect();
        if !unbounded.is_empty() {
            let message: Diagnostic = messages::missing_bound(name, &unbounded);
            return Err(self.report(message));
        }
        Ok(bounds.into_iter().flatten().collect())
    }
}

/// Whether T … T^order / order! are all in range, as the exact zero-order hold needs them.
fn has_powers(step: &Rational, order: usize) -> bool {
    let mut power = Rational::ONE;
    (1..=order as i64).all(|k| {
        power = &power * step / Rational::from(k);
        in_range(&power)
    })
}
