//! Tokens up to the cursor, and what may come at their end.
//!
//! The functions beside this follow the grammar from a declaration's first word. Where the tokens end, each
//! that is asked for something notes it as wanted: what an editor can offer there. They are lenient, so that
//! a mistake before the cursor costs as little as possible: what can't be there is passed over.

use crate::lsp::index::{Index, SymbolKind};
use crate::syntax::token::{Kind, Token};
use crate::syntax::words::{DECLARATIONS, is_reserved};

use super::model::Model;

/// The deepest brackets that are followed.
const MAX_DEPTH: usize = 256;

/// What a quantity measures, as far as its place tells.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Measure<'t> {
    /// Nothing: a plain number.
    Bare,
    /// Whatever it likes.
    Any,
    /// What is declared here.
    New,
    /// Something that has this unit.
    Unit(&'t str),
}

/// A metre's measure.
pub(super) const LENGTH: Measure<'static> = Measure::Unit("m");
/// A second's measure.
pub(super) const TIME: Measure<'static> = Measure::Unit("s");

/// What an expression is about besides constants.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum About {
    /// Nothing else.
    Constants,
    /// The workspace's coordinates.
    Coordinates,
    /// The states and inputs of the model that is read.
    Signals,
}

/// Something that may stand at the cursor.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Want<'t> {
    /// A declaration.
    Declaration,
    /// One of these words or signs.
    Words(&'static [&'static str]),
    /// A new name; the mission's can be guessed.
    NewName { of_mission: bool },
    /// A shape.
    Shape,
    /// A region.
    Region,
    /// A robot; a set of them, too.
    Robot { sets: bool },
    /// A motion model.
    Model,
    /// A constant expression's next operand.
    Operand(About),
    /// A unit behind a number.
    Unit(Measure<'t>),
    /// A formula.
    Formula,
    /// What joins two formulas.
    Connective,
    /// An item of a `dynamics` block.
    DynamicsItem,
    /// An item of a mode.
    ModeItem,
    /// An item of a `connectivity` block.
    ConnectivityItem,
    /// States of the model that is read; its inputs, too.
    Signals { inputs: bool },
    /// States of the model of this name.
    StatesOf(&'t str),
}

/// A bound variable in scope.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Variable<'t> {
    pub(super) name: &'t str,
    /// Whether it stands for a robot, not for a number.
    pub(super) is_robot: bool,
}

/// Why reading stops.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Halt {
    /// The cursor is reached, and something has to come.
    Cursor,
    /// What stands there makes no sense.
    Lost,
}

/// How reading went.
pub(super) type Read<T = ()> = Result<T, Halt>;

/// Reads a declaration's tokens up to the cursor.
pub(super) struct Reader<'a, 't> {
    tokens: &'a [Token<'t>],
    at: usize,
    depth: usize,
    index: &'a Index,
    /// What may come at the cursor, the likeliest first.
    pub(super) wants: Vec<Want<'t>>,
    /// The bound variables that can be used.
    pub(super) variables: Vec<Variable<'t>>,
    /// The motion model that is read.
    pub(super) model: Model<'t>,
    /// What is known of it from the whole text.
    pub(super) known: Model<'t>,
    /// The words of the items of the innermost block that is open.
    pub(super) items: Vec<&'t str>,
    /// Those of the block that was closed last.
    pub(super) closed: Vec<&'t str>,
}

