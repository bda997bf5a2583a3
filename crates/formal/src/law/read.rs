//! From the text of a law to its graph, with shapes and units checked where they are written.

use std::collections::HashMap;

use super::error::ENERGY_DENSITY;
use super::value::{
    Fault, Kind, PURE, Units, Value, common_units, describe, scalar, tensor, truth, wrong_shape,
};
use super::vocabulary::{self, LAW_FUNCTIONS, QUANTITIES, SIGNS_OF_BOOKS, Word};
use super::{LawError, LawParameter, LawProblem, LawText, UnitClash, WantedUnits};
use crate::function::{CONSTANTS, FUNCTIONS};
use crate::graph::{Expr, Graph, Shape};
use crate::{
    BinaryOperator, Dimension, Expression, FunctionEntry, NodeId, NodeKind, ParseError, Span, UnaryOperator,
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
    /// Parameters and definitions that are in it.
    pub used: Vec<String>,
    /// Where expressions were first written: part of the law and place.
    pub origins: HashMap<Expr, (String, Span)>,
}

/// One text being read.
pub(super) struct Reader<'a> {
    text: &'a LawText,
    pub(super) graph: Graph,
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
    let (energy, span) = reader.part("energy", &text.energy, units_of(ENERGY_DENSITY))?;
    let fail = |problem| LawError::new("energy", Some(span), problem);
    if energy.kind != Kind::Tensor(Shape::Scalar) {
        let wanted = "a number, the energy density".to_owned();
        return Err(fail(LawProblem::WrongShape { found: describe(energy.kind), wanted }));
    }
    let uses_small_strain = reader.uses_small_strain;
    // definitions that the energy does not use are read too, so that faults in them are told
    for (name, _) in &text.definitions {
        reader.definition(name, Span::new(0, 0))?;
    }
    let given = text.parameters.iter().map(|(name, _)| ("parameter", name));
    let unused = given.chain(text.definitions.iter().map(|(name, _)| ("definition", name)));
    let unused: Vec<(&str, &String)> = unused.filter(|(_, name)| !reader.used.contains(name)).collect();
    let mut warnings: Vec<String> = unused
        .iter()
        .take(UNUSED_TOLD)
        .map(|(kind, name)| format!("the {kind} `{name}` is used nowhere"))
        .collect();
    if unused.len() > UNUSED_TOLD {
        warnings.push(format!("{} more are used nowhere", unused.len() - UNUSED_TOLD));
    }
    let Reader { graph, origins, used, .. } = reader;
    Ok(Read { graph, energy: energy.expr, uses_small_strain, warnings, used, origins })
}

/// Names that are used nowhere, told one by one.
const UNUSED_TOLD: usize = 8;

/// A formula of numbers.
pub(super) struct Numbers {
    pub graph: Graph,
    pub value: Expr,
    /// Its names, and what they are in the graph.
    pub symbols: Vec<(String, Expr)>,
}

