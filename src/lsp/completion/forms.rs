//! What words are followed by: as one reads it, and as a snippet with places to fill in.

/// A word with the form of what it begins.
pub(super) struct Form {
    pub(super) word: &'static str,
    /// As the language's reference shows it.
    pub(super) form: &'static str,
    /// In the protocol's syntax of snippets.
    pub(super) snippet: &'static str,
}

const fn form(word: &'static str, form: &'static str, snippet: &'static str) -> Form {
    Form { word, form, snippet }
}

/// The declarations, those that most missions begin with first.
pub(super) const DECLARATION_FORMS: [Form; 19] = [
    form("dosm", "dosm 1", "dosm 1"),
    form("mission", "mission NAME", "mission ${1:name}"),
    form("workspace", "workspace SHAPE", "workspace box (${1:0}, ${2:0}) .. (${3:12}, ${4:12})"),
    form("region", "region NAME = SHAPE", "region ${1:name} = $0"),
    form("obstacle", "obstacle NAME = SHAPE", "obstacle ${1:name} = $0"),
    form("opaque", "opaque obstacle NAME = SHAPE", "opaque obstacle ${1:name} = $0"),
    form("jammer", "jammer NAME = SHAPE", "jammer ${1:name} = ball (${2:0}, ${3:0}) radius ${4:1}"),
    form("base", "base NAME at POINT", "base ${1:B1} at (${2:1}, ${3:1})"),
    form(
        "dynamics",
        "dynamics NAME { … }",
        "dynamics ${1:Rover} {\n  step ${2:0.5} s\n  integrator ${3:2}\n  bound vx, vy in [${4:-4}, ${5:4}] m/s\n  \
         bound ax, ay in [${6:-4}, ${7:4}] m/s^2\n  disturbance px, py in [${8:-0.1}, ${9:0.1}] m\n}",
    ),
    form("robot", "robot NAME: DYNAMICS at STATE", "robot ${1:R1}: ${2:MODEL} at (${3:1}, ${4:1})"),
    form("team", "team NAME = ROBOT, …", "team ${1:name} = $0"),
    form("separation", "separation LENGTH", "separation ${1:0.1} m"),
    form("connectivity", "connectivity { … }, connectivity none", "connectivity {\n  $0\n}"),
    form("horizon", "horizon A..B", "horizon ${1:1}..${2:40}"),
    form("minimize", "minimize effort, minimize length", "minimize ${1|effort,length|}"),
    form("goal", "goal NAME: FORMULA", "goal ${1:name}: $0"),
    form("define", "define NAME = FORMULA", "define ${1:name} = $0"),
    form("param", "param NAME = EXPRESSION", "param ${1:name} = $0"),
    form("let", "let NAME = EXPRESSION", "let ${1:name} = $0"),
];

/// The shapes.
pub(super) const SHAPE_FORMS: [Form; 6] = [
    form("box", "box P .. Q", "box (${1:0}, ${2:0}) .. (${3:1}, ${4:1})"),
    form("ball", "ball C radius R norm N", "ball (${1:0}, ${2:0}) radius ${3:1}"),
    form("disc", "disc C radius R", "disc (${1:0}, ${2:0}) radius ${3:1}"),
    form("polygon", "polygon P1, P2, …", "polygon (${1:0}, ${2:0}), (${3:1}, ${4:0}), (${5:0}, ${6:1})"),
    form("hull", "hull P1, P2, …", "hull (${1:0}, ${2:0}), (${3:1}, ${4:0}), (${5:0}, ${6:1})"),
    form("where", "where { A x + B y <= C; … }", "where { ${1:x + y <= 2}; ${2:x >= 0}; ${3:y >= 0} }"),
];

/// The items of a `dynamics` block.
pub(super) const DYNAMICS_FORMS: [Form; 13] = [
    form("step", "step TIME", "step ${1:0.5} s"),
    form("state", "state NAME: UNIT, …", "state ${1:px}: ${2:m}"),
    form("input", "input NAME: UNIT, …", "input ${1:ax}: ${2:m/s^2}"),
    form("position", "position STATE, …", "position $0"),
    form("A", "A = [ … ; … ]", "A = [$0]"),
    form("B", "B = [ … ; … ]", "B = [$0]"),
    form("c", "c = [ … ; … ]", "c = [$0]"),
    form("integrator", "integrator ORDER", "integrator ${1:2}"),
    form("continuous", "continuous", "continuous"),
    form("bound", "bound NAME, … in INTERVAL", "bound ${1:vx} in [${2:-4}, ${3:4}]"),
    form("disturbance", "disturbance STATE, … in INTERVAL", "disturbance ${1:px} in [${2:-0.1}, ${3:0.1}]"),
    form("rejection", "rejection SHARE", "rejection ${1:0.5}"),
    form("mode", "mode NAME when { … } { A = …; B = … }", "mode ${1:name} when { $2 } {\n  $0\n}"),
];

