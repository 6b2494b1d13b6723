//! `dosmc completions` and `dosmc man`: what shells and `man` know of the command.

use std::path::Path;

use clap::{Command, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;
use serde_json::json;

use super::args::Args;
use super::output::Output;
use super::{Status, files};
use crate::back::Artifact;

/// The name of the command.
const NAME: &str = "dosmc";

/// Prints a shell's completion script.
pub fn completions(shell: Shell, output: &Output) -> Status {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Args::command(), NAME, &mut script);
    let script = String::from_utf8_lossy(&script);
    output.result(script.trim_end(), &json!({"shell": shell.to_string(), "script": script}))
}

/// Prints the manual's first page, or writes all of them: one for the command and one for each of its
/// commands.
pub fn man(directory: Option<&Path>, output: &Output) -> Status {
    let pages = pages();
    let Some(directory) = directory else {
        let page = pages.first().map_or("", |page| page.contents.as_str());
        return output.result(page.trim_end(), &json!({"page": page}));
    };
    match files::OutputDirectory::probe(directory).and_then(|place| place.write(&pages)) {
        Ok(written) => {
            let lines: Vec<String> = written.iter().map(|path| path.display().to_string()).collect();
            let said = output.say(&lines.join("\n")).and_then(|()| output.json(&json!({"written": lines})));
            said.err().unwrap_or(Status::Done)
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
    let man = Man::new(command.clone())
        .source(format!("{NAME} {}", env!("CARGO_PKG_VERSION")))
        .manual("Plans for teams of robots");
    let mut roff = Vec::new();
    // Writing to memory can't fail.
    let _ = man.render(&mut roff);
    Artifact { name: man.get_filename(), contents: String::from_utf8_lossy(&roff).into_owned() }
}
