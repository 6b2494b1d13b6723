//! What is wrong with a mission, as editors show it.

use lsp_types::{
    CodeDescription, Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity, DiagnosticTag, Location,
    NumberOrString,
};

use super::document::Document;
use super::session::Session;
use super::solve::Outcome;
use super::{lens, location};
use crate::diag::{self, Label, Severity};
use crate::explain;

/// Who says it.
const SOURCE: &str = "dosmc";

/// All diagnostics of a mission, with what came of planning it.
pub fn all(document: &Document, outcome: Option<&Outcome>, session: &Session) -> Vec<Diagnostic> {
    let said = document.said().into_iter().map(|d| one(document, d, session));
    said.chain(outcome.map(|outcome| of_outcome(document, outcome, session))).collect()
}

fn one(document: &Document, diagnostic: &diag::Diagnostic, session: &Session) -> Diagnostic {
    let (first, others) = match diagnostic.labels.split_first() {
        Some((first, others)) => (first.clone(), others),
        None => (Label { span: lens::place(document), text: String::new() }, &[][..]),
    };
    Diagnostic {
        range: document.range(first.span),
        severity: Some(match diagnostic.severity {
            Severity::Error => DiagnosticSeverity::ERROR,
            Severity::Warning => DiagnosticSeverity::WARNING,
        }),
        code: Some(NumberOrString::String(diagnostic.code.into())),
        code_description: description(diagnostic.code, session),
        source: Some(SOURCE.into()),
        message: message(diagnostic, &first.text),
        related_information: related(document, others),
        tags: (diagnostic.code == "dosm::check::unused").then(|| vec![DiagnosticTag::UNNECESSARY]),
        data: None,
    }
}

/// The message, what is said about its place where that says more, and the mend.
fn message(diagnostic: &diag::Diagnostic, label: &str) -> String {
    let says_more = !label.is_empty() && !diagnostic.message.contains(label);
    let here = says_more.then(|| format!("here: {label}"));
    let help = diagnostic.help.as_ref().map(|help| format!("help: {help}"));
    let lines = [Some(diagnostic.message.clone()), here, help];
    lines.into_iter().flatten().collect::<Vec<_>>().join("\n")
}

/// The link behind a code: to its explanation.
fn description(code: &str, session: &Session) -> Option<CodeDescription> {
    if !session.client.code_links {
        return None;
    }
    let page = explain::PAGES.iter().find(|page| page.code == code)?;
    let file = session.host.explanation(page)?;
    Some(CodeDescription { href: location::uri(&file)? })
}

fn related(document: &Document, labels: &[Label]) -> Option<Vec<DiagnosticRelatedInformation>> {
    let one = |label: &Label| DiagnosticRelatedInformation {
        location: Location { uri: document.uri.clone(), range: document.range(label.span) },
        message: if label.text.is_empty() { "here".into() } else { label.text.clone() },
    };
    (!labels.is_empty()).then(|| labels.iter().map(one).collect())
}

/// What came of planning: a link to the picture, or why there is no plan.
fn of_outcome(document: &Document, outcome: &Outcome, session: &Session) -> Diagnostic {
    let picture = outcome.picture.as_deref().and_then(location::uri);
    let related = |message: &str, file: &Option<std::path::PathBuf>| {
        let uri = location::uri(file.as_deref()?)?;
        let location = Location { uri, range: lsp_types::Range::default() };
        Some(DiagnosticRelatedInformation { location, message: message.into() })
    };
    let files = [related("the picture", &outcome.picture), related("the animation", &outcome.page)];
    let files: Vec<_> = files.into_iter().flatten().collect();
    Diagnostic {
        range: document.range(lens::place(document)),
        severity: Some(match outcome.status {
            "plan" => DiagnosticSeverity::INFORMATION,
            "error" => DiagnosticSeverity::ERROR,
            _ => DiagnosticSeverity::WARNING,
        }),
        code: Some(NumberOrString::String(outcome.status.into())),
        code_description: picture.filter(|_| session.client.code_links).map(|href| CodeDescription { href }),
        source: Some("dosmc solve".into()),
        message: outcome.message.clone(),
        related_information: (!files.is_empty()).then_some(files),
        tags: None,
        data: None,
    }
}
