//! The commands, their arguments and their help.

use std::path::PathBuf;
use std::time::Duration;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

use super::help;
use super::time::parse_time;
use super::weather::Weather;
use crate::back::Emit;

/// The whole command line.
#[derive(Parser, Debug)]
#[command(
    name = "dosmc",
    version,
    about = "Plans for teams of robots that must stay in radio contact despite jammers and disturbances",
    long_about = "dosmc reads a mission (.dosm): a workspace, who jams it, who moves in it and how, and what must happen.\n\
It looks for the shortest plan that holds for every disturbance allowed, on an infinite run, and checks \
that plan again in exact arithmetic before it gives it out.",
    after_long_help = help::DOSMC,
    subcommand_required = true,
    arg_required_else_help = true,
    disable_help_subcommand = true
)]
pub struct Args {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Flags of every command.
    #[command(flatten)]
    pub common: Common,
}

/// Flags of every command.
#[derive(clap::Args, Debug, Clone)]
pub struct Common {
    /// Override a `param` of the mission, as in `--set robots=4`; repeatable
    #[arg(long, global = true, value_name = "NAME=EXPR", value_parser = parse_set, help_heading = "Mission")]
    pub set: Vec<(String, String)>,
    /// Try plans of A to B steps, whatever the mission's own `horizon` says
    #[arg(long, global = true, value_name = "A..B", value_parser = parse_horizon, help_heading = "Mission")]
    pub horizon: Option<(usize, usize)>,
    /// Stop searching after so long: `30 s`, `2min`, `500ms`, or seconds
    #[arg(long, global = true, value_name = "TIME", value_parser = parse_time, help_heading = "Search")]
    pub timeout: Option<Duration>,
    /// Use at most so many threads; the answer does not depend on it
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), help_heading = "Search")]
    pub threads: Option<u16>,
    /// Print one JSON object on standard output, and nothing else there
    #[arg(long, global = true, help_heading = "Output")]
    pub json: bool,
    /// Say nothing but errors
    #[arg(long, short, global = true, help_heading = "Output", conflicts_with = "verbose")]
    pub quiet: bool,
    /// Say more: sizes and times of each part
    #[arg(long, short, global = true, action = clap::ArgAction::Count, help_heading = "Output")]
    pub verbose: u8,
    /// When to use colours
    #[arg(long, global = true, value_enum, default_value_t = Color::Auto, value_name = "WHEN", help_heading = "Output")]
    pub color: Color,
}

/// When to use colours.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Color {
    /// On a terminal, unless NO_COLOR is set
    Auto,
    /// Even into a file or another program
    Always,
    /// Not even on a terminal
    Never,
}

/// What the search speaks of.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Half-spaces, added where they are needed: the fastest
    HalfSpaces,
    /// Cells of a partition, as in the paper; 'no plan' then holds for this partition only
    Paper,
}

impl From<Encoding> for crate::driver::Encoding {
    fn from(encoding: Encoding) -> Self {
        match encoding {
            Encoding::HalfSpaces => crate::driver::Encoding::HalfSpaces,
            Encoding::Paper => crate::driver::Encoding::Paper,
        }
    }
}

/// The numbers that controllers compute with.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Float {
    /// IEEE double precision
    F64,
    /// IEEE single precision, for processors without doubles
    F32,
}

impl From<Float> for crate::law::Float {
    fn from(float: Float) -> Self {
        match float {
            Float::F64 => crate::law::Float::F64,
            Float::F32 => crate::law::Float::F32,
        }
    }
}

/// What `compile` can write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// The mission in another tool's format.
    Mission(Emit),
    /// The controller of a plan.
    Controller,
}

impl Format {
    /// All there are, with their names on the command line.
    fn all() -> impl Iterator<Item = (&'static str, Format)> {
        let missions = Emit::ALL.iter().map(|emit| (emit.name(), Format::Mission(*emit)));
        missions.chain([("controller", Format::Controller)])
    }
}

