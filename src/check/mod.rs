//! From syntax tree to typed mission: names become ids, dimensions are checked, families written out.
//!
//! The phases run in the order in which they need each other (names, constants, shapes, dynamics,
//! robots, settings, formulas). Each goes on after an error with what is known: a declaration that
//! failed is kept as [`Reported`], so that whatever refers to it stays silent.

mod bounds;
mod connectivity;
mod constants;
mod dynamics;
mod expression;
mod facts;
mod families;
mod formulas;
mod functions;
mod goals;
mod hold;
mod messages;
mod names;
mod order;
mod placement;
mod robots;
mod settings;
mod shapes;
mod sums;
#[cfg(test)]
mod tests;
pub mod typed;
mod uncertain;
mod vacuity;
mod windows;

pub use facts::{Facts, Known, Members, Quantity, Steps, Values, check_with_facts};
pub use shapes::dimension;

use std::collections::BTreeMap;

use crate::check::constants::Constant;
use crate::check::expression::{Binding, Scope};
use crate::check::families::Family;
use crate::check::names::{Kind, Names, is_predeclared};
use crate::check::settings::Settings;
use crate::diag::{Diagnostic, Diagnostics, Reported};
use crate::entity::Table;
use crate::ir::RobotId;
use crate::source::SourceFile;
use crate::syntax::ast;

/// Checks a mission; `set` are the command line's assignments to parameters, as written.
///
/// # Errors
/// [`Reported`] after as many diagnostics as could be found.
pub fn check(
    file: &ast::File,
    source: &SourceFile,
    set: &[(String, String)],
    diagnostics: &mut Diagnostics,
) -> Result<typed::Mission, Reported> {
    let earlier = diagnostics.or_reported();
    let mut checker = Checker::new(file, source, diagnostics);
    checker.run(set);
    earlier?;
    checker.finish(set)
}

/// What is known of a declaration, by its place in the file.
enum Entry {
    /// Not looked at yet, or nothing to know.
    Pending,
    /// A parameter or a let.
    Constant(Result<Constant, Reported>),
    /// The members of a region, obstacle, jammer, base or robot.
    Family(Result<Family, Reported>),
    /// A motion model.
    Dynamics(Result<typed::DynamicsId, Reported>),
    /// A team's robots, each once.
    Team(Result<Vec<RobotId>, Reported>),
    /// A defined formula.
    Formula(Result<typed::FormulaId, Reported>),
}

/// The most errors that get a name suggested: each looks at all names.
const MAX_SUGGESTIONS: usize = 50;
/// The most errors and warnings that are kept.
const MAX_DIAGNOSTICS: usize = 1000;

/// The state of a check.
struct Checker<'a> {
    file: &'a ast::File,
    source: &'a SourceFile,
    diagnostics: &'a mut Diagnostics,
    names: Names,
    /// Indexed as the file's items.
    entries: Vec<Entry>,
    dimension: usize,
    workspace: Option<Result<typed::Workspace, Reported>>,
    /// `None` where a member failed; the ids are right all the same.
    regions: Vec<Option<typed::Region>>,
    blockers: Vec<Option<typed::Blocker>>,
    bases: Vec<Option<typed::Base>>,
    dynamics: Table<typed::DynamicsId, typed::Dynamics>,
    robots: Vec<Option<typed::Robot>>,
    settings: Settings,
    /// The members of all families so far.
    members: usize,
    formulas: Table<typed::FormulaId, typed::Formula>,
    /// What formulas took so far, terms of sums included.
    formula_size: usize,
    /// The proof that formulas were said to take too much.
    overgrown: Option<Reported>,
    goals: Vec<typed::Goal>,
    /// How many errors and warnings there were.
    said: usize,
    /// What is noted for those who ask for [`Facts`].
    notes: Option<Box<facts::Notes>>,
}

