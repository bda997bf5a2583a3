//! The functions and constants that a formula may name.

use crate::Kind;

/// What can be called with numbers, or chosen by a condition.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Log10,
    Sqrt,
    Cbrt,
    Abs,
    Sign,
    Min,
    Max,
    Floor,
    Ceil,
    Pow,
    Step,
    Smoothstep,
    Clamp,
    Hypot,
    If,
}

/// How many arguments a function takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArgumentCount {
    Exactly(usize),
    AtLeast(usize),
}

impl ArgumentCount {
    pub fn accepts(self, count: usize) -> bool {
        match self {
            Self::Exactly(wanted) => count == wanted,
            Self::AtLeast(wanted) => count >= wanted,
        }
    }
}

/// The page of one function.
#[derive(Debug)]
pub struct FunctionEntry {
    pub name: &'static str,
    /// The call as it is written, with named arguments.
    pub usage: &'static str,
    /// One line: what it gives.
    pub summary: &'static str,
    pub arguments: ArgumentCount,
    pub function: Function,
}

const fn entry(
    function: Function,
    name: &'static str,
    arguments: usize,
    usage: &'static str,
    summary: &'static str,
) -> FunctionEntry {
    FunctionEntry { name, usage, summary, arguments: ArgumentCount::Exactly(arguments), function }
}

const fn several(
    function: Function,
    name: &'static str,
    usage: &'static str,
    summary: &'static str,
) -> FunctionEntry {
    FunctionEntry { name, usage, summary, arguments: ArgumentCount::AtLeast(2), function }
}

/// All functions; angles are in radians.
pub const FUNCTIONS: &[FunctionEntry] = &[
    entry(Function::Sin, "sin", 1, "sin(x)", "sine"),
    entry(Function::Cos, "cos", 1, "cos(x)", "cosine"),
    entry(Function::Tan, "tan", 1, "tan(x)", "tangent"),
    entry(Function::Asin, "asin", 1, "asin(x)", "inverse sine, from -pi/2 to pi/2"),
    entry(Function::Acos, "acos", 1, "acos(x)", "inverse cosine, from 0 to pi"),
    entry(Function::Atan, "atan", 1, "atan(x)", "inverse tangent, from -pi/2 to pi/2"),
    entry(Function::Atan2, "atan2", 2, "atan2(y, x)", "angle of the point (x, y), from -pi to pi"),
    entry(Function::Sinh, "sinh", 1, "sinh(x)", "hyperbolic sine"),
    entry(Function::Cosh, "cosh", 1, "cosh(x)", "hyperbolic cosine"),
    entry(Function::Tanh, "tanh", 1, "tanh(x)", "hyperbolic tangent"),
    entry(Function::Exp, "exp", 1, "exp(x)", "power of e"),
    entry(Function::Ln, "ln", 1, "ln(x)", "natural logarithm"),
    entry(Function::Ln, "log", 1, "log(x)", "natural logarithm, as ln"),
    entry(Function::Log10, "log10", 1, "log10(x)", "decimal logarithm"),
    entry(Function::Sqrt, "sqrt", 1, "sqrt(x)", "square root"),
    entry(Function::Cbrt, "cbrt", 1, "cbrt(x)", "cube root, also of negative numbers"),
    entry(Function::Abs, "abs", 1, "abs(x)", "magnitude"),
    entry(Function::Sign, "sign", 1, "sign(x)", "-1, 0 or 1"),
    several(Function::Min, "min", "min(a, b, …)", "the least of its arguments"),
    several(Function::Max, "max", "max(a, b, …)", "the greatest of its arguments"),
    entry(Function::Floor, "floor", 1, "floor(x)", "the next whole number at or below"),
    entry(Function::Ceil, "ceil", 1, "ceil(x)", "the next whole number at or above"),
    entry(Function::Pow, "pow", 2, "pow(x, y)", "x^y"),
    entry(Function::Step, "step", 2, "step(edge, x)", "0 below the edge, 1 from it on"),
    entry(
        Function::Smoothstep,
        "smoothstep",
        3,
        "smoothstep(low, high, x)",
        "rises from 0 at low to 1 at high as s^2 (3 - 2 s), s from 0 to 1",
    ),
    entry(Function::Clamp, "clamp", 3, "clamp(x, low, high)", "x held between low and high"),
    entry(Function::Hypot, "hypot", 2, "hypot(x, y)", "sqrt(x^2 + y^2) without overflow"),
    entry(Function::If, "if", 3, "if(condition, value, otherwise)", "value where the condition holds"),
];

/// Constants and their values; a variable of the same name goes before.
pub const CONSTANTS: &[(&str, f64)] = &[("pi", std::f64::consts::PI), ("e", std::f64::consts::E)];

/// What other languages call functions of this one.
const ELSEWHERE: &[(&str, &str)] = &[
    ("select", "if"),
    ("where", "if"),
    ("cond", "if"),
    ("power", "pow"),
    ("sgn", "sign"),
    ("arctan", "atan"),
];

/// The function that a name which is none may mean.
pub(crate) fn nearest_function<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<String> {
    let elsewhere = ELSEWHERE.iter().find(|(other, _)| *other == name).map(|(_, here)| *here);
    elsewhere.or_else(|| souple_table::nearest(name, known)).map(str::to_owned)
}

impl FunctionEntry {
    /// The function of that name.
    pub fn find(name: &str) -> Option<&'static Self> {
        FUNCTIONS.iter().find(|entry| entry.name == name)
    }

    /// What the argument at `position` must be.
    pub(crate) fn argument_kind(&self, position: usize) -> Kind {
        if self.function == Function::If && position == 0 { Kind::Truth } else { Kind::Number }
    }
}
