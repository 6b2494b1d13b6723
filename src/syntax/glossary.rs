//! What each word and sign of the language means, in a sentence or two: what an editor shows where one
//! stands. The lists are those of [`words`](super::words); the test below holds one against the other.

/// A word or sign with its meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// As it is written.
    pub word: &'static str,
    /// What it means: one or two sentences of Markdown.
    pub meaning: &'static str,
    /// A piece of a mission that shows it.
    pub example: &'static str,
}

/// The meaning of a word or sign.
pub fn entry(word: &str) -> Option<&'static Entry> {
    let word = SYNONYMS.iter().find(|(other, _)| *other == word).map_or(word, |(_, first)| first);
    ENTRIES.iter().find(|entry| entry.word == word)
}

/// Letters and signs with the word that they stand for.
pub const SYNONYMS: [(&str, &str); 17] = [
    ("X", "next"),
    ("F", "eventually"),
    ("<>", "eventually"),
    ("G", "always"),
    ("[]", "always"),
    ("U", "until"),
    ("R", "release"),
    ("W", "weak"),
    ("M", "strong"),
    ("||", "or"),
    ("&&", "and"),
    ("!", "not"),
    ("±", "+/-"),
    ("y", "x"),
    ("z", "x"),
    ("<", "<="),
    (">", ">="),
];

const fn means(word: &'static str, meaning: &'static str, example: &'static str) -> Entry {
    Entry { word, meaning, example }
}

