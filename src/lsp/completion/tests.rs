//! Cursors (`|`) in texts with what must be and what must not be offered there; and all words of the corpus.

#![allow(clippy::disallowed_methods, reason = "reads the corpus")]

use std::path::Path;

use lsp_types::{CompletionItem, CompletionResponse, CompletionTextEdit, InsertTextFormat, Position};

use super::complete;
use crate::diag::Diagnostics;
use crate::driver::Overrides;
use crate::lsp::document::Document;
use crate::lsp::lines::Encoding;
use crate::lsp::session::Client;
use crate::source::{SourceFile, Span};
use crate::syntax::words::{CLASSES, UNITS};

/// What stands around most cases.
const MISSION: &str = "dosm 1
mission m
workspace box (0, 0) .. (9, 9)
param speed = 2 m/s
let P = [1, 2; 3, 4]
/// Where samples are.
region pi1 = box (1, 1) .. (2, 2)
region cell[i in 1..3] = box (i, 1) .. (i + 1, 2)
jammer J1 = ball (5, 5) radius 1
base B1 at (1, 1)
dynamics Rover { step 0.5 s state px: m, vx: m/s input ax: m/s^2 position px }
dynamics Chain { step 0.5 s integrator 2 }
robot R1: Rover at (1, 1)
robot fleet[k in 1..4]: Chain at (k, 1)
team scouts = R1, fleet[1]
define busy = R1 in pi1
";

fn document(text: &str) -> Document {
    let uri = "file:///tmp/my-mission.dosm".parse().expect("it is a URI");
    Document::new(uri, 1, text.into(), Encoding::Utf16, Overrides::default())
}

fn capable() -> Client {
    Client { snippets: true, insert_replace: true, markdown_completion: true, ..Client::default() }
}

fn items(document: &Document, offset: usize, typed: Option<&str>, client: Client) -> Vec<CompletionItem> {
    let position = document.range(Span::new(offset, offset)).start;
    match complete(document, position, typed, client) {
        Some(CompletionResponse::List(list)) => list.items,
        _ => Vec::new(),
    }
}

/// The items at the cursor of a text behind the usual mission.
fn offered(text: &str, typed: Option<&str>) -> Vec<CompletionItem> {
    let text = format!("{MISSION}{text}");
    let at = text.find('|').expect("a cursor");
    items(&document(&text.replacen('|', "", 1)), at, typed, capable())
}

fn labels(items: &[CompletionItem]) -> Vec<&str> {
    items.iter().map(|item| item.label.as_str()).collect()
}

/// Behind the usual mission, these are offered, the first one first of all, and those are not.
#[track_caller]
fn check(text: &str, these: &[&str], not_those: &[&str]) {
    let items = offered(text, None);
    let labels = labels(&items);
    for label in these {
        assert!(labels.contains(label), "`{text}` lacks {label}: {labels:?}");
    }
    for label in not_those {
        assert!(!labels.contains(label), "`{text}` has {label}: {labels:?}");
    }
    assert_eq!(labels.first(), these.first(), "`{text}`: {labels:?}");
}

/// Exactly these are offered, in this order.
#[track_caller]
fn only(text: &str, these: &[&str]) {
    let items = offered(text, None);
    assert_eq!(labels(&items), these, "`{text}`");
}

#[test]
fn regions_and_only_these_come_behind_in() {
    for text in [
        "goal g: R1 in |",
        "goal g: R1 in pi|",
        "goal g: always eventually R1 in |",
        "goal g: (R1 in |",
        "goal g: (R1 in |)",
        "goal g: not R1 in |\ngoal h: R1 in pi1",
        "goal g: R1 in pi1 and fleet[1] in |",
        "goal g: forall r in all: r in |",
        "goal g: count(r in all: r in |",
        "goal g: count(r in all: r in |) = 1",
        "goal g: 2 * (R1 in |) >= 1",
        "goal g: rubbish ) R1 in pi1 and R1 in |",
        "define d = R1 in pi1 until[1, 2] R1 in |",
        "goal g: forall i in 1..3: fleet[i] in |",
    ] {
        only(text, &["pi1", "cell[i]"]);
    }
}

