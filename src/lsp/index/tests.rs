//! Short cases: a mission with a cursor, and what stands under it.

use super::*;
use crate::diag::Diagnostics;
use crate::source::SourceFile;
use crate::syntax::parse;

fn index(text: &str) -> Index {
    let file = parse(&SourceFile::new("test.dosm", text), &mut Diagnostics::new()).expect("something");
    Index::with_text(&file, text)
}

/// The text without its cursor `$`, and where that was.
fn cursor(text: &str) -> (String, u32) {
    let at = text.find('$').expect("a cursor");
    (text.replacen('$', "", 1), at as u32)
}

/// What the name at the cursor is, and what its declaration's text begins with.
#[track_caller]
fn means(text: &str, kind: SymbolKind, declared: &str) {
    let (text, offset) = cursor(text);
    let index = index(&text);
    let occurrence = index.at(offset).unwrap_or_else(|| panic!("nothing at the cursor: {index:#?}"));
    let symbol = index.symbol(occurrence.symbol);
    let there = &text[symbol.place.start as usize..];
    assert_eq!(symbol.kind, kind);
    assert!(there.starts_with(declared), "it is declared at `{}`", &there[..there.len().min(40)]);
}

#[track_caller]
fn is_builtin(text: &str, builtin: Builtin) {
    let (text, offset) = cursor(text);
    let index = index(&text);
    assert_eq!(index.builtin_at(offset).map(|b| b.1), Some(builtin));
    assert_eq!(index.at(offset), None);
}

#[track_caller]
fn is_unresolved(text: &str) {
    let (text, offset) = cursor(text);
    let index = index(&text);
    assert_eq!(index.at(offset), None);
    assert!(index.unresolved().iter().any(|s| s.start <= offset && offset <= s.end));
}

/// How often each symbol of a name occurs, in the order of the symbols.
fn counts(index: &Index, name: &str) -> Vec<usize> {
    let of_name = index.symbols().filter(|(_, s)| s.name == name);
    of_name.map(|(id, _)| index.occurrences_of(id).count()).collect()
}

const ROVER: &str = "dynamics Rover { step 1 s state px: m, vx: m/s input ax: m/s^2 position px
    A = [1, 1; 0, 1] B = [0; 1] bound ax in [-1, 1] disturbance px in [0, 1] bound where { vx + ax <= k } }";

#[test]
fn names_may_be_used_before_their_declarations() {
    means("dosm 1 separation $eps let eps = 1", SymbolKind::Constant, "eps = 1");
    means("dosm 1 robot r: $Car at (1, 2) dynamics Car { step 1 }", SymbolKind::Dynamics, "Car { step");
    means("dosm 1 goal g: r in a and $busy define busy = r in a", SymbolKind::Define, "busy = r");
    means("dosm 1 team t = r$ robot r: Car at (1, 2)", SymbolKind::Robot, "r: Car");
    means("dosm 1 horizon 1..2 * n$ + 1 param n = 3", SymbolKind::Parameter, "n = 3");
    means("dosm 1 connectivity { hops <= $n } param n = 3", SymbolKind::Parameter, "n = 3");
}

#[test]
fn a_member_is_an_occurrence_of_its_family() {
    let text = "dosm 1 param n = 2 robot f[i in 1..n]: Car at (i, i) goal g: f[n] in a goal h: $f[1] in a";
    means(text, SymbolKind::Robot, "f[i in");
    let index = index(&text.replace('$', ""));
    assert_eq!(counts(&index, "f"), [3]);
    assert_eq!(counts(&index, "n"), [3]);
    assert_eq!(counts(&index, "i"), [3]);
    assert_eq!(index.symbol(index.global("f").unwrap()).indices, ["i"]);
}

#[test]
fn an_index_hides_the_mission_s_names_in_its_family_only() {
    let text = "dosm 1 let i = 7 region a[i in 1..i] = box (i, i) .. (9, 9) region b = box (i, i) .. (9, 9)";
    let index = index(text);
    assert_eq!(counts(&index, "i"), [4, 3]);
    means(&text.replace("1..i]", "1..$i]"), SymbolKind::Constant, "i = 7");
    means(&text.replace("(9, 9) region", "($i, 9) region"), SymbolKind::IndexVariable, "i in 1");
    // The ranges don't see each other's indices.
    means(
        "dosm 1 let i = 7 region a[i in 1..2, j in 1..$i] = box (0, 0) .. (1, 1)",
        SymbolKind::Constant,
        "i = 7",
    );
    // Nor does a robot's model see an index.
    means(
        "dosm 1 robot f[Car in 1..2]: $Car at (1, 1) dynamics Car { step 1 }",
        SymbolKind::Dynamics,
        "Car { step",
    );
}

