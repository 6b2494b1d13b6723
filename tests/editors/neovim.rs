//! The language server and tree-sitter in Neovim, without a screen.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::{Value, json};

use crate::common::{package, skipped};
use crate::vim::{Editor, place, scratch};

/// Asks Neovim; `None` if it isn't there.
fn ask(name: &str, program: &str, question: &Value) -> Option<Value> {
    let neovim = Editor::Neovim.program()?;
    let folder = scratch(&format!("neovim-{name}"));
    let (asked, answered) = (folder.join("ask.json"), folder.join("answer.json"));
    fs::write(&asked, question.to_string()).expect("it can be written");
    let _ = fs::remove_file(&answered);
    let mut command = Editor::Neovim.command(&neovim);
    command.arg("--cmd").arg(format!("let g:dosm_program = '{program}'"));
    command.arg("-c").arg(format!("luafile {}", package("tests/editors/vim/neovim.lua").display()));
    // Nobody's settings, and a place of its own for what is installed.
    for variable in ["XDG_DATA_HOME", "XDG_STATE_HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME"] {
        command.env(variable, folder.join(variable));
    }
    command.env("DOSMC_ASK", &asked).env("DOSMC_ANSWER", &answered);
    let output = command.output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr);
    let answer = fs::read_to_string(&answered).unwrap_or_else(|e| panic!("no answer: {e}\n{said}"));
    let answer: Value = serde_json::from_str(&answer).expect("JSON");
    assert!(answer["error"].is_null(), "{}\n{said}", answer["error"].as_str().unwrap_or("?"));
    Some(answer)
}

const EVERYTHING: &str = "tests/missions/parse/everything.dosm";

/// Tokens of [`EVERYTHING`], how many of them come before, and what they are captured as.
const CAPTURES: [(&str, usize, &str); 14] = [
    ("//! Every", 0, "comment.documentation"),
    ("dosm", 0, "keyword"),
    ("everything", 0, "module"),
    ("m/s", 0, "type.builtin"),
    ("min", 0, "type.builtin"),
    ("min", 1, "function.builtin"),
    ("pi", 0, "constant.builtin"),
    ("opaque", 0, "keyword.modifier"),
    ("box", 0, "constructor"),
    ("Rover", 0, "type.definition"),
    ("step", 0, "keyword"),
    ("px", 0, "variable.member"),
    ("busy", 1, "function.call"),
    ("G", 0, "keyword.operator"),
];

#[test]
fn tree_sitter_colours_missions() {
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    if !Command::new(&compiler).arg("--version").output().is_ok_and(|output| output.status.success()) {
        return skipped("the parser was not compiled for Neovim: there is no C compiler (CC, or cc)");
    }
    let text = fs::read_to_string(package(EVERYTHING)).expect("a mission");
    let places: Vec<_> = CAPTURES.iter().map(|(token, before, _)| place(&text, token, *before)).collect();
    let question = json!({
        "what": "captures", "file": EVERYTHING, "places": places,
        "sources": package("editors/tree-sitter/src"),
    });
    let Some(answer) = ask("captures", "no-such-program", &question) else { return };
    assert_eq!(answer["active"], true, "missions are coloured by the parser");
    assert_eq!(answer["broken"], false);
    assert_eq!(answer["colourless"], json!([]));
    for ((token, before, name), there) in
        CAPTURES.iter().zip(answer["captures"].as_array().expect("captures"))
    {
        assert_eq!(there, name, "`{token}` number {before}");
    }
}

/// A mission with a wrong name, a few blanks too many and letters before a name that are not of one byte.
const MISSION: &str = "dosm 1
mission port

workspace box (0, 0) .. (12, 12)
/// Where the ships lie.
region docks = box (9, 1) .. (11.5, 3.5)
region yard   = box (0.5, 9) .. (3, 11.5)
base B1 at (1, 1)

dynamics Rover {
  step 0.5 s
  integrator 2
  bound vx, vy in [-4, 4] m/s
  bound ax, ay in [-4, 4] m/s^2
  disturbance px, py in [-0.1, 0.1] m
}

robot R1: Rover at (4.5, 1)
goal there: always eventually R1 in docks
goal back: /* größer, 𝒳 */ eventually R1 in yrad
goal both: eventually[0 s, 20 s] R1 in yard
";

