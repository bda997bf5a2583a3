//! Units and quantities: values to the bit, dimensions, and errors that help.

use proptest::prelude::*;
use souple_formal::{Dimension, Span, UnitFault, parse_quantity, parse_unit, quantity_in, units};
use std::f64::consts::PI;

/// Quantities with decimal units have the bits of the number written out; others are right to rounding.
#[test]
fn quantities_in_si() {
    let exact = [
        ("10 kPa", 1e4, Dimension::new(1, -1, -2)),
        ("10kPa", 1e4, Dimension::new(1, -1, -2)),
        ("  2.5 MPa ", 2.5e6, Dimension::new(1, -1, -2)),
        ("1 GPa", 1e9, Dimension::new(1, -1, -2)),
        ("5 ms", 0.005, Dimension::new(0, 0, 1)),
        ("35 ms", 0.035, Dimension::new(0, 0, 1)),
        ("7 us", 7e-6, Dimension::new(0, 0, 1)),
        ("7 µs", 7e-6, Dimension::new(0, 0, 1)),
        ("2 min", 120.0, Dimension::new(0, 0, 1)),
        ("0.5 h", 1800.0, Dimension::new(0, 0, 1)),
        ("-9.81 m/s^2", -9.81, Dimension::new(0, 1, -2)),
        ("1e-3 m/s^2", 1e-3, Dimension::new(0, 1, -2)),
        ("1e-3 m s^-2", 1e-3, Dimension::new(0, 1, -2)),
        ("+.5 m·s⁻²", 0.5, Dimension::new(0, 1, -2)),
        ("1 m/s/s", 1.0, Dimension::new(0, 1, -2)),
        ("1000 kg/m^3", 1000.0, Dimension::new(1, -3, 0)),
        ("1 g/cm³", 1000.0, Dimension::new(1, -3, 0)),
        ("3 t", 3000.0, Dimension::new(1, 0, 0)),
        ("3 mg", 3e-6, Dimension::new(1, 0, 0)),
        ("20 N/mm", 2e4, Dimension::new(1, 0, -2)),
        ("5 N s/m", 5.0, Dimension::new(1, 0, -1)),
        ("5 N*s/m", 5.0, Dimension::new(1, 0, -1)),
        ("4 mPa s", 4e-3, Dimension::new(1, -1, -1)),
        ("4 m²", 4.0, Dimension::new(0, 2, 0)),
        ("4 mm^2", 4e-6, Dimension::new(0, 2, 0)),
        ("1.5 L", 1.5e-3, Dimension::new(0, 3, 0)),
        ("250 mL", 2.5e-4, Dimension::new(0, 3, 0)),
        ("1 kHz", 1e3, Dimension::new(0, 0, -1)),
        ("60 1/min", 1.0, Dimension::new(0, 0, -1)),
        ("36 km/h", 10.0, Dimension::new(0, 1, -1)),
        ("2 kJ", 2e3, Dimension::new(1, 2, -2)),
        ("2 J/(kg K)", 2.0, Dimension { mass: 0, length: 2, time: -2, temperature: -1 }),
        ("120 mmHg", 120.0 * 133.322387415, Dimension::new(1, -1, -2)),
        ("45 %", 0.45, Dimension::NONE),
        ("180 deg", PI, Dimension::NONE),
        ("0.3", 0.3, Dimension::NONE),
        ("1.5 rad", 1.5, Dimension::NONE),
        ("1e999999999999", f64::NAN, Dimension::NONE),
        ("1e-999999999999 km", 0.0, Dimension::new(0, 1, 0)),
    ];
    for (text, value, dimension) in exact {
        match parse_quantity(text) {
            Ok(quantity) => {
                assert_eq!(quantity.value_si.to_bits(), value.to_bits(), "{text}: {}", quantity.value_si);
                assert_eq!(quantity.dimension, dimension, "{text}");
            }
            Err(error) => assert!(value.is_nan(), "{text}: {error}"),
        }
    }
    // the product and the quotient by 180 are each rounded once
    let thirty = parse_quantity("30 deg").unwrap().value_si;
    assert!((thirty - PI / 6.0).abs() <= 2.0 * f64::EPSILON * thirty);
}

