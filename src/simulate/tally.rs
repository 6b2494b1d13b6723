//! What runs came to: the least margins, and how often there was none.

/// What is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A state's own bounds.
    State,
    /// Bounds over states and inputs together.
    Mixed,
    /// An input's own bounds.
    Input,
    /// The workspace.
    Workspace,
    /// Obstacles and jammers.
    Blocker,
    /// Other robots.
    Separation,
    /// What links must not cross.
    Link,
    /// How long links may be.
    Range,
    /// Regions that a robot is certainly in or out of.
    Region,
    /// Whether everybody reaches a base.
    Connectivity,
    /// The mission's goals.
    Goal,
}

impl Kind {
    /// All of them.
    pub const ALL: [Kind; 11] = [
        Kind::State,
        Kind::Mixed,
        Kind::Input,
        Kind::Workspace,
        Kind::Blocker,
        Kind::Separation,
        Kind::Link,
        Kind::Range,
        Kind::Region,
        Kind::Connectivity,
        Kind::Goal,
    ];

    /// Its name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Kind::State => "state",
            Kind::Mixed => "mixed",
            Kind::Input => "input",
            Kind::Workspace => "workspace",
            Kind::Blocker => "blocker",
            Kind::Separation => "separation",
            Kind::Link => "link",
            Kind::Range => "range",
            Kind::Region => "region",
            Kind::Connectivity => "connectivity",
            Kind::Goal => "goal",
        }
    }

    /// Whether it has a margin, rather than holding or not.
    pub fn has_margin(self) -> bool {
        !matches!(self, Kind::Connectivity | Kind::Goal)
    }
}

/// How many kinds there are.
const KINDS: usize = Kind::ALL.len();

/// Where and when something was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// The run, from 0.
    pub run: u64,
    /// The sample, from 0.
    pub sample: usize,
    /// So many eighths of a step after it.
    pub eighths: u8,
    /// The robots that it is about; none of them stands for all.
    pub robots: [Option<usize>; 2],
    /// What it is about.
    pub against: Against,
}

/// What a margin is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// A state of the robot's model.
    State(usize),
    /// An input of the robot's model.
    Input(usize),
    /// One of the bounds over states and inputs.
    Bound(usize),
    /// The workspace.
    Workspace,
    /// A piece of a blocker.
    Piece {
        /// The blocker.
        blocker: usize,
        /// The piece.
        piece: usize,
    },
    /// The other robot.
    Each,
    /// A link to a base that a piece of a blocker is in the way of, or that is too long.
    Base {
        /// The base.
        base: usize,
        /// The blocker.
        blocker: Option<usize>,
    },
    /// A region.
    Region(usize),
    /// A goal.
    Goal(usize),
    /// Nothing else.
    Nothing,
}

/// The least margin of a kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Least {
    /// The margin: in metres; of states and inputs the share of half their range that is left.
    pub margin: f64,
    /// Where and when.
    pub spot: Spot,
}

/// Margins and shortfalls of some runs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    least: [Option<Least>; KINDS],
    short: [u64; KINDS],
    /// The first of each kind.
    first: [Option<Least>; KINDS],
}

impl Tally {
    /// The least margin of a kind, where something of this kind was looked at.
    pub fn least(&self, kind: Kind) -> Option<&Least> {
        self.least[kind as usize].as_ref()
    }

    /// How often there was no margin left.
    pub fn shortfalls(&self, kind: Kind) -> u64 {
        self.short[kind as usize]
    }

    /// The first of them.
    pub fn first(&self, kind: Kind) -> Option<&Least> {
        self.first[kind as usize].as_ref()
    }

    /// How often there was no margin left, of whatever kind.
    pub fn all_shortfalls(&self) -> u64 {
        self.short.iter().sum()
    }

    /// Adds what later runs came to.
    pub(super) fn add(&mut self, later: &Tally) {
        for kind in 0..KINDS {
            self.short[kind] += later.short[kind];
            self.first[kind] = self.first[kind].or(later.first[kind]);
            if let Some(least) = later.least[kind]
                && self.least[kind].is_none_or(|l| least.margin < l.margin)
            {
                self.least[kind] = Some(least);
            }
        }
    }
}

/// Whether a margin is less than a level, or no number.
pub(super) fn short_of(margin: f64, level: f64) -> bool {
    margin < level || margin.is_nan()
}

/// A tally under way, with what needs no second look.
#[derive(Clone, Debug)]
pub(super) struct Book {
    tally: Tally,
    /// By kind: the least margin so far, or 0 if that is less; what is at least that changes nothing.
    level: [f64; KINDS],
    /// By kind: the least margin so far, tallies that were taken included.
    least: [f64; KINDS],
}

impl Default for Book {
    fn default() -> Book {
        Book { tally: Tally::default(), level: [f64::INFINITY; KINDS], least: [f64::INFINITY; KINDS] }
    }
}

impl Book {
    /// The margin from which on nothing has to be noted.
    pub(super) fn level(&self, kind: Kind) -> f64 {
        self.level[kind as usize]
    }

    /// Notes a margin; says whether there is none left.
    pub(super) fn note(&mut self, kind: Kind, margin: f64, spot: Spot) -> bool {
        let at = kind as usize;
        let found = Least { margin, spot };
        // What is no number is no margin.
        let short = short_of(margin, 0.0);
        if short {
            self.tally.short[at] += 1;
            self.tally.first[at].get_or_insert(found);
        }
        if short_of(margin, self.least[at]) {
            self.least[at] = margin;
            self.level[at] = margin.max(0.0);
            self.tally.least[at] = Some(found);
        }
        short
    }

    /// Takes out what was noted since the last time.
    pub(super) fn take(&mut self) -> Tally {
        std::mem::take(&mut self.tally)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spot(run: u64) -> Spot {
        Spot { run, sample: 0, eighths: 0, robots: [None; 2], against: Against::Nothing }
    }

    #[test]
    fn tallies_add_up_in_the_order_of_runs() {
        let mut book = Book::default();
        assert!(!book.note(Kind::Link, 0.5, spot(0)));
        assert!(!book.note(Kind::Link, 0.5, spot(1)), "an equal margin is no less");
        let mut all = book.take();
        assert!(book.note(Kind::Link, -0.25, spot(2)) && book.note(Kind::Link, -0.125, spot(3)));
        assert!(book.note(Kind::State, f64::NAN, spot(3)));
        all.add(&book.take());
        assert_eq!(all.least(Kind::Link).map(|l| (l.margin, l.spot.run)), Some((-0.25, 2)));
        assert_eq!((all.shortfalls(Kind::Link), all.all_shortfalls()), (2, 3));
        assert_eq!(all.first(Kind::Link).map(|l| l.spot.run), Some(2));
        assert_eq!((book.level(Kind::Link), book.level(Kind::Goal)), (0.0, f64::INFINITY));
        let mut other = Book::default();
        other.note(Kind::Link, -0.25, spot(4));
        all.add(&other.take());
        assert_eq!(all.least(Kind::Link).map(|l| l.spot.run), Some(2), "the earliest of equals stays");
    }
}
