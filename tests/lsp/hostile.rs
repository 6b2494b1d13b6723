//! Every request at every place, edits at random against fresh texts, and messages that come too fast.

use std::time::{Duration, Instant};

use serde_json::{Value, json};

use dosmc::diag::Diagnostics;
use dosmc::driver::{self, Overrides};
use dosmc::source::{SourceFile, Span};

use crate::client::Client;

const URI: &str = "file:///tmp/hostile.dosm";
const FRESH: &str = "file:///tmp/fresh.dosm";
const FIRST: &str = include_str!("../../examples/first.dosm");
const EVERYTHING: &str = include_str!("../missions/ok/everything.dosm");

/// Nearly everything that the language has, on few lines, with characters of two and of no unit.
const SMALL: &str = "//! 😀 doc\r\ndosm 1\nmission m\nworkspace box (0, 0) .. (9 m, 9)\nparam k = 2 m/s /* é */ let T = [1, 2; 3, 4]
/// 𝔸 yard
region a[i in 1..2] = box (i, 1) .. (i + 1, 2) or where { x + y <= 2; x >= 0; y >= 0 }\njammer J = ball (5 ± 0.1, 5) radius 1 norm 2
base B at (1, 1)\ndynamics D { step 0.5 s; integrator 2 bound vx, vy in [-4, 4] m/s bound ax, ay in [-4, 4] m/s^2\r\n disturbance px in [-0.1, 0.1] }
robot r[n in 1..2]: D at { px = n, py = T[1, 2] }\nteam t = r[1]\nconnectivity { hops <= 3 range 6 m }\nhorizon 1..9
define d = r[1] in a[1]\ngoal g: always[0 s, 5 s] (forall q in all: q in a[2] until d) and count(q in t: q in a[1]) = 1\n";

/// A small generator of numbers: splitmix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit.max(1) as u64) as usize
    }

    fn pick<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }
}

/// A text as editors have it: lines of UTF-16 units, counted here without anything of the server's.
struct Mirror {
    units: Vec<u16>,
}

impl Mirror {
    fn new(text: &str) -> Mirror {
        Mirror { units: text.encode_utf16().collect() }
    }

    fn text(&self) -> String {
        String::from_utf16(&self.units).expect("no halves of characters")
    }

    /// The beginnings and the ends of the lines, line breaks not counted.
    fn lines(&self) -> Vec<(usize, usize)> {
        let (mut lines, mut start, mut at) = (Vec::new(), 0, 0);
        while at < self.units.len() {
            let length = match self.units[at..] {
                [13, 10, ..] => 2,
                [10 | 13, ..] => 1,
                _ => 0,
            };
            if length > 0 {
                lines.push((start, at));
                start = at + length;
            }
            at += length.max(1);
        }
        lines.push((start, self.units.len()));
        lines
    }

    /// The position of a unit; one between `\r` and `\n` is the line's end.
    fn position(&self, unit: usize) -> Value {
        let lines = self.lines();
        let line = lines.iter().rposition(|(start, _)| *start <= unit).expect("there is a line");
        let (start, end) = lines[line];
        json!({ "line": line, "character": unit.min(end) - start })
    }

    /// The unit of a byte offset.
    fn unit(&self, offset: u32) -> usize {
        self.text()[..offset as usize].encode_utf16().count()
    }

    /// A place where an edit may begin or end: not in a character, nor between `\r` and `\n`.
    fn place(&self, random: &mut Random) -> usize {
        self.aligned(random.below(self.units.len() + 1))
    }

    /// The next such place.
    fn aligned(&self, unit: usize) -> usize {
        let unit = unit.min(self.units.len());
        let before = unit.checked_sub(1).map(|before| self.units[before]);
        let is_inside =
            matches!((before, self.units.get(unit)), (Some(0xd800..0xdc00), Some(_)) | (Some(13), Some(10)));
        if is_inside { unit + 1 } else { unit }
    }

    fn replace(&mut self, from: usize, to: usize, text: &str) {
        self.units.splice(from..to, text.encode_utf16());
    }
}

/// What stands in a message's ranges has to lie in the text.
fn check_ranges(value: &Value, lines: &[(usize, usize)], units: &[u16], what: &dyn Fn() -> String) {
    if let (Some(line), Some(character)) = (value["line"].as_u64(), value["character"].as_u64()) {
        let Some((start, end)) = lines.get(line as usize) else { panic!("{}: line {line}: {value}", what()) };
        let unit = start + character as usize;
        assert!(unit <= *end, "{}: {value} is behind the line's end", what());
        let is_half = units.get(unit).is_some_and(|u| (0xdc00..0xe000).contains(u));
        assert!(!is_half, "{}: {value} is within a character", what());
    }
    if let (Some(start), Some(end)) = (value.get("start"), value.get("end")) {
        let order = |p: &Value| (p["line"].as_u64(), p["character"].as_u64());
        assert!(order(start) <= order(end), "{}: {value} is turned round", what());
    }
    match value {
        Value::Array(list) => list.iter().for_each(|v| check_ranges(v, lines, units, what)),
        Value::Object(fields) => fields.values().for_each(|v| check_ranges(v, lines, units, what)),
        _ => {}
    }
}

