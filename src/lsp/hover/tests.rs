//! Missions with a cursor, and what is said there.

use super::*;
use crate::diag::Diagnostics;
use crate::driver::Overrides;
use crate::lsp::Encoding;
use crate::tube::synthesize;

fn document(text: &str) -> Document {
    let uri = "file:///m.dosm".parse().expect("it is a URI");
    Document::new(uri, 1, text.to_string(), Encoding::Utf16, Overrides::default())
}

/// What is said at the cursor `$` of a text.
fn said(text: &str) -> Option<String> {
    let at = text.find('$').expect("a cursor") as u32;
    let document = document(&text.replacen('$', "", 1));
    let tubes = Tubes::default();
    let (_, said) = View { document: &document, tubes: &tubes }.at(at)?;
    Some(said)
}

/// Asserts that what is said at the cursor holds some pieces.
#[track_caller]
fn says(text: &str, pieces: &[&str]) {
    let said = said(text).unwrap_or_else(|| panic!("nothing is said"));
    for piece in pieces {
        assert!(said.contains(piece), "`{piece}` is missing in:\n{said}");
    }
}

#[track_caller]
fn silent(text: &str) {
    assert_eq!(said(text), None);
}

/// A mission to which `rest` adds declarations.
fn mission(rest: &str) -> String {
    format!(
        "dosm 1
workspace box (0, 0) .. (10, 10)
base mast at (1, 1)
/// Turns on the spot.
dynamics Rover {{
  step 0.5 s
  state px: m, vx: m/s, py: m, vy: m/s
  input ax: m/s^2, ay: m/s^2
  position px, py
  A = [1, 0.5, 0, 0; 0, 1, 0, 0; 0, 0, 1, 0.5; 0, 0, 0, 1]
  B = [0.125, 0; 0.5, 0; 0, 0.125; 0, 0.5]
  bound vx, vy in [-4, 4] m/s
  bound ax, ay in [-4, 4] m/s^2
  disturbance px, py in [-0.2, 0.2] m
  rejection 0.5
}}
robot R1: Rover at (2, 2)
{rest}"
    )
}

#[test]
fn constants_show_their_values() {
    says("dosm 1 param $n = 3", &["param n = 3", "**parameter**", "`= 3`", "--set n="]);
    says("dosm 1 let n = 3 let a = 2 * $n", &["let n = 3", "**constant** · a number · `= 3`"]);
    says("dosm 1 let $far = 2 m + 50 cm", &["a length (m)", "`= 2.5 m`", "= `250 cm`"]);
    says("dosm 1 let $t = [1, 2; 3, 4] m", &["a table of 2 × 2, in m", "1  2\n3  4"]);
    says("dosm 1 let $third = 1 / 3", &["· `≈ 0.333333`"]);
    says("dosm 1 let $bad = 1 m + 1", &["**constant** without a value"]);
    says("dosm 1\n/// So *far*.\nlet $far = 2 m", &["---\n\nSo *far*."]);
}

#[test]
fn a_model_shows_its_tube() {
    let tube = [
        "**dynamics model** of 1 robot, step 0.5 s",
        "share β = 0.5",
        "memory K = 2 steps",
        "Turns on the spot.",
    ];
    says(&mission("").replace("dynamics Rover", "dynamics $Rover"), &tube);
    let rows = ["px     m      –        [-0.2, 0.2]  ± 0.3", "vx     m/s    [-4, 4]  –            ± 0.4"];
    says(&mission("").replace("R1: Rover", "R1: $Rover"), &rows);
    // The same while everything around it is wrong.
    let wrong = mission(
        "region bad = box (1, 1) .. (1, 2) jammer lost = bal (1, 1) goal g: R9 in nowhere robot R2: Car at (1, 1)",
    );
    says(&wrong.replace("dynamics Rover", "dynamics $Rover"), &tube);
    says(&wrong.replace("dynamics Rover", "dynamics $Rover"), &rows);
    let signal = mission("").replace("bound vx", "bound $vx");
    says(&signal, &["**state** of `Rover`", "state  unit  bound    disturbance  tube\nvx     m/s   [-4, 4]"]);
    let signal = mission("").replace("bound ax", "bound $ax");
    says(&signal, &["**input** of `Rover`", "feedback\nax     m/s^2  [-4, 4]    ± 1.6"]);
}

