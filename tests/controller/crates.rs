//! The crates as compilers see them: without a warning, without a path to a panic, and giving the very
//! bits that the law gives here.
//!
//! All crates are built together, in a directory that is kept between runs.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{LazyLock, Mutex};

use dosmc::law::Float;
use dosmc::law::tracking::Fallback;
use dosmc::simulate::{self, Disturbance, Observer, Way};

use super::luck::Luck;
use super::robot::{Column, Flown, Number, Pilot, doubles, pilots, said};
use super::{PLANNED, Planned, crate_of, in_type};
use crate::common::skipped;

/// Where the crates lie, with programs that use them.
struct Site {
    root: PathBuf,
}

/// Steps of each robot that are replayed.
const STEPS: usize = 80;

static SITE: LazyLock<Site> = LazyLock::new(|| {
    let root = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("controllers");
    let mut crates = Vec::new();
    for (at, planned) in PLANNED.iter().enumerate() {
        let krate = Crate::new(at, planned);
        for file in crate_of(planned) {
            let is_manifest = file.name.ends_with("Cargo.toml");
            let contents = if is_manifest { krate.adopted(&file.contents) } else { file.contents };
            put(&root.join("crates").join(&planned.name).join(&file.name), &contents);
        }
        crates.push(krate);
    }
    let members: Vec<String> =
        crates.iter().map(|c| format!("    \"crates/{}/controller\",\n", c.directory)).collect();
    let workspace = format!(
        "[workspace]\nresolver = \"2\"\nmembers = [\n    \"micro\", \"replay\", \"bare\", \"broken\",\n{}]\n\n\
         [profile.release]\npanic = \"abort\"\nlto = true\ncodegen-units = 1\n\n[profile.dev]\npanic = \"abort\"\n",
        members.concat()
    );
    put(&root.join("Cargo.toml"), &workspace);
    let uses: String = crates.iter().map(|c| format!("pub use {};\n", c.alias)).collect();
    program(&root, "micro", &crates, "lib.rs", &format!("#![no_std]\n{uses}"));
    program(&root, "replay", &crates, "main.rs", &replay(&crates));
    program(&root, "bare", &crates, "main.rs", &bare(&crates, ""));
    program(&root, "broken", &crates[..1], "main.rs", &bare(&crates[..1], BROKEN));
    Site { root }
});

/// Writes a file unless it is so already: what is not new is not compiled again.
fn put(path: &Path, contents: &str) {
    if fs::read_to_string(path).ok().as_deref() != Some(contents) {
        fs::create_dir_all(path.parent().expect("a directory")).expect("it can be made");
        fs::write(path, contents).expect("it can be written");
    }
}

/// A generated crate as programs use it.
struct Crate {
    /// What programs call it.
    alias: String,
    /// Its package's name as it is written, another one, and where it lies.
    written: String,
    package: String,
    directory: String,
    /// Its robots' types, each with the module of its model, in order.
    robots: Vec<(String, String)>,
    float: Float,
}

impl Crate {
    fn new(at: usize, planned: &Planned) -> Crate {
        let files = crate_of(planned);
        let text = |name: &str| &files.iter().find(|f| f.name.ends_with(name)).expect(name).contents;
        let package = text("Cargo.toml").split("name = \"").nth(1).and_then(|rest| rest.split('"').next());
        let types = text("robots.rs").split("pub struct ").skip(1).map(|rest| until(rest, " "));
        let models =
            text("robots.rs").split("pub fn start() -> dynamics::").skip(1).map(|rest| until(rest, ":"));
        Crate {
            alias: format!("c{at}"),
            written: package.expect("a name").into(),
            package: format!("controller-{at}"),
            directory: planned.name.clone(),
            robots: types.zip(models).collect(),
            float: planned.float,
        }
    }
}

impl Crate {
    /// Its manifest as that of a member of the site's workspace: only members are looked at by clippy.
    /// Several plans of one mission have one package name, of which a workspace takes one only.
    fn adopted(&self, manifest: &str) -> String {
        let (old, new) = (format!("name = \"{}\"", self.written), format!("name = \"{}\"", self.package));
        assert!(manifest.contains(&old) && manifest.ends_with("\n[workspace]\n"), "{manifest}");
        manifest.replace(&old, &new).replace("\n[workspace]\n", "\n")
    }
}

fn until(text: &str, end: &str) -> String {
    text.split(end).next().unwrap_or_default().to_string()
}

