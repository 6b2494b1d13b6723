//! The mode for Emacs: it compiles without a warning, its own tests pass (ERT), and so does a session of Eglot with
//! the language server.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::{package, skipped};
use crate::tools::{command, output, tool};
use crate::vscode;

/// The mode's directory.
const HERE: &str = "editors/emacs";

/// A text that adds what Debian installed for Emacs to where it looks.
const WITH_PACKAGES: &str = "(let ((default-directory \"/usr/share/emacs/site-lisp/elpa/\"))
  (when (file-directory-p default-directory) (normal-top-level-add-subdirs-to-load-path)))";

/// Emacs without a window, with the mode in its reach; says loudly when it isn't there.
fn emacs(what: &str) -> Option<Command> {
    let program = tool(&["emacs"], what)?;
    let mut emacs = command(program);
    emacs.args(["-Q", "--batch", "--eval", WITH_PACKAGES, "-L"]).arg(package(HERE));
    emacs.env("DOSMC", env!("CARGO_BIN_EXE_dosmc")).env("LC_ALL", "C.UTF-8");
    Some(emacs)
}

/// Missions that parse, one a line.
fn corpus() -> String {
    let all = vscode::corpus().into_iter().map(|path| path.to_string_lossy().into_owned());
    all.collect::<Vec<_>>().join("\n")
}

/// Runs a file of tests; they say on standard error how many there were.
fn ert(mut emacs: Command, file: &str, least: usize) {
    let file = package(HERE).join("test").join(file);
    let run = emacs.arg("-l").arg(file).args(["-f", "ert-run-tests-batch-and-exit"]);
    let result = run.output().expect("Emacs starts");
    let said = String::from_utf8_lossy(&result.stderr);
    assert!(result.status.success(), "{said}");
    let count = said.lines().find_map(|l| l.strip_prefix("Ran ")?.split(' ').next()?.parse::<usize>().ok());
    assert!(count.is_some_and(|count| count >= least) && !said.contains("skipped"), "{said}");
}

#[test]
fn the_mode_compiles_without_a_warning_and_is_documented() {
    let Some(mut emacs) = emacs("Emacs's compiler") else { return };
    let dir = tempfile::tempdir().expect("a directory");
    let file: PathBuf = dir.path().join("dosm-mode.el");
    std::fs::copy(package(HERE).join("dosm-mode.el"), &file).expect("a copy");
    let strict = "(setq byte-compile-error-on-warn t)";
    output(emacs.args(["--eval", strict, "-f", "batch-byte-compile"]).arg(&file));
    assert!(file.with_extension("elc").is_file());
    let said = checkdoc(&file);
    assert!(said.is_empty(), "{said}");
}

/// What Emacs says about the documentation in a file.
fn checkdoc(file: &Path) -> String {
    let mut emacs = emacs("checkdoc").expect("it was there before");
    let check = format!("(checkdoc-file {:?})", file.to_string_lossy());
    let result = emacs.args(["--eval", &check]).output().expect("Emacs starts");
    String::from_utf8_lossy(&result.stderr).into_owned()
}

#[test]
fn highlighting_indentation_menus_and_commands_work() {
    let Some(mut emacs) = emacs("the mode for Emacs") else { return };
    emacs
        .env("DOSM_MISSIONS", corpus())
        .env("DOSM_EVERYTHING", package("tests/missions/parse/everything.dosm"));
    ert(emacs, "dosm-mode-test.el", 14);
}

#[test]
fn eglot_and_the_language_server_understand_each_other() {
    let what = "a session of Eglot";
    let Some(mut probe) = emacs(what) else { return };
    let found = probe.args(["--eval", "(kill-emacs (if (locate-library \"eglot\") 0 1))"]).status();
    if !found.expect("Emacs starts").success() {
        return skipped("a session of Eglot was not run: Emacs has none (Debian's elpa-eglot)");
    }
    let mut emacs = emacs(what).expect("it was there before");
    emacs.env("DOSM_MISSION", package("examples/first.dosm"));
    ert(emacs, "dosm-eglot-test.el", 5);
}
