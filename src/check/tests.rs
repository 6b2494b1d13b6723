//! Short cases: a mission's text, and the diagnostics or values that it must give.

use super::*;
use crate::exact::Rational;
use crate::ir;
use crate::quantity::Dimension;
use crate::syntax::{parse, parse_expression};

fn run(text: &str, set: &[(&str, &str)]) -> (Result<typed::Mission, Reported>, Diagnostics) {
    let source = SourceFile::new("test.dosm", text);
    let set: Vec<(String, String)> = set.iter().map(|(n, e)| (n.to_string(), e.to_string())).collect();
    let mut diagnostics = Diagnostics::new();
    let mission =
        parse(&source, &mut diagnostics).and_then(|file| check(&file, &source, &set, &mut diagnostics));
    (mission, diagnostics)
}

/// The last parts of the codes that checking gives, errors and warnings, in the order of their places.
fn names(diagnostics: &Diagnostics) -> Vec<String> {
    let last = |code: &str| code.rsplit("::").next().unwrap_or("").to_string();
    diagnostics.sorted().iter().map(|d| last(d.code)).collect()
}

fn codes(text: &str) -> Vec<String> {
    names(&run(text, &[]).1)
}

fn problem(text: &str, set: &[(&str, &str)]) -> ir::Problem {
    let (mission, diagnostics) = run(text, set);
    let errors: Vec<_> = diagnostics.iter().collect();
    let problem = crate::lower::lower(&mission.unwrap_or_else(|_| panic!("{errors:#?}"))).0;
    assert_eq!(ir::validate(&problem), Ok(()));
    problem
}

/// A mission with one robot, to which `rest` adds declarations.
fn small(rest: &str) -> String {
    format!(
        "dosm 1
         workspace box (0, 0) .. (10, 10)
         region depot = box (6, 6) .. (9, 9)
         base mast at (1, 1)
         dynamics Rover {{ step 0.5 s  integrator 2  bound ax, ay in [-2, 2] m/s^2 }}
         robot R1: Rover at (2, 2)
         goal deliver: always eventually R1 in depot
         {rest}"
    )
}

/// The value and unit of an expression, or the code of what is wrong with it.
fn value(text: &str) -> Result<(Rational, String), String> {
    let expr = parse_expression(text).map_err(|d| d.code.to_string())?;
    let source = SourceFile::new("test", text);
    let mut diagnostics = Diagnostics::new();
    let file = ast::File {
        doc: None,
        items: Vec::new(),
        stray_docs: Vec::new(),
        broken: Vec::new(),
        span: expr.span,
    };
    let value = Checker::new(&file, &source, &mut diagnostics).evaluate(&expr, &Scope::default());
    match value {
        Ok(value) => Ok((value.number, value.dimension.to_string())),
        Err(_) => Err(names(&diagnostics).join(" ")),
    }
}

fn gives(text: &str, number: Rational, unit: &str) {
    assert_eq!(value(text), Ok((number, unit.to_string())), "{text}");
}

fn fails(text: &str, code: &str) {
    assert_eq!(value(text), Err(code.to_string()), "{text}");
}

#[test]
fn arithmetic_is_exact() {
    gives("0.1 + 0.2", Rational::ratio(3, 10), "1");
    gives("1 / 3 * 3", Rational::ONE, "1");
    gives("2 ^ 3 ^ 2", Rational::from(512), "1");
    gives("-2 ^ 2", Rational::from(-4), "1");
    gives("2 ^ -2", Rational::ratio(1, 4), "1");
    gives("8 - 4 - 2", Rational::from(2), "1");
    gives("mod(-7, 3) + abs(-2) + floor(2.7)", Rational::from(6), "1");
    gives("min(3, 1, 2) + max(1, 5)", Rational::from(6), "1");
    gives("1.01 ^ 64", Rational::ratio(101, 100).pow(64).unwrap(), "1");
}

#[test]
fn roots_and_sines_are_the_nearest_doubles() {
    let double = |x: f64| Rational::from_f64(x).unwrap();
    gives("sqrt(2)", double(std::f64::consts::SQRT_2), "1");
    gives("pi", double(std::f64::consts::PI), "1");
    gives("cos(pi)", double(-1.0), "1");
    gives("180 deg", double(std::f64::consts::PI), "rad");
    gives("8 ^ (1 / 3)", Rational::from(2), "1");
    gives("1.01 ^ 100", double(2.7048138294215263), "1");
}

