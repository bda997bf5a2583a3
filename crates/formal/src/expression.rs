//! The syntax tree of a formula, and how it is written out again.
//!
//! Nodes lie in one array, operands before what uses them and the root last: whoever works on a formula
//! (the evaluator, and derivations) passes once over the array, and a long formula cannot overflow the
//! stack. Names are kept as written: what they stand for is decided where a formula is compiled, so that
//! other languages over the same syntax bring names of their own.

use std::fmt;

use crate::Span;

/// A node of an [`Expression`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(u32);

impl NodeId {
    /// Its position in [`Expression::nodes`].
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// One part of a formula and its place in the text.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    pub kind: NodeKind,
    /// From the first to the last character; parentheses around it do not count.
    pub span: Span,
}

/// What a node is made of.
#[derive(Clone, Debug, PartialEq)]
pub enum NodeKind {
    /// Not negative: a sign is an operator.
    Number(f64),
    /// A variable or constant.
    Name(String),
    Unary {
        operator: UnaryOperator,
        operand: NodeId,
    },
    Binary {
        operator: BinaryOperator,
        left: NodeId,
        right: NodeId,
    },
    /// A function of its arguments; `if(condition, value, otherwise)` is one too.
    /// The name stands at the start of the node's span.
    Call {
        name: String,
        arguments: Vec<NodeId>,
    },
    /// A list in brackets.
    Vector(Vec<NodeId>),
}

impl NodeKind {
    /// What the node uses, from left to right.
    pub fn operands(&self) -> impl Iterator<Item = NodeId> {
        let (pair, list): ([Option<NodeId>; 2], &[NodeId]) = match self {
            Self::Number(_) | Self::Name(_) => ([None, None], &[]),
            Self::Unary { operand, .. } => ([Some(*operand), None], &[]),
            Self::Binary { left, right, .. } => ([Some(*left), Some(*right)], &[]),
            Self::Call { arguments, .. } => ([None, None], arguments),
            Self::Vector(components) => ([None, None], components),
        };
        pair.into_iter().flatten().chain(list.iter().copied())
    }
}

/// Operators before their operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryOperator {
    Negate,
    Not,
}

/// Operators between their operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinaryOperator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    NotEqual,
    And,
    Or,
}

/// How operators of one precedence group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Grouping {
    Left,
    Right,
    /// `a < b < c` means nothing.
    None,
}

impl UnaryOperator {
    /// How strongly it binds; `-a^2` is `-(a^2)`, and `not a < b` is `not (a < b)`.
    pub(crate) fn precedence(self) -> u8 {
        match self {
            Self::Not => 3,
            Self::Negate => 7,
        }
    }

    fn written(self) -> &'static str {
        match self {
            Self::Negate => "-",
            Self::Not => "not ",
        }
    }
}

impl BinaryOperator {
    /// How strongly it binds.
    pub(crate) fn precedence(self) -> u8 {
        match self {
            Self::Or => 1,
            Self::And => 2,
            Self::Less
            | Self::LessOrEqual
            | Self::Greater
            | Self::GreaterOrEqual
            | Self::Equal
            | Self::NotEqual => COMPARISON,
            Self::Add | Self::Subtract => 5,
            Self::Multiply | Self::Divide => 6,
            Self::Power => 8,
        }
    }

    pub(crate) fn grouping(self) -> Grouping {
        match self {
            Self::Power => Grouping::Right,
            _ if self.is_comparison() => Grouping::None,
            _ => Grouping::Left,
        }
    }

    /// Whether it compares two numbers.
    pub fn is_comparison(self) -> bool {
        self.precedence() == COMPARISON
    }

    fn written(self) -> &'static str {
        match self {
            Self::Add => " + ",
            Self::Subtract => " - ",
            Self::Multiply => " * ",
            Self::Divide => " / ",
            Self::Power => "^",
            Self::Less => " < ",
            Self::LessOrEqual => " <= ",
            Self::Greater => " > ",
            Self::GreaterOrEqual => " >= ",
            Self::Equal => " == ",
            Self::NotEqual => " != ",
            Self::And => " and ",
            Self::Or => " or ",
        }
    }
}

const COMPARISON: u8 = 4;
/// Binds stronger than every operator.
const ATOM: u8 = 9;

/// A parsed formula; it prints as a formula that parses to the same.
#[derive(Clone, Debug)]
pub struct Expression {
    nodes: Vec<Node>,
}

