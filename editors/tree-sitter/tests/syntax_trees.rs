//! The trees of `test/corpus`: each case is a text and the tree that it has.
//!
//! The form is that of `tree-sitter test`, which runs these files as well: a title between lines of `=`, perhaps
//! with `:error` (the text has to be refused), the text, a line of `-`, the tree. `DOSMC_UPDATE=1` writes the
//! trees anew; read them.

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use common::{parse, shown};

/// A case of a file.
struct Case {
    title: String,
    attributes: Vec<String>,
    text: String,
    tree: String,
}

impl Case {
    fn is_refused(&self) -> bool {
        self.attributes.iter().any(|a| a == ":error")
    }

    /// The case as it stands in its file.
    fn written(&self) -> String {
        let bar = "=".repeat(20);
        let attributes: String = self.attributes.iter().map(|a| format!("{a}\n")).collect();
        let tree = if self.tree.is_empty() { String::new() } else { format!("\n{}\n", self.tree) };
        format!("{bar}\n{}\n{attributes}{bar}\n{}\n---\n{tree}", self.title, self.text)
    }
}

fn is_bar(line: &str, sign: char, least: usize) -> bool {
    line.len() >= least && line.chars().all(|c| c == sign)
}

/// The cases of a file.
fn cases(text: &str) -> Vec<Case> {
    let mut cases = Vec::new();
    let mut lines = text.lines().peekable();
    while lines.next_if(|line| !is_bar(line, '=', 3)).is_some() {}
    while lines.next().is_some() {
        let mut head = Vec::new();
        while let Some(line) = lines.next_if(|line| !is_bar(line, '=', 3)) {
            head.push(line.to_owned());
        }
        lines.next();
        let mut take_until = |sign: char| {
            let mut part = String::new();
            while let Some(line) = lines.next_if(|line| !is_bar(line, sign, 3)) {
                part.push_str(line);
                part.push('\n');
            }
            part
        };
        let text = take_until('-');
        let text = text.strip_suffix('\n').unwrap_or(&text).to_owned();
        let tree = take_until('=');
        let tree = tree.trim_start_matches("---").trim().to_owned();
        let title = head.remove(0);
        cases.push(Case { title, attributes: head, text, tree });
    }
    cases
}

/// The files with cases.
fn files() -> Vec<PathBuf> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("test/corpus");
    let entries = fs::read_dir(directory).expect("the corpus");
    let mut files: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    files.sort();
    files
}

#[test]
fn every_text_has_its_tree() {
    let update = std::env::var_os("DOSMC_UPDATE").is_some();
    let (mut wrong, mut count) = (String::new(), 0);
    for file in files() {
        let mut cases = cases(&fs::read_to_string(&file).expect("a text file"));
        for case in &mut cases {
            count += 1;
            let tree = parse(&case.text);
            let refused = tree.root_node().has_error();
            assert_eq!(refused, case.is_refused(), "{}\n{}", case.title, shown(tree.root_node()));
            let fresh = if refused { String::new() } else { shown(tree.root_node()) };
            if fresh.split_whitespace().ne(case.tree.split_whitespace()) {
                wrong.push_str(&format!("{}\n{fresh}\ninstead of\n{}\n", case.title, case.tree));
            }
            case.tree = fresh;
        }
        if update {
            let texts: Vec<_> = cases.iter().map(Case::written).collect();
            fs::write(&file, texts.join("\n")).expect("it can be written");
        }
    }
    assert!(count > 50, "only {count} cases");
    assert!(update || wrong.is_empty(), "{wrong}");
}