#[test]
fn a_continuous_model_shows_what_it_becomes() {
    let text = mission("")
        .replace(
            "A = [1, 0.5, 0, 0; 0, 1, 0, 0; 0, 0, 1, 0.5; 0, 0, 0, 1]",
            "continuous
        A = [0, 1, 0, 0; 0, 0, 0, 0; 0, 0, 0, 1; 0, 0, 0, 0]",
        )
        .replace("B = [0.125, 0; 0.5, 0; 0, 0.125; 0, 0.5]", "B = [0, 0; 1, 0; 0, 0; 0, 1]");
    says(
        &text.replace("A =", "$A ="),
        &["**matrix** of `Rover`", "Held over a step of 0.5 s:", "1  0.5  0  0\n0  1"],
    );
    says(&text.replace("B =", "$B ="), &["0.125  0\n0.5"]);
    let discrete = said(&mission("").replace("A =", "$A =")).expect("something");
    assert!(!discrete.contains("Held"), "{discrete}");
}

#[test]
fn a_model_without_a_tube_says_why() {
    let weak = mission("").replace("disturbance px, py in [-0.2, 0.2]", "disturbance px, py in [-3, 3]");
    says(&weak.replace("dynamics Rover", "dynamics $Rover"), &["⚠ **No tube**: "]);
    let lost = mission("").replace("workspace box (0, 0) .. (10, 10)", "");
    says(&lost.replace("dynamics Rover", "dynamics $Rover"), &["No tube: the mission has no workspace."]);
    let wrong = mission("").replace("step 0.5 s", "");
    says(&wrong.replace("dynamics Rover", "dynamics $Rover"), &["that has errors"]);
}

#[test]
fn a_region_shows_what_the_tube_leaves() {
    let text = mission("region $depot = box (6, 6) .. (9, 9)");
    says(
        &text,
        &[
            "lies in (6, 6) .. (9, 9): 3 m × 3 m, area 9 m²",
            "± 0.3 m × ± 0.3 m, what is left for `in`: `depot`: 2.4 m × 2.4 m",
        ],
    );
    let text = mission("region $slot = box (6, 6) .. (9, 6.5)");
    says(&text, &["⚠ **Nothing is left** of `slot`", "wider than 0.6 m × 0.6 m"]);
    let text = mission("region $two[i in 1..2] = box (3 * i, 6) .. (3 * i + 1, 8)");
    says(
        &text,
        &["**region** family of 2 regions", "`two[2]` lies in (6, 6) .. (7, 8)", "`two[2]`: 0.4 m × 1.4 m"],
    );
    let text = mission("region $spot = disc (5, 5) radius 1");
    says(&text, &["area 3.142 m²", "radius 0.5757 m at least"]);
    // A part of the region beyond the workspace is of no use.
    let text = mission("region $edge = box (6, 6) .. (12, 9)");
    says(&text, &["`edge`: 3.4 m × 2.4 m"]);
}

#[test]
fn obstacles_grow_by_the_tube() {
    let text = mission("obstacle $rock = box (6, 6) .. (9, 9)");
    says(
        &text,
        &["**obstacle**", "With the tube of `Rover` around it, ± 0.3 m × ± 0.3 m: `rock`: 3.6 m × 3.6 m"],
    );
    says(&mission("jammer $J = ball (5, 5) radius 1"), &["**jammer**", "`J`: 2.6 m × 2.6 m"]);
    says(&mission("opaque obstacle $w = box (6, 6) .. (7, 9)"), &["**opaque obstacle**"]);
}

#[test]
fn robots_teams_and_bases_are_described() {
    says(
        &mission("robot $f[i in 1..2]: Rover at (i, 4)"),
        &["**robot** family of 2 robots", "`f[2]` starts at (2, 4)", "Model `Rover`: tube ± 0.3 m"],
    );
    says(&mission("robot $q: Rover at { px = 3, vx = 0.5 }"), &["starts at (3, 0), vx = 0.5 m/s"]);
    says(&mission("team $t = R1"), &["**team** of 1 robot: `R1`"]);
    says(
        &mission("team t = R1").replace("base mast", "base $mast"),
        &["**base station**", "`mast` at (1, 1)"],
    );
}

#[test]
fn a_member_is_described_alone() {
    let rest = "region a[i in 1..2, j in 1..2] = box (2 * i, 3 * j) .. (2 * i + 1, 3 * j + 1)
        robot f[i in 1..2]: Rover at (i, 1) goal g: f[1 + 1] in a[2, 1] goal h: forall k in 1..2: f[k] in a[k, 1]";
    let text = mission(rest);
    let only = said(&text.replace("in a[2, 1]", "in $a[2, 1]")).expect("something");
    assert!(only.contains("`a[2,1]` lies in (4, 3)") && !only.contains("`a[1,"), "{only}");
    let only = said(&text.replace("g: f[1 + 1]", "g: $f[1 + 1]")).expect("something");
    assert!(only.contains("`f[2]` starts at (2, 1)") && !only.contains("f[1]"), "{only}");
    says(&text.replace("in a[k, 1]", "in $a[k, 1]"), &["`a[1,1]`", "`a[2,2]`"]);
}

