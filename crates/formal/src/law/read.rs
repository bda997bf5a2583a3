//! From the text of a law to its graph, with shapes and units checked where they are written.

use std::collections::HashMap;

use super::vocabulary::{self, LAW_FUNCTIONS, QUANTITIES, Word};
use super::{LawError, LawParameter, LawProblem, LawText};
use crate::function::CONSTANTS;
use crate::graph::{Comparison, Expr, Graph, Shape};
use crate::{
    BinaryOperator, Dimension, Expression, FUNCTIONS, Function, FunctionEntry, NodeKind, Span, UnaryOperator,
};

/// Parts of a law at most: derivatives of long products grow with the square.
const LARGEST: usize = 4000;

/// The same of what its parts are made of: products of products grow with every one.
const LARGEST_GRAPH: usize = 20_000;

/// A law that has been read.
pub(super) struct Read {
    pub graph: Graph,
    pub energy: Expr,
    pub uses_small_strain: bool,
    pub warnings: Vec<String>,
    /// Where expressions were first written: part of the law and place.
    pub origins: HashMap<Expr, (String, Span)>,
}

/// Powers of kilogram, metre and second; `None` where no unit was declared.
type Units = Option<[f64; 3]>;

const PURE: Units = Some([0.0; 3]);

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Kind {
    Tensor(Shape),
    Truth,
}

#[derive(Clone, Copy)]
struct Value {
    expr: Expr,
    kind: Kind,
    units: Units,
}

/// One text being read.
struct Reader<'a> {
    text: &'a LawText,
    graph: Graph,
    origins: HashMap<Expr, (String, Span)>,
    defined: HashMap<String, Value>,
    /// Definitions being read, the outermost first.
    open: Vec<String>,
    used: Vec<String>,
    uses_small_strain: bool,
    nodes: usize,
}

pub(super) fn read(text: &LawText) -> Result<Read, LawError> {
    check_names(text)?;
    let mut reader = Reader::new(text);
    // the earliest expression, so that everything that varies with it comes later
    reader.graph.symbol(super::DEFORMATION, Shape::Matrix);
    let (energy, span) = reader.part("energy", &text.energy)?;
    let fail = |problem| LawError::new("energy", Some(span), problem);
    if energy.kind != Kind::Tensor(Shape::Scalar) {
        let wanted = "a number, the energy density".to_owned();
        return Err(fail(LawProblem::WrongShape { found: describe(energy.kind), wanted }));
    }
    let pressure = Dimension::new(1, -1, -2);
    if let Some(units) = energy.units
        && units != [1.0, -1.0, -2.0]
    {
        let wanted = format!("an energy per volume, which is {}", pressure.describe());
        return Err(fail(LawProblem::WrongUnit { found: describe_units(units), wanted }));
    }
    let uses_small_strain = reader.uses_small_strain;
    // definitions that the energy does not use are read too, so that faults in them are told
    for (name, _) in &text.definitions {
        reader.definition(name, Span::new(0, 0))?;
    }
    let given = text.parameters.iter().map(|(name, _)| ("parameter", name));
    let unused = given.chain(text.definitions.iter().map(|(name, _)| ("definition", name)));
    let warnings = unused
        .filter(|(_, name)| !reader.used.contains(name))
        .map(|(kind, name)| format!("the {kind} `{name}` is used nowhere"))
        .collect();
    let Reader { graph, origins, .. } = reader;
    Ok(Read { graph, energy: energy.expr, uses_small_strain, warnings, origins })
}

/// A formula of numbers.
pub(super) struct Numbers {
    pub graph: Graph,
    pub value: Expr,
    /// Its names, and what they are in the graph.
    pub symbols: Vec<(String, Expr)>,
}