#[test]
fn robots_come_where_a_goal_wants_one() {
    check(
        "goal g: |",
        &["R1", "fleet[k]", "busy", "always", "count", "forall", "not", "true", "G"],
        &["pi1", "fleet", "all", "scouts", "and", "region", "Rover"],
    );
    check("goal g: R1 in pi1 and |", &["R1", "busy", "eventually"], &["and", "in", "pi1", "goal"]);
    check("goal g: not |", &["R1", "not"], &["in"]);
    check("goal g: forall r in all: |", &["r", "R1"], &["pi1"]);
    check("goal g: forall r in all: exists s in scouts: |", &["s", "r", "R1"], &[]);
    check("goal g: (forall r in all: r in pi1) and |", &["R1"], &["r"]);
    check("goal g: always[1, 5] |", &["R1"], &["s"]);
    check("goal g: count(r in R1: |", &["r", "R1", "fleet[k]"], &["busy", "always"]);
    check("goal g: R1 in pi1 -> |", &["R1", "busy"], &[]);
    check("goal g: R1 in pi1\n\ngoal h: |", &["R1"], &["goal"]);
}

#[test]
fn sets_take_teams_families_and_all() {
    for text in [
        "goal g: forall r in |",
        "goal g: count(r in |",
        "goal g: exists q in R1, |",
        "team t = |",
        "team t = R1, |",
    ] {
        check(text, &["R1", "fleet", "scouts", "fleet[k]", "all"], &["pi1", "busy"]);
    }
    only("goal g: forall i in 1 |", &[".."]);
    only("goal g: forall i in 1.|", &[".."]);
}

#[test]
fn what_follows_a_name_in_a_formula_depends_on_what_it_is() {
    only("goal g: R1 |", &["in"]);
    only("goal g: fleet[1] |", &["in"]);
    only("goal g: forall r in all: r |", &["in"]);
    only("goal g: count(r in all: r |", &["in"]);
    only("goal g: count(r |", &["in"]);
    check("goal g: busy |", &["and", "or", "until", "weak until", "goal", "U"], &["in"]);
    check("goal g: (busy |", &["and"], &["in", "goal"]);
    check(
        "goal g: R1 in pi1 |",
        &["and", "strong release", "region"],
        &["in", "dosm", "mission", "workspace"],
    );
    check("goal g: nobody |", &["in", "and"], &[]);
    only("goal g: busy weak |", &["until"]);
    only("goal g: busy strong |", &["release"]);
    check("goal g: R1 in pi1\n|", &["region", "goal", "and"], &["dosm", "in"]);
}

#[test]
fn models_come_behind_a_robot_s_colon() {
    only("robot A1: |", &["Rover", "Chain"]);
    only("robot A1:|", &["Rover", "Chain"]);
    only("robot A1[i in 1..3]: R|", &["Rover", "Chain"]);
    only("robot A1: Rover |", &["at"]);
    only("base B2 |", &["at"]);
    only("base B2[i in 1..2] a|", &["at"]);
}

#[test]
fn units_follow_numbers_the_fitting_ones_first() {
    check("separation 0.5 |", &["m", "cm", "mm", "km", "s", "region"], &["1"]);
    check("separation 0.5|", &["m", "cm"], &["region"]);
    check("separation 0.5 c|", &["m", "cm"], &[]);
    check("dynamics D { step 0.5 |", &["s", "ms", "min"], &[]);
    check("dynamics D { step 0.5 |\n integrator 2 }", &["s"], &["integrator"]);
    check("dynamics D { state vx: m/s bound vx in [-4, 4] |", &["m/s", "m"], &[]);
    check("dynamics D { bound vx in [-4, 4] | state vx: m/s }", &["m/s"], &[]);
    check("dynamics D { bound vx in [-4, 4 | state vx: m/s }", &["m/s"], &[]);
    check("dynamics D { integrator 2 bound ay in [-4, 4] |", &["m/s^2"], &[]);
    check("dynamics D { integrator 3 disturbance py in [-4, 4] |", &["m"], &[]);
    check("dynamics D { state px: |", &["m", "s", "rad", "m/s", "m/s^2", "1"], &["px"]);
    check("goal g: always[0 s, 5 |", &["s", "ms"], &["R1"]);
    check("jammer J = ball (4, 5) radius 1 |", &["m", "cm", "norm", "or"], &["radius"]);
    check("region a = box (0, 0) |", &["m", "cm", ".."], &["or"]);
    check("robot A1: Rover at (1, 2) |", &["m"], &[]);
    check("robot A1: Rover at { vx = 1 |", &["m"], &[]);
    check("connectivity { range 6 |", &["m", "norm", "hops"], &["range"]);
    check("connectivity { every 2 |", &["s"], &["every"]);
    check("param p = 3 |", &["m", "m/s", "kg"], &[]);
    check("horizon 1..40 |", &["mission"].map(|_| "region"), &["m", "s"]);
    check("connectivity { hops <= 3 |", &["range"], &["m", "hops"]);
    check("let a = 2 * (1 + 3) |", &["m"], &[]);
    check("let a = P[1, 2] |", &["region"], &["m"]);
}

