//! Messages on a byte stream: a header with the length, an empty line, and JSON.
//!
//! What can't be read is reported and passed over, so that one bad message does not end a session; that is
//! more than `lsp_server::Message::read` does, which also takes any length's word for it.

use std::io::{self, BufRead, Read, Write};

use lsp_server::{Message, RequestId};
use serde_json::{Value, json};

/// The longest message that is read, in bytes.
const LONGEST: u64 = 256 << 20;
/// The longest header line, in bytes.
const LONGEST_HEADER: u64 = 4096;

/// What a client sent.
#[derive(Debug)]
pub enum Arrival {
    /// A message.
    Message(Message),
    /// Something that is none; the error to answer with.
    Malformed(Malformed),
}

/// Why something is no message.
#[derive(Debug, PartialEq)]
pub struct Malformed {
    /// The request's id, where one can be seen.
    pub id: Option<RequestId>,
    /// JSON-RPC's error code.
    pub code: i32,
    /// What is wrong, for the client's log.
    pub message: String,
}

/// JSON-RPC: the text is no JSON.
const PARSE_ERROR: i32 = -32700;
/// JSON-RPC: the JSON is no message.
const INVALID_REQUEST: i32 = -32600;

impl Malformed {
    fn new(code: i32, message: impl Into<String>) -> Malformed {
        Malformed { id: None, code, message: message.into() }
    }

    /// The answer to it; its id is null where the request's is not known.
    pub fn answer(&self) -> Value {
        json!({ "jsonrpc": "2.0", "id": self.id, "error": { "code": self.code, "message": self.message } })
    }
}

/// Reads the next message; `None` at the end.
///
/// # Errors
/// What the stream says.
pub fn read(input: &mut impl BufRead) -> io::Result<Option<Arrival>> {
    let Some(length) = read_header(input)? else { return Ok(None) };
    let length = match length {
        Ok(length) => length,
        Err(malformed) => return Ok(Some(Arrival::Malformed(malformed))),
    };
    if length > LONGEST {
        io::copy(&mut input.take(length), &mut io::sink())?;
        let why = format!("a message of {length} bytes is too long");
        return Ok(Some(Arrival::Malformed(Malformed::new(INVALID_REQUEST, why))));
    }
    let mut body = Vec::new();
    if input.take(length).read_to_end(&mut body)? < length as usize {
        return Ok(None);
    }
    Ok(Some(decode(&body)))
}

/// The length that a header gives; `None` at the end of the stream.
fn read_header(input: &mut impl BufRead) -> io::Result<Option<Result<u64, Malformed>>> {
    let (mut length, mut wrong) = (None, None);
    loop {
        let mut line = Vec::new();
        if input.take(LONGEST_HEADER).read_until(b'\n', &mut line)? == 0 {
            return Ok(None);
        }
        let line = String::from_utf8_lossy(&line);
        let line = line.trim_end();
        if line.is_empty() {
            break;
        }
        match line.split_once(':').map(|(name, value)| (name.trim(), value.trim())) {
            Some((name, value)) if name.eq_ignore_ascii_case("content-length") => match value.parse() {
                Ok(value) => length = Some(value),
                Err(_) => wrong = Some(format!("`{value}` is no length")),
            },
            Some(_) => {}
            None => wrong = Some(format!("`{line}` is no header")),
        }
    }
    // A length stands even beside rubbish: with it, the next message is found.
    let missing = || Malformed::new(PARSE_ERROR, wrong.unwrap_or("a header without Content-Length".into()));
    Ok(Some(length.ok_or_else(missing)))
}

/// A message from its JSON.
fn decode(body: &[u8]) -> Arrival {
    let value: Value = match serde_json::from_slice(body) {
        Ok(value) => value,
        Err(error) => return Arrival::Malformed(Malformed::new(PARSE_ERROR, format!("no JSON: {error}"))),
    };
    let id = value.get("id").and_then(|id| serde_json::from_value(id.clone()).ok());
    match serde_json::from_value(value) {
        Ok(message) => Arrival::Message(message),
        Err(_) => {
            let why = "neither a request nor a response nor a notification";
            Arrival::Malformed(Malformed { id, ..Malformed::new(INVALID_REQUEST, why) })
        }
    }
}

/// A message as JSON.
pub fn encode(message: &Message) -> Value {
    let mut value = serde_json::to_value(message).unwrap_or_default();
    if let Value::Object(fields) = &mut value {
        fields.insert("jsonrpc".into(), "2.0".into());
    }
    value
}

/// Writes a message with its header.
///
/// # Errors
/// What the stream says.
pub fn write(output: &mut impl Write, value: &Value) -> io::Result<()> {
    let text = value.to_string();
    write!(output, "Content-Length: {}\r\n\r\n{text}", text.len())?;
    output.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn framed(body: &str) -> String {
        format!("Content-Length: {}\r\n\r\n{body}", body.len())
    }

    fn all(text: &str) -> Vec<Arrival> {
        let mut input = text.as_bytes();
        std::iter::from_fn(|| read(&mut input).expect("memory can be read")).collect()
    }

    fn method(arrival: &Arrival) -> Option<&str> {
        match arrival {
            Arrival::Message(Message::Notification(n)) => Some(&n.method),
            _ => None,
        }
    }

    #[test]
    fn whatever_is_wrong_with_a_message_the_next_one_is_read() {
        let good = framed(r#"{"jsonrpc":"2.0","method":"exit"}"#);
        let bad = [
            framed("{"),
            framed("[]"),
            framed("7"),
            framed(r#"{"id":1.5,"method":3}"#),
            framed("\u{0}"),
            "Content-Length: many\r\n\r\n".into(),
            "rubbish\r\n\r\n".into(),
            "\r\n".into(),
            format!("rubbish\r\n{}", framed("nor this")),
            framed(&"[".repeat(100_000)),
        ];
        for bad in bad {
            let arrivals = all(&format!("{bad}{good}"));
            assert_eq!(arrivals.len(), 2, "{bad:.60}: {arrivals:?}");
            assert!(matches!(arrivals[0], Arrival::Malformed(_)), "{bad:.60}");
            assert_eq!(method(&arrivals[1]), Some("exit"), "{bad:.60}");
        }
    }

    #[test]
    fn a_request_that_is_none_is_answered_under_its_id() {
        let arrivals = all(&framed(r#"{"jsonrpc":"2.0","id":7}"#));
        let [Arrival::Malformed(malformed)] = &arrivals[..] else { panic!("{arrivals:?}") };
        assert_eq!(malformed.answer()["id"], 7);
        assert_eq!(malformed.answer()["error"]["code"], INVALID_REQUEST);
        assert_eq!(Malformed::new(PARSE_ERROR, "").answer()["id"], Value::Null);
    }

    #[test]
    fn a_stream_that_breaks_off_ends() {
        assert!(all("Content-Length: 10\r\n\r\n{").is_empty());
        assert!(all("Content-Length: 99999999999999\r\n\r\n{").len() <= 1);
        assert!(all("Content-Le").is_empty());
    }

    #[test]
    fn what_is_written_can_be_read() {
        let note = lsp_server::Notification::new("é→😀".into(), Value::Null);
        let mut bytes = Vec::new();
        write(&mut bytes, &encode(&Message::Notification(note))).expect("memory can be written");
        let arrivals = all(std::str::from_utf8(&bytes).expect("it is text"));
        assert_eq!(method(&arrivals[0]), Some("é→😀"));
    }
}
