//! What a simulation came to, for people.

use std::fmt::Write;

use super::output::counted;
use crate::simulate::{JsonSpot, JsonSummary};

/// The kinds in the order in which they are shown, and what they are called.
const KINDS: [(&str, &str); 11] = [
    ("state", "states"),
    ("input", "inputs"),
    ("mixed", "joint bounds"),
    ("workspace", "workspace"),
    ("blocker", "obstacles, jammers"),
    ("separation", "separation"),
    ("link", "links"),
    ("range", "range of links"),
    ("region", "regions"),
    ("connectivity", "connectivity"),
    ("goal", "goals"),
];

/// The summary, and the time that it took.
pub fn of(summary: &JsonSummary, asked: u64, seconds: f64) -> String {
    let mut text = head(summary, asked, seconds);
    let _ = write!(text, "\n\n{}", verdict(summary));
    if !summary.least.is_empty() {
        let rows = rows(&summary.least, false);
        let _ = write!(text, "\n\nleast margins at samples\n{}", table(&rows));
    }
    let between = &summary.between_samples;
    if !between.least.is_empty() {
        let rows = rows(&between.least, true);
        let _ = write!(
            text,
            "\n\nbetween samples, where nothing but straight ways is promised\n{}",
            table(&rows)
        );
    }
    for (kind, name) in KINDS {
        if let Some(count) = between.shortfalls.get(kind) {
            let _ = write!(text, "\n  {name}: none left at {}", counted(*count as usize, "instant"));
        }
    }
    text
}

fn head(summary: &JsonSummary, asked: u64, seconds: f64) -> String {
    let runs = counted(summary.runs.min(asked) as usize, "run");
    let robots = counted(summary.robots, "robot");
    let million = summary.robot_steps as f64 / 1e6;
    let rate =
        if seconds > 0.0 { format!(", {:.1} million a second", million / seconds) } else { String::new() };
    let scale = if summary.exceed == 1.0 { String::new() } else { format!(", scaled by {}", summary.exceed) };
    let float = if summary.float == "f64" { String::new() } else { format!(", law in {}", summary.float) };
    format!(
        "{runs} of {robots}, {} each: {} robot-steps in {seconds:.2} s{rate}\n\
         disturbances {}{scale}; seed {}{float}",
        counted(summary.steps, "step"),
        grouped(summary.robot_steps),
        summary.disturbance.join(", "),
        summary.seed,
    )
}

fn verdict(summary: &JsonSummary) -> String {
    let mut text = match summary.violations {
        0 => "nothing was violated".to_string(),
        count => {
            let runs = counted(summary.runs_with_violation as usize, "run");
            format!("{} in {runs}", counted(count as usize, "violation"))
        }
    };
    for (kind, name) in KINDS {
        if let (Some(count), Some(first)) =
            (summary.violations_by_kind.get(kind), summary.first_violations.get(kind))
        {
            let _ = write!(text, "\n  {name}: {}, first {}", grouped(*count), place(first));
        }
    }
    if summary.excess_reported > 0 {
        let count = grouped(summary.excess_reported);
        let runs = counted(summary.runs_with_excess as usize, "run");
        let _ = write!(text, "\nmonitors reported more than was assumed {count} times, in {runs}");
        if summary.float == "f32" && summary.exceed <= 1.0 {
            text.push_str("\n(single precision wants a plan that `solve --float f32` has made)");
        }
    } else {
        text.push_str("\nno monitor reported more than was assumed");
    }
    if summary.violations > 0 {
        let unreported = match summary.unreported_violations {
            0 => "each violation was reported by the sample that showed it".to_string(),
            count => format!("{} NOT reported by the sample that showed them", grouped(count)),
        };
        let _ = write!(text, "\n{unreported}");
    }
    text
}

/// Cells: the kind, its margin, who it is about, and when that was.
type Row = [String; 3];

fn rows(least: &std::collections::BTreeMap<&'static str, JsonSpot>, between: bool) -> Vec<Row> {
    let row = |(kind, name): (&str, &str)| {
        let spot = least.get(kind)?;
        let name = if between && kind == "link" { "contact" } else { name };
        Some([name.to_string(), amount(kind, spot), place(spot)])
    };
    KINDS.into_iter().filter_map(row).collect()
}

fn table(rows: &[Row]) -> String {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let (first, second) = (width(0), width(1));
    let line = |[kind, amount, place]: &Row| format!("  {kind:<first$}  {amount:<second$}  {place}");
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// `0.123 m`, `12 % (0.48 m/s)`
fn amount(kind: &str, spot: &JsonSpot) -> String {
    let (Some(margin), Some(amount), Some(unit)) = (spot.margin, spot.amount, spot.unit.as_deref()) else {
        return String::new();
    };
    let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
    match kind {
        "state" | "input" => format!("{} % ({}{unit})", short(100.0 * margin), short(amount)),
        _ => format!("{}{unit}", short(amount)),
    }
}

/// Three digits that count.
fn short(x: f64) -> String {
    match x.abs() {
        0.0 => "0".into(),
        a if a < 0.001 => format!("{x:.1e}"),
        a if a < 1.0 => format!("{x:.3}"),
        a if a < 100.0 => format!("{x:.2}"),
        _ => format!("{x:.0}"),
    }
}

/// `R1 and R2, each other, run 12 (aimed), step 7`
fn place(spot: &JsonSpot) -> String {
    let who = spot.robots.join(" and ");
    let about = match (who.is_empty(), spot.against.as_str()) {
        (true, against) => against.to_string(),
        (false, "each other") => who,
        (false, against) => format!("{who}: {against}"),
    };
    format!("{about}, run {} ({}), step {}", spot.run, spot.disturbance, spot.step)
}

/// A number with its thousands apart.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!([0, 7, 1000, 1_234_567].map(grouped), ["0", "7", "1,000", "1,234,567"]);
        let numbers = [0.0, 1.5e-6, -0.0123, 0.5, 12.25, 1234.5];
        assert_eq!(numbers.map(short), ["0", "1.5e-6", "-0.012", "0.500", "12.25", "1234"]);
    }
}
