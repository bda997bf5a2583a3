//! The expression language: units, parsing, evaluation.
//!
//! [`parse_quantity`] reads `"10 kPa"`, [`Formula`] computes `"0.1 * sin(2*pi*t)"` and its derivative,
//! [`Condition`] decides `"x > 0.5 and y < z"`, [`Expression`] is the syntax they share. Every error
//! points at a [`Span`] of the text.

mod arithmetic;
mod dimension;
pub mod element;
pub mod emit;
mod error;
mod expression;
mod formula;
mod function;
pub mod graph;
mod interval;
pub mod law;
mod lexer;
mod parser;
mod program;
mod quantity;
mod span;
pub mod tape;
mod unit;

pub use dimension::Dimension;
pub use error::{Kind, ParseError};
pub use expression::{BinaryOperator, Expression, Node, NodeId, NodeKind, UnaryOperator};
pub use formula::{Condition, Formula};
pub use function::{ArgumentCount, CONSTANTS, FUNCTIONS, Function, FunctionEntry};
pub use quantity::{Quantity, parse_quantity, quantity_in};
pub use span::Span;
pub use unit::{Unit, UnitEntry, UnitError, parse_unit, units};