#[test]
fn a_unit_of_several_signs_is_one_word() {
    let edit = |text: &str, label: &str| {
        let items = offered(text, None);
        let item = items.iter().find(|i| i.label == label).unwrap_or_else(|| panic!("{:?}", labels(&items)));
        match item.text_edit.clone() {
            Some(CompletionTextEdit::Edit(edit)) => {
                (edit.range.end.character - edit.range.start.character, edit.new_text)
            }
            Some(CompletionTextEdit::InsertAndReplace(edit)) => {
                (edit.insert.end.character - edit.insert.start.character, edit.new_text)
            }
            None => panic!("no edit"),
        }
    };
    assert_eq!(edit("param p = 2 m/|", "m/s"), (2, "m/s".into()));
    assert_eq!(edit("param p = 2 m/s|", "m/s^2"), (3, "m/s^2".into()));
    assert_eq!(edit("param p = 2 m/s^|", "m/s^2"), (4, "m/s^2".into()));
    assert_eq!(edit("param p = 2 m/|", "speed"), (0, "speed".into()));
    assert_eq!(edit("region a = box (0, 0) .|", ".."), (1, "..".into()));
}

#[test]
fn declarations_come_at_the_start_of_one() {
    check(
        "|",
        &["region", "goal", "let", "opaque", "horizon", "team"],
        &["dosm", "mission", "workspace", "box", "in"],
    );
    check("reg|", &["region"], &[]);
    check("\n\n  g|", &["region", "goal"], &["dosm"]);
    check("minimize effort\n|", &["region"], &["minimize"]);
    check("|\nseparation 1 m", &["region"], &["separation"]);
    check("|separation 1 m", &["region", "separation"], &[]);
    check("sep|aration 1 m", &["region", "separation"], &[]);
    only("opaque |", &["obstacle"]);
    check("region a b\n|", &["region"], &["box"]);
}

#[test]
fn an_empty_file_begins_with_the_edition_or_a_whole_mission() {
    let document = document("");
    let items = items(&document, 0, None, capable());
    assert_eq!(labels(&items), ["dosm mission", "dosm"]);
    let Some(CompletionTextEdit::Edit(edit)) = &items[0].text_edit else { panic!("no edit") };
    let mission = super::forms::filled(&edit.new_text);
    let mut diagnostics = Diagnostics::new();
    let source = SourceFile::new("new.dosm", mission);
    let loaded = crate::driver::load(&source, &Overrides::default(), &mut diagnostics);
    assert!(loaded.is_ok() && diagnostics.iter().next().is_none(), "{diagnostics:?}\n{}", source.text);
    only_in("//! What it is.\n|", &["dosm mission", "dosm"]);
    only_in("dosm |", &["1"]);
    only_in("dosm 1 mission |", &["my_mission"]);
}

/// Exactly these are offered in a text of its own.
#[track_caller]
fn only_in(text: &str, these: &[&str]) {
    let at = text.find('|').expect("a cursor");
    let items = items(&document(&text.replacen('|', "", 1)), at, None, capable());
    assert_eq!(labels(&items), these, "`{text}`");
}