pub(super) fn read_formula(formula: &str) -> Result<Numbers, LawError> {
    let expression = Expression::parse(formula)
        .map_err(|error| LawError::new("formula", Some(error.span()), LawProblem::Syntax(error)))?;
    let mut names: Vec<String> = Vec::new();
    for node in expression.nodes() {
        if let NodeKind::Name(name) = &node.kind
            && !names.contains(&name.to_string())
        {
            names.push(name.to_string());
        }
    }
    let number = |name: &String| (name.clone(), LawParameter::Number { value: 0.0, dimension: None });
    let text = LawText { parameters: names.iter().map(number).collect(), ..LawText::default() };
    let mut reader = Reader::new(&text);
    let (value, span) = reader.part("formula", formula)?;
    if value.kind != Kind::Tensor(Shape::Scalar) {
        let problem = LawProblem::WrongShape { found: describe(value.kind), wanted: "a number".to_owned() };
        return Err(LawError::new("formula", Some(span), problem));
    }
    let mut graph = reader.graph;
    let symbols = names.into_iter().map(|name| {
        let symbol = graph.symbol(&name, Shape::Scalar);
        (name, symbol)
    });
    let symbols = symbols.collect();
    Ok(Numbers { graph, value: value.expr, symbols })
}

fn check_names(text: &LawText) -> Result<(), LawError> {
    let names: Vec<&String> = text
        .parameters
        .iter()
        .map(|(name, _)| name)
        .chain(text.definitions.iter().map(|(name, _)| name))
        .collect();
    for (position, name) in names.iter().enumerate() {
        let fail = |problem| Err(LawError::new(short(name), None, problem));
        let mut letters = name.chars();
        let starts = letters.next().is_some_and(|first| first.is_ascii_alphabetic() || first == '_');
        if !starts || !letters.all(|letter| letter.is_ascii_alphanumeric() || letter == '_') {
            return fail(LawProblem::BadName { name: short(name) });
        }
        if matches!(name.as_str(), "and" | "or" | "not") || name.as_str() == super::VARIATION {
            return fail(LawProblem::ReservedName {
                name: short(name),
                meaning: "a word of the language".into(),
            });
        }
        if let Some(meaning) = vocabulary::reserved(name) {
            return fail(LawProblem::ReservedName { name: short(name), meaning });
        }
        if names[..position].contains(name) {
            return fail(LawProblem::GivenTwice { name: short(name) });
        }
    }
    for (name, parameter) in &text.parameters {
        let numbers = parameter.numbers();
        let direction = matches!(parameter, LawParameter::Direction(_));
        let zero = direction && numbers.iter().all(|number| *number == 0.0);
        if zero || !numbers.iter().all(|number| number.is_finite()) {
            return Err(LawError::new(short(name), None, LawProblem::BadParameter));
        }
    }
    Ok(())
}

impl<'a> Reader<'a> {
    fn new(text: &'a LawText) -> Self {
        Self {
            text,
            graph: Graph::new(),
            origins: HashMap::new(),
            defined: HashMap::new(),
            open: Vec::new(),
            used: Vec::new(),
            uses_small_strain: false,
            nodes: 0,
        }
    }

    /// Reads one text; the place is that of the whole.
    fn part(&mut self, part: &str, text: &str) -> Result<(Value, Span), LawError> {
        let fail = |span, problem| LawError::new(part, Some(span), problem);
        let expression =
            Expression::parse(text).map_err(|error| fail(error.span(), LawProblem::Syntax(error)))?;
        self.nodes += expression.nodes().len();
        if self.nodes > LARGEST {
            let problem = LawProblem::TooLarge { nodes: self.nodes, limit: LARGEST };
            return Err(fail(Span::new(0, text.len()), problem));
        }
        let mut values: Vec<Value> = Vec::with_capacity(expression.nodes().len());
        for node in expression.nodes() {
            let operands: Vec<(Value, Span)> = node
                .kind
                .operands()
                .map(|operand| (values[operand.index()], expression.node(operand).span))
                .collect();
            let value = self.node(&node.kind, node.span, &operands).map_err(|error| match error {
                Fault::Here(span, problem) => fail(span, problem),
                Fault::Elsewhere(error) => error,
            })?;
            self.origins.entry(value.expr).or_insert_with(|| (part.to_owned(), node.span));
            if self.graph.len() > LARGEST_GRAPH {
                let problem = LawProblem::TooLarge { nodes: self.graph.len(), limit: LARGEST_GRAPH };
                return Err(fail(node.span, problem));
            }
            values.push(value);
        }
        let root = expression.root();
        Ok((values[root.index()], expression.node(root).span))
    }

