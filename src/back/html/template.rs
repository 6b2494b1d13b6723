//! The page's frame with its parts in their places, and texts that are safe in it.

use sha2::{Digest, Sha256};

/// The script of every page. What it may do is fixed by its hash in the page's policy.
pub const SCRIPT: &str = include_str!("page.js");

/// Puts parts into the places `{{name}}` of a frame, in one pass: what a part holds is never looked at.
pub fn fill(frame: &str, parts: &[(&str, &str)]) -> String {
    let mut page = String::with_capacity(frame.len() + parts.iter().map(|(_, p)| p.len()).sum::<usize>());
    let mut rest = frame;
    while let Some((before, after)) = rest.split_once("{{") {
        page.push_str(before);
        let (name, after) = after.split_once("}}").unwrap_or((after, ""));
        page.push_str(parts.iter().find(|(n, _)| *n == name).map_or("", |(_, part)| part));
        rest = after;
    }
    page + rest
}

/// What the page may do: run its own script, use its own styles, and nothing else. No text of a mission
/// could run, even if it got into the page as markup.
pub fn policy() -> String {
    let hash = base64(&Sha256::digest(SCRIPT.as_bytes()));
    format!(
        "default-src 'none'; script-src 'sha256-{hash}'; style-src 'unsafe-inline'; base-uri 'none'; \
         form-action 'none'"
    )
}

/// JSON that can stand in a `<script>` element: no character of it can end the element or begin another.
pub fn harmless_json(json: &str) -> String {
    let mut text = String::with_capacity(json.len());
    for c in json.chars() {
        match c {
            // These occur in strings only, where they may as well be escaped.
            '<' | '>' | '&' | '\u{2028}' | '\u{2029}' => text.push_str(&format!("\\u{:04x}", c as u32)),
            _ => text.push(c),
        }
    }
    text
}

/// Bytes in base 64, with padding (RFC 4648, section 4).
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for chunk in bytes.chunks(3) {
        let byte = |i: usize| u32::from(chunk.get(i).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for digit in 0..4 {
            let value = (bits >> (18 - 6 * digit) & 63) as usize;
            text.push(if digit <= chunk.len() { DIGITS[value] as char } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_never_looked_at() {
        assert_eq!(fill("<{{a}}|{{b}}|{{c}}>", &[("a", "{{b}}"), ("b", "{{")]), "<{{b}}|{{|>");
    }

    #[test]
    fn base_64_is_that_of_the_rfc() {
        let cases = [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")];
        for (text, expected) in cases {
            assert_eq!(base64(text.as_bytes()), expected);
        }
    }

    #[test]
    fn json_can_neither_end_nor_begin_an_element() {
        let json = serde_json::to_string("</script><!--&\u{2028}\"").expect("a string");
        let text = harmless_json(&json);
        assert!(!text.contains(['<', '>', '&', '\u{2028}']));
        assert_eq!(serde_json::from_str::<String>(&text).expect("JSON"), "</script><!--&\u{2028}\"");
    }

    #[test]
    fn the_script_can_stand_in_its_element() {
        let lower = SCRIPT.to_lowercase();
        assert!(!lower.contains("</script") && !lower.contains("<!--") && SCRIPT.is_ascii());
    }
}
