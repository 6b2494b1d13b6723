//! Declarations and the items of blocks up to the cursor.

use crate::syntax::token::Kind;
use crate::syntax::words::{CONNECTIVITY_ITEMS, DECLARATIONS, DYNAMICS_ITEMS, MATRICES, OBJECTIVES};

use super::model::Signal;
use super::reader::{About, Halt, LENGTH, Measure, Read, Reader, TIME, Variable, Want};

impl<'a, 't> Reader<'a, 't> {
    /// A declaration from its first word on; at its end, the next one may begin.
    pub(super) fn declaration(&mut self) -> Read {
        let Some(word) = self.eat_any(&DECLARATIONS) else {
            self.skip();
            return Err(Halt::Lost);
        };
        self.behind(word)?;
        self.want(Want::Declaration);
        Ok(())
    }

    fn behind(&mut self, word: &str) -> Read {
        match word {
            "dosm" => {
                self.need(Want::Words(&["1"]))?;
                self.skip();
                Ok(())
            }
            "mission" => {
                self.need(Want::NewName { of_mission: true })?;
                self.eat_name().map(|_| ()).ok_or(Halt::Lost)
            }
            "param" | "let" => {
                self.new_name()?;
                self.expect(&["="])?;
                self.value(Measure::Any)
            }
            "workspace" => self.shape(false),
            "opaque" => {
                self.expect_word(&["obstacle"])?;
                self.shaped()
            }
            "region" | "obstacle" | "jammer" => self.shaped(),
            "base" => {
                self.family()?;
                self.expect_word(&["at"])?;
                self.point()
            }
            "dynamics" => {
                self.new_name()?;
                self.expect_block(Reader::dynamics_items)
            }
            "robot" => self.placed_robot(),
            "team" => {
                self.new_name()?;
                self.expect(&["="])?;
                self.set()
            }
            "separation" => self.expression(LENGTH, About::Constants),
            "connectivity" => {
                self.want(Want::Words(&["none", "{"]));
                self.go_on()?;
                if self.eat("none") { Ok(()) } else { self.expect_block(Reader::connectivity_items) }
            }
            "horizon" => self.range(),
            "minimize" => {
                self.need(Want::Words(&OBJECTIVES))?;
                self.eat_name().map(|_| ()).ok_or(Halt::Lost)
            }
            _ => {
                self.new_name()?;
                self.expect(if word == "goal" { &[":"] } else { &["="] })?;
                self.formula()?;
                // A bracket that closes nothing.
                while !self.is_at_cursor() {
                    self.skip();
                    self.formula()?;
                }
                Ok(())
            }
        }
    }

    /// `NAME = SHAPE`
    fn shaped(&mut self) -> Read {
        self.family()?;
        self.expect(&["="])?;
        self.shape(true)
    }

    /// `NAME`, `NAME[i in 1..n, j in 1..2]`
    fn family(&mut self) -> Read {
        self.new_name()?;
        if !self.is("[") {
            return Ok(());
        }
        let mut indices = Vec::new();
        self.bracketed("[", &["]"], |r| {
            r.list(|r| {
                let name = r.new_name()?;
                r.expect_word(&["in"])?;
                r.range()?;
                indices.push(Variable { name, is_robot: false });
                Ok(())
            })
        })?;
        self.variables.extend(indices);
        Ok(())
    }

    /// `NAME: MODEL at START`
    fn placed_robot(&mut self) -> Read {
        self.family()?;
        self.expect(&[":"])?;
        self.need(Want::Model)?;
        let model = self.eat_name().unwrap_or("");
        self.expect_word(&["at"])?;
        self.start(model)
    }

    /// A block, whose brace may have to be looked for.
    fn expect_block(&mut self, items: fn(&mut Reader<'a, 't>) -> Read) -> Read {
        self.go_on()?;
        if !self.skip_to(&["{"]) {
            return Err(Halt::Lost);
        }
        self.bracketed("{", &["}"], items)
    }

