//! The first look at a text: comments, documentation, nesting, odd characters, and where declarations begin.
//!
//! The words that begin declarations are reserved everywhere, so the text falls into stretches from one of
//! them to the next before anything is parsed, and an error in one stretch leaves the others alone. Nesting is
//! counted here, so that whatever recurses later recurses at most [`MAX_NESTING`] deep.

use std::ops::Range;

use crate::diag::Diagnostic;
use crate::source::Span;
use crate::syntax::ast::Doc;
use crate::syntax::characters::{self, Character};
use crate::syntax::condensed::Condensed;
use crate::syntax::docs::{self, Docs};
use crate::syntax::error;
use crate::syntax::words::DECLARATIONS;

/// The most levels of brackets, and of comments.
pub(super) const MAX_NESTING: usize = 256;

/// The longest name, in bytes.
pub(super) const MAX_NAME: usize = 64;

/// What the scan finds.
pub(super) struct Scan {
    /// The text for the parser.
    pub(super) condensed: Condensed,
    /// From one declaration's keyword to the next; the first one may lack a keyword.
    pub(super) stretches: Vec<Stretch>,
    /// The documentation comments.
    pub(super) docs: Docs,
    /// What is wrong with single characters, names and comments.
    pub(super) errors: Vec<Diagnostic>,
}

/// A part of the condensed text that should be one declaration.
pub(super) struct Stretch {
    /// Where it lies in the condensed text.
    pub(super) range: Range<usize>,
    /// Whether something in it was already reported.
    pub(super) reported: bool,
    /// The first bracket that isn't closed in it, or the first that closes nothing.
    pub(super) bracket: Option<Bracket>,
}

/// A bracket without its partner.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Bracket {
    /// The sign.
    pub(super) sign: char,
    /// Its place in the source.
    pub(super) offset: usize,
    /// Whether it is an opening one.
    pub(super) opening: bool,
}

/// Scans a text.
///
/// # Errors
/// When brackets or comments nest too deep, or there are too many errors to go on.
pub(super) fn scan(source: &str) -> Result<Scan, Diagnostic> {
    let mut scanner = Scanner::new(source);
    while let Some(next) = scanner.rest().chars().next() {
        scanner.step(next)?;
        if scanner.scan.errors.len() > error::MAX_ERRORS {
            return Err(error::too_many(scanner.here(0)));
        }
    }
    scanner.end_stretch();
    for doc in scanner.pending_docs.drain(..) {
        scanner.scan.docs.add_stray(doc.span);
    }
    Ok(scanner.scan)
}

struct Scanner<'s> {
    source: &'s str,
    position: usize,
    scan: Scan,
    open: Vec<(char, usize)>,
    stretch: Stretch,
    after_opaque: bool,
    /// `///` comments that wait for the token behind them.
    pending_docs: Vec<Doc>,
}

impl<'s> Scanner<'s> {
    fn new(source: &'s str) -> Scanner<'s> {
        let scan = Scan {
            condensed: Condensed::default(),
            stretches: Vec::new(),
            docs: Docs::default(),
            errors: Vec::new(),
        };
        // A byte order mark means nothing in UTF-8.
        let position = if source.starts_with('\u{feff}') { 3 } else { 0 };
        Scanner {
            source,
            position,
            scan,
            open: Vec::new(),
            stretch: Stretch { range: 0..0, reported: false, bracket: None },
            after_opaque: false,
            pending_docs: Vec::new(),
        }
    }

    fn rest(&self) -> &'s str {
        self.source.get(self.position..).unwrap_or("")
    }

    /// The span of the next `length` bytes.
    fn here(&self, length: usize) -> Span {
        Span::new(self.position, self.position + length)
    }

    /// The length of the run at the position whose bytes are all of a kind.
    fn run(&self, kind: impl Fn(u8) -> bool) -> usize {
        self.rest().bytes().take_while(|&b| kind(b)).count()
    }

