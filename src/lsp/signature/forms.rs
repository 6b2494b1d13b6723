//! The forms that are shown, part by part.

/// A piece of a form's text.
pub(super) enum Part {
    /// What stands there in any case.
    Sign(&'static str),
    /// What is to be written, with what it means.
    Place(&'static str, &'static str),
}

/// When a form is over.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Ends {
    /// With the bracket that its word opens.
    WithBracket,
    /// When the bracket of its last part is closed.
    AfterLast,
    /// As `AfterLast`, but other forms may stand inside.
    Declaration,
    /// With whatever comes next that is no part of it.
    Open,
}

/// A construct of the language with several parts.
pub(super) struct Form {
    /// The word that it begins with.
    pub(super) word: &'static str,
    /// Its text.
    pub(super) parts: &'static [Part],
    /// When it is over.
    pub(super) ends: Ends,
    /// The tokens with which each part but the first begins, `,` where a comma between parts does.
    steps: &'static [&'static str],
    /// The token behind which it is over.
    pub(super) over_behind: Option<&'static str>,
}

impl Form {
    /// How many parts there are to write.
    pub(super) fn count(&self) -> usize {
        self.parts.iter().filter(|part| matches!(part, Part::Place(..))).count()
    }

    /// Whether a comma leads to the next part: inside of its bracket, or between points.
    pub(super) fn counts_commas(&self, inside: bool, part: usize) -> bool {
        let listed = matches!(self.word, "polygon" | "hull");
        inside != listed && (listed || self.steps.get(part) == Some(&","))
    }

    /// The part that a token begins, from another one.
    pub(super) fn part_behind(&self, token: &str, part: usize) -> Option<usize> {
        let next = self.steps.get(part..)?.iter().position(|step| *step == token && token != ",")?;
        // Parts may be left out, but not those that only a bracket leads to.
        let skipped = &self.steps[part..part + next];
        skipped.iter().all(|step| *step == "radius" || *step == "norm").then_some(part + next + 1)
    }
}

/// The form that a word begins; that of a window where a bracket follows.
pub(super) fn form(word: &str, bracket: bool) -> Option<&'static Form> {
    let temporal =
        matches!(word, "always" | "eventually" | "until" | "release" | "F" | "G" | "U" | "R" | "W" | "M");
    if temporal {
        return bracket.then_some(&WINDOW);
    }
    FORMS.iter().find(|form| form.word == word)
}

use Part::{Place, Sign};

const WINDOW: Form = Form {
    word: "always",
    parts: &[
        Sign("["),
        Place("m", "The first step, or a time such as `2 s`."),
        Sign(", "),
        Place("n", "The last step, included; a time if the first one is."),
        Sign("]"),
    ],
    ends: Ends::WithBracket,
    steps: &[","],
    over_behind: None,
};

const fn function(word: &'static str, parts: &'static [Part], steps: &'static [&'static str]) -> Form {
    Form { word, parts, ends: Ends::WithBracket, steps, over_behind: None }
}

