//! Expressions, points and shapes up to the cursor.

use crate::syntax::token::Kind;
use crate::syntax::words::{ARITHMETIC, COMPARISONS, UNCERTAINTY};

use super::reader::{About, Halt, LENGTH, Measure, Read, Reader, Want};

impl<'a, 't> Reader<'a, 't> {
    /// An expression of some measure.
    pub(super) fn expression(&mut self, measure: Measure<'t>, about: About) -> Read {
        let mut measure = measure;
        loop {
            while self.eat("-") {}
            self.operand(measure, about)?;
            match self.eat_any(&ARITHMETIC) {
                None => return Ok(()),
                Some("+" | "-") => {}
                Some("^") => measure = Measure::Bare,
                Some(_) => measure = Measure::Any,
            }
        }
    }

    fn operand(&mut self, measure: Measure<'t>, about: About) -> Read {
        self.need(Want::Operand(about))?;
        let Some(token) = self.peek() else { return Ok(()) };
        if token.kind == Kind::Number {
            self.skip();
            self.unit(measure);
            return Ok(());
        }
        if self.is("(") {
            self.bracketed("(", &[")"], |r| r.expression(measure, about))?;
            self.unit(measure);
            return Ok(());
        }
        if self.eat_name().is_none() {
            // Something is missing: what follows may still make sense.
            return Ok(());
        }
        if self.is("(") {
            self.bracketed("(", &[")"], |r| r.list(|r| r.expression(measure, about)))?;
            self.unit(measure);
            return Ok(());
        }
        self.indices()
    }

    /// The unit that may come.
    pub(super) fn unit(&mut self, measure: Measure<'t>) {
        if measure != Measure::Bare {
            self.want(Want::Unit(measure));
        }
        if self.peek().is_some_and(|token| token.kind == Kind::Unit) {
            self.skip();
        }
    }

    /// A table or an expression.
    pub(super) fn value(&mut self, measure: Measure<'t>) -> Read {
        if !self.is("[") {
            return self.expression(measure, About::Constants);
        }
        self.bracketed("[", &["]"], |r| {
            loop {
                r.list(|r| r.expression(measure, About::Constants))?;
                if !r.eat(";") {
                    return Ok(());
                }
            }
        })?;
        self.unit(measure);
        Ok(())
    }

    /// `A..B`
    pub(super) fn range(&mut self) -> Read {
        self.expression(Measure::Bare, About::Constants)?;
        self.expect_word(&[".."])?;
        self.expression(Measure::Bare, About::Constants)
    }

    /// `(4, 7) m`
    pub(super) fn point(&mut self) -> Read {
        self.bracketed("(", &[")"], |r| r.list(Reader::coordinate))?;
        self.unit(LENGTH);
        Ok(())
    }

    /// `4`, `4 +/- 0.3`
    fn coordinate(&mut self) -> Read {
        self.expression(LENGTH, About::Constants)?;
        if self.eat_any(&UNCERTAINTY).is_some() {
            self.expression(LENGTH, About::Constants)?;
        }
        Ok(())
    }

    /// Pieces joined by `or`.
    pub(super) fn shape(&mut self, is_union: bool) -> Read {
        loop {
            self.need(Want::Shape)?;
            let word = self.eat_any(&crate::syntax::words::SHAPES);
            match word {
                Some(word) => self.piece(word)?,
                None if self.skip_to(&["or"]) => {}
                None => return Err(Halt::Lost),
            }
            if is_union && self.eat_word(&["or"]).is_some() {
                continue;
            }
            return Ok(());
        }
    }

    fn piece(&mut self, word: &str) -> Read {
        match word {
            "box" => {
                self.point()?;
                self.expect_word(&[".."])?;
                self.point()
            }
            "ball" | "disc" => {
                self.point()?;
                self.expect_word(&["radius"])?;
                self.coordinate()?;
                if word == "ball" { self.norm(&["1", "2"]) } else { Ok(()) }
            }
            "where" => self.inequalities(About::Coordinates),
            _ => self.list(Reader::point),
        }
    }

    /// The norm that may come; some numbers name one.
    pub(super) fn norm(&mut self, norms: &'static [&'static str]) -> Read {
        if self.eat_word(&["norm"]).is_some() {
            self.need(Want::Words(norms))?;
            if self.peek().is_some_and(|token| token.kind == Kind::Number) {
                self.skip();
            }
        }
        Ok(())
    }

    /// `{ x + y <= 2; … }`
    pub(super) fn inequalities(&mut self, about: About) -> Read {
        let measure = if about == About::Coordinates { LENGTH } else { Measure::Any };
        self.bracketed("{", &["}"], |r| {
            while !r.is("}") {
                r.expression(measure, about)?;
                while r.eat_any(&COMPARISONS).is_some() {
                    r.expression(measure, about)?;
                }
                r.go_on()?;
                if !r.eat(";") && !r.is("}") {
                    r.skip();
                }
            }
            Ok(())
        })
    }
}
