//! What may follow where the cursor stands inside a shape, a function, a bound, a count or a window.
//!
//! While somebody types the text can't be read, so that this works on the tokens before the cursor.

mod forms;
#[cfg(test)]
mod tests;

use lsp_types::{
    Documentation, MarkupContent, MarkupKind, ParameterInformation, ParameterLabel, Position, SignatureHelp,
    SignatureInformation,
};

use super::Document;
use crate::check::dimension;
use crate::syntax::token::{Kind, Token, tokens};
use crate::syntax::words;
use forms::{Ends, Form, Part, form};

/// The most bytes before the cursor that are looked at.
const MOST_BYTES: usize = 20_000;

/// The innermost form that the cursor stands in, with the part that comes there.
pub fn help(document: &Document, position: Position) -> Option<SignatureHelp> {
    let offset = document.offset(position) as usize;
    let before = before(document, offset);
    let (form, active) = innermost(before)?;
    let space = document.file().is_some_and(|file| dimension(&file.items) == 3);
    Some(SignatureHelp {
        signatures: vec![shown(form, space)],
        active_signature: Some(0),
        active_parameter: Some(active as u32),
    })
}

/// The text before an offset, from a line's beginning not too far away.
fn before(document: &Document, offset: usize) -> &str {
    let text = document.source.text.get(..offset).unwrap_or("");
    let Some(far) = text.len().checked_sub(MOST_BYTES) else { return text };
    let line = text.as_bytes()[far..].iter().position(|b| *b == b'\n').map_or(text.len(), |at| far + at + 1);
    text.get(line..).unwrap_or("")
}

