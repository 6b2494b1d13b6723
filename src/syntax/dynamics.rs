//! Building the items of a `dynamics` block.

use crate::syntax::ast::{DynamicsItem, DynamicsKind, Interval, Name, Signal, Unit};
use crate::syntax::builder::Builder;
use crate::syntax::grammar::{Built, Children, Node, Rule};

impl Builder<'_> {
    /// An item of a `dynamics` block or of a mode.
    pub(super) fn dynamics_item(&mut self, node: Node) -> Built<DynamicsItem> {
        let doc = self.doc(&node);
        let span = self.span(&node);
        let node = Children::of(node).expect_any()?;
        let rule = node.as_rule();
        let mut children = Children::of(node);
        let kind = match rule {
            Rule::step => DynamicsKind::Step(self.expression(children.expect(Rule::expression)?)?),
            Rule::state => DynamicsKind::State(self.signals(children)?),
            Rule::input => DynamicsKind::Input(self.signals(children)?),
            Rule::position => DynamicsKind::Position(self.names(children.expect(Rule::names)?)),
            Rule::continuous => DynamicsKind::Continuous,
            Rule::integrator => {
                DynamicsKind::Integrator(self.expression(children.expect(Rule::expression)?)?)
            }
            Rule::bound => self.bound(children)?,
            Rule::disturbance => {
                let names = self.names(children.expect(Rule::names)?);
                DynamicsKind::Disturbance {
                    names,
                    interval: self.interval(children.expect(Rule::interval)?)?,
                }
            }
            Rule::rejection => DynamicsKind::Rejection(self.expression(children.expect(Rule::expression)?)?),
            Rule::mode => {
                let name = self.name(children.expect(Rule::ident)?);
                let when = self.inequalities(children.expect(Rule::inequalities)?)?;
                let items = children.map(|item| self.dynamics_item(item)).collect::<Built<_>>()?;
                DynamicsKind::Mode { name, when, items }
            }
            _ => {
                let letter = self.name(children.expect(Rule::letter)?);
                DynamicsKind::Matrix { letter, value: self.value(children.expect(Rule::value)?)? }
            }
        };
        Ok(DynamicsItem { doc, span, kind })
    }

    fn bound(&mut self, mut children: Children) -> Built<DynamicsKind> {
        if let Some(inequalities) = children.take_if(Rule::inequalities) {
            return self.inequalities(inequalities).map(DynamicsKind::BoundWhere);
        }
        let names = self.names(children.expect(Rule::names)?);
        Ok(DynamicsKind::Bound { names, interval: self.interval(children.expect(Rule::interval)?)? })
    }

    fn signals(&mut self, children: Children) -> Built<Vec<Signal>> {
        children.map(|signal| self.signal(signal)).collect()
    }

    fn signal(&mut self, node: Node) -> Built<Signal> {
        let doc = self.doc(&node);
        let mut children = Children::of(node);
        let name = self.name(children.expect(Rule::ident)?);
        let unit = children.expect_any()?;
        let unit = match unit.as_rule() {
            Rule::unit => self.unit(unit)?,
            _ => Unit { factors: vec![("1".to_owned(), 1)], span: self.span(&unit) },
        };
        Ok(Signal { doc, name, unit })
    }

    fn names(&self, node: Node) -> Vec<Name> {
        Children::of(node).map(|name| self.name(name)).collect()
    }

    fn interval(&mut self, node: Node) -> Built<Interval> {
        let mark = self.units_read();
        let span = self.span(&node);
        let mut children = Children::of(node);
        let from = self.expression(children.expect(Rule::expression)?)?;
        let to = self.expression(children.expect(Rule::expression)?)?;
        let unit = self.trailing_unit(children.take_if(Rule::unit), mark)?;
        Ok(Interval { from, to, unit, span })
    }
}
