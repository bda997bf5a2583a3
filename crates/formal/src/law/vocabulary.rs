//! The words of the law language beside those of formulas.

#![allow(non_snake_case)]

use crate::graph::{Expr, Graph, Shape};

/// A quantity or function that a law may name, with its page.
#[derive(Clone, Copy, Debug)]
pub struct Word {
    pub name: &'static str,
    /// As it is written, for a function with its arguments.
    pub usage: &'static str,
    pub meaning: &'static str,
}

const fn word(name: &'static str, usage: &'static str, meaning: &'static str) -> Word {
    Word { name, usage, meaning }
}

/// Quantities of the deformation. Entries are written `F11`, `C12`, `E33`, `B23`, `eps31`.
pub const QUANTITIES: &[Word] = &[
    word("F", "F", "deformation gradient"),
    word("C", "C", "right Cauchy–Green tensor FᵀF"),
    word("B", "B", "left Cauchy–Green tensor FFᵀ"),
    word("E", "E", "Green strain (C - I)/2"),
    word("eps", "eps", "small strain (F + Fᵀ)/2 - I: rotations count as strain"),
    word("I", "I", "identity"),
    word("J", "J", "ratio of volumes det F"),
    word("I1", "I1", "tr C"),
    word("I2", "I2", "(I1² - C:C)/2"),
    word("I3", "I3", "det C = J²"),
    word("I1_bar", "I1_bar", "J^(-2/3) I1"),
    word("I2_bar", "I2_bar", "J^(-4/3) I2"),
    word("l1", "l1", "largest principal stretch"),
    word("l2", "l2", "middle principal stretch"),
    word("l3", "l3", "smallest principal stretch, negative in inverted elements"),
];

/// Functions of tensors and directions.
pub const LAW_FUNCTIONS: &[Word] = &[
    word("tr", "tr(A)", "trace"),
    word("det", "det(A)", "determinant"),
    word("cof", "cof(A)", "cofactor det(A) A⁻ᵀ"),
    word("inv", "inv(A)", "inverse"),
    word("transpose", "transpose(A)", "transpose"),
    word("sym", "sym(A)", "symmetric part"),
    word("dev", "dev(A)", "deviator A - tr(A)/3 I"),
    word("dot", "dot(A, B)", "sum of products of entries, of two tensors or two vectors"),
    word("outer", "outer(a, b)", "dyad a bᵀ"),
    word("I4", "I4(a)", "square of the stretch along the direction a, a·C a"),
    word("I5", "I5(a)", "a·C² a"),
];

/// Signs of books, what they are read in, and how that is written here.
pub(super) const SIGNS_OF_BOOKS: &[[&str; 3]] = &[
    [":", "A:B", "dot(A, B)"],
    ["⊗", "a⊗b", "outer(a, b)"],
    ["ᵀ", "Aᵀ", "transpose(A)"],
    ["'", "A'", "transpose(A)"],
    ["^T", "A^T", "transpose(A)"],
    ["=", "W = c*(J - 1)^2", "c*(J - 1)^2"],
];

impl Word {
    pub(crate) fn find(words: &'static [Self], name: &str) -> Option<&'static Self> {
        words.iter().find(|word| word.name == name)
    }

    pub(crate) fn list() -> String {
        QUANTITIES.iter().map(|word| word.name).collect::<Vec<_>>().join(", ")
    }
}

/// The quantity of that name; entries too.
pub(crate) fn quantity(graph: &mut Graph, name: &str) -> Option<Expr> {
    if let Some((tensor, row, column)) = entry_of(name) {
        let tensor = quantity(graph, tensor)?;
        return Some(graph.entry(tensor, (3 * column + row) as u8));
    }
    let F = graph.symbol(super::DEFORMATION, Shape::Matrix);
    let transposed = graph.transpose(F);
    let identity = graph.identity();
    Some(match name {
        "F" => F,
        "C" => graph.multiply(transposed, F),
        "B" => graph.multiply(F, transposed),
        "E" => {
            let C = graph.multiply(transposed, F);
            let (half, rest) = (graph.times_number(0.5, C), graph.times_number(-0.5, identity));
            graph.sum(&[half, rest])
        }
        "eps" => {
            let symmetric = graph.symmetric_part(F);
            graph.subtract(symmetric, identity)
        }
        "I" => identity,
        "J" => graph.determinant(F),
        "I1" => graph.dot(F, F),
        "I2" => {
            let C = graph.multiply(transposed, F);
            let (I1, squares) = (graph.dot(F, F), graph.dot(C, C));
            let square = graph.power_number(I1, 2.0);
            let difference = graph.subtract(square, squares);
            graph.times_number(0.5, difference)
        }
        "I3" => {
            let J = graph.determinant(F);
            graph.power_number(J, 2.0)
        }
        "I1_bar" | "I2_bar" => {
            let (invariant, exponent) =
                if name == "I1_bar" { ("I1", -2.0 / 3.0) } else { ("I2", -4.0 / 3.0) };
            let (invariant, J) = (quantity(graph, invariant)?, graph.determinant(F));
            let factor = graph.power_number(J, exponent);
            graph.times(factor, invariant)
        }
        "l1" | "l2" | "l3" => {
            let decomposition = graph.decompose(F);
            graph.stretch(decomposition, name.as_bytes()[1] - b'1')
        }
        _ => return None,
    })
}

/// `C12` is the entry (0, 1) of `C`.
pub(crate) fn entry_of(name: &str) -> Option<(&str, usize, usize)> {
    let tensor = ["eps", "F", "C", "B", "E"].into_iter().find(|tensor| name.starts_with(tensor))?;
    match &name.as_bytes()[tensor.len()..] {
        [row @ b'1'..=b'3', column @ b'1'..=b'3'] => {
            Some((tensor, usize::from(row - b'1'), usize::from(column - b'1')))
        }
        _ => None,
    }
}

/// Whether the arguments of a function are directions.
pub(crate) fn takes_directions(name: &str) -> bool {
    matches!(name, "outer" | "I4" | "I5")
}

/// Whether laws have a quantity of that name; entries too.
pub(crate) fn is_quantity(name: &str) -> bool {
    Word::find(QUANTITIES, name).is_some() || entry_of(name).is_some()
}

/// What a name means in every law, where it means something.
pub(crate) fn reserved(name: &str) -> Option<String> {
    let word = Word::find(QUANTITIES, name).or_else(|| Word::find(LAW_FUNCTIONS, name));
    if let Some(word) = word {
        return Some(word.meaning.to_owned());
    }
    if let Some((tensor, row, column)) = entry_of(name) {
        return Some(format!("entry ({}, {}) of {tensor}", row + 1, column + 1));
    }
    crate::FunctionEntry::find(name).map(|entry| entry.summary.to_owned())
}
