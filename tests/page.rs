//! The animated page: what it is made of, hostile names, and what it does in a browser.
//!
//! The browser is Chromium (`DOSMC_CHROMIUM`, or `chromium` where it is found), without a window; its
//! clock runs ahead, so nothing waits.

#![allow(clippy::disallowed_methods, reason = "runs the command and a browser")]

mod common;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::LazyLock;

use dosmc::back::svg::Options;
use dosmc::back::{Flight, html};
use dosmc::ir::Problem;
use dosmc::plan::Plan;
use proptest::prelude::*;
use roxmltree::Document;
use serde_json::Value;

use common::{planned, renamed};

const RELAY: &str = "examples/relay.dosm";

static RELAYED: LazyLock<(Problem, Plan)> = LazyLock::new(|| planned(RELAY));

/// Names that try to be something else.
const HOSTILE: [&str; 5] = [
    "</script><script>alert(1)</script>",
    "\"; alert(1); \"",
    "'--><![CDATA[ ]]> &amp; &#x202e;{{script}}",
    "\u{202e}desrever\u{2066}\u{200f}</template><img src=x onerror=alert(1)>",
    "\u{1b}[31m\0\u{fffe}\u{ffff}\n\t\u{7f}",
];

fn page(problem: &Problem, plan: &Plan) -> String {
    html::write(problem, plan, &Options::default()).contents
}

/// A part of a text that stands between two others, which occur once.
fn between<'a>(text: &'a str, from: &str, to: &str) -> &'a str {
    assert_eq!(text.matches(from).count(), 1, "{from}");
    let rest = text.split_once(from).expect("it is there").1;
    rest.split_once(to).expect("it ends").0
}

/// The page's parts: its frame as XML (script and styles left out), the data, the script.
fn parts(page: &str) -> (String, Value, String) {
    let data = between(page, "<script type=\"application/json\" id=\"plan\">", "</script>");
    let script = between(page, "<script>", "</script>");
    // The first styles are the page's own, the others those of pictures.
    let style = page.split_once("<style>").and_then(|(_, rest)| rest.split_once("</style>"));
    let style = style.expect("styles").0;
    let value = serde_json::from_str(data).expect("JSON");
    let frame = page.replace(data, "").replace(script, "").replace(style, "");
    (frame, value, script.to_string())
}

/// Each element with each of its attributes.
fn markup(frame: &str) -> BTreeSet<(String, String)> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    let document = Document::parse_with_options(frame, options).unwrap_or_else(|e| panic!("no XML: {e}"));
    let elements = document.descendants().filter(|n| n.is_element());
    let named = elements.flat_map(|element| {
        let name = element.tag_name().name().to_string();
        let attributes = element.attributes().map(|a| a.name().to_string()).chain([String::new()]);
        attributes.map(move |a| (name.clone(), a)).collect::<Vec<_>>()
    });
    named.collect()
}

/// Fails where a page is not as pages have to be, whatever the names in it.
fn assert_fine(page: &str) {
    let (frame, data, script) = parts(page);
    assert_eq!(script, include_str!("../src/back/html/page.js"), "no other script");
    assert!(data["robots"].as_array().is_some_and(|robots| !robots.is_empty()));
    for (element, attribute) in markup(&frame) {
        assert!(!attribute.starts_with("on") && !["href", "src", "style"].contains(&attribute.as_str()));
        assert!(
            !["a", "img", "iframe", "object", "link", "base", "use", "image"].contains(&element.as_str())
        );
    }
    let turns = |c| matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    assert!(!page.contains(|c: char| turns(c) || (c.is_control() && c != '\n')), "a character that hides");
    let addresses = page.matches("://").count();
    assert_eq!(addresses, page.matches("http://www.w3.org/2000/svg").count(), "nothing comes from a network");
    assert!(!page.contains("@import") && page.matches("url(").count() == page.matches("url(#").count());
}

