//! Names in declarations that can't be read: words that are names of the mission, taken as such.

use crate::lsp::index::{Index, Occurrence, Role};
use crate::source::Span;
use crate::syntax::ast::{Broken, File};

impl Index {
    /// Takes each word of a broken declaration that is a name of the mission for an occurrence of it.
    ///
    /// Bound variables and signals can't be told there, so that a name that is one of them by chance is
    /// taken for the mission's.
    pub(super) fn guess(&mut self, file: &File, text: &str) {
        for broken in &file.broken {
            let Some(lost) = text.get(broken.span.range()) else { continue };
            for (at, word) in words(lost) {
                let start = broken.span.start as usize + at;
                self.guess_word(broken, Span::new(start, start + word.len()), word);
            }
        }
    }

    fn guess_word(&mut self, broken: &Broken, span: Span, word: &str) {
        let is_declared = broken.name.as_ref().is_some_and(|name| name.span == span);
        if let Some(symbol) = self.global(word).filter(|_| !is_declared) {
            self.occurrences.push(Occurrence { span, symbol, role: Role::Guess });
        }
    }
}

/// The words of a text outside of comments, each with its place.
fn words(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let bytes = text.as_bytes();
    let mut at = 0;
    std::iter::from_fn(move || {
        loop {
            let rest = bytes.get(at..)?;
            let run = |kind: fn(&u8) -> bool| rest.iter().take_while(|b| kind(b)).count();
            match rest {
                [] => return None,
                [b'/', b'/', ..] => at += run(|b| *b != b'\n'),
                [b'/', b'*', ..] => at += comment_length(rest),
                [b, ..] if b.is_ascii_alphanumeric() || *b == b'_' => {
                    let start = at;
                    at += run(|b| b.is_ascii_alphanumeric() || *b == b'_');
                    if !b.is_ascii_digit() {
                        return text.get(start..at).map(|word| (start, word));
                    }
                }
                _ => at += 1,
            }
        }
    })
}

/// The length of the nesting comment that a text begins with.
fn comment_length(bytes: &[u8]) -> usize {
    let (mut depth, mut at) = (0usize, 0);
    while let Some(two) = bytes.get(at..at + 2) {
        match two {
            b"/*" => (depth, at) = (depth + 1, at + 2),
            b"*/" => (depth, at) = (depth.saturating_sub(1), at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            return at;
        }
    }
    bytes.len()
}