/// A package that depends on crates, with one file.
fn program(root: &Path, name: &str, crates: &[Crate], file: &str, source: &str) {
    let mut manifest = format!(
        "[package]\nname = \"{name}\"\nversion = \"0.0.0\"\nedition = \"2021\"\npublish = false\n\n[dependencies]\n"
    );
    for Crate { alias, package, directory, .. } in crates {
        let _ = writeln!(
            manifest,
            "{alias} = {{ package = \"{package}\", path = \"../crates/{directory}/controller\" }}"
        );
    }
    put(&root.join(name).join("Cargo.toml"), &manifest);
    put(&root.join(name).join("src").join(file), source);
}

/// A program that reads what robots measure and writes what their controllers say.
fn replay(crates: &[Crate]) -> String {
    let mut arms = String::new();
    for krate in crates {
        for (robot, model) in &krate.robots {
            let (alias, real) = (&krate.alias, krate.float);
            let bits = if real == Float::F64 { "u64" } else { "u32" };
            let _ = writeln!(
                arms,
                "        \"{alias} {robot}\" => replay!({alias}, {robot}, {model}, {real}, {bits}, lines),"
            );
        }
    }
    format!(
        r#"#![allow(clippy::all, clippy::pedantic)]
macro_rules! replay {{
    ($krate:ident, $robot:ident, $model:ident, $real:ident, $bits:ident, $lines:expr) => {{{{
        use $krate::dynamics::$model::{{Input, State, INPUTS, STATES}};
        let read = |text: &str| <$real>::from_bits($bits::from_str_radix(text, 16).expect("bits"));
        let mut robot = $krate::$robot::new();
        while let Some(line) = $lines.next_if(|line: &&str| !line.starts_with("robot ")) {{
            let mut words = line.split(' ');
            let output = match words.next() {{
                Some("x") => {{
                    let mut x = [0.0; STATES.len()];
                    x.iter_mut().zip(words).for_each(|(x, word)| *x = read(word));
                    robot.step(&State::from(x))
                }}
                Some("missed") => robot.missed(),
                Some("reset") => {{
                    robot.reset();
                    continue;
                }}
                Some("hold") => {{
                    robot = $krate::$robot::with_fallback($krate::Fallback::Hold);
                    continue;
                }}
                Some("fixed") => {{
                    let mut u = [0.0; INPUTS.len()];
                    u.iter_mut().zip(words).for_each(|(u, word)| *u = read(word));
                    robot = $krate::$robot::with_fallback($krate::Fallback::Fixed(Input::from(u)));
                    continue;
                }}
                _ => panic!("{{line}}"),
            }};
            let input = <[$real; INPUTS.len()]>::from(output.input);
            let input: Vec<String> = input.iter().map(|u| format!("{{:x}}", u.to_bits())).collect();
            println!("{{}} {{}} {{:?}}", output.moment, input.join(" "), output.status);
        }}
    }}}};
}}

fn main() {{
    let script = std::fs::read_to_string(std::env::args().nth(1).expect("a script")).expect("a script");
    let mut lines = script.lines().peekable();
    while let Some(line) = lines.next() {{
        run(line.strip_prefix("robot ").expect("a robot"), &mut lines);
    }}
}}

fn run(robot: &str, lines: &mut std::iter::Peekable<std::str::Lines<'_>>) {{
    println!("{{robot}}");
    match robot {{
{arms}        _ => panic!("{{robot}}"),
    }}
}}
"#
    )
}

/// What makes a panic possible.
const BROKEN: &str = "    core::hint::black_box([1, 2, 3][core::hint::black_box(1usize)]);\n";

/// A program without a standard library that links only when nothing of it can panic.
fn bare(crates: &[Crate], more: &str) -> String {
    let mut calls = String::new();
    for krate in crates {
        for (robot, model) in &krate.robots {
            let _ = writeln!(calls, "    fly!({}, {robot}, {model});", krate.alias);
        }
    }
    format!(
        r#"#![no_std]
#![no_main]
use core::hint::black_box;

#[link(name = "c")]
extern "C" {{
    fn a_path_to_a_panic_is_left() -> !;
}}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {{
    unsafe {{ a_path_to_a_panic_is_left() }}
}}

macro_rules! fly {{
    ($krate:ident, $robot:ident, $model:ident) => {{{{
        use $krate::dynamics::$model::{{State, STATES}};
        let mut robot = black_box($krate::$robot::new());
        let output = robot.step(&State::from([black_box(0.5); STATES.len()]));
        black_box(output);
        black_box(output.status.holds());
        black_box($krate::links::next_hop(output.moment, $krate::$robot::NODE));
        black_box($krate::$robot::NODE.name());
        black_box($krate::$robot::NODE.is_base());
        black_box(robot.missed());
        black_box(robot.moment());
        let mut other = $krate::$robot::with_fallback($krate::Fallback::Fixed(black_box(output.input)));
        black_box(other.missed());
        other.reset();
        black_box(other.step(&$krate::$robot::start()));
    }}}};
}}

#[no_mangle]
pub extern "C" fn main() -> i32 {{
{more}{calls}    0
}}
"#
    )
}