#[test]
fn the_page_is_one_file_that_needs_nothing_else() {
    let (problem, plan) = &*RELAYED;
    let text = page(problem, plan);
    assert_fine(&text);
    assert_eq!(text, page(problem, plan), "the same bytes");
    let (frame, data, _) = parts(&text);
    let says = |part: &str| assert!(frame.contains(part), "{part}");
    says("<h1>relay</h1>");
    says("<code>eventually scout in shadow</code>");
    says("aria-label=\"scout in shadow: certainly at step 7\"");
    // The picture is there without the script.
    says("role=\"img\" viewBox");
    assert_eq!(data["length"], 7);
    assert_eq!(data["robots"][0]["states"][1], serde_json::json!(["vx", "m/s"]));
    assert_eq!(data["robots"][0]["points"].as_array().expect("points").len(), 8);
}

/// What the page says about links is what the plan relies on.
#[test]
fn the_next_hop_follows_links_of_the_plan_to_a_base() {
    let (problem, plan) = &*RELAYED;
    let (_, data, _) = parts(&page(problem, plan));
    let name = |node: &Value| {
        let node = node.as_u64().expect("a node") as usize;
        let robots = data["robots"].as_array().expect("robots");
        robots.get(node).unwrap_or_else(|| &data["bases"][node - robots.len()])["name"].clone()
    };
    let mut relayed = 0;
    for (step, links) in plan.links.as_ref().expect("links are asked").iter().enumerate() {
        for (robot, hop) in data["hops"][step].as_array().expect("hops").iter().enumerate() {
            let to = name(&hop[0]);
            let from = &plan.robots[robot].name;
            let linked = |a: &str, b: &Value| links.iter().any(|l| l.from == a && *b == l.to.as_str());
            let back = to.as_str().is_some_and(|to| linked(to, &Value::from(from.as_str())));
            assert!(linked(from, &to) || back, "step {step}: {from} has no link to {to}");
            relayed += u64::from(hop[1] != 1);
        }
    }
    assert!(relayed > 0, "somebody relays");
}

#[test]
fn hostile_names_are_only_text() {
    let (mut problem, plan) = renamed(&RELAYED, HOSTILE[0], &HOSTILE.map(String::from));
    problem.doc = HOSTILE.join("\n\n");
    let text = page(&problem, &plan);
    assert_fine(&text);
    let (frame, ..) = parts(&text);
    let (plain, ..) = parts(&page(&RELAYED.0, &RELAYED.1));
    let new: Vec<_> = markup(&frame).difference(&markup(&plain)).cloned().collect();
    assert!(new.is_empty(), "names have become markup: {new:?}");
}

#[test]
fn a_mission_in_space_has_a_page() {
    let (problem, plan) = planned("tests/missions/solve/space.dosm");
    let text = page(&problem, &plan);
    assert_fine(&text);
    let (_, data, _) = parts(&text);
    assert!(data["robots"][0]["feet"].as_array().is_some_and(|feet| feet.len() > 1));
}

/// Two runs of the relay: its nominal positions, a little beside.
fn runs() -> Vec<Flight> {
    let beside = |by: f64| {
        let along = |z: &Vec<f64>| vec![z[0] + by, z[2] - by];
        Flight { ways: RELAYED.1.robots.iter().map(|r| r.z.iter().map(along).collect()).collect() }
    };
    vec![beside(0.05), beside(-0.05)]
}

#[test]
fn simulated_runs_are_drawn_over_the_nominal_ways() {
    let (problem, plan) = &*RELAYED;
    let options = Options { runs: &runs(), ..Options::default() };
    let text = html::write(problem, plan, &options).contents;
    assert_fine(&text);
    let (frame, data, _) = parts(&text);
    assert!(data["runs"] == 2 && data["robots"][1]["runs"][1].as_array().expect("a run").len() == 8);
    // The picture and the stage, and a line in both legends.
    assert_eq!(frame.matches(">2 simulated runs</text>").count(), 2);
    let thin = frame.matches("stroke-width=\".7\"").count();
    assert_eq!(thin, 2 * (plan.robots.len() + 1));
}

/// Names put together from what means something in a page.
fn pieces() -> impl Strategy<Value = String> {
    let known =
        ["</script", "<script", ">", "<!--", "-->", "]]>", "&lt;", "\"", "'", "{{data}}", "a", "\u{2028}"];
    let pieces = prop::collection::vec(prop::sample::select(known.to_vec()), 1..6);
    pieces.prop_map(|pieces| pieces.concat())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(32) })]

    #[test]
    fn whatever_the_names_the_page_is_fine(
        mission in any::<String>(),
        names in prop::array::uniform5(prop_oneof![any::<String>(), pieces()]),
    ) {
        let (problem, plan) = renamed(&RELAYED, &mission, &names);
        assert_fine(&page(&problem, &plan));
    }
}

