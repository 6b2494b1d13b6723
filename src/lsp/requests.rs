//! The requests that the workers answer.

use std::sync::Arc;

use lsp_server::{ErrorCode, ResponseError};
use lsp_types::Uri;
use lsp_types::request::{self, Request};
use serde_json::Value;

use super::document::Document;
use super::queue::Job;
use super::session::{Session, refusal};
use super::{
    actions, completion, folding, formatting, highlight, hover, inlay, lens, navigation, outline, rename,
    selection, signature, symbols,
};

/// The answer to a request.
///
/// # Errors
/// What the client is told instead: unknown methods and documents, parameters that can't be read.
pub fn answer(session: &Session, job: Job) -> Result<Value, ResponseError> {
    let Job { method, params, documents, .. } = job;
    let open = |uri: &Uri| {
        let missing = || refusal(ErrorCode::InvalidParams, format!("{} is not open", uri.as_str()));
        documents.get(uri.as_str()).cloned().ok_or_else(missing)
    };
    /// Answers a request about a document: its parameters' field with the identifier, and the answer.
    macro_rules! about {
        ($request:ty, |$params:ident| $uri:expr, |$document:ident| $answer:expr) => {
            on::<$request>(params, |$params| {
                let $document: Arc<Document> = open(&$uri.uri)?;
                Ok($answer)
            })
        };
    }
    match method.as_str() {
        request::Completion::METHOD => {
            about!(request::Completion, |p| p.text_document_position.text_document, |d| {
                let typed = p.context.as_ref().and_then(|c| c.trigger_character.as_deref());
                completion::complete(&d, p.text_document_position.position, typed, session.client)
            })
        }
        request::CodeActionRequest::METHOD => {
            about!(request::CodeActionRequest, |p| p.text_document, |d| {
                Some(actions::actions(&d, p.range, &p.context, session.client))
            })
        }
        request::DocumentSymbolRequest::METHOD => {
            about!(request::DocumentSymbolRequest, |p| p.text_document, |d| {
                Some(outline::outline(&d, session.client))
            })
        }
        request::WorkspaceSymbolRequest::METHOD => on::<request::WorkspaceSymbolRequest>(params, |p| {
            Ok(Some(symbols::find(session, &documents, &p.query)))
        }),
        request::FoldingRangeRequest::METHOD => {
            about!(request::FoldingRangeRequest, |p| p.text_document, |d| Some(folding::folds(&d)))
        }
        request::SelectionRangeRequest::METHOD => {
            about!(request::SelectionRangeRequest, |p| p.text_document, |d| {
                Some(selection::ranges(&d, &p.positions))
            })
        }
        request::Formatting::METHOD => {
            about!(request::Formatting, |p| p.text_document, |d| formatting::whole(&d))
        }
        request::RangeFormatting::METHOD => {
            about!(request::RangeFormatting, |p| p.text_document, |d| formatting::range(&d, p.range))
        }
        request::CodeLensRequest::METHOD => {
            about!(request::CodeLensRequest, |p| p.text_document, |d| Some(lens::lenses(&d, session)))
        }
        request::GotoDefinition::METHOD => {
            about!(request::GotoDefinition, |p| p.text_document_position_params.text_document, |d| {
                navigation::definition(&d, p.text_document_position_params.position)
            })
        }
        request::GotoTypeDefinition::METHOD => {
            about!(request::GotoTypeDefinition, |p| p.text_document_position_params.text_document, |d| {
                navigation::type_definition(&d, p.text_document_position_params.position)
            })
        }
        request::References::METHOD => {
            about!(request::References, |p| p.text_document_position.text_document, |d| {
                let position = p.text_document_position.position;
                navigation::references(&d, position, p.context.include_declaration)
            })
        }
        request::PrepareRenameRequest::METHOD => {
            about!(request::PrepareRenameRequest, |p| p.text_document, |d| {
                Some(rename::prepare(&d, p.position).map_err(failed)?)
            })
        }
        request::Rename::METHOD => {
            about!(request::Rename, |p| p.text_document_position.text_document, |d| {
                let position = p.text_document_position.position;
                Some(rename::rename(&d, position, &p.new_name).map_err(failed)?)
            })
        }
        request::DocumentHighlightRequest::METHOD => {
            about!(
                request::DocumentHighlightRequest,
                |p| p.text_document_position_params.text_document,
                |d| highlight::highlights(&d, p.text_document_position_params.position)
            )
        }
        request::InlayHintRequest::METHOD => {
            about!(request::InlayHintRequest, |p| p.text_document, |d| Some(inlay::hints(&d, p.range)))
        }
        request::SignatureHelpRequest::METHOD => {
            about!(request::SignatureHelpRequest, |p| p.text_document_position_params.text_document, |d| {
                signature::help(&d, p.text_document_position_params.position)
            })
        }
        request::SemanticTokensFullRequest::METHOD => {
            about!(request::SemanticTokensFullRequest, |p| p.text_document, |d| {
                Some(session.colours.full(&d).into())
            })
        }
        request::SemanticTokensFullDeltaRequest::METHOD => {
            about!(request::SemanticTokensFullDeltaRequest, |p| p.text_document, |d| {
                Some(session.colours.delta(&d, &p.previous_result_id))
            })
        }
        request::SemanticTokensRangeRequest::METHOD => {
            about!(request::SemanticTokensRangeRequest, |p| p.text_document, |d| {
                Some(session.colours.range(&d, p.range).into())
            })
        }
        request::HoverRequest::METHOD => {
            about!(request::HoverRequest, |p| p.text_document_position_params.text_document, |d| {
                hover::hover(&d, p.text_document_position_params.position, &session.tubes)
            })
        }
        _ => Err(refusal(ErrorCode::MethodNotFound, format!("`{method}` is not known here"))),
    }
}

/// The answer to what can't be done, with the reason for people.
fn failed(why: String) -> ResponseError {
    refusal(ErrorCode::RequestFailed, why)
}

/// Reads a request's parameters, and makes its answer a value.
fn on<R: Request>(
    params: Value,
    act: impl FnOnce(R::Params) -> Result<R::Result, ResponseError>,
) -> Result<Value, ResponseError> {
    let params =
        serde_json::from_value(params).map_err(|e| refusal(ErrorCode::InvalidParams, e.to_string()))?;
    let result = act(params)?;
    serde_json::to_value(result).map_err(|e| refusal(ErrorCode::InternalError, e.to_string()))
}