#[test]
fn units_bind_tightest_and_scale() {
    gives("100 cm + 1 m", Rational::from(2), "m");
    gives("2 * 3 m", Rational::from(6), "m");
    gives("(1 + 2) km", Rational::from(3000), "m");
    gives("10 m / 4 s", Rational::ratio(5, 2), "m/s");
    gives("1 km/min", Rational::ratio(50, 3), "m/s");
    gives("(3 m)^2", Rational::from(9), "m^2");
    gives("sqrt(9 m * 1 m)", Rational::from(3), "m");
    gives("2 N / 1 kg", Rational::from(2), "m/s^2");
    gives("2 rad/s * 3 m", Rational::from(6), "m*rad/s");
    gives("mod(90 s, 1 min)", Rational::from(30), "s");
}

#[test]
fn dimensions_are_checked() {
    fails("1 m + 1", "wrong_dimension");
    fails("1 m + 1 s", "wrong_dimension");
    fails("min(1 m, 2)", "wrong_dimension");
    fails("sin(1 m)", "wrong_dimension");
    fails("2 ^ (1 m)", "wrong_dimension");
    fails("sqrt(2 m)", "wrong_dimension");
    fails("floor(2.5 m)", "wrong_dimension");
}

#[test]
fn absurd_numbers_are_refused_at_once() {
    fails("2^9^9", "number_out_of_range");
    fails("10^301", "number_out_of_range");
    fails("10^-301", "number_out_of_range");
    fails("((1.0000001^64)^64)^64", "number_out_of_range");
    fails("(((1 m)^64)^64)", "wrong_dimension");
    fails("1 / (2 - 2)", "division_by_zero");
    fails("0 ^ -1", "division_by_zero");
    fails("mod(1, 0)", "division_by_zero");
    fails("(-8) ^ (1 / 3)", "outside_domain");
    fails("sqrt(-1)", "outside_domain");
}

#[test]
fn the_references_mission_checks() {
    let problem = problem(include_str!("../../tests/missions/ok/relay.dosm"), &[]);
    assert_eq!((problem.robots.len(), problem.models.len(), problem.goals.len()), (3, 1, 2));
    assert_eq!(problem.separation, Some(Rational::ratio(1, 10)));
}

#[test]
fn integrators_are_the_matrices_that_they_stand_for() {
    let explicit = problem(
        &small("").replace(
            "integrator 2",
            "state px: m, vx: m/s, py: m, vy: m/s  input ax: m/s^2, ay: m/s^2  position px, py
             A = [1, 0.5, 0, 0; 0, 1, 0, 0; 0, 0, 1, 500 ms; 0, 0, 0, 1]
             B = [0.125 s^2, 0; 0.5, 0; 0, 0.125; 0, 0.5]",
        ),
        &[],
    );
    let continuous = problem(
        &small("").replace(
            "integrator 2",
            "continuous  state px: m, vx: m/s, py: m, vy: m/s  input ax: m/s^2, ay: m/s^2  position px, py
             A = [0, 1, 0, 0; 0, 0, 0, 0; 0, 0, 0, 1; 0, 0, 0, 0]
             B = [0, 0; 1, 0; 0, 0; 0, 1]",
        ),
        &[],
    );
    let chain = problem(&small(""), &[]);
    assert_eq!(explicit.models, chain.models);
    assert_eq!(continuous.models, chain.models);
}

#[test]
fn general_bounds_are_half_spaces_over_states_and_inputs() {
    let text = small("")
        .replace("integrator 2", "integrator 2  bound where { vx + vy <= 5 m/s; ax >= 2 * ay - 1 m/s^2 }");
    let problem = problem(&text, &[]);
    let model = problem.models.values().next().unwrap();
    let rows: Vec<Vec<i64>> = model
        .mixed_bounds
        .iter()
        .map(|h| h.normal.iter().chain([&h.offset]).map(|x| x.to_i64().unwrap()).collect())
        .collect();
    assert_eq!(rows, [[0, 1, 0, 1, 0, 0, 5], [0, 0, 0, 0, -1, 2, 1]]);
    assert_eq!(codes(&text.replace("vx + vy", "vx + ay")), ["wrong_dimension"]);
}