/// The commands.
#[derive(Subcommand, Debug)]
pub enum Command {
    /// Say what is wrong with missions, and how to mend it
    #[command(display_order = 2, after_long_help = help::CHECK)]
    Check {
        /// The missions; `-` is standard input
        #[arg(required = true, value_name = "MISSION")]
        missions: Vec<PathBuf>,
    },
    /// Write a mission in other tools' formats
    #[command(display_order = 6, after_long_help = help::COMPILE)]
    Compile {
        /// The mission; `-` is standard input
        mission: PathBuf,
        /// Where to write the files; created where needed
        #[arg(short, long, value_name = "DIR")]
        output: PathBuf,
        /// What to write, separated by commas; everything when left out
        #[arg(long, value_name = "FORMAT", value_delimiter = ',', value_parser = format_parser())]
        emit: Vec<Format>,
        /// The plan, a `plan.json`, whose controller is to be written; it is checked first
        #[arg(long, value_name = "PLAN")]
        plan: Option<PathBuf>,
        /// What the controller computes with; refused where its rounding does not fit the plan
        #[arg(long, value_enum, default_value_t = Float::F64, value_name = "TYPE", requires = "plan")]
        float: Float,
        /// For plans of this length only, whatever the horizon says
        #[arg(long, value_name = "L", value_parser = parse_length)]
        length: Option<usize>,
        /// What instances speak of: half-spaces, or the cells of a partition as in the paper
        #[arg(long, value_enum, default_value_t = Encoding::HalfSpaces, value_name = "WHICH")]
        encoding: Encoding,
    },
    /// Look for the shortest plan, check it exactly, and write it down
    #[command(display_order = 3, after_long_help = help::SOLVE)]
    Solve {
        /// The mission, or an instance (`NAME.smc.json`); `-` is standard input
        mission: PathBuf,
        /// Where to write the plan; created where needed
        #[arg(short, long, value_name = "DIR")]
        output: PathBuf,
        /// What the search speaks of: half-spaces (the default; an instance has its own), or the cells of a
        /// partition as in the paper
        #[arg(long, value_enum, value_name = "WHICH", help_heading = "Search")]
        encoding: Option<Encoding>,
        /// What the controller will compute with: the tubes get room for its rounding
        #[arg(long, value_enum, default_value_t = Float::F64, value_name = "TYPE", help_heading = "Search")]
        float: Float,
        /// Write the picture as plan.png too (a dosmc built with `--features png`)
        #[arg(long, help_heading = "Output")]
        png: bool,
    },
    /// Check a plan against its mission, in exact arithmetic, believing nothing
    #[command(display_order = 4, after_long_help = help::VERIFY)]
    Verify {
        /// The plan, a `plan.json`
        plan: PathBuf,
        /// The mission; `-` is standard input
        mission: PathBuf,
    },
    /// Draw a plan: a picture of the workspace, every robot's way, tube and links, or a page on which they move
    #[command(display_order = 7, after_long_help = help::RENDER)]
    Render {
        /// The plan, a `plan.json`
        plan: PathBuf,
        /// The mission; `-` is standard input
        mission: PathBuf,
        /// Where to draw it; the name's end says how
        #[arg(short, long, value_name = "FILE.svg|FILE.html|FILE.png")]
        output: PathBuf,
        /// With `paper`, draw the cells too: the coarse ones that `solve --encoding paper` begins with
        #[arg(long, value_enum, default_value_t = Encoding::HalfSpaces, value_name = "WHICH")]
        encoding: Encoding,
        /// Simulate so many runs and draw them as thin lines over the nominal ways
        #[arg(long, default_value_t = 0, value_name = "N", value_parser = clap::value_parser!(u64).range(0..=MOST_DRAWN), help_heading = "Simulation")]
        runs: u64,
        /// How robots are disturbed.
        #[command(flatten)]
        weather: Weather,
    },
    /// Fly a plan in closed loop, disturbed as much as is allowed and more, and try to break it
    #[command(display_order = 5, after_long_help = help::SIMULATE)]
    Simulate {
        /// The plan, a `plan.json`
        plan: PathBuf,
        /// The mission; `-` is standard input
        mission: PathBuf,
        /// How many runs
        #[arg(long, default_value_t = 1000, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=MOST_RUNS), help_heading = "Simulation")]
        runs: u64,
        /// How robots are disturbed.
        #[command(flatten)]
        weather: Weather,
        /// What the law computes with
        #[arg(long, value_enum, default_value_t = Float::F64, value_name = "TYPE", help_heading = "Simulation")]
        float: Float,
        /// Write each run there, a row for each robot and step; `-` is standard output
        #[arg(long, value_name = "FILE", help_heading = "Output")]
        csv: Option<PathBuf>,
    },
    /// Lay missions out in the one style; they mean the same as before
    #[command(display_order = 8, after_long_help = help::FMT)]
    Fmt {
        /// Change nothing; say which missions are not in the style, and end with status 1 if any is not
        #[arg(long)]
        check: bool,
        /// The missions, which are rewritten; `-` is from standard input to standard output
        #[arg(required = true, value_name = "MISSION")]
        missions: Vec<PathBuf>,
    },
    /// Serve editors: the language server, on standard input and output
    #[command(display_order = 12, after_long_help = help::LSP)]
    Lsp {
        /// For clients that say so: standard input and output, which are used anyway
        #[arg(long, hide = true)]
        stdio: bool,
    },
    /// Write a starter mission, NAME.dosm
    #[command(display_order = 1, after_long_help = help::NEW)]
    New {
        /// The mission's name: letters, digits and `_`
        name: String,
    },
    /// Explain a diagnostic: what it means, why it matters, and how to mend it
    #[command(display_order = 9, after_long_help = help::EXPLAIN)]
    Explain {
        /// The diagnostic's code, such as `dosm::check::duplicate` or `duplicate`; or a phase, such as `tube`
        code: Option<String>,
    },
    /// Print a script that completes commands and flags in a shell
    #[command(display_order = 10, after_long_help = help::COMPLETIONS)]
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Print the manual page, or write the manual
    #[command(display_order = 11, after_long_help = help::MAN)]
    Man {
        /// Where to write dosmc.1 and a page for each command; created where needed
        #[arg(short, long, value_name = "DIR")]
        output: Option<PathBuf>,
    },
}

