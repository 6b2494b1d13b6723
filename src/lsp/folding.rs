//! What an editor may fold: blocks, tables, declarations and comments of several lines, and regions.
//!
//! All of it comes from the tokens, so that it stays while a mission can't be read.

use std::collections::BTreeMap;

use lsp_types::{FoldingRange, FoldingRangeKind};

use super::document::Document;
use crate::syntax::token::{Kind, Token, tokens};
use crate::syntax::words::DECLARATIONS;

/// Lines that fold, from and up to.
type Fold = (u32, u32, Option<FoldingRangeKind>);

/// The folds of a document, in the order of their first lines; one a line.
pub fn folds(document: &Document) -> Vec<FoldingRange> {
    let tokens = tokens(&document.source.text);
    let line = |offset: usize| document.lines.position(offset as u32).line;
    let mut folds = brackets(&tokens, &line);
    folds.extend(declarations(&tokens, &line));
    folds.extend(comments(&tokens, &line));
    folds.extend(regions(&tokens, &line));
    let mut first: BTreeMap<u32, Fold> = BTreeMap::new();
    for fold in folds.into_iter().filter(|fold| fold.1 > fold.0) {
        let widest = first.entry(fold.0).or_insert_with(|| fold.clone());
        if fold.1 > widest.1 {
            *widest = fold;
        }
    }
    let range = |(start_line, end_line, kind): Fold| FoldingRange {
        start_line,
        end_line,
        kind,
        ..FoldingRange::default()
    };
    first.into_values().map(range).collect()
}

