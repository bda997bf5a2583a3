//! WGSL, the shading language of WebGPU, in single precision.

use super::stretches::Words;
use super::text::sign_of;
use super::{Style, Written};
use crate::Function;
use crate::graph::{Comparison, Node, Shape};

/// See the module.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wgsl;

/// Arguments of the functions, and words of the language that could be names of a law.
const TAKEN: &[&str] = &[
    "p",
    "u",
    "v",
    "d",
    "alias",
    "array",
    "async",
    "await",
    "become",
    "bool",
    "break",
    "case",
    "cast",
    "catch",
    "class",
    "common",
    "const",
    "const_assert",
    "constexpr",
    "continue",
    "continuing",
    "default",
    "delete",
    "demote",
    "diagnostic",
    "discard",
    "do",
    "else",
    "enable",
    "enum",
    "export",
    "extern",
    "external",
    "f16",
    "f32",
    "fallthrough",
    "false",
    "filter",
    "final",
    "finally",
    "fn",
    "for",
    "friend",
    "from",
    "get",
    "goto",
    "groupshared",
    "handle",
    "highp",
    "i32",
    "impl",
    "implements",
    "import",
    "inline",
    "interface",
    "layout",
    "let",
    "loop",
    "lowp",
    "macro",
    "match",
    "mediump",
    "meta",
    "mod",
    "module",
    "move",
    "mut",
    "mutable",
    "namespace",
    "new",
    "nil",
    "noexcept",
    "nointerpolation",
    "non_coherent",
    "noncoherent",
    "noperspective",
    "null",
    "of",
    "operator",
    "override",
    "package",
    "packoffset",
    "partition",
    "pass",
    "patch",
    "pixelfragment",
    "precise",
    "precision",
    "premerge",
    "priv",
    "private",
    "protected",
    "pub",
    "public",
    "ref",
    "register",
    "reinterpret_cast",
    "requires",
    "resource",
    "restrict",
    "return",
    "select",
    "self",
    "set",
    "shared",
    "sizeof",
    "smooth",
    "snorm",
    "static",
    "static_assert",
    "std",
    "struct",
    "subroutine",
    "super",
    "switch",
    "target",
    "template",
    "this",
    "thread_local",
    "throw",
    "trait",
    "true",
    "try",
    "type",
    "typedef",
    "typeof",
    "u32",
    "union",
    "unless",
    "unorm",
    "unsafe",
    "unsized",
    "use",
    "using",
    "var",
    "varying",
    "vec2",
    "vec3",
    "virtual",
    "volatile",
    "wgsl",
    "where",
    "while",
    "with",
    "writeonly",
    "yield",
];

const WORDS: Words = Words {
    vector: |numbers| format!("vec3<f32>({})", numbers.join(", ")),
    matrix: |columns| format!("mat3x3<f32>({})", columns.join(", ")),
};

impl Style for Wgsl {
    fn number(&self, value: f64) -> String {
        // the nearest number of single precision, so that no literal is out of its range
        format!("{:?}", value as f32)
    }

    fn symbol(&self, name: &str) -> String {
        super::distinct(name, TAKEN)
    }

    fn own_symbol(&self, name: &str) -> String {
        super::element::indexed(name)
    }

    fn quotient(&self, above: &Written, below: &Written) -> Written {
        super::rust::quotient(above, below)
    }

    fn power(&self, base: &Written, exponent: f64) -> Written {
        if exponent == 0.5 {
            return Written::atom(format!("sqrt({})", base.text));
        }
        Written::atom(format!("pow({}, {})", base.text, self.number(exponent)))
    }

    fn power_of(&self, base: &Written, exponent: &Written) -> Written {
        Written::atom(format!("pow({}, {})", base.text, exponent.text))
    }

    fn function(&self, function: Function, argument: &Written) -> Written {
        let x = &argument.text;
        Written::atom(match function {
            Function::Ln => format!("log({x})"),
            Function::Log10 => format!("(log({x}) * 0.43429448)"),
            Function::Cbrt => format!("(sign({x}) * pow(abs({x}), 0.33333334))"),
            Function::Sin => format!("sin({x})"),
            Function::Cos => format!("cos({x})"),
            Function::Tan => format!("tan({x})"),
            Function::Asin => format!("asin({x})"),
            Function::Acos => format!("acos({x})"),
            Function::Atan => format!("atan({x})"),
            Function::Sinh => format!("sinh({x})"),
            Function::Cosh => format!("cosh({x})"),
            Function::Tanh => format!("tanh({x})"),
            Function::Exp => format!("exp({x})"),
            Function::Sign => format!("sign({x})"),
            Function::Floor => format!("floor({x})"),
            Function::Ceil => format!("ceil({x})"),
            _ => format!("abs({x})"),
        })
    }

    fn select(&self, (comparison, a, b): (Comparison, &str, &str), value: &str, otherwise: &str) -> Written {
        Written::atom(format!("select({otherwise}, {value}, {a} {} {b})", sign_of(comparison)))
    }

    fn tensor(&self, node: &Node, operands: &[Written]) -> Option<Written> {
        WORDS.tensor(node, operands)
    }

    fn entry(&self, shape: Shape, tensor: &Written, index: u8) -> Option<Written> {
        Some(super::stretches::entry(shape, tensor, index))
    }

    fn definition(&self, name: &str, value: &str) -> String {
        format!("let {name} = {value};")
    }

    fn powers_are_products(&self) -> bool {
        true
    }
}
