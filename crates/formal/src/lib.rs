//! The expression language: units, parsing, evaluation.

mod dimension;
mod quantity;
mod span;
mod unit;

pub use dimension::Dimension;
pub use quantity::{Quantity, parse_quantity, quantity_in};
pub use span::Span;
pub use unit::{Unit, UnitError, parse_unit};
