//! Windows of temporal operators, in steps or in times.

use crate::check::expression::{Scope, Value};
use crate::check::settings::MAX_STEPS;
use crate::check::{Checker, messages, typed};
use crate::diag::Reported;
use crate::exact::Rational;
use crate::quantity::Dimension;
use crate::source::Span;
use crate::syntax::ast;

impl Checker<'_> {
    /// A window in steps; both ends are steps or both are times, and 0 is either.
    pub(super) fn window(&mut self, window: &ast::Window, scope: &Scope) -> Result<typed::Window, Reported> {
        let from = self.evaluate(&window.from, scope);
        let to = self.evaluate(&window.to, scope);
        let (from, to) = (from?, to?);
        let times = [(&from, window.from.span), (&to, window.to.span)].map(|(v, s)| self.is_time(v, s));
        let [from_time, to_time] = times;
        let (m, n) = match (from_time?, to_time?) {
            (false, false) => (from.number, to.number),
            (true, true) => self.steps(window.span, from.number, to.number)?,
            (false, true) if from.number.is_zero() => self.steps(window.span, from.number, to.number)?,
            (true, false) if to.number.is_zero() => self.steps(window.span, from.number, to.number)?,
            _ => return Err(self.report(messages::mixed_window(window.span))),
        };
        for (number, span) in [(&m, window.from.span), (&n, window.to.span)] {
            if !number.is_integer() {
                return Err(self.report(messages::not_whole(span, number)));
            }
            if number.is_negative() {
                return Err(self.report(messages::negative_window(span, number)));
            }
        }
        if m > n {
            return Err(self.report(messages::reversed_window(window, &m, &n)));
        }
        let short = |number: &Rational| number.to_i64().filter(|n| *n <= MAX_STEPS);
        match (short(&m), short(&n)) {
            (Some(m), Some(n)) => {
                let steps = (m as u32, n as u32);
                self.note_steps(window.span, steps);
                Ok(steps)
            }
            _ => Err(self.report(messages::long_window(window.span, MAX_STEPS))),
        }
    }

    fn is_time(&mut self, value: &Value, span: Span) -> Result<bool, Reported> {
        if value.dimension.is_bare() {
            Ok(false)
        } else if value.dimension.agrees(Dimension::TIME) {
            Ok(true)
        } else {
            Err(self.report(messages::wrong_window_dimension(span, value.dimension)))
        }
    }

    /// Times as steps, which must be whole.
    fn steps(&mut self, span: Span, from: Rational, to: Rational) -> Result<(Rational, Rational), Reported> {
        let Some(step) = self.settings.step.clone() else {
            return Err(self.reported(|| messages::missing_robot(span)));
        };
        let (m, n) = (&from / &step, &to / &step);
        if m.is_integer() && n.is_integer() {
            return Ok((m, n));
        }
        Err(self.report(messages::window_between_steps(span, (&m, &n), &step)))
    }
}
