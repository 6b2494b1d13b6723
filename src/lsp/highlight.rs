//! The other places of the name under the cursor.

use lsp_types::{DocumentHighlight, DocumentHighlightKind, Position};

use super::Document;
use super::index::Role;

/// All places of the name at a position: where it is declared or given a value, and where it is read.
pub fn highlights(document: &Document, position: Position) -> Option<Vec<DocumentHighlight>> {
    let index = document.index();
    let symbol = index.at(document.offset(position))?.symbol;
    let kind = |role| match role {
        Role::Declaration | Role::Write => DocumentHighlightKind::WRITE,
        Role::Read => DocumentHighlightKind::READ,
        Role::Guess => DocumentHighlightKind::TEXT,
    };
    let places = index.occurrences_of(symbol);
    Some(
        places
            .map(|o| DocumentHighlight { range: document.range(o.span), kind: Some(kind(o.role)) })
            .collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::driver::Overrides;
    use crate::lsp::Encoding;

    #[test]
    fn places_are_told_apart_by_what_they_do() {
        let text = "dosm 1 dynamics D { step 1 s state px: m input u: m position px bound px in [0, 1] }\n\
            robot r: D at { px = 1 } region px2 = bo (k, k) let k = 2 let j = k";
        let uri = "file:///m.dosm".parse().expect("it is a URI");
        let document = Document::new(uri, 1, text.into(), Encoding::Utf16, Overrides::default());
        let kinds = |word: &str| -> Vec<DocumentHighlightKind> {
            let at = document.lines.position(text.find(word).expect("there") as u32);
            highlights(&document, at).unwrap_or_default().iter().filter_map(|h| h.kind).collect()
        };
        use DocumentHighlightKind as K;
        assert_eq!(kinds("px: m"), [K::WRITE, K::READ, K::WRITE, K::WRITE]);
        assert_eq!(kinds("k, k"), [K::TEXT, K::TEXT, K::WRITE, K::READ]);
        assert_eq!(highlights(&document, Position::new(0, 0)), None);
    }
}
