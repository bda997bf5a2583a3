//! Units of measurement: their text read into a scale and a dimension.
//!
//! `unit = factor { [*|·] factor } { / factor }`, `factor = (symbol | ( unit ) | 1) [power]`. A product after a
//! quotient (`kg/m s`) is read differently by different people and therefore refused.

mod quantity;
mod table;

pub use quantity::{Quantity, parse_quantity, quantity_in};
pub use table::{UnitEntry, units};

use crate::{Dimension, Span, span::shortened};

/// Longest text of a unit or quantity [bytes].
const TEXT_LIMIT: usize = 1024;
/// Deepest nesting of parentheses in a unit.
const NESTING_LIMIT: usize = 16;
/// Largest power of a unit, either sign.
const POWER_LIMIT: i8 = 12;

/// What a unit measures and how large it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    scale: Scale,
    pub dimension: Dimension,
}

/// `10^exponent · numerator / denominator` SI units.
///
/// Kept apart so that decimal units stay exact: `"35 ms"` is the number nearest to 0.035, not `35 · 0.001`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Scale {
    numerator: f64,
    denominator: f64,
    exponent: i32,
}

impl Unit {
    /// The pure number 1.
    pub const ONE: Self = Self::decimal(0, Dimension::NONE);

    const fn decimal(exponent: i32, dimension: Dimension) -> Self {
        Self { scale: Scale { numerator: 1.0, denominator: 1.0, exponent }, dimension }
    }

    const fn fraction(numerator: f64, denominator: f64, dimension: Dimension) -> Self {
        Self { scale: Scale { numerator, denominator, exponent: 0 }, dimension }
    }

    /// SI units in one of these: 1000 for `kPa`.
    pub fn scale(&self) -> f64 {
        self.scale.of("1")
    }

    /// `self · other^power`, or `None` where the dimension's powers grow too large.
    fn times(self, other: Self, power: i8) -> Option<Self> {
        let dimension = self.dimension.times(other.dimension, power)?;
        let mut scale = self.scale;
        for _ in 0..power.unsigned_abs() {
            let factors = (other.scale.numerator, other.scale.denominator);
            let (above, below) = if power > 0 { factors } else { (factors.1, factors.0) };
            scale.numerator *= above;
            scale.denominator *= below;
        }
        scale.exponent = scale.exponent.saturating_add(other.scale.exponent.saturating_mul(i32::from(power)));
        Some(Self { scale, dimension })
    }
}

impl Scale {
    /// `digits`, a number as Rust reads it, in SI units.
    fn of(&self, digits: &str) -> f64 {
        let (mantissa, own) = digits.split_once(['e', 'E']).unwrap_or((digits, "0"));
        // an exponent beyond i32 saturates: the number is zero or infinite either way
        let own: i32 = own.parse().unwrap_or(if own.starts_with('-') { i32::MIN / 2 } else { i32::MAX / 2 });
        let shifted = format!("{mantissa}e{}", own.saturating_add(self.exponent));
        let value: f64 = shifted.parse().unwrap_or(f64::NAN);
        value * self.numerator / self.denominator
    }
}

/// Why a text is no quantity, or not the one wanted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{fault}")]
pub struct UnitError {
    /// The part of the text at fault.
    pub span: Span,
    pub fault: UnitFault,
}

/// The kinds of [`UnitError`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum UnitFault {
    #[error("the text has {bytes} bytes, but a quantity may have at most {TEXT_LIMIT}")]
    TextTooLong { bytes: usize },
    #[error("read {read}, but a number is wanted, such as {example}")]
    MissingNumber { read: String, example: String },
    #[error("`{read}` is too large: a number is at most 1.8e308 in SI units")]
    NumberTooLarge { read: String },
    #[error("there is no unit `{symbol}`{}", .nearest.as_ref().map_or(", write one such as `mm`, `kPa`, `kg/m^3`".to_owned(), |near| format!(" (did you mean `{near}`?)")))]
    UnknownUnit { symbol: String, nearest: Option<String> },
    #[error("read {read}, but {expected} is wanted")]
    Unexpected { read: String, expected: &'static str },
    #[error(
        "a product after a quotient can be read in two ways; write parentheses, such as `kg/(m s)`, or the product first"
    )]
    AmbiguousQuotient,
    #[error("the power `{read}` is not a whole number between -{POWER_LIMIT} and {POWER_LIMIT}")]
    BadPower { read: String },
    #[error("the unit's powers add up to more than a dimension holds (127)")]
    PowersTooLarge,
    #[error("parentheses are nested more than {NESTING_LIMIT} deep")]
    TooDeep,
    #[error("`{quantity}` is {found}, but {wanted} is wanted, such as \"{example}\"")]
    WrongDimension { quantity: String, found: String, wanted: String, example: String },
    #[error("the unit `{unit}` that a quantity is wanted in cannot be read: {because}")]
    BadWantedUnit { unit: String, because: Box<UnitFault> },
}

impl UnitError {
    fn new(start: usize, end: usize, fault: UnitFault) -> Self {
        Self { span: Span::new(start, end), fault }
    }
}

/// Reads a unit such as `kPa`, `kg/m^3`, `N s/m`, `m²`, `W/(m² K)`; the empty text and `1` are pure numbers.
///
/// # Errors
/// Names the part that cannot be read and what would be accepted.
pub fn parse_unit(text: &str) -> Result<Unit, UnitError> {
    if text.len() > TEXT_LIMIT {
        return Err(UnitError::new(0, text.len(), UnitFault::TextTooLong { bytes: text.len() }));
    }
    parse_unit_from(text, 0)
}

