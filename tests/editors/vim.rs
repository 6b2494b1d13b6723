//! The plug-in in Vim (`DOSMC_VIM`, or `vim`) and Neovim (`DOSMC_NVIM`, or `nvim`), both without a screen.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::{Value, json};

use crate::common::{missions, package, skipped};

/// An editor to ask.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Editor {
    /// Vim, of version 8.2 at least.
    Vim,
    /// Neovim, of version 0.7 at least.
    Neovim,
}

/// Both.
const EDITORS: [Editor; 2] = [Editor::Vim, Editor::Neovim];

impl Editor {
    /// Its program, if it runs; without it something is said.
    pub fn program(self) -> Option<String> {
        let (variable, usual) = match self {
            Editor::Vim => ("DOSMC_VIM", "vim"),
            Editor::Neovim => ("DOSMC_NVIM", "nvim"),
        };
        let program = std::env::var(variable).unwrap_or_else(|_| usual.to_owned());
        let mut version = Command::new(&program);
        version.arg("--version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        if version.status().is_ok_and(|status| status.success()) {
            return Some(program);
        }
        skipped(&format!("nothing was tested in {self:?}: there is no {usual} ({variable})"));
        None
    }

    /// A run of it that reads nobody's settings; `timeout` ends it should it wait for somebody.
    pub fn command(self, program: &str) -> Command {
        let mut command = Command::new("timeout");
        command.args(["--kill-after=5", "120", program]);
        match self {
            Editor::Vim => command.args(["-Nu", "NONE", "-i", "NONE", "-es"]),
            Editor::Neovim => command.args(["--headless", "-u", "NONE", "-i", "NONE"]),
        };
        command.env("DOSMC_PLUGIN", package("editors/vim")).env("LC_ALL", "C.UTF-8");
        command.current_dir(package("")).stdin(Stdio::null());
        command
    }
}

/// A place of this run's own for files.
pub fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("editors").join(name);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// Asks an editor; `None` if it isn't there.
fn ask(editor: Editor, name: &str, questions: &[Value]) -> Option<Vec<Value>> {
    let program = editor.program()?;
    let folder = scratch(&format!("{name}-{editor:?}"));
    let (asked, answered) = (folder.join("ask.json"), folder.join("answer.json"));
    fs::write(&asked, Value::from(questions).to_string()).expect("it can be written");
    let _ = fs::remove_file(&answered);
    let mut command = editor.command(&program);
    command.arg("-S").arg(package("tests/editors/vim/answer.vim"));
    let output = command.env("DOSMC_ASK", &asked).env("DOSMC_ANSWER", &answered).output().expect("it runs");
    let answer = fs::read_to_string(&answered).unwrap_or_else(|e| {
        panic!("{editor:?} gave no answer: {e}\n{}", String::from_utf8_lossy(&output.stderr))
    });
    let answer: Value = serde_json::from_str(&answer).expect("JSON");
    assert!(answer["error"].is_null(), "{editor:?}: {}", answer["error"]);
    let answers = answer["answers"].as_array().expect("answers").clone();
    assert_eq!(answers.len(), questions.len());
    Some(answers)
}

/// Where a token stands in a text, as line and column, each from 1: the one before which so many others come.
pub fn place(text: &str, token: &str, before: usize) -> (usize, usize) {
    let part = |c: Option<char>| c.is_some_and(|c| c.is_ascii_alphanumeric() || c == '_');
    let goes_on = |a: Option<char>, b: Option<char>| part(a) && part(b);
    let whole = |at: &usize| {
        let (left, right) = (text[..*at].chars().next_back(), text[at + token.len()..].chars().next());
        !goes_on(left, token.chars().next()) && !goes_on(token.chars().next_back(), right)
    };
    let mut places = text.match_indices(token).map(|(at, _)| at).filter(whole);
    let at = places.nth(before).unwrap_or_else(|| panic!("no `{token}` number {before}"));
    let line = text[..at].rfind('\n').map_or(0, |end| end + 1);
    (text[..at].matches('\n').count() + 1, at - line + 1)
}

const EVERYTHING: &str = "tests/missions/parse/everything.dosm";

