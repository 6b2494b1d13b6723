//! Reading a whole file, stretch by stretch, and the other entry points.

use crate::diag::{Diagnostic, Diagnostics, Reported};
use crate::source::{SourceFile, Span};
use crate::syntax::ast::{Broken, Expr, File, Item, ItemKind, Name};
use crate::syntax::builder::Builder;
use crate::syntax::condensed::Condensed;
use crate::syntax::docs::Docs;
use crate::syntax::error;
use crate::syntax::expected::{self, Failure, Surroundings};
use crate::syntax::grammar::{self, Built, Node, Rule, Stop};
use crate::syntax::memory::{Memory, Place};
use crate::syntax::mend;
use crate::syntax::scan::{self, Scan, Stretch};
use crate::syntax::words::DECLARATIONS;

/// Parses a mission.
///
/// Whatever could be read is in the result, with an error in `diagnostics` for each declaration that could not
/// (`File::broken` lists them). That the text begins with `dosm 1` is seen to here; everything else that
/// concerns several declarations is the checker's.
///
/// # Errors
/// [`Reported`] when nothing useful can be read.
pub fn parse(source: &SourceFile, diagnostics: &mut Diagnostics) -> Result<File, Reported> {
    read(source, None, diagnostics)
}

/// Parses a mission as [`parse`] does, faster where most of its declarations are in `memory`; it remembers
/// this mission's from then on.
///
/// # Errors
/// [`Reported`] when nothing useful can be read.
pub fn parse_again(
    source: &SourceFile,
    memory: &mut Memory,
    diagnostics: &mut Diagnostics,
) -> Result<File, Reported> {
    let file = read(source, Some(memory), diagnostics);
    memory.turn();
    file
}

fn read(
    source: &SourceFile,
    memory: Option<&mut Memory>,
    diagnostics: &mut Diagnostics,
) -> Result<File, Reported> {
    if source.text.len() > error::MAX_TEXT {
        return Err(diagnostics.report(error::text_too_long(source.text.len())));
    }
    let Scan { condensed, stretches, docs, errors } =
        scan::scan(&source.text).map_err(|fatal| diagnostics.report(fatal))?;
    for diagnostic in errors {
        diagnostics.push(diagnostic);
    }
    if condensed.text().is_empty() {
        let end = source.text.len();
        return Err(diagnostics.report(error::empty(Span::new(end, end))));
    }
    let mut reader = Reader::new(source, &condensed, docs, memory, diagnostics);
    reader.check_beginning(&stretches);
    reader.read(&stretches)?;
    reader.finish()
}

/// Parses an expression by itself, as in `--set NAME=EXPR`; spans are places in `text`.
///
/// # Errors
/// The first thing that is wrong with it.
pub fn parse_expression(text: &str) -> Result<Expr, Diagnostic> {
    if text.len() > error::MAX_TEXT {
        return Err(error::text_too_long(text.len()));
    }
    let mut scan = scan::scan(text)?;
    if let Some(diagnostic) = scan.errors.drain(..).next() {
        return Err(diagnostic);
    }
    let condensed = &scan.condensed;
    let bracket = scan.stretches.first().and_then(|stretch| stretch.bracket);
    let around = Surroundings { source: text, condensed, base: 0, next: None, bracket };
    let pairs = grammar::run(Rule::lone_expression, condensed.text())
        .map_err(|error| expected::explain(&Failure::of(&error), condensed.text(), &around))?;
    let mut builder = Builder::new(text, condensed, 0, &mut scan.docs);
    let built = first(pairs).and_then(|node| builder.expression(node));
    match (builder.errors.into_iter().next(), built) {
        (None, Ok(expression)) => Ok(expression),
        (Some(diagnostic), _) => Err(diagnostic),
        (None, Err(Stop)) => Err(error::unreadable(Span::new(0, text.len()))),
    }
}

/// Decodes a mission's bytes; a byte order mark at the beginning is left out.
///
/// # Errors
/// Where the first byte stands that is no UTF-8.
pub fn decode(bytes: &[u8]) -> Result<String, Diagnostic> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok(text.strip_prefix('\u{feff}').unwrap_or(text).to_owned()),
        Err(error) => Err(error::not_utf8(error.valid_up_to())),
    }
}

/// Puts the file together.
struct Reader<'a> {
    source: &'a SourceFile,
    condensed: &'a Condensed,
    docs: Docs,
    memory: Option<&'a mut Memory>,
    diagnostics: &'a mut Diagnostics,
    items: Vec<Item>,
    broken: Vec<Broken>,
}

