//! The expression language: units, parsing, evaluation.