impl<'a, 't> Reader<'a, 't> {
    pub(super) fn new(tokens: &'a [Token<'t>], index: &'a Index) -> Reader<'a, 't> {
        Reader {
            tokens,
            at: 0,
            depth: 0,
            index,
            wants: Vec::new(),
            variables: Vec::new(),
            model: Model::default(),
            known: Model::default(),
            items: Vec::new(),
            closed: Vec::new(),
        }
    }

    /// Whether the cursor is reached.
    pub(super) fn is_at_cursor(&self) -> bool {
        self.at >= self.tokens.len()
    }

    /// The token that comes.
    pub(super) fn peek(&self) -> Option<&'a Token<'t>> {
        self.tokens.get(self.at)
    }

    /// The token that came.
    pub(super) fn last(&self) -> Option<&'a Token<'t>> {
        self.tokens.get(self.at.checked_sub(1)?)
    }

    pub(super) fn skip(&mut self) {
        self.at += 1;
    }

    /// Notes what may come at the cursor; elsewhere nothing.
    pub(super) fn want(&mut self, want: Want<'t>) {
        if self.is_at_cursor() && !self.wants.contains(&want) {
            self.wants.push(want);
        }
    }

    /// At the cursor: notes what has to come.
    pub(super) fn need(&mut self, want: Want<'t>) -> Read {
        self.want(want);
        self.go_on()
    }

    /// Stops at the cursor.
    pub(super) fn go_on(&self) -> Read {
        if self.is_at_cursor() { Err(Halt::Cursor) } else { Ok(()) }
    }

    pub(super) fn is(&self, text: &str) -> bool {
        self.peek().is_some_and(|token| token.is(text))
    }

    /// Takes a sign or word that may come; not offered at the cursor.
    pub(super) fn eat(&mut self, text: &str) -> bool {
        let is = self.is(text);
        self.at += usize::from(is);
        is
    }

    /// Takes one of these that may come, and tells which.
    pub(super) fn eat_any(&mut self, texts: &'static [&'static str]) -> Option<&'static str> {
        texts.iter().copied().find(|text| self.eat(text))
    }

    /// Takes a word that may come; offered at the cursor.
    pub(super) fn eat_word(&mut self, words: &'static [&'static str]) -> Option<&'static str> {
        self.want(Want::Words(words));
        self.eat_any(words)
    }

    /// Takes a word that has to come; one further on will do.
    pub(super) fn expect_word(&mut self, words: &'static [&'static str]) -> Read {
        self.need(Want::Words(words))?;
        self.expect_any(words)
    }

    /// Takes a sign that has to come; one further on will do.
    pub(super) fn expect(&mut self, sign: &'static [&'static str]) -> Read {
        self.go_on()?;
        self.expect_any(sign)
    }

    fn expect_any(&mut self, texts: &'static [&'static str]) -> Read {
        let mut depth = 0usize;
        for (at, token) in self.tokens.iter().enumerate().skip(self.at) {
            if depth == 0 && texts.iter().any(|text| token.is(text)) {
                self.at = at + 1;
                return Ok(());
            }
            match token.text {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" if depth == 0 => return Err(Halt::Lost),
                ")" | "]" | "}" => depth -= 1,
                _ => {}
            }
        }
        Err(Halt::Lost)
    }

    /// Passes over tokens up to one of these outside of brackets; false where there is none.
    pub(super) fn skip_to(&mut self, texts: &'static [&'static str]) -> bool {
        let from = self.at;
        let found = self.expect_any(texts).is_ok();
        self.at = if found { self.at - 1 } else { from };
        found
    }

    /// Takes a word that is no word of the language; units look like words behind some signs.
    pub(super) fn eat_name(&mut self) -> Option<&'t str> {
        let token = self.peek()?;
        let is_word = token.text.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
        let is_name = matches!(token.kind, Kind::Word | Kind::Unit) && is_word && !is_reserved(token.text);
        is_name.then(|| {
            self.at += 1;
            token.text
        })
    }

    /// Takes a name that is declared here.
    pub(super) fn new_name(&mut self) -> Read<&'t str> {
        self.need(Want::NewName { of_mission: false })?;
        self.eat_name().ok_or(Halt::Lost)
    }

    /// Goes one level down.
    pub(super) fn nested<T>(&mut self, read: impl FnOnce(&mut Reader<'a, 't>) -> Read<T>) -> Read<T> {
        if self.depth >= MAX_DEPTH {
            return Err(Halt::Lost);
        }
        self.depth += 1;
        let result = read(self);
        self.depth -= 1;
        result
    }

    /// Reads a list with commas.
    pub(super) fn list(&mut self, mut one: impl FnMut(&mut Reader<'a, 't>) -> Read) -> Read {
        one(self)?;
        while self.eat(",") {
            one(self)?;
        }
        Ok(())
    }

    /// Reads what stands in brackets; a mistake in it costs no more than what is in them.
    pub(super) fn bracketed(
        &mut self,
        open: &'static str,
        close: &'static [&'static str],
        inside: impl FnOnce(&mut Reader<'a, 't>) -> Read,
    ) -> Read {
        self.go_on()?;
        if !self.eat(open) {
            return Err(Halt::Lost);
        }
        let known = self.variables.len();
        match self.nested(inside) {
            Err(Halt::Lost) if !self.skip_to(close) => return Err(Halt::Lost),
            Err(Halt::Cursor) => return Err(Halt::Cursor),
            _ => {}
        }
        self.expect(close)?;
        self.variables.truncate(known);
        Ok(())
    }

    /// What a name of the mission is.
    pub(super) fn kind_of(&self, name: &str) -> Option<SymbolKind> {
        self.index.global(name).map(|id| self.index.symbol(id).kind)
    }

    /// The variable of this name in scope.
    pub(super) fn variable(&self, name: &str) -> Option<&Variable<'t>> {
        self.variables.iter().rev().find(|variable| variable.name == name)
    }

    /// A name or a member: `R1`, `fleet[1]`; the name.
    pub(super) fn reference(&mut self) -> Read<&'t str> {
        let name = self.eat_name().ok_or(Halt::Lost)?;
        self.indices()?;
        Ok(name)
    }

    /// The indices behind a name, if any.
    pub(super) fn indices(&mut self) -> Read {
        if !self.is("[") {
            return Ok(());
        }
        self.bracketed("[", &["]"], |r| r.list(|r| r.expression(Measure::Bare, About::Constants)))
    }
}

/// Where the declaration begins that the end of some tokens is in: the first of its tokens.
pub(super) fn declaration_start(tokens: &[Token<'_>]) -> Option<usize> {
    let start = tokens.iter().rposition(|t| t.kind == Kind::Word && DECLARATIONS.contains(&t.text))?;
    let opaque = start
        .checked_sub(1)
        .filter(|&before| tokens[start].text == "obstacle" && tokens[before].is("opaque"));
    Some(opaque.unwrap_or(start))
}