#[test]
fn families_are_written_out_in_order() {
    let text = small(
        "param n = 2
         let spots = [1, 5; 3, 5; 5, 5]
         robot fleet[i in 1..n, j in 0..1]: Rover at (spots[i + j, 1], spots[i, 2] + j)
         jammer J[i in 1..2] = ball (9, 2 * i) radius 50 cm
         goal all_there: forall i in 1..n: eventually fleet[i, 1] in depot",
    );
    let list = |p: &ir::Problem| p.robots.values().map(|r| r.name.clone()).collect::<Vec<_>>().join(" ");
    let two = problem(&text, &[]);
    assert_eq!(list(&two), "R1 fleet[1,0] fleet[1,1] fleet[2,0] fleet[2,1]");
    let last = two.robots.values().last().unwrap();
    let start: Vec<String> = last.start.iter().map(Rational::to_string).collect();
    assert_eq!(start, ["5", "0", "6", "0"]);
    assert_eq!(list(&problem(&text, &[("n", "3 - 2")])), "R1 fleet[1,0] fleet[1,1]");
    assert_eq!(list(&problem(&text, &[("n", "0")])), "R1");
    assert_eq!(names(&run(&text, &[("n", "3")]).1), ["index_out_of_table"]);
}

#[test]
fn assignments_from_the_command_line_are_checked() {
    let text =
        small("param speed = 2 m/s  let fixed = 3  jammer J = ball (9, 1) radius speed * 0.1 s * fixed");
    let width = |set: &[(&str, &str)]| {
        let problem = problem(&text, set);
        let ir::Piece::Polytope(jammer) = &problem.blockers.values().next().unwrap().shape.pieces[0] else {
            panic!("a ball of the ∞-norm is a box")
        };
        jammer.vertices[1][0].to_string()
    };
    assert_eq!(width(&[]), "9.6");
    assert_eq!(width(&[("speed", "1")]), "9.3");
    assert_eq!(width(&[("speed", "min(60, 70) m/min")]), "9.3");
    let wrong = |name: &str, text_of: &str| names(&run(&text, &[(name, text_of)]).1);
    assert_eq!(wrong("sped", "1"), ["unknown_param"]);
    assert_eq!(wrong("fixed", "1"), ["unknown_param"]);
    assert_eq!(wrong("speed", "1 s"), ["wrong_dimension"]);
    assert_eq!(wrong("speed", "fixed"), ["set_value"]);
    assert_eq!(wrong("speed", "1 +"), ["set_value"]);
}

#[test]
fn what_connectivity_asks_by_default_may_be_written_out() {
    let plain = problem(&small(""), &[]);
    assert_eq!(
        plain.connectivity,
        problem(&small("connectivity { redundancy 0 every 500 ms }"), &[]).connectivity
    );
    assert_eq!(
        plain.connectivity.map(|c| (c.hops, c.range, c.redundancy, c.every)),
        Some((None, None, 0, 1))
    );
    assert_eq!(problem(&small("connectivity none"), &[]).connectivity, None);
    assert_eq!(codes(&small("connectivity { every 0 }")), ["bad_every"]);
    assert_eq!(codes(&small("connectivity { hops <= 2 hops <= 3 }")), ["duplicate"]);
}

#[test]
fn sets_count_each_robot_once() {
    let text = small(
        "robot fleet[i in 1..2]: Rover at (3 + i, 2)
         team pair = fleet[2], R1, fleet[2]
         goal some: eventually count(r in pair, fleet, R1: r in depot) = 2
         goal most: eventually count(q in all: q in depot) - 2 * (R1 in depot) >= 1 - 1",
    );
    let problem = problem(&text, &[]);
    let comparisons: Vec<String> = problem
        .formulas
        .nodes()
        .values()
        .filter_map(|f| match f {
            ir::Formula::Compare(c) => Some(format!("{:?} {:?}", c.terms, (c.relation, c.bound))),
            _ => None,
        })
        .collect();
    let atom = |i: usize| format!("(Atom {{ robot: robot{i}, region: region0 }}, ");
    assert_eq!(comparisons[0], format!("[{}1), {}1), {}1)] (Equal, 2)", atom(0), atom(1), atom(2)));
    assert_eq!(comparisons[1], format!("[{}-1), {}1), {}1)] (AtLeast, 0)", atom(0), atom(1), atom(2)));
}