    /// The value of a definition, read when it is first needed.
    fn definition(&mut self, name: &str, span: Span) -> Result<Option<Value>, Fault> {
        if let Some(value) = self.defined.get(name) {
            return Ok(Some(*value));
        }
        let Some((_, text)) = self.text.definitions.iter().find(|(known, _)| known == name) else {
            return Ok(None);
        };
        if let Some(start) = self.open.iter().position(|open| open == name) {
            let mut cycle = self.open[start..].to_vec();
            cycle.push(name.to_owned());
            return Err(Fault::Here(span, LawProblem::Recursion { cycle }));
        }
        self.open.push(name.to_owned());
        let (value, _) = self.part(name, text)?;
        self.open.pop();
        self.defined.insert(name.to_owned(), value);
        Ok(Some(value))
    }

    fn node(&mut self, kind: &NodeKind, span: Span, operands: &[(Value, Span)]) -> Result<Value, Fault> {
        match kind {
            NodeKind::Number(number) => {
                let units = if *number == 0.0 { None } else { PURE };
                Ok(Value { units, ..self.scalar_number(*number) })
            }
            NodeKind::Name(name) => self.name(name, span),
            NodeKind::Unary { operator: UnaryOperator::Negate, .. } => {
                let (operand, place) = operands[0];
                tensor(operand, place)?;
                Ok(Value { expr: self.graph.negate(operand.expr), ..operand })
            }
            NodeKind::Unary { operator: UnaryOperator::Not, .. } => {
                truth(operands[0])?;
                let (one, minus) = (self.graph.number(1.0), self.graph.negate(operands[0].0.expr));
                Ok(Value { expr: self.graph.sum(&[one, minus]), kind: Kind::Truth, units: PURE })
            }
            NodeKind::Binary { operator, .. } => self.binary(*operator, span, operands[0], operands[1]),
            NodeKind::Call { name, .. } => self.call(name, span, operands),
            NodeKind::Vector(_) => {
                if operands.len() != 3 {
                    let found = format!("a list of {}", operands.len());
                    return wrong_shape(span, found, "a direction of three numbers");
                }
                let units = self.common_units(operands)?;
                let entries: Vec<Expr> = operands.iter().map(|(value, _)| value.expr).collect();
                for operand in operands {
                    scalar(*operand)?;
                }
                Ok(Value { expr: self.graph.pack(&entries), kind: Kind::Tensor(Shape::Vector), units })
            }
        }
    }

    fn scalar_number(&mut self, number: f64) -> Value {
        Value { expr: self.graph.number(number), kind: Kind::Tensor(Shape::Scalar), units: PURE }
    }

