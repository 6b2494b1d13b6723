//! Robots with their starts, and teams.

use crate::check::expression::Scope;
use crate::check::families::Family;
use crate::check::names::Kind;
use crate::check::{Checker, Entry, doc_text, messages, typed};
use crate::diag::Reported;
use crate::entity::EntityId;
use crate::exact::Rational;
use crate::ir::RobotId;
use crate::source::Span;
use crate::syntax::ast::{Expr, FamilyName, Item, ItemKind, Name, Reference, State};

impl Checker<'_> {
    /// All robots, members of families one by one.
    pub(super) fn declare_robots(&mut self) {
        let file = self.file;
        let mut unread = file.has_broken_keyword("robot");
        for (index, item) in file.items.iter().enumerate() {
            if let ItemKind::Robot { name, dynamics, at } = &item.kind {
                let family = self.robot(name, dynamics, at, item);
                unread |= family.is_err();
                self.entries[index] = Entry::Family(family);
            }
        }
        if self.robots.is_empty() && !unread {
            self.report(messages::missing_robot(file.span));
        }
    }

    fn robot(
        &mut self,
        name: &FamilyName,
        dynamics: &Name,
        at: &State,
        item: &Item,
    ) -> Result<Family, Reported> {
        let model = self.model_of(dynamics);
        let (family, members) = self.family(name, self.robots.len())?;
        let mut failed = false;
        for member in members {
            let start = match (&model, failed) {
                (Ok(model), false) => self.start(*model, at, &member.scope),
                (Err(reported), _) => Err(*reported),
                (_, true) => {
                    self.robots.push(None);
                    continue;
                }
            };
            failed = start.is_err();
            let robot = start.and_then(|start| Ok((start, model?))).map(|(start, dynamics)| typed::Robot {
                name: member.name,
                doc: doc_text(&item.doc),
                dynamics,
                start,
                span: item.span,
            });
            self.robots.push(robot.ok());
        }
        Ok(family)
    }

    fn model_of(&mut self, dynamics: &Name) -> Result<typed::DynamicsId, Reported> {
        let item = self.resolve(dynamics, &[Kind::Dynamics], "dynamics model", &Scope::default())?;
        match &self.entries[item] {
            Entry::Dynamics(result) => *result,
            _ => Err(self.reported(|| messages::missing_step(dynamics))),
        }
    }

    fn start(
        &mut self,
        model: typed::DynamicsId,
        at: &State,
        scope: &Scope,
    ) -> Result<Vec<Rational>, Reported> {
        let states = self.dynamics[model].states.clone();
        match at {
            State::Position(point) => {
                let position = self.dynamics[model].position.clone();
                let mut start = vec![Rational::ZERO; states.len()];
                for (state, coordinate) in position.into_iter().zip(self.point(point, scope)?) {
                    start[state] = coordinate;
                }
                Ok(start)
            }
            State::Full { entries, span } => self.full_state(&states, entries, *span, scope),
        }
    }

    fn full_state(
        &mut self,
        states: &[typed::Signal],
        entries: &[(Name, Expr)],
        _span: Span,
        scope: &Scope,
    ) -> Result<Vec<Rational>, Reported> {
        let mut start: Vec<Option<(Rational, Span)>> = vec![None; states.len()];
        let mut failed = None;
        for (name, expr) in entries {
            let Some(index) = states.iter().position(|s| s.name == name.text) else {
                failed = Some(self.report(messages::unknown_signal(name, "state", states.iter())));
                continue;
            };
            if let Some((_, first)) = &start[index] {
                failed = Some(self.report(messages::duplicate_signal(name, *first)));
                continue;
            }
            match self.quantity(expr, scope, states[index].dimension) {
                Ok(value) => start[index] = Some((value, name.span)),
                Err(reported) => failed = Some(reported),
            }
        }
        let values =
            start.into_iter().map(|entry| entry.map_or(Rational::ZERO, |(value, _)| value)).collect();
        failed.map_or(Ok(values), Err)
    }

    /// All teams.
    pub(super) fn declare_teams(&mut self) {
        let file = self.file;
        for (index, item) in file.items.iter().enumerate() {
            if let ItemKind::Team { members, .. } = &item.kind {
                let team = self.set(members, &Scope::default(), &[Kind::Robot]);
                self.entries[index] = Entry::Team(team);
            }
        }
    }

    /// The robots of a set, each once, in the order in which they are first named.
    pub(super) fn set(
        &mut self,
        members: &[Reference],
        scope: &Scope,
        kinds: &[Kind],
    ) -> Result<Vec<RobotId>, Reported> {
        let mut seen = vec![false; self.robots.len()];
        let mut robots = Vec::new();
        let mut failed = None;
        for reference in members {
            match self.set_member(reference, scope, kinds) {
                Ok(ids) => {
                    let new = ids.into_iter().filter(|id| !std::mem::replace(&mut seen[id.index()], true));
                    robots.extend(new);
                }
                Err(reported) => failed = Some(reported),
            }
        }
        failed.map_or(Ok(robots), Err)
    }

    fn set_member(
        &mut self,
        reference: &Reference,
        scope: &Scope,
        kinds: &[Kind],
    ) -> Result<Vec<RobotId>, Reported> {
        let plain = reference.indices.is_empty();
        if plain && reference.name.text == "all" {
            return Ok((0..self.robots.len()).map(RobotId::new).collect());
        }
        if plain && let Some(crate::check::Binding::Robot(id)) = scope.binding(&reference.name.text) {
            return Ok(vec![id]);
        }
        let item = self.resolve(&reference.name, kinds, "robot", scope)?;
        let family = match &self.entries[item] {
            Entry::Team(Ok(_)) if !plain => {
                return Err(self.report(messages::wrong_member_indices(reference, 0)));
            }
            Entry::Team(team) => return team.clone(),
            Entry::Family(family) => family.clone()?,
            _ => return Err(self.reported(|| messages::unknown_name(&reference.name, "robot", None))),
        };
        if plain {
            return Ok(family.ids().map(RobotId::new).collect());
        }
        Ok(vec![RobotId::new(self.member(&family, reference, scope, "robot")?)])
    }
}