/// What stands in brackets; the line of the closing one stays, where it begins with it.
fn brackets(tokens: &[Token<'_>], line: &impl Fn(usize) -> u32) -> Vec<Fold> {
    let (mut open, mut folds) = (Vec::new(), Vec::new());
    for token in tokens.iter().filter(|token| token.kind == Kind::Sign) {
        match token.text {
            "(" | "[" | "{" => open.push((token.text, line(token.start))),
            ")" | "]" | "}" => {
                let partner = match token.text {
                    ")" => "(",
                    "]" => "[",
                    _ => "{",
                };
                // Brackets without a partner are passed over.
                let Some(at) = open.iter().rposition(|(sign, _)| *sign == partner) else { continue };
                let from = open[at].1;
                open.truncate(at);
                let up_to = line(token.start);
                folds.push((
                    from,
                    if token.lines_before > 0 { up_to.saturating_sub(1) } else { up_to },
                    None,
                ));
            }
            _ => {}
        }
    }
    folds
}

/// Declarations from their first word to the last token before what comes next.
fn declarations(tokens: &[Token<'_>], line: &impl Fn(usize) -> u32) -> Vec<Fold> {
    let mut folds = Vec::new();
    let mut begun: Option<(usize, usize)> = None;
    for token in tokens.iter().filter(|token| !token.is_comment()) {
        if token.kind == Kind::Word && DECLARATIONS.contains(&token.text) {
            folds.extend(begun.map(|(from, to)| (line(from), line(to), None)));
            begun = Some((token.start, token.end));
        } else if let Some((_, end)) = &mut begun {
            // A brace at the beginning of a line stays, as for blocks.
            *end = if token.is("}") && token.lines_before > 0 { *end } else { token.end };
        }
    }
    folds.extend(begun.map(|(from, to)| (line(from), line(to), None)));
    folds
}

/// Comments of several lines, and comments on lines of their own one below the other.
fn comments(tokens: &[Token<'_>], line: &impl Fn(usize) -> u32) -> Vec<Fold> {
    let mut folds = Vec::new();
    let mut run: Option<(u32, u32)> = None;
    let close = |run: &mut Option<(u32, u32)>, folds: &mut Vec<Fold>| {
        folds.extend(run.take().map(|(from, to)| (from, to, Some(FoldingRangeKind::Comment))));
    };
    for (at, token) in tokens.iter().enumerate() {
        let is_alone = at == 0 || token.lines_before > 0;
        match token.kind {
            Kind::BlockComment => {
                close(&mut run, &mut folds);
                folds.push((line(token.start), line(token.end), Some(FoldingRangeKind::Comment)));
            }
            Kind::LineComment | Kind::Doc if is_alone && marker(token).is_none() => {
                let here = line(token.start);
                match &mut run {
                    Some((_, last)) if *last + 1 == here => *last = here,
                    _ => {
                        close(&mut run, &mut folds);
                        run = Some((here, here));
                    }
                }
            }
            _ => close(&mut run, &mut folds),
        }
    }
    close(&mut run, &mut folds);
    folds
}

/// `// region …` to `// endregion`, which nest.
fn regions(tokens: &[Token<'_>], line: &impl Fn(usize) -> u32) -> Vec<Fold> {
    let (mut open, mut folds) = (Vec::new(), Vec::new());
    for token in tokens {
        match marker(token) {
            Some(true) => open.push(line(token.start)),
            Some(false) => {
                let from = open.pop();
                folds.extend(from.map(|from| (from, line(token.start), Some(FoldingRangeKind::Region))));
            }
            None => {}
        }
    }
    folds
}

/// Whether a comment begins a region (`true`) or ends one (`false`).
fn marker(token: &Token<'_>) -> Option<bool> {
    let text = token.text.strip_prefix("//").filter(|_| token.kind == Kind::LineComment)?;
    let word = text.trim_start().trim_start_matches('#').split_whitespace().next()?;
    match word {
        "region" => Some(true),
        "endregion" => Some(false),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::driver::Overrides;
    use crate::lsp::lines::Encoding;

    #[track_caller]
    fn check(text: &str, expected: &[(u32, u32, &str)]) {
        let uri = "file:///tmp/m.dosm".parse().expect("it is a URI");
        let document = Document::new(uri, 1, text.into(), Encoding::Utf16, Overrides::default());
        let folds: Vec<(u32, u32, &str)> = folds(&document)
            .iter()
            .map(|f| {
                let kind = match f.kind {
                    Some(FoldingRangeKind::Comment) => "comment",
                    Some(FoldingRangeKind::Region) => "region",
                    _ => "",
                };
                (f.start_line, f.end_line, kind)
            })
            .collect();
        assert_eq!(folds, expected, "{text}");
    }

    #[test]
    fn blocks_and_tables_fold_up_to_their_last_line() {
        check("dynamics D {\n  step 1 s\n}\n", &[(0, 1, "")]);
        check("dynamics D {\n  A = [1, 2;\n       3, 4]\n  step 1 s }", &[(0, 3, ""), (1, 2, "")]);
        check("dynamics D\n{\n  step 1 s\n}", &[(0, 2, ""), (1, 2, "")]);
        check("dynamics D { step 1 s }", &[]);
        check("goal g: R1 in a\n  and R1 in b\n\n// c\ngoal h: true", &[(0, 1, "")]);
        check("region a = box (0, 0) ) .. \n (1, 1", &[(0, 1, "")]);
    }

    #[test]
    fn comments_fold() {
        check("/* a\n b */ dosm 1", &[(0, 1, "comment")]);
        check("// a\n// b\n/// c\nregion a = box", &[(0, 2, "comment")]);
        check("// a\n\n// b", &[]);
        check("let a = 1 // a\n// b", &[]);
        check("let a = 1\n// a\n// b\nlet b = 2", &[(1, 2, "comment")]);
    }

    #[test]
    fn regions_fold_and_nest() {
        check(
            "// region a\nlet a = 1\n// #region b\nlet b = 1\n//endregion\n// endregion a",
            &[(0, 5, "region"), (2, 4, "region")],
        );
        check("// endregion\n// region\nlet a = 1", &[]);
        check("// regional matters\n// and more", &[(0, 1, "comment")]);
    }
}
