//! Operators of the law language, by the shapes and units of what they stand between.

use super::WantedUnits;
use super::read::Reader;
use super::value::{
    Fault, Kind, PURE, Value, combine, common_units, describe, pure, scalar, tensor, truth, wrong_shape,
    wrong_unit,
};
use crate::graph::{Comparison, Expr, Shape};
use crate::{BinaryOperator, Span};

impl Reader<'_> {
    pub(super) fn binary(
        &mut self,
        operator: BinaryOperator,
        span: Span,
        left: (Value, Span),
        right: (Value, Span),
    ) -> Result<Value, Fault> {
        let (a, b) = (left.0, right.0);
        let pure = |expr, kind| Ok(Value { expr, kind, units: PURE });
        match operator {
            BinaryOperator::And | BinaryOperator::Or => {
                truth(left)?;
                truth(right)?;
                let expr = if operator == BinaryOperator::And {
                    self.graph.times(a.expr, b.expr)
                } else {
                    self.graph.maximum(a.expr, b.expr)
                };
                pure(expr, Kind::Truth)
            }
            _ if operator.is_comparison() => {
                scalar(left)?;
                scalar(right)?;
                common_units(&[left, right])?;
                pure(self.comparison(operator, a.expr, b.expr), Kind::Truth)
            }
            BinaryOperator::Add | BinaryOperator::Subtract => {
                let (found, wanted) = (tensor(b, right.1)?, tensor(a, left.1)?);
                if found != wanted {
                    return wrong_shape(
                        right.1,
                        describe(b.kind),
                        &format!("{}, as on the left", describe(a.kind)),
                    );
                }
                let units = common_units(&[left, right])?;
                let expr = if operator == BinaryOperator::Add {
                    self.graph.add(a.expr, b.expr)
                } else {
                    self.graph.subtract(a.expr, b.expr)
                };
                Ok(Value { expr, kind: a.kind, units })
            }
            BinaryOperator::Multiply => {
                let units = combine(a.units, b.units, 1.0);
                let (expr, shape) = match (tensor(a, left.1)?, tensor(b, right.1)?) {
                    (Shape::Scalar, shape) => (self.graph.scale(a.expr, b.expr), shape),
                    (shape, Shape::Scalar) => (self.graph.scale(b.expr, a.expr), shape),
                    (Shape::Matrix, Shape::Matrix) => (self.graph.multiply(a.expr, b.expr), Shape::Matrix),
                    (Shape::Matrix, Shape::Vector) => (self.graph.apply(a.expr, b.expr), Shape::Vector),
                    _ => {
                        return wrong_shape(
                            span,
                            "a product of two vectors".into(),
                            "dot(a, b) or outer(a, b)",
                        );
                    }
                };
                Ok(Value { expr, kind: Kind::Tensor(shape), units })
            }
            BinaryOperator::Divide => {
                tensor(a, left.1)?;
                scalar(right)?;
                if self.graph.value(b.expr) == Some(0.0) {
                    return wrong_shape(right.1, "zero".into(), "a divisor other than zero");
                }
                let inverse = self.graph.power_number(b.expr, -1.0);
                let expr = self.graph.scale(inverse, a.expr);
                Ok(Value { expr, kind: a.kind, units: combine(a.units, b.units, -1.0) })
            }
            _ => self.power(span, left, right),
        }
    }

    fn comparison(&mut self, operator: BinaryOperator, a: Expr, b: Expr) -> Expr {
        let graph = &mut self.graph;
        match operator {
            BinaryOperator::Less => graph.compare(Comparison::Less, a, b),
            BinaryOperator::LessOrEqual => graph.compare(Comparison::LessOrEqual, a, b),
            BinaryOperator::Greater => graph.compare(Comparison::Less, b, a),
            BinaryOperator::GreaterOrEqual => graph.compare(Comparison::LessOrEqual, b, a),
            BinaryOperator::Equal => graph.compare(Comparison::Equal, a, b),
            _ => {
                let (one, equal) = (graph.number(1.0), graph.compare(Comparison::Equal, a, b));
                graph.subtract(one, equal)
            }
        }
    }

    pub(super) fn power(
        &mut self,
        span: Span,
        base: (Value, Span),
        exponent: (Value, Span),
    ) -> Result<Value, Fault> {
        scalar(exponent)?;
        pure(exponent)?;
        let number = self.graph.value(exponent.0.expr);
        let shape = tensor(base.0, base.1)?;
        if shape == Shape::Scalar {
            let units = match (base.0.units, number) {
                (Some(units), Some(number)) => Some(units.map(|power| power * number)),
                (Some(units), None) if units != [0.0; 3] => {
                    return wrong_unit(base.1, units, WantedUnits::PureBase);
                }
                (units, _) => units,
            };
            let expr = self.graph.power(base.0.expr, exponent.0.expr);
            return Ok(Value { expr, kind: base.0.kind, units });
        }
        let whole = number.filter(|number| number.fract() == 0.0 && (1.0..=8.0).contains(&number.abs()));
        let (Shape::Matrix, Some(whole)) = (shape, whole) else {
            return wrong_shape(
                span,
                "this power of a tensor".into(),
                "a whole power from 1 to 8, or -1 to -8, of a matrix",
            );
        };
        let factor = if whole < 0.0 { self.graph.inverse(base.0.expr) } else { base.0.expr };
        let mut expr = factor;
        for _ in 1..whole.abs() as usize {
            expr = self.graph.multiply(expr, factor);
        }
        let units = base.0.units.map(|units| units.map(|power| power * whole));
        Ok(Value { expr, kind: base.0.kind, units })
    }
}
