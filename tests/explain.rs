//! The pages of `dosmc explain`: every code has one, and each page's missions do what it says.

#![allow(clippy::disallowed_methods, reason = "reads the sources and runs the command")]

mod common;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::Arc;

use dosmc::diag::{Diagnostic, Diagnostics};
use dosmc::driver::{self, Answer, Overrides};
use dosmc::explain::{PAGES, Page};
use dosmc::solve::Watch;
use dosmc::source::SourceFile;
use serde_json::Value;

use common::Patient;

/// Codes that no mission of a page can show, and why.
const WITHOUT_MISSION: [(&str, &str); 21] = [
    ("dosm::check::misplaced_table", "behind the parser, which refuses it first"),
    ("dosm::check::set_value", "comes from the command line"),
    ("dosm::check::unknown_param", "comes from the command line"),
    ("dosm::check::unknown_unit", "behind the parser, which refuses it first"),
    ("dosm::cli::bad_name", "comes from the command line"),
    ("dosm::cli::too_large", "takes too long to show"),
    ("dosm::cli::unknown_code", "comes from the command line"),
    ("dosm::cli::unreadable", "is about files"),
    ("dosm::cli::unwritable", "is about files"),
    ("dosm::cli::usage", "comes from the command line"),
    ("dosm::controller::rounding", "is about plans"),
    ("dosm::ir::invalid", "a bug by definition"),
    ("dosm::plan::malformed", "is about plans"),
    ("dosm::smc::altered", "is about instances"),
    ("dosm::smc::malformed", "is about instances"),
    ("dosm::syntax::not_utf8", "a page is text"),
    ("dosm::syntax::number_too_long", "takes 4,001 digits"),
    ("dosm::syntax::text_too_long", "takes 64 MiB"),
    ("dosm::syntax::too_deep", "takes 2,001 levels"),
    ("dosm::syntax::too_many_errors", "takes 501 errors"),
    ("dosm::syntax::too_nested", "takes 257 brackets"),
];

const WITH_MISSION: [&str; 4] =
    ["What it means", "Why it matters", "A mission that shows it", "The mended mission"];
const OTHERWISE: [&str; 4] = ["What it means", "Why it matters", "How it comes about", "What to do"];
const SEE_ALSO: &str = "See also";

/// The longest page and the longest line in a fence.
const MOST_LINES: usize = 80;
const MOST_COLUMNS: usize = 100;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn has_mission(page: &Page) -> bool {
    WITHOUT_MISSION.iter().all(|(code, _)| *code != page.code)
}

/// All files below a directory.
fn files(directory: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(directory).expect("a directory of the package") {
        let path = entry.expect("an entry").path();
        if path.is_dir() { found.extend(files(&path)) } else { found.push(path) }
    }
    found
}

/// The codes that stand between quotation marks in the sources, unit tests left out.
fn declared() -> BTreeSet<String> {
    let mut codes = BTreeSet::new();
    for path in files(&root().join("src")).iter().filter(|p| p.extension().is_some_and(|e| e == "rs")) {
        let text = fs::read_to_string(path).expect("a text");
        let product = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
        for rest in product.split("\"dosm::").skip(1) {
            let code = rest.split('"').next().unwrap_or_default();
            let part = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_' || c == ':';
            if code.matches("::").count() == 1 && !code.ends_with(':') && code.chars().all(part) {
                codes.insert(format!("dosm::{code}"));
            }
        }
    }
    codes
}

/// A page's headings with what stands below each; the title comes first.
fn sections(page: &Page) -> Vec<(&'static str, String)> {
    let mut sections: Vec<(&str, String)> = Vec::new();
    let mut fenced = false;
    for line in page.text.lines() {
        fenced ^= line.starts_with("```");
        match line.strip_prefix('#').filter(|_| !fenced) {
            Some(heading) => sections.push((heading.trim_start_matches(['#', ' ']), String::new())),
            None => {
                let (_, text) = sections.last_mut().expect("the title comes first");
                text.push_str(line);
                text.push('\n');
            }
        }
    }
    sections
}

fn section(page: &Page, heading: &str) -> String {
    sections(page).into_iter().find(|(h, _)| *h == heading).expect("it was looked for before").1
}