/// Every unit of the table is read by its symbol, and a thousand millis of it make one.
#[test]
fn every_unit_is_read_with_its_prefixes() {
    for entry in units() {
        assert_eq!(parse_unit(entry.symbol).unwrap(), entry.unit, "{}", entry.symbol);
        let milli = parse_unit(&format!("m{}", entry.symbol));
        if entry.prefixes {
            let thousand = parse_quantity(&format!("1000 m{}", entry.symbol)).unwrap();
            assert_eq!(thousand.value_si, entry.unit.scale(), "{}", entry.symbol);
            assert_eq!(thousand.dimension, entry.unit.dimension);
        } else {
            assert_ne!(milli.map(|unit| unit.scale()), Ok(entry.unit.scale() * 1e-3), "{}", entry.symbol);
        }
    }
}

/// No two readings of one symbol: nothing in the table is also a prefixed form of something else.
#[test]
fn symbols_are_unambiguous() {
    let symbols: Vec<&str> = units().iter().map(|entry| entry.symbol).collect();
    for (at, symbol) in symbols.iter().enumerate() {
        assert!(!symbols[..at].contains(symbol), "{symbol} stands twice");
    }
}

/// A quantity is given back in the unit wanted; a bare number serves where a pure number is wanted.
#[test]
fn quantities_in_a_wanted_unit() {
    assert_eq!(quantity_in("10 kPa", "Pa"), Ok(1e4));
    assert_eq!(quantity_in("3 cm", "mm"), Ok(30.0));
    assert_eq!(quantity_in("5 ms", "s"), Ok(0.005));
    assert_eq!(quantity_in("2 N/m", "kg/s^2"), Ok(2.0));
    assert_eq!(quantity_in("90 deg", "rad"), Ok(PI / 2.0));
    assert_eq!(quantity_in("0.3", ""), Ok(0.3));
    assert_eq!(quantity_in("30 %", ""), Ok(0.3));
}

/// A wrong dimension is told in words, with what would be accepted.
#[test]
fn wrong_dimension_reads_well() {
    let error = quantity_in("10 kPa", "m").unwrap_err();
    let expected = "`10 kPa` is a pressure [kg/(m s²)], but a length [m] is wanted, such as \"3 mm\"";
    assert_eq!(error.to_string(), expected);
    assert_eq!(error.span, Span::new(3, 6));

    let error = quantity_in(" 10 ", "Pa").unwrap_err();
    let expected = "`10` is a number without unit, but a pressure [kg/(m s²)] is wanted, such as \"10 kPa\"";
    assert_eq!(error.to_string(), expected);
    assert_eq!(error.span, Span::new(1, 3));

    let error = quantity_in("5 s^5", "kg^2 m").unwrap_err();
    let expected = "`5 s^5` is a quantity in [s⁵], but a quantity in [kg² m] is wanted, such as \"1 kg^2 m\"";
    assert_eq!(error.to_string(), expected);

    let error = quantity_in("5 mm", "").unwrap_err();
    assert_eq!(error.to_string(), "`5 mm` is a length [m], but a pure number is wanted, such as \"0.3\"");
}

