//! Mends as edits, for those who can make them: editors.

use crate::source::Span;

/// A change of a text that mends what a diagnostic is about.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Fix {
    /// What it does, as an imperative sentence without a full stop.
    pub title: String,
    /// The changes, which don't overlap.
    pub edits: Vec<Edit>,
    /// Whether it is the one mend that is surely meant.
    pub is_sure: bool,
}

/// A change of a place.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Edit {
    /// Puts a text in the place of another; blanks keep words apart.
    Replace(Span, String),
    /// Exchanges two texts.
    Swap(Span, Span),
    /// Removes a text, with the blanks before it.
    Remove(Span),
    /// Removes the blanks on both sides.
    Tighten(Span),
    /// Puts a text behind another, without a blank between.
    Append(Span, String),
    /// Adds an item to the block whose brace opens behind a place.
    IntoBlock(Span, String),
    /// Adds a declaration at the end.
    AtEnd(String),
    /// Gives a unit to an expression: in brackets where it is no number.
    GiveUnit(Span, String),
}

impl Fix {
    /// The fix as replacements in a text, in order; `None` where they don't fit it.
    pub fn replacements(&self, text: &str) -> Option<Vec<(Span, String)>> {
        let mut list = Vec::new();
        for edit in &self.edits {
            edit.add(text, &mut list)?;
        }
        list.sort_by_key(|(span, _)| *span);
        let overlap = list.windows(2).any(|pair| pair[0].0.end > pair[1].0.start);
        (!overlap && !list.is_empty()).then_some(list)
    }
}

impl Edit {
    fn add(&self, text: &str, list: &mut Vec<(Span, String)>) -> Option<()> {
        match self {
            Edit::Replace(span, new) => list.push((*span, apart(text, *span, new)?)),
            Edit::Swap(a, b) => {
                list.push((*a, text.get(b.range())?.to_string()));
                list.push((*b, text.get(a.range())?.to_string()));
            }
            Edit::Remove(span) => {
                let before = text.get(..span.start as usize)?;
                let start = before.trim_end_matches([' ', '\t']).len();
                // On a line of its own, the line goes as well.
                let rest = text.get(span.end as usize..)?;
                let ends_line = rest.is_empty() || rest.starts_with(['\n', '\r']);
                let begins_line = start == 0 || before.get(..start)?.ends_with('\n');
                let start = match (begins_line && ends_line, before.get(..start)?.strip_suffix('\n')) {
                    (true, Some(line)) => line.strip_suffix('\r').unwrap_or(line).len(),
                    (true, None) => start,
                    (false, _) if begins_line => span.start as usize,
                    (false, _) => start,
                };
                list.push((Span::new(start, span.end as usize), String::new()));
            }
            Edit::Tighten(span) => {
                let before = text.get(..span.start as usize)?;
                let behind = text.get(span.end as usize..)?;
                let end = span.end as usize + (behind.len() - behind.trim_start().len());
                list.push((Span::new(before.trim_end().len(), span.start as usize), String::new()));
                list.push((Span::new(span.end as usize, end), String::new()));
            }
            Edit::Append(span, new) => {
                let end = text.get(..span.end as usize)?.trim_end().len();
                list.push((Span::new(end, end), new.clone()));
            }
            Edit::IntoBlock(span, item) => {
                let behind = text.get(span.end as usize..)?;
                let brace = span.end as usize + behind.find('{')? + 1;
                let rest = text.get(brace..)?;
                let ends_line = rest.lines().next().is_none_or(|line| line.trim().is_empty());
                let gap = if ends_line { "\n  " } else { " " };
                list.push((Span::new(brace, brace), format!("{gap}{item}")));
            }
            Edit::AtEnd(declaration) => {
                let end = text.len();
                let gap = if text.is_empty() || text.ends_with('\n') { "" } else { "\n" };
                list.push((Span::new(end, end), format!("{gap}{declaration}\n")));
            }
            Edit::GiveUnit(span, unit) => {
                let written = text.get(span.range())?;
                let is_number = written.bytes().all(|b| b.is_ascii_digit() || b == b'.');
                let new = if is_number { format!("{written} {unit}") } else { format!("({written}) {unit}") };
                list.push((*span, new));
            }
        }
        Some(())
    }
}

/// A text for a place, with blanks where it would else grow together with its neighbours.
fn apart(text: &str, span: Span, new: &str) -> Option<String> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let before = text.get(..span.start as usize)?.ends_with(is_word) && new.starts_with(is_word);
    let behind = text.get(span.end as usize..)?.starts_with(is_word) && new.ends_with(is_word);
    let blank = |is: bool| if is { " " } else { "" };
    Some(format!("{}{new}{}", blank(before), blank(behind)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(text: &str, edits: Vec<Edit>, expected: &str) {
        let fix = Fix { title: String::new(), edits, is_sure: true };
        let mut changed = text.to_string();
        for (span, new) in fix.replacements(text).expect("the edits fit").into_iter().rev() {
            changed.replace_range(span.range(), &new);
        }
        assert_eq!(changed, expected);
    }

    #[test]
    fn edits_are_made_with_regard_to_what_stands_around() {
        let span = Span::new;
        check("a∧b", vec![Edit::Replace(span(1, 4), "and".into())], "a and b");
        check("a ∧ b", vec![Edit::Replace(span(2, 5), "and".into())], "a and b");
        check("[4, 10]", vec![Edit::Swap(span(1, 2), span(4, 6))], "[10, 4]");
        check("a\n  b\nc", vec![Edit::Remove(span(4, 5))], "a\nc");
        check("a\r\nb\r\nc", vec![Edit::Remove(span(3, 4))], "a\r\nc");
        check("b\nc", vec![Edit::Remove(span(0, 1))], "\nc");
        check("1 m m", vec![Edit::Remove(span(4, 5))], "1 m");
        check("b c\n", vec![Edit::Remove(span(0, 1))], " c\n");
        check("2 m / s", vec![Edit::Tighten(span(4, 5))], "2 m/s");
        check("[0 1]", vec![Edit::Append(span(1, 3), ",".into())], "[0, 1]");
        check("d D {\n}", vec![Edit::IntoBlock(span(2, 3), "i".into())], "d D {\n  i\n}");
        check("d D { x }", vec![Edit::IntoBlock(span(2, 3), "i".into())], "d D { i x }");
        check("a", vec![Edit::AtEnd("b".into())], "a\nb\n");
        check("1 + a", vec![Edit::GiveUnit(span(4, 5), "m".into())], "1 + (a) m");
        check("1 + a", vec![Edit::GiveUnit(span(0, 1), "m".into())], "1 m + a");
    }

    #[test]
    fn what_does_not_fit_is_no_fix() {
        let fix = |edits| Fix { title: String::new(), edits, is_sure: true };
        assert_eq!(fix(vec![Edit::Remove(Span::new(7, 9))]).replacements("abc"), None);
        assert_eq!(fix(vec![Edit::Remove(Span::new(1, 2))]).replacements("é"), None);
        let twice =
            vec![Edit::Replace(Span::new(0, 2), "x".into()), Edit::Replace(Span::new(1, 3), "y".into())];
        assert_eq!(fix(twice).replacements("abc"), None);
    }
}
