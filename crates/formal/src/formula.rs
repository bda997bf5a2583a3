//! Formulas of variables, compiled to a flat list of instructions for a stack machine.
//!
//! Evaluating takes no memory from the allocator and gives the same bits everywhere. Both branches of `if`
//! are evaluated and one is taken.

use std::fmt;

use souple_math::Dual;

use crate::arithmetic::{self, Number};
use crate::function::{CONSTANTS, FUNCTIONS, FunctionEntry};
use crate::parser::DEEPEST;
use crate::{
    BinaryOperator, Expression, Function, Kind, Node, NodeId, NodeKind, ParseError, Span, UnaryOperator,
};

/// A number computed from variables.
#[derive(Clone, Debug)]
pub struct Formula {
    text: String,
    variables: Vec<String>,
    program: Program,
}

impl Formula {
    /// Reads a formula of the named variables, whose values [`evaluate`](Self::evaluate) takes in that order.
    ///
    /// # Errors
    /// Names the place, what was read and what would be accepted there; unknown names with the nearest.
    pub fn compile(text: &str, variables: &[&str]) -> Result<Self, ParseError> {
        let expression = Expression::parse(text)?;
        let program = Program::compile(&expression, expression.root(), Kind::Number, variables)?;
        Ok(Self::of(text, variables, program))
    }

    /// Reads a list of `N` formulas in brackets, such as `[0.1 * sin(t), 0, 0]`.
    ///
    /// # Errors
    /// As [`compile`](Self::compile); also where the text is no list or one of another length.
    pub fn compile_vector<const N: usize>(text: &str, variables: &[&str]) -> Result<[Self; N], ParseError> {
        let expression = Expression::parse(text)?;
        let Node { kind, span } = expression.node(expression.root());
        let (found, span) = match kind {
            NodeKind::Vector(components) => match <&[NodeId; N]>::try_from(components.as_slice()) {
                Ok(components) => {
                    let mut formulas = Vec::with_capacity(N);
                    for &component in components {
                        let program = Program::compile(&expression, component, Kind::Number, variables)?;
                        let text = expression.node(component).span.of(text);
                        formulas.push(Self::of(text, variables, program));
                    }
                    return Ok(formulas.try_into().expect("one formula per component"));
                }
                Err(_) => (Kind::Vector(components.len()), *span),
            },
            _ => (kind_of(kind), *span),
        };
        Err(ParseError::WrongKind { found, wanted: Kind::Vector(N), span })
    }

    /// The formula that is always `value`.
    pub fn constant(value: f64) -> Self {
        let program = Program { instructions: vec![Instruction::Constant(value)], stack: 1 };
        Self::of(&value.to_string(), &[], program)
    }

    fn of(text: &str, variables: &[&str], program: Program) -> Self {
        let variables = variables.iter().map(|&name| name.to_owned()).collect();
        Self { text: text.to_owned(), variables, program }
    }

    /// As it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The names whose values are wanted, in order.
    pub fn variables(&self) -> &[String] {
        &self.variables
    }

    /// Whether the variable at `position` can change the result.
    pub fn depends_on(&self, position: usize) -> bool {
        self.program.instructions.contains(&Instruction::Variable(position))
    }

    /// The result for the values of the variables; not finite where the formula is not defined.
    ///
    /// # Panics
    /// If there are fewer values than variables.
    pub fn evaluate(&self, values: &[f64]) -> f64 {
        self.program.run(|position| values[position])
    }

    /// The result and its rate, for variables that change at the rates of `values`; panics like
    /// [`evaluate`](Self::evaluate).
    pub fn evaluate_dual(&self, values: &[Dual]) -> Dual {
        self.program.run(|position| values[position])
    }

    /// The result and its derivative by the variable at position `by`: the velocity of a motion given as
    /// a formula of time. Panics like [`evaluate`](Self::evaluate).
    pub fn differentiate(&self, values: &[f64], by: usize) -> Dual {
        self.program.run(|position| Dual::new(values[position], f64::from(u8::from(position == by))))
    }
}

impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// A condition on variables, such as `x > 0.5 and y < z`.
#[derive(Clone, Debug)]
pub struct Condition {
    text: String,
    program: Program,
}

impl Condition {
    /// Reads a condition on the named variables.
    ///
    /// # Errors
    /// As [`Formula::compile`]; also where the text is a number instead of a condition.
    pub fn compile(text: &str, variables: &[&str]) -> Result<Self, ParseError> {
        let expression = Expression::parse(text)?;
        let program = Program::compile(&expression, expression.root(), Kind::Truth, variables)?;
        Ok(Self { text: text.to_owned(), program })
    }

    /// As it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether the condition holds for the values of the variables; panics like [`Formula::evaluate`].
    pub fn holds(&self, values: &[f64]) -> bool {
        arithmetic::holds(self.program.run(|position| values[position]))
    }
}

/// One step of the stack machine: takes operands from the top, leaves its result there.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Instruction {
    Constant(f64),
    Variable(usize),
    Unary(UnaryOperator),
    Binary(BinaryOperator),
    WholePower(i32),
    OfOne(Function),
    OfTwo(Function),
    OfThree(Function),
}

