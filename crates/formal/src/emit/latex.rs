//! LaTeX, for reading.

use super::{Binding, Style, Written};
use crate::Function;
use crate::function::FUNCTIONS;
use crate::graph::{Comparison, Node};

/// See the module.
#[derive(Clone, Copy, Debug, Default)]
pub struct Latex;

const GREEK: &[&str] = &[
    "alpha", "beta", "gamma", "delta", "epsilon", "kappa", "lambda", "mu", "nu", "omega", "phi", "psi",
    "rho", "sigma", "tau", "theta", "xi", "zeta",
];

fn within(written: &Written, weakest: Binding) -> String {
    if written.binding < weakest { format!("\\left({}\\right)", written.text) } else { written.text.clone() }
}

impl Style for Latex {
    fn number(&self, value: f64) -> String {
        // thirds and the like as fractions
        for below in [2.0, 3.0, 4.0, 6.0, 8.0] {
            let above = value * below;
            if value.fract() != 0.0 && (above - above.round()).abs() < 1e-14 * above.abs() {
                let sign = if value < 0.0 { "-" } else { "" };
                return format!("{sign}\\tfrac{{{}}}{{{below}}}", above.abs().round());
            }
        }
        let text = format!("{value}");
        if text.len() <= 12 {
            return text;
        }
        let scientific = format!("{value:e}");
        match scientific.split_once('e') {
            Some((digits, exponent)) => format!("{digits}\\cdot10^{{{exponent}}}"),
            None => scientific,
        }
    }

    fn symbol(&self, name: &str) -> String {
        self.own_symbol(&super::distinct(name, &[]))
    }

    fn own_symbol(&self, name: &str) -> String {
        let (base, index) = name.split_once('_').unwrap_or((name, ""));
        let digits = base.find(|c: char| c.is_ascii_digit()).filter(|at| *at > 0);
        let (letters, number) = digits.map_or((base, ""), |at| base.split_at(at));
        let letters = match letters {
            "dF" => "\\delta F".to_owned(),
            greek if GREEK.contains(&greek) => format!("\\{greek}"),
            one if one.len() == 1 => one.to_owned(),
            word => format!("\\mathrm{{{word}}}"),
        };
        match format!("{number}{index}") {
            none if none.is_empty() => letters,
            index => format!("{letters}_{{{}}}", index.replace('_', "\\_")),
        }
    }

    fn times(&self) -> &'static str {
        "\\,"
    }

    fn parentheses(&self, text: &str) -> String {
        format!("\\left({text}\\right)")
    }

    fn quotient(&self, above: &Written, below: &Written) -> Written {
        Written { text: format!("\\frac{{{}}}{{{}}}", above.text, below.text), binding: Binding::Product }
    }

    fn power(&self, base: &Written, exponent: f64) -> Written {
        if exponent == 0.5 {
            return Written::atom(format!("\\sqrt{{{}}}", base.text));
        }
        self.power_of(base, &Written::atom(self.number(exponent)))
    }

    fn power_of(&self, base: &Written, exponent: &Written) -> Written {
        let text = format!("{}^{{{}}}", within(base, Binding::Atom), exponent.text);
        Written { text, binding: Binding::Power }
    }

    fn function(&self, function: Function, argument: &Written) -> Written {
        let name = FUNCTIONS.iter().find(|entry| entry.function == function).map_or("?", |entry| entry.name);
        let name = match name {
            "sin" | "cos" | "tan" | "sinh" | "cosh" | "tanh" | "exp" | "ln" => format!("\\{name}"),
            other => format!("\\operatorname{{{other}}}"),
        };
        Written::atom(format!("{name}\\left({}\\right)", argument.text))
    }

    fn select(&self, (comparison, a, b): (Comparison, &str, &str), value: &str, otherwise: &str) -> Written {
        let sign = match comparison {
            Comparison::Less => "<",
            Comparison::LessOrEqual => "\\le",
            Comparison::Equal => "=",
        };
        Written::atom(format!(
            "\\begin{{cases}}{value}&{a}{sign}{b}\\\\{otherwise}&\\text{{otherwise}}\\end{{cases}}"
        ))
    }

    fn tensor(&self, node: &Node, operands: &[Written]) -> Option<Written> {
        let a = |index: usize| within(&operands[index], Binding::Product);
        let atom = |index: usize| within(&operands[index], Binding::Atom);
        let call = |name: &str| {
            let arguments: Vec<&str> = operands.iter().map(|operand| operand.text.as_str()).collect();
            Written::atom(format!("\\operatorname{{{name}}}\\left({}\\right)", arguments.join(", ")))
        };
        let product = |text: String| Written { text, binding: Binding::Product };
        Some(match node {
            Node::Identity => Written::atom("I"),
            Node::Zero(_) => Written::atom("0"),
            Node::Multiply(..) | Node::Apply(..) => product(format!("{}\\,{}", a(0), a(1))),
            Node::Transpose(_) => Written::atom(format!("{}^{{T}}", atom(0))),
            Node::Dot(..) => Written::atom(format!("\\left({}:{}\\right)", a(0), a(1))),
            Node::Trace(_) => call("tr"),
            Node::Determinant(_) => call("det"),
            Node::Cofactor(_) => call("cof"),
            Node::Cross(..) => product(format!("{}\\times\\!\\!\\!\\!\\times{}", a(0), a(1))),
            Node::Outer(..) => product(format!("{}\\otimes {}", a(0), a(1))),
            Node::Entry(_, index @ 18..) => Written::atom(format!("\\lambda_{{{}}}", index - 17)),
            Node::Entry(_, index) => {
                let base = atom(0);
                // a second index needs the first in braces
                let base = if base.contains('_') { format!("{{{base}}}") } else { base };
                Written::atom(format!("{base}_{{{}{}}}", index % 3 + 1, index / 3 + 1))
            }
            Node::Pack(_) => call("vec"),
            Node::Decompose(_) => call("svd"),
            Node::Compose(..) => call("compose"),
            Node::StretchRates(..) => call("diag"),
            Node::ComposeDifferential(_) => call("dcompose"),
            _ => return None,
        })
    }

    fn definition(&self, name: &str, value: &str) -> String {
        format!("{name} = {value}")
    }

    fn part(&self, index: usize) -> String {
        format!("t_{{{index}}}")
    }

    fn powers_are_products(&self) -> bool {
        false
    }
}