    /// The items of a block up to its brace; what is no item is passed over.
    fn items(
        &mut self,
        words: &[&'static [&'static str]],
        want: Want<'t>,
        one: fn(&mut Reader<'a, 't>, &'static str) -> Read,
    ) -> Read {
        let outside = std::mem::take(&mut self.items);
        while !self.is("}") {
            self.need(want)?;
            let found = words.iter().find_map(|words| self.eat_any(words));
            match found {
                Some(word) => {
                    self.items.push(word);
                    match one(self, word) {
                        Err(Halt::Cursor) => return Err(Halt::Cursor),
                        // The next item is looked for from here on.
                        Ok(()) | Err(Halt::Lost) => {}
                    }
                    self.eat(";");
                }
                None => self.skip(),
            }
        }
        self.closed = std::mem::replace(&mut self.items, outside);
        Ok(())
    }

    /// The items of a `dynamics` block.
    pub(super) fn dynamics_items(&mut self) -> Read {
        self.items(&[&DYNAMICS_ITEMS, &MATRICES], Want::DynamicsItem, Reader::dynamics_item)
    }

    fn dynamics_item(&mut self, word: &'static str) -> Read {
        match word {
            "step" => self.expression(TIME, About::Constants),
            "state" | "input" => self.list(|r| r.signal(word == "input")),
            "position" => self.list(|r| r.signal_name(false).map(|_| ())),
            "continuous" => Ok(()),
            "integrator" => {
                self.need(Want::Operand(About::Constants))?;
                let order = self.peek().and_then(|token| token.text.parse().ok());
                self.model.order = Some(order.unwrap_or(2));
                self.expression(Measure::Bare, About::Constants)
            }
            "bound" => {
                self.want(Want::Words(&["where"]));
                if self.eat("where") { self.inequalities(About::Signals) } else { self.bounded(true) }
            }
            "disturbance" => self.bounded(false),
            "rejection" => self.expression(Measure::Bare, About::Constants),
            "mode" => self.mode(),
            _ => self.matrix(),
        }
    }

    fn matrix(&mut self) -> Read {
        self.expect(&["="])?;
        self.value(Measure::Any)
    }

    /// `px: m`
    fn signal(&mut self, is_input: bool) -> Read {
        let name = self.new_name()?;
        self.expect(&[":"])?;
        self.need(Want::Unit(Measure::New))?;
        let unit = self.peek().filter(|token| token.kind == Kind::Unit || token.text == "1");
        let Some(unit) = unit else { return Err(Halt::Lost) };
        self.skip();
        self.model.signals.push(Signal { name: name.into(), unit: unit.text, is_input });
        Ok(())
    }

    fn signal_name(&mut self, inputs: bool) -> Read<&'t str> {
        self.need(Want::Signals { inputs })?;
        self.eat_name().ok_or(Halt::Lost)
    }

    /// `vx, vy in [-4, 4] m/s`
    fn bounded(&mut self, inputs: bool) -> Read {
        let mut first = None;
        self.list(|r| {
            let name = r.signal_name(inputs)?;
            first.get_or_insert(name);
            Ok(())
        })?;
        self.expect_word(&["in"])?;
        let unit = first.and_then(|name| self.known.unit(name));
        let measure = unit.map_or(Measure::Any, Measure::Unit);
        self.bracketed("[", &["]"], |r| r.list(|r| r.expression(measure, About::Constants)))?;
        self.unit(measure);
        Ok(())
    }

    fn mode(&mut self) -> Read {
        self.new_name()?;
        self.expect_word(&["when"])?;
        self.inequalities(About::Signals)?;
        self.expect_block(Reader::mode_items)
    }

    /// The items of a mode.
    pub(super) fn mode_items(&mut self) -> Read {
        self.items(&[&MATRICES], Want::ModeItem, |r, _| r.matrix())
    }

    /// The items of a `connectivity` block.
    pub(super) fn connectivity_items(&mut self) -> Read {
        self.items(&[&CONNECTIVITY_ITEMS], Want::ConnectivityItem, |r, word| match word {
            "hops" => {
                r.expect_word(&["<="])?;
                r.expression(Measure::Bare, About::Constants)
            }
            "range" => {
                r.expression(LENGTH, About::Constants)?;
                r.norm(&["2"])
            }
            "every" => r.expression(TIME, About::Constants),
            _ => r.expression(Measure::Bare, About::Constants),
        })
    }
}
