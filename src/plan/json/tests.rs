//! Tests of the reader and the writer: there and back again, and what must be refused.

use std::collections::BTreeMap;

use proptest::prelude::*;

use super::{read, write};
use crate::plan::{Apart, Label, Link, Mission, Objective, Plan, RobotPlan, Separator, Tube};

fn separator(piece: usize) -> Separator {
    Separator { piece, normal: vec![0.1, -1e-300], offset: 1.0 / 3.0 }
}

/// A plan in which every optional part is present; `x` stands in several places.
fn sample(x: f64) -> Plan {
    let tube = Tube {
        dynamics: "Point".into(),
        center: vec![0.0, -0.0],
        half_width: vec![0.1, x],
        reserve: vec![1e-9, 5e-324],
        d: vec![vec![vec![1.0, 0.0], vec![0.0, 1.0]]],
        m: vec![vec![vec![-1.0, x]]],
    };
    let robot = |name: &str| RobotPlan {
        name: name.into(),
        dynamics: "Point".into(),
        z: vec![vec![x, 0.1 + 0.2], vec![1e22, 4.0]],
        v: vec![vec![x], vec![-x]],
        regions: BTreeMap::from([("pi[1,2]".into(), vec![Label::Out, Label::Unknown])]),
        outside: BTreeMap::from([("pi[1,2]".into(), vec![Some(vec![separator(0), separator(1)]), None])]),
        clear: BTreeMap::from([("J\"1\u{1b}".into(), vec![vec![separator(0)], vec![]])]),
    };
    Plan {
        tool: "dosmc 0.1.0".into(),
        mission: Mission {
            name: "m".into(),
            sha256: "00ff".into(),
            set: BTreeMap::from([("radius".into(), "1.5".into())]),
        },
        step_s: 0.5,
        length: 1,
        loop_start: 1,
        tubes: vec![tube],
        robots: vec![robot("fleet[1]"), robot("fleet[2]")],
        links: Some(vec![
            vec![Link {
                from: "fleet[1]".into(),
                to: "B1".into(),
                hops: 1,
                separators: vec![("J\"1\u{1b}".into(), separator(3))],
            }],
            vec![],
        ]),
        separation: vec![
            vec![Apart { pair: ("fleet[1]".into(), "fleet[2]".into()), axis: 1, sign: -1 }],
            vec![Apart { pair: ("fleet[1]".into(), "fleet[2]".into()), axis: 0, sign: 1 }],
        ],
        objective: Some(Objective { kind: "effort".into(), value: x, bound: 0.0, proved: false }),
    }
}

fn same_bits(a: &Plan, b: &Plan) -> bool {
    a == b
        && a.robots[0].z[0][0].to_bits() == b.robots[0].z[0][0].to_bits()
        && a.tubes[0].center[1].to_bits() == b.tubes[0].center[1].to_bits()
}

proptest! {
    #[test]
    fn any_double_comes_back_as_it_was(bits in any::<u64>()) {
        let x = f64::from_bits(bits);
        prop_assume!(x.is_finite());
        let plan = sample(x);
        let text = write(&plan);
        prop_assert!(same_bits(&plan, &read(&text).unwrap()));
        prop_assert_eq!(write(&read(&text).unwrap()), text);
    }

    #[test]
    fn damaged_texts_never_panic(at in any::<prop::sample::Index>(), byte in any::<u8>(), cut in any::<bool>()) {
        let mut text = write(&sample(0.7)).into_bytes();
        let at = at.index(text.len());
        text[at] = byte;
        if cut {
            text.truncate(at);
        }
        let _ = read(&String::from_utf8_lossy(&text));
    }
}

#[test]
fn another_reader_sees_the_keys_of_the_format() {
    let value: serde_json::Value = serde_json::from_str(&write(&sample(0.25))).unwrap();
    let keys = |v: &serde_json::Value| {
        let mut keys: Vec<String> = v.as_object().unwrap().keys().cloned().collect();
        keys.sort();
        keys.join(" ")
    };
    assert_eq!(
        keys(&value),
        "format length links loop_start mission objective robots separation step_s tool tubes version"
    );
    assert_eq!(keys(&value["mission"]), "name set sha256");
    assert_eq!(keys(&value["tubes"][0]), "D M disturbance dynamics reserve");
    assert_eq!(keys(&value["tubes"][0]["disturbance"]), "center half_width");
    assert_eq!(keys(&value["robots"][0]), "clear dynamics name outside regions v z");
    assert_eq!(keys(&value["robots"][0]["outside"]["pi[1,2]"][0][0]), "normal offset piece");
    assert_eq!(keys(&value["links"][0][0]), "from hops separators to");
    assert_eq!(keys(&value["links"][0][0]["separators"][0]), "blocker normal offset piece");
    assert_eq!(keys(&value["separation"][0][0]), "axis pair sign");
    assert_eq!(keys(&value["objective"]), "bound kind proved value");
    assert_eq!(value["format"], "dosm-plan");
    assert_eq!(value["version"], 1);
    assert_eq!(value["separation"][0][0]["sign"], -1);
    assert_eq!(value["robots"][0]["regions"]["pi[1,2]"], serde_json::json!(["out", "unknown"]));
}

