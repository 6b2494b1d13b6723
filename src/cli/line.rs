//! The progress line of a long command: one line at the bottom of a terminal, gone at the end.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::diag::printable;
use crate::solve::Progress;

/// The longest name that is shown whole.
const LONGEST_NAME: usize = 16;

/// A line that is drawn over and over.
#[derive(Debug, Default)]
pub struct Line {
    bar: Option<ProgressBar>,
}

impl Line {
    /// Draws the line in place of what it was, cut to the terminal.
    pub fn draw(&mut self, text: &str) {
        let bar = self.bar.get_or_insert_with(new_bar);
        bar.set_message(text.to_owned());
        bar.tick();
    }

    /// Takes the line away, until it is drawn again.
    pub fn clear(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }
}

fn new_bar() -> ProgressBar {
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
    // A template that could not be read would leave the line plain.
    if let Ok(style) = ProgressStyle::with_template("{spinner} {wide_msg}") {
        bar.set_style(style);
    }
    bar
}

/// A text of so many characters at most.
fn cut(text: &str, columns: usize) -> String {
    if text.chars().count() <= columns {
        return text.into();
    }
    let kept: String = text.chars().take(columns.saturating_sub(1)).collect();
    if columns > 0 { format!("{kept}…") } else { kept }
}

/// `1.2 s · making tubes`
pub fn said(stage: &str, elapsed: Duration) -> String {
    format!("{} · {stage}", clock(elapsed))
}

/// `8.9 s · ▆▆▆▁▁▁▁▁▁▁ 345 of 1000 runs · no violation`
pub fn runs(done: u64, of: u64, violations: u64, elapsed: Duration) -> String {
    let share = (10 * done).checked_div(of).unwrap_or(0).min(10) as usize;
    let bar = "▆".repeat(share) + &"▁".repeat(10 - share);
    let found = match violations {
        0 => "no violation".to_string(),
        1 => "1 violation".to_string(),
        many => format!("{many} violations"),
    };
    format!("{} · {bar} {done} of {of} runs · {found}", clock(elapsed))
}

/// `8.9 s · length 12 · 345 candidates · 67 lemmas · R3 refused 21 times`
pub fn search(reached: &Progress, robots: &[String], elapsed: Duration) -> String {
    let mut parts = vec![
        clock(elapsed),
        format!("length {}", reached.length),
        format!("{} candidates", reached.candidates),
        format!("{} lemmas", reached.lemmas),
    ];
    // The first of those with the most, so that the name stays while numbers grow together.
    let most = reached.conflicts.iter().max().copied().unwrap_or(0);
    let robot = reached.conflicts.iter().position(|&c| c == most).and_then(|i| robots.get(i));
    if let Some(name) = robot.filter(|_| most > 0) {
        let times = if most == 1 { "once".into() } else { format!("{most} times") };
        parts.push(format!("{} refused {times}", shortened(name)));
    }
    parts.join(" · ")
}

/// A name that can be shown, and is not too long to be.
fn shortened(name: &str) -> String {
    cut(&printable(name), LONGEST_NAME)
}

/// `8.9 s`, `59 s`, `12:34 min`, `2:05 h`
fn clock(elapsed: Duration) -> String {
    let seconds = elapsed.as_secs();
    match seconds {
        0..10 => format!("{seconds}.{} s", elapsed.subsec_millis() / 100),
        10..60 => format!("{seconds} s"),
        60..3600 => format!("{}:{:02} min", seconds / 60, seconds % 60),
        _ => format!("{}:{:02} h", seconds / 3600, seconds / 60 % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_says_how_many_runs_are_done() {
        let at = Duration::from_millis(8_950);
        assert_eq!(runs(345, 1000, 0, at), "8.9 s · ▆▆▆▁▁▁▁▁▁▁ 345 of 1000 runs · no violation");
        assert_eq!(runs(7, 7, 1, at), "8.9 s · ▆▆▆▆▆▆▆▆▆▆ 7 of 7 runs · 1 violation");
        assert_eq!(runs(0, 0, 12, at), "8.9 s · ▁▁▁▁▁▁▁▁▁▁ 0 of 0 runs · 12 violations");
    }

    #[test]
    fn what_is_too_long_is_cut() {
        assert_eq!(cut("a·b·c", 5), "a·b·c");
        assert_eq!(cut("a·b·c", 4), "a·b…");
        assert_eq!((cut("ab", 1), cut("ab", 0)), ("…".into(), String::new()));
    }

    #[test]
    fn the_line_says_how_far_the_search_is_within_eighty_columns() {
        let robots = ["R1".to_string(), "a_robot_with_quite_a_long_name".to_string()];
        let reached = Progress {
            length: 128,
            candidates: 123_456,
            lemmas: 34_567,
            conflicts: vec![7, 9999],
            ..Progress::default()
        };
        let line = search(&reached, &robots, Duration::from_secs(754));
        let expected =
            "12:34 min · length 128 · 123456 candidates · 34567 lemmas · a_robot_with_qu… refused 9999 times";
        assert_eq!(line, expected);
        let usual =
            Progress { length: 12, candidates: 345, lemmas: 67, conflicts: vec![21, 21], ..reached.clone() };
        let line = search(&usual, &robots, Duration::from_millis(8_950));
        assert_eq!(line, "8.9 s · length 12 · 345 candidates · 67 lemmas · R1 refused 21 times");
        assert!(line.chars().count() + 2 <= 80);
        let fresh = Progress { length: 1, ..Progress::default() };
        assert_eq!(
            search(&fresh, &[], Duration::from_secs(7199)),
            "1:59 h · length 1 · 0 candidates · 0 lemmas"
        );
        assert_eq!(said("making tubes", Duration::from_millis(59_999)), "59 s · making tubes");
    }
}