impl Site {
    fn cargo(&self, args: &[&str], variables: &[(&str, &str)]) -> Output {
        let mut command = Command::new(std::env::var("CARGO").unwrap_or_else(|_| "cargo".into()));
        command.current_dir(&self.root).args(args).env("CARGO_NET_OFFLINE", "true");
        command.envs(variables.iter().copied());
        command.env("CARGO_TARGET_DIR", self.root.join("target")).env("RUSTFLAGS", "-D warnings");
        command.env_remove("CARGO_ENCODED_RUSTFLAGS").output().expect("cargo starts")
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn crates_compile_without_a_word_from_clippy() {
    let rest = ["--workspace", "--exclude", "bare", "--exclude", "broken", "--exclude", "micro"];
    let asked = ["--", "-D", "warnings", "-D", "clippy::pedantic"];
    let output = SITE.cargo(&[&["clippy"][..], &rest, &asked].concat(), &[]);
    if text(&output.stderr).contains("no such command") {
        return skipped("cargo clippy: no crate was looked at");
    }
    assert!(output.status.success(), "{}", text(&output.stderr));
}

#[test]
fn nothing_in_a_crate_can_panic() {
    let build = |name: &str| SITE.cargo(&["build", "--release", "-p", name], &[]);
    let output = build("bare");
    assert!(output.status.success(), "{}", text(&output.stderr));
    // The same with an index that could be out of range: the test can fail.
    let broken = build("broken");
    let said = text(&broken.stderr);
    assert!(!broken.status.success() && said.contains("a_path_to_a_panic_is_left"), "{said}");
}

#[test]
fn crates_compile_for_a_microcontroller() {
    let target = "thumbv7em-none-eabihf";
    // Another compiler, where the installed one can't.
    let rustc = std::env::var("DOSMC_ARM_RUSTC").ok();
    let asked = rustc.as_deref().unwrap_or("rustc");
    let found = Command::new(asked).args(["--print", "target-libdir", "--target", target]).output();
    if !found.is_ok_and(|o| Path::new(text(&o.stdout).trim()).is_dir()) {
        return skipped("no target thumbv7em-none-eabihf: no crate was compiled for it");
    }
    let rustc: Vec<(&str, &str)> = rustc.iter().map(|rustc| ("RUSTC", rustc.as_str())).collect();
    let output = SITE.cargo(&["build", "-p", "micro", "--target", target], &rustc);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

/// A robot's flight, with measurements that are none here and there: what it reads, and what the law
/// says to it.
fn flight<R: Number>(pilot: &Pilot<'_>, bits: fn(R) -> String, luck: &mut Luck) -> (String, String) {
    let (mut script, mut expected) = (String::new(), String::new());
    let fixed: Column<R> = pilot.path.v[0].iter().map(|v| R::of(*v)).collect();
    let fallback = luck.pick(&[Fallback::Predict, Fallback::Hold, Fallback::Fixed(fixed)]).clone();
    let line = |values: &[R]| values.iter().map(|x| bits(*x)).collect::<Vec<_>>().join(" ");
    match &fallback {
        Fallback::Predict => {}
        Fallback::Hold => script.push_str("hold\n"),
        Fallback::Fixed(u) => script.push_str(&format!("fixed {}\n", line(u))),
    }
    let flown = Flown::<R>::new(pilot);
    flown.fly(pilot, fallback, |law| {
        let mut x = pilot.start();
        for _ in 0..STEPS {
            let moment = law.moment();
            let mut measured: Column<R> = x.iter().map(|x| R::of(*x)).collect();
            let case = luck.below(24);
            let at = luck.below(measured.len());
            match case {
                0 => measured[at] = R::of(f64::NAN),
                1 => measured[at] = R::of(f64::INFINITY),
                2 => measured[at] = R::of(1e30),
                3 => measured[at] = R::of(-0.0),
                4 => {
                    script.push_str("reset\n");
                    law.reset();
                    x = pilot.start();
                    continue;
                }
                _ => {}
            }
            let (u, status) = if case == 5 {
                script.push_str("missed\n");
                law.missed()
            } else {
                script.push_str(&format!("x {}\n", line(&measured)));
                law.step(&measured)
            };
            let _ = writeln!(expected, "{moment} {} {}", line(&u), said(&status));
            let w = pilot.disturbance(|| 1.5 * luck.push());
            x = pilot.plant(&x, &doubles(&u), &w);
        }
    });
    (script, expected)
}

trait Bits {
    fn hex(self) -> String;
}

impl Bits for f64 {
    fn hex(self) -> String {
        format!("{:x}", self.to_bits())
    }
}

impl Bits for f32 {
    fn hex(self) -> String {
        format!("{:x}", self.to_bits())
    }
}

fn recorded<R: Number + Bits>(pilot: &Pilot<'_>, luck: &mut Luck) -> (String, String) {
    flight::<R>(pilot, R::hex, luck)
}

/// What `simulate` measures and gives out in some runs: scripts, and the beginnings of the lines that
/// controllers have to answer with.
fn simulated(planned: &Planned, krate: &Crate) -> (String, String) {
    struct Recorder(Mutex<Vec<Vec<Way>>>);
    impl Observer for Recorder {
        fn wants_ways(&self) -> bool {
            true
        }
        fn see(&self, _: u64, ways: &[Way]) {
            self.0.lock().expect("nobody panicked").push(ways.to_vec());
        }
    }
    let options = simulate::Options {
        runs: Disturbance::ALL.len() as u64,
        seed: 5,
        exceed: 1.2,
        float: planned.float,
        ..simulate::Options::default()
    };
    let recorder = Recorder(Mutex::default());
    simulate::run(&planned.problem, &planned.plan, &options, &recorder).expect("it can be simulated");
    let (mut script, mut expected) = (String::new(), String::new());
    for ways in recorder.0.into_inner().expect("nobody panicked") {
        assert_eq!(ways.len(), krate.robots.len());
        for (way, (robot, _)) in ways.iter().zip(&krate.robots) {
            let _ = writeln!(script, "robot {} {robot}", krate.alias);
            let _ = writeln!(expected, "{} {robot}", krate.alias);
            let hex = |values: &[f64]| {
                let all = values.iter().map(|x| match planned.float {
                    Float::F64 => x.hex(),
                    Float::F32 => f32::of(*x).hex(),
                });
                all.collect::<Vec<_>>().join(" ")
            };
            for sample in 0..way.samples() {
                let _ = writeln!(script, "x {}", hex(way.state(sample)));
                let _ = writeln!(expected, "{} {} *", planned.moment(sample), hex(way.input(sample)));
            }
        }
    }
    (script, expected)
}

#[test]
fn compiled_crates_give_the_very_bits_that_the_law_gives_here() {
    let (mut script, mut expected) = (String::new(), String::new());
    for (at, planned) in PLANNED.iter().enumerate() {
        let krate = Crate::new(at, planned);
        for (seed, (pilot, (robot, _))) in pilots(planned).iter().zip(&krate.robots).enumerate() {
            let mut luck = Luck::new((1000 * at + seed) as u64);
            let (read, said) = in_type!(planned.float, recorded(pilot, &mut luck));
            let _ = write!(script, "robot {} {robot}\n{read}", krate.alias);
            let _ = write!(expected, "{} {robot}\n{said}", krate.alias);
        }
        let (read, said) = simulated(planned, &krate);
        script.push_str(&read);
        expected.push_str(&said);
    }
    let built = SITE.cargo(&["build", "-p", "replay"], &[]);
    assert!(built.status.success(), "{}", text(&built.stderr));
    let file = SITE.root.join("script");
    put(&file, &script);
    let program = SITE.root.join("target/debug/replay");
    let output = Command::new(program).arg(&file).output().expect("it starts");
    assert!(output.status.success(), "{}", text(&output.stderr));
    let said = text(&output.stdout);
    for (number, (line, wanted)) in said.lines().zip(expected.lines()).enumerate() {
        match wanted.strip_suffix('*') {
            Some(beginning) => assert!(line.starts_with(beginning), "line {number}: {line}, not {wanted}"),
            None => assert_eq!(line, wanted, "line {number}"),
        }
    }
    assert_eq!(said.lines().count(), expected.lines().count());
    assert!(expected.contains("NotANumber") && expected.contains("Returned") && expected.contains("Missing"));
}
