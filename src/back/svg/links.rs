//! The radio links that the plan relies on at its last step.

use super::canvas::{Canvas, Pixel, px};
use crate::exact::Rational;
use crate::ir::Problem;
use crate::plan::Plan;

/// Draws the links of the last step: who keeps whom in contact where the plan has got to.
pub fn draw(canvas: &mut Canvas, problem: &Problem, plan: &Plan) {
    for link in at_last_step(plan) {
        let ends = [&link.from, &link.to].map(|name| place(canvas, problem, plan, name));
        if let [Some(a), Some(b)] = ends {
            let path = format!("M{} {}L{} {}", px(a.0), px(a.1), px(b.0), px(b.1));
            canvas.add(&format!(r#"<path class="link" d="{path}"/>"#));
        }
    }
}

/// The links of the last step, none where the mission asks for none.
pub fn at_last_step(plan: &Plan) -> &[crate::plan::Link] {
    plan.links.as_ref().and_then(|steps| steps.get(plan.length)).map_or(&[], Vec::as_slice)
}

/// Where a robot is at the last step, or where a base stands.
fn place(canvas: &Canvas, problem: &Problem, plan: &Plan, name: &str) -> Option<Pixel> {
    if let Some(base) = problem.bases.values().find(|b| b.name == name) {
        let at: Vec<f64> = base.position.iter().map(Rational::to_f64).collect();
        return Some(canvas.pixel(&at));
    }
    let robot = plan.robots.iter().find(|r| r.name == name)?;
    let model = problem.models.values().find(|m| m.name == robot.dynamics)?;
    let state = robot.z.get(plan.length)?;
    let at: Option<Vec<f64>> = model.position.iter().map(|&s| state.get(s).copied()).collect();
    Some(canvas.pixel(&at?))
}
