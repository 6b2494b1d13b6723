//! The checked-in JSON Schemas as tests use them.
#![allow(clippy::disallowed_methods, reason = "reads the schemas")]
#![allow(dead_code, reason = "each test uses what it needs of it")]

use std::fs;
use std::path::Path;

use serde_json::Value;

/// A schema of `docs/schemas` that takes no keys but those that it describes: users' readers must
/// ignore unknown keys, but what is written has none.
pub struct Closed(jsonschema::Validator);

impl Closed {
    /// The schema of a format or a command.
    pub fn of(name: &str) -> Closed {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("docs/schemas/{name}.schema.json"));
        let mut schema = serde_json::from_str(&fs::read_to_string(path).expect("a schema")).expect("JSON");
        close(&mut schema);
        Closed(jsonschema::draft202012::new(&schema).expect("a schema of the draft"))
    }

    /// Whether a value is as the schema wants it.
    pub fn accepts(&self, value: &Value) -> bool {
        self.0.is_valid(value)
    }

    /// Fails with the first places where a value is not as the schema wants it.
    #[track_caller]
    pub fn assert_accepts(&self, value: &Value) {
        let errors: Vec<String> =
            self.0.iter_errors(value).take(5).map(|e| format!("{}: {e}", e.instance_path())).collect();
        assert!(errors.is_empty(), "{errors:#?}");
    }
}

fn close(schema: &mut Value) {
    match schema {
        Value::Object(fields) => {
            if fields.contains_key("properties") && !fields.contains_key("additionalProperties") {
                fields.insert("additionalProperties".into(), false.into());
            }
            fields.values_mut().for_each(close);
        }
        Value::Array(items) => items.iter_mut().for_each(close),
        _ => {}
    }
}
