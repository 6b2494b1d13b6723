//! `dosmc completions` and `dosmc man`: what shells and `man` know of the command.

use std::path::Path;

use clap::{Command, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;
use serde::Serialize;

use super::args::Args;
use super::output::Output;
use super::{Status, files};
use crate::back::Artifact;

/// The name of the command.
const NAME: &str = "dosmc";

/// What `completions --json` prints.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct JsonScript {
    /// Always `done`.
    #[cfg_attr(test, schemars(extend("enum" = ["done"])))]
    status: &'static str,
    /// The shell's name.
    shell: String,
    /// The script, for the shell to read in.
    script: String,
}

/// What `man --json` prints.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct JsonManual {
    /// Always `done`.
    #[cfg_attr(test, schemars(extend("enum" = ["done"])))]
    status: &'static str,
    /// The page of the whole command, in roff.
    page: String,
}

/// What `man -o DIR --json` prints.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct JsonWritten {
    /// Always `done`.
    #[cfg_attr(test, schemars(extend("enum" = ["done"])))]
    status: &'static str,
    /// The paths of the pages.
    files: Vec<String>,
}

/// All that `man --json` prints.
#[cfg(test)]
#[derive(Serialize, schemars::JsonSchema)]
#[serde(untagged)]
#[allow(dead_code, reason = "only the schema is made of it")]
pub(super) enum JsonMan {
    /// Without a directory.
    Manual(JsonManual),
    /// With a directory.
    Written(JsonWritten),
}

/// Prints a shell's completion script.
pub fn completions(shell: Shell, output: &Output) -> Status {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Args::command(), NAME, &mut script);
    let script = String::from_utf8_lossy(&script).into_owned();
    let text = script.trim_end().to_string();
    output.result(&text, &JsonScript { status: "done", shell: shell.to_string(), script })
}

/// Prints the manual's first page, or writes all of them: one for the command and one for each of its
/// commands.
pub fn man(directory: Option<&Path>, output: &Output) -> Status {
    let pages = pages();
    let Some(directory) = directory else {
        let page = pages.into_iter().next().map(|page| page.contents).unwrap_or_default();
        let text = page.trim_end().to_string();
        return output.result(&text, &JsonManual { status: "done", page });
    };
    match files::OutputDirectory::probe(directory).and_then(|place| place.write(&pages)) {
        Ok(written) => {
            let files: Vec<String> = written.iter().map(|path| path.display().to_string()).collect();
            let said = output.say(&files.join("\n"));
            said.and_then(|()| output.json(&JsonWritten { status: "done", files }))
                .err()
                .unwrap_or(Status::Done)
        }
        Err(problem) => output.fail(problem),
    }
}

/// The manual's pages, `dosmc.1` first.
fn pages() -> Vec<Artifact> {
    let mut whole = Args::command();
    // Gives the commands their whole names and the flags of every command.
    whole.build();
    let shown = whole.get_subcommands().filter(|command| !command.is_hide_set());
    std::iter::once(&whole).chain(shown).map(page).collect()
}

fn page(command: &Command) -> Artifact {
    let version = env!("CARGO_PKG_VERSION");
    let man =
        Man::new(command.clone()).source(format!("{NAME} {version}")).manual("Plans for teams of robots");
    let help = command.get_after_long_help().map(|help| help.to_string()).unwrap_or_default();
    let first = help.lines().position(is_heading).unwrap_or(usize::MAX);
    let mut roff = Vec::new();
    // Writing to memory can't fail.
    let _ = man.render_title(&mut roff);
    let _ = man.render_name_section(&mut roff);
    let _ = man.render_synopsis_section(&mut roff);
    let _ = man.render_description_section(&mut roff);
    std::iter::once("").chain(help.lines().take(first)).for_each(|line| set(line, &mut roff));
    let _ = man.render_options_section(&mut roff);
    if command.has_subcommands() {
        let _ = man.render_subcommands_section(&mut roff);
    }
    help.lines().skip(first).for_each(|line| set(line, &mut roff));
    Artifact { name: man.get_filename(), contents: String::from_utf8_lossy(&roff).into_owned() }
}

/// Whether a line of [`help`](super::help) is a heading.
fn is_heading(line: &str) -> bool {
    line.ends_with(':') && !line.starts_with(' ')
}

/// Sets a line of [`help`](super::help): a heading as a section's, an example or a line with columns
/// by itself, all else as running text.
fn set(line: &str, roff: &mut Vec<u8>) {
    let text = line.trim_start();
    let escaped = text.replace('\\', "\\e").replace('-', "\\-");
    let apart = line.starts_with("  dosmc ") || text.contains("  ");
    // `\&` keeps a line that begins with a dot from being a request.
    let set = match line.strip_suffix(':').filter(|_| is_heading(line)) {
        Some(heading) => format!(".SH {}\n", heading.to_uppercase()),
        None if line.is_empty() => ".PP\n".to_string(),
        None if apart => format!(".nf\n\\&{escaped}\n.fi\n"),
        None => format!("\\&{escaped}\n"),
    };
    roff.extend_from_slice(set.as_bytes());
}