/// A mission in a folder of its own.
fn mission(name: &str) -> PathBuf {
    let file = scratch(name).join("port.dosm");
    fs::write(&file, MISSION).expect("it can be written");
    file
}

/// What `dosmc fmt` makes of a text.
fn formatted(text: &str, folder: &Path) -> String {
    let file = folder.join("formatted.dosm");
    fs::write(&file, text).expect("it can be written");
    let done = Command::new(env!("CARGO_BIN_EXE_dosmc")).arg("fmt").arg(&file).status().expect("it runs");
    assert!(done.success());
    fs::read_to_string(&file).expect("it is there")
}

#[test]
fn the_language_server_serves_a_whole_session() {
    let file = mission("neovim-session");
    let line = |start: &str| MISSION.lines().position(|line| line.starts_with(start)).expect("a line") + 1;
    let question = json!({
        "what": "session", "file": file,
        "wrong": {"line": line("goal back"), "token": "yrad", "meant": "yard"},
        "model": {"line": line("dynamics"), "token": "Rover"},
        "used": {"line": line("goal there"), "token": "docks"},
    });
    let Some(answer) = ask("session", env!("CARGO_BIN_EXE_dosmc"), &question) else { return };

    // Neovim counts bytes here, whatever the server was asked in.
    let wrong = MISSION.lines().nth(line("goal back") - 1).expect("a line");
    let from = wrong.find("yrad").expect("it is wrong");
    let row = line("goal back") - 1;
    let diagnostic = &answer["diagnostics"][0];
    assert_eq!(diagnostic[0], row, "{diagnostic}");
    assert_eq!([&diagnostic[1], &diagnostic[3]], [from, from + 4], "{diagnostic}");
    assert_eq!(diagnostic[4], 1, "an error");
    assert!(diagnostic[5].as_str().is_some_and(|message| message.contains("`yrad`")), "{diagnostic}");
    assert!(diagnostic.to_string().contains("unknown_region"), "{diagnostic}");

    let hover = answer["hover"].as_str().expect("a hover");
    assert!(hover.contains("Rover"), "{hover}");
    assert_eq!(answer["definition"], json!([line("region docks"), "region ".len()]));
    assert_eq!(answer["references"], 2);
    let mended = MISSION.replace("yrad", "yard");
    assert_eq!(answer["mended"], mended, "a code action mends it: {}", answer["actions"]);
    let renamed = mended.replace("docks", "harbour");
    assert_eq!(answer["renamed"], renamed);
    let offered = answer["offered"].as_array().expect("items");
    assert!(offered.contains(&json!("harbour")) && offered.contains(&json!("yard")), "{offered:?}");
    let symbols = answer["symbols"].as_array().expect("symbols");
    assert!(symbols.contains(&json!("harbour")) && symbols.contains(&json!("Rover")), "{symbols:?}");
    // From Neovim 0.10 on.
    assert!(answer["hints"].is_null() || answer["hints"].to_string().contains("40"), "{}", answer["hints"]);
    assert!(answer["tokens"].is_null() || answer["tokens"] == json!(["class"]), "{}", answer["tokens"]);
    assert_eq!(answer["formatted"], formatted(&renamed, &scratch("neovim-session")));
    let said = answer["said"].to_string();
    assert!(said.contains("planning"), "{said}");
    assert!(said.contains("plan of") || said.contains("steps"), "{said}");
}

#[test]
fn one_server_is_enough() {
    let file = mission("neovim-enabled");
    let question = json!({"what": "enabled", "file": file});
    let Some(answer) = ask("enabled", env!("CARGO_BIN_EXE_dosmc"), &question) else { return };
    assert_eq!(answer["servers"], 1);
    assert_eq!(answer["command"], true, "it has the plug-in's keys and commands");
}

#[test]
fn without_the_program_something_is_said() {
    let file = mission("neovim-missing");
    let Some(answer) = ask("missing", "no-such-program", &json!({"what": "missing", "file": file})) else {
        return;
    };
    assert_eq!(answer["filetype"], "dosm");
    let said = answer["said"].as_array().expect("messages");
    assert!(
        said.len() == 1 && said[0].as_str().is_some_and(|text| text.contains("dosm_program")),
        "{said:?}"
    );
}