/// Every request about a place, with its parameters.
fn at(position: &Value) -> Vec<(&'static str, Value)> {
    let document = json!({ "uri": URI });
    let here = json!({ "textDocument": document, "position": position });
    let range = json!({ "start": position, "end": position });
    let with = |extra: Value| {
        let mut params = here.clone();
        for (key, value) in extra.as_object().expect("an object") {
            params[key] = value.clone();
        }
        params
    };
    vec![
        ("textDocument/completion", with(json!({ "context": { "triggerKind": 1 } }))),
        (
            "textDocument/completion",
            with(json!({ "context": { "triggerKind": 2, "triggerCharacter": " " } })),
        ),
        ("textDocument/hover", here.clone()),
        ("textDocument/signatureHelp", here.clone()),
        ("textDocument/definition", here.clone()),
        ("textDocument/typeDefinition", here.clone()),
        ("textDocument/references", with(json!({ "context": { "includeDeclaration": true } }))),
        ("textDocument/documentHighlight", here.clone()),
        ("textDocument/prepareRename", here.clone()),
        ("textDocument/rename", with(json!({ "newName": "other_name" }))),
        ("textDocument/selectionRange", json!({ "textDocument": document, "positions": [position] })),
        (
            "textDocument/codeAction",
            json!({ "textDocument": document, "range": range, "context": { "diagnostics": [] } }),
        ),
    ]
}

/// Every request about a whole text, with its parameters.
fn about(end: &Value) -> Vec<(&'static str, Value)> {
    let document = json!({ "uri": URI });
    let plain = json!({ "textDocument": document });
    let range = json!({ "start": { "line": 0, "character": 0 }, "end": end });
    let ranged = json!({ "textDocument": document, "range": range });
    let options = json!({ "tabSize": 2, "insertSpaces": true });
    let all = json!(["source.fixAll", "quickfix"]);
    vec![
        ("textDocument/documentSymbol", plain.clone()),
        ("textDocument/foldingRange", plain.clone()),
        ("textDocument/codeLens", plain.clone()),
        ("textDocument/semanticTokens/full", plain.clone()),
        ("textDocument/semanticTokens/range", ranged.clone()),
        ("textDocument/inlayHint", ranged.clone()),
        ("textDocument/formatting", json!({ "textDocument": document, "options": options })),
        (
            "textDocument/rangeFormatting",
            json!({ "textDocument": document, "range": range, "options": options }),
        ),
        (
            "textDocument/codeAction",
            json!({ "textDocument": document, "range": range, "context": { "diagnostics": [], "only": all } }),
        ),
        ("workspace/symbol", json!({ "query": "a" })),
    ]
}