#[test]
fn quantifiers_bind_inside_out() {
    let text = "dosm 1 robot r: Car at (1, 1) region a = box (0, 0) .. (1, 1)
        goal g: forall r in r: (exists r in r: r in a) and r in a";
    let index = index(text);
    // The robot and its use in the outer set; the outer one with the inner set and the last atom; the inner.
    assert_eq!(counts(&index, "r"), [2, 3, 2]);
    means("dosm 1 goal g: forall i in 1..2: r[$i] in a", SymbolKind::IndexVariable, "i in 1");
    means(
        "dosm 1 goal g: forall r in all: always[0, k$] $r in a let k = 2".replacen("k$", "k", 1).as_str(),
        SymbolKind::RobotVariable,
        "r in all",
    );
    is_unresolved("dosm 1 goal g: (forall r in all: r in a) and $r in a");
}

#[test]
fn a_count_binds_its_robot_but_not_its_region() {
    let text = "dosm 1 region r = box (0, 0) .. (1, 1) goal g: count(r in all: r in r) = 1";
    let index = index(text);
    assert_eq!(counts(&index, "r"), [2, 2]);
    means(&text.replace("in r)", "in $r)"), SymbolKind::Region, "r = box");
    means(&text.replace(": r in r)", ": $r in r)"), SymbolKind::RobotVariable, "r in all");
}

#[test]
fn signals_belong_to_their_model() {
    let two =
        format!("dosm 1 let k = 1 {ROVER} dynamics Other {{ step 1 s integrator 2 bound $ax in [-1, 1] }}");
    means(&two, SymbolKind::Input, "integrator 2");
    let index = index(&two.replace('$', ""));
    assert_eq!(counts(&index, "px"), [3, 0]);
    assert_eq!(counts(&index, "k"), [2]);
    let rover = index.global("Rover").unwrap();
    let names: Vec<&str> = index.signals(rover).map(|id| index.symbol(id).name.as_str()).collect();
    assert_eq!(names, ["ax", "px", "vx"]);
    let at = "robot r: Rover at { $vx = 1, px = vx } let vx = 3";
    means(&format!("dosm 1 let k = 1 {ROVER} {at}"), SymbolKind::State, "vx: m/s");
    let at = "robot r: Rover at { vx = 1, px = $vx } let vx = 3";
    means(&format!("dosm 1 let k = 1 {ROVER} {at}"), SymbolKind::Constant, "vx = 3");
    // A state comes before a constant of the same name, and only where states are.
    let text = format!("dosm 1 let vx = 1 {ROVER}");
    means(&text.replace("{ vx +", "{ $vx +"), SymbolKind::State, "vx: m/s");
    is_unresolved(&format!("dosm 1 {ROVER}").replace("<= k", "<= $k"));
}

#[test]
fn the_signals_of_an_integrator_are_known() {
    let model =
        |bound: &str| format!("dosm 1 dynamics D {{ step 1 s integrator 2 bound {bound} in [-1, 1] }}");
    means(&model("$vy"), SymbolKind::State, "integrator 2");
    means(&model("$ay"), SymbolKind::Input, "integrator 2");
    is_unresolved(&model("$jy"));
    is_unresolved(&model("$ux"));
    let index = index(&model("vy"));
    let (_, vy) = index.symbols().find(|(_, s)| s.name == "vy").unwrap();
    assert!(!vy.is_renamable());
}

#[test]
fn coordinates_come_first_in_where_and_nowhere_else() {
    let text = "dosm 1 workspace box (0, 0) .. (9, 9) let x = 1 let z = 2
        region a[y in 1..2] = where { x + y <= z } or box (x, y) .. (9, 9)";
    is_builtin(&text.replace("{ x", "{ $x"), Builtin::Coordinate);
    is_builtin(&text.replace("+ y", "+ $y"), Builtin::Coordinate);
    means(&text.replace("<= z", "<= $z"), SymbolKind::Constant, "z = 2");
    means(&text.replace("(x, y)", "($x, y)"), SymbolKind::Constant, "x = 1");
    means(&text.replace("(x, y)", "(x, $y)"), SymbolKind::IndexVariable, "y in");
    let space = text.replace("(0, 0) .. (9, 9) let", "(0, 0, 0) .. (9, 9, 9) let");
    is_builtin(&space.replace("<= z", "<= $z"), Builtin::Coordinate);
    // An entry of a table is no coordinate.
    means("dosm 1 let x = [1, 2] region a = where { $x[1] <= x }", SymbolKind::Constant, "x = [1");
}

