//! Formulas over robots and regions by index, and ways to write the same another way.

use crate::chance::Chance;
use crate::draft::Draft;

pub type Window = Option<(usize, usize)>;

/// A formula.
#[derive(Clone, Debug)]
pub enum Formula {
    True,
    In(usize, usize),
    /// Weighted counts, with the robots that each one counts.
    Compare(Vec<(i64, Vec<usize>, usize)>, &'static str, i64),
    Not(Box<Formula>),
    Next(Box<Formula>),
    Always(Window, Box<Formula>),
    Eventually(Window, Box<Formula>),
    /// With the operator's words.
    Infix(&'static str, Window, Box<Formula>, Box<Formula>),
}

pub const TIMED: [&str; 4] = ["until", "release", "weak until", "strong release"];

impl Formula {
    pub fn not(self) -> Formula {
        Formula::Not(Box::new(self))
    }

    pub fn infix(self, op: &'static str, other: Formula) -> Formula {
        Formula::Infix(op, None, Box::new(self), Box::new(other))
    }

    /// As the language writes it.
    pub fn text(&self, draft: &Draft) -> String {
        let window = |w: &Window| w.map_or(String::new(), |(m, n)| format!("[{m}, {n}]"));
        match self {
            Formula::True => "true".into(),
            Formula::In(robot, region) => {
                format!("({} in {})", draft.robots[*robot].name, draft.regions[*region].name)
            }
            Formula::Compare(terms, op, bound) => {
                let mut sum = String::new();
                for (i, (weight, robots, region)) in terms.iter().enumerate() {
                    let names: Vec<&str> = robots.iter().map(|r| draft.robots[*r].name.as_str()).collect();
                    let region = &draft.regions[*region].name;
                    let sign = if i == 0 { "" } else { " + " };
                    sum += &format!("{sign}{weight} * count(k_ in {}: k_ in {region})", names.join(", "));
                }
                format!("({sum} {op} {bound})")
            }
            Formula::Not(p) => format!("(not {})", p.text(draft)),
            Formula::Next(p) => format!("(next {})", p.text(draft)),
            Formula::Always(w, p) => format!("(always{} {})", window(w), p.text(draft)),
            Formula::Eventually(w, p) => format!("(eventually{} {})", window(w), p.text(draft)),
            Formula::Infix(op, w, p, q) => {
                format!("({} {op}{} {})", p.text(draft), window(w), q.text(draft))
            }
        }
    }

    /// The same formula, made longer at random places by laws that hold with unknown atoms too.
    pub fn padded(&self, chance: &mut Chance) -> Formula {
        let deep = |p: &Formula, chance: &mut Chance| Box::new(p.padded(chance));
        let same = match self {
            Formula::Not(p) => Formula::Not(deep(p, chance)),
            Formula::Next(p) => Formula::Next(deep(p, chance)),
            Formula::Always(w, p) => Formula::Always(*w, deep(p, chance)),
            Formula::Eventually(w, p) => Formula::Eventually(*w, deep(p, chance)),
            Formula::Infix(op, w, p, q) => Formula::Infix(op, *w, deep(p, chance), deep(q, chance)),
            leaf => leaf.clone(),
        };
        if chance.percent(50) { same.rewritten(chance) } else { same }
    }

    fn rewritten(self, chance: &mut Chance) -> Formula {
        let other = || Formula::In(0, 0);
        let copy = self.clone();
        match chance.below(11) {
            0 => copy.infix("and", self),
            1 => copy.infix("or", self),
            2 => self.not().not(),
            3 => Formula::True.infix("and", self),
            4 => self.infix("or", Formula::True.not()),
            // Absorption, both ways round.
            5 => copy.infix("and", self.infix("or", other())),
            6 => copy.infix("or", self.infix("and", other())),
            7 => Formula::True.infix("->", self),
            8 => Formula::True.infix("<->", self),
            9 => self.unfolded(),
            _ => self.dual(),
        }
    }

    /// By De Morgan's laws and the duals of the temporal operators.
    fn dual(self) -> Formula {
        let no = |p: Box<Formula>| Box::new(p.not());
        match self {
            Formula::Infix("and", _, p, q) => Formula::Infix("or", None, no(p), no(q)).not(),
            Formula::Infix("or", _, p, q) => Formula::Infix("and", None, no(p), no(q)).not(),
            Formula::Infix("->", _, p, q) => Formula::Infix("or", None, no(p), q),
            Formula::Infix("until", w, p, q) => Formula::Infix("release", w, no(p), no(q)).not(),
            Formula::Infix("release", w, p, q) => Formula::Infix("until", w, no(p), no(q)).not(),
            Formula::Infix("weak until", w, p, q) => Formula::Infix("strong release", w, no(p), no(q)).not(),
            Formula::Infix("strong release", w, p, q) => Formula::Infix("weak until", w, no(p), no(q)).not(),
            Formula::Always(w, p) => Formula::Eventually(w, no(p)).not(),
            Formula::Eventually(w, p) => Formula::Always(w, no(p)).not(),
            Formula::Next(p) => Formula::Next(no(p)).not(),
            other => other,
        }
    }

    /// The first step of a temporal operator written out.
    fn unfolded(self) -> Formula {
        let copy = self.clone();
        let next = |f: Formula| Formula::Next(Box::new(f));
        match self {
            Formula::Always(None, p) => p.infix("and", next(copy)),
            Formula::Eventually(None, p) => p.infix("or", next(copy)),
            Formula::Always(Some((0, n)), p) if n > 0 => {
                let rest = next(Formula::Always(Some((0, n - 1)), p.clone()));
                p.infix("and", rest)
            }
            Formula::Eventually(Some((m, n)), p) if m > 0 => {
                next(Formula::Eventually(Some((m - 1, n - 1)), p))
            }
            Formula::Infix("until", None, p, q) => q.infix("or", p.infix("and", next(copy))),
            Formula::Infix("release", None, p, q) => q.infix("and", p.infix("or", next(copy))),
            other => other,
        }
    }

    /// A formula that follows from this one, where some part can be relaxed.
    pub fn relaxed(&self, chance: &mut Chance) -> Formula {
        let copy = || Box::new(self.clone());
        let later = chance.between(1, 4) as usize;
        match self {
            Formula::Infix("and", _, p, q) => match chance.below(3) {
                0 => (**p).clone(),
                1 => Formula::Infix("and", None, Box::new(p.relaxed(chance)), q.clone()),
                _ => Formula::Infix("and", None, p.clone(), Box::new(q.relaxed(chance))),
            },
            Formula::Always(None, p) if chance.percent(30) => {
                Formula::Always(Some((later, later + 3)), p.clone())
            }
            Formula::Always(Some((m, n)), p) if n > m => Formula::Always(Some((m + 1, *n)), p.clone()),
            Formula::Always(w, p) => Formula::Always(*w, Box::new(p.relaxed(chance))),
            Formula::Eventually(Some((m, n)), p) => {
                Formula::Eventually(Some((m.saturating_sub(later), n + later)), p.clone())
            }
            Formula::Eventually(w, p) => Formula::Eventually(*w, Box::new(p.relaxed(chance))),
            Formula::Next(p) => Formula::Next(Box::new(p.relaxed(chance))),
            Formula::Infix("until", Some((m, n)), p, q) => {
                Formula::Infix("until", Some((*m, n + later)), p.clone(), q.clone())
            }
            Formula::Infix("until", None, p, q) => Formula::Infix("weak until", None, p.clone(), q.clone()),
            Formula::Infix("strong release", w, p, q) => Formula::Infix("release", *w, p.clone(), q.clone()),
            Formula::Compare(terms, ">=", bound) => Formula::Compare(terms.clone(), ">=", bound - 1),
            Formula::Compare(terms, "<=", bound) => Formula::Compare(terms.clone(), "<=", bound + 1),
            Formula::Compare(terms, "=", bound) => Formula::Compare(terms.clone(), "<=", *bound),
            _ => Formula::Infix("or", None, copy(), Box::new(Formula::In(0, 0))),
        }
    }
}
