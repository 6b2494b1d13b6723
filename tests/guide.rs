//! The language guide, `docs/language.md`: each block of code in it is run.
//!
//! What a block is for stands behind its language: `append=FILE` adds to a mission, `file=FILE` is a
//! whole one, `frame=NAME` is put into the mission that `frame-is=NAME` shows (`formula` is `plane`
//! with a goal around it), `wrong=CODE` must give just this error and `warns=CODE` just this warning.
//! A `console` block has a command and what it prints; `DOSMC_UPDATE=1 cargo test --test guide`
//! writes the outputs, and the tutorial's picture, anew.

#![allow(clippy::disallowed_methods, reason = "runs the command on what the guide says")]

mod common;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::Command;

use dosmc::diag::render::{Style, render};
use dosmc::diag::{Diagnostic, Diagnostics, Severity};
use dosmc::driver::{self, Overrides};
use dosmc::source::SourceFile;

use common::package;

const GUIDE: &str = "docs/language.md";
/// Where a frame takes its fragment.
const HERE: &str = "// HERE\n";

/// A fenced block.
struct Block<'a> {
    /// The line that its fence stands in, from 1.
    line: usize,
    /// The words behind the fence.
    words: Vec<&'a str>,
    /// What is inside.
    text: &'a str,
}

impl Block<'_> {
    fn is(&self, language: &str) -> bool {
        self.words.first() == Some(&language)
    }

    /// The value of `KEY=VALUE`.
    fn value(&self, key: &str) -> Option<&str> {
        self.words.iter().find_map(|word| word.strip_prefix(key)?.strip_prefix('='))
    }
}

fn guide() -> String {
    fs::read_to_string(package(GUIDE)).expect("the guide")
}

/// The blocks of a text, in order.
fn blocks(text: &str) -> Vec<Block<'_>> {
    let mut found = Vec::new();
    let mut open: Option<(usize, Vec<&str>, usize)> = None;
    let mut offset = 0;
    for (index, line) in text.split_inclusive('\n').enumerate() {
        let start = offset;
        offset += line.len();
        let Some(rest) = line.strip_prefix("```") else { continue };
        match open.take() {
            Some((line, words, from)) => found.push(Block { line, words, text: &text[from..start] }),
            None => open = Some((index + 1, rest.split_whitespace().collect(), offset)),
        }
    }
    assert!(open.is_none(), "a fence is open at the end");
    found
}

/// The missions that fragments are put into.
fn frames(blocks: &[Block]) -> BTreeMap<String, String> {
    let named = |block: &Block| Some((block.value("frame-is")?.to_string(), block.text.to_string()));
    let mut frames: BTreeMap<String, String> = blocks.iter().filter_map(named).collect();
    let goal = frames["plane"].replace(HERE, &format!("goal example:\n{HERE}"));
    frames.insert("formula".into(), goal);
    frames
}

/// What is said about a mission, unused names aside.
fn said(text: &str) -> (String, Vec<Diagnostic>) {
    let source = SourceFile::new("guide.dosm", text);
    let mut diagnostics = Diagnostics::new();
    let _ = driver::load(&source, &Overrides::default(), &mut diagnostics);
    let all = diagnostics.sorted().into_iter().filter(|d| d.code != "dosm::check::unused");
    let all: Vec<Diagnostic> = all.cloned().collect();
    (render(&source, &all, Style::PLAIN), all)
}

#[test]
fn each_fragment_is_right_or_wrong_as_it_says() {
    let text = guide();
    let blocks = blocks(&text);
    let frames = frames(&blocks);
    let (mut right, mut wrong) = (0, 0);
    for block in blocks.iter().filter(|block| block.is("dosm") && block.value("append").is_none()) {
        let mission = match block.value("frame") {
            Some(name) => {
                let frame =
                    frames.get(name).unwrap_or_else(|| panic!("line {}: no frame {name}", block.line));
                assert_eq!(frame.matches(HERE).count(), 1, "{name}");
                frame.replace(HERE, block.text)
            }
            None => {
                let whole = block.value("file").is_some() || block.value("frame-is").is_some();
                assert!(whole, "line {}: nothing says what to do with it", block.line);
                if block.value("frame-is") == Some("model") {
                    continue;
                }
                block.text.to_string()
            }
        };
        let (shown, found) = said(&mission);
        let codes: BTreeSet<&str> = found.iter().map(|d| d.code.trim_start_matches("dosm::")).collect();
        let expected = block.value("wrong").or(block.value("warns"));
        assert_eq!(codes, expected.into_iter().collect(), "line {}:\n{shown}", block.line);
        let errors = found.iter().any(|d| d.severity == Severity::Error);
        assert_eq!(errors, block.value("wrong").is_some(), "line {}:\n{shown}", block.line);
        if errors { wrong += 1 } else { right += 1 }
    }
    assert!(right > 30 && wrong > 30, "{right} right, {wrong} wrong");
}

