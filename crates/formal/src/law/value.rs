//! Values of the law language while a text is read: shape and unit beside the expression, and faults with their places.

use super::{LawError, LawProblem, UnitClash, WantedUnits};
use crate::Span;
use crate::graph::{Expr, Shape};

/// Powers of kilogram, metre and second; `None` where no unit was declared.
pub(super) type Units = Option<[f64; 3]>;

pub(super) const PURE: Units = Some([0.0; 3]);

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    Tensor(Shape),
    Truth,
}

#[derive(Clone, Copy)]
pub(super) struct Value {
    pub expr: Expr,
    pub kind: Kind,
    pub units: Units,
}

/// A fault of the node at hand, or of a definition that it needs.
pub(super) enum Fault {
    Here(Span, LawProblem),
    Elsewhere(LawError),
}

impl From<LawError> for Fault {
    fn from(error: LawError) -> Self {
        Self::Elsewhere(error)
    }
}

impl From<Fault> for LawError {
    fn from(fault: Fault) -> Self {
        match fault {
            Fault::Here(span, problem) => Self::new("energy", Some(span), problem),
            Fault::Elsewhere(error) => error,
        }
    }
}

pub(super) fn wrong_shape<T>(span: Span, found: String, wanted: &str) -> Result<T, Fault> {
    Err(Fault::Here(span, LawProblem::WrongShape { found, wanted: wanted.to_owned() }))
}

pub(super) fn wrong_count(span: Span, name: &str, found: usize, usage: &str) -> Fault {
    Fault::Here(
        span,
        LawProblem::WrongArgumentCount { name: name.to_owned(), found, usage: usage.to_owned() },
    )
}

pub(super) fn tensor(value: Value, span: Span) -> Result<Shape, Fault> {
    match value.kind {
        Kind::Tensor(shape) => Ok(shape),
        Kind::Truth => wrong_shape(span, describe(value.kind), "a number or tensor"),
    }
}

pub(super) fn scalar((value, span): (Value, Span)) -> Result<(), Fault> {
    match value.kind {
        Kind::Tensor(Shape::Scalar) => Ok(()),
        kind => wrong_shape(span, describe(kind), "a number"),
    }
}

pub(super) fn truth((value, span): (Value, Span)) -> Result<(), Fault> {
    match value.kind {
        Kind::Truth => Ok(()),
        kind => wrong_shape(span, describe(kind), "a truth value such as `J > 1`"),
    }
}

pub(super) fn describe(kind: Kind) -> String {
    match kind {
        Kind::Truth => "a truth value",
        Kind::Tensor(Shape::Scalar) => "a number",
        Kind::Tensor(Shape::Vector) => "a vector",
        Kind::Tensor(_) => "a 3x3 tensor",
    }
    .to_owned()
}

pub(super) fn combine(a: Units, b: Units, sign: f64) -> Units {
    let (a, b) = (a?, b?);
    Some([a[0] + sign * b[0], a[1] + sign * b[1], a[2] + sign * b[2]])
}

/// Units that do not fit; what is written there is filled in by the reader, who has the text.
pub(super) fn wrong_unit<T>(span: Span, found: [f64; 3], wanted: WantedUnits) -> Result<T, Fault> {
    Err(Fault::Here(span, LawProblem::WrongUnit(UnitClash::boxed(found, wanted))))
}

/// The units that all have; what has none declared takes any.
pub(super) fn common_units(values: &[(Value, Span)]) -> Result<Units, Fault> {
    let mut common: Option<([f64; 3], Span)> = None;
    for (value, span) in values {
        let Some(found) = value.units else { continue };
        match common {
            Some((units, beside)) if units != found => {
                return wrong_unit(*span, found, WantedUnits::Like { units, beside, written: String::new() });
            }
            Some(_) => {}
            None => common = Some((found, *span)),
        }
    }
    Ok(common.map(|(units, _)| units))
}

pub(super) fn pure((value, span): (Value, Span)) -> Result<(), Fault> {
    match value.units {
        Some(units) if units != [0.0; 3] => wrong_unit(span, units, WantedUnits::Pure),
        _ => Ok(()),
    }
}
