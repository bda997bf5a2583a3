//! Scene files: text to specification to model and state.
//!
//! [`read_file`] gives a [`Document`]: texts, includes, overrides and parameters put together. Its [`Spec`] says what
//! the text says; the scene compiled from it is ready to run. Whatever is wrong is collected in [`Diagnostics`],
//! each with its place, what was read and what would be accepted.

pub mod diagnostic;
mod document;
mod include;
mod keys;
mod overrides;
mod parameters;
mod reader;
pub mod source;
pub mod spec;
mod values;

pub use diagnostic::{Code, Diagnostic, Diagnostics};
pub use spec::Spec;
