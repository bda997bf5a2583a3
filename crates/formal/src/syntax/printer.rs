//! A tree back to text.

use std::fmt;

use super::{Node, NodeId, Precedence, Syntax};

impl fmt::Display for Syntax {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.display(self.root()).fmt(f)
    }
}

impl Syntax {
    /// The text of the subtree under `id`.
    pub fn display(&self, id: NodeId) -> impl fmt::Display {
        Subtree { tree: self, root: id }
    }

    fn precedence(&self, id: NodeId) -> Precedence {
        match self.node(id) {
            Node::Negate(_) => Precedence::Negation,
            Node::Not(_) => Precedence::Not,
            Node::Binary { operator, .. } => operator.precedence(),
            _ => Precedence::Primary,
        }
    }
}

struct Subtree<'a> {
    tree: &'a Syntax,
    root: NodeId,
}

/// What is still to be written.
enum Piece {
    Text(&'static str),
    /// An operand, in parentheses if it holds together less tightly than this.
    Operand(NodeId, Precedence),
}

impl fmt::Display for Subtree<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let tree = self.tree;
        // a stack of our own: long sums are deep trees
        let mut pending = vec![Piece::Operand(self.root, Precedence::Or)];
        while let Some(piece) = pending.pop() {
            let (id, minimum) = match piece {
                Piece::Text(text) => {
                    f.write_str(text)?;
                    continue;
                }
                Piece::Operand(id, minimum) => (id, minimum),
            };
            if tree.precedence(id) < minimum {
                f.write_str("(")?;
                pending.push(Piece::Text(")"));
            }
            let free = |id| Piece::Operand(id, Precedence::Or);
            match tree.node(id) {
                Node::Number(value) => write_number(f, value)?,
                Node::Constant(constant) => f.write_str(constant.name())?,
                Node::Variable(index) => f.write_str(&tree.variables()[index as usize])?,
                Node::Negate(operand) => {
                    f.write_str("-")?;
                    pending.push(Piece::Operand(operand, Precedence::Negation));
                }
                Node::Not(operand) => {
                    f.write_str("not ")?;
                    pending.push(Piece::Operand(operand, Precedence::Not));
                }
                Node::Binary { operator, left, right } => {
                    let (left_minimum, right_minimum) = operator.operand_precedences();
                    pending.push(Piece::Operand(right, right_minimum));
                    if operator.precedence() == Precedence::Power {
                        pending.push(Piece::Text(operator.symbol()));
                    } else {
                        pending.extend([" ", operator.symbol(), " "].map(Piece::Text));
                    }
                    pending.push(Piece::Operand(left, left_minimum));
                }
                Node::Select { condition, if_true, if_false } => {
                    f.write_str("if(")?;
                    let separated = [
                        Piece::Text(")"),
                        free(if_false),
                        Piece::Text(", "),
                        free(if_true),
                        Piece::Text(", "),
                        free(condition),
                    ];
                    pending.extend(separated);
                }
                Node::Call { arguments, .. } | Node::Vector(arguments) => {
                    let (name, opening, closing) = match tree.node(id) {
                        Node::Call { function, .. } => (function.name(), "(", ")"),
                        _ => ("", "[", "]"),
                    };
                    write!(f, "{name}{opening}")?;
                    pending.push(Piece::Text(closing));
                    for (at, argument) in tree.arguments(arguments).iter().enumerate().rev() {
                        pending.push(free(*argument));
                        if at > 0 {
                            pending.push(Piece::Text(", "));
                        }
                    }
                }
            }
        }
        Ok(())
    }
}

/// The shortest digits that read back as `value`.
fn write_number(f: &mut fmt::Formatter<'_>, value: f64) -> fmt::Result {
    if value == 0.0 || (1e-5..1e15).contains(&value) { write!(f, "{value}") } else { write!(f, "{value:e}") }
}
