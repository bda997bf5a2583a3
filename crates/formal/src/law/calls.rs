//! Functions of the law language: those of numbers, and those of tensors and directions.

use super::LawProblem;
use super::read::{Reader, short};
use super::value::{
    Fault, Kind, PURE, Value, combine, common_units, describe, pure, scalar, tensor, truth, wrong_count,
    wrong_shape,
};
use super::vocabulary::{self, LAW_FUNCTIONS, Word};
use crate::function::{FUNCTIONS, Function, FunctionEntry, nearest_function};
use crate::graph::{Comparison, Expr, Node, Shape};
use crate::{ParseError, Span};

impl Reader<'_> {
    pub(super) fn call(
        &mut self,
        name: &str,
        span: Span,
        arguments: &[(Value, Span)],
    ) -> Result<Value, Fault> {
        if let Some(word) = Word::find(LAW_FUNCTIONS, name) {
            return self.law_function(word, span, arguments);
        }
        let Some(entry) = FunctionEntry::find(name) else {
            let known: Vec<&'static str> = LAW_FUNCTIONS
                .iter()
                .map(|word| word.name)
                .chain(FUNCTIONS.iter().map(|entry| entry.name).filter(|name| *name != "atan2"))
                .collect();
            let nearest = nearest_function(name, known.iter().copied());
            let here = Span::new(span.start, span.start + name.len());
            if self.is_value(name) {
                let problem = ParseError::NotAFunction { name: short(name), span: here };
                return Err(Fault::Here(here, LawProblem::Syntax(problem)));
            }
            return Err(Fault::Here(here, LawProblem::UnknownFunction { name: short(name), nearest, known }));
        };
        if !entry.arguments.accepts(arguments.len()) {
            return Err(wrong_count(span, name, arguments.len(), entry.usage));
        }
        if entry.function == Function::If {
            truth(arguments[0])?;
        } else {
            scalar(arguments[0])?;
        }
        for argument in &arguments[1..] {
            scalar(*argument)?;
        }
        let e = |index: usize| arguments[index].0.expr;
        let kind = Kind::Tensor(Shape::Scalar);
        let (expr, units) = match entry.function {
            Function::Min | Function::Max => {
                let mut expr = e(0);
                for (argument, _) in &arguments[1..] {
                    expr = if entry.function == Function::Min {
                        self.graph.minimum(expr, argument.expr)
                    } else {
                        self.graph.maximum(expr, argument.expr)
                    };
                }
                (expr, common_units(arguments)?)
            }
            Function::Clamp => {
                let above = self.graph.maximum(e(0), e(1));
                (self.graph.minimum(above, e(2)), common_units(arguments)?)
            }
            Function::If => {
                let units = common_units(&arguments[1..])?;
                (self.graph.select(e(0), e(1), e(2)), units)
            }
            Function::Step => {
                common_units(arguments)?;
                (self.graph.compare(Comparison::LessOrEqual, e(0), e(1)), PURE)
            }
            Function::Smoothstep => {
                common_units(arguments)?;
                (self.smoothstep(e(0), e(1), e(2)), PURE)
            }
            Function::Hypot => {
                let squares = [0, 1].map(|index| self.graph.power_number(e(index), 2.0));
                let sum = self.graph.sum(&squares);
                (self.graph.power_number(sum, 0.5), common_units(arguments)?)
            }
            Function::Pow => return self.power(span, arguments[0], arguments[1]),
            Function::Abs => (self.graph.function(entry.function, e(0)), arguments[0].0.units),
            Function::Sqrt | Function::Cbrt => {
                let power = if entry.function == Function::Sqrt { 0.5 } else { 1.0 / 3.0 };
                let units = arguments[0].0.units.map(|units| units.map(|unit| unit * power));
                (self.graph.function(entry.function, e(0)), units)
            }
            Function::Atan2 => {
                return wrong_shape(span, "an angle of two numbers".into(), "atan(y/x)");
            }
            function => {
                pure(arguments[0])?;
                (self.graph.function(function, e(0)), PURE)
            }
        };
        Ok(Value { expr, kind, units })
    }

    // s² (3 - 2 s) with s = (x - low)/(high - low) held between 0 and 1
    fn smoothstep(&mut self, low: Expr, high: Expr, x: Expr) -> Expr {
        let graph = &mut self.graph;
        let (rise, width) = (graph.subtract(x, low), graph.subtract(high, low));
        let ratio = graph.divide(rise, width);
        let (zero, one) = (graph.number(0.0), graph.number(1.0));
        let above = graph.maximum(ratio, zero);
        let s = graph.minimum(above, one);
        let (square, twice, three) =
            (graph.power_number(s, 2.0), graph.times_number(-2.0, s), graph.number(3.0));
        let rest = graph.sum(&[three, twice]);
        graph.times(square, rest)
    }

    fn law_function(&mut self, word: &Word, span: Span, arguments: &[(Value, Span)]) -> Result<Value, Fault> {
        let wanted = 1 + usize::from(matches!(word.name, "dot" | "outer"));
        if arguments.len() != wanted {
            return Err(wrong_count(span, word.name, arguments.len(), word.usage));
        }
        let (a, place) = arguments[0];
        let shape = match word.name {
            name if vocabulary::takes_directions(name) => Shape::Vector,
            "dot" => tensor(a, place)?,
            _ => Shape::Matrix,
        };
        if shape == Shape::Scalar && word.name == "dot" {
            return wrong_shape(place, describe(a.kind), "a vector or a tensor");
        }
        for (value, place) in arguments {
            if value.kind != Kind::Tensor(shape) {
                let wanted = match shape {
                    Shape::Vector => "a direction, a vector such as a parameter `a = [1, 0, 0]`,".to_owned(),
                    _ => describe(Kind::Tensor(shape)),
                };
                return wrong_shape(*place, describe(value.kind), &wanted);
            }
        }
        let graph = &mut self.graph;
        let scaled = |power: f64| a.units.map(|units| units.map(|unit| unit * power));
        let (expr, units) = match word.name {
            "tr" => (graph.trace(a.expr), a.units),
            "det" => (graph.determinant(a.expr), scaled(3.0)),
            "cof" => (graph.cofactor(a.expr), scaled(2.0)),
            "inv" => (graph.inverse(a.expr), scaled(-1.0)),
            "transpose" => (graph.transpose(a.expr), a.units),
            "sym" => (graph.symmetric_part(a.expr), a.units),
            "dev" => {
                let (trace, identity) = (graph.trace(a.expr), graph.identity());
                let third = graph.times_number(-1.0 / 3.0, trace);
                let spherical = graph.scale(third, identity);
                (graph.add(a.expr, spherical), a.units)
            }
            "dot" => (graph.dot(a.expr, arguments[1].0.expr), combine(a.units, arguments[1].0.units, 1.0)),
            "outer" => {
                (graph.outer(a.expr, arguments[1].0.expr), combine(a.units, arguments[1].0.units, 1.0))
            }
            _ => {
                let deformation = graph.symbol(super::DEFORMATION, Shape::Matrix);
                let mut image = graph.apply(deformation, a.expr);
                if word.name == "I5" {
                    let transposed = graph.transpose(deformation);
                    image = graph.apply(transposed, image);
                }
                let stretch = graph.dot(image, image);
                if matches!(graph.node(a.expr), Node::Symbol(_)) {
                    // directions among the parameters have the length one
                    (stretch, scaled(2.0))
                } else {
                    let length_sq = graph.dot(a.expr, a.expr);
                    (graph.divide(stretch, length_sq), PURE)
                }
            }
        };
        Ok(Value { expr, kind: Kind::Tensor(self.graph.shape(expr)), units })
    }
}
