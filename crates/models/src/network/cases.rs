//! Whether a transition can ever fire: by the cases into which comparisons with numbers part what conditions ask about.
//!
//! Between two neighbouring numbers that a variable is compared with, no condition on it changes. One value at each of them,
//! between them and beyond them stands for all; where a condition holds for no choice of such values, it never does. What is no
//! comparison of a variable with a number may hold or not, as it likes: of that nothing is said that is not sure.

use souple_formal::{BinaryOperator, Expression, Formula, NodeId, NodeKind, UnaryOperator};

/// Cases that are looked at for one condition, at most; of those with more nothing is said.
const CASES_MAX: usize = 1 << 16;
/// Conditions that are looked at in a case for all that is asked: a fraction of a second. Of what is asked beyond it nothing is said.
const WORK_MAX: usize = 1 << 20;
/// Bytes of a condition that is taken apart: what it is made of is nested no deeper, and is looked at by functions that call themselves.
const LENGTH_MAX: usize = 4096;

/// A condition by what it is made of.
#[derive(Clone, Debug, PartialEq)]
pub enum Truth {
    Settled(bool),
    /// A variable, by its number, with a number.
    Compared {
        variable: usize,
        operator: BinaryOperator,
        number: f64,
    },
    /// Anything else, by its number among such ([`Questions::other`]).
    Other(usize),
    Not(Box<Truth>),
    Both(Box<[Truth; 2]>),
    Either(Box<[Truth; 2]>),
}

/// What conditions ask about.
#[derive(Debug)]
pub struct Questions<'a> {
    /// Names of variables; those from `known_from` on have known values, which end `values`.
    names: &'a [&'a str],
    values: &'a [f64],
    known_from: usize,
    /// What the others are never below; negative infinity where nothing is known.
    lows: Vec<f64>,
    /// What is no comparison of a variable with a number.
    others: Vec<String>,
    /// What is left of [`WORK_MAX`].
    work: usize,
}

