//! Words of a mission as identifiers, string literals and comments of Rust: never as code.

use std::collections::BTreeSet;

use crate::diag::printable;

/// Rust's keywords, reserved ones and those of all editions included, and the names of its prelude
/// that the generated source relies on.
const TAKEN: [&str; 78] = [
    "abstract",
    "as",
    "async",
    "await",
    "become",
    "box",
    "break",
    "const",
    "continue",
    "crate",
    "do",
    "dyn",
    "else",
    "enum",
    "extern",
    "false",
    "final",
    "fn",
    "for",
    "gen",
    "if",
    "impl",
    "in",
    "let",
    "loop",
    "macro",
    "macro_rules",
    "match",
    "mod",
    "move",
    "mut",
    "override",
    "priv",
    "pub",
    "raw",
    "ref",
    "return",
    "safe",
    "self",
    "Self",
    "static",
    "struct",
    "super",
    "trait",
    "true",
    "try",
    "type",
    "typeof",
    "union",
    "unsafe",
    "unsized",
    "use",
    "virtual",
    "where",
    "while",
    "yield",
    "_",
    "f32",
    "f64",
    "str",
    "usize",
    "core",
    "law",
    "Clone",
    "Copy",
    "Debug",
    "Default",
    "Eq",
    "Fallback",
    "None",
    "Node",
    "Option",
    "Output",
    "PartialEq",
    "Some",
    "Status",
    "Input",
    "State",
];

/// Identifiers of one scope, each given out once.
#[derive(Debug, Default)]
pub(super) struct Scope {
    given: BTreeSet<String>,
}

impl Scope {
    /// A scope in which some names are taken already.
    pub(super) fn with(taken: &[&str]) -> Scope {
        Scope { given: taken.iter().map(|name| (*name).to_owned()).collect() }
    }

    /// The first of `name` and its variants that no other name of this scope has.
    fn unique(&mut self, name: String, variant: impl Fn(&str, usize) -> String) -> String {
        let mut candidate = name.clone();
        let mut count = 1;
        while TAKEN.contains(&candidate.as_str()) || !self.given.insert(candidate.clone()) {
            count += 1;
            candidate = variant(&name, count);
        }
        candidate
    }

    /// A type's name: `scout` is `Scout`, `left_wing` `LeftWing`, `fleet[2,1]` `Fleet2_1`.
    pub(super) fn camel(&mut self, name: &str) -> String {
        let mut camel = String::new();
        for part in words(name) {
            // Digits run into each other else.
            if camel.ends_with(|c: char| c.is_ascii_digit()) && part.starts_with(|c: char| c.is_ascii_digit())
            {
                camel.push('_');
            }
            let mut chars = part.chars();
            camel.extend(chars.next().map(|c| c.to_ascii_uppercase()));
            camel.extend(chars);
        }
        self.unique(started(camel, 'N'), |name, count| {
            let joint = if name.ends_with(|c: char| c.is_ascii_digit()) { "_" } else { "" };
            format!("{name}{joint}{count}")
        })
    }

    /// A field's or a module's name: `px` stays `px`, `Px` and `fleet[1]` are `px` and `fleet_1`.
    pub(super) fn snake(&mut self, name: &str) -> String {
        let mut snake = String::new();
        for part in words(name) {
            if !snake.is_empty() {
                snake.push('_');
            }
            let mut small = false;
            for c in part.chars() {
                // `maxSpeed` is `max_speed`.
                if c.is_ascii_uppercase() && small {
                    snake.push('_');
                }
                small = c.is_ascii_lowercase();
                snake.push(c.to_ascii_lowercase());
            }
        }
        self.unique(started(snake, 'n'), |name, count| match count {
            2 => format!("{name}_"),
            _ => format!("{name}_{count}"),
        })
    }
}

/// The runs of ASCII letters and digits in a name.
fn words(name: &str) -> impl Iterator<Item = &str> {
    name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|part| !part.is_empty())
}

/// A name that begins with a letter.
fn started(name: String, letter: char) -> String {
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) { name } else { format!("{letter}{name}") }
}

/// A string literal.
pub(super) fn literal(text: &str) -> String {
    format!("{:?}", printable(text))
}

/// Lines of documentation, each behind `prefix` (`/// `, `//! `): plain text, of which Markdown makes
/// nothing but paragraphs. A line that begins like code, a list or a heading does not.
pub(super) fn doc(prefix: &str, text: &str) -> String {
    let line = |line: &str| format!("{prefix}{}", plain(line)).trim_end().to_owned() + "\n";
    printable(text.trim()).lines().map(line).collect()
}

/// Text as code in Markdown, within a line.
pub(super) fn code(text: &str) -> String {
    let text = printable(text).replace(['`', '\n', '\t', '|'], " ");
    format!("`{text}`")
}

/// A line of plain text in Markdown.
pub(super) fn plain(line: &str) -> String {
    let mut plain = String::new();
    for c in line.trim().replace('\t', " ").chars() {
        let leads = plain.is_empty() && matches!(c, '-' | '+' | '=');
        if leads || matches!(c, '\\' | '`' | '*' | '_' | '[' | ']' | '<' | '>' | '#' | '~' | '|' | '&' | '!')
        {
            plain.push('\\');
        }
        // `1.` and `1)` begin a list.
        let numbered =
            matches!(c, '.' | ')') && !plain.is_empty() && plain.chars().all(|c| c.is_ascii_digit());
        if numbered {
            plain.push('\\');
        }
        plain.push(c);
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_identifiers() {
        let mut scope = Scope::default();
        let cases = [
            ("R1", "R1"),
            ("scout", "Scout"),
            ("left_wing", "LeftWing"),
            ("fleet[1]", "Fleet1"),
            ("fleet1", "Fleet1_2"),
            ("fleet[2,1]", "Fleet2_1"),
            ("fleet[21]", "Fleet21"),
            ("self", "Self2"),
            ("_", "N"),
            ("_9", "N9"),
            ("option", "Option2"),
        ];
        for (name, expected) in cases {
            assert_eq!(scope.camel(name), expected, "{name}");
        }
        let mut scope = Scope::with(&["vx"]);
        let cases = [
            ("px", "px"),
            ("Px", "px_"),
            ("maxSpeed", "max_speed"),
            ("move", "move_"),
            ("vx", "vx_"),
            ("a__b_", "a_b"),
            ("\"; loop {}", "loop_"),
            ("loop", "loop_3"),
        ];
        for (name, expected) in cases {
            assert_eq!(scope.snake(name), expected, "{name}");
        }
    }

    #[test]
    fn documentation_stays_text() {
        let text = "Ends here */ \"\n    indented\n```\nlet x = 1;\n- item\u{2028}<script>\r1. one\n# head";
        let expected = "/// Ends here \\*/ \"\n/// indented\n/// \\`\\`\\`\n/// let x = 1;\n\
                        /// \\- item\u{fffd}\\<script\\>\u{240d}1. one\n/// \\# head\n";
        assert_eq!(doc("/// ", text), expected);
        assert_eq!(plain("1. one"), "1\\. one");
        assert_eq!(plain("in 1. place"), "in 1. place");
        assert_eq!(doc("/// ", "  "), "");
    }

    #[test]
    fn literals_hold_any_text() {
        assert_eq!(literal("a\"; loop {}\\"), r#""a\"; loop {}\\""#);
    }
}
