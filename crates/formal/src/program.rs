//! Instructions for a stack machine: what a formula becomes once its names are known.
//!
//! Running takes no memory from the allocator and gives the same bits everywhere. Both branches of `if`
//! are evaluated and one is taken. Truth is kept as 1 and 0.

use crate::arithmetic::{self, Number};
use crate::function::{CONSTANTS, FUNCTIONS, FunctionEntry, nearest_function};
use crate::interval::{self, Interval};
use crate::parser::DEEPEST;
use crate::{
    BinaryOperator, Expression, Function, Kind, Node, NodeId, NodeKind, ParseError, Span, UnaryOperator,
};

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
pub(crate) struct Program {
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
    pub(crate) fn compile(
        expression: &Expression,
        root: NodeId,
        wanted: Kind,
        variables: &[&str],
    ) -> Result<Self, ParseError> {
        let range = expression.subtree(root);
        let nodes = &expression.nodes()[range.clone()];
        check_kind(expression.node(root), wanted)?;
        let folds = folds(*range.start(), nodes);
        let mut program = Self { instructions: Vec::new(), stack: 0 };
        for (node, fold) in nodes.iter().zip(folds) {
            // names first: what an unknown function wants of its arguments is unknown too
            let instruction = instruction_of(node, variables)?;
            for (position, operand) in node.kind.operands().enumerate() {
                check_kind(expression.node(operand), wanted_operand(&node.kind, position))?;
            }
            if let Some(instruction) = instruction {
                program.push(instruction);
            }
            if let Some(function) = fold {
                program.push(Instruction::OfTwo(function));
            }
        }
        program.stack = program.measure_stack();
        Ok(program)
    }

    pub(crate) fn constant(value: f64) -> Self {
        Self { instructions: vec![Instruction::Constant(value)], stack: 1 }
    }

    /// Whether the variable at `position` is used.
    pub(crate) fn reads(&self, position: usize) -> bool {
        self.instructions.contains(&Instruction::Variable(position))
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
        // a variable times itself: the same product, of which it is known that it is not below zero
        if let (
            Instruction::Binary(BinaryOperator::Multiply),
            [Instruction::Variable(a), Instruction::Variable(b)],
        ) = (instruction, operands)
            && a == b
        {
            self.instructions.pop();
            self.instructions.push(Instruction::WholePower(2));
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

    /// The result, with the variables as given; truth is 1 or 0.
    pub(crate) fn run<T: Number>(&self, variable: impl Fn(usize) -> T) -> T {
        if self.stack <= USUAL_STACK {
            self.run_on(&mut [T::constant(0.0); USUAL_STACK], variable)
        } else {
            self.run_on(&mut [T::constant(0.0); LARGEST_STACK], variable)
        }
    }

    /// Numbers that the result lies between, for variables between those given.
    pub(crate) fn range(&self, variable: impl Fn(usize) -> [f64; 2]) -> Option<[f64; 2]> {
        let mut stack: Vec<interval::Known> = Vec::with_capacity(self.stack);
        for instruction in &self.instructions {
            let bottom = stack.len() - instruction.operand_count();
            let of = |operand: usize| stack[bottom + operand];
            let result = match *instruction {
                Instruction::Constant(value) => Interval::point(value),
                Instruction::Variable(position) => {
                    let [low, high] = variable(position);
                    Interval::of(low, high)
                }
                Instruction::Unary(UnaryOperator::Negate) => interval::negate(of(0)),
                Instruction::Unary(UnaryOperator::Not) => interval::not(of(0)),
                Instruction::Binary(operator) => interval::binary(operator, of(0), of(1)),
                Instruction::WholePower(exponent) => interval::power_of_whole(of(0), exponent),
                Instruction::OfOne(function) => interval::function_of_one(function, of(0)),
                Instruction::OfTwo(function) => interval::function_of_two(function, of(0), of(1)),
                Instruction::OfThree(function) => interval::function_of_three(function, of(0), of(1), of(2)),
            };
            stack.truncate(bottom);
            stack.push(result);
        }
        stack.pop().flatten().map(|Interval { low, high }| [low, high])
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
fn folds(first: usize, nodes: &[Node]) -> Vec<Option<Function>> {
    let mut folds = vec![None; nodes.len()];
    for node in nodes {
        if let NodeKind::Call { name, arguments } = &node.kind
            && let Some(entry) = FunctionEntry::find(name)
            && matches!(entry.function, Function::Min | Function::Max)
        {
            for argument in arguments.iter().skip(1) {
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
            nearest: nearest_function(name, known()),
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

pub(crate) fn kind_of(kind: &NodeKind) -> Kind {
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

#[cfg(test)]
mod tests {
    use super::*;

    const VARIABLES: &[&str] = &["x", "y", "t"];

    fn compiled(text: &str, variables: &[&str]) -> Program {
        let expression = Expression::parse(text).unwrap();
        Program::compile(&expression, expression.root(), Kind::Number, variables).unwrap()
    }

    fn run(program: &Program, values: &[f64]) -> f64 {
        program.run(|position| values[position])
    }

    /// What is known while compiling is computed there; a variable goes before a constant of its name.
    #[test]
    fn constants_fold() {
        let shadowed = compiled("e + 1", &["e"]);
        assert_eq!(run(&shadowed, &[4.0]), 5.0);
        assert_eq!(run(&Program::constant(-2.5), &[]), -2.5);
        let folded = compiled("max(1, 2, min(5, 3)) - 2^10", &[]);
        assert_eq!(folded.instructions, [Instruction::Constant(-1021.0)]);
        let power = compiled("x^(4 - 1)", VARIABLES);
        assert_eq!(power.instructions, [Instruction::Variable(0), Instruction::WholePower(3)]);
    }

    /// The stack holds the deepest formula that parses, and long lists need no more than short ones.
    #[test]
    fn deep_and_long_formulas() {
        let depth = DEEPEST - 1;
        let nested = format!("{}x{}", "clamp(y, x, ".repeat(depth), ")".repeat(depth));
        let formula = compiled(&nested, VARIABLES);
        assert_eq!(formula.stack, 2 * depth + 1);
        assert!(formula.stack <= LARGEST_STACK);
        assert_eq!(run(&formula, &[3.0, 2.0, 0.0]), 3.0);
        let list = format!("max(x{})", ", y".repeat(10_000));
        let formula = compiled(&list, VARIABLES);
        assert_eq!((formula.stack, run(&formula, &[3.0, 2.0, 0.0])), (2, 3.0));
        let sum = compiled(&format!("x{}", "+x".repeat(10_000)), VARIABLES);
        assert_eq!(run(&sum, &[1.0, 0.0, 0.0]), 10_001.0);
    }
}
