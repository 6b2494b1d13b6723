//! What has to change in a text to bring it into the style, gap by gap between its tokens.

use crate::source::Span;
use crate::syntax::token::{Token, tokens};

/// The edits that make one text of another which differs from it in blanks; they do not touch one another,
/// and stand in the order of the text.
///
/// Where tokens differ, too, all of it is one edit.
pub(super) fn between(before: &str, after: &str) -> Vec<(Span, String)> {
    // Semicolons between items count as blanks: they may go.
    let essential = |text| tokens(text).into_iter().filter(|t| !t.is(";")).collect::<Vec<Token<'_>>>();
    let (old, new) = (essential(before), essential(after));
    let alike = old.len() == new.len() && old.iter().zip(&new).all(|(a, b)| a.kind == b.kind);
    if !alike {
        return vec![(Span::new(0, before.len()), after.to_string())];
    }
    let (mut edits, mut from) = (Vec::new(), (0, 0));
    let ends = (before.len(), after.len());
    for (old, new) in old.iter().map(Some).chain([None]).zip(new.iter().map(Some).chain([None])) {
        let to = (old.map_or(ends.0, |t| t.start), new.map_or(ends.1, |t| t.start));
        push(&mut edits, (before, from.0, to.0), (after, from.1, to.1));
        from = (old.map_or(to.0, end), new.map_or(to.1, end));
        // Blanks at the ends of a comment's lines.
        push(&mut edits, (before, to.0, from.0), (after, to.1, from.1));
    }
    edits
}

/// The end of a token's text: blanks behind a comment are none of it.
fn end(token: &Token<'_>) -> usize {
    token.start + token.text.len()
}

/// Adds the edit that makes a part of one text a part of another, where they differ.
fn push(edits: &mut Vec<(Span, String)>, old: (&str, usize, usize), new: (&str, usize, usize)) {
    let (was, is) = (&old.0[old.1..old.2], &new.0[new.1..new.2]);
    if was != is {
        edits.push((Span::new(old.1, old.2), is.to_string()));
    }
}
