//! What the sentences of the language mean: each case is a text and one that must mean the same, or
//! the codes of what is wrong with it. (`tests/missions/err` shows the messages themselves.)

mod common;

use dosmc::diag::{Diagnostics, Severity};
use dosmc::driver::{self, Mission, Overrides};
use dosmc::source::SourceFile;

use common::{overrides, solve};

/// A mission to put declarations into: five robots, six regions.
const FRAME: &str = "dosm 1
workspace box (0, 0) .. (20, 10)
base home at (1, 1)
region west = box (0.5, 6) .. (4, 9.5)
region east = box (15, 6) .. (19.5, 9.5)
region S[i in 1..2, j in 1..2] = box (5 * i, 3 * j) .. (5 * i + 3, 3 * j + 2)
dynamics Rover { step 0.5 s integrator 2 bound ax, ay in [-4, 4] disturbance px, py in [-0.1, 0.1] }
robot a: Rover at (2, 2)
robot b: Rover at (4, 2)
robot f[i in 1..3]: Rover at (4 + 2 * i, 2)
";

fn load(text: &str, overrides: &Overrides) -> (Option<Mission>, Vec<String>) {
    let source = SourceFile::new("mission.dosm", text);
    let mut diagnostics = Diagnostics::new();
    let mission = driver::load(&source, overrides, &mut diagnostics).ok();
    let unused = |code: &str| code == "dosm::check::unused";
    let all = diagnostics.sorted().into_iter().filter(|d| !unused(d.code));
    let shown = |severity| if severity == Severity::Warning { "warning " } else { "" };
    (mission, all.map(|d| format!("{}{}", shown(d.severity), d.code.trim_start_matches("dosm::"))).collect())
}

/// What the goals of the frame with these declarations mean, in the IR's text.
#[track_caller]
fn goals(declarations: &str) -> String {
    let (mission, codes) = load(&format!("{FRAME}{declarations}"), &Overrides::default());
    let mission = mission.unwrap_or_else(|| panic!("{declarations}: {codes:?}"));
    let text = mission.problem.to_string();
    let from = text.find("\nhorizon").expect("a horizon");
    text[from..].to_string()
}

#[track_caller]
fn same(one: &str, other: &str) {
    assert_eq!(goals(&format!("goal g: {one}")), goals(&format!("goal g: {other}")), "{one}\n{other}");
}

#[track_caller]
fn different(one: &str, other: &str) {
    assert_ne!(goals(&format!("goal g: {one}")), goals(&format!("goal g: {other}")), "{one}\n{other}");
}

/// The codes for the frame with these declarations; warnings are marked, unused names left out.
fn codes(declarations: &str) -> Vec<String> {
    load(&format!("{FRAME}{declarations}"), &Overrides::default()).1
}

#[track_caller]
fn says(declarations: &str, expected: &[&str]) {
    assert_eq!(codes(declarations), expected, "{declarations}");
}

#[test]
fn quantifiers_are_conjunctions_and_disjunctions() {
    same("forall r in a, b: eventually r in west", "(eventually a in west) and (eventually b in west)");
    same("exists r in a, b: eventually r in west", "(eventually a in west) or (eventually b in west)");
    same(
        "forall i in 1..2: exists j in 1..2: F a in S[i, j]",
        "(F a in S[1, 1] or F a in S[1, 2]) and (F a in S[2, 1] or F a in S[2, 2])",
    );
    // An inner range may use an outer index.
    same(
        "forall i in 1..2: exists j in i..2: F f[j] in S[i, j]",
        "(F f[1] in S[1, 1] or F f[2] in S[1, 2]) and F f[2] in S[2, 2]",
    );
    same(
        "forall r in f[1], b: exists s in a, r: F (r in west and s in east)",
        "(F (f[1] in west and a in east) or F (f[1] in west and f[1] in east)) and (F (b in west and a in east) \
         or F (b in west and b in east))",
    );
    same("F forall i in 1..2: G[0, i] f[i] in west", "F (G[0, 1] f[1] in west and G[0, 2] f[2] in west)");
}