impl<'a> Checker<'a> {
    fn new(file: &'a ast::File, source: &'a SourceFile, diagnostics: &'a mut Diagnostics) -> Checker<'a> {
        Checker {
            file,
            source,
            diagnostics,
            names: Names::default(),
            entries: file.items.iter().map(|_| Entry::Pending).collect(),
            dimension: 2,
            workspace: None,
            regions: Vec::new(),
            blockers: Vec::new(),
            bases: Vec::new(),
            dynamics: Table::new(),
            robots: Vec::new(),
            settings: Settings::default(),
            members: 0,
            formulas: Table::new(),
            formula_size: 0,
            overgrown: None,
            goals: Vec::new(),
            said: 0,
            notes: None,
        }
    }

    fn run(&mut self, set: &[(String, String)]) {
        self.declare_names();
        self.constants(set);
        self.settings();
        self.workspace();
        self.declare_shapes();
        self.declare_dynamics();
        self.declare_robots();
        self.declare_teams();
        self.cross_settings();
        self.declare_goals();
        self.placements();
        self.stray_comments();
        if !self.diagnostics.has_errors() {
            self.unused_names();
        }
    }

    /// Adds an error and returns the proof of it.
    ///
    /// After [`MAX_DIAGNOSTICS`] of them it is only counted: nobody reads more, and a hostile text must
    /// not make us compare each with all others.
    fn report(&mut self, diagnostic: Diagnostic) -> Reported {
        self.said += 1;
        match (self.said > MAX_DIAGNOSTICS, self.diagnostics.or_reported()) {
            (true, Err(reported)) => reported,
            _ => self.diagnostics.report(diagnostic),
        }
    }

    /// Adds a warning, unless there are too many already.
    fn warn(&mut self, diagnostic: Diagnostic) {
        self.said += 1;
        if self.said <= MAX_DIAGNOSTICS {
            self.diagnostics.push(diagnostic);
        }
    }

    /// The proof that something was reported before, by this phase or the parser.
    fn reported(&mut self, otherwise: impl FnOnce() -> Diagnostic) -> Reported {
        match self.diagnostics.or_reported() {
            Err(reported) => reported,
            Ok(()) => self.report(otherwise()),
        }
    }

    fn declare_names(&mut self) {
        let mut duplicates = Vec::new();
        self.names = Names::collect(self.file, |name, kind, first| {
            duplicates.push(messages::duplicate_name(name, kind, first));
        });
        for duplicate in duplicates {
            self.report(duplicate);
        }
        for item in &self.file.items {
            if let Some((name, _)) = names::declared(item)
                && is_predeclared(&name.text)
            {
                self.report(messages::predeclared_name(name));
            }
        }
    }

    /// The declaration of a name that must be of one of the kinds; `wanted` is what messages call it.
    fn resolve(
        &mut self,
        name: &ast::Name,
        kinds: &[Kind],
        wanted: &'static str,
        scope: &Scope,
    ) -> Result<usize, Reported> {
        match scope.binding(&name.text) {
            Some(Binding::Unknown(reported)) => return Err(reported),
            Some(_) => return Err(self.report(messages::bound_variable(name, wanted))),
            None => {}
        }
        let Some(symbol) = self.names.get(&name.text) else {
            let near = if self.said < MAX_SUGGESTIONS { self.names.nearest(&name.text, kinds) } else { None };
            let near = near.map(str::to_string);
            let message = messages::unknown_name(name, wanted, near.as_deref());
            if self.file.has_broken(&name.text) {
                return Err(self.reported(|| message));
            }
            return Err(self.report(message));
        };
        if !kinds.contains(&symbol.kind) {
            return Err(self.report(messages::wrong_kind(name, wanted, symbol)));
        }
        self.names.mark_used(&name.text);
        Ok(symbol.item)
    }

    /// Checks the name of a bound variable or index and adds it to the scope.
    fn bind(&mut self, scope: &mut Scope, variable: &ast::Name, binding: Binding) {
        scope.bindings.push((variable.text.clone(), binding));
    }

    /// Warns where a bound variable hides a name, and refuses one that hides a predeclared name.
    fn check_variable(&mut self, variable: &ast::Name, scope: &Scope) -> Result<(), Reported> {
        if is_predeclared(&variable.text) {
            return Err(self.report(messages::predeclared_name(variable)));
        }
        if let Some(symbol) = self.names.get(&variable.text) {
            self.warn(messages::hidden_name(variable, symbol));
        } else if scope.binding(&variable.text).is_some() {
            self.warn(messages::hidden_variable(variable));
        }
        Ok(())
    }

    fn stray_comments(&mut self) {
        let file = self.file;
        for span in &file.stray_docs {
            self.warn(messages::misplaced_doc(*span));
        }
    }

    fn unused_names(&mut self) {
        let unused: Vec<Diagnostic> = self
            .names
            .iter()
            .filter(|(_, symbol)| !symbol.used)
            .filter(|(_, symbol)| {
                let kinds = [Kind::Param, Kind::Let, Kind::Region, Kind::Dynamics, Kind::Team, Kind::Define];
                kinds.contains(&symbol.kind)
            })
            .map(|(name, symbol)| messages::unused(name, symbol))
            .collect();
        for warning in unused {
            self.warn(warning);
        }
    }

    /// The whole mission, once everything is known to be right.
    fn finish(mut self, set: &[(String, String)]) -> Result<typed::Mission, Reported> {
        self.diagnostics.or_reported()?;
        let workspace = match self.workspace.take() {
            Some(workspace) => workspace?,
            None => return Err(self.report(messages::missing_workspace(self.file.span))),
        };
        let (Some(step), Some(_)) = (self.settings.step.clone(), self.robots.first()) else {
            return Err(self.report(messages::missing_robot(self.file.span)));
        };
        Ok(typed::Mission {
            name: self.settings.name.clone().unwrap_or_else(|| stem(&self.source.name)),
            doc: doc_text(&self.file.doc),
            sha256: self.source.sha256(),
            set: set.iter().cloned().collect::<BTreeMap<_, _>>(),
            step,
            workspace,
            regions: self.regions.into_iter().flatten().collect(),
            blockers: self.blockers.into_iter().flatten().collect(),
            bases: self.bases.into_iter().flatten().collect(),
            dynamics: self.dynamics,
            robots: self.robots.into_iter().flatten().collect(),
            separation: self.settings.separation,
            connectivity: self.settings.connectivity,
            horizon: self.settings.horizon,
            objective: self.settings.objective,
            formulas: self.formulas,
            goals: self.goals,
        })
    }
}

/// The text of a documentation comment, empty when there is none.
fn doc_text(doc: &Option<ast::Doc>) -> String {
    doc.as_ref().map(|d| d.text.clone()).unwrap_or_default()
}

/// The file's name without its directory and ending.
fn stem(name: &str) -> String {
    let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let stem = file.strip_suffix(".dosm").unwrap_or(file);
    if stem.is_empty() || stem.starts_with('<') { "mission".into() } else { stem.into() }
}