/// All meanings.
pub const ENTRIES: &[Entry] = &[
    // Declarations.
    means("dosm", "The edition of the language. It is the first declaration of every mission.", "dosm 1"),
    means("mission", "The mission's name. Without it the file's name is taken.", "mission relay"),
    means(
        "param",
        "A constant that the command line may override: `--set NAME=EXPR`, with the same dimension or a bare number.",
        "param radius = 1.5 m",
    ),
    means(
        "let",
        "A constant, or a table whose entries are counted from 1.",
        "let spots = [1, 1; 4, 2] m\nbase mast at (spots[2, 1], spots[2, 2])",
    ),
    means(
        "workspace",
        "Where robots move: a bounded convex polytope in 2 or 3 dimensions, which fixes the dimension of every shape.",
        "workspace box (0, 0) .. (12, 12)",
    ),
    means(
        "region",
        "A region of interest, which goals speak of. Regions may overlap and need not cover the workspace.",
        "region depot = box (9, 1) .. (11.5, 3.5)",
    ),
    means(
        "obstacle",
        "A set that robots stay out of, with their whole tube and also between two steps.",
        "obstacle rock = polygon (8, 8), (9, 8), (8.5, 9.5)",
    ),
    means(
        "opaque",
        "An opaque obstacle blocks radio links too.",
        "opaque obstacle wall = box (4, 0) .. (4.2, 8)",
    ),
    means(
        "jammer",
        "A jamming area: no link may cross it, and no robot may be in it.",
        "jammer J1 = ball (4, 7) radius 1",
    ),
    means("base", "A stationary base station, which robots keep radio contact with.", "base home at (1, 1)"),
    means(
        "dynamics",
        "A motion model x⁺ = A x + B u + c + w: states, inputs, their bounds, and the disturbance w. A tube that every disturbance is kept in is computed from it.",
        "dynamics Rover {\n  step 0.5 s\n  integrator 2\n  bound ax, ay in [-2, 2] m/s^2\n  disturbance px, py in [-0.1, 0.1] m\n}",
    ),
    means(
        "robot",
        "A robot with its motion model and its initial state; with indices, a family of robots.",
        "robot fleet[i in 1..3]: Rover at (2 * i, 1)",
    ),
    means("team", "A named set of robots, for counts and quantifiers.", "team scouts = R1, fleet[2]"),
    means(
        "separation",
        "The least distance between any two robots, in the ∞-norm, at and between steps.",
        "separation 0.3 m",
    ),
    means(
        "connectivity",
        "What radio contact is asked. Without this declaration every robot must reach a base over any number of links at every step.",
        "connectivity { hops <= 3  range 6 m }",
    ),
    means(
        "horizon",
        "The lengths of plan that may be tried, in steps; `1..64` without it. The shortest is looked for.",
        "horizon 1..40",
    ),
    means(
        "minimize",
        "What the best plan of the shortest length minimizes: `effort` or `length`.",
        "minimize effort",
    ),
    means(
        "goal",
        "A part of the specification. A plan satisfies all goals, for every disturbance, on an infinite run.",
        "goal deliver: always eventually R1 in depot",
    ),
    means("define", "A named formula, to be used in goals.", "define busy = R1 in depot or R2 in depot"),
    // Small words.
    means(
        "in",
        "A robot is in a region: with its whole tube. Also the range of an index or a variable, and the interval of a bound.",
        "goal g: forall i in 1..3: eventually fleet[i] in depot",
    ),
    means(
        "at",
        "The place of a base, or the initial state of a robot.",
        "robot R1: Rover at { px = 4.5, vx = 0.2 }",
    ),
    // Shapes.
    means("box", "The axis-aligned box between two opposite corners.", "box (0, 0) .. (12, 12)"),
    means(
        "ball",
        "A ball: of the ∞-norm (a cube) unless `norm 1` or `norm 2` follows. Its numbers may be uncertain.",
        "ball (4 +/- 0.3, 7) radius 1 norm 2",
    ),
    means("disc", "A Euclidean ball in the plane: `ball … norm 2`.", "disc (20, 5) radius 1"),
    means(
        "polygon",
        "A convex polygon in the plane by its corners, in either orientation.",
        "polygon (0, 0), (2, 0), (1, 2)",
    ),
    means("hull", "The convex hull of some points, in 2 or 3 dimensions.", "hull (8, 8), (9, 8), (8.5, 9.5)"),
    means(
        "where",
        "Half-spaces over the coordinates `x`, `y` (and `z`); in `bound where` over states and inputs.",
        "region corner = where { x >= 0; y >= 0; x + y <= 2 }",
    ),
    means("radius", "The radius of a ball or a disc; it may be uncertain.", "ball (4, 7) radius 1 +/- 0.2"),
    means(
        "norm",
        "The norm of a ball (1 or 2) or of a range (2); the ∞-norm without it.",
        "ball (4, 7) radius 1 norm 2",
    ),
    means(
        "+/-",
        "Anything between the number less and plus this much: the plan holds for all of it.",
        "jammer J = ball (4 +/- 0.3, 7 ± 0.3) radius 1",
    ),
    means(
        "..",
        "From one end to the other, both included; or the opposite corners of a box.",
        "horizon 1..40",
    ),
    // Motion models.
    means("step", "The sampling time, the same for all models in use.", "step 0.5 s"),
    means(
        "state",
        "The names, order and units of the states x. Units are SI without prefixes.",
        "state px: m, vx: m/s",
    ),
    means("input", "The names, order and units of the inputs u. Each needs a bound.", "input ax: m/s^2"),
    means("position", "Which states are the coordinates in the workspace.", "position px, py"),
    means(
        "continuous",
        "A, B and c describe dx/dt; the model is their exact zero-order hold over a step.",
        "continuous",
    ),
    means(
        "integrator",
        "One chain of so many integrators for each coordinate, instead of states, inputs and matrices. With `integrator 2` in the plane the states are `px, vx, py, vy` and the inputs `ax, ay`.",
        "integrator 2",
    ),
    means(
        "bound",
        "An interval that states or inputs stay in, tube and feedback included; with `where`, general half-spaces.",
        "bound vx, vy in [-4, 4] m/s",
    ),
    means(
        "disturbance",
        "The interval that the disturbance of states lies in, a new one at each step. States not named have none.",
        "disturbance px, py in [-0.2, 0.2] m",
    ),
    means(
        "rejection",
        "The share of the inputs' extent that is kept for the feedback, between 0 and 1. The compiler chooses one without it.",
        "rejection 0.5",
    ),
    means(
        "mode",
        "A part of the states and inputs with matrices of its own: piecewise affine motion.",
        "mode wet when { px >= 5 } { B = [0.1; 0.4] }",
    ),
    means(
        "when",
        "Where a mode holds: half-spaces over states and inputs.",
        "mode dry when { px <= 5 } { B = [0.2; 0.5] }",
    ),
    means("A", "The state's own part of the motion, n × n: x⁺ = A x + B u + c.", "A = [1, 0.5; 0, 1]"),
    means("B", "The inputs' part of the motion, n × m: x⁺ = A x + B u + c.", "B = [0.125; 0.5]"),
    means(
        "c",
        "The constant part of the motion, n entries: x⁺ = A x + B u + c; 0 without it.",
        "c = [0, 0.1]",
    ),
    // Connectivity.
    means("hops", "The most links between a robot and a base.", "hops <= 3"),
    means(
        "range",
        "The longest link: in the ∞-norm, or with `norm 2` the Euclidean one.",
        "range 6 m norm 2",
    ),
    means(
        "redundancy",
        "How many robots may be lost, whichever they are, with all others still connected; at most 3.",
        "redundancy 1",
    ),
    means(
        "every",
        "How often contact is required, in steps or as a time: at 0 and each multiple.",
        "every 2 s",
    ),
    means("none", "No radio contact is asked; then no base is needed.", "connectivity none"),
    means("effort", "The sum of the squares of all inputs.", "minimize effort"),
    means("length", "The sum of the distances from step to step, in the ∞-norm.", "minimize length"),
    // Formulas.
    means(
        "always",
        "At this step and all later ones (`G`, `[]`); with a window, at all steps of it.",
        "goal g: always[0, 9] R1 in depot",
    ),
    means(
        "eventually",
        "At this step or some later one (`F`, `<>`); with a window, at some step of it.",
        "goal g: eventually[0 s, 20 s] R1 in depot",
    ),
    means("next", "At the next step (`X`).", "goal g: next R1 in depot"),
    means(
        "until",
        "The right-hand side holds at some step from now on, the left-hand side at all steps before it (`U`).",
        "goal g: R1 in dock until[2, 9] R2 in depot",
    ),
    means(
        "release",
        "The right-hand side holds up to and with the step at which the left-hand side does, or for ever (`R`).",
        "goal g: R1 in dock release R2 in depot",
    ),
    means(
        "weak",
        "`weak until` (`W`): as `until`, but the right-hand side need never hold if the left-hand side always does.",
        "goal g: R1 in dock weak until R2 in depot",
    ),
    means(
        "strong",
        "`strong release` (`M`): as `release`, but the left-hand side does hold at some step.",
        "goal g: R1 in dock strong release R2 in depot",
    ),
    means("and", "Both hold (`&&`).", "goal g: eventually R1 in a and eventually R1 in b"),
    means(
        "or",
        "One of them holds (`||`); between shapes, their union.",
        "region ports = box (0, 0) .. (1, 1) or box (4, 0) .. (5, 1)",
    ),
    means(
        "not",
        "It certainly does not hold (`!`): for `in`, the tube meets no piece of the region.",
        "goal g: always not R1 in depot",
    ),
    means(
        "->",
        "If the left-hand side, then the right-hand side: `not a or b`.",
        "goal g: always (R1 in a -> eventually R1 in b)",
    ),
    means(
        "<->",
        "Both or neither: `(a and b) or (not a and not b)`.",
        "goal g: always (R1 in a <-> R2 in b)",
    ),
    means(
        "forall",
        "For each robot of a set, or each number of a range. Reaches as far right as possible.",
        "goal g: forall r in fleet: always eventually r in depot",
    ),
    means(
        "exists",
        "For some robot of a set, or some number of a range. Reaches as far right as possible.",
        "goal g: always exists r in all: r in depot",
    ),
    means(
        "count",
        "How many robots of a set are in a region; compared with a number. It must hold whatever is not certain.",
        "goal g: always eventually count(r in all: r in depot) = 1",
    ),
    means("all", "All robots of the mission.", "goal g: forall r in all: always not r in depot"),
    means("true", "What always holds.", "goal g: always eventually true"),
    means("false", "What never holds.", "goal g: not false"),
    // Signs.
    means(
        "=",
        "Both sides are the same number; also what follows a declared name.",
        "goal g: always count(r in all: r in a) = 1",
    ),
    means("!=", "The sides are different numbers.", "goal g: always count(r in all: r in a) != 2"),
    means(
        "<=",
        "The left-hand side is at most the right-hand side (`<`: less).",
        "goal g: always count(r in all: r in a) <= 2",
    ),
    means(
        ">=",
        "The left-hand side is at least the right-hand side (`>`: more).",
        "goal g: always count(r in all: r in a) >= 1",
    ),
    means("+", "The sum of two quantities of one dimension.", "let far = 2 m + 30 cm"),
    means(
        "-",
        "The difference of two quantities of one dimension, or a negative number.",
        "let near = 2 m - 30 cm",
    ),
    means("*", "The product; a unit follows a number without it.", "let area = 2 m * 3 m"),
    means(
        "/",
        "The quotient; exact, like all arithmetic but roots, sines and fractional powers.",
        "let speed = 6 m / 4 s",
    ),
    means(
        "^",
        "The power; it binds tightest, to the right. With whole exponents up to 64 it is exact.",
        "let volume = (2 m)^3",
    ),
    // Names that every mission has.
    means("pi", "The double nearest to π.", "let turn = 2 * pi"),
    means(
        "sqrt",
        "The square root: `sqrt(x)`, x ≥ 0. The dimension's exponents are halved.",
        "let diagonal = sqrt(2) * 3 m",
    ),
    means(
        "sin",
        "The sine of an angle: `sin(x)`, in radians unless x has a unit.",
        "let height = 2 m * sin(30 deg)",
    ),
    means(
        "cos",
        "The cosine of an angle: `cos(x)`, in radians unless x has a unit.",
        "let width = 2 m * cos(30 deg)",
    ),
    means(
        "min",
        "The least of its arguments, all of one dimension: `min(a, b, …)`. Behind a number it is the minute.",
        "let short = min(2 m, 150 cm)",
    ),
    means(
        "max",
        "The greatest of its arguments, all of one dimension: `max(a, b, …)`.",
        "let long = max(2 m, 150 cm)",
    ),
    means("abs", "The value without its sign: `abs(x)`.", "let size = abs(-2 m)"),
    means("floor", "The greatest whole number that is not greater: `floor(x)`.", "let row = floor(7 / 3)"),
    means("mod", "The remainder of the division: `mod(a, b)`, with the sign of b.", "let column = mod(7, 3)"),
    means(
        "x",
        "A coordinate inside `where`: a length. There it comes before every other meaning of the name.",
        "region left = where { x <= 3; x >= 0; y >= 0; y <= 9 }",
    ),
    // Units.
    means("m", "Metre, the SI unit of length.", "separation 0.3 m"),
    means("cm", "Centimetre: 0.01 m.", "separation 30 cm"),
    means("mm", "Millimetre: 0.001 m.", "separation 300 mm"),
    means("km", "Kilometre: 1000 m.", "let far = 2 km"),
    means("s", "Second, the SI unit of time.", "step 0.5 s"),
    means("ms", "Millisecond: 0.001 s.", "step 500 ms"),
    means("rad", "Radian, the SI unit of angle: a plain number.", "let a = sin(0.5 rad)"),
    means("deg", "Degree: π/180 rad.", "let a = sin(30 deg)"),
    means("kg", "Kilogram, the SI unit of mass.", "let load = 12 kg"),
    means("g", "Gram: 0.001 kg.", "let load = 300 g"),
    means("N", "Newton, the SI unit of force: kg·m/s².", "let push = 20 N"),
];

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::syntax::words::CLASSES;

    #[test]
    fn every_word_and_sign_has_a_meaning() {
        let words: BTreeSet<&str> = CLASSES.iter().flat_map(|(_, list)| *list).copied().collect();
        let without: Vec<&&str> = words.iter().filter(|word| entry(word).is_none()).collect();
        assert!(without.is_empty(), "nothing is said about {without:?}");
        let other: Vec<&str> = ENTRIES.iter().map(|e| e.word).filter(|w| !words.contains(w)).collect();
        assert!(other.is_empty(), "these are no words of the language: {other:?}");
        let twice: Vec<&str> =
            SYNONYMS.iter().map(|s| s.0).filter(|w| ENTRIES.iter().any(|e| e.word == *w)).collect();
        assert!(twice.is_empty(), "these have a meaning of their own: {twice:?}");
    }

    #[test]
    fn meanings_are_short_and_examples_show_the_word() {
        for Entry { word, meaning, example } in ENTRIES {
            assert!(meaning.ends_with('.') && meaning.len() < 240, "{word}: {meaning}");
            assert!(example.contains(word), "{word}: {example}");
        }
    }

    #[test]
    fn examples_are_pieces_of_missions() {
        for Entry { word, example, .. } in ENTRIES {
            let tokens = crate::syntax::token::tokens(example);
            assert!(tokens.iter().all(|t| t.kind != crate::syntax::token::Kind::LineComment), "{word}");
            let open = example.chars().filter(|c| "([{".contains(*c)).count();
            let closed = example.chars().filter(|c| ")]}".contains(*c)).count();
            assert_eq!(open, closed, "{word}: {example}");
            // Whole declarations can be read; items and shapes stand in one that can.
            let whole = [
                format!("dosm 1\n{example}"),
                format!("dosm 1 region r = {example}"),
                format!("dosm 1 dynamics D {{ {example} }}"),
                format!("dosm 1 connectivity {{ {example} }}"),
            ];
            let reads = |text: &String| {
                let mut diagnostics = crate::diag::Diagnostics::new();
                let source = crate::source::SourceFile::new("test.dosm", text.as_str());
                let file = crate::syntax::parse(&source, &mut diagnostics);
                file.is_ok_and(|f| f.broken.is_empty()) && diagnostics.or_reported().is_ok()
            };
            assert!(whole.iter().any(reads), "{word}: {example}");
        }
    }
}
