//! A mission in an editor: its text at one moment, and what is known of it.

use std::sync::{Arc, Mutex, OnceLock};

use lsp_types::{Position, Range, TextDocumentContentChangeEvent, Uri};

use super::index::Index;
use super::lines::{Encoding, Lines};
use super::location;
use super::session::lock;
use crate::check::{Facts, check_with_facts};
use crate::diag::{Diagnostic, Diagnostics};
use crate::driver::{self, Mission, Overrides};
use crate::ir::{Problem, Spans};
use crate::law::Float;
use crate::source::{SourceFile, Span};
use crate::syntax::{self, Memory, ast};

/// A mission at one moment; what is known of it is found out when it is first asked for.
pub struct Document {
    /// What the editor calls it.
    pub uri: Uri,
    /// The editor's number for this moment.
    pub version: i32,
    /// The text, called by its path.
    pub source: SourceFile,
    /// Converts the editor's places.
    pub lines: Lines,
    overrides: Overrides,
    /// What was read of earlier moments.
    memory: Arc<Mutex<Memory>>,
    index: OnceLock<Index>,
    facts: OnceLock<Option<Facts>>,
    front: OnceLock<Front>,
    whole: OnceLock<Whole>,
}

/// What reading and checking a mission says.
pub struct Front {
    /// The tree; `None` where nothing useful can be read.
    pub file: Option<ast::File>,
    /// What the mission means, where it has no errors.
    pub meaning: Option<(Problem, Spans)>,
    /// What was said.
    pub diagnostics: Diagnostics,
}

/// What `dosmc check` says.
pub struct Whole {
    /// The mission with its tubes, where it has no errors.
    pub mission: Option<Mission>,
    /// What was said, by all phases.
    pub diagnostics: Diagnostics,
}

impl Document {
    /// A mission as it was opened.
    pub fn new(uri: Uri, version: i32, text: String, encoding: Encoding, overrides: Overrides) -> Document {
        let lines = Lines::new(&text, encoding);
        let source = SourceFile::new(location::name(&uri), text);
        let (index, facts) = (OnceLock::new(), OnceLock::new());
        let (front, whole) = (OnceLock::new(), OnceLock::new());
        let memory = Arc::default();
        Document { uri, version, source, lines, overrides, memory, index, facts, front, whole }
    }

    /// The mission after some changes, made one after the other.
    pub fn changed(
        &self,
        version: i32,
        changes: Vec<TextDocumentContentChangeEvent>,
        encoding: Encoding,
    ) -> Document {
        let mut text = self.source.text.clone();
        // Changes often come from the last to the first: what stands before one keeps its place.
        let (mut anew, mut kept): (Option<Lines>, Option<Position>) = (None, None);
        for change in changes {
            let Some(range) = change.range else {
                text = change.text;
                (anew, kept) = (None, Some(Position::default()));
                continue;
            };
            // At a line's start, a `\n` may have come behind the `\r` that was the line break.
            if kept.is_some_and(|kept| range.end > kept || range.end == kept && kept.character == 0) {
                (anew, kept) = (Some(Lines::new(&text, encoding)), None);
            }
            let lines = anew.as_ref().unwrap_or(&self.lines);
            text.replace_range(lines.span_of(range).range(), &change.text);
            kept = Some(kept.map_or(range.start, |kept| kept.min(range.start)));
        }
        let overrides = self.overrides.clone();
        let memory = Arc::clone(&self.memory);
        Document { memory, ..Document::new(self.uri.clone(), version, text, encoding, overrides) }
    }

    /// What reading and checking says; found out at the first call.
    pub fn front(&self) -> &Front {
        self.front.get_or_init(|| {
            let mut diagnostics = Diagnostics::new();
            let file = syntax::parse_again(&self.source, &mut lock(&self.memory), &mut diagnostics).ok();
            let meaning = file
                .as_ref()
                .and_then(|file| driver::meaning(file, &self.source, &self.overrides, &mut diagnostics).ok());
            Front { file, meaning, diagnostics }
        })
    }

    /// What all phases before a search say; found out at the first call, which takes the time of tubes.
    pub fn whole(&self) -> &Whole {
        self.whole.get_or_init(|| {
            let front = self.front();
            let mut diagnostics = front.diagnostics.clone();
            let mission = front.meaning.clone().and_then(|(problem, spans)| {
                driver::prepare(problem, spans, self.overrides.float, &mut diagnostics).ok()
            });
            Whole { mission, diagnostics }
        })
    }

