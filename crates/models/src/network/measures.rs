//! Units of parameters within formulas of laws.
//!
//! A parameter that is written with a unit has the dimension of it wherever a formula names it. Plain numbers in formulas are in SI units, of
//! whatever dimension their place asks for: so what they multiply has no known dimension, and is not checked.

use souple_formal::{BinaryOperator, Dimension, Expression, NodeKind, Span, UnaryOperator, parse_quantity};

use super::law::LinkError;

pub const LENGTH: Dimension = Dimension::new(0, 1, 0);
pub const VELOCITY: Dimension = Dimension::new(0, 1, -1);
pub const TIME: Dimension = Dimension::new(0, 0, 1);
pub const FORCE: Dimension = Dimension::new(1, 1, -2);
pub const ENERGY: Dimension = Dimension::new(1, 2, -2);
pub const POWER: Dimension = Dimension::new(1, 2, -3);

/// Names of a law with their dimensions, as far as these are known.
#[derive(Debug)]
pub struct Measures<'a> {
    variables: Vec<(&'a str, Dimension)>,
    /// Parameters that are written with a unit.
    parameters: Vec<(&'a str, Dimension)>,
}

/// Powers of kilogram, metre and second: roots have parts of them.
type Powers = [f64; 3];

/// What is known of a part of a formula.
#[derive(Clone, Copy, Default)]
struct Measure {
    powers: Option<Powers>,
    /// Whether the dimension comes of that of a parameter.
    of_parameter: bool,
}

/// Where dimensions do not go together.
struct Clash {
    span: Span,
    found: Powers,
    wanted: Powers,
}

impl<'a> Measures<'a> {
    /// The dimensions of variables, and of parameters by how they are written.
    pub fn new(variables: &[(&'a str, Dimension)], parameters: &'a [(String, String)]) -> Self {
        let dimension = |(name, text): &'a (String, String)| {
            // a plain number is in SI units of whatever is wanted
            if text.trim().parse::<f64>().is_ok() {
                return None;
            }
            Some((name.as_str(), parse_quantity(text).ok()?.dimension))
        };
        Self { variables: variables.to_vec(), parameters: parameters.iter().filter_map(dimension).collect() }
    }

    /// Refuses a formula in which a parameter has another dimension than its place asks for; `wanted` is that of the whole.
    ///
    /// # Errors
    /// The first such place, with what stands there, what is wanted, and the parameters in it.
    pub fn check(&self, place: &str, text: &str, wanted: Option<Dimension>) -> Result<(), LinkError> {
        self.check_within(place, text, text, wanted)
    }

    /// The same of a piece of the text at a place.
    pub fn check_within(
        &self,
        place: &str,
        text: &str,
        piece: &str,
        wanted: Option<Dimension>,
    ) -> Result<(), LinkError> {
        if self.parameters.is_empty() {
            return Ok(());
        }
        // what is no formula is refused where it is compiled
        let Ok(expression) = Expression::parse(piece) else { return Ok(()) };
        let Err(Clash { span, found, wanted }) = self.follow(&expression, wanted) else { return Ok(()) };
        let named = expression.nodes().iter().filter(|node| span.contains(node.span));
        let mut told: Vec<String> = Vec::new();
        for node in named {
            let NodeKind::Name(name) = &node.kind else { continue };
            if let Some((_, dimension)) = self.parameters.iter().find(|(known, _)| known == name) {
                let words = format!("`{name}` is {}", dimension.describe());
                if !told.contains(&words) {
                    told.push(words);
                }
            }
        }
        Err(LinkError::Text {
            place: place.to_owned(),
            what: format!(
                "has `{}`, which is {}, where {} is wanted{}{}",
                span.of(piece),
                described(found),
                described(wanted),
                if told.is_empty() { "" } else { ": " },
                told.join(", ")
            ),
            part: Some(span.moved_by(super::written::begin_within(text, piece))),
        })
    }

    fn follow(&self, expression: &Expression, wanted: Option<Dimension>) -> Result<(), Clash> {
        let mut known: Vec<Measure> = Vec::with_capacity(expression.nodes().len());
        for node in expression.nodes() {
            let operands: Vec<(Measure, Span)> = node
                .kind
                .operands()
                .map(|operand| (known[operand.index()], expression.node(operand).span))
                .collect();
            let exponent = match &node.kind {
                NodeKind::Binary { operator: BinaryOperator::Power, right, .. } => {
                    plain_number(expression, *right)
                }
                _ => None,
            };
            known.push(self.measure(&node.kind, &operands, exponent)?);
        }
        let root = expression.root();
        let whole = (known[root.index()], expression.node(root).span);
        let asked = Measure { powers: wanted.map(powers), of_parameter: false };
        alike((asked, whole.1), whole).map(|_| ())
    }

    fn measure(
        &self,
        kind: &NodeKind,
        operands: &[(Measure, Span)],
        exponent: Option<f64>,
    ) -> Result<Measure, Clash> {
        use BinaryOperator::{Add, And, Divide, Multiply, Or, Power, Subtract};
        Ok(match kind {
            NodeKind::Name(name) => {
                let find = |known: &[(&str, Dimension)]| {
                    known.iter().find(|(it, _)| it == name).map(|(_, dimension)| powers(*dimension))
                };
                let own = find(&self.parameters);
                Measure { powers: own.or_else(|| find(&self.variables)), of_parameter: own.is_some() }
            }
            NodeKind::Unary { operator: UnaryOperator::Negate, .. } => operands[0].0,
            NodeKind::Binary { operator: Add | Subtract, .. } => alike(operands[0], operands[1])?,
            NodeKind::Binary { operator: Multiply, .. } => product(operands[0].0, operands[1].0, 1.0),
            NodeKind::Binary { operator: Divide, .. } => product(operands[0].0, operands[1].0, -1.0),
            NodeKind::Binary { operator: Power, .. } => match exponent {
                Some(exponent) => raised(operands[0].0, exponent),
                None => Measure::default(),
            },
            NodeKind::Binary { operator: And | Or, .. } => Measure::default(),
            // comparisons
            NodeKind::Binary { .. } => {
                alike(operands[0], operands[1])?;
                Measure::default()
            }
            NodeKind::Call { name, .. } => match (name.as_str(), operands) {
                ("sqrt", [base]) => raised(base.0, 0.5),
                ("abs", [one]) => one.0,
                ("min" | "max", [first, others @ ..]) => {
                    let mut sum = *first;
                    for other in others {
                        sum.0 = alike(sum, *other)?;
                    }
                    sum.0
                }
                ("if", [_, then, otherwise]) => alike(*then, *otherwise)?,
                _ => Measure::default(),
            },
            NodeKind::Number(_) | NodeKind::Unary { .. } | NodeKind::Vector(_) => Measure::default(),
        })
    }
}

fn powers(dimension: Dimension) -> Powers {
    [dimension.mass, dimension.length, dimension.time].map(f64::from)
}

/// In words, with the unit.
fn described(powers: Powers) -> String {
    if powers.iter().all(|power| power.fract() == 0.0 && power.abs() < 100.0) {
        let [mass, length, time] = powers.map(|power| power as i8);
        return Dimension::new(mass, length, time).describe();
    }
    let [mass, length, time] = powers;
    format!("a quantity in [kg^{mass} m^{length} s^{time}]")
}

/// The number that a node is, with its sign.
fn plain_number(expression: &Expression, id: souple_formal::NodeId) -> Option<f64> {
    match expression.node(id).kind {
        NodeKind::Number(number) => Some(number),
        NodeKind::Unary { operator: UnaryOperator::Negate, operand } => {
            plain_number(expression, operand).map(|number| -number)
        }
        _ => None,
    }
}

/// What two parts have in common that are added or compared; the clash is where the parameter is.
fn alike(one: (Measure, Span), other: (Measure, Span)) -> Result<Measure, Clash> {
    let ((a, a_span), (b, b_span)) = (one, other);
    let of_parameter = a.of_parameter || b.of_parameter;
    match (a.powers, b.powers) {
        (Some(wanted), Some(found)) if wanted != found && of_parameter => Err(match b.of_parameter {
            true => Clash { span: b_span, found, wanted },
            false => Clash { span: a_span, found: wanted, wanted: found },
        }),
        (known, None) | (None, known) => Ok(Measure { powers: known, of_parameter }),
        (known, _) => Ok(Measure { powers: known, of_parameter }),
    }
}

fn product(one: Measure, other: Measure, sign: f64) -> Measure {
    let both = one.powers.zip(other.powers);
    let powers = both.map(|(a, b)| std::array::from_fn(|of| a[of] + sign * b[of]));
    Measure { powers, of_parameter: powers.is_some() && (one.of_parameter || other.of_parameter) }
}

fn raised(base: Measure, exponent: f64) -> Measure {
    Measure { powers: base.powers.map(|powers| powers.map(|power| power * exponent)), ..base }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, parameters: &[(&str, &str)], wanted: Dimension) -> Result<(), String> {
        let parameters: Vec<(String, String)> =
            parameters.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect();
        let variables = [("D", LENGTH), ("L0", LENGTH), ("V", VELOCITY), ("t", TIME)];
        let checked = Measures::new(&variables, &parameters).check("push", text, Some(wanted));
        checked.map_err(|error| error.to_string())
    }

    /// What a parameter is written with has to be what its place asks for, and the message names both and the place.
    #[test]
    fn units_of_parameters_are_those_of_their_place() {
        let spring = "-k * (D - L0) - z * V";
        assert_eq!(check(spring, &[("k", "50 N/m"), ("z", "0.01 N s/m")], FORCE), Ok(()));
        let message = check(spring, &[("k", "50 N"), ("z", "0.01")], FORCE).unwrap_err();
        for words in ["`-k * (D - L0)", "an energy or torque", "a force", "`k` is a force"] {
            assert!(message.contains(words), "{words}: {message}");
        }
        // two parameters that do not go together, in a sum and in a comparison
        assert!(check("k * (D - L0) - z * V", &[("k", "50 N/m"), ("z", "1 N/m")], FORCE).is_err());
        assert!(check("if(D > a, 1, 0)", &[("a", "5 ms")], FORCE).unwrap_err().contains("`a` is a time"));
        assert!(check("sqrt(e * k)", &[("e", "2 J"), ("k", "5 N/m")], FORCE).is_ok());
        assert!(check("k * (D - L0)^2", &[("k", "5 N/m")], ENERGY).is_ok());
        assert!(check("k * (D - L0)^2", &[("k", "5 N")], ENERGY).is_err());
        assert!(check("max(f, g)", &[("f", "1 N"), ("g", "1 Pa")], FORCE).is_err());
    }

    /// Plain numbers, in parameters and in formulas, are in SI units of whatever is wanted.
    #[test]
    fn plain_numbers_fit_everywhere() {
        assert_eq!(check("-k * (D - 0.2) - 10 * V", &[("k", "50 N/m")], FORCE), Ok(()));
        assert_eq!(check("-k * (D - L0)", &[("k", "50")], FORCE), Ok(()));
        assert_eq!(check("-2 * k", &[("k", "50 N/m")], FORCE), Ok(()));
        assert_eq!(check("a * sin(t)", &[("a", "5 N")], FORCE), Ok(()));
        // what no parameter is in is the writer's own
        assert_eq!(check("D + V", &[("a", "5 N")], FORCE), Ok(()));
    }
}