/// The same formula, wherever its parts stand in the text.
impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        let kinds = |expression: &Self| expression.nodes.len();
        kinds(self) == kinds(other) && self.nodes.iter().zip(&other.nodes).all(|(a, b)| a.kind == b.kind)
    }
}

impl Expression {
    /// Before the first [`push`](Self::push); the parser never hands out an expression without nodes.
    pub(crate) fn empty() -> Self {
        Self { nodes: Vec::new() }
    }

    /// A node whose operands are there already.
    pub(crate) fn push(&mut self, kind: NodeKind, span: Span) -> NodeId {
        // a text of at most `LONGEST` bytes has fewer nodes than that
        let id = NodeId(self.nodes.len() as u32);
        self.nodes.push(Node { kind, span });
        id
    }

    /// All nodes, operands before what uses them, the root last.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    pub fn node(&self, id: NodeId) -> &Node {
        &self.nodes[id.index()]
    }

    /// The node that is the whole formula.
    pub fn root(&self) -> NodeId {
        NodeId(self.nodes.len() as u32 - 1)
    }

    /// The positions of `id` and of all that it is made of: they lie side by side.
    pub fn subtree(&self, id: NodeId) -> std::ops::RangeInclusive<usize> {
        let mut first = id;
        while let Some(operand) = self.node(first).kind.operands().next() {
            first = operand;
        }
        first.index()..=id.index()
    }

    fn precedence(&self, id: NodeId) -> u8 {
        match &self.node(id).kind {
            NodeKind::Unary { operator, .. } => operator.precedence(),
            NodeKind::Binary { operator, .. } => operator.precedence(),
            NodeKind::Number(_) | NodeKind::Name(_) | NodeKind::Call { .. } | NodeKind::Vector(_) => ATOM,
        }
    }
}

/// What remains to be printed.
enum Piece<'a> {
    Text(&'a str),
    /// A node, in parentheses if it binds less than that.
    Node(NodeId, u8),
}

impl fmt::Display for Expression {
    // a stack of our own: sums of many terms are deep trees
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut remaining = vec![Piece::Node(self.root(), 0)];
        while let Some(piece) = remaining.pop() {
            let (id, weakest) = match piece {
                Piece::Text(text) => {
                    f.write_str(text)?;
                    continue;
                }
                Piece::Node(id, weakest) => (id, weakest),
            };
            if self.precedence(id) < weakest {
                remaining.extend([Piece::Text(")"), Piece::Node(id, 0), Piece::Text("(")]);
                continue;
            }
            match &self.node(id).kind {
                NodeKind::Number(number) => write_number(f, *number)?,
                NodeKind::Name(name) => f.write_str(name)?,
                NodeKind::Unary { operator, operand } => {
                    f.write_str(operator.written())?;
                    remaining.push(Piece::Node(*operand, operator.precedence()));
                }
                NodeKind::Binary { operator, left, right } => {
                    let precedence = operator.precedence();
                    let weakest_left = precedence + u8::from(operator.grouping() != Grouping::Left);
                    let weakest_right = precedence + u8::from(operator.grouping() != Grouping::Right);
                    remaining.push(Piece::Node(*right, weakest_right));
                    remaining.push(Piece::Text(operator.written()));
                    remaining.push(Piece::Node(*left, weakest_left));
                }
                NodeKind::Call { name, arguments } => {
                    write!(f, "{name}(")?;
                    remaining.push(Piece::Text(")"));
                    push_list(&mut remaining, arguments);
                }
                NodeKind::Vector(components) => {
                    f.write_str("[")?;
                    remaining.push(Piece::Text("]"));
                    push_list(&mut remaining, components);
                }
            }
        }
        Ok(())
    }
}

fn push_list(remaining: &mut Vec<Piece<'_>>, nodes: &[NodeId]) {
    for (position, id) in nodes.iter().enumerate().rev() {
        remaining.push(Piece::Node(*id, 0));
        if position > 0 {
            remaining.push(Piece::Text(", "));
        }
    }
}

/// The shortest digits that give the same number again, without a long row of zeros.
fn write_number(f: &mut fmt::Formatter<'_>, number: f64) -> fmt::Result {
    if number == 0.0 || (1e-5..1e16).contains(&number) {
        write!(f, "{number}")
    } else {
        write!(f, "{number:e}")
    }
}
