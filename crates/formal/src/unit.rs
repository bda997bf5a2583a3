//! Units of measurement: the table of symbols, and products, quotients and powers of them as text.
//!
//! A scale is kept as `factor · 10^decimal_exponent`, so that `3 mm` gives the same bits as `0.003`:
//! the power of ten joins the digits before these become a binary number.

use crate::dimension::SUPERSCRIPTS;
use crate::{Dimension, Span};

/// A unit: its dimension and how many SI units it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    pub dimension: Dimension,
    /// What remains of the scale beside the power of ten: 60 for a minute, π/180 for a degree, mostly 1.
    pub factor: f64,
    /// The power of ten of the scale: 3 for a kilopascal.
    pub decimal_exponent: i32,
}

impl Unit {
    /// The unit of a pure number.
    pub const ONE: Self = Self { dimension: Dimension::PURE, factor: 1.0, decimal_exponent: 0 };

    /// How many SI units of the same dimension this one is.
    pub fn scale(&self) -> f64 {
        self.factor * libm::exp10(f64::from(self.decimal_exponent))
    }

    fn times(self, other: Self) -> Option<Self> {
        Some(Self {
            dimension: self.dimension.times(other.dimension)?,
            factor: self.factor * other.factor,
            decimal_exponent: self.decimal_exponent.checked_add(other.decimal_exponent)?,
        })
    }

    fn power(self, exponent: i8) -> Option<Self> {
        let magnitude = (0..exponent.unsigned_abs()).fold(1.0, |product, _| product * self.factor);
        Some(Self {
            dimension: self.dimension.power(exponent)?,
            factor: if exponent < 0 { 1.0 / magnitude } else { magnitude },
            decimal_exponent: self.decimal_exponent.checked_mul(i32::from(exponent))?,
        })
    }
}

/// Why a quantity or a unit could not be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum UnitError {
    #[error("`{text}` does not begin with a finite number, as \"10 kPa\" does")]
    MissingNumber { text: String, span: Span },
    #[error("`{read}` is too large or too small a number once in SI units; 1e-300 to 1e300 are accepted")]
    OutOfRange { read: String, span: Span },
    #[error("there is no unit `{symbol}`{}; units are such as m, s, kg, N, Pa, J, W, Hz, deg, L, %, \
             with prefixes (mm, kPa), and products of them (kg/m^3, N s/m)", did_you_mean(.nearest))]
    UnknownUnit { symbol: String, nearest: Option<String>, span: Span },
    #[error("`{read}` was read where {expected} is wanted")]
    Unexpected { read: String, expected: &'static str, span: Span },
    #[error("a product after `/` can be meant in two ways; write `a/(b c)` or `a c/b`")]
    Ambiguous { span: Span },
    #[error("the power `{read}` is out of range; whole numbers from -9 to 9 are accepted")]
    Power { read: String, span: Span },
    #[error("a quantity of {length} bytes is too long; at most {limit} are accepted")]
    TooLong { length: usize, limit: usize, span: Span },
    #[error("`{text}` is {}, but {} is wanted, such as \"{example}\"", .found.describe(), .wanted.describe())]
    WrongDimension { text: String, found: Dimension, wanted: Dimension, example: String, span: Span },
    #[error("the wanted unit `{unit}` is itself wrong: {problem}")]
    WrongExpectation { unit: String, problem: Box<UnitError>, span: Span },
}

fn did_you_mean(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|name| format!(" (did you mean `{name}`?)")).unwrap_or_default()
}

impl UnitError {
    /// The place in the text that was read.
    pub fn span(&self) -> Span {
        match self {
            Self::MissingNumber { span, .. }
            | Self::OutOfRange { span, .. }
            | Self::UnknownUnit { span, .. }
            | Self::Unexpected { span, .. }
            | Self::Ambiguous { span }
            | Self::Power { span, .. }
            | Self::TooLong { span, .. }
            | Self::WrongDimension { span, .. }
            | Self::WrongExpectation { span, .. } => *span,
        }
    }
}

/// A unit that has a symbol of its own.
struct Symbol {
    symbol: &'static str,
    /// What people write instead; used only to suggest the symbol.
    words: &'static [&'static str],
    unit: Unit,
    prefixes: Prefixes,
}

/// Whether a symbol takes SI prefixes.
#[derive(Clone, Copy, PartialEq)]
enum Prefixes {
    All,
    None,
}

