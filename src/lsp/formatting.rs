//! The one style, as edits.

use lsp_types::{Range, TextEdit};

use super::document::Document;
use crate::diag::Diagnostics;
use crate::source::Span;
use crate::syntax::format;

/// The edits that bring a mission into the style; `None` where it can't be read.
pub fn whole(document: &Document) -> Option<Vec<TextEdit>> {
    Some(edits(document)?.into_iter().map(|(_, edit)| edit).collect())
}

/// Those of the edits that lie in a range.
pub fn range(document: &Document, range: Range) -> Option<Vec<TextEdit>> {
    let within = document.lines.span_of(range);
    let edits = edits(document)?.into_iter();
    Some(
        edits
            .filter(|(span, _)| span.start >= within.start && span.end <= within.end)
            .map(|(_, e)| e)
            .collect(),
    )
}

fn edits(document: &Document) -> Option<Vec<(Span, TextEdit)>> {
    let edits = format::edits(&document.source, &mut Diagnostics::new()).ok()?;
    let edit = |(span, new_text)| (span, TextEdit { range: document.range(span), new_text });
    Some(edits.into_iter().map(edit).collect())
}
