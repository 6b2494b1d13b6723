//! Robots with their starts, and teams.

use crate::check::expression::Scope;
use crate::check::families::Family;
use crate::check::names::Kind;
use crate::check::order::dependency_order;
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
        let mut empty = Vec::new();
        for (index, item) in file.items.iter().enumerate() {
            if let ItemKind::Robot { name, dynamics, at } = &item.kind {
                let family = self.robot(name, dynamics, at, item);
                unread |= family.is_err();
                empty.extend(family.as_ref().is_ok_and(|f| f.len == 0).then_some(&name.name));
                self.entries[index] = Entry::Family(family);
            }
        }
        if self.robots.is_empty() && !unread {
            let message = match &empty[..] {
                [] => messages::missing_robot(file.span),
                names => messages::empty_families(names),
            };
            self.report(message);
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

    /// All teams, those that another one names before it.
    pub(super) fn declare_teams(&mut self) {
        let file = self.file;
        let mut teams: Vec<(usize, &Name, &[Reference])> = Vec::new();
        for (item, declaration) in file.items.iter().enumerate() {
            if let ItemKind::Team { name, members } = &declaration.kind {
                teams.push((item, name, members));
            }
        }
        let named = |reference: &Reference| {
            let symbol = self.names.get(&reference.name.text)?;
            teams.binary_search_by_key(&symbol.item, |team| team.0).ok()
        };
        let edges: Vec<Vec<usize>> =
            teams.iter().map(|(_, _, members)| members.iter().filter_map(named).collect()).collect();
        let (order, circles) = dependency_order(&edges);
        for circle in circles {
            let names: Vec<&Name> = circle.iter().map(|&i| teams[i].1).collect();
            let reported = self.report(messages::circle("team", &names));
            for i in circle {
                self.entries[teams[i].0] = Entry::Team(Err(reported));
            }
        }
        for i in order {
            let (item, _, members) = teams[i];
            if !matches!(self.entries[item], Entry::Team(Err(_))) {
                self.entries[item] = Entry::Team(self.set(members, &Scope::default()));
            }
        }
    }

    /// The robots of a set, each once, in the order in which they are first named.
    pub(super) fn set(&mut self, members: &[Reference], scope: &Scope) -> Result<Vec<RobotId>, Reported> {
        let mut seen = vec![false; self.robots.len()];
        let mut robots = Vec::new();
        let mut failed = None;
        for reference in members {
            match self.set_member(reference, scope) {
                Ok(ids) => {
                    let new = ids.into_iter().filter(|id| !std::mem::replace(&mut seen[id.index()], true));
                    robots.extend(new);
                }
                Err(reported) => failed = Some(reported),
            }
        }
        failed.map_or(Ok(robots), Err)
    }

    fn set_member(&mut self, reference: &Reference, scope: &Scope) -> Result<Vec<RobotId>, Reported> {
        let plain = reference.indices.is_empty();
        if plain && reference.name.text == "all" {
            return Ok((0..self.robots.len()).map(RobotId::new).collect());
        }
        if plain && let Some(crate::check::Binding::Robot(id)) = scope.binding(&reference.name.text) {
            return Ok(vec![id]);
        }
        let item = self.resolve(&reference.name, &[Kind::Robot, Kind::Team], "robot", scope)?;
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
