//! Text: made harmless, cut, and measured without knowing the font.

use std::borrow::Cow;

use crate::diag::printable;

/// A text as SVG character data: one line, no markup, no control characters.
pub fn escape(text: &str) -> String {
    let text: Cow<str> = printable(text);
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' | '\t' => out.push(' '),
            // Not allowed in XML, and not printable text either.
            '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            _ => out.push(c),
        }
    }
    out
}

/// A text's width in pixels at a font size: a bound for the common sans-serif fonts rather than what
/// any one of them takes.
pub fn width(text: &str, size: f64, bold: bool) -> f64 {
    let sum: f64 = text.chars().map(advance).sum();
    sum * size * if bold { 1.1 } else { 1.0 }
}

/// A character's width in ems, at least that of Helvetica and its like.
fn advance(c: char) -> f64 {
    match c {
        'i' | 'j' | 'l' | '|' | '\'' | '.' | ',' | ':' | ';' | '!' | ' ' | 'I' => 0.34,
        'f' | 't' | 'r' | '(' | ')' | '[' | ']' | '-' | '/' | '"' | '·' => 0.4,
        'm' | 'w' | 'M' | 'W' | '%' | '@' | '…' => 0.98,
        'A'..='Z' | '&' | '<' | '>' | '=' | '+' | '×' | '→' => 0.74,
        // Accents that stand on the letter before.
        '\u{300}'..='\u{36f}' => 0.0,
        ' '..='~' => 0.61,
        '\u{a0}'..='\u{24f}' => 0.7,
        '\u{370}'..='\u{5ff}' => 0.8,
        _ => 1.05,
    }
}

/// The text, or as much of its beginning as fits with an ellipsis.
pub fn cut(text: &str, size: f64, bold: bool, room: f64) -> Cow<'_, str> {
    if width(text, size, bold) <= room {
        return Cow::Borrowed(text);
    }
    let mut short = String::new();
    for c in text.chars() {
        short.push(c);
        if width(&short, size, bold) + width("…", size, bold) > room {
            short.pop();
            break;
        }
    }
    short.push('…');
    Cow::Owned(short)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_becomes_neither_markup_nor_control() {
        assert_eq!(
            escape("</title><script>\"'&\u{1b}\u{202e}\n\u{ffff}"),
            "&lt;/title&gt;&lt;script&gt;&quot;&#39;&amp;\u{241b}\u{fffd} \u{fffd}"
        );
    }

    #[test]
    fn long_texts_are_cut_to_the_room_they_have() {
        let long = "a_name_that_goes_on_and_on";
        let short = cut(long, 14.0, true, 90.0);
        assert!(short.ends_with('…') && short.len() > 8);
        assert!(width(&short, 14.0, true) <= 90.0);
        assert_eq!(cut("J1", 14.0, true, 90.0), "J1");
    }
}
