//! `dosmc explain`: what a diagnostic means, at length.

use serde::Serialize;

use super::Status;
use super::output::{Output, plain_error};
use crate::diag::{Diagnostic, printable};
use crate::explain::{self, Found, PAGES, Page};

/// A page as `explain --json` prints it.
#[derive(Serialize)]
struct JsonPage {
    code: &'static str,
    title: &'static str,
    /// The whole page, in Markdown.
    #[serde(skip_serializing_if = "Option::is_none")]
    page: Option<&'static str>,
}

/// What `explain --json` without a code prints.
#[derive(Serialize)]
struct JsonList {
    codes: Vec<JsonPage>,
}

/// Prints a code's page, or the list of all codes.
pub fn explain(code: Option<&str>, output: &Output) -> Status {
    let Some(code) = code else { return list(output) };
    match explain::find(code) {
        Found::Page(page) => {
            let drawn = explain::draw(page.text, output.result_style);
            output.result(drawn.trim_end(), &json(page, Some(page.text)))
        }
        Found::Several(pages) => output.fail(ambiguous(code, &pages)),
        Found::None(near) => output.fail(unknown(code, &near)),
    }
}

fn list(output: &Output) -> Status {
    let widest = PAGES.iter().map(|page| page.code.len()).max().unwrap_or(0);
    let lines = PAGES.iter().map(|page| format!("{:widest$}  {}", page.code, page.headline()));
    let text = lines.collect::<Vec<_>>().join("\n");
    output.result(&text, &JsonList { codes: PAGES.iter().map(|page| json(page, None)).collect() })
}

fn json(page: &Page, text: Option<&'static str>) -> JsonPage {
    JsonPage { code: page.code, title: page.headline(), page: text }
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