#[test]
fn quantifiers_reach_as_far_right_as_possible() {
    same(
        "forall r in a, b: r in west or F a in east",
        "(a in west or F a in east) and (b in west or F a in east)",
    );
    same(
        "a in east -> exists r in a, b: r in west -> F r in east",
        "a in east -> ((a in west -> F a in east) or (b in west -> F b in east))",
    );
}

#[test]
fn empty_sets_and_ranges() {
    let empty = "robot e[i in 1..0]: Rover at (1, 1)\n";
    let trivial = ["warning check::trivial_goal"];
    for always_true in
        ["forall r in e: r in west", "forall i in 2..1: e[i] in west", "count(r in e: r in west) = 0"]
    {
        says(&format!("{empty}goal g: {always_true}"), &trivial);
    }
    for never in
        ["exists r in e: r in west", "F exists i in 1..0: a in S[i, 1]", "count(r in e: r in west) > 0"]
    {
        says(&format!("{empty}goal g: {never}"), &["check::false_goal"]);
    }
    // A family may be empty, but not the team of all.
    let lone = FRAME.split("robot a").next().expect("a start");
    let (_, codes) = load(&format!("{lone}{empty}"), &Overrides::default());
    assert_eq!(codes, ["check::missing_robot"]);
}

#[test]
fn a_set_counts_each_robot_once() {
    same("F count(r in f[1], f, f[1], b: r in west) = 4", "F count(r in f, b: r in west) = 4");
    same("F count(r in all, a, f: r in west) = 5", "F count(r in a, b, f: r in west) = 5");
    says("goal g: F count(r in f[1], f[1]: r in west) = 2", &["check::false_goal"]);
}

#[test]
fn teams_hold_robots_members_families_and_teams() {
    let teams = "team crew = day, f[1]\nteam day = night, b\nteam night = a\nteam everybody = all\n";
    let with = |goal: &str| goals(&format!("{teams}goal g: {goal}"));
    assert_eq!(
        with("F count(r in crew: r in west) = 3"),
        goals("goal g: F count(r in a, b, f[1]: r in west) = 3")
    );
    assert_eq!(with("forall r in day: F r in west"), goals("goal g: forall r in a, b: F r in west"));
    assert_eq!(with("exists r in everybody: F r in west"), goals("goal g: exists r in all: F r in west"));
    says("team one = two\nteam two = three, a\nteam three = one", &["check::circle"]);
    says("team one = one", &["check::circle"]);
    // What a broken team is part of says nothing more.
    says(
        "team one = two\nteam two = one\nteam three = two, a\ngoal g: forall r in three: F r in west",
        &["check::circle"],
    );
}

#[test]
fn sums_stand_on_both_sides() {
    same(
        "F 2 * count(r in a, b: r in west) - (a in east) + 1 >= (b in east) - 2",
        "F 2 * (a in west) + 2 * (b in west) - (a in east) - (b in east) >= -3",
    );
    same(
        "F -3 * (a in west) + 1 < -count(r in f: r in west)",
        "F count(r in f: r in west) + 1 < 3 * (a in west)",
    );
    same("F 0 * (b in west) + (a in west) = 1", "F a in west");
    same("F (a in west) = 0", "F not a in west");
    same("F not count(r in f: r in west) <= 1", "F count(r in f: r in west) >= 2");
    same("F not count(r in f: r in west) = 1", "F count(r in f: r in west) != 1");
    same("F (a in west) - (a in west) + (b in west) >= 1", "F b in west");
    same(
        "forall i in 1..2: F i * (a in west) + (b in west) >= 2",
        "F (a in west) + (b in west) >= 2 and F 2 * (a in west) + (b in west) >= 2",
    );
    // Unknown atoms make this different from `a in west or b in west`: the same unknown twice.
    different("F (a in west) + (b in west) >= 1", "F (a in west or b in west)");
    says("goal g: F 1.5 * (a in west) > 1", &["check::not_whole"]);
    says("let k = 2 m\ngoal g: F k * (a in west) > 1", &["check::wrong_dimension"]);
}

