//! What is said to the user and to programs, and where.

use std::cell::OnceCell;
use std::io::{self, IsTerminal, Write};
use std::time::Duration;

use serde::Serialize;

use super::Status;
use super::args::{Color, Common};
use super::overseer::{Cause, LastWords};
use crate::diag::json::{JsonDiagnostic, to_json};
use crate::diag::render::{Style, render};
use crate::diag::{Diagnostic, Severity};
use crate::source::{SourceFile, Span};

/// The streams, and how much to say on them.
#[derive(Clone, Debug)]
pub struct Output {
    /// Whether standard output gets one JSON object and nothing else.
    pub json: bool,
    /// Whether to say nothing but errors.
    pub quiet: bool,
    /// How much more to say.
    pub verbose: u8,
    /// How results on standard output are drawn.
    pub result_style: Style,
    style: Style,
    /// The code of the first error that was drawn, the command line's aside.
    first_error: OnceCell<&'static str>,
}

/// What `--json` prints when a command stops with an error.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct JsonFailure {
    /// Always `error`.
    #[cfg_attr(test, schemars(extend("const" = "error")))]
    pub status: &'static str,
    /// What was wrong.
    pub diagnostics: Vec<JsonDiagnostic>,
}

/// What `--json` prints when a command stops before its work is done.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct JsonGivenUp {
    /// Always `unknown`.
    #[cfg_attr(test, schemars(extend("const" = "unknown")))]
    pub status: &'static str,
    /// `timeout` or `interrupt`.
    #[cfg_attr(test, schemars(extend("enum" = ["timeout", "interrupt"])))]
    pub reason: &'static str,
    /// The time since the start, in seconds.
    pub time_s: f64,
}

/// The last words of a command that has nothing more to say than that it stops.
pub fn giving_up(output: Output) -> LastWords {
    Box::new(move |cause, _, elapsed| {
        // Nothing more can be done about an output that fails here.
        let _ = output.give_up(cause, elapsed);
    })
}

impl Output {
    /// The streams as the flags want them.
    pub fn new(common: &Common) -> Output {
        let color = |is_terminal: bool| match common.color {
            Color::Always => true,
            Color::Never => false,
            Color::Auto => is_terminal && colors_by_default(),
        };
        let width = terminal_size::terminal_size().map_or(100, |(w, _)| usize::from(w.0).clamp(60, 120));
        Output {
            json: common.json,
            quiet: common.quiet,
            verbose: common.verbose,
            result_style: Style { color: color(io::stdout().is_terminal()), width },
            style: Style { color: color(io::stderr().is_terminal()), width },
            first_error: OnceCell::new(),
        }
    }

    /// Nothing but JSON, for when the flags could not be read.
    pub fn json_only() -> Output {
        let style = Style::PLAIN;
        let first_error = OnceCell::new();
        Output { json: true, quiet: true, verbose: 0, result_style: style, style, first_error }
    }

    /// Prints a result for people on standard output.
    ///
    /// # Errors
    /// [`Status::Usage`] when it can't be written, which was said.
    pub fn say(&self, text: &str) -> Result<(), Status> {
        if self.json || self.quiet { Ok(()) } else { self.print(text) }
    }

    /// Prints what a command is for, as text that even `--quiet` keeps or as JSON.
    pub fn result(&self, text: &str, value: &impl Serialize) -> Status {
        let printed = if self.json { self.json(value) } else { self.print(text) };
        printed.err().unwrap_or(Status::Done)
    }

    /// Prints text that a command was asked for and that even `--quiet` keeps, as it stands.
    ///
    /// # Errors
    /// [`Status::Usage`] when it can't be written, which was said.
    pub fn text(&self, text: &str) -> Result<(), Status> {
        if self.json { Ok(()) } else { self.print(text.strip_suffix('\n').unwrap_or(text)) }
    }

    /// Prints a result for programs on standard output.
    ///
    /// # Errors
    /// [`Status::Usage`] when it can't be written, which was said.
    pub fn json(&self, value: &impl Serialize) -> Result<(), Status> {
        if !self.json {
            return Ok(());
        }
        let text = serde_json::to_string(value).map_err(|_| Status::Usage)?;
        self.print(&text)
    }

