//! `dosmc explain`: what a diagnostic means, at length.

use serde::Serialize;

use super::Status;
use super::output::{Output, plain_error};
use crate::diag::{Diagnostic, printable};
use crate::explain::{self, Found, PAGES, Page};

/// What `explain --json` prints of a code.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct JsonPage {
    /// Always `done`.
    #[cfg_attr(test, schemars(extend("enum" = ["done"])))]
    status: &'static str,
    /// The stable code.
    code: &'static str,
    /// The page's headline.
    title: &'static str,
    /// The whole page, in Markdown.
    page: &'static str,
}

/// What `explain --json` prints of a phase, or of all codes.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct JsonList {
    /// Always `done`.
    #[cfg_attr(test, schemars(extend("enum" = ["done"])))]
    status: &'static str,
    /// The codes in order.
    codes: Vec<JsonCode>,
}

/// A code in the list.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct JsonCode {
    /// The stable code.
    code: &'static str,
    /// The headline of its page.
    title: &'static str,
}

/// All that `explain --json` prints.
#[cfg(test)]
#[derive(Serialize, schemars::JsonSchema)]
#[serde(untagged)]
#[allow(dead_code, reason = "only the schema is made of it")]
pub(super) enum JsonExplained {
    /// With a code.
    Page(JsonPage),
    /// With a phase, or with nothing.
    List(JsonList),
}

/// Prints a code's page, or the list of all codes.
pub fn explain(code: Option<&str>, output: &Output) -> Status {
    let Some(code) = code else { return list(&PAGES.iter().collect::<Vec<_>>(), output) };
    match explain::find(code) {
        Found::Page(page) => {
            let drawn = explain::draw(page.text, output.result_style);
            let (code, title) = (page.code, page.headline());
            output.result(drawn.trim_end(), &JsonPage { status: "done", code, title, page: page.text })
        }
        Found::Phase(pages) => list(&pages, output),
        Found::Several(pages) => output.fail(ambiguous(code, &pages)),
        Found::None(near) => output.fail(unknown(code, &near)),
    }
}

fn list(pages: &[&Page], output: &Output) -> Status {
    let widest = pages.iter().map(|page| page.code.len()).max().unwrap_or(0);
    let lines = pages.iter().map(|page| format!("{:widest$}  {}", page.code, page.headline()));
    let text = lines.collect::<Vec<_>>().join("\n");
    let codes = pages.iter().map(|page| JsonCode { code: page.code, title: page.headline() }).collect();
    output.result(&text, &JsonList { status: "done", codes })
}

fn unknown(code: &str, near: &[&Page]) -> Diagnostic {
    let message = format!("there is no diagnostic `{}`", printable(code));
    let help = match near {
        [] => "`dosmc explain` alone lists all codes".into(),
        near => format!("did you mean {}?", codes(near)),
    };
    plain_error("dosm::cli::unknown_code", message).with_help(help)
}

fn ambiguous(code: &str, pages: &[&Page]) -> Diagnostic {
    let message = format!("`{}` is the name of {} diagnostics", printable(code), pages.len());
    plain_error("dosm::cli::unknown_code", message).with_help(format!("which one: {}?", codes(pages)))
}

/// `a, b or c`, as codes.
fn codes(pages: &[&Page]) -> String {
    let quoted: Vec<String> = pages.iter().map(|page| format!("`{}`", page.code)).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => quoted.concat(),
    }
}