const fn symbol(
    symbol: &'static str,
    words: &'static [&'static str],
    (mass, length, time): (i8, i8, i8),
    (factor, decimal_exponent): (f64, i32),
    prefixes: Prefixes,
) -> Symbol {
    let dimension = Dimension::new(mass, length, time);
    Symbol { symbol, words, unit: Unit { dimension, factor, decimal_exponent }, prefixes }
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;
/// The conventional millimetre of mercury, 133.322387415 Pa (ISO 80000-4).
const MILLIMETRE_OF_MERCURY: f64 = 133.322_387_415;

const SYMBOLS: &[Symbol] = &[
    symbol("m", &["metre", "meter", "metres", "meters"], (0, 1, 0), (1.0, 0), Prefixes::All),
    symbol("g", &["gram", "grams", "gramme"], (1, 0, 0), (1.0, -3), Prefixes::All),
    symbol("s", &["sec", "secs", "second", "seconds"], (0, 0, 1), (1.0, 0), Prefixes::All),
    symbol("t", &["ton", "tons", "tonne", "tonnes"], (1, 0, 0), (1.0, 3), Prefixes::None),
    symbol("min", &["mins", "minute", "minutes"], (0, 0, 1), (60.0, 0), Prefixes::None),
    symbol("h", &["hr", "hrs", "hour", "hours"], (0, 0, 1), (36.0, 2), Prefixes::None),
    symbol("Hz", &["hertz"], (0, 0, -1), (1.0, 0), Prefixes::All),
    symbol("N", &["newton", "newtons"], (1, 1, -2), (1.0, 0), Prefixes::All),
    symbol("Pa", &["pascal", "pascals"], (1, -1, -2), (1.0, 0), Prefixes::All),
    symbol("bar", &["bars"], (1, -1, -2), (1.0, 5), Prefixes::All),
    symbol("mmHg", &["torr"], (1, -1, -2), (MILLIMETRE_OF_MERCURY, 0), Prefixes::None),
    symbol("J", &["joule", "joules"], (1, 2, -2), (1.0, 0), Prefixes::All),
    symbol("W", &["watt", "watts"], (1, 2, -3), (1.0, 0), Prefixes::All),
    symbol("L", &["litre", "liter", "litres", "liters"], (0, 3, 0), (1.0, -3), Prefixes::All),
    symbol("l", &[], (0, 3, 0), (1.0, -3), Prefixes::All),
    symbol("rad", &["radian", "radians"], (0, 0, 0), (1.0, 0), Prefixes::All),
    symbol("deg", &["degree", "degrees"], (0, 0, 0), (DEGREE, 0), Prefixes::None),
    symbol("°", &[], (0, 0, 0), (DEGREE, 0), Prefixes::None),
    symbol("%", &["percent"], (0, 0, 0), (1.0, -2), Prefixes::None),
];

/// SI prefixes and their powers of ten; micro in its three spellings.
const PREFIXES: &[(&str, i32)] = &[
    ("p", -12),
    ("n", -9),
    ("u", -6),
    ("µ", -6),
    ("μ", -6),
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("h", 2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

/// A unit as it is listed.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitEntry {
    pub symbol: &'static str,
    /// What it is in words, or in SI units.
    pub meaning: String,
    /// Prefixes it takes.
    pub prefixes: Vec<&'static str>,
}

/// All units that may be written, without their products.
pub fn units() -> impl Iterator<Item = UnitEntry> {
    SYMBOLS.iter().map(|entry| UnitEntry {
        symbol: entry.symbol,
        meaning: match entry.unit.dimension {
            Dimension::PURE => format!("the number {}", entry.unit.scale()),
            dimension if entry.unit.scale() == 1.0 => dimension.describe(),
            dimension => format!("{} SI units of {}", entry.unit.scale(), dimension.describe()),
        },
        prefixes: match entry.prefixes {
            Prefixes::All => PREFIXES.iter().map(|(prefix, _)| *prefix).collect(),
            Prefixes::None => Vec::new(),
        },
    })
}

/// The unit of a symbol with or without prefix; a symbol as a whole goes first (`min` is no milli-inch).
fn lookup(symbol: &str) -> Option<Unit> {
    let exact = |text: &str| SYMBOLS.iter().find(|entry| entry.symbol == text);
    if let Some(entry) = exact(symbol) {
        return Some(entry.unit);
    }
    PREFIXES.iter().find_map(|&(prefix, exponent)| {
        let entry = exact(symbol.strip_prefix(prefix)?).filter(|entry| entry.prefixes == Prefixes::All)?;
        let decimal_exponent = entry.unit.decimal_exponent + exponent;
        Some(Unit { decimal_exponent, ..entry.unit })
    })
}

/// What was probably meant by an unknown symbol.
fn suggestion(symbol: &str) -> Option<String> {
    let lower = symbol.to_lowercase();
    if let Some(entry) = SYMBOLS.iter().find(|entry| entry.words.contains(&lower.as_str())) {
        return Some(entry.symbol.to_owned());
    }
    // two units without the space between them: `Nm`, `Pas`
    let split = symbol.char_indices().skip(1).map(|(at, _)| symbol.split_at(at));
    if let Some((left, right)) = split.into_iter().find(|(l, r)| lookup(l).is_some() && lookup(r).is_some()) {
        return Some(format!("{left} {right}"));
    }
    let plain = SYMBOLS.iter().map(|entry| entry.symbol.to_owned());
    let prefixed = SYMBOLS.iter().filter(|entry| entry.prefixes == Prefixes::All).flat_map(|entry| {
        let usual = PREFIXES.iter().rev().filter(|(prefix, _)| prefix.is_ascii());
        usual.map(|(prefix, _)| format!("{prefix}{}", entry.symbol))
    });
    let all: Vec<String> = plain.chain(prefixed).collect();
    souple_table::nearest(symbol, all.iter().map(String::as_str)).map(str::to_owned)
}

/// Longest text of a quantity or unit [bytes].
pub(crate) const LONGEST: usize = 256;
/// Deepest nesting of parentheses: none is needed, one is usual.
const DEEPEST: usize = 8;
/// Largest magnitude of a written power.
const LARGEST_POWER: u32 = 9;

/// Reads a unit such as `kPa`, `kg/m^3`, `N s/m`, `m/s²`; empty text is the unit of a pure number.
///
/// # Errors
/// Names the unknown symbol with the nearest known one, or what was read and what would be accepted.
pub fn parse_unit(text: &str) -> Result<Unit, UnitError> {
    if text.len() > LONGEST {
        let span = Span::new(0, text.len());
        return Err(UnitError::TooLong { length: text.len(), limit: LONGEST, span });
    }
    if text.trim() == "1" { Ok(Unit::ONE) } else { parse_unit_from(text, 0) }
}

/// Reads the unit in `text` from byte `at` to the end.
pub(crate) fn parse_unit_from(text: &str, at: usize) -> Result<Unit, UnitError> {
    let mut reader = Reader { text, at, depth: 0 };
    reader.skip_spaces();
    match reader.peek() {
        None => Ok(Unit::ONE),
        Some(_) => reader.product(),
    }
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
}

impl Reader<'_> {
    fn peek(&self) -> Option<char> {
        self.text[self.at..].chars().next()
    }

    fn advance_while(&mut self, mut accepted: impl FnMut(char) -> bool) -> Span {
        let start = self.at;
        while let Some(next) = self.peek().filter(|&next| accepted(next)) {
            self.at += next.len_utf8();
        }
        Span::new(start, self.at)
    }

    fn skip_spaces(&mut self) {
        self.advance_while(char::is_whitespace);
    }

    fn advance_one(&mut self) -> Span {
        let mut first = true;
        self.advance_while(|_| std::mem::take(&mut first))
    }

    fn unexpected(&self, expected: &'static str) -> UnitError {
        let end = self.at + self.peek().map_or(0, char::len_utf8);
        let span = Span::new(self.at, end);
        let read = self.peek().map_or("the end".to_owned(), String::from);
        UnitError::Unexpected { read, expected, span }
    }

    /// Factors joined by spaces, `*`, `·`, `.` and `/`, up to the end or a closing parenthesis.
    fn product(&mut self) -> Result<Unit, UnitError> {
        let start = self.at;
        let mut divided = false;
        // a leading `/`, as in "5 /s", divides one
        let mut unit = if self.peek() == Some('/') { Unit::ONE } else { self.factor()? };
        loop {
            self.skip_spaces();
            let factor = match self.peek() {
                None => return Ok(unit),
                Some(')') if self.depth > 0 => return Ok(unit),
                Some('/') => {
                    self.advance_one();
                    self.skip_spaces();
                    divided = true;
                    self.factor()?.power(-1)
                }
                Some(next) => {
                    if matches!(next, '*' | '·' | '⋅' | '.') {
                        self.advance_one();
                        self.skip_spaces();
                    } else if !starts_symbol(next) && next != '(' {
                        return Err(self.unexpected("a unit, `/` or the end"));
                    }
                    let at = self.at;
                    let factor = self.factor()?;
                    if divided {
                        return Err(UnitError::Ambiguous { span: Span::new(at, self.at) });
                    }
                    Some(factor)
                }
            };
            let span = Span::new(start, self.at);
            let too_high = || UnitError::Power { read: span.of(self.text).to_owned(), span };
            unit = factor.and_then(|factor| unit.times(factor)).ok_or_else(too_high)?;
        }
    }

    /// A symbol, a product in parentheses, or the one of `1/s`; with its power.
    fn factor(&mut self) -> Result<Unit, UnitError> {
        let unit = match self.peek() {
            Some('(') if self.depth < DEEPEST => {
                self.advance_one();
                self.skip_spaces();
                self.depth += 1;
                let unit = self.product()?;
                self.depth -= 1;
                if self.peek() != Some(')') {
                    return Err(self.unexpected("`)`"));
                }
                self.advance_one();
                unit
            }
            Some('(') => return Err(self.unexpected("a unit without so many parentheses")),
            Some('1') => {
                self.advance_one();
                self.skip_spaces();
                return if self.peek() == Some('/') { Ok(Unit::ONE) } else { Err(self.unexpected("`/`")) };
            }
            Some(next) if starts_symbol(next) => {
                let span = self.advance_while(starts_symbol);
                let symbol = span.of(self.text);
                lookup(symbol).ok_or_else(|| UnitError::UnknownUnit {
                    symbol: symbol.to_owned(),
                    nearest: suggestion(symbol),
                    span,
                })?
            }
            _ => return Err(self.unexpected("a unit")),
        };
        self.power_of(unit)
    }

    /// `unit` raised to the power that follows as `^3`, `³`, `3` or `^-1`, if any.
    fn power_of(&mut self, unit: Unit) -> Result<Unit, UnitError> {
        let start = self.at;
        let caret = self.peek() == Some('^');
        if caret {
            self.advance_one();
        }
        let mut digits = String::new();
        self.advance_while(|next| {
            let digit = match next {
                '-' | '⁻' if digits.is_empty() => '-',
                _ => match SUPERSCRIPTS.iter().position(|&raised| raised == next) {
                    Some(digit) => char::from_digit(digit as u32, 10).unwrap_or(next),
                    None if next.is_ascii_digit() => next,
                    None => return false,
                },
            };
            digits.push(digit);
            true
        });
        if digits.is_empty() && !caret {
            return Ok(unit);
        }
        if digits.is_empty() || digits == "-" {
            return Err(self.unexpected("a whole number as power"));
        }
        let span = Span::new(start, self.at);
        let power = digits.parse().ok().filter(|power: &i8| u32::from(power.unsigned_abs()) <= LARGEST_POWER);
        power
            .and_then(|power| unit.power(power))
            .ok_or_else(|| UnitError::Power { read: span.of(self.text).to_owned(), span })
    }
}

fn starts_symbol(next: char) -> bool {
    next.is_alphabetic() || matches!(next, '%' | '°' | 'µ')
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn dimension(text: &str) -> Dimension {
        parse_unit(text).unwrap().dimension
    }

    /// Products, quotients, powers and raised digits mean what they mean on paper.
    #[test]
    fn compound_units() {
        assert_eq!(dimension("kg/m^3"), Dimension::new(1, -3, 0));
        assert_eq!(dimension("m/s^2"), dimension("m s⁻²"));
        assert_eq!(dimension("m/s²"), dimension("m/s/s"));
        assert_eq!(dimension("N s/m"), Dimension::new(1, 0, -1));
        assert_eq!(dimension("Pa s"), dimension("Pa·s"));
        assert_eq!(dimension("kg/(m s²)"), dimension("Pa"));
        assert_eq!(dimension("J"), dimension("N m"));
        assert_eq!(dimension("W"), dimension("J/s"));
        assert_eq!(dimension("1/s"), dimension("/s"));
        assert_eq!(dimension("L"), dimension("dm3"));
        assert_eq!(dimension(""), Dimension::PURE);
        assert_eq!(dimension("deg/s"), dimension("Hz"));
    }

    /// The scale of a unit in SI; powers of ten to 1e22 are exact numbers, so these compare exactly.
    #[test]
    fn scales() {
        let cases = [
            ("kPa", 1e3),
            ("GPa", 1e9),
            ("min", 60.0),
            ("h", 3600.0),
            ("t", 1e3),
            ("kg", 1.0),
            ("kg/mm^3", 1e9),
            ("km^2", 1e6),
            ("deg", DEGREE),
            ("hPa", 100.0),
        ];
        for (text, scale) in cases {
            assert_eq!(parse_unit(text).unwrap().scale(), scale, "{text}");
        }
        assert_eq!(parse_unit("mg").unwrap().decimal_exponent, -6);
        assert_eq!(parse_unit("µm").unwrap(), parse_unit("um").unwrap());
        assert_eq!(parse_unit("mL").unwrap(), parse_unit("cm^3").unwrap());
        assert_eq!(parse_unit("%").unwrap().decimal_exponent, -2);
    }

    /// Every symbol is found by itself, and no prefixed symbol hides another one.
    #[test]
    fn the_table_has_no_two_meanings() {
        let mut seen = std::collections::BTreeMap::new();
        for entry in SYMBOLS {
            assert_eq!(lookup(entry.symbol), Some(entry.unit));
            let prefixed = PREFIXES.iter().filter(|_| entry.prefixes == Prefixes::All);
            for text in prefixed.map(|(prefix, _)| format!("{prefix}{}", entry.symbol)) {
                assert_eq!(seen.insert(text.clone(), entry.symbol), None, "{text} has two meanings");
            }
        }
        for entry in SYMBOLS {
            assert!(!seen.contains_key(entry.symbol), "{} hides a prefixed unit", entry.symbol);
        }
    }

    /// Whoever writes a wrong symbol is told the right one, and where.
    #[test]
    fn unknown_symbols() {
        let cases = [
            ("kpa", "kPa"),
            ("KPa", "kPa"),
            ("seconds", "s"),
            ("Nm", "N m"),
            ("Pas", "Pa s"),
            ("kgs", "kg s"),
            ("newton", "N"),
            ("khz", "kHz"),
        ];
        for (text, meant) in cases {
            let Err(UnitError::UnknownUnit { nearest, span, .. }) = parse_unit(text) else {
                panic!("{text}")
            };
            assert_eq!((nearest.as_deref(), span), (Some(meant), Span::new(0, text.len())), "{text}");
        }
        let error = parse_unit("kg/zorks^3").unwrap_err();
        assert_eq!(error.span(), Span::new(3, 8));
        assert!(error.to_string().starts_with("there is no unit `zorks`;"), "{error}");
    }

    #[test]
    fn malformed_units() {
        let place = |text: &str| parse_unit(text).unwrap_err().span();
        assert_eq!(parse_unit("kg/m s"), Err(UnitError::Ambiguous { span: Span::new(5, 6) }));
        assert_eq!(place("kg/"), Span::new(3, 3));
        assert_eq!(place("(kg"), Span::new(3, 3));
        assert_eq!(place("kg)"), Span::new(2, 3));
        assert_eq!(place("m^"), Span::new(2, 2));
        assert_eq!(place("m^x"), Span::new(2, 3));
        assert_eq!(place("m^99"), Span::new(1, 4));
        assert_eq!(place("m +"), Span::new(2, 3));
        assert_eq!(place("m 1"), Span::new(2, 3));
        assert!(matches!(parse_unit(&"(m^9)^9 ".repeat(2)), Err(UnitError::Power { .. })));
        assert!(matches!(parse_unit(&"(".repeat(100)), Err(UnitError::Unexpected { .. })));
        assert!(matches!(parse_unit(&"m".repeat(1000)), Err(UnitError::TooLong { .. })));
    }

    proptest! {
        /// What a dimension prints is read back as that dimension, with scale one.
        #[test]
        fn dimensions_print_and_parse(mass in -9i8..=9, length in -9i8..=9, time in -9i8..=9) {
            let printed = Dimension::new(mass, length, time);
            let unit = parse_unit(&printed.to_string()).unwrap();
            // the gram is the symbol: kg^n is (10^3 g)^n with g = 10^-3 kg
            prop_assert_eq!(unit, Unit { dimension: printed, ..Unit::ONE });
        }

        #[test]
        fn any_text_is_answered(text in "\\PC*", units in "[kMmµgPasNh1-9^/()*· .²⁻%-]{0,40}") {
            for text in [text, units] {
                if let Err(error) = parse_unit(&text) {
                    prop_assert!(error.span().start <= error.span().end && error.span().end <= text.len());
                }
            }
        }
    }
}
