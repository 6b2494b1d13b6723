//! `dosmc render`: the picture of a plan that checks.

use std::path::Path;
use std::time::Duration;

use serde::Serialize;

use super::files::OutputFile;
use super::output::Output;
use super::verify::{self, Examined};
use super::{Status, png, simulate};
use crate::back::{html, svg};
use crate::diag::{Diagnostic, printable};
use crate::driver::{self, Encoding, Overrides};
use crate::simulate::Options;

/// What `render --json` prints; for a plan that is refused it prints what `verify --json` does.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct JsonRender {
    /// Always `drawn`.
    #[cfg_attr(test, schemars(extend("enum" = ["drawn"])))]
    status: &'static str,
    /// Whether the plan was made from the same source text.
    same_text: bool,
    /// The picture's path.
    file: String,
}

/// All that `render --json` prints.
#[cfg(test)]
#[derive(Serialize, schemars::JsonSchema)]
#[serde(untagged)]
#[allow(dead_code, reason = "only the schema is made of it")]
pub(super) enum JsonRendered {
    /// A picture.
    Drawn(JsonRender),
    /// A plan that is refused.
    Refused(verify::JsonVerify),
}

/// How a picture is written; a page is one that moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Svg,
    Png,
    Html,
}

/// What is to be drawn.
pub struct Wanted<'a> {
    /// The picture's file.
    pub file: &'a Path,
    /// With the paper's encoding: the cells too.
    pub encoding: Encoding,
    /// Runs to simulate and draw over the nominal ways.
    pub runs: Options,
}

/// Draws a plan of a mission, if it checks.
pub fn render(
    plan: &Path,
    mission: &Path,
    wanted: &Wanted<'_>,
    overrides: &Overrides,
    timeout: Option<Duration>,
    output: &Output,
) -> Status {
    let prepared = format(wanted.file).and_then(|format| Ok((format, OutputFile::probe(wanted.file)?)));
    let (format, file) = match prepared {
        Ok(prepared) => prepared,
        Err(problem) => return output.fail(problem),
    };
    match verify::examine(plan, mission, overrides, timeout, output) {
        Ok(examined) if examined.report.holds() => {
            draw(&examined, format, wanted, &file, output).unwrap_or_else(|status| status)
        }
        Ok(refused) => verify::tell(&refused, output),
        Err(status) => status,
    }
}

/// The format that a file's name asks for.
///
/// # Errors
/// A diagnostic for any other name, and for formats that this program was built without.
fn format(file: &Path) -> Result<Format, Diagnostic> {
    let extension = file.extension().map(|e| e.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("svg") => Ok(Format::Svg),
        Some("html") => Ok(Format::Html),
        Some("png") => png::available().map(|()| Format::Png),
        _ => {
            let name = file.to_string_lossy();
            let problem =
                super::usage(format!("`{}` is no kind of picture that can be drawn", printable(&name)));
            Err(problem.with_help(if png::available().is_ok() {
                "FILE.svg, FILE.html and FILE.png can"
            } else {
                "FILE.svg and FILE.html can, and FILE.png in a dosmc built with `--features png`"
            }))
        }
    }
}

/// Draws the plan and says where.
fn draw(
    examined: &Examined,
    format: Format,
    wanted: &Wanted<'_>,
    file: &OutputFile,
    output: &Output,
) -> Result<Status, Status> {
    let Examined { problem, plan, report, .. } = examined;
    let fail = |problem| output.fail(problem);
    let cells = match wanted.encoding {
        Encoding::HalfSpaces => Vec::new(),
        Encoding::Paper => driver::cells_of(problem).map_err(|e| fail(super::usage(e.to_string())))?,
    };
    let runs = simulate::flights(examined, &wanted.runs).map_err(fail)?;
    let options = svg::Options { cells: &cells, runs: &runs };
    let drawn = || svg::draw(problem, plan, &options).contents;
    let bytes = match format {
        Format::Svg => drawn().into_bytes(),
        Format::Png => png::from_svg(&drawn()).map_err(fail)?,
        Format::Html => html::write(problem, plan, &options).contents.into_bytes(),
    };
    let written = file.write(&bytes).map_err(fail)?.to_string_lossy().into_owned();
    if !report.same_text {
        output.note("warning: the plan was made from another text of the mission; it holds for this one too");
    }
    output.say(&format!("plan checked exactly and drawn\n  {}", printable(&written)))?;
    output.json(&JsonRender { status: "drawn", same_text: report.same_text, file: written })?;
    Ok(Status::Done)
}
