//! Numbers and sizes as people read them.

use crate::check::{Known, Quantity, Steps, Values};
use crate::exact::Rational;
use crate::quantity::Dimension;

/// The most characters of an exact number.
const MOST_CHARACTERS: usize = 12;

/// A number: exactly where that is short, else `≈` and six digits.
pub fn number(x: &Rational) -> String {
    let exact = x.to_string();
    if exact.len() <= MOST_CHARACTERS && !exact.contains('/') {
        exact
    } else {
        format!("≈ {}", rough(x.to_f64()))
    }
}

/// A double with six significant digits.
fn rough(x: f64) -> String {
    digits(x, 6)
}

/// A measured length or the like, with four significant digits.
pub fn measure(x: f64) -> String {
    digits(x, 4)
}

/// A tube's half-width; what only keeps room for rounding counts as nothing.
pub fn half_width(x: f64) -> String {
    if x < 1e-6 { "0".into() } else { measure(x) }
}

/// A double with so many significant digits, without noughts at its end.
fn digits(x: f64, count: usize) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    let scientific = format!("{x:.*e}", count.saturating_sub(1));
    let exponent: i32 = scientific.rsplit('e').next().and_then(|e| e.parse().ok()).unwrap_or(0);
    if !(-5..9).contains(&exponent) {
        let (mantissa, _) = scientific.split_once('e').unwrap_or((&scientific, ""));
        return format!("{}e{exponent}", trimmed(mantissa));
    }
    let places = (count as i32 - 1 - exponent).max(0) as usize;
    trimmed(&format!("{x:.places$}")).to_string()
}

fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

/// A value behind `=`, unless it says `≈` itself.
pub fn equals(value: &str) -> String {
    if value.starts_with('≈') { value.to_string() } else { format!("= {value}") }
}

/// A number with its SI unit, which plain numbers don't have.
pub fn quantity(x: &Rational, dimension: Dimension) -> String {
    format!("{}{}", number(x), unit(dimension))
}

/// The SI unit behind a blank; nothing for plain numbers.
pub fn unit(dimension: Dimension) -> String {
    if dimension.is_bare() { String::new() } else { format!(" {dimension}") }
}

/// A constant's value on one line: `3.5 m`, `a table of 3 × 2, in m`.
pub fn known(value: &Known) -> String {
    match value {
        Known::Scalar(Quantity { number, dimension }) => quantity(number, *dimension),
        Known::Table(rows) => {
            let (height, width) = (rows.len(), rows.first().map_or(0, Vec::len));
            let first = rows.first().and_then(|row| row.first()).map(|q| q.dimension);
            let same = |q: &Quantity| Some(q.dimension) == first;
            let measured = first.filter(|d| !d.is_bare() && rows.iter().flatten().all(same));
            let unit = measured.map_or_else(String::new, |d| format!(", in {d}"));
            format!("a table of {height} × {width}{unit}")
        }
    }
}

/// The values of an expression: `3.5 m`, `2, 4, 6 m`, `1 … 30 m`.
pub fn values(values: &Values) -> String {
    let unit = unit(values.dimension);
    if values.more {
        return format!("{} … {}{unit}", number(&values.least), number(&values.most));
    }
    let list: Vec<String> = values.listed.iter().map(number).collect();
    format!("{}{unit}", list.join(", "))
}

/// The steps of a window or a time: `10..20`, `4`, `1..10, 2..20 …`.
pub fn steps(steps: &Steps) -> String {
    let one = |(from, to): &(u32, u32)| if from == to { from.to_string() } else { format!("{from}..{to}") };
    let list: Vec<String> = steps.listed.iter().map(one).collect();
    let dots = if steps.more { " …" } else { "" };
    format!("{}{dots}", list.join(", "))
}

/// A point: `(4, 7)`.
pub fn point(coordinates: &[Rational]) -> String {
    let list: Vec<String> = coordinates.iter().map(|x| measure(x.to_f64())).collect();
    format!("({})", list.join(", "))
}

/// The size of a box: `2.5 m × 3 m`.
pub fn size(lo: &[Rational], hi: &[Rational]) -> String {
    let list: Vec<String> =
        lo.iter().zip(hi).map(|(l, h)| format!("{} m", measure((h - l).to_f64()))).collect();
    list.join(" × ")
}

/// So many things: `1 robot`, `4 robots`.
pub fn counted(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_exact_where_that_is_short() {
        assert_eq!(number(&Rational::ratio(1, 8)), "0.125");
        assert_eq!(number(&Rational::ratio(1, 3)), "≈ 0.333333");
        assert_eq!(number(&Rational::ratio(-2_000_000, 3)), "≈ -666667");
        assert_eq!(number(&Rational::from(10).pow(40).unwrap()), "≈ 1e40");
        assert_eq!(number(&Rational::from(10).pow(-40).unwrap()), "≈ 1e-40");
        assert_eq!(number(&crate::quantity::pi()), "≈ 3.14159");
        assert_eq!(number(&Rational::from(-12)), "-12");
    }

    #[test]
    fn measures_have_four_digits() {
        let shown = [0.25, 1.0 / 3.0, 1234.56, 0.000_123_456, 2e-9, 0.0, 100.0].map(measure);
        assert_eq!(shown, ["0.25", "0.3333", "1235", "0.0001235", "2e-9", "0", "100"]);
    }

    #[test]
    fn tables_say_their_size_and_what_they_measure() {
        let cell = |dimension| Quantity { number: Rational::ONE, dimension };
        let lengths = Known::Table(vec![vec![cell(Dimension::LENGTH); 2]; 3]);
        assert_eq!(known(&lengths), "a table of 3 × 2, in m");
        let mixed = Known::Table(vec![vec![cell(Dimension::LENGTH), cell(Dimension::TIME)]]);
        assert_eq!(known(&mixed), "a table of 1 × 2");
    }
}
