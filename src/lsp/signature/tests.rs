//! Unfinished texts with their end as the cursor.

use super::*;
use crate::driver::Overrides;
use crate::lsp::Encoding;

fn document(text: &str) -> Document {
    let uri = "file:///m.dosm".parse().expect("it is a URI");
    Document::new(uri, 1, text.into(), Encoding::Utf16, Overrides::default())
}

/// The label with the active part in angle brackets.
fn shown_at_end(text: &str) -> Option<String> {
    let document = document(text);
    let help = help(&document, document.lines.position(text.len() as u32))?;
    let signature = &help.signatures[0];
    let parameters = signature.parameters.as_ref()?;
    let ParameterLabel::LabelOffsets([from, to]) = parameters[help.active_parameter? as usize].label else {
        return None;
    };
    let units: Vec<u16> = signature.label.encode_utf16().collect();
    let piece = |units: &[u16]| String::from_utf16_lossy(units);
    let (from, to) = (from as usize, to as usize);
    Some(format!("{}⟨{}⟩{}", piece(&units[..from]), piece(&units[from..to]), piece(&units[to..])))
}

#[track_caller]
fn check(text: &str, expected: &str) {
    assert_eq!(shown_at_end(text).as_deref(), Some(expected), "{text}");
}

#[track_caller]
fn silent(text: &str) {
    assert_eq!(shown_at_end(text), None, "{text}");
}

#[test]
fn shapes() {
    check("dosm 1 region a = box ", "box ⟨(x0, y0)⟩ .. (x1, y1)");
    check("dosm 1 region a = box (", "box ⟨(x0, y0)⟩ .. (x1, y1)");
    check("dosm 1 region a = box (1, 2) ", "box ⟨(x0, y0)⟩ .. (x1, y1)");
    check("dosm 1 region a = box (1, 2) .. ", "box (x0, y0) .. ⟨(x1, y1)⟩");
    check("dosm 1 region a = box (1, 2) .. (3 + (4", "box (x0, y0) .. ⟨(x1, y1)⟩");
    silent("dosm 1 region a = box (1, 2) .. (3, 4)");
    check("dosm 1 region a = box (1, 2) .. (3, 4) or ball ", "ball ⟨(x, y)⟩ radius r norm n");
    check("dosm 1 jammer J = ball (1, 2) radius ", "ball (x, y) radius ⟨r⟩ norm n");
    check("dosm 1 jammer J = ball (1, 2) radius 1 norm ", "ball (x, y) radius r norm ⟨n⟩");
    check("dosm 1 jammer J = disc (1, 2 +/- ", "disc ⟨(x, y)⟩ radius r");
    check("dosm 1 region a = polygon (1, 2), ", "polygon (x0, y0), ⟨(x1, y1)⟩, (x2, y2), …");
    check("dosm 1 region a = polygon (1, 2), (3, 4), (5, 6), (", "polygon (x0, y0), (x1, y1), ⟨(x2, y2), …⟩");
    check("dosm 1 region a = hull (1", "hull ⟨(x0, y0)⟩, (x1, y1), (x2, y2), …");
    check("dosm 1 region a = where { x <= 2; ", "where { ⟨x + 2 * y <= 3; …⟩ }");
    silent("dosm 1 region a = where { x <= 2 }");
    silent("dosm 1 region a = ball (1, 1) radius 2 or ");
    silent("dosm 1 region a = box");
    check(
        "dosm 1 workspace box (0, 0, 0) .. (1, 1, 1) region a = box (",
        "box ⟨(x0, y0, z0)⟩ .. (x1, y1, z1)",
    );
}

#[test]
fn functions() {
    check("dosm 1 let a = sqrt(", "sqrt(⟨x⟩)");
    check("dosm 1 let a = mod(1, ", "mod(a, ⟨b⟩)");
    check("dosm 1 let a = max(1, (2 + 3), 4, ", "max(a, ⟨b, …⟩)");
    check("dosm 1 region r = box (0, min(1, ", "min(a, ⟨b, …⟩)");
    check("dosm 1 region r = box (0, min(1, 2)", "box ⟨(x0, y0)⟩ .. (x1, y1)");
    check("dosm 1 let a = sqrt((1 + 2) * ", "sqrt(⟨x⟩)");
    silent("dosm 1 let a = sqrt(2)");
    silent("dosm 1 let a = P[1, ");
}