#[test]
fn shapes_come_where_a_shape_does() {
    let shapes = ["box", "ball", "disc", "polygon", "hull", "where"];
    for text in [
        "region a = |",
        "region a =|",
        "region a[i in 1..2] = |",
        "obstacle o = b|",
        "opaque obstacle o = |",
        "jammer j = ball (1, 2) radius 1 or |",
        "region a = box (0, 0) .. (1, 1) or |",
        "region a rubbish = |",
    ] {
        only(text, &shapes);
    }
    only_in("dosm 1 workspace |", &shapes);
    let text = "dosm 1 workspace box (0, 0) .. (9, 9) |";
    let at = text.len() - 1;
    let items = items(&document(text.trim_end_matches('|')), at, None, capable());
    assert!(!labels(&items).contains(&"or"), "{:?}", labels(&items));
}

#[test]
fn the_words_inside_shapes_come_in_their_order() {
    check("region a = box (0, 0) |", &["m", ".."], &[]);
    only("region a = box (0, 0) m |", &[".."]);
    only("region a = ball (0, 0) m |", &["radius"]);
    only("region a = ball (0, 0) m r|", &["radius"]);
    only("region a = disc (0, 0) m |", &["radius"]);
    check("region a = disc (0, 0) radius 1 m |", &["or", "region"], &["norm"]);
    check("region a = ball (0, 0) radius 1 m |", &["norm", "or"], &[]);
    only("region a = ball (0, 0) radius 1 m norm |", &["1", "2"]);
    check("region a = ball (0, 0) radius 1 m norm 2 |", &["or", "region"], &["norm", "m"]);
    check("region a = ball (0 +/- 1 |", &["m"], &[]);
    check("region a = polygon (0, 0), (1, 1), (|", &["P"].map(|_| "speed"), &["x"]);
    check("region a = where { |", &["x", "y", "speed", "pi", "sqrt"], &["z", "px"]);
    check("region a = where { x + y <= 2; |", &["x"], &[]);
    check("region a = where { x + y <= |", &["x", "speed"], &["m"]);
    check("horizon 1 |", &[".."], &["m"]);
    check("horizon 1.|", &[".."], &["m"]);
}

#[test]
fn blocks_offer_their_items_but_those_that_are_there() {
    check("dynamics D { |", &["step", "state", "A", "integrator", "bound", "mode"], &["hops", "region"]);
    check("dynamics D { |}", &["step"], &[]);
    check("dynamics D { step 0.5 s\n |", &["state", "bound", "integrator"], &["step"]);
    check("dynamics D { |\n step 0.5 s }", &["state", "integrator"], &["step"]);
    check("dynamics D {\n |step 0.5 s }", &["step", "state", "integrator"], &[]);
    check(
        "dynamics D { step 1 s integrator 2\n |",
        &["bound", "disturbance", "rejection"],
        &["state", "input", "A", "integrator"],
    );
    check("dynamics D { state px: m\n |", &["step", "state"], &["integrator"]);
    check("dynamics D { bound px in [1, 2]\n |", &["step", "bound"], &[]);
    check("dynamics D { mode a when { px >= 1 } { |", &["A", "B", "c"], &["step", "bound"]);
    check("dynamics D { A = [1] mode a when { px >= 1 } { A = [1]\n | } B = [1] }", &["B", "c"], &["A"]);
    only("dynamics D { mode a |", &["when"]);
    check("connectivity { |", &["hops", "range", "redundancy", "every"], &["none", "step"]);
    check("connectivity { hops <= 3 |", &["range"], &["hops"]);
    check("connectivity { hops <= 3 | range 6 m }", &["redundancy"], &["hops", "range"]);
    only("connectivity |", &["none", "{"]);
    check("dynamics D { rubbish 7 * ; |", &["step"], &[]);
    check("dynamics D { step 0.5 s }\n|", &["region"], &["step"]);
}

#[test]
fn signals_come_where_the_model_s_are_meant() {
    let model = "dynamics D { state px: m, vx: m/s input ax: m/s^2";
    only(&format!("{model} position |"), &["px", "vx"]);
    only(&format!("{model} disturbance px, |"), &["px", "vx"]);
    check(&format!("{model} bound |"), &["where", "px", "vx", "ax"], &["x", "speed"]);
    only(&format!("{model} bound px |"), &["in"]);
    check(&format!("{model} bound where {{ |"), &["px", "vx", "ax", "speed"], &["x"]);
    only("dynamics D { bound px, | state px: m }", &["px"]);
    only("dynamics D { integrator 2 position |", &["px", "vx", "py", "vy"]);
    only("robot A1: Rover at { |", &["px", "vx"]);
    only("robot A1: Chain at { px = 1, |", &["px", "vx", "py", "vy"]);
    check("robot A1: Rover at { px = |", &["speed"], &["px"]);
    only("robot A1: Nothing at { |", &[]);
}

