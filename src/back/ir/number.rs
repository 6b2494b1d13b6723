//! Exact numbers as JSON strings.

use serde::{Deserialize, Serialize};

use crate::exact::Rational;

/// The most digits that a numerator or a denominator may have when it is read; what missions can say
/// stays far below.
const MOST_DIGITS: usize = 100_000;

/// An exact number: `numerator` or `numerator/denominator` in decimal digits, in lowest terms with a
/// denominator above 1, as in `"3"`, `"-1/20"`. One number has one text.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Number(pub Rational);

impl From<Number> for String {
    fn from(number: Number) -> String {
        let (numerator, denominator) = number.0.parts();
        if denominator == "1" { numerator } else { format!("{numerator}/{denominator}") }
    }
}

impl TryFrom<String> for Number {
    type Error = String;

    fn try_from(text: String) -> Result<Number, String> {
        let number = parse(&text).map(Number);
        // Comparing with the one right text refuses `2/4`, `+1`, `007`, `-0` and `3/1` together.
        number.filter(|n| String::from(n.clone()) == text).ok_or_else(|| {
            let shown: String = text.chars().take(40).collect();
            format!("{shown:?} is no exact number: `3`, `-1/20`, in lowest terms")
        })
    }
}

fn parse(text: &str) -> Option<Rational> {
    let (negative, digits) = text.strip_prefix('-').map_or((false, text), |rest| (true, rest));
    let (numerator, denominator) = digits.split_once('/').unwrap_or((digits, "1"));
    let size = natural(numerator)?.checked_div(&natural(denominator)?)?;
    Some(if negative { -size } else { size })
}

fn natural(digits: &str) -> Option<Rational> {
    let decimal = !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit());
    (decimal && digits.len() <= MOST_DIGITS).then(|| Rational::from_decimal(digits, 0))?
}

#[cfg(test)]
impl schemars::JsonSchema for Number {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Number".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "description": "An exact number: `numerator` or `numerator/denominator` in decimal digits, in lowest \
                            terms with a denominator above 1. One number has one text.",
            "type": "string",
            "pattern": "^(0|-?[1-9][0-9]*(/([2-9]|[1-9][0-9]+))?)$",
            "examples": ["3", "-1/20"],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_has_one_text() {
        for text in ["0", "3", "-17", "1/3", "-1/20", "123456789012345678901234567890/11"] {
            let number = Number::try_from(text.to_string()).unwrap();
            assert_eq!(String::from(number), text);
        }
        let wrong = [
            "", "-", "/", "1/", "/2", "+1", "-0", "00", "01", "2/4", "3/1", "1/0", "0/5", "1.5", "1e3", " 1",
            "1 ", "1/-2", "--1", "1//2", "1/2/3", "0x10", "1_000", "NaN", "inf", "½", "١",
        ];
        for text in wrong {
            assert!(Number::try_from(text.to_string()).is_err(), "{text}");
        }
        assert!(Number::try_from("9".repeat(MOST_DIGITS + 1)).is_err());
    }
}
