//! The goals: each in words, and for all that it asks a strip over the steps that says when it is
//! certainly so.

use std::fmt::Write;

use super::formula;
use super::motion::{letter, steps};
use crate::back::svg::escape;
use crate::ir::{Atom, Goal, Problem};
use crate::plan::{Label, Plan};

/// The most strips of one goal.
const MOST_STRIPS: usize = 40;

/// All goals as HTML.
pub fn write(problem: &Problem, plan: &Plan) -> String {
    problem.goals.iter().map(|goal| one(problem, plan, goal)).collect()
}

fn one(problem: &Problem, plan: &Plan, goal: &Goal) -> String {
    let mut html = format!(
        "<section class=\"p-goal\"><h3>{}</h3><p><code>{}</code></p>\n",
        escape(&goal.name),
        escape(&formula::text(problem, goal.formula))
    );
    let atoms = formula::atoms(problem, goal.formula);
    for atom in atoms.iter().take(MOST_STRIPS) {
        html += &strip(problem, plan, *atom);
    }
    if atoms.len() > MOST_STRIPS {
        let _ = writeln!(html, "<p>and {} more</p>", atoms.len() - MOST_STRIPS);
    }
    html + "</section>\n"
}

/// When a robot is certainly in a region: a box as wide as it is so, half as high where it is unknown.
fn strip(problem: &Problem, plan: &Plan, atom: Atom) -> String {
    let (robot, region) = (&problem.robots[atom.robot].name, &problem.regions[atom.region].name);
    let named = plan.robots.iter().find(|r| r.name == *robot);
    let labels = named.and_then(|r| r.regions.get(region)).map_or(&[][..], Vec::as_slice);
    let count = steps(plan);
    let stretches = stretches(labels, count);
    let mut boxes = String::new();
    for (from, to, label) in &stretches {
        let (y, h) = if *label == Label::In { (0.0, 1.0) } else { (0.4, 0.2) };
        let class = if *label == Label::In { "p-in" } else { "p-unknown" };
        let _ = write!(
            boxes,
            "<rect class=\"{class}\" x=\"{from}\" y=\"{y}\" width=\"{}\" height=\"{h}\"/>",
            to - from
        );
    }
    let text = escape(&format!("{robot} in {region}"));
    format!(
        "<div class=\"p-strip\"><span>{text}</span><svg viewBox=\"0 0 {count} 1\" preserveAspectRatio=\"none\" \
         role=\"img\" aria-label=\"{text}: {}\"><rect class=\"p-out\" width=\"{count}\" height=\"1\"/>{boxes}\
         <rect class=\"p-now\" data-now=\"\" width=\"1\" height=\"1\"/></svg></div>\n",
        escape(&in_words(&stretches))
    )
}

/// The stretches of steps, ends left out, where a robot is certainly in, or it is unknown.
fn stretches(labels: &[Label], count: usize) -> Vec<(usize, usize, Label)> {
    let mut found: Vec<(usize, usize, Label)> = Vec::new();
    for (step, label) in labels.iter().enumerate().take(count).filter(|(_, l)| letter(**l) != 'o') {
        match found.last_mut() {
            Some((_, to, before)) if *to == step && before == label => *to = step + 1,
            _ => found.push((step, step + 1, *label)),
        }
    }
    found
}

/// Stretches of steps for those who can't see them.
fn in_words(stretches: &[(usize, usize, Label)]) -> String {
    let certain = stretches.iter().filter(|(_, _, label)| *label == Label::In);
    let words: Vec<String> = certain
        .map(|(from, to, _)| if to - from == 1 { format!("{from}") } else { format!("{from} to {}", to - 1) })
        .collect();
    if words.is_empty() {
        "at no step for certain".into()
    } else {
        format!("certainly at step {}", words.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_join_equal_neighbours_and_leave_out_the_rest() {
        use Label::{In, Out, Unknown};
        let labels = [In, In, Out, Unknown, In, In, In, Unknown];
        let found = stretches(&labels, 7);
        assert_eq!(found, [(0, 2, In), (3, 4, Unknown), (4, 7, In)]);
        assert_eq!(in_words(&found), "certainly at step 0 to 1, 4 to 6");
        assert_eq!(in_words(&[]), "at no step for certain");
    }
}
