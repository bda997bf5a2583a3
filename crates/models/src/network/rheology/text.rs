//! Reads a network: `spring(1 kN/m) - (damper(10 N s/m) | slider(5 N))`.
//!
//! ```text
//! parallel = series { "|" series }
//! series   = element { "-" element }
//! element  = "(" parallel ")" | name "(" number { "," number } ")"
//! ```

use souple_formal::Span;
use souple_table::nearest;

use super::{Network, SLIDERS};
use crate::network::written::WRITTEN_MEMORY;

/// Brackets within brackets.
const DEPTH: usize = 32;
/// Elements of a network.
const ELEMENTS: usize = 64;

const NAMES: [&str; 3] = ["spring", "damper", "slider"];

/// Why a text is no network.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RheologyError {
    #[error("{read} was read at {span}, where {expected} is wanted")]
    Unexpected { read: String, expected: &'static str, span: Span },
    #[error("there is no element `{name}` (at {span}){}; there are: spring(k), damper(z), slider(Q), slider(Qt, Qc)",
        .nearest.map(|name| format!(" (did you mean `{name}`?)")).unwrap_or_default())]
    UnknownElement { name: String, nearest: Option<&'static str>, span: Span },
    #[error("`{element}` at {span} was given {found} number(s); write {usage}")]
    WrongCount { element: &'static str, found: usize, usage: &'static str, span: Span },
    #[error("the number of `{element}` at {span}: {problem}")]
    Number { element: &'static str, span: Span, problem: String },
    #[error("brackets are nested more than {DEPTH} deep at {span}")]
    TooDeep { span: Span },
    #[error("there are {found} {what}; at most {most} are accepted")]
    TooMany { found: usize, what: &'static str, most: usize },
    #[error("nothing gives way before a slider slips: put a spring or a damper in series with it")]
    Rigid,
}

impl RheologyError {
    /// The place in the text, where there is one.
    pub fn span(&self) -> Option<Span> {
        match self {
            Self::Unexpected { span, .. }
            | Self::UnknownElement { span, .. }
            | Self::WrongCount { span, .. }
            | Self::Number { span, .. }
            | Self::TooDeep { span } => Some(*span),
            Self::TooMany { .. } | Self::Rigid => None,
        }
    }

    /// The message without the place, for those who show it.
    pub fn without_place(&self) -> String {
        let message = self.to_string();
        self.span().map_or_else(|| message.clone(), |span| span.taken_out_of(&message))
    }
}

/// Gives the value in SI units of a number that is written in this unit, or one of its kind, or without.
pub type ReadNumber<'a> = dyn Fn(&str, &str) -> Result<f64, String> + 'a;

/// Reads a network; `number` gives the values of its numbers.
///
/// # Errors
/// Names the place, what was read and what would be accepted.
pub fn read(text: &str, number: &ReadNumber) -> Result<Network, RheologyError> {
    let mut reader = Reader { text, at: 0, number, elements: 0, remembered: 0 };
    let network = reader.parallel(0)?;
    reader.skip_blanks();
    if reader.at < text.len() {
        return Err(reader.unexpected("`-`, `|` or the end"));
    }
    let limits = [
        (reader.elements, "elements", ELEMENTS),
        (reader.remembered, "dampers and sliders", WRITTEN_MEMORY),
        (network.slider_count(), "sliders", SLIDERS),
    ];
    if let Some((found, what, most)) = limits.into_iter().find(|(found, _, most)| found > most) {
        return Err(RheologyError::TooMany { found, what, most });
    }
    if network.stiffest(1.0).is_infinite() {
        return Err(RheologyError::Rigid);
    }
    Ok(network)
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    number: &'a ReadNumber<'a>,
    elements: usize,
    remembered: usize,
}

impl<'a> Reader<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn skip_blanks(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }

    /// Passes `symbol` if it comes next.
    fn takes(&mut self, symbol: char) -> bool {
        self.skip_blanks();
        let found = self.rest().starts_with(symbol);
        if found {
            self.at += symbol.len_utf8();
        }
        found
    }

    fn unexpected(&self, expected: &'static str) -> RheologyError {
        let read = self.rest().chars().next();
        let end = self.at + read.map_or(0, char::len_utf8);
        let read = read.map_or_else(|| "the end".to_owned(), |symbol| format!("`{symbol}`"));
        RheologyError::Unexpected { read, expected, span: Span::new(self.at, end) }
    }

    fn parallel(&mut self, depth: usize) -> Result<Network, RheologyError> {
        let parts = self.joined('|', |reader| reader.series(depth))?;
        Ok(alone(parts).unwrap_or_else(Network::Parallel))
    }

    fn series(&mut self, depth: usize) -> Result<Network, RheologyError> {
        let parts = self.joined('-', |reader| reader.element(depth))?;
        Ok(alone(parts).unwrap_or_else(Network::Series))
    }

    fn joined(
        &mut self,
        symbol: char,
        part: impl Fn(&mut Self) -> Result<Network, RheologyError>,
    ) -> Result<Vec<Network>, RheologyError> {
        let mut parts = vec![part(self)?];
        while self.takes(symbol) {
            parts.push(part(self)?);
        }
        Ok(parts)
    }

    fn element(&mut self, depth: usize) -> Result<Network, RheologyError> {
        if depth > DEPTH {
            return Err(RheologyError::TooDeep { span: Span::new(self.at, self.at + 1) });
        }
        if self.takes('(') {
            let inside = self.parallel(depth + 1)?;
            return if self.takes(')') { Ok(inside) } else { Err(self.unexpected("`-`, `|` or `)`")) };
        }
        self.skip_blanks();
        let start = self.at;
        let is_of_name = |symbol: char| symbol.is_alphanumeric() || symbol == '_';
        let len = self.rest().find(|symbol| !is_of_name(symbol)).unwrap_or(self.rest().len());
        if len == 0 {
            return Err(self.unexpected("spring(…), damper(…), slider(…) or `(`"));
        }
        let span = Span::new(start, start + len);
        let name = span.of(self.text);
        let Some(element) = NAMES.into_iter().find(|known| *known == name) else {
            let nearest = nearest(name, NAMES);
            return Err(RheologyError::UnknownElement { name: name.to_owned(), nearest, span });
        };
        self.at += len;
        let numbers = self.numbers(element)?;
        self.elements += 1;
        match (element, numbers[..].len()) {
            ("spring", 1) => Ok(Network::Spring { stiffness: numbers[0] }),
            ("damper", 1) => Ok(Network::Damper { viscosity: numbers[0], memory: self.remember() }),
            ("slider", 1 | 2) => {
                let yields = [numbers[numbers.len() - 1], numbers[0]];
                Ok(Network::Slider { yields, memory: self.remember() })
            }
            (_, found) => {
                let usage = match element {
                    "spring" => "spring(k) with its stiffness",
                    "damper" => "damper(z) with its viscosity",
                    _ => "slider(Q), or slider(Qt, Qc) with what it holds in traction and in compression",
                };
                Err(RheologyError::WrongCount { element, found, usage, span })
            }
        }
    }

    fn remember(&mut self) -> usize {
        self.remembered += 1;
        self.remembered - 1
    }

    /// The numbers in the brackets behind an element.
    fn numbers(&mut self, element: &'static str) -> Result<Vec<f64>, RheologyError> {
        if !self.takes('(') {
            return Err(self.unexpected("`(` and a number"));
        }
        let unit = match element {
            "spring" => "N/m",
            "damper" => "N s/m",
            _ => "N",
        };
        let mut numbers = Vec::new();
        loop {
            let (start, mut depth) = (self.at, 0_usize);
            let is_end = |symbol: char| {
                match symbol {
                    '(' => depth += 1,
                    ')' | ',' if depth == 0 => return true,
                    ')' => depth -= 1,
                    _ => {}
                }
                false
            };
            let Some(len) = self.rest().find(is_end) else {
                self.at = self.text.len();
                return Err(self.unexpected("`)`"));
            };
            let span = Span::new(start, start + len);
            let problem = |problem| RheologyError::Number { element, span, problem };
            let value = (self.number)(span.of(self.text).trim(), unit).map_err(problem)?;
            if !(value.is_finite() && value > 0.0) {
                return Err(problem(format!("is {value}, but must be finite and above zero")));
            }
            numbers.push(value);
            self.at += len;
            if !self.takes(',') {
                self.takes(')');
                return Ok(numbers);
            }
        }
    }
}

/// The only part, or all of them.
fn alone(mut parts: Vec<Network>) -> Result<Network, Vec<Network>> {
    if parts.len() == 1 { parts.pop().ok_or(parts) } else { Err(parts) }
}
