//! Building declarations.

use crate::syntax::ast::{
    Connectivity, ConnectivityItem, ConnectivityKind, FamilyName, Item, ItemKind, Reference, State,
};
use crate::syntax::builder::Builder;
use crate::syntax::grammar::{Built, Children, Node, Rule};

impl Builder<'_> {
    /// A declaration.
    pub(super) fn declaration(&mut self, node: Node) -> Built<Item> {
        let doc = self.doc(&node);
        let span = self.span(&node);
        let node = Children::of(node).expect_any()?;
        let rule = node.as_rule();
        let text = node.as_str();
        let mut children = Children::of(node);
        let kind = match rule {
            Rule::edition => ItemKind::Edition(self.number(children.expect(Rule::number)?)?),
            Rule::mission => ItemKind::Mission(self.name(children.expect(Rule::ident)?)),
            Rule::param | Rule::constant => self.constant(rule, children)?,
            Rule::workspace => ItemKind::Workspace(self.shape(children.expect(Rule::shape)?)?),
            Rule::region | Rule::obstacle | Rule::jammer => self.area(rule, text, children)?,
            Rule::base => ItemKind::Base {
                name: self.family(children.expect(Rule::family)?)?,
                at: self.point(children.expect(Rule::point)?)?,
            },
            Rule::dynamics => {
                let name = self.name(children.expect(Rule::ident)?);
                let items = children.map(|item| self.dynamics_item(item)).collect::<Built<_>>()?;
                ItemKind::Dynamics { name, items }
            }
            Rule::robot => ItemKind::Robot {
                name: self.family(children.expect(Rule::family)?)?,
                dynamics: self.name(children.expect(Rule::ident)?),
                at: self.initial(children.expect(Rule::initial)?)?,
            },
            Rule::team => ItemKind::Team {
                name: self.name(children.expect(Rule::ident)?),
                members: self.set(children.expect(Rule::set)?)?,
            },
            Rule::separation => ItemKind::Separation(self.expression(children.expect(Rule::expression)?)?),
            Rule::connectivity => ItemKind::Connectivity(self.connectivity(text, children)?),
            Rule::horizon => {
                let (from, to) = self.range(children.expect(Rule::range)?)?;
                ItemKind::Horizon { from, to }
            }
            Rule::minimize => ItemKind::Minimize(self.name(children.expect(Rule::ident)?)),
            _ => self.specification(rule, children)?,
        };
        Ok(Item { doc, span, kind })
    }

    fn constant(&mut self, rule: Rule, mut children: Children) -> Built<ItemKind> {
        let name = self.name(children.expect(Rule::ident)?);
        Ok(match children.take_if(Rule::value) {
            Some(value) if rule == Rule::constant => ItemKind::Let { name, value: self.value(value)? },
            _ => ItemKind::Param { name, value: self.expression(children.expect(Rule::expression)?)? },
        })
    }

    fn area(&mut self, rule: Rule, text: &str, mut children: Children) -> Built<ItemKind> {
        let name = self.family(children.expect(Rule::family)?)?;
        let shape = self.shape(children.expect(Rule::shape)?)?;
        Ok(match rule {
            Rule::region => ItemKind::Region { name, shape },
            Rule::jammer => ItemKind::Jammer { name, shape },
            _ => ItemKind::Obstacle { opaque: text.starts_with("opaque"), name, shape },
        })
    }

    fn specification(&mut self, rule: Rule, mut children: Children) -> Built<ItemKind> {
        let name = self.name(children.expect(Rule::ident)?);
        let formula = self.formula(children.expect(Rule::formula)?)?;
        Ok(if rule == Rule::goal {
            ItemKind::Goal { name, formula }
        } else {
            ItemKind::Define { name, formula }
        })
    }

    /// A declared name, perhaps of a family.
    fn family(&mut self, node: Node) -> Built<FamilyName> {
        let mut children = Children::of(node);
        let name = self.name(children.expect(Rule::ident)?);
        let indices = children.map(|index| self.index_range(index)).collect::<Built<_>>()?;
        Ok(FamilyName { name, indices })
    }

    /// Robots, members, teams and families; `all` is a reference of that name.
    pub(super) fn set(&mut self, node: Node) -> Built<Vec<Reference>> {
        Children::of(node).map(|member| self.set_member(member)).collect()
    }

    fn set_member(&mut self, node: Node) -> Built<Reference> {
        let span = self.span(&node);
        match Children::of(node.clone()).take_if(Rule::reference) {
            Some(reference) => self.reference(reference),
            None => Ok(Reference { name: self.name(node), indices: Vec::new(), span }),
        }
    }

    fn initial(&mut self, node: Node) -> Built<State> {
        let node = Children::of(node).expect_any()?;
        if node.as_rule() == Rule::point {
            return self.point(node).map(State::Position);
        }
        let span = self.span(&node);
        let mut entries = Vec::new();
        for entry in Children::of(node) {
            let mut children = Children::of(entry);
            let name = self.name(children.expect(Rule::ident)?);
            entries.push((name, self.expression(children.expect(Rule::expression)?)?));
        }
        Ok(State::Full { entries, span })
    }

    fn connectivity(&mut self, text: &str, children: Children) -> Built<Connectivity> {
        if text.trim_end().ends_with("none") {
            return Ok(Connectivity::None);
        }
        children.map(|item| self.connectivity_item(item)).collect::<Built<_>>().map(Connectivity::Items)
    }

    fn connectivity_item(&mut self, node: Node) -> Built<ConnectivityItem> {
        let span = self.span(&node);
        let node = Children::of(node).expect_any()?;
        let rule = node.as_rule();
        let mut children = Children::of(node);
        let value = self.expression(children.expect(Rule::expression)?)?;
        let kind = match rule {
            Rule::hops => ConnectivityKind::Hops(value),
            Rule::reach => ConnectivityKind::Range { length: value, norm: self.norm(&mut children)? },
            Rule::redundancy => ConnectivityKind::Redundancy(value),
            _ => ConnectivityKind::Every(value),
        };
        Ok(ConnectivityItem { span, kind })
    }
}