impl Instruction {
    fn operand_count(self) -> usize {
        match self {
            Self::Constant(_) | Self::Variable(_) => 0,
            Self::Unary(_) | Self::WholePower(_) | Self::OfOne(_) => 1,
            Self::Binary(_) | Self::OfTwo(_) => 2,
            Self::OfThree(_) => 3,
        }
    }
}

#[derive(Clone, Debug)]
struct Program {
    instructions: Vec<Instruction>,
    /// How many intermediate results are alive at once, at most.
    stack: usize,
}

/// Enough for all but monstrous formulas, and quickly cleared.
const USUAL_STACK: usize = 16;
/// A level of nesting keeps at most two results waiting (of a function of three), and the last is evaluated.
const LARGEST_STACK: usize = 2 * DEEPEST + 1;
/// Whole powers up to this are products.
const LARGEST_WHOLE_POWER: f64 = 8.0;

impl Program {
    /// The instructions of the subtree `root`, which must be of the wanted kind.
    fn compile(
        expression: &Expression,
        root: NodeId,
        wanted: Kind,
        variables: &[&str],
    ) -> Result<Self, ParseError> {
        let range = expression.subtree(root);
        let nodes = &expression.nodes()[range.clone()];
        check_kind(expression.node(root), wanted)?;
        let folds = folds(expression, *range.start(), nodes);
        let mut program = Self { instructions: Vec::new(), stack: 0 };
        for (node, fold) in nodes.iter().zip(folds) {
            for (position, operand) in node.kind.operands().enumerate() {
                check_kind(expression.node(operand), wanted_operand(&node.kind, position))?;
            }
            if let Some(instruction) = instruction_of(node, variables)? {
                program.push(instruction);
            }
            if let Some(function) = fold {
                program.push(Instruction::OfTwo(function));
            }
        }
        program.stack = program.measure_stack();
        Ok(program)
    }

    /// Appends an instruction, or its result where all operands are known.
    fn push(&mut self, instruction: Instruction) {
        let start = self.instructions.len() - instruction.operand_count();
        let operands = &self.instructions[start..];
        let known = operands.iter().all(|operand| matches!(operand, Instruction::Constant(_)));
        if let (Instruction::Binary(BinaryOperator::Power) | Instruction::OfTwo(Function::Pow), false) =
            (instruction, known)
            && let Some(&Instruction::Constant(exponent)) = operands.last()
            && exponent.fract() == 0.0
            && exponent.abs() <= LARGEST_WHOLE_POWER
        {
            self.instructions.pop();
            self.instructions.push(Instruction::WholePower(exponent as i32));
            return;
        }
        self.instructions.push(instruction);
        if known && instruction.operand_count() > 0 {
            let instructions = self.instructions.split_off(start);
            let value = Self { instructions, stack: USUAL_STACK }.run(|_| f64::NAN);
            self.instructions.push(Instruction::Constant(value));
        }
    }

    fn measure_stack(&self) -> usize {
        let mut alive: usize = 0;
        let heights = self.instructions.iter().map(|instruction| {
            alive = alive + 1 - instruction.operand_count();
            alive
        });
        heights.max().unwrap_or(0)
    }

    fn run<T: Number>(&self, variable: impl Fn(usize) -> T) -> T {
        if self.stack <= USUAL_STACK {
            self.run_on(&mut [T::constant(0.0); USUAL_STACK], variable)
        } else {
            self.run_on(&mut [T::constant(0.0); LARGEST_STACK], variable)
        }
    }

    #[inline(always)]
    fn run_on<T: Number>(&self, stack: &mut [T], variable: impl Fn(usize) -> T) -> T {
        // the number of results alive; `compile` has seen to it that they suffice and fit
        let mut alive = 0;
        for instruction in &self.instructions {
            let bottom = alive - instruction.operand_count();
            stack[bottom] = match *instruction {
                Instruction::Constant(value) => T::constant(value),
                Instruction::Variable(position) => variable(position),
                Instruction::Unary(UnaryOperator::Negate) => -stack[bottom],
                Instruction::Unary(UnaryOperator::Not) => arithmetic::negation(stack[bottom]),
                Instruction::Binary(operator) => {
                    arithmetic::binary(operator, stack[bottom], stack[bottom + 1])
                }
                Instruction::WholePower(exponent) => arithmetic::whole_power(stack[bottom], exponent),
                Instruction::OfOne(function) => arithmetic::of_one(function, stack[bottom]),
                Instruction::OfTwo(function) => {
                    arithmetic::of_two(function, stack[bottom], stack[bottom + 1])
                }
                Instruction::OfThree(function) => {
                    arithmetic::of_three(function, stack[bottom], stack[bottom + 1], stack[bottom + 2])
                }
            };
            alive = bottom + 1;
        }
        stack[0]
    }
}