/// Tokens of [`EVERYTHING`], how many of them come before, and their groups.
const GROUPS: [(&str, usize, &str); 52] = [
    ("//! Every", 0, "dosmDocComment"),
    ("/* Comments", 0, "dosmComment"),
    ("and are skipped", 0, "dosmComment"),
    ("//// Four", 0, "dosmComment"),
    ("/// A union", 0, "dosmDocComment"),
    ("dosm", 0, "dosmDeclaration"),
    ("1", 1, "dosmNumber"),
    ("everything", 0, "dosmName"),
    ("radius", 0, "dosmConstantName"),
    ("m", 0, "dosmUnit"),
    ("m/s", 0, "dosmUnit"),
    ("min", 0, "dosmUnit"),
    ("min", 1, "dosmFunction"),
    ("max", 0, "dosmFunction"),
    ("pi", 0, "dosmConstant"),
    ("deg", 0, "dosmUnit"),
    ("workspace", 0, "dosmDeclaration"),
    ("box", 0, "dosmShape"),
    ("box", 1, "dosmShape"),
    ("ball", 0, "dosmShape"),
    ("radius", 1, "dosmShapePart"),
    ("disc", 0, "dosmShape"),
    ("polygon", 0, "dosmShape"),
    ("where", 0, "dosmShape"),
    ("x", 0, "dosmCoordinate"),
    ("cell", 0, "dosmName"),
    ("in", 0, "dosmPreposition"),
    ("opaque", 0, "dosmDeclaration"),
    ("norm", 0, "dosmNorm"),
    ("±", 0, "dosmUncertainty"),
    ("home", 0, "dosmName"),
    ("Rover", 0, "dosmModelName"),
    ("step", 0, "dosmItem"),
    ("state", 0, "dosmItem"),
    ("/// How far east", 0, "dosmDocComment"),
    ("px", 0, "dosmIdentifier"),
    ("m", 14, "dosmUnit"),
    ("A", 1, "dosmMatrix"),
    ("bound", 0, "dosmItem"),
    ("where", 1, "dosmShape"),
    ("continuous", 0, "dosmItem"),
    ("when", 0, "dosmItem"),
    ("A", 3, "dosmMatrix"),
    ("R1", 0, "dosmRobotName"),
    ("Rover", 1, "dosmModel"),
    ("Cart", 1, "dosmModel"),
    ("hops", 0, "dosmItem"),
    ("effort", 0, "dosmObjective"),
    ("safe", 0, "dosmFormulaName"),
    ("count", 0, "dosmQuantifier"),
    ("true", 0, "dosmBoolean"),
    ("G", 0, "dosmTemporal"),
];

#[test]
fn words_have_their_groups() {
    let text = fs::read_to_string(package(EVERYTHING)).expect("a mission");
    let places: Vec<_> = GROUPS.iter().map(|(token, before, _)| place(&text, token, *before)).collect();
    let question = json!({"what": "Groups", "file": EVERYTHING, "places": places});
    for editor in EDITORS {
        let Some(answers) = ask(editor, "groups", std::slice::from_ref(&question)) else { continue };
        for ((token, before, group), (there, place)) in
            GROUPS.iter().zip(answers[0].as_array().expect("groups").iter().zip(&places))
        {
            assert_eq!(there, group, "{editor:?}: `{token}` number {before} at {place:?}");
        }
    }
}

#[test]
fn nothing_is_without_a_group() {
    let files: Vec<_> = missions("examples").into_iter().chain(missions("tests/missions/parse")).collect();
    let questions: Vec<_> = files.iter().map(|file| json!({"what": "Plain", "file": file})).collect();
    for editor in EDITORS {
        let Some(answers) = ask(editor, "plain", &questions) else { continue };
        for (file, plain) in files.iter().zip(answers) {
            assert_eq!(plain, json!([]), "{editor:?}: {}", file.display());
        }
    }
}

/// What goes on on further lines in every way, as `dosmc fmt` has it.
const BROKEN_LINES: &str = "dosm 1
robot R2: Rover at { px = 2.500000000000000000000000000, vx = 0.20000000000000000000000000 m/s,
  py = 3.000000000000000000000000000000000000000000000000000000 m }
team a = R1,
  // one that comes later
  R2
let P =  // a table
  [1, 2; 3, 4]
dynamics Rover {
  step 1 s
  mode dry when { x >= 5;
    // and not
    y <=
    3 } {
    A = [0, 0;
         0, 0]
  }
  // at the end
  bound where { vx + vy <= 5000000000000000000000000000000000000000000; vx - vy >= -500000000000000000000000000;
    vx <= 3 }
  state
    // to the east
    px: m, vx: m/s
}
// of the radio
connectivity {
  hops <= 3
  // in steps
  every 2 s
}
goal x: (a and
  b) or
  // many
  count(r in
  all: r in b) = 1 and [][1,
  2] p
";

/// The missions that `dosmc fmt` can lay out, as it does: what the compiler calls them, and their lines.
fn laid_out() -> Vec<(PathBuf, Vec<String>)> {
    let folder = scratch("laid-out");
    let stages = ["parse", "ok", "field"].map(|stage| format!("tests/missions/{stage}"));
    let directories = ["examples", "examples/paper"].map(str::to_owned).into_iter().chain(stages);
    let mut found = Vec::new();
    for path in directories.flat_map(|directory| missions(&directory)) {
        let source = crate::common::source(&path);
        let mut diagnostics = dosmc::diag::Diagnostics::new();
        let Ok(formatted) = dosmc::syntax::format::format(&source, &mut diagnostics) else { continue };
        let file =
            folder.join(path.strip_prefix(package("")).expect("below").to_string_lossy().replace('/', "-"));
        fs::write(&file, &formatted.text).expect("it can be written");
        found.push((file, formatted.text.lines().map(str::to_owned).collect()));
    }
    let file = folder.join("broken-lines.dosm");
    fs::write(&file, BROKEN_LINES).expect("it can be written");
    found.push((file, BROKEN_LINES.lines().map(str::to_owned).collect()));
    assert!(found.len() > 45, "only {}", found.len());
    found
}

