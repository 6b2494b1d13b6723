//! Diagnostics for people: drawn by miette around the lines that they speak of.

use std::fmt;

use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, ThemeCharacters, ThemeStyles};

use super::excerpt::{CONTEXT, Excerpt, Place};
use super::lines::Lines;
use super::printable::printable;
use crate::diag::{Diagnostic, Severity};
use crate::source::SourceFile;

/// How diagnostics are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// Whether to use colours.
    pub color: bool,
    /// The number of columns to fit into.
    pub width: usize,
}

impl Style {
    /// No colours, 100 columns: the same everywhere.
    pub const PLAIN: Style = Style { color: false, width: 100 };
}

/// The most diagnostics drawn of one file; a summary stands for the rest.
const MOST_DRAWN: usize = 100;

/// The diagnostics of a source as text, in the order given.
///
/// Nothing in the text comes from the source or from a message without being made printable.
pub fn render<'a>(
    source: &SourceFile,
    diagnostics: impl IntoIterator<Item = &'a Diagnostic>,
    style: Style,
) -> String {
    let lines = Lines::new(&source.text);
    let mut out = String::new();
    let mut all = diagnostics.into_iter();
    for diagnostic in all.by_ref().take(MOST_DRAWN) {
        let drawn = Drawn::new(source, &lines, diagnostic, style);
        // Writing to a string can't fail, and the excerpt holds all that miette asks it for.
        let _ = handler(style).render_report(&mut out, &drawn);
        out.push('\n');
    }
    let left = all.count();
    if left > 0 {
        out.push_str(&format!("… and {left} more\n"));
    }
    out
}

/// miette's renderer in this program's style.
fn handler(style: Style) -> GraphicalReportHandler {
    let styles = if style.color { ThemeStyles::ansi() } else { ThemeStyles::none() };
    let characters =
        ThemeCharacters { error: "×".into(), warning: "⚠".into(), ..ThemeCharacters::unicode() };
    GraphicalReportHandler::new_themed(GraphicalTheme { characters, styles })
        .with_width(style.width)
        .with_links(false)
        .with_context_lines(CONTEXT)
        .without_syntax_highlighting()
}

/// A diagnostic in miette's terms.
struct Drawn {
    code: &'static str,
    severity: Severity,
    message: String,
    help: Option<String>,
    labels: Vec<LabeledSpan>,
    excerpt: Option<Excerpt>,
}

impl Drawn {
    fn new(source: &SourceFile, lines: &Lines, diagnostic: &Diagnostic, style: Style) -> Drawn {
        // Room for the gutter beside the source.
        let width = style.width.saturating_sub(12).max(40);
        let excerpt = Excerpt::new(source, lines, &diagnostic.labels, width);
        let texts = diagnostic.labels.iter().map(|l| printable(&l.text).into_owned());
        let labels =
            texts.zip(excerpt.places()).enumerate().map(|(i, (text, &place))| labelled(i == 0, text, place));
        Drawn {
            code: diagnostic.code,
            severity: diagnostic.severity,
            message: printable(&diagnostic.message).into_owned(),
            help: diagnostic.help.as_deref().map(|h| printable(h).into_owned()),
            labels: labels.collect(),
            excerpt: (!diagnostic.labels.is_empty()).then_some(excerpt),
        }
    }
}

/// A label in miette's terms.
fn labelled(primary: bool, text: String, place: Place) -> LabeledSpan {
    let text = (!text.is_empty()).then_some(text);
    let span = (place.start, place.len);
    if primary {
        LabeledSpan::new_primary_with_span(text, span)
    } else {
        LabeledSpan::new_with_span(text, span)
    }
}

impl miette::Diagnostic for Drawn {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(self.code))
    }

    fn severity(&self) -> Option<miette::Severity> {
        Some(match self.severity {
            Severity::Error => miette::Severity::Error,
            Severity::Warning => miette::Severity::Warning,
        })
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.help.as_ref().map(|h| Box::new(h) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn miette::SourceCode> {
        self.excerpt.as_ref().map(|e| e as &dyn miette::SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        (!self.labels.is_empty())
            .then(|| Box::new(self.labels.iter().cloned()) as Box<dyn Iterator<Item = _>>)
    }
}

impl std::error::Error for Drawn {}

impl fmt::Display for Drawn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl fmt::Debug for Drawn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Span;

    fn drawn(text: &str, diagnostic: Diagnostic) -> String {
        render(&SourceFile::new("m.dosm", text), [&diagnostic], Style::PLAIN)
    }

    #[test]
    fn two_labels_and_a_help_are_drawn() {
        let error = Diagnostic::error(
            "dosm::check::duplicate_name",
            "`a` is declared twice",
            Span::new(18, 19),
            "again here",
        )
        .with_label(Span::new(4, 5), "first here")
        .with_help("rename one of them");
        insta::assert_snapshot!(drawn("let a = 1\nb\nc\nlet a = 2\n", error), @r"
        dosm::check::duplicate_name

          × `a` is declared twice
           ╭─[m.dosm:4:5]
         1 │ let a = 1
           ·     ┬
           ·     ╰── first here
         2 │ b
         3 │ c
         4 │ let a = 2
           ·     ┬
           ·     ╰── again here
           ╰────
          help: rename one of them
        ");
    }

    #[test]
    fn nothing_hostile_reaches_the_screen() {
        let error = Diagnostic::error("dosm::a::b", "bad \u{1b}]0;x\u{7}", Span::new(3, 4), "\u{202e}here")
            .with_help("no \u{9b}31m");
        let text = drawn("let\u{1b}[2J\u{202e} x\r\n", error);
        assert!(text.chars().all(|c| c == '\n' || !c.is_control()), "{text:?}");
        assert!(!text.contains('\u{202e}'));
    }

    #[test]
    fn a_long_line_takes_little_room_and_keeps_its_column() {
        let text = format!("{} bad {}", "x ".repeat(5_000_000), "y ".repeat(100));
        let error = Diagnostic::error("dosm::a::b", "bad", Span::new(10_000_001, 10_000_004), "here");
        let shown = drawn(&text, error);
        assert!(shown.len() < 1000, "{}", shown.len());
        assert!(shown.contains("m.dosm:1:10000002"), "{shown}");
    }

    #[test]
    fn a_flood_of_diagnostics_is_summed_up() {
        let many: Vec<Diagnostic> =
            (0..150).map(|_| Diagnostic::error("dosm::a::b", "bad", Span::new(0, 1), "")).collect();
        let text = render(&SourceFile::new("m", "x"), &many, Style::PLAIN);
        assert!(text.ends_with("… and 50 more\n"));
    }
}