/// Reads the unit that fills `text` from byte `start` on.
fn parse_unit_from(text: &str, start: usize) -> Result<Unit, UnitError> {
    let mut reader = Reader { text, at: start };
    reader.skip_blanks();
    if reader.peek().is_none() {
        return Ok(Unit::ONE);
    }
    let unit = reader.product(0)?;
    match reader.peek() {
        None => Ok(unit),
        Some(_) => Err(reader.unexpected("a unit, `/`, `^` or the end")),
    }
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
}

impl Reader<'_> {
    fn peek(&self) -> Option<char> {
        self.text[self.at..].chars().next()
    }

    fn take_while(&mut self, wanted: impl Fn(char) -> bool) -> &str {
        let rest = &self.text[self.at..];
        let taken = &rest[..rest.find(|c| !wanted(c)).unwrap_or(rest.len())];
        self.at += taken.len();
        taken
    }

    fn skip_blanks(&mut self) {
        self.take_while(char::is_whitespace);
    }

    fn unexpected(&self, expected: &'static str) -> UnitError {
        let (read, width) = self.peek().map_or(("the end of the text".to_owned(), 0), |_| {
            let rest = &self.text[self.at..];
            let word = rest.split(char::is_whitespace).next().filter(|word| !word.is_empty()).unwrap_or(rest);
            (format!("`{}`", shortened(word)), word.len())
        });
        UnitError::new(self.at, self.at + width, UnitFault::Unexpected { read, expected })
    }

    /// Factors side by side or after `/`, to the end or a closing parenthesis.
    fn product(&mut self, depth: usize) -> Result<Unit, UnitError> {
        let mut product = self.factor(depth)?;
        let mut divided = false;
        loop {
            self.skip_blanks();
            let start = self.at;
            let power = match self.peek() {
                None | Some(')') => return Ok(product),
                Some('/') => {
                    self.at += 1;
                    divided = true;
                    -1
                }
                Some(sign @ ('*' | '·' | '⋅' | '×')) => {
                    self.at += sign.len_utf8();
                    1
                }
                Some(c) if c == '(' || is_symbol(c) => 1,
                Some(_) => return Err(self.unexpected("a unit, `*`, `/`, `^` or the end")),
            };
            self.skip_blanks();
            let factor = self.factor(depth)?;
            if power > 0 && divided {
                return Err(UnitError::new(start, self.at, UnitFault::AmbiguousQuotient));
            }
            product = product
                .times(factor, power)
                .ok_or_else(|| UnitError::new(start, self.at, UnitFault::PowersTooLarge))?;
        }
    }

    /// One symbol, `1` or unit in parentheses, with its power.
    fn factor(&mut self, depth: usize) -> Result<Unit, UnitError> {
        let start = self.at;
        let base = match self.peek() {
            Some('(') if depth == NESTING_LIMIT => {
                return Err(UnitError::new(start, start + 1, UnitFault::TooDeep));
            }
            Some('(') => {
                self.at += 1;
                self.skip_blanks();
                let inner = self.product(depth + 1)?;
                if self.peek() != Some(')') {
                    return Err(self.unexpected("a unit or `)`"));
                }
                self.at += 1;
                inner
            }
            Some('1') => {
                self.at += 1;
                Unit::ONE
            }
            Some(c) if is_symbol(c) => {
                let symbol = self.take_while(is_symbol).to_owned();
                table::find(&symbol).ok_or_else(|| {
                    let nearest = table::nearest_symbol(&symbol);
                    let fault = UnitFault::UnknownUnit { symbol: shortened(&symbol), nearest };
                    UnitError::new(start, start + symbol.len(), fault)
                })?
            }
            _ => return Err(self.unexpected("a unit such as `mm`, `kPa`, `kg/m^3`")),
        };
        let power_start = self.at;
        let power = self.power()?;
        Unit::ONE
            .times(base, power)
            .ok_or_else(|| UnitError::new(power_start, self.at, UnitFault::PowersTooLarge))
    }

    /// `^2`, `^-1`, `²`, `⁻¹`, or nothing for 1.
    fn power(&mut self) -> Result<i8, UnitError> {
        let start = self.at;
        let digits: String = if self.peek() == Some('^') {
            self.at += 1;
            let sign = self.take_while(|c| c == '-' || c == '+').to_owned();
            sign + self.take_while(|c| c.is_ascii_digit())
        } else {
            self.take_while(|c| raised(c).is_some()).chars().filter_map(raised).collect()
        };
        if start == self.at {
            return Ok(1);
        }
        match digits.parse::<i8>() {
            Ok(power) if power.abs() <= POWER_LIMIT => Ok(power),
            _ => {
                let read = shortened(&self.text[start..self.at]);
                Err(UnitError::new(start, self.at, UnitFault::BadPower { read }))
            }
        }
    }
}

/// Whether `c` may stand in a unit's symbol.
fn is_symbol(c: char) -> bool {
    c.is_alphabetic() || matches!(c, '%' | '°')
}

/// The digit or sign that a raised character stands for.
fn raised(c: char) -> Option<char> {
    const RAISED: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹⁻";
    let at = RAISED.chars().position(|raised| raised == c)?;
    "0123456789-".chars().nth(at)
}
