//! `dosmc lsp`: the language server on standard input and output, and what it needs of the world.

use std::fs;
use std::io::{self, BufReader, BufWriter};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use serde_json::Value;

use super::Status;
use super::files::{self, OutputDirectory};
use super::output::Output;
use super::solve;
use crate::back::{html, svg};
use crate::diag::Diagnostic;
use crate::driver::{self, Answer, Encoding, Mission, Overrides};
use crate::explain::Page;
use crate::law::Float;
use crate::lsp::{self, Ending, Host, Outcome, wire};
use crate::plan::{self, Plan};
use crate::solve::Watch;
use crate::syntax;

/// Serves the client at the other end of standard input and output.
pub fn lsp(overrides: &Overrides, output: &Output) -> Status {
    let incoming = reader();
    let (outgoing, writer) = writer();
    let world = Arc::new(World::new(overrides.float));
    let killed = Arc::clone(&world);
    // Without a handler the process ends as well, and only leaves its directory behind.
    let _ = ctrlc::set_handler(move || {
        killed.clean();
        process::exit(Status::Usage.code().into());
    });
    let host: Arc<dyn Host> = Arc::<World>::clone(&world);
    let ending = lsp::serve(&incoming, &outgoing, overrides, &host);
    // All has been answered; what is still in the channel goes out, and nothing after it.
    let _ = outgoing.send(Value::Null);
    let _ = writer.join();
    world.clean();
    match ending {
        Ending::Orderly | Ending::Unused => Status::Done,
        Ending::Abrupt => {
            output.note("the client ended the session without `shutdown`");
            Status::Usage
        }
    }
}

/// The messages on standard input, read in a thread of its own, which ends with the process.
fn reader() -> Receiver<wire::Arrival> {
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        let mut input = BufReader::new(io::stdin());
        while let Ok(Some(arrival)) = wire::read(&mut input) {
            if sender.send(arrival).is_err() {
                break;
            }
        }
    });
    receiver
}

/// What is sent goes to standard output, up to a null, written in a thread of its own.
fn writer() -> (Sender<Value>, JoinHandle<()>) {
    let (sender, receiver) = mpsc::channel::<Value>();
    let writer = thread::spawn(move || {
        let mut output = BufWriter::new(io::stdout());
        while let Ok(value) = receiver.recv() {
            if value.is_null() || wire::write(&mut output, &value).is_err() {
                break;
            }
        }
    });
    (sender, writer)
}

/// Files, clock and planner.
struct World {
    started: Instant,
    float: Float,
    /// Holds explanations and the plans of missions without a place; gone with the server.
    scratch: Mutex<Scratch>,
}

/// A directory that the server makes when it needs one.
enum Scratch {
    /// Nobody needed it.
    None,
    /// It is there as long as this.
    Made(tempfile::TempDir),
    /// The server ends.
    Over,
}

impl World {
    fn new(float: Float) -> World {
        World { started: Instant::now(), float, scratch: Mutex::new(Scratch::None) }
    }

    /// The server's own directory, made when it is first needed; none once it has ended.
    fn scratch(&self) -> Option<PathBuf> {
        let mut scratch = self.scratch.lock().unwrap_or_else(PoisonError::into_inner);
        if let Scratch::None = *scratch {
            let made = tempfile::Builder::new().prefix("dosmc-").tempdir();
            *scratch = made.map_or(Scratch::None, Scratch::Made);
        }
        match &*scratch {
            Scratch::Made(directory) => Some(directory.path().to_path_buf()),
            Scratch::None | Scratch::Over => None,
        }
    }

    /// Removes the server's own directory, whoever still works.
    fn clean(&self) {
        *self.scratch.lock().unwrap_or_else(PoisonError::into_inner) = Scratch::Over;
    }