    /// Says something on standard error that is no error.
    pub fn note(&self, text: &str) {
        if !self.quiet {
            self.complain(text);
        }
    }

    /// Draws diagnostics on standard error; quiet keeps warnings back.
    pub fn diagnostics<'a>(&self, source: &SourceFile, all: impl IntoIterator<Item = &'a Diagnostic>) {
        let kept = all.into_iter().filter(|d| !self.quiet || d.severity == Severity::Error);
        let kept: Vec<&Diagnostic> = kept.collect();
        // What is wrong with a command line needs no page to be understood.
        let of_mission =
            |d: &&&Diagnostic| d.severity == Severity::Error && !d.code.starts_with("dosm::cli::");
        if let Some(error) = kept.iter().find(of_mission) {
            let _ = self.first_error.set(error.code);
        }
        if !self.json {
            self.complain(render(source, kept, self.style).strip_suffix('\n').unwrap_or_default());
        }
    }

    /// Says, after errors, where there is more to read about the first of them.
    pub fn point_to_explanation(&self) {
        if let (false, Some(code)) = (self.json, self.first_error.get()) {
            self.note(&format!("for more: dosmc explain {code}"));
        }
    }

    /// Ends a command with an error that has no place in a mission.
    pub fn fail(&self, diagnostic: Diagnostic) -> Status {
        self.fail_with(diagnostic, Status::Usage)
    }

    /// Ends a command with an error that has no place in a mission, and a status of its own.
    pub fn fail_with(&self, diagnostic: Diagnostic, status: Status) -> Status {
        self.fail_in(&SourceFile::new("", ""), &[diagnostic], status)
    }

    /// Ends a command with errors in a source.
    pub fn fail_in(&self, source: &SourceFile, diagnostics: &[Diagnostic], status: Status) -> Status {
        self.diagnostics(source, diagnostics);
        let failure = JsonFailure { status: "error", diagnostics: to_json(source, diagnostics) };
        self.json(&failure).err().unwrap_or(status)
    }

    /// Ends a command before its work is done.
    pub fn give_up(&self, cause: Cause, elapsed: Duration) -> Status {
        let time_s = elapsed.as_secs_f64();
        let said = self.say(&format!("unknown: {} after {time_s:.1} s; nothing is done", cause.said()));
        let json = JsonGivenUp { status: "unknown", reason: cause.name(), time_s };
        said.and_then(|()| self.json(&json)).err().unwrap_or(Status::Unknown)
    }

    fn print(&self, text: &str) -> Result<(), Status> {
        let mut out = io::stdout().lock();
        match writeln!(out, "{text}").and_then(|()| out.flush()) {
            Ok(()) => Ok(()),
            // Whoever closed the pipe has read enough.
            Err(e) if e.kind() == io::ErrorKind::BrokenPipe => Ok(()),
            Err(e) => {
                self.complain(&format!("dosmc: can't write to standard output: {e}"));
                Err(Status::Usage)
            }
        }
    }

    fn complain(&self, text: &str) {
        if !text.is_empty() {
            // There is nobody left to tell when standard error is gone.
            let _ = writeln!(io::stderr().lock(), "{text}");
        }
    }
}

/// An error without a place.
pub fn plain_error(code: &'static str, message: impl Into<String>) -> Diagnostic {
    Diagnostic { labels: Vec::new(), ..Diagnostic::error(code, message, Span::default(), "") }
}

/// `1 error`, `2 errors`.
pub fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// Whether the environment has nothing against colours.
fn colors_by_default() -> bool {
    std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty()) && !is_dumb()
}

/// Whether standard error is a terminal that can take back what stands there.
pub fn redraws() -> bool {
    io::stderr().is_terminal() && !is_dumb()
}

fn is_dumb() -> bool {
    std::env::var_os("TERM").is_some_and(|t| t == "dumb")
}