#[test]
fn windows_in_time_are_windows_in_steps() {
    for operator in ["until", "release", "weak until", "strong release", "U", "R", "W", "M"] {
        same(
            &format!("a in west {operator}[1 s, 2500 ms] b in west"),
            &format!("a in west {operator}[2, 5] b in west"),
        );
        same(
            &format!("a in west {operator}[0, 1 min / 60] b in west"),
            &format!("a in west {operator}[0, 2] b in west"),
        );
        says(
            &format!("goal g: a in west {operator}[0 s, 1.2 s] b in west"),
            &["check::window_between_steps"],
        );
        says(&format!("goal g: a in west {operator}[1, 2 s] b in west"), &["check::mixed_window"]);
        says(&format!("goal g: a in west {operator}[2, 1] b in west"), &["check::bad_window"]);
    }
    for operator in ["always", "eventually", "G", "F", "[]", "<>"] {
        same(&format!("{operator}[0 s, 1 s] a in west"), &format!("{operator}[0, 2] a in west"));
        says(&format!("goal g: {operator}[0, 0.2 s] a in west"), &["check::window_between_steps"]);
    }
    says("goal g: next[1, 1] a in west", &["syntax::window_on_next"]);
}

#[test]
fn words_and_symbols_are_the_same_operator() {
    let pairs = [
        ("always eventually next a in west", "G F X a in west"),
        ("always eventually a in west", "[] <> a in west"),
        ("not a in west && b in west || a in east", "(! a in west and b in west) or a in east"),
        ("a in west weak until b in west", "a in west W b in west"),
        ("a in west strong release b in west", "a in west M b in west"),
        ("a in west until b in west", "a in west U b in west"),
        ("a in west release b in west", "a in west R b in west"),
    ];
    for (words, symbols) in pairs {
        same(words, symbols);
    }
}

#[test]
fn operators_bind_and_associate_as_the_table_says() {
    let [p, q, r, s] = ["a in west", "b in west", "a in east", "b in east"];
    same(&format!("{p} <-> {q} <-> {r}"), &format!("({p} <-> {q}) <-> {r}"));
    same(&format!("{p} -> {q} -> {r}"), &format!("{p} -> ({q} -> {r})"));
    same(&format!("{p} until {q} until {r}"), &format!("{p} until ({q} until {r})"));
    same(&format!("{p} or {q} and {r} until {s}"), &format!("{p} or ({q} and ({r} until {s}))"));
    same(&format!("not {p} until F {q} release {r}"), &format!("(not {p}) until ((F {q}) release {r})"));
    same(&format!("{p} -> {q} or {r} <-> {s}"), &format!("({p} -> ({q} or {r})) <-> {s}"));
    different(&format!("({p} until {q}) until {r}"), &format!("{p} until {q} until {r}"));
}

#[test]
fn laws_that_hold_for_two_values_only_are_not_used() {
    different("a in west or not a in west", "true");
    different("(a in west) = 1 or (a in west) = 0", "true");
}

#[test]
fn set_changes_how_many_robots_there_are() {
    let text = "dosm 1
workspace box (0, 0) .. (20, 10)
connectivity none
param n = 3
let P = [2, 2; 4, 2; 6, 2; 8, 2]
region S[i in 1..n] = box (2 * i, 5) .. (2 * i + 2, 9)
dynamics Rover { step 0.5 s integrator 2 bound ax, ay in [-4, 4] disturbance px, py in [-0.1, 0.1] }
robot g[i in 1..n]: Rover at (P[i, 1], P[i, 2])
goal go: forall i in 1..n: eventually g[i] in S[i]
goal all_at_once: eventually count(r in g: r in S[1]) >= 1
";
    let with = |value: &str| load(text, &overrides(&[("n", value)], None));
    for (value, robots) in [("1", 1), ("2", 2), ("2 + 2", 4), ("2^2", 4)] {
        let (mission, codes) = with(value);
        let mission = mission.unwrap_or_else(|| panic!("{value}: {codes:?}"));
        assert_eq!(
            (mission.problem.robots.len(), mission.problem.regions.len()),
            (robots, robots),
            "{value}"
        );
    }
    assert!(matches!(solve(&with("1").0.expect("a mission")), driver::Answer::Plan { .. }));
    let wrong = [
        ("5", vec!["check::index_out_of_table"]),
        ("10001", vec!["check::family_too_large", "check::family_too_large", "check::family_too_large"]),
        ("1.5", vec!["check::not_whole", "check::not_whole", "check::not_whole"]),
        ("3 m", vec!["check::wrong_dimension"]),
        ("m", vec!["check::set_value"]),
    ];
    for (value, expected) in wrong {
        let (_, mut codes) = with(value);
        codes.dedup();
        let mut expected: Vec<&str> = expected;
        expected.dedup();
        assert_eq!(codes, expected, "{value}");
    }
    // Without members there is no robot, and what names a member of it names nothing.
    assert!(with("0").1.contains(&"check::missing_robot".to_string()), "{:?}", with("0").1);
}

