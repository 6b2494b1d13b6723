//! The commands: to plan a mission, to look at its picture or page, and to read an explanation.

use std::sync::Arc;

use lsp_server::{ErrorCode, RequestId};
use lsp_types::{ExecuteCommandParams, Uri};
use serde_json::Value;

use super::document::Document;
use super::session::{Session, refusal};
use super::solve;
use crate::explain;

/// Plans the mission whose URI is the argument; answers with an [`Outcome`](solve::Outcome).
pub const SOLVE: &str = "dosmc.solve";
/// Opens the picture of the mission's last plan.
pub const OPEN_PICTURE: &str = "dosmc.openPicture";
/// Opens the page on which the last plan's robots move.
pub const OPEN_PAGE: &str = "dosmc.openPage";
/// Opens the explanation of the code that is the argument; answers with its text.
pub const EXPLAIN: &str = "dosmc.explain";

/// All commands.
pub const COMMANDS: [&str; 4] = [SOLVE, OPEN_PICTURE, OPEN_PAGE, EXPLAIN];

/// Executes a command and answers the request, at once or when what it started has ended.
pub fn execute(session: &Arc<Session>, id: RequestId, params: Value) {
    let ExecuteCommandParams { command, arguments, work_done_progress_params } =
        match serde_json::from_value(params) {
            Ok(params) => params,
            Err(error) => {
                return session.answer(id, Err(refusal(ErrorCode::InvalidParams, error.to_string())));
            }
        };
    let argument = arguments.into_iter().next().unwrap_or_default();
    let answer = match command.as_str() {
        SOLVE => match document(session, &argument) {
            Ok(document) => {
                return solve::start(session, id, document, work_done_progress_params.work_done_token);
            }
            Err(why) => Err(why),
        },
        OPEN_PICTURE => open(session, &argument, |outcome| outcome.picture),
        OPEN_PAGE => open(session, &argument, |outcome| outcome.page),
        EXPLAIN => explain(session, &argument),
        _ => Err(format!("`{command}` is no command")),
    };
    session.answer(id, answer.map_err(|why| refusal(ErrorCode::InvalidParams, why)));
}

/// The open mission that an argument names by its URI.
fn document(session: &Session, argument: &Value) -> Result<Arc<Document>, String> {
    let uri: Uri = serde_json::from_value(argument.clone())
        .map_err(|_| "the argument has to be the URI of an open mission".to_string())?;
    session.document(&uri).ok_or_else(|| format!("{} is not open", uri.as_str()))
}

fn open(
    session: &Session,
    argument: &Value,
    which: impl Fn(solve::Outcome) -> Option<std::path::PathBuf>,
) -> Result<Value, String> {
    let document = document(session, argument)?;
    let file = session.runs.outcome(&document).and_then(which);
    let file = file.ok_or("there is no plan of this text: plan it first")?;
    session.show(&file, true);
    Ok(file.to_string_lossy().into())
}

fn explain(session: &Session, argument: &Value) -> Result<Value, String> {
    let code = argument.as_str().ok_or("the argument has to be a diagnostic's code")?;
    let page = explain::PAGES.iter().find(|page| page.code == code);
    let page = page.ok_or_else(|| format!("`{code}` is no code of a diagnostic"))?;
    if let Some(file) = session.host.explanation(page) {
        session.show(&file, false);
    }
    Ok(page.text.into())
}