/// The browser, if there is one.
static CHROMIUM: LazyLock<Option<String>> = LazyLock::new(|| {
    let named = std::env::var("DOSMC_CHROMIUM").ok();
    let known = ["chromium", "chromium-browser", "google-chrome"].map(String::from);
    let answers = |program: &String| {
        Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok()
    };
    named.into_iter().chain(known).find(answers)
});

/// What a browser makes of a page: its document after a while, and what its console said.
fn browse(chromium: &str, file: &Path, fragment: &str) -> (String, Vec<String>) {
    let profile = tempfile::tempdir().expect("a directory");
    let output = Command::new(chromium)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--dump-dom"])
        .args(["--virtual-time-budget=4000", "--run-all-compositor-stages-before-draw"])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .arg(format!("file://{}{fragment}", file.display()))
        .output()
        .expect("the browser starts");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let console = said.lines().filter(|line| line.contains("CONSOLE")).map(str::to_string).collect();
    let document = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(document.contains("</html>"), "the browser shows nothing: {said}");
    (document, console)
}

/// Where the robots stand on the stage: the `transform` of each.
fn places(document: &str) -> Vec<String> {
    let layer = document.split("data-layer=\"robots\">").nth(1).expect("a stage").split("data-layer").next();
    let robots = layer.expect("its robots").split("transform=\"").skip(1);
    robots.filter_map(|rest| rest.split('"').next()).map(str::to_string).collect()
}

#[test]
fn in_a_browser_robots_move_and_nothing_goes_wrong() {
    let Some(chromium) = CHROMIUM.as_deref() else {
        return common::skipped("no Chromium: the page's script was not run");
    };
    let directory = tempfile::tempdir().expect("a directory");
    let show = |name: &str, text: &str, fragment: &str| {
        let file = directory.path().join(name);
        fs::write(&file, text).expect("it can be written");
        let (document, console) = browse(chromium, &file, fragment);
        assert!(console.is_empty(), "{name}{fragment}: {console:#?}");
        document
    };
    let options = Options { runs: &runs(), ..Options::default() };
    let text = html::write(&RELAYED.0, &RELAYED.1, &options).contents;
    let (_, data, _) = parts(&text);
    let at = |step: usize| -> Vec<String> {
        let place = |robot: &Value| {
            let [x, y] = [0, 1].map(|i| robot["points"][step][i].as_f64().expect("a number"));
            format!("translate({x:.2} {y:.2})")
        };
        data["robots"].as_array().expect("robots").iter().map(place).collect()
    };
    let still = show("relay.html", &text, "");
    assert_eq!(places(&still), at(0));
    // The picture has made room for the stage, and there are controls.
    assert!(!still.contains("class=\"title\"") && !still.contains("aria-label=\"Animation\" hidden"));
    let playing = show("relay.html", &text, "#play");
    assert_eq!(places(&playing).len(), 2);
    assert!(places(&playing).iter().zip(at(0)).all(|(now, before)| *now != before), "{:?}", places(&playing));
    let chosen = show("relay.html", &text, "#step=3&robot=scout");
    assert_eq!(places(&chosen), at(3));
    let hops = data["hops"][3][0][1].as_u64().expect("a number of links") as usize;
    assert_eq!(chosen.matches("<path class=\"p-hot\"").count(), hops, "the chain of the chosen robot");
    assert!(hops == 2 && chosen.contains("step 3 of 7, 1.5 s, before the loop"));
    let (mut problem, plan) = renamed(&RELAYED, HOSTILE[0], &HOSTILE.map(String::from));
    problem.doc = HOSTILE.join("\n\n");
    let hostile = show("hostile.html", &page(&problem, &plan), "#play");
    assert!(hostile.contains("<h1>&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt;</h1>"));
    assert_eq!(hostile.matches("<img").count(), 0);
    // Without scripts the picture is there, and no control that would do nothing.
    let inert = show("inert.html", &text.replace(include_str!("../src/back/html/page.js"), ""), "");
    assert!(inert.contains("class=\"title\"") && inert.contains("aria-label=\"Animation\" hidden"));
}