    fn name(&mut self, name: &str, span: Span) -> Result<Value, Fault> {
        if let Some((_, parameter)) = self.text.parameters.iter().find(|(known, _)| known == name) {
            self.used.push(name.to_owned());
            let shape = parameter.shape();
            let units = match parameter {
                LawParameter::Number { dimension, .. } => {
                    dimension.map(|d| [f64::from(d.mass), f64::from(d.length), f64::from(d.time)])
                }
                LawParameter::Direction(_) => PURE,
            };
            return Ok(Value { expr: self.graph.symbol(name, shape), kind: Kind::Tensor(shape), units });
        }
        if let Some(value) = self.definition(name, span)? {
            self.used.push(name.to_owned());
            return Ok(value);
        }
        if let Some(expr) = vocabulary::quantity(&mut self.graph, name) {
            self.uses_small_strain |= name.starts_with("eps");
            return Ok(Value { expr, kind: Kind::Tensor(self.graph.shape(expr)), units: PURE });
        }
        if let Some((_, value)) = CONSTANTS.iter().find(|(constant, _)| *constant == name) {
            return Ok(self.scalar_number(*value));
        }
        let called = Word::find(LAW_FUNCTIONS, name).map(|word| word.usage);
        if let Some(usage) = called.or_else(|| FunctionEntry::find(name).map(|entry| entry.usage)) {
            let problem =
                LawProblem::WrongArgumentCount { name: name.to_owned(), found: 0, usage: usage.to_owned() };
            return Err(Fault::Here(span, problem));
        }
        let own: Vec<&str> = self
            .text
            .parameters
            .iter()
            .map(|(name, _)| name.as_str())
            .chain(self.text.definitions.iter().map(|(name, _)| name.as_str()))
            .collect();
        let known = own.iter().copied().chain(QUANTITIES.iter().map(|word| word.name));
        let nearest = souple_table::nearest(name, known).map(str::to_owned);
        let own = if own.is_empty() { " (none)".to_owned() } else { format!(" ({})", own.join(", ")) };
        Err(Fault::Here(span, LawProblem::UnknownName { name: short(name), nearest, own }))
    }