/// What is open at some place.
enum Frame {
    /// A bracket.
    Open(&'static str),
    /// A form with the part that comes next.
    Form(&'static Form, usize),
}

/// The innermost form that is open at the end of a text, with the part that comes there.
fn innermost(text: &str) -> Option<(&'static Form, usize)> {
    let tokens = tokens(text);
    // Inside a comment, which ends at the line's end or never, nothing is asked.
    let last = tokens.last()?;
    let ended = last.kind == Kind::BlockComment && last.text.ends_with("*/") && last.text.len() >= 4;
    if last.is_comment()
        && !ended
        && last.start + last.text.len() + 1 > text.trim_end_matches([' ', '\t']).len()
    {
        return None;
    }
    let start = tokens.iter().rposition(|t| t.kind == Kind::Word && words::DECLARATIONS.contains(&t.text))?;
    let mut walk = Walk { frames: Vec::new() };
    let code: Vec<&Token<'_>> = tokens[start..].iter().filter(|t| !t.is_comment()).collect();
    for (at, token) in code.iter().enumerate() {
        // The word at the cursor is still being written.
        let unfinished = at + 1 == code.len() && token.end == text.len() && token.kind == Kind::Word;
        if !unfinished {
            walk.step(token, at.checked_sub(1).map(|i| code[i]), code.get(at + 1).copied());
        }
    }
    let behind = text.get(last.end..).unwrap_or("");
    if !walk.is_inside() && behind.contains('\n') && !ends_open(last.text) {
        return None;
    }
    walk.frames.iter().rev().find_map(|frame| match frame {
        Frame::Form(form, part) => Some((*form, *part)),
        Frame::Open(_) => None,
    })
}

/// Whether something must follow a token, so that a form goes on in the next line.
fn ends_open(token: &str) -> bool {
    matches!(token, "," | ".." | "radius" | "norm" | "in" | "at" | "=" | ":")
        || forms::FORMS.iter().any(|form| form.word == token)
}

/// The way through the tokens of a declaration.
struct Walk {
    frames: Vec<Frame>,
}

impl Walk {
    fn step(&mut self, token: &Token<'_>, before: Option<&Token<'_>>, next: Option<&Token<'_>>) {
        match token.text {
            "(" | "[" | "{" => self.open(token.text, before),
            ")" | "]" | "}" => self.close(token.text),
            "," => self.comma(),
            "or" => self.end_shape(),
            _ if token.kind == Kind::Word => self.word(token.text, next),
            _ => {}
        }
        self.advance(token);
    }

    /// A word that begins a form; what came before in the same brackets is over.
    fn word(&mut self, word: &str, next: Option<&Token<'_>>) {
        let is_begin = form(word, false).is_some_and(|form| form.ends != Ends::WithBracket);
        // Names may be words of the language: `box` is one where a point follows or nothing yet.
        let names = next.is_some_and(|t| t.is("=") || t.is(":") || t.is("in") && word != "where");
        let is_item = words::DYNAMICS_ITEMS.contains(&word) || words::CONNECTIVITY_ITEMS.contains(&word);
        if is_begin && !names || is_item && matches!(self.frames.last(), Some(Frame::Form(..))) {
            while let Some(Frame::Form(form, _)) = self.frames.last() {
                // A declaration goes on behind the forms inside it.
                if form.ends == Ends::Declaration && !is_item {
                    break;
                }
                self.frames.pop();
            }
        }
        if let Some(form) = form(word, false).filter(|f| f.ends != Ends::WithBracket && !names) {
            self.frames.push(Frame::Form(form, 0));
        }
    }

    fn open(&mut self, bracket: &str, before: Option<&Token<'_>>) {
        let called = before.filter(|t| t.kind == Kind::Word).and_then(|t| form(t.text, bracket == "["));
        if let Some(form) = called.filter(|form| form.ends == Ends::WithBracket) {
            self.frames.push(Frame::Form(form, 0));
        }
        self.frames.push(Frame::Open(match bracket {
            "(" => ")",
            "[" => "]",
            _ => "}",
        }));
    }

    /// Closes the innermost bracket, with the forms in it and the one that ends with it.
    fn close(&mut self, bracket: &str) {
        if !self.frames.iter().any(|f| matches!(f, Frame::Open(end) if *end == bracket)) {
            return;
        }
        while let Some(frame) = self.frames.pop() {
            if matches!(frame, Frame::Open(end) if end == bracket) {
                break;
            }
        }
        if let Some(Frame::Form(form, part)) = self.frames.last() {
            let last = form.count() - 1;
            let over = match form.ends {
                Ends::WithBracket => true,
                Ends::AfterLast => *part == last,
                Ends::Declaration => *part == last,
                Ends::Open => false,
            };
            if over {
                self.frames.pop();
            }
        }
    }

    fn comma(&mut self) {
        let place = match self.frames.last() {
            Some(Frame::Open(_)) => self.frames.len().checked_sub(2),
            Some(Frame::Form(..)) => self.frames.len().checked_sub(1),
            None => None,
        };
        let inside = matches!(self.frames.last(), Some(Frame::Open(_)));
        if let Some(Frame::Form(form, part)) = place.and_then(|place| self.frames.get_mut(place))
            && form.counts_commas(inside, *part)
        {
            *part = (*part + 1).min(form.count() - 1);
        }
    }

    fn end_shape(&mut self) {
        if matches!(self.frames.last(), Some(Frame::Form(form, _)) if words::SHAPES.contains(&form.word)) {
            self.frames.pop();
        }
    }

    /// Whether the end of the text stands in a bracket.
    fn is_inside(&self) -> bool {
        self.frames.iter().any(|frame| matches!(frame, Frame::Open(_)))
            && matches!(self.frames.last(), Some(Frame::Open(_)))
    }

    /// Goes on to the part that a token begins, in the innermost form.
    fn advance(&mut self, token: &Token<'_>) {
        let inner = self.frames.iter().rposition(|frame| matches!(frame, Frame::Form(..)));
        let Some(Frame::Form(form, part)) = inner.and_then(|at| self.frames.get_mut(at)) else { return };
        if let Some(later) = form.part_behind(token.text, *part) {
            *part = later;
        }
        let is_over = form.ends == Ends::AfterLast && form.word != "box" && token.kind == Kind::Unit;
        let is_last = *part == form.count() - 1;
        if (is_over && is_last) || (form.over_behind == Some(token.text)) {
            self.frames.truncate(inner.unwrap_or(0));
        }
    }
}

/// A form as an editor shows it.
fn shown(form: &Form, space: bool) -> SignatureInformation {
    let (mut label, mut parameters) = (String::new(), Vec::new());
    for part in form.parts {
        let (text, meaning) = match part {
            Part::Sign(text) => (*text, None),
            Part::Place(text, meaning) => (*text, Some(*meaning)),
        };
        // Points have one coordinate more in space.
        let text = if space { in_space(text) } else { text.to_string() };
        let start = label.encode_utf16().count() as u32;
        label += &text;
        if let Some(meaning) = meaning {
            parameters.push(ParameterInformation {
                label: ParameterLabel::LabelOffsets([start, label.encode_utf16().count() as u32]),
                documentation: Some(markdown(meaning)),
            });
        }
    }
    SignatureInformation {
        label,
        documentation: crate::syntax::glossary::entry(form.word).map(|entry| markdown(entry.meaning)),
        parameters: Some(parameters),
        active_parameter: None,
    }
}

fn in_space(text: &str) -> String {
    [("x0, y0", "x0, y0, z0"), ("x1, y1", "x1, y1, z1"), ("x2, y2", "x2, y2, z2"), ("x, y", "x, y, z")]
        .iter()
        .fold(text.to_string(), |text, (plane, space)| {
            text.replace(&format!("({plane})"), &format!("({space})"))
        })
}

fn markdown(text: &str) -> Documentation {
    Documentation::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value: text.to_string() })
}