impl<'a> Questions<'a> {
    /// On variables, of which the last have known values.
    pub fn new(names: &'a [&'a str], values: &'a [f64], low: impl Fn(&str) -> f64) -> Self {
        let known_from = names.len() - values.len();
        let lows = names[..known_from].iter().map(|name| low(name)).collect();
        Self { names, values, known_from, lows, others: Vec::new(), work: WORK_MAX }
    }

    /// What is neither known nor compared with a number: the same words are the same thing.
    pub fn other(&mut self, words: &str) -> Truth {
        let words: String = words.split_whitespace().collect();
        let known = self.others.iter().position(|other| *other == words);
        Truth::Other(known.unwrap_or_else(|| {
            self.others.push(words);
            self.others.len() - 1
        }))
    }

    /// A condition that is a formula.
    pub fn read(&mut self, text: &str) -> Truth {
        match Expression::parse(text) {
            Ok(expression) if text.len() <= LENGTH_MAX => self.truth(&expression, expression.root(), text),
            _ => self.other(text),
        }
    }

    fn truth(&mut self, expression: &Expression, node: NodeId, text: &str) -> Truth {
        let words = expression.node(node).span.of(text);
        match &expression.node(node).kind {
            NodeKind::Unary { operator: UnaryOperator::Not, operand } => {
                Truth::Not(Box::new(self.truth(expression, *operand, text)))
            }
            NodeKind::Binary { operator: BinaryOperator::And, left, right } => {
                Truth::Both(Box::new([*left, *right].map(|node| self.truth(expression, node, text))))
            }
            NodeKind::Binary { operator: BinaryOperator::Or, left, right } => {
                Truth::Either(Box::new([*left, *right].map(|node| self.truth(expression, node, text))))
            }
            NodeKind::Binary { operator, left, right } => {
                let sides = [*left, *right].map(|side| expression.node(side));
                let [left, right] = sides.map(|side| self.number(side.span.of(text)));
                let [of_left, of_right] = sides.map(|side| match &side.kind {
                    NodeKind::Name(name) => self.variable(name),
                    _ => None,
                });
                match (left, right, of_left, of_right) {
                    (Some(left), Some(right), ..) => Truth::Settled(compare(left, *operator, right)),
                    (_, Some(number), Some(variable), _) => {
                        Truth::Compared { variable, operator: *operator, number }
                    }
                    (Some(number), _, _, Some(variable)) => {
                        Truth::Compared { variable, operator: turned(*operator), number }
                    }
                    _ => self.other(words),
                }
            }
            _ => self.other(words),
        }
    }

    /// A variable whose value is not known.
    fn variable(&self, name: &str) -> Option<usize> {
        self.names[..self.known_from].iter().position(|known| *known == name)
    }

    /// What words amount to that name nothing but what is known.
    fn number(&self, words: &str) -> Option<f64> {
        let formula = Formula::compile(words, &self.names[self.known_from..]).ok()?;
        Some(formula.evaluate(self.values))
    }

    /// Whether a condition can hold where none of the others does.
    pub fn can_hold(&mut self, condition: &Truth, unless: &[Truth]) -> bool {
        let all = || std::iter::once(condition).chain(unless);
        let mut variables = Vec::new();
        let mut others = Vec::new();
        all().for_each(|truth| {
            truth.visit(&mut |part| match part {
                Truth::Compared { variable, .. } => variables.push(*variable),
                Truth::Other(other) => others.push(*other),
                _ => {}
            })
        });
        for list in [&mut variables, &mut others] {
            list.sort_unstable();
            list.dedup();
        }
        let samples: Vec<Vec<f64>> =
            variables.iter().map(|variable| self.samples(*variable, all())).collect();
        let counts = samples.iter().map(Vec::len).chain(others.iter().map(|_| 2));
        let count = counts.clone().try_fold(1_usize, usize::checked_mul).filter(|count| *count <= CASES_MAX);
        let work = count.and_then(|count| self.work.checked_sub(count * (1 + unless.len())));
        let (Some(count), Some(work)) = (count, work) else { return true };
        self.work = work;
        let (mut values, mut answers) = (vec![0.0; self.known_from], vec![false; self.others.len()]);
        (0..count).any(|case| {
            let mut rest = case;
            for (variable, samples) in variables.iter().zip(&samples) {
                values[*variable] = samples[rest % samples.len()];
                rest /= samples.len();
            }
            for other in &others {
                answers[*other] = rest % 2 == 1;
                rest /= 2;
            }
            condition.holds(&values, &answers) && !unless.iter().any(|other| other.holds(&values, &answers))
        })
    }

    /// Values of a variable that stand for all.
    fn samples<'t>(&self, variable: usize, truths: impl Iterator<Item = &'t Truth>) -> Vec<f64> {
        let low = self.lows[variable];
        let mut bounds = vec![low];
        truths.for_each(|truth| {
            truth.visit(&mut |part| match part {
                Truth::Compared { variable: own, number, .. } if *own == variable => bounds.push(*number),
                _ => {}
            })
        });
        bounds.retain(|bound| bound.is_finite() && *bound >= low);
        bounds.sort_by(f64::total_cmp);
        bounds.dedup();
        let (Some(first), Some(last)) = (bounds.first(), bounds.last()) else { return vec![0.0] };
        let below = first - (1.0 + first.abs());
        let beyond = [below, last + (1.0 + last.abs())].into_iter().filter(|value| *value >= low);
        let between = bounds.windows(2).map(|pair| pair[0] + 0.5 * (pair[1] - pair[0]));
        beyond.chain(between).chain(bounds.iter().copied()).collect()
    }
}

impl Truth {
    fn visit(&self, visit: &mut dyn FnMut(&Truth)) {
        visit(self);
        match self {
            Self::Not(of) => of.visit(visit),
            Self::Both(of) | Self::Either(of) => of.iter().for_each(|part| part.visit(visit)),
            Self::Settled(_) | Self::Compared { .. } | Self::Other(_) => {}
        }
    }

