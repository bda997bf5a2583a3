//! Functions of the principal stretches in emitted code: what they call, written behind it.
//!
//! `F = U diag(s) Vᵀ` comes from one-sided Jacobi, which needs no roots of a cubic and leaves small stretches their digits. Differences of
//! `g` over differences of stretches, which the differential of `U diag(g) Vᵀ` is made of, go over to their limits where stretches coincide.

use super::Written;
use crate::graph::{Node, STRETCHES, Shape};

/// What each language has of its own.
pub(super) struct Words {
    /// Three numbers, then as many vectors, become a vector and a matrix.
    pub vector: fn(&[String]) -> String,
    pub matrix: fn([String; 3]) -> String,
}

impl Words {
    /// Tensors of the law at a sample: only stretches need any.
    pub fn tensor(&self, node: &Node, operands: &[Written]) -> Option<Written> {
        let texts: Vec<String> = operands.iter().map(|operand| operand.text.clone()).collect();
        let call = |name: &str| format!("{name}({})", texts.join(", "));
        let zero = || (self.vector)(&["0.0", "0.0", "0.0"].map(str::to_owned));
        Some(Written::atom(match node {
            Node::Pack(_) if texts.len() == 3 => (self.vector)(&texts),
            Node::Pack(_) => (self.matrix)([0, 3, 6].map(|first| (self.vector)(&texts[first..first + 3]))),
            Node::Zero(Shape::Vector) => zero(),
            Node::Identity => {
                let column = |axis: usize| {
                    (self.vector)(&[0, 1, 2].map(|row| if row == axis { "1.0" } else { "0.0" }.to_owned()))
                };
                (self.matrix)([0, 1, 2].map(column))
            }
            Node::Zero(Shape::Matrix) => (self.matrix)([zero(), zero(), zero()]),
            Node::Decompose(_) => call(DECOMPOSE),
            Node::Compose(..) => call("compose"),
            Node::StretchRates(..) => call("stretch_rates"),
            Node::ComposeDifferential(_) => call("compose_differential"),
            _ => return None,
        }))
    }
}

/// A number of a vector, of a matrix by columns, or a stretch.
pub(super) fn entry(shape: Shape, tensor: &Written, index: u8) -> Written {
    let tensor = &tensor.text;
    Written::atom(match shape {
        Shape::Matrix => format!("{tensor}[{}][{}]", index / 3, index % 3),
        Shape::Decomposition if index < 9 => format!("{tensor}.left[{}][{}]", index / 3, index % 3),
        Shape::Decomposition if index < STRETCHES => {
            format!("{tensor}.right[{}][{}]", index / 3 - 3, index % 3)
        }
        Shape::Decomposition => format!("{tensor}.stretches[{}]", index - STRETCHES),
        _ => format!("{tensor}[{index}]"),
    })
}

const DECOMPOSE: &str = "decompose";

/// `code` with the functions behind it that work on stretches, where it calls them.
pub(super) fn with_functions(mut code: String, functions: &str) -> String {
    if code.contains(&format!("{DECOMPOSE}(")) {
        code += "\n";
        code += functions;
    }
    code
}

pub(super) const OF_RUST: &str = include_str!("stretches/functions.rust.txt");
pub(super) const OF_WGSL: &str = include_str!("stretches/functions.wgsl");