    fn step(&mut self, next: char) -> Result<(), Diagnostic> {
        match next {
            ' ' | '\t' | '\r' | '\n' => {
                self.position += self.run(|b| matches!(b, b' ' | b'\t' | b'\r' | b'\n'));
                self.scan.condensed.separate();
            }
            '/' if self.rest().starts_with("//") => self.line_comment(),
            '/' if self.rest().starts_with("/*") => self.block_comment()?,
            'a'..='z' | 'A'..='Z' | '_' => self.word(),
            '0'..='9' => self.digits(),
            '(' | '[' | '{' => self.opening(next)?,
            ')' | ']' | '}' => self.closing(next),
            '!'..='~' | '±' => self.token(next.len_utf8()),
            _ => self.odd_character(next),
        }
        Ok(())
    }

    /// Hands on the next `length` bytes.
    fn token(&mut self, length: usize) {
        self.place_docs();
        let piece = self.source.get(self.position..self.position + length).unwrap_or("");
        self.scan.condensed.push(piece, self.position);
        self.position += length;
    }

    /// Hands on `piece` in place of the next `length` bytes.
    fn replaced_token(&mut self, piece: &str, length: usize) {
        self.place_docs();
        self.scan.condensed.replace(piece, self.position, length);
        self.position += length;
    }

    /// Documentation belongs to the token that comes now.
    fn place_docs(&mut self) {
        let place = self.scan.condensed.next_start();
        for doc in self.pending_docs.drain(..) {
            self.scan.docs.add(place, doc);
        }
        self.after_opaque = false;
    }

    fn word(&mut self) {
        let length = self.run(|b| b.is_ascii_alphanumeric() || b == b'_');
        let word = self.source.get(self.position..self.position + length).unwrap_or("");
        if DECLARATIONS.contains(&word) && !(word == "obstacle" && self.after_opaque) {
            self.end_stretch();
        }
        if length > MAX_NAME {
            self.report(error::long_name(self.here(length), length));
            self.replaced_token(word.get(..MAX_NAME).unwrap_or(word), length);
        } else {
            self.token(length);
        }
        self.after_opaque = word == "opaque";
    }

    /// Digits with whatever touches them; so many that the number's limit is passed are not handed on.
    fn digits(&mut self) {
        let length = self.run(|b| b.is_ascii_alphanumeric() || b == b'_');
        if length > error::MAX_DIGITS {
            self.report(error::number_too_long(self.here(length), length));
            self.replaced_token("1", length);
        } else {
            self.token(length);
        }
    }

    fn opening(&mut self, sign: char) -> Result<(), Diagnostic> {
        if self.open.len() >= MAX_NESTING {
            return Err(error::too_nested(self.here(1), "brackets"));
        }
        self.open.push((sign, self.position));
        self.token(1);
        Ok(())
    }

    fn closing(&mut self, sign: char) {
        let partner = match sign {
            ')' => '(',
            ']' => '[',
            _ => '{',
        };
        match self.open.last() {
            Some(&(open, _)) if open == partner => {
                self.open.pop();
            }
            Some(&(open, offset)) => self.lone_bracket(Bracket { sign: open, offset, opening: true }),
            None => self.lone_bracket(Bracket { sign, offset: self.position, opening: false }),
        }
        self.token(1);
    }

    fn lone_bracket(&mut self, bracket: Bracket) {
        self.stretch.bracket.get_or_insert(bracket);
    }

    /// Ends the stretch before the token at the position, or at the end of the text.
    fn end_stretch(&mut self) {
        if let Some(&(sign, offset)) = self.open.last() {
            self.lone_bracket(Bracket { sign, offset, opening: true });
        }
        self.open.clear();
        let end = self.scan.condensed.text().len();
        let next = self.scan.condensed.next_start();
        let fresh = Stretch { range: next..next, reported: false, bracket: None };
        let mut done = std::mem::replace(&mut self.stretch, fresh);
        done.range.end = end;
        if done.range.start < end {
            self.scan.stretches.push(done);
        }
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        self.stretch.reported = true;
        self.scan.errors.push(diagnostic);
    }

