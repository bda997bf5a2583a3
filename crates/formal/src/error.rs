//! Why a text is not a formula.

use std::fmt;

use crate::Span;

/// What an expression stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Number,
    /// True or false: the outcome of a comparison.
    Truth,
    /// A list in brackets, with its length.
    Vector(usize),
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number => f.write_str("a number"),
            Self::Truth => f.write_str("a truth value such as `x > 0`"),
            Self::Vector(length) => write!(f, "a vector of {length}"),
        }
    }
}

/// Why a text is not a formula: the place, what was read, what would be accepted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ParseError {
    #[error("a formula of {length} bytes is too long; at most {limit} are accepted")]
    TooLong { length: usize, limit: usize },
    #[error("the formula is nested more than {limit} deep at {span}; name its parts instead")]
    TooDeep { limit: usize, span: Span },
    #[error("{read} was read at {span}, where {expected} is wanted")]
    Unexpected { read: String, expected: String, span: Span },
    #[error("`{read}` at {span} is too large a number; at most 1.797e308 is accepted")]
    NumberTooLarge { read: String, span: Span },
    #[error("there is no `{name}` (at {span}){}; there are: {}", did_you_mean(.nearest), .known.join(", "))]
    UnknownName { name: String, nearest: Option<String>, known: Vec<String>, span: Span },
    #[error("there is no function `{name}` (at {span}){}; there are: {}", did_you_mean(.nearest), .known.join(", "))]
    UnknownFunction { name: String, nearest: Option<String>, known: Vec<String>, span: Span },
    #[error("`{name}` at {span} is a function; write `{usage}`")]
    WithoutArguments { name: String, usage: &'static str, span: Span },
    #[error("`{name}` at {span} is no function; for a product a `*` is missing, as in `{name} * (…)`")]
    NotAFunction { name: String, span: Span },
    #[error("`{name}` at {span} was given {found} argument(s); write `{usage}`")]
    WrongArgumentCount { name: String, found: usize, usage: &'static str, span: Span },
    #[error("{found} stands at {span}, where {wanted} is wanted")]
    WrongKind { found: Kind, wanted: Kind, span: Span },
}

pub(crate) fn did_you_mean(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|name| format!(" (did you mean `{name}`?)")).unwrap_or_default()
}

impl ParseError {
    /// The message without the place, for those who show it.
    pub fn without_place(&self) -> String {
        self.span().taken_out_of(&self.to_string())
    }

    /// The place in the text that was read.
    pub fn span(&self) -> Span {
        match self {
            Self::TooLong { length, .. } => Span::new(0, *length),
            Self::TooDeep { span, .. }
            | Self::Unexpected { span, .. }
            | Self::NumberTooLarge { span, .. }
            | Self::UnknownName { span, .. }
            | Self::UnknownFunction { span, .. }
            | Self::WithoutArguments { span, .. }
            | Self::NotAFunction { span, .. }
            | Self::WrongArgumentCount { span, .. }
            | Self::WrongKind { span, .. } => *span,
        }
    }
}