/// The missions in a text, from ```` ```dosm ```` to ```` ``` ````.
fn missions(text: &str) -> Vec<String> {
    text.split("```dosm\n").skip(1).map(|rest| rest.split("```").next().unwrap_or_default().into()).collect()
}

/// What is said about a mission.
fn said(mission: &str) -> Vec<Diagnostic> {
    let mut diagnostics = Diagnostics::new();
    let _ = driver::load(&SourceFile::new("mission.dosm", mission), &Overrides::default(), &mut diagnostics);
    diagnostics.iter().cloned().collect()
}

/// The codes in backticks in a text.
fn named(text: &str) -> Vec<&str> {
    text.split('`').filter(|part| part.starts_with("dosm::") && !part.contains(' ')).collect()
}

/// Fails with everything that is wrong.
fn assert_none(wrong: Vec<String>) {
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_code_has_a_page_and_every_page_a_code() {
    let declared = declared();
    let explained: BTreeSet<String> = PAGES.iter().map(|page| page.code.to_string()).collect();
    let on_disk: BTreeSet<String> = files(&root().join("docs/codes"))
        .iter()
        .map(|path| {
            let stem = path.with_extension("");
            let parts = stem.iter().rev().take(2).map(|part| part.to_string_lossy()).collect::<Vec<_>>();
            format!("dosm::{}::{}", parts[1], parts[0])
        })
        .collect();
    assert!(declared.len() > 100, "the scanner sees only {declared:?}");
    assert_eq!(explained, on_disk, "src/explain/mod.rs lists other pages than docs/codes holds");
    let without: Vec<_> = declared.difference(&explained).collect();
    let gone: Vec<_> = explained.difference(&declared).collect();
    assert!(without.is_empty() && gone.is_empty(), "no page: {without:#?}\nno code: {gone:#?}");
    assert!(PAGES.is_sorted_by_key(|page| page.code), "the list is printed as it stands");
}

#[test]
fn pages_have_their_sections_in_order() {
    let mut wrong = Vec::new();
    for page in PAGES {
        let mut headings: Vec<&str> = sections(page).into_iter().map(|(heading, _)| heading).collect();
        let title = format!("`{}`: ", page.code);
        if !headings.remove(0).starts_with(&title) || page.headline().is_empty() {
            wrong.push(format!("{}: the title is no `# {title}HEADLINE`", page.code));
        }
        let expected = if has_mission(page) { WITH_MISSION } else { OTHERWISE };
        headings.pop_if(|last| *last == SEE_ALSO);
        if headings != expected {
            wrong.push(format!("{}: {headings:?}", page.code));
        }
        let empty = sections(page).into_iter().skip(1).find(|(_, text)| text.trim().is_empty());
        wrong.extend(empty.map(|(heading, _)| format!("{}: nothing below `{heading}`", page.code)));
    }
    assert_none(wrong);
}

#[test]
fn pages_are_short_and_plain() {
    let mut wrong = Vec::new();
    for page in PAGES {
        let (mut fenced, mut note) = (false, |what: &str| wrong.push(format!("{}: {what}", page.code)));
        if page.text.lines().count() > MOST_LINES {
            note("too long");
        }
        for line in page.text.lines() {
            fenced ^= line.starts_with("```");
            if fenced && line.chars().count() > MOST_COLUMNS {
                note(&format!("a line that is cut on a terminal: {line}"));
            }
            // What `explain` does not draw.
            let odd = ["**", "](", "| ", "<br", "\t"].iter().find(|odd| line.contains(**odd));
            if let Some(odd) = odd.filter(|_| !fenced) {
                note(&format!("`{odd}` in: {line}"));
            }
            let marks = line.matches('`').count();
            if !fenced && !line.starts_with("```") && marks % 2 == 1 {
                note(&format!("code over the end of a line: {line}"));
            }
        }
        if fenced || !page.text.ends_with('\n') {
            note("a fence or the last line does not end");
        }
    }
    assert_none(wrong);
}

#[test]
fn each_mission_shown_gives_its_code_and_nothing_else() {
    let mut wrong = Vec::new();
    for page in PAGES.iter().filter(|page| has_mission(page)) {
        let shown = missions(&section(page, WITH_MISSION[2]));
        if shown.len() != 1 {
            wrong.push(format!("{}: {} missions", page.code, shown.len()));
        }
        let codes: BTreeSet<&str> = shown.iter().flat_map(|m| said(m)).map(|d| d.code).collect();
        if codes != BTreeSet::from([page.code]) {
            wrong.push(format!("{}: {codes:?}", page.code));
        }
    }
    assert_none(wrong);
}

#[test]
fn nothing_is_said_about_mended_missions() {
    let mut wrong = Vec::new();
    for page in PAGES.iter().filter(|page| has_mission(page)) {
        let mended = missions(&section(page, WITH_MISSION[3]));
        if mended.len() != 1 {
            wrong.push(format!("{}: {} missions", page.code, mended.len()));
        }
        let messages = mended.iter().flat_map(|m| said(m)).map(|d| format!("{}: {}", d.code, d.message));
        wrong.extend(messages.map(|message| format!("{}: {message}", page.code)));
    }
    assert_none(wrong);
}

#[test]
fn mended_missions_have_plans() {
    let watch: Arc<dyn Watch> = Arc::new(Patient);
    let mut wrong = Vec::new();
    for page in PAGES.iter().filter(|page| has_mission(page)) {
        for mission in missions(&section(page, WITH_MISSION[3])) {
            let source = SourceFile::new("mission.dosm", mission);
            // What is said about it is another test's business.
            let loaded = driver::load(&source, &Overrides::default(), &mut Diagnostics::new());
            let planned =
                loaded.map(|mission| matches!(driver::solve(&mission, &watch).answer, Answer::Plan { .. }));
            wrong.extend((planned != Ok(true)).then(|| format!("{}: no plan", page.code)));
        }
    }
    assert_none(wrong);
}

#[test]
fn codes_named_in_pages_have_pages() {
    let codes: BTreeSet<&str> = PAGES.iter().map(|page| page.code).collect();
    let known = |code: &&str| codes.contains(*code);
    for page in PAGES {
        let dangling: Vec<&str> = named(page.text).into_iter().filter(|code| !known(code)).collect();
        assert!(dangling.is_empty(), "{} names {dangling:?}", page.code);
    }
    let gone: Vec<&str> = WITHOUT_MISSION.iter().map(|(code, _)| *code).filter(|c| !known(c)).collect();
    assert!(gone.is_empty(), "excused, but no longer there: {gone:?}");
}

fn run(args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dosmc"));
    command.current_dir(root()).env_remove("NO_COLOR").env("TERM", "xterm").stdin(Stdio::null());
    command.args(args).output().expect("the command starts")
}

fn status(output: &Output) -> i32 {
    output.status.code().expect("it was not killed")
}

fn out(output: &Output) -> &str {
    std::str::from_utf8(&output.stdout).expect("UTF-8")
}

fn err(output: &Output) -> &str {
    std::str::from_utf8(&output.stderr).expect("UTF-8")
}

#[test]
fn a_page_is_printed_for_people_and_for_programs() {
    let long = run(&["explain", "dosm::check::duplicate"]);
    let short = run(&["explain", "Duplicate", "--quiet"]);
    assert_eq!((status(&long), out(&long)), (0, out(&short)));
    assert!(out(&long).starts_with("dosm::check::duplicate: "), "{}", out(&long));
    assert!(out(&long).contains("\n    dosm 1\n") && !out(&long).contains("```"));
    let painted = run(&["explain", "duplicate", "--color", "always"]);
    assert!(out(&painted).contains("\u{1b}[1mWhat it means\u{1b}[0m"));
    let value: Value =
        serde_json::from_slice(&run(&["explain", "duplicate", "--json"]).stdout).expect("JSON");
    let page = PAGES.iter().find(|page| page.code == "dosm::check::duplicate").expect("it is there");
    assert_eq!((&value["code"], &value["page"]), (&page.code.into(), &page.text.into()));
    assert_eq!(value["title"], page.headline());
}

#[test]
fn all_codes_are_listed() {
    let list = run(&["explain"]);
    assert_eq!((status(&list), out(&list).lines().count()), (0, PAGES.len()));
    let first = out(&list).lines().next().expect("a line");
    assert!(first.starts_with(PAGES[0].code) && first.ends_with(PAGES[0].headline()));
    let value: Value = serde_json::from_slice(&run(&["explain", "--json"]).stdout).expect("JSON");
    assert_eq!(value["codes"].as_array().map(Vec::len), Some(PAGES.len()));
    assert_eq!(value["codes"][0]["title"], PAGES[0].headline());
    let tubes = run(&["explain", "tube"]);
    assert!(status(&tubes) == 0 && out(&tubes).lines().all(|line| line.starts_with("dosm::tube::")));
}

#[test]
fn an_unknown_code_gets_the_nearest_ones() {
    let unknown = run(&["explain", "check::duplicat"]);
    assert_eq!((status(&unknown), out(&unknown)), (1, ""));
    assert!(err(&unknown).contains("did you mean `dosm::check::duplicate`"), "{}", err(&unknown));
    let two = run(&["explain", "unit_twice"]);
    assert_eq!(status(&two), 1);
    assert!(err(&two).contains("`dosm::check::unit_twice` or `dosm::syntax::unit_twice`"), "{}", err(&two));
    let hostile = run(&["explain", "\u{1b}[31m"]);
    assert!(status(&hostile) == 1 && !err(&hostile).contains('\u{1b}'));
}

#[test]
fn errors_point_to_their_page_once() {
    let wrong = "tests/missions/err/check_unknown_region.dosm";
    let line = "for more: dosmc explain dosm::check::unknown_region\n";
    let output = run(&["check", wrong, wrong]);
    assert!(
        err(&output).ends_with(line) && err(&output).matches("for more").count() == 1,
        "{}",
        err(&output)
    );
    for quiet in [&["check", wrong, "--quiet"][..], &["check", wrong, "--json"]] {
        assert!(!err(&run(quiet)).contains("for more"), "{quiet:?}");
    }
    for without in [&["explain", "xyzzy"][..], &["check", "no/such/file.dosm"]] {
        assert!(status(&run(without)) == 1 && !err(&run(without)).contains("for more"), "{without:?}");
    }
    let warned = run(&["check", "tests/missions/err/check_unused.dosm"]);
    assert!(err(&warned).contains("dosm::check::unused") && !err(&warned).contains("for more"));
}

/// Runs a tool of the system on a text; none when it isn't installed, which is said.
fn tool(program: &str, args: &[&str], file: &Path) -> Option<Output> {
    let output = Command::new(program).args(args).arg(file).output();
    if output.is_err() {
        common::skipped(&format!("`{program}` is not installed, so its part of this test did not run"));
    }
    output.ok()
}

#[test]
fn every_shell_gets_its_completions() {
    let dir = tempfile::tempdir().expect("a directory");
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let output = run(&["completions", shell]);
        assert_eq!(status(&output), 0);
        for word in ["dosmc", "solve", "explain", "timeout"] {
            assert!(out(&output).contains(word), "{shell}: no `{word}`");
        }
        let file = dir.path().join(shell);
        fs::write(&file, &output.stdout).expect("it can be written");
        if ["bash", "zsh", "fish"].contains(&shell)
            && let Some(parsed) = tool(shell, &["-n"], &file)
        {
            assert!(parsed.status.success(), "{shell}: {}", err(&parsed));
        }
    }
    assert_eq!(status(&run(&["completions", "tcsh"])), 1);
}