/// Every fault names what was read, where, and what would be accepted.
#[test]
fn faults_name_the_place() {
    let cases = [
        ("", 0..0, "read the end of the text, but a number is wanted"),
        ("kPa", 0..3, "read `kPa`, but a number is wanted"),
        ("- 5 m", 0..1, "read `-`, but a number is wanted"),
        ("inf m", 0..3, "read `inf`, but a number is wanted"),
        ("10 kpa", 3..6, "there is no unit `kpa` (did you mean `kPa`?)"),
        ("10 meters", 3..9, "there is no unit `meters` (did you mean `m`?)"),
        ("10 seconds", 3..10, "there is no unit `seconds` (did you mean `s`?)"),
        ("10 kg/mn^3", 6..8, "there is no unit `mn`"),
        ("10 furlong", 3..10, "there is no unit `furlong`, write one such as"),
        ("10 kPa 5", 7..8, "read `5`, but a unit, `*`, `/`, `^` or the end is wanted"),
        ("10 m3", 4..5, "read `3`, but a unit"),
        ("1,5 m", 1..3, "read `,5`, but a unit such as"),
        ("1 kg/m s", 6..8, "can be read in two ways"),
        ("1 /s", 2..4, "read `/s`, but a unit such as"),
        ("1 m/", 4..4, "read the end of the text, but a unit such as"),
        ("1 (m", 4..4, "read the end of the text, but a unit or `)` is wanted"),
        ("1 m)", 3..4, "read `)`, but a unit, `/`, `^` or the end is wanted"),
        ("1 m^", 3..4, "the power `^` is not a whole number between -12 and 12"),
        ("1 m^0.5", 5..7, "read `.5`"),
        ("1 m^99", 3..6, "the power `^99` is not"),
        ("1 m²⁻", 3..8, "the power `²⁻` is not"),
        ("1e308 km", 0..8, "`1e308 km` is too large"),
    ];
    for (text, span, message) in cases {
        let error = parse_quantity(text).expect_err(text);
        assert!(error.to_string().contains(message), "{text}: {error}");
        assert_eq!(error.span.start..error.span.end, span, "{text}: {error}");
    }
}

/// Absurd input ends in a typed error, not in a deep stack or an endless loop.
#[test]
fn absurd_quantities_are_refused() {
    let long = "9".repeat(10_000_000);
    assert!(matches!(parse_quantity(&long).unwrap_err().fault, UnitFault::TextTooLong { bytes: 10_000_000 }));
    assert_eq!(parse_unit(&"(".repeat(1000)).unwrap_err().fault, UnitFault::TooDeep);
    assert_eq!(parse_unit(&"m^12 ".repeat(11)).unwrap_err().fault, UnitFault::PowersTooLarge);
    assert_eq!(parse_unit(&"m^12".to_owned()).unwrap().dimension, Dimension::new(0, 12, 0));
    let error = quantity_in("1 m", "metre").unwrap_err();
    assert!(matches!(error.fault, UnitFault::BadWantedUnit { .. }), "{error}");
}

proptest! {
    /// Whatever the bytes, the answer is a finite quantity or an error whose span lies in the text.
    #[test]
    fn any_text_is_answered(text in ".{0,40}") {
        check_total(&text)?;
    }

    /// The same for texts made of the language's own pieces.
    #[test]
    fn any_mixture_is_answered(
        pieces in prop::collection::vec(
            prop::sample::select(vec![
                "1", "10", "-", "1e", "e5", ".", " ", "kPa", "m", "s", "/", "^", "²", "⁻", "(", ")", "*", "·", "%",
                "°", "deg", "-2", "^12", "999", "µ", "\u{0}", "é",
            ]),
            0..20,
        )
    ) {
        check_total(&pieces.concat())?;
    }

    /// A decimal unit only shifts the decimal point.
    #[test]
    fn decimal_units_are_exact(digits in -999_999i64..999_999, places in 0usize..6) {
        let number = format!("{:.places$}", digits as f64 / 10f64.powi(places as i32));
        let milli = parse_quantity(&format!("{number} ms")).unwrap().value_si;
        prop_assert_eq!(milli, format!("{number}e-3").parse::<f64>().unwrap());
    }

    /// A printed dimension is a unit of this dimension.
    #[test]
    fn dimensions_print_as_units(mass in -12i8..12, length in -12i8..12, time in -12i8..12, temperature in -12i8..12) {
        let dimension = Dimension { mass, length, time, temperature };
        let unit = parse_unit(&dimension.to_string()).unwrap();
        prop_assert_eq!(unit.dimension, dimension);
        prop_assert_eq!(unit.scale(), 1.0);
    }
}

fn check_total(text: &str) -> Result<(), TestCaseError> {
    match parse_quantity(text) {
        Ok(quantity) => prop_assert!(quantity.value_si.is_finite(), "{text:?}"),
        Err(error) => {
            prop_assert!(text.get(error.span.start..error.span.end).is_some(), "{text:?}: {error:?}");
            prop_assert!(!error.to_string().is_empty());
        }
    }
    let _ = quantity_in(text, "Pa");
    Ok(())
}
