//! Formulas up to the cursor.

use crate::lsp::index::SymbolKind;
use crate::syntax::token::Kind;

use super::reader::{About, Halt, LENGTH, Measure, Read, Reader, TIME, Variable, Want};

/// The signs and words between formulas and between sums; `weak` and `strong` before their partners.
const JOINTS: [&str; 24] = [
    "and", "&&", "or", "||", "until", "U", "release", "R", "W", "M", "<->", "->", "=", "!=", "<=", ">=", "<",
    ">", "+", "-", "*", "==", "=>", "&",
];

impl<'a, 't> Reader<'a, 't> {
    /// A formula, and whatever stands between it and the end of its bracket.
    pub(super) fn formula(&mut self) -> Read {
        let known = self.variables.len();
        loop {
            self.prefixes()?;
            self.atom()?;
            if !self.joint()? {
                break;
            }
        }
        self.variables.truncate(known);
        Ok(())
    }

    /// `not`, `always[1, 2]`, `forall r in all:` and the like, any number of them.
    fn prefixes(&mut self) -> Read {
        loop {
            self.need(Want::Formula)?;
            if self.eat_any(&["not", "!"]).is_some() {
                continue;
            }
            if self.eat_any(&["always", "G", "[]", "eventually", "F", "<>", "next", "X"]).is_some() {
                self.window()?;
            } else if self.eat_any(&["forall", "exists"]).is_some() {
                self.quantifier()?;
            } else {
                return Ok(());
            }
        }
    }

    fn window(&mut self) -> Read {
        if !self.is("[") {
            return Ok(());
        }
        self.bracketed("[", &["]"], |r| r.list(|r| r.expression(TIME, About::Constants)))
    }

    /// `r in SET:`, `i in A..B:`, which bind a variable.
    fn quantifier(&mut self) -> Read {
        let name = self.new_name()?;
        self.expect_word(&["in"])?;
        let is_robot = self.set_or_range()?;
        self.expect(&[":"])?;
        self.variables.push(Variable { name, is_robot });
        Ok(())
    }

    /// What a quantifier runs over, and whether that is robots.
    fn set_or_range(&mut self) -> Read<bool> {
        self.want(Want::Robot { sets: true });
        self.need(Want::Operand(About::Constants))?;
        if self.is("all") {
            return self.set().map(|()| true);
        }
        self.expression(Measure::Bare, About::Constants)?;
        let could_be_number = self.last().is_some_and(|token| {
            let kind = self.kind_of(token.text);
            token.kind == Kind::Number || matches!(kind, Some(SymbolKind::Constant | SymbolKind::Parameter))
        });
        if could_be_number {
            self.need(Want::Words(&[".."]))?;
        }
        if self.eat("..") {
            self.expression(Measure::Bare, About::Constants)?;
            return Ok(false);
        }
        while self.eat(",") {
            self.robot(true)?;
        }
        Ok(true)
    }

    /// Robots, members, teams and families.
    pub(super) fn set(&mut self) -> Read {
        self.list(|r| r.robot(true))
    }

    fn robot(&mut self, sets: bool) -> Read {
        self.need(Want::Robot { sets })?;
        if self.eat("all") { Ok(()) } else { self.reference().map(|_| ()) }
    }

    fn region(&mut self) -> Read {
        self.need(Want::Region)?;
        self.reference().map(|_| ())
    }

    fn atom(&mut self) -> Read {
        let Some(token) = self.peek() else { return Ok(()) };
        if token.kind == Kind::Number || self.eat_any(&["true", "false"]).is_some() {
            if token.kind == Kind::Number {
                self.skip();
            }
            return Ok(());
        }
        if self.eat("-") {
            return Ok(());
        }
        if self.eat("count") {
            return self.bracketed("(", &[")"], Reader::counted);
        }
        if self.is("(") {
            return self.bracketed("(", &[")"], Reader::formula);
        }
        match self.reference() {
            Ok(name) => self.behind_name(name),
            Err(Halt::Cursor) => Err(Halt::Cursor),
            // Whatever stands here is passed over, and a formula goes on behind the next connective.
            Err(Halt::Lost) if self.skip_to(&JOINTS) => Ok(()),
            Err(Halt::Lost) => Err(Halt::Lost),
        }
    }

    /// `in REGION` behind a robot; nothing behind a defined name or a constant.
    fn behind_name(&mut self, name: &str) -> Read {
        let variable = self.variable(name).map(|variable| variable.is_robot);
        let is_robot = match (variable, self.kind_of(name)) {
            (Some(is_robot), _) => Some(is_robot),
            (None, Some(SymbolKind::Robot)) => Some(true),
            (None, Some(SymbolKind::Define | SymbolKind::Constant | SymbolKind::Parameter)) => Some(false),
            _ => None,
        };
        match is_robot {
            Some(true) => self.need(Want::Words(&["in"]))?,
            Some(false) => {}
            None => self.want(Want::Words(&["in"])),
        }
        if self.eat("in") { self.region() } else { Ok(()) }
    }

    /// `r in SET: r in REGION`
    fn counted(&mut self) -> Read {
        let name = self.new_name()?;
        self.expect_word(&["in"])?;
        self.set()?;
        self.expect(&[":"])?;
        self.variables.push(Variable { name, is_robot: true });
        self.robot(false)?;
        self.expect_word(&["in"])?;
        self.region()
    }

    /// Takes what joins two formulas or sums; false where nothing does.
    fn joint(&mut self) -> Read<bool> {
        self.want(Want::Connective);
        let Some(token) = self.peek() else { return Ok(false) };
        if self.eat("weak") {
            self.expect_word(&["until"])?;
        } else if self.eat("strong") {
            self.expect_word(&["release"])?;
        } else if self.eat_any(&JOINTS).is_none() {
            if matches!(token.text, ")" | "]" | "}" | ":" | ",") {
                return Ok(false);
            }
            // A connective is missing: what follows is a formula all the same.
            let is_start = token.kind == Kind::Word || token.is("(") || token.kind == Kind::Number;
            if !is_start {
                self.skip();
            }
            return Ok(!self.is_at_cursor() || is_start);
        }
        self.window()?;
        Ok(true)
    }

    /// A robot's start: a point or `{ px = 4.5, … }`.
    pub(super) fn start(&mut self, model: &'t str) -> Read {
        if !self.is("{") {
            return self.point();
        }
        self.bracketed("{", &["}"], |r| {
            while !r.is("}") {
                r.need(Want::StatesOf(model))?;
                let Some(_) = r.eat_name() else {
                    r.skip();
                    continue;
                };
                r.expect(&["="])?;
                r.expression(LENGTH, About::Constants)?;
                r.go_on()?;
                if !r.eat(",") && !r.is("}") {
                    r.skip();
                }
            }
            Ok(())
        })
    }
}