#[test]
fn indentation_is_that_of_the_formatter() {
    let files = laid_out();
    // Also from nothing: all lines pushed to the left, but for those in long comments, which stay.
    let flat = scratch("flat");
    let mut questions: Vec<_> =
        files.iter().map(|(file, _)| json!({"what": "Indented", "file": file})).collect();
    for (file, lines) in &files {
        let long = lines.iter().any(|line| line.contains("/*"));
        let text: String = lines
            .iter()
            .map(|line| if long { line.clone() } else { line.trim_start().to_owned() } + "\n")
            .collect();
        let there = flat.join(file.file_name().expect("a file"));
        fs::write(&there, text).expect("it can be written");
        questions.push(json!({"what": "Indented", "file": there}));
    }
    for editor in EDITORS {
        let Some(answers) = ask(editor, "indented", &questions) else { continue };
        for ((file, lines), answer) in files.iter().chain(&files).zip(answers) {
            let lines_there: Vec<_> =
                answer.as_array().expect("lines").iter().filter_map(Value::as_str).collect();
            for (at, (there, here)) in lines_there.iter().zip(lines).enumerate() {
                assert_eq!(there, here, "{editor:?}: {}:{}", file.display(), at + 1);
            }
        }
    }
}

/// What is typed, and what then stands there.
const TYPED: [(&str, &str); 7] = [
    ("goal a: p and\ngoal b: q", "goal a: p and\ngoal b: q"),
    (
        "dynamics Rover {\nstep 1 s\nintegrator 2\n}\nrobot",
        "dynamics Rover {\n  step 1 s\n  integrator 2\n}\nrobot",
    ),
    ("goal a: p and\nq\ngoal b", "goal a: p and\n  q\ngoal b"),
    ("let P = [1, 2;\n3, 4]\nparam", "let P = [1, 2;\n         3, 4]\nparam"),
    ("/// one\ntwo", "/// one\n/// two"),
    ("// one\ntwo", "// one\n// two"),
    (
        "dynamics D {\nmode a when { x >= 1 } {\nA = [1]\n}\nstep",
        "dynamics D {\n  mode a when { x >= 1 } {\n    A = [1]\n  }\n  step",
    ),
];

#[test]
fn lines_are_indented_as_they_are_typed() {
    let empty = scratch("typed").join("empty.dosm");
    fs::write(&empty, "").expect("it can be written");
    let question =
        |(keys, _): &(&str, &str)| json!({"what": "Typed", "file": empty, "keys": keys.replace('\n', "\r")});
    let questions: Vec<_> = TYPED.iter().map(question).collect();
    for editor in EDITORS {
        let Some(answers) = ask(editor, "typed", &questions) else { continue };
        for ((keys, expected), answer) in TYPED.iter().zip(answers) {
            let lines: Vec<_> = answer.as_array().expect("lines").iter().filter_map(Value::as_str).collect();
            assert_eq!(lines.join("\n"), *expected, "{editor:?}: {keys:?}");
        }
    }
}

#[test]
fn missions_are_known_by_their_ending_and_folded_at_their_braces() {
    let questions = [
        json!({"what": "Options", "file": "examples/relay.dosm"}),
        json!({"what": "Folds", "file": "examples/first.dosm"}),
    ];
    let text = fs::read_to_string(package("examples/first.dosm")).expect("a mission");
    let open = text.lines().position(|line| line.ends_with('{')).expect("a block") + 1;
    let close = text.lines().position(|line| line == "}").expect("its end") + 1;
    for editor in EDITORS {
        let Some(answers) = ask(editor, "options", &questions) else { continue };
        let options = &answers[0];
        assert_eq!(options["filetype"], "dosm");
        assert_eq!(options["commentstring"], "// %s");
        assert_eq!(options["shiftwidth"], 2);
        assert_eq!(options["formatprg"], "dosmc fmt -");
        assert!(options["makeprg"].as_str().is_some_and(|make| make.starts_with("dosmc check")), "{options}");
        assert_eq!(options["undo"], 1);
        assert_eq!(answers[1], json!([[open, close]]), "{editor:?}");
    }
}

