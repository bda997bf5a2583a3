//! Formulas of variables and conditions on them, read once and evaluated often.

use std::fmt;

use souple_math::Dual;

use crate::program::{Program, kind_of};
use crate::{Expression, Kind, Node, NodeId, NodeKind, ParseError};

/// A number computed from variables.
#[derive(Clone, Debug)]
pub struct Formula {
    text: String,
    variables: Vec<String>,
    program: Program,
}

impl Formula {
    /// Reads a formula of the named variables, whose values [`evaluate`](Self::evaluate) takes in that order.
    ///
    /// # Errors
    /// Names the place, what was read and what would be accepted there; unknown names with the nearest.
    pub fn compile(text: &str, variables: &[&str]) -> Result<Self, ParseError> {
        let expression = Expression::parse(text)?;
        let program = Program::compile(&expression, expression.root(), Kind::Number, variables)?;
        Ok(Self::of(text, variables, program))
    }

    /// Reads a list of `N` formulas in brackets, such as `[0.1 * sin(t), 0, 0]`.
    ///
    /// # Errors
    /// As [`compile`](Self::compile); also where the text is no list or one of another length.
    pub fn compile_vector<const N: usize>(text: &str, variables: &[&str]) -> Result<[Self; N], ParseError> {
        let expression = Expression::parse(text)?;
        let Node { kind, span } = expression.node(expression.root());
        let (found, span) = match kind {
            NodeKind::Vector(components) => match <&[NodeId; N]>::try_from(components.as_slice()) {
                Ok(components) => {
                    let mut formulas = Vec::with_capacity(N);
                    for &component in components {
                        let program = Program::compile(&expression, component, Kind::Number, variables)?;
                        let text = expression.node(component).span.of(text);
                        formulas.push(Self::of(text, variables, program));
                    }
                    return Ok(formulas.try_into().expect("one formula per component"));
                }
                Err(_) => (Kind::Vector(components.len()), *span),
            },
            _ => (kind_of(kind), *span),
        };
        Err(ParseError::WrongKind { found, wanted: Kind::Vector(N), span })
    }

    /// The formula that is always `value`.
    pub fn constant(value: f64) -> Self {
        Self::of(&value.to_string(), &[], Program::constant(value))
    }

    fn of(text: &str, variables: &[&str], program: Program) -> Self {
        let variables = variables.iter().map(|&name| name.to_owned()).collect();
        Self { text: text.to_owned(), variables, program }
    }

    /// As it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The names whose values are wanted, in order.
    pub fn variables(&self) -> &[String] {
        &self.variables
    }

    /// Whether the variable at `position` can change the result.
    pub fn depends_on(&self, position: usize) -> bool {
        self.program.reads(position)
    }

    /// The result for the values of the variables; not finite where the formula is not defined.
    ///
    /// # Panics
    /// If there are fewer values than variables.
    pub fn evaluate(&self, values: &[f64]) -> f64 {
        self.program.run(|position| values[position])
    }

    /// Numbers that the result lies between while each variable lies between two; `None` where nothing is known, or where the
    /// formula may not be defined. Panics like [`evaluate`](Self::evaluate).
    pub fn range(&self, variables: &[[f64; 2]]) -> Option<[f64; 2]> {
        self.program.range(|position| variables[position])
    }

    /// The result and its rate, for variables that change at the rates of `values`; panics like
    /// [`evaluate`](Self::evaluate).
    pub fn evaluate_dual(&self, values: &[Dual]) -> Dual {
        self.program.run(|position| values[position])
    }

    /// The result and its derivative by the variable at position `by`: the velocity of a motion given as
    /// a formula of time. Panics like [`evaluate`](Self::evaluate).
    pub fn differentiate(&self, values: &[f64], by: usize) -> Dual {
        self.program.run(|position| Dual::new(values[position], f64::from(u8::from(position == by))))
    }
}

impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// A condition on variables, such as `x > 0.5 and y < z`.
#[derive(Clone, Debug)]
pub struct Condition {
    text: String,
    program: Program,
}

impl Condition {
    /// Reads a condition on the named variables.
    ///
    /// # Errors
    /// As [`Formula::compile`]; also where the text is a number instead of a condition.
    pub fn compile(text: &str, variables: &[&str]) -> Result<Self, ParseError> {
        let expression = Expression::parse(text)?;
        let program = Program::compile(&expression, expression.root(), Kind::Truth, variables)?;
        Ok(Self { text: text.to_owned(), program })
    }

    /// As it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether the variable at `position` can change what it says.
    pub fn depends_on(&self, position: usize) -> bool {
        self.program.reads(position)
    }