    fn odd_character(&mut self, character: char) {
        match characters::classify(character) {
            Character::Hidden(name) => {
                self.report(error::hidden_character(self.here(character.len_utf8()), character, name));
                self.position += character.len_utf8();
                self.scan.condensed.separate();
            }
            Character::Lookalike(meant) => {
                self.report(error::lookalike(self.here(character.len_utf8()), character, meant));
                self.lookalike(character, meant);
            }
            Character::Letter => {
                let is_word = |c: &char| c.is_alphanumeric() || *c == '_';
                let length = self.rest().chars().take_while(is_word).map(char::len_utf8).sum();
                let before = self.source.get(..self.position).unwrap_or("");
                let start = before.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_').len();
                let span = Span::new(start, self.position + length);
                self.report(error::foreign_letter(span, character));
                self.replaced_token("_", length);
            }
            Character::Other => {
                self.report(error::unknown_character(self.here(character.len_utf8()), character));
                self.position += character.len_utf8();
            }
        }
    }

    /// Reads on as if `meant` stood there; brackets are left out, so that all that go on are counted.
    fn lookalike(&mut self, character: char, meant: &'static str) {
        let word = meant.starts_with(|c: char| c.is_ascii_alphabetic()) && !character.is_alphanumeric();
        if word || matches!(meant, "(" | ")" | "[" | "]" | "{" | "}") {
            self.scan.condensed.separate();
        }
        if matches!(meant, "(" | ")" | "[" | "]" | "{" | "}") {
            self.position += character.len_utf8();
            return;
        }
        self.replaced_token(meant, character.len_utf8());
        if word {
            self.scan.condensed.separate();
        }
    }

    fn line_comment(&mut self) {
        let length = self.run(|b| b != b'\n');
        let span = self.here(length);
        let text = self.source.get(span.range()).unwrap_or("").trim_end_matches('\r');
        self.check_comment(text);
        if text.starts_with("//!") {
            self.inner_doc(text, span);
        } else if text.starts_with("///") && !text.starts_with("////") {
            self.outer_doc(text, span);
        }
        self.position += length;
        self.scan.condensed.separate();
    }

    fn inner_doc(&mut self, text: &str, span: Span) {
        if self.scan.condensed.text().is_empty() && self.pending_docs.is_empty() {
            self.scan.docs.add_inner(Doc { text: docs::line_text(text).to_owned(), span });
        } else {
            self.scan.docs.add_stray(span);
        }
    }

    /// A `///` comment documents what follows only if it stands alone on its line.
    fn outer_doc(&mut self, text: &str, span: Span) {
        let before = self.source.get(..self.position).unwrap_or("");
        let line = before.rfind('\n').map_or(before, |i| before.get(i..).unwrap_or(""));
        if line.trim_start_matches('\u{feff}').trim().is_empty() {
            self.pending_docs.push(Doc { text: docs::line_text(text).to_owned(), span });
        } else {
            self.scan.docs.add_stray(span);
        }
    }

    /// Skips a comment with those inside it; one that doesn't end swallows the rest of the text.
    fn block_comment(&mut self) -> Result<(), Diagnostic> {
        let start = self.position;
        let bytes = self.source.as_bytes();
        let mut depth = 0usize;
        let mut at = start;
        loop {
            match (bytes.get(at), bytes.get(at + 1)) {
                (Some(b'/'), Some(b'*')) if depth >= MAX_NESTING => {
                    return Err(error::too_nested(Span::new(at, at + 2), "comments"));
                }
                (Some(b'/'), Some(b'*')) => (depth, at) = (depth + 1, at + 2),
                (Some(b'*'), Some(b'/')) => (depth, at) = (depth - 1, at + 2),
                (Some(_), _) => at += 1,
                (None, _) => {
                    self.report(error::unclosed_comment(Span::new(start, start + 2)));
                    at = bytes.len();
                    break;
                }
            }
            if depth == 0 {
                break;
            }
        }
        self.check_comment(self.source.get(start..at).unwrap_or(""));
        self.position = at;
        self.scan.condensed.separate();
        Ok(())
    }

    /// Reports what must not even stand in a comment: what a terminal obeys or an editor shows reordered.
    fn check_comment(&mut self, text: &str) {
        let start = self.position;
        for (i, character) in text.char_indices() {
            if let Some(name) = characters::hidden_in_comment(character) {
                let span = Span::new(start + i, start + i + character.len_utf8());
                self.scan.errors.push(error::hidden_character(span, character, name));
                if self.scan.errors.len() > error::MAX_ERRORS {
                    return;
                }
            }
        }
    }
}