/// All forms but windows.
pub(super) const FORMS: &[Form] = &[
    Form {
        word: "box",
        parts: &[
            Sign("box "),
            Place("(x0, y0)", "The corner with the least coordinates."),
            Sign(" .. "),
            Place("(x1, y1)", "The corner with the greatest coordinates."),
        ],
        ends: Ends::AfterLast,
        steps: &[".."],
        over_behind: None,
    },
    Form {
        word: "ball",
        parts: &[
            Sign("ball "),
            Place("(x, y)", "The middle; each coordinate may be uncertain: `4 +/- 0.3`."),
            Sign(" radius "),
            Place("r", "The radius; it may be uncertain, too."),
            Sign(" norm "),
            Place("n", "1 or 2; left out, it is the ∞-norm, and the ball is a cube."),
        ],
        ends: Ends::Open,
        steps: &["radius", "norm"],
        over_behind: None,
    },
    Form {
        word: "disc",
        parts: &[
            Sign("disc "),
            Place("(x, y)", "The middle; each coordinate may be uncertain: `4 +/- 0.3`."),
            Sign(" radius "),
            Place("r", "The radius; it may be uncertain, too."),
        ],
        ends: Ends::Open,
        steps: &["radius"],
        over_behind: None,
    },
    Form {
        word: "polygon",
        parts: &[
            Sign("polygon "),
            Place("(x0, y0)", "A corner; corners follow one another around the polygon."),
            Sign(", "),
            Place("(x1, y1)", "The next corner."),
            Sign(", "),
            Place("(x2, y2), …", "At least three corners; the polygon has to be convex."),
        ],
        ends: Ends::Open,
        steps: &[",", ","],
        over_behind: None,
    },
    Form {
        word: "hull",
        parts: &[
            Sign("hull "),
            Place("(x0, y0)", "A point; the order does not matter."),
            Sign(", "),
            Place("(x1, y1)", "The next point."),
            Sign(", "),
            Place("(x2, y2), …", "Enough points not to be flat."),
        ],
        ends: Ends::Open,
        steps: &[",", ","],
        over_behind: None,
    },
    Form {
        word: "where",
        parts: &[
            Sign("where { "),
            Place(
                "x + 2 * y <= 3; …",
                "Inequalities with `<=` or `>=`, linear in the coordinates; in `bound` in states and inputs.",
            ),
            Sign(" }"),
        ],
        ends: Ends::AfterLast,
        steps: &[],
        over_behind: None,
    },
    function("sqrt", &[Sign("sqrt("), Place("x", "At least 0; may have a unit."), Sign(")")], &[]),
    function("sin", &[Sign("sin("), Place("x", "An angle: in radians, or with a unit."), Sign(")")], &[]),
    function("cos", &[Sign("cos("), Place("x", "An angle: in radians, or with a unit."), Sign(")")], &[]),
    function("abs", &[Sign("abs("), Place("x", "Any quantity."), Sign(")")], &[]),
    function("floor", &[Sign("floor("), Place("x", "A number without a unit."), Sign(")")], &[]),
    function(
        "min",
        &[
            Sign("min("),
            Place("a", "A quantity."),
            Sign(", "),
            Place("b, …", "Of the same dimension."),
            Sign(")"),
        ],
        &[","],
    ),
    function(
        "max",
        &[
            Sign("max("),
            Place("a", "A quantity."),
            Sign(", "),
            Place("b, …", "Of the same dimension."),
            Sign(")"),
        ],
        &[","],
    ),
    function(
        "mod",
        &[
            Sign("mod("),
            Place("a", "A quantity."),
            Sign(", "),
            Place("b", "What it is divided by."),
            Sign(")"),
        ],
        &[","],
    ),
    function(
        "count",
        &[
            Sign("count("),
            Place("r", "A name for the robot."),
            Sign(" in "),
            Place("SET", "`all`, or robots, teams and families: `R1, fleet`."),
            Sign(": "),
            Place("r in REGION", "The region in which robots are counted."),
            Sign(")"),
        ],
        &["in", ":"],
    ),
    Form {
        word: "forall",
        parts: &[
            Sign("forall "),
            Place("r", "A name for the robot or the number."),
            Sign(" in "),
            Place("SET", "`all`, or robots, teams and families; or numbers, `1..n`."),
            Sign(": "),
            Place("FORMULA", "Reaches as far right as possible."),
        ],
        ends: Ends::Open,
        steps: &["in"],
        over_behind: Some(":"),
    },
    Form {
        word: "exists",
        parts: &[
            Sign("exists "),
            Place("r", "A name for the robot or the number."),
            Sign(" in "),
            Place("SET", "`all`, or robots, teams and families; or numbers, `1..n`."),
            Sign(": "),
            Place("FORMULA", "Reaches as far right as possible."),
        ],
        ends: Ends::Open,
        steps: &["in"],
        over_behind: Some(":"),
    },
    Form {
        word: "bound",
        parts: &[
            Sign("bound "),
            Place("NAME, …", "States and inputs of the model, of one unit."),
            Sign(" in ["),
            Place("least", "The lower end."),
            Sign(", "),
            Place("most", "The upper end."),
            Sign("] "),
            Place("UNIT", "A unit for both ends; SI without it."),
        ],
        ends: Ends::Open,
        steps: &["in", ",", "]"],
        over_behind: None,
    },
    Form {
        word: "disturbance",
        parts: &[
            Sign("disturbance "),
            Place("NAME, …", "States of the model, of one unit."),
            Sign(" in ["),
            Place("least", "The lower end."),
            Sign(", "),
            Place("most", "The upper end."),
            Sign("] "),
            Place("UNIT", "A unit for both ends; SI without it."),
        ],
        ends: Ends::Open,
        steps: &["in", ",", "]"],
        over_behind: None,
    },
    Form {
        word: "robot",
        parts: &[
            Sign("robot "),
            Place("NAME", "A name; with indices, `fleet[i in 1..3]`, a family."),
            Sign(": "),
            Place("DYNAMICS", "The motion model."),
            Sign(" at "),
            Place("(x, y)", "The position, other states 0; or all states: `{ px = 1, vx = 0.5 }`."),
        ],
        ends: Ends::Declaration,
        steps: &[":", "at"],
        over_behind: None,
    },
    Form {
        word: "base",
        parts: &[
            Sign("base "),
            Place("NAME", "A name; with indices, `mast[i in 1..3]`, a family."),
            Sign(" at "),
            Place("(x, y)", "The position."),
        ],
        ends: Ends::Declaration,
        steps: &["at"],
        over_behind: None,
    },
    Form {
        word: "horizon",
        parts: &[
            Sign("horizon "),
            Place("A", "The least length of a plan, at least 1."),
            Sign(".."),
            Place("B", "The greatest length that is tried."),
        ],
        ends: Ends::Open,
        steps: &[".."],
        over_behind: None,
    },
];