/// What `dosmc check` says about missions, as it says it, and as JSON.
fn checked(files: &[PathBuf]) -> (PathBuf, Vec<Value>) {
    let run = |options: &[&str]| {
        let mut check = Command::new(env!("CARGO_BIN_EXE_dosmc"));
        check.arg("check").args(options).args(files).current_dir(package(""));
        check.output().expect("it runs")
    };
    let said = scratch("checked").join("said.txt");
    fs::write(&said, run(&["--color", "never"]).stderr).expect("it can be written");
    let object: Value = serde_json::from_slice(&run(&["--json"]).stdout).expect("JSON");
    (said, object["diagnostics"].as_array().expect("diagnostics").clone())
}

#[test]
fn make_finds_every_diagnostic_in_its_place() {
    let files: Vec<_> = missions("tests/missions/err")
        .into_iter()
        .filter(|file| !file.to_string_lossy().contains("too_many"))
        .map(|file| file.strip_prefix(package("")).expect("below").to_path_buf())
        .collect();
    let (said, diagnostics) = checked(&files);
    // Each at one of its labels.
    let kind = |severity: &Value| if severity == "error" { "E" } else { "W" };
    let mut expected: BTreeMap<(String, &str), usize> = BTreeMap::new();
    let mut places: BTreeSet<(String, u64, u64, &str)> = BTreeSet::new();
    for diagnostic in diagnostics.iter().filter(|d| !d["labels"][0]["line"].is_null()) {
        let kind = kind(&diagnostic["severity"]);
        for label in diagnostic["labels"].as_array().expect("labels") {
            let number = |name: &str| label[name].as_u64().expect("a number");
            places.insert((
                label["file"].as_str().expect("a file").into(),
                number("line"),
                number("column"),
                kind,
            ));
        }
        *expected.entry((diagnostic["file"].as_str().expect("a file").into(), kind)).or_default() += 1;
    }
    assert!(expected.len() > 100, "only {}", expected.len());
    let question = json!({"what": "Errors", "file": files[0], "said": said});
    for editor in EDITORS {
        let Some(answers) = ask(editor, "errors", std::slice::from_ref(&question)) else { continue };
        let mut found: BTreeMap<(String, &str), usize> = BTreeMap::new();
        let errors = answers[0].as_array().expect("errors");
        for error in errors.iter().filter(|error| error[1] != 0) {
            let number = |at: usize| error[at].as_u64().expect("a number");
            let text = |at: usize| error[at].as_str().expect("a text");
            assert!(text(4).len() > 10, "{error}");
            assert!(places.contains(&(text(0).into(), number(1), number(2), text(3))), "{editor:?}: {error}");
            *found.entry((text(0).into(), text(3))).or_default() += 1;
        }
        assert_eq!(found, expected, "{editor:?}");
    }
}

#[test]
fn commands_run_the_program() {
    let program = env!("CARGO_BIN_EXE_dosmc");
    let folder = scratch("commands");
    let untidy =
        "dosm 1\nmission   a\n\n// a comment that is\nworkspace box (0,0)..(9 ,9)\n/* kept */ param b=1\n";
    let file = folder.join("untidy.dosm");
    fs::write(&file, untidy).expect("it can be written");
    let broken = folder.join("broken.dosm");
    fs::copy(package("tests/missions/err/check_unknown_region.dosm"), &broken).expect("it can be copied");
    let mission = folder.join("a mission.dosm");
    fs::copy(package("examples/first.dosm"), &mission).expect("it can be copied");
    let questions = [
        json!({"what": "Formatted", "file": file, "program": program}),
        json!({"what": "Reformatted", "file": file, "program": program}),
        json!({"what": "Made", "file": broken, "program": program}),
        json!({"what": "Explained", "file": broken, "program": program, "line": 14}),
        json!({"what": "Solved", "file": mission, "program": program, "arguments": "--horizon 1..9"}),
    ];
    let tidy =
        "dosm 1\nmission a\n\n// a comment that is\nworkspace box (0, 0) .. (9, 9)\n/* kept */\nparam b = 1";
    for editor in EDITORS {
        let Some(answers) = ask(editor, "commands", &questions) else { continue };
        let text = |lines: &Value| {
            lines.as_array().expect("lines").iter().filter_map(Value::as_str).collect::<Vec<_>>().join("\n")
        };
        assert_eq!(text(&answers[0]["lines"]), tidy, "{editor:?}");
        assert_eq!(text(&answers[1]), tidy, "{editor:?}");
        assert_eq!(answers[2][0], json!([14, 32, "E"]), "{editor:?}");
        assert!(text(&answers[3]).starts_with("dosm::check::unknown_region"), "{editor:?}: {}", answers[3]);
        let plan = folder.join("out/a mission/plan.json");
        assert!(plan.is_file(), "{editor:?}: {}", text(&answers[4]));
        fs::remove_file(plan).expect("it can be removed");
    }
}
