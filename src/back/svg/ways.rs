//! What moves: each robot's nominal way with its steps, and the tube around it.

use std::cmp::Ordering;
use std::fmt::Write;

use super::canvas::{Canvas, Pixel, escape, px};
use crate::ir::Problem;
use crate::plan::{Plan, RobotPlan, Tube};

/// Colours that people with any colour vision can tell apart (Okabe and Ito), darkest first.
const COLORS: [&str; 7] = ["#0072b2", "#d55e00", "#8250df", "#009e73", "#cc79a7", "#b8860b", "#56b4e9"];

/// The colour of the `index`-th robot.
pub fn color(index: usize) -> &'static str {
    COLORS[index % COLORS.len()]
}

/// Draws all tubes, then all ways over them.
pub fn draw(canvas: &mut Canvas, problem: &Problem, plan: &Plan) {
    let ways: Vec<Way> = plan.robots.iter().map(|robot| Way::new(canvas, problem, plan, robot)).collect();
    for (index, way) in ways.iter().enumerate() {
        way.draw_tube(canvas, color(index));
    }
    for (index, way) in ways.iter().enumerate() {
        way.draw_path(canvas, color(index), plan.loop_start);
    }
    for (index, way) in ways.iter().enumerate() {
        way.draw_start(canvas, color(index));
    }
}

/// A robot's way in pixels.
struct Way {
    name: String,
    /// The nominal position at each step.
    points: Vec<Pixel>,
    /// What is said of each step.
    notes: Vec<String>,
    /// The tube's middle relative to the nominal position, and its half-widths.
    tube: Option<(Pixel, Pixel)>,
}

impl Way {
    fn new(canvas: &Canvas, problem: &Problem, plan: &Plan, robot: &RobotPlan) -> Way {
        let model = problem.models.values().find(|m| m.name == robot.dynamics);
        let axes: &[usize] = model.map_or(&[], |m| &m.position);
        let position =
            |z: &Vec<f64>| axes.iter().map(|&a| z.get(a).copied().unwrap_or(0.0)).collect::<Vec<f64>>();
        let positions: Vec<Vec<f64>> = robot.z.iter().map(position).collect();
        let tube = plan.tubes.iter().find(|t| t.dynamics == robot.dynamics).zip(axes.get(..2));
        Way {
            name: robot.name.clone(),
            points: positions.iter().map(|p| canvas.pixel(p)).collect(),
            notes: positions.iter().enumerate().map(|(t, p)| note(&robot.name, t, plan.step_s, p)).collect(),
            tube: tube.map(|(tube, axes)| {
                let (x, y) = (support(tube, axes[0]), support(tube, axes[1]));
                ((canvas.length(x.0), -canvas.length(y.0)), (canvas.length(x.1), canvas.length(y.1)))
            }),
        }
    }

    /// The boxes in which the robot is at each step, whatever the disturbance does.
    fn draw_tube(&self, canvas: &mut Canvas, color: &str) {
        let Some((middle, half)) = self.tube else { return };
        let mut group = format!(
            r#"<g fill="{color}" fill-opacity=".10" stroke="{color}" stroke-opacity=".45" stroke-width=".8">"#
        );
        for p in &self.points {
            let (x, y) = (px(p.0 + middle.0 - half.0), px(p.1 + middle.1 - half.1));
            let _ = write!(
                group,
                r#"<rect x="{x}" y="{y}" width="{}" height="{}"/>"#,
                px(2.0 * half.0),
                px(2.0 * half.1)
            );
        }
        canvas.add(&(group + "</g>"));
    }

    /// The prefix dashed, the loop solid with its closing step, a dot a step.
    fn draw_path(&self, canvas: &mut Canvas, color: &str, loop_start: usize) {
        let (Some(last), Some(again)) = (self.points.last(), self.points.get(loop_start)) else { return };
        let prefix = &self.points[..=loop_start];
        let round: Vec<Pixel> = self.points[loop_start..].iter().copied().chain([*again]).collect();
        let line = r#"fill="none" stroke-linejoin="round" stroke-linecap="round""#;
        canvas.add(&format!(
            r#"<path d="{}" {line} stroke="{color}" stroke-width="1.8" stroke-dasharray="2 5"/>"#,
            open(prefix)
        ));
        canvas.add(&format!(r#"<path d="{}" {line} stroke="{color}" stroke-width="2.4"/>"#, open(&round)));
        for pair in round.windows(2) {
            arrow(canvas, color, pair[0], pair[1]);
        }
        let mut dots = format!(r##"<g fill="{color}" stroke="#ffffff" stroke-width="1">"##);
        for (p, note) in self.points.iter().zip(&self.notes) {
            let radius = if p == last { "3.60" } else { "3.00" };
            let _ = write!(
                dots,
                r#"<circle cx="{}" cy="{}" r="{radius}"><title>{}</title></circle>"#,
                px(p.0),
                px(p.1),
                escape(note)
            );
        }
        canvas.add(&(dots + "</g>"));
    }

    /// A ring and the robot's name where it starts.
    fn draw_start(&self, canvas: &mut Canvas, color: &str) {
        let Some(&(x, y)) = self.points.first() else { return };
        canvas.add(&format!(
            r##"<circle cx="{}" cy="{}" r="6" fill="#ffffff" stroke="{color}" stroke-width="2.4"/>"##,
            px(x),
            px(y)
        ));
        let (x, y) = (x + 9.0, y - 7.0);
        canvas.text((x, y), "halo", &self.name);
        let name = escape(&self.name);
        canvas.add(&format!(
            r#"<text class="name" x="{}" y="{}" style="fill:{color}">{name}</text>"#,
            px(x),
            px(y)
        ));
    }
}

/// What the pointer shows over a step.
fn note(name: &str, step: usize, step_s: f64, position: &[f64]) -> String {
    let at: Vec<String> = position.iter().map(|x| format!("{x:.3}")).collect();
    format!("{name}, step {step}, {:.3} s: ({}) m", step as f64 * step_s, at.join(", "))
}

/// Middle and half-width of the tube along one state: Σ D_i center, Σ |D_i| half_width.
fn support(tube: &Tube, state: usize) -> (f64, f64) {
    let row = |d: &'_ Vec<Vec<f64>>| d.get(state).cloned().unwrap_or_default();
    let along = |weights: &[f64], pick: fn(f64) -> f64| -> f64 {
        tube.d
            .iter()
            .flat_map(|d| row(d).into_iter().zip(weights).map(|(x, w)| pick(x) * w).collect::<Vec<_>>())
            .sum()
    };
    (along(&tube.center, |x| x), along(&tube.half_width, f64::abs))
}

/// An open path through points.
fn open(points: &[Pixel]) -> String {
    let at: Vec<String> = points.iter().map(|p| format!("{} {}", px(p.0), px(p.1))).collect();
    format!("M{}", at.join("L"))
}

/// A small arrow head in the middle of a segment, where the segment is long enough for one.
fn arrow(canvas: &mut Canvas, color: &str, from: Pixel, to: Pixel) {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = dx.hypot(dy);
    // Not a number is no length either.
    if length.partial_cmp(&22.0).is_none_or(Ordering::is_lt) {
        return;
    }
    let (ux, uy) = (dx / length, dy / length);
    let tip = (from.0 + dx / 2.0 + ux * 5.0, from.1 + dy / 2.0 + uy * 5.0);
    let wing = |side: f64| (tip.0 - ux * 9.0 - uy * side, tip.1 - uy * 9.0 + ux * side);
    canvas.add(&format!(r#"<path d="{}Z" fill="{color}"/>"#, open(&[tip, wing(4.5), wing(-4.5)])));
}