#[test]
fn goals_say_whom_they_concern() {
    let text = mission("region a = box (6, 6) .. (9, 9) goal $g: always eventually[1 s, 20 s] R1 in a");
    says(&text, &["speaks of `R1` in `a`", "Windows (a step is 0.5 s): `[1 s, 20 s]`: steps 2..40"]);
    says(&mission("goal $g: R9 in a"), &["**goal** that has errors"]);
    let text = mission("region a = box (6, 6) .. (9, 9) goal g: forall r in all: eventually $r in a");
    says(&text, &["r in all", "**robot variable**, used once"]);
    let text = mission("region a[i in 1..2] = box (6, 6) .. (9, 9) goal g: forall k in 1..2: R1 in a[$k]");
    says(&text, &["k in 1..2", "**index** from 1 to 2"]);
}

#[test]
fn words_units_and_numbers_are_explained() {
    says("dosm 1 $region a = box (0, 0) .. (1, 1)", &["region of interest"]);
    says(&mission("goal g: $always true"), &["At this step and all later ones"]);
    says(&mission("goal g: <$> true"), &["At this step or some later one"]);
    says("dosm 1 region a = where { $x <= 3 }", &["**coordinate** `x`", "inside `where`"]);
    says("dosm 1 separation 30 $cm", &["`cm`: Centimetre: 0.01 m."]);
    says("dosm 1 separation $30 cm", &["`30 cm` = `0.3 m`"]);
    says("dosm 1 let v = 3 $km/min^2", &["`km/min^2` = `≈ 0.277778 m/s^2`", "`min`: Minute: 60 s."]);
    says("dosm 1 workspace box ($4.5, 0) .. (9, 9)", &["`4.5` = `4.5 m`"]);
    says(
        &mission("").replace("$", "").replace("workspace", "$workspace"),
        &["**workspace** (0, 0) .. (10, 10): 10 m × 10 m"],
    );
    says(&mission("goal g: eventually[$1 s, 20 s] true"), &["`[1 s, 20 s]`: steps 2..40"]);
    says("dosm 1 let a = 2 $* (1 + 3)", &["2 * (1 + 3)", "`= 8`"]);
    says("dosm 1 let a = $sqrt(2)", &["square root"]);
}

#[test]
fn nothing_is_said_where_nothing_is_known() {
    silent("dosm 1 // a $comment region");
    silent("dosm 1 let a = 1 $ let b = 2");
    silent("dosm 1 let a = $step");
    silent("dosm 1 region a $= box (0, 0) .. (1, 1)");
    silent("$");
}

#[test]
fn long_declarations_are_cut() {
    let corners = "(1, 1),\n".repeat(20);
    says(&format!("dosm 1 region $a = hull {corners} (2, 2)"), &["(1, 1), …\n```"]);
    let wide = "1 + ".repeat(300);
    says(&format!("dosm 1 let $a = {wide} 1"), &["…\n```", "`= 301`"]);
}

#[test]
fn tubes_are_those_of_the_planner() {
    // Where a state has no bound, the rounding that a tube has room for grows with the robots' starts.
    let fast = mission("robot R3: Rover at { px = 1, py = 1, vx = 100000000 } goal g: true")
        .replace("bound vx, vy in [-4, 4] m/s", "")
        + " dynamics Slow { step 0.5 s integrator 2 bound ax, ay in [-1, 1] } robot S: Slow at (5, 5)";
    let (relay, drones) =
        (include_str!("../../../examples/relay.dosm"), include_str!("../../../examples/drones.dosm"));
    for text in [relay, drones, &fast] {
        let document = document(text);
        let (facts, tubes) = (document.facts().expect("facts"), Tubes::default());
        let (problem, spans) = document.front().meaning.as_ref().expect("a mission");
        let planned = synthesize(problem, spans, document.float(), &mut Diagnostics::new()).expect("tubes");
        for (id, model) in facts.dynamics().iter() {
            let ours = tubes.of(facts, id, document.float()).expect("a tube");
            let theirs = problem.models.iter().find(|(_, m)| m.name == model.name).expect("the model").0;
            assert_eq!(ours.tube.as_ref(), Ok(&planned[theirs]), "{}", model.name);
            let again = tubes.of(facts, id, document.float()).expect("a tube");
            assert!(std::sync::Arc::ptr_eq(&ours, &again), "it was kept");
        }
    }
}