#[test]
fn families_have_members_by_one_index_or_several() {
    says("jammer J[i in 1..3, j in 1..2] = ball (5 + 4 * i, 3 + 3 * j) radius 0.2", &[]);
    says("base mast[i in 1..2] at (i, 9)\nobstacle o[i in 1..2] = box (9 * i, 4) .. (9 * i + 1, 5)", &[]);
    says("region Q[i in 0..0, j in -1..1] = box (6 + j, 5) .. (7 + j, 6)\ngoal g: F a in Q[0, -1]", &[]);
    says("goal g: F a in S[1]", &["check::wrong_index_count"]);
    says("goal g: F a in S", &["check::family_as_member"]);
    says("goal g: F a in S[1, 3]", &["check::no_such_member"]);
    says("goal g: F f in west", &["check::family_as_member"]);
    says("goal g: F f[4] in west", &["check::no_such_member"]);
    says("goal g: F a[1] in west", &["check::wrong_index_count"]);
    says("goal g: forall r in f: F r[1] in west", &["check::wrong_index_count"]);
    // Ranges of one family do not see each other.
    says("region Q[i in 1..2, j in 1..i] = box (i, 5) .. (i + j, 6)", &["check::unknown_constant"]);
}

#[test]
fn hidden_names_are_warned_of_and_mean_the_inner_one() {
    says("goal g: forall f in all: F f in west", &["warning check::hidden_name"]);
    assert_eq!(goals("goal g: forall f in all: F f in west"), goals("goal g: forall r in all: F r in west"));
    says("goal g: forall r in a: forall r in b: F r in west", &["warning check::hidden_name"]);
    assert_eq!(goals("goal g: forall r in a: forall r in b: F r in west"), goals("goal g: F b in west"));
    says("region Q[a in 1..2] = box (a, 5) .. (a + 1, 6)", &["warning check::hidden_name"]);
    // Coordinates come first, without a warning.
    says("let x = 3 m\nregion Q = where { x >= 1; x <= 2; y >= 4; y <= 9 }\ngoal g: F a in Q", &[]);
    says("goal g: forall pi in 1..2: F a in S[pi, 1]", &["check::predeclared"]);
}

#[test]
fn numbers_and_units() {
    let step = |expression: &str| {
        let text = FRAME.replace("step 0.5 s", &format!("step {expression}"));
        load(&text, &Overrides::default()).0.map(|m| m.problem.step.to_string())
    };
    for half in
        ["500 ms", "1 min / 120", "0.5", "(2^-1) s", "sqrt(0.25 s^2)", "max(0.2 s, 0.5 s)", "1 m / (2 m/s)"]
    {
        assert_eq!(step(half).as_deref(), Some("0.5"), "{half}");
    }
    assert_eq!(step("-2^2 * -0.125 s").as_deref(), Some("0.5"), "-2^2 is -4");
    assert_eq!(step("2^3^2 * (2^-10) s").as_deref(), Some("0.5"), "powers are right-associative");
    assert_eq!(step("0.5 m"), None);
    says("let k = 10^3 m", &["syntax::unit_in_exponent"]);
    says("let k = 1 m + 1", &["check::wrong_dimension"]);
    says("let k = [0 1]", &["syntax::missing_comma"]);
    says("let k = 1e301", &["syntax::number_range"]);
    says("let k = 1e300 * 10", &["check::number_out_of_range"]);
    says("let k = 2 m / s", &["check::unknown_constant"]);
    says("let k = [1 m, 2] m", &["syntax::unit_twice"]);
    says("region Q = where { x + y - 7 <= 2; x >= 0; y >= 0 }", &["check::wrong_dimension"]);
    says("region Q = where { x + y - 7 m <= 2; x >= 0; y >= 0 }", &[]);
}

