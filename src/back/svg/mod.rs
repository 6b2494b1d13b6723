//! The picture of a plan: the workspace to scale, what is in it, and every robot's way with its tube.
//!
//! The picture is static and self-contained. Numbers have a fixed number of decimals and everything
//! is drawn in the mission's order, so the same plan gives the same bytes. A mission in space is
//! seen from above.

mod canvas;
mod cells;
mod legend;
mod links;
mod shapes;
mod ways;

#[cfg(test)]
mod tests;

use crate::back::Artifact;
use crate::ir::Problem;
use crate::plan::Plan;
use canvas::{Canvas, escape};

pub use cells::Cell;

/// The file's name in the output directory.
pub const NAME: &str = "plan.svg";

/// What a picture shows besides the plan.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options<'a> {
    /// The cells of a partition of the workspace, drawn as thin outlines under everything else.
    pub cells: &'a [Cell],
}

/// Draws a plan of a problem.
pub fn draw(problem: &Problem, plan: &Plan, options: &Options) -> Artifact {
    let mut canvas = Canvas::new(&problem.workspace, legend::height(problem));
    cells::draw(&mut canvas, options.cells);
    shapes::draw(&mut canvas, problem);
    links::draw(&mut canvas, problem, plan);
    ways::draw(&mut canvas, problem, plan);
    shapes::draw_names(&mut canvas, problem);
    legend::draw(&mut canvas, problem, plan);
    let title = format!("{}: {}", problem.name, plan.summary());
    Artifact { name: NAME.into(), contents: canvas.finish(&escape(&title)) }
}
