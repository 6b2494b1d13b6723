//! Characters that no mission holds: what they are called and what was probably meant.

/// What a character outside the language is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Character {
    /// Nothing to be seen: a control character, an odd blank, a mark that reorders text; with its name.
    Hidden(&'static str),
    /// It looks like this.
    Lookalike(&'static str),
    /// A letter or digit of another alphabet.
    Letter,
    /// Anything else.
    Other,
}

/// Classifies a character that is no part of the language.
pub(super) fn classify(character: char) -> Character {
    if let Some(name) = hidden_name(character) {
        return Character::Hidden(name);
    }
    match lookalike(character) {
        Some(meant) => Character::Lookalike(meant),
        None if character.is_alphanumeric() => Character::Letter,
        None => Character::Other,
    }
}

/// The name of a character that is refused in comments too: control characters and what reorders text.
pub(super) fn hidden_in_comment(character: char) -> Option<&'static str> {
    match character {
        '\t' | '\r' | '\n' => None,
        '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => hidden_name(character),
        c if c.is_control() => hidden_name(c),
        _ => None,
    }
}

fn hidden_name(character: char) -> Option<&'static str> {
    Some(match character {
        '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{200e}' | '\u{200f}' | '\u{061c}' => {
            "a mark that changes the direction of text"
        }
        '\u{200b}'..='\u{200d}'
        | '\u{2060}'..='\u{2064}'
        | '\u{feff}'
        | '\u{ad}'
        | '\u{fe00}'..='\u{fe0f}' => "a character without width",
        '\u{1b}' => "an escape character",
        c if c.is_control() => "a control character",
        c if c.is_whitespace() => "a blank of an unusual kind",
        _ => return None,
    })
}

/// The sign of the language that a character looks like or stands for.
fn lookalike(character: char) -> Option<&'static str> {
    Some(match character {
        '−' | '‐' | '‑' | '‒' | '–' | '—' => "-",
        '×' | '·' | '⋅' | '∙' | '∗' => "*",
        '÷' | '∕' | '⁄' => "/",
        '≤' | '⩽' => "<=",
        '≥' | '⩾' => ">=",
        '≠' => "!=",
        '→' | '⇒' | '⟶' | '⟹' => "->",
        '↔' | '⇔' | '⟷' | '⟺' => "<->",
        '∧' | '⋀' => "&&",
        '∨' | '⋁' => "||",
        '¬' => "!",
        '□' | '◻' | '☐' => "[]",
        '◇' | '◊' | '⋄' | '♢' => "<>",
        '○' | '◯' => "X",
        '∀' => "forall",
        '∃' => "exists",
        '∈' => "in",
        '∓' => "±",
        '…' | '‥' => "..",
        '“' | '”' | '„' | '‟' | '«' | '»' | '‘' | '’' | '‚' => "\"",
        '²' => "^2",
        '³' => "^3",
        '\u{ff01}'..='\u{ff5e}' => return full_width(character),
        _ => return None,
    })
}

/// The ASCII sign of a full-width one.
fn full_width(character: char) -> Option<&'static str> {
    const ASCII: &str =
        "!\"#$%&'()*+,-./0123456789:;<=>?@ABCDEFGHIJKLMNOPQRSTUVWXYZ[\\]^_`abcdefghijklmnopqrstuvwxyz{|}~";
    let index = (character as usize).checked_sub(0xff01)?;
    ASCII.get(index..index + 1)
}

/// A text for messages: what a terminal could obey or a reader misread is written as `\u{…}`.
pub(super) fn shown(text: &str) -> String {
    let mut out = String::new();
    for character in text.chars() {
        if hidden_name(character).is_some() && character != ' ' {
            out.extend(character.escape_unicode());
        } else {
            out.push(character);
        }
    }
    out
}
