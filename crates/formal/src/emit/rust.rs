//! Rust, in double precision.

use super::stretches::Words;
use super::text::sign_of;
use super::{Binding, Style, Written};
use crate::Function;
use crate::function::FUNCTIONS;
use crate::graph::{Comparison, Node, Shape};

/// See the module.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rust;

/// Arguments of the functions, and words of the language that could be names of a law.
const TAKEN: &[&str] = &[
    "p", "u", "v", "d", "abstract", "as", "async", "await", "become", "box", "break", "const", "continue",
    "crate", "do", "dyn", "else", "enum", "extern", "f64", "false", "final", "fn", "for", "gen", "impl",
    "in", "let", "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub", "ref", "return",
    "self", "Self", "static", "struct", "super", "trait", "true", "try", "type", "typeof", "unsafe",
    "unsized", "use", "virtual", "where", "while", "yield",
];

const WORDS: Words = Words {
    vector: |numbers| format!("[{}]", numbers.join(", ")),
    matrix: |columns| format!("[{}]", columns.join(", ")),
};

impl Style for Rust {
    fn number(&self, value: f64) -> String {
        format!("{value:?}")
    }

    fn symbol(&self, name: &str) -> String {
        super::distinct(name, TAKEN)
    }

    fn own_symbol(&self, name: &str) -> String {
        super::element::indexed(name)
    }

    fn quotient(&self, above: &Written, below: &Written) -> Written {
        quotient(above, below)
    }

    fn power(&self, base: &Written, exponent: f64) -> Written {
        if exponent == 0.5 {
            return Written::atom(format!("f64::sqrt({})", base.text));
        }
        Written::atom(format!("f64::powf({}, {exponent:?})", base.text))
    }

    fn power_of(&self, base: &Written, exponent: &Written) -> Written {
        Written::atom(format!("f64::powf({}, {})", base.text, exponent.text))
    }

    fn function(&self, function: Function, argument: &Written) -> Written {
        if function == Function::Sign {
            let x = &argument.text;
            // `signum` of zero is one
            return Written::atom(format!("(if {x} == 0.0 {{ 0.0 }} else {{ f64::signum({x}) }})"));
        }
        let name = FUNCTIONS.iter().find(|entry| entry.function == function).map_or("?", |entry| entry.name);
        Written::atom(format!("f64::{name}({})", argument.text))
    }

    fn select(&self, (comparison, a, b): (Comparison, &str, &str), value: &str, otherwise: &str) -> Written {
        Written::atom(format!("(if {a} {} {b} {{ {value} }} else {{ {otherwise} }})", sign_of(comparison)))
    }

    fn tensor(&self, node: &Node, operands: &[Written]) -> Option<Written> {
        WORDS.tensor(node, operands)
    }

    fn entry(&self, shape: Shape, tensor: &Written, index: u8) -> Option<Written> {
        Some(super::stretches::entry(shape, tensor, index))
    }

    fn definition(&self, name: &str, value: &str) -> String {
        format!("let {name} = {};", bare(value))
    }

    fn powers_are_products(&self) -> bool {
        true
    }
}

/// Without parentheses around the whole.
fn bare(text: &str) -> &str {
    let Some(inner) = text.strip_prefix('(').and_then(|text| text.strip_suffix(')')) else { return text };
    let mut open = 0;
    for letter in inner.chars() {
        open += match letter {
            '(' => 1,
            ')' => -1,
            _ => 0,
        };
        // the first one is closed before the end
        if open < 0 {
            return text;
        }
    }
    inner
}

/// `a / b`, with what binds less in parentheses.
pub(super) fn quotient(above: &Written, below: &Written) -> Written {
    let within = |written: &Written, weakest: Binding| {
        if written.binding < weakest { format!("({})", written.text) } else { written.text.clone() }
    };
    let text = format!("{} / {}", within(above, Binding::Product), within(below, Binding::Power));
    Written { text, binding: Binding::Product }
}
