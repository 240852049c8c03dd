//! Numbers as doubles.

use super::error::{FormulaError, FormulaErrorKind};
use super::item::{Item, shortened};

/// The double that a number reads as.
pub(super) fn number(item: &Item<'_>) -> Result<f64, FormulaError> {
    in_range(item, &item.text.replace('−', "-"))
}

/// The number that superscript digits, and perhaps a superscript minus, read as.
pub(super) fn superscript(item: &Item<'_>) -> Result<f64, FormulaError> {
    const DIGITS: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";
    let digit = |character| DIGITS.chars().position(|digit| digit == character);
    let digits = item.text.chars().map(|character| match digit(character) {
        Some(digit) => char::from(b'0' + digit as u8),
        None => '-',
    });
    in_range(item, &digits.collect::<String>())
}

fn in_range(item: &Item<'_>, text: &str) -> Result<f64, FormulaError> {
    let value: f64 = text.parse().expect("the grammar lets only numbers pass");
    let mantissa = text.split(['e', 'E']).next().unwrap_or(text);
    let is_zero = !mantissa.contains(|character| ('1'..='9').contains(&character));
    if value.is_finite() && (value != 0.0 || is_zero) {
        return Ok(value);
    }
    let kind = FormulaErrorKind::NumberOutOfRange { number: shortened(item.text) };
    Err(FormulaError::new(kind, item.span()).with_help("numbers lie between 4.9e-324 and 1.8e308 in size"))
}

#[cfg(test)]
mod tests {
    use super::super::item::Kind;
    use super::*;

    #[test]
    fn numbers_read_as_the_nearest_doubles() {
        let read = |text| number(&Item { kind: Kind::number, text, start: 0 });
        assert_eq!(read("0.1"), Ok(0.1));
        assert_eq!(read("1e−3"), Ok(0.001));
        assert_eq!(read("0.000e-999"), Ok(0.0));
        assert_eq!(read("4.9e-324"), Ok(f64::from_bits(1)));
        assert_eq!(read("1.7976931348623157e308"), Ok(f64::MAX));
        assert!(read("1.8e308").is_err() && read("2e-324").is_err());
    }

    #[test]
    fn superscripts_read_as_numbers() {
        let read = |text| superscript(&Item { kind: Kind::superscript, text, start: 0 });
        assert_eq!(read("⁰¹²³⁴⁵⁶⁷⁸⁹"), Ok(123_456_789.0));
        assert_eq!(read("⁻²"), Ok(-2.0));
    }
}