#[test]
fn windows_in_time_are_steps() {
    let windows = |text: &str| {
        let problem = problem(&small(&format!("goal w: {text}")), &[]);
        let find = |f: &ir::Formula| match f {
            ir::Formula::Until(w, ..) | ir::Formula::Release(w, ..) => *w,
            _ => None,
        };
        problem.formulas.nodes().values().find_map(find)
    };
    assert_eq!(windows("eventually[0, 10 s] R1 in depot"), Some((0, 20)));
    assert_eq!(windows("always[1 s, 1500 ms] R1 in depot"), Some((2, 3)));
    assert_eq!(windows("R1 in depot until[3, 7] not R1 in depot"), Some((3, 7)));
    let help = |text: &str| {
        let diagnostics = run(&small(&format!("goal w: {text}")), &[]).1;
        diagnostics.iter().next().and_then(|d| d.help.clone()).unwrap_or_default()
    };
    let nearest = help("eventually[0.6 s, 2.2 s] R1 in depot");
    assert_eq!(nearest, "the nearest ones that are: `[1 s, 2 s]` inside, `[0.5 s, 2.5 s]` around");
    assert_eq!(help("eventually[0.6 s, 0.7 s] R1 in depot"), "the nearest one that is: `[0.5 s, 1 s]`");
}

#[test]
fn only_models_in_use_are_lowered_and_only_they_share_a_step() {
    let other = "dynamics Boat { step 2 s  integrator 1  bound vx, vy in [-1, 1] m/s }";
    assert_eq!(codes(&small(other)), ["unused"]);
    assert_eq!(problem(&small(other), &[]).models.len(), 1);
}

#[test]
fn one_mistake_gives_one_message() {
    // Whatever refers to a broken declaration stays silent.
    assert_eq!(
        codes(&small("let a = nothing  let b = a + 1  jammer J = ball (b, a) radius b")),
        ["unknown_constant"]
    );
    assert_eq!(
        codes(&small("region spot = box (3, 3) .. (2, 4)  goal g: eventually R1 in spot")),
        ["box_corners_swapped"]
    );
    assert_eq!(codes(&small("define d = R9 in depot  goal g: d or d")), ["unknown_robot"]);
    assert_eq!(codes(&small("").replace("step 0.5 s", "step 0.5 m")), ["wrong_dimension"]);
    assert_eq!(codes(&small("goal g: forall i in 1..1000: eventually R1 in spot")), ["unknown_region"]);
    assert_eq!(
        codes(&small("").replace("box (0, 0) .. (10, 10)", "box (0, 0) .. (10, 10 s)")),
        ["wrong_dimension"]
    );
    assert_eq!(
        codes(&small("region spot = bx (3, 3) .. (2, 4)  goal g: eventually R1 in spot")),
        ["expected"]
    );
}

#[test]
fn as_many_errors_as_can_be_found_are_reported() {
    let text = small(
        "jammer J = ball (1 s, 4) radius 1
         region flat = box (1, 1) .. (1, 2)
         separation -1
         horizon 4..2
         goal g: R7 in depot and R1 in nowhere",
    );
    let mut found = codes(&text);
    found.sort();
    assert_eq!(
        found,
        ["bad_horizon", "flat_shape", "not_positive", "unknown_region", "unknown_robot", "wrong_dimension"]
    );
}

#[test]
fn a_bare_whole_number_takes_the_unit_of_its_place_and_an_angle_does_not() {
    assert!(codes(&small("separation 1")).is_empty());
    assert_eq!(codes(&small("separation 1 rad")), ["wrong_dimension"]);
    assert_eq!(codes(&small("separation 1 + 1 m")), ["wrong_dimension"]);
}

#[test]
fn goals_that_decide_themselves_are_seen() {
    let goal = |formula: &str| codes(&small(&format!("goal g: {formula}")));
    assert_eq!(goal("always false"), ["false_goal"]);
    assert_eq!(goal("R1 in depot and not R1 in depot"), ["false_goal"]);
    assert_eq!(goal("count(r in all: r in depot) = 2"), ["false_goal"]);
    assert_eq!(goal("eventually true"), ["trivial_goal"]);
    assert!(goal("R1 in depot or not R1 in depot").is_empty());
    // A robot that could not be read might be the second one.
    let unread = "robot R2 Rover at (3, 3) goal g: count(r in all: r in depot) = 2";
    assert_eq!(codes(&small(unread)), ["expected"]);
    assert!(goal("eventually R1 in depot and eventually not R1 in depot").is_empty());
}