/// The guide with what its commands print today.
fn retold(text: &str) -> String {
    let directory = tempfile::tempdir().expect("a directory");
    let mut missions: BTreeMap<String, String> = BTreeMap::new();
    let mut told = text.to_string();
    for block in blocks(text) {
        if let Some(name) = block.value("append") {
            let mission = missions.entry(name.to_string()).or_default();
            if !mission.is_empty() {
                mission.push('\n');
            }
            mission.push_str(block.text);
            fs::write(directory.path().join(name), mission).expect("it can be written");
        }
        if block.is("console") {
            let command = block.text.lines().next().unwrap_or_default();
            let args: Vec<&str> = command.split_whitespace().skip(2).collect();
            assert!(command.starts_with("$ dosmc "), "line {}: {command}", block.line);
            let new = format!("{command}\n{}", printed(directory.path(), &args));
            told = replaced(&told, block.line, &new);
        }
    }
    draw(directory.path());
    told
}

/// The text with another inside of its `console` block that begins with the same command and stands in
/// the same place among those that do.
fn replaced(text: &str, line: usize, new: &str) -> String {
    let original = guide();
    let nth = blocks(&original).iter().filter(|b| b.is("console") && b.line < line).count();
    let all = blocks(text);
    let block = all.iter().filter(|b| b.is("console")).nth(nth).expect("the same blocks");
    let start = block.text.as_ptr() as usize - text.as_ptr() as usize;
    format!("{}{new}{}", &text[..start], &text[start + block.text.len()..])
}

/// What a command prints, to either stream, in order.
fn printed(directory: &Path, args: &[&str]) -> String {
    let (mut reader, writer) = std::io::pipe().expect("a pipe");
    let mut command = Command::new(env!("CARGO_BIN_EXE_dosmc"));
    command.current_dir(directory).args(args).stderr(writer.try_clone().expect("a pipe")).stdout(writer);
    let mut child = command.spawn().expect("it runs");
    // The writing ends belong to the command now.
    drop(command);
    let mut text = String::new();
    reader.read_to_string(&mut text).expect("UTF-8");
    child.wait().expect("it ends");
    text
}

/// Compares the tutorial's picture with the one that is checked in, or draws it anew.
fn draw(directory: &Path) {
    let drawn = fs::read_to_string(directory.join("out/plan.svg")).expect("the tutorial draws a plan");
    let path = package("docs/tutorial.svg");
    if std::env::var_os("DOSMC_UPDATE").is_some() {
        fs::write(&path, &drawn).expect("it can be written");
    }
    let kept = fs::read_to_string(&path).unwrap_or_default();
    assert!(kept == drawn, "docs/tutorial.svg is not what is drawn today; DOSMC_UPDATE=1 draws it anew");
}

#[test]
fn each_command_prints_what_is_shown() {
    let text = guide();
    let told = retold(&text);
    if std::env::var_os("DOSMC_UPDATE").is_some() {
        fs::write(package(GUIDE), &told).expect("it can be written");
        return;
    }
    for (number, (shown, printed)) in text.lines().zip(told.lines()).enumerate() {
        assert_eq!(
            discrete(shown),
            discrete(printed),
            "line {} of {GUIDE}; DOSMC_UPDATE=1 writes it anew",
            number + 1
        );
    }
    assert_eq!(text.lines().count(), told.lines().count());
}

/// A line without what may differ from machine to machine: how much `verify` found to check, and margins.
fn discrete(line: &str) -> &str {
    line.find(" ok  ").filter(|_| line.contains(" checked")).map_or(line, |end| &line[..end + 4])
}

#[test]
fn links_lead_somewhere_and_wrong_blocks_have_their_page() {
    let text = guide();
    let targets: BTreeSet<&str> =
        text.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next()).collect();
    for target in targets.iter().filter(|target| !target.is_empty()) {
        assert!(package("docs").join(target).exists(), "{target}");
    }
    for block in blocks(&text) {
        for code in [block.value("wrong"), block.value("warns")].into_iter().flatten() {
            let page = format!("codes/{}.md", code.replace("::", "/"));
            assert!(targets.contains(page.as_str()), "line {}: {page} is linked nowhere", block.line);
        }
    }
}

/// Every word of the grammar stands in some block.
#[test]
fn every_word_of_the_language_is_shown() {
    let grammar = fs::read_to_string(package("grammar/dosm.pest")).expect("the grammar");
    let words: BTreeSet<&str> = grammar
        .lines()
        .filter_map(|line| line.strip_prefix("kw_")?.split_once(['"'])?.1.split('"').next())
        .collect();
    assert!(words.len() > 50, "{words:?}");
    let text = guide();
    let shown: BTreeSet<&str> = blocks(&text)
        .iter()
        .filter(|block| block.is("dosm"))
        .flat_map(|block| block.text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_'))
        .collect();
    let missing: Vec<&&str> = words.iter().filter(|word| !shown.contains(**word)).collect();
    assert!(missing.is_empty(), "no block shows {missing:?}");
}
