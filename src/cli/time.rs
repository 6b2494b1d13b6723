//! Spans of time as people write them on the command line.

use std::time::Duration;

/// The longest span accepted: a hundred years, far from what a clock can't add.
const LONGEST_S: f64 = 3.2e9;

/// `30 s`, `2min`, `500ms`, `1.5 h`, or bare seconds.
pub fn parse_time(text: &str) -> Result<Duration, String> {
    let text = text.trim();
    let unit_at = text.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(text.len());
    let (number, unit) = text.split_at(unit_at);
    let scale = match unit.trim() {
        "" | "s" => 1.0,
        "ms" => 1e-3,
        "min" => 60.0,
        "h" => 3600.0,
        _ => return Err("it must be a number with `ms`, `s`, `min` or `h`, as in `30 s`".into()),
    };
    let value: f64 = number.parse().map_err(|_| "it must start with a number, as in `30 s`")?;
    let seconds = value * scale;
    if seconds.is_finite() && seconds <= LONGEST_S {
        Ok(Duration::from_secs_f64(seconds))
    } else {
        Err("this is longer than a hundred years".into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_units_and_none_are_read() {
        for (text, ms) in
            [("30 s", 30_000), ("2min", 120_000), ("500ms", 500), ("1.5", 1500), ("1h", 3_600_000), ("0", 0)]
        {
            assert_eq!(parse_time(text), Ok(Duration::from_millis(ms)), "{text}");
        }
    }

    #[test]
    fn nonsense_is_refused() {
        for text in ["", "s", "-1", "1 day", "1e400", "1.2.3", "inf", "NaN", "99999999999999"] {
            assert!(parse_time(text).is_err(), "{text}");
        }
    }
}