/// For each node, the function that joins it with the arguments before it: `min(a, b, c)` runs as
/// `min(min(a, b), c)` while it is read, so that long lists need no deep stack.
fn folds(expression: &Expression, first: usize, nodes: &[Node]) -> Vec<Option<Function>> {
    let mut folds = vec![None; nodes.len()];
    for node in nodes {
        if let NodeKind::Call { name, arguments } = &node.kind
            && let Some(entry) = FunctionEntry::find(name)
            && matches!(entry.function, Function::Min | Function::Max)
        {
            for argument in arguments.iter().skip(1) {
                debug_assert!(argument.index() < expression.nodes().len());
                folds[argument.index() - first] = Some(entry.function);
            }
        }
    }
    folds
}

/// The instruction that stands for a node once its operands are on the stack.
fn instruction_of(node: &Node, variables: &[&str]) -> Result<Option<Instruction>, ParseError> {
    Ok(match &node.kind {
        NodeKind::Number(number) => Some(Instruction::Constant(*number)),
        NodeKind::Name(name) => Some(named(name, node.span, variables)?),
        NodeKind::Unary { operator, .. } => Some(Instruction::Unary(*operator)),
        NodeKind::Binary { operator, .. } => Some(Instruction::Binary(*operator)),
        NodeKind::Call { name, arguments } => {
            let span = Span::new(node.span.start, node.span.start + name.len());
            called(name, arguments.len(), span, variables)?
        }
        NodeKind::Vector(components) => {
            let found = Kind::Vector(components.len());
            return Err(ParseError::WrongKind { found, wanted: Kind::Number, span: node.span });
        }
    })
}

fn named(name: &str, span: Span, variables: &[&str]) -> Result<Instruction, ParseError> {
    if let Some(position) = variables.iter().position(|&variable| variable == name) {
        return Ok(Instruction::Variable(position));
    }
    if let Some(&(_, value)) = CONSTANTS.iter().find(|(constant, _)| *constant == name) {
        return Ok(Instruction::Constant(value));
    }
    if let Some(entry) = FunctionEntry::find(name) {
        return Err(ParseError::WithoutArguments { name: name.to_owned(), usage: entry.usage, span });
    }
    let known = || variables.iter().copied().chain(CONSTANTS.iter().map(|(constant, _)| *constant));
    Err(ParseError::UnknownName {
        name: shortened(name),
        nearest: souple_table::nearest(name, known()).map(str::to_owned),
        known: known().map(str::to_owned).collect(),
        span,
    })
}

/// `None` for functions whose work is done argument by argument, see [`folds`].
fn called(
    name: &str,
    argument_count: usize,
    span: Span,
    variables: &[&str],
) -> Result<Option<Instruction>, ParseError> {
    let Some(entry) = FunctionEntry::find(name) else {
        if variables.contains(&name) || CONSTANTS.iter().any(|(constant, _)| *constant == name) {
            return Err(ParseError::NotAFunction { name: name.to_owned(), span });
        }
        let known = || FUNCTIONS.iter().map(|entry| entry.name);
        return Err(ParseError::UnknownFunction {
            name: shortened(name),
            nearest: souple_table::nearest(name, known()).map(str::to_owned),
            known: known().map(str::to_owned).collect(),
            span,
        });
    };
    if !entry.arguments.accepts(argument_count) {
        let (name, found) = (name.to_owned(), argument_count);
        return Err(ParseError::WrongArgumentCount { name, found, usage: entry.usage, span });
    }
    Ok(match (entry.function, argument_count) {
        (Function::Min | Function::Max, _) => None,
        (function, 1) => Some(Instruction::OfOne(function)),
        (function, 2) => Some(Instruction::OfTwo(function)),
        (function, _) => Some(Instruction::OfThree(function)),
    })
}

/// The beginning of a name, so that a message about a long one stays readable.
fn shortened(name: &str) -> String {
    name.chars().take(40).collect()
}

fn kind_of(kind: &NodeKind) -> Kind {
    match kind {
        NodeKind::Unary { operator: UnaryOperator::Not, .. } => Kind::Truth,
        NodeKind::Binary { operator, .. } if is_logical(*operator) || operator.is_comparison() => Kind::Truth,
        NodeKind::Vector(components) => Kind::Vector(components.len()),
        _ => Kind::Number,
    }
}

fn is_logical(operator: BinaryOperator) -> bool {
    matches!(operator, BinaryOperator::And | BinaryOperator::Or)
}

/// What the operand at `position` must be.
fn wanted_operand(kind: &NodeKind, position: usize) -> Kind {
    match kind {
        NodeKind::Unary { operator: UnaryOperator::Not, .. } => Kind::Truth,
        NodeKind::Binary { operator, .. } if is_logical(*operator) => Kind::Truth,
        NodeKind::Call { name, .. } => {
            FunctionEntry::find(name).map_or(Kind::Number, |entry| entry.argument_kind(position))
        }
        _ => Kind::Number,
    }
}

fn check_kind(node: &Node, wanted: Kind) -> Result<(), ParseError> {
    let found = kind_of(&node.kind);
    if found == wanted { Ok(()) } else { Err(ParseError::WrongKind { found, wanted, span: node.span }) }
}