/// Asks all of these; answers may refuse, but none may be of a bug, and their ranges lie in the text.
fn ask_all(client: &mut Client, requests: Vec<(&'static str, Value)>, mirror: &Mirror) {
    let lines = mirror.lines();
    let sent: Vec<(i64, &str, Value)> = requests
        .into_iter()
        .map(|(method, params)| (client.request(method, params.clone()), method, params))
        .collect();
    for (id, method, params) in sent {
        let answer = client.answer(id);
        let code = answer["error"]["code"].as_i64();
        assert!(code != Some(-32603), "{method} {params}: {answer}\n{}", mirror.text());
        check_ranges(&answer["result"], &lines, &mirror.units, &|| {
            format!("{method} {params}\n{}", mirror.text())
        });
    }
}

/// All requests at every `step`th place of a text.
fn ask_everywhere(client: &mut Client, text: &str, step: usize) {
    let mirror = Mirror::new(text);
    client.open(URI, text);
    let end = mirror.position(mirror.units.len());
    ask_all(client, about(&end), &mirror);
    for unit in (0..=mirror.units.len()).step_by(step) {
        ask_all(client, at(&mirror.position(unit)), &mirror);
    }
    client.tell("textDocument/didClose", json!({ "textDocument": { "uri": URI } }));
}

#[test]
fn every_request_is_answered_at_every_place() {
    let mut client = Client::begin();
    ask_everywhere(&mut client, SMALL, 1);
    ask_everywhere(&mut client, EVERYTHING, 11);
    ask_everywhere(&mut client, "", 1);
    ask_everywhere(&mut client, "\u{feff}dosm 1 goal", 1);
    client.end();
}

#[test]
fn every_request_is_answered_in_texts_that_are_cut_off_or_mangled() {
    let mut client = Client::begin();
    let mut random = Random(7);
    let places: Vec<usize> = SMALL.char_indices().map(|(at, _)| at).collect();
    for (count, &cut) in places.iter().enumerate().step_by(9) {
        ask_everywhere(&mut client, &SMALL[..cut], 61);
        let mut mangled: Vec<char> = SMALL.chars().collect();
        for _ in 0..1 + count % 9 {
            let (a, b) = (random.below(mangled.len()), random.below(mangled.len()));
            mangled.swap(a, b);
        }
        ask_everywhere(&mut client, &mangled.iter().collect::<String>(), 97);
    }
    client.end();
}

#[test]
fn places_outside_of_the_text_are_answered() {
    let mut client = Client::begin();
    client.open(URI, SMALL);
    let mirror = Mirror::new(SMALL);
    for (line, character) in [(0, 999), (999, 0), (u32::MAX, u32::MAX), (0, u32::MAX), (0, 5)] {
        ask_all(&mut client, at(&json!({ "line": line, "character": character })), &mirror);
    }
    ask_all(&mut client, about(&json!({ "line": u32::MAX, "character": u32::MAX })), &mirror);
    let nowhere = |(method, mut params): (&'static str, Value)| {
        params["textDocument"]["uri"] = json!("file:///nowhere.dosm");
        (method, params)
    };
    for (method, params) in at(&json!({ "line": 0, "character": 0 })).into_iter().map(nowhere) {
        assert_eq!(client.ask_wrongly(method, params), -32602, "{method}");
    }
    for (line, character) in [(-1, 0), (0, -1)] {
        for (method, params) in at(&json!({ "line": line, "character": character })) {
            assert_eq!(client.ask_wrongly(method, params), -32602, "{method}");
        }
    }
    client.end();
}

/// What a diagnostic says, wherever it was published.
fn said(diagnostics: &[Value]) -> Vec<String> {
    diagnostics.iter().map(|d| d.to_string().replace(FRESH, URI)).collect()
}

/// What the compiler says about a text: codes with the ranges of their first places, in the published order.
fn compiled(mirror: &Mirror) -> Vec<(String, Value, Value)> {
    let mut diagnostics = Diagnostics::new();
    let _ = driver::load(&SourceFile::new("m.dosm", mirror.text()), &Overrides::default(), &mut diagnostics);
    let place = |span: Span| [span.start, span.end].map(|offset| mirror.position(mirror.unit(offset)));
    diagnostics
        .sorted()
        .into_iter()
        .filter_map(|d| {
            let [start, end] = place(d.labels.first()?.span);
            Some((d.code.to_string(), start, end))
        })
        .collect()
}

const PIECES: [&str; 24] = [
    "a",
    " ",
    "\n",
    "\r\n",
    "\r",
    "😀",
    "é",
    "∧",
    "{",
    "}",
    "(",
    ")",
    "[",
    "/*",
    "*/",
    "//",
    "/// doc\n",
    "region ",
    "1",
    " m",
    "goal g: true\n",
    "dosm 1\n",
    "horizon 1..2\n",
    "let q = 1\n",
];

/// Some changes at random, made in the mirror as well.
fn edit(random: &mut Random, mirror: &mut Mirror) -> Value {
    let mut changes = Vec::new();
    for _ in 0..1 + random.below(3) {
        if random.below(40) == 0 {
            let text = format!("{}{}", *random.pick(&[SMALL, FIRST, ""]), *random.pick(&PIECES));
            *mirror = Mirror::new(&text);
            changes.push(json!({ "text": text }));
            continue;
        }
        let from = mirror.place(random);
        let length = *random.pick(&[0, 0, 0, 1, 2, 30]);
        let mut to = mirror.aligned(from + length);
        if random.below(30) == 0 {
            to = mirror.place(random).max(from);
        }
        let text: String = (0..random.below(4)).map(|_| *random.pick(&PIECES)).collect();
        let (start, end) = (mirror.position(from), mirror.position(to));
        changes.push(json!({ "range": { "start": start, "end": end }, "text": text }));
        mirror.replace(from, to, &text);
    }
    Value::from(changes)
}

#[test]
fn after_any_edits_a_text_is_as_if_it_were_fresh() {
    let mut client = Client::begin();
    let rounds = if std::env::var_os("DOSMC_SLOW").is_some() { 5_000 } else { 120 };
    for seed in 0..4 {
        let mut random = Random(seed);
        let mut mirror = Mirror::new(if random.below(2) == 0 { SMALL } else { FIRST });
        client.open(URI, &mirror.text());
        for round in 0..rounds / 4 {
            for _ in 0..random.below(4) {
                let changes = edit(&mut random, &mut mirror);
                client.change(URI, &changes);
            }
            let changes = edit(&mut random, &mut mirror);
            client.change(URI, &changes);
            let edited = client.diagnostics(URI);
            let text = mirror.text();
            client.open(FRESH, &text);
            let fresh = client.diagnostics(FRESH);
            client.tell("textDocument/didClose", json!({ "textDocument": { "uri": FRESH } }));
            assert_eq!(said(&edited), said(&fresh), "seed {seed}, round {round}: {text:?}");
            let short: Vec<(String, Value, Value)> = edited
                .iter()
                .map(|d| {
                    let code = d["code"].as_str().unwrap_or_default().to_string();
                    (code, d["range"]["start"].clone(), d["range"]["end"].clone())
                })
                .collect();
            assert_eq!(short, compiled(&mirror), "seed {seed}, round {round}: {text:?}");
        }
        client.tell("textDocument/didClose", json!({ "textDocument": { "uri": URI } }));
    }
    client.end();
}

#[test]
fn a_storm_of_changes_is_kept_up_with() {
    let mut client = Client::begin();
    client.open(URI, FIRST);
    let end = Mirror::new(FIRST);
    let mut place = end.position(end.units.len());
    for _ in 0..5_000 {
        let range = json!({ "start": place, "end": place });
        client.change(URI, &json!([{ "range": range, "text": "/" }]));
        place["character"] = json!(place["character"].as_u64().expect("a number") + 1);
    }
    let started = Instant::now();
    client.diagnostics(URI);
    assert!(started.elapsed() < Duration::from_secs(60), "{:?}", started.elapsed());
    client.end();
}

#[test]
fn cancelled_requests_and_ids_that_come_twice_are_answered_once() {
    let mut client = Client::begin();
    client.open(URI, &EVERYTHING.repeat(20));
    let position = json!({ "line": 3, "character": 3 });
    let mut ids = Vec::new();
    for (method, params) in at(&position).into_iter().cycle().take(200) {
        let id = client.request(method, params.clone());
        client.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        client.tell("$/cancelRequest", json!({ "id": id }));
        client.tell("$/cancelRequest", json!({ "id": "none" }));
        ids.push(id);
    }
    for id in ids {
        // The first, and the repetition: refused, or a request of its own where the first was done.
        for _ in 0..2 {
            let answer = client.answer(id);
            let code = answer["error"]["code"].as_i64();
            assert!(matches!(code, None | Some(-32800 | -32600 | -32602 | -32803)), "{answer}");
        }
    }
    let symbols = client.ask("workspace/symbol", json!({ "query": "" }));
    assert!(symbols.as_array().is_some_and(|list| !list.is_empty()), "it still answers");
    client.end();
}

/// A mission of so many bytes at least, most of them regions.
fn long(bytes: usize) -> String {
    let mut text = String::from(SMALL);
    let mut count = 0;
    while text.len() < bytes {
        count += 1;
        text.push_str(&format!("region yard_{count} = box (1.25, 2.5) .. (3.125 m, 4) // 😀 a place\n"));
    }
    text
}

#[test]
fn ten_megabytes_are_no_reason_to_stop_answering() {
    let mut client = Client::begin();
    // A debug build takes a minute for all of it.
    let is_slow = cfg!(debug_assertions) && std::env::var_os("DOSMC_SLOW").is_none();
    let megabytes = if is_slow { 1 } else { 10 };
    let text = long(megabytes << 20);
    let lines = text.matches('\n').count();
    client.open(URI, &text);
    client.open(FRESH, SMALL);
    let started = Instant::now();
    let hover = json!({ "textDocument": { "uri": FRESH }, "position": { "line": 7, "character": 8 } });
    client.ask("textDocument/hover", hover);
    let other = started.elapsed();
    let end = json!({ "line": lines, "character": 0 });
    let range = json!({ "start": end, "end": end });
    client.change(URI, &json!([{ "range": range, "text": "reg" }]));
    let started = Instant::now();
    client.diagnostics(URI);
    let published = started.elapsed();
    let place = json!({ "line": lines, "character": 3 });
    let started = Instant::now();
    let completion = json!({ "textDocument": { "uri": URI }, "position": place });
    let items = client.ask("textDocument/completion", completion);
    let completed = started.elapsed();
    assert!(items["items"].as_array().is_some_and(|list| !list.is_empty() && list.len() <= 1000));
    let memory = client.peak_memory().unwrap_or_default();
    println!(
        "{megabytes} MB: a hover elsewhere {other:?}, diagnostics {published:?}, completion {completed:?}"
    );
    println!("{} MB of memory", memory >> 20);
    assert!(memory < (megabytes as u64 * 300 + 200) << 20, "{memory}");
    assert!(other < Duration::from_secs(30), "{other:?}");
    client.end();
}