#[test]
fn the_language_s_own_names_are_not_the_mission_s() {
    is_builtin("dosm 1 let a = $pi", Builtin::Constant);
    is_builtin("dosm 1 let a = $sqrt(2)", Builtin::Function);
    is_builtin("dosm 1 team t = $all", Builtin::All);
    is_unresolved("dosm 1 let a = $sqr(2)");
    is_unresolved("dosm 1 let a = $b");
    means("dosm 1 region a[pi in 1..2] = box ($pi, 0) .. (9, 9)", SymbolKind::IndexVariable, "pi in");
}

#[test]
fn a_second_declaration_is_a_symbol_of_its_own() {
    let text = "dosm 1 region a = box (0, 0) .. (1, 1) region a = box (2, 2) .. (3, 3) goal g: r in a";
    let index = index(text);
    assert_eq!(counts(&index, "a"), [2, 1]);
    assert_eq!(index.symbol(index.global("a").unwrap()).place.start, 14);
    // With a model declared twice, each has the signals that stand in it.
    let text =
        "dosm 1 dynamics D { step 1 state a: m position a } dynamics D { step 1 state b: m position $b }";
    means(text, SymbolKind::State, "b: m position");
}

#[test]
fn modes_and_matrices_have_their_places() {
    let text = "dosm 1 dynamics D { step 1 state a: m input u: m B = [1] mode dry when { a >= 0 } { A = [k] } } let k = 1";
    means(&text.replace("dry", "$dry"), SymbolKind::Mode, "dry when");
    means(&text.replace("{ a >=", "{ $a >="), SymbolKind::State, "a: m");
    means(&text.replace("A =", "$A ="), SymbolKind::Matrix, "A = ");
    means(&text.replace("[k]", "[$k]"), SymbolKind::Constant, "k = 1");
    let index = index(text);
    let parents: Vec<&str> = index
        .symbols()
        .filter_map(|(_, s)| {
            Some(index.symbol(s.parent.filter(|_| s.kind == SymbolKind::Matrix)?).name.as_str())
        })
        .collect();
    assert_eq!(parents, ["D", "dry"]);
}

#[test]
fn what_can_t_be_read_is_guessed() {
    // The declaration of `a` is broken, and what uses it is not.
    let text = "dosm 1 region a = bx (0, 0) .. (n, 1) // n\nparam n = 1 goal g: r in $a and $b"
        .replacen(" and $b", "", 1);
    means(&text, SymbolKind::Region, "a = bx");
    let index = index(&text.replace('$', ""));
    assert_eq!(counts(&index, "n"), [2]);
    let guess = index.occurrences().iter().find(|o| o.role == Role::Guess).unwrap();
    assert_eq!(index.symbol(guess.symbol).name, "n");
    assert_eq!(index.symbol(index.global("a").unwrap()).item, None);
}

#[test]
fn the_cursor_touches_a_name_at_both_ends() {
    let index = index("dosm 1 let ab = 1 let c = ab");
    let name = |offset| index.at(offset).map(|o| index.symbol(o.symbol).name.as_str());
    assert_eq!([10, 11, 12, 13, 14].map(name), [None, Some("ab"), Some("ab"), Some("ab"), None]);
    assert_eq!([25, 26, 28, 29].map(name), [None, Some("ab"), Some("ab"), None]);
}

#[test]
fn documentation_and_places_are_kept() {
    let text = "dosm 1\n/// Where samples are.\nregion a = box (0, 0) .. (1, 1)\ndynamics D { step 1 s
        state\n /// East.\n px: m }";
    let index = index(text);
    let a = index.symbol(index.global("a").unwrap());
    assert_eq!(a.doc.as_deref(), Some("Where samples are."));
    assert_eq!(&text[a.declaration.range()], "region a = box (0, 0) .. (1, 1)");
    assert_eq!(a.item, Some(1));
    let (_, px) = index.symbols().find(|(_, s)| s.name == "px").unwrap();
    assert_eq!(px.doc.as_deref(), Some("East."));
    assert_eq!(&text[px.declaration.range()], "px: m");
}
