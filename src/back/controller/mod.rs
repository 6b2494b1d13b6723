//! The controller of a plan: a Rust crate for the robots' own computers.
//!
//! Only tables and names are generated. The law and its monitor are [`law::SOURCE`], copied as it
//! stands; nothing is written unless its rounding, proved from the tables, fits what the plan keeps
//! for it. No text of the mission becomes code: see `words`.
//!
//! | file | holds |
//! | --- | --- |
//! | `Cargo.toml` | a package without dependencies, a workspace of its own |
//! | `README.md` | how to use it, and what is proved of it |
//! | `src/lib.rs` | what the crate is, what it was made from |
//! | `src/law.rs` | the law |
//! | `src/dynamics.rs` | for each motion model: states, inputs, feedback |
//! | `src/robots.rs` | for each robot: its type and its nominal trajectory |
//! | `src/links.rs` | who talks to whom, at each step |

mod dynamics;
mod links;
mod manual;
mod names;
mod robots;
mod words;

use crate::back::Artifact;
use crate::exact::Rational;
use crate::ir::{ModelId, Problem};
use crate::law::{self, Feedback, Flight, Float, Misfit, PathTables, Promise, Rounding, TubeTables};
use crate::plan::{self, Plan, Tube};
use crate::source::sha256;

use names::Names;

/// The directory that all files are in.
pub const DIRECTORY: &str = "controller";

/// The least Rust version that the crate asks for.
const RUST: &str = "1.63";

/// Everything that a file of the crate is written from.
struct Contents<'a> {
    problem: &'a Problem,
    plan: &'a Plan,
    float: Float,
    names: Names,
    /// SHA-256 of plan.json as `solve` writes it.
    hash: String,
    models: Vec<ModelPart<'a>>,
    robots: Vec<RobotPart>,
}

/// A motion model that robots of the plan have.
struct ModelPart<'a> {
    id: ModelId,
    tube: &'a Tube,
    tables: TubeTables,
    rounding: Rounding,
}

/// A robot.
struct RobotPart {
    /// The place of its model among the parts.
    model: usize,
    path: PathTables,
    start: Vec<f64>,
}

/// The files of the controller of a plan that was checked against the problem.
///
/// # Errors
/// [`Misfit`] where the law's rounding in this float type does not fit the plan's reserve.
pub fn write(problem: &Problem, plan: &Plan, float: Float) -> Result<Vec<Artifact>, Misfit> {
    let contents = Contents::new(problem, plan, float)?;
    let files = [
        ("Cargo.toml", manual::manifest(&contents)),
        ("README.md", manual::readme(&contents)),
        ("src/law.rs", law::SOURCE.to_owned()),
        ("src/dynamics.rs", dynamics::file(&contents)),
        ("src/robots.rs", robots::file(&contents)),
        ("src/links.rs", links::file(&contents)),
        ("src/lib.rs", manual::library(&contents)),
    ];
    let artifact = |(name, contents)| Artifact { name: format!("{DIRECTORY}/{name}"), contents };
    Ok(files.map(artifact).into())
}

impl<'a> Contents<'a> {
    fn new(problem: &'a Problem, plan: &'a Plan, float: Float) -> Result<Contents<'a>, Misfit> {
        let missing = |name: &str| Misfit::Missing { name: name.to_owned() };
        let mut models = Vec::new();
        let mut robots = Vec::new();
        for (id, model) in problem.models.iter() {
            let members: Vec<_> = problem.robots.values().filter(|robot| robot.model == id).collect();
            let tube = plan.tubes.iter().find(|tube| tube.dynamics == model.name);
            let tube = tube.ok_or_else(|| missing(&model.name))?;
            let promise = Promise {
                model,
                workspace: &problem.workspace,
                feedback: Feedback {
                    center: &tube.center,
                    half_width: &tube.half_width,
                    d: &tube.d,
                    m: &tube.m,
                },
                reserve: &tube.reserve,
            };
            let mut flights = Vec::new();
            for robot in members {
                let part = plan.robots.iter().find(|part| part.name == robot.name);
                let part = part.ok_or_else(|| missing(&robot.name))?;
                flights.push(Flight { start: &robot.start, z: &part.z, v: &part.v });
            }
            let (tables, rounding) = law::fit(float, &promise, &flights)?;
            models.push(ModelPart { id, tube, tables, rounding });
        }
        for robot in problem.robots.values() {
            let part = plan.robots.iter().find(|part| part.name == robot.name);
            let part = part.ok_or_else(|| missing(&robot.name))?;
            let path = PathTables::new(float, &part.z, &part.v, plan.loop_start);
            let path = path.ok_or_else(|| Misfit::TooLarge { name: robot.name.clone() })?;
            let model = models.iter().position(|m| m.id == robot.model).unwrap_or(0);
            let start = robot.start.iter().map(|x: &Rational| float.round(x.to_f64())).collect();
            robots.push(RobotPart { model, path, start });
        }
        let hash = sha256(&plan::json::write(plan));
        Ok(Contents { problem, plan, float, names: Names::new(problem), hash, models, robots })
    }

    /// A constant that says which plan a file is of: `lib.rs` compares them, so that files of two plans,
    /// as a crash between two writes may leave them, do not compile together.
    fn stamp(&self) -> String {
        let start = self.hash.get(..16).unwrap_or_default();
        // Not every compiler from 1.63 on sees that it is used.
        format!(
            "/// Which plan this file is of.\n#[allow(dead_code)]\npub(crate) const PLAN: u64 = 0x{start};\n"
        )
    }
}
