//! The syntax tree of a formula: the ground that evaluation and symbolic work stand on.
//!
//! Nodes lie in one array in post-order: the operands of a node stand before it, and a subtree is an unbroken run
//! that ends with its root. One forward loop therefore visits operands first, without recursion, and the tree of
//! a million terms is dropped like any array. Spans lie in a second array beside the nodes.

mod error;
mod function;
mod kinds;
mod lexer;
mod parser;
mod printer;

pub use error::{ParseError, ParseFault};
pub use function::Function;
pub use parser::{NESTING_LIMIT, TEXT_LIMIT, parse};

use std::fmt;
use std::ops::Range;

use crate::Span;

/// The place of a node in its [`Syntax`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(u32);

impl NodeId {
    /// Position in [`Syntax::nodes`].
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// The operands of a call or vector; resolved by [`Syntax::arguments`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arguments {
    first: u32,
    count: u32,
}

/// One operation of a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Node {
    /// Finite and not negative; a negative number is a [`Node::Negate`] of one.
    Number(f64),
    Constant(Constant),
    /// Index into [`Syntax::variables`].
    Variable(u32),
    /// `-x`
    Negate(NodeId),
    /// `not x`
    Not(NodeId),
    Binary {
        operator: BinaryOperator,
        left: NodeId,
        right: NodeId,
    },
    /// `if(condition, if_true, if_false)`
    Select {
        condition: NodeId,
        if_true: NodeId,
        if_false: NodeId,
    },
    Call {
        function: Function,
        arguments: Arguments,
    },
    /// `[a, b, c]`
    Vector(Arguments),
}

/// Numbers with a name of their own; a variable of the same name hides them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Constant {
    /// `pi`
    Pi,
    /// `e`
    E,
}

impl Constant {
    pub const ALL: [Self; 2] = [Self::Pi, Self::E];

    pub const fn name(self) -> &'static str {
        match self {
            Self::Pi => "pi",
            Self::E => "e",
        }
    }

    pub const fn value(self) -> f64 {
        match self {
            Self::Pi => std::f64::consts::PI,
            Self::E => std::f64::consts::E,
        }
    }
}

/// Operators between two operands, from the loosest to the tightest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BinaryOperator {
    Or,
    And,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    NotEqual,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

impl BinaryOperator {
    pub const ALL: [Self; 13] = [
        Self::Or,
        Self::And,
        Self::Less,
        Self::LessOrEqual,
        Self::Greater,
        Self::GreaterOrEqual,
        Self::Equal,
        Self::NotEqual,
        Self::Add,
        Self::Subtract,
        Self::Multiply,
        Self::Divide,
        Self::Power,
    ];

    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Or => "or",
            Self::And => "and",
            Self::Less => "<",
            Self::LessOrEqual => "<=",
            Self::Greater => ">",
            Self::GreaterOrEqual => ">=",
            Self::Equal => "==",
            Self::NotEqual => "!=",
            Self::Add => "+",
            Self::Subtract => "-",
            Self::Multiply => "*",
            Self::Divide => "/",
            Self::Power => "^",
        }
    }

    /// Kind of the operands and kind of the result.
    pub(crate) const fn kinds(self) -> (Kind, Kind) {
        match self.precedence() {
            Precedence::Or | Precedence::And => (Kind::Condition, Kind::Condition),
            Precedence::Comparison => (Kind::Number, Kind::Condition),
            _ => (Kind::Number, Kind::Number),
        }
    }

    const fn precedence(self) -> Precedence {
        match self {
            Self::Or => Precedence::Or,
            Self::And => Precedence::And,
            Self::Less
            | Self::LessOrEqual
            | Self::Greater
            | Self::GreaterOrEqual
            | Self::Equal
            | Self::NotEqual => Precedence::Comparison,
            Self::Add | Self::Subtract => Precedence::Sum,
            Self::Multiply | Self::Divide => Precedence::Product,
            Self::Power => Precedence::Power,
        }
    }

    /// How tightly the left and the right operand must hold together to stand without parentheses.
    const fn operand_precedences(self) -> (Precedence, Precedence) {
        match self.precedence() {
            Precedence::Or => (Precedence::Or, Precedence::And),
            Precedence::And => (Precedence::And, Precedence::Not),
            Precedence::Sum => (Precedence::Sum, Precedence::Product),
            Precedence::Product => (Precedence::Product, Precedence::Negation),
            // a power groups to the right and may have a signed exponent: 2^-x^3 is 2^(-(x^3))
            Precedence::Power => (Precedence::Primary, Precedence::Negation),
            _ => (Precedence::Sum, Precedence::Sum),
        }
    }
}

/// How tightly an expression holds together, loosest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Precedence {
    Or,
    And,
    Not,
    Comparison,
    Sum,
    Product,
    Negation,
    Power,
    Primary,
}

/// What a formula or a part of it yields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Number,
    /// True or false: a comparison or a combination of them.
    Condition,
    /// So many components.
    Vector(usize),
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number => f.write_str("a number"),
            Self::Condition => f.write_str("a condition"),
            Self::Vector(components) => write!(f, "a vector of {components}"),
        }
    }
}

/// A formula as a tree. `Display` prints it with the fewest parentheses; reading that back gives an equal tree.
#[derive(Clone, Debug)]
pub struct Syntax {
    nodes: Vec<Node>,
    spans: Vec<Span>,
    arguments: Vec<NodeId>,
    variables: Vec<String>,
}

/// Equal trees over equal variables, wherever they stood in their texts.
impl PartialEq for Syntax {
    fn eq(&self, other: &Self) -> bool {
        (&self.nodes, &self.arguments, &self.variables) == (&other.nodes, &other.arguments, &other.variables)
    }
}