#[test]
fn items_of_a_model() {
    let model = |items: &str| format!("dosm 1 dynamics D {{ step 1 s {items}");
    check(&model("bound "), "bound ⟨NAME, …⟩ in [least, most] UNIT");
    check(&model("bound vx, "), "bound ⟨NAME, …⟩ in [least, most] UNIT");
    check(&model("bound vx, vy in "), "bound NAME, … in [⟨least⟩, most] UNIT");
    check(&model("bound vx, vy in [-1, "), "bound NAME, … in [least, ⟨most⟩] UNIT");
    check(&model("bound vx in [-1, 1] "), "bound NAME, … in [least, most] ⟨UNIT⟩");
    check(
        &model("bound vx in [-1, 1] m/s disturbance px in [0"),
        "disturbance NAME, … in [⟨least⟩, most] UNIT",
    );
    check(&model("bound where { vx "), "where { ⟨x + 2 * y <= 3; …⟩ }");
    silent(&model("bound vx in [-1, 1] m/s step "));
    silent(&model("bound vx in [-1, 1]\n  "));
}

#[test]
fn formulas() {
    check("dosm 1 goal g: count(", "count(⟨r⟩ in SET: r in REGION)");
    check("dosm 1 goal g: count(r in ", "count(r in ⟨SET⟩: r in REGION)");
    check("dosm 1 goal g: count(r in R1, R2, ", "count(r in ⟨SET⟩: r in REGION)");
    check("dosm 1 goal g: count(r in all: r in ", "count(r in SET: ⟨r in REGION⟩)");
    silent("dosm 1 goal g: count(r in all: r in a)");
    check("dosm 1 goal g: forall ", "forall ⟨r⟩ in SET: FORMULA");
    check("dosm 1 goal g: (exists r in ", "exists r in ⟨SET⟩: FORMULA");
    silent("dosm 1 goal g: forall r in all: ");
    check("dosm 1 goal g: always[", "[⟨m⟩, n]");
    check("dosm 1 goal g: R1 in a weak until[1 s, ", "[m, ⟨n⟩]");
    check("dosm 1 goal g: F[0, ", "[m, ⟨n⟩]");
    silent("dosm 1 goal g: F[0, 1]");
}

#[test]
fn declarations() {
    check("dosm 1 robot ", "robot ⟨NAME⟩: DYNAMICS at (x, y)");
    check("dosm 1 robot f[i in 1..3]: ", "robot NAME: ⟨DYNAMICS⟩ at (x, y)");
    check("dosm 1 robot f: D at (1, ", "robot NAME: DYNAMICS at ⟨(x, y)⟩");
    silent("dosm 1 robot f: D at (1, 2)");
    check("dosm 1 base b at (", "base NAME at ⟨(x, y)⟩");
    check("dosm 1 horizon 1..", "horizon A..⟨B⟩");
    silent("dosm 1 horizon 1..9\n");
}

#[test]
fn nothing_is_shown_where_nothing_is_asked() {
    silent("");
    silent("dosm 1 ");
    silent("box (");
    silent("dosm 1 region a = box (0, 0 // and (");
    silent("dosm 1 region a = /* box (");
    silent("dosm 1 let box = 1 let b = ");
    silent("dosm 1 region a = ball (1, 1) radius 2\n\n");
    check("dosm 1 region a = /* 😀 */ box (0,\n  0) // é\n  .. (", "box (x0, y0) .. ⟨(x1, y1)⟩");
}

#[test]
fn any_beginning_of_a_mission_is_survived() {
    let text = include_str!("../../../tests/missions/ok/everything.dosm");
    let document = document(text);
    let shown =
        (0..text.len()).filter(|&at| help(&document, document.lines.position(at as u32)).is_some()).count();
    assert!(shown > 500, "{shown} places of {}", text.len());
}
