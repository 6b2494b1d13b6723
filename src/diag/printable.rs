//! Text that is safe to print: nothing in it moves the cursor, hides or reorders.

use std::borrow::Cow;

/// The text with every control, invisible and direction-changing character replaced by a visible
/// one, character for character; tabs and newlines stay.
pub fn printable(text: &str) -> Cow<'_, str> {
    if text.chars().all(|c| shown_as(c) == c) {
        return Cow::Borrowed(text);
    }
    Cow::Owned(text.chars().map(shown_as).collect())
}

/// What stands for a character: itself, or a visible picture of it.
///
/// The C0 controls and DEL have pictures of their own in Unicode; all else becomes U+FFFD.
pub(super) fn shown_as(c: char) -> char {
    match c {
        '\t' | '\n' => c,
        '\0'..='\u{1f}' => char::from_u32(0x2400 + c as u32).unwrap_or('\u{fffd}'),
        '\u{7f}' => '\u{2421}',
        _ if c.is_control() || is_unseen(c) => '\u{fffd}',
        _ => c,
    }
}

/// Whether a character changes the direction of writing, breaks lines or can't be seen.
fn is_unseen(c: char) -> bool {
    matches!(c,
        '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
        | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
}

#[cfg(test)]
mod tests {
    use super::printable;

    #[test]
    fn control_and_bidi_characters_become_visible() {
        assert_eq!(
            printable("a\u{1b}[31mb\u{202e}c\u{9b}d\u{7f}\t\n"),
            "a\u{241b}[31mb\u{fffd}c\u{fffd}d\u{2421}\t\n"
        );
    }

    #[test]
    fn ordinary_text_is_left_alone() {
        for text in ["", "plain", "Ω ⊕ ψ — 北京", "two\nlines"] {
            assert_eq!(printable(text), text);
        }
    }
}
