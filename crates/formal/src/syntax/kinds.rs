//! What each part of a tree yields: numbers, conditions and vectors do not mix.

use super::{Kind, Node, NodeId, ParseError, ParseFault, Syntax};
use crate::span::shortened;

impl Syntax {
    /// What the subtree under `id` yields.
    ///
    /// # Errors
    /// An operand in it is not of the kind its operation takes.
    pub fn kind(&self, id: NodeId) -> Result<Kind, ParseError> {
        let nodes = self.subtree(id);
        let first = nodes.start;
        let mut kinds: Vec<Kind> = Vec::with_capacity(nodes.len());
        for node in &self.nodes()[nodes] {
            let require = |operand: NodeId, wanted: Kind| {
                let found = kinds[operand.index() - first];
                if found == wanted { Ok(()) } else { Err(self.wrong_kind(operand, found, wanted)) }
            };
            let kind = match *node {
                Node::Number(_) | Node::Constant(_) | Node::Variable(_) => Kind::Number,
                Node::Negate(operand) => {
                    require(operand, Kind::Number)?;
                    Kind::Number
                }
                Node::Not(operand) => {
                    require(operand, Kind::Condition)?;
                    Kind::Condition
                }
                Node::Binary { operator, left, right } => {
                    let (operands, result) = operator.kinds();
                    require(left, operands)?;
                    require(right, operands)?;
                    result
                }
                Node::Select { condition, if_true, if_false } => {
                    require(condition, Kind::Condition)?;
                    let kind = match kinds[if_true.index() - first] {
                        Kind::Condition => Kind::Condition,
                        _ => Kind::Number,
                    };
                    require(if_true, kind)?;
                    require(if_false, kind)?;
                    kind
                }
                Node::Call { arguments, .. } => {
                    for argument in self.arguments(arguments) {
                        require(*argument, Kind::Number)?;
                    }
                    Kind::Number
                }
                Node::Vector(components) => {
                    for component in self.arguments(components) {
                        require(*component, Kind::Number)?;
                    }
                    Kind::Vector(self.arguments(components).len())
                }
            };
            kinds.push(kind);
        }
        Ok(kinds[kinds.len() - 1])
    }

    /// Refuses a subtree that does not yield `wanted`.
    pub(crate) fn require_kind(&self, id: NodeId, wanted: Kind) -> Result<(), ParseError> {
        let found = self.kind(id)?;
        if found == wanted { Ok(()) } else { Err(self.wrong_kind(id, found, wanted)) }
    }

    fn wrong_kind(&self, id: NodeId, found: Kind, wanted: Kind) -> ParseError {
        let read = shortened(&self.display(id).to_string());
        ParseError { span: self.span(id), fault: ParseFault::WrongKind { read, found, wanted } }
    }
}
