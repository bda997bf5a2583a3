//! What can be wrong with a formula's text, told to the one who wrote it.

use super::{Kind, NESTING_LIMIT, TEXT_LIMIT};
use crate::Span;

/// Why a text is no formula, or not the one wanted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{fault}")]
pub struct ParseError {
    /// The part of the text at fault; empty at the end of the text where something is missing.
    pub span: Span,
    pub fault: ParseFault,
}

impl ParseError {
    /// The message, and below it the place in the text with `^^^` under it.
    pub fn pointing_into(&self, text: &str) -> String {
        format!("{}, at byte {}:\n{}", self.fault, self.span.start, self.span.underlined(text))
    }
}

/// The kinds of [`ParseError`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ParseFault {
    #[error("the text has {bytes} bytes, but a formula may have at most {TEXT_LIMIT}")]
    TextTooLong { bytes: usize },
    #[error("expressions are nested more than {NESTING_LIMIT} deep")]
    TooDeep,
    #[error("the character {character:?} has no meaning here{}", .instead.map_or(String::new(), |instead| format!("; write {instead}")))]
    UnexpectedCharacter { character: char, instead: Option<&'static str> },
    #[error("the number `{read}` is too large: at most 1.8e308 is possible")]
    NumberTooLarge { read: String },
    #[error("read {read}, but {expected} is wanted")]
    Unexpected { read: String, expected: String },
    #[error("there is no variable or constant `{name}`{}; there are: {}", did_you_mean(.nearest), .known.join(", "))]
    UnknownName { name: String, nearest: Option<String>, known: Vec<String> },
    #[error("there is no function `{name}`{}; there are: {}", did_you_mean(.nearest), .known.join(", "))]
    UnknownFunction { name: String, nearest: Option<&'static str>, known: Vec<&'static str> },
    #[error("`{name}` is no function; a product is written `{name} * (...)`")]
    NotAFunction { name: String },
    #[error("`{name}` is a function: write `{signature}`")]
    FunctionWithoutArguments { name: &'static str, signature: &'static str },
    #[error("`{signature}` takes {takes}, not {given}")]
    WrongArgumentCount { signature: &'static str, takes: &'static str, given: usize },
    #[error("comparisons do not chain: write `a < b and b < c` for `a < b < c`")]
    ChainedComparison,
    #[error("`{read}` is {found}, but {wanted} is wanted{}", hint(*.found, *.wanted))]
    WrongKind { read: String, found: Kind, wanted: Kind },
}

fn did_you_mean<Name: std::fmt::Display>(nearest: &Option<Name>) -> String {
    nearest.as_ref().map(|name| format!(" (did you mean `{name}`?)")).unwrap_or_default()
}

fn hint(found: Kind, wanted: Kind) -> &'static str {
    match (found, wanted) {
        (Kind::Number, Kind::Condition) => ", such as `x > 0`",
        (Kind::Condition, Kind::Number) => ", such as `if(x > 0, 1, 0)`",
        (_, Kind::Vector(3)) => ", such as `[0, 0, 1]`",
        _ => "",
    }
}
