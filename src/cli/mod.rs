//! The command line: the only part that touches files, clock, terminal and environment.
//!
//! Results go to standard output, everything else to standard error; the exit statuses are a
//! promise ([`Status`]). What the commands do is in [`driver`](crate::driver).

#![allow(clippy::disallowed_methods, reason = "this is where files, clock and environment belong")]

mod args;
mod check;
mod compile;
mod completions;
mod explain;
mod files;
mod fmt;
mod help;
mod instance;
mod line;
mod lsp;
mod mission;
mod new;
mod output;
mod overseer;
mod phases;
mod png;
mod render;
mod sheet;
mod simulate;
mod solve;
mod stats;
mod time;
mod verify;
mod weather;

use std::process::ExitCode;

use clap::Parser;
use clap::error::ErrorKind;

use crate::diag::Diagnostic;
use crate::driver::Overrides;
use crate::law::Float;
use args::{Args, Command};
use output::Output;

/// What the exit status says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Done; for `solve`, a plan was found and checked.
    Done = 0,
    /// Wrong usage, or a file that can't be read or written.
    Usage = 1,
    /// The mission has errors.
    Mission = 2,
    /// No plan of any length in the horizon.
    NoPlan = 3,
    /// Time, memory or numerics ran out first.
    Unknown = 4,
    /// A plan does not check.
    Refused = 5,
}

impl Status {
    /// The exit status's value.
    pub fn code(self) -> u8 {
        self as u8
    }
}

/// Runs the command that the process was started with.
pub fn main() -> ExitCode {
    let status = match Args::try_parse() {
        Ok(args) => run(args),
        Err(error) => answer_without_command(&error),
    };
    ExitCode::from(status.code())
}

/// Runs a command.
fn run(args: Args) -> Status {
    let output = Output::new(&args.common);
    let overrides = Overrides {
        set: args.common.set.clone(),
        horizon: args.common.horizon,
        float: match args.command {
            Command::Solve { float, .. } => float.into(),
            _ => Float::default(),
        },
    };
    if let Some(name) = repeated(&overrides.set) {
        return output.fail(usage(format!("`--set {name}=…` is given twice")));
    }
    let status = match args.command {
        Command::Check { missions } => check::check(&missions, &overrides, args.common.timeout, &output),
        Command::Compile { mission, output: directory, emit, plan, float, length, encoding } => {
            let wanted =
                compile::Wanted { emit, plan, float: float.into(), length, encoding: encoding.into() };
            compile::compile(&mission, &directory, &wanted, &overrides, args.common.timeout, &output)
        }
        Command::Solve { mission, output: directory, encoding, png, float: _ } => {
            let search =
                solve::Settings { timeout: args.common.timeout, encoding: encoding.map(Into::into), png };
            solve::solve(&mission, &directory, &overrides, search, &output)
        }
        Command::Verify { plan, mission } => {
            verify::verify(&plan, &mission, &overrides, args.common.timeout, &output)
        }
        Command::Render { plan, mission, output: file, encoding, runs, weather } => {
            let runs = simulate::options(runs, weather, Float::F64, args.common.threads);
            let wanted = render::Wanted { file: &file, encoding: encoding.into(), runs };
            render::render(&plan, &mission, &wanted, &overrides, args.common.timeout, &output)
        }
        Command::Simulate { plan, mission, runs, weather, float, csv } => {
            let options = simulate::options(runs, weather, float.into(), args.common.threads);
            let wanted = simulate::Wanted { options, csv: csv.as_deref() };
            simulate::simulate(&plan, &mission, &wanted, &overrides, args.common.timeout, &output)
        }
        Command::Fmt { check, missions } => fmt::fmt(&missions, check, &output),
        Command::Lsp { stdio: _ } => lsp::lsp(&overrides, &output),
        Command::New { name } => new::new(&name, &output),
        Command::Explain { code } => explain::explain(code.as_deref(), &output),
        Command::Completions { shell } => completions::completions(shell, &output),
        Command::Man { output: directory } => completions::man(directory.as_deref(), &output),
    };
    output.point_to_explanation();
    status
}

/// A parameter that is set twice.
fn repeated(set: &[(String, String)]) -> Option<&str> {
    set.iter().enumerate().find(|(i, s)| set[..*i].iter().any(|t| t.0 == s.0)).map(|(_, s)| s.0.as_str())
}

/// Help and version, or what is wrong with the usage.
fn answer_without_command(error: &clap::Error) -> Status {
    let asked = matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion);
    let json = std::env::args_os().skip(1).take_while(|a| a != "--").any(|a| a == "--json");
    if json && !asked {
        let text = error.to_string();
        let message = text.lines().next().unwrap_or_default().trim_start_matches("error: ");
        return Output::json_only().fail(usage(message));
    }
    // A reader that went away needs no help any more.
    let _ = error.print();
    if asked { Status::Done } else { Status::Usage }
}

/// Wrong usage, found after the arguments were read one by one.
fn usage(message: impl Into<String>) -> Diagnostic {
    output::plain_error("dosm::cli::usage", message)
}

#[cfg(test)]
mod schemas;
