//! A tree compiled to a flat program for a stack machine.
//!
//! Post-order is the order of evaluation, so compiling is one pass over the nodes: kinds checked, constant parts
//! computed once, whole powers turned into products. Both sides of a choice are evaluated; there are no jumps.

use std::ops::Range;

use crate::scalar::{Scalar, apply_one, apply_three, apply_two, integer_power, power};
use crate::syntax::{BinaryOperator, Function, Kind, Node, NodeId, ParseError, ParseFault, Syntax};

/// Largest whole exponent computed by products; beyond it `pow` is as fast.
const LARGEST_PRODUCT_POWER: f64 = 16.0;

/// Each nesting level holds back at most two values while its last operand is evaluated.
const DEEPEST_STACK: usize = 2 * crate::NESTING_LIMIT + 2;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Instruction {
    Constant(f64),
    Variable(u32),
    Negate,
    Not,
    Binary(BinaryOperator),
    /// By a whole constant.
    Power(i32),
    Select,
    One(Function),
    Two(Function),
    Three(Function),
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Program {
    instructions: Vec<Instruction>,
    /// Most values on the stack at a time.
    depth: usize,
}

impl Program {
    /// The subtree under `root`, which must yield `wanted`.
    pub fn compile(syntax: &Syntax, root: NodeId, wanted: Kind) -> Result<Self, ParseError> {
        syntax.require_kind(root, wanted)?;
        let nodes = syntax.subtree(root);
        let mut compiler = Compiler { instructions: Vec::new(), held: 0, depth: 0 };
        let folds = folds(syntax, nodes.clone());
        for at in nodes.clone() {
            compiler.node(syntax, syntax.nodes()[at]);
            if let Some(function) = folds[at - nodes.start] {
                compiler.join(Instruction::Two(function), 2);
            }
            if compiler.depth > DEEPEST_STACK {
                return Err(ParseError { span: syntax.span(root), fault: ParseFault::TooDeep });
            }
        }
        Ok(Self { instructions: compiler.instructions, depth: compiler.depth })
    }

    /// The value, if it depends on no variable.
    pub fn constant(&self) -> Option<f64> {
        match self.instructions[..] {
            [Instruction::Constant(value)] => Some(value),
            _ => None,
        }
    }

    pub fn depends_on(&self, variable: usize) -> bool {
        self.instructions
            .iter()
            .any(|i| matches!(i, Instruction::Variable(index) if *index as usize == variable))
    }

    pub fn evaluate<S: Scalar>(&self, values: &[S]) -> S {
        // a small stack is cheaper to clear, and most formulas fit the smallest
        match self.depth {
            0..=8 => run::<S, 8>(&self.instructions, values),
            9..=32 => run::<S, 32>(&self.instructions, values),
            _ => run::<S, DEEPEST_STACK>(&self.instructions, values),
        }
    }
}

fn run<S: Scalar, const DEPTH: usize>(instructions: &[Instruction], values: &[S]) -> S {
    let mut stack = [S::constant(0.0); DEPTH];
    // the topmost value is at `top - 1`
    let mut top = 0;
    for instruction in instructions {
        match *instruction {
            Instruction::Constant(value) => {
                stack[top] = S::constant(value);
                top += 1;
            }
            Instruction::Variable(index) => {
                stack[top] = values[index as usize];
                top += 1;
            }
            Instruction::Negate => stack[top - 1] = -stack[top - 1],
            Instruction::Not => stack[top - 1] = truth(stack[top - 1].value() == 0.0),
            Instruction::Power(exponent) => stack[top - 1] = integer_power(stack[top - 1], exponent),
            Instruction::One(function) => stack[top - 1] = apply_one(function, stack[top - 1]),
            Instruction::Binary(operator) => {
                top -= 1;
                stack[top - 1] = join(operator, stack[top - 1], stack[top]);
            }
            Instruction::Two(function) => {
                top -= 1;
                stack[top - 1] = apply_two(function, stack[top - 1], stack[top]);
            }
            Instruction::Three(function) => {
                top -= 2;
                stack[top - 1] = apply_three(function, stack[top - 1], stack[top], stack[top + 1]);
            }
            Instruction::Select => {
                top -= 2;
                let chosen = if stack[top - 1].value() != 0.0 { top } else { top + 1 };
                stack[top - 1] = stack[chosen];
            }
        }
    }
    stack[0]
}

fn join<S: Scalar>(operator: BinaryOperator, a: S, b: S) -> S {
    let (x, y) = (a.value(), b.value());
    match operator {
        BinaryOperator::Add => a + b,
        BinaryOperator::Subtract => a - b,
        BinaryOperator::Multiply => a * b,
        BinaryOperator::Divide => a / b,
        BinaryOperator::Power => power(a, b),
        BinaryOperator::Or => truth(x != 0.0 || y != 0.0),
        BinaryOperator::And => truth(x != 0.0 && y != 0.0),
        BinaryOperator::Less => truth(x < y),
        BinaryOperator::LessOrEqual => truth(x <= y),
        BinaryOperator::Greater => truth(x > y),
        BinaryOperator::GreaterOrEqual => truth(x >= y),
        BinaryOperator::Equal => truth(x == y),
        BinaryOperator::NotEqual => truth(x != y),
    }
}

fn truth<S: Scalar>(holds: bool) -> S {
    S::constant(if holds { 1.0 } else { 0.0 })
}

struct Compiler {
    instructions: Vec<Instruction>,
    /// Values on the stack after the instructions so far.
    held: usize,
    depth: usize,
}

impl Compiler {
    fn node(&mut self, syntax: &Syntax, node: Node) {
        match node {
            Node::Number(value) => self.push(Instruction::Constant(value)),
            Node::Constant(constant) => self.push(Instruction::Constant(constant.value())),
            Node::Variable(index) => self.push(Instruction::Variable(index)),
            Node::Negate(_) => self.join(Instruction::Negate, 1),
            Node::Not(_) => self.join(Instruction::Not, 1),
            Node::Binary { operator: BinaryOperator::Power, .. } => self.power(),
            Node::Binary { operator, .. } => self.join(Instruction::Binary(operator), 2),
            Node::Select { .. } => self.join(Instruction::Select, 3),
            Node::Call { function: Function::Pow, .. } => self.power(),
            // joined pair by pair behind its arguments
            Node::Call { function: Function::Min | Function::Max, .. } => {}
            Node::Call { function, arguments } => match syntax.arguments(arguments).len() {
                1 => self.join(Instruction::One(function), 1),
                2 => self.join(Instruction::Two(function), 2),
                _ => self.join(Instruction::Three(function), 3),
            },
            Node::Vector(_) => unreachable!("kinds are checked: no vector stands inside a number"),
        }
    }

    fn push(&mut self, instruction: Instruction) {
        self.instructions.push(instruction);
        self.held += 1;
        self.depth = self.depth.max(self.held);
    }

    /// An operation on the `count` topmost values; done at once where they are constants.
    fn join(&mut self, instruction: Instruction, count: usize) {
        self.instructions.push(instruction);
        self.held -= count - 1;
        // as many values come from as many instructions or more
        let first = self.instructions.len() - 1 - count;
        let (tail, operands) = (&self.instructions[first..], first..first + count);
        if self.instructions[operands].iter().all(|operand| matches!(operand, Instruction::Constant(_))) {
            let value = run::<f64, 4>(tail, &[]);
            self.instructions.truncate(first);
            self.instructions.push(Instruction::Constant(value));
        }
    }

    fn power(&mut self) {
        match self.instructions.last() {
            Some(Instruction::Constant(exponent))
                if exponent.abs() <= LARGEST_PRODUCT_POWER && exponent.fract() == 0.0 =>
            {
                let exponent = *exponent as i32;
                self.instructions.pop();
                self.held -= 1;
                self.join(Instruction::Power(exponent), 1);
            }
            _ => self.join(Instruction::Binary(BinaryOperator::Power), 2),
        }
    }
}

/// For each node the function that joins it to its elder sibling: `min(a, b, c)` runs as `a b min c min`, so that
/// a list of any length needs two places on the stack.
fn folds(syntax: &Syntax, nodes: Range<usize>) -> Vec<Option<Function>> {
    let mut folds = vec![None; nodes.len()];
    for node in &syntax.nodes()[nodes.clone()] {
        if let Node::Call { function: function @ (Function::Min | Function::Max), arguments } = *node {
            for argument in &syntax.arguments(arguments)[1..] {
                folds[argument.index() - nodes.start] = Some(function);
            }
        }
    }
    folds
}
