//! The table of units and of prefixes.

use super::{Scale, Unit};
use crate::Dimension;

/// One unit people write.
#[derive(Clone, Copy, Debug)]
pub struct UnitEntry {
    /// As written in a quantity: `Pa`.
    pub symbol: &'static str,
    /// The word for it, singular: `pascal`.
    pub name: &'static str,
    pub unit: Unit,
    /// Whether SI prefixes may stand before it.
    pub prefixes: bool,
}

/// All units, without their prefixed forms.
pub fn units() -> &'static [UnitEntry] {
    UNITS
}

const fn prefixed(
    symbol: &'static str,
    name: &'static str,
    exponent: i32,
    dimension: Dimension,
) -> UnitEntry {
    UnitEntry { symbol, name, unit: Unit::decimal(exponent, dimension), prefixes: true }
}

const fn plain(symbol: &'static str, name: &'static str, unit: Unit) -> UnitEntry {
    UnitEntry { symbol, name, unit, prefixes: false }
}

const TIME: Dimension = Dimension::new(0, 0, 1);
const FREQUENCY: Dimension = Dimension::new(0, 0, -1);
const VOLUME: Dimension = Dimension::new(0, 3, 0);
const PRESSURE: Dimension = Dimension::new(1, -1, -2);
const PI: f64 = std::f64::consts::PI;

const UNITS: &[UnitEntry] = &[
    prefixed("m", "metre", 0, Dimension::new(0, 1, 0)),
    prefixed("g", "gram", -3, Dimension::new(1, 0, 0)),
    plain("t", "tonne", Unit::decimal(3, Dimension::new(1, 0, 0))),
    prefixed("s", "second", 0, TIME),
    plain("min", "minute", Unit::fraction(60.0, 1.0, TIME)),
    plain("h", "hour", Unit::fraction(3600.0, 1.0, TIME)),
    prefixed("Hz", "hertz", 0, FREQUENCY),
    plain("rpm", "revolution per minute", Unit::fraction(PI, 30.0, FREQUENCY)),
    prefixed("N", "newton", 0, Dimension::new(1, 1, -2)),
    prefixed("Pa", "pascal", 0, PRESSURE),
    plain("bar", "bar", Unit::decimal(5, PRESSURE)),
    plain("mmHg", "millimetre of mercury", Unit::fraction(133.322387415, 1.0, PRESSURE)),
    prefixed("J", "joule", 0, Dimension::new(1, 2, -2)),
    prefixed("W", "watt", 0, Dimension::new(1, 2, -3)),
    prefixed("L", "litre", -3, VOLUME),
    prefixed("l", "litre", -3, VOLUME),
    prefixed("K", "kelvin", 0, Dimension { temperature: 1, ..Dimension::NONE }),
    prefixed("rad", "radian", 0, Dimension::NONE),
    plain("deg", "degree", Unit::fraction(PI, 180.0, Dimension::NONE)),
    plain("°", "degree", Unit::fraction(PI, 180.0, Dimension::NONE)),
    plain("%", "percent", Unit::decimal(-2, Dimension::NONE)),
];

/// SI prefixes and their powers of ten; micro in its three spellings.
const PREFIXES: &[(&str, i32)] = &[
    ("T", 12),
    ("G", 9),
    ("M", 6),
    ("k", 3),
    ("h", 2),
    ("d", -1),
    ("c", -2),
    ("m", -3),
    ("u", -6),
    ("µ", -6),
    ("μ", -6),
    ("n", -9),
    ("p", -12),
];

/// The unit that `symbol` stands for; a unit's own symbol goes before a prefixed one (`min`, `Pa`).
pub(super) fn find(symbol: &str) -> Option<Unit> {
    if let Some(entry) = UNITS.iter().find(|entry| entry.symbol == symbol) {
        return Some(entry.unit);
    }
    PREFIXES.iter().find_map(|(prefix, exponent)| {
        let rest = symbol.strip_prefix(prefix)?;
        let entry = UNITS.iter().find(|entry| entry.prefixes && entry.symbol == rest)?;
        let Scale { exponent: own, .. } = entry.unit.scale;
        Some(Unit { scale: Scale { exponent: own + exponent, ..entry.unit.scale }, ..entry.unit })
    })
}

/// The known symbol that was probably meant: by its word, by its letters in another case, or by few edits.
pub(super) fn nearest_symbol(symbol: &str) -> Option<String> {
    // also turns the American spelling `meter`, `liter` into the international one
    let lower = symbol.to_lowercase();
    let word = lower.strip_suffix('s').unwrap_or(&lower);
    let word = word.strip_suffix("er").map_or(word.to_owned(), |stem| format!("{stem}re"));
    let by_word = |word: &str| UNITS.iter().find(|entry| entry.name == word || entry.name == lower);
    if let Some(entry) = by_word(&word) {
        return Some(entry.symbol.to_owned());
    }

    let bare = UNITS.iter().map(|entry| entry.symbol.to_owned());
    let with_prefix = UNITS
        .iter()
        .filter(|entry| entry.prefixes)
        .flat_map(|entry| PREFIXES.iter().map(move |(prefix, _)| format!("{prefix}{}", entry.symbol)));
    let known: Vec<String> = bare.chain(with_prefix).collect();
    if let Some(same_letters) = known.iter().find(|known| known.to_lowercase() == lower) {
        return Some(same_letters.clone());
    }
    souple_table::nearest(symbol, known.iter().map(String::as_str)).map(str::to_owned)
}