#[test]
fn absent_parts_have_the_form_of_the_format() {
    let plan = Plan { links: None, separation: vec![], objective: None, ..sample(1.0) };
    let text = write(&plan);
    for line in ["\"links\": null", "\"separation\": []", "\"objective\": null"] {
        assert!(text.contains(line), "{line} in {text}");
    }
    assert!(text.starts_with("{\n  \"format\": \"dosm-plan\",\n  \"version\": 1,\n"));
    assert_eq!(read(&text).unwrap(), plan);
}

/// One replacement in the sample's text, and the path or message that the refusal must show.
#[track_caller]
fn refused(old: &str, new: &str, shows: &str) {
    let text = write(&sample(0.25));
    assert!(text.contains(old), "{old} is not in {text}");
    let error = read(&text.replacen(old, new, 1)).expect_err("must be refused").to_string();
    assert!(error.contains(shows), "{error:?} doesn't show {shows:?}");
}

#[test]
fn what_is_wrong_is_refused_with_its_place() {
    refused("\"dosm-plan\"", "\"dosm-plot\"", "$.format: ");
    refused("\"version\": 1", "\"version\": 2", "$.version: ");
    refused("\"version\": 1", "\"version\": 1.5", "$.version: ");
    refused("\"version\": 1,", "", "the key \"version\" is missing");
    refused("\"length\": 1", "\"length\": 2", "$.robots[0].z: expected 3 entries, found 2");
    refused("\"length\": 1", "\"length\": -1", "$.length: ");
    refused("\"length\": 1", "\"length\": 18446744073709551615", "$.robots[0].z: ");
    refused("\"length\": 1", "\"length\": 1e0", "$.length: ");
    refused("\"step_s\": 0.5", "\"step_s\": 1e999", "number out of range");
    refused("\"step_s\": 0.5", "\"step_s\": NaN", "line 6 column 13");
    refused("\"step_s\": 0.5", "\"step_s\": \"0.5\"", "$.step_s: expected a number, found a string");
    refused("\"step_s\": 0.5", "\"step_s\": 0.5, \"length\": 1", "$.length: the key occurs twice");
    refused("\"radius\": ", "\"radius\": \"1\", \"radius\": ", "$.mission.set.radius: the key occurs twice");
    refused("[1.0, 0.0], ", "", "$.tubes[0].D[0]: expected 2 entries, found 1");
    refused("\"D\": [", "\"D\": [[[1, 0], [0, 1]], ", "$.tubes[0].M: expected 2 entries, found 1");
    refused("\"M\": [", "\"M\": {}, \"N\": [", "$.tubes[0].M: gains for each mode");
    refused("[1e22, 4.0]", "[1e22, 4.0, 0]", "$.robots[0].z[1]: expected 2 entries, found 3");
    refused("[1e22, 4.0]", "[1e22, null]", "$.robots[0].z[1][1]: expected a number, found null");
    refused("\"unknown\"", "\"maybe\"", "$.robots[0].regions[\"pi[1,2]\"][1]: ");
    refused("\"sign\": -1", "\"sign\": 0", "$.separation[0][0].sign: ");
    refused("[\"fleet[1]\", ", "[", "$.separation[0][0].pair: expected 2 entries, found 1");
    refused("\"hops\": 1", "\"hops\": 1.5", "$.links[0][0].hops: ");
    refused("\"name\": \"fleet[2]\"", "\"name\": 2", "$.robots[1].name: expected a string");
    refused(
        "\"z\": ",
        "\"mode\": [\"dry\", \"wet\"], \"z\": ",
        "$.robots[0].mode: modes of switching models",
    );
    refused("\"proved\": false", "\"proved\": 0", "$.objective.proved: ");
    refused(
        "\"dynamics\": \"Point\",\n      \"z\"",
        "\"dynamics\": \"Car\",\n      \"z\"",
        "$.robots[0].dynamics: ",
    );
}

#[test]
fn what_is_no_plan_at_all_is_refused() {
    let deep = "[".repeat(100_000);
    for text in ["", "null", "[]", "{}", "{\"format\": \"dosm-plan\"}", "{} {}", &deep, "\u{feff}{}"] {
        assert!(read(text).is_err());
    }
    assert!(read(&(write(&sample(1.0)) + "]")).is_err());
}

#[test]
fn unknown_keys_and_other_ways_to_write_a_number_are_taken() {
    let plan = sample(0.25);
    let text = write(&plan);
    assert_eq!(
        read(&text.replacen("\"step_s\": 0.5", "\"note\": [{}], \"step_s\": 5.0e-1", 1)).unwrap(),
        plan
    );
    assert_eq!(read(&text.replace("[1.0,", "[1,")).unwrap(), plan);
    // Nearest doubles, not digit by digit: these are the classic hard cases.
    let step = |digits: &str| {
        read(&text.replacen("\"step_s\": 0.5", &format!("\"step_s\": {digits}"), 1)).unwrap().step_s
    };
    assert_eq!(step("9007199254740993"), 9007199254740992.0);
    assert_eq!(step("9007199254740993.00000000000000000001"), 9007199254740994.0);
    assert_eq!(step("18446744073709551617"), 18446744073709551616.0);
    assert_eq!(step("2.2250738585072011e-308"), f64::from_bits(0x000f_ffff_ffff_ffff));
    assert_eq!(step("-9223372036854775809"), -9223372036854775808.0);
}
