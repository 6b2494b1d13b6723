//! From an instance file to its document.

use super::{Document, FORMAT, VERSION};
use crate::json::{ReadError, Value};

/// Reads an instance file.
///
/// # Errors
/// The first place where the text is no JSON, has a key twice, or is no instance of this format and
/// version. Whether it is the instance of its own mission is another question.
pub fn read(text: &str) -> Result<Document, ReadError> {
    let wrong = |message: String| ReadError::new(message).from_root();
    let value = Value::parse(text).map_err(ReadError::from_root)?;
    let field = |key: &str| match &value {
        Value::Object(fields) => fields.iter().find(|(k, _)| k == key).map(|(_, v)| v),
        _ => None,
    };
    if field("format") != Some(&Value::Text(FORMAT.into())) {
        return Err(wrong(format!("`format` is not {FORMAT:?}")));
    }
    if field("version") != Some(&Value::Natural(VERSION.into())) {
        return Err(wrong(format!("`version` is not {VERSION}, the only one that this dosmc reads")));
    }
    serde_json::from_str(text).map_err(|e| wrong(e.to_string()))
}
