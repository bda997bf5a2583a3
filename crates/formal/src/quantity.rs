//! Quantities: a number with a unit, as text of scene files and of the command line.

use crate::unit::{LONGEST, parse_unit_from};
use crate::{Dimension, Span, Unit, UnitError, parse_unit};

/// A number in SI units and its dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// In SI units of `dimension`.
    pub value: f64,
    pub dimension: Dimension,
}

/// Reads a number with its unit: `10 kPa`, `-3mm`, `1e-3 kg/m^3`, `30 deg`, `12 %`, `0.3`.
///
/// The nearest number to what is written: `0.3 mm` gives the bits of `0.0003`.
///
/// # Errors
/// Names the missing number, the unknown unit, or what was read and what would be accepted, with the place.
pub fn parse_quantity(text: &str) -> Result<Quantity, UnitError> {
    let (written, unit) = split(text)?;
    Ok(Quantity { value: written.times(unit)?, dimension: unit.dimension })
}

/// Reads a quantity as a multiple of `expected_unit` (for an SI unit: its value in SI units).
///
/// # Errors
/// As [`parse_quantity`]; and where the dimension is another one, both are named with an example.
pub fn quantity_in(text: &str, expected_unit: &str) -> Result<f64, UnitError> {
    let whole = Span::new(0, text.len());
    let expected = parse_unit(expected_unit).map_err(|problem| UnitError::WrongExpectation {
        unit: expected_unit.to_owned(),
        problem: Box::new(problem),
        span: whole,
    })?;
    let (written, unit) = split(text)?;
    if unit.dimension != expected.dimension {
        let example =
            expected.dimension.example().map_or_else(|| format!("1 {expected_unit}"), str::to_owned);
        return Err(UnitError::WrongDimension {
            text: text.trim().to_owned(),
            found: unit.dimension,
            wanted: expected.dimension,
            example,
            span: whole,
        });
    }
    written.times(Unit {
        factor: unit.factor / expected.factor,
        decimal_exponent: unit.decimal_exponent - expected.decimal_exponent,
        ..unit
    })
}

/// A decimal number as written.
struct Written<'a> {
    /// Sign and digits, with or without a point.
    digits: &'a str,
    decimal_exponent: i64,
    span: Span,
    text: &'a str,
}

impl Written<'_> {
    /// The number in SI units when written with `unit`.
    fn times(&self, unit: Unit) -> Result<f64, UnitError> {
        let exponent = self.decimal_exponent.saturating_add(i64::from(unit.decimal_exponent));
        // the reader of decimal numbers rounds once, to the nearest
        let nearest: f64 = format!("{}e{exponent}", self.digits).parse().unwrap_or(f64::NAN);
        let value = nearest * unit.factor;
        let zero = !self.digits.bytes().any(|digit| matches!(digit, b'1'..=b'9'));
        if zero || value.is_normal() {
            return Ok(value);
        }
        Err(UnitError::OutOfRange { read: self.text.trim().to_owned(), span: self.span })
    }
}

