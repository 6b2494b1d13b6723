//! A page for a terminal: its little Markdown as bold headings, indented code and filled lines.

use crate::diag::render::Style;

const BOLD: &str = "\u{1b}[1m";
const CODE: &str = "\u{1b}[36m";
const PLAIN: &str = "\u{1b}[0m";

/// The widest line of running text; longer ones are tiring to read.
const WIDEST: usize = 88;

/// The page's text; without colours the backticks stay, since nothing else sets code apart.
///
/// Of Markdown it knows what pages use: headings, paragraphs, lists, fences and code in backticks.
pub fn draw(markdown: &str, style: Style) -> String {
    let width = style.width.min(WIDEST);
    let mut out = String::new();
    let mut open = Vec::new();
    let mut fenced = false;
    for line in markdown.lines() {
        let fence = line.starts_with("```");
        let apart = fence || fenced || line.is_empty() || line.starts_with(['#', '-']);
        if apart {
            fill(&mut out, &mut open, width, style.color);
        }
        if fence {
            fenced = !fenced;
        } else if fenced {
            push(&mut out, "    ", &painted(line, CODE, style.color));
        } else if line.is_empty() {
            out.push('\n');
        } else if let Some(heading) = line.strip_prefix('#') {
            let heading = heading.trim_start_matches(['#', ' ']).replace('`', "");
            push(&mut out, "", &painted(&heading, BOLD, style.color));
        } else {
            open.push(line);
        }
    }
    fill(&mut out, &mut open, width, style.color);
    out
}

fn push(out: &mut String, indent: &str, line: &str) {
    if !line.is_empty() {
        out.push_str(indent);
    }
    out.push_str(line);
    out.push('\n');
}

fn painted(text: &str, paint: &str, color: bool) -> String {
    if color && !text.is_empty() { format!("{paint}{text}{PLAIN}") } else { text.to_string() }
}

/// Sets the lines of a paragraph or of a list's item as lines of at most `width` characters.
fn fill(out: &mut String, open: &mut Vec<&str>, width: usize, color: bool) {
    let text = open.join(" ");
    open.clear();
    let (mark, text) = text.strip_prefix("- ").map_or(("", text.as_str()), |rest| ("- ", rest));
    for (i, line) in lines(text, width - mark.len(), color).iter().enumerate() {
        let indent = if i == 0 { mark } else { &"  "[..mark.len()] };
        push(out, indent, &spans(line, color));
    }
}

/// A text cut into lines between its words.
fn lines(text: &str, width: usize, color: bool) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words(text) {
        match lines.last_mut() {
            Some(line) if length(line, color) + 1 + length(word, color) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_string()),
        }
    }
    lines
}

/// The words of a text; code in backticks is one word, blanks and all.
fn words(text: &str) -> Vec<&str> {
    let (mut words, mut start, mut code) = (Vec::new(), 0, false);
    for (at, c) in text.char_indices() {
        if c == '`' {
            code = !code;
        } else if c == ' ' && !code {
            words.push(&text[start..at]);
            start = at + 1;
        }
    }
    words.push(&text[start..]);
    words.retain(|word| !word.is_empty());
    words
}

/// The columns that a text takes: with colours, backticks take none.
fn length(text: &str, color: bool) -> usize {
    text.chars().filter(|&c| !(color && c == '`')).count()
}

/// Code in backticks, painted.
fn spans(line: &str, color: bool) -> String {
    if !color {
        return line.to_string();
    }
    let parts = line.split('`').enumerate();
    parts.map(|(i, part)| painted(part, if i % 2 == 1 { CODE } else { "" }, i % 2 == 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = "# `a::b`: so\n\n## What\nThe unit of `1 m/s` is\nwrong.\n\n- an item that is long\n  and goes on\n- two\n\n```dosm\nstep 1 s\n\ngoal g: true\n```\n";

    #[test]
    fn a_page_is_filled_and_its_code_indented() {
        let drawn = draw(PAGE, Style { color: false, width: 20 });
        let lines: Vec<&str> = drawn.lines().collect();
        let expected = [
            "a::b: so",
            "",
            "What",
            "The unit of `1 m/s`",
            "is wrong.",
            "",
            "- an item that is",
            "  long and goes on",
            "- two",
            "",
            "    step 1 s",
            "",
            "    goal g: true",
        ];
        assert_eq!(lines, expected);
    }

    #[test]
    fn colours_take_no_room_and_replace_backticks() {
        let drawn = draw(PAGE, Style { color: true, width: 20 });
        assert!(drawn.starts_with("\u{1b}[1ma::b: so\u{1b}[0m\n"));
        assert!(drawn.contains("The unit of \u{1b}[36m1 m/s\u{1b}[0m is\nwrong.\n"), "{drawn:?}");
        assert!(!drawn.contains('`') && drawn.contains("    \u{1b}[36mgoal g: true\u{1b}[0m\n"));
    }
}
