//! The words and signs that fit what a place wants.

use crate::lsp::document::Document;
use crate::lsp::index::SymbolKind;
use crate::syntax::words::{COORDINATES, UNITS};

use super::Wanted;
use super::forms::{
    CONNECTIVE_FORMS, CONNECTIVITY_FORMS, DECLARATION_FORMS, DYNAMICS_FORMS, FORMULA_FORMS, FUNCTION_FORMS,
    Form, INFIX_LETTERS, MISSION, PREFIX_LETTERS, SHAPE_FORMS,
};
use super::model::Signal;
use super::names::Names;
use super::place::Place;
use super::reader::{About, Measure, Want};

/// Units that are more than a symbol, for signals.
const COMPOUND_UNITS: [&str; 6] = ["m/s", "m/s^2", "m/s^3", "rad/s", "1/s", "1"];

/// Declarations of which there is at most one.
const ONCE: [&str; 7] = ["dosm", "mission", "workspace", "separation", "connectivity", "horizon", "minimize"];

/// Items of a `dynamics` block of which there is at most one.
const ITEMS_ONCE: [&str; 8] = ["step", "position", "A", "B", "c", "continuous", "integrator", "rejection"];

/// The items that `integrator` stands for.
const INTEGRATED: [&str; 7] = ["state", "input", "position", "A", "B", "c", "continuous"];

/// What a candidate is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    /// A word or sign of the language.
    Word,
    /// A name of the mission.
    Name(SymbolKind),
    /// A name that every mission has.
    Function,
    /// A coordinate.
    Coordinate,
    /// A unit.
    Unit,
    /// A name to choose.
    NewName,
    /// A piece of text.
    Snippet,
}

/// Something to offer.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Candidate {
    /// What is shown and, but for snippets, inserted.
    pub(super) label: String,
    pub(super) kind: Kind,
    /// What it is, in a few words.
    pub(super) detail: Option<String>,
    /// What it is for.
    pub(super) doc: Option<String>,
    /// With places to fill in.
    pub(super) snippet: Option<String>,
    /// Whether it goes on with the unit that is typed, over several tokens.
    pub(super) continues_unit: bool,
}

impl Candidate {
    pub(super) fn new(label: impl Into<String>, kind: Kind) -> Candidate {
        let label = label.into();
        Candidate { label, kind, detail: None, doc: None, snippet: None, continues_unit: false }
    }

    pub(super) fn with_detail(mut self, detail: impl Into<String>) -> Candidate {
        self.detail = Some(detail.into());
        self
    }
}

/// Collects candidates, the likeliest first.
pub(super) struct Candidates<'t> {
    pub(super) document: &'t Document,
    pub(super) place: &'t Place<'t>,
    pub(super) wanted: Wanted<'t>,
    pub(super) list: Vec<Candidate>,
}