    fn holds(&self, values: &[f64], answers: &[bool]) -> bool {
        match self {
            Self::Settled(holds) => *holds,
            Self::Compared { variable, operator, number } => compare(values[*variable], *operator, *number),
            Self::Other(other) => answers[*other],
            Self::Not(of) => !of.holds(values, answers),
            Self::Both(of) => of.iter().all(|part| part.holds(values, answers)),
            Self::Either(of) => of.iter().any(|part| part.holds(values, answers)),
        }
    }
}

fn compare(left: f64, operator: BinaryOperator, right: f64) -> bool {
    match operator {
        BinaryOperator::Less => left < right,
        BinaryOperator::LessOrEqual => left <= right,
        BinaryOperator::Greater => left > right,
        BinaryOperator::GreaterOrEqual => left >= right,
        BinaryOperator::Equal => left == right,
        BinaryOperator::NotEqual => left != right,
        operator => unreachable!("{operator:?} compares no numbers"),
    }
}

/// The operator between the same operands the other way round.
fn turned(operator: BinaryOperator) -> BinaryOperator {
    match operator {
        BinaryOperator::Less => BinaryOperator::Greater,
        BinaryOperator::LessOrEqual => BinaryOperator::GreaterOrEqual,
        BinaryOperator::Greater => BinaryOperator::Less,
        BinaryOperator::GreaterOrEqual => BinaryOperator::LessOrEqual,
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: &[&str] = &["D", "V", "k"];

    fn can_hold(condition: &str, unless: &[&str]) -> bool {
        let mut questions =
            Questions::new(NAMES, &[3.0], |name| if name == "D" { 0.0 } else { f64::NEG_INFINITY });
        let condition = questions.read(condition);
        let unless: Vec<Truth> = unless.iter().map(|text| questions.read(text)).collect();
        questions.can_hold(&condition, &unless)
    }

    /// A distance is not below zero, and no number is above 2 and below 1; what cannot be told may be.
    #[test]
    fn what_never_holds_is_known() {
        for never in
            ["D < 0", "D > 2 and D < 1", "0 > D", "D < k - 3", "V > 1 and V < 1", "not (D >= 0)", "k < 3"]
        {
            assert!(!can_hold(never, &[]), "{never}");
        }
        for may in ["D <= 0", "V < 0", "D > 2 or D < 1", "D < V and V < 0", "D == 2 and D >= 2", "D + 1 < 0"]
        {
            assert!(can_hold(may, &[]), "{may}");
        }
    }

    /// Of what is too long, too much or asked too often nothing is said, and soon.
    #[test]
    fn what_takes_long_is_left() {
        assert!(can_hold(&["D < 0"; 100_000].join(" or "), &[]));
        let question = |number: usize| format!("D < {} and D > {}", -1.0 - number as f64, number);
        let mut questions = Questions::new(NAMES, &[3.0], |_| f64::NEG_INFINITY);
        let asked: Vec<Truth> = (0..2000).map(|number| questions.read(&question(number))).collect();
        let known = (0..asked.len()).filter(|at| !questions.can_hold(&asked[*at], &asked[at + 1..])).count();
        assert!(known < asked.len() && questions.can_hold(&asked[0], &asked[1..]));
    }

    /// What comes after a condition covers it together.
    #[test]
    fn what_is_covered_is_known() {
        assert!(!can_hold("D > 1", &["D > 0.5"]));
        assert!(!can_hold("D > 1", &["D < 2", "D >= 2"]));
        assert!(can_hold("D > 1", &["D < 2", "D > 2"]), "at 2 itself");
        assert!(!can_hold("V > 0 and D > V", &["D  >  V"]));
        assert!(can_hold("D > 1", &["D > V"]));
    }
}