/// `NAME=EXPR`
fn parse_set(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("it must be NAME=EXPR, as in `robots=4`")?;
    let (name, value) = (name.trim(), value.trim());
    if name.is_empty() || value.is_empty() {
        return Err("both sides of `=` are needed, as in `robots=4`".into());
    }
    Ok((name.into(), value.into()))
}

/// One of the formats' names.
fn format_parser() -> impl TypedValueParser<Value = Format> {
    let named =
        |name: String| Format::all().find(|(n, _)| *n == name).map(|(_, f)| f).ok_or("no such format");
    PossibleValuesParser::new(Format::all().map(|(name, _)| name)).try_map(named)
}

/// The longest plan that may be asked for (language.md §2).
const LONGEST: usize = 100_000;

/// The most runs that are simulated.
const MOST_RUNS: u64 = 1_000_000_000;
/// The most runs that are drawn.
const MOST_DRAWN: u64 = 1000;

/// `A..B` with 1 ≤ A ≤ B
fn parse_horizon(text: &str) -> Result<(usize, usize), String> {
    let ends = text.split_once("..").ok_or("it must be A..B, as in `1..40`")?;
    let end = |s: &str| s.trim().parse::<usize>().map_err(|_| format!("`{s}` is no number of steps"));
    let (from, to) = (end(ends.0)?, end(ends.1)?);
    if from < 1 || from > to || to > LONGEST {
        return Err(format!("it must have 1 ≤ A ≤ B ≤ {LONGEST}"));
    }
    Ok((from, to))
}

/// 1 ≤ L
pub fn parse_length(text: &str) -> Result<usize, String> {
    let length = text.trim().parse().ok().filter(|l| (1..=LONGEST).contains(l));
    length.ok_or_else(|| format!("it must be a number of steps from 1 to {LONGEST}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_definition_is_consistent() {
        use clap::CommandFactory;
        Args::command().debug_assert();
    }

    #[test]
    fn assignments_need_both_sides() {
        assert_eq!(parse_set("a = 1 == 2"), Ok(("a".into(), "1 == 2".into())));
        for bad in ["a", "=1", "a=", " = "] {
            assert!(parse_set(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn horizons_are_ordered_and_bounded() {
        assert_eq!(parse_horizon("3..17"), Ok((3, 17)));
        for bad in ["", "3", "0..4", "5..4", "1..100001", "a..b", "1..-2", "1..99999999999999999999"] {
            assert!(parse_horizon(bad).is_err(), "{bad}");
        }
    }
}
