//! Diagnostics: one structure for all phases, with stable codes.
//!
//! A phase pushes [`Diagnostic`]s into [`Diagnostics`] and returns [`Reported`] when it cannot go on.
//! Each phase keeps one small function a diagnostic beside its own code; nothing here knows them.

mod excerpt;
mod fix;
pub mod json;
mod lines;
mod printable;
pub mod render;

pub use fix::{Edit, Fix};
pub use printable::printable;

use std::collections::BTreeSet;

use crate::source::Span;

/// How much a diagnostic weighs.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Severity {
    /// The mission still means something; it is worth a look.
    Warning,
    /// The mission is refused.
    Error,
}

/// A place in the source with what is to be said about it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Label {
    /// The place.
    pub span: Span,
    /// What is said about it, without a full stop; may be empty.
    pub text: String,
}

/// One message to the user.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Diagnostic {
    /// The stable code, `dosm::<phase>::<name>`.
    pub code: &'static str,
    /// Error or warning.
    pub severity: Severity,
    /// One sentence, without a full stop.
    pub message: String,
    /// The places concerned; the first is the primary one.
    pub labels: Vec<Label>,
    /// The mend, where one is known.
    pub help: Option<String>,
    /// Mends as edits, the likeliest first.
    pub fixes: Vec<Fix>,
}

impl Diagnostic {
    /// An error with its primary place.
    pub fn error(
        code: &'static str,
        message: impl Into<String>,
        span: Span,
        label: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic {
            code,
            severity: Severity::Error,
            message: message.into(),
            labels: vec![Label { span, text: label.into() }],
            help: None,
            fixes: Vec::new(),
        }
    }

    /// A warning with its primary place.
    pub fn warning(
        code: &'static str,
        message: impl Into<String>,
        span: Span,
        label: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic { severity: Severity::Warning, ..Diagnostic::error(code, message, span, label) }
    }

    /// The diagnostic with a further place.
    pub fn with_label(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.labels.push(Label { span, text: text.into() });
        self
    }

    /// The diagnostic with a mend.
    pub fn with_help(mut self, help: impl Into<String>) -> Diagnostic {
        self.help = Some(help.into());
        self
    }

    /// The diagnostic with edits that surely mend it.
    pub fn mended_by(mut self, title: impl Into<String>, edits: Vec<Edit>) -> Diagnostic {
        self.fixes.push(Fix { title: title.into(), edits, is_sure: true });
        self
    }

    /// The diagnostic with edits that may be what is meant.
    pub fn perhaps_by(mut self, title: impl Into<String>, edits: Vec<Edit>) -> Diagnostic {
        self.fixes.push(Fix { title: title.into(), edits, is_sure: false });
        self
    }

    /// The diagnostic with a word that is surely meant in the place of another.
    pub fn meant(self, span: Span, word: &str) -> Diagnostic {
        self.mended_by(format!("write `{word}`"), vec![Edit::Replace(span, word.into())])
    }
}

/// Proof that the user was told: returned by a phase that pushed at least one error.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Reported(());

/// The diagnostics of one run, in the order found.
#[derive(Clone, Default, Debug)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
    /// The codes with their primary places: of which a repetition may be.
    known: BTreeSet<(&'static str, Option<Span>)>,
}

impl Diagnostics {
    /// No diagnostics yet.
    pub fn new() -> Diagnostics {
        Diagnostics::default()
    }

    /// Adds a diagnostic; an exact repetition is dropped.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        let key = (diagnostic.code, diagnostic.labels.first().map(|label| label.span));
        // A long mission may have an unused declaration on each line.
        if self.known.insert(key) || !self.list.contains(&diagnostic) {
            self.list.push(diagnostic);
        }
    }

    /// Adds an error and returns the proof of it.
    pub fn report(&mut self, diagnostic: Diagnostic) -> Reported {
        debug_assert_eq!(diagnostic.severity, Severity::Error);
        self.push(diagnostic);
        Reported(())
    }

    /// Whether there is an error among them.
    pub fn has_errors(&self) -> bool {
        self.list.iter().any(|d| d.severity == Severity::Error)
    }

    /// `Err` when there is an error among them.
    ///
    /// # Errors
    /// [`Reported`] when an error was pushed before.
    pub fn or_reported(&self) -> Result<(), Reported> {
        if self.has_errors() { Err(Reported(())) } else { Ok(()) }
    }

    /// The diagnostics, sorted by their primary place.
    pub fn sorted(&self) -> Vec<&Diagnostic> {
        let mut list: Vec<&Diagnostic> = self.list.iter().collect();
        list.sort_by_key(|d| (d.labels.first().map(|l| l.span), d.severity, d.code));
        list
    }

    /// The diagnostics in the order found.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.list.iter()
    }
}