pub(super) fn read_formula(formula: &str) -> Result<Numbers, LawError> {
    let expression = parsed("formula", formula)?;
    let mut names: Vec<String> = Vec::new();
    for node in expression.nodes() {
        match &node.kind {
            NodeKind::Name(name) if !names.contains(name) => names.push(name.clone()),
            // functions of a deformation, of which there is none
            NodeKind::Call { name, .. } if Word::find(LAW_FUNCTIONS, name).is_some() => {
                let known = FUNCTIONS.iter().map(|entry| entry.name).collect();
                let problem = LawProblem::UnknownFunction { name: short(name), nearest: None, known };
                let here = Span::new(node.span.start, node.span.start + name.len());
                return Err(LawError::new("formula", Some(here), problem));
            }
            _ => {}
        }
    }
    let number = |name: &String| (name.clone(), LawParameter::Number { value: 0.0, dimension: None });
    let text = LawText { parameters: names.iter().map(number).collect(), ..LawText::default() };
    let mut reader = Reader::new(&text);
    let (value, span) = reader.part("formula", formula, None)?;
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

/// The syntax of one text of a law; signs that tensors have in books are answered with how they are written here.
fn parsed(part: &str, text: &str) -> Result<Expression, LawError> {
    Expression::parse(text).map_err(|error| {
        let span = error.span();
        let problem = match sign_of_books(span.of(text)) {
            Some(problem) if matches!(error, ParseError::Unexpected { .. }) => problem,
            _ => LawProblem::Syntax(error),
        };
        LawError::new(part, Some(span), problem)
    })
}

/// What is said of a sign of tensors in books.
fn sign_of_books(sign: &str) -> Option<LawProblem> {
    let &[read, meant, written_here] = SIGNS_OF_BOOKS.iter().find(|[read, ..]| *read == sign)?;
    Some(LawProblem::SignOfBooks { read, meant, written_here })
}

/// `T` behind `^` where nothing has that name: a transpose is meant.
fn transpose_meant(text: &str, fault: Fault) -> Fault {
    match &fault {
        Fault::Here(span, LawProblem::UnknownName { name, .. }) if name == "T" => {
            let before = text[..span.start].trim_end();
            let power = before.len().checked_sub(1).filter(|_| before.ends_with('^'));
            let meant =
                power.and_then(|start| Some(Fault::Here(Span::new(start, span.end), sign_of_books("^T")?)));
            meant.unwrap_or(fault)
        }
        _ => fault,
    }
}

fn units_of(dimension: Dimension) -> Units {
    Some([dimension.mass, dimension.length, dimension.time].map(f64::from))
}

/// The addends of a formula, from left to right.
fn addends(expression: &Expression) -> Vec<NodeId> {
    let (mut open, mut found) = (vec![expression.root()], Vec::new());
    while let Some(id) = open.pop() {
        match expression.node(id).kind {
            NodeKind::Unary { operator: UnaryOperator::Negate, operand } => open.push(operand),
            NodeKind::Binary { operator: BinaryOperator::Add | BinaryOperator::Subtract, left, right } => {
                open.extend([right, left]);
            }
            _ => found.push(id),
        }
    }
    found
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

    /// Reads one text, whose terms must have the units `wanted`, if any are; the place is that of the whole.
    fn part(&mut self, part: &str, text: &str, wanted: Units) -> Result<(Value, Span), LawError> {
        let fail = |span, problem| LawError::new(part, Some(span), problem);
        let expression = parsed(part, text)?;
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
            let value = self.node(&node.kind, node.span, &operands).map_err(|fault| {
                match transpose_meant(text, fault) {
                    Fault::Here(span, LawProblem::WrongUnit(clash)) => {
                        // of two terms of the energy the one that is none is wrong, whichever stands first
                        let misfit = misfit(&expression, &values, wanted, node.span);
                        let (span, clash) = misfit.unwrap_or((span, clash));
                        fail(span, LawProblem::WrongUnit(self.told(clash, span, &expression, text)))
                    }
                    Fault::Here(span, LawProblem::UnknownName { name, nearest, own, .. }) => {
                        let shape = shape_wanted(&expression, values.len());
                        fail(span, LawProblem::UnknownName { name, nearest, own, shape })
                    }
                    Fault::Here(span, problem) => fail(span, problem),
                    Fault::Elsewhere(error) => error,
                }
            })?;
            self.origins.entry(value.expr).or_insert_with(|| (part.to_owned(), node.span));
            if self.graph.len() > LARGEST_GRAPH {
                let problem = LawProblem::TooLarge { nodes: self.graph.len(), limit: LARGEST_GRAPH };
                return Err(fail(node.span, problem));
            }
            values.push(value);
        }
        let root = expression.root();
        let (value, span) = (values[root.index()], expression.node(root).span);
        if value.kind == Kind::Tensor(Shape::Scalar)
            && let Some((term, clash)) = misfit(&expression, &values, wanted, span)
        {
            // terms that agree are wrong together
            let is_alike = |id: &NodeId| values[id.index()].units == Some(clash.found);
            let span = if addends(&expression).iter().all(is_alike) { span } else { term };
            return Err(fail(span, LawProblem::WrongUnit(self.told(clash, span, &expression, text))));
        }
        Ok((value, span))
    }

    /// The clash at a place of a text with what is written there, and with the parameters that are in it.
    fn told(
        &self,
        mut clash: Box<UnitClash>,
        span: Span,
        expression: &Expression,
        text: &str,
    ) -> Box<UnitClash> {
        clash.written = excerpt(span.of(text));
        if let WantedUnits::Like { beside, written, .. } = &mut clash.wanted {
            *written = excerpt(beside.of(text));
        }
        let mut seen = Vec::new();
        self.gather_names(expression, span, &mut seen);
        let is_seen = |(name, parameter): &(String, LawParameter)| match parameter {
            LawParameter::Number { dimension, .. } if seen.contains(name) => Some((short(name), *dimension)),
            _ => None,
        };
        clash.parameters = self.text.parameters.iter().filter_map(is_seen).collect();
        clash
    }

    /// The names at a place of a text, and those of the definitions among them.
    fn gather_names(&self, expression: &Expression, span: Span, seen: &mut Vec<String>) {
        for node in expression.nodes() {
            let NodeKind::Name(name) = &node.kind else { continue };
            if !span.contains(node.span) || seen.contains(name) {
                continue;
            }
            seen.push(name.clone());
            let definition = self.text.definitions.iter().find(|(known, _)| known == name);
            if let Some(Ok(inner)) = definition.map(|(_, text)| Expression::parse(text)) {
                self.gather_names(&inner, inner.node(inner.root()).span, seen);
            }
        }
    }

    /// Whether a name stands for a value.
    pub(super) fn is_value(&self, name: &str) -> bool {
        let given = self.text.parameters.iter().map(|(name, _)| name);
        given.chain(self.text.definitions.iter().map(|(name, _)| name)).any(|known| known == name)
            || CONSTANTS.iter().any(|(constant, _)| *constant == name)
            || vocabulary::is_quantity(name)
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
        let (value, _) = self.part(name, text, None)?;
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
                let units = common_units(operands)?;
                let entries: Vec<Expr> = operands.iter().map(|(value, _)| value.expr).collect();
                for operand in operands {
                    scalar(*operand)?;
                }
                Ok(Value { expr: self.graph.pack(&entries), kind: Kind::Tensor(Shape::Vector), units })
            }
        }
    }

    pub(super) fn scalar_number(&mut self, number: f64) -> Value {
        Value { expr: self.graph.number(number), kind: Kind::Tensor(Shape::Scalar), units: PURE }
    }

    fn name(&mut self, name: &str, span: Span) -> Result<Value, Fault> {
        if let Some((_, parameter)) = self.text.parameters.iter().find(|(known, _)| known == name) {
            self.used.push(name.to_owned());
            let shape = parameter.shape();
            let units = match parameter {
                LawParameter::Number { dimension, .. } => dimension.and_then(units_of),
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
        Err(Fault::Here(
            span,
            LawProblem::UnknownName { name: short(name), nearest, own, shape: Shape::Scalar },
        ))
    }
}

/// Of the terms at a place, as far as they have been read, the first that has other units than those wanted.
fn misfit(
    expression: &Expression,
    values: &[Value],
    wanted: Units,
    place: Span,
) -> Option<(Span, Box<UnitClash>)> {
    let wanted = wanted?;
    addends(expression).into_iter().find_map(|id| {
        let (span, found) = (expression.node(id).span, values.get(id.index())?.units?);
        let is_wrong = place.contains(span) && found != wanted;
        is_wrong.then(|| (span, UnitClash::boxed(found, WantedUnits::EnergyDensity)))
    })
}

/// What the node at a position must be where it stands.
fn shape_wanted(expression: &Expression, position: usize) -> Shape {
    let takes = |kind: &NodeKind| match kind {
        NodeKind::Call { name, arguments } => {
            vocabulary::takes_directions(name) && arguments.iter().any(|id| id.index() == position)
        }
        _ => false,
    };
    let is_direction = expression.nodes()[position..].iter().any(|node| takes(&node.kind));
    if is_direction { Shape::Vector } else { Shape::Scalar }
}

/// What is written at a place, or its beginning.
fn excerpt(written: &str) -> String {
    let beginning = short(written);
    if beginning.len() < written.len() { beginning + "…" } else { beginning }
}

/// The beginning of a name, so that a message about a long one stays readable.
pub(super) fn short(name: &str) -> String {
    name.chars().take(40).collect()
}