impl<'a> Reader<'a> {
    fn new(
        source: &'a SourceFile,
        condensed: &'a Condensed,
        docs: Docs,
        memory: Option<&'a mut Memory>,
        diagnostics: &'a mut Diagnostics,
    ) -> Reader<'a> {
        Reader { source, condensed, docs, memory, diagnostics, items: Vec::new(), broken: Vec::new() }
    }

    fn finish(mut self) -> Result<File, Reported> {
        if self.items.is_empty() {
            self.diagnostics.or_reported()?;
        }
        Ok(File {
            doc: self.docs.file.take(),
            items: self.items,
            stray_docs: self.docs.into_stray(),
            broken: self.broken,
            span: Span::new(0, self.source.text.len()),
        })
    }

    /// The text of a stretch.
    fn text(&self, stretch: &Stretch) -> &'a str {
        self.condensed.text().get(stretch.range.clone()).unwrap_or("")
    }

    fn place(&self, start: usize, end: usize) -> Span {
        self.condensed.span(start, end, &self.source.text)
    }

    /// Reports a file that doesn't begin with its edition, unless it begins with no declaration at all.
    fn check_beginning(&mut self, stretches: &[Stretch]) {
        let Some(first) = stretches.first() else { return };
        let word = expected::token_at(self.text(first), 0);
        if word == "dosm" || !DECLARATIONS.contains(&word) {
            return;
        }
        let start = first.range.start;
        let mut diagnostic = error::missing_edition(self.place(start, start + word.len()));
        if let Some(later) = stretches.iter().find(|s| expected::token_at(self.text(s), 0) == "dosm") {
            diagnostic = diagnostic
                .with_label(self.place(later.range.start, later.range.end), "this belongs at the beginning");
        }
        self.diagnostics.push(diagnostic);
    }

    fn read(&mut self, stretches: &[Stretch]) -> Result<(), Reported> {
        let (mut rest, mut from) = (stretches, 0);
        while let [stretch, after @ ..] = rest {
            let to = self.place(stretch.range.start, stretch.range.end).end;
            let place = Place {
                text: self.source.slice(Span { start: from, end: to }),
                start: from,
                stretch: stretch.range.start,
            };
            from = to;
            if self.recall(place) {
                rest = after;
                continue;
            }
            let both = self.read_stretch(stretch, after.first(), place);
            rest = if both { after.get(1..).unwrap_or(&[]) } else { after };
            if self.broken.len() > error::MAX_ERRORS {
                let end = self.place(stretch.range.end, stretch.range.end);
                return Err(self.diagnostics.report(error::too_many(end)));
            }
        }
        Ok(())
    }

    /// Takes a declaration that was read before; gives whether there is one.
    fn recall(&mut self, place: Place<'_>) -> bool {
        let memory = self.memory.as_mut();
        let item = memory.and_then(|memory| memory.recall(place, &mut self.docs));
        let is_known = item.is_some();
        self.items.extend(item);
        is_known
    }

    /// Reads one declaration; gives whether the next stretch was a part of it.
    fn read_stretch(&mut self, stretch: &Stretch, next: Option<&Stretch>, place: Place<'_>) -> bool {
        let text = self.text(stretch);
        let failure = match grammar::run(Rule::lone_declaration, text) {
            Ok(pairs) => {
                let before = self.docs.unclaimed(stretch.range.clone());
                match first(pairs).and_then(|node| self.build(node, stretch)) {
                    Ok(()) => self.keep(stretch, place, before),
                    Err(Stop) => self.lose(stretch, 0),
                }
                return false;
            }
            Err(error) => Failure::of(&error),
        };
        if let Some(next) = next.filter(|next| self.is_misused_word(&failure, text, next)) {
            let word = expected::token_at(self.text(next), 0);
            let span = self.place(next.range.start, next.range.start + word.len());
            self.diagnostics.push(error::reserved_word(span, word));
            self.lose(stretch, 0);
            self.docs.forget(next.range.start, next.range.end);
            return true;
        }
        self.report_failure(&failure, stretch, next);
        let lost_from = self.keep_beginning(&failure, stretch);
        self.lose(stretch, lost_from);
        false
    }

    /// Remembers the declaration that was built last, unless something was said about it; `docs` are the
    /// comments that it could claim.
    fn keep(&mut self, stretch: &Stretch, place: Place<'_>, mut docs: Vec<usize>) {
        let (Some(memory), Some(item)) = (self.memory.as_mut(), self.items.last()) else { return };
        if stretch.reported || matches!(item.kind, ItemKind::Edition(_)) {
            return;
        }
        let left = self.docs.unclaimed(stretch.range.clone());
        docs.retain(|doc| !left.contains(doc));
        memory.keep(place, item, &docs);
    }

    /// Whether the keyword that the next stretch begins with was meant as a name in this one.
    fn is_misused_word(&self, failure: &Failure, text: &str, next: &Stretch) -> bool {
        failure.position >= text.len()
            && failure.expects(Rule::ident)
            && grammar::run(Rule::lone_declaration, self.text(next)).is_err()
    }

    fn report_failure(&mut self, failure: &Failure, stretch: &Stretch, next: Option<&Stretch>) {
        if stretch.reported {
            return;
        }
        let around = Surroundings {
            source: &self.source.text,
            condensed: self.condensed,
            base: stretch.range.start,
            next: next.map(|next| expected::token_at(self.text(next), 0)),
            bracket: stretch.bracket,
        };
        self.diagnostics.push(expected::explain(failure, self.text(stretch), &around));
    }

    /// Keeps a whole declaration before the place of the failure; gives where the rest begins.
    ///
    /// What follows on the same line was meant as a part of it, unless it is a `;`.
    fn keep_beginning(&mut self, failure: &Failure, stretch: &Stretch) -> usize {
        let text = self.text(stretch);
        let Ok(pairs) = grammar::run(Rule::leading_declaration, text) else { return 0 };
        let Ok(node) = first(pairs) else { return 0 };
        let end = node.as_str().trim_end().len();
        let between = text.get(end..failure.position).is_some_and(|gap| gap.trim().is_empty());
        let start = stretch.range.start;
        let gap = Span {
            start: self.place(start, start + end).end,
            end: self.place(start + failure.position, start + failure.position + 1).start,
        };
        let apart =
            self.source.slice(gap).contains('\n') || expected::token_at(text, failure.position) == ";";
        if stretch.reported || !between || !apart || self.build(node, stretch).is_err() {
            return 0;
        }
        failure.position
    }

    /// Builds a declaration and keeps it if nothing is wrong with it.
    fn build(&mut self, node: Node, stretch: &Stretch) -> Built<()> {
        let mut builder =
            Builder::new(&self.source.text, self.condensed, stretch.range.start, &mut self.docs);
        let built = builder.declaration(node);
        let errors = builder.errors;
        let said = stretch.reported || !errors.is_empty();
        let wrong = !errors.is_empty();
        for diagnostic in errors {
            self.diagnostics.push(diagnostic);
        }
        match built {
            Ok(item) if !wrong => {
                self.check_edition(&item);
                self.items.push(item);
                Ok(())
            }
            Err(Stop) if !said => {
                let span = self.place(stretch.range.start, stretch.range.end);
                self.diagnostics.push(error::unreadable(span));
                Err(Stop)
            }
            _ => Err(Stop),
        }
    }

    fn check_edition(&mut self, item: &Item) {
        if let ItemKind::Edition(number) = &item.kind
            && number.value != 1
        {
            self.diagnostics.push(error::unknown_edition(number.span, &number.value));
        }
    }

    /// Notes that a stretch, from `start` on, could not be read.
    fn lose(&mut self, stretch: &Stretch, start: usize) {
        let text = self.text(stretch).get(start..).unwrap_or("");
        let base = stretch.range.start + start;
        self.docs.forget(base, stretch.range.end);
        let mut words = expected::tokens(text);
        let mut first = words.next().map_or("", |(_, word)| word);
        let mut second = words.next();
        if first == "opaque" && second.is_some_and(|(_, word)| word == "obstacle") {
            (first, second) = ("obstacle", words.next());
        }
        let name = second.filter(|(_, word)| expected::is_word(word)).map(|(at, word)| Name {
            text: word.to_owned(),
            span: self.place(base + at, base + at + word.len()),
        });
        let span = self.place(base, stretch.range.end);
        let keyword = mend::nearest_starter(first).unwrap_or(first).to_owned();
        self.broken.push(Broken { keyword, name, span });
    }
}

/// The first node of pest's result.
fn first(mut pairs: pest::iterators::Pairs<'_, Rule>) -> Built<Node<'_>> {
    pairs.next().ok_or(Stop)
}
