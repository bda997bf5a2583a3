//! The functions of the language, with their page in the reference.

/// A function of numbers.
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
}

impl Function {
    /// All of them, in the order of the reference page.
    pub const ALL: [Self; 26] = [
        Self::Sin,
        Self::Cos,
        Self::Tan,
        Self::Asin,
        Self::Acos,
        Self::Atan,
        Self::Atan2,
        Self::Sinh,
        Self::Cosh,
        Self::Tanh,
        Self::Exp,
        Self::Ln,
        Self::Log10,
        Self::Sqrt,
        Self::Cbrt,
        Self::Abs,
        Self::Sign,
        Self::Min,
        Self::Max,
        Self::Floor,
        Self::Ceil,
        Self::Pow,
        Self::Step,
        Self::Smoothstep,
        Self::Clamp,
        Self::Hypot,
    ];

    /// As written: `atan2`.
    pub fn name(self) -> &'static str {
        let signature = self.signature();
        signature.split('(').next().unwrap_or(signature)
    }

    /// With its arguments: `atan2(y, x)`.
    pub const fn signature(self) -> &'static str {
        self.page().0
    }

    /// One line on what it yields.
    pub const fn summary(self) -> &'static str {
        self.page().1
    }

    const fn page(self) -> (&'static str, &'static str) {
        match self {
            Self::Sin => ("sin(x)", "sine of an angle [rad]"),
            Self::Cos => ("cos(x)", "cosine of an angle [rad]"),
            Self::Tan => ("tan(x)", "tangent of an angle [rad]"),
            Self::Asin => ("asin(x)", "the angle in [-pi/2, pi/2] whose sine is x"),
            Self::Acos => ("acos(x)", "the angle in [0, pi] whose cosine is x"),
            Self::Atan => ("atan(x)", "the angle in [-pi/2, pi/2] whose tangent is x"),
            Self::Atan2 => ("atan2(y, x)", "the angle of the point (x, y) in [-pi, pi]"),
            Self::Sinh => ("sinh(x)", "hyperbolic sine"),
            Self::Cosh => ("cosh(x)", "hyperbolic cosine"),
            Self::Tanh => ("tanh(x)", "hyperbolic tangent"),
            Self::Exp => ("exp(x)", "e to the power x"),
            Self::Ln => ("ln(x)", "natural logarithm"),
            Self::Log10 => ("log10(x)", "logarithm to base 10"),
            Self::Sqrt => ("sqrt(x)", "square root"),
            Self::Cbrt => ("cbrt(x)", "cube root, of either sign"),
            Self::Abs => ("abs(x)", "absolute value; its slope at 0 is 0"),
            Self::Sign => ("sign(x)", "-1, 0 or 1"),
            Self::Min => ("min(a, b, ...)", "the smallest of two or more"),
            Self::Max => ("max(a, b, ...)", "the largest of two or more"),
            Self::Floor => ("floor(x)", "the largest whole number that is not above x"),
            Self::Ceil => ("ceil(x)", "the smallest whole number that is not below x"),
            Self::Pow => ("pow(x, y)", "x to the power y, as x^y"),
            Self::Step => ("step(edge, x)", "0 below the edge, 1 from it on"),
            Self::Smoothstep => ("smoothstep(a, b, x)", "rises from 0 at a to 1 at b as 3 s^2 - 2 s^3"),
            Self::Clamp => ("clamp(x, low, high)", "x kept between low and high"),
            Self::Hypot => ("hypot(x, y)", "length of (x, y) without overflow; its slope at the origin is 0"),
        }
    }

    /// The function written `name`.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|function| function.name() == name)
    }

    /// Whether it may be called with `count` arguments.
    pub const fn accepts(self, count: usize) -> bool {
        match self {
            Self::Min | Self::Max => count >= 2,
            Self::Atan2 | Self::Pow | Self::Step | Self::Hypot => count == 2,
            Self::Smoothstep | Self::Clamp => count == 3,
            _ => count == 1,
        }
    }

    /// How many arguments it takes, in words.
    pub(crate) const fn argument_count(self) -> &'static str {
        match self {
            Self::Min | Self::Max => "two or more arguments",
            Self::Atan2 | Self::Pow | Self::Step | Self::Hypot => "2 arguments",
            Self::Smoothstep | Self::Clamp => "3 arguments",
            _ => "1 argument",
        }
    }
}