#[test]
fn expressions_take_constants_and_functions() {
    for text in [
        "separation |",
        "param p = 1 + |",
        "param p = (|",
        "param p = sqrt(|",
        "let t = [1, |",
        "horizon |",
        "horizon 1..|",
        "region a = box (|",
        "goal g: always[|",
        "goal g: always[1, |",
        "connectivity { hops <= |",
    ] {
        check(text, &["speed", "P", "pi", "sqrt", "min"], &["R1", "pi1", "x", "px", "region"]);
    }
    check("region a[n in 1..3] = box (|", &["n", "speed"], &[]);
    check("goal g: forall n in 1..3: fleet[|", &["n", "speed"], &["R1"]);
    check("param p = speed * |", &["speed"], &["m"]);
    only("minimize |", &["effort", "length"]);
}

#[test]
fn nothing_is_offered_in_comments_and_for_new_names() {
    for text in [
        "// |",
        "// region |",
        "/// |",
        "/* a |",
        "/* a | */",
        "/* /* */ |",
        "region |",
        "region a|",
        "goal |",
        "goal g|",
        "robot |",
        "dynamics |",
        "param |",
        "dynamics D { state |",
        "goal g: forall |",
        "goal g: count(|",
        "region a[|",
        "region a = 7 |",
        "separation 1.|",
    ] {
        only(text, &[]);
    }
    check("/* a */ |", &["region"], &[]);
    check("// a\n|", &["region"], &[]);
    check("goal g: /* who? */ |", &["R1"], &[]);
}

#[test]
fn what_comes_by_itself_is_only_what_has_to_come() {
    let by_itself = |text: &str, typed: &str| labels(&offered(text, Some(typed))).join(" ");
    assert_eq!(by_itself("goal g: R1 in |", " "), "pi1 cell[i]");
    assert_eq!(by_itself("robot A1: |", " "), "Rover Chain");
    assert_eq!(by_itself("goal g: R1 |", " "), "in");
    assert_eq!(by_itself("goal g: R1 in pi1 |", " "), "");
    assert_eq!(by_itself("horizon 1..40 |", " "), "");
    assert_eq!(by_itself("region |", " "), "");
    assert_eq!(by_itself("separation |", " "), "");
    assert_eq!(by_itself("separation 2 |", " "), "");
    assert_eq!(by_itself("region a = box (0, 0) .|", "."), "..");
    assert_eq!(by_itself("dynamics D {|", "{").split(' ').next(), Some("step"));
}

#[test]
fn items_say_what_they_are_and_what_they_insert() {
    let items = offered("goal g: R1 in |", None);
    assert_eq!(items[0].detail.as_deref(), Some("region: box (1, 1) .. (2, 2)"));
    assert!(
        matches!(&items[0].documentation, Some(lsp_types::Documentation::MarkupContent(m)) if m.value == "Where samples are.")
    );
    assert_eq!(items[1].insert_text_format, Some(InsertTextFormat::SNIPPET));
    let find = |items: &[CompletionItem], label: &str| {
        items.iter().find(|i| i.label == label).cloned().expect("it is there")
    };
    let text = |item: &CompletionItem| match item.text_edit.clone() {
        Some(CompletionTextEdit::Edit(edit)) => edit.new_text,
        Some(CompletionTextEdit::InsertAndReplace(edit)) => edit.new_text,
        None => panic!("no edit"),
    };
    assert_eq!(text(&find(&offered("|", None), "robot")), "robot ${1:R1}: ${2:Rover} at (${3:1}, ${4:1})");
    // Where something follows on the line, and for clients without snippets, only the word.
    assert_eq!(text(&find(&offered("|: Rover at (1, 1)", None), "robot")), "robot");
    let plain = items_of_all(Client::default());
    assert_eq!(text(&find(&plain, "robot")), "robot");
    assert!(plain.iter().all(|item| item.insert_text_format.is_none()));
    // The word is exchanged as far as the cursor, or all of it, as the client likes.
    let Some(CompletionTextEdit::InsertAndReplace(edit)) =
        find(&offered("goal g: R1 in pi|7 ", None), "pi1").text_edit
    else {
        panic!("the client can do both")
    };
    assert_eq!(
        (
            edit.insert.end.character - edit.insert.start.character,
            edit.replace.end.character - edit.insert.start.character
        ),
        (2, 3)
    );
}