    /// What was said, by as many phases as have been asked.
    pub fn said(&self) -> Vec<&Diagnostic> {
        let diagnostics = self.whole.get().map_or_else(|| &self.front().diagnostics, |w| &w.diagnostics);
        diagnostics.sorted()
    }

    /// The syntax tree, where there is one.
    pub fn file(&self) -> Option<&ast::File> {
        self.front().file.as_ref()
    }

    /// The names of the mission; empty where nothing useful can be read.
    pub fn index(&self) -> &Index {
        let read = |file| Index::with_text(file, &self.source.text);
        self.index.get_or_init(|| self.file().map(read).unwrap_or_default())
    }

    /// What the check found out, also where the mission has errors; `None` where nothing can be read.
    pub fn facts(&self) -> Option<&Facts> {
        let check = |file| {
            let mut unheard = Diagnostics::new();
            check_with_facts(file, &self.source, &self.overrides.set, &mut unheard).1
        };
        self.facts.get_or_init(|| self.file().map(check)).as_ref()
    }

    /// What the robots' controllers compute with.
    pub fn float(&self) -> Float {
        self.overrides.float
    }

    /// The byte offset of a position.
    pub fn offset(&self, position: Position) -> u32 {
        self.lines.offset(position)
    }

    /// The range of a span.
    pub fn range(&self, span: Span) -> Range {
        self.lines.range(span)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(text: &str) -> Document {
        let uri = "file:///tmp/m.dosm".parse().expect("it is a URI");
        Document::new(uri, 1, text.into(), Encoding::Utf16, Overrides::default())
    }

    fn change(from: (u32, u32), to: (u32, u32), text: &str) -> TextDocumentContentChangeEvent {
        let range = Range::new(Position::new(from.0, from.1), Position::new(to.0, to.1));
        TextDocumentContentChangeEvent { range: Some(range), range_length: None, text: text.into() }
    }

    #[test]
    fn changes_are_made_one_after_the_other() {
        let before = document("a😀b\nc");
        let changes =
            vec![change((0, 1), (0, 3), "\n"), change((1, 1), (2, 0), "→"), change((9, 9), (9, 9), "!")];
        let after = before.changed(2, changes, Encoding::Utf16);
        assert_eq!(after.source.text, "a\nb→c!");
        assert_eq!(after.version, 2);
        let whole = TextDocumentContentChangeEvent { range: None, range_length: None, text: "new".into() };
        assert_eq!(
            after.changed(3, vec![whole, change((0, 0), (0, 1), "N")], Encoding::Utf16).source.text,
            "New"
        );
    }

    #[test]
    fn the_order_of_changes_does_not_matter_to_where_they_are() {
        let before = document("one\ntwo\nthree\n");
        let backwards = vec![
            change((2, 0), (2, 5), "drei"),
            change((1, 0), (1, 3), "zwei"),
            change((0, 0), (0, 3), "eins"),
        ];
        assert_eq!(before.changed(2, backwards, Encoding::Utf16).source.text, "eins\nzwei\ndrei\n");
        let forwards =
            vec![change((0, 0), (0, 3), "a\nb"), change((1, 1), (1, 1), "!"), change((2, 0), (2, 3), "c")];
        assert_eq!(before.changed(2, forwards, Encoding::Utf16).source.text, "a\nb!\nc\nthree\n");
        let mixed =
            vec![change((1, 1), (1, 1), "?"), change((0, 0), (0, 0), "\n"), change((2, 0), (2, 1), "T")];
        assert_eq!(before.changed(2, mixed, Encoding::Utf16).source.text, "\none\nT?wo\nthree\n");
        let whole = TextDocumentContentChangeEvent { range: None, range_length: None, text: "x\ny".into() };
        let after = before.changed(2, vec![whole, change((1, 0), (1, 1), "z")], Encoding::Utf16);
        assert_eq!(after.source.text, "x\nz");
    }

    #[test]
    fn a_line_break_may_grow_between_two_changes() {
        let changes = vec![change((1, 0), (1, 0), "\n"), change((1, 0), (1, 0), "-")];
        assert_eq!(document("a\rb").changed(2, changes, Encoding::Utf16).source.text, "a\r\n-b");
    }

    #[test]
    fn a_range_turned_round_is_an_insertion() {
        let after = document("abc").changed(2, vec![change((0, 2), (0, 1), "-")], Encoding::Utf16);
        assert_eq!(after.source.text, "ab-c");
    }
}