    /// Whether the condition holds for the values of the variables; panics like [`Formula::evaluate`].
    pub fn holds(&self, values: &[f64]) -> bool {
        self.program.run::<f64>(|position| values[position]) != 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Span;

    const VARIABLES: &[&str] = &["x", "y", "t"];

    /// Every mistake is named, placed, and answered with what would be right.
    #[test]
    fn errors() {
        let truth = "a truth value such as `x > 0`";
        let cases = [
            ("1 + foo", 4..7, "there is no `foo` (at byte 4); there are: x, y, t, pi, e".to_owned()),
            ("sine(x)", 0..4, "there is no function `sine` (at byte 0) (did you mean `sin`?)".to_owned()),
            ("2 * sin", 4..7, "`sin` at byte 4 is a function; write `sin(x)`".to_owned()),
            (
                "x (y)",
                0..1,
                "`x` at byte 0 is no function; for a product a `*` is missing, as in `x * (…)`".to_owned(),
            ),
            ("atan2(y)", 0..5, "`atan2` at byte 0 was given 1 argument(s); write".to_owned()),
            ("max()", 0..3, "`max` at byte 0 was given 0 argument(s); write".to_owned()),
            ("x > 0", 0..5, format!("{truth} stands at byte 0, where a number is wanted")),
            ("if(x, 1, 2)", 3..4, format!("a number stands at byte 3, where {truth} is wanted")),
            ("if(x < 0, y > 0, 2)", 10..15, format!("{truth} stands at byte 10, where a number is wanted")),
            ("1 + (x < y)", 5..10, format!("{truth} stands at byte 5, where a number is wanted")),
            ("2 * [1, 2]", 4..10, "a vector of 2 stands at byte 4, where a number is wanted".to_owned()),
            ("[1, 2]", 0..6, "a vector of 2 stands at byte 0, where a number is wanted".to_owned()),
        ];
        for (text, place, message) in cases {
            let error = Formula::compile(text, VARIABLES).unwrap_err();
            assert_eq!(error.span().start..error.span().end, place, "{text}");
            assert!(error.to_string().starts_with(&message), "{text}: {error}");
        }
        let Err(ParseError::UnknownName { nearest, .. }) = Formula::compile("tyme", &["time"]) else {
            panic!()
        };
        assert_eq!(nearest.as_deref(), Some("time"));
        let error = Condition::compile("x + 1", VARIABLES).unwrap_err();
        assert!(matches!(error, ParseError::WrongKind { found: Kind::Number, wanted: Kind::Truth, .. }));
    }

    /// The velocity of `a sin(ω t)` is `a ω cos(ω t)`.
    #[test]
    fn velocity_of_a_prescribed_motion() {
        let formula = Formula::compile("0.1 * sin(2*pi*t)", &["t"]).unwrap();
        let (time, omega) = (0.3, 2.0 * std::f64::consts::PI);
        let motion = formula.differentiate(&[time], 0);
        assert_eq!(motion.value, formula.evaluate(&[time]));
        // three roundings of numbers below one
        assert!((motion.derivative - 0.1 * omega * libm::cos(omega * time)).abs() < 3.0 * f64::EPSILON);
        assert_eq!(formula.evaluate_dual(&[Dual::new(time, 1.0)]), motion);
    }

    #[test]
    fn vectors_are_lists_of_formulas() {
        let [x, y, z] = Formula::compile_vector("[t^2, (1 + t), 0]", &["t"]).unwrap();
        assert_eq!([x.evaluate(&[3.0]), y.evaluate(&[3.0]), z.evaluate(&[3.0])], [9.0, 4.0, 0.0]);
        assert_eq!((x.text(), y.text(), z.to_string().as_str()), ("t^2", "1 + t", "0"));
        assert!(x.depends_on(0) && !z.depends_on(0));
        let wrong = |text: &str| Formula::compile_vector::<3>(text, &["t"]).unwrap_err();
        assert_eq!(
            wrong("[1, 2]").to_string(),
            "a vector of 2 stands at byte 0, where a vector of 3 is wanted"
        );
        assert_eq!(wrong("t").to_string(), "a number stands at byte 0, where a vector of 3 is wanted");
        assert_eq!(wrong("[t, t, u]").span(), Span::new(7, 8));
    }

    /// Comparisons with what is not a number do not hold, and such numbers are not hidden by `min` or `max`.
    #[test]
    fn conditions() {
        let holds = |text: &str, x: f64| Condition::compile(text, &["x"]).unwrap().holds(&[x]);
        assert!(holds("x > 0.5 and not x == 2 or x <= -1", 1.0));
        assert!(!holds("x > 0.5 and not x == 2 or x <= -1", 2.0));
        assert!(holds("x >= 1 and x != 3", 2.0) && holds("x < 1 or x > 2", -1.0));
        assert!(!holds("x < 0 or x >= 0", f64::NAN));
        for text in
            ["min(x, 1)", "min(1, x)", "max(x, 1)", "clamp(x, 0, 1)", "step(x, 0)", "sign(x)", "x + 1"]
        {
            assert!(Formula::compile(text, &["x"]).unwrap().evaluate(&[f64::NAN]).is_nan(), "{text}");
        }
    }
}
