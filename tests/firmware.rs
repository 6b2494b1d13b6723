//! The firmware examples: three generated controllers in a closed loop over a jammed radio, on the host
//! and on a Cortex-M4F in qemu, which must agree to the last bit.
//!
//! For the second the compiler needs the target `thumbv7em-none-eabihf` (`DOSMC_ARM_RUSTC` may name
//! one that has it, see `.ci/arm`), and `qemu-system-arm` has to be there. Without them the test says
//! loudly that it was skipped, and fails where `DOSMC_REQUIRE_TOOLS` is set.

#![allow(clippy::disallowed_methods, reason = "builds and runs programs")]

mod common;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

/// What the controller of the example is compiled for.
const TARGET: &str = "thumbv7em-none-eabihf";

/// A copy of the examples' folder with the plan in it, as its README says how to get it.
fn folder() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("firmware");
        let _ = fs::remove_dir_all(&folder);
        copy(&common::package("examples/firmware"), &folder);
        let mission = common::package("examples/paper/fig2-4.dosm");
        let mut dosmc = Command::new(env!("CARGO_BIN_EXE_dosmc"));
        let solved = dosmc.arg("solve").arg(mission).arg("-o").arg(folder.join("plan")).output();
        done(&solved.expect("it runs"));
        folder
    })
}

/// Copies what belongs to the repository.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a directory");
    for entry in fs::read_dir(from).expect("a directory") {
        let entry = entry.expect("an entry").path();
        let name = entry.file_name().expect("a name");
        if entry.is_file() {
            fs::copy(&entry, to.join(name)).expect("it can be copied");
        } else if name != "plan" && name != "target" {
            copy(&entry, &to.join(name));
        }
    }
}

/// Cargo in one of the examples.
fn cargo(example: &str) -> Command {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.current_dir(folder().join(example)).env_remove("RUSTFLAGS");
    cargo.env("CARGO_TARGET_DIR", Path::new(env!("CARGO_TARGET_TMPDIR")).join("firmware-target"));
    cargo
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

fn done(output: &Output) {
    assert!(output.status.success(), "{}", said(output));
}

/// What the host's example prints, and its status.
fn host(options: &[&str]) -> (String, Option<i32>) {
    let mut cargo = cargo("host");
    let output = cargo.args(["run", "--release", "--quiet", "--offline", "--"]).args(options).output();
    let output = output.expect("cargo runs");
    (said(&output), output.status.code())
}

/// The summary that a run ends with; what the compiler had to say may come before.
fn summary(said: &str) -> &str {
    let start = said.find("\nsteps ").map_or(0, |line| line + 1);
    assert!(said[start..].starts_with("steps ") && said.contains("\nhash of"), "{said}");
    &said[start..]
}

/// The number that a line of a summary begins with, after its name.
fn figure(summary: &str, line: &str) -> u32 {
    let found = summary.lines().find_map(|l| l.strip_prefix(line)).expect("such a line");
    let digits = found.trim_start().split(|c: char| !c.is_ascii_digit()).next();
    digits.and_then(|d| d.parse().ok()).expect("a number")
}

#[test]
fn three_robots_fly_on_the_host_as_planned() {
    let (said, status) = host(&[]);
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("3000, lost 0"), "{said}");
    // Some of them go through a relay.
    assert!(figure(&said, "transmissions") > 3000, "{said}");
}

#[test]
fn more_disturbance_than_planned_is_noticed() {
    let (said, status) = host(&["--push", "1.5"]);
    assert_eq!(status, Some(1), "{said}");
    assert!(figure(&said, "warnings of the monitors") > 0, "{said}");
    assert!(figure(&said, "bounds, jammers, walls") > 0, "{said}");
}

#[test]
fn nobody_is_heard_through_a_jammer() {
    let (said, status) = host(&["--direct"]);
    assert_eq!(status, Some(1), "{said}");
    assert!(!said.contains("lost 0\n") && !said.contains("jammed 0\n"), "{said}");
}

/// The compiler for the target: the one at hand where it has it, or the one that is named; empty for
/// the first.
fn arm() -> Option<String> {
    let mut rustc = Command::new("rustc");
    let place = rustc.args(["--print", "target-libdir", "--target", TARGET]).output();
    let place = place.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
    if place.is_ok_and(|place| !place.is_empty() && Path::new(&place).is_dir()) {
        return Some(String::new());
    }
    std::env::var("DOSMC_ARM_RUSTC").ok().filter(|rustc| !rustc.is_empty())
}

#[test]
fn three_robots_fly_on_a_microcontroller_as_on_the_host() {
    let Some(rustc) = arm() else {
        return common::skipped(&format!("no compiler for {TARGET}: nothing was run on a microcontroller"));
    };
    if Command::new("qemu-system-arm").arg("--version").output().is_err() {
        return common::skipped("no qemu-system-arm: nothing was run on a microcontroller");
    }
    let mut cargo = cargo("cortex-m");
    if !rustc.is_empty() {
        cargo.env("RUSTC", rustc);
    }
    let output = cargo.args(["run", "--release", "--quiet", "--offline"]).output().expect("cargo runs");
    done(&output);
    let machine = said(&output);
    let (host, _) = host(&[]);
    assert_eq!(summary(&machine), summary(&host));
}
