//! A number with its unit, as scene files write it.

use super::{Reader, TEXT_LIMIT, Unit, UnitError, UnitFault, parse_unit, parse_unit_from};
use crate::{Dimension, span::shortened};

/// A physical quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// In SI units of `dimension`; finite.
    pub value_si: f64,
    pub dimension: Dimension,
}

/// A quantity with where its unit stands in the text.
struct Reading {
    quantity: Quantity,
    unit_start: usize,
}

/// Reads a quantity: a number and a unit, with or without a blank between (`10 kPa`, `5ms`, `30 deg`, `0.3`).
///
/// Numbers with decimal units are as exact as if written in SI units: `35 ms` has the bits of `0.035`.
///
/// # Errors
/// Names the part that cannot be read and what would be accepted.
pub fn parse_quantity(text: &str) -> Result<Quantity, UnitError> {
    read(text, "\"10 kPa\" or \"5 ms\"").map(|reading| reading.quantity)
}

/// Reads a quantity of the dimension of `expected_unit` and returns it measured in `expected_unit`, that is, for
/// an SI unit, in SI units. An empty `expected_unit` wants a pure number.
///
/// # Errors
/// The text is no quantity or one of another dimension.
pub fn quantity_in(text: &str, expected_unit: &str) -> Result<f64, UnitError> {
    let expected = parse_unit(expected_unit).map_err(|error| {
        let fault =
            UnitFault::BadWantedUnit { unit: shortened(expected_unit), because: Box::new(error.fault) };
        UnitError::new(0, text.len(), fault)
    })?;
    let example = example_of(expected.dimension, expected_unit);
    let Reading { quantity, unit_start } = read(text, &format!("\"{example}\""))?;

    if quantity.dimension == expected.dimension {
        return Ok(quantity.value_si / expected.scale());
    }
    let written = text.trim();
    let bare = unit_start == text.trim_end().len();
    let found = if bare { "a number without unit".to_owned() } else { quantity.dimension.described() };
    let wanted = expected.dimension.described();
    let start = if bare { text.len() - text.trim_start().len() } else { unit_start };
    let fault = UnitFault::WrongDimension { quantity: shortened(written), found, wanted, example };
    Err(UnitError::new(start, text.trim_end().len(), fault))
}

/// A quantity of `dimension` as one would write it.
fn example_of(dimension: Dimension, unit: &str) -> String {
    dimension.example().map_or_else(|| format!("1 {}", unit.trim()), str::to_owned)
}

fn read(text: &str, example: &str) -> Result<Reading, UnitError> {
    if text.len() > TEXT_LIMIT {
        return Err(UnitError::new(0, text.len(), UnitFault::TextTooLong { bytes: text.len() }));
    }
    let mut reader = Reader { text, at: 0 };
    reader.skip_blanks();
    let start = reader.at;
    if !skip_number(&mut reader) {
        let word = text[start..].split_whitespace().next().unwrap_or("");
        let read =
            if word.is_empty() { "the end of the text".to_owned() } else { format!("`{}`", shortened(word)) };
        let fault = UnitFault::MissingNumber { read, example: example.to_owned() };
        return Err(UnitError::new(start, start + word.len(), fault));
    }
    let digits = &text[start..reader.at];
    reader.skip_blanks();
    let unit_start = reader.at;
    let unit: Unit = parse_unit_from(text, unit_start)?;

    let value_si = unit.scale.of(digits);
    if !value_si.is_finite() {
        let end = text.trim_end().len();
        let fault = UnitFault::NumberTooLarge { read: shortened(&text[start..end]) };
        return Err(UnitError::new(start, end, fault));
    }
    Ok(Reading { quantity: Quantity { value_si, dimension: unit.dimension }, unit_start })
}

/// Passes over `[+-] digits [. digits] [e [+-] digits]`; false where no digit stands.
fn skip_number(reader: &mut Reader) -> bool {
    let digit = |c: char| c.is_ascii_digit();
    if matches!(reader.peek(), Some('+' | '-')) {
        reader.at += 1;
    }
    let mut found = !reader.take_while(digit).is_empty();
    if reader.peek() == Some('.') {
        reader.at += 1;
        found |= !reader.take_while(digit).is_empty();
    }
    // an `e` without digits behind it belongs to what follows
    let before_exponent = reader.at;
    if found && matches!(reader.peek(), Some('e' | 'E')) {
        reader.at += 1;
        if matches!(reader.peek(), Some('+' | '-')) {
            reader.at += 1;
        }
        if reader.take_while(digit).is_empty() {
            reader.at = before_exponent;
        }
    }
    found
}
