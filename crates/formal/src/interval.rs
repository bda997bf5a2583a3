//! Between which numbers a formula stays while its variables stay between theirs (Moore 1966, Interval analysis).
//!
//! Bounds are wide rather than close: each operation takes the worst of its operands, as if they had nothing to do with each
//! other, and a few roundings on top. Where a formula may not be defined, nothing is said.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::arithmetic::{of_one, whole_power};
use crate::{BinaryOperator, Function};

/// Numbers between two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    pub low: f64,
    pub high: f64,
}

/// What is known of a result: the numbers it lies between, or nothing.
pub(crate) type Known = Option<Interval>;

/// Roundings of an operation, and of the best known functions.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;
/// Angles beyond this are known too coarsely for their place in a turn.
const FARTHEST_ANGLE: f64 = 1e6;

impl Interval {
    pub fn point(value: f64) -> Known {
        Self::of(value, value)
    }

    /// `None` where a bound is not finite.
    pub fn of(low: f64, high: f64) -> Known {
        (low <= high && low.is_finite() && high.is_finite()).then_some(Self { low, high })
    }

    /// Of bounds that were computed. Zero stays zero, so that a sum of squares has a root: what is below the least number is none.
    fn rounded(low: f64, high: f64) -> Known {
        let spread = |x: f64| ROUNDINGS * x.abs();
        Self::of(low - spread(low), high + spread(high))
    }

    /// Around several numbers that were computed.
    fn around(values: impl IntoIterator<Item = f64>) -> Known {
        let bounds = (f64::INFINITY, f64::NEG_INFINITY);
        let (low, high) = values.into_iter().fold(bounds, |(low, high), value| {
            // what is not a number leaves nothing known
            if value.is_nan() { (f64::NAN, f64::NAN) } else { (least(low, value), most(high, value)) }
        });
        Self::rounded(low, high)
    }