impl Syntax {
    /// All nodes in post-order; the last is the root.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    pub fn node(&self, id: NodeId) -> Node {
        self.nodes[id.index()]
    }

    /// Where the node stands in the text, with its parentheses; `0..0` for a tree that was built without text.
    pub fn span(&self, id: NodeId) -> Span {
        self.spans[id.index()]
    }

    pub fn root(&self) -> NodeId {
        NodeId(self.nodes.len() as u32 - 1)
    }

    /// The operands of a call or vector of this tree.
    pub fn arguments(&self, arguments: Arguments) -> &[NodeId] {
        let first = arguments.first as usize;
        &self.arguments[first..first + arguments.count as usize]
    }

    /// The names that [`Node::Variable`] refers to, used or not.
    pub fn variables(&self) -> &[String] {
        &self.variables
    }

    /// Positions of the nodes of the subtree under `id`; the last is `id` itself.
    pub fn subtree(&self, id: NodeId) -> Range<usize> {
        // the first node of a post-order run is the leftmost leaf
        let mut first = id;
        loop {
            first = match self.node(first) {
                Node::Number(_) | Node::Constant(_) | Node::Variable(_) => break,
                Node::Negate(operand) | Node::Not(operand) => operand,
                Node::Binary { left, .. } => left,
                Node::Select { condition, .. } => condition,
                Node::Call { arguments, .. } | Node::Vector(arguments) => self.arguments(arguments)[0],
            };
        }
        first.index()..id.index() + 1
    }
}

/// Builds a [`Syntax`] as a reverse Polish calculator would: operands first, then what joins them.
///
/// ```
/// use souple_formal::{BinaryOperator, Function, SyntaxBuilder};
/// let mut builder = SyntaxBuilder::new(&["x"]);
/// builder.variable(0).number(2.0).binary(BinaryOperator::Multiply).call(Function::Sin, 1);
/// assert_eq!(builder.finish().to_string(), "sin(x * 2)");
/// ```
///
/// # Panics
/// Its methods panic where operands are lacking or a number of arguments does not fit: bugs of the caller.
#[derive(Clone, Debug)]
pub struct SyntaxBuilder {
    tree: Syntax,
    /// Roots of the subtrees not yet joined.
    open: Vec<NodeId>,
    span: Span,
}

impl SyntaxBuilder {
    pub fn new(variables: &[&str]) -> Self {
        let variables = variables.iter().map(|name| (*name).to_owned()).collect();
        let tree = Syntax { nodes: Vec::new(), spans: Vec::new(), arguments: Vec::new(), variables };
        Self { tree, open: Vec::new(), span: Span::default() }
    }

    /// The span of the nodes that follow.
    pub fn at(&mut self, span: Span) -> &mut Self {
        self.span = span;
        self
    }

    /// A finite number of either sign.
    pub fn number(&mut self, value: f64) -> &mut Self {
        assert!(value.is_finite(), "a formula holds finite numbers, not {value}");
        self.push(Node::Number(value.abs()));
        if value.is_sign_negative() { self.negate() } else { self }
    }

    pub fn constant(&mut self, constant: Constant) -> &mut Self {
        self.push(Node::Constant(constant))
    }

    pub fn variable(&mut self, index: u32) -> &mut Self {
        assert!((index as usize) < self.tree.variables.len(), "there is no variable {index}");
        self.push(Node::Variable(index))
    }

    pub fn negate(&mut self) -> &mut Self {
        let operand = self.pop();
        self.push(Node::Negate(operand))
    }

    pub fn not(&mut self) -> &mut Self {
        let operand = self.pop();
        self.push(Node::Not(operand))
    }

    pub fn binary(&mut self, operator: BinaryOperator) -> &mut Self {
        let right = self.pop();
        let left = self.pop();
        self.push(Node::Binary { operator, left, right })
    }

    /// Joins condition, value if true, value if false.
    pub fn select(&mut self) -> &mut Self {
        let if_false = self.pop();
        let if_true = self.pop();
        let condition = self.pop();
        self.push(Node::Select { condition, if_true, if_false })
    }

    pub fn call(&mut self, function: Function, count: usize) -> &mut Self {
        assert!(
            function.accepts(count),
            "{} takes {}, not {count}",
            function.name(),
            function.argument_count()
        );
        let arguments = self.pop_arguments(count);
        self.push(Node::Call { function, arguments })
    }

    pub fn vector(&mut self, count: usize) -> &mut Self {
        assert!(count > 0, "a vector has components");
        let arguments = self.pop_arguments(count);
        self.push(Node::Vector(arguments))
    }

    /// The tree under the one node that is left.
    pub fn finish(self) -> Syntax {
        assert_eq!(self.open.len(), 1, "a formula has one root");
        self.tree
    }

    fn push(&mut self, node: Node) -> &mut Self {
        self.open
            .push(NodeId(u32::try_from(self.tree.nodes.len()).expect("a formula has fewer than 2^32 nodes")));
        self.tree.nodes.push(node);
        self.tree.spans.push(self.span);
        self
    }

    fn pop(&mut self) -> NodeId {
        self.open.pop().expect("operands stand before what joins them")
    }

    fn pop_arguments(&mut self, count: usize) -> Arguments {
        let kept = self.open.len().checked_sub(count).expect("arguments stand before their call");
        let first = self.tree.arguments.len() as u32;
        self.tree.arguments.extend(self.open.drain(kept..));
        Arguments { first, count: count as u32 }
    }
}