#[test]
fn the_manual_has_a_page_for_each_command() {
    let dir = tempfile::tempdir().expect("a directory");
    let place = dir.path().join("man");
    let output = run(&["man", "-o", place.to_str().expect("plain names")]);
    assert_eq!(status(&output), 0, "{}", err(&output));
    let help = run(&["--help"]);
    let commands = out(&help).split("Commands:\n").nth(1).and_then(|rest| rest.split("\n\n").next());
    let commands = commands
        .expect("the commands")
        .lines()
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let mut names: Vec<String> =
        commands.filter_map(|l| l.split_whitespace().next()).map(|c| format!("dosmc-{c}.1")).collect();
    names.push("dosmc.1".into());
    names.sort();
    let mut written: Vec<String> =
        files(&place).iter().filter_map(|p| Some(p.file_name()?.to_str()?.to_string())).collect();
    written.sort();
    assert!(names.len() > 6 && written == names, "{written:?} for {names:?}");
    let whole = fs::read_to_string(place.join("dosmc.1")).expect("it was written");
    assert_eq!(out(&run(&["man"])), whole);
    for name in names {
        let Some(set) = tool("groff", &["-man", "-Tutf8", "-ww", "-z"], &place.join(&name)) else { return };
        assert!(set.status.success() && set.stderr.is_empty(), "{name}: {}", err(&set));
    }
}
