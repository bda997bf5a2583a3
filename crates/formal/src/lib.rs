//! Physics as text: formulas with units, and laws that are read, derived and compiled.
//!
//! - [`law`]: a strain energy as text, read, differentiated and tried; what it does at rest.
//! - [`graph`]: expressions of numbers, vectors and matrices in which equal ones are one; derivatives, simplification, grouping of
//!   constants, common parts.
//! - [`element`]: forces and differentials of an element under a law, by the data of the element alone.
//! - [`tape`]: instructions over lanes that run what was derived, without a compiler.
//! - [`emit`]: what was derived as text, LaTeX, Rust, WGSL or a program of Maxima.
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
mod hashing;
mod interval;
pub mod law;
mod lexer;
mod parser;
mod polynomial;
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

/// The version of what derives and compiles: what it made is the same whenever this is.
pub const DERIVATION: &str = concat!(env!("CARGO_PKG_VERSION"), " ", env!("SOUPLE_DERIVATION"));