#[test]
fn positions_are_counted_as_the_client_does() {
    let text = "dosm 1 /* 😀 */ region a = box (0, 0) .. (1, 1) goal g: R1 in a";
    let document = document(text);
    let line = Position::new(0, text.encode_utf16().count() as u32);
    let Some(CompletionResponse::List(list)) = complete(&document, line, None, capable()) else {
        panic!("nothing")
    };
    let Some(CompletionTextEdit::Edit(edit)) = &list.items[0].text_edit else { panic!("no edit") };
    assert_eq!((edit.range.start.character + 1, edit.range.end), (line.character, line));
}

/// The items behind the usual mission.
fn items_of_all(client: Client) -> Vec<CompletionItem> {
    items(&document(MISSION), MISSION.len(), None, client)
}

/// All missions of the repository.
fn corpus() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut open = vec![root.join("tests/missions"), root.join("examples")];
    let mut texts = Vec::new();
    while let Some(directory) = open.pop() {
        for entry in std::fs::read_dir(directory).expect("the directory can be read") {
            let path = entry.expect("the entry can be read").path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == "dosm") {
                let text = std::fs::read_to_string(&path).unwrap_or_default();
                texts.push((path.display().to_string(), text));
            }
        }
    }
    texts.sort();
    assert!(texts.len() > 100);
    texts
}

#[test]
fn every_word_of_the_corpus_is_offered_where_it_stands() {
    let words: Vec<&str> = CLASSES
        .iter()
        .take_while(|(class, _)| *class != "functions")
        .flat_map(|(_, w)| w.iter().copied())
        .collect();
    let (mut asked, mut missing) = (0, Vec::new());
    for (name, text) in corpus() {
        let whole = document(&text);
        // What is broken has no words where they belong; what is large takes long.
        if whole.front().diagnostics.has_errors() || text.len() > 8_000 || name.contains("/err/") {
            continue;
        }
        let names: Vec<(usize, usize)> = whole
            .index()
            .occurrences()
            .iter()
            .filter(|o| !o.is_declaration())
            .map(|o| (o.span.start as usize, o.span.end as usize))
            .collect();
        let tokens = crate::syntax::token::tokens(&text);
        for (count, token) in tokens.iter().filter(|t| !t.is_comment()).enumerate() {
            let is_name = names.contains(&(token.start, token.start + token.text.len()));
            let is_declared = whole
                .index()
                .at(token.start as u32)
                .is_some_and(|o| o.is_declaration() && o.span.start as usize == token.start);
            let is_word = words.contains(&token.text) && token.is(token.text) && !is_declared;
            let is_unit = token.kind == crate::syntax::token::Kind::Unit && !is_name && !is_declared;
            if !(is_name || is_word || is_unit) {
                continue;
            }
            asked += 1;
            let is_there = |document: &Document| {
                let items = items(document, token.start, None, capable());
                let unit = UNITS
                    .iter()
                    .find(|unit| is_unit && token.text.split(['*', '/', '^']).next() == Some(unit));
                items.iter().any(|item| {
                    let rest = item.label.strip_prefix(token.text);
                    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with([' ', '[']))
                        || unit.is_some_and(|unit| item.label == *unit)
                })
            };
            let line = text[..token.start].matches('\n').count() + 1;
            if !is_there(&whole) {
                missing.push(format!("{name}:{line}: {}", token.text));
            } else if count % 19 == 0 && !is_there(&document(&text[..token.start])) {
                // The texts that are cut off have to be read, so some are enough. What is declared further on is
                // not known there.
                let known = document(&text[..token.start]);
                let is_declared_before =
                    !is_name || known.index().symbols().any(|(_, s)| s.name == token.text);
                if is_declared_before {
                    missing.push(format!("{name}:{line}: {} (cut off)", token.text));
                }
            }
        }
    }
    assert!(asked > 5_000, "{asked}");
    missing.truncate(40);
    assert!(missing.is_empty(), "{missing:#?}");
}