    fn holds(self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    fn is_point(self) -> bool {
        self.low == self.high
    }

    fn negated(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }

    /// Distances from zero.
    fn absolute(self) -> Self {
        let (a, b) = (self.low.abs(), self.high.abs());
        Self { low: if self.holds(0.0) { 0.0 } else { a.min(b) }, high: a.max(b) }
    }

    fn hull(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// By a function that does not fall.
    fn rising(self, f: impl Fn(f64) -> f64) -> Known {
        Self::around([f(self.low), f(self.high)])
    }
}

/// The smaller of two, and no number where one is none.
fn least(a: f64, b: f64) -> f64 {
    if a.is_nan() || a < b { a } else { b }
}

fn most(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

/// Truth: surely 1, surely 0, or either.
fn truth(is_sure: bool, is_excluded: bool) -> Known {
    Interval::of(f64::from(u8::from(is_sure)), f64::from(u8::from(!is_excluded)))
}

pub(crate) fn negate(operand: Known) -> Known {
    operand.map(Interval::negated)
}

/// `1` for false and `0` for true.
pub(crate) fn not(operand: Known) -> Known {
    operand.and_then(|truth| Interval::of(1.0 - truth.high, 1.0 - truth.low))
}

pub(crate) fn binary(operator: BinaryOperator, left: Known, right: Known) -> Known {
    let (a, b) = (left?, right?);
    match operator {
        BinaryOperator::Add => Interval::rounded(a.low + b.low, a.high + b.high),
        BinaryOperator::Subtract => Interval::rounded(a.low - b.high, a.high - b.low),
        BinaryOperator::Multiply => product(a, b),
        BinaryOperator::Divide if b.holds(0.0) => None,
        BinaryOperator::Divide => {
            Interval::around([a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high])
        }
        BinaryOperator::Power => power(a, b),
        BinaryOperator::Less => truth(a.high < b.low, a.low >= b.high),
        BinaryOperator::LessOrEqual => truth(a.high <= b.low, a.low > b.high),
        BinaryOperator::Greater => truth(a.low > b.high, a.high <= b.low),
        BinaryOperator::GreaterOrEqual => truth(a.low >= b.high, a.high < b.low),
        BinaryOperator::Equal => truth(are_equal(a, b), are_apart(a, b)),
        BinaryOperator::NotEqual => truth(are_apart(a, b), are_equal(a, b)),
        BinaryOperator::And => Interval::of(a.low * b.low, a.high * b.high),
        BinaryOperator::Or => Interval::of(a.low.max(b.low), a.high.max(b.high)),
    }
}

fn are_equal(a: Interval, b: Interval) -> bool {
    a.is_point() && a == b
}

fn are_apart(a: Interval, b: Interval) -> bool {
    a.high < b.low || b.high < a.low
}

fn product(a: Interval, b: Interval) -> Known {
    Interval::around([a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high])
}

// of a base above zero it rises or falls with each of both, so that the ends are at corners
fn power(base: Interval, exponent: Interval) -> Known {
    let is_defined = base.low > 0.0 || (base.low == 0.0 && exponent.low > 0.0);
    let at = |x: f64, y: f64| libm::pow(x, y);
    let corners = || {
        [(base.low, exponent.low), (base.low, exponent.high), (base.high, exponent.low)]
            .into_iter()
            .chain([(base.high, exponent.high)])
            .map(|(x, y)| at(x, y))
    };
    is_defined.then(corners).and_then(Interval::around)
}

pub(crate) fn power_of_whole(base: Known, exponent: i32) -> Known {
    let base = base?;
    if exponent < 0 && base.holds(0.0) {
        return None;
    }
    let base = if exponent % 2 == 0 { base.absolute() } else { base };
    // a product of up to eight has more roundings than one
    let Interval { low, high } =
        Interval::around([whole_power(base.low, exponent), whole_power(base.high, exponent)])?;
    Interval::rounded(low - 8.0 * f64::EPSILON * low.abs(), high + 8.0 * f64::EPSILON * high.abs())
}

// it comes to 1 a quarter of a turn after each whole one
fn sine(x: Interval) -> Known {
    if x.high - x.low >= TAU || x.absolute().high > FARTHEST_ANGLE {
        return Interval::of(-1.0, 1.0);
    }
    // a little wider: an end that is all but passed is passed
    let spread = 1e-9 * (1.0 + x.absolute().high);
    let passes = |top: f64| ((x.low - spread - top) / TAU).ceil() * TAU + top <= x.high + spread;
    let ends = Interval::around([libm::sin(x.low), libm::sin(x.high)])?;
    Interval::of(
        if passes(-FRAC_PI_2) { -1.0 } else { ends.low.max(-1.0) },
        if passes(FRAC_PI_2) { 1.0 } else { ends.high.min(1.0) },
    )
}

fn cosine(x: Interval) -> Known {
    Interval::rounded(x.low + FRAC_PI_2, x.high + FRAC_PI_2).and_then(sine)
}

pub(crate) fn function_of_one(function: Function, argument: Known) -> Known {
    let x = argument?;
    let at = |value: f64| of_one(function, value);
    let within = |low: f64, high: f64| low <= x.low && x.high <= high;
    match function {
        Function::Sin => sine(x),
        Function::Cos => cosine(x),
        Function::Tan => binary(BinaryOperator::Divide, sine(x), cosine(x)),
        Function::Acos => within(-1.0, 1.0).then(|| Interval::around([at(x.low), at(x.high)]))?,
        Function::Asin => within(-1.0, 1.0).then(|| x.rising(at))?,
        Function::Cosh => x.absolute().rising(at),
        Function::Ln | Function::Log10 => within(f64::MIN_POSITIVE, f64::MAX).then(|| x.rising(at))?,
        Function::Sqrt => within(0.0, f64::MAX).then(|| x.rising(at))?,
        Function::Abs => Some(x.absolute()),
        // what is left does not fall
        _ => x.rising(at),
    }
}

pub(crate) fn function_of_two(function: Function, first: Known, second: Known) -> Known {
    let (a, b) = (first?, second?);
    match function {
        Function::Atan2 => angle(a, b),
        Function::Hypot => {
            let (a, b) = (a.absolute(), b.absolute());
            Interval::around([libm::hypot(a.low, b.low), libm::hypot(a.high, b.high)])
        }
        Function::Min => Interval::of(a.low.min(b.low), a.high.min(b.high)),
        Function::Max => Interval::of(a.low.max(b.low), a.high.max(b.high)),
        Function::Pow => power(a, b),
        Function::Step => truth(b.low >= a.high, b.high < a.low),
        _ => None,
    }
}

// seen from the origin the ends of a box are at its corners, unless the origin or the cut of angles is in it
fn angle(y: Interval, x: Interval) -> Known {
    if x.low <= 0.0 && y.holds(0.0) {
        return Interval::rounded(-PI, PI);
    }
    Interval::around([
        libm::atan2(y.low, x.low),
        libm::atan2(y.low, x.high),
        libm::atan2(y.high, x.low),
        libm::atan2(y.high, x.high),
    ])
}

pub(crate) fn function_of_three(function: Function, first: Known, second: Known, third: Known) -> Known {
    match function {
        Function::If => {
            let condition = first?;
            let (chosen, other) = (second?, third?);
            match (condition.low, condition.high) {
                (low, _) if low > 0.0 => Some(chosen),
                (_, high) if high < 1.0 => Some(other),
                _ => Some(chosen.hull(other)),
            }
        }
        Function::Clamp => {
            function_of_two(Function::Min, function_of_two(Function::Max, first, second), third)
        }
        // of a ramp that is known it rises or falls all along
        Function::Smoothstep => {
            let (low, high, x) = (first?, second?, third?);
            if !(low.is_point() && high.is_point()) {
                return Interval::of(0.0, 1.0);
            }
            let at = |x: f64| crate::arithmetic::of_three(Function::Smoothstep, low.low, high.low, x);
            Interval::around([at(x.low), at(x.high)])
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use crate::{ArgumentCount, FUNCTIONS, Formula};

    /// Steps of a box along each variable at which a formula is asked.
    const STEPS: u32 = 24;

    /// Holds what a formula says in a box against its range there; how wide the range is, over how far the values go.
    fn check(text: &str, box_: [[f64; 2]; 3]) -> Option<f64> {
        let formula = Formula::compile(text, &["a", "b", "c"]).unwrap();
        let range = formula.range(&box_);
        let at = |k: u32, axis: usize| {
            let [low, high] = box_[axis];
            (low + (high - low) * f64::from(k) / f64::from(STEPS - 1)).min(high)
        };
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for k in 0..STEPS.pow(3) {
            let place = [at(k % STEPS, 0), at(k / STEPS % STEPS, 1), at(k / STEPS / STEPS, 2)];
            let value = formula.evaluate(&place);
            if let Some([low, high]) = range {
                assert!(low <= value && value <= high, "{text} at {place:?}: {value} of {low} to {high}");
            }
            (least, most) = (least.min(value), most.max(value));
        }
        range.map(|[low, high]| (high - low) / (most - least))
    }

    /// Every function and operator stays within its range, over boxes within its domain, across it, and beyond.
    #[test]
    fn values_are_within_their_range() {
        let variables = ["a", "b", "c"];
        let calls = FUNCTIONS.iter().map(|entry| {
            let (ArgumentCount::Exactly(count) | ArgumentCount::AtLeast(count)) = entry.arguments;
            let condition = entry.name == "if";
            let arguments = variables[..count].join(", ");
            if condition { "if(a < 0.3, b, c)".to_owned() } else { format!("{}({arguments})", entry.name) }
        });
        let operators = ["a + b*c", "a - b/c", "-a", "a^b", "a^2", "a^3", "a^-2", "a^-1", "a^0"];
        let conditions = ["a < b", "a <= b", "a > b", "a >= b", "a == b", "a != b", "not a < b"];
        let joined = ["a < b and b < c", "a < b or b < c", "smoothstep(0, 1, a)", "smoothstep(1, 0, a)"];
        let truths = conditions.iter().chain(&joined[..2]).map(|text| format!("if({text}, 1, 0)"));
        let texts: Vec<String> = calls
            .chain(operators.iter().chain(&joined[2..]).map(|t| (*t).to_owned()))
            .chain(truths)
            .collect();
        for text in &texts {
            for low in [-7.0, -1.1, -0.4, 0.0, 0.1, 0.9, 3.0] {
                for size in [0.0, 0.05, 0.8, 9.0] {
                    check(text, [[low, low + size], [0.7 * low, 0.7 * low + size], [0.2, 0.2 + size]]);
                }
            }
        }
    }

    /// Of a variable that stands once the range is that of the values, to what samples miss of it.
    #[test]
    fn ranges_of_simple_formulas_are_close() {
        for text in
            ["0.5 - sqrt(a^2 + b^2 + c^2)", "clamp(a + b - c, -0.4, 0.3)", "tanh((1 - hypot(a, b))/0.3)"]
        {
            let share = check(text, [[-0.2, 0.6], [0.1, 0.4], [-0.3, 0.3]]).unwrap();
            assert!(share < 1.1, "{text}: {share}");
        }
    }

    /// A sum of squares has a root also around zero.
    #[test]
    fn distances_are_known_around_the_origin() {
        for text in ["0.4 - sqrt(a^2 + b^2 + c^2)", "0.4 - sqrt(a*a + b*b + c*c)"] {
            assert!(check(text, [[-1.0, 1.0], [-0.5, 0.7], [-0.2, 0.3]]).is_some(), "{text}");
        }
    }

    /// Where a formula may be undefined nothing is said of it.
    #[test]
    fn nothing_is_said_of_the_undefined() {
        for text in ["sqrt(a)", "1/a", "ln(a)", "asin(3*a)", "tan(3*a)", "a^0.5", "max(0, sqrt(a))"] {
            assert_eq!(check(text, [[-1.0, 1.0]; 3]), None, "{text}");
        }
    }
}