    fn binary(
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
                self.common_units(&[left, right])?;
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
                let units = self.common_units(&[left, right])?;
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

    fn power(&mut self, span: Span, base: (Value, Span), exponent: (Value, Span)) -> Result<Value, Fault> {
        scalar(exponent)?;
        self.pure(exponent)?;
        let number = self.graph.value(exponent.0.expr);
        let shape = tensor(base.0, base.1)?;
        if shape == Shape::Scalar {
            let units = match (base.0.units, number) {
                (Some(units), Some(number)) => Some(units.map(|power| power * number)),
                (Some(units), None) if units != [0.0; 3] => {
                    let wanted = "a pure number under an exponent that is not a plain number".to_owned();
                    return Err(Fault::Here(
                        base.1,
                        LawProblem::WrongUnit { found: describe_units(units), wanted },
                    ));
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

    fn call(&mut self, name: &str, span: Span, arguments: &[(Value, Span)]) -> Result<Value, Fault> {
        if let Some(word) = Word::find(LAW_FUNCTIONS, name) {
            return self.law_function(word, span, arguments);
        }
        let Some(entry) = FunctionEntry::find(name) else {
            let known: Vec<&'static str> = LAW_FUNCTIONS
                .iter()
                .map(|word| word.name)
                .chain(FUNCTIONS.iter().map(|entry| entry.name).filter(|name| *name != "atan2"))
                .collect();
            let nearest = souple_table::nearest(name, known.iter().copied()).map(str::to_owned);
            let here = Span::new(span.start, span.start + name.len());
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
                (expr, self.common_units(arguments)?)
            }
            Function::Clamp => {
                let above = self.graph.maximum(e(0), e(1));
                (self.graph.minimum(above, e(2)), self.common_units(arguments)?)
            }
            Function::If => {
                let units = self.common_units(&arguments[1..])?;
                (self.graph.select(e(0), e(1), e(2)), units)
            }
            Function::Step => {
                self.common_units(arguments)?;
                (self.graph.compare(Comparison::LessOrEqual, e(0), e(1)), PURE)
            }
            Function::Smoothstep => {
                self.common_units(arguments)?;
                (self.smoothstep(e(0), e(1), e(2)), PURE)
            }
            Function::Hypot => {
                let squares = [0, 1].map(|index| self.graph.power_number(e(index), 2.0));
                let sum = self.graph.sum(&squares);
                (self.graph.power_number(sum, 0.5), self.common_units(arguments)?)
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
                self.pure(arguments[0])?;
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
            "log" => Shape::Scalar,
            "outer" | "I4" | "I5" => Shape::Vector,
            "dot" => tensor(a, place)?,
            _ => Shape::Matrix,
        };
        if shape == Shape::Scalar && word.name == "dot" {
            return wrong_shape(place, describe(a.kind), "a vector or a tensor");
        }
        for (value, place) in arguments {
            if value.kind != Kind::Tensor(shape) {
                return wrong_shape(*place, describe(value.kind), &describe(Kind::Tensor(shape)));
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
            "log" => {
                self.pure(arguments[0])?;
                (self.graph.function(Function::Ln, a.expr), PURE)
            }
            _ => {
                let deformation = graph.symbol(super::DEFORMATION, Shape::Matrix);
                let mut image = graph.apply(deformation, a.expr);
                if word.name == "I5" {
                    let transposed = graph.transpose(deformation);
                    image = graph.apply(transposed, image);
                }
                (graph.dot(image, image), scaled(2.0))
            }
        };
        Ok(Value { expr, kind: Kind::Tensor(self.graph.shape(expr)), units })
    }

    /// The units that all have; what has none declared takes any.
    fn common_units(&self, values: &[(Value, Span)]) -> Result<Units, Fault> {
        let mut common: Units = None;
        for (value, span) in values {
            match (common, value.units) {
                (Some(wanted), Some(found)) if wanted != found => {
                    let wanted = format!("{}, as beside it", describe_units(wanted));
                    return Err(Fault::Here(
                        *span,
                        LawProblem::WrongUnit { found: describe_units(found), wanted },
                    ));
                }
                (None, units) => common = units,
                _ => {}
            }
        }
        Ok(common)
    }

    fn pure(&self, (value, span): (Value, Span)) -> Result<(), Fault> {
        match value.units {
            Some(units) if units != [0.0; 3] => {
                let wanted = "a pure number".to_owned();
                Err(Fault::Here(span, LawProblem::WrongUnit { found: describe_units(units), wanted }))
            }
            _ => Ok(()),
        }
    }
}

/// A fault of the node at hand, or of a definition that it needs.
enum Fault {
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

fn wrong_shape<T>(span: Span, found: String, wanted: &str) -> Result<T, Fault> {
    Err(Fault::Here(span, LawProblem::WrongShape { found, wanted: wanted.to_owned() }))
}

fn wrong_count(span: Span, name: &str, found: usize, usage: &str) -> Fault {
    Fault::Here(
        span,
        LawProblem::WrongArgumentCount { name: name.to_owned(), found, usage: usage.to_owned() },
    )
}

fn tensor(value: Value, span: Span) -> Result<Shape, Fault> {
    match value.kind {
        Kind::Tensor(shape) => Ok(shape),
        Kind::Truth => wrong_shape(span, describe(value.kind), "a number or tensor"),
    }
}

fn scalar((value, span): (Value, Span)) -> Result<(), Fault> {
    match value.kind {
        Kind::Tensor(Shape::Scalar) => Ok(()),
        kind => wrong_shape(span, describe(kind), "a number"),
    }
}

fn truth((value, span): (Value, Span)) -> Result<(), Fault> {
    match value.kind {
        Kind::Truth => Ok(()),
        kind => wrong_shape(span, describe(kind), "a truth value such as `J > 1`"),
    }
}

fn describe(kind: Kind) -> String {
    match kind {
        Kind::Truth => "a truth value",
        Kind::Tensor(Shape::Scalar) => "a number",
        Kind::Tensor(Shape::Vector) => "a vector",
        Kind::Tensor(_) => "a 3x3 tensor",
    }
    .to_owned()
}

fn combine(a: Units, b: Units, sign: f64) -> Units {
    let (a, b) = (a?, b?);
    Some([a[0] + sign * b[0], a[1] + sign * b[1], a[2] + sign * b[2]])
}

fn describe_units(units: [f64; 3]) -> String {
    if units.iter().all(|power| power.fract() == 0.0 && power.abs() < 100.0) {
        return Dimension::new(units[0] as i8, units[1] as i8, units[2] as i8).describe();
    }
    let [mass, length, time] = units;
    format!("a quantity in [kg^{mass} m^{length} s^{time}]")
}

/// The beginning of a name, so that a message about a long one stays readable.
fn short(name: &str) -> String {
    name.chars().take(40).collect()
}
