//! Compact JSON laid out for people.

/// How wide a line may be before its array or object is broken.
const WIDTH: usize = 120;

/// Lays out one JSON value that is written without white space between its parts: the value itself
/// is broken into lines, and so is every array or object in it that is too wide for one.
pub fn lay_out(compact: &str) -> String {
    let mut layout =
        Layout { text: compact.as_bytes(), at: 0, out: Vec::with_capacity(compact.len() * 3 / 2) };
    layout.broken(0);
    layout.out.push(b'\n');
    // Only ASCII white space was added, between tokens.
    String::from_utf8(layout.out).unwrap_or_else(|_| compact.to_owned())
}

struct Layout<'a> {
    text: &'a [u8],
    at: usize,
    out: Vec<u8>,
}

impl Layout<'_> {
    /// Writes the value that begins here, on one line where it fits.
    fn value(&mut self, indent: usize) {
        match self.end_inline(WIDTH.saturating_sub(indent)) {
            Some(end) => self.inline(end),
            None => self.broken(indent),
        }
    }

    /// Writes the value that begins here with one line or more for each member.
    fn broken(&mut self, indent: usize) {
        let Some(close) = self.peek().and_then(closing) else {
            return self.leaf();
        };
        self.copy();
        let inner = indent + 2;
        let mut first = true;
        while self.peek().is_some_and(|c| c != close) {
            if !first {
                // The comma between two members.
                self.copy();
            }
            first = false;
            self.new_line(inner);
            if close == b'}' {
                self.leaf();
                self.copy();
                self.out.push(b' ');
            }
            self.value(inner);
        }
        self.new_line(indent);
        self.copy();
    }

    /// Where the array or object that begins here ends, if it takes `room` bytes at most on one line.
    fn end_inline(&self, room: usize) -> Option<usize> {
        let (mut at, mut depth, mut width) = (self.at, 0usize, 0usize);
        loop {
            let byte = *self.text.get(at)?;
            let end = if byte == b'"' { end_of_string(self.text, at) } else { at + 1 };
            // A blank follows each comma and colon.
            width += end - at + usize::from(matches!(byte, b',' | b':'));
            at = end;
            match byte {
                b'[' | b'{' => depth += 1,
                b']' | b'}' => depth = depth.checked_sub(1)?,
                _ => {}
            }
            if width > room {
                return None;
            }
            if depth == 0 {
                let leaf = !matches!(byte, b']' | b'}');
                return (!leaf).then_some(at);
            }
        }
    }

    /// Writes everything up to `end` on one line.
    fn inline(&mut self, end: usize) {
        while self.at < end {
            match self.peek() {
                Some(b'"') => self.leaf(),
                Some(b',' | b':') => {
                    self.copy();
                    self.out.push(b' ');
                }
                _ => self.copy(),
            }
        }
    }

    /// Writes the string, number or constant that begins here.
    fn leaf(&mut self) {
        let end = if self.peek() == Some(b'"') {
            end_of_string(self.text, self.at)
        } else {
            let rest = self.text.get(self.at..).unwrap_or_default();
            self.at + rest.iter().position(|c| matches!(c, b',' | b']' | b'}')).unwrap_or(rest.len())
        };
        self.out.extend_from_slice(self.text.get(self.at..end).unwrap_or_default());
        self.at = end;
    }

    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    /// Writes one byte as it is.
    fn copy(&mut self) {
        self.out.extend(self.peek());
        self.at += 1;
    }

    fn new_line(&mut self, indent: usize) {
        self.out.push(b'\n');
        self.out.extend(std::iter::repeat_n(b' ', indent));
    }
}

fn closing(open: u8) -> Option<u8> {
    match open {
        b'[' => Some(b']'),
        b'{' => Some(b'}'),
        _ => None,
    }
}

/// One past the closing quote of the string that begins at `start`.
fn end_of_string(text: &[u8], start: usize) -> usize {
    let mut at = start + 1;
    while let Some(&byte) = text.get(at) {
        match byte {
            b'"' => return at + 1,
            b'\\' => at += 2,
            _ => at += 1,
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_fits_stays_on_a_line() {
        let text = lay_out(r#"{"a":[1,2,{"b":null}],"c\"]":{},"d":"x, y: [z"}"#);
        assert_eq!(text, "{\n  \"a\": [1, 2, {\"b\": null}],\n  \"c\\\"]\": {},\n  \"d\": \"x, y: [z\"\n}\n");
        assert_eq!(lay_out("[]"), "[\n]\n");
        assert_eq!(lay_out("17"), "17\n");
    }

    #[test]
    fn what_is_too_wide_is_broken() {
        let row = |n: usize| format!("[{}]", vec!["12345678"; n].join(","));
        // Twelve numbers take 12 · 10 bytes on a line, brackets included and the last blank not.
        let text = lay_out(&format!("{{\"k\":{},\"l\":{}}}", row(11), row(12)));
        assert_eq!(text.lines().count(), 3 + 14);
        assert!(text.lines().all(|l| l.len() <= WIDTH + 5));
        let long = format!("[\"{}\"]", "é".repeat(200));
        assert_eq!(lay_out(&long), format!("[\n  \"{}\"\n]\n", "é".repeat(200)));
    }

    #[test]
    fn nothing_but_white_space_changes() {
        let rows: Vec<Vec<f64>> = (0..40).map(|i| vec![f64::from(i) / 7.0; i as usize]).collect();
        let value = serde_json::json!({"rows": rows, "text": "a \\ \" \u{1} é", "deep": [[[[{}]]]]});
        let text = lay_out(&value.to_string());
        assert_eq!(serde_json::from_str::<serde_json::Value>(&text).unwrap(), value);
    }

    #[test]
    fn what_is_no_json_ends_all_the_same() {
        for text in ["", "[", "{\"a", "]", "}{", "[1,", "{\"a\":", "\\", "[\"\\", ",,,", "{,}", "[}"] {
            lay_out(text);
        }
    }
}