impl<'t> Candidates<'t> {
    pub(super) fn new(document: &'t Document, place: &'t Place<'t>, wanted: Wanted<'t>) -> Candidates<'t> {
        Candidates { document, place, wanted, list: Vec::new() }
    }

    /// Collects what fits all that is wanted.
    pub(super) fn collect(&mut self) {
        if let Some(Want::Unit(measure)) = self.wanted.unit {
            let from = self.list.len();
            self.units(measure);
            self.list[from..].iter_mut().for_each(|unit| unit.continues_unit = true);
        }
        let mut wants = self.wanted.wants.clone();
        if self.place.is_dot {
            wants.retain(|want| *want == Want::Words(&[".."]));
        } else if self.place.touches_number {
            // A word would need a blank first.
            wants.retain(|want| matches!(want, Want::Unit(_)) || *want == Want::Words(&[".."]));
        }
        // On a new line, the next declaration is likelier than the last one's continuation.
        if self.place.is_first_of_line {
            let likeliest = [Want::Declaration, Want::DynamicsItem, Want::ModeItem, Want::ConnectivityItem];
            wants.sort_by_key(|want| !likeliest.contains(want));
        }
        for want in wants {
            self.add(want);
        }
        let mut seen = std::collections::BTreeSet::new();
        self.list.retain(|candidate| seen.insert((candidate.label.clone(), candidate.continues_unit)));
    }

    fn add(&mut self, want: Want<'_>) {
        match want {
            Want::Declaration => self.declarations(),
            Want::Words(words) => {
                self.list.extend(words.iter().map(|word| Candidate::new(*word, Kind::Word)));
            }
            Want::NewName { of_mission } => self.mission_name(of_mission),
            Want::Shape => self.forms(&SHAPE_FORMS),
            Want::Region => self.names().regions(),
            Want::Robot { sets } => self.robots(sets),
            Want::Model => self.names().of_kinds(&[SymbolKind::Dynamics]),
            Want::Operand(about) => self.operands(about),
            Want::Unit(measure) => self.units(measure),
            Want::Formula => self.formulas(),
            Want::Connective => {
                self.forms(&CONNECTIVE_FORMS);
                self.letters(&INFIX_LETTERS);
            }
            Want::DynamicsItem => self.dynamics_items(),
            Want::ModeItem => self.forms_without(&DYNAMICS_FORMS, |word| word.len() > 1),
            Want::ConnectivityItem => self.forms_without(&CONNECTIVITY_FORMS, |_| false),
            Want::Signals { inputs } => {
                let signals = self.wanted.model.all(self.place.dimensions());
                self.signals(&signals, inputs);
            }
            Want::StatesOf(model) => self.states_of(model),
        }
    }

    pub(super) fn names(&mut self) -> Names<'_, 't> {
        Names::new(self)
    }

    fn declarations(&mut self) {
        if self.place.others.is_empty() {
            self.list.push(Candidate {
                snippet: Some(MISSION.snippet.into()),
                ..Candidate::new(MISSION.word, Kind::Snippet).with_detail(MISSION.form)
            });
        }
        let has_edition = self.place.declares("dosm");
        for form in &DECLARATION_FORMS {
            let is_once = ONCE.contains(&form.word) && self.place.declares(form.word);
            // Before the edition, nothing else may come.
            let is_first = self.place.before.is_empty() && !has_edition && form.word != "dosm";
            if !is_once && !is_first {
                self.form(form);
            }
        }
    }

    fn forms(&mut self, forms: &[Form]) {
        forms.iter().for_each(|form| self.form(form));
    }

    /// The items that a block has not yet, but for some.
    fn forms_without(&mut self, forms: &[Form], skipped: impl Fn(&str) -> bool) {
        for form in forms {
            if !skipped(form.word) && !self.wanted.items.contains(&form.word) {
                self.form(form);
            }
        }
    }

    fn form(&mut self, form: &Form) {
        let snippet = match (form.word, self.only_model()) {
            ("robot", Some(model)) => form.snippet.replace("MODEL", model),
            _ => form.snippet.to_string(),
        };
        self.list.push(Candidate {
            snippet: Some(snippet),
            ..Candidate::new(form.word, Kind::Word).with_detail(form.form)
        });
    }

    /// The first model of the mission.
    fn only_model(&self) -> Option<&'t str> {
        let index = self.document.index();
        let mut models = index.symbols().filter(|(_, symbol)| symbol.kind == SymbolKind::Dynamics);
        models.next().map(|(_, symbol)| symbol.name.as_str())
    }

    fn letters(&mut self, letters: &[(&str, &str)]) {
        let one = |(letter, word): &(&str, &str)| {
            Candidate::new(*letter, Kind::Word).with_detail(format!("the same as `{word}`"))
        };
        self.list.extend(letters.iter().map(one));
    }

    fn mission_name(&mut self, of_mission: bool) {
        let path = of_mission.then(|| crate::lsp::location::path(&self.document.uri)).flatten();
        let stem = path.as_deref().and_then(|path| path.file_stem()).and_then(|stem| stem.to_str());
        let Some(stem) = stem else { return };
        let name: String = stem.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
        let digit = name.starts_with(|c: char| c.is_ascii_digit());
        let name = if digit { format!("_{name}") } else { name };
        if !name.is_empty() && name.len() <= 64 && !crate::syntax::words::is_reserved(&name) {
            self.list.push(Candidate::new(name, Kind::NewName).with_detail("the name of the file"));
        }
    }

    fn robots(&mut self, sets: bool) {
        self.variables(true);
        self.names().robots(sets);
        if sets {
            self.list.push(Candidate::new("all", Kind::Word).with_detail("all robots"));
        }
    }

    /// The bound variables that stand for robots, or those that stand for numbers; the innermost first.
    fn variables(&mut self, robots: bool) {
        let kind = if robots { SymbolKind::RobotVariable } else { SymbolKind::IndexVariable };
        let fitting = self.wanted.variables.iter().rev().filter(|variable| variable.is_robot == robots);
        let one = |variable: &super::reader::Variable<'_>| {
            Candidate::new(variable.name, Kind::Name(kind)).with_detail(kind.noun())
        };
        self.list.extend(fitting.map(one));
    }

    fn operands(&mut self, about: About) {
        match about {
            About::Constants => {}
            About::Coordinates => {
                let one = |axis: &&str| Candidate::new(*axis, Kind::Coordinate).with_detail("coordinate");
                self.list.extend(COORDINATES[..self.place.dimensions()].iter().map(one));
            }
            About::Signals => {
                let signals = self.wanted.model.all(self.place.dimensions());
                self.signals(&signals, true);
            }
        }
        self.variables(false);
        self.names().of_kinds(&[SymbolKind::Constant, SymbolKind::Parameter]);
        self.list.push(Candidate::new("pi", Kind::Function).with_detail("3.14159…"));
        let from = self.list.len();
        self.forms(&FUNCTION_FORMS);
        self.list[from..].iter_mut().for_each(|function| function.kind = Kind::Function);
    }

    fn units(&mut self, measure: Measure<'_>) {
        let fitting: Vec<&str> = match measure {
            Measure::Bare => return,
            Measure::Any | Measure::New => Vec::new(),
            Measure::Unit("m") => vec!["m", "cm", "mm", "km"],
            Measure::Unit("s") => vec!["s", "ms", "min"],
            Measure::Unit("rad") => vec!["rad", "deg"],
            Measure::Unit(unit) => vec![unit],
        };
        let others = UNITS.iter().chain(&COMPOUND_UNITS).filter(|unit| !fitting.contains(unit));
        for unit in fitting.iter().chain(others) {
            // `1` is a unit only where a signal is declared.
            if *unit != "1" || measure == Measure::New {
                self.list.push(Candidate::new(*unit, Kind::Unit).with_detail(unit_name(unit)));
            }
        }
    }

    fn formulas(&mut self) {
        self.variables(true);
        self.names().robots(false);
        self.names().of_kinds(&[SymbolKind::Define]);
        self.forms(&FORMULA_FORMS);
        self.variables(false);
        self.names().of_kinds(&[SymbolKind::Constant, SymbolKind::Parameter]);
        self.letters(&PREFIX_LETTERS);
    }

    fn dynamics_items(&mut self) {
        let items = self.wanted.items.clone();
        let is_integrated = items.contains(&"integrator");
        let is_written = items.iter().any(|item| INTEGRATED.contains(item));
        for form in &DYNAMICS_FORMS {
            let is_there = ITEMS_ONCE.contains(&form.word) && items.contains(&form.word);
            let is_foreign = is_integrated && INTEGRATED.contains(&form.word);
            let is_late = is_written && form.word == "integrator";
            if !is_there && !is_foreign && !is_late {
                self.form(form);
            }
        }
    }

    fn signals(&mut self, signals: &[Signal<'_>], inputs: bool) {
        for signal in signals.iter().filter(|signal| inputs || !signal.is_input) {
            let kind = if signal.is_input { SymbolKind::Input } else { SymbolKind::State };
            let detail = format!("{} in {}", kind.noun(), signal.unit);
            self.list.push(Candidate::new(signal.name.as_ref(), Kind::Name(kind)).with_detail(detail));
        }
    }

    fn states_of(&mut self, model: &str) {
        let index = self.document.index();
        let declared = self
            .place
            .declarations("dynamics")
            .find(|tokens| tokens.get(1).is_some_and(|name| name.text == model));
        if let Some(tokens) = declared {
            let signals = super::model_of(tokens, index).all(self.place.dimensions());
            self.signals(&signals, false);
        }
    }
}

/// What a unit measures, in a word.
fn unit_name(unit: &str) -> &'static str {
    match unit {
        "m" => "metre",
        "cm" => "centimetre",
        "mm" => "millimetre",
        "km" => "kilometre",
        "s" => "second",
        "ms" => "millisecond",
        "min" => "minute",
        "rad" => "radian",
        "deg" => "degree",
        "kg" => "kilogram",
        "g" => "gram",
        "N" => "newton",
        "m/s" => "velocity",
        "m/s^2" => "acceleration",
        "m/s^3" => "jerk",
        "rad/s" => "angular velocity",
        "1/s" => "rate",
        "1" => "a plain number",
        _ => "unit",
    }
}
