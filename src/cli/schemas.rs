//! The JSON Schemas of everything that is written or printed as JSON, in `docs/schemas`.
//!
//! They are made from the types and their comments; a test fails when a file differs, and
//! `INSTA_UPDATE=always cargo test --lib schemas` writes it anew. Only tests know `schemars`: who
//! builds the program does not build it.

use std::fs;
use std::path::{Path, PathBuf};

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use serde_json::Value;

use super::output::{JsonFailure, JsonGivenUp};
use super::{check, compile, completions, explain, fmt, new, render, simulate, solve, verify};
use crate::{back, json, plan};

/// Each schema's name and itself: a format or a command more is a line more.
fn all() -> Vec<(&'static str, Schema)> {
    vec![
        ("ir", of::<back::ir::Document>()),
        ("smc", of::<back::smc::Document>()),
        ("plan", of::<plan::json::schema::Document>()),
        ("check", of::<Stoppable<check::JsonCheck>>()),
        ("compile", of::<Stoppable<compile::JsonCompiled>>()),
        ("completions", of::<Printed<completions::JsonScript>>()),
        ("explain", of::<Printed<explain::JsonExplained>>()),
        ("fmt", of::<Printed<fmt::JsonFmt>>()),
        ("man", of::<Printed<completions::JsonMan>>()),
        ("new", of::<Printed<new::JsonNew>>()),
        ("render", of::<Stoppable<render::JsonRendered>>()),
        ("simulate", of::<Stoppable<simulate::JsonSimulated>>()),
        ("solve", of::<Printed<solve::JsonSolve>>()),
        ("verify", of::<Stoppable<verify::JsonVerify>>()),
    ]
}

/// What the command prints on standard output with `--json`.
#[derive(Serialize, JsonSchema)]
#[serde(untagged)]
#[allow(dead_code, reason = "only the schema is made of it")]
enum Printed<T> {
    /// When the command could do its work.
    Answer(T),
    /// When it could not: wrong usage, files that can't be read, missions with errors.
    Failure(JsonFailure),
}

/// What the command prints on standard output with `--json`, one that stops without an answer included.
#[derive(Serialize, JsonSchema)]
#[serde(untagged)]
#[allow(dead_code, reason = "only the schema is made of it")]
enum Stoppable<T> {
    /// When the command could do its work.
    Answer(T),
    /// When it could not: wrong usage, files that can't be read, missions with errors.
    Failure(JsonFailure),
    /// When it had to stop: time ran out, or somebody interrupted.
    GivenUp(JsonGivenUp),
}

fn of<T: JsonSchema>() -> Schema {
    // What is written is described, not what a lenient reader might take.
    let settings = SchemaSettings::draft2020_12().for_serialize();
    settings.into_generator().into_root_schema_for::<T>()
}

/// The schema's text, in the order in which people read it: what it is first, keys as they are written,
/// definitions last.
fn text(name: &str, schema: &Schema) -> String {
    let mut value = schema.clone().to_value();
    if value["anyOf"].is_array() {
        value["title"] = format!("dosmc {name} --json").into();
    }
    json::lay_out(&ordered(&value))
}

/// What comes first in a schema, and last; other keys come between, in the order of the alphabet.
const FIRST: [&str; 4] = ["$schema", "title", "description", "type"];
const LAST: [&str; 3] = ["properties", "required", "$defs"];

fn ordered(value: &Value) -> String {
    match value {
        Value::Object(schema) => {
            let rank = |key: &str| {
                let first = FIRST.iter().position(|k| *k == key);
                let last = || LAST.iter().position(|k| *k == key).map(|i| i + FIRST.len() + 1);
                first.or_else(last).unwrap_or(FIRST.len())
            };
            let mut keys: Vec<&String> = schema.keys().filter(|k| !is_rust_format(k, &schema[*k])).collect();
            keys.sort_by_key(|key| (rank(key), *key));
            let member = |key: &&String| match (key.as_str(), &schema[*key]) {
                ("properties", Value::Object(properties)) => {
                    format!("\"properties\":{}", by_requirement(properties, &schema.get("required")))
                }
                ("description", Value::String(text)) => {
                    format!("\"description\":{}", Value::from(text.replace('\n', " ")))
                }
                (key, value) => format!("{}:{}", Value::from(key), ordered(value)),
            };
            format!("{{{}}}", keys.iter().map(member).collect::<Vec<_>>().join(","))
        }
        Value::Array(items) => format!("[{}]", items.iter().map(ordered).collect::<Vec<_>>().join(",")),
        leaf => leaf.to_string(),
    }
}

/// Rust's own names of number formats, which say nothing to others.
fn is_rust_format(key: &str, value: &Value) -> bool {
    key == "format" && value.is_string()
}

/// Keys in the order in which they are written, which `required` has kept, then those that may be absent.
fn by_requirement(properties: &serde_json::Map<String, Value>, required: &Option<&Value>) -> String {
    let required = required.and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
    let place = |key: &String| required.iter().position(|k| k == key).unwrap_or(required.len());
    let mut keys: Vec<&String> = properties.keys().collect();
    keys.sort_by_key(|key| (place(key), *key));
    let member = |key: &&String| format!("{}:{}", Value::from(key.as_str()), ordered(&properties[*key]));
    format!("{{{}}}", keys.iter().map(member).collect::<Vec<_>>().join(","))
}

fn directory() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/schemas")
}

#[test]
fn the_files_are_those_of_the_types() {
    let update = std::env::var("INSTA_UPDATE").is_ok_and(|v| v == "always");
    let mut stale = Vec::new();
    for (name, schema) in all() {
        let (path, text) = (directory().join(format!("{name}.schema.json")), text(name, &schema));
        if fs::read_to_string(&path).ok().as_ref() == Some(&text) {
            continue;
        }
        if update {
            fs::write(&path, text).unwrap();
        } else {
            stale.push(path);
        }
    }
    assert!(
        stale.is_empty(),
        "run `INSTA_UPDATE=always cargo test --lib schemas`; these are stale: {stale:?}"
    );
    let files = fs::read_dir(directory()).unwrap().count();
    assert_eq!(files, all().len(), "a schema of nothing lies in docs/schemas");
}
