//! Defined formulas and goals, and goals that say nothing or too much.

use crate::check::formulas::mentioned;
use crate::check::order::dependency_order;
use crate::check::vacuity::contradictions;
use crate::check::{Checker, Entry, messages, typed};
use crate::entity::EntityId;
use crate::syntax::ast::{Formula, ItemKind, Name};
use crate::{ir, lower};

impl Checker<'_> {
    /// All defined formulas, in the order in which they need each other, and then the goals.
    pub(super) fn declare_goals(&mut self) {
        self.declare_defines();
        let file = self.file;
        for item in &file.items {
            if let ItemKind::Goal { name, formula } = &item.kind
                && let Ok(root) = self.formula(formula)
            {
                self.goals.push(typed::Goal { name: name.text.clone(), formula: root, span: item.span });
            }
        }
        // Robots that could not be read are missing from the sets that goals count, and where there
        // are none at all, that has been said.
        if file.broken.is_empty() && !self.robots.is_empty() {
            self.look_for_vacuous_goals();
        }
    }

    fn declare_defines(&mut self) {
        let file = self.file;
        let mut defines: Vec<(usize, &Name, &Formula)> = Vec::new();
        for (item, declaration) in file.items.iter().enumerate() {
            if let ItemKind::Define { name, formula } = &declaration.kind {
                defines.push((item, name, formula));
            }
        }
        let edges = defines.iter().map(|(_, _, formula)| {
            let mut found = Vec::new();
            mentioned(formula, |name| {
                let Some(symbol) = self.names.get(&name.text) else { return };
                found.extend(defines.binary_search_by_key(&symbol.item, |d| d.0).ok());
            });
            found
        });
        let (order, circles) = dependency_order(&edges.collect::<Vec<_>>());
        for circle in circles {
            let names: Vec<&Name> = circle.iter().map(|&i| defines[i].1).collect();
            let reported = self.report(messages::circle("formula", &names));
            for i in circle {
                self.entries[defines[i].0] = Entry::Formula(Err(reported));
            }
        }
        for i in order {
            let (item, _, formula) = defines[i];
            if !matches!(self.entries[item], Entry::Formula(Err(_))) {
                self.entries[item] = Entry::Formula(self.formula(formula));
            }
        }
    }

    /// Goals that constants and propositional reasoning alone decide.
    fn look_for_vacuous_goals(&mut self) {
        let roots: Vec<typed::FormulaId> = self.goals.iter().map(|goal| goal.formula).collect();
        let (formulas, roots) = lower::normalise(&self.formulas, &roots);
        let contradictory = contradictions(&formulas);
        for (index, root) in roots.into_iter().enumerate() {
            let goal = &self.goals[index];
            if contradictory[root.index()] {
                let message = messages::false_goal(&goal.name, goal.span);
                self.report(message);
            } else if formulas[root] == ir::Formula::True {
                let message = messages::trivial_goal(&goal.name, goal.span);
                self.warn(message);
            }
        }
    }
}