/// The items of a `connectivity` block.
pub(super) const CONNECTIVITY_FORMS: [Form; 4] = [
    form("hops", "hops <= N", "hops <= ${1:3}"),
    form("range", "range LENGTH norm N", "range ${1:6} m"),
    form("redundancy", "redundancy N", "redundancy ${1:1}"),
    form("every", "every STEPS, every TIME", "every ${1:2}"),
];

/// The operators before a formula and the other beginnings of one, their letters not among them.
pub(super) const FORMULA_FORMS: [Form; 9] = [
    form("always", "always FORMULA, always[m, n] FORMULA", "always $0"),
    form("eventually", "eventually FORMULA, eventually[m, n] FORMULA", "eventually $0"),
    form("next", "next FORMULA", "next $0"),
    form("not", "not FORMULA", "not $0"),
    form("forall", "forall r in SET: FORMULA", "forall ${1:r} in ${2:all}: $0"),
    form("exists", "exists r in SET: FORMULA", "exists ${1:r} in ${2:all}: $0"),
    form("count", "count(r in SET: r in REGION)", "count(${1:r} in ${2:all}: ${1:r} in $3)"),
    form("true", "true", "true"),
    form("false", "false", "false"),
];

/// What joins two formulas, the letters not among them.
pub(super) const CONNECTIVE_FORMS: [Form; 6] = [
    form("and", "FORMULA and FORMULA", "and $0"),
    form("or", "FORMULA or FORMULA", "or $0"),
    form("until", "FORMULA until FORMULA, … until[m, n] …", "until $0"),
    form("release", "FORMULA release FORMULA, … release[m, n] …", "release $0"),
    form("weak until", "FORMULA weak until FORMULA", "weak until $0"),
    form("strong release", "FORMULA strong release FORMULA", "strong release $0"),
];

/// The letters of operators before a formula.
pub(super) const PREFIX_LETTERS: [(&str, &str); 3] = [("G", "always"), ("F", "eventually"), ("X", "next")];

/// The letters of operators between formulas.
pub(super) const INFIX_LETTERS: [(&str, &str); 4] =
    [("U", "until"), ("R", "release"), ("W", "weak until"), ("M", "strong release")];

/// The functions with their arguments.
pub(super) const FUNCTION_FORMS: [Form; 8] = [
    form("sqrt", "sqrt(x)", "sqrt($0)"),
    form("sin", "sin(angle)", "sin($0)"),
    form("cos", "cos(angle)", "cos($0)"),
    form("min", "min(x, y)", "min($1, $2)"),
    form("max", "max(x, y)", "max($1, $2)"),
    form("abs", "abs(x)", "abs($0)"),
    form("floor", "floor(x)", "floor($0)"),
    form("mod", "mod(x, y)", "mod($1, $2)"),
];

/// A whole mission, for an empty file.
pub(super) const MISSION: Form = form(
    "dosm mission",
    "a whole mission",
    "dosm 1\n\nmission ${1:NAME}\n\nworkspace box (0, 0) .. (${2:10}, ${3:10})\n\nregion ${4:target} = box (7, 7) .. \
     (9, 9)\n\njammer ${5:noise} = ball (5, 5) radius 1\n\nbase ${6:home} at (1, 1)\n\ndynamics Rover {\n  step 0.5 s\n  \
     integrator 2\n  bound vx, vy in [-3, 3] m/s\n  bound ax, ay in [-4, 4] m/s^2\n  disturbance px, py in [-0.1, 0.1] \
     m\n}\n\nrobot ${7:scout}: Rover at (2, 1)\nrobot ${8:relay}: Rover at (1, 2)\n\nseparation 0.2 m\n\ngoal ${9:visit}: \
     always eventually ${7:scout} in ${4:target}$0\n",
);

/// The text of a snippet with its places filled in with what they suggest.
pub(super) fn filled(snippet: &str) -> String {
    let mut text = String::new();
    let mut rest = snippet;
    while let Some((before, behind)) = rest.split_once('$') {
        text.push_str(before);
        rest = match behind.strip_prefix('{').and_then(|place| place.split_once('}')) {
            Some((place, behind)) => {
                let choices =
                    place.split_once('|').map(|(_, choices)| choices.split(',').next().unwrap_or(""));
                text.push_str(choices.or(place.split_once(':').map(|p| p.1)).unwrap_or(""));
                behind
            }
            None => behind.trim_start_matches(|c: char| c.is_ascii_digit()),
        };
    }
    text + rest
}
