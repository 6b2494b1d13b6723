//! Diagnostics for programs: one JSON value each.

use serde::Serialize;

use super::lines::Lines;
use crate::diag::{Diagnostic, Label, Severity};
use crate::source::SourceFile;

/// A diagnostic as `--json` prints it.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct JsonDiagnostic {
    /// The stable code.
    pub code: &'static str,
    /// `error` or `warning`.
    #[cfg_attr(test, schemars(extend("enum" = ["error", "warning"])))]
    pub severity: &'static str,
    /// The message.
    pub message: String,
    /// The mend, where one is known.
    pub help: Option<String>,
    /// The file that it speaks of.
    pub file: String,
    /// The places concerned; the first is the primary one.
    pub labels: Vec<JsonLabel>,
}

/// A place: lines and columns from 1, columns in characters, ends one past the last.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct JsonLabel {
    /// What is said about the place.
    pub text: String,
    /// The file.
    pub file: String,
    /// The first line.
    pub line: usize,
    /// The first column.
    pub column: usize,
    /// The last line.
    pub end_line: usize,
    /// One past the last column.
    pub end_column: usize,
    /// The first byte, from 0.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

/// The diagnostics of a source, in the order given.
pub fn to_json<'a>(
    source: &SourceFile,
    diagnostics: impl IntoIterator<Item = &'a Diagnostic>,
) -> Vec<JsonDiagnostic> {
    let lines = Lines::new(&source.text);
    diagnostics.into_iter().map(|d| one(source, &lines, d)).collect()
}

fn one(source: &SourceFile, lines: &Lines, diagnostic: &Diagnostic) -> JsonDiagnostic {
    JsonDiagnostic {
        code: diagnostic.code,
        severity: match diagnostic.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        },
        message: diagnostic.message.clone(),
        help: diagnostic.help.clone(),
        file: source.name.clone(),
        labels: diagnostic.labels.iter().map(|l| label(source, lines, l)).collect(),
    }
}

fn label(source: &SourceFile, lines: &Lines, label: &Label) -> JsonLabel {
    let (start, end) = lines.clamp(label.span);
    let ((line, column), (end_line, end_column)) = (lines.place(start), lines.place(end));
    JsonLabel {
        text: label.text.clone(),
        file: source.name.clone(),
        line,
        column,
        end_line,
        end_column,
        start,
        end,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Span;

    #[test]
    fn places_are_in_lines_columns_and_bytes() {
        let source = SourceFile::new("m.dosm", "Ω\nΩab\n");
        let error = Diagnostic::error("dosm::a::b", "bad", Span::new(5, 7), "here");
        let json = serde_json::to_value(&to_json(&source, [&error])[0]).expect("plain values");
        let place = serde_json::json!({"text": "here", "file": "m.dosm", "line": 2, "column": 2,
            "end_line": 2, "end_column": 4, "start": 5, "end": 7});
        assert_eq!(json["labels"][0], place);
        assert_eq!(json["severity"], "error");
    }
}