#[test]
fn words_of_a_place_are_names_elsewhere() {
    let words = "step state input position A B c continuous integrator bound disturbance rejection mode when norm \
                 radius hops range redundancy every none effort length box ball disc polygon hull where x y z m s";
    for word in words.split_whitespace() {
        says(&format!("let {word} = 3"), &[]);
        says(&format!("region {word} = box (1, 6) .. (2, 7)\ngoal g: F a in {word}"), &[]);
    }
    let reserved = "dosm mission param let workspace region obstacle opaque jammer base dynamics robot team \
                    separation connectivity horizon minimize goal define in at or and not true false always \
                    eventually next until release weak strong count forall exists all X F G U R W M";
    for word in reserved.split_whitespace() {
        let found = codes(&format!("let {word} = 3"));
        assert_eq!(found.first().map(String::as_str), Some("syntax::reserved_word"), "{word}: {found:?}");
    }
    for name in "pi sqrt sin cos min max abs floor mod".split_whitespace() {
        says(&format!("let {name} = 3"), &["check::predeclared"]);
    }
}

/// A family means its members, declared one by one.
#[test]
fn a_family_is_its_members() {
    let head = "dosm 1
workspace box (0, 0) .. (20, 10)
dynamics Rover { step 0.5 s integrator 2 bound ax, ay in [-4, 4] disturbance px, py in [-0.1, 0.1] }
let P = [2, 2; 4, 3]
";
    let family = "base mast[i in 1..2] at (i, 9)
region S[i in 1..2, j in 0..1] = box (5 * i, 3 * j + 1) .. (5 * i + 3, 3 * j + 3) or disc (i, 8) radius 0.5
obstacle pillar[i in 1..2] = box (9 * i, 9) .. (9 * i + 1, 10)
opaque obstacle wall[k in -1..0] = box (14 + k, 0) .. (14.5 + k, 1)
jammer J[i in 1..2] = ball (16 + i, 5 +/- i / 10) radius 0.3 +/- i / 20
robot cart[i in 1..2]: Rover at { px = P[i, 1], py = P[i, 2], vx = i / 10 }
goal go: forall i in 1..2: forall j in 0..1: eventually cart[i] in S[i, j]
";
    let members = "base mast_1 at (1, 9)
base mast_2 at (2, 9)
region S_1_0 = box (5, 1) .. (8, 3) or disc (1, 8) radius 0.5
region S_1_1 = box (5, 4) .. (8, 6) or disc (1, 8) radius 0.5
region S_2_0 = box (10, 1) .. (13, 3) or disc (2, 8) radius 0.5
region S_2_1 = box (10, 4) .. (13, 6) or disc (2, 8) radius 0.5
obstacle pillar_1 = box (9, 9) .. (10, 10)
obstacle pillar_2 = box (18, 9) .. (19, 10)
opaque obstacle wall_m1 = box (13, 0) .. (13.5, 1)
opaque obstacle wall_0 = box (14, 0) .. (14.5, 1)
jammer J_1 = ball (17, 5 +/- 0.1) radius 0.3 +/- 0.05
jammer J_2 = ball (18, 5 +/- 0.2) radius 0.3 +/- 0.1
robot cart_1: Rover at { px = 2, py = 2, vx = 0.1 }
robot cart_2: Rover at { px = 4, py = 3, vx = 0.2 }
goal go: (eventually cart_1 in S_1_0 and eventually cart_1 in S_1_1) and (eventually cart_2 in S_2_0 and \
 eventually cart_2 in S_2_1)
";
    let text = |declarations: &str| {
        let (mission, codes) = load(&format!("{head}{declarations}"), &Overrides::default());
        mission.unwrap_or_else(|| panic!("{codes:?}")).problem.to_string()
    };
    let facts = |text: &str| -> String {
        let plain = text.replace("[-1]", "_m1").replace([',', '['], "_").replace(']', "");
        plain.lines().filter(|line| !line.starts_with(['f', 'g'])).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(facts(&text(family)), facts(&text(members)));
}