#[test]
fn uncertain_balls_are_as_large_as_they_may_be() {
    let piece = |text: &str| {
        let problem = problem(&small(text), &[]);
        let ir::Piece::Polytope(jammer) = problem.blockers.values().next().unwrap().shape.pieces[0].clone()
        else {
            panic!("a polytope")
        };
        jammer
    };
    let cube = piece("jammer J = ball (5 +/- 0.5, 4) radius 1 +/- 0.25");
    let (lo, hi) = cube.bounding_box();
    let text = |v: &[Rational]| v.iter().map(Rational::to_string).collect::<Vec<_>>().join(" ");
    assert_eq!((text(&lo), text(&hi)), ("3.25 2.75".into(), "6.75 5.25".into()));
    let diamond = piece("jammer J = ball (5 +/- 0.5, 4) radius 1 norm 1");
    assert_eq!(diamond.vertices.len(), 6);
    assert!(diamond.contains(&[Rational::ratio(13, 2), Rational::from(4)]));
    assert!(!diamond.contains(&[Rational::ratio(13, 2), Rational::ratio(9, 2)]));
}

#[test]
fn discs_stay_round_and_space_has_three_axes() {
    let disc = problem(&small("jammer J = disc (5 +/- 0.5, 4) radius 1 +/- 0.25"), &[]);
    let ir::Piece::Ball { center, spread, radius } = &disc.blockers.values().next().unwrap().shape.pieces[0]
    else {
        panic!("a ball")
    };
    assert_eq!((&center[0], &spread[0], radius), (&5.into(), &Rational::ratio(1, 2), &Rational::ratio(5, 4)));
    let space = problem(include_str!("../../tests/missions/ok/space.dosm"), &[]);
    assert_eq!((space.dimension, space.regions.values().next().unwrap().shape.pieces.len()), (3, 1));
    let model = space.models.values().next().unwrap();
    assert_eq!((model.n(), model.m(), &model.position[..]), (6, 3, &[0, 2, 4][..]));
    let flat = "dosm 1 workspace box (0, 0, 0) .. (9, 9, 9) jammer J = disc (5, 5, 5) radius 1";
    assert!(codes(flat).contains(&"wrong_point".to_string()));
}

#[test]
fn long_chains_of_lets_and_defines_need_no_stack() {
    let mut text = small("let a0 = 1\n define d0 = R1 in depot\n");
    for i in 1..3000 {
        text += &format!("let a{i} = a{0} + 1\n define d{i} = next not d{0}\n", i - 1);
    }
    text += "goal g: eventually[0, a2999] d2999";
    assert_eq!(codes(&text), Vec::<String>::new());
}

#[test]
fn dimensions_of_a_point_behind_a_bracket_are_one_error() {
    assert_eq!(codes(&small("jammer J = ball (4, 7) s radius 1")), ["wrong_dimension"]);
    assert_eq!(Dimension::LENGTH.to_string(), "m");
}

#[test]
fn deep_formulas_and_expressions_fit_a_small_stack() {
    let formula = |text: String| codes(&small(&format!("goal g: {text}")));
    let not = "! ".repeat(1990);
    assert!(formula(format!("eventually ({not} R1 in depot)")).is_empty());
    let implied = "R1 in depot -> ".repeat(1990);
    assert!(formula(format!("eventually ({implied} R1 in depot)")).is_empty());
    let nested = format!("{}R1 in depot{}", "(next ".repeat(250), ")".repeat(250));
    assert!(formula(nested).is_empty());
    let quantified = "forall i in 1..1: ".repeat(1900);
    assert!(formula(format!("{quantified} eventually[0, 1] R1 in depot")).iter().all(|c| c == "hidden_name"));
    assert!(value(&format!("{}1", "-".repeat(1990))).is_ok());
    assert!(value(&format!("1{}", " + 1".repeat(1990))).is_ok());
    assert!(value(&format!("1{}", "^1".repeat(1990))).is_ok());
    assert!(value(&format!("{}1{}", "min(".repeat(250), ")".repeat(250))).is_ok());
}