    /// Writes a plan with its pictures and its controller.
    fn write(&self, mission: &Mission, plan: &Plan, directory: &Path) -> Result<Vec<PathBuf>, Diagnostic> {
        let picture = svg::draw(&mission.problem, plan, &svg::Options::default());
        let page = html::write(&mission.problem, plan, &svg::Options::default());
        let controller = driver::controller(&mission.problem, plan, self.float).unwrap_or_default();
        let text = plan::json::write(plan);
        let mut all = vec![(svg::NAME, picture.contents.as_bytes()), (html::NAME, page.contents.as_bytes())];
        all.extend(controller.iter().map(|a| (a.name.as_str(), a.contents.as_bytes())));
        all.push(("plan.json", text.as_bytes()));
        OutputDirectory::probe(directory)?.write_bytes(&all)
    }

    fn planned(&self, mission: &Mission, plan: &Plan, shortest: bool, directory: &Path) -> Outcome {
        match self.write(mission, plan, directory) {
            Err(problem) => Outcome::without_plan("error", problem.message),
            Ok(files) => {
                let shown: Vec<String> = files.iter().map(|f| f.to_string_lossy().into_owned()).collect();
                let named = |name: &str| files.iter().find(|f| f.ends_with(name)).cloned();
                Outcome {
                    status: "plan",
                    length: Some(plan.length),
                    message: solve::found(plan, shortest, Encoding::HalfSpaces, &shown),
                    picture: named(svg::NAME),
                    page: named(html::NAME),
                    plan: named("plan.json"),
                }
            }
        }
    }
}

impl Host for World {
    fn plan(&self, mission: &Mission, directory: &Path, watch: &Arc<dyn Watch>) -> Outcome {
        let started = Instant::now();
        let solved = driver::solve(mission, watch);
        match solved.answer {
            Answer::Plan { plan, shortest } => self.planned(mission, &plan, shortest, directory),
            Answer::NoPlan(scope) => Outcome::without_plan("no_plan", solve::no_plan(mission, &scope)),
            Answer::Unknown(reason) => {
                let (_, why) = solve::why_unknown(reason, None);
                let length = solved.statistics.length;
                Outcome::without_plan("unknown", solve::unknown(why, length, started.elapsed()))
            }
            Answer::Refused(report) => Outcome::without_plan(
                "error",
                format!("the plan that was found does not check exactly:\n{report}"),
            ),
        }
    }

    fn temporary(&self) -> PathBuf {
        self.scratch().unwrap_or_else(std::env::temp_dir)
    }

    fn explanation(&self, page: &Page) -> Option<PathBuf> {
        let path = self.scratch()?.join(format!("{}.md", page.code.replace("::", "-")));
        if !path.exists() {
            fs::write(&path, page.text).ok()?;
        }
        Some(path)
    }

    fn missions(&self, folders: &[PathBuf]) -> Vec<(PathBuf, String)> {
        let mut found = Vec::new();
        let mut waiting: Vec<(PathBuf, usize)> = folders.iter().map(|f| (f.clone(), 0)).collect();
        while let Some((folder, depth)) = waiting.pop() {
            for path in entries(&folder) {
                if found.len() >= MOST_MISSIONS {
                    break;
                }
                let is_mission = path.extension().is_some_and(|e| e == "dosm");
                if path.is_dir() && !path.is_symlink() && depth < DEEPEST && !is_passed_over(&path) {
                    waiting.push((path, depth + 1));
                } else if is_mission && let Some(text) = text(&path) {
                    found.push((path, text));
                }
            }
        }
        found.sort();
        found
    }

    fn now(&self) -> Duration {
        self.started.elapsed()
    }
}

/// The most missions that are looked through for a symbol.
const MOST_MISSIONS: usize = 1000;
/// How many folders below a workspace's are looked into.
const DEEPEST: usize = 8;

/// What is in a folder, in order; nothing where it can't be read.
fn entries(folder: &Path) -> Vec<PathBuf> {
    let read = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut entries: Vec<PathBuf> = read.map(|entry| entry.path()).collect();
    entries.sort();
    entries
}

/// Folders in which no missions are written.
fn is_passed_over(path: &Path) -> bool {
    let name = path.file_name().and_then(|n| n.to_str()).unwrap_or_default();
    name.starts_with('.') || matches!(name, "target" | "node_modules" | "out")
}

fn text(path: &Path) -> Option<String> {
    syntax::decode(&files::read(path).ok()?).ok()
}
