//! The law language itself: what is written can be read back.

use super::{Binding, Style, Written};
use crate::Function;
use crate::function::FUNCTIONS;
use crate::graph::{Comparison, Node};

/// See the module.
#[derive(Clone, Copy, Debug, Default)]
pub struct Text;

pub(super) fn sign_of(comparison: Comparison) -> &'static str {
    match comparison {
        Comparison::Less => "<",
        Comparison::LessOrEqual => "<=",
        Comparison::Equal => "==",
    }
}

/// A number as one writes it: `2/3` where that has its bits and its decimals would not end.
fn plain(value: f64) -> String {
    let decimal = value.to_string();
    if decimal.len() > 12 {
        for below in [3.0, 6.0, 7.0, 9.0, 11.0, 12.0, 15.0, 27.0] {
            let above = (value * below).round();
            if above / below == value && above.abs() < 1e3 {
                return format!("{above}/{below}");
            }
        }
    }
    decimal
}

fn within(written: &Written, weakest: Binding) -> String {
    if written.binding < weakest { format!("({})", written.text) } else { written.text.clone() }
}

impl Style for Text {
    fn number(&self, value: f64) -> String {
        plain(value)
    }

    fn times(&self) -> &'static str {
        "*"
    }

    fn quotient(&self, above: &Written, below: &Written) -> Written {
        let text = format!("{}/{}", within(above, Binding::Product), within(below, Binding::Power));
        Written { text, binding: Binding::Product }
    }

    fn power(&self, base: &Written, exponent: f64) -> Written {
        let text = plain(exponent);
        let binding = if text.contains('/') { Binding::Product } else { Binding::Atom };
        self.power_of(base, &Written { text, binding })
    }

    fn power_of(&self, base: &Written, exponent: &Written) -> Written {
        let text = format!("{}^{}", within(base, Binding::Atom), within(exponent, Binding::Atom));
        Written { text, binding: Binding::Power }
    }

    fn function(&self, function: Function, argument: &Written) -> Written {
        let name = FUNCTIONS.iter().find(|entry| entry.function == function).map_or("?", |entry| entry.name);
        Written::atom(format!("{name}({})", argument.text))
    }

    fn select(&self, (comparison, a, b): (Comparison, &str, &str), value: &str, otherwise: &str) -> Written {
        Written::atom(format!("if({a} {} {b}, {value}, {otherwise})", sign_of(comparison)))
    }

    fn tensor(&self, node: &Node, operands: &[Written]) -> Option<Written> {
        let call = |name: &str| {
            let arguments: Vec<&str> = operands.iter().map(|operand| operand.text.as_str()).collect();
            Written::atom(format!("{name}({})", arguments.join(", ")))
        };
        Some(match node {
            Node::Identity => Written::atom("I"),
            Node::Zero(_) => Written::atom("0*I"),
            Node::Multiply(..) | Node::Apply(..) => {
                let factors: Vec<String> =
                    operands.iter().map(|operand| within(operand, Binding::Product)).collect();
                Written { text: factors.join("*"), binding: Binding::Product }
            }
            Node::Transpose(_) => call("transpose"),
            Node::Dot(..) => call("dot"),
            Node::Trace(_) => call("tr"),
            Node::Determinant(_) => call("det"),
            Node::Cofactor(_) => call("cof"),
            Node::Cross(..) => call("cross"),
            Node::Outer(..) => call("outer"),
            Node::Pack(_) => call("pack"),
            // of the deformation they have names
            Node::Entry(_, index @ 18..) if operands[0].text == "svd(F)" => {
                Written::atom(format!("l{}", index - 17))
            }
            Node::Entry(_, index @ 18..) => Written::atom(format!("{}.l{}", operands[0].text, index - 17)),
            // as the language names them
            Node::Entry(_, index) if operands[0].text == "F" => {
                Written::atom(format!("F{}{}", index % 3 + 1, index / 3 + 1))
            }
            Node::Entry(_, index) => Written::atom(format!(
                "{}[{}, {}]",
                within(&operands[0], Binding::Atom),
                index % 3 + 1,
                index / 3 + 1
            )),
            Node::Decompose(_) => call("svd"),
            Node::Compose(..) => call("compose"),
            Node::StretchRates(..) => call("stretch_rates"),
            Node::ComposeDifferential(_) => call("compose_differential"),
            _ => return None,
        })
    }

    fn definition(&self, name: &str, value: &str) -> String {
        format!("{name} = {value}")
    }

    fn powers_are_products(&self) -> bool {
        false
    }
}