/// The number at the start of `text`, and the unit after it.
fn split(text: &str) -> Result<(Written<'_>, Unit), UnitError> {
    let whole = Span::new(0, text.len());
    if text.len() > LONGEST {
        return Err(UnitError::TooLong { length: text.len(), limit: LONGEST, span: whole });
    }
    let bytes = text.as_bytes();
    let digits_from = |at: usize| at + bytes[at..].iter().take_while(|byte| byte.is_ascii_digit()).count();

    let start = text.len() - text.trim_start().len();
    let unsigned = start + usize::from(matches!(bytes.get(start), Some(b'+' | b'-')));
    let mut end = digits_from(unsigned);
    let mut digit_count = end - unsigned;
    if bytes.get(end) == Some(&b'.') {
        let fraction_end = digits_from(end + 1);
        digit_count += fraction_end - end - 1;
        end = fraction_end;
    }
    if digit_count == 0 {
        return Err(UnitError::MissingNumber {
            text: text.trim().to_owned(),
            span: Span::new(start, text.len()),
        });
    }
    let digits = &text[start..end];

    let mut decimal_exponent = 0;
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let exponent_start = end + 1;
        let exponent_digits =
            exponent_start + usize::from(matches!(bytes.get(exponent_start), Some(b'+' | b'-')));
        let exponent_end = digits_from(exponent_digits);
        if exponent_end > exponent_digits {
            let negative = bytes[exponent_start] == b'-';
            // beyond nine digits every number is out of range anyway
            let magnitude: i64 =
                text[exponent_digits..exponent_end].parse().unwrap_or(i64::MAX).min(1_000_000_000);
            decimal_exponent = if negative { -magnitude } else { magnitude };
            end = exponent_end;
        }
    }
    let unit = parse_unit_from(text, end)?;
    Ok((Written { digits, decimal_exponent, span: Span::new(start, end), text }, unit))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A prefix moves the decimal point and nothing else: same bits as the number written in SI units.
    #[test]
    fn prefixes_cost_no_rounding() {
        let cases = [
            ("10 kPa", 10e3),
            ("5 ms", 5e-3),
            ("0.3 mm", 0.3e-3),
            ("7um", 7e-6),
            ("-2.5e2 GPa", -2.5e11),
            ("+.5 m", 0.5),
            ("1060 kg/m^3", 1060.0),
            ("1.06 g/cm³", 1060.0),
            ("12%", 0.12),
            ("3.", 3.0),
            ("  9.81 m/s^2 ", 9.81),
            ("2 h", 7200.0),
            ("0 mm", 0.0),
            ("250 mL", 250e-6),
            ("50 /s", 50.0),
        ];
        for (text, value) in cases {
            assert_eq!(parse_quantity(text).unwrap().value, value, "{text}");
        }
        // 30 · (π/180) takes two roundings more than π/6
        let angle = quantity_in("30 deg", "rad").unwrap();
        assert!((angle - std::f64::consts::FRAC_PI_6).abs() <= 2.0 * f64::EPSILON * angle);
    }

    #[test]
    fn multiples_of_the_expected_unit() {
        assert_eq!(quantity_in("10 kPa", "Pa"), Ok(10e3));
        assert_eq!(quantity_in("3 mm", "m"), Ok(0.003));
        assert_eq!(quantity_in("3 m", "mm"), Ok(3000.0));
        assert_eq!(quantity_in("2 N s/m", "kg/s"), Ok(2.0));
        assert_eq!(quantity_in("0.25", ""), Ok(0.25));
        assert_eq!(quantity_in("25 %", ""), Ok(0.25));
        assert_eq!(quantity_in("90 min", "h"), Ok(1.5));
    }

    /// The message names both dimensions and shows how the wanted one is written.
    #[test]
    fn wrong_dimension() {
        let message = |text: &str, unit: &str| quantity_in(text, unit).unwrap_err().to_string();
        assert_eq!(
            message("10 kPa", "m"),
            "`10 kPa` is a pressure [kg/(m s²)], but a length [m] is wanted, such as \"3 mm\""
        );
        assert_eq!(
            message("10", "Pa"),
            "`10` is a pure number, but a pressure [kg/(m s²)] is wanted, such as \"10 kPa\""
        );
        assert_eq!(
            message("10 m", ""),
            "`10 m` is a length [m], but a pure number is wanted, such as \"0.3\""
        );
        assert_eq!(
            message("1 kg^2", "m^5"),
            "`1 kg^2` is a quantity in [kg²], but a quantity in [m⁵] is wanted, such as \"1 m^5\""
        );
        assert!(
            message("1 m", "quux").starts_with("the wanted unit `quux` is itself wrong: there is no unit")
        );
    }

    #[test]
    fn faulty_quantities() {
        let error = |text: &str| parse_quantity(text).unwrap_err();
        for text in ["", "kPa", "-", ".", "nan", "inf m", "e3", "− 3 mm"] {
            assert!(matches!(error(text), UnitError::MissingNumber { .. }), "{text}");
        }
        assert_eq!(error("5 kpa").span(), Span::new(2, 5));
        assert_eq!(error("1,5 mm").span(), Span::new(1, 2));
        assert_eq!(error("3 mm!").span(), Span::new(4, 5));
        assert_eq!(error("5 1").span(), Span::new(3, 3));
        assert!(matches!(error("3 4 mm"), UnitError::Unexpected { .. }));
        for text in ["1e999 m", "1e-999 m", "1e300 GPa^9", "1e99999999999999999999 m"] {
            assert!(matches!(error(text), UnitError::OutOfRange { .. }), "{text}");
        }
    }

    proptest! {
        /// Any number printed with a unit of scale one is read back with the same bits.
        #[test]
        fn numbers_print_and_parse(value in proptest::num::f64::NORMAL | proptest::num::f64::ZERO) {
            prop_assert_eq!(quantity_in(&format!("{value:e} m"), "m"), Ok(value));
        }

        #[test]
        fn any_text_is_answered(text in "\\PC*", soup in "[0-9.eE+ mkPa/^()²-]{0,30}") {
            for text in [text, soup] {
                if let Err(error) = parse_quantity(&text) {
                    prop_assert!(error.span().start <= error.span().end && error.span().end <= text.len());
                }
            }
        }
    }
}
